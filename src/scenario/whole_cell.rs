//! A cell and its job as a scenario file states them, with the arm and its file of drives and sensor.

use std::path::PathBuf;

use glam::DQuat;
use glamx::DPose3;

use super::arm_file::ArmFile;
use super::assumed::AssumedValue;
use super::cell::{
    CollisionScenario, DeviceScenario, DriveScenario, Expectation, LimitOverride, PassScenario,
    ProcessScenario, RemovalScenario, ServoScenario, SimulationScenario, ToolScenario,
    WorkpieceScenario,
};
use super::controller::ControllerScenario;
use super::program::ProgramScenario;
use crate::effects::PresentEffect;
use crate::plant::{Nominal, OperatingLimits, PlantParameters};
use crate::sensing::SensingParameters;

/// A whole cell and its job.
#[derive(Debug, Clone)]
pub struct Scenario {
    /// File that it was read from.
    pub path: PathBuf,
    /// Name for people; becomes the recording's title.
    pub title: String,
    /// The robot arm.
    pub arm: ArmScenario,
    /// Physics of device and contact as the file states them; of the joints too, once the arm is loaded.
    pub nominal: Nominal<PlantParameters>,
    /// The device between flange and tool, its physics apart.
    pub device: DeviceScenario,
    /// The workpiece and the edge to follow.
    pub workpiece: WorkpieceScenario,
    /// Process of the cell.
    pub process: ProcessScenario,
    /// Passes along the edge as they differ from the process; empty for one that does not.
    pub passes: Vec<PassScenario>,
    /// Tool on a spindle, if it turns.
    pub tool: Option<ToolScenario>,
    /// What it takes off.
    pub removal: Option<RemovalScenario>,
    /// What must not meet.
    pub collision: CollisionScenario,
    /// What a robot's program of it says beyond the cell.
    pub program: ProgramScenario,
    /// Settings of its simulation.
    pub simulation: SimulationScenario,
    /// Sensing between controller and device.
    pub sensing: SensingParameters,
    /// Controllers of the regulator's pressure.
    pub controller: ControllerScenario,
    /// How far an experiment may move it.
    pub limits: OperatingLimits,
    /// Bounds that the results must keep.
    pub expect: Vec<Expectation>,
    /// Effects beyond the nominal cell, of `[[effect]]` or of improved.toml, with all their numbers.
    pub effects: Vec<PresentEffect>,
    /// Values of tool and edge in use that nobody has measured in public; those of the device are with it.
    pub assumed: Vec<AssumedValue>,
}

impl Scenario {
    /// Bounds that the results of each pass must keep.
    #[must_use]
    pub fn expect_of_passes(&self) -> Vec<Vec<Expectation>> {
        let own = self.passes.iter().map(|pass| pass.expect.clone());
        own.collect()
    }

    /// Values in use that nobody has measured in public: of tool and edge, then of the device.
    pub fn assumed_values(&self) -> impl Iterator<Item = &AssumedValue> {
        self.assumed.iter().chain(&self.device.assumed)
    }
}

/// The arm.
#[derive(Debug, Clone)]
pub struct ArmScenario {
    /// URDF file.
    pub urdf: PathBuf,
    /// Link that carries the arm; the URDF's root when absent.
    pub base_link: Option<String>,
    /// Link on which the device is mounted.
    pub flange_link: String,
    /// Turn of the frame along whose +z the device is mounted, in that of the link.
    pub flange_from_mount: DQuat,
    /// Mass of the whole robot with its base, of which links that have none in the URDF take the share of their volume [kg].
    pub whole_mass: Option<f64>,
    /// How far an estimated mass may be off, as a share of it [1].
    pub mass_spread: f64,
    /// Masses of links, by name [kg].
    pub link_masses: std::collections::BTreeMap<String, f64>,
    /// Folders of ROS packages by name, for `package://`.
    pub package_directories: std::collections::BTreeMap<String, PathBuf>,
    /// Limits for joints whose file gives none: joint name, effort [N m], velocity [rad/s].
    pub limit_overrides: Vec<LimitOverride>,
    /// Base in the world.
    pub world_from_base: DPose3,
    /// Mass that it may carry on its flange [kg]; its maker's, where that is known, when absent.
    pub payload: Option<f64>,
    /// Joint positions near which a solution is sought first [rad]; found by search when absent.
    pub seed_posture: Option<Vec<f64>>,
    /// Joints whose drives are not as the URDF has them.
    pub drives: Vec<DriveScenario>,
    /// The joint servo.
    pub servo: ServoScenario,
    /// The arm's drives, load and wrench sensor, with the effects that the scenario puts into them.
    pub recorded_arm: Option<Box<ArmFile>>,
}
