//! The command line.

use std::path::PathBuf;

use clap::{Args, CommandFactory as _, Parser, Subcommand};

use super::design::PreparedStudy;
use super::error::{AppError, ExitCode};
use super::files::{OverwritePolicy, output_folder};
use super::interrupt::Interruptible;
use super::output::show;
use super::{help, progress};

/// Simulate a robot deburring cell with a pneumatic constant-force end effector, and find out what physics recordings of a real one contain
/// that its model leaves out.
#[derive(Debug, Parser)]
#[command(
    name = "idc",
    version,
    long_version = crate::recording::provenance::BUILD,
    max_term_width = 100,
    after_help = help::PROGRAM
)]
pub struct Cli {
    #[command(subcommand)]
    command: Command,
    /// When to print in colours.
    #[command(flatten)]
    pub colour: colorchoice_clap::Color,
    /// Largest file that is read, and what one may come to unpacked, in place of the usual limits [MB].
    #[arg(long, global = true, value_name = "MB", value_parser = clap::value_parser!(u64).range(1..=1_000_000))]
    largest_mb: Option<u64>,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// Run a scenario: simulate, record, print how uniform the contact force was.
    #[command(after_help = help::RUN)]
    Run(super::run::RunArguments),
    /// Run a scenario with many other values of its keys: how its numbers are distributed, and which key drives which.
    #[command(after_help = super::vary::EXAMPLES)]
    Vary(super::vary::VaryArguments),
    /// Diagnose all recordings of many devices by their days: which effects appear where, since when, and what drifts.
    #[command(after_help = super::fleet::EXAMPLES)]
    Fleet(super::fleet::FleetArguments),
    /// Do one task of a plan that `idc vary` or `idc fleet` wrote, as an engine asks for it.
    #[command(after_help = super::task::EXAMPLES)]
    Task(super::task::TaskArguments),
    /// Explain a file without running it: what it describes, what would be done, what is missing.
    #[command(after_help = super::check::EXAMPLES)]
    Check(super::check::CheckArguments),
    /// List the physics that a model may lack, explain an effect, draw what it looks like.
    #[command(after_help = super::effects::EXAMPLES)]
    Effects(super::effects::EffectsArguments),
    /// Write a commented file to start from: a cell, a rig file or an import map.
    #[command(after_help = super::new::EXAMPLES)]
    New(super::new::NewArguments),
    /// Do a design study: find the device that keeps the contact force most uniform under limits.
    #[command(after_help = help::DESIGN)]
    Design(DesignArguments),
    /// Look at recordings, in Rerun's native viewer where it is installed, otherwise as a web page.
    #[command(after_help = super::view::EXAMPLES)]
    View(super::view::ViewArguments),
    /// List the sharp edges of a part and the outlines of its faces.
    #[command(after_help = help::EDGES)]
    Edges(super::edges::EdgesArguments),
    /// Say where the part of a cell can lie: over a grid of positions, where the whole job can be done.
    #[command(after_help = super::place::EXAMPLES)]
    Place(super::place::PlaceArguments),
    /// Write a program for a robot of a cell's planned path, or a bench as a unit for co-simulation (FMU).
    #[command(after_help = super::export::EXAMPLES)]
    Export(super::export::ExportArguments),
    /// Make a recording of the logs of a real device, as a map says what their columns are.
    #[command(after_help = help::IMPORT)]
    Import(super::import::ImportArguments),
    /// Say what a rig file, nominal or improved, predicts for the inputs of a recording.
    #[command(after_help = help::PREDICT)]
    Predict(super::predict::PredictArguments),
    /// Find what physics the recordings of a rig contain that its model leaves out.
    #[command(after_help = help::DIAGNOSE)]
    Diagnose(super::diagnose::DiagnoseArguments),
    /// Say what to record next: the experiment that is expected to tell most of what a diagnosis leaves open.
    #[command(after_help = super::next::EXAMPLES)]
    Next(super::next::NextArguments),
    /// Diagnose a rig by experiments of its own choice: its program carries them out, until one explanation is settled.
    #[command(after_help = super::next::INVESTIGATE_EXAMPLES)]
    Investigate(super::next::InvestigateArguments),
    /// Write report.html of a folder with results: one page for a browser.
    #[command(after_help = super::report::EXAMPLES)]
    Report(super::report::ReportArguments),
    /// Compare runs, or diagnoses: numbers side by side, signals of runs over one another.
    #[command(after_help = super::compare::EXAMPLES)]
    Compare(super::compare::CompareArguments),
    /// Prove the diagnosis: diagnose cases whose truth is sealed, then open it and print the score.
    #[command(after_help = help::PROVE)]
    Prove(super::prove::ProveArguments),
    /// Write the cases that come with the project, with their sealed truth, as the laboratory makes them.
    #[command(after_help = help::LABORATORY)]
    Laboratory(super::prove::LaboratoryArguments),
    /// Print the JSON Schema of a file, for editors.
    #[command(after_help = super::schema::EXAMPLES)]
    Schema(super::schema::SchemaArguments),
    /// Print what a shell needs to complete commands and options.
    #[command(after_help = super::manual::COMPLETION_EXAMPLES)]
    Completions(super::manual::CompletionArguments),
    /// Print the manual page, or write one of each command.
    #[command(after_help = super::manual::MAN_EXAMPLES)]
    Man(super::manual::ManArguments),
}

