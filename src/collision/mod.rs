//! Bodies of a cell that must not meet: the arm's links, the device, the tool, the part, obstacles and the floor, checked along a motion.
//!
//! Between two moments at which a pair is apart by `d0` and `d1` its clearance is at least
//!
//! ```text
//! (d0 + d1 - s) / 2,   s = sum over joints of R_j V_j
//! ```
//!
//! R_j greatest distance of the moving body's points from joint j [m] (1 where it slides), V_j way of joint j meanwhile [rad or m], of the joints between the two
//! bodies. Over a short time a closer bound on the way there and back is taken, of second order in the joints' ways (Taylor's remainder of the position, whose
//! second derivatives are at most R),
//!
//! ```text
//! s = c + 2 R (sum V_j)^2 + 2 sum R_j e_j
//! ```
//!
//! c largest distance of a point of the body between the two moments [m], R the largest of R_j, e_j how far joint j gets from a straight course between them. Where that is not enough the time between is halved, so that nothing thin slips through (adaptive dynamic collision checking: Schwarzer, Saha,
//! Latombe, IEEE Trans. Robotics 21(3), 2005). Distances are those of Rapier's parry: of a link's mesh its convex hull counts, of part and obstacles the surface.

mod ball;
mod bodies;
mod body;
mod model;
mod motion;
mod sweep;
mod watch;

#[cfg(test)]
mod tests;

pub use ball::{RIDDEN_ZONE, RiddenEdge};
pub use bodies::{fixed_body, floor_at, links_of, robot_body};
pub use body::{Body, Mount, Solid, SolidError};
pub use model::{CollisionModel, ModelError, ModelRequest, Pair, PlacedBody, Role};
pub use motion::JointMotion;
pub use sweep::{Meeting, Place};
pub use watch::ClearanceWatch;

/// Positions of all joints, the slide's last [rad or m]; slots past the chain's last joint are zero.
pub type Positions = [f64; crate::arm::chain::MAX_JOINTS];
