//! Which axes the readings are given in: every frame fitted, with its probability.

use std::f64::consts::PI;

use nalgebra::{Matrix3, Vector3};

use super::Posture;
use super::estimate::numbers;
use super::fit::{Fit, fit};
use super::frame::{Frame, Turn};
use super::nominal::{Bounded, Nominal};

/// Share of bases that stand tilted anyhow [1].
const TILTED: f64 = 0.05;
/// Share of declared numbers that are wrong by anything [1].
const WRONG: f64 = 0.1;
/// Size of what a wrong mass [kg], centre [m], force [N] and torque [N m] may be.
const WIDTHS: [f64; 4] = [10.0, 0.5, 50.0, 5.0];
/// Most that is stated of one [1].
pub const SUREST: f64 = 0.98;

/// A frame with its fit.
#[derive(Debug, Clone)]
pub struct Candidate {
    /// The fit.
    pub fit: Fit,
    /// Probability that it is the one [1].
    pub probability: f64,
}

/// All frames that the postures can be fitted in, the likeliest first; nothing where they do not tell the numbers.
#[must_use]
pub fn candidates(postures: &[Posture], nominal: &Nominal) -> Vec<Candidate> {
    let fits = Frame::all()
        .into_iter()
        .filter_map(|frame| fit(postures, frame, nominal));
    let mut weighed: Vec<(f64, Fit)> = fits
        .filter(|fit| !is_within(fit, nominal))
        .map(|fit| signed(fit, nominal.gravity))
        .map(|fit| (worth(&fit, postures, nominal), fit))
        .collect();
    weighed.sort_by(|a, b| b.0.total_cmp(&a.0));
    let best = weighed.first().map_or(0.0, |(worth, _)| *worth);
    let whole: f64 = weighed.iter().map(|(worth, _)| (worth - best).exp()).sum();
    let of = |(worth, fit): (f64, Fit)| Candidate {
        fit,
        probability: ((worth - best).exp() / whole).min(SUREST),
    };
    weighed.into_iter().map(of).collect()
}

/// Whether a turn that is free has come out as one that a plainer frame has.
fn is_within(fit: &Fit, nominal: &Nominal) -> bool {
    if fit.frame.turn.count() == 0 {
        return false;
    }
    let turn = fit.turn * nominal.axes_turn.transpose();
    let plain = Frame::all().into_iter().map(|frame| frame.turn);
    let fixed = plain.filter(|turn| matches!(turn, Turn::None | Turn::Quarters(..)));
    let mut starts = fixed.flat_map(Turn::starts);
    starts.any(|start| angle_between(&start, &turn) <= nominal.turn)
        // A free turn about z is the turn about z.
        || (fit.frame.turn == Turn::Free && turn[(2, 2)].clamp(-1.0, 1.0).acos() <= nominal.turn)
}

fn angle_between(one: &Matrix3<f64>, other: &Matrix3<f64>) -> f64 {
    let cosine = 0.5 * ((one.transpose() * other).trace() - 1.0);
    cosine.clamp(-1.0, 1.0).acos()
}

/// With the sign of the readings by which the weight points down.
fn signed(mut fit: Fit, gravity: Vector3<f64>) -> Fit {
    fit.frame.opposite = fit.numbers[1].dot(&gravity) < 0.0;
    fit
}

/// Natural logarithm of what a fit is worth, but for a constant of all.
fn worth(fit: &Fit, postures: &[Posture], nominal: &Nominal) -> f64 {
    let rows = (6 * postures.len()) as f64;
    let penalty = 0.5 * fit.frame.turn.count() as f64 * rows.ln();
    let tilt = fit.weight().angle(&nominal.gravity);
    let variance = nominal.tilt.max(1e-3).powi(2);
    // On the sphere: near gravity, or anywhere.
    let near = (1.0 - TILTED) * (-0.5 * tilt * tilt / variance).exp() / (2.0 * PI * variance);
    let anywhere = TILTED / (4.0 * PI);
    let prior = fit.frame.prior(&nominal.frame) + (near + anywhere).ln();
    prior + as_declared(fit, postures, nominal) - fit.cost - penalty
}

/// Natural logarithm of how well the numbers of a fit go with those that are declared [1].
fn as_declared(fit: &Fit, postures: &[Posture], nominal: &Nominal) -> f64 {
    let declared = &nominal.declared;
    if declared.is_empty() {
        return 0.0;
    }
    let found = numbers(postures, fit, nominal);
    let density = |(bounded, [value, low, high]): (Bounded, [f64; 3])| {
        let own = 0.25 * (high - low);
        let variance = own.powi(2) + bounded.half_width().powi(2) + 1e-12;
        (-0.5 * (value - bounded.value).powi(2) / variance).exp() / (2.0 * PI * variance).sqrt()
    };
    let mut sum = 0.0;
    let mut weigh = |pairs: Vec<(Bounded, [f64; 3])>, width: f64| {
        let wrong = WRONG / width.powi(pairs.len() as i32);
        if !pairs.is_empty() {
            let right: f64 = pairs.into_iter().map(density).product();
            sum += ((1.0 - WRONG) * right + wrong).ln();
        }
    };
    let three = |declared: Option<[Bounded; 3]>, found: [[f64; 3]; 3]| {
        let pairs = declared.into_iter().flatten().zip(found);
        pairs.collect::<Vec<_>>()
    };
    let mass = declared.mass.map(|mass| (mass, found.mass));
    weigh(mass.into_iter().collect(), WIDTHS[0]);
    weigh(three(declared.zero, found.zero), WIDTHS[2]);
    if fit.has_torques {
        weigh(three(declared.centre, found.centre), WIDTHS[1]);
        weigh(three(declared.torque_zero, found.torque_zero), WIDTHS[3]);
    }
    sum
}