#[derive(Debug, Args)]
struct DesignArguments {
    /// Study file.
    study: PathBuf,
    /// Folder for design.json, override.toml, front.svg and robustness.svg [default: runs/<study name>].
    #[arg(long, help_heading = "Output")]
    out: Option<PathBuf>,
    /// Put new results in place of old ones.
    #[arg(long, help_heading = "Output")]
    force: bool,
    /// Print nothing but errors.
    #[arg(long, help_heading = "Output")]
    quiet: bool,
    /// Most designs that are tried, in place of what the study says.
    #[arg(long, value_parser = clap::value_parser!(u32).range(10..=1_000_000))]
    evaluations: Option<u32>,
    /// Print what design.json holds instead of the table.
    #[arg(long, conflicts_with = "quiet", help_heading = "Output")]
    json: bool,
}

/// Runs the command; errors are bad input.
///
/// # Errors
/// One message that names file, key or waypoint and what was expected.
pub fn execute(cli: &Cli) -> Result<ExitCode, AppError> {
    if let Some(megabytes) = cli.largest_mb {
        crate::file::raise(megabytes);
    }
    match &cli.command {
        Command::Run(arguments) => super::run::run(arguments),
        Command::Vary(arguments) => super::vary::run(arguments),
        Command::Fleet(arguments) => super::fleet::run(arguments),
        Command::Task(arguments) => super::task::run(arguments),
        Command::Check(arguments) => super::check::run(arguments),
        Command::Effects(arguments) => super::effects::run(arguments),
        Command::New(arguments) => super::new::run(arguments),
        Command::Design(arguments) => design(arguments),
        Command::View(arguments) => super::view::run(arguments),
        Command::Edges(arguments) => super::edges::list(arguments),
        Command::Place(arguments) => super::place::run(arguments),
        Command::Export(arguments) => super::export::run(arguments),
        Command::Import(arguments) => super::import::run(arguments),
        Command::Predict(arguments) => super::predict::predict(arguments),
        Command::Diagnose(arguments) => super::diagnose::run(arguments),
        Command::Next(arguments) => super::next::run(arguments),
        Command::Investigate(arguments) => super::next::investigate(arguments),
        Command::Report(arguments) => super::report::run(arguments),
        Command::Compare(arguments) => super::compare::run(arguments),
        Command::Prove(arguments) => super::prove::run(arguments),
        Command::Laboratory(arguments) => super::prove::run_laboratory(arguments),
        Command::Schema(arguments) => super::schema::run(arguments),
        Command::Completions(arguments) => super::manual::completions(arguments, Cli::command()),
        Command::Man(arguments) => super::manual::man(arguments, Cli::command()),
    }
}

fn design(arguments: &DesignArguments) -> Result<ExitCode, AppError> {
    let out = output_folder(arguments.out.as_ref(), &arguments.study);
    let study = PreparedStudy::new(
        &arguments.study,
        arguments.evaluations,
        &out,
        OverwritePolicy::of(arguments.force),
    )?;
    let bar = progress::bar("searching", arguments.quiet || arguments.json);
    let interruptible = Interruptible::of_one("study", &out);
    let finished = study.run(&|done, most| progress::tell(&bar, done, most));
    bar.finish_and_clear();
    let finished = finished?;
    drop(interruptible);
    show(
        [arguments.quiet, arguments.json],
        &finished.document,
        &finished.table,
        study.folder(),
        &finished.names,
    )?;
    Ok(ExitCode::Done)
}
