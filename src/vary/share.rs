//! How much of a number's scatter goes with one variable: its first-order index.
//!
//! ```text
//! S = Var(E[y | x]) / Var(y)
//! ```
//!
//! estimated from the runs that there are, whatever their sampling: of a variable with few values the runs of each value are a group, otherwise runs are
//! sorted by it and parted into groups of equal size. The variance between groups is freed of what chance alone puts there (Kelley's epsilon squared), so
//! that of nothing it is 0 in the mean. The interval is the bootstrap's, runs drawn anew, moved to the estimate.

use std::collections::BTreeMap;

use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;

/// Values up to which a variable's runs are grouped by value, if there are two runs a value in the mean.
const FEW: usize = 30;
/// Groups of a variable that has many, at most; and runs of each, at least.
const GROUPS: usize = 20;
const OF_EACH: usize = 5;
/// Turns of the bootstrap.
const TURNS: usize = 400;
/// Runs that are drawn in a turn at most: an interval from more would be narrower than it is read.
const DRAWN: usize = 20_000;
/// Least number of runs.
const LEAST: usize = 10;

/// A share of a number's variance.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Share {
    /// The share [1].
    pub value: f64,
    /// Its interval at 95 %.
    pub interval: [f64; 2],
}

/// The share of the variance of `y` that goes with `x`, over runs in which both are known; none of few runs, or where one of them stands still.
#[must_use]
pub fn share_of_variance(x: &[f64], y: &[f64], seed: u64) -> Option<Share> {
    let known: Vec<(f64, f64)> = (x.iter().zip(y))
        .map(|(x, y)| (*x, *y))
        .filter(|(x, y)| !x.is_nan() && y.is_finite())
        .collect();
    let groups = groups(&known.iter().map(|pair| pair.0).collect::<Vec<_>>())?;
    let count = groups.iter().max()? + 1;
    let y: Vec<f64> = known.iter().map(|pair| pair.1).collect();
    let scale = y.iter().fold(0.0f64, |most, y| most.max(y.abs()));
    let spread = y.iter().copied().fold(f64::NEG_INFINITY, f64::max)
        - y.iter().copied().fold(f64::INFINITY, f64::min);
    if y.len() < LEAST || spread <= 1e-12 * scale {
        return None;
    }
    let all: Vec<usize> = (0..y.len()).collect();
    let value = index(&all, &groups, &y, count)?;
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let drawn = y.len().min(DRAWN);
    let mut turns: Vec<f64> = (0..TURNS)
        .filter_map(|_| {
            let again: Vec<usize> = (0..drawn)
                .map(|_| random.random_range(0..y.len()))
                .collect();
            index(&again, &groups, &y, count)
        })
        .collect();
    turns.sort_by(f64::total_cmp);
    let mean = turns.iter().sum::<f64>() / turns.len() as f64;
    let at = |share: f64| turns[((turns.len() - 1) as f64 * share).round() as usize];
    let end = |turn: f64| (value + turn - mean).clamp(0.0, 1.0);
    Some(Share {
        value: value.clamp(0.0, 1.0),
        interval: [end(at(0.025)), end(at(0.975))],
    })
}

/// The group of each run; none where there is but one.
fn groups(x: &[f64]) -> Option<Vec<usize>> {
    let mut sorted = x.to_vec();
    sorted.sort_by(f64::total_cmp);
    let mut values = sorted.clone();
    values.dedup();
    if values.len() < 2 {
        return None;
    }
    if values.len() <= FEW && x.len() >= 2 * values.len() {
        let places: BTreeMap<u64, usize> = (values.iter().enumerate())
            .map(|(place, value)| (value.to_bits(), place))
            .collect();
        return Some(x.iter().map(|x| places[&x.to_bits()]).collect());
    }
    let count = (x.len() / OF_EACH).clamp(2, GROUPS);
    let mut order: Vec<usize> = (0..x.len()).collect();
    order.sort_by(|a, b| x[*a].total_cmp(&x[*b]));
    let mut found = vec![0; x.len()];
    let mut before = 0;
    // Runs of one value stay together.
    for equal in order.chunk_by(|a, b| x[*a] == x[*b]) {
        let group = (before + equal.len() / 2) * count / x.len();
        for run in equal {
            found[*run] = group;
        }
        before += equal.len();
    }
    Some(found)
}

