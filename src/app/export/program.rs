//! `idc export program`: the planned path of a cell as a program for its robot, and as a trajectory.

use std::path::{Path, PathBuf};

use clap::builder::PossibleValue;
use clap::{Args, ValueEnum};

use super::super::error::{AppError, ExitCode};
use super::super::files::{OutputFolder, OverwritePolicy, output_folder};
use super::super::output::say;
use super::super::terminal::shown_path;
use crate::cell::Cell;
use crate::recording::atomic::write_all;
use crate::robot_program::{
    Deviation, Dialect, Moves, ProgramError, bag, csv, deviation, planned, read, sampled, write,
};

/// For the help.
pub(super) const EXAMPLES: &str = "\
The program goes to the start of the job, sets the force by an analog output,
and does approach, engage, follow and retract of each pass, the tool's poses in
the part's frame. Before anything is written it is read back and compared with
the plan. trajectory.csv and trajectory.mcap hold the joints over time for
every arm. The table [program] of the scenario names the output and its scale;
docs/PROGRAMS.md says what each dialect can say. Exit codes: 0 written, 2 bad
input, or what the dialect cannot say.

Examples:
  # for Universal Robots; poses on lines
  idc export program scenarios/plate_edge.toml --dialect urscript \\
      --out runs/program
  # joint angles, each with its time
  idc export program scenarios/plate_edge.toml --dialect krl --moves joint \\
      --out runs/program_krl
  # the joints over time alone, for any arm
  idc export program scenarios/plate_edge.toml --out runs/trajectory";

/// The joints over time.
const TRAJECTORY: &str = "trajectory.csv";
/// The same as a message of ROS 2.
const BAG: &str = "trajectory.mcap";

#[derive(Debug, Args)]
pub(super) struct ProgramArguments {
    /// Scenario of a cell.
    scenario: PathBuf,
    /// Language of the program; without it the joints over time alone are written.
    #[arg(long)]
    dialect: Option<Dialect>,
    /// Whether moves are given by poses of the tool or by joint angles.
    #[arg(long, default_value = "cartesian")]
    moves: Moves,
    /// Folder for the program, trajectory.csv and trajectory.mcap [default: runs/<scenario name>].
    #[arg(long, help_heading = "Output")]
    out: Option<PathBuf>,
    /// Put new files in place of old ones.
    #[arg(long, help_heading = "Output")]
    force: bool,
    /// Print nothing but errors.
    #[arg(long, help_heading = "Output")]
    quiet: bool,
    /// Print what was written as JSON.
    #[arg(long, conflicts_with = "quiet", help_heading = "Output")]
    json: bool,
}

impl ValueEnum for Dialect {
    fn value_variants<'a>() -> &'a [Self] {
        &Self::ALL
    }

    fn to_possible_value(&self) -> Option<PossibleValue> {
        Some(PossibleValue::new(self.name()))
    }
}

impl ValueEnum for Moves {
    fn value_variants<'a>() -> &'a [Self] {
        &Self::ALL
    }

    fn to_possible_value(&self) -> Option<PossibleValue> {
        Some(PossibleValue::new(self.name()))
    }
}

/// A program that says what was planned.
struct Checked {
    file: String,
    text: String,
    moves: usize,
    deviation: Deviation,
}

fn checked(
    cell: &Cell,
    name: &str,
    dialect: Dialect,
    moves: Moves,
) -> Result<Checked, ProgramError> {
    let program = planned(cell, name, dialect, moves)?;
    let text = write(dialect, &program);
    let back = read(dialect, &text).map_err(|error| error.to_string());
    let deviation = back.and_then(|back| deviation(&program, &back));
    let deviation = deviation.map_err(|what| ProgramError::NotTheSame {
        dialect: dialect.name(),
        what,
    })?;
    Ok(Checked {
        file: format!("{}.{}", program.name, dialect.ending()),
        text,
        moves: program.moves().count(),
        deviation,
    })
}

/// Writes what was asked for.
pub(super) fn run(arguments: &ProgramArguments) -> Result<ExitCode, AppError> {
    let out = output_folder(arguments.out.as_ref(), &arguments.scenario);
    let policy = OverwritePolicy::of(arguments.force);
    OutputFolder::check(&out, &[TRAJECTORY, BAG], policy)?;
    let cell = Cell::load(&arguments.scenario)?;
    let name = arguments
        .scenario
        .file_stem()
        .unwrap_or_default()
        .to_string_lossy();
    let one = |dialect| checked(&cell, &name, dialect, arguments.moves);
    let written = arguments.dialect.map(one).transpose()?;
    let sampled = sampled(&cell);
    let (table, bytes) = (csv(&sampled), bag(&sampled)?);
    let file = written.as_ref().map(|written| written.file.as_str());
    let all: Vec<&str> = file.into_iter().chain([TRAJECTORY, BAG]).collect();
    let folder = OutputFolder::prepare(&out, &all, policy)?;
    let place = |name: &str| folder.path().join(name);
    let mut files: Vec<(PathBuf, &[u8])> =
        vec![(place(TRAJECTORY), table.as_bytes()), (place(BAG), &bytes)];
    files.extend(
        written
            .as_ref()
            .map(|one| (place(&one.file), one.text.as_bytes())),
    );
    write_all(&files)?;
    report(arguments, folder.path(), &all, written.as_ref())?;
    Ok(ExitCode::Done)
}

/// What was written, and how exactly.
fn report(
    arguments: &ProgramArguments,
    folder: &Path,
    all: &[&str],
    written: Option<&Checked>,
) -> Result<(), AppError> {
    if arguments.json {
        let digits = |value: f64| (1e4 * value).round() / 1e4;
        let read_back = written.map(|one| {
            serde_json::json!({
                "moves": one.moves,
                "position_um": digits(1e6 * one.deviation.position),
                "angle_deg": (1e7 * one.deviation.angle.to_degrees()).round() / 1e7,
                "joint_deg": (1e7 * one.deviation.joint.to_degrees()).round() / 1e7,
                "speed_percent": digits(100.0 * one.deviation.timing),
            })
        });
        let document = serde_json::json!({
            "folder": folder.display().to_string(),
            "files": all,
            "dialect": arguments.dialect.map(Dialect::name),
            "read_back": read_back,
        });
        return say(&format!("{document:#}\n"));
    }
    if arguments.quiet {
        return Ok(());
    }
    if let Some(one) = written {
        let Deviation {
            position,
            angle,
            joint,
            timing,
        } = one.deviation;
        say(&format!(
            "{} moves; read back, the program is within {:.3} um, {:.6} deg, {:.6} deg of the joints and {:.3} % of the speeds planned\n",
            one.moves,
            1e6 * position,
            angle.to_degrees(),
            joint.to_degrees(),
            100.0 * timing
        ))?;
    }
    say(&format!(
        "written to {}: {}\n",
        shown_path(folder),
        all.join(", ")
    ))
}
