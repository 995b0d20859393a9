//! Least squares from many starts: logarithms of the numbers, priors, a loss that forgives single residuals.
//!
//! ```text
//! minimise  sum 2 (sqrt(1 + r^2) - 1),    (J' W J + l diag) d = -J' W r,    W = 1/sqrt(1 + r^2)      (Levenberg, Marquardt; Holland and Welsch 1977)
//! ```
//!
//! r residuals, and the logarithms of the numbers by their priors' deviations. The starts are drawn from the priors; of many the best is followed, by
//! a seed each, so that the same recordings give the same bytes whatever the machine.

use std::f64::consts::TAU;

use nalgebra::{DMatrix, DVector};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};

use super::residuals::Targets;
use crate::flange::{FLANGE_NUMBERS, FlangeModel};

/// What is usual of each number, and the deviation of its logarithm. The masses' are by the rig's moving mass.
const USUAL: [(f64, f64); FLANGE_NUMBERS] = [
    (1.4, 0.2),
    (0.28, 0.5),
    (4e5, 1.0),
    (0.05, 1.2),
    (500.0, 1.2),
    (1.2e6, 1.0),
    (0.25, 0.8),
    (0.15, 1.0),
    (1.2e6, 1.2),
    (0.02, 1.0),
    (4.0, 0.6),
    (5e-5, 0.7),
    (10.0, 0.8),
    (0.45, 0.5),
    (2.5e3, 0.4),
    (0.012, 0.7),
    (0.013, 0.7),
];
/// Numbers that are given by the rig's moving mass.
const BY_MASS: [usize; 3] = [0, 1, 7];
/// Stiffnesses of the structure and of what carries the workpiece, among the numbers.
const STRUCTURE: usize = 2;
const BELOW: usize = 8;
/// Deviation of the time of touch [s].
const TOUCH: f64 = 0.7e-3;
/// Starts that are followed, and draws for each.
const STARTS: u64 = 32;
const DRAWS: usize = 200;
/// Width of the draws by the priors' [1].
const WIDTH: f64 = 0.6;
/// Iterations of a start at most, and the gain below which it ends [1].
const ITERATIONS: usize = 45;
const GAIN: f64 = 1e-3;
/// Step of the difference quotients [1].
const DIFFERENCE: f64 = 3e-3;

/// A fit from a start.
#[derive(Debug, Clone)]
pub(super) struct Solution {
    /// The flange.
    pub model: FlangeModel,
    /// Its cost.
    pub cost: f64,
    /// Standard deviation of the logarithm of each number.
    pub deviations: [f64; FLANGE_NUMBERS],
}

/// Fits to some runs from all starts, the best first.
pub(super) fn solutions(targets: &[Targets], mass: f64) -> Vec<Solution> {
    let problem = Problem::new(targets, mass);
    let workers = std::thread::available_parallelism().map_or(1, usize::from) as u64;
    let mut found: Vec<(u64, Solution)> = std::thread::scope(|scope| {
        let handles: Vec<_> = (0..workers.min(STARTS))
            .map(|worker| {
                let problem = &problem;
                let own = (worker..STARTS).step_by(workers as usize);
                scope.spawn(move || {
                    own.map(|seed| (seed, problem.started(seed)))
                        .collect::<Vec<_>>()
                })
            })
            .collect();
        let joined = handles.into_iter().filter_map(|handle| handle.join().ok());
        joined.flatten().collect()
    });
    found.sort_by(|a, b| a.1.cost.total_cmp(&b.1.cost).then(a.0.cmp(&b.0)));
    found.into_iter().map(|(_, solution)| solution).collect()
}

/// Goes on from a flange with a fit to other runs.
pub(super) fn refitted(targets: &[Targets], mass: f64, from: &FlangeModel) -> Solution {
    let problem = Problem::new(targets, mass);
    let numbers = from.numbers();
    let mut x: Vec<f64> = (0..FLANGE_NUMBERS)
        .map(|i| (numbers[i] / problem.usual[i]).ln() / USUAL[i].1)
        .collect();
    x.resize(FLANGE_NUMBERS + targets.len(), 0.0);
    problem.followed(problem.place(x))
}

struct Problem<'a> {
    targets: &'a [Targets],
    usual: [f64; FLANGE_NUMBERS],
}

/// A place with its residuals.
struct Place {
    x: Vec<f64>,
    residuals: Vec<f64>,
    cost: f64,
}

impl<'a> Problem<'a> {
    fn new(targets: &'a [Targets], mass: f64) -> Self {
        let mut usual = USUAL.map(|(value, _)| value);
        for index in BY_MASS {
            usual[index] *= mass;
        }
        Self { targets, usual }
    }

    /// Places are in deviations of the priors.
    fn model(&self, x: &[f64]) -> FlangeModel {
        FlangeModel::of(&std::array::from_fn(|i| {
            self.usual[i] * (x[i] * USUAL[i].1).exp()
        }))
    }

