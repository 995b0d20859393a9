//! A Latin hypercube (M. D. McKay, R. J. Beckman and W. J. Conover, Technometrics 21, 1979): of each variable's range as many equal parts as there are runs, each of
//! them once, and within its part anywhere.
//!
//! Shuffled, 40 runs of two variables correlate at 0.3 once in twenty by chance, and one is then taken for the other. Parts are therefore put in another order, by
//! ranks after the correlation is divided out (R. L. Iman and W. J. Conover, Communications in Statistics B 11, 1982), until it grows no less.

use nalgebra::DMatrix;
use rand::{Rng, SeedableRng, seq::SliceRandom};
use rand_chacha::ChaCha8Rng;

/// Runs up to which chance correlates variables enough to matter.
const CORRELATED: usize = 10_000;
/// Turns of the new order at most.
const TURNS: usize = 20;

/// Shares of the ranges of some variables, by run.
#[derive(Debug, Clone)]
pub struct LatinHypercube {
    seed: u64,
    count: usize,
    /// Which part of its range each variable has in each run.
    parts: Vec<Vec<u32>>,
}

impl LatinHypercube {
    /// So many runs of so many variables, each shuffled for itself.
    #[must_use]
    pub fn new(count: usize, variables: usize, seed: u64) -> Self {
        let parts = |variable: usize| {
            let mut parts: Vec<u32> = (0..count as u32).collect();
            parts.shuffle(&mut stream(seed, variable as u64));
            parts
        };
        let mut parts: Vec<Vec<u32>> = (0..variables).map(parts).collect();
        if count <= CORRELATED {
            uncorrelate(&mut parts);
        }
        Self { seed, count, parts }
    }

    /// The shares of a run, from 0 to below 1, in the order of the variables.
    #[must_use]
    pub fn shares(&self, run: usize) -> Vec<f64> {
        let mut random = stream(self.seed ^ 0x9e37_79b9_7f4a_7c15, run as u64);
        let share = |parts: &Vec<u32>| {
            let within: f64 = random.random();
            (f64::from(parts[run]) + within) / self.count as f64
        };
        self.parts.iter().map(share).collect()
    }
}

/// Puts each variable's parts in an order in which they correlate least; as they are where there are too few runs for so many variables.
fn uncorrelate(parts: &mut Vec<Vec<u32>>) {
    let runs = parts.first().map_or(0, Vec::len);
    if runs < 2 {
        return;
    }
    let middle = 0.5 * (runs as f64 - 1.0);
    let mut least = largest(&correlation(parts));
    for _ in 0..TURNS {
        let Some(factor) = correlation(parts).cholesky() else {
            return;
        };
        let centred = DMatrix::from_fn(parts.len(), runs, |variable, run| {
            f64::from(parts[variable][run]) - middle
        });
        let Some(apart) = factor.l().solve_lower_triangular(&centred) else {
            return;
        };
        let other: Vec<Vec<u32>> = (0..parts.len())
            .map(|variable| order_of(&apart.row(variable).iter().copied().collect::<Vec<_>>()))
            .collect();
        let most = largest(&correlation(&other));
        if most >= least {
            return;
        }
        least = most;
        *parts = other;
    }
}

/// The rank of each value, from 0.
fn order_of(values: &[f64]) -> Vec<u32> {
    let mut order: Vec<usize> = (0..values.len()).collect();
    order.sort_by(|a, b| values[*a].total_cmp(&values[*b]));
    let mut ranks = vec![0; values.len()];
    for (rank, run) in (0..).zip(order) {
        ranks[run] = rank;
    }
    ranks
}

/// Correlation of the parts of each variable with each other's.
fn correlation(parts: &[Vec<u32>]) -> DMatrix<f64> {
    let count = parts.first().map_or(0, Vec::len) as f64;
    let middle = 0.5 * (count - 1.0);
    // Of the numbers from 0 to count - 1.
    let squares = count * (count * count - 1.0) / 12.0;
    DMatrix::from_fn(parts.len(), parts.len(), |one, other| {
        let pairs = parts[one].iter().zip(&parts[other]);
        let products = pairs.map(|(a, b)| (f64::from(*a) - middle) * (f64::from(*b) - middle));
        products.sum::<f64>() / squares
    })
}

/// The largest correlation of two variables, without its sign.
fn largest(correlation: &DMatrix<f64>) -> f64 {
    let size = correlation.nrows();
    let pairs = (0..size).flat_map(|one| (0..one).map(move |other| (one, other)));
    pairs
        .map(|pair| correlation[pair].abs())
        .fold(0.0, f64::max)
}

/// Random numbers of one of many streams.
pub(super) fn stream(seed: u64, number: u64) -> ChaCha8Rng {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    random.set_stream(number);
    random
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn few_runs_of_a_few_variables_do_not_correlate_and_each_part_is_there_once() {
        for seed in 0..200 {
            for (count, variables) in [(40, 5), (20, 3), (100, 8)] {
                let latin = LatinHypercube::new(count, variables, seed);
                let most = largest(&correlation(&latin.parts));
                assert!(
                    most < 4.0 / count as f64,
                    "{count} runs, seed {seed}: {most}"
                );
                for parts in &latin.parts {
                    let mut sorted = parts.clone();
                    sorted.sort_unstable();
                    assert!(sorted.iter().copied().eq(0..count as u32));
                }
            }
        }
    }

    #[test]
    fn too_few_runs_for_so_many_variables_are_a_latin_hypercube_all_the_same() {
        for (count, variables) in [(1, 1), (1, 3), (2, 2), (3, 9)] {
            let latin = LatinHypercube::new(count, variables, 1);
            for parts in &latin.parts {
                let mut sorted = parts.clone();
                sorted.sort_unstable();
                assert!(sorted.iter().copied().eq(0..count as u32));
            }
        }
    }
}
