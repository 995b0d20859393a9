//! A contact flange seen from outside: what its runs show that its nominal first order leaves out.
//!
//! ```text
//! F_peak = F_0 + v sqrt(k m),   k = ((F_peak - F_0)/v)^2 / m                 a mass m meets a spring k at a speed v (Johnson 1985, chapter 11)
//! ```
//!
//! F_peak largest force of the impact [N], F_0 force desired before it [N]. Each run gives one number of each kind, so that their intervals come from how
//! they differ from run to run (Student's t), with the force sampled as it was. What cannot be determined without pressure and stroke is said to be so.

pub mod answer;
pub mod fit;

use crate::stats::{mean, median, student_95};
use std::f64::consts::TAU;
use std::ops::Range;

/// One run.
#[derive(Debug, Clone)]
pub struct Run {
    /// File name.
    pub name: String,
    /// Sample times [s].
    pub time: Vec<f64>,
    /// Contact force, pushing positive [N].
    pub force: Vec<f64>,
    /// Desired force [N].
    pub desired: Vec<f64>,
    /// Speed of the arm's tool along its path [m/s].
    pub speed: Vec<f64>,
    /// The speed that the arm is commanded [m/s]; the logged one where there is none.
    pub commanded: Vec<f64>,
    /// The force that was set before contact, where it was not the desired one.
    pub force_ramp: Option<ForceRamp>,
}

/// A desired force that is approached from another once the tool touches.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ForceRamp {
    /// Force set before contact [N].
    pub before: f64,
    /// Time from contact until the desired one is set [s].
    pub time: f64,
}

/// Result of a run.
#[derive(Debug, Clone, PartialEq)]
pub struct RunMetrics {
    /// Time of first contact [s].
    pub contact: f64,
    /// Speed at which the tool came [m/s].
    pub approach: f64,
    /// Force desired before contact [N].
    pub before: f64,
    /// Force desired after it [N].
    pub desired: f64,
    /// Largest force of the impact [N].
    pub peak: f64,
    /// Time from contact until the force, averaged over [`AVERAGED`], stays within [`BAND`] of its later mean [s].
    pub settling: f64,
    /// When the tool was off for the last time [s].
    pub bounced: f64,
    /// Frequency at which the force rings after the impact [Hz]; none where no line stands out.
    pub frequency: Option<f64>,
    /// Its amplitude as it begins [N].
    pub ringing: f64,
    /// Rate at which that dies away [1/s]; none where it does not stand out long enough.
    pub decay: Option<f64>,
    /// Mean of force less desired force once settled, while the arm stands [N].
    pub steady: f64,
    /// Standard deviation of the same [N].
    pub unrest: f64,
    /// Root mean square of force less desired force while the arm moves in contact [N]; none where it does not.
    pub moving: Option<f64>,
    /// Standard deviation of the force in the [`MIDDLE`] of that time [N].
    pub spread: Option<f64>,
    /// Share of the time in which contact is lost while the arm moves [1].
    pub lost: f64,
    /// Until when the arm stands [s].
    pub stationary_until: f64,
}

/// Time over which the force is averaged for its settling [s].
pub const AVERAGED: f64 = 0.02;
/// Share of the desired force within which it has settled [1].
pub const BAND: f64 = 0.1;
/// Force from which there is contact, as a multiple of the noise in free air [1], and at least [N].
const CONTACT: (f64, f64) = (10.0, 2.0);
/// Time before contact in which the approach is looked at [s].
const APPROACH: (f64, f64) = (0.06, 0.01);
/// Time after contact in which the impact's peak lies [s].
const IMPACT: f64 = 0.1;
/// Frequencies in which the ringing is looked for: below, the arm's own control moves the force [Hz].
const RINGING: (f64, f64) = (40.0, 300.0);
/// Duration of the view [s], and its delay after the last bounce [s].
const RUNG: f64 = 0.4;
const SOON: f64 = 0.01;
/// Speed from which the arm moves [m/s].
const MOVES: f64 = 0.01;
/// Speed from which the arm comes to the part, and does not let the flange reach for it [m/s].
const COMES: f64 = 1e-3;
/// Time without motion that parts two motions [s].
const PAUSE: f64 = 0.1;
/// Samples in motion from which they tell something [-].
const FEW_MOVING: usize = 50;
/// Time that is left to a force to settle at most [s].
const LONGEST: f64 = 6.0;

