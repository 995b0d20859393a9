//! How an arm stands, from its joint angles and where its axes lie.
//!
//! Makers name postures by where the wrist's centre, the point in which axes 4, 5 and 6 meet, lies: before or behind axis 1, and before or behind the lower arm from axis 2 to axis 3. An arm whose
//! last axes do not meet, or whose axes 2 and 3 are not parallel, has no such names.

use glam::{DQuat, DVec3};
use glamx::DPose3;

use super::dialect::Dialect;
use super::moves::Configuration;

/// Distance up to which axes count as meeting [m].
const MEETS: f64 = 1e-4;
/// Sine of the angle up to which axes count as parallel or square [1].
const PARALLEL: f64 = 1e-3;

/// Where the wrist's centre lies.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Posture {
    /// Before axis 1, seen along x of the controller's base as axis 1 has turned it.
    pub front: bool,
    /// Before the lower arm, on the side to which it leans when it leans forward.
    pub before_arm: bool,
}

impl Posture {
    /// The posture of six axes, each a point and a direction in the controller's base, the first turned by an angle [rad]; why not, where it has none.
    ///
    /// # Errors
    /// Why it has no name.
    pub fn of(axes: &[(DVec3, DVec3); 6], first: f64) -> Result<Self, &'static str> {
        let up = DVec3::Z * axes[0].1.z.signum();
        let sine = |one: DVec3, other: DVec3| one.cross(other).length();
        if sine(axes[0].1, up) > PARALLEL {
            return Err("axis 1 does not stand along z of the controller's base");
        }
        if sine(axes[1].1, axes[2].1) > PARALLEL || axes[1].1.dot(axes[0].1).abs() > PARALLEL {
            return Err("axes 2 and 3 are not parallel to each other and square to axis 1");
        }
        let centre = nearest(axes[3], axes[4]);
        let off = |(point, axis): (DVec3, DVec3)| (centre - point).cross(axis).length();
        if axes[3..].iter().any(|axis| off(*axis) > MEETS) {
            return Err("axes 4, 5 and 6 do not meet in one point");
        }
        let forward = DQuat::from_axis_angle(axes[0].1, first) * DVec3::X;
        // The axis about which the arm leans forward.
        let lean = DVec3::Z.cross(forward);
        if sine(lean, axes[1].1) > PARALLEL {
            return Err(
                "the arm does not reach along x of the controller's base where axis 1 is 0",
            );
        }
        let lower = axes[2].0 - axes[1].0;
        Ok(Self {
            front: (centre - axes[0].0).dot(forward) > 0.0,
            before_arm: lower.cross(centre - axes[2].0).dot(lean) > 0.0,
        })
    }
}

/// The point of a line nearest to another.
fn nearest((point, along): (DVec3, DVec3), (other, across): (DVec3, DVec3)) -> DVec3 {
    let normal = along.cross(across);
    let square = normal.length_squared();
    if square < 1e-12 {
        return point;
    }
    point + along * ((other - point).cross(across).dot(normal) / square)
}

/// The configuration of a posture and joint angles as the controller counts them [rad]; none where the dialect has none.
///
/// # Errors
/// Why the dialect has no words for it.
pub fn configuration(
    dialect: Dialect,
    posture: Posture,
    joints: &[f64; 6],
) -> Result<Option<Configuration>, &'static str> {
    let Posture { front, before_arm } = posture;
    let [one, _, _, four, five, six] = *joints;
    let of_three = |turn: fn(f64) -> f64| [one, four, six].map(|angle| turn(angle) as i32);
    Ok(match dialect {
        Dialect::Urscript => None,
        Dialect::Rapid => Some(Configuration::Quarters {
            turns: of_three(|angle| (angle / std::f64::consts::FRAC_PI_2).floor()),
            posture: 4 * i32::from(!front) + 2 * i32::from(!before_arm) + i32::from(five < 0.0),
        }),
        Dialect::Krl => {
            let status = u32::from(!front) + 2 * u32::from(before_arm) + 4 * u32::from(five < 0.0);
            let bits = joints.iter().enumerate();
            let turn = bits
                .map(|(bit, angle)| u32::from(*angle < 0.0) << bit)
                .sum();
            Some(Configuration::StatusTurn { status, turn })
        }
        Dialect::FanucLs if !front => {
            return Err("the wrist is behind axis 1, where up and down are the model's own");
        }
        Dialect::FanucLs => Some(Configuration::Flags {
            flip: five >= 0.0,
            up: before_arm,
            top: true,
            turns: of_three(|angle| (angle / std::f64::consts::TAU).round()),
        }),
    })
}

/// Axes of link frames with the axis of each in them.
pub(super) fn axes(links: &[(DPose3, DVec3)]) -> Option<[(DVec3, DVec3); 6]> {
    let axes: Vec<(DVec3, DVec3)> = links
        .iter()
        .map(|(link, axis)| (link.translation, link.rotation * *axis))
        .collect();
    axes.try_into().ok()
}
