//! Bounded, robust least squares in the simulator: Levenberg-Marquardt on whitened residuals with priors.
//!
//! ```text
//! minimise   sum rho(r_i) + sum ((value - mean)/deviation)^2,     rho(r) = r^2 for |r| <= c,   2 c |r| - c^2 beyond    (Huber)
//! ```

pub(super) mod autocorrelation;
pub(super) mod covariance;
pub mod cross_validation;
pub mod free;
pub mod hypothesis;
pub(super) mod model_error;
pub(super) mod normal_equations;

use self::free::{Free, Prior};
use self::normal_equations::weighted_products;
use super::recordings::device::Device;
use super::recordings::evidence::{Evidence, Prediction};
use super::recordings::subject::Subject;
use super::settings::HUBER;
use crate::stats::quantile;
use nalgebra::{DMatrix, DVector};

/// Step of the difference quotients in the fit's coordinate [1].
const STEP: f64 = 0.03;
/// The same where the piston is not held: an impact that is met a tenth of a millisecond earlier reads quite another acceleration, and a wider quotient
/// is none of its slope.
const FINE_STEP: f64 = 0.003;
/// Gain below which a fit has come to its end, in units of a sum of squares [1].
const LEAST_GAIN: f64 = 0.05;

/// Share of its promise that a step by earlier derivatives must gain: one that gains less asks for new ones.
const KEPT_PROMISE: f64 = 0.7;
/// Steps by the same derivatives at most, beside the first.
const MOST_CHORDS: usize = 3;

/// Tries of a shorter step before an iteration is given up.
const MOST_TRIES: usize = 8;

/// A fitted description.
#[derive(Debug, Clone)]
pub struct Fit<S: Subject = Device> {
    /// Free quantities.
    pub free: Vec<Free<S>>,
    /// Values of the free quantities.
    pub values: Vec<f64>,
    /// The description with what it gives.
    pub prediction: Prediction<S>,
    /// Robust sum of squares of the samples [1].
    pub misfit: f64,
    /// Sum of a bounded loss that forgives errors in time, for the comparison of rough fits [1].
    pub rough: f64,
    /// Sum of squares of the priors [1].
    pub prior: f64,
    /// Derivatives of the residuals by the coordinates, one column each, from the last iteration.
    pub columns: Vec<Vec<f64>>,
    /// Information matrix in the fit's coordinates, priors included.
    pub information: DMatrix<f64>,
}

impl<S: Subject> Fit<S> {
    /// The objective of the fit.
    pub fn cost(&self) -> f64 {
        self.misfit + self.prior
    }

    /// Free quantities, to go on from where the fit is.
    pub fn free_from_here(&self) -> Vec<Free<S>> {
        let values = self.free.iter().zip(&self.values);
        values.map(|(f, value)| f.from(*value)).collect()
    }
}

/// Robust sum of squares.
pub fn robust_sum(residuals: &[f64]) -> f64 {
    residuals
        .iter()
        .filter(|r| !r.is_nan())
        .map(|r| loss(*r, HUBER))
        .sum()
}

/// Weight of a residual relative to one that is not far off [1].
pub fn robust_weight(residual: f64) -> f64 {
    (HUBER / residual.abs()).min(1.0)
}

/// Huber's loss beyond a limit.
pub(super) fn loss(residual: f64, limit: f64) -> f64 {
    let size = residual.abs().min(1e6);
    if size <= limit {
        size * size
    } else {
        limit * (2.0 * size - limit)
    }
}

/// Weights of the samples.
struct Weighing<'a> {
    /// One over what a residual is divided by.
    shares: &'a [f64],
    /// Where the loss turns from square to proportional, or to a logarithm.
    limit: f64,
    /// The logarithm (Cauchy): an impact that is met by one sample more or less counts for little.
    bounded: bool,
}

