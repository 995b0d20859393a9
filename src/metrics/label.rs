//! Metrics of either kind of scenario for people: their names and units, and which matter most.

use super::catalogue::ranked;
use super::{BenchSummary, Measured, Metric, Part, Summary};

/// Metrics of a bench, or of a cell, that matter most, the first ones most; of those a run has the ones that it determines.
pub fn most_important(is_bench: bool) -> Vec<&'static str> {
    fn names<S: Measured>() -> Vec<&'static str> {
        let ranked = ranked(S::METRICS, |metric| metric.rank).into_iter();
        ranked.map(|metric| metric.name).collect()
    }
    if is_bench {
        names::<BenchSummary>()
    } else {
        names::<Summary>()
    }
}

/// Names of the metrics of a kind of scenario.
pub fn metric_names(is_bench: bool) -> Vec<&'static str> {
    let names = labels(is_bench).into_iter().map(|label| label.key);
    names.collect()
}

/// A metric for people.
#[derive(Debug, Clone, PartialEq)]
pub struct Label {
    /// Key in summary.json.
    pub key: &'static str,
    /// Its name.
    pub name: String,
    /// Its unit; empty for a plain number.
    pub unit: &'static str,
    /// Its meaning.
    pub meaning: &'static str,
    /// Its definition.
    pub definition: &'static str,
    /// Part of the report.
    pub part: Part,
    /// Rank among the key facts, from 1.
    pub fact: Option<u8>,
}

fn labelled<S: Measured>() -> Vec<Label> {
    let label = |metric: &Metric<S>| Label {
        key: metric.name,
        name: metric.full_label(),
        unit: metric.shown_unit(),
        meaning: metric.meaning,
        definition: metric.definition,
        part: metric.part,
        fact: metric.fact,
    };
    S::METRICS.iter().map(label).collect()
}

/// The metrics of benches, or of cells.
pub fn labels(of_bench: bool) -> Vec<Label> {
    if of_bench {
        labelled::<BenchSummary>()
    } else {
        labelled::<Summary>()
    }
}
