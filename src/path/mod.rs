//! From an edge to joint motion: the tool's path along the edge, its timing, and the joint angles that follow it.
//!
//! - [`toolpath`]: where the tool touches and how its axis stands, along the edge;
//! - [`profile`]: how far along it is at each time, jerk-limited;
//! - [`spline`]: smooth joint angles over the path;
//! - [`plan`]: the whole job (approach, engage, settle, follow, retract), checked against the arm's limits before anything moves.

mod choice;
mod collisions;
mod curvature;
mod error;
mod feed;
mod legs;
pub mod plan;
mod poses;
mod posture;
pub mod profile;
mod reference;
pub mod request;
pub mod spline;
pub mod toolpath;
pub mod torques;

pub use choice::Outline;
pub use error::{Obstacle, PlanError};
pub use plan::{Plan, Stretch};
#[cfg(feature = "cli")]
pub(crate) use posture::rotation_vector;
pub use reference::Reference;
pub use request::{Pass, Phase, PlanRequest};
pub use toolpath::{ToolAxis, ToolPath, ToolStation};
pub use torques::TorqueRange;
