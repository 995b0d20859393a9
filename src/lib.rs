//! Simulation of a robot deburring cell with a pneumatic constant-force end effector.
//!
//! Data flows one way: scenario -> cell -> simulation -> recording -> metrics -> report.
//!
//! - [`file`]: files opened for reading: regular ones alone, up to a limit
//! - [`listed`]: enums whose variants are listed and named
//! - [`unit`]: units, each declared once
//! - [`xml`]: XML within limits
//! - [`stats`]: median, quantiles, distributions: one rule for each
//! - [`quantity`]: numbers with their units as people read them
//! - [`physics`]: the pneumatic equations, one effect a file
//! - [`device`]: the device made of them
//! - [`mesh_file`]: STL, OBJ, COLLADA, PLY and glTF files as triangles
//! - [`arm`]: the robot arm from URDF: kinematics, dynamics
//! - [`recorded_arm`]: a recorded arm as one description of numbers, driven by the motion that was measured
//! - [`removal`]: what a turning tool takes off an edge
//! - [`workpiece`]: mesh, edges, burrs, where a ball touches
//! - [`collision`]: bodies that must not meet, checked along a motion
//! - [`path`]: the tool's path along an edge and the joint motion that follows it
//! - [`sensing`]: the chain between controller and device: converters, amplifiers, filters, sensors
//! - [`control`]: joint servo and force controllers
//! - [`estimation`]: contact force without a load cell, with its uncertainty
//! - [`keys`]: keys of files as they are declared: read, checked, in SI
//! - [`shell`]: paths as a shell takes them
//! - [`scenario`]: the file that says what to simulate, checked
//! - [`cell`]: all of it assembled and checked
//! - `advice`: what would make a refused job possible
//! - [`place`]: where the part of a cell can lie
//! - `robot_program`: a planned path as a program of a robot's maker, and such programs read
//! - [`simulation`]: the coupled step
//! - [`rig`]: the bench rig, the device without an arm
//! - [`recording`]: sampled signals, CSV, Parquet
//! - `ros_bag`: messages of ROS 2 in an MCAP
//! - [`scene`]: a recording in space
//! - `viewer`: both for Rerun's viewer
//! - [`metrics`]: the numbers of a run
//! - [`run`]: a scenario run to its end, with its numbers
//! - [`document`]: results for people as typed documents, rendered as text, Markdown and HTML
//! - [`report`]: results as such documents
//! - [`design`]: the design study
//! - [`plant`]: a rig as one description of numbers, driven by the inputs of a recording
//! - [`flange`]: another device, a contact flange
//! - [`replay`]: the loads of the device in a recorded cell, from the arm's commands
//! - `fmu`: a bench rig as a functional mock-up unit
//! - [`effects`]: the physics that a description may lack, one effect a file
//! - [`import`]: logs of real devices made into recordings
//! - [`case`]: a folder with recordings, read and diagnosed
//! - [`diagnosis`]: the physics in recordings that the nominal model leaves out
//! - `excitation`: a motion that tells an arm's numbers apart
//! - [`laboratory`]: recordings of devices by equations of its own, to prove a diagnosis with
//! - [`proof`]: a diagnosis scored on the laboratory's cases
//! - [`vary`]: sweeps of a scenario: the values of each run, and what drives its numbers
//! - [`demonstration`]: short runs in which each effect shows
//! - [`tasks`]: runs and diagnoses as tasks named by content, and the engines that do them
//! - [`fleet`]: many recordings of many devices, and what their numbers say over time
//! - [`figure`]: signals as SVG pictures
//! - [`drawing`]: a scene as an SVG picture
//! - [`app`]: the command line and the files that it writes
//! - `python`: the extension module of the Python package `idc`
// Units stand in square brackets, which rustdoc would take for links.
#![allow(rustdoc::broken_intra_doc_links)]

#[cfg(feature = "cli")]
pub mod advice;
#[cfg(feature = "cli")]
pub mod app;
pub mod arm;
pub mod case;
pub mod cell;
pub mod collision;
pub mod control;
pub mod demonstration;
#[cfg(feature = "cli")]
pub mod design;
pub mod device;
pub mod diagnosis;
pub mod document;
#[cfg(feature = "cli")]
pub mod drawing;
pub mod effects;
pub mod estimation;
#[cfg(feature = "cli")]
pub mod excitation;
#[cfg(feature = "cli")]
pub mod figure;
pub mod file;
pub mod flange;
pub mod fleet;
#[cfg(feature = "fmu")]
pub mod fmu;
#[cfg(feature = "import")]
pub mod import;
pub mod keys;
#[cfg(feature = "cli")]
pub mod laboratory;
pub mod listed;
pub mod mesh_file;
pub mod metrics;
pub mod path;
pub mod physics;
#[cfg(feature = "cli")]
pub mod place;
pub mod plant;
#[cfg(feature = "cli")]
pub mod proof;
#[cfg(feature = "python")]
pub mod python;
pub mod quantity;
pub mod recorded_arm;
pub mod recording;
pub mod removal;
pub mod replay;
pub mod report;
pub mod rig;
#[cfg(feature = "cli")]
pub mod robot_program;
#[cfg(feature = "import")]
pub mod ros_bag;
pub mod run;
pub mod scenario;
pub mod scene;
pub mod sensing;
pub mod shell;
pub mod simulation;
pub mod stats;
#[cfg(feature = "cli")]
pub mod tasks;
pub mod unit;
pub mod vary;
#[cfg(feature = "viewer")]
pub mod viewer;
pub mod workpiece;
pub mod xml;

pub use case::{Case, Diagnosed, diagnose};
pub use cell::Cell;
pub use diagnosis::settings::Settings;
pub use recording::Recording;
pub use rig::Rig;
