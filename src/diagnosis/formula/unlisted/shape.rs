//! The shape of a model discrepancy: its value against its variable, with how sure it is.
//!
//! ```text
//! y(x) = sum d_k psi_k(x),   half width = 1.96 sqrt(psi^T V psi)
//! ```
//!
//! d what the fit moves, in the port's unit, psi what a unit of each adds (`super::super::latent`), V their covariance (`crate::diagnosis::fit::covariance`).

use nalgebra::DVector;

use super::super::latent;
use super::balance::{self, Needed};
use super::form::{Form, form};
use crate::diagnosis::fit::covariance::covariance;
use crate::diagnosis::fit::hypothesis::Hypothesis;
use crate::diagnosis::recordings::evidence::Evidence;
use crate::effects::Coordinate;
use crate::plant::{Basis, Latent};
use crate::stats::NORMAL_95;

/// Standard deviations to either side in a 95 % interval [1].
const INTERVAL: f64 = NORMAL_95;
/// Places of the curve.
const PLACES: usize = 161;
/// Rows of the table.
const ROWS: usize = 12;
/// Share of its largest value below which a term does not act [1].
const ACTS: f64 = 0.1;
/// Share of the width in which a localised term acts that is shown at either side of it [1].
const BESIDE: f64 = 0.5;

/// A value of the term.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ShapePoint {
    /// Value of the variable, or time within a period [SI].
    pub at: f64,
    /// The term [SI].
    pub value: f64,
    /// Half the width of its 95 % interval [SI].
    pub half_width: f64,
}

/// The shape of a term.
#[derive(Debug, Clone, PartialEq)]
pub struct Shape {
    /// The term.
    pub latent: Latent,
    /// Kind of curve.
    pub form: Form,
    /// One period with the half width of its 95 % interval [s], of a periodic term.
    pub period: Option<[f64; 2]>,
    /// Values at the knots, or over a period.
    pub knots: Vec<ShapePoint>,
    /// The same, finely, where it acts.
    pub curve: Vec<ShapePoint>,
    /// The same as a table for people.
    pub table: Vec<ShapePoint>,
    /// Between which values of its variable it acts.
    pub acts: [f64; 2],
    /// Residual of the balance, by the recordings; empty where no reading shows it.
    pub needed: Vec<Needed>,
    /// Largest less smallest value [SI].
    pub peak_to_peak: f64,
}

impl Shape {
    /// The shape of a hypothesis' term, if it has one.
    #[must_use]
    pub fn of(evidence: &Evidence, hypothesis: &Hypothesis) -> Option<Self> {
        let latent = hypothesis.unlisted()?.clone();
        let visited = balance::visited(evidence, hypothesis, &latent)?;
        let spread = Spread::of(evidence, hypothesis, &latent);
        let period = period(hypothesis, &spread, &latent);
        let row = |at: f64| ShapePoint {
            at,
            value: latent.shape(at),
            half_width: spread.half_width(&latent, at),
        };
        let [from, to] = match latent.basis {
            Basis::Hats { ends } => ends,
            Basis::Waves { frequency } => [0.0, 1.0 / frequency],
            Basis::Formula(_) => visited,
        };
        let steps = match latent.basis {
            Basis::Hats { .. } => latent.coefficients.len() - 1,
            Basis::Waves { .. } | Basis::Formula(_) => 24,
        };
        let knots: Vec<ShapePoint> = even([from, to], steps).map(row).collect();
        let form = form(&latent, visited);
        let acts = acting(&knots);
        let shown = if form == Form::Localised {
            let beside = BESIDE * (acts[1] - acts[0]).max((to - from) / steps as f64);
            [
                (acts[0] - beside).max(visited[0].min(acts[0])),
                (acts[1] + beside).min(visited[1].max(acts[1])),
            ]
        } else {
            [from, to]
        };
        // A kink is shown where it is.
        let kinks = knots.iter().map(|row| row.at);
        let kinks = kinks.filter(|at| (shown[0]..=shown[1]).contains(at));
        let mut places: Vec<f64> = even(shown, PLACES - 1).chain(kinks).collect();
        places.sort_by(f64::total_cmp);
        let curve: Vec<ShapePoint> = places.into_iter().map(row).collect();
        let values = || curve.iter().map(|row| row.value);
        let peak_to_peak =
            values().fold(f64::NEG_INFINITY, f64::max) - values().fold(f64::INFINITY, f64::min);
        Some(Self {
            form,
            period,
            acts,
            knots,
            table: even(shown, ROWS).map(row).collect(),
            needed: balance::needed(evidence, hypothesis, &latent, shown, peak_to_peak),
            curve,
            latent,
            peak_to_peak,
        })
    }
}

/// From the first to the last knot at which a term acts.
fn acting(knots: &[ShapePoint]) -> [f64; 2] {
    let largest = knots
        .iter()
        .fold(0.0f64, |most, row| most.max(row.value.abs()));
    let mut acts = knots.iter().filter(|row| row.value.abs() > ACTS * largest);
    let first = acts.next().map_or(knots[0].at, |row| row.at);
    [first, acts.next_back().map_or(first, |row| row.at)]
}

/// Evenly spaced places, both ends among them.
fn even([from, to]: [f64; 2], steps: usize) -> impl Iterator<Item = f64> {
    (0..=steps).map(move |step| from + (to - from) * step as f64 / steps as f64)
}

/// Covariance of what the fit moves of a term, and that of the frequency, in SI.
struct Spread {
    covariance: nalgebra::DMatrix<f64>,
    frequency: f64,
}

impl Spread {
    fn of(evidence: &Evidence, hypothesis: &Hypothesis, latent: &Latent) -> Self {
        let fit = &hypothesis.fit;
        let own = hypothesis.unlisted().map_or(0, Latent::numbers);
        let first = fit.free.len() - own;
        let all = covariance(evidence, fit);
        let scale = |index: usize| match fit.free[first + index].coordinate {
            Coordinate::Linear(scale) => scale,
            Coordinate::Logarithmic => fit.values[first + index],
        };
        let count = latent.coefficients.len();
        let covariance = nalgebra::DMatrix::from_fn(count, count, |i, j| {
            scale(i) * scale(j) * all[(first + i, first + j)]
        });
        let frequency = if own > count {
            scale(count).powi(2) * all[(first + count, first + count)]
        } else {
            0.0
        };
        Self {
            covariance,
            frequency,
        }
    }

    fn half_width(&self, latent: &Latent, at: f64) -> f64 {
        let count = latent.coefficients.len();
        let functions = DVector::from_fn(count, |k, _| latent::response(latent, k, at));
        INTERVAL
            * functions
                .dot(&(&self.covariance * &functions))
                .max(0.0)
                .sqrt()
    }
}

/// One period with the half width of its interval [s].
fn period(hypothesis: &Hypothesis, spread: &Spread, latent: &Latent) -> Option<[f64; 2]> {
    let Basis::Waves { frequency } = hypothesis.unlisted()?.basis else {
        return None;
    };
    debug_assert!(
        latent.coefficients.len().is_multiple_of(2),
        "sines and cosines"
    );
    let half = INTERVAL * spread.frequency.max(0.0).sqrt();
    Some([1.0 / frequency, half / (frequency * frequency)])
}
