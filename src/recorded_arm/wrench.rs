//! A wrench sensor between flange and tool: what the tool does to it, as it reads that.
//!
//! ```text
//! w = -(m a, c x m a + I w' + ..)            of the tool beyond it, about its origin; still: the tool's weight
//! r = G (R_z(-rotation) w) + zero + rate t
//! ```
//!
//! G gains and crosstalk: reading k = gain_k truth_k + sum over sources of share truth_source. Source of the wrench: Featherstone, Rigid Body Dynamics
//! Algorithms, 2008, sec. 2.13 (Newton-Euler).

use glam::{DMat3, DQuat, DVec3};
use glamx::DPose3;

use super::outside::OutsideWrench;
use crate::arm::BodyInertia;
use crate::arm::dynamics::LinkMotion;

/// Channels of a wrench, in their order.
pub const CHANNELS: [&str; 6] = [
    "force_x", "force_y", "force_z", "torque_x", "torque_y", "torque_z",
];

/// A share of one channel that another reads in addition.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Crosstalk {
    /// Channel whose truth it is.
    pub source: usize,
    /// Channel that reads it.
    pub target: usize,
    /// The share [channel of the target over that of the source].
    pub share: f64,
}

/// A wrench sensor and the tool that hangs on it.
#[derive(Debug, Clone, PartialEq)]
pub struct WrenchSensor {
    /// Its origin along the flange's z [m].
    pub height: f64,
    /// Its axes against the flange's, about z [rad].
    pub rotation: f64,
    /// Readings without a tool [N, N m].
    pub zero: [f64; 6],
    /// Rates of the zeros [N/s, N m/s].
    pub drift: [f64; 6],
    /// Readings over truth [1].
    pub gain: [f64; 6],
    /// Crosstalk.
    pub crosstalk: Vec<Crosstalk>,
    /// Mass of all beyond it [kg].
    pub tool_mass: f64,
    /// Its centre from the sensor's origin, in the flange's axes [m].
    pub tool_centre: DVec3,
    /// Its inertia about its centre, in the flange's axes, per mass [m2].
    pub tool_inertia_per_mass: DVec3,
}

impl WrenchSensor {
    /// The tool, in the frame of the sensor's origin with the flange's axes.
    #[must_use]
    pub fn tool(&self) -> BodyInertia {
        BodyInertia {
            mass: self.tool_mass,
            centre_of_mass: self.tool_centre,
            inertia: DMat3::from_diagonal(self.tool_inertia_per_mass * self.tool_mass),
        }
    }

    /// What the tool does to the sensor as the flange moves, with what acts on it from outside, in the sensor's axes.
    #[must_use]
    pub fn truth(&self, flange: &LinkMotion, outside: Option<&OutsideWrench>) -> [f64; 6] {
        let centre = DVec3::Z * self.height;
        let origin = DPose3::from_translation(centre);
        let (force, moment) = flange.of_fixed(&origin).wrench_of(&self.tool());
        let outside = outside.unwrap_or(&OutsideWrench::ZERO);
        let force = outside.force - force;
        let moment = outside.moment_about(centre) - moment;
        let turned = DQuat::from_rotation_z(-self.rotation);
        let (force, moment) = (turned * force, turned * moment);
        [force.x, force.y, force.z, moment.x, moment.y, moment.z]
    }

    /// Reading of a wrench at a time of the recording [s].
    #[must_use]
    pub fn reading(&self, truth: &[f64; 6], time: f64) -> [f64; 6] {
        let mut reading = [0.0; 6];
        for (k, value) in reading.iter_mut().enumerate() {
            *value = self.gain[k] * truth[k] + self.zero[k] + self.drift[k] * time;
        }
        for crosstalk in &self.crosstalk {
            reading[crosstalk.target] += crosstalk.share * truth[crosstalk.source];
        }
        reading
    }
}
