//! A rig file explained, and a case of `idc diagnose`: a rig file with the recordings that it names.

use std::path::Path;

use super::super::error::AppError;
use super::report::{Report, shown};
use crate::case::{Case, CaseError, read_in_any_unit, read_rig, rig_of, to_fit};
use crate::diagnosis::recordings::input::{DiagnosisInput, prepare};
use crate::diagnosis::recordings::recorded::{COLUMNS, recorded_of};
use crate::plant::{DeviceParts, InitialState};
use crate::recording::thousandfold::thousandfold;
use crate::scenario::rig_file::{RigFile, load_rig};
use crate::shell::word;
use crate::stats::median_step;

/// Share by which a recording's rate may differ from the sheet's.
const OTHER_RATE: f64 = 0.05;

/// A rig file alone.
pub(super) fn rig(file: &Path) -> Result<Report, AppError> {
    let rig = load_rig(file)?;
    let mut report = Report::new(file, "a rig file: a device by its nominal values", None);
    describe(&mut report, &rig);
    let folder = file.parent().unwrap_or(Path::new(""));
    for name in rig.fit.iter().filter(|name| !name.contains('*')) {
        report.file("recording to diagnose from", &folder.join(name));
    }
    if let Some(name) = &rig.predict {
        report.file("recording to predict", &folder.join(name));
    }
    if rig.fit.is_empty() {
        report.note("`recordings.fit` names no recording; idc diagnose asks for one at least");
    }
    report.next(format!("idc predict {} RECORDING", word(file)));
    Ok(report)
}

/// A folder with a rig file and its recordings, read as `idc diagnose` would.
pub(super) fn case(folder: &Path) -> Result<Report, AppError> {
    let rig = rig_of(folder)?;
    let mut report = Report::new(
        folder,
        "a case to diagnose: a rig file and recordings",
        None,
    );
    describe(&mut report, &rig);
    let names = to_fit(&rig, folder)?;
    let case = Case::from_folder(folder)?;
    for name in &names {
        recording(&mut report, &rig, folder, name, "to diagnose from")?;
    }
    if let Some(name) = &rig.predict {
        recording(&mut report, &rig, folder, name, "to be predicted")?;
    }
    report.number("recordings", names.len());
    if let Some(input) = case.input() {
        conditions(&mut report, input)?;
    }
    report.next(format!("idc diagnose {} --out DIR", word(folder)));
    Ok(report)
}

/// How the recordings to diagnose from differ from those of a laboratory, which start at rest and measure all, with the noise that the file states.
fn conditions(report: &mut Report, input: &DiagnosisInput) -> Result<(), AppError> {
    let prepared = prepare(input).map_err(CaseError::from)?;
    let starts = (prepared.evidence.recordings.iter())
        .filter(|measured| measured.inputs.initial == InitialState::AtRest)
        .count();
    let all = prepared.evidence.recordings.len();
    report.fact(
        "start",
        format!("{starts} of {all} recordings begin at rest"),
    );
    report.number("begin_at_rest", starts);
    for note in prepared.notes {
        report.note(note);
    }
    Ok(())
}

fn describe(report: &mut Report, rig: &RigFile) {
    let plant = &rig.plant;
    if plant.parts == DeviceParts::Whole {
        report.device(&plant.device);
    } else {
        report.fact(
            "part",
            format!("{} alone ([rig] chain)", plant.parts.name()),
        );
    }
    let tolerances: Vec<String> = (rig.tolerances.iter())
        .map(|t| format!("{} to {} %", t.key, shown(t.tolerance * 100.0)))
        .collect();
    if !tolerances.is_empty() {
        report.fact("nominal", tolerances.join(", "));
    }
    for present in &rig.effects {
        report.fact("effect", present.effect.name);
    }
    if let Some(latent) = &plant.latent {
        let variable = latent.variable.name();
        report.fact("latent", format!("a model discrepancy over {variable}"));
    }
    if plant.parts == DeviceParts::Whole {
        report.fact("rate", format!("{} Hz", shown(rig.rate)));
        report.number("rate_hz", rig.rate);
        let absent = COLUMNS
            .iter()
            .zip(rig.sensors())
            .filter(|(_, there)| !there);
        let absent: Vec<&str> = absent.map(|(column, _)| *column).collect();
        if !absent.is_empty() {
            let absent = absent.join(", ");
            report.fact(
                "no sensor of",
                format!("{absent} ([sensors] does not name it)"),
            );
        }
    }
}

/// One recording, as far as a reader of it needs to know.
fn recording(
    report: &mut Report,
    rig: &RigFile,
    folder: &Path,
    name: &str,
    what: &str,
) -> Result<(), AppError> {
    let path = folder.join(name);
    let parts = rig.plant.parts;
    // The case was read: a column in another unit is one of its faults.
    let read = read_rig(parts, &path).or_else(|e| read_in_any_unit(parts, &path).ok_or(e))?;
    let time = read.time();
    let span = time.last().unwrap_or(&0.0) - time.first().unwrap_or(&0.0);
    let mut measured = String::new();
    if rig.plant.parts != DeviceParts::ContactFlange {
        let file = path.display().to_string();
        let taken = recorded_of(rig.plant.parts, &file, &read)?.of_sensors(rig.sensors());
        let there = |channel: &usize| taken.readings[*channel].iter().any(|v| v.is_finite());
        let columns: Vec<&str> = (0..COLUMNS.len())
            .filter(there)
            .map(|channel| COLUMNS[channel])
            .collect();
        measured = match columns.is_empty() {
            true => "; nothing measured".to_owned(),
            false => format!("; measured: {}", columns.join(", ")),
        };
    }
    let samples = read.sample_count();
    let step = median_step(time);
    if rig.plant.parts == DeviceParts::Whole && step > 0.0 {
        let rate = 1.0 / step;
        if (rate / rig.rate - 1.0).abs() > OTHER_RATE {
            report.note(format!(
                "{name} has {} samples a second, rig.toml says {} (`rate_hz` in [sensors]): correct the one that is wrong; if it is the recording's, its times are in another unit than was said",
                shown(rate),
                shown(rig.rate)
            ));
        }
    }
    for channel in read.channels() {
        if let Some(fallen) = thousandfold(&channel.values) {
            let column = &channel.quantity;
            report.note(format!(
                "{name}: `{column}` falls to a thousandth from one sample to the next {} times, the first at {} s from {} to {}, and never goes beyond: \
                 a thousands mark was read as a decimal mark; import the log again with `thousands_mark` in its map",
                fallen.count,
                shown(time[fallen.first]),
                shown(channel.values[fallen.first - 1]),
                shown(channel.values[fallen.first])
            ));
        }
    }
    report.fact(
        "recording",
        format!(
            "{name}, {what}: {samples} samples in {} s{measured}",
            shown(span)
        ),
    );
    report.file(what, &path);
    Ok(())
}
