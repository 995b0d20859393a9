//! Keys of a scenario file and of a device model file that fill no type of the scenario as they stand; those that do are declared there (`cell`).
//!
//! A key that holds a physical number ends with its unit.

use std::collections::BTreeMap;
use std::path::PathBuf;

use glam::DVec3;
use serde::Deserialize;

use super::arm_file::EffectTables;
use super::cell::{
    ContactKeys, DriveScenario, LimitOverride, Misplacement, ProcessScenario, ServoScenario,
    SimulationScenario,
};
use super::cell_limits::CellLimitsKeys;
use super::controller::ControllerKeys;
use super::device::ModelKeys;
use super::effects::EffectKeys;
use super::program::ProgramScenario;
use super::sensing::keys::SensingKeys;
use crate::keys::declaration::{Plain, keys};

/// Thickness of a burr's root where the file says nothing [m].
pub(super) const USUAL_ROOT: f64 = 0.15e-3;
/// Version of both formats.
pub(super) const SCHEMA: u32 = 2;

/// Kind of scenario in a file; a cell if it does not say.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "snake_case")]
pub(super) enum Kind {
    /// Arm, device and workpiece.
    #[default]
    Cell,
    /// The device alone.
    Bench,
    /// Arm, device and workpiece of which there are recordings.
    RecordedCell,
}

impl Kind {
    /// As a file names it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Cell => "cell",
            Self::Bench => "bench",
            Self::RecordedCell => "recorded_cell",
        }
    }
}

/// The one key that is read before a file's kind is known.
#[derive(Debug, Deserialize)]
pub(super) struct KindOnly {
    #[serde(default)]
    pub kind: Kind,
}

impl Plain for Kind {}
impl Plain for MeshUnit {}
impl Plain for BurrKind {}
impl Plain for ToolShapeWord {}
impl Plain for SpindleSense {}
impl Plain for SpindleStart {}
impl Plain for RemovalWord {}

impl Plain for EffectKeys {
    const WORD: &'static str = "tables";

    fn absent() -> Option<Self> {
        Some(Self::default())
    }
}

