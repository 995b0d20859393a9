//! Least squares of a recorded arm's numbers within their bounds.
//!
//! ```text
//! min sum over channels of |m - y(x)|^2/s_c^2 + sum ((x - c)/d)^2,    l <= x <= u
//! ```
//!
//! m measured, y model, both over the sensor's noise; s_c what the channel leaves beyond it [1], c centre, d standard deviation of a number that is known
//! within bounds: half their distance over the square root of three, that of a uniform distribution.

use std::collections::BTreeMap;
use std::sync::Arc;

use nalgebra::{DMatrix, DVector};

use super::evidence::{Column, Course, Evidence};
use super::quadratic::least_within;
use crate::recorded_arm::Tolerated;
use crate::recorded_arm::{ArmParameters, Quantity};

/// A number that a fit moves.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Parameter {
    /// The number.
    pub quantity: Quantity,
    /// Least and largest value.
    pub bounds: [f64; 2],
    /// Centre and standard deviation of what is known of it beforehand; none of a number that is free.
    pub prior: Option<[f64; 2]>,
}

impl Parameter {
    /// Known within bounds.
    #[must_use]
    pub fn tolerated(tolerated: &Tolerated) -> Self {
        let [low, high] = tolerated.bounds;
        Self {
            quantity: tolerated.quantity,
            bounds: tolerated.bounds,
            prior: Some([0.5 * (low + high), 0.5 * (high - low) / 3f64.sqrt()]),
        }
    }

    /// Known by nothing but bounds.
    #[must_use]
    pub fn free(quantity: Quantity, bounds: [f64; 2]) -> Self {
        Self {
            quantity,
            bounds,
            prior: None,
        }
    }
}

/// Scales of the channels' residuals beyond the noise [1].
pub type Scales = Vec<f64>;

/// A fit.
#[derive(Debug, Clone)]
pub struct Fit {
    /// The model.
    pub arm: ArmParameters,
    /// Numbers that were moved.
    pub parameters: Vec<Parameter>,
    /// Residuals by channel and row, over the noise.
    pub residuals: Column,
    /// Sum of squares over the scales, with that of the priors.
    pub cost: f64,
    /// Its curvature.
    pub hessian: DMatrix<f64>,
    /// Course of the model.
    pub course: Course,
}

impl Fit {
    /// Part of the cost that is not the recordings': how far numbers lie from what is known of them.
    #[must_use]
    pub fn prior_cost(&self) -> f64 {
        prior_cost(&self.arm, &self.parameters)
    }
}

fn prior_cost(arm: &ArmParameters, parameters: &[Parameter]) -> f64 {
    let prior = |p: &Parameter| match p.prior {
        Some([centre, deviation]) => ((p.quantity.value(arm) - centre) / deviation).powi(2),
        None => 0.0,
    };
    parameters.iter().map(prior).sum()
}

/// Derivatives that were computed at one model, for fits near it.
#[derive(Debug, Default)]
pub struct Columns {
    known: BTreeMap<Quantity, Arc<Column>>,
    products: BTreeMap<(Quantity, Quantity), Vec<f64>>,
}

impl Columns {
    /// Derivative by a quantity, at a course if it is not known.
    pub fn of(&mut self, evidence: &Evidence, course: &Course, quantity: Quantity) -> Arc<Column> {
        let known = self.known.entry(quantity);
        let column = known.or_insert_with(|| Arc::new(evidence.derivative(course, quantity)));
        Arc::clone(column)
    }

    /// Products of two columns by channel.
    pub fn product(&mut self, a: (Quantity, &Column), b: (Quantity, &Column)) -> &[f64] {
        let key = (a.0.min(b.0), a.0.max(b.0));
        (self.products)
            .entry(key)
            .or_insert_with(|| products(a.1, b.1))
    }

    /// Forgets quantities whose derivatives change with the model.
    pub fn forget(&mut self, which: impl Fn(Quantity) -> bool) {
        self.known.retain(|quantity, _| !which(*quantity));
        self.products.retain(|(a, b), _| !which(*a) && !which(*b));
    }
}

