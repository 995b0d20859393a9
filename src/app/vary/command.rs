//! Arguments of `idc vary`, and the way from them to a table and a page.

use std::path::{Path, PathBuf};

use clap::Args;

use super::super::engine::{EngineArguments, PLAN, Tasks, tell_changed};
use super::super::error::{AppError, ExitCode};
use super::super::files::{OutputFolder, OverwritePolicy, REPORT, output_folder};
use super::super::output::say;
use super::page;
use super::table::{RUNS, SWEEP, columns, write_table};
use super::work::Worker;
use crate::document::{Style, html, text};
use crate::quantity::counted;
use crate::recording::atomic::write_text;
use crate::run::apply_effects;
use crate::scenario::{EffectRequest, ScenarioTemplate};
use crate::tasks::{Head, Made, Plan, Store};
use crate::vary::{Points, Sampling, Sweep, Swept, Variable, VaryError};

/// All that it writes, besides the folders of the tasks.
const NAMES: [&str; 4] = [PLAN, RUNS, SWEEP, REPORT];

/// For the help.
pub(in super::super) const EXAMPLES: &str = "\
VALUES are 30,60 or 1e5..3e5:5 (so many, evenly) or 1..200: any number between,
for samples; of a key that is a count, as a seed, each whole number. Each is
checked by its key before anything is run. A combination that cannot be run is a
result as well: the table says why. What stands is known by its content
(program, files, values): --resume does what is missing, also after the sweep
has grown or the engine has died.
How much of a number goes with one variable is its first-order (Sobol) index,
with a bootstrap interval at 95 %, after what the other variables do is taken
away; it is named where the interval lies above what a shuffled variable gets.

Exit codes: 0 done, whatever the runs came to; 2 bad input, or runs that came to
nothing (the others are kept).

Examples:
  # Three durations with two seeds: every combination.
  idc vary scenarios/paper_step.toml --out runs/few \\
      --set bench.duration_s=8..9:3 --set simulation.seed=1..2
  # The same, and more: what stands is not done again.
  idc vary scenarios/paper_step.toml --out runs/few --resume \\
      --set bench.duration_s=8..9:3 --set simulation.seed=1..4
  # A Latin hypercube of 400 runs, by four workers of Dask. (takes minutes)
  idc vary scenarios/plate_edge.toml --out runs/latin --sample latin:400 \\
      --set contact.stiffness_n_per_m=1e5..3e5 --set process.force_n=100..200 \\
      --engine dask=local:4";

#[derive(Debug, Args)]
pub(in super::super) struct VaryArguments {
    /// Scenario file, of a cell or a bench.
    scenario: PathBuf,
    /// Values of a key of the scenario by its dotted path, as in process.force_n=30,60 or contact.stiffness_n_per_m=1e5..3e5:5 or workpiece.burr.seed=1..200; may be given several times.
    #[arg(long = "set", value_name = "KEY=VALUES", value_parser = variable)]
    variables: Vec<Variable>,
    /// An effect of the catalogue to put into all runs, as of idc run.
    #[arg(long = "with", value_name = "EFFECT[:KEY=VALUE,..]", value_parser = EffectRequest::parse)]
    effects: Vec<EffectRequest>,
    /// How the points lie: `grid`, every combination; `random:N`, each drawn for itself; `latin:N`, a Latin hypercube.
    #[arg(long, default_value = "grid", value_parser = sampling)]
    sample: Sampling,
    /// Seed of what is drawn.
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Points of a table in place of --set: a CSV file with a column for each key, a row for each run.
    #[arg(long, value_name = "CSV", conflicts_with_all = ["variables", "sample"], required_unless_present = "variables")]
    points: Option<PathBuf>,
    #[command(flatten)]
    engine: EngineArguments,
    /// Folder for runs.parquet, vary.json and report.html [default: runs/<scenario name>].
    #[arg(long, help_heading = "Output")]
    out: Option<PathBuf>,
    /// Leave runs as they are that stand, as of a sweep that was interrupted or has grown.
    #[arg(long, conflicts_with = "force")]
    resume: bool,
    /// Write the plan alone: an engine of your own does it (idc task), and this with --resume the tables.
    #[arg(long)]
    plan: bool,
    /// Put new results in place of old ones.
    #[arg(long, help_heading = "Output")]
    force: bool,
    /// Print nothing but errors.
    #[arg(long, help_heading = "Output")]
    quiet: bool,
    /// Print what vary.json holds.
    #[arg(long, conflicts_with = "quiet", help_heading = "Output")]
    json: bool,
}

