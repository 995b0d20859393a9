//! A study: what is varied, minimised and limited, from its file.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use crate::keys::check::Section;
use crate::keys::document::{Document, read_text};
use crate::keys::error::Location;
use crate::scenario::ScenarioError;

use super::candidate::{Design, Outcome, scenario_key};
use super::file::{BoundKeys, ObjectiveKeys, OverKeys, SCHEMA, StudyFile, VariableKeys};
use super::limits::{Limit, LimitQuantity, Side};
use super::robustness::{Scattering, scattering};
use super::variable::{Variable, variable};

/// A checked study.
#[derive(Debug, Clone, PartialEq)]
pub struct Study {
    /// File that it was read from.
    pub path: PathBuf,
    /// Name for people.
    pub title: String,
    /// Scenario files, as the program finds them.
    pub scenarios: Vec<PathBuf>,
    /// Seed of the search.
    pub seed: u64,
    /// Most designs that are evaluated.
    pub evaluations: usize,
    /// Variables, by key.
    pub variables: Vec<Variable>,
    /// The objective.
    pub objective: Objective,
    /// Second objective, if there is one.
    pub trade_off: Option<TradeOff>,
    /// Levels of the second objective at which the front is computed.
    pub front_points: usize,
    /// Limits to be kept.
    pub limits: Vec<Limit>,
    /// What is drawn at the chosen design, if anything is.
    pub scattering: Option<Scattering>,
    /// Where the metrics of both objectives, then those of the limits stand in the file.
    pub(super) locations: Vec<(String, String, Location)>,
}

/// A metric over the scenarios.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Objective {
    /// Its name, unit included.
    pub metric: String,
    /// Reduction of the scenarios to one number.
    pub over: Over,
}

/// Reduction of the scenarios to one number; those that do not give the metric are left out.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Over {
    /// Their mean.
    Mean,
    /// The largest.
    Worst,
}

/// Further objectives, for the front.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum TradeOff {
    /// A metric.
    Metric(Objective),
    /// The value of a variable, by its index.
    Variable(usize),
}

impl Objective {
    /// The number that an outcome gives.
    pub(super) fn value(&self, outcome: &Outcome) -> Option<f64> {
        let values: Vec<f64> = outcome
            .scenarios
            .iter()
            .filter_map(|scenario| scenario.metrics.get(&self.metric).copied())
            .collect();
        match self.over {
            _ if values.is_empty() => None,
            Over::Mean => Some(values.iter().sum::<f64>() / values.len() as f64),
            Over::Worst => values.into_iter().max_by(f64::total_cmp),
        }
    }
}

impl Study {
    /// Key of the second objective.
    pub fn trade_off_key(&self) -> Option<&str> {
        self.trade_off.as_ref().map(|trade_off| match trade_off {
            TradeOff::Metric(objective) => objective.metric.as_str(),
            TradeOff::Variable(index) => &self.variables[*index].key,
        })
    }

    /// The design with these values, one a variable, in the keys' own units.
    pub fn design(&self, values: &[f64]) -> Design {
        let pairs = self.variables.iter().zip(values);
        Design::new(
            pairs
                .flat_map(|(variable, value)| variable.entries(*value))
                .collect(),
        )
    }

    /// The starting design.
    pub fn starting_design(&self) -> Design {
        let values: Vec<f64> = self.variables.iter().map(|v| v.start).collect();
        self.design(&values)
    }

    /// The variable to blame when a scenario that is sound refuses this key with the variables' values: the key's own or the one it follows, else one
    /// of the same table.
    pub fn variable_to_blame(&self, refused: &str) -> Option<&Variable> {
        let (table, _) = refused.rsplit_once('.').unwrap_or((refused, ""));
        let gives = |fits: &dyn Fn(&str) -> bool| {
            self.variables.iter().find(|variable| {
                let entries = variable.entries(variable.start);
                entries.iter().any(|(key, _)| fits(&scenario_key(key)))
            })
        };
        gives(&|key| key == refused)
            .or_else(|| gives(&|key| key.rsplit_once('.').is_some_and(|(own, _)| own == table)))
    }