/// Products of two columns by channel.
#[must_use]
pub fn products(a: &Column, b: &Column) -> Vec<f64> {
    let channels = a.iter().zip(b);
    channels
        .map(|(a, b)| {
            if a.is_empty() || b.is_empty() {
                return 0.0;
            }
            a.iter().zip(b).map(|(a, b)| a * b).sum()
        })
        .collect()
}

/// Sum over channels of products over the squares of the scales.
#[must_use]
pub fn weighed(products: &[f64], scales: &[f64]) -> f64 {
    let channels = products.iter().zip(scales);
    channels.map(|(p, s)| p / (s * s)).sum()
}

/// Steps of a fit at most.
const STEPS: usize = 8;
/// Decrease of the cost below which a fit is done [1].
const DONE: f64 = 0.02;

/// Fits numbers from a model on.
#[must_use]
pub fn fit(
    evidence: &Evidence,
    start: (&ArmParameters, Option<&Course>),
    parameters: &[Parameter],
    scales: &[f64],
    columns: &mut Columns,
) -> Fit {
    let mut arm = start.0.clone();
    for parameter in parameters {
        let value = parameter.quantity.value(&arm);
        let [low, high] = parameter.bounds;
        if !(low..=high).contains(&value) {
            parameter.quantity.set(&mut arm, value.clamp(low, high));
        }
    }
    let mut course = evidence.course(&arm, start.1);
    let mut residuals = residuals_of(evidence, &course);
    let mut cost = cost_of(&arm, &residuals, parameters, scales);
    let mut hessian = DMatrix::zeros(0, 0);
    let mut fresh = false;
    let mut step = 0;
    while step < STEPS {
        if step > 0 {
            columns.forget(is_curved);
        }
        let (curvature, gradient) =
            normal_equations(evidence, &course, &residuals, parameters, scales, columns);
        let values: Vec<f64> = parameters.iter().map(|p| p.quantity.value(&arm)).collect();
        let room: Vec<[f64; 2]> = (parameters.iter().zip(&values))
            .map(|(p, value)| p.bounds.map(|bound| bound - value))
            .collect();
        let change = least_within(&curvature, &gradient, &room, &vec![0.0; values.len()]);
        hessian = curvature;
        let mut share = 1.0;
        let mut better = None;
        for _ in 0..5 {
            let mut tried = arm.clone();
            for ((parameter, value), change) in parameters.iter().zip(&values).zip(&change) {
                parameter.quantity.set(&mut tried, value + share * change);
            }
            let along = evidence.course(&tried, Some(&course));
            let left = residuals_of(evidence, &along);
            let found = cost_of(&tried, &left, parameters, scales);
            if found < cost {
                better = Some((tried, along, left, found));
                break;
            }
            share *= 0.4;
        }
        step += 1;
        let Some((tried, along, left, found)) = better else {
            // Derivatives of a model that was another one may point anywhere.
            if fresh {
                break;
            }
            columns.forget(|_| true);
            fresh = true;
            continue;
        };
        let gained = cost - found;
        (arm, course, residuals, cost) = (tried, along, left, found);
        if gained < DONE {
            break;
        }
    }
    Fit {
        arm,
        parameters: parameters.to_vec(),
        residuals,
        cost,
        hessian,
        course,
    }
}

/// Quantities on which readings do not depend linearly.
#[must_use]
pub fn is_curved(quantity: Quantity) -> bool {
    use Quantity as Q;
    matches!(
        quantity,
        Q::BristleLength(_)
            | Q::StaticExcess(_)
            | Q::StribeckVelocity(_)
            | Q::WarmFraction(_)
            | Q::WarmTime(_)
            | Q::Ripple(..)
            | Q::RippleCycles(_)
            | Q::Compliance(_)
            | Q::EncoderOffset(_)
            | Q::PayloadMass
            | Q::PayloadMoment(_)
            | Q::Tilt(_)
            | Q::SensorRotation
            | Q::ToolMass
            | Q::ToolCentre(_)
            | Q::Delay
            | Q::PushForce(..)
            | Q::PushStart(_)
            | Q::PushEnd(_)
            | Q::PushEdge(_)
            | Q::LawAmplitude(..)
            | Q::LawPlace(_)
            | Q::LawWidth(_)
    )
}

