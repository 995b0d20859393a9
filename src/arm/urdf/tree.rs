//! Which link hangs where: the path of moving joints, and what is welded to each moving link.

use super::Refusal;
use super::graph::{Graph, few, kind_of};
use crate::arm::chain::BodyInertia;
use crate::arm::chain::{Joint as ChainJoint, JointKind};
use glam::DVec3;
use glamx::DPose3;
use std::ops::RangeInclusive;
use urdf_rs::{Joint, Link, Robot};

/// Numbers of moving joints that an arm of a cell may have.
pub(super) const OF_A_CELL: RangeInclusive<usize> = 5..=7;

/// A moving joint on the path, with the fixed frames before it folded in.
pub(super) struct Moving<'a> {
    pub joint: &'a Joint,
    pub parent_from_joint: DPose3,
}

/// A link and where it sits.
pub(super) struct Placed<'a> {
    pub link: &'a Link,
    /// 0 for the base, `i` for the link behind moving joint `i - 1`.
    pub link_index: usize,
    /// Frame of this link in the frame of that moving link.
    pub moving_from_link: DPose3,
}

/// The file's links as seen from the base.
pub(super) struct Tree<'a> {
    pub robot: &'a Robot,
    pub base: &'a str,
    pub moving: Vec<Moving<'a>>,
    pub tip_from_last: DPose3,
    pub placed: Vec<Placed<'a>>,
}

impl<'a> Tree<'a> {
    /// Sorts the links of `robot` by the moving link they are rigid with.
    pub fn build(
        robot: &'a Robot,
        base: Option<&str>,
        tip: &str,
        counts: RangeInclusive<usize>,
        notes: &mut Vec<String>,
    ) -> Result<Self, Refusal> {
        let graph = Graph::build(robot)?;
        let base = match base {
            Some(name) => graph.link(name, "base")?,
            None => graph.root()?,
        };
        let tip = graph.link(tip, "tip")?;
        let path = graph.path(base, tip)?;
        let mut tree = Self {
            robot,
            base: &base.name,
            moving: Vec::new(),
            tip_from_last: DPose3::IDENTITY,
            placed: Vec::new(),
        };
        tree.place(&graph, base, &path, notes)?;
        let tip_placed = tree
            .placed
            .iter()
            .find(|placed| placed.link.name == tip.name);
        tree.tip_from_last = tip_placed.map_or(DPose3::IDENTITY, |p| p.moving_from_link);
        if !counts.contains(&tree.moving.len()) {
            let names: Vec<_> = tree.path_joints().map(|j| j.name.as_str()).collect();
            let hint = match names.len() {
                _ if counts != OF_A_CELL => "",
                4 => {
                    "; an arm of four axes, as palletisers and SCARAs are, cannot lean a tool as edges ask for"
                }
                8.. => {
                    "; arm.base_link in the scenario lets the arm begin behind a track or a turntable, which then stands still"
                }
                _ => "",
            };
            return Err(Refusal::JointCount {
                base: base.name.clone(),
                tip: tip.name.clone(),
                count: names.len(),
                expected: [*counts.start(), *counts.end()],
                names: match names.len() {
                    0 => String::new(),
                    _ => format!(" ({})", few(&names)),
                },
                hint,
            });
        }
        tree.note_weightless(notes);
        let matters = |link: &&Link| link.inertial.mass.value != 0.0 || !link.visual.is_empty();
        let outside = robot.links.iter().filter(|link| !tree.holds(&link.name));
        let outside = outside.filter(matters);
        let outside: Vec<_> = outside.map(|link| link.name.as_str()).collect();
        if !outside.is_empty() {
            notes.push(format!(
                "links not carried by base link {} are left out: {}",
                base.name,
                few(&outside)
            ));
        }
        Ok(tree)
    }

    /// The moving joints of the path, base first.
    pub fn path_joints(&self) -> impl Iterator<Item = &'a Joint> + '_ {
        self.moving.iter().map(|moving| moving.joint)
    }

    /// The base's name and the name of the link behind each moving joint.
    pub fn link_names(&self) -> Vec<String> {
        let behind = self.path_joints().map(|joint| joint.child.link.clone());
        std::iter::once(self.base.to_string())
            .chain(behind)
            .collect()
    }

    /// Notes links with a shape, but no mass, on others that have one.
    fn note_weightless(&self, notes: &mut Vec<String>) {
        let heavy = |index: usize| {
            let mut own = self.placed.iter().filter(|other| other.link_index == index);
            own.any(|other| other.link.inertial.mass.value > 0.0)
        };
        let weightless = self.placed.iter().filter(|placed| {
            let link = placed.link;
            let has_shape = !link.visual.is_empty() || !link.collision.is_empty();
            let index = placed.link_index;
            index > 0 && has_shape && link.inertial.mass.value == 0.0 && heavy(index)
        });
        let names: Vec<&str> = weightless.map(|placed| placed.link.name.as_str()).collect();
        if !names.is_empty() {
            notes.push(format!(
                "links that have a shape but no mass, fixed to others that have one, weigh nothing: {}; [[arm.link_masses]] gives them one",
                few(&names)
            ));
        }
    }

