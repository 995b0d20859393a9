//! Parts of a cell and its job, checked and in SI.

use std::path::PathBuf;

use glam::DVec3;
use glamx::DPose3;
use serde::Deserialize;

use super::assumed::AssumedValue;
use crate::keys::declaration::{Below, Filled, keys};
use crate::keys::schema::type_schema;
use crate::physics::cutting_force::CuttingForce;
use crate::physics::removal_law::RemovalLaw;
use crate::physics::spindle::Spindle;
use crate::plant::registry;
use crate::removal::TurningTool;
use crate::unit::Unit;

/// The device's file, and how it is used.
#[derive(Debug, Clone)]
pub struct DeviceScenario {
    /// File that it was read from.
    pub model: PathBuf,
    /// Whether it is the source paper's in what its scenario leaves open: without friction of its seals, at constant temperature.
    pub ideal: bool,
    /// Whether the slide is clamped at the working stroke.
    pub locked: bool,
    /// Values in use that nobody has measured in public.
    pub assumed: Vec<AssumedValue>,
}

/// The workpiece.
#[derive(Debug, Clone)]
pub struct WorkpieceScenario {
    /// Mesh file.
    pub mesh: PathBuf,
    /// Metres per unit of the mesh file [m].
    pub mesh_scale: f64,
    /// Nominal pose of the part.
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

keys! {
    /// `[[arm.limit_overrides]]`: limits that replace those of the URDF.
    pub struct LimitOverride {
        /// joint's name in the URDF
        joint: String = "joint", being "each joint once";
        /// largest torque
        effort: Option<f64> = "effort_n_m" in 0.1..=1e5;
        /// largest speed
        velocity: Option<f64> = "velocity_deg_per_s" in 1..=2000;
    }

    /// `[[arm.drives]]`: one joint's drive.
    pub struct DriveScenario {
        /// joint's name in the URDF
        joint: String = "joint", being "each joint once";
        /// dry friction of the joint; the URDF's when left out
        friction: Option<f64> = "friction_n_m", of registry::DRIVE_FRICTION;
        /// spring between motor and link; `inf` for none. The motor then has half the joint's own inertia besides
        stiffness: f64 = "stiffness_n_m_per_rad", of registry::JOINT_STIFFNESS;
        /// damping of that spring over its stiffness
        damping_time: f64 = "damping_time_ms", of registry::JOINT_DAMPING;
        /// play between motor and link, from flank to flank; needs the stiffness of the teeth
        backlash: f64 = "backlash_deg", of registry::JOINT_PLAY;
    }

    /// `[arm.servo]`: the joint servo, the same for all axes.
    pub struct ServoScenario: Copy {
        /// natural frequency of each axis about its own inertia
        natural_frequency: f64 = "natural_frequency_hz" in 1..=200, or 40.0;
        /// damping ratio
        damping_ratio: f64 = "damping_ratio" in 0.1..=10.0, or 1.0;
        /// time constant of the integral action; `inf` for none
        integral_time: f64 = "integral_time_s" in 0.001..=f64::INFINITY, or 0.1;
        /// is the torque of the contact force, from the device's pressures, fed forward?
        contact_feed_forward: bool = "contact_feed_forward", or true;
        /// drives that trail their commands: a critically damped second-order lag of this bandwidth ahead of the servo; `inf` for none
        lag_bandwidth: f64 = "lag_bandwidth_hz", of registry::SERVO_BANDWIDTH;
        /// standard deviation of the encoders' noise; encoders sit on the motors, as recorded in `joint_N_encoder_rad`
        encoder_noise: f64 = "encoder_noise_rad" in 0.0..=0.01, or 0.0;
    }

    /// `[workpiece.misplacement]`: true place of the part, about the middle of the followed edge.
    pub struct Misplacement: Copy, Default {
        /// along the edge's outward bisector in the middle of the followed edge, towards the tool
        shift: f64 = "shift_mm" in -50..=50, or 0.0;
        /// about that middle, in the plane of edge and bisector, the far end towards the tool
        tilt: f64 = "tilt_deg" in -10..=10, or 0.0;
    }

    /// `[contact]`: contact law.
    pub(super) struct ContactKeys {
        /// contact stiffness between tool and workpiece
        stiffness: f64 = "stiffness_n_per_m", of registry::CONTACT_STIFFNESS;
        /// contact damping
        damping: f64 = "damping_n_s_per_m", of registry::CONTACT_DAMPING;
        /// Coulomb friction
        friction: f64 = "friction_coefficient", of registry::EDGE_FRICTION;
        /// turns of the tool a second, 0 where it is not known
        spindle_frequency: f64 = "spindle_frequency_hz", of registry::SPINDLE_FREQUENCY;
        /// runout of the tool, zero to peak: it stands out towards the part in turn
        runout_amplitude: f64 = "runout_um" in 0..=1000, or 0.0;
        /// its turns a second; the spindle's where those are given
        runout_frequency: f64 = "runout_frequency_hz", of registry::RUNOUT_FREQUENCY, else usual_runout(spindle_frequency);
    }

    /// `[process]`: the job.
    pub struct ProcessScenario {
        /// desired contact force along the contact normal
        force: f64 = "force_n" in 0.1..=5000.0;
        /// feed along the edge
        feed: f64 = "feed_mm_per_s" in 0.1..=1000.0;
        /// feed past corners, at most the feed
        corner_feed: f64 = "corner_feed_mm_per_s" in 0.05..=1000.0, else feed / 2.0, shown "half the feed";
        /// largest acceleration along the path
        acceleration: f64 = "acceleration_mm_per_s2" in 1..=20_000, or 500.0;
        /// largest acceleration across the path: where the edge bends the feed is at most the root of it times the radius; inf for a feed that no bend lowers
        lateral_acceleration: f64 = "lateral_acceleration_mm_per_s2" in 1.0..=f64::INFINITY, or f64::INFINITY;
        /// largest jerk along the path
        jerk: f64 = "jerk_mm_per_s3" in 10.0..=1e6, or 5000.0;
        /// stroke at which the device is to work, less than its full stroke
        working_stroke: f64 = "working_stroke_mm" in 0.1..=500.0, or f64::NAN, shown "half the device's stroke";
        /// lean of the tool's axis about the edge, from the bisector towards the face on the left of the direction of travel
        lean: f64 = "lean_deg" in -60..=60, or 0.0;
        /// passes along the edge, all alike; none beside `[[pass]]`
        passes: usize = "passes" in 1..=100, or 1;
        /// in place of a lean: "down", or the direction of the tool's axis in the world, from the flange to the part, as in [0, 0, -1]; at most 60 deg from the
        /// edge's bisector
        tool_axis: Option<Direction> = "tool_axis";
        /// angle of the flange's x axis about the tool's axis, from the direction of travel at the start of the edge; when left out, that which keeps farthest from
        /// collisions, singularities and limits is found by search
        roll: Option<f64> = "roll_deg" in -360..=360;
        /// distance in front of the edge at which the motion starts
        approach_distance: f64 = "approach_distance_mm" in 1..=1000, or 50.0;
        /// speed of approach, and of retraction once the tool is clear of the edge
        approach_speed: f64 = "approach_speed_mm_per_s" in 1..=2000, or 100.0;
        /// speed at which the tool is set on the edge and lifted off it
        engage_speed: f64 = "engage_speed_mm_per_s" in 0.1..=200.0, or 20.0;
        /// time at rest on the edge before it is followed
        settle_time: f64 = "settle_time_s" in 0..=60, or 1.0;
        /// whether the feed is lowered by what is measured
        feed_follows: Option<FeedFollows> = "feed_follows";
    }

    /// `process.feed_follows`: the feed is lowered where this is above its limit.
    pub(crate) struct FeedFollowsKeys {
        /// tangential force above which the feed is lowered
        force: Option<f64> = "force_n" in 0.01..=5000.0, shown "one of force and power";
        /// power at the tool above which the feed is lowered
        power: Option<f64> = "power_w" in 0.01..=1e5, shown "one of force and power";
        /// least share of the feed
        least_share: f64 = "least_share" in 0.01..=1.0, or 0.2;
        /// of the first-order lag with which the feed follows
        time_constant: f64 = "time_constant_s" in 0.001..=10.0, or 0.1;
    }

    /// `[simulation]`: settings of a simulation.
    pub struct SimulationScenario {
        /// rigid-body step
        step: f64 = "step_ms" in 0.01..=10.0, or 1.0;
        /// pneumatic sub-steps in each of them
        substeps: usize = "device_substeps" in 1..=1000, or 2;
        /// most steps in which the arm's mass matrix is taken once
        arm_steps: usize = "arm_steps" in 1..=64, or 16;
        /// gravity in the world
        gravity: DVec3 = "gravity_m_per_s2" in -30..=30, or vec![0.0, 0.0, -9.81];
        /// seed of the search for a posture and of all noise
        seed: u64 = "seed", or 1;
    }
}

/// Turns of a runout a second [Hz]: the spindle's [Hz], where they are known.
fn usual_runout(spindle: f64) -> f64 {
    match spindle > 0.0 {
        true => spindle,
        false => registry::RUNOUT_FREQUENCY.default,
    }
}

/// `process.tool_axis`.
#[derive(Debug, Clone, Deserialize, schemars::JsonSchema)]
#[serde(
    untagged,
    expecting = "\"down\" or a direction in the world such as [0, 0, -1]"
)]
pub(crate) enum ToolAxisKeys {
    /// A direction by name.
    Word(ToolAxisWord),
    /// A direction in the world.
    Direction(Vec<f64>),
}

