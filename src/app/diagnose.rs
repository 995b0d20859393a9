//! `idc diagnose`: from a folder with a rig file and recordings to what the model lacks, for one case or many.

mod all;
mod arm_prediction;
mod board;
mod cell;
mod cell_account;
mod cell_scene;
mod comparison_files;
mod fit_picture;
mod one;
mod outputs;
mod progress;
mod unlisted_picture;

use std::path::Path;

pub(super) use comparison_files::read_comparison;
pub(super) use outputs::DIAGNOSIS;

use super::cli::{DiagnoseArguments, output_folder};
use super::error::{AppError, ExitCode};
use super::output::say;
use crate::replay::LoadedCell;
use crate::scenario::load_recorded_cell;

/// For the help.
pub(super) const EXAMPLES: &str = "Examples:
  idc diagnose rigs/cell_3 --out runs/cell_3              one case: rig.toml names its recordings
  idc diagnose rigs/cell_3 --out runs/cell_3 --force      the same again, in place of what is there
  idc diagnose rigs/cell_3 --json | jq .effects           what was found, for a program
  idc diagnose rigs --all --out runs/rigs                 every case below rigs/
  idc diagnose rigs --all --out runs/rigs --quiet         the same, saying nothing but what failed
  idc diagnose rigs --all --out runs/rigs --resume        go on where it was stopped
  idc diagnose recordings --all --scenario cell.toml --out runs/cell
                                                          every case of a robot cell below recordings/
  idc diagnose rigs --all --out runs/rigs --jobs 4        four cases at a time, each on its share of the processors

diagnosis.json is written last: where it stands, the others are complete. \
Exit codes: 0 done, 2 bad input (with --all: of any case; the others are done all the same).";

fn load_cell(path: &Path) -> Result<LoadedCell, AppError> {
    Ok(LoadedCell::new(load_recorded_cell(path)?)?)
}

/// Diagnoses and writes.
pub(super) fn run(arguments: &DiagnoseArguments) -> Result<ExitCode, AppError> {
    let out = output_folder(arguments.out.as_ref(), &arguments.case);
    let standing = match (arguments.resume, arguments.force) {
        (true, _) => one::Standing::Keep,
        (_, true) => one::Standing::Replace,
        _ => one::Standing::Refuse,
    };
    let cell = arguments.scenario.as_deref().map(load_cell).transpose()?;
    let cell = cell.as_ref();
    if arguments.all {
        return all::run(arguments, cell, &out, standing);
    }
    if standing == one::Standing::Keep
        && let Some(answer) = one::complete(&out)
    {
        if arguments.json {
            say(&answer.text()?)?;
        } else if !arguments.quiet {
            say(&format!("{} holds a diagnosis already\n", out.display()))?;
        }
        return Ok(ExitCode::Done);
    }
    let prepared = one::Prepared::new(&arguments.case, cell, &out, standing)?;
    let spinner = progress::spinner(arguments.quiet || arguments.json || arguments.verbose);
    let finished = prepared.run(&mut |text| {
        spinner.set_message(text.trim().to_owned());
        if arguments.verbose {
            eprintln!("{text}");
        }
    });
    spinner.finish_and_clear();
    let finished = finished?;
    if arguments.json {
        say(&finished.document)?;
    } else if !arguments.quiet {
        say(&finished.account)?;
        say(&format!(
            "\nwritten to {}: {}\n",
            out.display(),
            finished.names.join(", ")
        ))?;
    }
    Ok(ExitCode::Done)
}

/// Diagnoses a case into a folder, in place of what stands there.
pub(super) fn answer_case(
    case: &std::path::Path,
    out: &std::path::Path,
) -> Result<crate::diagnosis::answer::Answer, AppError> {
    let prepared = one::Prepared::new(case, None, out, one::Standing::Replace)?;
    Ok(prepared.run(&mut |_| ())?.answer)
}
