//! Look of a recording in space: bodies, their poses, the edge and the contact force.
//!
//! Plain data, in world coordinates and SI units; whoever runs the cell fills it in, and
//! [`crate::viewer`] draws it. Frames may be fewer than samples: 50 a second look smooth.

pub mod board;
pub mod colour;
pub mod error_scale;
pub mod finished_edge;

use glam::DVec3;
use glamx::DPose3;

use crate::arm::VisualShape;
use crate::recording::RecordingError;
use colour::Colour;
use finished_edge::FinishedEdge;

/// A part of a body.
#[derive(Debug, Clone, PartialEq)]
pub struct SceneShape {
    /// Pose in the body's frame.
    pub body_from_shape: DPose3,
    /// Its geometry, in its own frame.
    pub geometry: VisualShape,
    /// Its colour.
    pub colour: Colour,
}

/// Where a body is.
#[derive(Debug, Clone, PartialEq)]
pub enum ScenePoses {
    /// It does not move.
    Static(DPose3),
    /// One pose per frame.
    Moving(Vec<DPose3>),
}

/// A rigid body of the scene.
#[derive(Debug, Clone, PartialEq)]
pub struct SceneBody {
    /// Its name in the viewer's tree, parts split by `/`: `arm/link_3`.
    pub entity: String,
    /// Its parts.
    pub shapes: Vec<SceneShape>,
    /// Poses in the world.
    pub world_from_body: ScenePoses,
}

/// What of a body is checked for collisions: a mesh that moves with a body of the scene, or stands in the world.
#[derive(Debug, Clone, PartialEq)]
pub struct CollisionShape {
    /// Name of the body that is checked; it may hold any character.
    pub name: String,
    /// Entity of the body of the scene that it moves with; none for the world.
    pub moves_with: Option<String>,
    /// Corners in the frame of that body, or in the world [m].
    pub vertices: Vec<DVec3>,
    /// Corner indices, counter-clockwise from outside.
    pub triangles: Vec<[u32; 3]>,
}

/// The contact force at one frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ContactArrow {
    /// Point of contact [m].
    pub point_in_world: DVec3,
    /// Force on the workpiece [N]; zero draws nothing.
    pub force_in_world: DVec3,
}

/// The planned path along the edge, coloured by how well the force was kept.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct EdgePath {
    /// Its corners [m].
    pub points_in_world: Vec<DVec3>,
    /// Length of the edge [m], of which the corners cut off a little; zero without one.
    pub length: f64,
    /// Per segment, (force - desired) / desired; NaN where there was no contact.
    pub relative_force_error: Vec<f64>,
}

/// Limits that plots show.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct SceneLimits {
    /// End stops of the slide [m]: retracted and extended.
    pub stroke: Option<[f64; 2]>,
    /// Torque limit of each joint, base first [N m].
    pub joint_torque: Vec<f64>,
}

/// Everything that is drawn beside the signals.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Scene {
    /// Name of the run.
    pub title: String,
    /// Bodies; entities must differ.
    pub bodies: Vec<SceneBody>,
    /// What is checked for collisions, not shown until it is asked for; names must differ.
    pub collision_shapes: Vec<CollisionShape>,
    /// Times of the frames, increasing [s].
    pub frame_times: Vec<f64>,
    /// Planned path behind the tool at each frame [m].
    pub frame_path_lengths: Vec<f64>,
    /// The planned path.
    pub edge_path: EdgePath,
    /// The edge before and after it was worked; of a whole run with a turning tool.
    pub finished_edge: Option<FinishedEdge>,
    /// Contact force at each frame.
    pub contact_arrows: Vec<ContactArrow>,
    /// Limits for the plots.
    pub limits: SceneLimits,
}

impl Scene {
    /// Checks that the scene's parts fit together.
    ///
    /// # Errors
    /// [`RecordingError::Scene`] naming the part that does not.
    pub fn check(&self) -> Result<(), RecordingError> {
        self.check_frames()?;
        let segments = self.edge_path.points_in_world.len().saturating_sub(1);
        check_count(
            "number of relative force errors along the edge path",
            self.edge_path.relative_force_error.len(),
            segments,
        )?;
        let entities = self.bodies.iter().map(|b| b.entity.as_str());
        check_different("body entity", entities.collect())?;
        for body in &self.bodies {
            self.check_body(body)?;
        }
        self.check_collision_shapes()?;
        if let Some(edge) = &self.finished_edge {
            edge.check()?;
        }
        for (index, limit) in self.limits.joint_torque.iter().enumerate() {
            if !(limit.is_finite() && *limit > 0.0) {
                let what = format!("torque limit of joint {}", index + 1);
                return Err(RecordingError::scene(
                    what,
                    limit,
                    "a positive number of N m",
                ));
            }
        }
        Ok(())
    }

    fn check_frames(&self) -> Result<(), RecordingError> {
        let frames = self.frame_times.len();
        let mut previous = f64::NEG_INFINITY;
        for &time in &self.frame_times {
            if !time.is_finite() || time <= previous {
                let found = format!("{time} s after {previous} s");
                let expected = "finite, increasing times";
                return Err(RecordingError::scene("frame time", found, expected));
            }
            previous = time;
        }
        let lengths = self.frame_path_lengths.len();
        check_count("number of frame path lengths", lengths, frames)?;
        let arrows = self.contact_arrows.len();
        check_count("number of contact arrows", arrows, frames)
    }