/// A direction by name.
#[derive(Debug, Clone, Copy, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "lowercase")]
pub(crate) enum ToolAxisWord {
    /// Along the world's -z.
    Down,
}

/// A direction in the world.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Direction(pub DVec3);

impl Filled for Direction {
    type Written = ToolAxisKeys;
    const WORD: &'static str = "text";

    fn filled(written: ToolAxisKeys, _: Unit) -> Result<Self, &'static str> {
        let direction = match written {
            ToolAxisKeys::Word(ToolAxisWord::Down) => Some(DVec3::NEG_Z),
            ToolAxisKeys::Direction(numbers) => <[f64; 3]>::try_from(numbers)
                .ok()
                .and_then(|numbers| DVec3::from(numbers).try_normalize()),
        };
        direction
            .map(Self)
            .ok_or("a direction in the world from the flange to the part, as [0, 0, -1]")
    }

    fn schema() -> serde_json::Value {
        type_schema::<ToolAxisKeys>()
    }
}

impl Filled for FeedFollows {
    type Written = FeedFollowsKeys;
    const BELOW: Option<Below> = FeedFollowsKeys::BELOW;

    fn filled(written: FeedFollowsKeys, _: Unit) -> Result<Self, &'static str> {
        let (by, limit) = match (written.force, written.power) {
            (Some(force), None) => (FeedMeasure::Force, force),
            (None, Some(power)) => (FeedMeasure::Power, power),
            _ => return Err("one of force_n and power_w in it"),
        };
        Ok(Self {
            by,
            limit,
            least_share: written.least_share,
            time_constant: written.time_constant,
        })
    }

    fn schema() -> serde_json::Value {
        FeedFollowsKeys::schema()
    }
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
