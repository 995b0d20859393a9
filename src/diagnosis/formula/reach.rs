//! Whether a model stays finite over what inputs that it was not fitted to make it reach.

use crate::diagnosis::fit::hypothesis::Hypothesis;
use crate::diagnosis::search::Search;
use crate::plant::{PlantInputs, PlantParameters, simulate};

/// First time at which a model driven by inputs is no longer finite, or a formula in it has no value there [s]; none where it stays finite.
#[must_use]
pub fn astray(plant: &PlantParameters, inputs: &PlantInputs) -> Option<f64> {
    let trajectory = simulate(plant, inputs);
    let formula = plant.latent.as_ref().and_then(|latent| {
        let law = &latent.formula()?.law;
        Some((law, &latent.coefficients))
    });
    let finite = |sample: &usize| {
        let read = (trajectory.readings.iter()).all(|values| values[*sample].is_finite());
        let moment = trajectory.truth.moment(inputs, *sample);
        read && formula.is_none_or(|(law, constants)| law.is_finite_at(&moment, constants))
    };
    let first = (0..inputs.time.len()).find(|sample| !finite(sample))?;
    Some(inputs.time[first])
}

impl Search<'_> {
    /// Whether an explanation stays finite in its recordings and over what the inputs of the recording to be predicted reach.
    pub(in crate::diagnosis) fn is_finite(&self, hypothesis: &Hypothesis) -> bool {
        let prediction = &hypothesis.fit.prediction;
        let fitted = prediction.residuals.iter().all(|r| !r.is_infinite());
        fitted
            && self
                .unseen
                .is_none_or(|inputs| astray(&prediction.plant, inputs).is_none())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnosis::test_evidence::{evidence, plant};
    use crate::plant::{
        Basis, Constant, Expression, Formula, Latent, LawText, Moment, Port, SYMBOLS, Variable,
    };
    use std::sync::Arc;

    fn with_force(text: &str) -> PlantParameters {
        let constants = vec![Constant {
            name: "c",
            value: 1.0,
            unit: None,
            range: None,
        }];
        let names: Vec<&str> = SYMBOLS
            .iter()
            .map(|symbol| symbol.name)
            .chain(["c"])
            .collect();
        let law = LawText {
            name: "unlisted",
            port: Port::PistonForce,
            expression: Expression::read(text, &names).unwrap(),
            constants,
        };
        let formula = Formula {
            law,
            visited: [0.0, 0.02],
            typical: Moment::default(),
        };
        PlantParameters {
            latent: Some(Latent {
                port: Port::PistonForce,
                variable: Variable::Stroke,
                directed: false,
                basis: Basis::Formula(Arc::new(formula)),
                coefficients: vec![1.0],
            }),
            ..plant()
        }
    }

    #[test]
    fn a_model_that_leaves_all_numbers_or_a_formula_without_a_value_is_found() {
        let inputs = &evidence(1).recordings[0].inputs;
        assert_eq!(astray(&plant(), inputs), None);
        assert_eq!(astray(&with_force("-c * x"), inputs), None);
        // A force that grows with the speed without end.
        assert!(astray(&with_force("c * 1e8 * v * v * v + c"), inputs).is_some());
        // Of no value where the stroke is beyond 10 mm; there the plant takes it for nothing, and stays finite.
        let time = astray(&with_force("c * sqrt(0.01 - x)"), inputs).unwrap();
        assert!(time > 0.0, "{time}");
    }
}
