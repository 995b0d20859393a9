//! Zeros that jump: a step from one sample to the next that the motion denies.

use super::fault::{DataFault, Kind};
use super::free_air::in_the_air;
use super::line::Line;
use crate::diagnosis::recordings::input::{DiagnosisInput, NamedRecording};
use crate::plant::Channel;
use nalgebra::{DMatrix, DVector};

/// Readings on either side of a step.
const NARROW: usize = 10;
/// Wider ones, which must say the same: what is steep for a moment only is none.
const WIDE: [usize; 2] = [20, 40];
/// Standard deviations of a step, by the narrow lines, from which it is none of noise, of some ten thousand places that are looked at [1].
const SURE: f64 = 6.5;
/// Readings on either side from which a size is taken, and degrees of the polynomials beside it.
const SMOOTH: [usize; 7] = [10, 20, 40, 80, 160, 320, 640];
const DEGREES: [usize; 3] = [1, 2, 3];
/// Standard deviations of the narrow step by which the wide one may differ [1].
const ALIKE: f64 = 2.5;
/// Readings on either side of the closest look: a steep rise over a few samples is none.
const CLOSE: [usize; 2] = [1, 3];
/// Standard deviations by which a closer look may differ [1].
const CLOSE_ALIKE: f64 = 3.2;
/// White noise integrated twice: root mean square beside a line, and standard deviation of the step between two lines, over step squared, noise and root of the cube of
/// the number of readings [1]; from 400 draws of 10 to 40 readings.
const WALK: [f64; 2] = [0.05, 0.14];
/// Time after a command within which air and contact move fast [s], and how much surer a step must be there [1].
const AFTER_COMMAND: (f64, f64) = (0.15, 1.6);
/// Standard deviations by which the root mean square beside a line may exceed the noise for there to be a line [1]: of n readings it scatters by 1 / sqrt(2 (n - 2)).
const ON_LINE: f64 = 2.6;
/// Times that a step must be what either line moves by from sample to sample [1].
const STEEPER: f64 = 2.5;
/// The same of what their slopes differ by: a bend between two samples is no step [1].
const BENT: f64 = 4.0;
/// Samples within which there is one step.
const NEAR: usize = 20;
/// Share of the step that the acceleration may show as a force [1].
const UNSEEN: f64 = 0.3;
/// Jumps of a channel in a recording at most.
const MOST: usize = 3;
/// Readings without contact that say a level.
const LEAST_FREE: usize = 30;

/// A step at a sample.
#[derive(Clone, Copy)]
struct StepAt {
    index: usize,
    size: f64,
    /// In its standard deviations [1].
    sigmas: f64,
}

/// Steps in the zeros of stroke, force and pressure.
pub(super) fn jumps(case: &DiagnosisInput) -> Vec<DataFault> {
    let mut faults = Vec::new();
    let channels = [Channel::Force, Channel::Stroke, Channel::RegulatorPressure];
    for recording in &case.recordings {
        for channel in channels {
            for (time, size) in of_channel(case, recording, channel) {
                let name = Some(recording.name.as_str());
                faults.push(DataFault::of(
                    Kind::ZeroJump(size, time),
                    channel,
                    name,
                    0.99,
                ));
            }
        }
    }
    faults
}

