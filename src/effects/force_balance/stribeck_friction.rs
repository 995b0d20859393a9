//! Seals stick: breaking loose takes more force than sliding on. The lubricant film of a lip only builds up with speed.
//!
//! ```text
//! F = -(F_c + (F_s - F_c) exp(-(v / v_s)^2)) sign(v) - b v
//! ```
//!
//! F force along extension [N], F_c Coulomb and F_s static friction [N], v_s Stribeck velocity [m/s], b viscous coefficient [N s/m], v speed of extension
//! [m/s].
//! Source: Stribeck 1902 for bearings; the exponential after Bo and Pavelescu 1982; Armstrong-Helouvry, Dupont and Canudas de Wit 1994 for the whole.
//!
//! Signature: The force overshoots as sliding starts and sags within a few v_s; slow motion sticks and slips.
//!
//! Confused with:
//! - coulomb_viscous_friction: no overshoot at the start of sliding, F_s = F_c.
//! - presliding_hysteresis: friction builds up and stays, it does not sag with speed.

use super::*;

/// The effect.
#[rustfmt::skip] // A table: one number a line.
pub const EFFECT: Effect = Effect {
    text: include_str!("stribeck_friction.rs"),
    group: Some("friction"),
    parameters: |_, _| vec![
        reported(COULOMB, Logarithmic, [0.05, 500.0]),
        reported(SEAL_STATIC.named("static_force_n"), Linear(5.0), [0.05, 1000.0]),
        reported(SEAL_STRIBECK.named("stribeck_velocity_m_per_s"), Logarithmic, [5e-4, 0.2]),
        hidden(VISCOUS, Linear(20.0), [0.0, 5000.0]),
        hidden(PRESLIDING, Logarithmic, [2e-6, 3e-4]),
    ],
    usual: |_, _| vec![10.0, 16.0, 0.01, 60.0, 3e-5],
    // Where a plain law rubs already, its dry part is between the two.
    starts: |c, _| rubbing(c)
        .map(|[dry, viscous]| vec![0.55 * dry, 1.1 * dry, 0.01, viscous, 3e-5])
        .into_iter()
        .chain([vec![4.0, 8.0, 0.008, 30.0, 5e-5], vec![8.0, 16.0, 0.008, 40.0, 5e-5], vec![8.0, 16.0, 0.03, 40.0, 5e-5]])
        .collect(),
    ..effect("stribeck_friction", Subsystem::ForceBalance)
};
