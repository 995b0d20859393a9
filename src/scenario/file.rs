//! The TOML of a scenario file and of a device model file, key by key. Plain data: units, defaults and ranges are `load`'s business.
//!
//! A key that holds a physical number ends with its unit. What is optional here has a default, or is left out.

use std::collections::BTreeMap;
use std::path::PathBuf;

use serde::Deserialize;

use super::controller::ControllerKeys;
use super::device::ModelKeys;
use super::sensing::keys::SensingKeys;

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

/// A scenario file.
#[derive(Debug, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct ScenarioFile {
    #[expect(dead_code, reason = "checked by Document::new")]
    pub schema: u32,
    #[expect(dead_code, reason = "read as `KindOnly`; here so that it is known")]
    pub kind: Option<Kind>,
    pub title: String,
    pub arm: ArmKeys,
    pub device: DeviceKeys,
    pub workpiece: WorkpieceKeys,
    #[serde(default)]
    pub contact: ContactKeys,
    pub process: ProcessKeys,
    #[serde(default)]
    pub pass: Vec<PassKeys>,
    pub tool: Option<ToolKeys>,
    pub removal: Option<RemovalKeys>,
    #[serde(default)]
    pub collision: CollisionKeys,
    #[serde(default)]
    pub obstacle: Vec<ObstacleKeys>,
    #[serde(default)]
    pub simulation: SimulationKeys,
    #[serde(default)]
    pub sensing: SensingKeys,
    #[serde(default)]
    pub controller: ControllerKeys,
    #[serde(default)]
    pub expect: BTreeMap<String, BoundKeys>,
    #[serde(default)]
    pub effect: super::effects::EffectKeys,
}

/// `[arm]`.
#[derive(Debug, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct ArmKeys {
    pub urdf: PathBuf,
    pub base_link: Option<String>,
    pub flange_link: String,
    pub flange_rotation_deg: Option<Vec<f64>>,
    pub mass_kg: Option<f64>,
    pub mass_spread: Option<f64>,
    #[serde(default)]
    pub link_masses: Vec<LinkMassKeys>,
    #[serde(default)]
    pub packages: BTreeMap<String, PathBuf>,
    #[serde(default)]
    pub limit_overrides: Vec<LimitKeys>,
    #[serde(default)]
    pub drives: Vec<DriveKeys>,
    pub base_position_mm: Option<Vec<f64>>,
    pub base_rotation_deg: Option<Vec<f64>>,
    pub payload_kg: Option<f64>,
    pub seed_posture_deg: Option<Vec<f64>>,
    #[serde(default)]
    pub servo: ServoKeys,
}

/// `[[arm.link_masses]]`.
#[derive(Debug, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct LinkMassKeys {
    pub link: String,
    pub mass_kg: f64,
}

/// `[[arm.limit_overrides]]`.
#[derive(Debug, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct LimitKeys {
    pub joint: String,
    pub effort_n_m: Option<f64>,
    pub velocity_deg_per_s: Option<f64>,
}

/// `[[arm.drives]]`.
#[derive(Debug, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct DriveKeys {
    pub joint: String,
    pub friction_n_m: Option<f64>,
    pub stiffness_n_m_per_rad: Option<f64>,
    pub damping_time_ms: Option<f64>,
    pub backlash_deg: Option<f64>,
}

/// `[arm.servo]`.
#[derive(Debug, Default, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct ServoKeys {
    pub natural_frequency_hz: Option<f64>,
    pub damping_ratio: Option<f64>,
    pub integral_time_s: Option<f64>,
    pub contact_feed_forward: Option<bool>,
    pub lag_bandwidth_hz: Option<f64>,
    pub encoder_noise_rad: Option<f64>,
}

/// `[device]` of a scenario.
#[derive(Debug, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct DeviceKeys {
    pub model: PathBuf,
    pub ideal: Option<bool>,
    pub locked: Option<bool>,
    #[serde(default, rename = "override")]
    pub overrides: ModelKeys,
}

/// A device model file.
#[derive(Debug, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct ModelFile {
    #[expect(dead_code, reason = "checked by Document::new")]
    pub schema: u32,
    pub device: ModelKeys,
}

