//! A design, simulated in every scenario of its study.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use rayon::prelude::*;

use super::failure::Failure;
use super::force_range::{force_range, intersection};
use crate::cell::Cell;
use crate::design::{
    Design, DesignError, Evaluate, EvaluateError, Outcome, ScenarioOutcome, Study,
};
use crate::metrics::{BENCH_METRICS, METRICS, Metric};
use crate::rig::Rig;
use crate::run::{run_bench, run_cell};
use crate::scenario::{AnyScenario, BenchScenario, KeyValue, Scenario, ScenarioTemplate};

/// Simulates designs in the scenarios of a study: benches on the rig, cells in the cell. Noise and search for a posture keep the scenarios' seeds.
#[derive(Debug)]
pub struct ScenarioEvaluator {
    /// Name for people and scenario.
    scenarios: Vec<(String, ScenarioTemplate)>,
}

/// Results of a design in one scenario.
struct Run {
    metrics: BTreeMap<String, f64>,
    force_range: [f64; 2],
}

impl ScenarioEvaluator {
    /// Reads the study's scenarios and sees whether they take the starting design.
    ///
    /// # Errors
    /// A scenario that is none, or that does not take one of the study's variables.
    pub fn new(study: &Study) -> Result<Self, DesignError> {
        let values = study.starting_design().scenario_values();
        let names = names(study);
        let read = |(path, name): (&std::path::PathBuf, String)| {
            let template = ScenarioTemplate::read(path)?;
            match template.with(&values) {
                Ok(_) => drawn(study, &template).map(|()| (name, template)),
                Err(reason) => {
                    let variable = reason.key().and_then(|key| study.variable_to_blame(key));
                    Err(match variable {
                        Some(variable) => DesignError::Variable {
                            location: variable.location.clone(),
                            key: variable.key.clone(),
                            reason: Box::new(reason),
                        },
                        None => reason.into(),
                    })
                }
            }
        };
        let scenarios = study.scenarios.iter().zip(names).map(read);
        Ok(Self {
            scenarios: scenarios.collect::<Result<_, DesignError>>()?,
        })
    }
}

/// Whether a scenario takes the ends of what is drawn.
fn drawn(study: &Study, template: &ScenarioTemplate) -> Result<(), DesignError> {
    for scatter in study.scattering.iter().flat_map(|s| &s.scatters) {
        for end in scatter.ends() {
            let design = study.starting_design().with([(scatter.key.clone(), end)]);
            let taken = template.with(&design.scenario_values());
            taken.map_err(|reason| DesignError::Scatter {
                location: scatter.location.clone(),
                key: scatter.key.clone(),
                value: end,
                reason: Box::new(reason),
            })?;
        }
    }
    Ok(())
}

/// Names of the files, or their paths where two have the same name.
fn names(study: &Study) -> Vec<String> {
    let name = |path: &Path| path.file_stem().unwrap_or_default().display().to_string();
    let short: Vec<String> = study.scenarios.iter().map(|path| name(path)).collect();
    if short.iter().collect::<BTreeSet<_>>().len() == short.len() {
        return short;
    }
    let paths = study.scenarios.iter();
    paths.map(|path| path.display().to_string()).collect()
}

impl Evaluate for ScenarioEvaluator {
    fn evaluate(&self, design: &Design) -> Result<Outcome, EvaluateError> {
        let values = design.scenario_values();
        let mut outcome = Outcome {
            force_range: [f64::NEG_INFINITY, f64::INFINITY],
            scenarios: Vec::with_capacity(self.scenarios.len()),
        };
        // Side by side: a search that goes step by step would leave the other processors idle.
        let runs: Vec<Result<Run, EvaluateError>> = (self.scenarios.par_iter())
            .map(|(name, template)| {
                run(template, &values).map_err(|failure| failure.in_scenario(name))
            })
            .collect();
        for ((name, _), run) in self.scenarios.iter().zip(runs) {
            let run = run?;
            outcome.force_range = intersection(outcome.force_range, run.force_range);
            outcome.scenarios.push(ScenarioOutcome {
                name: name.clone(),
                metrics: run.metrics,
            });
        }
        Ok(outcome)
    }
}

fn run(template: &ScenarioTemplate, values: &[KeyValue]) -> Result<Run, Failure> {
    match template.with(values)? {
        AnyScenario::Bench(scenario) => bench(*scenario),
        AnyScenario::Cell(scenario) => cell(*scenario),
    }
}

fn bench(scenario: BenchScenario) -> Result<Run, Failure> {
    let rig = Rig::new(scenario)?;
    let finished = run_bench(&rig, &mut |_| ())?;
    if let Some(stop) = finished.stop {
        return Err(stop.into());
    }
    let gravity = rig.actual.gravity_along_extension;
    Ok(Run {
        metrics: values_of(BENCH_METRICS, &finished.summary),
        force_range: force_range(
            &rig.actual.device,
            &rig.scenario.sensing.command,
            [gravity; 2],
        ),
    })
}

fn cell(scenario: Scenario) -> Result<Run, Failure> {
    let cell = Cell::new(scenario)?;
    let finished = run_cell(&cell, &mut |_| ())?;
    if let Some(stop) = finished.stop {
        return Err(stop.into());
    }
    let scenario = &cell.setup.scenario;
    let axial = force_range(
        &scenario.nominal.device,
        &scenario.sensing.command,
        cell.gravity_on_edge,
    );
    Ok(Run {
        metrics: values_of(METRICS, &finished.summary),
        force_range: axial.map(|force| force / cell.axial_share),
    })
}

fn values_of<S>(metrics: &[Metric<S>], summary: &S) -> BTreeMap<String, f64> {
    let determined =
        |metric: &Metric<S>| (metric.value)(summary).map(|value| (metric.name.to_owned(), value));
    metrics.iter().filter_map(determined).collect()
}
