//! `[[effect]]` of an arm file: physics beyond the nominal model, by the names of the vocabulary, with all its numbers.
//!
//! ```text
//! [[effect]]
//! name = "gear_ripple"
//! joint = 2                          as columns count them; link = "link_3", channel = "force_z", recording = "fourier.csv" where the effect has that
//! amplitude_n_m = 1.4
//! cycles_per_turn = 101
//! phase_rad = 0.3                    beyond the vocabulary: what decides a prediction, and no answer is scored by
//! ```

use std::collections::BTreeMap;

use glam::DVec3;
use serde::Deserialize;
use serde_json::{Value, json};

use super::super::effects::EffectValue;
use super::names::Names;
use crate::keys::check::{Section, checked};
use crate::keys::declaration::Filled;
use crate::keys::document::Document;
use crate::keys::error::ScenarioError;
use crate::keys::suggestion::nearest;
use crate::recorded_arm::push::Push;
use crate::recorded_arm::vocabulary::{ARM_EFFECTS, ArmEffectName, Place, arm_effect};
use crate::recorded_arm::wrench::{Crosstalk, WrenchSensor};
use crate::recorded_arm::{ArmParameters, Drive, PointMass};
use crate::unit::Unit;

/// Key of an effect's name.
const NAME: &str = "name";
/// Frictions of a joint, of which one may stand.
const FRICTIONS: [&str; 3] = [
    "joint_friction",
    "stribeck_joint_friction",
    "load_dependent_joint_friction",
];

/// `[[effect]]` as it is written.
#[derive(Debug, Clone, Default, PartialEq, Deserialize)]
#[serde(transparent)]
pub(in super::super) struct EffectTables(Vec<BTreeMap<String, EffectValue>>);

impl Filled for EffectTables {
    type Written = Self;
    const WORD: &'static str = "tables";

    fn filled(written: Self, _: Unit) -> Result<Self, &'static str> {
        Ok(written)
    }

    fn absent() -> Option<Self> {
        Some(Self::default())
    }

    fn schema() -> Value {
        let number = json!({ "type": "number" });
        let mut properties = serde_json::Map::new();
        properties.insert(
            NAME.to_owned(),
            json!({ "enum": ARM_EFFECTS.map(|e| e.name), "description": "An effect of the vocabulary. Required." }),
        );
        for effect in &ARM_EFFECTS {
            for place in effect.places {
                let form = match place {
                    Place::Joint => {
                        json!({ "type": "integer", "minimum": 1, "description": "The joint, as columns count them." })
                    }
                    other => {
                        json!({ "type": "string", "description": format!("The {} in which, or of which, it is.", other.key()) })
                    }
                };
                properties.insert(place.key().to_owned(), form);
            }
            for key in effect.numbers.iter().chain(further(effect.name)) {
                let unit = Unit::of_key(key).symbol;
                let unit = if unit.is_empty() { "1" } else { unit };
                let about = format!("Number of {} [{unit}].", having(key).join(", "));
                let form = json!({ "anyOf": [number, { "type": "object" }], "description": about });
                properties.insert((*key).to_owned(), form);
            }
        }
        json!({ "type": "array", "description": "Tables [[effect]]: physics beyond the nominal arm.", "items": {
            "type": "object",
            "properties": properties,
            "required": [NAME],
            "additionalProperties": false,
        } })
    }
}

/// Effects that have a number of this key.
fn having(key: &str) -> Vec<&'static str> {
    let all = ARM_EFFECTS.iter();
    let own = all.filter(|e| e.numbers.contains(&key) || further(e.name).contains(&key));
    own.map(|effect| effect.name).collect()
}

/// Keys that an effect may have beyond its numbers in the vocabulary.
pub(in super::super) const fn further(name: &str) -> &'static [&'static str] {
    match name.as_bytes() {
        b"gear_ripple" => &["phase_rad"],
        b"outside_push" => &["direction_x", "direction_y", "direction_z", "edge"],
        _ => &[],
    }
}

/// An effect that is read.
struct Read<'a> {
    section: Section<'a>,
    table: &'a BTreeMap<String, EffectValue>,
    effect: &'static ArmEffectName,
    names: Names<'a>,
}

impl EffectTables {
    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }
}