/// Stamps and sizes of the jumps of a channel.
fn of_channel(
    case: &DiagnosisInput,
    recording: &NamedRecording,
    channel: Channel,
) -> Vec<(f64, f64)> {
    let time = &recording.recorded.inputs.time;
    let readings = &recording.recorded.readings;
    let noise = case.noise[channel as usize];
    let values = readings[channel as usize].clone();
    if noise.is_nan() || noise.is_infinite() || values.iter().all(|v| v.is_nan()) {
        return Vec::new();
    }
    let acceleration = &readings[Channel::Acceleration as usize];
    let inputs = &recording.recorded.inputs;
    let commands = inputs.set_pressure.iter().zip(&inputs.extends);
    let commands: Vec<(f64, bool)> = commands.map(|(p, v)| (*p, *v)).collect();
    let motion = (channel == Channel::Stroke).then_some(&acceleration[..]);
    let sight = Sight {
        time,
        values: &values,
        acceleration: motion,
        commands: &commands,
        noise_of_acceleration: match channel {
            Channel::Stroke => case.noise[Channel::Acceleration as usize],
            _ => 0.0,
        },
        noise,
    };
    let mut steps: Vec<StepAt> = (NARROW..time.len().saturating_sub(NARROW))
        .filter_map(|index| sight.step(index))
        .filter(|step| !is_motion(case, recording, channel, step))
        .collect();
    steps.sort_by(|a, b| b.sigmas.total_cmp(&a.sigmas));
    let mut kept: Vec<StepAt> = Vec::new();
    for step in steps {
        if kept.iter().all(|k| k.index.abs_diff(step.index) > NEAR) && kept.len() < MOST {
            kept.push(step);
        }
    }
    if let (&[step], Channel::Force) = (&kept[..], channel)
        && let Some(change) = level_change(recording, &values, step.index)
    {
        let stays = (change - step.size).abs() <= (0.3 * step.size.abs()).max(noise);
        // What goes back is no zero.
        kept = match stays {
            true => vec![StepAt {
                size: change,
                ..step
            }],
            false => Vec::new(),
        };
    }
    let said = |step: StepAt| (time[step.index], step.size);
    kept.into_iter().map(said).collect()
}

/// Readings less the motion that accelerations from the first of them on make, lines apart.
fn without_motion(time: &[f64], values: &[f64], acceleration: &[f64]) -> Vec<f64> {
    let (mut way, mut speed) = (0.0, 0.0);
    let mut left = vec![values[0]];
    for i in 1..time.len() {
        let h = time[i] - time[i - 1];
        let mean = 0.5 * (acceleration[i - 1] + acceleration[i]);
        let mean = if mean.is_finite() { mean } else { 0.0 };
        way += h * speed + 0.5 * h * h * mean;
        speed += h * mean;
        left.push(values[i] - way);
    }
    left
}

/// The examined readings.
struct Sight<'a> {
    time: &'a [f64],
    values: &'a [f64],
    /// Acceleration whose motion is taken out.
    acceleration: Option<&'a [f64]>,
    /// Set pressure [Pa gauge] and position of the valve.
    commands: &'a [(f64, bool)],
    noise: f64,
    /// Noise of the acceleration [m/s2]; nothing where its motion is not taken out.
    noise_of_acceleration: f64,
}