    /// Values at places from 0 to 1, one a variable.
    pub(super) fn values(&self, coordinates: &[f64]) -> Vec<f64> {
        let pairs = self.variables.iter().zip(coordinates);
        pairs
            .map(|(variable, coordinate)| variable.domain.value(*coordinate))
            .collect()
    }

    /// Places of the starting design.
    pub(super) fn start(&self) -> Vec<f64> {
        let coordinate = |variable: &Variable| variable.domain.coordinate(variable.start);
        self.variables.iter().map(coordinate).collect()
    }
}

/// Reads and checks a study file.
///
/// # Errors
/// One message with file, line and column, the key, its value and what was expected.
pub fn load(path: &Path) -> Result<Study, ScenarioError> {
    from_text(path, &read_text(path)?)
}

/// As `load`, of a text that stands, or could stand, in the file at `path`.
pub(super) fn from_text(path: &Path, text: &str) -> Result<Study, ScenarioError> {
    let document = Document::new(path, text, SCHEMA)?;
    let file: StudyFile = document.read().map_err(quote_dotted)?;
    debug_assert_eq!(file.schema, SCHEMA, "others are refused by Document::new");
    let section = Section::new(&document, "study");
    let evaluations = file.study.evaluations;
    let variables = variables(&document, &file)?;
    let least = least_evaluations(variables.len());
    let (objective, trade_off, front_points) = objectives(&document, &file.objective, &variables)?;
    let limits = limits(&document, &file)?;
    let scattering = (file.robustness.as_ref())
        .map(|keys| scattering(&document, keys, &variables))
        .transpose()?;
    let study = Study {
        path: path.to_owned(),
        title: section.text("title", &file.study.title)?,
        scenarios: scenarios(&section, &file.study.scenarios)?,
        seed: file.study.seed,
        evaluations: section.count("evaluations", evaluations, least..=1_000_000)?,
        locations: locations(&document, &objective, trade_off.as_ref(), &limits),
        variables,
        objective,
        trade_off,
        front_points,
        limits,
        scattering,
    };
    Ok(study)
}

/// A search worth the name: some generations, and a simplex in each of its parts.
fn least_evaluations(variables: usize) -> usize {
    50 * variables.max(1)
}

/// `[variables.controller.gain]` is a table in a table; say how it is meant to be written.
fn quote_dotted(error: ScenarioError) -> ScenarioError {
    match error {
        ScenarioError::UnknownKey { location, key, .. }
            if key.matches('.').count() > 1 && !key.contains("device") =>
        {
            let name = key.trim_start_matches("variables.").to_owned();
            ScenarioError::UnknownKey {
                location,
                key,
                advice: format!("a name with a dot stands in quotes: [variables.\"{name}\"]"),
            }
        }
        other => other,
    }
}

fn scenarios(section: &Section<'_>, files: &[PathBuf]) -> Result<Vec<PathBuf>, ScenarioError> {
    if files.is_empty() {
        let expected = "at least one scenario file".to_owned();
        return Err(section.refuse("scenarios", "[]".to_owned(), expected));
    }
    let mut seen = BTreeSet::new();
    let check = |(index, file): (usize, &PathBuf)| {
        let key = format!("scenarios[{index}]");
        let full = section.file(&key, file)?;
        if !seen.insert(full.clone()) {
            let expected = "each scenario once".to_owned();
            return Err(section.refuse(&key, format!("\"{}\"", file.display()), expected));
        }
        Ok(full)
    };
    files.iter().enumerate().map(check).collect()
}

fn variables(document: &Document<'_>, file: &StudyFile) -> Result<Vec<Variable>, ScenarioError> {
    if file.variables.is_empty() {
        let expected = "at least one table such as [variables.bore_mm]";
        return Err(Section::new(document, "").missing("variables", expected));
    }
    let rod_varies = file.variables.contains_key("rod_mm");
    let check = |(key, keys): (&String, &VariableKeys)| variable(document, key, keys, rod_varies);
    file.variables.iter().map(check).collect()
}

