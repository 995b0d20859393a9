//! Effects of the catalogue put into a scenario.

use super::error::RunError;
use crate::cell::Cell;
use crate::plant::{Nominal, PlantParameters};
use crate::scenario::{AnyScenario, EffectRequest, KeyValue, ScenarioTemplate};

/// The nominal physics of a scenario, and the joint that shows most in it, from 1.
///
/// # Errors
/// Those of the scenario and of its cell.
pub fn nominal_of(
    template: &ScenarioTemplate,
) -> Result<(Nominal<PlantParameters>, usize), RunError> {
    Ok(match template.with(&[])? {
        AnyScenario::Bench(bench) => (bench.nominal, 1),
        AnyScenario::Cell(cell) => {
            let cell = Cell::new(*cell)?;
            let most_observable = cell.most_observable_joint();
            (cell.setup.scenario.nominal, most_observable)
        }
    })
}

/// Changes of a scenario by the effects that are asked for.
///
/// # Errors
/// Those of [`nominal_of`], and an effect that cannot be put in as it is asked for.
pub fn apply_effects(
    requests: &[EffectRequest],
    template: &ScenarioTemplate,
) -> Result<Vec<KeyValue>, RunError> {
    if requests.is_empty() {
        return Ok(Vec::new());
    }
    let (nominal, most_observable) = nominal_of(template)?;
    let mut edits = Vec::new();
    for request in requests {
        let own = request.edits(&nominal, most_observable);
        edits.extend(own.map_err(|reason| RunError::With { reason })?);
    }
    Ok(edits)
}
