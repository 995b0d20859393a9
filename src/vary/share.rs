//! How much of a number's scatter goes with one variable alone: its first-order index.
//!
//! ```text
//! S = Var(E[y | x]) / Var(y)
//! ```
//!
//! estimated from the runs that there are, whatever their sampling. What the other variables do to the number is taken away first (`additive.rs`), as few
//! runs of one variable go with another by chance, and a table's by intention. Then, of a variable with few values, the runs of each value are a group,
//! otherwise runs are sorted by it and parted into groups of equal size; the variance between groups is freed of what chance alone puts there (Kelley's
//! epsilon squared), so that of nothing it is 0 in the mean. The interval is the bootstrap's, runs drawn anew, moved to the estimate. Beside it stands what a
//! variable gets whose values are shuffled among the runs: a share whose interval does not lie above that is no share.

use std::collections::BTreeMap;

use rand::{Rng, SeedableRng, seq::SliceRandom};
use rand_chacha::ChaCha8Rng;

use super::additive::{Varied, parted};
use crate::stats::{mean, quantile, quantiles};

/// Values up to which a variable's runs are grouped by value, if there are two runs a value in the mean.
const FEW: usize = 30;
/// Groups of a variable that has many, at most; and runs of each, at least.
const GROUPS: usize = 20;
const OF_EACH: usize = 5;
/// Turns of the bootstrap, and of the shuffled variable.
const TURNS: usize = 400;
/// Runs that are drawn in a turn at most: an interval from more would be narrower than it is read.
const DRAWN: usize = 20_000;
/// Least number of runs.
const LEAST: usize = 10;
/// Of shuffled variables, this share gets no more than what is compared with [1].
const SHUFFLED: f64 = 0.95;

/// A share of a number's variance.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Share {
    /// The share [1].
    pub value: f64,
    /// Its interval at 95 %.
    pub interval: [f64; 2],
    /// What the same variable shuffled among the runs gets at most, 95 times of 100 [1].
    pub shuffled: f64,
}

impl Share {
    /// Whether it differs from chance: its interval lies above what the shuffled variable gets.
    #[must_use]
    pub fn is_sure(&self) -> bool {
        self.interval[0] > self.shuffled
    }
}

/// The share of the variance of `y` that goes with each variable, over runs in which all are known; none of few runs, or where one of them stands still.
/// Together they are at most 1.
#[must_use]
pub fn shares_of_variance(variables: &[Varied<'_>], y: &[f64], seed: u64) -> Vec<Option<Share>> {
    let none = vec![None; variables.len()];
    let known: Vec<usize> = (0..y.len())
        .filter(|run| y[*run].is_finite() && variables.iter().all(|v| !v.values[*run].is_nan()))
        .collect();
    let of = |values: &[f64]| -> Vec<f64> { known.iter().map(|run| values[*run]).collect() };
    let y = of(y);
    let scale = y.iter().fold(0.0f64, |most, y| most.max(y.abs()));
    let spread = y.iter().copied().fold(f64::NEG_INFINITY, f64::max)
        - y.iter().copied().fold(f64::INFINITY, f64::min);
    if y.len() < LEAST || spread <= 1e-12 * scale {
        return none;
    }
    let values: Vec<Vec<f64>> = variables.iter().map(|v| of(v.values)).collect();
    let own: Vec<Varied<'_>> = (variables.iter().zip(&values))
        .map(|(variable, values)| Varied {
            values,
            names: variable.names,
        })
        .collect();
    let parted = parted(&own, &y);
    let mut shares: Vec<Option<Share>> = (own.iter().zip(&parted.without_others).enumerate())
        .map(|(place, (variable, without_others))| {
            let groups = groups(variable.values)?;
            let count = groups.iter().max()? + 1;
            let index = |rest| Index {
                groups: &groups,
                count,
                without_others,
                rest,
                y: &y,
            };
            // The variable's own curve is taken out of its groups where that leaves them closer: in a group of a steep one values differ by it alone.
            let all: Vec<usize> = (0..y.len()).collect();
            let [with, without] = [&without_others[..], &parted.rest[..]].map(index);
            let within = |index: &Index<'_>| index.within(&all, index.groups);
            let closer = match within(&without)? < within(&with)? {
                true => without,
                false => with,
            };
            closer.share(&all, ChaCha8Rng::seed_from_u64(seed + place as u64))
        })
        .collect();
    let together: f64 = shares.iter().flatten().map(|share| share.value).sum();
    if together > 1.0 {
        for share in shares.iter_mut().flatten() {
            share.value /= together;
            share.interval = share.interval.map(|end| end / together);
            share.shuffled /= together;
        }
    }
    shares
}

/// What an index is made of.
struct Index<'a> {
    groups: &'a [usize],
    count: usize,
    without_others: &'a [f64],
    rest: &'a [f64],
    y: &'a [f64],
}