/// `[workpiece]`.
#[derive(Debug, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct WorkpieceKeys {
    pub mesh: PathBuf,
    pub mesh_unit: MeshUnit,
    pub position_mm: Vec<f64>,
    pub rotation_deg: Option<Vec<f64>>,
    pub edge: EdgeKeys,
    #[serde(default)]
    pub misplacement: MisplacementKeys,
    pub burr: Option<BurrKeys>,
    #[serde(default)]
    pub chamfer: ChamferKeys,
}

/// Unit of a mesh file, which itself states none.
#[derive(Debug, Clone, Copy, Deserialize, schemars::JsonSchema)]
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

/// `[workpiece.edge]`.
#[derive(Debug, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct EdgeKeys {
    pub edge: Option<usize>,
    #[serde(rename = "loop")]
    pub closed_loop: Option<usize>,
    pub start_mm: Option<f64>,
    pub end_mm: Option<f64>,
    pub reversed: Option<bool>,
    pub sharp_angle_deg: Option<f64>,
}

/// `[workpiece.misplacement]`.
#[derive(Debug, Default, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct MisplacementKeys {
    pub shift_mm: Option<f64>,
    pub tilt_deg: Option<f64>,
}

/// `[workpiece.burr]`: `kind` says which of the other keys there are.
#[derive(Debug, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct BurrKeys {
    pub kind: BurrKind,
    pub root_mm: Option<f64>,
    pub height_mm: Option<f64>,
    pub mean_height_mm: Option<f64>,
    pub standard_deviation_mm: Option<f64>,
    pub correlation_length_mm: Option<f64>,
    pub seed: Option<u64>,
    pub position_mm: Option<f64>,
    pub width_mm: Option<f64>,
    pub path: Option<PathBuf>,
}

/// Shape of a burr.
#[derive(Debug, Clone, Copy, Deserialize, schemars::JsonSchema)]
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

/// `[contact]`.
#[derive(Debug, Default, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct ContactKeys {
    pub stiffness_n_per_m: Option<f64>,
    pub damping_n_s_per_m: Option<f64>,
    pub friction_coefficient: Option<f64>,
    pub spindle_frequency_hz: Option<f64>,
    pub runout_um: Option<f64>,
    pub runout_frequency_hz: Option<f64>,
}

/// `[process]`.
#[derive(Debug, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct ProcessKeys {
    pub force_n: f64,
    pub feed_mm_per_s: f64,
    pub corner_feed_mm_per_s: Option<f64>,
    pub acceleration_mm_per_s2: Option<f64>,
    pub lateral_acceleration_mm_per_s2: Option<f64>,
    pub jerk_mm_per_s3: Option<f64>,
    pub working_stroke_mm: Option<f64>,
    pub lean_deg: Option<f64>,
    pub passes: Option<usize>,
    pub feed_follows: Option<FeedFollowsKeys>,
    pub tool_axis: Option<ToolAxisKeys>,
    pub roll_deg: Option<f64>,
    pub approach_distance_mm: Option<f64>,
    pub approach_speed_mm_per_s: Option<f64>,
    pub engage_speed_mm_per_s: Option<f64>,
    pub settle_time_s: Option<f64>,
}

/// `[[pass]]`: one along the edge; what is not given is as in `[process]`.
#[derive(Debug, Default, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct PassKeys {
    pub force_n: Option<f64>,
    pub feed_mm_per_s: Option<f64>,
    #[serde(default)]
    pub expect: BTreeMap<String, BoundKeys>,
}

/// `[tool]`: a tool on a spindle.
#[derive(Debug, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct ToolKeys {
    pub shape: ToolShapeWord,
    pub spindle_speed_rpm: f64,
    pub spindle_sense: Option<SpindleSense>,
    pub spindle_start: Option<SpindleStart>,
    pub spindle_lead_deg: Option<f64>,
    pub spindle_lean_deg: Option<f64>,
    pub stall_torque_n_mm: Option<f64>,
    pub wheel_radius_mm: Option<f64>,
    pub cone_angle_deg: Option<f64>,
    pub cone_length_mm: Option<f64>,
    pub cone_contact_mm: Option<f64>,
    pub cone_tip_radius_mm: Option<f64>,
}

