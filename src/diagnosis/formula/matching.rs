//! Match of a form to a fitted curve, by the quadratic model of its fit, without a simulation.
//!
//! ```text
//! D(c) = (c - c0)^T S (c - c0),   S = A - B C^-1 B^T
//! ```
//!
//! c the curve at its knots, c0 as fitted, A its information without the belief in smooth curves, C that of what else is free, B between them: what a
//! curve costs more than the fitted one once everything else has followed it.

use nalgebra::{DMatrix, DVector};

use super::super::fit::Fit;
use super::grammar::{Form, Role};
use crate::effects::Coordinate;
use crate::plant::{Basis, Latent, LawText, Moment};

/// Ridge beside the largest curvature [1].
const RIDGE: f64 = 1e-10;
/// Places that are tried over the range of a variable.
const PLACES: usize = 20;
/// Widths, as shares of the range.
const WIDTHS: [f64; 7] = [0.01, 0.025, 0.06, 0.15, 0.35, 0.8, 2.0];
/// Limits, as shares of the largest size.
const LIMITS: [f64; 12] = [
    0.02, 0.04, 0.06, 0.09, 0.12, 0.16, 0.22, 0.3, 0.4, 0.55, 0.7, 0.85,
];
/// Powers.
const EXPONENTS: [f64; 8] = [0.25, 0.4, 0.55, 0.7, 1.4, 1.7, 2.5, 3.5];
/// Periods, as shares of the range: from a twelfth to four times, evenly by their logarithm.
const PERIODS: usize = 40;
/// Rounds of the way down from the grid.
const ROUNDS: usize = 24;
/// Phases of a turn.
const PHASES: usize = 12;

/// The quadratic model of a fitted curve.
pub(super) struct CurveModel {
    /// Knots.
    knots: Vec<f64>,
    /// The fitted curve at them, in the port's unit.
    values: DVector<f64>,
    /// S.
    information: DMatrix<f64>,
}

/// A form's constants with what it costs.
pub(super) struct Match {
    /// Constants, in the form's order.
    pub constants: Vec<f64>,
    /// Cost over that of the curve [1].
    pub cost: f64,
}

impl CurveModel {
    /// The model of a fit whose last free quantities are the level and the rises of a curve.
    pub fn of(fit: &Fit, latent: &Latent) -> Option<Self> {
        let Basis::Hats { ends } = latent.basis else {
            return None;
        };
        let count = latent.coefficients.len();
        let own = fit.free.len().checked_sub(count)?;
        let mut all = fit.information.clone();
        for (i, free) in fit.free.iter().enumerate().skip(own) {
            all[(i, i)] -= free.departure_slope(fit.values[i]).powi(2);
        }
        let curve = all.view((own, own), (count, count)).into_owned();
        let between = all.view((own, 0), (count, own)).into_owned();
        let mut others = all.view((0, 0), (own, own)).into_owned();
        for i in 0..own {
            others[(i, i)] += RIDGE * others[(i, i)].max(1e-12);
        }
        let followed = match own {
            0 => curve,
            _ => curve - &between * others.cholesky()?.solve(&between.transpose()),
        };
        // From coordinates of rises to values at knots: rise k is c_k less c_(k-1).
        let mut rises = DMatrix::zeros(count, count);
        for k in 0..count {
            let scale = match fit.free[own + k].coordinate {
                Coordinate::Linear(scale) => scale,
                Coordinate::Logarithmic => return None,
            };
            rises[(k, k)] = 1.0 / scale;
            if k > 0 {
                rises[(k, k - 1)] = -1.0 / scale;
            }
        }
        let information = rises.transpose() * followed * &rises;
        let step = (ends[1] - ends[0]) / (count - 1) as f64;
        Some(Self {
            knots: (0..count).map(|k| ends[0] + step * k as f64).collect(),
            values: DVector::from_column_slice(&latent.coefficients),
            information: 0.5 * (&information + information.transpose()),
        })
    }

    fn ends(&self) -> [f64; 2] {
        [self.knots[0], self.knots[self.knots.len() - 1]]
    }