impl Weighing<'_> {
    fn sum(&self, residuals: &[f64]) -> f64 {
        let pairs = residuals
            .iter()
            .zip(self.shares)
            .filter(|(r, share)| !r.is_nan() && **share > 0.0);
        if self.bounded {
            let square = self.limit * self.limit;
            pairs
                .map(|(r, share)| square * ((r * share).powi(2).min(1e12) / square).ln_1p())
                .sum()
        } else {
            pairs.map(|(r, share)| loss(r * share, self.limit)).sum()
        }
    }

    /// Weights of the squares; none where there is no value.
    fn weights(&self, residuals: &[f64]) -> Vec<f64> {
        residuals
            .iter()
            .zip(self.shares)
            .map(|(r, share)| {
                if !r.is_finite() {
                    return 0.0;
                }
                let size = (r * share).abs();
                let weight = if self.bounded {
                    1.0 / (1.0 + (size / self.limit).powi(2))
                } else if size <= self.limit {
                    1.0
                } else {
                    self.limit / size
                };
                share * share * weight
            })
            .collect()
    }
}

/// Where the loss turns from square to proportional for now: far out while much is unexplained, because a proportional loss has no curvature and
/// converges slowly; at `HUBER` in the end.
fn limit_for(residuals: &[f64], shares: &[f64]) -> f64 {
    let finite = residuals.iter().zip(shares).filter(|(r, _)| r.is_finite());
    let high = quantile(finite.map(|(r, share)| (r * share).abs()), 0.98);
    // Of noise alone, one in fifty is beyond 2.33.
    HUBER * (high.unwrap_or(0.0) / 2.5).max(1.0)
}

fn prior_sum<S: Subject>(free: &[Free<S>], values: &[f64]) -> f64 {
    free.iter()
        .zip(values)
        .map(|(f, v)| f.departure(*v).powi(2))
        .sum()
}

/// A description with quantities set.
pub fn with_values<S: Subject>(plant: &S::Model, free: &[Free<S>], values: &[f64]) -> S::Model {
    let mut changed = plant.clone();
    for (f, value) in free.iter().zip(values) {
        S::set(&f.quantity, &mut changed, *value);
    }
    changed
}

/// Derivatives of the residuals by the coordinates of `free[from..]`.
pub fn jacobian<S: Subject>(
    evidence: &Evidence<S>,
    here: &Prediction<S>,
    free: &[Free<S>],
    values: &[f64],
    from: usize,
) -> Vec<Vec<f64>> {
    let mut steps = Vec::with_capacity(free.len());
    let plants: Vec<S::Model> = (from..free.len())
        .map(|i| {
            let f = &free[i];
            let at = f.coordinate.of(values[i]);
            let mut step = if here.guided { STEP } else { FINE_STEP };
            if f.coordinate.value(at + step) > f.bounds[1] {
                step = -step;
            }
            steps.push(step);
            let mut plant = here.plant.clone();
            S::set(&f.quantity, &mut plant, f.coordinate.value(at + step));
            plant
        })
        .collect();
    let mut columns = evidence.residuals_of(&plants, here);
    for (column, step) in columns.iter_mut().zip(steps) {
        for (moved, here) in column.iter_mut().zip(&here.residuals) {
            *moved = (*moved - here) / step;
        }
    }
    columns
}

/// Information and gradient with the samples' weights, priors included.
fn normal_equations<S: Subject>(
    columns: &[Vec<f64>],
    residuals: &[f64],
    weighing: &Weighing<'_>,
    free: &[Free<S>],
    values: &[f64],
) -> (DMatrix<f64>, DVector<f64>) {
    let weights = weighing.weights(residuals);
    let (mut information, mut gradient) = weighted_products(columns, residuals, &weights);
    for (i, f) in free.iter().enumerate() {
        let slope = f.departure_slope(values[i]);
        information[(i, i)] += slope * slope;
        gradient[i] += slope * f.departure(values[i]);
    }
    (information, gradient)
}

/// A stage of a fit.
#[derive(Debug, Clone, Copy)]
pub struct Stage {
    /// Errors in time that are forgiven [s]: a model that is still far off meets impacts at other times than the device, and their spikes would hold it
    /// there.
    pub forgiven: f64,
    /// Whether the piston is held to its measured motion.
    pub guided: bool,
    /// Whether the loss is bounded.
    pub bounded: bool,
    /// Share of the cost that an iteration must gain for the stage to go on [1].
    pub gain: f64,
}

