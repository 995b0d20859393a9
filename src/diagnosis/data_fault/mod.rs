//! Faults of sensors, logs and clocks, found and taken off before any physics is looked for, and put back into what a faulty sensor would read.
//!
//! ```text
//! reading(stamp) = gain * signal(floor(t / period) * period) + zero,   t = (stamp - offset) / scale
//! ```
//!
//! Most need no model; those of channels' clocks and of units are held against the nominal model.

mod channel_clock;
mod clock;
mod copied;
mod curvature;
mod drift;
pub mod fault;
mod free_air;
mod gain;
mod jump;
mod line;
mod noise;
mod refined;
pub mod report;
mod reported;
mod resample;
mod run;
mod zero;

pub use refined::refined;
pub use reported::reported;

use crate::stats::median;
use fault::{DataFault, Kind};

use super::recordings::input::{DiagnosisInput, NamedRecording};
use crate::plant::{CHANNELS, Channel, DeviceParts, InitialState};
use resample::{held, interpolated, read_at, set_impacts_aside};

/// Finds the faults in a case and takes them off its readings and stamps.
pub fn take_off(case: &mut DiagnosisInput) {
    let of_cell = |r: &NamedRecording| r.recorded.inputs.cell.is_some();
    if case.nominal.parts != DeviceParts::Whole || case.recordings.iter().any(of_cell) {
        return;
    }
    let steps: [fn(&DiagnosisInput) -> Vec<DataFault>; 11] = [
        copied::copies,
        run::frozen,
        run::held,
        gain::gains,
        zero::absolute,
        clock::of_log_by_rate,
        zero::at_start,
        jump::jumps,
        drift::drifts,
        channel_clock::of_channels,
        clock::of_log_by_motion,
    ];
    for find in steps {
        let faults = find(case);
        match clock_of_all(case, &faults) {
            Some(scale) => {
                (case.recordings.iter_mut()).for_each(|r| by_other_clock(r, scale));
                // What is to be predicted keeps its commands: a prediction is made at their stamps.
                let unseen = case.unseen.iter_mut();
                unseen.for_each(|r| faults.iter().for_each(|fault| correct_one(r, fault)));
            }
            None => faults.iter().for_each(|fault| correct(case, fault)),
        }
        case.data_faults.extend(faults);
    }
    let loud = noise::louder(case);
    case.data_faults.extend(loud);
}

/// Scale of the clock by which all that was measured is stamped; none where some of it is stamped by that of the commands.
fn clock_of_all(case: &DiagnosisInput, faults: &[DataFault]) -> Option<f64> {
    let scale = |channel: Channel| {
        let of = |fault: &DataFault| match fault.kind {
            Kind::ClockScale(scale) if fault.channel == Some(channel) => Some(scale),
            _ => None,
        };
        faults.iter().find_map(of)
    };
    let measured = |channel: &Channel| {
        let mut recordings = case.recordings.iter();
        recordings.any(|r| {
            r.recorded.readings[*channel as usize]
                .iter()
                .any(|v| v.is_finite())
        })
    };
    let mut scales = CHANNELS.into_iter().filter(measured).map(scale);
    let first = scales.next()??;
    scales.all(|other| other == Some(first)).then_some(first)
}

/// Stamps a recording by when its readings were taken, with the commands of that time: no reading is made another. A command that changes between two of them gets a
/// sample of its own, without readings.
fn by_other_clock(recording: &mut NamedRecording, scale: f64) {
    let inputs = &mut recording.recorded.inputs;
    let stamps = inputs.time.clone();
    let start = stamps[0];
    let command = |i: usize| (inputs.set_pressure[i], inputs.extends[i]);
    let taken = |i: usize| start + (stamps[i] - start) / scale;
    // Time of each sample, and the row of its readings.
    let mut samples: Vec<(f64, Option<usize>)> =
        (0..stamps.len()).map(|i| (taken(i), Some(i))).collect();
    let changes = (1..stamps.len()).filter(|i| command(*i) != command(i - 1));
    samples.extend(changes.map(|i| (stamps[i], None)));
    samples.sort_by(|a, b| a.0.total_cmp(&b.0));
    samples.dedup_by(|later, earlier| later.0 - earlier.0 < 1e-9 && later.1.is_none());
    let last = stamps.len() - 1;
    // A command holds until the next.
    let row = |t: f64| {
        stamps
            .partition_point(|stamp| *stamp <= t)
            .clamp(1, last + 1)
            - 1
    };
    let rows: Vec<usize> = samples.iter().map(|(t, _)| row(*t)).collect();
    inputs.set_pressure = rows.iter().map(|i| inputs.set_pressure[*i]).collect();
    inputs.extends = rows.iter().map(|i| inputs.extends[*i]).collect();
    let surface = &inputs.surface;
    let place = |t: f64| {
        let next = row(t).min(last.saturating_sub(1)) + 1;
        let share = ((t - stamps[next - 1]) / (stamps[next] - stamps[next - 1])).min(1.0);
        surface[next - 1] + share * (surface[next] - surface[next - 1])
    };
    inputs.surface = samples.iter().map(|(t, _)| place(*t)).collect();
    for values in &mut recording.recorded.readings {
        set_impacts_aside(values);
        let of = |(_, row): &(f64, Option<usize>)| row.map_or(f64::NAN, |i| values[i]);
        *values = samples.iter().map(of).collect();
    }
    inputs.time = samples.into_iter().map(|(t, _)| t).collect();
}

