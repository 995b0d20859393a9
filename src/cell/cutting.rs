//! Whether the tool, as it stands on the edge, can cut at all.

use super::error::CellError;
use super::setup::passes;
use crate::path::{Pass, ToolPath};
use crate::removal::ToolShape;
use crate::scenario::Scenario;

/// Share of a tool's largest speed below which it rubs and does not cut [1]: within 3 degrees of a ball's pole.
const LEAST_SPEED_SHARE: f64 = 0.05;
/// Largest angle between a cone's flank and the edge's bisecting plane's normal at which the flank still lies on the edge [rad].
const FLANK_TOLERANCE: f64 = 0.175;

/// The tool must turn where it touches, with its flank on the edge and with a torque that its spindle has.
pub(super) fn check(scenario: &Scenario, tool_path: &ToolPath) -> Result<(), CellError> {
    let Some(tool) = &scenario.tool else {
        return Ok(());
    };
    let station = tool_path.at(0.5 * tool_path.length());
    let axis = (tool.tool).spindle_axis(station.axis, station.normal, station.tangent);
    let file = || scenario.path.clone();
    // Angle between the spindle's axis, from it to the tip, and the way into the part.
    let angle = axis.dot(-station.normal).clamp(-1.0, 1.0).acos();
    match tool.tool.shape {
        ToolShape::Cone { half_angle, .. } => {
            let needed = std::f64::consts::FRAC_PI_2 - half_angle;
            if (angle - needed).abs() > FLANK_TOLERANCE {
                return Err(CellError::ConeOffEdge {
                    file: file(),
                    angle,
                    needed,
                });
            }
        }
        ToolShape::Ball { .. } | ToolShape::Belt { .. } => {
            if angle.sin() < LEAST_SPEED_SHARE {
                return Err(CellError::ToolDoesNotCut {
                    file: file(),
                    angle,
                });
            }
        }
    }
    let radius = tool.tool.contact_radius(axis, station.normal);
    let speed = tool.spindle.free_speed * radius;
    for (index, Pass { force, .. }) in passes(scenario).into_iter().enumerate() {
        let (cutting, rate) = match &scenario.removal {
            Some(removal) => {
                let area = removal.contact_area;
                let rate = removal.law.removal_rate(force, speed, area, 0.0);
                (removal.cutting.tangential(rate, speed, force), rate)
            }
            None => (scenario.nominal.cell.friction * force, 0.0),
        };
        let torque = cutting * radius;
        if torque >= tool.spindle.stall_torque {
            return Err(CellError::SpindleStalls {
                file: file(),
                pass: index + 1,
                force,
                torque,
                stall_torque: tool.spindle.stall_torque,
                rate,
            });
        }
    }
    Ok(())
}