    fn check_body(&self, body: &SceneBody) -> Result<(), RecordingError> {
        let name = &body.entity;
        if name.is_empty() || name.split('/').any(str::is_empty) {
            let expected = "names split by single slashes";
            return Err(RecordingError::scene(
                "body entity",
                format!("`{name}`"),
                expected,
            ));
        }
        if let ScenePoses::Moving(poses) = &body.world_from_body {
            let what = format!("number of poses of `{name}`");
            check_count(what, poses.len(), self.frame_times.len())?;
        }
        for shape in &body.shapes {
            if let VisualShape::Mesh {
                vertices,
                triangles,
            } = &shape.geometry
            {
                check_indices(name, vertices, triangles)?;
            }
        }
        Ok(())
    }

    fn check_collision_shapes(&self) -> Result<(), RecordingError> {
        let shapes = &self.collision_shapes;
        let names = shapes.iter().map(|shape| shape.name.as_str());
        check_different("collision shape", names.collect())?;
        for shape in shapes {
            check_indices(&shape.name, &shape.vertices, &shape.triangles)?;
            if let Some(with) = &shape.moves_with
                && !self.bodies.iter().any(|body| body.entity == *with)
            {
                let what = format!("what the collision shape of `{}` moves with", shape.name);
                let found = format!("`{with}`");
                return Err(RecordingError::scene(what, found, "a body's entity"));
            }
        }
        Ok(())
    }
}

fn check_different(what: &str, mut names: Vec<&str>) -> Result<(), RecordingError> {
    names.sort_unstable();
    match names.windows(2).find(|pair| pair[0] == pair[1]) {
        None => Ok(()),
        Some(pair) => {
            let found = format!("`{}` twice", pair[0]);
            Err(RecordingError::scene(what, found, "different names"))
        }
    }
}

fn check_indices(
    name: &str,
    vertices: &[DVec3],
    triangles: &[[u32; 3]],
) -> Result<(), RecordingError> {
    let beyond = |index: &&u32| **index as usize >= vertices.len();
    match triangles.iter().flatten().find(beyond) {
        None => Ok(()),
        Some(index) => {
            let what = format!("a vertex index of the mesh of `{name}`");
            let expected = format!("less than {}", vertices.len());
            Err(RecordingError::scene(what, index, expected))
        }
    }
}

fn check_count(
    what: impl Into<String>,
    found: usize,
    expected: usize,
) -> Result<(), RecordingError> {
    if found == expected {
        Ok(())
    } else {
        Err(RecordingError::scene(what, found, expected))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn body(entity: &str, poses: ScenePoses, triangles: Vec<[u32; 3]>) -> SceneBody {
        SceneBody {
            entity: entity.to_owned(),
            shapes: vec![SceneShape {
                body_from_shape: DPose3::IDENTITY,
                geometry: VisualShape::Mesh {
                    vertices: vec![DVec3::ZERO, DVec3::X, DVec3::Y],
                    triangles,
                },
                colour: [255; 4],
            }],
            world_from_body: poses,
        }
    }

    fn fixed(entity: &str) -> SceneBody {
        body(
            entity,
            ScenePoses::Static(DPose3::IDENTITY),
            vec![[0, 1, 2]],
        )
    }

    #[test]
    fn a_scene_that_fits_passes() {
        let scene = Scene {
            bodies: vec![fixed("arm/link_1"), fixed("arm/link_2")],
            ..Scene::default()
        };
        scene.check().unwrap();
    }

    #[test]
    fn what_does_not_fit_is_named() {
        let still = || ScenePoses::Static(DPose3::IDENTITY);
        let moving = ScenePoses::Moving(vec![DPose3::IDENTITY; 3]);
        let with = |bodies| Scene {
            bodies,
            ..Scene::default()
        };
        let hull = |name: &str, with: &str, index| CollisionShape {
            name: name.to_owned(),
            moves_with: Some(with.to_owned()),
            vertices: vec![DVec3::ZERO; 3],
            triangles: vec![[0, 1, index]],
        };
        let hulls = |collision_shapes| Scene {
            bodies: vec![fixed("arm")],
            collision_shapes,
            ..Scene::default()
        };
        let mut late_frame = with(vec![]);
        late_frame.frame_times = vec![0.0, 0.0];
        let mut lost_frame = with(vec![]);
        lost_frame.frame_times = vec![f64::NAN];
        let mut lone_arrow = with(vec![]);
        lone_arrow.contact_arrows = vec![ContactArrow {
            point_in_world: DVec3::ZERO,
            force_in_world: DVec3::ZERO,
        }];
        let mut unmatched_error = with(vec![]);
        unmatched_error.edge_path.relative_force_error = vec![0.0];
        let mut no_limit = with(vec![]);
        no_limit.limits.joint_torque = vec![100.0, 0.0];
        for (scene, expected) in [
            (with(vec![fixed("arm"), fixed("arm")]), "`arm` twice"),
            (with(vec![fixed("arm//link")]), "`arm//link`"),
            (
                with(vec![body("arm", moving, vec![])]),
                "poses of `arm` is 3, expected 0",
            ),
            (
                with(vec![body("arm", still(), vec![[0, 1, 3]])]),
                "is 3, expected less than 3",
            ),
            (
                hulls(vec![hull("link", "arm", 2), hull("link", "arm", 2)]),
                "collision shape is `link` twice",
            ),
            (
                hulls(vec![hull("link", "leg", 2)]),
                "moves with is `leg`, expected a body's entity",
            ),
            (
                hulls(vec![hull("link", "arm", 3)]),
                "mesh of `link` is 3, expected less than 3",
            ),
            (late_frame, "frame time is 0 s after 0 s"),
            (lost_frame, "frame time is NaN s"),
            (lone_arrow, "contact arrows is 1, expected 0"),
            (unmatched_error, "relative force errors"),
            (no_limit, "torque limit of joint 2 is 0"),
        ] {
            let message = scene.check().unwrap_err().to_string();
            assert!(message.contains(expected), "{message}");
        }
    }
}
