//! The TOML of a recorded cell, key by key, as `file` is for a cell.

use serde::Deserialize;

use super::super::file::{ArmKeys, ContactKeys, DeviceKeys, Kind, WorkpieceKeys};

/// The file.
#[derive(Debug, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub(in super::super) struct RecordedCellFile {
    #[expect(dead_code, reason = "checked by Document::new")]
    pub schema: u32,
    pub kind: Kind,
    pub title: String,
    pub arm: ArmKeys,
    pub joints: JointsKeys,
    pub device: DeviceKeys,
    pub workpiece: WorkpieceKeys,
    #[serde(default)]
    pub contact: ContactKeys,
    pub sensors: SensorsKeys,
    #[serde(default)]
    pub belief: BeliefKeys,
    #[serde(default)]
    pub effect: super::super::effects::EffectKeys,
}

/// `[joints]`.
#[derive(Debug, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub(in super::super) struct JointsKeys {
    pub servo_bandwidth_hz: f64,
    pub stiffness_n_m_per_rad: Vec<f64>,
    pub damping_time_ms: Option<f64>,
    pub damping_time_tolerance_ms: Option<f64>,
}

/// `[sensors]`: standard deviations of their noise.
#[derive(Debug, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub(in super::super) struct SensorsKeys {
    pub joints_rad: f64,
    pub regulator_pressure_pa: f64,
    pub stroke_um: f64,
    pub force_n: f64,
}

/// `[belief]`.
#[derive(Debug, Default, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub(in super::super) struct BeliefKeys {
    pub tolerance: Option<f64>,
    pub start_stroke_tolerance_mm: Option<f64>,
    pub gravity_m_per_s2: Option<Vec<f64>>,
}
