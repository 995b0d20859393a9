//! Seals and guides rub: a dry part that only knows the direction of motion, and one that grows with speed.
//!
//!     F = -F_c sign(v) - b v
//!
//! F force along extension [N], F_c Coulomb friction [N], b viscous coefficient [N s/m], v speed of extension [m/s]. In the simulator the sign is that of
//! bristles that bend before they slide (Dahl 1968; Canudas de Wit, Olsson, Astrom and Lischinsky 1995), over a displacement that is fitted along.
//!
//! Signature: force and acceleration step by 2 F_c wherever the motion turns, whatever the speed; the piston stays put under small changes of pressure;
//! what is left falls in proportion to the speed.
//! Confused with: the other frictions (told apart by the first moments of sliding and by pressure), end_cushioning (near the ends alone),
//! exhaust_restriction (a pressure that brakes, and that a chamber's gas shows).

use super::*;

/// The effect.
#[rustfmt::skip] // A table: one number a line.
pub const EFFECT: Effect = Effect {
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