/// Puts effects, listed under a key of a file, into an arm. Pushes are counted by the arm's own list of recordings, which grows.
pub(super) fn apply(
    document: &Document<'_>,
    (list, EffectTables(tables)): (&str, &EffectTables),
    names: Names<'_>,
    arm: &mut ArmParameters,
    recordings: &mut Vec<String>,
) -> Result<(), ScenarioError> {
    let mut seen: Vec<(&str, String)> = Vec::new();
    for (index, table) in tables.iter().enumerate() {
        let section = Section::new(document, format!("{list}[{index}]"));
        let effect = named(&section, table)?;
        let read = Read {
            section,
            table,
            effect,
            names,
        };
        read.check_keys()?;
        let place = read.place();
        let other = seen.iter().find(|(name, other)| {
            let alike = *name == effect.name
                || (FRICTIONS.contains(name) && FRICTIONS.contains(&effect.name));
            alike && *other == place && effect.name != "outside_push"
        });
        if let Some((name, _)) = other {
            let reason = format!("{name} stands in its place already");
            return Err(read.section.misplaced_itself(reason));
        }
        seen.push((effect.name, place));
        match effect.subsystem {
            _ if effect.places == [Place::Joint] => {
                let joint = read.joint()?;
                read.of_joint(&mut arm.drives[joint])?;
            }
            "wrench_sensor" => {
                let Some(wrench) = arm.wrench.as_mut() else {
                    let expected = "[wrench_sensor] in the file, of which it is";
                    let found = format!("{:?}", effect.name);
                    return Err(read.section.refuse(NAME, found, expected.to_owned()));
                };
                read.of_wrench(wrench)?;
            }
            _ => read.of_arm(arm, recordings)?,
        }
    }
    Ok(())
}

/// The effect that a table names.
fn named(
    section: &Section<'_>,
    table: &BTreeMap<String, EffectValue>,
) -> Result<&'static ArmEffectName, ScenarioError> {
    let all: Vec<&str> = ARM_EFFECTS.iter().map(|effect| effect.name).collect();
    match table.get(NAME) {
        Some(EffectValue::Text(name)) => arm_effect(name).ok_or_else(|| {
            let expected = format!("an effect of the vocabulary; {}", nearest(name, &all));
            section.refuse(NAME, format!("{name:?}"), expected)
        }),
        Some(other) => Err(section.refuse(NAME, other.to_string(), "a text".to_owned())),
        None => Err(section.missing(NAME, &format!("one of {}", all.join(", ")))),
    }
}

/// Range of a number of an effect.
fn range(key: &str) -> [f64; 2] {
    match key {
        "mass_kg" | "coulomb_n_m" | "viscous_n_m_s_per_rad" | "inertia_kg_m2" => [0.0, 1e6],
        "stribeck_velocity_rad_per_s" | "time_constant_s" => [1e-9, 1e9],
        "edge" => [0.0, 0.5],
        _ => [-1e12, 1e12],
    }
}

