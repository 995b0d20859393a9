//! A term that a rig's model lacks and that has no name: a force, a pressure, a flow, a displacement or an error of a reading, as a function of one
//! variable.
//!
//! ```text
//! y = s(v) sum c_k phi_k(x),   phi_k hats between evenly spaced knots, or sines and cosines of a frequency and its double
//! y = f(moment; c)             a formula, once one is found that does as well
//! s(v) = 1, or tanh(v/v_0), v_0 = 2 mm/s, for what acts against the motion
//! ```
//!
//! x variable, v speed of extension [m/s], c coefficients in the port's unit.

use std::f64::consts::TAU;
use std::sync::Arc;

use super::moment::{Moment, Variable};
use super::own_law::LawText;
use super::port::Port;

/// Coefficients at most.
pub const MOST_COEFFICIENTS: usize = 24;
/// Speed at which what acts against the motion is fully there [m/s].
const SOFT: f64 = 2e-3;

/// Functions whose sum a latent term is, or a formula.
#[derive(Debug, Clone, PartialEq)]
pub enum Basis {
    /// Hats between evenly spaced knots from one value to another; constant beyond.
    Hats {
        /// First and last knot.
        ends: [f64; 2],
    },
    /// Sine and cosine of a frequency and of its double.
    Waves {
        /// Cycles over one unit of the variable.
        frequency: f64,
    },
    /// A formula of which the coefficients are the free constants.
    Formula(Arc<Formula>),
}

/// A formula of a latent term.
#[derive(Debug, Clone, PartialEq)]
pub struct Formula {
    /// Its text.
    pub law: LawText,
    /// From the least to the largest value of the term's variable in the recordings [SI].
    pub visited: [f64; 2],
    /// A moment of which all but that variable is taken where the term is shown over it.
    pub typical: Moment,
}

/// A latent term.
#[derive(Debug, Clone, PartialEq)]
pub struct Latent {
    /// Where it enters.
    pub port: Port,
    /// On what it depends.
    pub variable: Variable,
    /// Whether it acts with the direction of motion.
    pub directed: bool,
    /// Functions.
    pub basis: Basis,
    /// Their coefficients in the port's unit.
    pub coefficients: Vec<f64>,
}

impl Latent {
    /// Its formula, if it is one.
    pub fn formula(&self) -> Option<&Formula> {
        match &self.basis {
            Basis::Formula(formula) => Some(formula),
            Basis::Hats { .. } | Basis::Waves { .. } => None,
        }
    }

    /// Count of the numbers that it has: its coefficients and, of waves, their frequency.
    pub fn numbers(&self) -> usize {
        self.coefficients.len() + usize::from(matches!(self.basis, Basis::Waves { .. }))
    }

    /// Stiffness of the bristles that its friction bends [N/m], of a formula that says it.
    pub fn bristle_stiffness(&self) -> Option<f64> {
        self.formula()?.law.bristle_stiffness(&self.coefficients)
    }

    /// Whether it turns with the direction of motion.
    pub fn turns_with_motion(&self) -> bool {
        self.directed || self.port == Port::Friction
    }

    /// Its value at a moment.
    pub fn at(&self, moment: &Moment) -> f64 {
        match &self.basis {
            Basis::Formula(formula) => formula.law.value(moment, &self.coefficients),
            _ => self.value(moment.of(self.variable), moment.speed),
        }
    }

    /// Its value at a value of its variable and a speed of extension [m/s].
    fn value(&self, at: f64, speed: f64) -> f64 {
        if !at.is_finite() {
            return 0.0;
        }
        let shape = self.shape(at);
        if self.directed {
            shape * (speed / SOFT).tanh()
        } else {
            shape
        }
    }

    /// Its value without the direction of motion.
    pub fn shape(&self, at: f64) -> f64 {
        let c = &self.coefficients;
        match &self.basis {
            Basis::Formula(formula) => {
                let moment = formula.typical.with(self.variable, at);
                formula.law.value(&moment, c)
            }
            Basis::Hats { ends } => {
                let last = c.len() - 1;
                let place = (at - ends[0]) / (ends[1] - ends[0]) * last as f64;
                let place = place.clamp(0.0, last as f64);
                let left = (place as usize).min(last.saturating_sub(1));
                let share = place - left as f64;
                let right = c.get(left + 1).copied().unwrap_or(0.0);
                c[left] * (1.0 - share) + right * share
            }
            Basis::Waves { frequency } => {
                let terms = c.chunks_exact(2).enumerate();
                terms
                    .map(|(k, pair)| {
                        let (sine, cosine) = (TAU * frequency * (k + 1) as f64 * at).sin_cos();
                        pair[0] * sine + pair[1] * cosine
                    })
                    .sum()
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn with(basis: Basis, coefficients: &[f64]) -> Latent {
        Latent {
            port: Port::PistonForce,
            variable: Variable::Stroke,
            directed: false,
            basis,
            coefficients: coefficients.to_vec(),
        }
    }

    #[test]
    fn hats_are_linear_between_knots_and_constant_beyond() {
        let latent = with(Basis::Hats { ends: [1.0, 3.0] }, &[2.0, 4.0, -2.0]);
        for (at, expected) in [(0.0, 2.0), (1.5, 3.0), (2.0, 4.0), (2.5, 1.0), (9.0, -2.0)] {
            assert!((latent.shape(at) - expected).abs() < 1e-12);
        }
        assert_eq!(latent.value(f64::NAN, 1.0), 0.0);
    }

    #[test]
    fn what_is_directed_turns_with_the_motion() {
        let mut latent = with(Basis::Waves { frequency: 2.0 }, &[1.0, 0.0, 0.0, 0.5]);
        let plain = (TAU * 2.0 * 0.1).sin() + 0.5 * (TAU * 4.0 * 0.1).cos();
        assert!((latent.value(0.1, -1.0) - plain).abs() < 1e-12);
        latent.directed = true;
        assert!((latent.value(0.1, -1.0) + plain).abs() < 1e-12);
        assert_eq!(latent.value(0.1, 0.0), 0.0);
    }
}
