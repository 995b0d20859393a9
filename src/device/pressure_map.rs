//! From a desired contact force to the set pressure that gives it at rest.
//!
//! ```text
//! p_set = (F - m g_a + p_o A_2) / (K A_1)                        (source paper, eq. 1 at rest, chamber 2 at the opposing pressure)
//! ```
//!
//! p_set gauge [Pa], F contact force along the axis [N], m moving mass [kg], g_a component of gravity along extension [m/s2],
//! p_o opposing pressure, 0 in the paper,
//! gauge [Pa], K regulator gain [1], A_1, A_2 areas of the chambers [m2].

use super::DeviceParameters;

/// The map, with the parameters it needs.
#[derive(Debug, Clone, Copy)]
pub struct PressureMap {
    moving_mass: f64,
    force_per_pressure: f64,
    supply: f64,
    /// Force of the opposing pressure [N].
    opposing: f64,
}

impl PressureMap {
    /// The map of a device.
    pub fn new(parameters: &DeviceParameters) -> Self {
        Self {
            moving_mass: parameters.moving_mass,
            force_per_pressure: parameters.regulator.gain * parameters.areas().extending,
            supply: parameters.regulator.supply,
            opposing: parameters.opposing_pressure * parameters.areas().retracting,
        }
    }

    /// Set pressure before any limit [Pa gauge]; may be negative or beyond the supply.
    pub fn unlimited(&self, force: f64, gravity_along_axis: f64) -> f64 {
        (force - self.moving_mass * gravity_along_axis + self.opposing) / self.force_per_pressure
    }

    /// Set pressure within what the regulator can give [Pa gauge].
    pub fn set_pressure(&self, force: f64, gravity_along_axis: f64) -> f64 {
        self.unlimited(force, gravity_along_axis)
            .clamp(0.0, self.supply)
    }

    /// Contact force at rest [N] for a set pressure [Pa gauge]: the inverse.
    pub fn force(&self, set_pressure: f64, gravity_along_axis: f64) -> f64 {
        set_pressure * self.force_per_pressure + self.moving_mass * gravity_along_axis
            - self.opposing
    }
}
