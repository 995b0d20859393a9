//! Which axes the readings are given in: every frame fitted, with its probability.

use std::f64::consts::PI;

use nalgebra::Vector3;

use super::Posture;
use super::fit::{Fit, fit};
use super::frame::{Frame, Turn};

/// Share of bases that stand tilted anyhow [1].
const TILTED: f64 = 0.05;
/// Most that is stated of one [1].
const SUREST: f64 = 0.98;

/// What is believed of gravity and sensor.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Belief {
    /// Gravity in the base's axes [m/s2].
    pub gravity: Vector3<f64>,
    /// How far the weight may lie from it [rad].
    pub tilt: f64,
    /// How far the sensor's axes may be turned [rad].
    pub turn: f64,
    /// Noise of a force [N] and of a torque [N m]; 0: not known.
    pub noise: [f64; 2],
}

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
pub fn candidates(postures: &[Posture], belief: &Belief) -> Vec<Candidate> {
    let fits = Frame::all()
        .into_iter()
        .filter_map(|frame| fit(postures, frame, belief.noise));
    let mut weighed: Vec<(f64, Fit)> = fits
        .filter(|fit| !is_within(fit, belief.turn))
        .map(|fit| signed(fit, belief.gravity))
        .map(|fit| (worth(&fit, postures.len(), belief), fit))
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
fn is_within(fit: &Fit, tolerance: f64) -> bool {
    if fit.frame.turn.count() == 0 {
        return false;
    }
    let plain = Frame::all().into_iter().map(|frame| frame.turn);
    let fixed = plain.filter(|turn| matches!(turn, Turn::None | Turn::Quarters(..)));
    let mut starts = fixed.flat_map(Turn::starts);
    starts.any(|start| angle_between(&start, &fit.turn) <= tolerance)
        // A free turn about z is the turn about z.
        || (fit.frame.turn == Turn::Free && fit.turn[(2, 2)].clamp(-1.0, 1.0).acos() <= tolerance)
}

fn angle_between(one: &nalgebra::Matrix3<f64>, other: &nalgebra::Matrix3<f64>) -> f64 {
    let cosine = 0.5 * ((one.transpose() * other).trace() - 1.0);
    cosine.clamp(-1.0, 1.0).acos()
}

/// With the sign of the readings by which the weight points down.
fn signed(mut fit: Fit, gravity: Vector3<f64>) -> Fit {
    fit.frame.opposite = fit.numbers[1].dot(&gravity) < 0.0;
    fit
}

/// Natural logarithm of what a fit is worth, but for a constant of all.
fn worth(fit: &Fit, postures: usize, belief: &Belief) -> f64 {
    let rows = (6 * postures) as f64;
    let penalty = 0.5 * fit.frame.turn.count() as f64 * rows.ln();
    let tilt = fit.weight().angle(&belief.gravity);
    let variance = belief.tilt.max(1e-3).powi(2);
    // On the sphere: near gravity, or anywhere.
    let near = (1.0 - TILTED) * (-0.5 * tilt * tilt / variance).exp() / (2.0 * PI * variance);
    let anywhere = TILTED / (4.0 * PI);
    fit.frame.prior() + (near + anywhere).ln() - fit.cost - penalty
}
