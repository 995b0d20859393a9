//! The part in the cell: its nominal and its actual pose, the followed edge and the burr on it.

use std::path::Path;

use glam::{DQuat, DVec3};
use glamx::DPose3;

use super::error::{CellError, millimetres};
use crate::plant::EdgeStation;
use crate::removal::EdgeState;
use crate::scenario::{
    BurrScenario, EdgeChoice, EdgeSelection, Misplacement, Scenario, WorkpieceScenario,
};
use crate::workpiece::{
    BurrProfile, Convexity, EdgeCurve, EdgeSearch, RiddenProfile, TriangleMesh, WorkpieceError,
    list_edges, load_mesh,
};

/// Spacing at which the ball's ride over the burr is tabulated [m].
const RIDE_STEP: f64 = 2e-5;

/// The part.
pub struct Part {
    /// Its mesh, in the part frame.
    pub mesh: TriangleMesh,
    /// Its mesh where it really is, in the world frame.
    pub mesh_in_world: TriangleMesh,
    /// Where it really is.
    pub world_from_part: DPose3,
    /// The followed edge, in the part frame, in the direction of travel.
    pub edge: EdgeCurve,
    /// Lift of the ball's centre by the burr along the followed edge; none without a burr.
    pub ride: Option<RiddenProfile>,
    /// The followed edge as it comes to the cell.
    pub edge_state: EdgeState,
}

impl Part {
    /// Loads the mesh, finds the edge and prepares the burr for the tool's ball.
    ///
    /// # Errors
    /// A fault of the mesh, the choice of the edge or the burr.
    pub fn load(scenario: &Scenario) -> Result<Self, CellError> {
        let workpiece = &scenario.workpiece;
        let mesh = load_mesh(&workpiece.mesh, workpiece.mesh_scale)?;
        let edge = choose_edge(&scenario.path, workpiece, &mesh)?;
        let world_from_part = real_pose(workpiece, &edge);
        let vertices = mesh
            .vertices()
            .iter()
            .map(|&v| world_from_part.transform_point(v))
            .collect();
        let mesh_in_world = TriangleMesh::new(vertices, mesh.triangles().to_vec())
            .expect("a rigid motion keeps a mesh closed and outward");
        let fault = |source| CellError::Burr {
            file: scenario.path.clone(),
            source,
        };
        let burr = burr(&workpiece.burr).map_err(fault)?;
        let ridden = |burr| ride(burr, scenario.nominal.mounting.tool_radius, edge.length);
        let ride = burr.as_ref().map(ridden).transpose().map_err(fault)?;
        let edge_state = EdgeState::new(&edge, burr.as_ref(), workpiece.burr_root);
        Ok(Self {
            mesh,
            mesh_in_world,
            world_from_part,
            edge,
            ride,
            edge_state,
        })
    }
}

/// The edge that a scenario file chooses of a mesh.
///
/// # Errors
/// There is no such edge, it is an inside one, or shorter than the stretch chosen.
pub fn choose_edge(
    file: &Path,
    workpiece: &WorkpieceScenario,
    mesh: &TriangleMesh,
) -> Result<EdgeCurve, CellError> {
    let choice = &workpiece.edge;
    let search = EdgeSearch {
        sharp_angle: choice.sharp_angle,
        ..EdgeSearch::default()
    };
    let list = list_edges(mesh, &search);
    let (chosen, found) = match choice.selection {
        EdgeSelection::Edge(number) => (format!("edge {number}"), list.edges.get(number)),
        EdgeSelection::Loop(number) => (format!("loop {number}"), list.loops.get(number)),
    };
    let curve = found.ok_or_else(|| CellError::EdgeUnknown {
        file: file.to_owned(),
        mesh: workpiece.mesh.clone(),
        chosen: chosen.clone(),
        edges: list.edges.len(),
        loops: list.loops.len(),
    })?;
    let convexity = match curve.convexity {
        Convexity::Convex => None,
        Convexity::Concave => Some("an inside edge"),
        Convexity::Mixed => Some("an inside edge in places"),
    };
    if let Some(convexity) = convexity {
        let file = file.to_owned();
        return Err(CellError::EdgeNotConvex {
            file,
            mesh: workpiece.mesh.clone(),
            chosen,
            convexity,
        });
    }
    let curve = if choice.reversed {
        curve.reversed()
    } else {
        curve.clone()
    };
    check_stretch(file, choice, &curve)?;
    match (choice.start, choice.end) {
        (0.0, None) => Ok(curve),
        (start, None) if curve.closed => Ok(curve.started_at(start)?),
        (start, end) => Ok(curve.trim(start, end.unwrap_or(curve.length))?),
    }
}

