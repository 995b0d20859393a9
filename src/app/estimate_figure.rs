//! The estimator in figures.svg of a bench run: its band about the force, and its error.

use crate::document::{Panel, Role, Series, Stroke};
use crate::recording::{Recording, schema};
use crate::stats::{NORMAL_95, median};

/// Both ends of the band; nothing without an estimator.
pub(super) fn band(recording: &Recording) -> Vec<Series<'_>> {
    let Some((estimated, deviation)) = estimate(recording) else {
        return Vec::new();
    };
    let end = |label: &str, side: f64| {
        let pairs = estimated.iter().zip(deviation);
        let values: Vec<f64> = pairs.map(|(e, d)| e + side * NORMAL_95 * d).collect();
        line(recording, label, values, Role::Band, Stroke::Raw)
    };
    vec![end("95 % band", -1.0), end("", 1.0)]
}

/// Estimate less truth with the band about zero, where the tool presses; nothing without an estimator.
///
/// The band is drawn up to `WIDEST` medians: at an impact it opens by orders of magnitude, and the rest would be a line.
pub(super) fn error_panel(recording: &Recording) -> Option<Panel<'_>> {
    const TOUCH_FORCE: f64 = 1.0;
    const WIDEST: f64 = 20.0;
    let (estimated, deviation) = estimate(recording)?;
    let force = &recording.channel(schema::CONTACT_FORCE)?.values;
    let pressed = force
        .iter()
        .zip(deviation)
        .filter(|(force, _)| **force > TOUCH_FORCE)
        .map(|(_, deviation)| *deviation);
    let widest = WIDEST * median(pressed)?;
    let shown = |i: usize| force[i] > TOUCH_FORCE && deviation[i] <= widest;
    let over = |of: &dyn Fn(usize) -> f64| -> Vec<f64> {
        let value = |i| if shown(i) { of(i) } else { f64::NAN };
        (0..force.len()).map(value).collect()
    };
    let end = |label: &str, side: f64| {
        let values = over(&|i| side * NORMAL_95 * deviation[i]);
        line(recording, label, values, Role::Band, Stroke::Plain)
    };
    let error = over(&|i| estimated[i] - force[i]);
    Some(Panel {
        title: "Estimate less truth".to_owned(),
        vertical_label: "error [N]".to_owned(),
        series: vec![
            end("95 % band", -1.0),
            end("", 1.0),
            line(recording, "error", error, Role::Estimate, Stroke::Plain),
        ],
        ..Panel::default()
    })
}

fn estimate(recording: &Recording) -> Option<(&[f64], &[f64])> {
    let values = |quantity| Some(recording.channel(quantity)?.values.as_slice());
    Some((
        values(schema::ESTIMATED_FORCE)?,
        values(schema::ESTIMATED_FORCE_DEVIATION)?,
    ))
}

fn line<'a>(
    recording: &'a Recording,
    label: &str,
    values: Vec<f64>,
    role: Role,
    stroke: Stroke,
) -> Series<'a> {
    Series::new(label, recording.time(), values, role, stroke)
}
