//! The rig file: a device, its contact and its sensors by their nominal values, or as a diagnosis has improved them. Strict SI.
//!
//! ```text
//! key = 5.09                                   a number
//! key = { value = 5.09, tolerance = 0.01 }     lies within 1 % of it
//! key = { value = 5.13, low = 5.1, high = 5.2 } known to lie in an interval
//! [rig]  chain = "moved_piston"                a part of the device ([`crate::plant::Chain`]); only that part's numbers are then asked for
//! [[effect]]                                   physics beyond the nominal model (`super::effects`)
//! [shares]  force_sensor = "LC-7"              a part that other rigs have too, by its serial number ([`Shares`])
//! [limits]                                     how far an experiment may move the rig
//! [known]                                      how sure a diagnosis is of it, and what its recordings covered (`known`)
//! [latent]                                     physics that no known effect explains (`latent`)
//! [flange]                                     a contact flange as it was fitted to runs (`flange`)
//! ```

use std::path::{Path, PathBuf};

use super::effects::effects;
use crate::effects::{PresentEffect, candidates};
use crate::flange::FittedFlange;
use crate::keys::document::{Document, read_text};
use crate::keys::error::ScenarioError;
use crate::plant::{OperatingLimits, PlantParameters};
use keys::{RigKeys, sections};
use values::{check_together, limits, pressure_drift, recordings, sensors, shares};

mod entry;
mod flange;
mod improved;
mod keys;
mod known;
mod latent;
mod number;
mod quantities;
#[cfg(test)]
pub(super) mod tests;
mod values;

pub use improved::{Improved, improved_text, text_with_recordings};
pub(super) use keys::{LimitsKeys, PartKeys, RecordingsKeys, SharesKeys};
pub use known::{FREQUENCY_NAME, Known, coefficient_name, of_term};
pub(super) use quantities::described_numbers;
pub use values::{RecordingForceRamp, Shares, Tolerance};

/// Pressure of a regulator's supply of which a file says nothing: as much as a regulator stands, so that it never binds [Pa gauge].
const AMPLE_SUPPLY: f64 = 16e5;

/// Version of the format.
const SCHEMA: u32 = 2;

/// A rig file, checked.
#[derive(Debug, Clone)]
pub struct RigFile {
    /// File that it was read from.
    pub path: PathBuf,
    /// Its text.
    text: String,
    /// The rig, with the effects and the model discrepancy that the file holds.
    pub plant: PlantParameters,
    /// Numbers that are not exactly known, in the order of the format.
    pub tolerances: Vec<Tolerance>,
    /// Samples per second [Hz].
    pub rate: f64,
    /// Standard deviation of each sensor's noise, in the order of [`crate::plant::CHANNELS`]; infinite where the rig has no such sensor.
    pub noise: [f64; 4],
    /// Standard deviation of the pressure sensor's drift [Pa/s].
    pub pressure_drift: f64,
    /// Recordings to diagnose from, as the file names them.
    pub fit: Vec<String>,
    /// Recording whose inputs are to be predicted.
    pub predict: Option<String>,
    /// Force ramps of recordings of a contact flange.
    pub force_ramps: Vec<RecordingForceRamp>,
    /// Effects that the file names, in the order of the catalogue, with all their numbers.
    pub effects: Vec<PresentEffect>,
    /// The rig without them and without a term that has no name.
    pub bare: PlantParameters,
    /// Parts that other rigs may have too.
    pub shares: Shares,
    /// How far it may be moved.
    pub limits: OperatingLimits,
    /// How sure a diagnosis is of it, and what its recordings covered.
    pub known: Option<Known>,
    /// A contact flange as a diagnosis has fitted it.
    pub flange: Option<FittedFlange>,
}

impl RigFile {
    /// Which channels the rig has sensors of, in the order of [`crate::plant::CHANNELS`].
    #[must_use]
    pub fn sensors(&self) -> [bool; 4] {
        self.noise.map(f64::is_finite)
    }
}

/// Reads and checks a rig file.
///
/// # Errors
/// File, line, column and key of what is wrong, what was found and what was expected.
pub fn load_rig(path: &Path) -> Result<RigFile, ScenarioError> {
    from_text(path, &read_text(path)?)
}

/// As [`load_rig`], of a text that stands, or could stand, in the file at `path`.
///
/// # Errors
/// As [`load_rig`].
pub fn from_text(path: &Path, text: &str) -> Result<RigFile, ScenarioError> {
    let document = Document::new(path, text, SCHEMA)?;
    let mut keys: RigKeys = document.parse(&sections())?;
    let mut plant = PlantParameters::default();
    plant.device.regulator.dead_time = 0.0;
    plant.device.regulator.supply = AMPLE_SUPPLY;
    let tolerances = values::base(&document, &keys, &mut plant)?;
    check_together(&document, &plant)?;
    let effects = effects(&document, &keys.effect, &candidates(plant.parts), &plant)?;
    let bare = plant.clone();
    for effect in &effects {
        effect.apply_to(&mut plant);
    }
    plant.latent = latent::latent(&document, keys.latent.as_ref())?;
    let known = known::known(&document, keys.known.take(), &plant, &effects)?;
    let flange = flange::flange(&document, keys.flange.as_ref(), plant.parts)?;
    let (rate, noise) = sensors(&document, &keys, plant.parts)?;
    let pressure_drift = pressure_drift(&document, &keys)?;
    let shares = shares(&document, keys.shares)?;
    let limits = limits(&document, &keys.limits)?;
    let recordings = recordings(&document, keys.recordings, plant.parts)?;
    Ok(RigFile {
        path: path.to_owned(),
        text: text.to_owned(),
        plant,
        tolerances,
        rate,
        noise,
        pressure_drift,
        fit: recordings.fit,
        predict: recordings.predict,
        force_ramps: recordings.force_ramps,
        effects,
        bare,
        shares,
        limits,
        known,
        flange,
    })
}
