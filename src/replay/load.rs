//! From the scenario file of a recorded cell to what does not change between its recordings.

use crate::arm::chain::{JointKind, KinematicChain};
use crate::arm::load_arm;
use crate::cell::{
    CellError, arm_options, check_recorded_arm, choose_edge, complete, station, with_housing,
};
use crate::plant::{EdgeStation, PlantParameters, SharpEdge};
use crate::scenario::{RecordedCell, load_recorded_cell};
use crate::workpiece::{EdgeCurve, load_mesh};
use glam::DVec3;
use glamx::DPose3;
use std::path::Path;
use std::sync::Arc;

/// A recorded cell with its arm and its edge.
#[derive(Debug, Clone)]
pub struct LoadedCell {
    /// The file.
    pub scenario: RecordedCell,
    /// Names of the arm's joints, base first.
    pub joints: Vec<String>,
    /// The arm up to its flange, with the device's housing on it.
    pub chain: KinematicChain,
    /// The edge in the part's frame.
    pub(super) edge: EdgeCurve,
    /// Its middle in the world.
    pub(super) middle: EdgeStation,
    /// The edge as the ball meets it; none where it is met along its bisector.
    pub(super) sharp: Option<Arc<SharpEdge>>,
}

impl LoadedCell {
    /// Reads the scenario of a cell, one that is run or one that was recorded, as the nominal model of recordings.
    ///
    /// # Errors
    /// Those of the file, and of [`LoadedCell::new`].
    pub fn load(path: &Path) -> Result<Self, CellError> {
        Self::new(load_recorded_cell(path)?)
    }

    /// Loads what the file names.
    ///
    /// # Errors
    /// A fault of the arm, the mesh or the choice of the edge; joints that are not served alike.
    pub fn new(mut scenario: RecordedCell) -> Result<Self, CellError> {
        let arm = load_arm(&scenario.arm.urdf, &arm_options(&scenario.arm))?;
        check_recorded_arm(&scenario.arm, &arm.chain)?;
        let joints: Vec<String> = arm.chain.joints.iter().map(|j| j.name.clone()).collect();
        let axes = arm.chain.len();
        if let Some(found) = scenario.springs
            && found != axes
        {
            return Err(CellError::JointStiffness {
                file: scenario.path.clone(),
                found,
                axes,
            });
        }
        if let Some(torques) = &scenario.limits.joint_torque
            && torques.len() != axes
        {
            return Err(CellError::JointTorque {
                file: scenario.path.clone(),
                found: torques.len(),
                axes,
            });
        }
        let slides = |joint: &&crate::arm::chain::Joint| joint.kind == JointKind::Prismatic;
        if let Some(joint) = arm.chain.joints.iter().find(slides) {
            return Err(CellError::SlidingJoint {
                file: scenario.arm.urdf.clone(),
                joint: joint.name.clone(),
            });
        }
        let mesh = load_mesh(&scenario.workpiece.mesh, scenario.workpiece.mesh_scale)?;
        let edge = choose_edge(&scenario.path, &scenario.workpiece, &mesh)?;
        complete(&mut scenario.nominal, &scenario.arm, &arm.chain);
        let part = scenario.workpiece.world_from_part;
        Ok(Self {
            joints,
            chain: with_housing(&arm.chain, &scenario.nominal.mounting),
            middle: station(&edge, part, 0.5 * edge.length),
            sharp: (scenario.observed.sharp_edge).then(|| Arc::new(sharp_edge(&edge, part))),
            edge,
            scenario,
        })
    }

    /// The nominal cell with the effects that its file has.
    pub fn plant(&self) -> PlantParameters {
        let mut plant = PlantParameters::clone(&self.scenario.nominal);
        for effect in &self.scenario.effects {
            effect.apply_to(&mut plant);
        }
        plant
    }
}

/// The edge as a chain of segments in the world.
fn sharp_edge(edge: &EdgeCurve, world_from_part: DPose3) -> SharpEdge {
    let mut points = edge.points.clone();
    let mut stations = edge.stations().to_vec();
    if edge.closed {
        points.push(edge.points[0]);
        stations.push(edge.length);
    }
    let of = |normal: DVec3| world_from_part.rotation * normal;
    SharpEdge::new(
        points
            .iter()
            .map(|&point| world_from_part.transform_point(point))
            .collect(),
        stations,
        edge.normals.iter().map(|&(a, b)| [of(a), of(b)]).collect(),
    )
}
