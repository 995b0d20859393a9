//! How the numbers of a sweep are distributed, and which variable drives which.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use super::sweep::Sweep;
use super::{QUANTILES, Varied, rank_correlation, shares_of_variance};
use crate::metrics::{Label, labels, metric_names, most_important};
use crate::quantity::display_name::display_name;
use crate::quantity::{capital, column, counted};
use crate::recording::RecordingError;
use crate::recording::long_column::LongColumn;
use crate::recording::provenance::SourceFile;
use crate::stats::quantiles;

/// Refusals that are listed with their run.
const MOST_REASONS: usize = 3;
/// Share from which a driver stands in a terminal's line [1].
const MIN_SHARE: f64 = 0.01;
/// Drivers of a terminal's line.
const NAMED: usize = 2;

/// A sweep that has been run.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Swept {
    /// Version of this form.
    pub schema: u32,
    /// The scenario's file and title.
    pub scenario: String,
    /// See `scenario`.
    pub title: String,
    /// Whether it is a bench's.
    pub is_bench: bool,
    /// How the points lie.
    pub points: String,
    /// Their number.
    pub runs: usize,
    /// Whether the scenario sets bounds on results.
    #[serde(default)]
    pub bounded: bool,
    /// Number of runs by exit code.
    pub codes: BTreeMap<u8, usize>,
    /// The first runs that were refused or stopped: their numbers, and why.
    pub stopped: Vec<(usize, String)>,
    /// Keys that vary, with the ends of their values.
    pub variables: Vec<VariedKey>,
    /// Numbers of the runs.
    pub metrics: Vec<MetricOfRuns>,
    /// Who did the runs.
    pub program: String,
    /// Files that all runs read.
    pub files: Vec<SourceFile>,
}

/// A key that varies.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct VariedKey {
    /// The key.
    pub key: String,
    /// Number of different values.
    pub values: usize,
    /// Least and greatest, of numbers.
    pub ends: Option<[f64; 2]>,
    /// Which values it may have, in words.
    #[serde(default)]
    pub which: String,
}

/// A metric over all runs.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct MetricOfRuns {
    /// Its name in summary.json.
    pub name: String,
    /// Runs that determine it.
    pub runs: usize,
    /// Its quantiles, by the share [1] of the runs below.
    pub quantiles: Vec<(f64, f64)>,
    /// What drives it, the largest share first; empty where it stands still.
    pub drivers: Vec<Driver>,
}

/// How a metric goes with a variable.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Driver {
    /// The variable's key.
    pub key: String,
    /// First-order share of the metric's variance [1], with its interval at 95 %.
    pub share: f64,
    /// See `share`.
    pub interval: [f64; 2],
    /// What the same values shuffled among the runs get at most, 95 times of 100 [1].
    #[serde(default)]
    pub shuffled: f64,
    /// Correlation of ranks, from -1 to 1; none of names.
    pub rank_correlation: Option<f64>,
}

impl Driver {
    /// Whether its share differs from chance.
    pub fn is_sure(&self) -> bool {
        self.interval[0] > self.shuffled
    }
}

impl MetricOfRuns {
    /// Drivers of which it is sure.
    pub fn sure(&self) -> impl Iterator<Item = &Driver> {
        self.drivers.iter().filter(|driver| driver.is_sure())
    }

    /// Whether it is another number in some run.
    pub fn varies(&self) -> bool {
        !self.drivers.is_empty()
    }

    /// One of its quantiles.
    pub fn quantile(&self, share: f64) -> Option<f64> {
        let found = self.quantiles.iter().find(|(of, _)| *of == share);
        found.map(|(_, value)| *value)
    }
}

/// Columns of a table of runs by their names, a few at a time, as the table may be long.
pub type ReadColumns<'a> =
    &'a dyn Fn(&[&str]) -> Result<BTreeMap<String, LongColumn>, RecordingError>;