/// The stretch must lie on the edge, up to once round a closed one.
fn check_stretch(file: &Path, choice: &EdgeChoice, curve: &EdgeCurve) -> Result<(), CellError> {
    let refuse = |key, value, expected| {
        Err(CellError::EdgeStretch {
            file: file.to_owned(),
            key,
            value,
            expected,
        })
    };
    let length = millimetres(curve.length);
    if choice.start >= curve.length {
        return refuse(
            "start_mm",
            choice.start,
            format!("less than the edge's length, {length} mm"),
        );
    }
    let (last, what) = if curve.closed {
        (choice.start + curve.length, "once round from start_mm")
    } else {
        (curve.length, "the edge's length")
    };
    match choice.end {
        Some(end) if end > last + 1e-9 => refuse(
            "end_mm",
            end,
            format!("at most {what}, {} mm", millimetres(last)),
        ),
        _ => Ok(()),
    }
}

/// The nominal pose turned and shifted about the middle of the edge.
fn real_pose(workpiece: &WorkpieceScenario, edge: &EdgeCurve) -> DPose3 {
    let Misplacement { shift, tilt } = workpiece.misplacement;
    let nominal = workpiece.world_from_part;
    let middle = edge.at(0.5 * edge.length);
    let (pivot, bisector) = (
        nominal.transform_point(middle.point),
        nominal.rotation * middle.bisector,
    );
    let tangent = nominal.rotation * middle.tangent;
    // Turning the tangent towards the bisector lifts the far end towards the tool.
    let turn = DQuat::from_axis_angle(tangent.cross(bisector).normalize_or(DVec3::X), tilt);
    DPose3::from_translation(pivot + bisector * shift)
        * DPose3::from_rotation(turn)
        * DPose3::from_translation(-pivot)
        * nominal
}

/// Lift of the ball's centre by a burr along an edge of a length [m].
fn ride(
    burr: &BurrProfile,
    ball_radius: f64,
    length: f64,
) -> Result<RiddenProfile, WorkpieceError> {
    burr.require_cover(length)?;
    burr.ridden_by_ball(ball_radius, length, RIDE_STEP)
}

fn burr(scenario: &BurrScenario) -> Result<Option<BurrProfile>, WorkpieceError> {
    Ok(match scenario {
        BurrScenario::None => None,
        BurrScenario::Constant { height } => Some(BurrProfile::constant(*height)?),
        BurrScenario::Random {
            seed,
            mean_height,
            height_deviation,
            correlation_length,
        } => Some(BurrProfile::seeded_random(
            *seed,
            *mean_height,
            *height_deviation,
            *correlation_length,
        )?),
        BurrScenario::Bump {
            position,
            height,
            width,
        } => Some(BurrProfile::bump(*position, *height, *width)?),
        BurrScenario::Table { path } => Some(BurrProfile::from_csv(path)?),
    })
}

/// A place on an edge [m] in the world.
pub fn station(edge: &EdgeCurve, world_from_part: DPose3, place: f64) -> EdgeStation {
    let place = place.clamp(0.0, edge.length);
    let point = edge.at(place);
    EdgeStation {
        point: world_from_part.transform_point(point.point),
        tangent: world_from_part.rotation * point.tangent,
        bisector: (world_from_part.rotation * point.bisector).normalize_or(DVec3::Z),
        station: place,
    }
}
