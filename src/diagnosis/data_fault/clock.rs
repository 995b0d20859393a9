//! Clocks: of a whole log, of one logger, of a channel.
//!
//! ```text
//! whole log:   d2 x / d stamp2 = a / s^2                         s stamp over true time, x stroke, a acceleration
//! a channel:   reading(stamp) = signal((stamp - offset) / s)     signal of the believed model
//! ```

use super::super::input::{DiagnosisInput, NamedRecording};
use super::resample::read_at;
use super::{DataFault, Kind};
use crate::plant::registry::{REGULATOR_DEAD_TIME, REGULATOR_TIME_CONSTANT};
use crate::plant::{Channel, simulate};

/// Length of a stretch over which an acceleration is integrated twice [s].
const STRETCH: f64 = 0.1;
/// Readings of it at least.
const LEAST: usize = 16;
/// Root mean square of the motion in a stretch, lines apart, from which it tells [standard deviations of the stroke's noise].
const MOVED: f64 = 12.0;
/// What it may leave, in the same.
const LEFT: f64 = 3.0;
/// Change of the acceleration from sample to sample that is an impact, which its samples do not hold [m/s2].
const IMPACT: f64 = 15.0;
/// Stretches that are needed.
const LEAST_STRETCHES: usize = 8;
/// Departure of a clock from true time that is worth a word [1].
const WORTH: f64 = 0.004;
/// Rates farther apart than this are other rates, not clocks [1].
const FARTHEST: f64 = 0.15;

/// Measured acceleration over the second derivative of the stroke by the stamps [1], and its standard error; none where the recordings do not tell.
pub(super) fn curvature_ratio(case: &DiagnosisInput) -> Option<(f64, f64)> {
    let noise = case.noise[Channel::Stroke as usize];
    let mut told: Vec<(f64, f64)> = Vec::new();
    for recording in &case.recordings {
        told.extend(curvatures(recording, noise, |t| t));
    }
    pooled(&told)
}

/// Ratio of stretches, by their weights.
fn pooled(told: &[(f64, f64)]) -> Option<(f64, f64)> {
    if told.len() < LEAST_STRETCHES {
        return None;
    }
    let mut sorted = told.to_vec();
    sorted.sort_by(|a, b| a.0.total_cmp(&b.0));
    let half: f64 = sorted.iter().map(|(_, w)| w).sum::<f64>() / 2.0;
    let mut sum = 0.0;
    let median = sorted.iter().find(|(_, w)| {
        sum += w;
        sum >= half
    })?;
    let whole = 2.0 * half;
    let scatter = |(g, w): &(f64, f64)| w * (g - median.0).abs();
    let deviation = 1.2533 * sorted.iter().map(scatter).sum::<f64>() / whole;
    let squares: f64 = sorted.iter().map(|(_, w)| w * w).sum();
    let error = 1.2533 * deviation * squares.sqrt() / whole;
    Some((1.0 / median.0, error / median.0.powi(2)))
}

/// Second derivative of the stroke over acceleration in each stretch that tells, with its weight; the acceleration is read at other stamps.
fn curvatures(recording: &NamedRecording, noise: f64, at: impl Fn(f64) -> f64) -> Vec<(f64, f64)> {
    let time = &recording.recorded.inputs.time;
    let readings = &recording.recorded.readings;
    let stroke = &readings[Channel::Stroke as usize];
    let acceleration = read_at(time, &readings[Channel::Acceleration as usize], at);
    let step = (time[time.len() - 1] - time[0]) / (time.len() - 1) as f64;
    let width = ((STRETCH / step) as usize).max(LEAST);
    let mut told = Vec::new();
    let mut from = 0;
    while from + width <= time.len() {
        let span = from..from + width;
        if let Some(found) = curvature(
            &time[span.clone()],
            &stroke[span.clone()],
            &acceleration[span],
            noise,
        ) {
            told.push(found);
        }
        from += width / 2;
    }
    told
}