    /// The constants with which a form costs least.
    pub fn best(
        &self,
        form: &Form,
        law: &LawText,
        moment: impl Fn(f64) -> Moment,
    ) -> Option<Match> {
        let moments: Vec<Moment> = self.knots.iter().map(|at| moment(*at)).collect();
        let grids: Vec<Vec<f64>> = (form.constants.iter())
            .map(|(_, role)| self.grid(*role))
            .collect();
        let mut best: Option<Match> = None;
        let mut index = vec![0; grids.len()];
        loop {
            let mut constants: Vec<f64> =
                grids.iter().zip(&index).map(|(grid, i)| grid[*i]).collect();
            if is_ordered(form, &constants)
                && let Some(cost) = self.fit_linear(form, law, &moments, &mut constants)
                && best.as_ref().is_none_or(|known| cost < known.cost)
            {
                best = Some(Match { constants, cost });
            }
            let Some(place) = (0..grids.len()).find(|i| index[*i] + 1 < grids[*i].len()) else {
                break;
            };
            index[place] += 1;
            index[..place].fill(0);
        }
        best.map(|best| self.refined(form, law, &moments, best))
    }

    /// Goes down from a place on the grid, one constant after the other, in steps that shrink.
    fn refined(&self, form: &Form, law: &LawText, moments: &[Moment], mut best: Match) -> Match {
        let [low, high] = self.ends();
        let sought = form.constants.iter().enumerate();
        let sought: Vec<(usize, Role)> = sought
            .map(|(i, (_, role))| (i, *role))
            .filter(|(_, role)| !role.is_linear())
            .collect();
        let mut step = 0.5;
        for _ in 0..ROUNDS {
            let before = best.cost;
            for (place, role) in &sought {
                for sign in [-1.0, 1.0] {
                    let mut constants = best.constants.clone();
                    let value = &mut constants[*place];
                    match role {
                        Role::Place => *value += sign * step * (high - low) / PLACES as f64,
                        Role::Phase | Role::Exponent => *value += sign * step * 0.5,
                        _ => *value *= (sign * step * 0.8).exp(),
                    }
                    if is_ordered(form, &constants)
                        && let Some(cost) = self.fit_linear(form, law, moments, &mut constants)
                        && cost < best.cost
                    {
                        best = Match { constants, cost };
                    }
                }
            }
            if best.cost > 0.99 * before {
                step *= 0.5;
            }
        }
        best
    }

    /// Values of a constant that are tried; of one that the form is in proportion to, one.
    fn grid(&self, role: Role) -> Vec<f64> {
        let [low, high] = self.ends();
        let range = high - low;
        let largest = low.abs().max(high.abs());
        match role {
            Role::Height | Role::Gain | Role::Curvature => vec![1.0],
            Role::Place => (0..PLACES)
                .map(|i| low + range * (i as f64 + 0.5) / PLACES as f64)
                .collect(),
            Role::Width => WIDTHS.map(|share| share * range).to_vec(),
            Role::Limit => LIMITS.map(|share| share * largest).to_vec(),
            Role::Period => (0..PERIODS)
                .map(|i| range * 48f64.powf(i as f64 / (PERIODS - 1) as f64) / 12.0)
                .collect(),
            Role::Phase => (0..PHASES)
                .map(|i| std::f64::consts::TAU * i as f64 / PHASES as f64)
                .collect(),
            Role::Exponent => EXPONENTS.to_vec(),
            // No curve shows one; it comes from the waves.
            Role::Frequency => Vec::new(),
        }
    }

    /// Solves for the constants that the form is in proportion to, and returns the cost.
    fn fit_linear(
        &self,
        form: &Form,
        law: &LawText,
        moments: &[Moment],
        constants: &mut [f64],
    ) -> Option<f64> {
        let count = moments.len();
        let linear: Vec<usize> = (form.constants.iter().enumerate())
            .filter(|(_, (_, role))| role.is_linear())
            .map(|(i, _)| i)
            .collect();
        let curve = |constants: &[f64]| {
            DVector::from_iterator(count, moments.iter().map(|m| law.value(m, constants)))
        };
        if linear.is_empty() {
            return Some(self.cost(&curve(constants)));
        }
        let columns: Vec<DVector<f64>> = (linear.iter())
            .map(|own| {
                let mut unit = constants.to_vec();
                for place in &linear {
                    unit[*place] = 0.0;
                }
                unit[*own] = 1.0;
                curve(&unit)
            })
            .collect();
        let columns = DMatrix::from_columns(&columns);
        let weighted = &self.information * &columns;
        let mut normal = columns.transpose() * &weighted;
        for i in 0..linear.len() {
            normal[(i, i)] += RIDGE * normal[(i, i)] + f64::MIN_POSITIVE;
        }
        let right = weighted.transpose() * &self.values;
        let solved = normal.cholesky()?.solve(&right);
        for (place, value) in linear.iter().zip(solved.iter()) {
            constants[*place] = *value;
        }
        let cost = self.cost(&(columns * solved));
        cost.is_finite().then_some(cost)
    }

