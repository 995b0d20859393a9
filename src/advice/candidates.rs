//! What may help against which refusal, and in which order it is looked for.

use super::amounts;
use super::edge;
use super::kind::Kind;
use super::places;
use super::remedy::Remedy;
use super::trial::Trial;
use crate::cell::{CellError, Setup};
use crate::path::{Obstacle, PlanError};
use crate::scenario::Scenario;

/// Where a posture cannot be had: another one, then another place.
const POSTURE: [Kind; 6] = [
    Kind::Roll,
    Kind::Lean,
    Kind::PartMoved,
    Kind::Reversed,
    Kind::PartTurned,
    Kind::BaseMoved,
];

/// Kinds of change that may help, in the order in which they are looked for.
pub(super) fn kinds(scenario: &Scenario, refusal: &CellError) -> Vec<Kind> {
    let mut kinds = of_refusal(refusal);
    let process = &scenario.process;
    kinds.retain(|kind| match kind {
        Kind::Roll => process.roll.is_some(),
        Kind::Lean => process.tool_axis.is_none(),
        _ => true,
    });
    kinds
}

fn of_refusal(error: &CellError) -> Vec<Kind> {
    match error {
        CellError::Plan { source, .. } => of_plan(source),
        CellError::Penetration { names, .. } if names.iter().any(|name| name == "part") => {
            vec![Kind::PartMoved, Kind::PartTurned, Kind::BaseMoved]
        }
        CellError::Penetration { .. } => vec![Kind::BaseMoved],
        CellError::ToolDoesNotCut { .. } | CellError::ConeOffEdge { .. } => vec![Kind::Spindle],
        CellError::SpindleStalls { .. } => vec![Kind::LessForce, Kind::SpindleTorque],
        CellError::Weight { .. } => vec![
            Kind::Mass,
            Kind::OpposingPressure,
            Kind::MoreForce,
            Kind::Lean,
        ],
        CellError::Supply { .. } => vec![
            Kind::LessForce,
            Kind::SupplyPressure,
            Kind::Lean,
            Kind::Bore,
        ],
        CellError::EdgeNotConvex { .. } | CellError::EdgeUnknown { .. } => vec![Kind::Edge],
        CellError::EdgeStretch { .. } => vec![Kind::Stretch],
        CellError::BallTooLarge { .. } => vec![Kind::Ball, Kind::Stretch],
        CellError::ShiftBeyondStroke { .. } => vec![Kind::WorkingStroke, Kind::Located],
        _ => Vec::new(),
    }
}

fn of_plan(error: &PlanError) -> Vec<Kind> {
    let PlanError::Waypoint { obstacle, .. } = error else {
        return match error {
            PlanError::Lean { .. } => vec![Kind::ToolAxis],
            PlanError::InwardCorner { .. } => vec![Kind::Stretch],
            _ => vec![Kind::PartMoved, Kind::PartTurned],
        };
    };
    match obstacle {
        Obstacle::Velocity { .. } => vec![Kind::Feed, Kind::PartMoved],
        Obstacle::Effort { .. } => {
            let first = [Kind::Acceleration, Kind::LessForce];
            [&first[..], &POSTURE].concat()
        }
        Obstacle::Collision(meeting) => {
            let mut kinds = Vec::new();
            if meeting.depth < 0.0 && meeting.margin > 0.0 {
                kinds.push(Kind::Margin);
            }
            if meeting.names.iter().any(|name| name == "tool's ball") {
                kinds.extend([Kind::Ball, Kind::Stretch]);
            }
            kinds.push(Kind::Approach);
            kinds.extend(POSTURE);
            kinds
        }
        _ => POSTURE.to_vec(),
    }
}

/// The first change of a kind that passes check and run.
pub(super) fn remedy(
    kind: Kind,
    trial: &Trial<'_>,
    scenario: &Scenario,
    setup: Option<&Setup>,
    refusal: &CellError,
) -> Option<Remedy> {
    match kind {
        Kind::Roll => places::rolled(trial, setup?),
        Kind::Lean => places::leaned(trial, setup?),
        Kind::PartMoved => places::moved(trial, setup?),
        Kind::PartTurned => places::turned(trial, setup?),
        Kind::Located => places::located(trial, setup?),
        Kind::BaseMoved => places::base_moved(trial, setup?),
        Kind::ToolAxis => edge::tool_axis(trial, setup?),
        Kind::Reversed => edge::reversed(trial, scenario),
        Kind::Edge => edge::another(trial, scenario),
        Kind::Stretch => edge::stretch(trial, scenario, setup, refusal),
        kind => amounts::remedy(kind, trial, scenario, refusal),
    }
}