impl Sight<'_> {
    /// What the noise of the acceleration, integrated twice, comes to over so many readings: it grows as the root of the cube of their number.
    fn walk(&self, width: usize, step: f64) -> f64 {
        step * step * self.noise_of_acceleration * (width as f64).powi(3).sqrt()
    }

    /// The step at a sample by narrow lines, its size by the widest that say the same; none where there is none.
    fn step(&self, index: usize) -> Option<StepAt> {
        // A quick look first: most places have no step at all.
        let near = [1, 2, 3].map(|k| self.values[index + k - 1] - self.values[index - k]);
        let near = near.iter().sum::<f64>().abs() / 3.0;
        if near.is_nan() || near < 3.0 * self.noise {
            return None;
        }
        let (narrow, deviation) = self.between_lines(index, NARROW)?;
        let sigmas = narrow.abs() / deviation;
        if !self.is_sudden(index, narrow) {
            return None;
        }
        let alike =
            |(other, own): &(f64, f64)| (other - narrow).abs() < ALIKE * deviation.hypot(*own);
        let mut wide = WIDE.into_iter();
        wide.find_map(|width| self.between_lines(index, width).filter(alike))?;
        // What is left of a zero is left in all that follows: its size is taken from as far as the readings are smooth.
        let smooth = SMOOTH.into_iter().flat_map(|width| {
            DEGREES
                .into_iter()
                .filter_map(move |degree| self.beside_polynomial(index, width, degree))
        });
        let surest = smooth.filter(alike).min_by(|a, b| a.1.total_cmp(&b.1));
        let (size, _) = surest.unwrap_or((narrow, deviation));
        let sure = match self.follows_a_command(index) {
            true => AFTER_COMMAND.1 * SURE,
            false => SURE,
        };
        (sigmas >= sure).then_some(StepAt {
            index,
            size,
            sigmas,
        })
    }

    /// Step at a sample beside a polynomial through the readings on both sides, and its standard deviation; none where they are not smooth.
    fn beside_polynomial(&self, index: usize, width: usize, degree: usize) -> Option<(f64, f64)> {
        if index < width || index + width > self.time.len() {
            return None;
        }
        let span = index - width..index + width;
        let values = &self.values[span.clone()];
        let reach = self.time[span.end - 1] - self.time[span.start];
        let count = 2 * width;
        let numbers = degree + 2;
        let row = |i: usize, column: usize| match column {
            0 => f64::from(u8::from(i >= width)),
            power => ((self.time[span.start + i] - self.time[index]) / reach)
                .powi(i32::try_from(power - 1).unwrap_or(0)),
        };
        let design = DMatrix::from_fn(count, numbers, row);
        let measured = DVector::from_column_slice(values);
        if values.iter().any(|v| !v.is_finite()) {
            return None;
        }
        let inverse = (design.transpose() * &design).try_inverse()?;
        let found = &inverse * design.transpose() * &measured;
        let beside = (&measured - &design * &found).norm_squared();
        let free = (count - numbers) as f64;
        let on_line = 1.0 + ON_LINE / (2.0 * free).sqrt();
        let is_smooth = (beside / free).sqrt() <= on_line * self.noise;
        is_smooth.then(|| (found[0], self.noise * inverse[(0, 0)].sqrt()))
    }

    /// Whether the few readings on either side of a sample show the step too, less what the lines about them move by.
    fn is_sudden(&self, index: usize, size: f64) -> bool {
        let span = index - NARROW..index + NARROW;
        let values = self.values_of(span.clone());
        let time = &self.time[span];
        let Some([left, right]) = lines_beside(time, &values) else {
            return false;
        };
        let step = 0.5 * (left.slope + right.slope) * (time[NARROW] - time[NARROW - 1]);
        CLOSE.into_iter().all(|width| {
            let mean = |part: &[f64]| part.iter().sum::<f64>() / width as f64;
            let apart =
                mean(&values[NARROW..NARROW + width]) - mean(&values[NARROW - width..NARROW]);
            let close = apart - step * width as f64;
            let deviation = self.noise * (2.0 / width as f64).sqrt();
            (close - size).abs() < CLOSE_ALIKE * deviation + 0.1 * size.abs()
        })
    }

    /// Whether a command was given shortly before a sample.
    fn follows_a_command(&self, index: usize) -> bool {
        let since = self.time[index] - AFTER_COMMAND.0;
        let first = self.time.partition_point(|t| *t < since);
        let mut pairs = self.commands[first..=index].windows(2);
        pairs.any(|pair| pair[0] != pair[1])
    }

    /// Readings less the motion that the accelerometer shows, lines apart.
    fn values_of(&self, span: std::ops::Range<usize>) -> Vec<f64> {
        match self.acceleration {
            Some(a) => without_motion(
                &self.time[span.clone()],
                &self.values[span.clone()],
                &a[span],
            ),
            None => self.values[span].to_vec(),
        }
    }

    /// Step between the lines on either side of a sample, and its standard deviation; none where there are no lines, or they move as fast.
    fn between_lines(&self, index: usize, width: usize) -> Option<(f64, f64)> {
        let count = self.time.len();
        if index < width || index + width > count {
            return None;
        }
        let span = index - width..index + width;
        let usual = (self.time[count - 1] - self.time[0]) / (count - 1) as f64;
        let time = &self.time[span.clone()];
        if time[2 * width - 1] - time[0] > 1.3 * 2.0 * width as f64 * usual {
            return None;
        }
        let values = self.values_of(span);
        let middle = 0.5 * (time[width - 1] + time[width]);
        let [left, right] = lines_beside(time, &values)?;
        let size = right.at(middle) - left.at(middle);
        let steep = usual * left.slope.abs().max(right.slope.abs());
        let bent = usual * (right.slope - left.slope).abs();
        let on_line = 1.0 + ON_LINE / (2.0 * (width - 2) as f64).sqrt();
        let walk = self.walk(width, usual);
        let noise = self.noise.hypot(WALK[0] * walk);
        let is_step = left.rms.max(right.rms) <= on_line * noise
            && size.abs() > (STEEPER * steep).max(BENT * bent);
        let own = self.noise * (left.variance_at(middle) + right.variance_at(middle)).sqrt();
        let deviation = own.hypot(WALK[1] * walk);
        is_step.then_some((size, deviation))
    }
}

