//! `idc schema`: what editors need to know of a file's keys.

use clap::{Args, ValueEnum};

use super::error::{AppError, ExitCode};
use super::output::say;
use crate::metrics::{BenchSummary, Measured, Summary};
use crate::{design, import, scenario};

/// For the help.
pub(super) const EXAMPLES: &str = "\
They stand in assets/schemas as well. An editor for TOML (taplo, Even Better
TOML of VS Code) takes one from the first line of a file:
  #:schema https://example.org/schemas/scenario.json, or a path

Exit codes: 0 done, 2 bad input.

Examples:
  # Keys, units, ranges and defaults of a scenario.
  idc schema scenario > scenario.json
  # Every key of a rig file's cylinder.
  idc schema rig | python3 -c 'import json, sys; \\
      print(*json.load(sys.stdin)[\"properties\"][\"cylinder\"][\"properties\"])'";

#[derive(Debug, Args)]
pub(super) struct SchemaArguments {
    /// Which file.
    #[arg(value_enum)]
    file: File,
}

/// A file that has a schema.
#[derive(Debug, Clone, Copy, ValueEnum)]
enum File {
    /// A scenario: a cell, a bench or a recorded cell.
    Scenario,
    /// A rig file.
    Rig,
    /// A recorded arm.
    Arm,
    /// Still postures of a wrench sensor.
    Postures,
    /// An import map.
    Import,
    /// A design study.
    Study,
    /// A device model.
    Device,
    /// A table of runs: what a tool took off.
    #[value(name = "removal_table")]
    RemovalTable,
}

impl File {
    fn schema(self) -> serde_json::Value {
        match self {
            Self::Scenario => with_metrics(scenario::schema::scenario()),
            Self::Rig => scenario::schema::rig(),
            Self::Arm => scenario::arm_file::schema(),
            Self::Postures => scenario::postures_file::schema(),
            Self::Import => import::map_file::schema(),
            Self::Study => design::schema(),
            Self::Device => scenario::schema::device(),
            Self::RemovalTable => scenario::removal_table::schema(),
        }
    }
}

/// Names the metrics that `[expect]` may bound.
fn with_metrics(mut schema: serde_json::Value) -> serde_json::Value {
    schema["then"]["properties"]["expect"]["propertyNames"] = one_of::<BenchSummary>();
    schema["else"]["else"]["properties"]["expect"]["propertyNames"] = one_of::<Summary>();
    schema
}

fn one_of<S: Measured>() -> serde_json::Value {
    let names: Vec<&str> = S::METRICS.iter().map(|metric| metric.name).collect();
    serde_json::json!({ "enum": names })
}

/// Prints a schema.
pub(super) fn run(arguments: &SchemaArguments) -> Result<ExitCode, AppError> {
    say(&format!("{:#}\n", arguments.file.schema()))?;
    Ok(ExitCode::Done)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::metrics::test_planted::Planted;

    #[test]
    fn every_number_that_is_declared_may_be_bounded() {
        let names = one_of::<Planted>();
        assert_eq!(names["enum"][0], "planted_depth_mm");
    }
}
