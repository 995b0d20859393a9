//! `--engine`: who does the tasks of a plan, and how far they are.

use std::path::{Path, PathBuf};

use clap::Args;

use super::error::AppError;
use super::interrupt::Interruptible;
use super::progress;
use super::terminal::say_aside;
use super::this_program::this_program;
use crate::quantity::counted;
use crate::recording::provenance::BUILD;
use crate::tasks::{
    Dask, Engine, Made, Plan, Store, Task, TaskError, TaskMessage, Unfit, dask, local,
};

/// The plan of a sweep or a fleet, in its folder.
pub(super) const PLAN: &str = "plan.jsonl";

#[derive(Debug, Clone, Args)]
#[command(next_help_heading = "Engine")]
pub(super) struct EngineArguments {
    /// Who does the tasks: `local`, threads of this program; `dask=local:N`, as many workers of Dask on this machine; `dask=ADDRESS`, those of a scheduler, as in dask=tls://10.0.0.1:8786.
    #[arg(long, default_value = "local", value_parser = engine)]
    engine: Engine,
    /// Tasks at a time of `local` [default: as many as there are processors].
    #[arg(long, value_parser = clap::value_parser!(u16).range(1..))]
    jobs: Option<u16>,
    /// Python with Dask.
    #[arg(long, default_value = "python3")]
    python: PathBuf,
    /// This program as workers find it [default: where it is here].
    #[arg(long)]
    program: Option<PathBuf>,
    /// Send files and results through Dask, where workers share no folder.
    #[arg(long)]
    carry: bool,
}

fn engine(text: &str) -> Result<Engine, String> {
    text.parse().map_err(|error: TaskError| error.to_string())
}

/// What the tasks are called, and who does one.
pub(super) struct Tasks<'a> {
    /// A word that takes an s: `run`.
    pub word: &'static str,
    /// Words of what is kept: `runs are done`.
    pub are: &'static str,
    /// Whether nothing but errors is printed.
    pub quiet: bool,
    /// Does a task and puts its result into the store.
    pub work: &'a (dyn Fn(&Task) -> Result<(), TaskError> + Sync),
}

impl EngineArguments {
    /// Does all tasks of a plan that do not stand.
    pub(super) fn perform(&self, plan: &Path, tasks: &Tasks<'_>) -> Result<(), AppError> {
        let opened = Plan::open(plan)?;
        let count = opened.head.tasks;
        let store = Store::of(plan);
        store.make()?;
        tell_unfit(&store.vet(Plan::open(plan)?)?, store.path());
        let bar = progress::tasks(count, tasks.word, tasks.quiet);
        let out = plan.parent().unwrap_or(Path::new("."));
        let interruptible = Interruptible::of_many(count, tasks.are, out);
        let report = |report: TaskMessage| match report {
            TaskMessage::Done(done) => {
                interruptible.at(done);
                bar.set_position(done as u64);
            }
            TaskMessage::Words(words) if tasks.quiet => drop(words),
            TaskMessage::Words(words) if bar.is_hidden() => say_aside(&words),
            TaskMessage::Words(words) => progress::above(&bar, &words),
        };
        let done = match &self.engine {
            Engine::Local => {
                let processors = || std::thread::available_parallelism().map_or(1, usize::from);
                let jobs = self.jobs.map_or_else(processors, usize::from);
                local(opened, &store, jobs, tasks.work, &report)
            }
            engine => dask(&self.dask(engine)?, &full(plan)?, count, &report),
        };
        bar.finish_and_clear();
        match done {
            // What counts is what stands, whatever an engine has received of it.
            Err(TaskError::Failed { of, first, .. }) => match store.missing(Plan::open(plan)?)? {
                0 => Ok(()),
                failed => Err(TaskError::Failed { failed, of, first }.into()),
            },
            done => Ok(done?),
        }
    }

    fn dask(&self, engine: &Engine) -> Result<Dask, AppError> {
        let here = || this_program().map_err(|e| cannot_find(&e));
        Ok(Dask {
            engine: engine.clone(),
            python: self.python.clone(),
            program: self.program.clone().map_or_else(here, Ok)?,
            version: format!("idc {BUILD}"),
            carry: self.carry,
        })
    }
}

/// Says which results were not what was written, and are done again.
pub(super) fn tell_unfit(unfit: &[Unfit], folder: &Path) {
    /// Names that are shown, and digits of each.
    const SHOWN: usize = 5;
    const DIGITS: usize = 12;
    let shown = unfit.iter().take(SHOWN).map(|one| {
        let short = one.id.get(..DIGITS).unwrap_or(&one.id);
        format!("{short}: {}", one.why)
    });
    let shown = shown.collect::<Vec<_>>().join("; ");
    let more = match unfit.len().saturating_sub(SHOWN) {
        0 => String::new(),
        more => format!("; and {more} more"),
    };
    if !unfit.is_empty() {
        let count = counted(unfit.len(), "result");
        let folder = folder.display();
        say_aside(&format!(
            "note: done again, as not what was written: {count} in {folder} ({shown}{more})"
        ));
    }
}

/// Says what has changed since an earlier plan was made.
pub(super) fn tell_changed(before: Option<&Made>, plan: &Path) {
    let changed = before.and_then(|before| before.changed(&Made::of(plan)?));
    if let Some(changed) = changed {
        let plan = plan.display();
        say_aside(&format!(
            "note: since {plan} was last made, {changed}: what comes of it is done again"
        ));
    }
}

fn cannot_find(error: &std::io::Error) -> TaskError {
    TaskError::Refused {
        reason: format!("this program is not found: {error}; expected its path (--program)"),
    }
}

/// A path as a worker in another folder finds it.
pub(super) fn full(path: &Path) -> Result<PathBuf, AppError> {
    let full = path.canonicalize();
    Ok(full.map_err(|e| crate::recording::RecordingError::read(path, e))?)
}