/// Share of the time in which the arm moves that counts for the spread of the force: neither its start nor its end [1].
pub const MIDDLE: [f64; 2] = [0.2, 0.9];

/// Time for which a run must go on after contact [s].
const PRESSED: f64 = 1.5;

/// A run that shows nothing of a contact.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum NoContact {
    /// It never touches, or does from the start.
    #[error(
        "{run}: the force never rises beyond {limit:.1} N after a time without contact; expected a run that begins in free air and ends pressing"
    )]
    Never {
        /// File name.
        run: String,
        /// Force from which there would be contact [N].
        limit: f64,
    },
    /// It ends too early.
    #[error("{run}: it ends {left:.2} s after contact, expected at least {PRESSED} s")]
    Short {
        /// File name.
        run: String,
        /// Time that it still goes on [s].
        left: f64,
    },
    /// The arm stands as it touches: what its impact would say of mass and spring is not there.
    #[error(
        "{run}: the arm comes at {approach:.4} m/s in the time before contact, expected at least {COMES} m/s towards the part"
    )]
    Stationary {
        /// File name.
        run: String,
        /// Its speed [m/s].
        approach: f64,
    },
    /// Nothing is desired.
    #[error("{run}: the force desired after contact is {desired:.2} N, expected one above zero")]
    Undesired {
        /// File name.
        run: String,
        /// The force [N].
        desired: f64,
    },
}

/// How the tool touches.
struct Touch {
    /// First sample in contact.
    first: usize,
    /// Its time [s].
    contact: f64,
    /// Force from which there is contact [N].
    limit: f64,
    /// Speed at which the tool came [m/s].
    approach: f64,
    /// Force desired before contact [N].
    before: f64,
    /// Force desired after it [N].
    desired: f64,
}

impl Run {
    /// Result of the run.
    ///
    /// # Errors
    /// There is no contact, it is there from the start, or the run ends soon after it; the arm stands as it touches; nothing is desired.
    pub fn metrics(&self) -> Result<RunMetrics, NoContact> {
        let (time, force) = (&self.time, &self.force);
        let touch = self.touch()?;
        let Touch {
            first,
            contact,
            limit,
            desired,
            ..
        } = touch;
        let leaves = self.leaves(&touch);
        let stationary_until = time[leaves.saturating_sub(1).max(first)];
        let hold = first..leaves.max(first + 2);
        let settled = self.between(0.5 * (contact + stationary_until), stationary_until);
        let errors: Vec<f64> = settled
            .clone()
            .map(|i| force[i] - self.desired[i])
            .collect();
        let level = mean(&force[settled]);
        let smooth = averaged(&time[hold.clone()], &force[hold.clone()]);
        let outside = smooth
            .iter()
            .rposition(|f| (f - level).abs() > BAND * desired.abs());
        let impact = self.between(contact - 2e-3, contact + IMPACT);
        // While the tool still bounces it rings nowhere: after it was off for the last time.
        let bounced = self
            .between(contact, contact + RUNG)
            .rev()
            .find(|i| force[*i] < limit)
            .map_or(contact, |i| time[i]);
        let rings = self.between(bounced + SOON, bounced + SOON + RUNG);
        let (times, forces) = (&time[rings.clone()], &force[rings]);
        let frequency = loudest(times, forces);
        let samples = self.moving(leaves, desired);
        let (moving, lost) = self.moving_error(&samples, limit);
        Ok(RunMetrics {
            contact,
            approach: touch.approach,
            before: touch.before,
            desired,
            peak: force[impact].iter().copied().fold(f64::MIN, f64::max),
            settling: outside.map_or(0.0, |i| time[hold.start + i] - contact),
            bounced,
            decay: frequency.and_then(|f| decay(times, forces, f)),
            frequency,
            ringing: frequency.map_or(0.0, |f| power_at(times, forces, f).sqrt()),
            steady: mean(&errors),
            unrest: deviation(&errors),
            moving,
            spread: (samples.len() > FEW_MOVING).then(|| self.spread(&samples)),
            lost,
            stationary_until,
        })
    }

    /// Samples from one time to another [s].
    fn between(&self, from: f64, to: f64) -> Range<usize> {
        let at = |limit: f64| self.time.partition_point(|t| *t < limit);
        at(from)..at(to)
    }

