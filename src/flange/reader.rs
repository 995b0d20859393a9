//! The way of a force into a log: read at a rate, held onto another, and passed through two equal first-order lags by explicit Euler.
//!
//! ```text
//! x_n = x_{n-1} + g (u_n - x_{n-1}),    F_n = F_{n-1} + g (x_n - F_{n-1})
//! ```
//!
//! u held reading [N], F what the log has [N], g step by time constant [1]. With g above 1 an impact is overshot: a step of 1 first reads g^2. A log that
//! went this way shows it: the readings behind it stand still from one sample to the next as often as the rates differ.

/// Rates of readings are whole multiples of this [Hz].
const WHOLE: f64 = 10.0;
/// Whole rates to either side that are looked at.
const NEARBY: u32 = 6;
/// Share of samples that must repeat the last reading [1].
const REPEATS: f64 = 0.4;
/// Difference within which it is repeated, by the usual difference [1].
const SAME: f64 = 0.01;
/// Gains looked at: from, to, steps.
const GAINS: (f64, f64, u32) = (0.3, 1.9, 1600);

/// How a log reads a force.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Reader {
    /// Time between readings [s].
    pub period: f64,
    /// Gain of each lag over a sample [1]; 1 without.
    pub gain: f64,
}

impl Reader {
    /// One that logs what it reads.
    #[must_use]
    pub fn plain(period: f64) -> Self {
        Self { period, gain: 1.0 }
    }

    /// How a log with a sample period [s] was read, from some of its samples.
    #[must_use]
    pub fn of(force: &[f64], period: f64) -> Self {
        let (from, to, steps) = GAINS;
        let gains = (0..=steps).map(|i| from + (to - from) * f64::from(i) / f64::from(steps));
        let shares = gains.map(|gain| (gain, repeated(&behind(force, gain))));
        let best = shares.fold((1.0, 0.0), |a: (f64, f64), b| if b.1 > a.1 { b } else { a });
        if best.1 < REPEATS {
            return Self::plain(period);
        }
        Self {
            period: lattice(&behind(force, best.0), (1.0 - best.1) / period, period),
            gain: best.0,
        }
    }

    /// Readings behind a log, each held as long as it was [N].
    #[must_use]
    pub fn readings(&self, force: &[f64]) -> Vec<f64> {
        behind(force, self.gain)
    }

    /// Time at which the reading was taken that a sample of a time [s] has, with readings at a phase [s].
    #[must_use]
    pub fn read_at(&self, time: f64, phase: f64) -> f64 {
        ((time - phase) / self.period + 1e-6).floor() * self.period + phase
    }

    /// What a log has of held readings [N].
    #[must_use]
    pub fn logged(&self, readings: &[f64]) -> Vec<f64> {
        let (mut first, mut second) = (0.0, 0.0);
        let lags = readings.iter().map(|reading| {
            first += self.gain * (reading - first);
            second += self.gain * (first - second);
            second
        });
        lags.collect()
    }
}

fn behind(force: &[f64], gain: f64) -> Vec<f64> {
    let undo = |values: &[f64]| {
        let mut last = values.first().copied().unwrap_or(0.0);
        let undone = values.iter().map(|value| {
            let input = (value - last) / gain + last;
            last = *value;
            input
        });
        undone.collect::<Vec<f64>>()
    };
    undo(&undo(force))
}

/// Period of readings that change about so often [Hz]: that of the whole rates nearby whose instants the changes miss least.
fn lattice(readings: &[f64], rate: f64, period: f64) -> f64 {
    const PHASES: u32 = 20;
    let largest = readings.iter().copied().fold(0.0, f64::max);
    let changes: Vec<f64> = (1..readings.len())
        .filter(|i| (readings[*i] - readings[i - 1]).abs() > SAME * largest)
        .map(|i| i as f64 * period)
        .collect();
    let missed = |rate: f64| {
        let reader = Reader {
            period: 1.0 / rate,
            gain: 1.0,
        };
        let late = |phase: f64| {
            let missed = |t: &&f64| **t - reader.read_at(**t, phase) > period;
            changes.iter().filter(missed).count()
        };
        let phases = (0..PHASES).map(|k| late(reader.period * f64::from(k) / f64::from(PHASES)));
        phases.min().unwrap_or(0)
    };
    let middle = (rate / WHOLE).round();
    let nearest = (0..=NEARBY).flat_map(|k| [middle - f64::from(k), middle + f64::from(k)]);
    let rates = nearest
        .filter(|whole| *whole >= 1.0)
        .map(|whole| WHOLE * whole);
    let best = rates.min_by_key(|rate| missed(*rate));
    1.0 / best.unwrap_or(rate)
}

/// Share of readings that are those before.
fn repeated(readings: &[f64]) -> f64 {
    let steps: Vec<f64> = readings.windows(2).map(|w| (w[1] - w[0]).abs()).collect();
    let mean = steps.iter().sum::<f64>() / steps.len().max(1) as f64;
    let same = steps.iter().filter(|step| **step < SAME * mean).count();
    same as f64 / steps.len().max(1) as f64
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::{Rng, SeedableRng};

    #[test]
    fn a_reader_is_identified_by_its_noise_and_undone() {
        let planted = Reader {
            period: 2e-3,
            gain: 1.43,
        };
        let mut random = rand_chacha::ChaCha8Rng::seed_from_u64(1);
        let raw: Vec<f64> = (0..2000).map(|_| random.random_range(-0.2..0.2)).collect();
        let held: Vec<f64> = (0..4000)
            .map(|i| raw[((f64::from(i) * 8e-4 + 1e-9) / 2e-3) as usize])
            .collect();
        let log = planted.logged(&held);
        let found = Reader::of(&log, 8e-4);
        assert!((found.gain - 1.43).abs() < 2e-3, "{found:?}");
        assert!((found.period - 2e-3).abs() < 1e-9);
        let back = found.readings(&log);
        assert!((back[1000] - held[1000]).abs() < 2e-3);
        assert_eq!(Reader::of(&raw, 8e-4), Reader::plain(8e-4));
    }
}
