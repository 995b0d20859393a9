//! The device of a bench: a device model file, or a rig file with its contact and its sensors' errors.

use super::DeviceScenario;
use super::file::DeviceKeys;
use super::load::{device, is_rig};
use super::rig_file::load_rig;
use crate::keys::check::Section;
use crate::keys::error::ScenarioError;
use crate::plant::{ContactParameters, Latent, OwnLaw, PlantParameters, SensorErrors, registry};

/// Parts of a device on a bench.
pub(super) struct BenchDevice {
    pub device: DeviceScenario,
    /// Component of gravity along extension [m/s2], unless the bench gives another.
    pub gravity_along_extension: f64,
    /// Contact, unless the load gives another.
    pub contact: ContactParameters,
    pub sensor_errors: SensorErrors,
    /// A term without a name, as a diagnosis found it.
    pub latent: Option<Latent>,
    /// Laws of a user's own.
    pub own: Vec<OwnLaw>,
}

/// The contact of a load that says nothing of it.
pub(super) fn usual_contact(ideal: bool) -> ContactParameters {
    ContactParameters::linear(
        registry::CONTACT_STIFFNESS.default_of(ideal),
        registry::CONTACT_DAMPING.default_of(ideal),
    )
}

/// The device of a bench.
pub(super) fn bench_device(
    section: &Section<'_>,
    keys: &DeviceKeys,
) -> Result<BenchDevice, ScenarioError> {
    let model = section.file("model", &keys.model)?;
    if !is_rig(&model)? {
        let device = device(section, keys)?;
        return Ok(BenchDevice {
            contact: usual_contact(device.ideal),
            device,
            gravity_along_extension: 0.0,
            sensor_errors: SensorErrors::NONE,
            latent: None,
            own: Vec::new(),
        });
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
    Ok(BenchDevice {
        device: DeviceScenario {
            model,
            parameters: rig.plant.device,
            locked: keys.locked,
            ideal: false,
            // Of its tool a rig file says nothing; it is drawn as that of models/device.toml.
            moving_centre_of_mass: 0.1,
            moving_radius_of_gyration: 0.05,
            housing_mass: 0.0,
            housing_centre_of_mass: 0.0,
            tool_centre: 0.15,
            tool_radius: 0.005,
            judged: Vec::new(),
        },
        gravity_along_extension: rig.plant.gravity_along_extension,
        contact: rig.plant.contact,
        sensor_errors: rig.plant.sensors,
        latent: rig.plant.latent,
        own: rig.plant.own,
    })
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
