//! Seals and guides rub: a dry part and one that grows with speed. Dry friction knows the direction of motion alone.
//!
//! ```text
//! F = -F_c sign(v) - b v
//! ```
//!
//! F force along extension [N], F_c Coulomb friction [N], b viscous coefficient [N s/m], v speed of extension [m/s]. In the simulator the sign is that of
//! bristles that bend before they slide, over a presliding displacement that is fitted along.
//! Source: Coulomb 1785 for dry friction; bristles by Dahl 1968; Canudas de Wit, Olsson, Astrom and Lischinsky 1995.
//!
//! Signature: Force and acceleration step by 2 F_c wherever the motion turns, whatever the speed, and are off by b v in proportion to the speed; the piston
//! stays put under small changes of pressure.
//!
//! Confused with:
//! - stribeck_friction: the force overshoots as sliding starts; here it does not.
//! - presliding_hysteresis: friction builds up over 0.1 mm and more after a reversal; here within micrometres.
//! - pressure_dependent_friction: the step grows with the set pressure; recordings at one pressure alone cannot tell.
//! - end_cushioning: brakes near the ends alone, and on the way in alone.
//! - exhaust_restriction: brakes by a pressure, which the vented chamber shows.

use super::*;

/// The effect.
#[rustfmt::skip] // A table: one number a line.
pub const EFFECT: Effect = Effect {
    text: include_str!("coulomb_viscous_friction.rs"),
    group: Some("friction"),
    parameters: |_, _| vec![
        reported(COULOMB, Logarithmic, [0.05, 500.0]),
        reported(VISCOUS, Linear(20.0), [0.0, 5000.0]),
        hidden(PRESLIDING, Logarithmic, [2e-6, 3e-4]),
    ],
    usual: |_, _| vec![10.0, 60.0, 3e-5],
    starts: |_, _| vec![vec![3.0, 20.0, 5e-5], vec![10.0, 60.0, 5e-5], vec![30.0, 100.0, 5e-5]],
    ..effect("coulomb_viscous_friction", Subsystem::ForceBalance)
};