    fn cost(&self, curve: &DVector<f64>) -> f64 {
        let left = curve - &self.values;
        left.dot(&(&self.information * &left)).max(0.0)
    }
}

/// Whether places that bound a window stand in their order.
fn is_ordered(form: &Form, constants: &[f64]) -> bool {
    let mut places = (form.constants.iter().zip(constants))
        .filter(|((_, role), _)| *role == Role::Place)
        .map(|(_, value)| *value);
    let first = places.next();
    places
        .next()
        .is_none_or(|second| first.is_some_and(|first| first < second))
}

#[cfg(test)]
mod tests {
    use super::super::candidate::Candidate;
    use super::super::grammar::FORMS;
    use super::*;
    use crate::plant::{Port, Variable};

    /// A curve of 24 knots over the stroke that follows a law, each knot known to 0.01 of its unit but for what all have in common.
    fn model(law: impl Fn(f64) -> f64) -> (CurveModel, Latent) {
        let ends = [0.0, 0.05];
        let knots: Vec<f64> = (0..24).map(|k| 0.05 * f64::from(k) / 23.0).collect();
        let coefficients: Vec<f64> = knots.iter().map(|at| law(*at)).collect();
        let latent = Latent {
            port: Port::PistonForce,
            variable: Variable::Stroke,
            directed: false,
            basis: Basis::Hats { ends },
            coefficients: coefficients.clone(),
        };
        let model = CurveModel {
            knots,
            values: DVector::from_vec(coefficients),
            information: DMatrix::identity(24, 24) * 1e4,
        };
        (model, latent)
    }

    /// Text, cost and constants of the form that costs least, with 10 for each constant.
    fn best(law: impl Fn(f64) -> f64) -> (&'static str, Match) {
        let (model, latent) = model(law);
        let mut all: Vec<(&str, Match)> = FORMS
            .iter()
            .filter(|form| form.makes_sense(latent.port, latent.variable, [0.0, 0.05]))
            .filter_map(|form| {
                let text = Candidate::new(form, (&latent, false), Moment::default(), &[]);
                let moment = |at: f64| Moment::default().with(Variable::Stroke, at);
                Some((form.text, model.best(form, text.law(), moment)?))
            })
            .collect();
        let cost = |(_, found): &(&str, Match)| found.cost + 10.0 * found.constants.len() as f64;
        all.sort_by(|a, b| cost(a).total_cmp(&cost(b)));
        all.remove(0)
    }

    #[test]
    fn a_curve_points_at_the_form_that_it_was_made_with() {
        let (text, found) = best(|x| 40.0 * x);
        assert_eq!(text, "gain * X");
        assert!((found.constants[0] - 40.0).abs() < 1e-6);
        let (text, found) = best(|x| -6.0 * (std::f64::consts::PI * x / 0.05).sin());
        assert_eq!(text, "height * sin(2 * pi * X / period)");
        assert!(
            (found.constants[0] + 6.0).abs() < 0.01,
            "{:?}",
            found.constants
        );
        assert!(
            (found.constants[1] - 0.1).abs() < 2e-4,
            "{:?}",
            found.constants
        );
        let (text, found) = best(|x| 300.0 * (x - 0.0217).max(0.0));
        assert_eq!(text, "gain * max(X - threshold, 0)");
        assert!(
            (found.constants[1] - 0.0217).abs() < 5e-5,
            "{:?}",
            found.constants
        );
        let (text, found) = best(|x| 9.0 * (-((x - 0.02) / 0.006f64).powi(2)).exp());
        assert_eq!(text, "height * exp(-((X - centre) / width)^2)");
        assert!(
            (found.constants[1] - 0.02).abs() < 5e-5,
            "{:?}",
            found.constants
        );
    }

    /// What all knots have in common costs nothing where another number that is free takes it.
    #[test]
    fn what_else_is_free_takes_its_part() {
        let (mut model, latent) = model(|x| 3.0 + 40.0 * x);
        let ones = DVector::from_element(24, 1.0);
        let free_level = &model.information * &ones;
        model.information -= &free_level * free_level.transpose() / ones.dot(&free_level);
        let form = &FORMS[0];
        let text = Candidate::new(form, (&latent, false), Moment::default(), &[]);
        let moment = |at: f64| Moment::default().with(Variable::Stroke, at);
        let found = model.best(form, text.law(), moment).unwrap();
        assert!(
            (found.constants[0] - 40.0).abs() < 1e-3,
            "{:?}",
            found.constants
        );
        assert!(found.cost < 1e-6, "{}", found.cost);
    }
}