/// Values of a column as numbers: names by their order in the alphabet.
fn as_numbers(column: &LongColumn) -> Vec<f64> {
    match column {
        LongColumn::Numbers(numbers) => numbers.clone(),
        LongColumn::Names(names) => {
            let mut each: Vec<&String> = names.iter().collect();
            each.sort();
            each.dedup();
            let place = |name: &String| each.binary_search(&name).unwrap_or(0) as f64;
            names.iter().map(place).collect()
        }
    }
}

fn varied(key: &str, which: &str, column: &LongColumn) -> VariedKey {
    let mut values = as_numbers(column);
    values.sort_by(f64::total_cmp);
    values.dedup();
    let ends = values.first().zip(values.last());
    let ends = ends.map(|(low, high)| [*low, *high]);
    VariedKey {
        key: key.to_owned(),
        values: values.len(),
        ends: ends.filter(|_| matches!(column, LongColumn::Numbers(_))),
        which: which.to_owned(),
    }
}

impl Swept {
    /// What the table of a sweep's runs says, which a program of this name did from these files.
    ///
    /// # Errors
    /// Those of reading, and of a table without the runs' codes and reasons.
    pub fn of(
        sweep: &Sweep,
        (program, files): (&str, &[SourceFile]),
        columns: ReadColumns<'_>,
    ) -> Result<Self, RecordingError> {
        let keys = sweep.points.variables().iter();
        let keys: Vec<&str> = keys.map(|variable| variable.key.as_str()).collect();
        let variables = columns(&keys)?;
        let numbers: Vec<(&str, bool, Vec<f64>)> = (keys.iter())
            .filter_map(|key| {
                let column = variables.get(*key)?;
                let names = matches!(column, LongColumn::Names(_));
                Some((*key, names, as_numbers(column)))
            })
            .collect();
        let metrics = metric_names(sweep.template.is_bench());
        let metrics = metrics.into_iter().map(|name| {
            let read = columns(&[name])?;
            let values = read.get(name).map(as_numbers).unwrap_or_default();
            Ok(metric(name, &values, &numbers))
        });
        let metrics: Vec<MetricOfRuns> = metrics.collect::<Result<_, RecordingError>>()?;
        let (codes, stopped) = ends(columns)?;
        Ok(Self {
            schema: 1,
            scenario: sweep.template.path().display().to_string(),
            title: sweep.template.title().to_owned(),
            is_bench: sweep.template.is_bench(),
            points: sweep.points.words(),
            runs: sweep.points.count(),
            codes,
            stopped,
            bounded: sweep.is_bounded(),
            variables: (sweep.points.variables().iter())
                .filter_map(|v| {
                    let which = if sweep.points.is_table() {
                        "those of a table"
                    } else {
                        v.words()
                    };
                    Some(varied(&v.key, which, variables.get(&v.key)?))
                })
                .collect(),
            metrics: metrics.into_iter().filter(|m| m.runs > 0).collect(),
            program: program.to_owned(),
            files: files.to_vec(),
        })
    }

    /// How the runs ended, in a sentence.
    pub fn verdict(&self) -> String {
        let mut text = counted(self.runs, "run");
        let words = [
            (1, "outside the bounds"),
            (2, "refused"),
            (3, "stopped by the physics"),
        ];
        let endings: Vec<String> = words
            .into_iter()
            .filter_map(|(code, words)| Some(format!("{} {words}", self.codes.get(&code)?)))
            .collect();
        text += &match endings.is_empty() {
            true if self.bounded => ", all to their end and within the bounds".to_owned(),
            true => ", all to their end; the scenario sets no bounds".to_owned(),
            false => format!(": {}", endings.join(", ")),
        };
        text + "."
    }

