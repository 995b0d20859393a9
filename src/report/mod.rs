//! Results as documents for people: what is said of each kind of result is said here once, and rendered by [`crate::document`].

mod assumed;
mod comparison;
mod diagnosis;
mod diagnosis_charts;
mod diagnosis_tables;
mod estimated;
mod finished_edge;
mod provenance;
mod run;
mod signals;
#[cfg(feature = "cli")]
mod study;
#[cfg(feature = "cli")]
pub mod study_charts;

pub use assumed::assumed;
pub use comparison::{ComparedNumber, Comparison, MOST_DRAWN};
pub use diagnosis::diagnosis;
pub use diagnosis_charts::{lacking, robust_range, variable};
pub use diagnosis_tables::detectable;
pub use provenance::{provenance, sources};
pub use run::{RunReport, drives};
pub use signals::{FORCE, Line, PRESSURE, ROLES, STROKE, chart_groups};

#[cfg(feature = "cli")]
pub use study::study;

use crate::document::Drawing;

/// File with the numbers of a run.
pub const SUMMARY: &str = "summary.json";

/// Pictures of a run.
#[derive(Debug, Clone, Default)]
pub struct Sketches {
    /// The cell, or the bench, as SVG.
    pub cell: Option<String>,
    /// The edge in the colours of its force error; none on a bench.
    pub edge: Option<String>,
    /// The tool across the edge; none on a bench.
    pub lean: Option<String>,
    /// Cell and edge in space; none on a bench.
    pub space: Option<Drawing>,
}
