//! The command line.

use std::io::IsTerminal;
use std::path::{Path, PathBuf};

use clap::{Args, Parser, Subcommand};
use indicatif::{ProgressBar, ProgressStyle};

use super::error::{AppError, ExitCode};
use super::run::{Finished, run_cell, write_outputs};
use crate::cell::Cell;
use crate::metrics;
use crate::report::{Style, text};
use crate::scenario;

/// Simulate a robot deburring cell with a pneumatic constant-force end effector.
#[derive(Debug, Parser)]
#[command(name = "idc", version, about, after_help = "Exit codes: 0 done, 1 a result lies outside the scenario's [expect] bounds, \
2 bad input, 3 the physics stopped the run (the recording up to there is kept).")]
pub struct Cli {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// Run a scenario: simulate, record, print how uniform the contact force was.
    #[command(after_help = "Example: idc run scenarios/plate_edge.toml --out runs/first")]
    Run(RunArguments),
    /// List the sharp edges of a part and the outlines of its faces.
    #[command(after_help = "Example: idc edges assets/bracket.stl")]
    Edges(EdgesArguments),
}

#[derive(Debug, Args)]
struct RunArguments {
    /// Scenario file.
    scenario: PathBuf,
    /// Folder for recording.rrd, samples.parquet and summary.json [default: runs/<scenario name>].
    #[arg(long)]
    out: Option<PathBuf>,
    /// Print nothing but errors.
    #[arg(long)]
    quiet: bool,
    /// Print the summary as JSON instead of the table.
    #[arg(long)]
    json: bool,
}

#[derive(Debug, Args)]
pub(super) struct EdgesArguments {
    /// Mesh file: STL, OBJ or COLLADA.
    pub(super) mesh: PathBuf,
    /// Unit of the mesh file: mm, m or inch.
    #[arg(long, default_value = "mm")]
    pub(super) unit: MeshUnit,
    /// Dihedral angle above which an edge counts as sharp [deg].
    #[arg(long, default_value_t = 30.0)]
    pub(super) sharp_angle_deg: f64,
}

#[derive(Debug, Clone, Copy, clap::ValueEnum)]
pub(super) enum MeshUnit {
    Mm,
    M,
    Inch,
}

/// Runs the command; errors are bad input.
///
/// # Errors
/// One message that names file, key or waypoint and what was expected.
pub fn execute(cli: &Cli) -> Result<ExitCode, AppError> {
    match &cli.command {
        Command::Run(arguments) => run(arguments),
        Command::Edges(arguments) => super::edges::list(arguments),
    }
}

fn run(arguments: &RunArguments) -> Result<ExitCode, AppError> {
    let scenario = scenario::load(&arguments.scenario)?;
    let file = arguments.scenario.display().to_string();
    let metrics_error = |source| AppError::Metrics { file: file.clone(), source };
    metrics::validate(&scenario.expect).map_err(metrics_error)?;
    let cell = Cell::new(scenario)?;
    let quiet = arguments.quiet || arguments.json;
    if !quiet {
        for note in &cell.notes {
            eprintln!("note: {note}");
        }
    }
    let bar = progress(quiet);
    let finished = run_cell(&cell, &mut |done, total| {
        bar.set_length(total as u64);
        bar.set_position(done as u64);
    })?;
    bar.finish_and_clear();
    let verdicts = metrics::check(&finished.summary, &cell.scenario.expect).map_err(metrics_error)?;
    let folder = arguments.out.clone().unwrap_or_else(|| default_folder(&arguments.scenario));
    write_outputs(&folder, &cell, &finished, &verdicts)?;
    print(arguments, &cell, &finished, &verdicts, &folder)?;
    if let Some(stop) = &finished.stop {
        eprintln!("stopped: {stop}");
        return Ok(ExitCode::Stopped);
    }
    let outside = verdicts.iter().filter(|verdict| !verdict.kept).count();
    if outside > 0 {
        if arguments.quiet {
            for verdict in verdicts.iter().filter(|verdict| !verdict.kept) {
                eprintln!("outside its bounds: {} = {:?}", verdict.metric, verdict.value);
            }
        }
        return Ok(ExitCode::OutsideBounds);
    }
    Ok(ExitCode::Done)
}

fn print(
    arguments: &RunArguments,
    cell: &Cell,
    finished: &Finished,
    verdicts: &[metrics::Verdict],
    folder: &Path,
) -> Result<(), AppError> {
    if arguments.json {
        println!("{}", serde_json::to_string_pretty(&finished.summary)?);
    } else if !arguments.quiet {
        let style = if std::io::stdout().is_terminal() && std::env::var_os("NO_COLOR").is_none() {
            Style::Coloured
        } else {
            Style::Plain
        };
        print!("{}", text(&cell.scenario.title, &finished.summary, verdicts, style));
        println!("written to {}: recording.rrd, samples.parquet, summary.json", folder.display());
    }
    Ok(())
}

fn default_folder(scenario: &Path) -> PathBuf {
    Path::new("runs").join(scenario.file_stem().unwrap_or_default())
}

fn progress(quiet: bool) -> ProgressBar {
    if quiet {
        return ProgressBar::hidden();
    }
    let bar = ProgressBar::new(0);
    let style = ProgressStyle::with_template("simulating {wide_bar} {percent:>3} %, {eta} left");
    bar.set_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()));
    bar
}
