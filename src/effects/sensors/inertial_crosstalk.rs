//! The load cell feels the mass in front of it being accelerated.
//!
//!     F_m = F + m_x a
//!
//! F_m reading and F contact force [N], m_x mass beyond the load cell [kg], a acceleration along extension [m/s2].
//! Source: Newton's second law.
//!
//! Signature: The reading in the air is a copy of the accelerometer's, m_x times it.
//!
//! Confused with:
//! - moving_mass_error: the motion itself is another one.
//! - force_sensor_lag: nothing in the air.

use super::*;

/// The effect.
pub const EFFECT: Effect = Effect {
    name: "inertial_crosstalk",
    text: include_str!("inertial_crosstalk.rs"),
    which: Which::Only,
    subsystem: Subsystem::Sensors,
    group: None,
    parameters: |_, _| {
        vec![reported(
            quantity!("mass_kg", p => p.sensors.crosstalk_mass),
            Linear(0.1),
            [-20.0, 20.0],
        )]
    },
    usual: |_, _| vec![0.5],
    starts: |_, _| vec![vec![0.0]],
};