/// Slope of a stroke on its acceleration twice integrated, lines apart, and its weight.
fn curvature(time: &[f64], stroke: &[f64], acceleration: &[f64], noise: f64) -> Option<(f64, f64)> {
    let whole = stroke.iter().filter(|v| v.is_finite()).count();
    let smooth = acceleration
        .windows(2)
        .all(|pair| (pair[1] - pair[0]).abs() < IMPACT);
    if 2 * whole < time.len() || whole < 6 || !smooth {
        return None;
    }
    let mut way = vec![0.0];
    let (mut position, mut speed) = (0.0, 0.0);
    for i in 1..time.len() {
        let h = time[i] - time[i - 1];
        position += h * (speed + h * (2.0 * acceleration[i - 1] + acceleration[i]) / 6.0);
        speed += 0.5 * h * (acceleration[i - 1] + acceleration[i]);
        way.push(position);
    }
    let known: Vec<usize> = (0..time.len()).filter(|i| stroke[*i].is_finite()).collect();
    let of = |values: &[f64]| -> Vec<f64> { known.iter().map(|i| values[*i]).collect() };
    let time = of(time);
    let (way, stroke) = (
        without_line(&time, &of(&way)),
        without_line(&time, &of(stroke)),
    );
    let own: f64 = way.iter().map(|w| w * w).sum();
    let both: f64 = way.iter().zip(&stroke).map(|(w, x)| w * x).sum();
    let slope = both / own;
    let count = known.len() as f64;
    let moved = (own / count).sqrt();
    let left = way
        .iter()
        .zip(&stroke)
        .map(|(w, x)| (x - slope * w).powi(2));
    let left = (left.sum::<f64>() / count).sqrt();
    // In another unit the noise is too: what is left is held against the motion as well.
    let size = (stroke.iter().map(|x| x * x).sum::<f64>() / count).sqrt();
    let tells = size > MOVED * noise && left < (LEFT * noise).max(0.02 * size) && moved > 0.0;
    tells.then_some((slope, own * slope * slope))
}

fn without_line(time: &[f64], values: &[f64]) -> Vec<f64> {
    let count = time.len() as f64;
    let middle = time.iter().sum::<f64>() / count;
    let mean = values.iter().sum::<f64>() / count;
    let spread: f64 = time.iter().map(|t| (t - middle).powi(2)).sum();
    let rise: f64 = time
        .iter()
        .zip(values)
        .map(|(t, v)| (t - middle) * (v - mean))
        .sum();
    let pairs = time.iter().zip(values);
    pairs
        .map(|(t, v)| v - mean - rise / spread * (t - middle))
        .collect()
}

/// Mean step of the stamps, gaps apart [s].
fn step(time: &[f64]) -> f64 {
    let mut steps: Vec<f64> = time.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let middle = steps.len() / 2;
    let usual = *steps.select_nth_unstable_by(middle, f64::total_cmp).1;
    let known: Vec<f64> = steps.into_iter().filter(|h| *h < 1.5 * usual).collect();
    known.iter().sum::<f64>() / known.len() as f64
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
    /// Spread of the surface that tells a gain [m].
    const SPREAD: f64 = 1.5e-3;
    (mean[2] > 50.0 && (own / mean[2]).sqrt() > SPREAD).then(|| both / own)
}

/// Samples that are compared, at most, of each recording and channel.
const SAMPLES: usize = 900;
/// Offsets that are tried [s].
const OFFSETS: [f64; 2] = [-0.12, 0.2];
/// Scales that are tried [1].
const SCALES: f64 = 0.03;
/// Where the loss turns to a logarithm, in standard deviations of the noise and of the model [1].
const BOUND: f64 = 3.0;
/// What the believed model is off by within its tolerances in stroke and force, in standard deviations of their noise [1].
const OF_MODEL: f64 = 8.0;
/// Share of its cost that a clock must take from a channel [1].
const TAKEN: f64 = 0.3;
/// The same in each recording.
const TAKEN_OF_EACH: f64 = 0.1;
/// Offset that a channel must have beyond the others [s].
const LEAST_OFFSET: f64 = 0.012;
/// Shares of the believed time constant of the regulator that are tried, for it delays too [1].
const TIME_CONSTANTS: [f64; 5] = [0.85, 0.93, 1.0, 1.08, 1.18];

