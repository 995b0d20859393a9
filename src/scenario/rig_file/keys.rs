//! The TOML of a rig file, table by table. The numbers of a table are `quantities`' business.

use std::collections::BTreeMap;

use serde::Deserialize;

use super::super::sections::keys;
use super::entry::Entry;
use super::number::{Number, NumberKeys};

/// Numbers of a table, by key.
pub(super) type Numbers = BTreeMap<String, Number>;

/// A rig file.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RigKeys {
    #[expect(dead_code, reason = "checked by Document::new")]
    pub schema: u32,
    #[serde(default)]
    pub rig: PartKeys,
    #[serde(default)]
    pub cylinder: Numbers,
    #[serde(default)]
    pub end_stop: Numbers,
    #[serde(default)]
    pub regulator: Numbers,
    #[serde(default)]
    pub valve: Numbers,
    #[serde(default)]
    pub gas: Numbers,
    #[serde(default)]
    pub contact: Numbers,
    #[serde(default)]
    pub sensors: Numbers,
    #[serde(default)]
    pub recordings: RecordingsKeys,
    #[serde(default)]
    pub effect: super::super::effects::EffectKeys,
    pub latent: Option<BTreeMap<String, Entry>>,
}

/// `[rig]`: how much of the device there is.
#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct PartKeys {
    pub chain: Option<String>,
}

/// `[recordings]`.
#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RecordingsKeys {
    #[serde(default)]
    pub fit: Vec<String>,
    pub predict: Option<String>,
}

impl RigKeys {
    /// Tables that hold numbers of the rig, in the order of the format.
    pub fn tables(&self) -> [(&'static str, &Numbers); 7] {
        [
            ("cylinder", &self.cylinder),
            ("end_stop", &self.end_stop),
            ("regulator", &self.regulator),
            ("valve", &self.valve),
            ("gas", &self.gas),
            ("contact", &self.contact),
            ("sensors", &self.sensors),
        ]
    }
}

/// Tables of a rig file with their keys; those of numbers as `quantities` has them.
#[rustfmt::skip] // A table: one table of the file a line.
pub(super) fn sections() -> Vec<(&'static str, &'static [&'static str])> {
    let mut sections: Vec<(&'static str, &'static [&'static str])> = vec![
        ("", keys::<RigKeys>()),
        ("rig", keys::<PartKeys>()),
        ("recordings", keys::<RecordingsKeys>()),
        ("cylinder", &["count", "bore_m", "rod_m", "stroke_m", "dead_volume_m3", "moving_mass_kg", "gravity_along_axis_m_per_s2"]),
        ("end_stop", &["stiffness_n_per_m", "damping_n_s_per_m"]),
        ("regulator", &["gain", "time_constant_s"]),
        ("valve", &["supply_orifice_m2", "exhaust_orifice_m2", "discharge_coefficient"]),
        ("gas", &["specific_gas_constant_j_per_kg_k", "heat_capacity_ratio", "temperature_k", "atmosphere_pa"]),
        ("contact", &["stiffness_n_per_m", "damping_n_s_per_m"]),
        ("sensors", &["rate_hz", "force_n", "stroke_m", "regulator_pressure_pa", "acceleration_m_per_s2", "regulator_pressure_drift_pa_per_s"]),
    ];
    let with_accuracy = [
        "cylinder.*", "end_stop.*", "regulator.*", "valve.*", "gas.*", "contact.*", "sensors.*",
    ];
    sections.extend(with_accuracy.map(|tables| (tables, keys::<NumberKeys>())));
    sections
}
