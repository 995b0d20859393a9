//! The workpiece's part of a scenario file.

use super::file::{self, BurrKeys, BurrKind, USUAL_ROOT};
use super::{BurrScenario, ChamferScenario, EdgeChoice, EdgeSelection, WorkpieceScenario};
use crate::keys::check::{Section, pose};
use crate::keys::error::ScenarioError;

/// `[workpiece]` and the tables in it.
pub(super) fn workpiece(
    section: &Section<'_>,
    keys: &file::WorkpieceKeys,
) -> Result<WorkpieceScenario, ScenarioError> {
    let table = |name: &str| Section::new(section.document(), format!("workpiece.{name}"));
    let burr_table = keys.burr.as_ref();
    let burr = burr_table
        .map(|keys| burr(&table("burr"), keys))
        .transpose()?;
    Ok(WorkpieceScenario {
        mesh: section.file("mesh", &keys.mesh)?,
        mesh_scale: keys.mesh_unit.length(),
        world_from_part: pose(keys.position, keys.rotation),
        edge: edge(&table("edge"), &keys.edge)?,
        misplacement: keys.misplacement,
        burr: burr.unwrap_or(BurrScenario::None),
        burr_root: burr_table.map_or(USUAL_ROOT, |burr| burr.root),
        chamfer: chamfer(&table("chamfer"), &keys.chamfer)?,
    })
}

fn edge(section: &Section<'_>, keys: &file::EdgeKeys) -> Result<EdgeChoice, ScenarioError> {
    let selection = match (keys.edge, keys.closed_loop) {
        (Some(edge), None) => EdgeSelection::Edge(edge),
        (None, Some(number)) => EdgeSelection::Loop(number),
        (None, None) => {
            return Err(section.missing("edge", "edge or loop, a number from `idc edges`"));
        }
        (Some(_), Some(_)) => {
            let reason = "`workpiece.edge.edge` is given too, expected one of the two".to_owned();
            return Err(section.misplaced("loop", reason));
        }
    };
    if let Some(end) = keys.end
        && end <= keys.start
    {
        let expected = format!("more than start_mm, {} mm", keys.start * 1e3);
        return Err(section.refuse_si("end_mm", end, expected));
    }
    Ok(EdgeChoice {
        selection,
        start: keys.start,
        end: keys.end,
        reversed: keys.reversed,
        sharp_angle: keys.sharp_angle,
    })
}

/// Leg and burr within which an edge is good; without bounds anything is.
fn chamfer(
    section: &Section<'_>,
    keys: &file::ChamferKeys,
) -> Result<ChamferScenario, ScenarioError> {
    if keys.leg_min >= keys.leg_max {
        let expected = format!("more than leg_min_mm, {} mm", keys.leg_min * 1e3);
        return Err(section.refuse_si("leg_max_mm", keys.leg_max, expected));
    }
    Ok(ChamferScenario {
        leg: [keys.leg_min, keys.leg_max],
        residual_burr: keys.residual_burr,
    })
}

fn burr(section: &Section<'_>, keys: &BurrKeys) -> Result<BurrScenario, ScenarioError> {
    section.of_kind::<BurrKeys>(None)?;
    // What a kind needs is there by now.
    let needed = |value: Option<f64>| value.unwrap_or_default();
    Ok(match keys.kind {
        BurrKind::None => BurrScenario::None,
        BurrKind::Constant => BurrScenario::Constant {
            height: needed(keys.height),
        },
        BurrKind::Random => {
            let mean_height = needed(keys.mean_height);
            BurrScenario::Random {
                seed: keys.seed,
                mean_height,
                height_deviation: keys.standard_deviation.unwrap_or(mean_height / 3.0),
                correlation_length: needed(keys.correlation_length),
            }
        }
        BurrKind::Bump => BurrScenario::Bump {
            position: needed(keys.position),
            height: needed(keys.height),
            width: needed(keys.width),
        },
        BurrKind::Table => BurrScenario::Table {
            path: section.file("path", &keys.path.clone().unwrap_or_default())?,
        },
    })
}
