//! The TOML of a rig file, table by table. The numbers of a table are `quantities`' business.

use std::collections::BTreeMap;
use std::sync::LazyLock;

use serde::Deserialize;

use super::super::sections::keys;
use super::entry::Entry;
use super::flange::FlangeKeys;
use super::known::KnownKeys;
use super::number::{Number, NumberKeys};
use super::quantities::{Described, described_numbers};
use crate::plant::flange::FlangeModel;

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
    pub known: Option<KnownKeys>,
    pub flange: Option<FlangeKeys>,
}

/// `[rig]`: how much of the device there is.
#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct PartKeys {
    pub chain: Option<String>,
}

/// `[shares]`: identities of parts that other rigs may have too, a serial number or a name.
#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct SharesKeys {
    pub cylinder: Option<String>,
    pub force_sensor: Option<String>,
    pub regulator: Option<String>,
}

/// `[recordings]`.
#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RecordingsKeys {
    #[serde(default)]
    pub fit: Vec<String>,
    pub predict: Option<String>,
    #[serde(default)]
    pub force_ramp: Vec<ForceRampKeys>,
}

/// `[[recordings.force_ramp]]`.
#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ForceRampKeys {
    pub recording: String,
    pub before_contact_n: f64,
    pub time_s: f64,
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
        ("".to_owned(), keys::<RigKeys>().to_vec()),
        ("rig".to_owned(), keys::<PartKeys>().to_vec()),
        ("recordings".to_owned(), keys::<RecordingsKeys>().to_vec()),
        ("shares".to_owned(), keys::<SharesKeys>().to_vec()),
        ("known".to_owned(), keys::<KnownKeys>().to_vec()),
        ("flange".to_owned(), keys::<FlangeKeys>().to_vec()),
        ("flange.fit".to_owned(), FlangeModel::NAMES.to_vec()),
        (
            "recordings.force_ramp".to_owned(),
            keys::<ForceRampKeys>().to_vec(),
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
    sections.extend(with_accuracy.map(|tables| (tables.to_owned(), keys::<NumberKeys>().to_vec())));
    sections
}
