//! Clocks of channels: those of one logger, of which some or all are, and offsets of single ones.
//!
//! ```text
//! reading(stamp) = signal((stamp - offset) / s)
//! ```
//!
//! signal that of the nominal model, s stamp over true time [1], offset [s].

use super::clock::WORTH;
use super::curvature::{LEAST_STRETCHES, curvatures};
use super::fault::{DataFault, Kind};
use crate::diagnosis::recordings::input::{DiagnosisInput, NamedRecording};
use crate::plant::registry::{REGULATOR_DEAD_TIME, REGULATOR_TIME_CONSTANT};
use crate::plant::{Channel, simulate};
use crate::stats::median;

/// Samples that are compared, at most, of each recording and channel.
const SAMPLES: usize = 900;
/// Offsets that are tried [s].
const OFFSETS: [f64; 2] = [-0.12, 0.2];
/// Scales that are tried [1].
const SCALES: f64 = 0.03;
/// Where the loss turns to a logarithm, in standard deviations of the noise and of the model [1].
const BOUND: f64 = 3.0;
/// What the nominal model is off by within its tolerances in stroke and force, in standard deviations of their noise [1].
const OF_MODEL: f64 = 8.0;
/// Share of its cost that a clock must take from a channel [1].
const TAKEN: f64 = 0.3;
/// The same in each recording.
const TAKEN_OF_EACH: f64 = 0.1;
/// The same in each half of them.
const TAKEN_OF_HALF: f64 = 0.05;
/// Lag that must have grown by the end of the longest recording [s]: less is what a device within its tolerances comes to.
const LEAST_GROWN: f64 = 0.03;
/// Offset that a channel must have beyond the others [s].
const LEAST_OFFSET: f64 = 0.012;
/// Shares of the nominal time constant of the regulator that are tried, for it delays too [1].
const TIME_CONSTANTS: [f64; 5] = [0.85, 0.93, 1.0, 1.08, 1.18];

/// Shares of it between which it is sought where the clock of a logger is measured [1].
const TIME_CONSTANT_SHARES: [f64; 2] = [0.8, 1.25];

/// A channel beside what the nominal model gives.
struct Pair<'a> {
    time: &'a [f64],
    measured: &'a [f64],
    simulated: &'a [f64],
    noise: f64,
}

impl Pair<'_> {
    /// Loss of the channel with a clock.
    fn cost(&self, scale: f64, offset: f64) -> f64 {
        let stride = (self.time.len() / SAMPLES).max(1);
        self.loss(&self.read(scale, offset, stride), 1.0)
    }

    /// The same of either half of the recording.
    fn cost_of_halves(&self, scale: f64, offset: f64) -> [f64; 2] {
        let read = self.read(scale, offset, 1);
        let middle = self.time.len() / 2;
        let measured = self.measured[..middle].iter().filter(|v| v.is_finite());
        let (first, second) = read.split_at(measured.count());
        [self.loss(first, 1.0), self.loss(second, 1.0)]
    }

    /// Readings beside simulated ones at the times of a clock, one of so many.
    fn read(&self, scale: f64, offset: f64, stride: usize) -> Vec<(f64, f64)> {
        let start = self.time[0];
        let last = self.time.len() - 1;
        let mut next = 1;
        let rows = (0..self.time.len()).step_by(stride);
        rows.filter(|i| self.measured[*i].is_finite())
            .map(|i| {
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
                    let [before, after] = [self.simulated[next - 1], self.simulated[next]];
                    let step = self.time[next] - self.time[next - 1];
                    before + (u - self.time[next - 1]) / step * (after - before)
                };
                (self.measured[i], value)
            })
            .collect()
    }

    /// Loss of readings against simulated ones times a gain.
    fn loss(&self, pairs: &[(f64, f64)], gain: f64) -> f64 {
        let of = |(measured, value): &(f64, f64)| {
            let size = (measured - gain * value) / (BOUND * self.noise);
            (size * size).ln_1p()
        };
        pairs.iter().map(of).sum()
    }
}

