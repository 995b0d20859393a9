//! `idc import`: logs of a real device made into recordings, and what was understood of them.

mod json;
mod summary;

use std::collections::BTreeMap;
use std::ops::Range;
use std::path::{Path, PathBuf};

use clap::Args;

use super::error::{AppError, ExitCode};
use super::files::{OverwritePolicy, is_same, prepare_files};
use super::interrupt::Interruptible;
use super::output::say;
use super::progress;
use super::terminal::shown_path;
use crate::document::{self, Style};
use crate::import::findings::same_data;
use crate::import::{ImportError, ImportMap, Imported, LogNote, import, load_map, map_of_bag};
use crate::recording::csv::write_recording;
use crate::recording::gaps::parts;
use crate::recording::parquet::write_parquet;
use summary::{Copies, Job, name};

#[derive(Debug, Args)]
pub(super) struct ImportArguments {
    /// Import map; or a recording.mcap of `idc run --mcap`, which needs none.
    map: PathBuf,
    /// Logs in place of those that the map names, in its order; several times as many make several recordings.
    #[arg(value_name = "LOG")]
    logs: Vec<PathBuf>,
    /// Recording to write, .parquet or .csv; or a folder, where each is named by its first log. Nothing is written without it.
    #[arg(long, help_heading = "Output")]
    out: Option<PathBuf>,
    /// Write what stands between gaps, or where a clock starts again, as recordings of their own, numbered from 1; `idc diagnose` takes no recording with a gap.
    #[arg(long, help_heading = "Output", requires = "out")]
    split: bool,
    /// Put new results in place of old ones.
    #[arg(long, help_heading = "Output")]
    force: bool,
    /// Print nothing but errors.
    #[arg(long, help_heading = "Output")]
    quiet: bool,
    /// Print what was understood as JSON.
    #[arg(long, conflicts_with = "quiet", help_heading = "Output")]
    json: bool,
}

/// Imports logs, one recording for as many as the map has files; nothing is written before all of them have been read.
pub(super) fn run(arguments: &ImportArguments) -> Result<ExitCode, AppError> {
    let map = match map_of_bag(&arguments.map)? {
        Some(_) if !arguments.logs.is_empty() => {
            return Err(AppError::OwnRecording {
                file: arguments.map.clone(),
                more: arguments.logs.len(),
            });
        }
        Some(own) => own,
        None => load_map(&arguments.map)?,
    };
    if let Some(out) = &arguments.out {
        check_ending(out)?;
    }
    let each = map.files.iter().filter(|file| !file.same_log).count();
    if !arguments.logs.len().is_multiple_of(each) {
        return Err(AppError::Logs {
            given: arguments.logs.len(),
            each,
            map: arguments.map.clone(),
        });
    }
    let groups: Vec<&[PathBuf]> = if arguments.logs.is_empty() {
        vec![&[]]
    } else {
        arguments.logs.chunks(each).collect()
    };
    let mut jobs: Vec<Job> = Vec::new();
    let reading =
        Interruptible::new(|_| "nothing was written yet; the same command begins anew".to_owned());
    let sizes: Vec<u64> = groups.iter().map(|logs| bytes(logs)).collect();
    let bar = progress::bytes(sizes.iter().sum(), arguments.quiet || arguments.json);
    for (logs, size) in groups.iter().zip(&sizes) {
        let recordings = match arguments.split {
            true => parted(&map, logs)?,
            false => vec![import(&map, logs)?],
        };
        bar.inc(*size);
        jobs.extend(self::jobs(arguments, recordings, groups.len()));
    }
    bar.finish_and_clear();
    drop(reading);
    check_destinations(&jobs)?;
    let paths = jobs.iter().flat_map(|job| &job.outs).map(|(path, _)| path);
    let paths: Vec<&PathBuf> = paths.collect();
    let _claims = prepare_files(&paths, "--out", OverwritePolicy::of(arguments.force))?;
    let copies = copies(&jobs);
    let interruptible = arguments.out.as_ref().map(|out| {
        let (out, count) = (out.display().to_string(), jobs.len());
        Interruptible::new(move |done| format!("{done} of {count} recordings are written and kept in {out}; the same command with --force writes all of them"))
    });
    for job in &jobs {
        for (path, samples) in &job.outs {
            let recording = &job.imported.recording;
            let is_whole = *samples == (0..recording.sample_count());
            let part = (!is_whole).then(|| recording.part(samples.clone()));
            let part = part.transpose()?;
            let part = part.as_ref().unwrap_or(recording);
            if is_csv(path) {
                write_recording(path, part)?;
            } else {
                write_parquet(path, part, &provenance(&job.imported, &map))?;
            }
        }
        interruptible.iter().for_each(Interruptible::one_more);
    }
    if arguments.json {
        say(&json::report(&map, &jobs, &copies)?)?;
    } else if !arguments.quiet {
        say(&text(&map, &jobs, &copies))?;
    }
    Ok(ExitCode::Done)
}