/// Shape of the part of a tool that touches.
#[derive(Debug, Clone, Copy, Deserialize, schemars::JsonSchema)]
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
#[derive(Debug, Clone, Copy, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "lowercase")]
pub(super) enum SpindleSense {
    /// Right-handed about the axis.
    Clockwise,
    /// Left-handed.
    Counterclockwise,
}

/// When the spindle is switched on.
#[derive(Debug, Clone, Copy, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "lowercase")]
pub(super) enum SpindleStart {
    /// Before the tool touches.
    Approach,
    /// As following starts.
    Follow,
}

/// `[removal]`: `law` says which of the other keys there are.
#[derive(Debug, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct RemovalKeys {
    pub law: RemovalWord,
    pub coefficient_mm3_per_j: Option<f64>,
    pub threshold_force_n: Option<f64>,
    pub rate_mm3_per_s: Option<f64>,
    pub reference_force_n: Option<f64>,
    pub reference_speed_m_per_s: Option<f64>,
    pub force_exponent: Option<f64>,
    pub speed_exponent: Option<f64>,
    pub reference_area_mm2: Option<f64>,
    pub area_exponent: Option<f64>,
    pub contact_area_mm2: Option<f64>,
    pub wear_work_kj: Option<f64>,
    pub wear_at_start_kj: Option<f64>,
    pub contact_length_mm: Option<f64>,
    pub specific_energy_j_per_mm3: Option<f64>,
    pub friction_coefficient: Option<f64>,
}

/// Law of removal.
#[derive(Debug, Clone, Copy, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "lowercase")]
pub(super) enum RemovalWord {
    /// In proportion to force and speed.
    Preston,
    /// The same above a threshold force.
    Threshold,
    /// Powers of force, speed and contact area.
    Power,
}

/// `[workpiece.chamfer]`: what the edge should be like.
#[derive(Debug, Default, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct ChamferKeys {
    pub leg_min_mm: Option<f64>,
    pub leg_max_mm: Option<f64>,
    pub residual_burr_max_mm: Option<f64>,
}

/// `process.feed_follows`: the feed is lowered where this is above its limit.
#[derive(Debug, Clone, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct FeedFollowsKeys {
    pub force_n: Option<f64>,
    pub power_w: Option<f64>,
    pub least_share: Option<f64>,
    pub time_constant_s: Option<f64>,
}

/// `process.tool_axis`.
#[derive(Debug, Clone, Deserialize, schemars::JsonSchema)]
#[serde(
    untagged,
    expecting = "\"down\" or a direction in the world such as [0, 0, -1]"
)]
pub(super) enum ToolAxisKeys {
    /// A direction by name.
    Word(ToolAxisWord),
    /// A direction in the world.
    Direction(Vec<f64>),
}

/// A direction by name.
#[derive(Debug, Clone, Copy, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "lowercase")]
pub(super) enum ToolAxisWord {
    /// Along the world's -z.
    Down,
}

/// `[collision]`.
#[derive(Debug, Default, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct CollisionKeys {
    pub margin_mm: Option<f64>,
    pub floor_height_mm: Option<f64>,
    pub allowed_pairs: Option<Vec<[String; 2]>>,
}

/// `[[obstacle]]`.
#[derive(Debug, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct ObstacleKeys {
    pub name: Option<String>,
    pub box_mm: Option<Vec<f64>>,
    pub mesh: Option<PathBuf>,
    pub mesh_unit: Option<MeshUnit>,
    pub position_mm: Option<Vec<f64>>,
    pub rotation_deg: Option<Vec<f64>>,
}

/// `[simulation]`.
#[derive(Debug, Default, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct SimulationKeys {
    pub step_ms: Option<f64>,
    pub device_substeps: Option<usize>,
    pub gravity_m_per_s2: Option<Vec<f64>>,
    pub seed: Option<u64>,
}

/// A metric in `[expect]`.
#[derive(Debug, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct BoundKeys {
    /// The least that is allowed, in the unit of its name.
    pub min: Option<f64>,
    /// The most that is allowed, in the unit of its name.
    pub max: Option<f64>,
}
