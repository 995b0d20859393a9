//! The file of a recorded arm, arm.toml: links, drives, load and sensors by their nominal values, or as a diagnosis has improved them. Strict SI.
//!
//! ```text
//! gain_n_m_per_a = 11.8                                        exact
//! gain_n_m_per_a = { value = 11.8, tolerance = 0.1 }           lies within 10 % of it
//! zero_force_n = { value = [0, 0, 0], tolerance_n = 0.5 }      each component lies within 0.5 N of it
//! [[drive]]                                                    one for each moving joint, in the order in which columns count them
//! [[link]]                                                     a link by other numbers than the URDF's
//! [[effect]]                                                   physics beyond the nominal model (`effects`)
//! [[law]]                                                      the same where it has no name (`laws`)
//! ```

mod effects;
mod improved;
mod keys;
mod laws;
mod names;
mod noise;
mod order;
#[cfg(test)]
mod tests;
mod values;

use std::path::{Path, PathBuf};

use serde::Deserialize;
use serde_json::Value;

use super::CollisionScenario;
use super::collision::collision;
use crate::arm::{Arm, ArmError, ArmOptions, BodyInertia, Identified, identified_urdf, load_arm};
use crate::keys::check::Section;
use crate::keys::declaration::of_file;
use crate::keys::document::{Document, read_text};
use crate::keys::error::ScenarioError;
use crate::recorded_arm::push::Push;
use crate::recorded_arm::{ArmParameters, Tolerated};
use keys::ArmFileKeys;
use names::Names;
use values::Known;

pub(super) use effects::{EffectTables, further as further_numbers};
pub use improved::improved_arm_text;
pub use noise::ArmNoise;

/// Version of the format.
const SCHEMA: u32 = 1;
/// What `kind` says.
pub const RECORDED_ARM: &str = "recorded_arm";

/// An arm file, checked.
#[derive(Debug, Clone)]
pub struct ArmFile {
    /// File that it was read from.
    pub path: PathBuf,
    /// Its text.
    text: String,
    /// The URDF file.
    pub urdf: PathBuf,
    /// The arm, with the effects that the file holds; its pushes count recordings by `push_recordings`.
    pub nominal: ArmParameters,
    /// Links by the URDF.
    bodies: Vec<BodyInertia>,
    /// Names of the links behind the moving joints, base first.
    pub links: Vec<String>,
    /// Number of each joint in the names of columns, from 1, base first.
    pub numbers: Vec<usize>,
    /// Numbers that are known within bounds.
    pub tolerated: Vec<Tolerated>,
    /// Noise of the sensors.
    pub noise: ArmNoise,
    /// Samples per second [Hz].
    pub rate: f64,
    /// Recordings to diagnose from, as the file names them.
    pub fit: Vec<String>,
    /// Recording that is to be predicted.
    pub predict: Option<String>,
    /// Where the tool touches, along the flange's z from the wrench sensor's origin [m].
    pub tip: Option<f64>,
    /// What a designed path keeps clear of.
    pub collision: CollisionScenario,
    /// What of the URDF is the arm.
    options: ArmOptions,
    /// Recordings in which something pushes.
    push_recordings: Vec<String>,
}

impl ArmFile {
    /// The arm, its pushes counted by a list of recordings; those of others act in none, those that name none act in each.
    #[must_use]
    pub fn arm(&self, recordings: &[String]) -> ArmParameters {
        let mut arm = self.nominal.clone();
        arm.pushes.clear();
        for push in &self.nominal.pushes {
            let name = &self.push_recordings[push.recording];
            let places: Vec<usize> = match name.as_str() {
                effects::EVERY => (0..recordings.len()).collect(),
                name => {
                    let place = recordings.iter().position(|own| own == name);
                    vec![place.unwrap_or(usize::MAX)]
                }
            };
            let there = |recording| Push { recording, ..*push };
            arm.pushes.extend(places.into_iter().map(there));
        }
        arm
    }

    /// The arm with further effects, that a scenario lists under a key of it.
    pub(super) fn with_effects(
        mut self,
        document: &Document<'_>,
        (list, effects): (&str, &EffectTables),
    ) -> Result<Self, ScenarioError> {
        let names = Names {
            links: &self.links,
            numbers: &self.numbers,
        };
        let (arm, recordings) = (&mut self.nominal, &mut self.push_recordings);
        effects::apply(document, (list, effects), names, arm, recordings)?;
        Ok(self)
    }

    /// Names of the joints in the order of the drives.
    #[must_use]
    pub fn joints_of_drives(&self) -> Vec<&str> {
        let mut joints: Vec<(usize, &str)> = (self.numbers.iter().copied())
            .zip(self.nominal.chain.joints.iter().map(|j| j.name.as_str()))
            .collect();
        joints.sort_unstable();
        joints.into_iter().map(|(_, name)| name).collect()
    }

