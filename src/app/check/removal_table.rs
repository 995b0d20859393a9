//! A table of runs explained: its file and the tables that it names.

use std::path::Path;

use super::super::error::AppError;
use super::report::{Report, shown};
use crate::case::{RIG, RemovalCase};
use crate::quantity::counted;
use crate::shell::word;

/// The file, or the folder with it.
pub(super) fn removal_table(path: &Path) -> Result<Report, AppError> {
    let file = match path.is_dir() {
        true => path.join(RIG),
        false => path.to_owned(),
    };
    let case = RemovalCase::from_file(&file, String::new())?;
    let table = &case.file;
    let kind = "a table of runs: what a tool took off at which settings";
    let title = Some(table.title.as_str()).filter(|title| !title.is_empty());
    let mut report = Report::new(path, kind, title);
    let mut rows = format!("{} to diagnose from", counted(case.rows.len(), "row"));
    if !case.unseen.is_empty() {
        rows += &format!(", {} to be predicted", case.unseen.len());
    }
    report.fact("rows", rows);
    let time = if table.is_feed { "feed" } else { "time" };
    let columns = [
        ("force", Some(&table.force)),
        (time, table.time.as_ref()),
        ("speed", table.speed.as_ref()),
        ("area", table.area.as_ref()),
        ("wear", table.wear.as_ref()),
        ("volume", Some(&table.volume)),
    ];
    let known = columns
        .into_iter()
        .filter_map(|(what, column)| Some((what, column?)));
    for (what, column) in known {
        let unit = match column.unit.as_str() {
            "" => String::new(),
            unit => format!(", in {unit}"),
        };
        report.fact("columns", format!("{what} from {}{unit}", column.name));
    }
    let [force, time, speed, area] = table.nominal.exponents.map(shown);
    let mut law = format!("exponents of force {force}, time {time}, speed {speed}, area {area}");
    if table.nominal.threshold > 0.0 {
        law += &format!(", above {} N", shown(table.nominal.threshold));
    }
    report.fact("nominal law", law);
    report.number("rows", case.rows.len());
    report.number("rows_to_predict", case.unseen.len());
    let folder = file.parent().unwrap_or(Path::new(""));
    for (what, names) in [("runs", &table.fit), ("runs to predict", &table.predict)] {
        for name in names {
            report.file(what, &folder.join(name));
        }
    }
    let folder = match folder.as_os_str().is_empty() {
        true => Path::new("."),
        false => folder,
    };
    report.next(match file.ends_with(RIG) {
        true => format!("idc diagnose {}", word(folder)),
        false => format!("idc diagnose FOLDER, in which it stands as {RIG}"),
    });
    Ok(report)
}
