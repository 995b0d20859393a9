//! Kind of a term's curve, in words that physics is known by.

use crate::listed::listed;
use crate::plant::{Basis, Latent};
use crate::stats::median;

/// Places at which a curve is judged.
const PLACES: usize = 201;
/// Share of its largest departure below which a curve does not act [1].
const ACTS: f64 = 0.15;
/// Share of what the variable moves through within which all of it acts, for a curve to be localised [1].
const NARROW: f64 = 0.4;
/// Share of a curve's energy that makes it odd or even, or of its ways up and down that makes it monotonic [1].
const MOSTLY: f64 = 0.85;

listed! {
    /// A kind of curve.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
    pub enum Form,
    /// Name in an answer.
    name: &'static str {
        /// Comes back after a period.
        Periodic = "periodic",
        /// Acts in a small part of what the variable moves through.
        Localised = "localised",
        /// Turns its sign with the variable's.
        Odd = "odd",
        /// Does not care about the variable's sign.
        Even = "even",
        /// Rises all along, or falls.
        Monotonic = "monotonic",
        /// Anything else.
        Broad = "broad",
    }
}

/// The form of a term over what its variable moves through.
#[must_use]
pub fn form(latent: &Latent, visited: [f64; 2]) -> Form {
    if matches!(latent.basis, Basis::Waves { .. }) {
        return Form::Periodic;
    }
    let values = over(latent, visited);
    // What it is in most places: an offset that some tolerated number took the other half of.
    let usual = median(values.iter().copied()).unwrap_or(0.0);
    let largest = values
        .iter()
        .fold(0.0f64, |most, v| most.max((v - usual).abs()));
    let acts = |value: &f64| (value - usual).abs() > ACTS * largest;
    let (first, last) = (values.iter().position(acts), values.iter().rposition(acts));
    if let (Some(first), Some(last)) = (first, last)
        && ((last - first) as f64) < NARROW * (PLACES - 1) as f64
    {
        return Form::Localised;
    }
    let reach = visited[1].min(-visited[0]);
    if reach > 0.25 * visited[1].max(-visited[0]) {
        let values = over(latent, [-reach, reach]);
        let (mut odd, mut even) = (0.0, 0.0);
        for (one, other) in values.iter().zip(values.iter().rev()) {
            odd += (0.5 * (one - other)).powi(2);
            even += (0.5 * (one + other)).powi(2);
        }
        if odd > MOSTLY * (odd + even) {
            return Form::Odd;
        }
        if even > MOSTLY * (odd + even) {
            return Form::Even;
        }
    }
    let way: f64 = values
        .windows(2)
        .map(|pair| (pair[1] - pair[0]).abs())
        .sum();
    if (values[values.len() - 1] - values[0]).abs() > MOSTLY * way {
        return Form::Monotonic;
    }
    Form::Broad
}

fn over(latent: &Latent, [from, to]: [f64; 2]) -> Vec<f64> {
    let place = |i: usize| from + (to - from) * i as f64 / (PLACES - 1) as f64;
    (0..PLACES).map(|i| latent.shape(place(i))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plant::{Port, Variable};

    fn of(ends: [f64; 2], shape: impl Fn(f64) -> f64) -> Latent {
        let at = |k: usize| ends[0] + (ends[1] - ends[0]) * k as f64 / 23.0;
        Latent {
            port: Port::PistonForce,
            variable: Variable::Velocity,
            directed: false,
            basis: Basis::Hats { ends },
            coefficients: (0..24).map(|k| shape(at(k))).collect(),
        }
    }

    #[test]
    fn curves_are_called_what_they_look_like() {
        let spot = of([-1.0, 1.0], |x| 3.0 + (-(x / 0.1).powi(2)).exp());
        assert_eq!(form(&spot, [-1.0, 1.0]), Form::Localised);
        let odd = of([-1.0, 1.0], |x| x * x.abs() + 0.1 * x * x);
        assert_eq!(form(&odd, [-1.0, 0.9]), Form::Odd);
        let even = of([-1.0, 1.0], |x| x * x);
        assert_eq!(form(&even, [-1.0, 1.0]), Form::Even);
        let rising = of([0.0, 1.0], f64::sqrt);
        assert_eq!(form(&rising, [0.0, 1.0]), Form::Monotonic);
        let there_and_back = of([0.0, 1.0], |x| (std::f64::consts::TAU * x).sin());
        assert_eq!(form(&there_and_back, [0.0, 1.0]), Form::Broad);
        let mut periodic = rising;
        periodic.basis = Basis::Waves { frequency: 3.0 };
        assert_eq!(form(&periodic, [0.0, 1.0]), Form::Periodic);
    }
}
