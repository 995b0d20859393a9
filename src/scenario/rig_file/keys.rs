//! The TOML of a rig file, table by table. The numbers of a table are `quantities`' business.

use std::collections::BTreeMap;
use std::sync::LazyLock;

use serde::Deserialize;

use super::super::sections::keys as names_of;
use super::entry::Entry;
use super::flange::FlangeKeys;
use super::known::KnownKeys;
use super::number::{Number, NumberKeys};
use super::quantities::{Described, described_numbers};
use crate::flange::FlangeModel;
use crate::keys::declaration::keys;

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
    #[serde(default)]
    pub shares: SharesKeys,
    #[serde(default)]
    pub limits: LimitsKeys,
    pub known: Option<KnownKeys>,
    pub flange: Option<FlangeKeys>,
}

keys! {
    /// `[rig]`: how much of the device there is.
    pub(in super::super) struct PartKeys: Default {
        /// how much of the device there is
        chain: Option<String> = "chain", shown "whole";
    }

    /// `[shares]`: parts that other rigs may have too: those that state the same identity have the same part, and `idc diagnose --all` finds one value for it.
    pub(in super::super) struct SharesKeys: Default {
        /// identity of the cylinder, such as its serial number
        cylinder: Option<String> = "cylinder";
        /// identity of the load cell
        force_sensor: Option<String> = "force_sensor";
        /// identity of the pressure regulator
        regulator: Option<String> = "regulator";
    }

    /// `[limits]`: how far an experiment may move the rig; what is not stated, no farther than the recordings did.
    pub(in super::super) struct LimitsKeys: Default {
        /// largest set pressure, gauge
        set_pressure: Option<f64> = "set_pressure_pa" in 0.0..=1.6e6;
        /// largest rate of the set pressure
        set_pressure_rate: Option<f64> = "set_pressure_rate_pa_per_s" in 1.0..=1e12;
        /// largest stroke of the tool
        stroke: Option<f64> = "stroke_m" in 0.0..=2.0;
        /// where the surface may stand along the stroke, at least
        surface_least: Option<f64> = "surface_least_m" in 0.0..=2.0;
        /// where it may stand at most
        surface_most: Option<f64> = "surface_most_m" in 0.0..=2.0;
        /// largest speed of the surface
        surface_speed: Option<f64> = "surface_speed_m_per_s" in 0.0..=10.0;
        /// largest acceleration of the surface
        surface_acceleration: Option<f64> = "surface_acceleration_m_per_s2" in 0.0..=1000.0;
        /// whether the valve may retract
        solenoid: Option<bool> = "solenoid";
        /// whether the tool may run without a workpiece
        without_workpiece: Option<bool> = "without_workpiece";
        /// largest force on the part
        force: Option<f64> = "force_n" in 0.0..=1e5;
        /// longest recording
        duration: Option<f64> = "duration_s" in 0.5..=3600.0;
    }

    /// `[recordings]`.
    pub(in super::super) struct RecordingsKeys: Default {
        /// recordings beside this file to diagnose from; a star stands for all that fit
        fit: Vec<String> = "fit";
        /// recording that is kept back, to be predicted
        predict: Option<String> = "predict";
        /// force ramps of a contact flange; without one the whole desired force is set before contact
        force_ramp: Vec<ForceRampKeys> = "force_ramp";
    }

    /// `[[recordings.force_ramp]]`.
    pub(in super::super) struct ForceRampKeys {
        /// recording that it is of; a star stands for all that fit
        recording: String = "recording";
        /// force that a contact flange is set to before contact
        before_contact: f64 = "before_contact_n" in 0.0..=1e4;
        /// time from contact until the desired force is set
        time: f64 = "time_s" in 0..=100;
    }
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

/// Keys of the tables of numbers, in the order of the format.
static TABLES: LazyLock<Vec<(&str, Vec<&str>)>> = LazyLock::new(|| {
    let mut tables: Vec<(&str, Vec<&str>)> = Vec::new();
    for Described { table, key, .. } in described_numbers() {
        match tables.last_mut() {
            Some((last, keys)) if *last == table => keys.push(key),
            _ => tables.push((table, vec![key])),
        }
    }
    tables
});

/// Tables of a rig file with their keys.
pub(super) fn sections() -> Vec<(String, Vec<&'static str>)> {
    let mut sections = vec![
        (String::new(), names_of::<RigKeys>().to_vec()),
        ("rig".to_owned(), names_of::<PartKeys>().to_vec()),
        (
            "recordings".to_owned(),
            names_of::<RecordingsKeys>().to_vec(),
        ),
        ("shares".to_owned(), names_of::<SharesKeys>().to_vec()),
        ("limits".to_owned(), names_of::<LimitsKeys>().to_vec()),
        ("known".to_owned(), names_of::<KnownKeys>().to_vec()),
        ("flange".to_owned(), names_of::<FlangeKeys>().to_vec()),
        ("flange.fit".to_owned(), FlangeModel::NAMES.to_vec()),
        (
            "recordings.force_ramp".to_owned(),
            names_of::<ForceRampKeys>().to_vec(),
        ),
    ];
    sections.extend(
        TABLES
            .iter()
            .map(|(table, keys)| ((*table).to_owned(), keys.clone())),
    );
    let with_accuracy = [
        "cylinder.*",
        "end_stop.*",
        "regulator.*",
        "valve.*",
        "gas.*",
        "contact.*",
        "sensors.*",
    ];
    sections
        .extend(with_accuracy.map(|tables| (tables.to_owned(), names_of::<NumberKeys>().to_vec())));
    sections
}