    /// What drives the numbers that differ and matter most, a sentence each.
    #[must_use]
    pub fn findings(&self) -> Vec<String> {
        let finding = |(label, metric): (Label, &MetricOfRuns)| {
            let ends = [0.05, 0.5, 0.95].map(|share| metric.quantile(share));
            let cells = column(&ends, label.unit);
            let drivers: Vec<String> = metric
                .sure()
                .filter(|driver| driver.share >= MIN_SHARE)
                .take(NAMED)
                .map(|driver| {
                    let name = display_name(short(&driver.key)).0;
                    let [low, high] = driver.interval.map(percent);
                    format!("{name} {} % ({low} to {high})", percent(driver.share))
                })
                .collect();
            let drivers = match drivers.is_empty() {
                true => "nothing that chance does not explain".to_owned(),
                false => drivers.join(", "),
            };
            let unit = match label.unit {
                "" => String::new(),
                unit => format!(" {unit}"),
            };
            format!(
                "{}: {} to {}{unit} in 90 % of the runs, median {}; driven by {drivers}.",
                capital(&label.name),
                cells[0],
                cells[2],
                cells[1]
            )
        };
        let findings: Vec<String> = self.most_important().map(finding).collect();
        match findings.is_empty() {
            true => vec!["No number differs between the runs.".to_owned()],
            false => findings,
        }
    }

    /// Metrics that differ and matter most.
    pub fn most_important(&self) -> impl Iterator<Item = (Label, &MetricOfRuns)> {
        let labels = self.labels();
        let names = most_important(self.is_bench);
        names.into_iter().filter_map(move |name| {
            let metric = self.metrics.iter().find(|metric| metric.name == name)?;
            let label = labels.iter().find(|label| label.key == name)?;
            metric.varies().then(|| (label.clone(), metric))
        })
    }

    /// Its metrics for people.
    pub fn labels(&self) -> Vec<Label> {
        labels(self.is_bench)
    }
}

/// The last part of a key.
pub fn short(key: &str) -> &str {
    key.rsplit('.').next().unwrap_or(key)
}

/// A share in percent, as it is shown.
pub fn percent(share: f64) -> String {
    match 100.0 * share {
        percent if percent > 0.0 && percent < 0.5 => "<1".to_owned(),
        percent => format!("{percent:.0}"),
    }
}

fn metric(name: &str, values: &[f64], variables: &[(&str, bool, Vec<f64>)]) -> MetricOfRuns {
    let found = quantiles(values, &QUANTILES).unwrap_or_default();
    let varied: Vec<Varied<'_>> = (variables.iter())
        .map(|(_, names, values)| Varied {
            values,
            names: *names,
        })
        .collect();
    let shares = shares_of_variance(&varied, values, 0);
    let mut drivers: Vec<Driver> = (variables.iter().zip(shares))
        .filter_map(|((key, names, x), share)| {
            let share = share?;
            Some(Driver {
                key: (*key).to_owned(),
                share: share.value,
                interval: share.interval,
                shuffled: share.shuffled,
                rank_correlation: if *names {
                    None
                } else {
                    rank_correlation(x, values)
                },
            })
        })
        .collect();
    drivers.sort_by(|a, b| b.share.total_cmp(&a.share));
    MetricOfRuns {
        name: name.to_owned(),
        runs: values.iter().filter(|value| !value.is_nan()).count(),
        quantiles: QUANTILES.into_iter().zip(found).collect(),
        drivers,
    }
}

/// Runs by exit code, and the first that were refused or stopped.
type Ends = (BTreeMap<u8, usize>, Vec<(usize, String)>);

fn ends(columns: ReadColumns<'_>) -> Result<Ends, RecordingError> {
    let read = columns(&["code", "reason"])?;
    let (Some(LongColumn::Numbers(codes)), Some(LongColumn::Names(reasons))) =
        (read.get("code"), read.get("reason"))
    else {
        return Err(RecordingError::Missing {
            quantity: "code".to_owned(),
        });
    };
    let mut counts = BTreeMap::new();
    let mut first = Vec::new();
    for (run, (code, reason)) in codes.iter().zip(reasons).enumerate() {
        *counts.entry(*code as u8).or_insert(0) += 1;
        if *code >= 2.0 && first.len() < MOST_REASONS {
            first.push((run + 1, reason.clone()));
        }
    }
    Ok((counts, first))
}
