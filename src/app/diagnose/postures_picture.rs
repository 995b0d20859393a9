//! fit.svg of still postures: what is left of force and torque in each, as declared and as found.

use super::super::error::AppError;
use crate::document::{Figure, Horizontal, Panel, Role, Series, Stroke};
use crate::figure::svg;

/// The picture; `left` by channel, as declared and as found.
pub(super) fn picture(left: &[[Vec<f64>; 6]; 2]) -> Result<String, AppError> {
    let panel = |title: &str, unit: &str, first: usize| {
        let series = |channels: &[Vec<f64>; 6], label: &str, role| {
            let own = &channels[first..first + 3];
            let sizes: Vec<f64> = (0..own[0].len())
                .map(|row| own.iter().map(|c| c[row] * c[row]).sum::<f64>().sqrt())
                .collect();
            let rows = (1..=sizes.len()).map(|row| row as f64).collect::<Vec<_>>();
            Series::new(label, rows, sizes, role, Stroke::Points)
        };
        Panel {
            title: title.to_owned(),
            vertical_label: format!("measured - predicted [{unit}]"),
            horizontal: Horizontal::Quantity("posture".to_owned()),
            series: vec![
                series(&left[0], "as declared", Role::Command),
                series(&left[1], "with what was found", Role::Estimate),
            ],
            ..Panel::default()
        }
    };
    let mut panels = vec![panel("Size of what is left of the force", "N", 0)];
    if left[1][3].iter().any(|torque| torque.is_finite()) {
        panels.push(panel("Size of what is left of the torque", "N m", 3));
    }
    Ok(svg(&Figure {
        title: "What is left of a wrench sensor's readings".to_owned(),
        panels,
    })?)
}
