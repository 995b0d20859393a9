//! Global search: differential evolution (R. Storn and K. Price, J. Global Optim. 11, 1997; here current-to-best/1/bin with dither) over the unit
//! cube of all variables, catalogues by the share of it that each entry has. It only compares, so [`Goal::rank`] gives it the feasibility rule.

use std::convert::Infallible;

use basin::{
    BoxBounds, ConstraintDescription, ConstraintSet, Constraints, CostFunction, De, DeMutation,
    Executor, PopulationProgress,
};
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;

use super::archive::Archive;
use super::error::DesignError;
use super::goal::Goal;

/// Members a variable, and the least and most altogether.
const MEMBERS: (usize, usize, usize) = (5, 10, 40);
/// At least so many generations, or fewer members.
const GENERATIONS: usize = 6;

struct Ranking<'a> {
    archive: &'a Archive<'a>,
    goal: &'a Goal,
    lower: Vec<f64>,
    upper: Vec<f64>,
}

impl CostFunction for Ranking<'_> {
    type Param = Vec<f64>;
    type Output = f64;
    type Error = Infallible;

    fn cost(&self, coordinates: &Vec<f64>) -> Result<f64, Infallible> {
        Ok(self.goal.rank(&self.archive.at(coordinates)))
    }
}

impl Constraints for Ranking<'_> {
    type Set = ConstraintSet<BoxBounds<Vec<f64>>>;

    fn constraints(&self) -> <Self::Set as ConstraintDescription>::Borrowed<'_> {
        let bounds = BoxBounds::new(Some(&self.lower), Some(&self.upper));
        ConstraintSet::new().with_bounds(bounds)
    }
}

/// Searches with about `budget` designs, from some known places and others by chance. A generation is evaluated in parallel; everything found is in
/// the archive.
pub(super) fn evolve(
    archive: &Archive<'_>,
    goal: &Goal,
    known: &[Vec<f64>],
    budget: usize,
    seed: u64,
) -> Result<(), DesignError> {
    let dimensions = archive.study().variables.len();
    let (each, least, most) = MEMBERS;
    let count = (each * dimensions)
        .clamp(least, most)
        .min(budget / GENERATIONS);
    // Fewer would leave no difference to mutate with.
    let count = count.max(4);
    let mut population: Vec<Vec<f64>> = known.iter().take(count).cloned().collect();
    population.extend(spread(count - population.len(), dimensions, seed));
    let problem = Ranking {
        archive,
        goal,
        lower: vec![0.0; dimensions],
        upper: vec![1.0; dimensions],
    };
    let solver = De::new(seed)
        .with_pop_size(count)
        .with_mutation(DeMutation::CurrentToBest1)
        .with_dither(0.4, 0.95);
    let generations = (budget / count).saturating_sub(1) as u64;
    Executor::new(
        problem,
        solver,
        PopulationProgress::from_population(population),
    )
    .max_iter(generations)
    .run()
    .map_err(|error| DesignError::Optimiser(format!("differential evolution: {error}")))?;
    Ok(())
}

/// Latin hypercube: each of `count` equal shares of every axis has one point.
fn spread(count: usize, dimensions: usize, seed: u64) -> Vec<Vec<f64>> {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let mut points = vec![vec![0.0; dimensions]; count];
    for axis in 0..dimensions {
        let mut shares: Vec<usize> = (0..count).collect();
        for last in (1..count).rev() {
            shares.swap(last, random.random_range(0..=last));
        }
        for (point, share) in points.iter_mut().zip(shares) {
            point[axis] = (share as f64 + random.random::<f64>()) / count as f64;
        }
    }
    points
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_members_are_spread_over_every_axis() {
        let points = spread(20, 3, 7);
        for axis in 0..3 {
            let mut shares: Vec<usize> = points.iter().map(|p| (p[axis] * 20.0) as usize).collect();
            shares.sort_unstable();
            assert_eq!(shares, (0..20).collect::<Vec<_>>());
        }
        assert_eq!(points, spread(20, 3, 7));
        assert_ne!(points, spread(20, 3, 8));
    }
}
