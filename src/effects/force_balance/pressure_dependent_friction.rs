//! Seals rub the harder, the more the two chambers' pressures differ. Pressure presses the lip against the bore.
//!
//! ```text
//! F = -(F_c + c |p_1 - p_2|) sign(v) - b v
//! ```
//!
//! F force along extension [N], c growth of friction with pressure [N/Pa], p_1 and p_2 chamber pressures [Pa], F_c Coulomb friction [N], b viscous
//! coefficient [N s/m], v speed of extension [m/s].
//! Source: Raparelli, Manuello Bertetto and Mazza 1997; Belforte, Raparelli and Mazza 1993.
//!
//! Signature: The force steps at reversals, by more at higher set pressures.
//!
//! Confused with:
//! - coulomb_viscous_friction: the same step at every pressure; recordings at one pressure alone cannot tell.
//! - force_sensor_gain_error: grows with the pressure too, but does not change its sign at reversals.

use super::*;
use crate::plant::DeviceParts;

/// The effect.
#[rustfmt::skip] // A table: one number a line.
pub const EFFECT: Effect = Effect {
    text: include_str!("pressure_dependent_friction.rs"),
    group: Some("friction"),
    parameters: |_, _| vec![
        reported(SEAL_PRESSURE.named("friction_per_pressure_n_per_pa"), Logarithmic, [1e-7, 1e-2]),
        hidden(COULOMB, Linear(3.0), [0.0, 500.0]),
        hidden(VISCOUS, Linear(20.0), [0.0, 5000.0]),
        hidden(PRESLIDING, Logarithmic, [2e-6, 3e-4]),
    ],
    usual: |_, _| vec![5e-5, 3.0, 40.0, 3e-5],
    starts: |c, _| {
        // Where a plain law rubs already, half of it at 2 bar.
        let rubs = rubbing(c).map(|[dry, viscous]| vec![0.5 * dry / 2e5, 0.5 * dry, viscous, 3e-5]);
        let mut starts: Vec<Vec<f64>> = rubs.into_iter().collect();
        starts.extend([vec![3e-5, 2.0, 30.0, 5e-5], vec![1e-4, 3.0, 40.0, 5e-5]]);
        // One small cylinder, moved slowly.
        if c.plant.parts == DeviceParts::MovedPiston {
            starts.extend([vec![2e-6, 4.0, 100.0, 5e-5], vec![1e-5, 2.0, 100.0, 5e-5]]);
        }
        starts
    },
    ..effect("pressure_dependent_friction", Subsystem::ForceBalance)
};