    /// The arm of the URDF with its shapes.
    ///
    /// # Errors
    /// A mesh that cannot be read.
    pub fn with_shapes(&self) -> Result<Arm, ArmError> {
        let options = ArmOptions {
            skip_visuals: false,
            ..self.options.clone()
        };
        load_arm(&self.urdf, &options)
    }

    /// Text of the URDF with the masses, centres and frictions of an arm in place of its own; none of a file of macros.
    ///
    /// # Errors
    /// The URDF can no longer be read.
    pub fn identified_urdf(&self, arm: &ArmParameters) -> Result<Option<String>, ArmError> {
        let joints = arm.chain.joints.iter().zip(&arm.drives).zip(&self.bodies);
        let found = joints.map(|((joint, drive), own)| {
            let same = joint.body == *own;
            Identified {
                mass_ratio: match own.mass > 0.0 && !same {
                    true => joint.body.mass / own.mass,
                    false => 1.0,
                },
                shift: joint.body.centre_of_mass - own.centre_of_mass,
                damping: drive.viscous,
                friction: drive.coulomb,
            }
        });
        identified_urdf(&self.urdf, &self.options, &found.collect::<Vec<_>>())
    }

    fn names(&self) -> Names<'_> {
        Names {
            links: &self.links,
            numbers: &self.numbers,
        }
    }
}

/// Kind of a file, whatever else stands in it.
#[derive(Deserialize)]
struct KindKeys {
    kind: Option<String>,
}

/// Whether a file says that it is of a recorded arm; not where it cannot be read.
#[must_use]
pub fn is_arm_file(path: &Path) -> bool {
    read_text(path).is_ok_and(|text| is_arm_text(path, &text))
}

/// As [`is_arm_file`], of a text that stands, or could stand, in the file at `path`.
#[must_use]
pub fn is_arm_text(path: &Path, text: &str) -> bool {
    let kind =
        Document::new(path, text, u32::MAX).and_then(|document| document.parse::<KindKeys>(&[]));
    kind.is_ok_and(|keys| keys.kind.as_deref() == Some(RECORDED_ARM))
}

/// Reads and checks an arm file and the URDF that it names.
///
/// # Errors
/// File, line, column and key of what is wrong, what was found and what was expected.
pub fn load_arm_file(path: &Path) -> Result<ArmFile, ScenarioError> {
    from_text(path, &read_text(path)?)
}

/// As [`load_arm_file`], of a text that stands, or could stand, in the file at `path`.
///
/// # Errors
/// As [`load_arm_file`].
pub fn from_text(path: &Path, text: &str) -> Result<ArmFile, ScenarioError> {
    let document = Document::new(path, text, SCHEMA)?;
    let keys: ArmFileKeys = document.read()?;
    let (mut arm, links, numbers) = values::chain(&document, &keys)?;
    let bodies = arm.chain.joints.iter().map(|joint| joint.body).collect();
    let names = Names {
        links: &links,
        numbers: &numbers,
    };
    let mut known = Known(Vec::new());
    values::links(&document, &keys, names, &mut arm, &mut known)?;
    for (place, number) in numbers.iter().enumerate() {
        let own = (number - 1, &keys.drives[number - 1]);
        arm.drives[place] = values::drive(&document, own, place, &mut known)?;
    }
    arm.load = values::load(&document, &keys.load, &mut known)?;
    arm.wrench = (keys.wrench.as_ref())
        .map(|wrench| values::wrench(&document, wrench, &mut known))
        .transpose()?;
    let noise = values::noise(&document, &keys.sensors, &arm, &numbers)?;
    let mut push_recordings = Vec::new();
    effects::apply(
        &document,
        ("effect", &keys.effects),
        names,
        &mut arm,
        &mut push_recordings,
    )?;
    arm.laws = laws::laws(&document, &keys.laws, names)?;
    check_recordings(&document, &keys.recordings.fit)?;
    Ok(ArmFile {
        path: path.to_owned(),
        text: text.to_owned(),
        urdf: document.folder().join(&keys.arm.urdf),
        nominal: arm,
        bodies,
        tolerated: known.0,
        noise,
        rate: keys.sensors.rate,
        fit: keys.recordings.fit,
        predict: keys.recordings.predict,
        tip: keys.wrench.and_then(|wrench| wrench.tip),
        collision: collision(&document, &keys.collision, &keys.obstacles)?,
        options: values::options(&keys.arm),
        push_recordings,
        links,
        numbers,
    })
}

/// Schema of the file.
#[must_use]
pub fn schema() -> Value {
    of_file::<ArmFileKeys>("A recorded arm of idc")
}

fn check_recordings(document: &Document<'_>, fit: &[String]) -> Result<(), ScenarioError> {
    let section = Section::new(document, "recordings");
    for (index, name) in fit.iter().enumerate() {
        let key = format!("fit[{index}]");
        section.text(&key, name)?;
        if fit[..index].contains(name) {
            let expected = "each recording once".to_owned();
            return Err(section.refuse(&key, format!("{name:?} again"), expected));
        }
    }
    Ok(())
}
