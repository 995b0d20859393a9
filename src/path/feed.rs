//! Feed along the edge: as asked for, less at corners and where the edge bends (`curvature`), and less where an axis could not keep up.

use super::curvature::feed_limit;
use super::error::{Obstacle, PlanError};
use super::profile::SpeedSection;
use super::request::{KNOT_SPACING, Phase, PlanRequest, waypoint_error};
use super::spline::Spline;
use super::toolpath::Stretch;
use crate::arm::chain::MAX_JOINTS;

/// Share of an axis's speed limit that a slowed feed may use [1].
const SPEED_SHARE: f64 = 0.9;
/// Length over which the feed may be slowed for an axis's speed limit [m].
const FEED_CHUNK: f64 = 1e-2;
/// The same for its curvature, which changes over shorter lengths.
const BEND_CHUNK: f64 = 2e-3;
/// Share of the feed below which slowing down would no longer be following [1].
const LEAST_SHARE: f64 = 0.1;

/// Where the feed had to be slowed most.
struct Slowest {
    speed: f64,
    place: f64,
    joint: usize,
}

/// Speed limits along the edge at a feed [m/s] for joint angles over the path, and a note if the feed had to be slowed.
///
/// # Errors
/// An axis is so slow that next to nothing of the feed would be left.
pub(super) fn sections(
    request: &PlanRequest,
    feed: f64,
    spline: &Spline,
) -> Result<(Vec<SpeedSection>, Option<String>), PlanError> {
    let mut sections = Vec::new();
    let mut slowest: Option<Slowest> = None;
    for section in request.tool_path.sections() {
        let wanted = match section.stretch {
            Stretch::Edge { .. } => feed,
            Stretch::Corner { .. } => feed.min(request.corner_feed),
        };
        let bends = matches!(section.stretch, Stretch::Edge { .. })
            && request.lateral_acceleration.is_finite();
        let chunk = if bends { BEND_CHUNK } else { FEED_CHUNK };
        let chunks = (section.length / chunk).ceil().max(1.0);
        let length = section.length / chunks;
        for chunk in 0..chunks as usize {
            let place = section.start + length * chunk as f64;
            let ends = [place, place + length];
            let wanted = match bends {
                true => wanted.min(feed_limit(
                    &request.tool_path,
                    section,
                    ends,
                    request.lateral_acceleration,
                )),
                false => wanted,
            };
            let (speed, joint) = speed_cap(request, spline, place, place + length);
            if speed < wanted && slowest.as_ref().is_none_or(|s| speed < s.speed) {
                slowest = Some(Slowest {
                    speed,
                    place,
                    joint,
                });
            }
            sections.push(SpeedSection {
                length,
                speed: wanted.min(speed),
            });
        }
    }
    let note = slowest
        .map(|slowest| note(request, feed, spline, &slowest))
        .transpose()?;
    Ok((sections, note))
}

fn note(
    request: &PlanRequest,
    feed: f64,
    spline: &Spline,
    slowest: &Slowest,
) -> Result<String, PlanError> {
    let axis = &request.arm.joints[slowest.joint];
    if slowest.speed < LEAST_SHARE * feed {
        let obstacle = Obstacle::Velocity {
            axis: axis.name.clone(),
            value: axis.velocity * SPEED_SHARE * feed / slowest.speed,
            limit: axis.velocity,
        };
        let (waypoint, count) = (
            (slowest.place / KNOT_SPACING) as usize,
            spline.knots().len(),
        );
        return Err(waypoint_error(
            &request.tool_path,
            Phase::Follow,
            waypoint,
            count,
            slowest.place,
            obstacle,
        ));
    }
    Ok(format!(
        "the feed is slowed to {:.1} mm/s near {:.1} mm of the edge, where axis {} reaches {:.0} % of its speed limit",
        1e3 * slowest.speed,
        1e3 * request.tool_path.at(slowest.place).edge_length,
        axis.name,
        100.0 * SPEED_SHARE
    ))
}

/// Largest speed between two places that every axis can follow [m/s], and the axis that limits it.
fn speed_cap(request: &PlanRequest, spline: &Spline, start: f64, end: f64) -> (f64, usize) {
    let (mut value, mut slope, mut bend) =
        ([0.0; MAX_JOINTS], [0.0; MAX_JOINTS], [0.0; MAX_JOINTS]);
    let n = request.arm.len();
    let mut worst = (0.0, 0);
    for i in 0..=8 {
        let place = start + (end - start) * f64::from(i) / 8.0;
        spline.at(place, &mut value[..n], &mut slope[..n], &mut bend[..n]);
        for (joint, axis) in request.arm.joints.iter().enumerate() {
            let share = slope[joint].abs() / axis.velocity;
            if share > worst.0 {
                worst = (share, joint);
            }
        }
    }
    (SPEED_SHARE / worst.0.max(1e-12), worst.1)
}
