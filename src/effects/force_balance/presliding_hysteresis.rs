//! Seals bend before they slide, over a displacement that shows. A soft lip, or a soft mount of the piston.
//!
//! ```text
//! F = -s z - b v,   dz/dx = 1 - sign(v) s z / F_c,   s = F_c / z_p
//! ```
//!
//! F force along extension [N], z deflection [m], s its stiffness [N/m], F_c Coulomb friction [N], z_p presliding displacement [m], b viscous coefficient [N
//! s/m], v speed of extension [m/s], x stroke [m].
//! Source: Dahl 1968; Canudas de Wit, Olsson, Astrom and Lischinsky 1995.
//!
//! Signature: After a reversal the force follows the displacement in a loop, and friction is complete only after some z_p; small motions see a spring.
//!
//! Confused with:
//! - coulomb_viscous_friction: complete within micrometres of a reversal, z_p below 0.1 mm.
//! - return_spring_load: the force follows the stroke on one line, there and back: no loop.
//! - contact_stiffness_error: the displacement goes with the contact force, without a loop, and not in the air.

use super::*;

/// The effect.
#[rustfmt::skip] // A table: one number a line.
pub const EFFECT: Effect = Effect {
    text: include_str!("presliding_hysteresis.rs"),
    group: Some("friction"),
    parameters: |_, _| vec![
        reported(COULOMB, Logarithmic, [0.05, 500.0]),
        reported(PRESLIDING, Logarithmic, [1e-4, 1e-2]),
        hidden(VISCOUS, Linear(20.0), [0.0, 5000.0]),
    ],
    usual: |_, _| vec![12.0, 8e-4, 40.0],
    starts: |c, _| rubbing(c)
        .map(|[dry, viscous]| vec![dry, 5e-4, viscous])
        .into_iter()
        .chain([vec![8.0, 5e-4, 30.0], vec![20.0, 5e-4, 40.0], vec![8.0, 2e-3, 30.0], vec![20.0, 2e-3, 40.0]])
        .collect(),
    ..effect("presliding_hysteresis", Subsystem::ForceBalance)
};
