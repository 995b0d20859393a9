//! The TOML of a bench scenario, key by key, as `file` is for a cell.

use std::collections::BTreeMap;

use serde::Deserialize;

use super::controller::ControllerKeys;
use super::estimator::EstimatorKeys;
use super::file::{BoundKeys, DeviceKeys, Kind};
use super::sensing::keys::SensingKeys;

/// A bench scenario file.
#[derive(Debug, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct BenchFile {
    #[expect(dead_code, reason = "checked by Document::new")]
    pub schema: u32,
    #[expect(dead_code, reason = "read as `KindOnly`; here so that it is known")]
    pub kind: Kind,
    pub title: String,
    pub device: DeviceKeys,
    pub bench: BenchKeys,
    pub load: LoadKeys,
    pub hand: Option<HandKeys>,
    /// Physics beyond the believed device, by its name in the catalogue.
    #[serde(default)]
    pub effect: super::effects::EffectKeys,
    #[serde(default)]
    pub command: Vec<CommandKeys>,
    #[serde(default)]
    pub valve: Vec<ValveKeys>,
    #[serde(default)]
    pub simulation: BenchSimulationKeys,
    #[serde(default)]
    pub sensing: SensingKeys,
    pub estimator: Option<EstimatorKeys>,
    #[serde(default)]
    pub controller: ControllerKeys,
    #[serde(default)]
    pub expect: BTreeMap<String, BoundKeys>,
}

/// `[bench]`.
#[derive(Debug, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct BenchKeys {
    pub duration_s: f64,
    pub gravity_along_extension_m_per_s2: Option<f64>,
    pub start_stroke_mm: Option<f64>,
}

/// Load that the tool meets.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "snake_case")]
pub(super) enum LoadKind {
    /// Nothing.
    Free,
    /// A load cell that stands still.
    LoadCell,
    /// A surface that moves.
    Surface,
}

/// `[load]`.
#[derive(Debug, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct LoadKeys {
    pub kind: LoadKind,
    pub position_mm: Option<f64>,
    pub stiffness_n_per_m: Option<f64>,
    pub damping_n_s_per_m: Option<f64>,
    pub peak_to_peak_mm: Option<f64>,
    pub frequency_hz: Option<f64>,
    pub start_s: Option<f64>,
}

/// `[hand]`.
#[derive(Debug, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct HandKeys {
    pub peak_force_n: f64,
    pub frequency_hz: f64,
    pub start_s: Option<f64>,
}

/// `[[command]]`.
#[derive(Debug, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct CommandKeys {
    pub at_s: f64,
    pub set_pressure_bar_gauge: Option<f64>,
    pub force_n: Option<f64>,
}

/// `[[valve]]`.
#[derive(Debug, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct ValveKeys {
    pub at_s: f64,
    #[schemars(with = "String", extend("enum" = ["extend", "retract"]))]
    pub position: crate::physics::valve::ValvePosition,
}

/// `[simulation]` of a bench.
#[derive(Debug, Default, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct BenchSimulationKeys {
    pub step_ms: Option<f64>,
    pub device_substeps: Option<usize>,
    pub seed: Option<u64>,
}
