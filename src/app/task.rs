//! `idc task`: tasks of a plan, as an engine asks for them; or the whole plan as another engine takes it.

use std::path::PathBuf;

use clap::{Args, ValueEnum};

use super::engine::{full, tell_unfit};
use super::error::{AppError, ExitCode};
use super::output::say;
use super::this_program::this_program;
use super::{fleet, vary};
use crate::recording::atomic::write_text;
use crate::tasks::{Plan, Store, Task, TaskError, snakefile};

/// For the help.
pub(super) const EXAMPLES: &str = "\
A task's result goes to its own folder in `tasks` beside the plan, named when it
is whole; a task that stands is not done again. An engine takes what
stands for the answer, and exit codes 1, 2 and 3 of it for results.

Exit codes: that of the run, of several the highest; 2 as well where a task
cannot be done.

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
    /// Name of the task; of several each is done, one after the other.
    #[arg(value_name = "ID", required_unless_present = "export")]
    ids: Vec<String>,
    /// Write the plan as another engine takes it.
    #[arg(long, value_enum, conflicts_with = "ids")]
    export: Option<Export>,
    /// File for it [default: standard output].
    #[arg(long, requires = "export", conflicts_with = "ids")]
    out: Option<PathBuf>,
}

/// An engine that takes a plan as a file.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Export {
    /// A Snakefile.
    Snakemake,
}

/// Who does the tasks of a plan.
enum Worker {
    Vary(vary::Worker),
    Fleet(fleet::Worker),
}

impl Worker {
    fn new(plan: &Plan) -> Result<Self, AppError> {
        match plan.head.plan.as_str() {
            vary::KIND => Ok(Self::Vary(vary::Worker::new(plan)?)),
            fleet::KIND => Ok(Self::Fleet(fleet::Worker::new(plan)?)),
            other => Err(TaskError::NoPlan {
                file: plan.path().display().to_string(),
                line: 1,
                reason: format!("tasks of the kind `{other}` are not known"),
            }
            .into()),
        }
    }

    fn perform(&self, task: &Task, store: &Store) -> Result<(), TaskError> {
        match self {
            Self::Vary(worker) => worker.perform(task, store),
            Self::Fleet(worker) => worker.perform(task, store),
        }
    }
}

/// Does the tasks, or writes the file.
pub(super) fn run(arguments: &TaskArguments) -> Result<ExitCode, AppError> {
    let plan = Plan::open(&arguments.plan)?;
    if arguments.ids.is_empty() {
        let program = this_program().unwrap_or_else(|_| PathBuf::from("idc"));
        let text = snakefile(&program, &full(&arguments.plan)?);
        match &arguments.out {
            Some(file) => write_text(file, &text)?,
            None => say(&text)?,
        }
        return Ok(ExitCode::Done);
    }
    let store = Store::of(&arguments.plan);
    store.make()?;
    let names = || arguments.ids.iter().map(String::as_str);
    let named: Vec<&str> = names().collect();
    if Plan::open(&arguments.plan)?.tasks(&named).is_ok() {
        for id in named {
            let unfit = store.take_unfit(id)?;
            tell_unfit(unfit.as_slice(), store.path());
        }
    }
    let missing: Vec<&str> = names().filter(|id| !store.exists(id)).collect();
    if !missing.is_empty() {
        let tasks = Plan::open(&arguments.plan)?.tasks(&missing)?;
        plan.check(tasks.iter().flat_map(|task| &task.files))?;
        let worker = Worker::new(&plan)?;
        for task in &tasks {
            worker.perform(task, &store)?;
        }
    }
    let report = match plan.head.plan.as_str() {
        fleet::KIND => fleet::report_result,
        _ => vary::report_result,
    };
    let mut highest = ExitCode::Done;
    for id in names() {
        highest = highest.max(report(&store, id)?);
    }
    Ok(highest)
}