/// Epsilon squared of the runs named, some of them perhaps more than once.
fn index(runs: &[usize], groups: &[usize], y: &[f64], count: usize) -> Option<f64> {
    let mut sums = vec![(0.0, 0.0); count];
    for run in runs {
        let sum = &mut sums[groups[*run]];
        sum.0 += 1.0;
        sum.1 += y[*run];
    }
    let total = runs.len() as f64;
    let mean = sums.iter().map(|sum| sum.1).sum::<f64>() / total;
    let means: Vec<f64> = sums.iter().map(|(n, sum)| sum / n).collect();
    let (mut within, mut whole) = (0.0, 0.0);
    for run in runs {
        within += (y[*run] - means[groups[*run]]).powi(2);
        whole += (y[*run] - mean).powi(2);
    }
    let used = sums.iter().filter(|sum| sum.0 > 0.0).count() as f64;
    let free = total - used;
    (whole > 0.0 && free > 0.0).then(|| 1.0 - within / free / (whole / (total - 1.0)))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Ishigami's function, whose indices are known: 0.3139, 0.4424, 0 for a = 7, b = 0.1 (I. M. Sobol' and Y. L. Levitan, 1999).
    fn ishigami(random: &mut ChaCha8Rng, count: usize) -> ([Vec<f64>; 3], Vec<f64>) {
        let pi = std::f64::consts::PI;
        let mut draw =
            || -> Vec<f64> { (0..count).map(|_| random.random_range(-pi..pi)).collect() };
        let x = [draw(), draw(), draw()];
        let y = (0..count).map(|i| {
            let [a, b, c] = [x[0][i], x[1][i], x[2][i]];
            a.sin() + 7.0 * b.sin().powi(2) + 0.1 * c.powi(4) * a.sin()
        });
        let y = y.collect();
        (x, y)
    }

    #[test]
    fn indices_of_a_known_function_lie_in_their_intervals_as_often_as_these_say() {
        let truth = [0.3139, 0.4424, 0.0];
        let mut held = [0; 3];
        let mut mean = [0.0; 3];
        for turn in 0..100 {
            let mut random = ChaCha8Rng::seed_from_u64(turn);
            let (x, y) = ishigami(&mut random, 1000);
            for place in 0..3 {
                let share = share_of_variance(&x[place], &y, turn).unwrap();
                let [low, high] = share.interval;
                held[place] += usize::from(low <= truth[place] && truth[place] <= high);
                mean[place] += share.value / 100.0;
            }
        }
        for place in 0..3 {
            assert!((mean[place] - truth[place]).abs() < 0.02, "{mean:?}");
            assert!(held[place] >= 90, "{held:?}");
        }
    }

    #[test]
    fn a_grid_s_shares_are_those_of_its_sums_of_squares() {
        // y = 3 a + b over a full grid: variances of a and b stand as 9 to 1.
        let (mut a, mut b, mut y) = (Vec::new(), Vec::new(), Vec::new());
        for turn in 0..2500 {
            let (first, second) = (f64::from(turn / 50 % 10), f64::from(turn % 10));
            a.push(first);
            b.push(second);
            y.push(3.0 * first + second);
        }
        let share = |x: &[f64]| share_of_variance(x, &y, 1).unwrap().value;
        assert!((share(&a) - 0.9).abs() < 0.01, "{}", share(&a));
        assert!((share(&b) - 0.1).abs() < 0.01, "{}", share(&b));
    }

    #[test]
    fn of_what_stands_still_and_of_few_runs_nothing_is_said() {
        let x: Vec<f64> = (0..40).map(f64::from).collect();
        assert_eq!(share_of_variance(&x, &[1.0; 40], 0), None);
        assert_eq!(share_of_variance(&[1.0; 40], &x, 0), None);
        assert_eq!(share_of_variance(&x[..6], &x[..6], 0), None);
        let noise = [f64::NAN; 40];
        assert_eq!(share_of_variance(&x, &noise, 0), None);
    }
}
