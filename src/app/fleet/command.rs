//! Arguments of `idc fleet`, and the way from them to a table and a page.

use std::path::{Path, PathBuf};

use clap::Args;

use super::super::engine::{EngineArguments, PLAN, Tasks, tell_changed, tell_unfit};
use super::super::error::{AppError, ExitCode};
use super::super::files::{OutputFolder, OverwritePolicy, REPORT, is_same, output_folder};
use super::super::output::say;
use super::page;
use super::planned::{check, recordings, write, write_fits};
use super::table::{FLEET, TABLE, write_table};
use super::work::Worker;
use crate::document::{Style, html, text};
use crate::fleet::{Found, Layout, scan};
use crate::quantity::counted;
use crate::recording::atomic::write_text;
use crate::tasks::{Head, Made, Plan, Store};

/// For the help.
pub(in super::super) const EXAMPLES: &str = "\
FOLDER/DEVICE/DATE: each DATE is a recording, or a folder of them, whose name
begins with its date, as in 2026-03-01 or 20260301T0600. Recordings of a device
are diagnosed in the order of their days. One that the device's last improved
model, or the nominal one, predicts to the noise needs no search. The same
command on another day does that day's recordings alone.

Exit codes: 0 done, whatever was found; 2 bad input (a recording that cannot be
read is listed in the report, the others are done).

Examples:
  # Two days of a bench's device, as if they had been recorded.
  mkdir -p recorded/press-1/2026-03-01 recorded/press-1/2026-03-02
  cp assets/proof/cases/case-03/ride.csv recorded/press-1/2026-03-01
  cp assets/proof/cases/case-03/ride.csv recorded/press-1/2026-03-02
  idc fleet recorded --scenario assets/proof/cases/case-03/rig.toml \\
      --out runs/fleet
  # A cell's recordings of each shift, by workers of Dask. (takes minutes)
  idc fleet shifts --scenario cell.toml --out runs/cells --engine dask=local:4";

#[derive(Debug, Args)]
pub(in super::super) struct FleetArguments {
    /// Folder of folders of devices, each with recordings by their dates.
    folder: PathBuf,
    /// The nominal model of all devices: a cell's scenario, or a rig file.
    #[arg(long)]
    scenario: PathBuf,
    #[command(flatten)]
    engine: EngineArguments,
    /// Folder for fleet.parquet, fleet.json and report.html [default: runs/<name of the folder>].
    #[arg(long, help_heading = "Output")]
    out: Option<PathBuf>,
    /// Write the plan alone: an engine of your own does it (idc task), and this the tables.
    #[arg(long)]
    plan: bool,
    /// Diagnose all recordings anew; otherwise what stands is kept, as it is named by its content.
    #[arg(long, help_heading = "Output")]
    force: bool,
    /// Print nothing but errors.
    #[arg(long, help_heading = "Output")]
    quiet: bool,
    /// Print what fleet.json holds.
    #[arg(long, conflicts_with = "quiet", help_heading = "Output")]
    json: bool,
}

/// The plan of the fits.
const FITS: &str = "fits.jsonl";

/// Plans, diagnoses, follows what was found, and writes what came of it.
pub(in super::super) fn run(arguments: &FleetArguments) -> Result<ExitCode, AppError> {
    check(&arguments.scenario)?;
    let layout = scan(&arguments.folder)?;
    let out = output_folder(arguments.out.as_ref(), &arguments.folder);
    if is_same(&arguments.folder, &out) {
        return Err(AppError::AmongInputs {
            folder: out.display().to_string(),
        });
    }
    let worker = Worker::of(&arguments.scenario, &out)?;
    let folder = OutputFolder::prepare(
        &out,
        &[PLAN, FITS, TABLE, FLEET, REPORT],
        OverwritePolicy::Keep,
    )?;
    let (plan, fits) = (out.join(PLAN), out.join(FITS));
    let store = Store::of(&plan);
    let before = Made::of(&plan).filter(|_| !arguments.force);
    if arguments.force {
        store.clear()?;
    }
    write(&layout, &arguments.scenario, &plan)?;
    tell_changed(before.as_ref(), &plan);
    tell_unfit(&store.vet(Plan::open(&plan)?)?, store.path());
    let quiet = arguments.quiet || arguments.json;
    let new = Plan::open(&plan)?
        .filter_map(Result::ok)
        .filter(|task| !store.exists(&task.id));
    let new = new.count();
    let count: usize = layout
        .devices
        .iter()
        .map(|device| device.recordings.len())
        .sum();
    if !quiet {
        say(&format!(
            "{} of {}, {new} not diagnosed yet\n",
            counted(count, "recording"),
            counted(layout.devices.len(), "device")
        ))?;
    }
    if arguments.plan {
        return Ok(ExitCode::Done);
    }
    let work = |task: &_| worker.perform(task, &store);
    let tasks = |word: &'static str, are: &'static str| Tasks {
        word,
        are,
        quiet,
        work: &work,
    };
    arguments
        .engine
        .perform(&plan, &tasks("recording", "recordings are diagnosed"))?;
    let places = write_fits(&plan, &fits)?;
    arguments
        .engine
        .perform(&fits, &tasks("fit", "fits are done"))?;
    finish(arguments, &layout, (&plan, &places), &folder)
}

fn finish(
    arguments: &FleetArguments,
    layout: &Layout,
    (plan, places): (&Path, &[Option<String>]),
    folder: &OutputFolder,
) -> Result<ExitCode, AppError> {
    let recordings = recordings(plan, places)?;
    let Head { program, files, .. } = Plan::open(plan)?.head;
    let found = Found::of(&recordings, layout, (&program, &files));
    let document = serde_json::to_string_pretty(&found)?;
    let report = page::document(&found);
    let names = [TABLE, FLEET, REPORT];
    folder.write_with(&names, |unfinished| {
        write_table(&recordings, &unfinished.join(TABLE))?;
        write_text(&unfinished.join(REPORT), &html(&report))?;
        write_text(&unfinished.join(FLEET), &document)?;
        Ok(names.to_vec())
    })?;
    if arguments.json {
        say(&format!("{document}\n"))?;
    } else if !arguments.quiet {
        say(&text(&report, Style::Plain))?;
        let out = folder.path().display();
        say(&format!("written to {out}: {TABLE}, {FLEET}, {REPORT}\n"))?;
    }
    Ok(ExitCode::Done)
}
