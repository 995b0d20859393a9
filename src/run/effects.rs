//! Effects put into a scenario: of the catalogue, or of the arm file that a cell names.

use super::error::RunError;
use crate::cell::Cell;
use crate::plant::{Nominal, PlantParameters};
use crate::scenario::arm_file::ArmFile;
use crate::scenario::{AnyScenario, EffectRequest, KeyValue, ScenarioTemplate};

/// What the sizes of effects follow from.
struct Subject {
    nominal: Nominal<PlantParameters>,
    /// The joint that shows most, from 1.
    joint: usize,
    arm: Option<Box<ArmFile>>,
}

impl Subject {
    fn of(template: &ScenarioTemplate) -> Result<Self, RunError> {
        Ok(match template.with(&[])? {
            AnyScenario::Bench(bench) => Self {
                nominal: bench.nominal,
                joint: 1,
                arm: None,
            },
            AnyScenario::Cell(cell) => {
                let cell = Cell::new(*cell)?;
                Self {
                    joint: cell.most_observable_joint(),
                    nominal: cell.setup.scenario.nominal,
                    arm: cell.setup.scenario.arm.recorded_arm,
                }
            }
        })
    }

    fn edits(
        &self,
        request: &EffectRequest,
        template: &ScenarioTemplate,
    ) -> Result<Vec<KeyValue>, String> {
        let Some(effect) = request.of_arm() else {
            return request.edits(&self.nominal, self.joint);
        };
        match &self.arm {
            Some(file) => request.arm_edits(effect, file, self.joint),
            None => {
                let (name, file) = (effect.name, template.path().display());
                let lacks = match template.is_bench() {
                    true => "is of a bench, without an arm; expected the scenario of a cell with",
                    false => "names no arm file; expected",
                };
                Err(format!(
                    "{name} is of an arm's drives, load or wrench sensor, and {file} {lacks} recorded_arm = \"arm.toml\" in [arm] (`idc new arm` writes such a file)"
                ))
            }
        }
    }
}

/// The nominal physics of a scenario, and the joint that shows most in it, from 1.
///
/// # Errors
/// Those of the scenario and of its cell.
pub fn nominal_of(
    template: &ScenarioTemplate,
) -> Result<(Nominal<PlantParameters>, usize), RunError> {
    let subject = Subject::of(template)?;
    Ok((subject.nominal, subject.joint))
}

/// Changes of a scenario by the effects that are asked for.
///
/// # Errors
/// Those of the scenario and of its cell, and an effect that cannot be put in as it is asked for.
pub fn apply_effects(
    requests: &[EffectRequest],
    template: &ScenarioTemplate,
) -> Result<Vec<KeyValue>, RunError> {
    if requests.is_empty() {
        return Ok(Vec::new());
    }
    let subject = Subject::of(template)?;
    let mut edits = Vec::new();
    for request in requests {
        let own = subject.edits(request, template);
        edits.extend(own.map_err(|reason| RunError::With { reason })?);
    }
    Ok(edits)
}