type Objectives = (Objective, Option<TradeOff>, usize);

fn objectives(
    document: &Document<'_>,
    keys: &ObjectiveKeys,
    variables: &[Variable],
) -> Result<Objectives, ScenarioError> {
    let section = Section::new(document, "objective");
    let over = |over: OverKeys| match over {
        OverKeys::Mean => Over::Mean,
        OverKeys::Worst => Over::Worst,
    };
    let given = |key: &str| section.given().any(|given| given == key);
    let objective = Objective {
        metric: section.text("minimise", &keys.minimise)?,
        over: over(keys.minimise_over),
    };
    let Some(trade_off) = &keys.trade_off else {
        let needless = ["trade_off_over", "front_points"];
        return match needless.into_iter().find(|key| given(key)) {
            Some(key) => {
                Err(section.misplaced(key, "there is no `trade_off` that it belongs to".to_owned()))
            }
            None => Ok((objective, None, keys.front_points)),
        };
    };
    let name = section.text("trade_off", trade_off)?;
    let index = variables.iter().position(|variable| variable.key == name);
    if index.is_some() && given("trade_off_over") {
        let reason = format!("{name} is a variable, the same in every scenario");
        return Err(section.misplaced("trade_off_over", reason));
    }
    if name == objective.metric {
        let expected = "another quantity than the one that is minimised".to_owned();
        return Err(section.refuse("trade_off", format!("\"{name}\""), expected));
    }
    let trade_off = index.map_or_else(
        || {
            TradeOff::Metric(Objective {
                metric: name.clone(),
                over: over(keys.trade_off_over),
            })
        },
        TradeOff::Variable,
    );
    Ok((objective, Some(trade_off), keys.front_points))
}

fn limits(document: &Document<'_>, file: &StudyFile) -> Result<Vec<Limit>, ScenarioError> {
    let mut limits = Vec::new();
    for (name, keys) in &file.limits {
        check_bounds(document, name, keys)?;
        for (side, bound) in [(Side::Min, keys.min), (Side::Max, keys.max)] {
            let quantity = match name.as_str() {
                "force_n" => LimitQuantity::Force,
                metric => LimitQuantity::Metric(metric.to_owned()),
            };
            limits.extend(bound.map(|bound| Limit {
                quantity,
                side,
                bound,
            }));
        }
    }
    Ok(limits)
}

fn check_bounds(
    document: &Document<'_>,
    name: &str,
    keys: &BoundKeys,
) -> Result<(), ScenarioError> {
    let section = Section::new(document, format!("limits.{name}"));
    for (key, bound) in [("min", keys.min), ("max", keys.max)] {
        if let Some(bound) = bound
            && !bound.is_finite()
        {
            let expected = "a finite number".to_owned();
            return Err(section.refuse(key, bound.to_string(), expected));
        }
    }
    match (keys.min, keys.max) {
        (None, None) => Err(section.missing("min", "min or max, or both")),
        (Some(min), Some(max)) if min > max => {
            Err(section.refuse("min", min.to_string(), format!("at most max, {max}")))
        }
        _ => Ok(()),
    }
}

/// Key, metric and place of every metric that the file names.
fn locations(
    document: &Document<'_>,
    objective: &Objective,
    trade_off: Option<&TradeOff>,
    limits: &[Limit],
) -> Vec<(String, String, Location)> {
    let mut named = vec![("objective.minimise".to_owned(), objective.metric.clone())];
    if let Some(TradeOff::Metric(objective)) = trade_off {
        named.push(("objective.trade_off".to_owned(), objective.metric.clone()));
    }
    for limit in limits {
        if let LimitQuantity::Metric(metric) = &limit.quantity {
            named.push((format!("limits.{metric}"), metric.clone()));
        }
    }
    let location = |(key, metric): (String, String)| (key.clone(), metric, document.location(&key));
    named.into_iter().map(location).collect()
}