/// A rough fit: what it gains says whether a full one is worth its while.
pub const ROUGH: &[Stage] = &[Stage {
    forgiven: ROUGH_TIME,
    guided: true,
    bounded: false,
    gain: 1e-3,
}];
/// A full fit, one stage after the other.
pub const FULL: &[Stage] = &[
    Stage {
        forgiven: ROUGH_TIME,
        guided: true,
        bounded: false,
        gain: 1e-3,
    },
    Stage {
        forgiven: 0.001,
        guided: false,
        bounded: true,
        gain: 1e-3,
    },
    Stage {
        forgiven: 1e-4,
        guided: false,
        bounded: true,
        gain: 1e-3,
    },
    Stage {
        forgiven: 0.0,
        guided: false,
        bounded: true,
        gain: 3e-4,
    },
    Stage {
        forgiven: 0.0,
        guided: false,
        bounded: false,
        gain: 0.0,
    },
];
/// The last stage of a full fit alone.
pub const FINEST: &[Stage] = FULL.split_at(FULL.len() - 1).1;
/// Error in time that a rough fit forgives [s].
const ROUGH_TIME: f64 = 0.006;

/// Where a fit ends at the latest.
#[derive(Debug, Clone, Copy)]
pub struct Limit {
    /// Iterations at most.
    pub iterations: usize,
    /// Longest step in a coordinate [1].
    pub longest_step: f64,
}

impl Limit {
    /// That of a full fit.
    pub const FULL: Self = Self::of(40);

    /// So many iterations, with steps for the numbers of laws.
    pub const fn of(iterations: usize) -> Self {
        Self {
            iterations,
            longest_step: 3.0,
        }
    }

    /// So many iterations, with steps as long as a curve without a law may need.
    pub const fn of_curve(iterations: usize) -> Self {
        Self {
            iterations,
            longest_step: 30.0,
        }
    }
}

/// Start of a fit.
#[derive(Debug)]
pub enum Start<'a, S: Subject = Device> {
    /// Where it was; what is tolerated from its nominal value, because a model that lacks something bends it out of shape.
    Nominal,
    /// Where it was.
    Here,
    /// Where another description stands: impacts make many minima, and a fit comes to rest in one of them. What another gains by having come to a better
    /// one is not what it has more.
    Where(&'a S::Model),
}

#[expect(
    clippy::expl_impl_clone_on_copy,
    reason = "a derive asks that the model itself may be copied"
)]
impl<S: Subject> Clone for Start<'_, S> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<S: Subject> Copy for Start<'_, S> {}

/// A fit of what a hypothesis has free.
#[derive(Debug, Clone, Copy)]
pub struct Refit<'a, S: Subject = Device> {
    /// Its start.
    pub start: Start<'a, S>,
    /// Its stages.
    pub stages: &'a [Stage],
    /// Its end.
    pub limit: Limit,
}

impl<'a, S: Subject> Refit<'a, S> {
    /// The full fit from where it was.
    pub const FULL: Self = Self {
        start: Start::Nominal,
        stages: FULL,
        limit: Limit::FULL,
    };
    /// The finest measure alone.
    pub const FINEST: Self = Self {
        stages: FINEST,
        ..Self::FULL
    };
    /// The rough fit.
    pub const ROUGH: Self = Self {
        stages: ROUGH,
        limit: Limit::of(15),
        ..Self::FULL
    };

    /// The same from another start.
    #[must_use]
    pub const fn from(self, start: Start<'a, S>) -> Self {
        Self { start, ..self }
    }

    /// The same with another end.
    #[must_use]
    pub const fn until(self, limit: Limit) -> Self {
        Self { limit, ..self }
    }

    /// What is free in a fit, from this start.
    pub fn free(&self, fitted: &Fit<S>) -> Vec<Free<S>> {
        let here = fitted.free_from_here().into_iter();
        match self.start {
            Start::Here => here.collect(),
            Start::Where(there) => here.map(|f| f.from_where(there)).collect(),
            Start::Nominal => here
                .map(|f| match f.prior {
                    Prior::Normal { mean, .. } => f.from(mean),
                    Prior::Flat | Prior::Settled { .. } => f,
                })
                .collect(),
        }
    }
}