/// A channel beside what the believed model gives.
struct Pair<'a> {
    time: &'a [f64],
    measured: &'a [f64],
    simulated: &'a [f64],
    noise: f64,
}

impl Pair<'_> {
    /// Loss of the channel with a clock.
    fn cost(&self, scale: f64, offset: f64) -> f64 {
        let start = self.time[0];
        let stride = (self.time.len() / SAMPLES).max(1);
        let last = self.time.len() - 1;
        let mut cost = 0.0;
        let mut next = 1;
        for i in (0..self.time.len()).step_by(stride) {
            if !self.measured[i].is_finite() {
                continue;
            }
            let u = start + (self.time[i] - start - offset) / scale;
            let value = if u <= start {
                self.simulated[0]
            } else if u >= self.time[last] {
                self.simulated[last]
            } else {
                while self.time[next] < u {
                    next += 1;
                }
                while next > 1 && self.time[next - 1] > u {
                    next -= 1;
                }
                let share = (u - self.time[next - 1]) / (self.time[next] - self.time[next - 1]);
                self.simulated[next - 1] + share * (self.simulated[next] - self.simulated[next - 1])
            };
            let size = (self.measured[i] - value) / (BOUND * self.noise);
            cost += (size * size).ln_1p();
        }
        cost
    }
}

/// A clock of a channel as it fits best, with and without a scale.
struct Fitted {
    channel: Channel,
    scale: f64,
    /// Share of the cost that the scale takes from the best offset, in all and in the recording where it takes least [1].
    taken: [f64; 2],
    /// Best offset alone [s], and the share of the cost that it takes [1].
    alone: f64,
    taken_alone: f64,
}

/// Clocks of one logger, of which some or all channels are, and offsets of single channels.
pub(super) fn of_channels(case: &DiagnosisInput) -> Vec<DataFault> {
    let simulated: Vec<Vec<[Vec<f64>; 4]>> = (TIME_CONSTANTS.iter())
        .map(|share| {
            let mut plant = case.believed.clone();
            let quantity = REGULATOR_TIME_CONSTANT.quantity();
            quantity.set(&mut plant, share * quantity.get(&case.believed));
            let of = |r: &NamedRecording| simulate(&plant, &r.recorded.inputs).readings;
            case.recordings.iter().map(of).collect()
        })
        .collect();
    let channels = [Channel::RegulatorPressure, Channel::Stroke, Channel::Force];
    let fitted: Vec<Fitted> = (channels.iter())
        .filter_map(|channel| fitted(case, &simulated, *channel))
        .collect();
    let logger = of_logger(case, &fitted);
    if !logger.is_empty() {
        return logger;
    }
    let mut faults = late_pressure(case, &fitted);
    faults.extend(late_motion(case, &fitted));
    faults
}

