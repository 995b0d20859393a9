//! The device of a bench: a device model file, or a rig file with its contact and its sensors' errors.

use super::DeviceScenario;
use super::file::DeviceKeys;
use super::load::{device, is_rig};
use super::rig_file::load_rig;
use crate::keys::check::Section;
use crate::keys::error::ScenarioError;
use crate::plant::PlantParameters;

/// The device of a bench, and its physics. Of its tool a rig file says nothing; it is drawn as that of models/device.toml.
pub(super) fn bench_device(
    section: &Section<'_>,
    keys: &DeviceKeys,
) -> Result<(DeviceScenario, PlantParameters), ScenarioError> {
    let model = section.file("model", &keys.model)?;
    if !is_rig(&model)? {
        return device(section, keys);
    }
    let overrides = Section::new(section.document(), "device.override");
    if let Some(key) = overrides.given().next() {
        let reason = "device.model is a rig file, whose own keys say what it is".to_owned();
        return Err(overrides.misplaced(key, reason));
    }
    if keys.ideal.is_some() {
        let reason = "device.model is a rig file, whose own keys say what it is".to_owned();
        return Err(section.misplaced("ideal", reason));
    }
    let rig = load_rig(&model)?;
    refuse_without_counterpart(section, &rig.plant)?;
    let device = DeviceScenario {
        model,
        locked: keys.locked,
        ideal: false,
        assumed: Vec::new(),
    };
    Ok((device, rig.plant))
}

/// Refuses what a bench has no counterpart of.
fn refuse_without_counterpart(
    section: &Section<'_>,
    plant: &PlantParameters,
) -> Result<(), ScenarioError> {
    if plant.sensors.force_delay < 0.0 {
        let reason = "its channel_time_offset has a negative offset_s, and a bench that runs reads no force before it is there";
        return Err(section.misplaced("model", reason.to_owned()));
    }
    Ok(())
}