    /// Link behind a moving joint, by its index, with which a link of the file moves.
    pub fn index_of(&self, link: &str) -> Option<usize> {
        let mut placed = self.placed.iter();
        placed
            .find(|placed| placed.link.name == link)
            .map(|placed| placed.link_index)
    }

    fn holds(&self, link: &str) -> bool {
        self.placed.iter().any(|placed| placed.link.name == link)
    }

    /// Walks down from the base, parents before children, in the order of the file's joints.
    fn place(
        &mut self,
        graph: &Graph<'a>,
        base: &'a Link,
        path: &[&'a Joint],
        notes: &mut Vec<String>,
    ) -> Result<(), Refusal> {
        self.placed.push(Placed {
            link: base,
            link_index: 0,
            moving_from_link: DPose3::IDENTITY,
        });
        let mut next = 0;
        while next < self.placed.len() {
            let (parent, parent_index, moving_from_parent) = {
                let placed = &self.placed[next];
                (placed.link, placed.link_index, placed.moving_from_link)
            };
            next += 1;
            for &joint in graph.below(&parent.name) {
                let origin = pose_of(&joint.origin, || {
                    format!("origin of joint `{}`", joint.name)
                })?;
                let parent_from_joint = moving_from_parent * origin;
                let on_path = path.iter().any(|step| step.name == joint.name);
                let (link_index, moving_from_link) = match kind_of(joint)? {
                    Some(_) if on_path => {
                        self.moving.push(Moving {
                            joint,
                            parent_from_joint,
                        });
                        (self.moving.len(), DPose3::IDENTITY)
                    }
                    Some(kind) => {
                        let held = graph.held_position(joint, path)?;
                        notes.push(held_note(joint, kind, held));
                        let motion = held_motion(joint, kind, held)?;
                        (parent_index, parent_from_joint * motion)
                    }
                    None => (parent_index, parent_from_joint),
                };
                self.placed.push(Placed {
                    link: graph.link(&joint.child.link, "child")?,
                    link_index,
                    moving_from_link,
                });
            }
        }
        Ok(())
    }
}

/// Longest length in an arm [m].
pub(super) const LONGEST: f64 = 1000.0;

/// Refuses a number that no arm has, so that no search starts with it.
pub(super) fn within(
    value: f64,
    most: f64,
    unit: &'static str,
    location: impl FnOnce() -> String,
) -> Result<(), Refusal> {
    // Of what is not finite others say it.
    if value.is_finite() && value.abs() > most {
        return Err(Refusal::Absurd {
            location: location(),
            value,
            unit,
            most,
        });
    }
    Ok(())
}

/// Unit axis of a joint, in its own frame.
pub(super) fn unit_axis(joint: &Joint) -> Result<DVec3, Refusal> {
    let axis = DVec3::from_array(*joint.axis.xyz);
    axis.try_normalize().ok_or_else(|| Refusal::Axis {
        joint: joint.name.clone(),
        axis: format!("{} {} {}", axis.x, axis.y, axis.z),
    })
}

fn held_note(joint: &Joint, kind: JointKind, held: f64) -> String {
    let unit = match kind {
        JointKind::Revolute => "rad",
        JointKind::Prismatic => "m",
    };
    let mimic = joint.mimic.as_ref();
    let why = mimic.map_or(String::new(), |mimic| {
        format!(", as it mimics {}", mimic.joint)
    });
    format!(
        "joint {} is off the path and held at {held} {unit}{why}; link {} is welded on",
        joint.name, joint.child.link
    )
}

fn held_motion(joint: &Joint, kind: JointKind, held: f64) -> Result<DPose3, Refusal> {
    let chain_joint = ChainJoint {
        name: String::new(),
        kind,
        parent_from_joint: DPose3::IDENTITY,
        axis: unit_axis(joint)?,
        lower: held,
        upper: held,
        effort: 0.0,
        velocity: 0.0,
        damping: 0.0,
        friction: 0.0,
        body: BodyInertia::ZERO,
    };
    Ok(chain_joint.parent_from_link(held))
}

/// Pose of a URDF `origin`, refused if it is not finite; `place` says where it stands.
pub(super) fn pose_of(
    origin: &urdf_rs::Pose,
    location: impl FnOnce() -> String,
) -> Result<DPose3, Refusal> {
    let far = DVec3::from_array(*origin.xyz).abs().max_element();
    let [roll, pitch, yaw] = *origin.rpy;
    // Fixed-axis roll, pitch, yaw: roll turns first.
    let rotation = glam::DQuat::from_rotation_z(yaw)
        * glam::DQuat::from_rotation_y(pitch)
        * glam::DQuat::from_rotation_x(roll);
    let pose = DPose3::from_parts(DVec3::from_array(*origin.xyz), rotation);
    if pose.translation.is_finite() && pose.rotation.is_finite() {
        within(far, LONGEST, "m", location)?;
        Ok(pose)
    } else {
        Err(Refusal::NotFinite {
            location: location(),
        })
    }
}
