//! Noise that is louder than the sheet's.

use super::fault::{DataFault, Kind};
use crate::diagnosis::recordings::clean::{clean, departures};
use crate::diagnosis::recordings::device::Device;
use crate::diagnosis::recordings::input::{DiagnosisInput, OTHER_NOISE};
use crate::plant::CHANNELS;
use crate::stats::median;

/// Samples within which departures of white noise from their neighbours' cubic are alike, and up to which a period is sought.
const LAGS: [usize; 2] = [5, 40];
/// Correlation of departures with themselves from which they are periodic [1].
const PERIODIC: f64 = 0.25;

/// Whether departures from the neighbours have no period: a fast runout is no noise.
fn is_white(time: &[f64], values: &[f64]) -> bool {
    let step = (time[time.len() - 1] - time[0]) / (time.len() - 1) as f64;
    let all: Vec<f64> = departures(time, values, step);
    // Robustly: an impact is large and stands alone.
    let signs: Vec<f64> = all
        .iter()
        .map(|z| if z.is_nan() { 0.0 } else { z.signum() })
        .collect();
    let at = |lag: usize| -> f64 {
        let pairs = signs.iter().zip(&signs[lag..]);
        pairs.map(|(a, b)| a * b).sum::<f64>() / (signs.len() - lag) as f64
    };
    (LAGS[0]..LAGS[1].min(signs.len() / 4)).all(|lag| at(lag).abs() < PERIODIC)
}

/// Channels whose noise is clearly more than their sheet says, by the median over the recordings.
pub(super) fn louder(case: &DiagnosisInput) -> Vec<DataFault> {
    let cleanings: Vec<_> = (case.recordings.iter())
        .map(|recording| {
            let mut readings = recording.recorded.readings.clone();
            let inputs = &recording.recorded.inputs;
            let mut cleaning =
                clean::<Device>(&inputs.time, &mut readings, &case.noise, &case.nominal);
            for (noise, values) in cleaning.noise.iter_mut().zip(&readings) {
                *noise = noise.filter(|_| is_white(&inputs.time, values));
            }
            cleaning
        })
        .collect();
    let of = |(channel, sheet): (usize, f64)| {
        let shown = cleanings.iter().filter_map(|c| c.noise[channel]);
        let noise = median(shown.filter(|noise| *noise > 0.0))?;
        let louder = noise > OTHER_NOISE * sheet;
        louder.then(|| DataFault::of(Kind::Noise(noise), CHANNELS[channel], None, 0.99))
    };
    let sheets = case.noise.into_iter().enumerate();
    sheets
        .filter(|(_, sheet)| sheet.is_finite())
        .filter_map(of)
        .collect()
}