fn variable(text: &str) -> Result<Variable, String> {
    Variable::parse(text).map_err(|error| match error {
        // Clap names the text itself.
        VaryError::Setting { reason, .. } => reason,
        other => other.to_string(),
    })
}

fn sampling(text: &str) -> Result<Sampling, String> {
    text.parse().map_err(|error: VaryError| error.to_string())
}

/// Plans, runs, and writes what came of it.
pub(in super::super) fn run(arguments: &VaryArguments) -> Result<ExitCode, AppError> {
    let template = ScenarioTemplate::read(&arguments.scenario)?;
    let fixed = apply_effects(&arguments.effects, &template)?;
    let points = match &arguments.points {
        Some(file) => Points::table(file)?,
        None => {
            let is_count = |key: &str, whole| template.is_count(key, whole, &fixed);
            let variables = arguments.variables.iter().cloned();
            let variables = variables.map(|variable| variable.of_key(is_count));
            Points::new(variables.collect(), arguments.sample, arguments.seed)?
        }
    };
    let sweep = Sweep {
        template,
        fixed,
        points,
    };
    sweep.check()?;
    let out = output_folder(arguments.out.as_ref(), &arguments.scenario);
    let folder = prepare(arguments, &out)?;
    let plan = write_plan(arguments, &sweep, &folder)?;
    if arguments.plan {
        return planned(arguments, &plan, sweep.points.count());
    }
    let worker = Worker::new(&Plan::open(&plan)?)?;
    let store = Store::of(&plan);
    let work = |task: &_| worker.perform(task, &store);
    let tasks = Tasks {
        word: "run",
        are: "runs are done",
        quiet: arguments.quiet || arguments.json,
        work: &work,
    };
    arguments.engine.perform(&plan, &tasks)?;
    finish(arguments, &sweep, &plan, &folder)
}

/// The folder.
fn prepare(arguments: &VaryArguments, out: &Path) -> Result<OutputFolder, AppError> {
    let policy = match arguments.resume {
        true => OverwritePolicy::Keep,
        false => OverwritePolicy::of(arguments.force),
    };
    OutputFolder::prepare(out, &NAMES, policy)
}

/// Writes the plan. The tables of the sweep before stand until there are new ones, but where the plan is all that is asked for.
fn write_plan(
    arguments: &VaryArguments,
    sweep: &Sweep,
    folder: &OutputFolder,
) -> Result<PathBuf, AppError> {
    let plan = folder.path().join(PLAN);
    let before = Made::of(&plan).filter(|_| arguments.resume);
    if arguments.force {
        Store::of(&plan).clear()?;
    }
    let all: &[&str] = if arguments.plan { &NAMES } else { &[] };
    folder.write_with(all, |unfinished| {
        sweep.write(&unfinished.join(PLAN), folder.path())?;
        Ok(vec![PLAN])
    })?;
    tell_changed(before.as_ref(), &plan);
    Ok(plan)
}

fn planned(arguments: &VaryArguments, plan: &Path, count: usize) -> Result<ExitCode, AppError> {
    let file = plan.display();
    if arguments.json {
        let document = serde_json::json!({ "plan": file.to_string(), "tasks": count });
        say(&format!("{document}\n"))?;
    } else if !arguments.quiet {
        say(&format!("{} planned in {file}\n", counted(count, "run")))?;
    }
    Ok(ExitCode::Done)
}

/// Writes the table, and what it says.
fn finish(
    arguments: &VaryArguments,
    sweep: &Sweep,
    plan: &Path,
    folder: &OutputFolder,
) -> Result<ExitCode, AppError> {
    let Head { program, files, .. } = Plan::open(plan)?.head;
    let mut said = (String::new(), String::new());
    folder.write_with(&[RUNS, SWEEP, REPORT], |unfinished| {
        let table = unfinished.join(RUNS);
        write_table(plan, sweep.template.is_bench(), &table)?;
        let swept = Swept::of(sweep, (&program, &files), &|wanted| columns(&table, wanted))?;
        let document = serde_json::to_string_pretty(&swept)?;
        let report = page::document(&swept, &|wanted| columns(&table, wanted))?;
        write_text(&unfinished.join(REPORT), &html(&report))?;
        write_text(&unfinished.join(SWEEP), &document)?;
        said = (document, text(&report, Style::Plain));
        Ok(vec![RUNS, SWEEP, REPORT])
    })?;
    let (document, report) = said;
    if arguments.json {
        say(&format!("{document}\n"))?;
    } else if !arguments.quiet {
        say(&report)?;
        let folder = folder.path().display();
        say(&format!("written to {folder}: {RUNS}, {SWEEP}, {REPORT}\n"))?;
    }
    Ok(ExitCode::Done)
}
