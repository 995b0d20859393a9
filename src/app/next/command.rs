//! `idc next` from its arguments to its files.

use std::path::{Path, PathBuf};

use clap::Args;

use super::super::error::{AppError, ExitCode};
use super::super::files::{OutputFolder, OverwritePolicy, output_folder};
use super::super::interrupt::Interruptible;
use super::super::output::say;
use super::super::progress;
use super::super::terminal::say_aside;
use super::error::NextError;
use super::files::NAMES;
use super::outputs::write;
use super::page;
use super::proposal::{Allowed, Proposal, case_in, diagnosed, stated_limits};
use crate::case::{Case, EXPLANATIONS, Explanations};
use crate::document::{Style, text};
use crate::replay::LoadedCell;

/// For the help.
pub(in super::super) const EXAMPLES: &str = "\
The recordings of a rig are diagnosed; then set pressure, valve and surface are
sought, of a cell set pressure and the arm's ride along the path of its
recordings, that are expected to tell most, per second, of which explanation is
right and, once that is settled, of how large its numbers are. Nothing is moved
farther than [limits] of the file allows and, where it states nothing, than the
recordings moved it; the force on the part is kept by 20 draws of the numbers of
every open explanation. Given the results of a diagnosis in place of a case, it
goes on from them. Exit codes: 0 written, 2 bad input.

Examples:
  # Inputs, a bench's scenario, instructions and a picture. (takes minutes)
  idc next assets/proof/cases/case-03 --out runs/next
  # Ten seconds at most, the valve left alone. (takes minutes)
  idc next assets/proof/cases/case-03 --out runs/ten --time 10s \\
      --may set_pressure,surface";

#[derive(Debug, Args)]
pub(in super::super) struct NextArguments {
    /// Folder with rig.toml and the recordings that it names, with the recordings of a cell (--scenario), or with the results of their diagnosis, which is gone on from.
    case: PathBuf,
    /// Scenario file of a cell that the recordings are of.
    #[arg(long)]
    scenario: Option<PathBuf>,
    #[command(flatten)]
    allowed: Allowed,
    /// Folder for inputs.csv, bench.toml (of a cell cell.toml), instructions.txt, expected.svg, report.html and next.json [default: runs/<name of the case's folder>].
    #[arg(long, help_heading = "Output")]
    out: Option<PathBuf>,
    /// Put new results in place of old ones.
    #[arg(long, help_heading = "Output")]
    force: bool,
    /// Print nothing but errors.
    #[arg(long, help_heading = "Output")]
    quiet: bool,
    /// Print what next.json holds instead of the text.
    #[arg(long, conflicts_with = "quiet", help_heading = "Output")]
    json: bool,
}

/// A case by its folder, or by that of its diagnosis: then with what it found.
fn case_of(folder: &Path, scenario: Option<&Path>) -> Result<Case, AppError> {
    let file = folder.join(EXPLANATIONS);
    if !file.is_file() {
        let cell = scenario.map(LoadedCell::load).transpose()?;
        return case_in(folder, cell.as_ref());
    }
    let known = Explanations::read(&file)?;
    let cell = (scenario.or(known.scenario.as_deref())).map(LoadedCell::load);
    let mut case = match cell.transpose()? {
        Some(cell) => Case::of_cell(&known.case, &cell, &known.recordings)?,
        None => Case::with_recordings(&known.case, &known.recordings)?,
    };
    match known.outdated(&case.provenance()?) {
        None => case.go_on_from(&known),
        Some(why) => say_aside(&format!(
            "note: {}: {why}; diagnosed from the beginning",
            file.display()
        )),
    }
    Ok(case)
}

/// Chooses an experiment and writes it.
pub(in super::super) fn run(arguments: &NextArguments) -> Result<ExitCode, AppError> {
    let silent = arguments.quiet || arguments.json;
    let case = case_of(&arguments.case, arguments.scenario.as_deref())?;
    stated_limits(&case)?;
    let out = output_folder(arguments.out.as_ref(), &arguments.case);
    let folder = OutputFolder::prepare(&out, &NAMES, OverwritePolicy::of(arguments.force))?;
    let _interruptible = Interruptible::of_one("choice", &out);
    let found = diagnosed(&case, (silent, arguments.allowed.verbose))?;
    let Some(diagnosis) = &found.diagnosis else {
        return Err(NextError::NoBench { case: case.name }.into());
    };
    let bar = progress::bar("choosing", silent);
    let allowed = &arguments.allowed;
    let proposal = Proposal::of(
        &case,
        diagnosis,
        (allowed, allowed.seed, None),
        &mut |done, all| progress::tell(&bar, done, all),
    );
    bar.finish_and_clear();
    let proposal = proposal?;
    let document = write(&folder, &proposal, &found.improved, &case.name)?;
    if arguments.json {
        say(&document)?;
    } else if !arguments.quiet {
        say(&text(
            &page::of_proposal(&proposal, &case.name),
            Style::Plain,
        ))?;
    }
    Ok(ExitCode::Done)
}
