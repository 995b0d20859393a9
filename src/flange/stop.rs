//! The stop on which the slide rests fully extended.
//!
//! ```text
//! S = min(0, k s + c s')  for s < 0, else 0
//! ```
//!
//! S force on the slide [N], s stroke by which it is pushed in [m]. The stop is steel: its numbers are far stiffer than all else and show nowhere.

/// Stiffness [N/m] and damping [N s/m].
const STIFFNESS: f64 = 2e6;
const DAMPING: f64 = 1.7e3;

/// Force on the slide [N] at a stroke [m] and its rate [m/s].
pub(super) fn stop_force(stroke: f64, rate: f64) -> f64 {
    if stroke < 0.0 {
        (STIFFNESS * stroke + DAMPING * rate).min(0.0)
    } else {
        0.0
    }
}

/// How far a force [N] presses the slide into it [m].
pub(super) fn pressed(force: f64) -> f64 {
    force / STIFFNESS
}
