//! A cell and its job, checked and in SI.

use std::path::PathBuf;

use glam::{DQuat, DVec3};
use glamx::DPose3;

use super::controller::ControllerScenario;
use super::judged::JudgedValue;
use crate::device::DeviceParameters;
use crate::effects::PresentEffect;
use crate::physics::cutting_force::CuttingForce;
use crate::physics::removal_law::RemovalLaw;
use crate::physics::spindle::Spindle;
use crate::removal::TurningTool;
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
    /// The device between flange and tool.
    pub device: DeviceScenario,
    /// The workpiece and the edge to follow.
    pub workpiece: WorkpieceScenario,
    /// Contact between tool and workpiece.
    pub contact: ContactScenario,
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
    /// Settings of its simulation.
    pub simulation: SimulationScenario,
    /// Sensing between controller and device.
    pub sensing: SensingParameters,
    /// Controllers of the regulator's pressure.
    pub controller: ControllerScenario,
    /// Bounds that the results must keep.
    pub expect: Vec<Expectation>,
    /// Physics beyond the cell, as a diagnosis writes it into improved.toml, with all its numbers; nothing that is simulated.
    pub effects: Vec<PresentEffect>,
    /// Values of tool and edge in use that nobody has measured in public; those of the device are with it.
    pub judged: Vec<JudgedValue>,
}

impl Scenario {
    /// Bounds that the results of each pass must keep.
    #[must_use]
    pub fn expect_of_passes(&self) -> Vec<Vec<Expectation>> {
        let own = self.passes.iter().map(|pass| pass.expect.clone());
        own.collect()
    }

    /// Values in use that nobody has measured in public: of tool and edge, then of the device.
    pub fn judged_values(&self) -> impl Iterator<Item = &JudgedValue> {
        self.judged.iter().chain(&self.device.judged)
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
}

/// Limits that replace those of the URDF.
#[derive(Debug, Clone, PartialEq)]
pub struct LimitOverride {
    /// Joint name.
    pub joint: String,
    /// Largest torque [N m].
    pub effort: Option<f64>,
    /// Largest speed [rad/s].
    pub velocity: Option<f64>,
}

/// Properties of one joint's drive.
#[derive(Debug, Clone, PartialEq)]
pub struct DriveScenario {
    /// Joint name.
    pub joint: String,
    /// Dry friction [N m]; the URDF's when absent.
    pub friction: Option<f64>,
    /// Stiffness of the spring between motor and link [N m/rad]; infinite for none.
    pub stiffness: f64,
    /// Its damping over its stiffness [s].
    pub damping_time: f64,
    /// Play between motor and link, from flank to flank [rad].
    pub backlash: f64,
}

/// The joint servo, the same for all axes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ServoScenario {
    /// Natural frequency of each axis about its own inertia [Hz].
    pub natural_frequency: f64,
    /// Damping ratio [1].
    pub damping_ratio: f64,
    /// Time constant of the integral action [s]; none when infinite.
    pub integral_time: f64,
    /// Whether the torque of the contact force (from the device's pressures) is fed forward.
    pub contact_feed_forward: bool,
    /// Bandwidth of the critically damped lag with which the drives take their commands [Hz]; infinite for none.
    pub lag_bandwidth: f64,
    /// Standard deviation of the encoders' noise [rad].
    pub encoder_noise: f64,
}

/// The device and its tool.
#[derive(Debug, Clone)]
pub struct DeviceScenario {
    /// File that it was read from.
    pub model: PathBuf,
    /// Pneumatics.
    pub parameters: DeviceParameters,
    /// Whether it is the source paper's in what its scenario leaves open: without friction of its seals, at constant temperature.
    pub ideal: bool,
    /// Whether the slide is clamped at the working stroke.
    pub locked: bool,
    /// Centre of the moving mass from the flange at zero stroke, along the axis [m].
    pub moving_centre_of_mass: f64,
    /// Radius of gyration of the moving mass about its centre [m].
    pub moving_radius_of_gyration: f64,
    /// Mass of the housing on the flange, which does not move with the slide [kg]; 0 where it is not known.
    pub housing_mass: f64,
    /// Its centre from the flange, along the axis [m].
    pub housing_centre_of_mass: f64,
    /// Centre of the tool's ball nose from the flange at zero stroke, along the axis [m].
    pub tool_centre: f64,
    /// Radius of the ball nose [m].
    pub tool_radius: f64,
    /// Values in use that nobody has measured in public.
    pub judged: Vec<JudgedValue>,
}

