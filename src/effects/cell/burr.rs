//! A burr stands on the edge. A smooth bump.
//!
//! ```text
//! l(s) = h exp(-((s - p)/w)^2 / 2)
//! ```
//!
//! l how far the part stands out along the bisector of its edge [m], s place along the edge and p that of the burr [m], h height and w standard width of the
//! burr [m].
//! Source: The bump is a normal curve, the simplest smooth one of a place, a height and a width: a choice of this project.
//!
//! Signature: The stroke gives way at one place of the path, in every recording at the same, and the force kicks as it climbs and leaves.
//!
//! Confused with:
//! - surface_waviness: goes on all along the path.
//! - a disturbance at one time: is at another place of the path in another recording.

use super::*;

#[rustfmt::skip] // A table: one number a line.
pub(super) const EFFECT: Effect = Effect {
    text: include_str!("burr.rs"),
    parameters: |_, _| vec![
        reported(BURR_POSITION.named("position_m"), Linear(1e-3), [0.0, 100.0]),
        reported(BURR_HEIGHT.named("height_m"), Linear(1e-4), [0.0, 0.02]),
        hidden(BURR_WIDTH.named("width_m"), Logarithmic, [2e-4, 0.02]),
    ],
    usual: |_, _| vec![0.1, 3e-4, 2e-3],
    starts: |clues: &Clues<'_>, _| {
        let places = clues.bumps.iter();
        places.map(|place| vec![*place, 1e-4, 2e-3]).collect()
    },
    ..effect("burr", Subsystem::Workpiece)
};
