//! Why a job cannot be done, said before anything moves.

use glam::DVec3;

use crate::collision::Meeting;

/// Obstacle at a waypoint. Angles [rad], torques [N m].
#[derive(Debug, Clone, PartialEq)]
pub enum Obstacle {
    /// No joint angles reach the pose; the axis that is over or nearest its limit.
    OutOfReach {
        /// Distance that is left [m].
        distance: f64,
        /// Axis with its position and limit.
        axis: Option<(String, f64, f64)>,
    },
    /// An axis would leave its range.
    Position {
        /// Axis.
        axis: String,
        /// Position it would need.
        value: f64,
        /// Its limit.
        limit: f64,
    },
    /// An axis would have to be faster than it can.
    Velocity {
        /// Axis.
        axis: String,
        /// Speed it would need [rad/s].
        value: f64,
        /// Its limit.
        limit: f64,
    },
    /// An axis would need more torque than it has.
    Effort {
        /// Axis.
        axis: String,
        /// Torque it would need.
        value: f64,
        /// Its limit.
        limit: f64,
    },
    /// The pose is within reach, but not from the one before without a change of posture.
    PostureChange {
        /// Axis that would have to jump.
        axis: String,
        /// Its position in the pose before [rad].
        value: f64,
        /// Its position in the pose [rad].
        needed: f64,
    },
    /// Two bodies come nearer than they may.
    Collision(Box<Meeting>),
    /// The arm is all but singular.
    Singular {
        /// Smallest singular value of the scaled Jacobian [1].
        value: f64,
        /// Least that is accepted.
        limit: f64,
        /// Axis that would move most.
        axis: String,
    },
}

impl std::fmt::Display for Obstacle {
    fn fmt(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
        match self {
            Self::OutOfReach { distance, axis } => {
                write!(f, "out of reach by {:.1} mm", 1e3 * distance)?;
                if let Some((axis, value, limit)) = axis {
                    write!(
                        f,
                        "; in the nearest pose axis {axis} is at {:.1} deg, its limit is {:.1} deg",
                        value.to_degrees(),
                        limit.to_degrees()
                    )?;
                }
                Ok(())
            }
            Self::Position { axis, value, limit } => write!(
                f,
                "axis {axis} would need {:.1} deg, its limit is {:.1} deg",
                value.to_degrees(),
                limit.to_degrees()
            ),
            Self::Velocity { axis, value, limit } => write!(
                f,
                "axis {axis} would need {:.2} deg/s, its limit is {:.2} deg/s",
                value.abs().to_degrees(),
                limit.to_degrees()
            ),
            Self::Effort { axis, value, limit } => {
                write!(
                    f,
                    "axis {axis} would need {:.2} N m, its limit is {limit:.2} N m",
                    value.abs()
                )
            }
            Self::PostureChange {
                axis,
                value,
                needed,
            } => write!(
                f,
                "within reach only after a change of posture: axis {axis} would have to jump from {:.1} to {:.1} deg",
                value.to_degrees(),
                needed.to_degrees()
            ),
            Self::Collision(meeting) => {
                let Meeting {
                    names: [first, second],
                    depth,
                    margin,
                    ..
                } = &**meeting;
                if *depth >= 0.0 {
                    write!(
                        f,
                        "collision: {first} meets {second}, at worst {:.1} mm deep",
                        1e3 * depth
                    )?;
                } else {
                    write!(
                        f,
                        "collision: {first} comes within {:.1} mm of {second}",
                        -1e3 * depth
                    )?;
                }
                if *margin > 0.0 {
                    write!(
                        f,
                        " (clearance asked for: collision.margin_mm = {})",
                        1e3 * margin
                    )?;
                }
                Ok(())
            }
            Self::Singular { value, limit, axis } => write!(
                f,
                "the arm is all but singular (smallest singular value {value:.5}, least accepted {limit}); axis {axis} would move most"
            ),
        }
    }
}

/// A job that cannot be planned.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum PlanError {
    /// A waypoint cannot be passed.
    #[error("{phase}, waypoint {waypoint} of {waypoints} at {:.1} mm along the edge, point ({:.1}, {:.1}, {:.1}) mm: {obstacle}",
        1e3 * edge_length, 1e3 * point.x, 1e3 * point.y, 1e3 * point.z)]
    Waypoint {
        /// Phase of the job.
        phase: &'static str,
        /// Waypoint, counted from 1.
        waypoint: usize,
        /// Waypoints of the phase.
        waypoints: usize,
        /// Length along the edge [m].
        edge_length: f64,
        /// Point of the edge in the world [m].
        point: DVec3,
        /// The obstacle.
        obstacle: Obstacle,
    },
    /// Bodies that stand still stand in each other.
    #[error("{} stands {:.1} mm deep in {}", _0.names[0], 1e3 * _0.depth, _0.names[1])]
    Penetration(Box<Meeting>),
    /// A given direction of the tool that stands too far from the bisector.
    #[error("at {:.1} mm along the edge, point ({:.1}, {:.1}, {:.1}) mm, the tool's axis ({:.3}, {:.3}, {:.3}) stands {:.1} deg from the edge's bisector ({:.3}, {:.3}, {:.3}), expected at most {:.0} deg: turn the part, or choose another process.tool_axis",
        1e3 * edge_length, 1e3 * point.x, 1e3 * point.y, 1e3 * point.z, axis.x, axis.y, axis.z, lean.to_degrees(), bisector.x, bisector.y, bisector.z, most.to_degrees())]
    Lean {
        /// Length along the edge [m].
        edge_length: f64,
        /// Point of the edge in the world [m].
        point: DVec3,
        /// Angle between them [rad].
        lean: f64,
        /// Largest that is accepted [rad].
        most: f64,
        /// The tool's axis, towards the part.
        axis: DVec3,
        /// The bisector, into the part.
        bisector: DVec3,
    },
    /// A corner that turns inwards.
    #[error("the edge turns inwards by {:.0} deg at {:.1} mm, point ({:.1}, {:.1}, {:.1}) mm: a ball cannot reach into a sharp inside corner; choose a stretch without it",
        turn.to_degrees(), 1e3 * edge_length, 1e3 * point.x, 1e3 * point.y, 1e3 * point.z)]
    InwardCorner {
        /// Length along the edge [m].
        edge_length: f64,
        /// The corner in the world [m].
        point: DVec3,
        /// Angle turned [rad].
        turn: f64,
    },
}

impl PlanError {
    /// Whether bodies meet along the motion.
    pub(super) fn is_collision(&self) -> bool {
        let Self::Waypoint { obstacle, .. } = self else {
            return false;
        };
        matches!(obstacle, Obstacle::Collision(_))
    }
}
