//! Zeros: absolute pressure for gauge, and those that the rest at the start of each recording shows.

use super::fault::{DataFault, Kind};
use super::free_air::{CLEAR, in_the_air};
use crate::diagnosis::recordings::input::{DiagnosisInput, NamedRecording};
use crate::plant::{CHANNELS, Channel, InitialState, simulate};
use crate::stats::{NORMAL_MAD, median};

/// Share of the atmosphere by which that of a day may differ [1].
const WEATHER: f64 = 0.06;
/// Set pressure that counts as none [Pa gauge].
const NO_PRESSURE: f64 = 3e4;
/// Readings at rest that are needed.
const LEAST: usize = 10;
/// Standard errors from which a zero is not noise [1].
const SURE: f64 = 6.0;
/// Standard deviations of the noise below which a zero is not worth a word [1].
const WORTH: f64 = 0.4;
/// The same of a zero that a force on the stop or a residual pressure may be [1].
const FAR: f64 = 4.0;
/// Spread of the readings at rest, in standard deviations of the noise, beyond which that is no rest [1].
const QUIET: f64 = 1.6;
/// Force that a stop may carry at rest unknown to the model [N].
const UNKNOWN_LOAD: f64 = 120.0;

/// An outlet that is stated as absolute pressure: at the atmosphere where nothing is set.
pub(super) fn absolute(case: &DiagnosisInput) -> Vec<DataFault> {
    let atmosphere = case.nominal.device.gas.atmosphere;
    let channel = Channel::RegulatorPressure;
    let starts: Vec<Option<f64>> = (case.recordings.iter())
        .map(|r| Some(at_rest(r, channel as usize)?.0))
        .collect();
    let is = |start: &Option<f64>| start.is_some_and(|p| (p / atmosphere - 1.0).abs() < WEATHER);
    if starts.is_empty() || !starts.iter().all(is) {
        return Vec::new();
    }
    vec![DataFault {
        stays: true,
        ..DataFault::of(Kind::ZeroOffset(atmosphere), channel, None, 0.99)
    }]
}

/// Samples before anything is commanded.
fn rest(recording: &NamedRecording) -> usize {
    let inputs = &recording.recorded.inputs;
    if inputs.set_pressure[0].abs() > NO_PRESSURE {
        return 0;
    }
    let count = inputs.time.len();
    let still = |i: &usize| {
        (inputs.set_pressure[*i] - inputs.set_pressure[0]).abs() < 1.0
            && inputs.extends[*i] == inputs.extends[0]
    };
    (0..count).find(|i| !still(i)).unwrap_or(count)
}

/// Mean and number of a channel's readings at rest.
fn at_rest(recording: &NamedRecording, channel: usize) -> Option<(f64, usize)> {
    let values = &recording.recorded.readings[channel][..rest(recording)];
    let finite: Vec<f64> = values.iter().copied().filter(|v| v.is_finite()).collect();
    let mean = finite.iter().sum::<f64>() / finite.len().max(1) as f64;
    (finite.len() >= LEAST).then_some((mean, finite.len()))
}

/// Zeros at the start of each recording. One of the load cell that is the same in all is a listed effect (`force_sensor_bias_drift`) and left to the search.
pub(super) fn at_start(case: &DiagnosisInput) -> Vec<DataFault> {
    let mut faults = Vec::new();
    for channel in CHANNELS {
        let sheet = case.noise[channel as usize];
        let zeros: Vec<(&NamedRecording, f64, f64)> = (case.recordings.iter())
            .filter_map(|r| {
                let (zero, error) = zero(case, r, channel)?;
                Some((r, zero, error))
            })
            .collect();
        let least = match channel {
            Channel::Force | Channel::Acceleration => WORTH * sheet,
            Channel::Stroke => {
                (FAR * sheet).max(UNKNOWN_LOAD / case.nominal.device.end_stop.stiffness)
            }
            Channel::RegulatorPressure => FAR * sheet,
        };
        let weight: f64 = zeros.iter().map(|(.., e)| e.powi(-2)).sum();
        let mean = zeros.iter().map(|(_, z, e)| z * e.powi(-2)).sum::<f64>() / weight;
        let same = (zeros.iter()).all(|(_, z, e)| (z - mean).abs() < (SURE * e).max(WORTH * sheet));
        if same {
            if channel != Channel::Force && mean.abs() > least.max(SURE * weight.powf(-0.5)) {
                faults.push(DataFault::of(Kind::ZeroOffset(mean), channel, None, 0.97));
            }
            continue;
        }
        for (recording, zero, error) in zeros {
            if zero.abs() > least.max(4.0 * error) {
                let name = Some(recording.name.as_str());
                faults.push(DataFault::of(Kind::ZeroOffset(zero), channel, name, 0.99));
            }
        }
    }
    faults
}

