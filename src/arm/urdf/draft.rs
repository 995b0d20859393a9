//! What a scenario has to say of an arm so that it can be simulated: the mount, and values that the file lacks, as arms of its size have them.
//!
//! Sizes are judged by data sheets of some 20 industrial robots of 0.5 m to 3 m reach: mass and drives grow with reach as below, within a factor of about 1.5.

use std::path::Path;

use glam::{DQuat, DVec3};

use super::error::ArmError;
use super::inertia::merged_bodies;
use super::masses::Masses;
use super::mount::{self, Mount};
use super::source::Source;
use super::tree::{OF_A_CELL, Tree};
use super::{ArmOptions, Refusal, collisions, refused};
use crate::arm::chain::{BodyInertia, MAX_JOINTS};

/// Mass of a robot of 1 m reach [kg], and the power of reach with which it grows.
const MASS: f64 = 80.0;
const MASS_POWER: f64 = 2.65;
/// Payload over the robot's mass.
const PAYLOAD: f64 = 0.12;
/// Torque of a drive over what holds the outstretched arm.
const SPARE: f64 = 2.0;
/// Speed of the first three axes at 1 m reach [rad/s], the power of reach with which it grows, and how much faster wrists are.
const SPEED: f64 = 4.0;
const SPEED_POWER: f64 = -0.8;
const WRIST: f64 = 1.8;

/// A draft of what a scenario says of an arm.
#[derive(Debug, Clone, PartialEq)]
pub struct ArmDraft {
    /// Where the device is mounted.
    pub mount: Mount,
    /// Reach of the wrist from the first axis [m].
    pub reach: f64,
    /// Mass of the whole robot, estimated, where links have none [kg].
    pub whole_mass: Option<f64>,
    /// What it may carry, estimated [kg].
    pub payload: f64,
    /// Limits that the file lacks, estimated: joint, torque [N m], speed [rad/s].
    pub limits: Vec<(String, Option<f64>, Option<f64>)>,
}

/// Looks at the arm of a URDF file.
///
/// # Errors
/// The file cannot be read, or no link of it ends an arm; why not of its likeliest link.
pub fn draft_of(path: &Path) -> Result<ArmDraft, ArmError> {
    let source = Source::read(path)?;
    draft(&source).map_err(|refusal| refused(path, &source, refusal))
}

/// Where load and wrench sensor of a recorded arm are, of whatever number of joints.
///
/// # Errors
/// As [`draft_of`].
pub fn mount_of_recorded(path: &Path) -> Result<Mount, ArmError> {
    let source = Source::read(path)?;
    mount::likely(&source.robot, 1..=MAX_JOINTS).map_err(|refusal| refused(path, &source, refusal))
}

fn draft(source: &Source) -> Result<ArmDraft, Refusal> {
    let robot = &source.robot;
    let mount = mount::likely(robot, OF_A_CELL)?;
    let tip = mount.flange_link.as_str();
    let tree = Tree::build(
        robot,
        mount.base_link.as_deref(),
        tip,
        OF_A_CELL,
        &mut Vec::new(),
    )?;
    let reach = reach(&tree);
    let mut options = ArmOptions {
        base_link: mount.base_link.clone(),
        tip_link: tip.to_owned(),
        tip_from_mount: DQuat::IDENTITY,
        ..ArmOptions::default()
    };
    let known: f64 = tree
        .placed
        .iter()
        .map(|placed| placed.link.inertial.mass.value)
        .sum();
    let has_mass = |index: usize| {
        let mut own = tree
            .placed
            .iter()
            .filter(|placed| placed.link_index == index);
        own.any(|placed| placed.link.inertial.mass.value > 0.0)
    };
    let typical = MASS * reach.powf(MASS_POWER);
    if !(1..=tree.moving.len()).all(has_mass) {
        // Links that have masses say more of the robot than its reach.
        let most = (1..=tree.moving.len())
            .filter(|index| has_mass(*index))
            .count();
        let share = (most + usize::from(has_mass(0))) as f64 / (tree.moving.len() + 1) as f64;
        let whole = if most > 0 {
            (known / share).max(known + 1.0)
        } else {
            typical
        };
        options.whole_mass = Some(two_digits(whole));
    }
    let shapes = match Masses::needs_shapes(&options, &source.walked.without_inertia) {
        true => collisions::load(&tree, &source.folder, &options, &mut Vec::new())?,
        false => Vec::new(),
    };
    let masses = Masses {
        options: &options,
        shapes: &shapes,
        without_inertia: &source.walked.without_inertia,
    };
    let (bodies, _) = merged_bodies(&tree, &masses, &mut Vec::new())?;
    let moving: f64 = bodies.iter().map(|body| body.mass).sum();
    let payload = PAYLOAD * options.whole_mass.unwrap_or_else(|| known.max(moving));
    Ok(ArmDraft {
        limits: limits(&tree, &bodies, reach, payload),
        mount,
        reach,
        whole_mass: options.whole_mass,
        payload,
    })
}

/// Reach of the wrist, the axis before the last, from the first axis, as data sheets have it [m].
fn reach(tree: &Tree) -> f64 {
    let offsets: Vec<DVec3> = (tree.moving.iter())
        .map(|moving| moving.parent_from_joint.translation)
        .collect();
    let first = super::tree::unit_axis(tree.moving[0].joint).unwrap_or(DVec3::Z);
    let aside = offsets[1] - offsets[1].dot(first) * first;
    let along: f64 = offsets[2..offsets.len() - 1]
        .iter()
        .map(|offset| offset.length())
        .sum();
    (aside.length() + along).max(0.1)
}

fn limits(
    tree: &Tree,
    bodies: &[BodyInertia],
    reach: f64,
    payload: f64,
) -> Vec<(String, Option<f64>, Option<f64>)> {
    /// Least lever of the payload about an axis of the wrist, over the reach.
    const LEVER: f64 = 0.1;
    const GRAVITY: f64 = 9.81;
    let offsets: Vec<f64> = (tree.moving.iter())
        .map(|moving| moving.parent_from_joint.translation.length())
        .collect();
    let tip = tree.tip_from_last.translation.length();
    let held = |joint: usize| {
        let mut lever = 0.0;
        let mut moment = 0.0;
        for index in joint..bodies.len() {
            if index > joint {
                lever += offsets[index];
            }
            moment += bodies[index].mass * (lever + bodies[index].centre_of_mass.length());
        }
        GRAVITY * (moment + payload * (lever + tip).max(LEVER * reach))
    };
    let mut found = Vec::new();
    for (index, joint) in tree.path_joints().enumerate() {
        let limit = &joint.limit;
        let is_set = |value: f64| value.is_finite() && value > 0.0;
        let effort = (!is_set(limit.effort)).then(|| two_digits(SPARE * held(index)));
        let faster = if index < 3 { 1.0 } else { WRIST };
        let speed = SPEED * reach.powf(SPEED_POWER) * faster;
        let velocity = (!is_set(limit.velocity)).then_some(speed);
        if effort.is_some() || velocity.is_some() {
            found.push((joint.name.clone(), effort, velocity));
        }
    }
    found
}

/// A number to two digits: an estimate deserves no more.
fn two_digits(value: f64) -> f64 {
    format!("{value:.1e}").parse().unwrap_or(value)
}