/// Cost of a prediction by the rough measure: the piston held to its measured motion.
fn rough_cost<S: Subject>(evidence: &Evidence<S>, prediction: &Prediction<S>) -> f64 {
    let shares = evidence.shares(ROUGH[0].forgiven, ROUGH[0].guided);
    let held = (!prediction.guided).then(|| evidence.predict(&prediction.plant, true, None));
    let weighing = Weighing {
        shares: &shares,
        limit: HUBER,
        bounded: ROUGH[0].bounded,
    };
    weighing.sum(&held.as_ref().unwrap_or(prediction).residuals)
}

/// A fit on its way.
struct Walk<'a, S: Subject> {
    evidence: &'a Evidence<S>,
    free: &'a [Free<S>],
    values: Vec<f64>,
    /// Prediction at these values.
    here: Prediction<S>,
    /// Penalty of the prior at these values [1].
    prior: f64,
    /// Levenberg and Marquardt's damping [1].
    damping: f64,
    longest_step: f64,
    /// Number of columns that are kept as they are.
    frozen: usize,
    /// Derivatives of the residuals by the coordinates.
    columns: Vec<Vec<f64>>,
    /// Whether the piston was held when they were found; none before.
    derived: Option<bool>,
    /// Whether the fit has moved since.
    moved: bool,
    /// Information matrix of the last iteration.
    information: DMatrix<f64>,
}

impl<S: Subject> Walk<'_, S> {
    /// Goes through a stage, in no more iterations than are `left`.
    fn through(&mut self, stage: &Stage, left: &mut usize) {
        if self.here.guided != stage.guided {
            self.here = (self.evidence).predict(&self.here.plant, stage.guided, None);
        }
        let shares = self.evidence.shares(stage.forgiven, stage.guided);
        while *left > 0 {
            if self.goes_on(stage, &shares) == Chord::Ends {
                return;
            }
            *left -= 1;
            self.derive();
            let iteration = Iteration::of(self, &shares, stage);
            let gain = self.iterate(&iteration);
            self.moved |= gain > 0.0;
            self.information = iteration.normal;
            if gain < iteration.enough {
                return;
            }
        }
    }

    /// Goes on by derivatives of earlier places while steps keep their promise. The end of a stage that ends short of the least is left to those.
    fn goes_on(&mut self, stage: &Stage, shares: &[f64]) -> Chord {
        if self.derived != Some(stage.guided) || !self.moved {
            return Chord::Fails;
        }
        for _ in 0..MOST_CHORDS {
            let iteration = Iteration::of(self, shares, stage);
            let chord = self.chord(&iteration);
            self.information = iteration.normal;
            match chord {
                Chord::Gains => (),
                Chord::Ends if stage.gain > 0.0 => return Chord::Ends,
                Chord::Ends | Chord::Fails => return Chord::Fails,
            }
        }
        Chord::Gains
    }

    /// Finds the derivatives anew, unless they are those of this place.
    fn derive(&mut self) {
        let guided = Some(self.here.guided);
        if self.derived == guided && !self.moved {
            return;
        }
        self.columns.truncate(self.frozen);
        let open = jacobian(
            self.evidence,
            &self.here,
            self.free,
            &self.values,
            self.frozen,
        );
        self.columns.extend(open);
        (self.derived, self.moved) = (guided, false);
    }

    /// Steps more and more damped, until one gains or none promises to. Returns the gain.
    fn iterate(&mut self, iteration: &Iteration<'_>) -> f64 {
        for _ in 0..MOST_TRIES {
            let Some((tried, promised)) = self.step(iteration) else {
                self.damping *= 10.0;
                continue;
            };
            if promised < LEAST_GAIN {
                break;
            }
            let gain = self.try_step(iteration, tried, 0.0);
            if gain > 0.0 {
                self.damping = (self.damping * 0.1).max(1e-6);
                return gain;
            }
            self.damping *= 10.0;
        }
        0.0
    }

    /// One step by derivatives of an earlier place, taken if it keeps its promise; none where it promises no more than ends the stage.
    fn chord(&mut self, iteration: &Iteration<'_>) -> Chord {
        match self.step(iteration) {
            Some((_, promised)) if promised < iteration.enough => Chord::Ends,
            Some((tried, promised)) => {
                match self.try_step(iteration, tried, KEPT_PROMISE * promised) > 0.0 {
                    true => Chord::Gains,
                    false => Chord::Fails,
                }
            }
            None => Chord::Fails,
        }
    }

    fn step(&self, iteration: &Iteration<'_>) -> Option<(Vec<f64>, f64)> {
        step(
            self.free,
            &self.values,
            &iteration.normal,
            &iteration.gradient,
            self.damping,
            self.longest_step,
        )
    }

    /// Goes to values that gain more than `least`; gives the gain, 0 where it stays.
    fn try_step(&mut self, iteration: &Iteration<'_>, tried: Vec<f64>, least: f64) -> f64 {
        let plant = with_values(&self.here.plant, self.free, &tried);
        let there = (self.evidence).predict(&plant, self.here.guided, Some(&self.here));
        let prior = prior_sum(self.free, &tried);
        let gain = iteration.before - (iteration.weighing.sum(&there.residuals) + prior);
        if gain > least {
            (self.values, self.here, self.prior) = (tried, there, prior);
            return gain;
        }
        0.0
    }
}

