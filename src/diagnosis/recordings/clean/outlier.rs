//! Wild readings: they stand alone, far from both neighbours, and another sensor denies what they say of the rig.
//!
//! An impact of one sample passes, for what it says is true; so does what no other sensor can deny. Which sensor can is the subject's to say ([`Denial`]).

use super::departure::{departure, departures};
use crate::diagnosis::recordings::subject::Denial;
use crate::stats::{NORMAL_MAD, median};

/// Departure from which a reading may be wild, in standard deviations of noise and of what happens around it [1].
const FAR: f64 = 12.0;
/// Share of its departure that is left to its neighbours once it is gone [1].
const ALONE: f64 = 0.2;
/// Readings on either side that say what happens around it.
const AROUND: usize = 12;
/// Share of what it says that a sensor must show at least if it were true [1].
const SHOWN: f64 = 0.25;
/// Its size, in standard deviations of the sensor that denies it, from which that one can [1].
const POWER: f64 = 10.0;
/// As `POWER`, for a change of speed, which a sensor of positions denies less surely.
const SPEED_POWER: f64 = 25.0;
/// Departure of that change from none that is noise [1].
const SPEED_NOISE: f64 = 4.0;

/// The examined readings.
struct Sight<'a> {
    time: &'a [f64],
    readings: &'a [Vec<f64>],
    noise: &'a [f64],
    denials: &'a [Denial],
    departures: Vec<Vec<f64>>,
    step: f64,
}

/// Wild readings by channel.
pub(super) fn outlier(
    time: &[f64],
    readings: &[Vec<f64>],
    noise: &[f64],
    denials: &[Denial],
    step: f64,
) -> Vec<Vec<usize>> {
    let departures = readings.iter().map(|own| departures(time, own, step));
    let sight = Sight {
        time,
        readings,
        noise,
        denials,
        departures: departures.collect(),
        step,
    };
    let of = |channel: usize| {
        (0..time.len())
            .filter(|index| sight.is_isolated(channel, *index) && sight.denied(channel, *index))
            .collect()
    };
    (0..readings.len()).map(of).collect()
}

impl Sight<'_> {
    /// Whether a reading is far from its neighbours, which go on as if it were not there.
    fn is_isolated(&self, channel: usize, index: usize) -> bool {
        let departures = &self.departures[channel];
        let size = departures[index].abs();
        // Most readings end here.
        if size.is_nan() || size <= FAR * self.noise[channel] {
            return false;
        }
        let around = index.saturating_sub(AROUND)..(index + AROUND + 1).min(departures.len());
        let others = around
            .filter(|other| other.abs_diff(index) > 2)
            .map(|other| departures[other].abs())
            .filter(|other| other.is_finite());
        if median(others).is_none_or(|median| size <= FAR * NORMAL_MAD * median) {
            return false;
        }
        let near = index.saturating_sub(2)..(index + 3).min(departures.len());
        let values = &self.readings[channel];
        near.filter(|other| *other != index).all(|other| {
            let left = departure(self.time, values, self.step, other, Some(index));
            left.is_none_or(|left| left.abs() < ALONE * size)
        })
    }

    /// Whether another sensor denies a reading.
    fn denied(&self, channel: usize, index: usize) -> bool {
        let said = self.departures[channel][index].abs();
        match self.denials[channel] {
            Denial::None => false,
            Denial::Itself => true,
            Denial::Derivative { by, per, order } => {
                self.derivative_denies(by, index, said / per / self.step.powi(order))
            }
            Denial::TwiceIntegrated { by } => self.integral_denies(channel, by, index),
        }
    }

    /// Whether a channel shows nothing like what is said of it.
    fn derivative_denies(&self, by: usize, index: usize, said: f64) -> bool {
        let departures = &self.departures[by];
        let near = index.saturating_sub(1)..(index + 2).min(departures.len());
        let shown = departures[near]
            .iter()
            .fold(0.0f64, |most, z| most.max(z.abs()));
        departures[index].is_finite() && said > POWER * self.noise[by] && shown < SHOWN * said
    }

    /// Whether a position shows no change of speed at a reading of an acceleration beyond what the others say.
    fn integral_denies(&self, channel: usize, by: usize, index: usize) -> bool {
        const SIDE: usize = 4;
        if index < SIDE || index + SIDE >= self.time.len() {
            return false;
        }
        let span = index - SIDE..=index + SIDE;
        let time = &self.time[span.clone()];
        let stroke = &self.readings[by][span.clone()];
        let mut acceleration = self.readings[channel][span].to_vec();
        let whole = stroke
            .iter()
            .chain(&acceleration)
            .all(|value| value.is_finite());
        if !whole || time[2 * SIDE] - time[0] > 1.5 * 2.0 * SIDE as f64 * self.step {
            return false;
        }
        let without = 0.5 * (acceleration[SIDE - 1] + acceleration[SIDE + 1]);
        let said = (acceleration[SIDE] - without) * 0.5 * (time[SIDE + 1] - time[SIDE - 1]);
        acceleration[SIDE] = without;
        let trajectory = twice_integrated(time, &acceleration);
        let rest: Vec<f64> = stroke.iter().zip(trajectory).map(|(x, c)| x - c).collect();
        let (before, its_variance) = slope(&time[..SIDE], &rest[..SIDE]);
        let (after, other_variance) = slope(&time[SIDE + 1..], &rest[SIDE + 1..]);
        let deviation = self.noise[by] * (its_variance + other_variance).sqrt();
        said.abs() > SPEED_POWER * deviation && (after - before).abs() < SPEED_NOISE * deviation
    }
}

/// Positions [m] from accelerations [m/s2] that are linear between samples, from rest.
fn twice_integrated(time: &[f64], acceleration: &[f64]) -> Vec<f64> {
    let (mut position, mut speed) = (0.0, 0.0);
    let mut positions = vec![0.0];
    for i in 1..time.len() {
        let h = time[i] - time[i - 1];
        position += h * (speed + h * (2.0 * acceleration[i - 1] + acceleration[i]) / 6.0);
        speed += 0.5 * h * (acceleration[i - 1] + acceleration[i]);
        positions.push(position);
    }
    positions
}

/// Slope of the line through values, and its variance over that of the values [1/s2].
fn slope(time: &[f64], values: &[f64]) -> (f64, f64) {
    let middle = time.iter().sum::<f64>() / time.len() as f64;
    let spread: f64 = time.iter().map(|t| (t - middle) * (t - middle)).sum();
    let rise: f64 = time.iter().zip(values).map(|(t, v)| (t - middle) * v).sum();
    (rise / spread, 1.0 / spread)
}
