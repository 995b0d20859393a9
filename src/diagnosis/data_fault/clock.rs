//! Clock of a whole log.
//!
//! ```text
//! d2 x / d stamp2 = a / s^2
//! ```
//!
//! s stamp over true time [1], x stroke [m], a acceleration [m/s2].

use super::curvature::curvature_ratio;
use super::fault::{DataFault, Kind};
use crate::diagnosis::recordings::input::DiagnosisInput;
use crate::plant::Channel;
use crate::stats::{mean, median_step};

/// Departure of a clock from true time that is worth a word [1].
pub(super) const WORTH: f64 = 0.004;
/// Rates farther apart than this are other rates, not clocks [1].
const FARTHEST: f64 = 0.15;

/// Mean step of the stamps, gaps apart [s].
fn step(time: &[f64]) -> f64 {
    let usual = median_step(time);
    let steps = time.windows(2).map(|pair| pair[1] - pair[0]);
    mean(&steps.filter(|h| *h < 1.5 * usual).collect::<Vec<f64>>())
}

/// Clock of a whole log, in true time.
fn log_clock(scale: f64, probability: f64) -> Vec<DataFault> {
    vec![DataFault {
        kind: Kind::ClockScale(scale),
        channel: None,
        recording: None,
        probability,
        stays: true,
    }]
}

/// Whether a scale is worth a word, and one of a clock.
fn is_clock(scale: f64) -> bool {
    (scale - 1.0).abs() > WORTH && (scale - 1.0).abs() < FARTHEST
}

/// Step of the stamps of each recording over that of the sheet's rate, if it is the same in all [1].
fn stated_scale(case: &DiagnosisInput) -> Option<f64> {
    let rates = case.recordings.iter();
    let scales: Vec<f64> = rates
        .map(|r| step(&r.recorded.inputs.time) * case.rate)
        .collect();
    let mean = scales.iter().sum::<f64>() / scales.len() as f64;
    let alike = scales.iter().all(|s| (s / mean - 1.0).abs() < 0.5 * WORTH);
    alike.then_some(mean)
}

/// Clock of a whole log whose stamps are not at the sheet's rate: motion against acceleration says whether the clock is off or the rate another one.
pub(super) fn of_log_by_rate(case: &DiagnosisInput) -> Vec<DataFault> {
    let (Some((ratio, _)), Some(scale)) = (curvature_ratio(case), stated_scale(case)) else {
        return Vec::new();
    };
    let says_so = (ratio - scale * scale).abs() < (ratio - 1.0).abs();
    match is_clock(scale) && says_so {
        true => log_clock(scale, 0.98),
        false => Vec::new(),
    }
}

/// Clock of a whole log by motion against acceleration alone, such as an index taken for time, unless a gain of the stroke or one logger's clock says it.
pub(super) fn of_log_by_motion(case: &DiagnosisInput) -> Vec<DataFault> {
    let known = (case.data_faults.iter()).any(|f| matches!(f.kind, Kind::ClockScale(_)));
    let Some((ratio, error)) = curvature_ratio(case).filter(|_| !known) else {
        return Vec::new();
    };
    let scale = ratio.max(0.0).sqrt();
    let sure = (ratio - 1.0).abs() > (5.0 * error).max(3.0 * WORTH);
    let gain = stroke_gain(case);
    let is_stroke = gain.is_none_or(|gain| (gain * ratio - 1.0).abs() < (gain - 1.0).abs());
    match sure && is_clock(scale) && !is_stroke {
        true => log_clock(scale, 0.95),
        false => Vec::new(),
    }
}

/// Spread of the surface that tells a gain [m].
const SPREAD: f64 = 1.5e-3;

/// Gain of the stroke sensor, from the strokes at which the tool rests on a surface that the robot knows [1].
fn stroke_gain(case: &DiagnosisInput) -> Option<f64> {
    let (mut both, mut own, mut mean) = (0.0, 0.0, [0.0; 3]);
    let mut pairs: Vec<(f64, f64)> = Vec::new();
    let noise = case.noise[Channel::Force as usize];
    for recording in &case.recordings {
        let inputs = &recording.recorded.inputs;
        let [_, stroke, force, _] = &recording.recorded.readings;
        for i in 0..inputs.time.len() {
            let pair = (inputs.surface[i], stroke[i]);
            if force[i] > 15.0 * noise && pair.0.is_finite() && pair.1.is_finite() {
                pairs.push(pair);
            }
        }
    }
    for (s, x) in &pairs {
        mean = [mean[0] + s, mean[1] + x, mean[2] + 1.0];
    }
    let [s0, x0] = [mean[0], mean[1]].map(|sum| sum / mean[2].max(1.0));
    for (s, x) in &pairs {
        both += (s - s0) * (x - x0);
        own += (s - s0).powi(2);
    }
    (mean[2] > 50.0 && (own / mean[2]).sqrt() > SPREAD).then(|| both / own)
}