/// What a step by earlier derivatives came to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Chord {
    /// It gains about what it promised.
    Gains,
    /// It promises no more than ends a stage.
    Ends,
    /// It gains less than it promised.
    Fails,
}

/// The least squares about where a fit is.
struct Iteration<'a> {
    weighing: Weighing<'a>,
    /// Cost there [1].
    before: f64,
    /// Gain below which the stage has come to its end [1].
    enough: f64,
    normal: DMatrix<f64>,
    gradient: DVector<f64>,
}

impl<'a> Iteration<'a> {
    /// Of a fit with its derivatives, by samples of these shares.
    fn of<S: Subject>(walk: &Walk<'_, S>, shares: &'a [f64], stage: &Stage) -> Self {
        let residuals = &walk.here.residuals;
        let weighing = Weighing {
            shares,
            limit: limit_for(residuals, shares),
            bounded: stage.bounded,
        };
        let (normal, gradient) =
            normal_equations(&walk.columns, residuals, &weighing, walk.free, &walk.values);
        let before = weighing.sum(residuals) + walk.prior;
        Self {
            weighing,
            before,
            enough: LEAST_GAIN.max(stage.gain * before),
            normal,
            gradient,
        }
    }
}

/// Fits free quantities from where they start, the derivatives by the first of them `frozen`; `known` may spare simulations.
pub fn fit<S: Subject>(
    evidence: &Evidence<S>,
    (plant, known): (&S::Model, Option<&Prediction<S>>),
    (free, frozen): (&[Free<S>], &[Vec<f64>]),
    stages: &[Stage],
    limit: Limit,
) -> Fit<S> {
    let values: Vec<f64> = free.iter().map(|f| f.clamp(f.start)).collect();
    let mut walk = Walk {
        evidence,
        free,
        here: evidence.predict(&with_values(plant, free, &values), stages[0].guided, known),
        prior: prior_sum(free, &values),
        values,
        damping: 1e-4,
        longest_step: limit.longest_step,
        frozen: frozen.len(),
        columns: frozen.to_vec(),
        derived: None,
        moved: false,
        information: DMatrix::zeros(free.len(), free.len()),
    };
    let mut left = limit.iterations;
    for stage in stages {
        walk.through(stage, &mut left);
    }
    let Walk {
        values,
        here,
        prior,
        columns,
        information,
        ..
    } = walk;
    let misfit = robust_sum(&here.residuals);
    let rough = rough_cost(evidence, &here) + prior;
    Fit {
        free: free.to_vec(),
        values,
        prediction: here,
        misfit,
        rough,
        prior,
        columns,
        information,
    }
}