/// The workpiece.
#[derive(Debug, Clone)]
pub struct WorkpieceScenario {
    /// Mesh file.
    pub mesh: PathBuf,
    /// Metres per unit of the mesh file [m].
    pub mesh_scale: f64,
    /// Where the cell believes the part to be.
    pub world_from_part: DPose3,
    /// Which edge to follow.
    pub edge: EdgeChoice,
    /// Where the part really is, relative to that.
    pub misplacement: Misplacement,
    /// Burr on the edge.
    pub burr: BurrScenario,
    /// Thickness of its root [m].
    pub burr_root: f64,
    /// What the edge should be like.
    pub chamfer: ChamferScenario,
}

/// The edge to follow.
#[derive(Debug, Clone, PartialEq)]
pub struct EdgeChoice {
    /// An edge or a loop, by its number in `idc edges`.
    pub selection: EdgeSelection,
    /// Where to begin [m from the edge's first point].
    pub start: f64,
    /// Where to end [m]; the edge's end when absent.
    pub end: Option<f64>,
    /// Followed the other way round.
    pub reversed: bool,
    /// Dihedral angle above which an edge counts as sharp [rad].
    pub sharp_angle: f64,
}

/// Edge or loop, by number.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum EdgeSelection {
    /// A smooth edge.
    Edge(usize),
    /// A closed loop.
    Loop(usize),
}

/// True place of the part, about the middle of the followed edge.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Misplacement {
    /// Shift along the edge's outward bisector at its middle, towards the tool [m].
    pub shift: f64,
    /// Tilt in the plane of edge and bisector, the far end towards the tool [rad].
    pub tilt: f64,
}

/// Burr along the edge.
#[derive(Debug, Clone, PartialEq)]
pub enum BurrScenario {
    /// No burr.
    None,
    /// The same height everywhere [m].
    Constant {
        /// Height [m].
        height: f64,
    },
    /// Seeded random height.
    Random {
        /// Seed.
        seed: u64,
        /// Mean height [m].
        mean_height: f64,
        /// Standard deviation of the height [m].
        height_deviation: f64,
        /// Distance over which the correlation of its logarithm falls to exp(-1/2) [m].
        correlation_length: f64,
    },
    /// A single smooth bump.
    Bump {
        /// Middle, from the start of the followed edge [m].
        position: f64,
        /// Height [m].
        height: f64,
        /// Width from foot to foot [m].
        width: f64,
    },
    /// Heights from a CSV file.
    Table {
        /// CSV with `position_mm,height_mm`.
        path: PathBuf,
    },
}

/// Contact law.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ContactScenario {
    /// Stiffness [N/m].
    pub stiffness: f64,
    /// Damping [N s/m].
    pub damping: f64,
    /// Coulomb friction coefficient [1].
    pub friction: f64,
    /// Turns of the tool a second [Hz]; 0 where it is not known.
    pub spindle_frequency: f64,
    /// Runout of the tool, zero to peak [m].
    pub runout_amplitude: f64,
    /// Its turns a second [Hz].
    pub runout_frequency: f64,
}

/// The job.
#[derive(Debug, Clone, PartialEq)]
pub struct ProcessScenario {
    /// Desired contact force along the contact normal [N].
    pub force: f64,
    /// Feed along the edge [m/s].
    pub feed: f64,
    /// Feed past corners [m/s].
    pub corner_feed: f64,
    /// Whether the feed is lowered by what is measured.
    pub feed_follows: Option<FeedFollows>,
    /// Acceleration along the path [m/s2].
    pub acceleration: f64,
    /// Largest acceleration across the path [m/s2]; infinite for a feed that does not fall where the edge bends.
    pub lateral_acceleration: f64,
    /// Jerk along the path [m/s3].
    pub jerk: f64,
    /// Stroke at which the device is to work [m].
    pub working_stroke: f64,
    /// Lean of the tool axis about the edge, from the bisector towards the face on the left of the direction of travel [rad].
    pub lean: f64,
    /// Direction of the tool's axis in the world, from the flange towards the part, in place of a lean.
    pub tool_axis: Option<DVec3>,
    /// Angle of the flange's x axis about the tool's axis from the direction of travel, at the start of the edge [rad]; found by search when absent.
    pub roll: Option<f64>,
    /// Distance in front of the edge at which the motion starts [m].
    pub approach_distance: f64,
    /// Speed of approach and retraction [m/s].
    pub approach_speed: f64,
    /// Speed at which the tool is set on the edge [m/s].
    pub engage_speed: f64,
    /// Time at rest on the edge before following starts [s].
    pub settle_time: f64,
}

