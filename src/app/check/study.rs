//! A design study, an import map and a device model explained.

use std::path::Path;

use super::super::error::AppError;
use super::report::{Report, shown};
use crate::design::{self, Domain};
use crate::import::load_map;
use crate::import::map::{Clock, Form};
use crate::quantity::counted;
use crate::scenario::{load_any, load_device};
use crate::shell::word;

/// A design study.
pub(super) fn study(file: &Path) -> Result<Report, AppError> {
    let study = design::load(file)?;
    let mut report = Report::new(file, "a design study", Some(&study.title));
    for variable in &study.variables {
        let range = match &variable.domain {
            Domain::Linear(low, high) => format!("{} to {}", shown(*low), shown(*high)),
            Domain::Logarithmic(low, high) => {
                format!("{} to {}, in ratios", shown(*low), shown(*high))
            }
            Domain::Catalogue(entries) => format!("one of {} catalogue values", entries.len()),
        };
        let start = shown(variable.start);
        report.fact("varied", format!("{}: {range}, from {start}", variable.key));
    }
    report.fact("minimised", study.objective.metric.as_str());
    if let Some(key) = study.trade_off_key() {
        let front = format!("against {key}, {} points of the front", study.front_points);
        report.fact("traded off", front);
    }
    for limit in &study.limits {
        let side = match limit.side {
            design::Side::Min => "at least",
            design::Side::Max => "at most",
        };
        let bound = shown(limit.bound);
        report.fact("limits", format!("{} {side} {bound}", limit.key()));
    }
    let scenarios = study.scenarios.len();
    report.fact(
        "extent",
        format!(
            "at most {} designs, each in {}",
            study.evaluations,
            counted(scenarios, "scenario")
        ),
    );
    report.number("evaluations", study.evaluations);
    report.number("scenarios", scenarios);
    for scenario in &study.scenarios {
        load_any(scenario)?;
        report.file("scenario", scenario);
    }
    report.next(format!("idc design {}", word(file)));
    Ok(report)
}

/// An import map.
pub(super) fn map(file: &Path) -> Result<Report, AppError> {
    let map = load_map(file)?;
    let kind = "an import map: what the columns of a log are";
    let mut report = Report::new(file, kind, Some(&map.title));
    for log in &map.files {
        let form = match &log.form {
            Form::Text(_) => "a text",
            Form::Parquet => "Parquet",
            Form::Mat5 => "MATLAB",
            Form::Bag => "a bag",
            Form::Tdms => "TDMS",
            Form::Spreadsheet { .. } => "a spreadsheet",
        };
        let clock = match &log.clock {
            Clock::Shared { .. } => "",
            Clock::Unknown { .. } => ", its clock off by what is to be found",
        };
        let time = match &log.time {
            None if log.form == Form::Tdms => "times of its waveforms".to_owned(),
            None if log.sample_rate.is_none() => "times at which messages were logged".to_owned(),
            None => String::new(),
            Some(time) => format!("times in {}", time.column),
        };
        let rate = log
            .sample_rate
            .map(|rate| format!("{} samples a second", shown(rate)));
        let rows = log.rows.as_ref();
        let rows = rows.map(|rows| format!("rows with `{}` in {}", rows.value, rows.column));
        let said = [Some(time), rate, rows].into_iter().flatten();
        let said: Vec<String> = said.filter(|text| !text.is_empty()).collect();
        let form = if log.same_log { "the same log" } else { form };
        report.fact("log", format!("{form}, {}{clock}", said.join(", ")));
        for channel in &log.channels {
            let text = format!(
                "{} from {}, in {}",
                channel.quantity, channel.column, channel.unit.name
            );
            report.fact("channel", text);
        }
        if let Some(path) = &log.path {
            report.file("log", path);
        }
    }
    for constant in &map.constants {
        let value = if constant.value.is_nan() {
            "none".to_owned()
        } else {
            format!("{} {}", shown(constant.value), constant.unit.symbol())
        };
        report.fact("constant", format!("{}, {value}", constant.quantity));
    }
    report.number("logs", map.files.len());
    report.next(format!("idc import {} LOGS", word(file)));
    Ok(report)
}

/// A device model.
pub(super) fn model(file: &Path) -> Result<Report, AppError> {
    let (_, plant) = load_device(file)?;
    let kind = "a device model, for [device] model of a scenario";
    let mut report = Report::new(file, kind, None);
    report.device(&plant.device);
    report.next("idc new cell, whose [device] names it".to_owned());
    Ok(report)
}
