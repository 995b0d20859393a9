//! Whether the slide can follow the part to where it really lies.

use super::error::CellError;
use super::part::Part;
use crate::path::ToolPath;
use crate::scenario::Scenario;

/// Places along the edge at which that is looked at.
const LOOKS: usize = 200;

/// The slide must not reach an end of its stroke anywhere along the edge of a part that lies off its nominal pose.
pub(super) fn check(scenario: &Scenario, part: &Part, path: &ToolPath) -> Result<(), CellError> {
    if scenario.device.locked {
        return Ok(());
    }
    let nominal = scenario.workpiece.world_from_part;
    let length = path.length();
    let mut range = [f64::INFINITY, f64::NEG_INFINITY];
    for look in 0..=LOOKS {
        let station = path.at(length * look as f64 / LOOKS as f64);
        let really = part
            .world_from_part
            .transform_point(nominal.inverse_transform_point(station.point));
        let nearer = (really - station.point).dot(station.normal) / path.share(&station);
        let stroke = scenario.process.working_stroke - nearer;
        range = [range[0].min(stroke), range[1].max(stroke)];
    }
    let full_stroke = scenario.nominal.device.full_stroke;
    if range[0] > 0.0 && range[1] < full_stroke {
        return Ok(());
    }
    Err(CellError::ShiftBeyondStroke {
        file: scenario.path.clone(),
        shift: scenario.workpiece.misplacement.shift,
        tilt: scenario.workpiece.misplacement.tilt,
        from: range[0],
        to: range[1],
        full_stroke,
        working_stroke: scenario.process.working_stroke,
    })
}