keys! {
    /// A scenario file.
    pub(super) struct ScenarioFile {
        /// version of this format
        schema: u32 = "schema" in 1..=2;
        /// a bench has the tables of [Keys of a bench](#keys-of-a-bench) instead of those here
        kind: Kind = "kind", or "cell", being "\"cell\" or \"bench\"";
        /// name for people, also the recording's title
        title: String = "title", being "not empty";
        arm: ArmKeys = "arm";
        device: DeviceKeys = "device";
        workpiece: WorkpieceKeys = "workpiece";
        contact: ContactKeys = "contact";
        process: ProcessScenario = "process";
        pass: Vec<PassKeys> = "pass";
        tool: Option<ToolKeys> = "tool";
        removal: Option<RemovalKeys> = "removal";
        collision: CollisionKeys = "collision";
        obstacle: Vec<ObstacleKeys> = "obstacle";
        program: ProgramScenario = "program";
        simulation: SimulationScenario = "simulation";
        sensing: SensingKeys = "sensing";
        controller: ControllerKeys = "controller";
        limits: CellLimitsKeys = "limits";
        /// bounds that the results must keep: [`[expect]`](#expect)
        expect: BTreeMap<String, BoundKeys> = "expect", shown "none";
        /// physics beyond what is nominal: [`[[effect]]`](#effect)
        effect: EffectKeys = "effect", shown "none";
    }

    /// `[arm]`.
    pub(super) struct ArmKeys {
        /// the robot
        urdf: PathBuf = "urdf";
        /// link that carries the arm; the URDF's root link when left out
        base_link: Option<String> = "base_link";
        /// link on which the device is mounted, along the +z of its frame as turned by the next key
        flange_link: String = "flange_link", being "not empty";
        /// turn of the frame along whose +z the device is mounted, in that of the link: roll, pitch, yaw; for a flange whose z lies across the last joint's axis.
        /// `idc new cell --urdf` finds it
        flange_rotation: DVec3 = "flange_rotation_deg" in -360..=360, or vec![0; 3];
        /// mass of the whole robot with its base, as on its data sheet; links to which the URDF gives no mass take the share of their volume (of a mesh that of its
        /// convex hull) of what the other masses leave of it
        mass: Option<f64> = "mass_kg" in 0.1..=1e5;
        /// how far each mass estimated so may be off, either way, as a share of it; the interval of the joint torques that `idc check`, summary.json and report.html
        /// give follows from it
        mass_spread: f64 = "mass_spread" in 0..=1, or 0.5;
        link_masses: Vec<LinkMassKeys> = "link_masses";
        /// folder of each ROS package that the URDF names by `package://`, as in `packages = { ur_description = "../ur" }`
        packages: BTreeMap<String, PathBuf> = "packages", shown "none";
        limit_overrides: Vec<LimitOverride> = "limit_overrides";
        drives: Vec<DriveScenario> = "drives";
        /// base in the world
        base_position: DVec3 = "base_position_mm" in -10_000..=10_000, or vec![0; 3];
        /// base in the world: roll, pitch, yaw
        base_rotation: DVec3 = "base_rotation_deg" in -360..=360, or vec![0; 3];
        /// mass that the arm may carry on its flange: a cell whose device weighs more, housing and slide, is refused
        payload: Option<f64> = "payload_kg" in 0.1..=3000.0, shown "that of its maker, where the robot's name in the URDF is known";
        /// joint angles, one for each axis, near which a posture is sought first; when left out, it is found by search
        seed_posture: Option<Vec<f64>> = "seed_posture_deg" in -360..=360;
        /// file of kind `recorded_arm`: drives, load, wrench sensor and their tolerances, for recordings with the drives' currents or torques and a raw wrench; a run
        /// records what they would read
        recorded_arm: Option<PathBuf> = "recorded_arm";
        /// effects of that file's drives, load and wrench sensor, beside those that it holds
        effects: EffectTables = "effect";
        servo: ServoScenario = "servo";
    }

    /// `[[arm.link_masses]]`.
    pub(super) struct LinkMassKeys {
        /// link's name in the URDF
        link: String = "link", being "each link once";
        /// its mass
        mass: f64 = "mass_kg" in 0.001..=1e5;
    }

    /// `[device]` of a scenario.
    pub(super) struct DeviceKeys {
        /// device model file, [../models/device.toml](../models/device.toml)
        model: PathBuf = "model";
        /// the source paper's device in what the scenario leaves open: no friction of the seals, air at constant temperature, a contact of 150000 N/m and 400 N s/m
        ideal: Option<bool> = "ideal", shown "false";
        /// is the slide clamped at the working stroke? The contact may then be at most a tenth as stiff as the clamp
        locked: bool = "locked", or false;
        overrides: Option<ModelKeys> = "override";
    }

    /// A device model file.
    pub(super) struct ModelFile {
        /// version of this format
        schema: u32 = "schema" in 1..=2;
        /// keys of its values that rest on no public measurement; reports say where such a value is in use
        assumed: Vec<String> = "judged", shown "none";
        device: ModelKeys = "device";
    }

    /// `[workpiece]`.
    pub(super) struct WorkpieceKeys {
        /// closed mesh of the part: STL, OBJ, COLLADA, PLY or glTF; small flaws are mended, with a note that says where
        mesh: PathBuf = "mesh";
        /// unit of the mesh file; `m` takes COLLADA and glTF, which state theirs, as they are
        mesh_unit: MeshUnit = "mesh_unit";
        /// nominal place of the part's origin
        position: DVec3 = "position_mm" in -10_000..=10_000;
        /// part in the world: roll, pitch, yaw
        rotation: DVec3 = "rotation_deg" in -360..=360, or vec![0; 3];
        edge: EdgeKeys = "edge" must stand;
        misplacement: Misplacement = "misplacement";
        burr: Option<BurrKeys> = "burr";
        chamfer: ChamferKeys = "chamfer";
    }

    /// `[workpiece.edge]`.
    pub(super) struct EdgeKeys {
        /// smooth edge, by its number in `idc edges`
        edge: Option<usize> = "edge", shown "one of the two";
        /// closed loop, by its number in `idc edges`
        closed_loop: Option<usize> = "loop", shown "one of the two";
        /// where to begin, along the edge from its first point
        start: f64 = "start_mm" in 0.0..=1e5, or 0.0;
        /// where to end, more than `start_mm`; the edge's end, or once round the loop, when left out
        end: Option<f64> = "end_mm" in 0.0..=1e5;
        /// followed the other way round; `start_mm` and `end_mm` then count from the other end
        reversed: bool = "reversed", or false;
        /// by how much two faces must turn from one to the other (180 less the angle between them) for their edge to count as sharp
        sharp_angle: f64 = "sharp_angle_deg" in 1..=170, or 30.0;
    }

    /// `[workpiece.burr]`: `kind` says which of the other keys there are.
    pub(super) struct BurrKeys {
        /// which of the keys below there are
        kind: BurrKind = "kind";
        /// thickness of its root, of which a turning tool takes the section; 0.05 to 0.3 is usual
        root: f64 = "root_mm" for "constant" | "random" | "bump" | "table" in 0.001..=5.0, from USUAL_ROOT, assumed "leg of the chamfer and burr that is left";
        /// height
        height: Option<f64> = "height_mm" for "constant" | "bump" in 0..=10;
        /// mean height
        mean_height: Option<f64> = "mean_height_mm" for "random" in 0.001..=10.0;
        /// standard deviation of the height
        standard_deviation: Option<f64> = "standard_deviation_mm" for "random" in 0..=10, shown "a third of the mean height";
        /// distance over which the correlation of the height's logarithm falls to exp(-1/2)
        correlation_length: Option<f64> = "correlation_length_mm" for "random" in 0.1..=1000.0;
        /// another seed, another burr of the same kind
        seed: u64 = "seed" for "random", or 1;
        /// middle, from the start of the followed edge
        position: Option<f64> = "position_mm" for "bump" in 0.0..=1e5;
        /// from foot to foot
        width: Option<f64> = "width_mm" for "bump" in 0.1..=1000.0;
        /// CSV with the header `position_mm,height_mm`
        path: Option<PathBuf> = "path" for "table";
    }

    /// `[workpiece.chamfer]`: what the edge should be like.
    pub(super) struct ChamferKeys {
        /// least leg of a good chamfer
        leg_min: f64 = "leg_min_mm" in 0..=20, or 0.0;
        /// largest leg of a good chamfer
        leg_max: f64 = "leg_max_mm" in 0.0..=f64::INFINITY, or f64::INFINITY;
        /// burr that may be left, which is not felt by a finger any more
        residual_burr: f64 = "residual_burr_max_mm" in 0..=5, or 0.02, assumed "share out of tolerance";
    }

    /// `[[pass]]`: one along the edge; what is not given is as in `[process]`.
    pub(super) struct PassKeys {
        /// desired contact force
        force: Option<f64> = "force_n" in 0.1..=5000.0, shown "that of the process";
        /// feed along the edge
        feed: Option<f64> = "feed_mm_per_s" in 0.1..=1000.0, shown "that of the process";
        /// bounds on the numbers of this pass, as those of [`[expect]`](#expect) on the run's: `expect.force_mean_n = { min = 39.0 }`
        expect: BTreeMap<String, BoundKeys> = "expect", shown "none";
    }

    /// `[tool]`: a tool on a spindle.
    pub(super) struct ToolKeys {
        /// the device's ball, a cone with its flank on the edge, or a belt over a wheel
        shape: ToolShapeWord = "shape";
        /// without load
        spindle_speed: f64 = "spindle_speed_rpm" in 1.0..=2e5;
        /// seen along the spindle's axis towards the tool
        sense: SpindleSense = "spindle_sense", or "clockwise";
        /// before the tool touches, or as it starts to follow the edge
        start: SpindleStart = "spindle_start", or "follow";
        /// angle of the spindle's axis from the slide's, towards the direction of travel
        lead: f64 = "spindle_lead_deg" in -180..=180, or 0.0;
        /// the same towards the face on the left of the direction of travel
        lean: f64 = "spindle_lean_deg" in -180..=180, or 0.0;
        /// torque at which the spindle stands, its speed falling in proportion to the torque; inf for a speed that no load changes
        stall_torque: f64 = "stall_torque_n_mm" in 0.01..=f64::INFINITY, or f64::INFINITY;
        /// of the wheel with the belt
        wheel_radius: Option<f64> = "wheel_radius_mm" for "belt" in 0.5..=500.0;
        /// between opposite flanks
        cone_angle: Option<f64> = "cone_angle_deg" for "cone" in 1..=179;
        /// of the flank, from the tip
        cone_length: Option<f64> = "cone_length_mm" for "cone" in 0.5..=200.0;
        /// from the tip to the contact, along the flank
        cone_contact: Option<f64> = "cone_contact_mm" for "cone" in 0..=200, shown "half the length";
        /// radius at its tip
        cone_tip_radius: f64 = "cone_tip_radius_mm" for "cone" in 0..=100, or 0.0;
    }

    /// `[removal]`: `law` says which of the other keys there are.
    pub(super) struct RemovalKeys {
        /// in proportion to force and speed, the same above a threshold force, or powers of them
        law: RemovalWord = "law";
        /// volume per work of normal force and speed
        coefficient: Option<f64> = "coefficient_mm3_per_j" for "preston" | "threshold" in 1e-9..=1e3, assumed "leg of the chamfer and burr that is left";
        /// force below which nothing comes off; 0 when left out of *power*
        threshold_force: Option<f64> = "threshold_force_n" for "threshold" | "power" in 0..=5000, shown "required", assumed "leg of the chamfer and burr that is left";
        /// removal rate at the reference point
        rate: Option<f64> = "rate_mm3_per_s" for "power" in 1e-9..=1e6, assumed "leg of the chamfer and burr that is left";
        /// of the reference point, more than the threshold
        reference_force: Option<f64> = "reference_force_n" for "power" in 0.001..=5000.0;
        /// of the reference point
        reference_speed: Option<f64> = "reference_speed_m_per_s" for "power" in 0.001..=500.0;
        /// exponent of the force
        force_exponent: Option<f64> = "force_exponent" for "power" in 0.1..=5.0;
        /// exponent of the cutting speed
        speed_exponent: f64 = "speed_exponent" for "power" in -5..=5, or 1.0;
        /// contact area of the reference point
        reference_area: f64 = "reference_area_mm2" for "power" in 1e-3..=1e4, or 1.0;
        /// exponent of the contact area
        area_exponent: f64 = "area_exponent" for "power" in -5..=5, or 0.0;
        /// contact area
        contact_area: f64 = "contact_area_mm2" for "power" in 1e-3..=1e4, else reference_area, shown "that of the reference point";
        /// work of force and speed after which the tool takes off 1/e of what a new one does; inf for one that does not wear
        wear_work: f64 = "wear_work_kj" in 1e-3..=f64::INFINITY, or f64::INFINITY, assumed "leg of the chamfer and burr that is left";
        /// work that the tool has done before: `tool_wear_kj` at the end of an earlier run
        wear_at_start: f64 = "wear_at_start_kj" in 0.0..=1e6, or 0.0, assumed "leg of the chamfer and burr that is left";
        /// length of edge on which the tool touches at a time
        contact_length: f64 = "contact_length_mm" in 0.1..=100.0, or 1.0, assumed "leg of the chamfer and burr that is left";
        /// energy that a volume takes: of an abrasive on steel 10 to 60, of a sharp burr tool on aluminium 1 to 3
        specific_energy: f64 = "specific_energy_j_per_mm3" in 0..=1000, or 20.0, assumed "spindle torque and power";
        /// of what rubs
        friction: f64 = "friction_coefficient" in 0..=2, or 0.3, assumed "spindle torque and power";
    }

    /// `[collision]`.
    pub(super) struct CollisionKeys {
        /// least clearance between bodies: by default twice the path error of a usual robot, and what its shapes leave out of hoses
        margin: f64 = "margin_mm" in 0..=200, or 5.0;
        /// height of the floor in the world; when left out, 0 unless base, part or an obstacle stands below that, and then there is none
        floor_height: Option<f64> = "floor_height_mm" in -1e5..=1e5;
        /// bodies that may meet, by the names of the links, `device`, `tool`, `part`, `floor` and the obstacles, as in `[["forearm", "hose"]]`
        allowed_pairs: Option<Vec<[String; 2]>> = "allowed_pairs";
    }

    /// `[[obstacle]]`.
    pub(super) struct ObstacleKeys {
        /// name for messages, each once; when left out, `obstacle` and its number
        name: Option<String> = "name", being "not empty";
        /// edge lengths of a box about its position
        box_size: Option<DVec3> = "box_mm" in 0.01..=1e5, shown "one of box and mesh", being "each positive, at most 100000";
        /// mesh in place of a box: STL, OBJ, COLLADA, PLY or glTF
        mesh: Option<PathBuf> = "mesh", shown "one of box and mesh";
        /// unit of the mesh, needed with one
        mesh_unit: Option<MeshUnit> = "mesh_unit", shown "one of these with a mesh";
        /// a box's middle, a mesh's origin, in the world
        position: DVec3 = "position_mm" in -10_000..=10_000, or vec![0; 3];
        /// roll, pitch, yaw
        rotation: DVec3 = "rotation_deg" in -360..=360, or vec![0; 3];
    }

    /// A metric in `[expect]`.
    pub(super) struct BoundKeys {
        /// the least that is allowed, in the unit of its name
        min: Option<f64> = "min";
        /// the most that is allowed, in the unit of its name
        max: Option<f64> = "max";
    }
}