/// Loss of all recordings with a clock, at the gain that fits best: a sensor's or a regulator's is no matter of time.
fn cost_at_best_gain(pairs: &[Pair<'_>], scale: f64, offset: f64) -> f64 {
    let read: Vec<_> = pairs
        .iter()
        .map(|pair| pair.read(scale, offset, 1))
        .collect();
    let (both, own) = (read.iter().flatten()).fold((0.0, 0.0), |(both, own), (m, v)| {
        (both + m * v, own + v * v)
    });
    let gain = if own > 0.0 { both / own } else { 1.0 };
    let all = pairs.iter().zip(&read);
    all.map(|(pair, read)| pair.loss(read, gain)).sum()
}

/// A clock of a channel as it fits best, with and without a scale.
struct Fitted {
    channel: Channel,
    scale: f64,
    /// Share of the cost that the scale takes from the best offset, in all and in the recording where it takes least [1].
    taken: [f64; 2],
    /// The same in the halves of the recordings, where it takes less: what came late once is late in one of them.
    taken_of_half: f64,
    /// By how much it is late or early at the end of the longest recording [s].
    grown: f64,
    /// Best offset alone [s], and the share of the cost that it takes [1].
    alone: f64,
    taken_alone: f64,
}

/// Clocks of one logger, of which some or all channels are, and offsets of single channels.
pub(super) fn of_channels(case: &DiagnosisInput) -> Vec<DataFault> {
    let simulated: Vec<Vec<[Vec<f64>; 4]>> = (TIME_CONSTANTS.iter())
        .map(|share| {
            let mut plant = case.nominal.clone();
            let quantity = REGULATOR_TIME_CONSTANT.quantity();
            quantity.set(&mut plant, share * quantity.get(&case.nominal));
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
    // What the nominal model is off by within its tolerances is no matter of time.
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
        let halves = |scale: f64, offset: f64| {
            let all = pairs.iter().map(|p| p.cost_of_halves(scale, offset));
            all.fold([0.0; 2], |[a, b], [first, second]| [a + first, b + second])
        };
        let (before, after) = (halves(1.0, alone), halves(scale, offset));
        let longest = pairs.iter().map(|p| p.time[p.time.len() - 1] - p.time[0]);
        let found = Fitted {
            channel,
            scale,
            taken_of_half: share(before[0], after[0]).min(share(before[1], after[1])),
            grown: (scale - 1.0).abs() * longest.fold(0.0, f64::max),
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
        (f.scale - 1.0).abs() > 0.5 * WORTH
            && f.grown > LEAST_GROWN
            && f.taken[0] > TAKEN
            && f.taken[1] > TAKEN_OF_EACH
            && f.taken_of_half > TAKEN_OF_HALF
    };
    let those: Vec<&Fitted> = fitted.iter().filter(grows).collect();
    let Some(first) = those.first() else {
        return Vec::new();
    };
    let scales: Vec<f64> = those.iter().map(|f| f.scale).collect();
    let scale = median(scales.iter().copied()).unwrap_or(first.scale);
    // Physics makes lags too, and never by the same share of the time in all channels.
    let alike = scales
        .iter()
        .all(|s| (s - scale).abs() < 0.25 * (scale - 1.0).abs());
    if !alike || first.scale == 1.0 {
        return Vec::new();
    }
    // What the nominal model explains worse goes with them where its own scale is theirs.
    let goes =
        |f: &&Fitted| f.taken[0] > 0.0 && (f.scale - scale).abs() < 0.25 * (scale - 1.0).abs();
    let mut channels: Vec<Channel> = (fitted.iter().filter(goes)).map(|f| f.channel).collect();
    if acceleration_goes_with_stroke(case, scale) == channels.contains(&Channel::Stroke) {
        channels.push(Channel::Acceleration);
    }
    let scale = match channels.contains(&Channel::RegulatorPressure) {
        true => by_pressure(case, scale),
        false => scale,
    };
    (channels.into_iter())
        .map(|channel| DataFault::of(Kind::ClockScale(scale), channel, None, 0.98))
        .collect()
}

/// The scale of a clock by the outlet, of which the commands alone say when it moves: fitted with time constant and delay of the regulator.
fn by_pressure(case: &DiagnosisInput, scale: f64) -> f64 {
    let index = Channel::RegulatorPressure as usize;
    let quantity = REGULATOR_TIME_CONSTANT.quantity();
    let nominal = quantity.get(&case.nominal);
    let fitted = |share: f64| -> (f64, f64) {
        let mut plant = case.nominal.clone();
        quantity.set(&mut plant, share * nominal);
        let simulated: Vec<_> = (case.recordings.iter())
            .map(|r| simulate(&plant, &r.recorded.inputs).readings)
            .collect();
        let pairs: Vec<Pair<'_>> = (case.recordings.iter().zip(&simulated))
            .map(|(r, of)| Pair {
                time: &r.recorded.inputs.time,
                measured: &r.recorded.readings[index],
                simulated: &of[index],
                noise: case.noise[index],
            })
            .collect();
        let cost = |scale: f64, offset: f64| cost_at_best_gain(&pairs, scale, offset);
        let (mut scale, mut offset, mut least_cost) = (scale, 0.0, f64::INFINITY);
        for width in [4e-3, 1e-3, 3e-4, 1e-4] {
            (offset, _) = least(
                |o| cost(scale, o),
                [offset - 5.0 * width, offset + 5.0 * width],
                11,
            );
            (scale, least_cost) = least(|s| cost(s, offset), [scale - width, scale + width], 11);
        }
        (scale, least_cost)
    };
    let (share, _) = least(|share| fitted(share).1, TIME_CONSTANT_SHARES, 5);
    fitted(share).0
}

/// Whether the accelerometer is stamped by the clock of the stroke, not by one of another scale.
fn acceleration_goes_with_stroke(case: &DiagnosisInput, scale: f64) -> bool {
    let noise = case.noise[Channel::Stroke as usize];
    let weighed = |by: f64| {
        let of = |r: &NamedRecording| {
            let start = r.recorded.inputs.time[0];
            curvatures(r, noise, |t| start + (t - start) * by).len()
        };
        case.recordings.iter().map(of).sum::<usize>()
    };
    weighed(1.0) >= weighed(scale).max(weighed(1.0 / scale))
}

/// An outlet that is stamped late or early, unless the regulator is late: then what it drives is late too.
fn late_pressure(case: &DiagnosisInput, fitted: &[Fitted]) -> Vec<DataFault> {
    let channel = Channel::RegulatorPressure;
    let late = fitted.iter().find(|f| f.channel == channel);
    let Some(late) = late.filter(|f| f.alone.abs() > LEAST_OFFSET && f.taken_alone > TAKEN) else {
        return Vec::new();
    };
    let cost = |dead_time: f64| -> f64 {
        let mut plant = case.nominal.clone();
        let quantity = REGULATOR_DEAD_TIME.quantity();
        quantity.set(&mut plant, quantity.get(&case.nominal) + dead_time);
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
    let weighed = |lag: f64| -> (usize, f64) {
        let all = case.recordings.iter();
        let all = all.flat_map(|r| curvatures(r, noise, |t| t - lag));
        all.fold((0, 0.0), |(count, sum), (_, weight)| {
            (count + 1, sum + weight)
        })
    };
    let (_, none) = weighed(0.0);
    let lags = (-LAG.1..=LAG.1).map(|step| LAG.0 * f64::from(step));
    let best = lags
        .map(|lag| (lag, weighed(lag)))
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
