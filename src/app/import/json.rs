//! Interpretation of logs, for programs: `--json`. Numbers are in SI.

use serde::Serialize;

use super::summary::{Copies, Job, rate, remarks};
use crate::import::ImportMap;
use crate::import::findings::{Finding, findings};
use crate::recording::gaps::parts;

/// All of it.
#[derive(Debug, Serialize)]
struct Report {
    map: String,
    title: String,
    recordings: Vec<RecordingReport>,
    same_data: Vec<SameReport>,
}

/// A recording.
#[derive(Debug, Serialize)]
struct RecordingReport {
    written_to: Option<String>,
    /// Files of its parts, where gaps part it and that was asked for.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    parts_written_to: Vec<String>,
    /// Number of stretches without a gap.
    parts: usize,
    samples: usize,
    from_s: f64,
    to_s: f64,
    span_s: f64,
    rate_hz: f64,
    /// Origin of its times, in seconds since 1970; none where it is the logs' own start.
    origin_unix_s: Option<f64>,
    logs: Vec<LogReport>,
    channels: Vec<Finding>,
}

/// A log.
#[derive(Debug, Serialize)]
struct LogReport {
    file: String,
    rows_used: usize,
    rows_there: usize,
    remarks: Vec<String>,
    clock_found: Option<ClockReport>,
}

/// A clock that was found.
#[derive(Debug, Serialize)]
struct ClockReport {
    added_s: f64,
    correlation: f64,
    step_s: f64,
}

/// Two logs that are the same data.
#[derive(Debug, Serialize)]
struct SameReport {
    one: String,
    other: String,
    share: f64,
}

/// The report as JSON.
pub(super) fn report(
    map: &ImportMap,
    jobs: &[Job],
    copies: &[Copies],
) -> Result<String, serde_json::Error> {
    let recordings = jobs.iter().map(|job| recording(map, job));
    let same = copies.iter().map(|copies| SameReport {
        one: copies.one.display().to_string(),
        other: copies.other.display().to_string(),
        share: copies.share,
    });
    let report = Report {
        map: map.path.display().to_string(),
        title: map.title.clone(),
        recordings: recordings.collect(),
        same_data: same.collect(),
    };
    Ok(serde_json::to_string_pretty(&report)? + "\n")
}

fn recording(map: &ImportMap, job: &Job) -> RecordingReport {
    let imported = &job.imported;
    let time = imported.recording.time();
    let logs = imported.logs.iter().map(|log| LogReport {
        file: log.file.display().to_string(),
        rows_used: log.rows[0],
        rows_there: log.rows[1],
        remarks: remarks(log),
        clock_found: log.alignment.map(|found| ClockReport {
            added_s: found.offset,
            correlation: found.correlation,
            step_s: found.step,
        }),
    });
    let outs = job.outs.iter().map(|(path, _)| path.display().to_string());
    let outs: Vec<String> = outs.collect();
    RecordingReport {
        written_to: match &outs[..] {
            [only] => Some(only.clone()),
            _ => None,
        },
        parts: parts(time).len(),
        parts_written_to: if outs.len() > 1 { outs } else { Vec::new() },
        samples: time.len(),
        from_s: time[0],
        to_s: time[time.len() - 1],
        span_s: time[time.len() - 1] - time[0],
        rate_hz: rate(time),
        origin_unix_s: (imported.origin != 0.0).then_some(imported.origin),
        logs: logs.collect(),
        channels: findings(imported, map),
    }
}
