//! Noise that is louder than the sheet's.

use super::super::clean::clean;
use super::super::input::{DiagnosisInput, OTHER_NOISE};
use super::{DataFault, Kind};
use crate::plant::CHANNELS;

/// Channels whose noise is clearly more than their sheet says, by the median over the recordings.
pub(super) fn louder(case: &DiagnosisInput) -> Vec<DataFault> {
    let mass = case.believed.device.moving_mass;
    let cleanings: Vec<_> = (case.recordings.iter())
        .map(|recording| {
            let mut readings = recording.recorded.readings.clone();
            let inputs = &recording.recorded.inputs;
            clean(&inputs.time, &mut readings, &case.noise, mass)
        })
        .collect();
    let of = |(channel, sheet): (usize, f64)| {
        let shown = cleanings.iter().filter_map(|c| c.noise[channel]);
        let mut shown: Vec<f64> = shown.filter(|noise| *noise > 0.0).collect();
        shown.sort_by(f64::total_cmp);
        let noise = *shown.get(shown.len() / 2)?;
        let louder = noise > OTHER_NOISE * sheet;
        louder.then(|| DataFault::of(Kind::Noise(noise), CHANNELS[channel], None, 0.99))
    };
    let sheets = case.noise.into_iter().enumerate();
    sheets
        .filter(|(_, sheet)| sheet.is_finite())
        .filter_map(of)
        .collect()
}
