//! The parts of the device that a rig may have alone.

use crate::plant::trajectory::Channel;

/// Share of the device that a rig has.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum DeviceParts {
    /// All of it, from set pressure to contact force.
    #[default]
    Whole,
    /// A piston that a rig moves at a recorded pressure; the load cell carries what it pushes.
    MovedPiston,
    /// A slide that a motor drives; the force of the drive is recorded, positive along extension.
    DrivenSlide,
    /// A chamber, filled and shut off.
    ClosedChamber,
    /// A regulator.
    Regulator,
    /// A flange that presses by a force that it controls itself; the arm's speed and the contact force are recorded.
    ContactFlange,
}

impl DeviceParts {
    /// All of them.
    pub const ALL: [Self; 6] = [
        Self::Whole,
        Self::MovedPiston,
        Self::DrivenSlide,
        Self::ClosedChamber,
        Self::Regulator,
        Self::ContactFlange,
    ];

    /// Name in a rig file.
    pub fn name(self) -> &'static str {
        match self {
            Self::Whole => "whole",
            Self::MovedPiston => "moved_piston",
            Self::DrivenSlide => "driven_slide",
            Self::ClosedChamber => "closed_chamber",
            Self::Regulator => "regulator",
            Self::ContactFlange => "contact_flange",
        }
    }

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