    /// How the tool touches.
    fn touch(&self) -> Result<Touch, NoContact> {
        let (time, force) = (&self.time, &self.force);
        let run = || self.name.clone();
        let free = force.len().min(200);
        let noise = deviation(&force[..free / 2]);
        let limit = CONTACT.1.max(CONTACT.0 * noise);
        let never = || NoContact::Never { run: run(), limit };
        let first = force.iter().position(|f| *f > limit).ok_or_else(never)?;
        let contact = time[first];
        let approaching = self.between(contact - APPROACH.0, contact - APPROACH.1);
        if approaching.len() < 2 {
            return Err(never());
        }
        let approach = mean(&self.speed[approaching.clone()]);
        let before = median(self.desired[approaching].iter().copied()).unwrap_or(0.0);
        if approach.is_nan() || approach < COMES {
            return Err(NoContact::Stationary {
                run: run(),
                approach,
            });
        }
        let left = time[time.len() - 1] - contact;
        if left < PRESSED {
            return Err(NoContact::Short { run: run(), left });
        }
        let desired = median(
            self.desired[self.between(contact + 0.3, contact + 1.5)]
                .iter()
                .copied(),
        )
        .unwrap_or(0.0);
        if desired <= 0.0 {
            return Err(NoContact::Undesired {
                run: run(),
                desired,
            });
        }
        Ok(Touch {
            first,
            contact,
            limit,
            approach,
            before,
            desired,
        })
    }

    /// Sample at which the arm, once it has come to rest, moves again, or another force is desired.
    fn leaves(&self, touch: &Touch) -> usize {
        let held = self.between(touch.contact, touch.contact + LONGEST);
        let rests = held
            .clone()
            .find(|i| self.time[*i] > touch.contact + 0.3 && self.speed[*i].abs() < MOVES)
            .unwrap_or(held.end.saturating_sub(1));
        let another = |i: &usize| {
            (self.desired[*i] - touch.desired).abs() > 0.1 * touch.desired.abs().max(1.0)
        };
        (rests..held.end)
            .find(|i| self.speed[*i].abs() > 3.0 * MOVES || another(i))
            .unwrap_or(held.end)
    }

    /// Samples in which the arm moves in contact, after it has stood.
    fn moving(&self, leaves: usize, desired: f64) -> Vec<usize> {
        let moves = |i: &usize| {
            self.speed[*i].abs() > 3.0 * MOVES
                && (self.desired[*i] - desired).abs() < 0.1 * desired.abs()
        };
        (leaves..self.time.len()).filter(moves).collect()
    }

    /// Standard deviation of the force in the [`MIDDLE`] of the time of some samples [N].
    fn spread(&self, samples: &[usize]) -> f64 {
        // The arm goes once; as it lifts off it moves again.
        let pauses = |w: &[usize]| self.time[w[1]] - self.time[w[0]] > PAUSE;
        let once = samples.windows(2).position(pauses);
        let samples = &samples[..once.map_or(samples.len(), |last| last + 1)];
        let (from, to) = (self.time[samples[0]], self.time[samples[samples.len() - 1]]);
        let [first, last] = MIDDLE.map(|share| from + share * (to - from));
        let middle = samples
            .iter()
            .filter(|i| self.time[**i] > first && self.time[**i] < last);
        let forces: Vec<f64> = middle.map(|i| self.force[*i]).collect();
        deviation(&forces)
    }

    /// Force error of samples in which the arm moves in contact [N], root mean square, and the share of them without contact [1].
    fn moving_error(&self, moving: &[usize], limit: f64) -> (Option<f64>, f64) {
        let squares: f64 = moving
            .iter()
            .map(|i| (self.force[*i] - self.desired[*i]).powi(2))
            .sum();
        let gone = moving.iter().filter(|i| self.force[**i] < limit).count();
        let count = moving.len() as f64;
        (
            (moving.len() > FEW_MOVING).then(|| (squares / count).sqrt()),
            match moving.is_empty() {
                true => 0.0,
                false => gone as f64 / count,
            },
        )
    }
}

impl RunMetrics {
    /// Growth of the peak with the speed of approach: sqrt(k m) [N s/m].
    pub fn impedance(&self) -> f64 {
        (self.peak - self.before) / self.approach
    }
}

