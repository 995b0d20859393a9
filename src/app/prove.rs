//! `idc prove`, `idc sweep` and `idc laboratory`: the diagnosis on cases of which the truth is known, but not to it.

use std::path::Path;

use super::cli::{LaboratoryArguments, ProveArguments, SweepArguments};
use super::diagnose::answer_case;
use super::error::{AppError, ExitCode};
use super::output::say;
use crate::laboratory::{shipped, write_case};
use crate::proof::{Claims, Diagnose, SweepPlan, page, prove, sweep};
use crate::recording::atomic::write_text;

/// For the help.
pub(super) const PROVE_EXAMPLES: &str = "Examples:
  idc prove                                          the cases that come with the project
  idc prove --only case-02 case-06                   two of them
  idc prove --cases lab/cases --sealed lab/truth     others

Exit codes: 0 the score is as good as claimed, 1 it is not, 2 bad input.";
/// For the help.
pub(super) const SWEEP_EXAMPLES: &str = "Examples:
  idc sweep --out runs/sweep --page docs/CONFUSION.md             everything: hours
  idc sweep --out runs/sweep --page docs/CONFUSION.md --resume    go on where it was stopped
  idc sweep --out runs/few --effects transport_delay,hose_volume --seeds 1 --empty 5";

/// The program's own diagnosis of a case.
fn diagnose() -> Box<Diagnose<'static>> {
    Box::new(|case: &Path, out: &Path| answer_case(case, out).map_err(|error| error.to_string()))
}

fn jobs(asked: Option<u16>) -> usize {
    let processors = || std::thread::available_parallelism().map_or(1, usize::from);
    asked.map_or_else(processors, usize::from)
}

/// Proves and prints the score.
pub(super) fn run_prove(arguments: &ProveArguments) -> Result<ExitCode, AppError> {
    let beside = || {
        arguments
            .cases
            .parent()
            .unwrap_or(Path::new(""))
            .join("sealed")
    };
    let sealed = arguments.sealed.clone().unwrap_or_else(beside);
    let jobs = jobs(arguments.jobs);
    let out = &arguments.out;
    let summary = prove(
        &arguments.cases,
        &sealed,
        &arguments.only,
        out,
        jobs,
        &*diagnose(),
    )?;
    let short = summary.shortfalls(&Claims::PAGE);
    if arguments.json {
        say(&(serde_json::to_string_pretty(&summary)? + "\n"))?;
    } else {
        say(&summary.text())?;
        for sentence in &short {
            say(&format!("falls short: {sentence}\n"))?;
        }
    }
    Ok(if short.is_empty() {
        ExitCode::Done
    } else {
        ExitCode::OutsideBounds
    })
}

/// Sweeps and writes the tables.
pub(super) fn run_sweep(arguments: &SweepArguments) -> Result<ExitCode, AppError> {
    let plan = SweepPlan {
        effects: arguments.effects.clone(),
        seeds: arguments.seeds,
        draw: arguments.draw,
        sizes: usize::from(arguments.sizes),
        empty: arguments.empty,
        duration: arguments.duration_s,
        jobs: jobs(arguments.jobs),
        resume: arguments.resume,
    };
    let tell = |line: &str| {
        if !arguments.quiet {
            eprintln!("{line}");
        }
    };
    let outcomes = sweep(&plan, &arguments.out, &*diagnose(), &tell)?;
    let usual = || arguments.out.join("CONFUSION.md");
    let file = arguments.page.clone().unwrap_or_else(usual);
    write_text(&file, &page(&outcomes))?;
    if !arguments.quiet {
        say(&format!(
            "{} outcomes, tables in {}\n",
            outcomes.len(),
            file.display()
        ))?;
    }
    Ok(ExitCode::Done)
}

/// Writes the project's own cases.
pub(super) fn run_laboratory(arguments: &LaboratoryArguments) -> Result<ExitCode, AppError> {
    for recipe in shipped() {
        let folder = arguments.out.join("cases").join(&recipe.name);
        let case = recipe.make().map_err(crate::proof::ProofError::from)?;
        write_case(&case, &folder, Some(&arguments.out.join("sealed")))?;
    }
    Ok(ExitCode::Done)
}
