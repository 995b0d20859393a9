//! Constant parameters of a rig while it is recorded.

use super::cell_parameters::CellParameters;
use super::contact::ContactParameters;
use super::latent::Latent;
use super::mounting::Mounting;
use super::own_law::OwnLaw;
use super::parts::{DeviceParts, LinkParameters};
use super::sensors::SensorErrors;
use crate::device::DeviceParameters;

/// A rig: device, contact, sensors; of a cell its arm and part too.
#[derive(Debug, Clone, PartialEq)]
pub struct PlantParameters {
    /// The share of the device that there is.
    pub parts: DeviceParts,
    /// Further properties of its single links.
    pub links: LinkParameters,
    /// The device.
    pub device: DeviceParameters,
    /// How it is mounted.
    pub mounting: Mounting,
    /// Component of gravity along extension [m/s2].
    pub gravity_along_extension: f64,
    /// Tool on workpiece.
    pub contact: ContactParameters,
    /// Arm and part of a cell.
    pub cell: CellParameters,
    /// Errors of the sensors.
    pub sensors: SensorErrors,
    /// A model discrepancy.
    pub latent: Option<Latent>,
    /// Laws of a user's own.
    pub own: Vec<OwnLaw>,
}

impl Default for PlantParameters {
    /// A whole device with ideal sensors, alone: neither gravity along it, nor contact, nor an arm that gives.
    fn default() -> Self {
        Self {
            parts: DeviceParts::Whole,
            links: LinkParameters::NONE,
            device: DeviceParameters::default(),
            mounting: Mounting::default(),
            gravity_along_extension: 0.0,
            contact: ContactParameters::linear(0.0, 0.0),
            cell: CellParameters::RIGID,
            sensors: SensorErrors::NONE,
            latent: None,
            own: Vec::new(),
        }
    }
}

impl PlantParameters {
    /// Whether the rig moves as another one does where there is no workpiece.
    pub fn moves_freely_as(&self, other: &Self) -> bool {
        self.parts == other.parts
            && self.links == other.links
            && self.device == other.device
            && self.gravity_along_extension == other.gravity_along_extension
            && self.cell == other.cell
            && self.moving_latent() == other.moving_latent()
            && self.moving_laws().eq(other.moving_laws())
    }

    /// The model discrepancy, if it is not of a reading alone.
    fn moving_latent(&self) -> Option<&Latent> {
        self.latent
            .as_ref()
            .filter(|latent| !latent.port.is_reading())
    }

    /// Laws of a user's own that are not of a reading alone.
    fn moving_laws(&self) -> impl Iterator<Item = &OwnLaw> {
        let moves = |law: &&OwnLaw| law.acts && !law.text.port.is_reading();
        self.own.iter().filter(moves)
    }

    /// Whether the rig moves as another one does in one of the recordings, by its place among them, whatever its sensors say.
    pub fn moves_as(&self, other: &Self, recording: usize) -> bool {
        let [own, its] = [self, other].map(|plant| plant.contact.in_recording(recording));
        self.moves_freely_as(other) && own == its
    }
}
