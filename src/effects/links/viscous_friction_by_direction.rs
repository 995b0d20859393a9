//! Viscous friction is larger one way than the other. Lips of seals that face one way, a ball screw.
//!
//! ```text
//! F = -(b + B sign(v)) v
//! ```
//!
//! F force along extension [N], b viscous coefficient [N s/m], B half of what it is larger by in extension than in retraction [N s/m], v speed of extension
//! [m/s].
//! Source: Janot, Gautier and Brunot 2019 for a ball screw.
//!
//! Signature: What is left grows with the size of the speed, with the same sign both ways.
//!
//! Confused with:
//! - axial_force_offset: the same at every speed.
//! - gains of a regulator or drive that differ by direction: in proportion to the force, at rest too.

use super::*;

/// The effect.
#[rustfmt::skip] // A table: one number a line.
pub const EFFECT: Effect = Effect {
    text: include_str!("viscous_friction_by_direction.rs"),
    parameters: |_, _| vec![reported(VISCOUS_ASYMMETRY.named("viscous_asymmetry_n_s_per_m"), Linear(20.0), [-5000.0, 5000.0])],
    usual: |_, _| vec![20.0],
    starts: |_, _| vec![vec![0.0]],
    ..effect("viscous_friction_by_direction", Subsystem::ForceBalance)
};