/// Lines through the first and the second half of readings.
fn lines_beside(time: &[f64], values: &[f64]) -> Option<[Line; 2]> {
    let half = time.len() / 2;
    let points = || time.iter().copied().zip(values.iter().copied());
    Some([
        Line::through(points().take(half))?,
        Line::through(points().skip(half))?,
    ])
}

/// Whether a step may be motion or force: the accelerometer shows what it takes, or there is none to deny it.
fn is_motion(
    case: &DiagnosisInput,
    recording: &NamedRecording,
    channel: Channel,
    step: &StepAt,
) -> bool {
    let time = &recording.recorded.inputs.time;
    let acceleration = &recording.recorded.readings[Channel::Acceleration as usize];
    let noise = case.noise[Channel::Acceleration as usize];
    let i = step.index;
    let h = time[i] - time[i - 1];
    let near = &acceleration[i.saturating_sub(3)..(i + 3).min(time.len())];
    let known: Vec<f64> = near.iter().copied().filter(|a| a.is_finite()).collect();
    match channel {
        Channel::Stroke | Channel::Force if known.is_empty() => true,
        Channel::Stroke => {
            let largest = known.iter().fold(0.0f64, |most, a| most.max(a.abs()));
            largest > (UNSEEN * step.size.abs() / (h * h)).max(4.0 * noise)
        }
        Channel::Force => {
            let mean = |part: &[f64]| {
                let known: Vec<f64> = part.iter().copied().filter(|a| a.is_finite()).collect();
                known.iter().sum::<f64>() / known.len().max(1) as f64
            };
            let side = 6;
            let before = mean(&acceleration[i.saturating_sub(side)..i]);
            let after = mean(&acceleration[i..(i + side).min(time.len())]);
            let limit = UNSEEN * step.size.abs() / case.nominal.device.moving_mass;
            let largest = known.iter().fold(0.0f64, |most, a| most.max(a.abs()));
            (after - before).abs() > limit.max(2.0 * noise)
                || largest > limit.max(5.0 * noise) * 3.0
        }
        _ => false,
    }
}

/// Change of a load cell's level in the air from before a sample to after it; none where either side has no such time.
fn level_change(recording: &NamedRecording, force: &[f64], index: usize) -> Option<f64> {
    let air = in_the_air(recording);
    let level = |side: &[usize]| {
        let sum: f64 = side.iter().map(|i| force[*i]).sum();
        (side.len() >= LEAST_FREE).then(|| sum / side.len() as f64)
    };
    let (before, after) = air.split_at(air.partition_point(|i| *i < index));
    Some(level(after)? - level(before)?)
}
