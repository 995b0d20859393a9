//! `idc diagnose`: from a folder with a rig file and recordings to what the model lacks, for one case or many.

mod all;
mod board;
mod cell_scene;
mod comparison_files;
mod fit_picture;
mod one;
mod outputs;
mod stages;
mod unlisted_picture;

pub(super) use all::natural;
pub(super) use comparison_files::{BALANCE, COMPARISON, read_comparison};
pub(super) use outputs::{BOARD, DIAGNOSIS, HOW_TO_RUN};

use super::cli::{DiagnoseArguments, output_folder};
use super::error::{AppError, ExitCode};
use super::files::Standing;
use super::interrupt::Interruptible;
use super::output::say;
use super::progress::StagedLine;
use crate::diagnosis::progress::Progress;
use crate::replay::LoadedCell;
use stages::Stages;

/// Diagnoses and writes.
pub(super) fn run(arguments: &DiagnoseArguments) -> Result<ExitCode, AppError> {
    let out = output_folder(arguments.out.as_ref(), &arguments.case);
    let standing = match (arguments.resume, arguments.force) {
        (true, _) => Standing::Keep,
        (_, true) => Standing::Replace,
        _ => Standing::Refuse,
    };
    let cell = arguments
        .scenario
        .as_deref()
        .map(LoadedCell::load)
        .transpose()?;
    let cell = cell.as_ref();
    if arguments.all {
        return all::run(arguments, cell, &out, standing);
    }
    if standing == Standing::Keep
        && let Some(answer) = one::complete(&out)
    {
        if arguments.json {
            say(&answer.text()?)?;
        } else if !arguments.quiet {
            say(&format!("{} holds a diagnosis already\n", out.display()))?;
        }
        return Ok(ExitCode::Done);
    }
    let silent = arguments.quiet || arguments.json || arguments.verbose;
    let _interruptible = Interruptible::of_one("diagnosis", &out);
    let line = StagedLine::new(&stages::first(), silent);
    let prepared = one::Prepared::new(&arguments.case, cell, &out, standing)?;
    let mut stages = Stages::default();
    line.tell(Stages::begun(), None);
    let finished = prepared.run(&mut |progress: &Progress<'_>| {
        let (words, behind) = stages.shown(progress);
        line.tell(words, behind);
        if arguments.verbose {
            eprintln!("{progress}");
        }
    });
    line.end();
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
    let prepared = one::Prepared::new(case, None, out, Standing::Replace)?;
    Ok(prepared.run(&mut |_| ())?.answer)
}