/// Takes a fault off all recordings that it acts in.
fn correct(case: &mut DiagnosisInput, fault: &DataFault) {
    let in_it = |r: &NamedRecording| fault.recording.as_ref().is_none_or(|name| *name == r.name);
    for recording in case.recordings.iter_mut().filter(|r| in_it(r)) {
        correct_one(recording, fault);
    }
    if let Some(unseen) = case
        .unseen
        .as_mut()
        .filter(|_| fault.stays && fault.recording.is_none())
    {
        correct_one(unseen, fault);
    }
}

fn correct_one(recording: &mut NamedRecording, fault: &DataFault) {
    let inputs = &mut recording.recorded.inputs;
    let readings = &mut recording.recorded.readings;
    let Some(channel) = fault.channel else {
        if let Kind::ClockScale(scale) = fault.kind {
            let start = inputs.time[0];
            for time in &mut inputs.time {
                *time = start + (*time - start) / scale;
            }
        }
        return;
    };
    let values = &mut readings[channel as usize];
    match fault.kind {
        Kind::ZeroOffset(zero) => values.iter_mut().for_each(|value| *value -= zero),
        Kind::ZeroJump(zero, from) => {
            for (value, time) in values.iter_mut().zip(&inputs.time) {
                if *time >= from {
                    *value -= zero;
                }
            }
        }
        Kind::Gain(gain) => values.iter_mut().for_each(|value| *value /= gain),
        Kind::Held(_) => run::keep_firsts(values),
        Kind::Drift(drift) => {
            for (value, time) in values.iter_mut().zip(&inputs.time) {
                *value -= drift * (time - inputs.time[0]);
            }
        }
        Kind::Frozen([start, end]) | Kind::Copied([start, end], _) => {
            for (value, time) in values.iter_mut().zip(&inputs.time) {
                if *time > start && *time < end {
                    *value = f64::NAN;
                }
            }
        }
        Kind::ClockScale(scale) => {
            let start = inputs.time[0];
            *values = interpolated(&inputs.time, values, |t| start + scale * (t - start));
        }
        Kind::ClockOffset(offset) => {
            *values = interpolated(&inputs.time, values, |t| t + offset);
        }
        Kind::Noise(_) => {}
    }
    let [pressure, stroke] =
        [Channel::RegulatorPressure, Channel::Stroke].map(|channel| &readings[channel as usize]);
    inputs.initial = InitialState::of(&inputs.time, pressure, stroke);
}

/// Simulated readings as sensors with these faults read them, and the stamps of their log [s].
#[must_use]
pub fn as_read(
    faults: &[DataFault],
    time: &[f64],
    mut readings: [Vec<f64>; 4],
) -> (Vec<f64>, [Vec<f64>; 4]) {
    let start = time[0];
    let mut stamps = time.to_vec();
    let lasting = || faults.iter().filter(|fault| fault.stays);
    let of_log = lasting().filter(|fault| fault.channel.is_none());
    for fault in of_log {
        if let Kind::ClockScale(scale) = fault.kind {
            for stamp in &mut stamps {
                *stamp = start + (*stamp - start) * scale;
            }
        }
    }
    for (index, values) in readings.iter_mut().enumerate() {
        // In the order of the signal's way: time, hold, gain, zero.
        let own = || lasting().filter(|f| f.channel.is_some_and(|c| c as usize == index));
        let (mut scale, mut offset) = (1.0, 0.0);
        let (mut gain, mut zero) = (1.0, 0.0);
        let mut periods: Vec<f64> = Vec::new();
        for fault in own() {
            match fault.kind {
                Kind::ClockScale(value) => scale *= value,
                Kind::ClockOffset(value) => offset += value,
                Kind::Gain(value) => gain *= value,
                Kind::ZeroOffset(value) => zero += value,
                Kind::Held(period) => periods.push(period),
                _ => {}
            }
        }
        let period = median(periods);
        if scale != 1.0 || offset != 0.0 || period.is_some() {
            let at = |t: f64| {
                let sampled = period.map_or(t, |period| held(t - start, period) + start);
                start + (sampled - offset - start) / scale
            };
            *values = read_at(time, values, at);
        }
        for value in values.iter_mut() {
            *value = gain * *value + zero;
        }
    }
    (stamps, readings)
}

#[cfg(test)]
mod tests;
