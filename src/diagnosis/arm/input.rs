//! What a diagnosis of a recorded arm is made of.

use crate::recorded_arm::motion::Motion;
use crate::recorded_arm::simulate::Channel;
use crate::recorded_arm::{ArmParameters, Tolerated};

/// A recording of an arm.
#[derive(Debug, Clone, PartialEq)]
pub struct ArmRecording {
    /// Name for people, that of its file.
    pub name: String,
    /// Motion of its joints.
    pub motion: Motion,
    /// Readings by channel and sample; not a number where there is none.
    pub readings: Vec<Vec<f64>>,
}

/// Model, recordings and tolerances.
#[derive(Debug, Clone, PartialEq)]
pub struct ArmInput {
    /// The arm as declared.
    pub nominal: ArmParameters,
    /// Names of the links behind the joints, base first.
    pub links: Vec<String>,
    /// Number of each joint in the names of columns and in answers, from 1, base first.
    pub numbers: Vec<usize>,
    /// Numbers that are known within bounds; what is not among them is exact.
    pub tolerated: Vec<Tolerated>,
    /// Measured channels.
    pub channels: Vec<Channel>,
    /// Name of each channel's column.
    pub columns: Vec<String>,
    /// Standard deviation of the noise of each channel [its unit].
    pub noise: Vec<f64>,
    /// Recordings to diagnose from.
    pub recordings: Vec<ArmRecording>,
}

impl ArmInput {
    /// Whether what acts from outside is known: a contact then shows better than drives and wrench do where the joints are, and what encoders and gears do is
    /// diagnosed from that.
    #[must_use]
    pub fn shows_joints_by_contact(&self) -> bool {
        let mut recordings = self.recordings.iter();
        recordings.any(|own| own.motion.outside.is_some())
    }
}
