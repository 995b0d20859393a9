//! Noise of a recorded arm's sensors.

use crate::recorded_arm::simulate::Channel;

/// Standard deviations of the sensors' noise [SI]; none where there is no such sensor.
#[derive(Debug, Clone, PartialEq)]
pub struct ArmNoise {
    /// Of the joints' angles.
    pub position: f64,
    /// Of current or torque of each drive, base first.
    pub drives: Vec<Option<f64>>,
    /// Of angles on the links' side.
    pub link: Option<f64>,
    /// Of the wrench sensor's forces.
    pub force: Option<f64>,
    /// Of its torques.
    pub moment: Option<f64>,
}

impl ArmNoise {
    /// Noise of a channel; none where there is no such sensor.
    #[must_use]
    pub fn of(&self, channel: Channel) -> Option<f64> {
        match channel {
            Channel::Drive(joint) => self.drives[joint],
            Channel::Link(_) => self.link,
            Channel::Wrench(0..=2) => self.force,
            Channel::Wrench(_) => self.moment,
        }
    }
}