/// The geometric mean of values above zero with its 95 % interval from how their logarithms differ; of one value alone, twice and half of it.
pub fn spread_of_sizes(values: &[f64]) -> [f64; 3] {
    let logarithms: Vec<f64> = values
        .iter()
        .map(|v| v.max(f64::MIN_POSITIVE).ln())
        .collect();
    match values {
        [one] => [*one, 0.5 * one, 2.0 * one],
        _ => spread(&logarithms).map(f64::exp),
    }
}

/// A mean with its 95 % interval from how values differ; of one value alone, what such values differ by at worst is not known and half of it is taken.
pub fn spread(values: &[f64]) -> [f64; 3] {
    let centre = mean(values);
    if values.len() < 2 {
        return [centre, 0.5 * centre, 1.5 * centre];
    }
    let free = values.len() - 1;
    let sample = deviation(values) * (values.len() as f64 / free as f64).sqrt();
    let half = student_95(free as f64) * sample / (values.len() as f64).sqrt();
    [centre, centre - half, centre + half]
}

pub(super) fn deviation(values: &[f64]) -> f64 {
    let centre = mean(values);
    let squares: f64 = values.iter().map(|v| (v - centre).powi(2)).sum();
    (squares / values.len().max(1) as f64).sqrt()
}

/// Means over [`AVERAGED`] about each time.
fn averaged(time: &[f64], values: &[f64]) -> Vec<f64> {
    let around = |t: f64| {
        let from = time.partition_point(|s| *s < t - 0.5 * AVERAGED);
        let to = time.partition_point(|s| *s <= t + 0.5 * AVERAGED);
        mean(&values[from..to])
    };
    time.iter().map(|t| around(*t)).collect()
}

/// Square of the amplitude at a frequency [Hz], in a bell-shaped window.
pub(super) fn power_at(time: &[f64], values: &[f64], frequency: f64) -> f64 {
    let (Some(first), Some(last)) = (time.first(), time.last()) else {
        return 0.0;
    };
    let centre = mean(values);
    let (mut cosine, mut sine, mut weights) = (0.0, 0.0, 0.0);
    for (t, x) in time.iter().zip(values) {
        let weight = 0.5 - 0.5 * (TAU * (t - first) / (last - first)).cos();
        let (s, c) = (TAU * frequency * t).sin_cos();
        cosine += weight * (x - centre) * c;
        sine += weight * (x - centre) * s;
        weights += weight;
    }
    (cosine * cosine + sine * sine) * (2.0 / f64::max(weights, 1e-12)).powi(2)
}

/// The frequency of the largest power in [`RINGING`] [Hz]; none where that lies at an end of it, as where a force settles slowly and nothing rings.
fn loudest(time: &[f64], force: &[f64]) -> Option<f64> {
    let steps = 600;
    let at = |k: usize| RINGING.0 * (RINGING.1 / RINGING.0).powf(k as f64 / f64::from(steps));
    let powers: Vec<f64> = (0..=steps as usize)
        .map(|k| power_at(time, force, at(k)))
        .collect();
    let best = (0..powers.len()).max_by(|a, b| powers[*a].total_cmp(&powers[*b]))?;
    (0 < best && best < powers.len() - 1).then(|| at(best))
}

