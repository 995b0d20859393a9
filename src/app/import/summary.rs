//! Interpretation of a log, for people.

use std::ops::Range;
use std::path::{Path, PathBuf};

use crate::document::{Block, Cell, Column, Document, Section, Table};
use crate::import::findings::{Finding, findings};
use crate::import::rows::Stray;
use crate::import::{ImportMap, Imported, LogNote, Remark};
use crate::recording::gaps::{longest_pause, parts};
use crate::stats::median_step;

/// Gaps and rows that are listed, at most.
const LISTED: usize = 3;

/// A recording to be, and where it goes.
pub(super) struct Job {
    pub imported: Imported,
    /// Files, with the samples that go into each; none where nothing is written.
    pub outs: Vec<(PathBuf, Range<usize>)>,
}

/// Two logs that are the same data.
pub(super) struct Copies {
    pub one: PathBuf,
    pub other: PathBuf,
    pub share: f64,
}

/// Interpretation of a recording.
pub(super) fn described(imported: &Imported, map: &ImportMap) -> Document<'static> {
    let time = imported.recording.time();
    let [first, last] = [time[0], time[time.len() - 1]];
    let logs = &imported.logs;
    let mut files: Vec<String> = (logs.iter().map(|log| log.file.display().to_string())).collect();
    // Clocks of one log stand behind each other.
    files.dedup();
    let found = findings(imported, map);
    let columns = Column::list("channel | | #Hz | #least | #most | #noise | #steps");
    let table = Table::new("", columns, found.iter().map(row).collect());
    let mut notes: Vec<String> = found.iter().flat_map(remarks_on).collect();
    if imported.origin != 0.0 {
        let origin = imported.origin;
        notes.push(format!("Times count from {origin:.0} s since 1970."));
    }
    for log in logs {
        let [used, there] = log.rows;
        let of = match logs.len() {
            1 => String::new(),
            _ => format!(", of {}", log.quantities.join(", ")),
        };
        let rows = format!("{used} of {there} rows used{of}");
        let said = std::iter::once(rows).chain(remarks(log));
        notes.extend(said.map(|said| format!("{}: {said}", name(&log.file))));
    }
    let several = parts(time).len();
    if several > 1 {
        let pause = shown(longest_pause(time));
        notes.push(format!("Gaps part it into {several} recordings: `idc diagnose` takes none with a gap longer than {pause} s, `--split` writes each part by itself."));
    }
    notes.extend(gaps(&found));
    let notes = notes.into_iter().map(Block::Paragraph);
    Document {
        title: format!(
            "{}: {} samples from {first:.3} to {last:.3} s, {:.3} s at {} Hz",
            files.join(" and "),
            time.len(),
            last - first,
            shown(rate(time))
        ),
        sections: vec![
            Section::new("Channels", vec![Block::Table(table)]),
            Section::new("Notes", notes.collect()),
        ],
        ..Document::default()
    }
}

/// Samples a second, in the median [Hz].
pub(super) fn rate(time: &[f64]) -> f64 {
    let step = median_step(time);
    if step > 0.0 { 1.0 / step } else { 0.0 }
}

/// The longest gaps of each log, which its channels share.
fn gaps(found: &[Finding]) -> Vec<String> {
    let mut reported: Vec<[f64; 2]> = Vec::new();
    let mut said = Vec::new();
    for finding in found {
        for &[from, to] in finding.gaps.iter().take(LISTED) {
            if reported.contains(&[from, to]) {
                continue;
            }
            reported.push([from, to]);
            let others = match finding.gaps.len() {
                0..=LISTED => String::new(),
                count => format!(", one of {count}"),
            };
            let (length, channel) = (to - from, &finding.quantity);
            said.push(format!(
                "Gap of {length:.3} s from {from:.3} s in {channel}{others}."
            ));
        }
    }
    said
}

/// A channel in numbers.
fn row(finding: &Finding) -> Vec<Cell> {
    let is_empty = finding.missing == finding.samples;
    let number = |value: Option<f64>| match value {
        Some(value) if !is_empty => Cell::from(shown(value)),
        _ => Cell::default(),
    };
    let noise = match (finding.noise, finding.quantum) {
        (Some(noise), Some(step)) if noise < step => Cell::from("below a step"),
        (noise, _) => number(noise),
    };
    vec![
        finding.quantity.as_str().into(),
        finding.unit.into(),
        number(Some(finding.rate)),
        number(Some(finding.least)),
        number(Some(finding.most)),
        noise,
        number(finding.quantum),
    ]
}

/// What else there is to know of a channel.
fn remarks_on(finding: &Finding) -> Vec<String> {
    let (missing, samples) = (finding.missing, finding.samples);
    let empty = match missing {
        0 => None,
        _ if missing == samples => Some("empty".to_owned()),
        _ => Some(format!("{missing} of {samples} samples empty")),
    };
    let logged = (finding.logged_in != finding.unit && missing < samples)
        .then(|| format!("logged in {}", finding.logged_in));
    let cut = finding.cut_off_at.iter();
    let cut = cut.map(|value| {
        format!(
            "stays at its extreme value {}: cut off there?",
            shown(*value)
        )
    });
    let doubts = finding.doubts.iter();
    let doubts = doubts.map(|doubt| format!("doubtful: {doubt}"));
    let said = empty.into_iter().chain(logged).chain(doubts).chain(cut);
    said.map(|said| format!("{}: {said}", finding.quantity))
        .collect()
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
    crate::quantity::significant(value, 4)
}

/// Remarks on a log's rows and clock.
pub(super) fn remarks(log: &LogNote) -> Vec<String> {
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
            Remark::Unstamped(lines) => format!(
                "rows whose stamp is 0, which is none, were left out: {}",
                rows(lines)
            ),
            Remark::Reversed => {
                "its rows go back in time, the newest first; they were turned round".to_owned()
            }
            Remark::Note(sentence) => sentence.clone(),
            Remark::Others(count) => format!("{count} rows are of other variables"),
            Remark::Hollow(count) => {
                format!("{count} rows hold nothing in the columns of the map, as those of another clock")
            }
            Remark::Strays(lines) => format!(
                "lines that are no rows were left out, as the map says: {}",
                strays(lines)
            ),
            Remark::Truncated(rest) => format!("{rest}; what is left was used, as the map accepts"),
            Remark::Unended(line) => {
                format!("its last line, {line}, does not end, and may lack the last digits of its last number")
            }
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

/// The first of the lines that were left out, with what stands in them.
fn strays(lines: &[Stray]) -> String {
    let first: Vec<String> = lines
        .iter()
        .take(LISTED)
        .map(|stray| format!("line {} `{}`", stray.line, stray.text))
        .collect();
    let more = if lines.len() > LISTED { ", ..." } else { "" };
    format!("{} ({}{more})", lines.len(), first.join(", "))
}

pub(super) fn name(path: &Path) -> String {
    let name = path.file_name().unwrap_or(path.as_os_str());
    name.to_string_lossy().into_owned()
}
