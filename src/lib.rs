//! Simulation of a robot deburring cell with a pneumatic constant-force end effector.
//!
//! Data flows one way: scenario -> cell -> simulation -> recording -> metrics -> report.
//!
//! - [`physics`]: the pneumatic equations, one effect a file
//! - [`device`]: the device made of them
//! - [`arm`]: the robot arm from URDF: kinematics, dynamics
//! - [`workpiece`]: mesh, edges, burrs, where a ball touches
//! - [`estimation`]: contact force without a load cell, with its uncertainty
//! - [`scenario`]: the file that says what to simulate, checked
//! - [`path`]: the tool's path along an edge and the joint motion that follows it
//! - [`cell`]: all of it assembled and checked
//! - [`control`]: joint servo and force controllers
//! - [`recording`]: sampled signals, Parquet, Rerun
//! - [`simulation`]: the coupled step
//! - [`rig`]: the bench rig, the device without an arm
//! - [`design`]: the design study
//! - [`diagnosis`]: what physics recordings contain that the believed model leaves out
//! - [`case`]: a folder with recordings, read and diagnosed
//! - [`laboratory`]: recordings of devices by equations of its own, to prove a diagnosis with
//! - [`proof`]: a diagnosis scored on the laboratory's cases
//! - [`metrics`]: the numbers of a run
//! - [`drawing`]: a scene as an SVG picture
//! - [`figure`]: signals as SVG pictures
//! - [`quantity`]: numbers with their units as people read them
//! - [`report`]: tables for people
//! - [`app`]: the command line and the files that it writes
// Units stand in square brackets, which rustdoc would take for links.
#![allow(rustdoc::broken_intra_doc_links)]

#[cfg(feature = "cli")]
pub mod app;
pub mod arm;
pub mod case;
pub mod cell;
pub mod control;
#[cfg(feature = "cli")]
pub mod design;
pub mod device;
pub mod diagnosis;
#[cfg(feature = "cli")]
pub mod drawing;
pub mod effects;
pub mod estimation;
#[cfg(feature = "cli")]
pub mod figure;
#[cfg(feature = "import")]
pub mod import;
#[cfg(feature = "cli")]
pub mod laboratory;
pub mod metrics;
#[cfg(feature = "cli")]
pub mod page;
pub mod path;
pub mod physics;
pub mod plant;
#[cfg(feature = "cli")]
pub mod proof;
pub mod quantity;
pub mod recording;
pub mod replay;
#[cfg(feature = "cli")]
pub mod report;
pub mod rig;
pub mod scenario;
pub mod sensing;
pub mod simulation;
pub mod workpiece;

pub use case::{Case, Diagnosed, diagnose};
pub use cell::Cell;
pub use diagnosis::settings::Settings;
pub use recording::Recording;
pub use rig::Rig;