impl Index<'_> {
    fn share(&self, all: &[usize], mut random: ChaCha8Rng) -> Option<Share> {
        let value = self.of(all)?;
        let drawn = all.len().min(DRAWN);
        let some: Vec<usize> = (0..drawn).map(|place| place * all.len() / drawn).collect();
        let turns: Vec<f64> = (0..TURNS)
            .filter_map(|_| {
                let again: Vec<usize> = (0..drawn)
                    .map(|_| random.random_range(0..all.len()))
                    .collect();
                self.of(&again)
            })
            .collect();
        let mean = mean(&turns);
        let ends = quantiles(&turns, &[0.025, 0.975])?;
        let end = |turn: f64| (value + turn - mean).clamp(0.0, 1.0);
        let shuffled = (0..TURNS).filter_map(|_| self.shuffled(&some, &mut random));
        Some(Share {
            value: value.clamp(0.0, 1.0),
            interval: [end(ends[0]), end(ends[1])],
            shuffled: quantile(shuffled, SHUFFLED)?.clamp(0.0, 1.0),
        })
    }

    /// Epsilon squared of the runs named, some of them perhaps more than once.
    fn of(&self, runs: &[usize]) -> Option<f64> {
        let between = variance(self.without_others, runs) - self.within(runs, self.groups)?;
        let whole = variance(self.y, runs);
        (whole > 0.0).then(|| between / whole)
    }

    /// The same with the groups shuffled among the runs: a variable that does nothing.
    fn shuffled(&self, runs: &[usize], random: &mut ChaCha8Rng) -> Option<f64> {
        let mut groups = self.groups.to_vec();
        groups.shuffle(random);
        let other = Index {
            rest: self.without_others,
            ..*self
        };
        let between = variance(self.without_others, runs) - other.within(runs, &groups)?;
        let whole = variance(self.y, runs);
        (whole > 0.0).then(|| between / whole)
    }

    /// Variance within the groups; none where each run is one of its own.
    fn within(&self, runs: &[usize], groups: &[usize]) -> Option<f64> {
        let mut sums = vec![(0.0, 0.0); self.count];
        for run in runs {
            let sum = &mut sums[groups[*run]];
            sum.0 += 1.0;
            sum.1 += self.rest[*run];
        }
        let means: Vec<f64> = sums.iter().map(|(n, sum)| sum / n).collect();
        let squares = runs.iter();
        let squares = squares.map(|run| (self.rest[*run] - means[groups[*run]]).powi(2));
        let used = sums.iter().filter(|sum| sum.0 > 0.0).count();
        let free = runs.len().checked_sub(used).filter(|free| *free > 0)?;
        Some(squares.sum::<f64>() / free as f64)
    }
}

