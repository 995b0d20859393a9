//! The parts of the device that a rig may have alone.

use crate::listed::listed;
use crate::plant::trajectory::Channel;

listed! {
    /// Share of the device that a rig has.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
    pub enum DeviceParts: 6,
    /// Name in a rig file.
    name: &'static str {
        /// All of it, from set pressure to contact force.
        #[default]
        Whole = "whole",
        /// A piston that a rig moves at a recorded pressure; the load cell carries what it pushes.
        MovedPiston = "moved_piston",
        /// A slide that a motor drives; the force of the drive is recorded, positive along extension.
        DrivenSlide = "driven_slide",
        /// A chamber, filled and shut off.
        ClosedChamber = "closed_chamber",
        /// A regulator.
        Regulator = "regulator",
        /// A flange that presses by a force that it controls itself; the arm's speed and the contact force are recorded.
        ContactFlange = "contact_flange",
    }
}

impl DeviceParts {
    /// The channel that is predicted; none where all are.
    pub fn output(self) -> Option<Channel> {
        match self {
            Self::Whole => None,
            Self::MovedPiston | Self::DrivenSlide | Self::ContactFlange => Some(Channel::Force),
            Self::ClosedChamber | Self::Regulator => Some(Channel::RegulatorPressure),
        }
    }

    /// Whether the motion of the piston is recorded and taken as it is.
    pub fn takes_motion(self) -> bool {
        matches!(self, Self::MovedPiston | Self::DrivenSlide)
    }
}
