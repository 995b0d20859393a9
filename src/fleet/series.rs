//! A number over days: its trend, and where it steps or begins to grow.
//!
//! A change is the step, or the kink, that leaves the least squares; its probability is the share of shuffled series in which chance does as much, so that a
//! series without a change is named as often as that probability says, whatever its scatter is like (A. N. Pettitt's idea, Appl. Statist. 28, 1979, with
//! least squares in place of ranks). Days are taken to scatter independently.

use crate::stats::{mean, student_95};
use rand::{SeedableRng, seq::SliceRandom};
use rand_chacha::ChaCha8Rng;

/// Shuffled series.
const SHUFFLED: usize = 1999;
/// Days before and after a change at least, and of a series.
const SIDE: usize = 3;
const LEAST: usize = 8;

/// A straight line through a series.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Trend {
    /// Slope, in the number's unit a day, with its interval at 95 %.
    pub slope: f64,
    /// The interval.
    pub interval: [f64; 2],
}

/// Kind of a change.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ChangeKind {
    /// From one day to the next.
    Step,
    /// From a day on, more and more.
    Growth,
}

/// A change.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Change {
    /// Its kind.
    pub kind: ChangeKind,
    /// The first day on which it is there, or the day from which it grows [d].
    pub day: f64,
    /// The days that are as likely, at 95 %.
    pub interval: [f64; 2],
    /// The number before, and at the end.
    pub before: f64,
    /// The number at the end: after a step its mean.
    pub after: f64,
    /// Probability that a series without a change shows as much [1].
    pub probability: f64,
}

/// The trend of a series of days; none of few.
#[must_use]
pub fn trend(days: &[f64], values: &[f64]) -> Option<Trend> {
    let count = days.len();
    if count < LEAST {
        return None;
    }
    let [day, value] = [mean(days), mean(values)];
    let square: f64 = days.iter().map(|d| (d - day).powi(2)).sum();
    let product: f64 = days
        .iter()
        .zip(values)
        .map(|(d, v)| (d - day) * (v - value))
        .sum();
    let slope = product / square;
    let left: f64 = (days.iter().zip(values))
        .map(|(d, v)| (v - value - slope * (d - day)).powi(2))
        .sum();
    let free = count as f64 - 2.0;
    let half = student_95(free) * (left / free / square).sqrt();
    (square > 0.0).then_some(Trend {
        slope,
        interval: [slope - half, slope + half],
    })
}

/// The change that a series shows best; none of few days, or of one that stands still.
#[must_use]
pub fn change(days: &[f64], values: &[f64], seed: u64) -> Option<Change> {
    let count = days.len();
    let centre = mean(values);
    let whole: f64 = values.iter().map(|v| (v - centre).powi(2)).sum();
    if count < LEAST || whole <= 1e-24 * centre.powi(2) * count as f64 {
        return None;
    }
    let shapes = shapes(days);
    let gains = |values: &[f64]| -> Vec<f64> {
        let values: Vec<f64> = values.iter().map(|v| v - centre).collect();
        let of = |shape: &Shape| -> f64 {
            let product: f64 = shape.unit.iter().zip(&values).map(|(s, v)| s * v).sum();
            product.powi(2)
        };
        shapes.iter().map(of).collect()
    };
    let own = gains(values);
    let (best, most) = (own.iter().enumerate()).max_by(|a, b| a.1.total_cmp(b.1))?;
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let mut shuffled = values.to_vec();
    let as_much = (0..SHUFFLED).filter(|_| {
        shuffled.shuffle(&mut random);
        gains(&shuffled).iter().any(|gain| gain >= most)
    });
    let probability = (as_much.count() + 1) as f64 / (SHUFFLED + 1) as f64;
    let free = count as f64 - 3.0;
    let likely = (whole - most) * student_95(free).powi(2) / free;
    let near: Vec<f64> = (shapes.iter().zip(&own))
        .filter(|(shape, gain)| shape.kind == shapes[best].kind && most - **gain <= likely)
        .map(|(shape, _)| shape.day)
        .collect();
    let shape = &shapes[best];
    let product: f64 = (shape.unit.iter().zip(values))
        .map(|(s, v)| s * (v - centre))
        .sum();
    let fitted = |place: usize| centre + product * shape.unit[place];
    Some(Change {
        kind: shape.kind,
        day: shape.day,
        interval: [
            near.iter().copied().fold(f64::INFINITY, f64::min),
            near.iter().copied().fold(f64::NEG_INFINITY, f64::max),
        ],
        before: fitted(0),
        after: fitted(count - 1),
        probability,
    })
}