fn fitted(
    case: &DiagnosisInput,
    simulated: &[Vec<[Vec<f64>; 4]>],
    channel: Channel,
) -> Option<Fitted> {
    let index = channel as usize;
    let noise = case.noise[index];
    let measured = |r: &NamedRecording| r.recorded.readings[index].iter().any(|v| v.is_finite());
    if !noise.is_finite() || !case.recordings.iter().all(measured) {
        return None;
    }
    // What the believed model is off by within its tolerances is no matter of time.
    let noise = match channel {
        Channel::RegulatorPressure => 3.0 * noise,
        _ => OF_MODEL * noise,
    };
    let mut best: Option<(f64, Fitted)> = None;
    for of_all in simulated {
        if of_all
            .iter()
            .any(|of| of[index].iter().any(|v| !v.is_finite()))
        {
            continue;
        }
        let pairs: Vec<Pair<'_>> = (case.recordings.iter().zip(of_all))
            .map(|(r, of)| Pair {
                time: &r.recorded.inputs.time,
                measured: &r.recorded.readings[index],
                simulated: &of[index],
                noise,
            })
            .collect();
        let cost = |scale: f64, offset: f64| -> f64 {
            pairs.iter().map(|pair| pair.cost(scale, offset)).sum()
        };
        let (alone, cost_alone) = least(|o| cost(1.0, o), OFFSETS, 65);
        let none = cost(1.0, 0.0);
        let (scale, _) = least(|s| cost(s, 0.0), [1.0 - SCALES, 1.0 + SCALES], 61);
        let (offset, cost_both) = least(|o| cost(scale, o), [-0.03, 0.08], 23);
        let (scale, cost_both) =
            match least(|s| cost(s, offset), [scale - 0.003, scale + 0.003], 13) {
                (s, c) if c < cost_both => (s, c),
                _ => (scale, cost_both),
            };
        let share = |before: f64, after: f64| 1.0 - after / before.max(1e-9);
        let each = pairs
            .iter()
            .map(|p| share(p.cost(1.0, alone), p.cost(scale, offset)));
        let found = Fitted {
            channel,
            scale,
            taken: [
                share(cost_alone, cost_both),
                each.fold(f64::INFINITY, f64::min),
            ],
            alone,
            taken_alone: share(none, cost_alone),
        };
        let least_cost = cost_both.min(cost_alone);
        if best.as_ref().is_none_or(|(known, _)| least_cost < *known) {
            best = Some((least_cost, found));
        }
    }
    best.map(|(_, fitted)| fitted)
}

/// Least value of a function over an interval: of a grid, then about its best place.
fn least(of: impl Fn(f64) -> f64, [low, high]: [f64; 2], count: usize) -> (f64, f64) {
    let step = (high - low) / (count - 1) as f64;
    let at = |i: usize| low + step * i as f64;
    let costs: Vec<f64> = (0..count).map(|i| of(at(i))).collect();
    let best = (0..count)
        .min_by(|a, b| costs[*a].total_cmp(&costs[*b]))
        .unwrap_or(0);
    let (mut place, mut cost) = (at(best), costs[best]);
    let mut step = step;
    for _ in 0..6 {
        step *= 0.5;
        for tried in [place - step, place + step] {
            let c = of(tried);
            if c < cost {
                (place, cost) = (tried, c);
            }
        }
    }
    (place, cost)
}

/// Channels whose lag grows with time, all by the same scale: those of one logger.
fn of_logger(case: &DiagnosisInput, fitted: &[Fitted]) -> Vec<DataFault> {
    let grows = |f: &&Fitted| {
        (f.scale - 1.0).abs() > 0.5 * WORTH && f.taken[0] > TAKEN && f.taken[1] > TAKEN_OF_EACH
    };
    let those: Vec<&Fitted> = fitted.iter().filter(grows).collect();
    let Some(first) = those.first() else {
        return Vec::new();
    };
    let mut scales: Vec<f64> = those.iter().map(|f| f.scale).collect();
    scales.sort_by(f64::total_cmp);
    let scale = scales[scales.len() / 2];
    // Physics makes lags too, and never by the same share of the time in all channels.
    let alike = scales
        .iter()
        .all(|s| (s - scale).abs() < 0.25 * (scale - 1.0).abs());
    if !alike || first.scale == 1.0 {
        return Vec::new();
    }
    let mut channels: Vec<Channel> = those.iter().map(|f| f.channel).collect();
    if acceleration_goes_with_stroke(case, scale) == channels.contains(&Channel::Stroke) {
        channels.push(Channel::Acceleration);
    }
    (channels.into_iter())
        .map(|channel| DataFault::of(Kind::ClockScale(scale), channel, None, 0.98))
        .collect()
}

