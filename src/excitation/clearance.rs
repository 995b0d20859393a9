//! What a path must keep clear of: the arm's own links, what stands beside it, the floor.

use glam::DVec3;
use glamx::DPose3;

use super::error::ExcitationError;
use crate::arm::{JointKind, VisualShape};
use crate::cell::obstacle_body;
use crate::collision::{
    Body, CollisionModel, JointMotion, ModelRequest, Mount, Role, floor_at, links_of, robot_body,
};
use crate::recorded_arm::fourier_path::FourierPath;
use crate::scenario::arm_file::ArmFile;

/// Knots of a path between which it is a cubic [Hz].
const KNOTS: f64 = 10.0;
/// Radius of the cylinder that a tool beyond a wrench sensor is taken for [m].
const TOOL_RADIUS: f64 = 0.05;

/// Bodies that must not meet.
pub struct Clearance {
    model: CollisionModel,
    /// Least distance [m].
    pub margin: f64,
    /// What it counts with, one sentence each.
    pub notes: Vec<String>,
}

impl Clearance {
    /// Of an arm file: its URDF's shapes, `[collision]` and `[[obstacle]]`.
    ///
    /// # Errors
    /// A shape that cannot be read or encloses nothing, links that meet at rest.
    pub fn of(file: &ArmFile) -> Result<Self, ExcitationError> {
        let refused = |source| ExcitationError::Bodies {
            file: file.path.clone(),
            source: Box::new(source),
        };
        let arm = file
            .with_shapes()
            .map_err(|source| ExcitationError::Shapes {
                file: file.path.clone(),
                source: Box::new(source),
            })?;
        let mut notes = Vec::new();
        let mut bodies = links_of(&arm, DPose3::IDENTITY).map_err(refused)?;
        if bodies.is_empty() {
            notes.push(
                "the URDF has no shapes: nothing says whether the links meet each other".to_owned(),
            );
        }
        if let Some((length, shape)) = tool(file) {
            let middle = DPose3::from_translation(DVec3::Z * (0.5 * length));
            let shapes = [(&shape, file.nominal.chain.tip_from_last * middle)];
            let last = Mount::Link(file.numbers.len() - 1);
            let body = robot_body(Role::Device, "tool", last, shapes.into_iter());
            bodies.extend(body.map_err(refused)?);
            notes.push(format!(
                "the tool counts as a cylinder of {:.0} mm, {:.0} mm long from the flange; a load has no shape",
                2e3 * TOOL_RADIUS,
                1e3 * length
            ));
        }
        for obstacle in &file.collision.obstacles {
            let body = obstacle_body(obstacle, &file.path, &mut notes);
            bodies.push((
                Role::Obstacle,
                body.map_err(|source| ExcitationError::Obstacle(Box::new(source)))?,
            ));
        }
        let mut allowed = file.collision.allowed_pairs.clone();
        if let Some(height) = floor(file, &mut notes) {
            bodies.push((Role::Floor, floor_at(height)));
            allowed.extend(first_link_on_floor(file, &bodies));
        }
        let model = CollisionModel::new(ModelRequest {
            chain: &file.nominal.chain,
            world_from_base: DPose3::IDENTITY,
            bodies,
            ridden: None,
            margin: file.collision.margin,
            allowed: &allowed,
        })
        .map_err(refused)?;
        if !model.touching_at_rest.is_empty() {
            let pairs = model.touching_at_rest.iter();
            let pairs: Vec<_> = pairs.map(|[one, two]| format!("{one} and {two}")).collect();
            notes.push(format!(
                "links that touch with all joints at zero may meet: {}",
                pairs.join("; ")
            ));
        }
        Ok(Self {
            model,
            margin: file.collision.margin,
            notes,
        })
    }

    /// Names of two bodies that come too near to each other along a path.
    #[must_use]
    pub fn met(&self, path: &FourierPath) -> Option<[String; 2]> {
        let motion = path.motion(0, KNOTS);
        let mut joints = JointMotion::default();
        let at = |values: &[Vec<f64>], i: usize, factor: f64| {
            let mut all = [0.0; crate::arm::MAX_JOINTS];
            for (one, values) in all.iter_mut().zip(values) {
                *one = factor * values[i];
            }
            all
        };
        for i in 0..motion.len() {
            let changes = [i.saturating_sub(1), i].map(|k| at(&motion.speed, k, 1.0 / KNOTS));
            joints.cubic_to(at(&motion.position, i, 1.0), changes);
        }
        // Most paths that meet something do at a knot.
        let mut knots = joints.knots().iter();
        if let Some(meeting) = knots.find_map(|knot| self.model.meeting_at(knot)) {
            return Some(meeting.names);
        }
        self.model
            .first_meeting(&joints)
            .map(|meeting| meeting.names)
    }
}

/// Length and shape of what a wrench sensor carries.
fn tool(file: &ArmFile) -> Option<(f64, VisualShape)> {
    let wrench = file.nominal.wrench.as_ref()?;
    let beyond = file.tip.unwrap_or(2.0 * wrench.tool_centre.z);
    let length = wrench.height + beyond;
    let shape = VisualShape::Cylinder {
        radius: TOOL_RADIUS,
        length,
    };
    (length > 0.0).then_some((length, shape))
}

/// Height of the floor [m]: where the file says, else the plane on which the base stands.
fn floor(file: &ArmFile, notes: &mut Vec<String>) -> Option<f64> {
    const ALONG: f64 = 0.999;
    if let Some(height) = file.collision.floor_height {
        return Some(height);
    }
    if file.nominal.gravity.normalize_or_zero().z > -ALONG {
        notes.push(
            "no floor is kept clear of, as the base does not stand upright; collision.floor_height_mm says where it is"
                .to_owned(),
        );
        return None;
    }
    notes.push(
        "the floor is taken to be the plane on which the base stands; collision.floor_height_mm says otherwise"
            .to_owned(),
    );
    Some(0.0)
}

/// The first link and the floor, where it turns upright on it.
fn first_link_on_floor(file: &ArmFile, bodies: &[(Role, Body)]) -> Option<[String; 2]> {
    let first = file.nominal.chain.joints.first()?;
    let axis = first.parent_from_joint.rotation * first.axis;
    let upright = first.kind == JointKind::Revolute && axis.z.abs() > 0.999;
    let has_shape = bodies.iter().any(|(_, body)| body.name == file.links[0]);
    (upright && has_shape).then(|| [file.links[0].clone(), "floor".to_owned()])
}