/// A change of size one that a series may show, its mean taken off.
struct Shape {
    kind: ChangeKind,
    day: f64,
    unit: Vec<f64>,
}

fn shapes(days: &[f64]) -> Vec<Shape> {
    let count = days.len();
    let steps = (SIDE..=count - SIDE).map(|from| {
        let values = (0..count).map(|at| f64::from(u8::from(at >= from)));
        (ChangeKind::Step, days[from], values.collect::<Vec<f64>>())
    });
    // The first one is a line from the beginning.
    let kinks = (0..count - SIDE).map(|from| {
        let values = days.iter().map(|day| (day - days[from]).max(0.0));
        (ChangeKind::Growth, days[from], values.collect())
    });
    let shape = |(kind, day, values): (ChangeKind, f64, Vec<f64>)| {
        let centre = mean(&values);
        let size = values
            .iter()
            .map(|v| (v - centre).powi(2))
            .sum::<f64>()
            .sqrt();
        let unit = values.iter().map(|v| (v - centre) / size).collect();
        (size > 0.0).then_some(Shape { kind, day, unit })
    };
    steps.chain(kinks).filter_map(shape).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand_distr::{Distribution, Normal};

    fn series(seed: u64, law: impl Fn(f64) -> f64) -> (Vec<f64>, Vec<f64>) {
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        let noise = Normal::new(0.0, 1.0).unwrap();
        let days: Vec<f64> = (0..40).map(f64::from).collect();
        let values = days.iter().map(|day| law(*day) + noise.sample(&mut random));
        let values = values.collect();
        (days, values)
    }

    #[test]
    fn where_nothing_changes_a_change_is_named_as_often_as_its_probability_says() {
        let mut below = [0; 2];
        for seed in 0..200 {
            let (days, values) = series(seed, |_| 5.0);
            let found = change(&days, &values, 1).unwrap();
            below[0] += usize::from(found.probability <= 0.05);
            below[1] += usize::from(found.probability <= 0.2);
        }
        // 10 and 40 of 200 expected, with standard deviations of 3 and 6.
        assert!((3..=20).contains(&below[0]), "{below:?}");
        assert!((23..=58).contains(&below[1]), "{below:?}");
    }

    #[test]
    fn a_step_and_a_growth_are_found_with_their_days_as_often_as_the_intervals_say() {
        let mut held = [0; 2];
        for seed in 0..100 {
            let (days, values) = series(seed, |day| if day >= 17.0 { 4.0 } else { 0.0 });
            let step = change(&days, &values, 1).unwrap();
            assert!(step.probability <= 0.001);
            let [first, last] = step.interval;
            let at = step.kind == ChangeKind::Step && (step.day - 17.0).abs() <= 2.0;
            held[0] += usize::from(at && first <= 17.0 && 17.0 <= last);
            let (days, values) = series(seed, |day| 0.6 * (day - 17.0).max(0.0));
            let growth = change(&days, &values, 1).unwrap();
            assert!(growth.probability <= 0.001);
            let [first, last] = growth.interval;
            held[1] +=
                usize::from(growth.kind == ChangeKind::Growth && first <= 17.0 && 17.0 <= last);
        }
        assert!(held.iter().all(|held| *held >= 88), "{held:?}");
    }

    #[test]
    fn a_trend_s_interval_holds_the_slope_as_often_as_it_says() {
        let held = (0..200).filter(|seed| {
            let (days, values) = series(*seed, |day| 0.03 * day);
            let [low, high] = trend(&days, &values).unwrap().interval;
            low <= 0.03 && 0.03 <= high
        });
        let held = held.count();
        assert!((180..=199).contains(&held), "{held}");
    }
}