fn variance(values: &[f64], runs: &[usize]) -> f64 {
    let count = runs.len() as f64;
    let mean = runs.iter().map(|run| values[*run]).sum::<f64>() / count;
    let squares = runs.iter().map(|run| (values[*run] - mean).powi(2));
    squares.sum::<f64>() / (count - 1.0)
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::vary::LatinHypercube;

    fn numbers(columns: &[Vec<f64>]) -> Vec<Varied<'_>> {
        let varied = |values| Varied {
            values,
            names: false,
        };
        columns.iter().map(|column| varied(column)).collect()
    }

    /// Ishigami's function, whose indices are known: 0.3139, 0.4424, 0 for a = 7, b = 0.1 (I. M. Sobol' and Y. L. Levitan, 1999).
    fn ishigami(x: &[f64]) -> f64 {
        let [a, b, c] = [0, 1, 2].map(|place| std::f64::consts::PI * (2.0 * x[place] - 1.0));
        a.sin() + 7.0 * b.sin().powi(2) + 0.1 * c.powi(4) * a.sin()
    }

    /// Shares of a function of so many variables, each from 0 to 1, by a Latin hypercube.
    fn shares(
        of: &dyn Fn(&[f64]) -> f64,
        [runs, variables]: [usize; 2],
        seed: u64,
    ) -> Vec<Option<Share>> {
        let latin = LatinHypercube::new(runs, variables, seed);
        let points: Vec<Vec<f64>> = (0..runs).map(|run| latin.shares(run)).collect();
        let y: Vec<f64> = points.iter().map(|x| of(x)).collect();
        let columns: Vec<Vec<f64>> = (0..variables)
            .map(|variable| points.iter().map(|x| x[variable]).collect())
            .collect();
        shares_of_variance(&numbers(&columns), &y, seed)
    }

    #[test]
    fn indices_of_a_known_function_lie_in_their_intervals_as_often_as_these_say() {
        let truth = [0.3139, 0.4424, 0.0];
        let mut held = [0; 3];
        let mut mean = [0.0; 3];
        for turn in 0..60 {
            let found = shares(&ishigami, [1000, 3], turn);
            for (place, share) in found.into_iter().flatten().enumerate() {
                let [low, high] = share.interval;
                held[place] += usize::from(low <= truth[place] && truth[place] <= high);
                mean[place] += share.value / 60.0;
            }
        }
        for place in 0..3 {
            assert!((mean[place] - truth[place]).abs() < 0.02, "{mean:?}");
            assert!(held[place] >= 54, "{held:?}");
        }
    }

    /// A function of some of five variables, and the shares of all.
    type Planted = (&'static str, fn(&[f64]) -> f64, [f64; 5]);

    /// Variances on [0, 1]: of x 1/12, of a step at 0.6 0.24, of 12 (x - 1/2)(y - 1/2) 1, of exp(2 x) (e^4 - 1)/4 - ((e^2 - 1)/2)^2.
    fn planted() -> [Planted; 5] {
        let line = 1.0 / 12.0;
        let step = 0.24 / (0.24 + 0.25 * line);
        let bent = (1f64.exp().powi(4) - 1.0) / 4.0 - ((2f64.exp() - 1.0) / 2.0).powi(2);
        let whole = bent + 4.0 * line;
        [
            (
                "two lines",
                |x| 3.0 * x[0] + x[1],
                [0.9, 0.1, 0.0, 0.0, 0.0],
            ),
            ("one line", |x| x[0], [1.0, 0.0, 0.0, 0.0, 0.0]),
            (
                "step and line",
                |x| f64::from(u8::from(x[0] > 0.6)) + 0.5 * x[1],
                [step, 1.0 - step, 0.0, 0.0, 0.0],
            ),
            (
                "product and line",
                |x| 12.0 * (x[0] - 0.5) * (x[1] - 0.5) + x[2],
                [0.0, 0.0, line / (1.0 + line), 0.0, 0.0],
            ),
            (
                "bent and line",
                |x| (2.0 * x[0]).exp() + 2.0 * x[1],
                [bent / whole, 4.0 * line / whole, 0.0, 0.0, 0.0],
            ),
        ]
    }

    // Catches: 40 runs of which a variable that does nothing correlates with one that does, and is reported to drive the number by a fifth.
    #[test]
    fn of_few_runs_what_does_nothing_is_not_named_and_shares_lie_in_their_intervals() {
        const TURNS: usize = 40;
        let (mut named, mut idle) = (0, 0);
        for (words, of, truth) in planted() {
            let mut held = [0; 5];
            let mut sure = [0; 5];
            for turn in 0..TURNS {
                let found: Vec<Share> = shares(&of, [40, 5], turn as u64)
                    .into_iter()
                    .flatten()
                    .collect();
                let together: f64 = found.iter().map(|share| share.value).sum();
                assert!(
                    found.len() == 5 && together <= 1.0 + 1e-9,
                    "{words}: {together}"
                );
                for (place, share) in found.iter().enumerate() {
                    let [low, high] = share.interval;
                    let in_it = low <= truth[place] + 1e-6 && truth[place] <= high + 1e-6;
                    held[place] += usize::from(in_it);
                    sure[place] += usize::from(share.is_sure());
                }
            }
            for place in 0..5 {
                assert!(held[place] * 100 >= 90 * TURNS, "{words}: {held:?}");
                if truth[place] == 0.0 {
                    named += sure[place];
                    idle += TURNS;
                }
                if truth[place] >= 0.5 {
                    assert!(sure[place] * 100 >= 95 * TURNS, "{words}: {sure:?}");
                }
            }
        }
        assert!(named * 100 <= 2 * idle, "{named} of {idle}");
    }

    #[test]
    fn of_two_that_go_together_in_a_table_that_which_does_nothing_is_not_named() {
        let latin = LatinHypercube::new(60, 3, 3);
        let points: Vec<Vec<f64>> = (0..60).map(|run| latin.shares(run)).collect();
        let first: Vec<f64> = points.iter().map(|x| x[0]).collect();
        let beside: Vec<f64> = points.iter().map(|x| x[0] + 0.5 * x[1]).collect();
        let own: Vec<f64> = points.iter().map(|x| x[2]).collect();
        let y: Vec<f64> = points.iter().map(|x| 3.0 * x[0] + x[2]).collect();
        let found = shares_of_variance(&numbers(&[first, beside, own]), &y, 1);
        let sure: Vec<bool> = found.into_iter().flatten().map(|s| s.is_sure()).collect();
        assert_eq!(sure, [true, false, true]);
    }

    #[test]
    fn names_are_groups_of_their_own() {
        let latin = LatinHypercube::new(60, 2, 5);
        let points: Vec<Vec<f64>> = (0..60).map(|run| latin.shares(run)).collect();
        let name: Vec<f64> = points.iter().map(|x| (3.0 * x[0]).floor()).collect();
        let other: Vec<f64> = points.iter().map(|x| x[1]).collect();
        // 0, 1, 0: no line through the names tells them.
        let y: Vec<f64> = name
            .iter()
            .map(|n| f64::from(u8::from(*n == 1.0)))
            .collect();
        let varied = [
            Varied {
                values: &name,
                names: true,
            },
            Varied {
                values: &other,
                names: false,
            },
        ];
        let found = shares_of_variance(&varied, &y, 1);
        let [name, other] = [found[0].unwrap(), found[1].unwrap()];
        assert!(name.value > 0.95 && name.is_sure(), "{name:?}");
        assert!(!other.is_sure(), "{other:?}");
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
        let found = shares_of_variance(&numbers(&[a, b]), &y, 1);
        let value = |place: usize| found[place].unwrap().value;
        assert!((value(0) - 0.9).abs() < 0.01, "{}", value(0));
        assert!((value(1) - 0.1).abs() < 0.01, "{}", value(1));
    }

    #[test]
    fn of_constants_and_of_few_runs_nothing_is_said() {
        let x: Vec<f64> = (0..40).map(f64::from).collect();
        let share = |x: &[f64], y: &[f64]| shares_of_variance(&numbers(&[x.to_vec()]), y, 0)[0];
        assert_eq!(share(&x, &[1.0; 40]), None);
        assert_eq!(share(&[1.0; 40], &x), None);
        assert_eq!(share(&x[..6], &x[..6]), None);
        assert_eq!(share(&x, &[f64::NAN; 40]), None);
    }
}
