//! `idc task`: one task of a plan, as an engine asks for it; or the whole plan as another engine takes it.

use std::path::PathBuf;

use clap::{Args, ValueEnum};

use super::engine::{full, tell_unfit};
use super::error::{AppError, ExitCode};
use super::output::say;
use super::{fleet, vary};
use crate::recording::atomic::write_text;
use crate::tasks::{Plan, Store, TaskError, snakefile};

/// For the help.
pub(super) const EXAMPLES: &str = "\
A task's result goes to its own folder in `tasks` beside the plan, named when it
is whole; a task that stands is not done again. An engine takes what
stands for the answer, and exit codes 1, 2 and 3 of it for results.

Exit codes: that of the run; 2 as well where the task cannot be done.

Examples:
  # A sweep is planned, and left to Snakemake.
  idc vary scenarios/paper_step.toml --set bench.duration_s=8,9 --plan \\
      --out runs/planned
  idc task runs/planned/plan.jsonl --export snakemake > runs/planned/Snakefile
  # Its first task, by its name.
  idc task runs/planned/plan.jsonl \\
      $(sed -n '2s/.*\"id\":\"\\([0-9a-f]*\\)\".*/\\1/p' runs/planned/plan.jsonl)
  # The other tasks, and the tables.
  idc vary scenarios/paper_step.toml --set bench.duration_s=8,9 --resume \\
      --out runs/planned";

#[derive(Debug, Args)]
pub(super) struct TaskArguments {
    /// Plan that `idc vary` or `idc fleet` wrote.
    plan: PathBuf,
    /// Name of the task.
    #[arg(required_unless_present = "export")]
    id: Option<String>,
    /// Write the plan as another engine takes it.
    #[arg(long, value_enum, conflicts_with = "id")]
    export: Option<Export>,
    /// File for it [default: standard output].
    #[arg(long, requires = "export", conflicts_with = "id")]
    out: Option<PathBuf>,
}

/// An engine that takes a plan as a file.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Export {
    /// A Snakefile.
    Snakemake,
}

/// Does the task, or writes the file.
pub(super) fn run(arguments: &TaskArguments) -> Result<ExitCode, AppError> {
    let plan = Plan::open(&arguments.plan)?;
    let Some(id) = &arguments.id else {
        let program = std::env::current_exe().unwrap_or_else(|_| PathBuf::from("idc"));
        let text = snakefile(&program, &full(&arguments.plan)?);
        match &arguments.out {
            Some(file) => write_text(file, &text)?,
            None => say(&text)?,
        }
        return Ok(ExitCode::Done);
    };
    let store = Store::of(&arguments.plan);
    store.make()?;
    let kind = plan.head.plan.clone();
    if Plan::open(&arguments.plan)?.task(id).is_ok() {
        let unfit = store.take_unfit(id)?;
        tell_unfit(unfit.as_slice(), store.path());
    }
    if store.exists(id) {
        return match kind.as_str() {
            fleet::KIND => fleet::report_result(&store, id),
            _ => vary::report_result(&store, id),
        };
    }
    let file = arguments.plan.display().to_string();
    let task = Plan::open(&arguments.plan)?.task(id)?;
    plan.check(&task.files)?;
    match kind.as_str() {
        vary::KIND => {
            vary::Worker::new(&plan)?.perform(&task, &store)?;
            vary::report_result(&store, id)
        }
        fleet::KIND => {
            fleet::Worker::new(&plan)?.perform(&task, &store)?;
            fleet::report_result(&store, id)
        }
        other => Err(TaskError::NoPlan {
            file,
            line: 1,
            reason: format!("tasks of the kind `{other}` are not known"),
        }
        .into()),
    }
}