/// Recordings of logs, one for each time that their clock starts.
fn parted(map: &ImportMap, logs: &[PathBuf]) -> Result<Vec<Imported>, ImportError> {
    match import(map, logs) {
        Err(ImportError::Restart {
            dropped: [before, after],
            ..
        }) if map.files.len() == 1 => {
            let (mut first, mut rest) = (map.clone(), map.clone());
            first.files[0].dropped[1] = after;
            rest.files[0].dropped[0] = before;
            let mut all = parted(&first, logs)?;
            all.extend(parted(&rest, logs)?);
            Ok(all)
        }
        imported => Ok(vec![imported?]),
    }
}

/// Recordings of the same logs, and where they go.
fn jobs(arguments: &ImportArguments, recordings: Vec<Imported>, groups: usize) -> Vec<Job> {
    let of = |imported: &Imported| {
        let whole = 0..imported.recording.sample_count();
        match arguments.split {
            true => parts(imported.recording.time()),
            false => vec![whole],
        }
    };
    let samples: Vec<Vec<Range<usize>>> = recordings.iter().map(of).collect();
    let out = arguments.out.as_ref();
    let out = out.map(|out| destination(out, &recordings[0], groups));
    let count = samples.iter().map(Vec::len).sum();
    let paths = out.map_or(Vec::new(), |out| numbered(&out, count));
    let mut paths = paths.into_iter();
    let pairs = recordings.into_iter().zip(samples);
    let job = |(imported, samples): (Imported, Vec<Range<usize>>)| Job {
        // No path is left where nothing is written.
        outs: samples
            .into_iter()
            .filter_map(|s| Some((paths.next()?, s)))
            .collect(),
        imported,
    };
    pairs.map(job).collect()
}

/// Whether a recording is written as comma-separated values, by the ending of its name.
fn is_csv(path: &Path) -> bool {
    let ending = path.extension().unwrap_or_default();
    ending.eq_ignore_ascii_case("csv")
}

/// Refuses a name whose ending is that of neither form, and of no folder.
fn check_ending(out: &Path) -> Result<(), AppError> {
    let is_parquet = |ending: &std::ffi::OsStr| ending.eq_ignore_ascii_case("parquet");
    let is_known = out.extension().is_some_and(is_parquet) || is_csv(out);
    if is_known || out.is_dir() || is_folder_name(out) || out.extension().is_none() {
        return Ok(());
    }
    Err(AppError::OutputFile {
        file: out.display().to_string(),
        option: "--out",
        reason: "the ending of its name says which form it has, and is neither .parquet nor .csv (the name of a folder ends in /)".to_owned(),
    })
}

fn is_folder_name(out: &Path) -> bool {
    out.as_os_str().to_string_lossy().ends_with('/')
}

