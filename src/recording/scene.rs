//! Look of a recording in space: bodies, their poses, the edge and the contact force.
//!
//! Plain data, in world coordinates and SI units; whoever runs the cell fills it in, and
//! [`super::rerun`] draws it. Frames may be fewer than samples: 50 a second look smooth.

use glam::DVec3;
use glamx::DPose3;

use super::RecordingError;

/// Red, green, blue and opacity, 0 to 255.
pub type Colour = [u8; 4];

/// The shape of a part of a body, in the part's own frame.
#[derive(Debug, Clone, PartialEq)]
pub enum SceneGeometry {
    /// A box centred on the origin.
    Box {
        /// Full edge lengths [m].
        size: DVec3,
    },
    /// A cylinder about z, centred on the origin.
    Cylinder {
        /// Radius [m].
        radius: f64,
        /// Length [m].
        length: f64,
    },
    /// A sphere centred on the origin.
    Sphere {
        /// Radius [m].
        radius: f64,
    },
    /// A triangle mesh.
    Mesh {
        /// Corners [m].
        vertices: Vec<DVec3>,
        /// Corner indices, counter-clockwise from outside.
        triangles: Vec<[u32; 3]>,
    },
}

/// A part of a body.
#[derive(Debug, Clone, PartialEq)]
pub struct SceneShape {
    /// Pose in the body's frame.
    pub body_from_shape: DPose3,
    /// Its geometry.
    pub geometry: SceneGeometry,
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
    /// Times of the frames, increasing [s].
    pub frame_times: Vec<f64>,
    /// Planned path behind the tool at each frame [m].
    pub frame_path_lengths: Vec<f64>,
    /// The planned path.
    pub edge_path: EdgePath,
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
        let mut entities: Vec<&str> = self.bodies.iter().map(|b| b.entity.as_str()).collect();
        entities.sort_unstable();
        if let Some([name, ..]) = entities.windows(2).find(|pair| pair[0] == pair[1]) {
            let found = format!("`{name}` twice");
            return Err(RecordingError::scene(
                "body entity",
                found,
                "different names",
            ));
        }
        for body in &self.bodies {
            self.check_body(body)?;
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
            if let SceneGeometry::Mesh {
                vertices,
                triangles,
            } = &shape.geometry
                && let Some(index) = triangles
                    .iter()
                    .flatten()
                    .find(|&&index| index as usize >= vertices.len())
            {
                let what = format!("a vertex index of the mesh of `{name}`");
                let expected = format!("less than {}", vertices.len());
                return Err(RecordingError::scene(what, index, expected));
            }
        }
        Ok(())
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
                geometry: SceneGeometry::Mesh {
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
