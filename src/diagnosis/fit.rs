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
mod stage;
mod walk;
mod weighing;

pub use self::stage::{FINEST, FULL, Limit, ROUGH, Stage};
pub use self::walk::{jacobian, with_values};
pub(super) use self::weighing::loss;
pub use self::weighing::{robust_sum, robust_weight};

use self::free::{Free, Prior};
use self::walk::{Walk, normal_equations, step};
use self::weighing::{Weighing, limit_for};
use super::recordings::device::Device;
use super::recordings::evidence::{Evidence, Prediction};
use super::recordings::subject::Subject;
use super::settings::HUBER;
use nalgebra::DMatrix;

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

/// Fits free quantities from where they start, the derivatives by the first of them `frozen`; `known` may spare simulations.
pub fn fit<S: Subject>(
    evidence: &Evidence<S>,
    (plant, known): (&S::Model, Option<&Prediction<S>>),
    (free, frozen): (&[Free<S>], &[Vec<f64>]),
    stages: &[Stage],
    limit: Limit,
) -> Fit<S> {
    let mut walk = Walk::new(
        evidence,
        (plant, known),
        (free, frozen),
        stages[0].guided,
        limit,
    );
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
