//! A run as its folder has it.

use std::borrow::Cow;

use serde_json::Value;

use crate::document::Drawing;
use crate::metrics::{Label, labels};
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
