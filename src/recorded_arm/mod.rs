//! A recorded arm as one description: links, drives, load, mount, surroundings and a wrench sensor, driven by the motion that was measured.
//!
//! ```text
//! g i(t + d) = M(q) q'' + h(q, q') - J(q)^T f + I q'' + friction + offset + ripple + spring + laws        of each joint
//! ```
//!
//! g torque per ampere [N m/A] (1 where torques are logged), i current, d delay of the currents, M, h inverse dynamics of links, load and tool, f a push at the
//! flange, I inertia of motor and gear at the joint's side. One effect a file; of a prismatic joint read N for N m and m for rad.

pub mod bristles;
pub mod delay;
pub mod device_mount;
pub mod drive;
pub mod filter;
pub mod fourier_path;
pub mod law;
pub mod moment;
pub mod motion;
pub mod outside;
pub mod parameters;
pub mod push;
pub mod quantity;
pub mod simulate;
pub mod sliding_mass;
pub mod spline;
pub mod tolerated;
pub mod usual;
pub mod vocabulary;
pub mod wrench;

pub use parameters::{ArmParameters, Drive, PointMass};
pub use quantity::Quantity;
pub use tolerated::Tolerated;
