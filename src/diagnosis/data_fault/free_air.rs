//! Readings of a tool that touches nothing.

use crate::diagnosis::recordings::input::NamedRecording;
use crate::plant::Channel;

/// Distance from the surface beyond which a tool does not touch [m].
pub(super) const CLEAR: f64 = 2e-3;
/// Samples on either side that must be clear too.
const BESIDE: usize = 3;

/// Indices of the load cell's readings in the air.
pub(super) fn in_the_air(recording: &NamedRecording) -> Vec<usize> {
    let inputs = &recording.recorded.inputs;
    let readings = &recording.recorded.readings;
    let [stroke, force] =
        [Channel::Stroke, Channel::Force].map(|channel| &readings[channel as usize]);
    let count = force.len();
    let clear = |i: usize| {
        let surface = inputs.surface[i];
        surface.is_nan() || stroke[i] < surface - CLEAR
    };
    let air = |i: &usize| {
        let near = i.saturating_sub(BESIDE)..(i + BESIDE + 1).min(count);
        near.into_iter().all(clear) && force[*i].is_finite()
    };
    (0..count).filter(air).collect()
}
