//! A run as its folder has it, and its metrics for people.

use std::borrow::Cow;

use serde_json::Value;

use crate::metrics::{BENCH_METRICS, METRICS, Metric};
use crate::page::Drawing;
use crate::recording::Recording;
use crate::recording::csv::EdgeProfile;

/// A run as its folder has it.
pub(in super::super) struct RunResult<'a> {
    /// summary.json.
    pub document: Value,
    /// samples.parquet.
    pub recording: Cow<'a, Recording>,
    /// cell.svg.
    pub cell: Option<Cow<'a, str>>,
    /// edge.svg.
    pub edge: Option<Cow<'a, str>>,
    /// lean.svg.
    pub lean: Option<Cow<'a, str>>,
    /// drawing.json.
    pub space: Option<Cow<'a, Drawing>>,
    /// edge_profile.csv.
    pub profile: Option<Cow<'a, EdgeProfile>>,
}

/// A metric for people.
#[derive(Debug, Clone, PartialEq)]
pub(in super::super) struct Label {
    /// Key in summary.json.
    pub key: &'static str,
    /// Its name.
    pub name: String,
    /// Its unit; empty for a plain number.
    pub unit: &'static str,
    /// Its meaning.
    pub meaning: &'static str,
}

fn labelled<S>(metrics: &[Metric<S>]) -> Vec<Label> {
    let label = |metric: &Metric<S>| Label {
        key: metric.name,
        name: metric.full_label(),
        unit: metric.shown_unit(),
        meaning: metric.meaning,
    };
    metrics.iter().map(label).collect()
}

/// The metrics of benches, or of cells.
pub(in super::super) fn labels(of_bench: bool) -> Vec<Label> {
    if of_bench {
        labelled(BENCH_METRICS)
    } else {
        labelled(METRICS)
    }
}

impl RunResult<'_> {
    /// Its title.
    pub(in super::super) fn title(&self) -> &str {
        self.document["title"].as_str().unwrap_or("a run")
    }

    /// Its metrics in their order, with their values.
    pub(in super::super) fn metrics(&self) -> Vec<(Label, Option<f64>)> {
        let summary = &self.document["summary"];
        let own = labels(self.document["kind"] == "bench").into_iter();
        own.filter_map(|label| {
            let value = summary.get(label.key)?.as_f64();
            Some((label, value))
        })
        .collect()
    }

    /// The value of one.
    pub(super) fn metric(&self, key: &str) -> Option<f64> {
        self.document["summary"][key].as_f64()
    }
}