/// Zero of a channel in a recording, and its standard error; none where nothing says it.
fn zero(case: &DiagnosisInput, recording: &NamedRecording, channel: Channel) -> Option<(f64, f64)> {
    let at_start = zero_at_start(case, recording, channel);
    match channel {
        Channel::Force => at_start.or_else(|| zero_in_the_air(case, recording)),
        _ => at_start,
    }
}

/// Mean of the load cell's readings in the air, which say its zero whatever went before, and its standard error.
fn zero_in_the_air(case: &DiagnosisInput, recording: &NamedRecording) -> Option<(f64, f64)> {
    let force = &recording.recorded.readings[Channel::Force as usize];
    let air: Vec<f64> = in_the_air(recording)
        .into_iter()
        .map(|i| force[i])
        .collect();
    if air.len() < 4 * LEAST {
        return None;
    }
    // What moves shakes the load cell: the middle, and as few independent readings as a motion leaves.
    let middle = median(air.iter().copied())?;
    let spread = NORMAL_MAD * median(air.iter().map(|f| (f - middle).abs()))?;
    let noise = case.noise[Channel::Force as usize];
    (spread < 3.0 * noise).then(|| (middle, spread.max(noise) / (air.len() as f64 / 20.0).sqrt()))
}

/// The same from the rest at the start.
fn zero_at_start(
    case: &DiagnosisInput,
    recording: &NamedRecording,
    channel: Channel,
) -> Option<(f64, f64)> {
    let inputs = &recording.recorded.inputs;
    if inputs.initial != InitialState::AtRest {
        return None;
    }
    let index = channel as usize;
    let (mean, count) = at_rest(recording, index)?;
    let clear = inputs.surface[0].is_nan() || inputs.surface[0] > CLEAR;
    let values = &recording.recorded.readings[index][..rest(recording)];
    let finite = values.iter().filter(|v| v.is_finite());
    let variance = finite.map(|v| (v - mean).powi(2)).sum::<f64>() / (count - 1) as f64;
    let noise = case.noise[index].max(1e-12);
    if !clear || variance.sqrt() > 10.0 * noise {
        return None;
    }
    // A rise or a swing is no rest; a louder noise is.
    let halves = values.split_at(values.len() / 2);
    let level = |half: &[f64]| {
        let finite: Vec<f64> = half.iter().copied().filter(|v| v.is_finite()).collect();
        finite.iter().sum::<f64>() / finite.len().max(1) as f64
    };
    let error = variance.sqrt().max(noise) / (count as f64).sqrt();
    if (level(halves.0) - level(halves.1)).abs() > QUIET * 3.0 * error {
        return None;
    }
    let expected = simulate(&case.nominal, &start_of(inputs)).readings[index][0];
    Some((mean - expected, error))
}

/// The first samples of the inputs.
fn start_of(inputs: &crate::plant::PlantInputs) -> crate::plant::PlantInputs {
    let few = inputs.time.len().min(3);
    crate::plant::PlantInputs {
        time: inputs.time[..few].to_vec(),
        set_pressure: inputs.set_pressure[..few].to_vec(),
        extends: inputs.extends[..few].to_vec(),
        surface: inputs.surface[..few].to_vec(),
        ..inputs.clone()
    }
}