/// Cost that a description could come to in a stage by one step, and where, by the derivatives known, without a simulation more.
pub fn linearised_cost<S: Subject>(
    evidence: &Evidence<S>,
    there: &Prediction<S>,
    free: &[Free<S>],
    values: &[f64],
    columns: &[Vec<f64>],
    stage: &Stage,
) -> (f64, Vec<f64>) {
    let shares = evidence.shares(stage.forgiven, stage.guided);
    let weighing = |limit| Weighing {
        shares: &shares,
        limit,
        bounded: stage.bounded,
    };
    let wide = weighing(limit_for(&there.residuals, &shares));
    let (normal, gradient) = normal_equations(columns, &there.residuals, &wide, free, values);
    let mut adjusted = there.residuals.clone();
    let mut reached = values.to_vec();
    if let Some((tried, _)) = step(free, values, &normal, &gradient, 1e-4, 3.0) {
        for ((f, (from, to)), column) in free.iter().zip(values.iter().zip(&tried)).zip(columns) {
            let moved = f.coordinate.of(*to) - f.coordinate.of(*from);
            let known = adjusted.iter_mut().zip(column);
            for (residual, slope) in known.filter(|(_, slope)| slope.is_finite()) {
                *residual += moved * slope;
            }
        }
        reached = tried;
    }
    (weighing(HUBER).sum(&adjusted), reached)
}

/// Damped step to where the quadratic model is least within the bounds, by an active set: values tried and the gain promised.
fn step<S: Subject>(
    free: &[Free<S>],
    values: &[f64],
    normal: &DMatrix<f64>,
    gradient: &DVector<f64>,
    damping: f64,
    longest: f64,
) -> Option<(Vec<f64>, f64)> {
    let count = free.len();
    let mut damped = normal.clone();
    for i in 0..count {
        damped[(i, i)] += damping * normal[(i, i)].max(1e-9);
    }
    // Ways to the bounds in the coordinates.
    let room: Vec<[f64; 2]> = free.iter().zip(values).map(|(f, v)| f.room(*v)).collect();
    // Where a coordinate is held at a bound, its way there.
    let mut held: Vec<Option<f64>> = vec![None; count];
    let mut way = DVector::zeros(count);
    for _ in 0..=count {
        let open: Vec<usize> = (0..count).filter(|i| held[*i].is_none()).collect();
        let mut reduced = DMatrix::zeros(open.len(), open.len());
        let mut right = DVector::zeros(open.len());
        for (a, &i) in open.iter().enumerate() {
            for (b, &j) in open.iter().enumerate() {
                reduced[(a, b)] = damped[(i, j)];
            }
            let known: f64 = (0..count)
                .filter_map(|j| held[j].map(|way| damped[(i, j)] * way))
                .sum();
            right[a] = -gradient[i] - known;
        }
        let solved = reduced.cholesky()?.solve(&right);
        let mut furthest: Option<(f64, usize, f64)> = None;
        for (a, &i) in open.iter().enumerate() {
            way[i] = solved[a];
            let bound = if solved[a] < 0.0 {
                room[i][0]
            } else {
                room[i][1]
            };
            let beyond = solved[a].abs() - bound.abs();
            if beyond > 1e-12 && furthest.is_none_or(|(most, _, _)| beyond > most) {
                furthest = Some((beyond, i, bound));
            }
        }
        for i in 0..count {
            if let Some(bound) = held[i] {
                way[i] = bound;
            }
        }
        match furthest {
            None => break,
            Some((_, i, bound)) => held[i] = Some(bound),
        }
    }
    let largest = way.amax();
    if largest > longest {
        way *= longest / largest;
    }
    let promised = -2.0 * gradient.dot(&way) - way.dot(&(normal * &way));
    let tried = free
        .iter()
        .zip(values)
        .zip(way.iter())
        .map(|((f, v), w)| f.clamp(f.coordinate.value(f.coordinate.of(*v) + w)))
        .collect();
    Some((tried, promised))
}

/// The rough cost that noise alone has [1].
pub fn rough_noise<S: Subject>(evidence: &Evidence<S>) -> f64 {
    let shares = evidence.shares(ROUGH[0].forgiven, ROUGH[0].guided);
    let readings = evidence
        .recordings
        .iter()
        .flat_map(|m| m.readings.as_ref())
        .flatten();
    readings
        .zip(shares.iter())
        .filter(|(value, _)| value.is_finite())
        .map(|(_, share)| share * share)
        .sum::<f64>()
        * evidence.worth
}
