//! Zeros of the load cell that drift in one recording otherwise than in the next.
//!
//! ```text
//! F_m = d (t - t_0)      in the air
//! ```
//!
//! F_m reading [N], d drift [N/s], t_0 start of the recording [s]. One that is the same in all recordings is a listed effect (`force_sensor_bias_drift`).

use super::fault::{DataFault, Kind};
use super::free_air::in_the_air;
use super::line::Line;
use crate::diagnosis::recordings::input::{DiagnosisInput, NamedRecording};
use crate::plant::Channel;

/// Readings in the air that are needed.
const LEAST: usize = 60;
/// Share of a recording over which they must be spread [1].
const SPREAD: f64 = 0.4;
/// Standard errors from which a drift is none of noise [1].
const SURE: f64 = 8.0;
/// Standard deviations of the noise over the recording below which a drift is not worth a word [1].
const WORTH: f64 = 1.5;

/// Drifts that differ from recording to recording.
pub(super) fn drifts(case: &DiagnosisInput) -> Vec<DataFault> {
    let noise = case.noise[Channel::Force as usize];
    let found: Vec<(&NamedRecording, f64, f64)> = (case.recordings.iter())
        .filter_map(|recording| {
            let (drift, error) = drift(recording, noise)?;
            Some((recording, drift, error))
        })
        .collect();
    let weight: f64 = found.iter().map(|(.., e)| e.powi(-2)).sum();
    let mean = found.iter().map(|(_, d, e)| d * e.powi(-2)).sum::<f64>() / weight;
    if found.iter().all(|(_, d, e)| (d - mean).abs() < SURE * e) {
        return Vec::new();
    }
    let is_worth = |(recording, drift, error): &(&NamedRecording, f64, f64)| {
        let time = &recording.recorded.inputs.time;
        let length = time[time.len() - 1] - time[0];
        drift.abs() > (SURE * error).max(WORTH * noise / length)
    };
    let said = |(recording, drift, _): (&NamedRecording, f64, f64)| {
        DataFault::of(
            Kind::Drift(drift),
            Channel::Force,
            Some(&recording.name),
            0.97,
        )
    };
    found.into_iter().filter(is_worth).map(said).collect()
}

/// Slope of the load cell's readings in the air [N/s], and its standard error.
fn drift(recording: &NamedRecording, noise: f64) -> Option<(f64, f64)> {
    let time = &recording.recorded.inputs.time;
    let force = &recording.recorded.readings[Channel::Force as usize];
    let air: Vec<(f64, f64)> = (in_the_air(recording).into_iter())
        .map(|i| (time[i], force[i]))
        .collect();
    let length = time[time.len() - 1] - time[0];
    let spread = air.last()?.0 - air.first()?.0;
    if air.len() < LEAST || spread < SPREAD * length {
        return None;
    }
    let line = Line::through(air.into_iter())?;
    // Beside a line there is noise alone: a jump, or what the tool touches, is no drift.
    (line.rms < 1.6 * noise).then(|| (line.slope, line.rms.max(noise) / line.spread.sqrt()))
}