/// Whether the accelerometer is stamped by the clock of the stroke, not by one of another scale.
fn acceleration_goes_with_stroke(case: &DiagnosisInput, scale: f64) -> bool {
    let noise = case.noise[Channel::Stroke as usize];
    let told = |by: f64| {
        let of = |r: &NamedRecording| {
            let start = r.recorded.inputs.time[0];
            curvatures(r, noise, |t| start + (t - start) * by).len()
        };
        case.recordings.iter().map(of).sum::<usize>()
    };
    told(1.0) >= told(scale).max(told(1.0 / scale))
}

/// An outlet that is stamped late or early, unless the regulator is late: then what it drives is late too.
fn late_pressure(case: &DiagnosisInput, fitted: &[Fitted]) -> Vec<DataFault> {
    let channel = Channel::RegulatorPressure;
    let late = fitted.iter().find(|f| f.channel == channel);
    let Some(late) = late.filter(|f| f.alone.abs() > LEAST_OFFSET && f.taken_alone > TAKEN) else {
        return Vec::new();
    };
    let cost = |dead_time: f64| -> f64 {
        let mut plant = case.believed.clone();
        let quantity = REGULATOR_DEAD_TIME.quantity();
        quantity.set(&mut plant, quantity.get(&case.believed) + dead_time);
        let of = |r: &NamedRecording| -> f64 {
            let simulated = simulate(&plant, &r.recorded.inputs).readings;
            [Channel::Stroke, Channel::Force]
                .into_iter()
                .filter(|c| case.noise[*c as usize].is_finite())
                .map(|c| {
                    let index = c as usize;
                    Pair {
                        time: &r.recorded.inputs.time,
                        measured: &r.recorded.readings[index],
                        simulated: &simulated[index],
                        noise: OF_MODEL * case.noise[index],
                    }
                    .cost(1.0, 0.0)
                })
                .sum()
        };
        case.recordings.iter().map(of).sum()
    };
    if late.alone > 0.0 && cost(late.alone) < cost(0.0) {
        return Vec::new();
    }
    vec![DataFault::of(
        Kind::ClockOffset(late.alone),
        channel,
        None,
        0.95,
    )]
}

/// Steps by which a lag of the stroke behind the acceleration is sought [s], and how many on either side.
const LAG: (f64, i32) = (0.002, 60);
/// Times that what the stretches tell at a lag must be what they tell at none [1].
const TELLS_MORE: f64 = 1.6;

/// A stroke or an acceleration that is stamped late: they tell of one motion, and the surface that the tool follows says which of them is in time.
fn late_motion(case: &DiagnosisInput, fitted: &[Fitted]) -> Vec<DataFault> {
    let noise = case.noise[Channel::Stroke as usize];
    // A wrong lag passes where there is little motion.
    let told = |lag: f64| -> (usize, f64) {
        let all = case.recordings.iter();
        let all = all.flat_map(|r| curvatures(r, noise, |t| t - lag));
        all.fold((0, 0.0), |(count, sum), (_, weight)| {
            (count + 1, sum + weight)
        })
    };
    let (_, none) = told(0.0);
    let lags = (-LAG.1..=LAG.1).map(|step| LAG.0 * f64::from(step));
    let best = lags
        .map(|lag| (lag, told(lag)))
        .max_by(|a, b| a.1.1.total_cmp(&b.1.1));
    let stroke = fitted.iter().find(|f| f.channel == Channel::Stroke);
    let (Some((lag, (count, most))), Some(stroke)) = (best, stroke) else {
        return Vec::new();
    };
    if lag.abs() < LEAST_OFFSET || count < LEAST_STRETCHES || most < TELLS_MORE * none {
        return Vec::new();
    }
    let of = |channel: Channel, offset: f64| {
        vec![DataFault::of(
            Kind::ClockOffset(offset),
            channel,
            None,
            0.95,
        )]
    };
    if (stroke.alone - lag).abs() < 0.4 * lag.abs() {
        of(Channel::Stroke, lag)
    } else if stroke.alone.abs() < 0.4 * lag.abs() {
        of(Channel::Acceleration, -lag)
    } else {
        Vec::new()
    }
}
