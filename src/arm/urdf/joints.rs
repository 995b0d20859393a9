//! One moving joint of the path: axis, limits, damping and friction.

use super::graph::kind_of;
use super::tree::{Moving, unit_axis, within};
use super::{ArmOptions, Refusal};
use crate::arm::chain::{BodyInertia, Joint, JointKind};
use urdf_rs::JointType;

/// Speed of a recorded arm's joint of which its file says none [rad/s or m/s].
const USUAL_SPEED: f64 = 2.0;

/// Turns a joint of the file into one of the chain.
pub(super) fn path_joint(
    moving: &Moving,
    body: BodyInertia,
    options: &ArmOptions,
    notes: &mut Vec<String>,
) -> Result<Joint, Refusal> {
    let source = moving.joint;
    let (lower, upper) = match position_limits(source, notes) {
        Err(_) if options.is_recorded => (f64::NEG_INFINITY, f64::INFINITY),
        limits => limits?,
    };
    let replaced = options.limit_overrides.get(&source.name);
    let mut drive_limit = |limit, in_file: f64, usual: f64, replacement: Option<f64>| {
        let value = replacement.unwrap_or(in_file);
        if replacement.is_some() {
            notes.push(format!(
                "joint {}: {limit} limit {in_file} of the file is overridden by {value}",
                source.name
            ));
        }
        if value.is_finite() && value > 0.0 {
            Ok(value)
        } else if options.is_recorded {
            Ok(usual)
        } else {
            Err(Refusal::DriveLimit {
                joint: source.name.clone(),
                limit,
                key: match limit {
                    "effort" => "effort_n_m",
                    _ => "velocity_deg_per_s",
                },
                value,
            })
        }
    };
    let limit = &source.limit;
    let effort = drive_limit(
        "effort",
        limit.effort,
        f64::INFINITY,
        replaced.and_then(|r| r.effort),
    )?;
    let velocity = drive_limit(
        "velocity",
        limit.velocity,
        USUAL_SPEED,
        replaced.and_then(|r| r.velocity),
    )?;
    if limit.acceleration.is_finite() || limit.deceleration.is_finite() || limit.jerk.is_finite() {
        notes.push(format!(
            "joint {}: acceleration, deceleration and jerk limits are not used",
            source.name
        ));
    }
    let dynamics = source.dynamics.clone().unwrap_or_default();
    Ok(Joint {
        name: source.name.clone(),
        // A joint is on the list of moving ones because it has a kind.
        kind: kind_of(source)?.unwrap_or(JointKind::Revolute),
        parent_from_joint: moving.parent_from_joint,
        axis: unit_axis(source)?,
        lower,
        upper,
        effort,
        velocity,
        damping: not_negative(source, "damping", dynamics.damping)?,
        friction: not_negative(source, "friction", dynamics.friction)?,
        body,
    })
}

/// Largest damping and friction [N m s/rad, N m, N s/m or N].
const LARGEST: f64 = 1e6;

fn not_negative(source: &urdf_rs::Joint, what: &'static str, value: f64) -> Result<f64, Refusal> {
    if value.is_finite() && value >= 0.0 {
        let unit = "N m s/rad, N m, N s/m or N";
        within(value, LARGEST, unit, || {
            format!("{what} of joint `{}`", source.name)
        })?;
        Ok(value)
    } else {
        Err(Refusal::JointDynamics {
            joint: source.name.clone(),
            what,
            value,
        })
    }
}

/// Position limits, narrowed by the safety controller's soft limits.
fn position_limits(
    source: &urdf_rs::Joint,
    notes: &mut Vec<String>,
) -> Result<(f64, f64), Refusal> {
    if source.joint_type == JointType::Continuous {
        return Ok((f64::NEG_INFINITY, f64::INFINITY));
    }
    let check = |lower: f64, upper: f64, origin| {
        if lower < upper {
            Ok((lower, upper))
        } else {
            Err(Refusal::PositionLimits {
                joint: source.name.clone(),
                lower,
                upper,
                origin,
            })
        }
    };
    let (lower, upper) = check(source.limit.lower, source.limit.upper, "")?;
    let Some(safety) = &source.safety_controller else {
        return Ok((lower, upper));
    };
    let (soft_lower, soft_upper) = (safety.soft_lower_limit, safety.soft_upper_limit);
    // Both default to zero in a safety controller that only gives gains.
    if soft_lower == 0.0 && soft_upper == 0.0 {
        return Ok((lower, upper));
    }
    let narrowed = (soft_lower.max(lower), soft_upper.min(upper));
    if narrowed != (lower, upper) {
        notes.push(format!(
            "joint {}: position limits {lower} to {upper} are narrowed by its safety controller to {} to {}",
            source.name, narrowed.0, narrowed.1
        ));
    }
    check(
        narrowed.0,
        narrowed.1,
        " after its safety controller's soft limits",
    )
}
