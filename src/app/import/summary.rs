//! Interpretation of a log, for people.

use std::fmt::Write;
use std::ops::Range;
use std::path::{Path, PathBuf};

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
pub(super) fn described(imported: &Imported, map: &ImportMap) -> String {
    let mut text = String::new();
    let time = imported.recording.time();
    let mut files: Vec<String> = imported
        .logs
        .iter()
        .map(|log| log.file.display().to_string())
        .collect();
    // Clocks of one log stand behind each other.
    files.dedup();
    let _ = writeln!(
        text,
        "{}: {} samples from {:.3} to {:.3} s, {:.3} s at {} Hz",
        files.join(" and "),
        time.len(),
        time[0],
        time[time.len() - 1],
        time[time.len() - 1] - time[0],
        shown(rate(time))
    );
    let found = findings(imported, map);
    let wide = found.iter().map(|f| f.quantity.len()).max().unwrap_or(0);
    for finding in &found {
        let _ = writeln!(text, "  {}", line(finding, wide));
        for doubt in &finding.doubts {
            let _ = writeln!(text, "    doubtful: {doubt}");
        }
        for value in &finding.cut_off_at {
            let _ = writeln!(
                text,
                "    stays at its extreme value {}: cut off there?",
                shown(*value)
            );
        }
    }
    if imported.origin != 0.0 {
        let _ = writeln!(
            text,
            "  its times count from {:.0} s since 1970",
            imported.origin
        );
    }
    for log in &imported.logs {
        let [used, there] = log.rows;
        let of = match imported.logs.len() {
            1 => String::new(),
            _ => format!(", of {}", log.quantities.join(", ")),
        };
        let _ = writeln!(
            text,
            "  {}: {used} of {there} rows used{of}",
            name(&log.file)
        );
        for remark in remarks(log) {
            let _ = writeln!(text, "  {}: {remark}", name(&log.file));
        }
    }
    let several = parts(time).len();
    if several > 1 {
        let _ = writeln!(
            text,
            "  gaps part it into {several} recordings: `idc diagnose` takes none with a gap longer than {} s, `--split` writes each part by itself",
            shown(longest_pause(time))
        );
    }
    text + &gaps(&found)
}

/// Samples a second, in the median [Hz].
pub(super) fn rate(time: &[f64]) -> f64 {
    let step = median_step(time);
    if step > 0.0 { 1.0 / step } else { 0.0 }
}

/// The longest gaps of each log, which its channels share.
fn gaps(found: &[Finding]) -> String {
    let mut text = String::new();
    let mut reported: Vec<[f64; 2]> = Vec::new();
    for finding in found {
        let longest = finding.gaps.iter().take(LISTED);
        let fresh: Vec<[f64; 2]> = longest
            .filter(|gap| !reported.contains(gap))
            .copied()
            .collect();
        for [from, to] in fresh {
            let _ = writeln!(
                text,
                "  gap of {:.3} s from {from:.3} s in {}{}",
                to - from,
                finding.quantity,
                match finding.gaps.len() {
                    0..=LISTED => String::new(),
                    count => format!(", one of {count}"),
                }
            );
            reported.push([from, to]);
        }
    }
    text
}

/// A channel in a line.
fn line(finding: &Finding, wide: usize) -> String {
    if finding.missing == finding.samples {
        return format!("{:<wide$}  empty", finding.quantity);
    }
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
