//! A fit on its way: Levenberg and Marquardt's steps within bounds, by derivatives that serve for several of them.

use super::free::Free;
use super::normal_equations::weighted_products;
use super::stage::{Limit, Stage};
use super::weighing::{Weighing, limit_for};
use crate::diagnosis::recordings::evidence::{Evidence, Prediction};
use crate::diagnosis::recordings::subject::Subject;
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
pub(super) fn normal_equations<S: Subject>(
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

/// A fit on its way.
pub(super) struct Walk<'a, S: Subject> {
    evidence: &'a Evidence<S>,
    free: &'a [Free<S>],
    pub values: Vec<f64>,
    /// Prediction at these values.
    pub here: Prediction<S>,
    /// Penalty of the prior at these values [1].
    pub prior: f64,
    /// Levenberg and Marquardt's damping [1].
    damping: f64,
    longest_step: f64,
    /// Number of columns that are kept as they are.
    frozen: usize,
    /// Derivatives of the residuals by the coordinates.
    pub columns: Vec<Vec<f64>>,
    /// Whether the piston was held when they were found; none before.
    derived: Option<bool>,
    /// Whether the fit has moved since.
    moved: bool,
    /// Information matrix of the last iteration.
    pub information: DMatrix<f64>,
}

impl<'a, S: Subject> Walk<'a, S> {
    /// A fit where its free quantities start, the derivatives by the first of them `frozen`; `known` may spare simulations.
    pub fn new(
        evidence: &'a Evidence<S>,
        (plant, known): (&S::Model, Option<&Prediction<S>>),
        (free, frozen): (&'a [Free<S>], &[Vec<f64>]),
        guided: bool,
        limit: Limit,
    ) -> Self {
        let values: Vec<f64> = free.iter().map(|f| f.clamp(f.start)).collect();
        Self {
            evidence,
            free,
            here: evidence.predict(&with_values(plant, free, &values), guided, known),
            prior: prior_sum(free, &values),
            values,
            damping: 1e-4,
            longest_step: limit.longest_step,
            frozen: frozen.len(),
            columns: frozen.to_vec(),
            derived: None,
            moved: false,
            information: DMatrix::zeros(free.len(), free.len()),
        }
    }

    /// Goes through a stage, in no more iterations than are `left`.
    pub fn through(&mut self, stage: &Stage, left: &mut usize) {
        if self.here.guided != stage.guided {
            self.here = (self.evidence).predict(&self.here.plant, stage.guided, None);
        }
        let shares = self.evidence.shares(stage.forgiven, stage.guided);
        while *left > 0 {
            self.go_on(stage, &shares);
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

    /// Goes on by derivatives of an earlier place while steps keep their promise. They end no stage: what they promise no more, new ones may.
    fn go_on(&mut self, stage: &Stage, shares: &[f64]) {
        if self.derived != Some(stage.guided) || !self.moved {
            return;
        }
        for _ in 0..MOST_CHORDS {
            let iteration = Iteration::of(self, shares, stage);
            if !self.chord(&iteration) {
                return;
            }
        }
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

    /// One step by derivatives of an earlier place, taken if it keeps its promise; says whether it was.
    fn chord(&mut self, iteration: &Iteration<'_>) -> bool {
        self.step(iteration).is_some_and(|(tried, promised)| {
            promised >= iteration.enough
                && self.try_step(iteration, tried, KEPT_PROMISE * promised) > 0.0
        })
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

/// Damped step to where the quadratic model is least within the bounds, by an active set: values tried and the gain promised.
pub(super) fn step<S: Subject>(
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
