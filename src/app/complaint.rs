//! Printing of an error: one sentence on standard error, below it the line of the file that it is about with a caret; as JSON where JSON was asked for.
//!
//! ```text
//! error: cell.toml:28:1: unknown key `process.froce_n`; did you mean `force_n`?
//!   --> cell.toml:28:1
//!    |
//! 28 | froce_n = 150
//!    | ^^^^^^^
//! ```

use std::path::Path;

use annotate_snippets::{AnnotationKind, Group, Level, Renderer, Snippet};
use anstyle::{AnsiColor, Style};

use super::advice::as_json as as_json_list;
use super::error::{AppError, ExitCode};
use super::terminal::{say_aside, say_aside_styled, shown_path};
use crate::advice::Advice;
use crate::cell::CellError;
use crate::design::DesignError;
use crate::document::printable;
use crate::keys::error::Location;
use crate::metrics::MetricsError;
use crate::run::RunError;
use crate::scenario::{ScenarioError, location_of};

/// The word that an error begins with.
const WORD: Style = AnsiColor::BrightRed.on_default().bold();

/// Whether JSON was asked for, of whichever command.
pub fn wants_json(matches: &clap::ArgMatches) -> bool {
    let Some((_, command)) = matches.subcommand() else {
        return false;
    };
    let flag = command.try_get_one::<bool>("json");
    matches!(flag, Ok(Some(true))) || wants_json(command)
}

/// Tells an error on standard error.
pub fn complain(error: &AppError, json: bool) {
    let code = error.exit_code();
    let location = location(error);
    if json {
        say_aside(&as_json(error, code, location.as_ref()).to_string());
        return;
    }
    let sentence = error.to_string();
    say_aside_styled(&format!("{WORD}error{WORD:#}: {}\n", printable(&sentence)));
    if let Some(excerpt) = location.as_ref().and_then(excerpt) {
        say_aside_styled(&format!("{excerpt}\n"));
    }
}

/// Refuses arguments, or shows the help that they ask for, and ends the program. What was typed may be a name that a shell took from a folder.
pub fn refuse_arguments(error: &clap::Error) -> ! {
    if !error.use_stderr() {
        error.exit();
    }
    say_aside_styled(&error.render().ansi().to_string());
    std::process::exit(error.exit_code());
}

/// What an error is about, for a program in the same process.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Facts {
    /// The file, if it is about one.
    pub file: Option<String>,
    /// Line and column in it, both from 1.
    pub position: Option<(u32, u32)>,
    /// Its dotted key.
    pub key: Option<String>,
}

impl Facts {
    /// Those of an error.
    #[must_use]
    pub fn of(error: &AppError) -> Self {
        let scenario = scenario_error(error);
        let place = location(error).or_else(|| scenario?.location().cloned());
        let missing = match scenario {
            Some(ScenarioError::NoSuchFile { file } | ScenarioError::Read { file, .. }) => {
                Some(file.display().to_string())
            }
            _ => None,
        };
        Self {
            file: (place.as_ref())
                .map(|place| place.file.display().to_string())
                .or(missing),
            position: place.and_then(|place| place.position),
            key: scenario
                .and_then(ScenarioError::key)
                .map(str::to_owned)
                .or_else(|| metric_key(error)),
        }
    }
}

/// The fault of a settings file behind an error.
fn scenario_error(error: &AppError) -> Option<&ScenarioError> {
    match error {
        AppError::Advised { source, .. } | AppError::Set { source, .. } => scenario_error(source),
        AppError::Run(error) => match &**error {
            RunError::Scenario(error) | RunError::Cell(CellError::Scenario(error)) => Some(error),
            _ => None,
        },
        AppError::Design(error) => match &**error {
            DesignError::File(error) => Some(error),
            _ => None,
        },
        _ => None,
    }
}

/// Key of a bound that cannot be.
fn metric_key(error: &AppError) -> Option<String> {
    match error {
        AppError::Advised { source, .. } | AppError::Set { source, .. } => metric_key(source),
        AppError::Run(error) => match &**error {
            RunError::Metrics {
                source:
                    MetricsError::UnknownMetric { metric, .. } | MetricsError::Bound { metric, .. },
                ..
            } => Some(format!("expect.{metric}")),
            _ => None,
        },
        _ => None,
    }
}

