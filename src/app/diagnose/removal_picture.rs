//! fit.svg of a table of runs: what came off over what the law says, against the force and against the feed or time, before and after.

use super::super::error::AppError;
use crate::diagnosis::removal::{RemovalDiagnosis, TableLaw, TableRow};
use crate::document::{Figure, Horizontal, Panel, Role, Series, Stroke};
use crate::figure::svg;

/// The picture of a table of runs with a feed, or with a grinding time.
pub(super) fn picture(diagnosis: &RemovalDiagnosis, is_feed: bool) -> Result<String, AppError> {
    let rows = &diagnosis.rows;
    let (other, setting): (&str, fn(&TableRow) -> f64) = match is_feed {
        true => ("feed [mm/s]", |row| 1e3 / row.time),
        false => ("grinding time [s]", |row| row.time),
    };
    let panel = |title: &str, label: &str, place: fn(&TableRow) -> f64| {
        let series = |name: &str, law: &TableLaw, role| {
            let places: Vec<f64> = rows.iter().map(place).collect();
            let ratios: Vec<f64> = rows
                .iter()
                .map(|row| (row.volume / law.volume_of(row)).ln())
                .collect();
            Series::new(name, places, ratios, role, Stroke::Points)
        };
        Panel {
            title: title.to_owned(),
            vertical_label: "ln(measured / predicted)".to_owned(),
            horizontal: Horizontal::Quantity(label.to_owned()),
            series: vec![
                series("nominal", &diagnosis.nominal, Role::Command),
                series("with what was found", &diagnosis.found, Role::Estimate),
            ],
            ..Panel::default()
        }
    };
    let panels = vec![
        panel("Removed volume, by force", "force [N]", |row| row.force),
        panel("Removed volume, by the other setting", other, setting),
    ];
    Ok(svg(&Figure {
        title: "What the law of removal leaves".to_owned(),
        panels,
    })?)
}