/// Rate at which the amplitude at a frequency falls [1/s]: a line through the logarithm of its amplitude in pieces of some cycles, while it stands out.
fn decay(time: &[f64], force: &[f64], frequency: f64) -> Option<f64> {
    const CYCLES: f64 = 4.0;
    const PROMINENT: f64 = 0.1;
    let start = *time.first()?;
    let length = CYCLES / frequency;
    let mut points: Vec<(f64, f64)> = Vec::new();
    let mut from = start;
    while from + length <= *time.last()? {
        let piece =
            time.partition_point(|t| *t < from)..time.partition_point(|t| *t < from + length);
        let amplitude = power_at(&time[piece.clone()], &force[piece], frequency).sqrt();
        let loudest = points.first().map_or(amplitude, |(_, a)| *a);
        if amplitude < PROMINENT * loudest {
            break;
        }
        points.push((from - start, amplitude));
        from += length;
    }
    if points.len() < 3 {
        return None;
    }
    let times: Vec<f64> = points.iter().map(|(t, _)| *t).collect();
    let logarithms: Vec<f64> = points.iter().map(|(_, a)| a.ln()).collect();
    let (t, l) = (mean(&times), mean(&logarithms));
    let both: f64 = times
        .iter()
        .zip(&logarithms)
        .map(|(a, b)| (a - t) * (b - l))
        .sum();
    let own: f64 = times.iter().map(|a| (a - t).powi(2)).sum();
    let rate = -both / own;
    (rate > 0.0).then_some(rate)
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::{Rng, SeedableRng};

    /// A mass that meets a spring at a speed and rings away, on a steady force that is a little off.
    fn run(approach: f64, seed: u64) -> Run {
        let (mass, stiffness, frequency, decay, off) = (3.0, 2e6f64, 80.0, 12.0, 1.5);
        let mut random = rand_chacha::ChaCha8Rng::seed_from_u64(seed);
        let time: Vec<f64> = (0..8000).map(|i| -1.0 + 8e-4 * f64::from(i)).collect();
        let own = (stiffness / mass).sqrt();
        let force = |t: f64| {
            let impact = approach * (stiffness * mass).sqrt();
            let half = std::f64::consts::PI / own;
            let bounce = if t < half {
                impact * (own * t).sin()
            } else {
                0.0
            };
            let ringing = 60.0 * (-decay * t).exp() * (TAU * frequency * t).sin();
            let pushed = if t < half { 0.0 } else { 100.0 + off + ringing };
            bounce + pushed
        };
        Run {
            name: "run".to_owned(),
            force: time
                .iter()
                .map(|t| {
                    0.1 * random.random_range(-1.0..1.0) + if *t < 0.0 { 0.0 } else { force(*t) }
                })
                .collect(),
            desired: time
                .iter()
                .map(|t| if *t < 0.0 { 0.0 } else { 100.0 })
                .collect(),
            speed: time
                .iter()
                .map(|t| if *t < 0.1 { approach } else { 0.0 })
                .collect(),
            force_ramp: None,
            commanded: time
                .iter()
                .map(|t| if *t < 0.1 { approach } else { 0.0 })
                .collect(),
            time,
        }
    }

    /// The lower end of the band, 40 Hz, was taken for the frequency of a run that settles slowly, and flanges were fitted to it.
    #[test]
    fn a_force_that_settles_slowly_rings_at_no_frequency() {
        let time: Vec<f64> = (0..500).map(|i| 8e-4 * f64::from(i)).collect();
        let force = |ringing: f64| -> Vec<f64> {
            let at = |t: &f64| 20.0 * (-8.0 * t).exp() + ringing * (TAU * 80.0 * t).sin();
            time.iter().map(at).collect()
        };
        assert_eq!(loudest(&time, &force(0.0)), None);
        let rings = loudest(&time, &force(1.0)).unwrap();
        assert!((rings - 80.0).abs() < 1.0, "{rings}");
    }

    #[test]
    fn what_was_planted_comes_back_and_a_run_at_another_speed_is_foretold() {
        let shown = run(0.1, 1).metrics().unwrap();
        // An impact of 3.8 ms has its peak between two samples.
        assert!(
            (shown.impedance() / (2e6f64 * 3.0).sqrt() - 1.0).abs() < 0.05,
            "{shown:?}"
        );
        assert!((shown.frequency.unwrap() - 80.0).abs() < 1.0, "{shown:?}");
        assert!((shown.decay.unwrap() / 12.0 - 1.0).abs() < 0.1, "{shown:?}");
        assert!((shown.steady - 1.5).abs() < 0.05, "{shown:?}");
        let other = run(0.25, 2).metrics().unwrap();
        let predicted = other.before + other.approach * shown.impedance();
        assert!((predicted / other.peak - 1.0).abs() < 0.05);
    }

    #[test]
    fn a_run_without_contact_is_refused_and_intervals_are_students() {
        let mut away = run(0.1, 3);
        away.force.iter_mut().for_each(|f| *f = f.min(0.1));
        assert!(
            away.metrics()
                .unwrap_err()
                .to_string()
                .contains("never rises")
        );
        let [centre, low, high] = spread(&[1.0, 2.0, 3.0]);
        assert!(
            (centre - 2.0).abs() < 1e-12 && (high - low - 2.0 * 4.30 / 3f64.sqrt()).abs() < 0.01
        );
    }
}
