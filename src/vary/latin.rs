//! A Latin hypercube (M. D. McKay, R. J. Beckman and W. J. Conover, Technometrics 21, 1979): of each variable's range as many equal parts as there are runs, each of
//! them once, and within its part anywhere.

use rand::{Rng, SeedableRng, seq::SliceRandom};
use rand_chacha::ChaCha8Rng;

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
        Self {
            seed,
            count,
            parts: (0..variables).map(parts).collect(),
        }
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

/// Random numbers of one of many streams.
pub(super) fn stream(seed: u64, number: u64) -> ChaCha8Rng {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    random.set_stream(number);
    random
}
