//! `idc import`: logs of a real device made into recordings, and what was understood of them.

use std::collections::BTreeMap;
use std::fmt::Write;
use std::path::{Path, PathBuf};

use super::cli::ImportArguments;
use super::error::{AppError, ExitCode};
use super::output::say;
use crate::import::findings::{Finding, findings, same_data};
use crate::import::{ImportMap, Imported, LogNote, Remark, import, load_map};
use crate::recording::parquet::write_parquet;

pub(super) const EXAMPLES: &str = "\
Examples:
  idc import assets/import/cylinder_friction.toml KDN_1bar.csv            what is in it
  idc import assets/import/cylinder_friction.toml KDN_1bar.csv --out kdn_1.parquet
  idc import assets/import/cylinder_friction.toml KDN_*.csv --out runs/kdn a recording of each, into a folder";
/// Gaps and rows that are listed, at most.
const LISTED: usize = 3;

/// Imports logs, one recording for as many as the map has files.
pub(super) fn run(arguments: &ImportArguments) -> Result<ExitCode, AppError> {
    let map = load_map(&arguments.map)?;
    let each = map.files.len();
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
    let all: Vec<Imported> = groups
        .iter()
        .map(|logs| import(&map, logs))
        .collect::<Result<_, _>>()?;
    let mut text = String::new();
    for imported in &all {
        text += &described(imported, &map);
    }
    text += &copies(&all);
    if let Some(out) = &arguments.out {
        for imported in &all {
            let path = if all.len() == 1 {
                out.clone()
            } else {
                std::fs::create_dir_all(out).map_err(|error| AppError::OutputFolder {
                    folder: out.display().to_string(),
                    reason: error.to_string(),
                })?;
                out.join(stem(imported)).with_extension("parquet")
            };
            write_parquet(&path, &imported.recording, &provenance(imported, &map))?;
            let _ = writeln!(text, "written to {}", path.display());
        }
    }
    if !arguments.quiet {
        say(&text)?;
    }
    Ok(ExitCode::Done)
}

fn stem(imported: &Imported) -> PathBuf {
    let name = imported.logs[0].file.file_stem();
    name.map_or_else(|| PathBuf::from("recording"), PathBuf::from)
}

fn provenance(imported: &Imported, map: &ImportMap) -> BTreeMap<String, String> {
    let files: Vec<String> = imported.logs.iter().map(|log| name(&log.file)).collect();
    BTreeMap::from([
        ("title".to_owned(), map.title.clone()),
        ("imported_from".to_owned(), files.join(", ")),
        ("import_map".to_owned(), name(&map.path)),
    ])
}

fn name(path: &Path) -> String {
    let name = path.file_name().unwrap_or(path.as_os_str());
    name.to_string_lossy().into_owned()
}

/// What was understood of a recording.
fn described(imported: &Imported, map: &ImportMap) -> String {
    let mut text = String::new();
    let time = imported.recording.time();
    let files: Vec<String> = imported
        .logs
        .iter()
        .map(|log| log.file.display().to_string())
        .collect();
    let _ = writeln!(
        text,
        "{}: {} samples from {:.3} to {:.3} s",
        files.join(" and "),
        time.len(),
        time[0],
        time[time.len() - 1]
    );
    let found = findings(imported, map);
    let wide = found.iter().map(|f| f.quantity.len()).max().unwrap_or(0);
    for finding in &found {
        let _ = writeln!(text, "  {}", line(finding, wide));
        if let Some(doubt) = &finding.doubt {
            let _ = writeln!(text, "    doubtful unit: {doubt}");
        }
        for value in &finding.cut_off_at {
            let _ = writeln!(
                text,
                "    stays at its extreme value {}: cut off there?",
                shown(*value)
            );
        }
    }
    for log in &imported.logs {
        for remark in remarks(log) {
            let _ = writeln!(text, "  {}: {remark}", name(&log.file));
        }
    }
    let series = imported
        .logs
        .iter()
        .zip(&map.files)
        .flat_map(|(log, file)| {
            let channel = log.series.iter().zip(&file.channels);
            channel.map(|(series, channel)| (channel.quantity.as_str(), series))
        });
    let mut told: Vec<[f64; 2]> = Vec::new();
    for ((quantity, _), finding) in series.zip(&found) {
        for gap in finding
            .gaps
            .iter()
            .filter(|gap| !told.contains(gap))
            .take(LISTED)
            .copied()
            .collect::<Vec<_>>()
        {
            let _ = writeln!(
                text,
                "  gap of {:.3} s from {:.3} s in {quantity}{}",
                gap[1] - gap[0],
                gap[0],
                match finding.gaps.len() {
                    0..=LISTED => String::new(),
                    count => format!(", one of {count}"),
                }
            );
            told.push(gap);
        }
    }
    text
}

