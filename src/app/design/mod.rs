//! `idc design`: from a study file to design.json, override.toml, front.svg and robustness.svg.

mod evaluate;
mod failure;
mod force_range;

use std::path::Path;

pub use evaluate::ScenarioEvaluator;

use super::error::AppError;
use super::files::{
    DESIGN, FRONT, OVERRIDE, OutputFolder, OverwritePolicy, REPORT, ROBUSTNESS, provenance,
};
use crate::design::{self, Domain, Study, StudyDocument, Variable, VariedKey};
use crate::document::{Style, html, text};
use crate::figure::svg;
use crate::recording::provenance::Provenance;
use crate::report::{self, study_charts};
use crate::scenario::{self, AnyScenario, AssumedValue, files_of_cell};

/// All that a study may write.
const NAMES: [&str; 5] = [DESIGN, OVERRIDE, FRONT, ROBUSTNESS, REPORT];

/// A study that can be done, and a folder that its files can go to.
pub(super) struct PreparedStudy {
    study: Study,
    evaluator: ScenarioEvaluator,
    folder: OutputFolder,
    /// Its files as they were when they were read: a search takes minutes.
    provenance: Provenance,
    /// Values in use that nobody has measured in public, of all scenarios.
    assumed: Vec<AssumedValue>,
}

/// A study that was done.
pub(super) struct FinishedStudy {
    /// The printed table.
    pub table: String,
    /// design.json.
    pub document: String,
    /// Names of the files written.
    pub names: Vec<&'static str>,
}

impl PreparedStudy {
    /// Reads study and scenarios and tries the starting design, then makes the folder: bad input leaves nothing behind.
    pub(super) fn new(
        file: &Path,
        evaluations: Option<u32>,
        folder: &Path,
        policy: OverwritePolicy,
    ) -> Result<Self, AppError> {
        let mut study = design::load(file)?;
        if let Some(evaluations) = evaluations {
            study.evaluations = evaluations as usize;
        }
        let evaluator = ScenarioEvaluator::new(&study)?;
        design::check_start(&study, &evaluator)?;
        let scenarios = scenarios(&study)?;
        Ok(Self {
            provenance: sources(&study, &scenarios)?,
            assumed: assumed(&study, &scenarios),
            folder: OutputFolder::prepare(folder, &NAMES, policy)?,
            study,
            evaluator,
        })
    }

    /// Where its files go.
    pub(super) fn folder(&self) -> &OutputFolder {
        &self.folder
    }

    /// Does it and writes its files. `progress` gets designs evaluated and the most that will be, from any thread.
    pub(super) fn run(
        &self,
        progress: &(dyn Fn(usize, usize) + Sync),
    ) -> Result<FinishedStudy, AppError> {
        let result = design::run(&self.study, &self.evaluator, progress)?;
        let override_text = result.override_text();
        let study = StudyDocument {
            study: self.study.path.display().to_string(),
            scenarios: (self.study.scenarios.iter())
                .map(|path| path.display().to_string())
                .collect(),
            variables: self.study.variables.iter().map(varied).collect(),
            result,
            assumed: self.assumed.clone(),
            provenance: self.provenance.clone(),
        };
        let document = serde_json::to_string_pretty(&study)?;
        let figures = [
            (FRONT, study_charts::front(&study.result)),
            (ROBUSTNESS, study_charts::robustness(&study.result)),
        ];
        let drawn = |(name, figure): &(_, Option<_>)| match figure {
            Some(figure) => svg(figure).map(|svg| (*name, Some(svg))),
            None => Ok((*name, None)),
        };
        let pictures: Result<Vec<_>, _> = figures.iter().map(drawn).collect();
        let pictures = pictures?;
        let report = report::study(&study);
        let page = html(&report);
        let mut files = vec![
            (DESIGN, document.as_str()),
            (OVERRIDE, override_text.as_str()),
        ];
        files.push((REPORT, page.as_str()));
        for (name, svg) in &pictures {
            files.extend(svg.as_deref().map(|svg| (*name, svg)));
        }
        let names = self.folder.write_texts(&NAMES, &files)?;
        Ok(FinishedStudy {
            table: text(&report, Style::Plain),
            names,
            document,
        })
    }
}

fn scenarios(study: &Study) -> Result<Vec<AnyScenario>, AppError> {
    let scenarios = study.scenarios.iter();
    let scenarios = scenarios.map(|path| scenario::load_any(path));
    Ok(scenarios.collect::<Result<_, _>>()?)
}

/// Values of the scenarios that nobody has measured in public, each once, but for those that the study varies.
fn assumed(study: &Study, scenarios: &[AnyScenario]) -> Vec<AssumedValue> {
    let varied = |key: &str| {
        let own = key.strip_prefix("device.").unwrap_or(key);
        (study.variables.iter()).any(|variable| [key, own].contains(&variable.key.as_str()))
    };
    let mut found: Vec<AssumedValue> = Vec::new();
    for scenario in scenarios {
        let own: Vec<&AssumedValue> = match scenario {
            AnyScenario::Cell(cell) => cell.assumed_values().collect(),
            AnyScenario::Bench(bench) => bench.device.assumed.iter().collect(),
        };
        for value in own {
            if !varied(&value.key) && !found.iter().any(|known| known.key == value.key) {
                found.push(value.clone());
            }
        }
    }
    found
}

/// The files that a study is made of.
fn sources(study: &Study, scenarios: &[AnyScenario]) -> Result<Provenance, AppError> {
    let mut files = vec![&study.path];
    for scenario in scenarios {
        let own = match scenario {
            AnyScenario::Cell(cell) => files_of_cell(
                &cell.path,
                &cell.arm,
                &cell.device,
                &cell.workpiece,
                &cell.collision.obstacles,
            ),
            AnyScenario::Bench(bench) => vec![&bench.path, &bench.device.model],
        };
        for file in own {
            if !files.contains(&file) {
                files.push(file);
            }
        }
    }
    provenance(&files, study.seed)
}

/// What was varied.
fn varied(variable: &Variable) -> VariedKey {
    let [min, max] = variable.domain.ends();
    let choices = match &variable.domain {
        Domain::Catalogue(entries) => Some(entries.iter().map(|entry| entry.value).collect()),
        _ => None,
    };
    VariedKey {
        key: variable.key.clone(),
        min,
        max,
        choices,
    }
}
