//! A burr on the edge: a smooth bump.
//!
//!     l(s) = h exp(-((s - p)/w)^2 / 2)
//!
//! Signature: the stroke gives way at one place of the path, in every recording at the same, and the force kicks as it climbs and leaves.
//! Confused with: nothing that is spread along the path; a disturbance at one time is at another place in another recording.

use super::*;

#[rustfmt::skip] // A table: one number a line.
pub(super) const EFFECT: Effect = Effect {
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