/// What a course leaves of the measured values, over the noise.
#[must_use]
pub fn residuals_of(evidence: &Evidence, course: &Course) -> Column {
    let all: Vec<usize> = (0..evidence.rows.len()).collect();
    let mut values = evidence.values(course, &all);
    for (values, measured) in values.iter_mut().zip(&evidence.measured) {
        for (value, measured) in values.iter_mut().zip(measured) {
            *value = measured - *value;
        }
    }
    values
}

fn cost_of(
    arm: &ArmParameters,
    residuals: &Column,
    parameters: &[Parameter],
    scales: &[f64],
) -> f64 {
    weighed(&products(residuals, residuals), scales) + prior_cost(arm, parameters)
}

/// Curvature and downhill gradient of half the cost.
fn normal_equations(
    evidence: &Evidence,
    course: &Course,
    residuals: &Column,
    parameters: &[Parameter],
    scales: &[f64],
    columns: &mut Columns,
) -> (DMatrix<f64>, DVector<f64>) {
    let count = parameters.len();
    let each: Vec<(Quantity, Arc<Column>)> = parameters
        .iter()
        .map(|p| (p.quantity, columns.of(evidence, course, p.quantity)))
        .collect();
    let mut hessian = DMatrix::zeros(count, count);
    let mut gradient = DVector::zeros(count);
    for (i, (quantity, column)) in each.iter().enumerate() {
        gradient[i] = weighed(&products(column, residuals), scales);
        for (j, (other, with)) in each.iter().enumerate().take(i + 1) {
            let value = weighed(columns.product((*quantity, column), (*other, with)), scales);
            hessian[(i, j)] = value;
            hessian[(j, i)] = value;
        }
        if let Some([centre, deviation]) = parameters[i].prior {
            hessian[(i, i)] += 1.0 / (deviation * deviation);
            gradient[i] += (centre - quantity.value(course.arm())) / (deviation * deviation);
        }
        // A number that moves nothing stays where it is.
        hessian[(i, i)] = hessian[(i, i)] * (1.0 + 1e-9) + 1e-12;
    }
    (hessian, gradient)
}

/// What channels leave beyond the noise: root mean square over it.
#[must_use]
pub fn scales_of(residuals: &Column) -> Scales {
    let channels = residuals.iter();
    let scale = |r: &Vec<f64>| {
        let square = r.iter().map(|r| r * r).sum::<f64>() / r.len().max(1) as f64;
        square.sqrt().max(LEAST)
    };
    channels.map(scale).collect()
}

/// Share of the noise that is declared below which a channel's is not taken to be [1].
const LEAST: f64 = 0.2;
/// Samples of a block within which residuals may be alike.
const BLOCK: usize = 40;

/// Samples of a channel that count as one, since what a model leaves goes on from one to the next [1].
///
/// ```text
/// t = n var(mean of a block of n)/var
/// ```
#[must_use]
pub fn correlation_of(residuals: &Column) -> Vec<f64> {
    let of = |r: &Vec<f64>| {
        let square = r.iter().map(|r| r * r).sum::<f64>() / r.len().max(1) as f64;
        let blocks = r.chunks_exact(BLOCK);
        let count = blocks.len().max(1) as f64;
        let sums = blocks.map(|block| block.iter().sum::<f64>().powi(2));
        let between = sums.sum::<f64>() / (count * BLOCK as f64);
        (between / square.max(1e-300)).clamp(1.0, BLOCK as f64)
    };
    residuals.iter().map(of).collect()
}
