//! Where a device would be mounted on an arm of which nothing is said: link, base and turn of the frame.

use glam::DVec3;
use glamx::DPose3;

use super::Refusal;
use super::graph::{Graph, kind_of};
use super::tree::{Tree, unit_axis};
use std::collections::BTreeSet;
use std::ops::RangeInclusive;
use urdf_rs::{Joint, JointType, Link, Robot};

/// Names that frames for tools usually have, the usual one first; names may have a robot's name before them.
const USUAL: [&str; 5] = ["tool0", "flange", "ee_link", "tool_frame", "tcp"];
/// Angle from the last joint's axis up to which a frame's z counts as along it [rad].
const ALONG: f64 = 0.1;

/// A mount that has been found.
#[derive(Debug, Clone, PartialEq)]
pub struct Mount {
    /// The base link, where the file has several roots.
    pub base_link: Option<String>,
    /// The link that carries the device.
    pub flange_link: String,
    /// Roll, pitch and yaw of the frame whose z points out of the flange, in that of the link [rad].
    pub rotation: [f64; 3],
}

/// The link of a file that a device would be mounted on: of those that end an arm one with a usual name, else the outermost frame.
pub(super) fn likely(robot: &Robot, counts: RangeInclusive<usize>) -> Result<Mount, Refusal> {
    let graph = Graph::build(robot)?;
    let tried = |link: &Link| -> Result<Mount, Refusal> {
        let base = match graph.root() {
            Ok(_) => None,
            Err(refusal @ Refusal::Ring { .. }) => return Err(refusal),
            Err(_) => Some(graph.root_above(link)),
        };
        let tree = Tree::build(
            robot,
            base.as_deref(),
            &link.name,
            counts.clone(),
            &mut Vec::new(),
        )?;
        Ok(Mount {
            rotation: turn(&tree)?,
            base_link: base,
            flange_link: link.name.clone(),
        })
    };
    let mut refused = None;
    for link in by_likelihood(robot, &graph, &counts) {
        match tried(link) {
            Ok(mount) => return Ok(mount),
            // The message is that of the likeliest link.
            Err(refusal) => drop(refused.get_or_insert(refusal)),
        }
    }
    Err(refused.unwrap_or(Refusal::Ring {
        links: String::new(),
    }))
}

/// Links, the likeliest first: by their names, then by the count of moving joints that carry them (not counting fingers), frames before bodies.
fn by_likelihood<'a>(
    robot: &'a Robot,
    graph: &Graph<'a>,
    counts: &RangeInclusive<usize>,
) -> Vec<&'a Link> {
    let rank = |link: &Link| {
        let is = |usual: &str| {
            let before = link.name.strip_suffix(usual);
            before.is_some_and(|rest| !rest.ends_with(|c: char| c.is_alphanumeric()))
        };
        let usual = USUAL.iter().position(|usual| is(usual));
        let above = graph.above(link);
        let moving = above.iter().filter(|joint| moves(joint)).count();
        let finger = is_on_finger(graph, &above);
        let is_arm = counts.contains(&moving) && !finger;
        let body = !link.visual.is_empty() || link.inertial.mass.value > 0.0;
        // A frame far behind the last joint is rather that of a tool.
        let fixed = above.iter().rev().take_while(|joint| !moves(joint)).count();
        (
            !is_arm,
            usual.unwrap_or(USUAL.len()),
            std::cmp::Reverse(moving),
            body,
            fixed,
        )
    };
    let mut links: Vec<&Link> = robot.links.iter().collect();
    links.sort_by_cached_key(|link| rank(link));
    links
}

fn moves(joint: &Joint) -> bool {
    joint.joint_type != JointType::Fixed
}

/// Whether the last moving joint is one of several that branch off the same body, as fingers do.
fn is_on_finger(graph: &Graph, above: &[&Joint]) -> bool {
    let Some(at) = above.iter().rposition(|joint| moves(joint)) else {
        return false;
    };
    if at == 0 {
        return false;
    }
    // What is rigid with the parent of that joint.
    let mut rigid = vec![above[at].parent.link.as_str()];
    for joint in above[..at].iter().rev().take_while(|joint| !moves(joint)) {
        rigid.push(&joint.parent.link);
    }
    let mut known: BTreeSet<&str> = rigid.iter().copied().collect();
    let mut next = 0;
    while next < rigid.len() {
        let here = rigid[next];
        next += 1;
        for joint in graph.below(here).iter().filter(|joint| !moves(joint)) {
            if known.insert(joint.child.link.as_str()) {
                rigid.push(&joint.child.link);
            }
        }
    }
    let below = rigid.iter().flat_map(|link| graph.below(link));
    below.filter(|joint| moves(joint)).count() > 1
}

/// Roll, pitch and yaw [rad] by which the tip's frame is turned so that its z points along the last joint's axis, out of the flange; zeros where it does already.
fn turn(tree: &Tree) -> Result<[f64; 3], Refusal> {
    let Some(outward) = outward(tree)? else {
        return Ok([0.0; 3]);
    };
    if outward.angle_between(DVec3::Z) < ALONG {
        return Ok([0.0; 3]);
    }
    let pitch = outward.z.clamp(-1.0, 1.0).acos();
    let level = DVec3::new(outward.x, outward.y, 0.0).length();
    let yaw = match level > 1e-6 {
        true => outward.y.atan2(outward.x),
        false => 0.0,
    };
    Ok([0.0, pitch, yaw])
}

/// Direction out of the flange along the last joint's axis, in the tip's frame: away from the axis of the joint before, from which a flange stands off.
fn outward(tree: &Tree) -> Result<Option<DVec3>, Refusal> {
    const NEAR: f64 = 1e-3;
    let [.., before, last] = &tree.moving[..] else {
        return Ok(None);
    };
    let is_turning = kind_of(last.joint)? == Some(crate::arm::chain::JointKind::Revolute);
    if !is_turning {
        return Ok(None);
    }
    let axis = unit_axis(last.joint)?;
    let last_from_before: DPose3 = last.parent_from_joint.inverse();
    let other = last_from_before.rotation * unit_axis(before.joint)?;
    let on_other = last_from_before.translation;
    let tip = tree.tip_from_last.translation;
    // The point of the last axis that is nearest to the one before.
    let cosine = axis.dot(other);
    let spread = 1.0 - cosine * cosine;
    let nearest = if spread > 1e-6 {
        (axis - cosine * other).dot(on_other) / spread
    } else {
        axis.dot(on_other)
    };
    let off = axis.dot(tip) - nearest;
    let z = tree.tip_from_last.rotation * DVec3::Z;
    let sense = if off.abs() > NEAR { off } else { axis.dot(z) };
    let outward = if sense < 0.0 { -axis } else { axis };
    Ok(Some(tree.tip_from_last.rotation.inverse() * outward))
}

/// Angle between the axis along which something is mounted and the last joint's, where that turns [rad].
pub(super) fn askew(tree: &Tree, tip_from_mount: glam::DQuat) -> Result<Option<f64>, Refusal> {
    let outward = outward(tree)?;
    Ok(outward
        .map(|outward| outward.angle_between(tip_from_mount * DVec3::Z))
        .filter(|angle| *angle > ALONG))
}
