//! fit.svg: of a part of the device, each recording as measured, by the nominal and by the improved model, and the residual.

use super::super::error::AppError;
use crate::diagnosis::answer::finding::Diagnosis;
use crate::diagnosis::answer::words::{CHANNEL_UNITS, CHANNEL_WORDS};
use crate::document::{Figure, Horizontal, Panel, Role, Series, Stroke};
use crate::figure::svg;

/// Recordings drawn at most.
const MOST: usize = 4;

/// The picture, if a part of the device was diagnosed.
pub(super) fn picture(diagnosis: &Diagnosis) -> Result<Option<String>, AppError> {
    let Some(channel) = diagnosis.nominal.parts.output() else {
        return Ok(None);
    };
    let index = channel as usize;
    let (unit, factor) = CHANNEL_UNITS[index];
    let words = CHANNEL_WORDS[index];
    let scaled = |values: &[f64]| -> Vec<f64> { values.iter().map(|v| v * factor).collect() };
    let mut panels = Vec::new();
    let recordings = diagnosis.evidence.recordings.iter().enumerate().take(MOST);
    for (place, measured) in recordings {
        let start = measured.inputs.time[0];
        let time: Vec<f64> = measured.inputs.time.iter().map(|t| t - start).collect();
        let of = |readings: &[f64], label: &str, role, stroke| {
            Series::new(label, time.clone(), scaled(readings), role, stroke)
        };
        let nominal = &diagnosis.as_nominal.trajectories[place].readings[index];
        let found = &diagnosis.best().fit.prediction.trajectories[place].readings[index];
        let readings = &measured.readings[index];
        panels.push(Panel {
            title: measured.name.clone(),
            vertical_label: format!("{words} [{unit}]"),
            horizontal: Horizontal::Time,
            series: vec![
                of(readings, "measured", Role::Measured, Stroke::Plain),
                of(nominal, "nominal", Role::Command, Stroke::Dashed),
                of(found, "with what was found", Role::Estimate, Stroke::Plain),
            ],
            ..Panel::default()
        });
        let left = |model: &[f64]| -> Vec<f64> {
            readings.iter().zip(model).map(|(m, p)| m - p).collect()
        };
        panels.push(Panel {
            title: "left".to_owned(),
            vertical_label: format!("{words} [{unit}]"),
            horizontal: Horizontal::Time,
            series: vec![
                of(
                    &left(nominal),
                    "measured - nominal",
                    Role::Command,
                    Stroke::Raw,
                ),
                of(
                    &left(found),
                    "measured less found",
                    Role::Estimate,
                    Stroke::Plain,
                ),
            ],
            ..Panel::default()
        });
    }
    Ok(Some(svg(&Figure {
        title: "Before and after".to_owned(),
        panels,
    })?))
}