/// A channel in a line.
fn line(finding: &Finding, wide: usize) -> String {
    let [low, high] = finding.range.map(shown);
    let unit = finding.unit.symbol();
    let mut text = format!(
        "{:wide$}  {:.6} Hz, {low} to {high} {unit}",
        finding.quantity,
        shown(finding.rate)
    );
    if finding.log_unit.factor != 1.0 || finding.log_unit.zero != 0.0 {
        let _ = write!(text, " (logged in {})", finding.log_unit.name);
    }
    match (finding.noise, finding.quantum) {
        (Some(noise), Some(step)) if noise < step => {
            let _ = write!(text, ", noise below its steps");
        }
        (Some(noise), _) => {
            let _ = write!(text, ", noise {} {unit}", shown(noise));
        }
        (None, _) => {}
    }
    if let Some(step) = finding.quantum {
        let _ = write!(text, ", in steps of {} {unit}", shown(step));
    }
    if finding.missing > 0 {
        let _ = write!(
            text,
            ", {} of {} samples empty",
            finding.missing, finding.samples
        );
    }
    text
}

/// A number to four digits.
fn shown(value: f64) -> String {
    if value == 0.0 {
        return "0".to_owned();
    }
    let digits = 3 - value.abs().log10().floor() as i32;
    if (-2..=7).contains(&digits) {
        let text = format!("{value:.*}", usize::try_from(digits.max(0)).unwrap_or(0));
        if text.contains('.') {
            return text.trim_end_matches('0').trim_end_matches('.').to_owned();
        }
        return text;
    }
    format!("{value:.3e}")
}

fn remarks(log: &LogNote) -> Vec<String> {
    let rows = |lines: &[u64]| {
        let first: Vec<String> = lines.iter().take(LISTED).map(u64::to_string).collect();
        let more = if lines.len() > LISTED { ", ..." } else { "" };
        format!("{} (line {}{more})", lines.len(), first.join(", "))
    };
    let mut said: Vec<String> = log
        .remarks
        .iter()
        .map(|remark| match remark {
            Remark::Dropped([0, last]) => {
                format!("the last {last} rows were dropped, as the map says")
            }
            Remark::Dropped([first, 0]) => {
                format!("the first {first} rows were dropped, as the map says")
            }
            Remark::Dropped([first, last]) => {
                format!("the first {first} and the last {last} rows were dropped, as the map says")
            }
            Remark::Repeated(lines) => format!(
                "rows that repeat the one before them were left out: {}",
                rows(lines)
            ),
            Remark::Stamped(lines) => format!(
                "rows with the time of the one before them but other values were left out: {}",
                rows(lines)
            ),
            Remark::Torn(line) => format!("its last row, line {line}, is torn and was left out"),
        })
        .collect();
    if let Some(found) = log.alignment {
        said.push(format!(
            "its clock was found: {:+.4} s to be added (correlation {:.3}, looked at every {:.4} s)",
            found.offset, found.correlation, found.step
        ));
    }
    said
}

/// Recordings that are copies of one another.
fn copies(all: &[Imported]) -> String {
    let mut text = String::new();
    let logs: Vec<&LogNote> = all.iter().flat_map(|imported| &imported.logs).collect();
    for (index, one) in logs.iter().enumerate() {
        for other in &logs[..index] {
            if let Some(share) = same_data(one, other) {
                let _ = writeln!(
                    text,
                    "{} and {} are the same data: {:.0} % of their rows",
                    other.file.display(),
                    one.file.display(),
                    100.0 * share
                );
            }
        }
    }
    text
}
