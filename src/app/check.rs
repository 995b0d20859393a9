//! `idc check`: what a file describes and what would be done with it, without doing it; of a recorded arm the motion that would tell most of it.

mod arm;
mod arm_design;
mod bench;
mod cell;
mod identifiability;
mod postures;
mod removal_table;
mod report;
mod rig;
mod study;

use std::path::{Path, PathBuf};

use clap::Args;

use self::arm_design::Wanted;
use self::report::Report;
use super::advice::AdviceArguments;
use super::error::{AppError, ExitCode};
use super::files::{OverwritePolicy, prepare_file};
use super::output::say;
use crate::case::{POSTURES, RIG, is_arm_case, is_postures_case};
use crate::recording::atomic::write_text;
use crate::scenario::arm_file::is_arm_file;
use crate::scenario::postures_file::is_postures_file;
use crate::scenario::removal_table::is_removal_table;
use crate::scenario::{self, AnyScenario, ScenarioError, ScenarioTemplate};

/// For the help.
pub(super) const EXAMPLES: &str = "\
What is wrong is reported with file, line and column, and the key that was
probably meant. Of a cell that cannot do its job changes are looked for with
which it can; each is checked and run before it is given, and stands in --json
as keys and values for --set. Exit codes: 0 it can be used, 2 it cannot.

Examples:
  # What would be simulated, how long it is and how large its files will be.
  idc check scenarios/plate_edge.toml
  # A rig, a design study and an import map are explained as well.
  idc check scenarios/studies/device_design.toml
  # A case for idc diagnose: its rig file and the recordings that it names.
  idc check assets/proof/cases/case-03
  # How the tool stands across the edge, drawn.
  idc check scenarios/tilted_wrist.toml --draw runs/tilted_wrist_tool.svg
  # A recorded arm: what its log can tell, and a path that would tell it best.
  idc new arm runs/arm/arm.toml --urdf models/arm/arm10.urdf
  idc check runs/arm/arm.toml --design runs/arm/path.csv --duration-s 10
  # For a program; of a refusal, what would make the job possible.
  idc check scenarios/hand_push.toml --json";

#[derive(Debug, Args)]
pub(super) struct CheckArguments {
    /// Scenario, rig file, recorded arm, table of runs, import map, study or device model; or a folder with rig.toml or arm.toml and its recordings.
    pub(super) file: PathBuf,
    /// SVG file for a drawing of how a cell's tool stands across its edge.
    #[arg(long, value_name = "FILE", help_heading = "Output")]
    pub(super) draw: Option<PathBuf>,
    /// CSV file for a path of a recorded arm's joints over time that tells its numbers apart best, within its limits; a picture goes beside it.
    #[arg(long, value_name = "CSV", help_heading = "Output")]
    pub(super) design: Option<PathBuf>,
    /// Duration of that path [default: 30].
    #[arg(long, value_name = "SECONDS", help_heading = "Output", requires = "design", value_parser = duration)]
    pub(super) duration_s: Option<f64>,
    /// Put new files in place of old ones.
    #[arg(long, help_heading = "Output")]
    pub(super) force: bool,
    #[command(flatten)]
    pub(super) advice: AdviceArguments,
    /// Print nothing but errors.
    #[arg(long, help_heading = "Output")]
    pub(super) quiet: bool,
    /// Print it as JSON.
    #[arg(long, conflicts_with = "quiet", help_heading = "Output")]
    pub(super) json: bool,
}

/// Duration of a path that is designed [s].
const USUAL_DURATION: f64 = 30.0;

fn duration(text: &str) -> Result<f64, String> {
    let read = text.parse().ok().filter(|s| (5.0..=600.0).contains(s));
    read.ok_or_else(|| "expected 5 to 600 seconds".to_owned())
}

/// Explains a file.
pub(super) fn run(arguments: &CheckArguments) -> Result<ExitCode, AppError> {
    let mut report = explained(&arguments.file).map_err(|error| advised(error, arguments))?;
    if let Some(path) = &arguments.design {
        let wanted = Wanted {
            file: path,
            duration: arguments.duration_s.unwrap_or(USUAL_DURATION),
            policy: OverwritePolicy::of(arguments.force),
        };
        arm_design::add(&mut report, &arguments.file, &wanted)?;
    }
    if let Some(draw) = &arguments.draw {
        let drawing = report.drawing.as_ref().ok_or_else(|| AppError::NoTool {
            file: arguments.file.display().to_string(),
        })?;
        let _claim = prepare_file(draw, "--draw", OverwritePolicy::of(arguments.force))?;
        write_text(draw, drawing)?;
    }
    if arguments.json {
        say(&report.json()?)?;
    } else if !arguments.quiet {
        say(&report.text())?;
    }
    Ok(ExitCode::Done)
}

/// A scenario that can be run.
fn of_scenario(scenario: AnyScenario, overridden: &[String]) -> Result<Report, AppError> {
    match scenario {
        AnyScenario::Cell(own) => cell::cell(*own, overridden),
        AnyScenario::Bench(own) => bench::bench(*own, overridden),
    }
}

/// What a file, or a folder, describes: the document that --json prints. What would make a refused job possible is not looked for.
///
/// # Errors
/// It cannot be used.
pub fn check_file(file: &Path) -> Result<String, AppError> {
    explained(file)?.json()
}

/// The same of a scenario that was read before.
///
/// # Errors
/// It cannot be run.
pub fn check_scenario(template: &ScenarioTemplate) -> Result<String, AppError> {
    let overridden = template.keys_given(cell::OVERRIDES)?;
    of_scenario(template.with(&[])?, &overridden)?.json()
}

/// A refusal of a cell's scenario with what would help.
fn advised(error: AppError, arguments: &CheckArguments) -> AppError {
    let quiet = arguments.quiet || arguments.json;
    match ScenarioTemplate::read(&arguments.file) {
        Ok(template) if !template.is_bench() => {
            (arguments.advice).with_advice(error, &template, &[], quiet)
        }
        _ => error,
    }
}

fn explained(file: &Path) -> Result<Report, AppError> {
    if file.is_dir() {
        if is_removal_table(&file.join(RIG)) {
            return removal_table::removal_table(file);
        }
        if is_arm_case(file) {
            return arm::case(file);
        }
        if is_postures_case(file) {
            return postures::postures(&file.join(POSTURES), file);
        }
        return rig::case(file);
    }
    if file
        .extension()
        .is_some_and(|extension| extension != "toml")
    {
        return Err(AppError::NoDescription {
            file: file.display().to_string(),
        });
    }
    let keys = scenario::keys_given(file, "")?;
    let has = |key: &str| keys.iter().any(|given| given == key);
    if has("study") {
        return study::study(file);
    }
    if has("file") {
        return study::map(file);
    }
    if !has("title") && !has("kind") {
        let of_rig = [
            "rig",
            "cylinder",
            "regulator",
            "gas",
            "sensors",
            "recordings",
        ];
        if of_rig.into_iter().any(has) {
            return rig::rig(file);
        }
        if has("device") {
            return study::model(file);
        }
    }
    if is_removal_table(file) {
        return removal_table::removal_table(file);
    }
    if is_postures_file(file) {
        return postures::postures(file, file);
    }
    if is_arm_file(file) {
        return arm::arm(file);
    }
    match scenario::load_any(file) {
        Ok(scenario) => of_scenario(scenario, &scenario::keys_given(file, cell::OVERRIDES)?),
        Err(ScenarioError::OtherKind { .. }) => cell::recorded(file),
        Err(error) => Err(error.into()),
    }
}