/// Unit of a mesh file, which itself states none.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "lowercase")]
pub(super) enum MeshUnit {
    /// Millimetre.
    Mm,
    /// Metre.
    M,
    /// Inch.
    Inch,
}

impl MeshUnit {
    /// Its length [m].
    pub fn length(self) -> f64 {
        match self {
            Self::Mm => 1e-3,
            Self::M => 1.0,
            Self::Inch => 0.0254,
        }
    }
}

/// Shape of a burr.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "lowercase")]
pub(super) enum BurrKind {
    /// No burr.
    None,
    /// The same height everywhere.
    Constant,
    /// Seeded random height.
    Random,
    /// One bump.
    Bump,
    /// From a CSV file.
    Table,
}

/// Shape of the part of a tool that touches.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "lowercase")]
pub(super) enum ToolShapeWord {
    /// The device's ball.
    Ball,
    /// A cone with its flank on the edge.
    Cone,
    /// A belt over a wheel.
    Belt,
}

/// Sense of a spindle, seen along its axis towards the tool.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "lowercase")]
pub(super) enum SpindleSense {
    /// Right-handed about the axis.
    Clockwise,
    /// Left-handed.
    Counterclockwise,
}

/// When the spindle is switched on.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "lowercase")]
pub(super) enum SpindleStart {
    /// Before the tool touches.
    Approach,
    /// As following starts.
    Follow,
}

/// Law of removal.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "lowercase")]
pub(super) enum RemovalWord {
    /// In proportion to force and speed.
    Preston,
    /// The same above a threshold force.
    Threshold,
    /// Powers of force, speed and contact area.
    Power,
}