impl Read<'_> {
    fn check_keys(&self) -> Result<(), ScenarioError> {
        let places = self.effect.places.iter().map(|place| place.key());
        let numbers = self.effect.numbers.iter().copied();
        let further = further(self.effect.name).iter().copied();
        let known: Vec<&str> = [NAME]
            .into_iter()
            .chain(places)
            .chain(numbers)
            .chain(further)
            .collect();
        match self.table.keys().find(|key| !known.contains(&key.as_str())) {
            None => Ok(()),
            Some(key) => {
                let dotted = self.section.dotted(key);
                Err(ScenarioError::UnknownKey {
                    location: self.section.document().key_location(&dotted),
                    key: dotted,
                    advice: nearest(key, &known),
                })
            }
        }
    }

    /// What says where it is, as it is written.
    fn place(&self) -> String {
        let keys = self.effect.places.iter();
        let written = keys.filter_map(|place| Some(self.table.get(place.key())?.to_string()));
        written.collect::<Vec<_>>().join(" ")
    }

    fn optional(&self, key: &str) -> Result<Option<f64>, ScenarioError> {
        let Some(value) = self.table.get(key) else {
            return Ok(None);
        };
        let Some(known) = value.number() else {
            let expected = "a number or { value, low, high }".to_owned();
            return Err(self.section.refuse(key, value.to_string(), expected));
        };
        let own = Section::new(self.section.document(), self.section.dotted(key));
        known.check(&own)?;
        checked(&self.section, key, known.value, range(key)).map(Some)
    }

    fn number(&self, key: &str) -> Result<f64, ScenarioError> {
        let value = self.optional(key)?;
        let unit = Unit::of_key(key);
        value.ok_or_else(|| {
            let expected = format!("it to be given in {}", unit.symbol);
            self.section.missing(key, expected.trim_end_matches(" in "))
        })
    }

    /// A number that something is divided by.
    fn divisor(&self, key: &str) -> Result<f64, ScenarioError> {
        match self.number(key)? {
            0.0 => Err(self
                .section
                .refuse(key, "0".to_owned(), "another than 0".to_owned())),
            value => Ok(value),
        }
    }

    fn text(&self, place: Place, expected: &str) -> Result<&str, ScenarioError> {
        match self.table.get(place.key()) {
            Some(EffectValue::Text(text)) => Ok(text),
            Some(other) => {
                let expected = expected.to_owned();
                Err(self
                    .section
                    .refuse(place.key(), other.to_string(), expected))
            }
            None => Err(self.section.missing(place.key(), expected)),
        }
    }

    /// Place in the chain of its joint.
    fn joint(&self) -> Result<usize, ScenarioError> {
        let Some(value) = self.table.get(Place::Joint.key()) else {
            let expected = "the number of its joint, as columns count them";
            return Err(self.section.missing(Place::Joint.key(), expected));
        };
        let number = value.number().map_or(f64::NAN, |known| known.value);
        self.names.joint(number).ok_or_else(|| {
            let expected = format!("1 to {}, as columns count them", self.names.numbers.len());
            self.section
                .refuse(Place::Joint.key(), value.to_string(), expected)
        })
    }

    fn channel(&self, place: Place) -> Result<usize, ScenarioError> {
        use crate::recorded_arm::wrench::CHANNELS;
        let expected = format!("one of {}", CHANNELS.join(", "));
        let name = self.text(place, &expected)?;
        let found = CHANNELS.iter().position(|channel| *channel == name);
        found.ok_or_else(|| {
            self.section
                .refuse(place.key(), format!("{name:?}"), expected)
        })
    }

    fn vector(&self, keys: [&str; 3]) -> Result<DVec3, ScenarioError> {
        let [x, y, z] = keys.map(|key| self.number(key));
        Ok(DVec3::new(x?, y?, z?))
    }

    fn of_joint(&self, drive: &mut Drive) -> Result<(), ScenarioError> {
        let n = |key: &str| self.number(key);
        match self.effect.name {
            "joint_friction" => {
                drive.coulomb = n("coulomb_n_m")?;
                drive.viscous = n("viscous_n_m_s_per_rad")?;
            }
            "stribeck_joint_friction" => {
                drive.coulomb = n("coulomb_n_m")?;
                drive.viscous = n("viscous_n_m_s_per_rad")?;
                drive.static_excess = n("static_n_m")? - drive.coulomb;
                drive.stribeck_velocity = n("stribeck_velocity_rad_per_s")?;
            }
            "load_dependent_joint_friction" => drive.load_friction = n("friction_per_load")?,
            "motor_inertia_error" => drive.motor_inertia = n("inertia_kg_m2")?,
            "drive_gain_error" => {
                if !drive.logs_current {
                    let reason =
                        "the drive has no gain_n_m_per_a: its torque is logged, not its current";
                    return Err(self.section.misplaced(NAME, reason.to_owned()));
                }
                drive.inverse_gain = 1.0 / self.divisor("gain_n_m_per_a")?;
            }
            "joint_torque_offset" => drive.offset += n("offset_n_m")?,
            "gear_ripple" => {
                let phase = self.optional("phase_rad")?.unwrap_or(0.0);
                let (sine, cosine) = phase.sin_cos();
                let amplitude = n("amplitude_n_m")?;
                drive.ripple = [amplitude * cosine, amplitude * sine];
                drive.ripple_cycles = n("cycles_per_turn")?;
            }
            "compliant_joint" => drive.compliance = 1.0 / self.divisor("stiffness_n_m_per_rad")?,
            "joint_encoder_offset" => drive.encoder_offset = n("offset_rad")?,
            "joint_warm_up" => {
                drive.warm_fraction = n("fraction")?;
                drive.warm_time = n("time_constant_s")?;
            }
            _ => {
                drive.spring_stiffness = n("stiffness_n_m_per_rad")?;
                drive.offset -= drive.spring_stiffness * n("rest_rad")?;
            }
        }
        Ok(())
    }

    fn of_wrench(&self, wrench: &mut WrenchSensor) -> Result<(), ScenarioError> {
        let n = |key: &str| self.number(key);
        match self.effect.name {
            "wrench_zero" => {
                for (zero, key) in wrench.zero.iter_mut().zip(self.effect.numbers) {
                    *zero = n(key)?;
                }
            }
            "tool_weight_error" => {
                wrench.tool_mass = n("mass_kg")?;
                wrench.tool_centre = self.vector(["centre_x_m", "centre_y_m", "centre_z_m"])?;
            }
            "wrench_frame_turned" => wrench.rotation += n("angle_rad")?,
            "wrench_gain_error" => wrench.gain[self.channel(Place::Channel)?] = n("gain")?,
            "wrench_crosstalk" => wrench.crosstalk.push(Crosstalk {
                source: self.channel(Place::Source)?,
                target: self.channel(Place::Target)?,
                share: n("coefficient")?,
            }),
            _ => wrench.drift[self.channel(Place::Channel)?] = n("n_per_s")?,
        }
        Ok(())
    }

    fn of_arm(
        &self,
        arm: &mut ArmParameters,
        recordings: &mut Vec<String>,
    ) -> Result<(), ScenarioError> {
        let n = |key: &str| self.number(key);
        match self.effect.name {
            "payload" => {
                let mass = n("mass_kg")?;
                let centre = self.vector(["centre_x_m", "centre_y_m", "centre_z_m"])?;
                arm.payload = PointMass {
                    mass,
                    moment: mass * centre,
                };
            }
            "link_mass_error" => {
                let all = self.names.links.join(", ");
                let name = self.text(Place::Link, &format!("one of {all}"))?;
                let Some(link) = self.names.links.iter().position(|link| link == name) else {
                    let expected = format!("a link behind a moving joint: one of {all}");
                    return Err((self.section).refuse("link", format!("{name:?}"), expected));
                };
                let body = &mut arm.chain.joints[link].body;
                crate::recorded_arm::parameters::set_mass(body, n("mass_kg")?);
            }
            "base_tilt" => arm.tilt = [n("roll_rad")?, n("pitch_rad")?],
            "current_late" => arm.delay = n("delay_s")?,
            _ => {
                let name = match self.table.contains_key(Place::Recording.key()) {
                    true => self.text(Place::Recording, "the name of its recording's file")?,
                    false => EVERY,
                };
                let push = self.push(place_of(recordings, name))?;
                arm.pushes.push(push);
            }
        }
        Ok(())
    }

    fn push(&self, recording: usize) -> Result<Push, ScenarioError> {
        let [start, end] = ["start_s", "end_s"].map(|key| self.number(key));
        let (start, end) = (start?, end?);
        if end <= start {
            let expected = format!("more than start_s, {start} s");
            return Err(self.section.refuse_number("end_s", end, expected));
        }
        let keys = ["direction_x", "direction_y", "direction_z"];
        let [x, y, z] = keys.map(|key| self.optional(key));
        let direction = DVec3::new(x?.unwrap_or(0.0), y?.unwrap_or(0.0), z?.unwrap_or(0.0));
        // Without a direction it is down, as most that lies on something.
        let direction = direction.try_normalize().unwrap_or(-DVec3::Z);
        Ok(Push {
            recording,
            start,
            end,
            edge: self.optional("edge")?.unwrap_or(0.2),
            force: self.number("force_n")? * direction,
        })
    }
}

/// Name under which something is in every recording.
pub(super) const EVERY: &str = "";

/// Place of a recording in a list, which it is put into where it is not there.
fn place_of(recordings: &mut Vec<String>, name: &str) -> usize {
    let known = recordings.iter().position(|known| known == name);
    known.unwrap_or_else(|| {
        recordings.push(name.to_owned());
        recordings.len() - 1
    })
}
