//! `idc run --set`: several variants of a scenario, a folder each, and a page that compares them.

use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};

use serde_json::Value;

use super::super::compare::write_page;
use super::super::error::{AppError, ExitCode};
use super::super::files::{
    OutputFolder, OverwritePolicy, RUN, RUN_NAMES, claim_folder, prepare_file,
};
use super::super::interrupt::Interruptible;
use super::super::output::{say, say_styled};
use super::super::progress;
use super::super::terminal::{say_aside, shown_path};
use super::command::RunArguments;
use super::job::{RunOptions, code};
use super::settings::{Variant, blamed, with_flags};
use super::source::Source;
use super::table::{Done, document};
use crate::document::text;
use crate::proof::in_order;
use crate::recording::seal::{SealError, read_sealed};
use crate::report::SUMMARY;
use crate::run::{Job, RunResult};
use crate::scenario::ScenarioTemplate;

/// The page beside the folders.
const PAGE: &str = "compare.html";
/// Count of each run's progress.
const PARTS: usize = 1000;

/// Runs all of them; nothing is run before all have been checked.
pub(super) fn run(
    arguments: &RunArguments,
    template: &ScenarioTemplate,
    variants: &[Variant],
) -> Result<ExitCode, AppError> {
    let out = arguments.folder();
    let page = out.join(PAGE);
    let policy = arguments.policy();
    let jobs = rayon::current_num_threads();
    let checked = in_order(variants.len(), jobs, |index| {
        job(template, &variants[index]).map(drop)
    });
    // One that panics is met, and reported, as it is run.
    checked
        .into_iter()
        .flatten()
        .collect::<Result<Vec<()>, _>>()?;
    for variant in variants {
        OutputFolder::check(&out.join(&variant.name), &RUN_NAMES, policy)?;
    }
    // One claim for all: a process holds no thousands of files open.
    let _claims = (claim_folder(&out)?, prepare_file(&page, "--out", policy)?);
    let folders = (variants.iter())
        .map(|variant| OutputFolder::prepare_within(&out.join(&variant.name), &RUN_NAMES, policy))
        .collect::<Result<Vec<_>, _>>()?;
    let quiet = arguments.quiet || arguments.json;
    let bar = progress::runs(variants.len(), PARTS, quiet);
    let count = variants.len();
    let interruptible = Interruptible::of_many(count, "runs are done", &out);
    let failed = AtomicUsize::new(0);
    let outcome = in_order(count, jobs, |index| {
        // What a full disk does to one it does to all.
        if failed.load(Ordering::Relaxed) > 0 {
            return Ok(None);
        }
        let mut before = 0;
        let progress = &mut |done: usize, total: usize| {
            let parts = PARTS * done / total.max(1);
            bar.inc(parts.saturating_sub(before) as u64);
            before = before.max(parts);
        };
        let done = one(
            arguments,
            template,
            &variants[index],
            &folders[index],
            progress,
        );
        match &done {
            Ok(_) => interruptible.one_more(),
            Err(_) => drop(failed.fetch_add(1, Ordering::Relaxed)),
        }
        bar.inc(PARTS.saturating_sub(before) as u64);
        progress::words(&bar, &interruptible.done().to_string());
        done.map(Some)
    });
    bar.finish_and_clear();
    let mut runs = Vec::new();
    for (index, outcome) in outcome.into_iter().enumerate() {
        let fault = || AppError::Fault {
            part: variants[index].name.clone(),
        };
        runs.extend(outcome.ok_or_else(fault)??);
    }
    let paths: Vec<PathBuf> = runs.iter().map(|run| run.folder.clone()).collect();
    write_page(&paths, &page)?;
    drop(interruptible);
    print_result(arguments, &out, &runs)
}

fn job(template: &ScenarioTemplate, variant: &Variant) -> Result<Job, AppError> {
    let scenario =
        (template.with(&variant.edits)).map_err(|error| blamed(error, &variant.edits, template))?;
    Job::new(scenario).map_err(|error| with_flags(error.into(), &variant.edits))
}

fn one(
    arguments: &RunArguments,
    template: &ScenarioTemplate,
    variant: &Variant,
    folder: &OutputFolder,
    progress: &mut dyn FnMut(usize, usize),
) -> Result<Done, AppError> {
    let title = variant.title(template.title());
    let source = Source::varied(template, &variant.edits, title.clone(), folder.path())?;
    let titled: Vec<_> = variant.edits.iter().cloned().chain(title).collect();
    let job = Job::new(template.with(&titled)?)?;
    let existing = match arguments.policy() {
        OverwritePolicy::Keep => existing(folder.path(), &job, &source, arguments.run_options())?,
        _ => None,
    };
    let existing = existing.and_then(|existing| match existing {
        Ok(result) => Some(result),
        Err(why) => {
            say_aside(&format!(
                "note: {}: {why}; run again",
                folder.path().display()
            ));
            None
        }
    });
    let result = match existing {
        Some(result) => result,
        None => {
            let outcome = job.perform(&source, folder, arguments.run_options(), None, progress)?;
            outcome.result
        }
    };
    Ok(Done {
        folder: folder.path().to_owned(),
        variant: variant.clone(),
        result,
    })
}

/// The numbers of a run that stands complete in its folder and comes from the same files and values, or why it is to be run again; neither where nothing stands.
fn existing(
    folder: &Path,
    job: &Job,
    source: &Source,
    options: RunOptions,
) -> Result<Option<Result<RunResult, String>>, AppError> {
    let text = match read_sealed(&folder.join(SUMMARY), RUN) {
        Ok(text) => text,
        Err(SealError::Absent) => return Ok(None),
        Err(why) => return Ok(Some(Err(format!("of {SUMMARY}, {why}")))),
    };
    let mut needed = RUN_NAMES.iter().filter(|name| job.writes(name, options));
    if let Some(name) = needed.find(|name| !folder.join(name).is_file()) {
        return Ok(Some(Err(format!("{name} is missing"))));
    }
    let result: RunResult = serde_json::from_str(&text)?;
    let (origin, _) = job.provenance(source)?;
    let same = result.provenance == origin;
    let moved = || "its files were called otherwise".to_owned();
    let why = || result.provenance.changed(&origin).unwrap_or_else(moved);
    Ok(Some(if same { Ok(result) } else { Err(why()) }))
}

/// Prints what came of them.
fn print_result(arguments: &RunArguments, out: &Path, runs: &[Done]) -> Result<ExitCode, AppError> {
    if arguments.json {
        let with_folder = |run: &Done| {
            let mut document = serde_json::to_value(&run.result)?;
            document["folder"] = run.folder.display().to_string().into();
            Ok(document)
        };
        let all: Result<Vec<Value>, AppError> = runs.iter().map(with_folder).collect();
        let all = all?;
        say(&format!("{}\n", serde_json::to_string_pretty(&all)?))?;
    } else if !arguments.quiet {
        say_styled(&text(&document(runs), arguments.run_options().style))?;
        let count = runs.len();
        let folder = shown_path(out);
        say(&format!("written to {folder}: {count} folders, {PAGE}\n"))?;
    }
    let codes = runs.iter().map(|run| {
        let code = code(&run.result);
        for line in run.result.complaints() {
            say_aside(&format!("{}: {line}", run.variant.name));
        }
        code
    });
    let worst = codes.max_by_key(|code| *code as u8);
    Ok(worst.unwrap_or(ExitCode::Done))
}