    fn place(&self, x: Vec<f64>) -> Place {
        let model = self.model(&x);
        let touches = &x[FLANGE_NUMBERS..];
        let mut residuals: Vec<f64> = (self.targets.iter().zip(touches))
            .flat_map(|(targets, touch)| targets.residuals(&model, touch * TOUCH))
            .collect();
        residuals.extend(&x);
        Place {
            cost: residuals.iter().map(|r| loss(*r)).sum(),
            x,
            residuals,
        }
    }

    fn started(&self, seed: u64) -> Solution {
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        let count = FLANGE_NUMBERS + self.targets.len();
        let draws = (0..DRAWS).map(|_| {
            let drawn: Vec<f64> = (0..FLANGE_NUMBERS)
                .map(|_| StandardNormal.sample(&mut random))
                .collect();
            let mut x = vec![0.0; count];
            for (place, drawn) in x.iter_mut().zip(drawn) {
                *place = WIDTH * drawn;
            }
            self.tune(&mut x, seed);
            let place = self.place(x);
            let rough: f64 = place.residuals.iter().map(|r| (r * r).ln_1p()).sum();
            (rough, place)
        });
        let best = draws.reduce(|a, b| if b.0 < a.0 { b } else { a });
        let start = match best {
            Some((_, place)) => place,
            None => self.place(vec![0.0; count]),
        };
        self.followed(start)
    }

    /// Makes one of the two modes that can ring in contact ring at the recorded frequency, by its spring: the slide on the structure, or head and
    /// workpiece on what carries this.
    fn tune(&self, x: &mut [f64], seed: u64) {
        let model = self.model(x);
        let Some(line) = self.targets.iter().find_map(Targets::line) else {
            return;
        };
        let square = (TAU * line).powi(2);
        let (index, mass) = if seed.is_multiple_of(2) {
            (
                STRUCTURE,
                (model.mass - model.head_mass).max(0.1 * model.mass),
            )
        } else {
            (BELOW, model.head_mass + model.workpiece_mass)
        };
        x[index] = (square * mass / self.usual[index]).ln() / USUAL[index].1;
    }

    fn followed(&self, start: Place) -> Solution {
        let mut place = start;
        let (mut damping, mut idle) = (1e-2, 0);
        for _ in 0..ITERATIONS {
            let (normal, slope) = self.normal(&place);
            let before = place.cost;
            for _ in 0..6 {
                if let Some(better) = self.step(&place, &normal, &slope, damping) {
                    place = better;
                    damping = f64::max(0.3 * damping, 1e-6);
                    break;
                }
                damping *= 4.0;
            }
            idle = if place.cost > before * (1.0 - GAIN) {
                idle + 1
            } else {
                0
            };
            if idle == 2 || damping > 1e6 {
                break;
            }
        }
        let (normal, _) = self.normal(&place);
        let excess = place.cost / (place.residuals.len() - place.x.len()).max(1) as f64;
        let covariance = normal.try_inverse();
        let deviations = std::array::from_fn(|i| {
            let variance = covariance.as_ref().map_or(1.0, |c| c[(i, i)]);
            USUAL[i].1 * (variance * excess.max(1.0)).clamp(0.0, 1.0).sqrt()
        });
        Solution {
            model: self.model(&place.x),
            cost: place.cost,
            deviations,
        }
    }

    fn step(
        &self,
        from: &Place,
        normal: &DMatrix<f64>,
        slope: &DVector<f64>,
        damping: f64,
    ) -> Option<Place> {
        let mut damped = normal.clone();
        for i in 0..damped.nrows() {
            damped[(i, i)] *= 1.0 + damping;
        }
        let step = damped.cholesky()?.solve(&-slope);
        let x = from.x.iter().zip(step.iter());
        let place = self.place(x.map(|(x, d)| x + d.clamp(-1.5, 1.5)).collect());
        (place.cost < from.cost).then_some(place)
    }

    /// J' W J and J' W r.
    fn normal(&self, at: &Place) -> (DMatrix<f64>, DVector<f64>) {
        let (rows, columns) = (at.residuals.len(), at.x.len());
        let mut jacobian = DMatrix::zeros(rows, columns);
        for column in 0..columns {
            // Of the logarithm of the number, whatever its prior's deviation.
            let step = DIFFERENCE / USUAL.get(column).map_or(1.0, |(_, deviation)| *deviation);
            let mut x = at.x.clone();
            x[column] += step;
            let moved = self.place(x);
            for row in 0..rows {
                jacobian[(row, column)] = (moved.residuals[row] - at.residuals[row]) / step;
            }
        }
        let mut weighted = jacobian.clone();
        for row in 0..rows {
            let weight = 1.0 / (1.0 + at.residuals[row].powi(2)).sqrt();
            weighted.row_mut(row).scale_mut(weight);
        }
        let slope = weighted.transpose() * DVector::from_column_slice(&at.residuals);
        (weighted.transpose() * jacobian, slope)
    }
}

pub(super) fn loss(residual: f64) -> f64 {
    2.0 * ((1.0 + residual * residual).sqrt() - 1.0)
}