/// Where in a file the error is.
fn location(error: &AppError) -> Option<Location> {
    match error {
        AppError::Advised { source, .. } => location(source),
        AppError::Run(error) => location_of_run(error),
        AppError::Design(error) => match &**error {
            DesignError::File(error) => error.location().cloned(),
            DesignError::Variable { location, .. }
            | DesignError::UnknownMetric { location, .. } => Some(location.clone()),
            _ => None,
        },
        _ => None,
    }
}

/// The same of a scenario, its run or its numbers.
fn location_of_run(error: &RunError) -> Option<Location> {
    let of_key = |file: &Path, key: &str| location_of(file, key);
    let error = match error {
        RunError::Scenario(error) | RunError::Cell(CellError::Scenario(error)) => {
            return error.location().cloned();
        }
        RunError::Metrics {
            file,
            source: MetricsError::UnknownMetric { metric, .. } | MetricsError::Bound { metric, .. },
        } => return of_key(Path::new(file), &format!("expect.{metric}")),
        RunError::Cell(error) => error,
        _ => return None,
    };
    match error {
        CellError::EdgeUnknown { file, .. } | CellError::EdgeNotConvex { file, .. } => {
            ["edge", "loop"]
                .into_iter()
                .find_map(|key| of_key(file, &format!("workpiece.edge.{key}")))
        }
        CellError::JointStiffness { file, .. } => of_key(file, "joints.stiffness_n_m_per_rad"),
        CellError::JointTorque { file, .. } => of_key(file, "limits.joint_torque_n_m"),
        CellError::Supply { file, .. } | CellError::Weight { file, .. } => {
            of_key(file, "process.force_n")
        }
        CellError::BallTooLarge { file, .. } => of_key(file, "device.override.tool_ball_radius_mm"),
        CellError::ShiftBeyondStroke { file, .. } => (["shift_mm", "tilt_deg"].iter())
            .find_map(|key| of_key(file, &format!("workpiece.misplacement.{key}"))),
        CellError::SeedPosture { file, .. } => of_key(file, "arm.seed_posture_deg"),
        CellError::EdgeStretch { file, key, .. } => of_key(file, &format!("workpiece.edge.{key}")),
        CellError::Effect { file, key, .. } => of_key(file, key),
        CellError::Burr { file, .. } => of_key(file, "workpiece.burr.kind"),
        _ => None,
    }
}

/// The line with carets below what is meant.
fn excerpt(location: &Location) -> Option<String> {
    // A scenario from elsewhere may name any file of this machine, whose lines are not to be shown.
    location.file.extension().filter(|end| *end == "toml")?;
    let (line, _) = location.position?;
    let excerpt = location.excerpt.as_ref()?;
    let file = shown_path(&location.file);
    let snippet = Snippet::source(&excerpt.line)
        .line_start(line as usize)
        .path(file)
        .annotation(AnnotationKind::Primary.span(excerpt.meant.clone()));
    let group = Group::with_level(Level::ERROR).element(snippet);
    // `anstream` takes the colours out where there is no terminal.
    Some(Renderer::styled().render(&[group]))
}

/// What would help, of a refusal that comes with it.
fn advice_of(error: &AppError) -> Option<&Advice> {
    match error {
        AppError::Advised { advice, .. } => Some(advice),
        AppError::Set { source, .. } => advice_of(source),
        _ => None,
    }
}

/// One line: {"error": {"message", "exit_code"}}, "file", "line", "column" where it is in a file, and "remedies" of a job: what each sets.
fn as_json(error: &AppError, code: ExitCode, location: Option<&Location>) -> serde_json::Value {
    let mut message = serde_json::json!({
        "message": error.to_string(),
        "exit_code": code as u8,
    });
    if let Some(location) = location {
        message["file"] = location.file.display().to_string().into();
        if let Some((line, column)) = location.position {
            message["line"] = line.into();
            message["column"] = column.into();
        }
    }
    if let Some(advice) = advice_of(error) {
        message["remedies"] = as_json_list(advice);
    }
    serde_json::json!({ "error": message })
}