/// Where the parts of a recording go: one alone as it is called, several numbered from 1.
fn numbered(out: &Path, count: usize) -> Vec<PathBuf> {
    if count == 1 {
        return vec![out.to_owned()];
    }
    let stem = out.file_stem().unwrap_or_default().to_string_lossy();
    let ending = out.extension().unwrap_or_default().to_string_lossy();
    let name = |index: usize| out.with_file_name(format!("{stem}-{}.{ending}", index + 1));
    (0..count).map(name).collect()
}

/// Size of logs together [bytes].
fn bytes(logs: &[PathBuf]) -> u64 {
    let size = |log: &PathBuf| std::fs::metadata(log).map_or(0, |file| file.len());
    logs.iter().map(size).sum()
}

/// Where a recording goes: into a folder, named by its first log, unless it is alone and the folder is none.
fn destination(out: &Path, imported: &Imported, count: usize) -> PathBuf {
    let is_folder = out.is_dir() || is_folder_name(out) || out.extension().is_none();
    if count == 1 && !is_folder {
        return out.to_owned();
    }
    // Not `with_extension`: the dots of a name such as `F35_v0.10` are its own.
    let stem = imported.logs[0].file.file_stem();
    let stem = stem.map_or_else(|| "recording".into(), |stem| stem.to_string_lossy());
    out.join(format!("{stem}.parquet"))
}

/// Refuses recordings that would take each other's place, or a log's.
fn check_destinations(jobs: &[Job]) -> Result<(), AppError> {
    for (index, job) in jobs.iter().enumerate() {
        for (out, _) in &job.outs {
            let has = |other: &&Job| other.outs.iter().any(|(path, _)| path == out);
            if let Some(other) = jobs[..index].iter().find(has) {
                return Err(AppError::SameOutput {
                    one: other.imported.logs[0].file.clone(),
                    other: job.imported.logs[0].file.clone(),
                    out: out.clone(),
                });
            }
            let mut logs = jobs.iter().flat_map(|job| &job.imported.logs);
            if logs.any(|log| is_same(&log.file, out)) {
                return Err(AppError::Overwrites {
                    file: out.display().to_string(),
                });
            }
        }
    }
    Ok(())
}

fn provenance(imported: &Imported, map: &ImportMap) -> BTreeMap<String, String> {
    let mut files: Vec<String> = imported.logs.iter().map(|log| name(&log.file)).collect();
    files.dedup();
    let mut pairs = BTreeMap::from([
        ("title".to_owned(), map.title.clone()),
        ("imported_from".to_owned(), files.join(", ")),
        ("import_map".to_owned(), name(&map.path)),
    ]);
    if imported.origin != 0.0 {
        let origin = format!("{:.0}", imported.origin);
        pairs.insert("time_origin_unix_s".to_owned(), origin);
    }
    pairs
}

fn text(map: &ImportMap, jobs: &[Job], copies: &[Copies]) -> String {
    let jobs_text = jobs.iter().map(|job| {
        let described = summary::described(&job.imported, map);
        document::text(&described, Style::Plain) + "\n"
    });
    let copies = copies.iter().map(|Copies { one, other, share }| {
        let [one, other] = [one.display(), other.display()];
        let percent = 100.0 * share;
        let words = format!("{one} and {other} are the same data: {percent:.0} % of their rows");
        document::wrapped("", &words)
    });
    let outs = jobs.iter().flat_map(|job| &job.outs);
    let outs = outs.map(|(out, _)| format!("written to {}\n", shown_path(out)));
    jobs_text.chain(copies).chain(outs).collect()
}

/// Logs that are copies of one another.
fn copies(jobs: &[Job]) -> Vec<Copies> {
    let logs: Vec<&LogNote> = jobs.iter().flat_map(|job| &job.imported.logs).collect();
    let mut found = Vec::new();
    for (index, other) in logs.iter().enumerate() {
        for one in &logs[..index] {
            if let Some(share) = same_data(one, other) {
                found.push(Copies {
                    one: one.file.clone(),
                    other: other.file.clone(),
                    share,
                });
            }
        }
    }
    found
}