/// A pass along the edge; what it does not say is the process's.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct PassScenario {
    /// Desired contact force along the contact normal [N].
    pub force: Option<f64>,
    /// Feed along the edge [m/s].
    pub feed: Option<f64>,
    /// Bounds that its results must keep.
    pub expect: Vec<Expectation>,
}

/// Feed lowered by what is measured: to the share limit over measured value, within bounds, first order.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FeedFollows {
    /// What is measured.
    pub by: FeedMeasure,
    /// Its value above which the feed is lowered [N or W].
    pub limit: f64,
    /// Least share of the feed [1].
    pub least_share: f64,
    /// Time constant [s].
    pub time_constant: f64,
}

/// Value that a feed follows.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FeedMeasure {
    /// Tangential force on the tool.
    Force,
    /// Power at the tool.
    Power,
}

/// A tool that turns.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ToolScenario {
    /// The tool on its spindle.
    pub tool: TurningTool,
    /// Speed under torque.
    pub spindle: Spindle,
    /// Whether it turns only while the edge is followed.
    pub while_following: bool,
}

/// What a turning tool takes off.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RemovalScenario {
    /// Rate.
    pub law: RemovalLaw,
    /// Contact area that the law is taken at [m2].
    pub contact_area: f64,
    /// Work of force and speed that the tool has done before [J].
    pub wear_at_start: f64,
    /// Length of edge on which the tool touches at a time [m].
    pub contact_length: f64,
    /// Tangential force.
    pub cutting: CuttingForce,
}

/// What the edge should be like.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ChamferScenario {
    /// Least and largest leg [m].
    pub leg: [f64; 2],
    /// Largest burr that may be left [m].
    pub residual_burr: f64,
}

/// Bodies that must not meet.
#[derive(Debug, Clone, PartialEq)]
pub struct CollisionScenario {
    /// Least clearance between them [m].
    pub margin: f64,
    /// Height of the floor in the world [m]; that of the world's origin, unless something stands below it, when absent.
    pub floor_height: Option<f64>,
    /// Bodies that may meet, by name.
    pub allowed_pairs: Vec<[String; 2]>,
    /// What else stands in the cell.
    pub obstacles: Vec<Obstacle>,
}

/// Something that stands in the cell.
#[derive(Debug, Clone, PartialEq)]
pub struct Obstacle {
    /// Its name for people.
    pub name: String,
    /// Its shape.
    pub shape: ObstacleShape,
    /// Its place: a box's middle, a mesh's origin.
    pub world_from_obstacle: DPose3,
}

/// Shape of an obstacle.
#[derive(Debug, Clone, PartialEq)]
pub enum ObstacleShape {
    /// A box of edge lengths [m].
    Box(DVec3),
    /// A mesh file.
    Mesh {
        /// The file.
        path: PathBuf,
        /// Metres per unit of it [m].
        scale: f64,
    },
}

/// Settings of a simulation.
#[derive(Debug, Clone, PartialEq)]
pub struct SimulationScenario {
    /// Rigid-body step [s].
    pub step: f64,
    /// Pneumatic sub-steps in it.
    pub substeps: usize,
    /// Gravity in the world [m/s2].
    pub gravity: DVec3,
    /// Seed of the search for a posture and of all noise.
    pub seed: u64,
}

/// A bound on a result.
#[derive(Debug, Clone, PartialEq)]
pub struct Expectation {
    /// Name of the metric as in summary.json, unit included.
    pub metric: String,
    /// Least allowed value, in that unit.
    pub min: Option<f64>,
    /// Largest allowed value, in that unit.
    pub max: Option<f64>,
}
