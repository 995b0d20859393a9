//! Rigs that have a part of the device alone: what is recorded stands in the place of what would be simulated before it.
//!
//! ```text
//! moved piston      pressure, motion -> force          a rig moves the piston, the chamber's pressure is held
//! driven slide      motion -> force of the drive       a motor and screw in place of the air
//! closed chamber    start pressure -> pressure         filled and shut off
//! regulator         set pressure -> outlet             nothing but its own volume behind it
//! contact flange    desired force -> contact force     its own control inside, seen from outside
//! ```
//!
//! Each is a link of the whole chain with the same parameters, effects and sensors.

mod closed_chamber;
mod flange;
mod moved;
mod parameters;
mod regulator_alone;

use super::inputs::PlantInputs;
use super::parameters::PlantParameters;
use super::simulate::{Channel, Trajectory};

pub use parameters::LinkParameters;

/// Share of the device that a rig has.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Chain {
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

impl Chain {
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

/// True trajectory of a rig with a part of the device; none of a whole one.
pub(super) fn true_trajectory(plant: &PlantParameters, inputs: &PlantInputs) -> Option<Trajectory> {
    Some(match plant.chain {
        Chain::Whole => return None,
        Chain::MovedPiston | Chain::DrivenSlide => moved::true_trajectory(plant, inputs),
        Chain::ClosedChamber => closed_chamber::true_trajectory(plant, inputs),
        Chain::Regulator => regulator_alone::true_trajectory(plant, inputs),
        Chain::ContactFlange => flange::true_trajectory(plant, inputs),
    })
}

impl Trajectory {
    /// Nothing happens, at every sample.
    fn still(count: usize, atmosphere: f64) -> Self {
        let nothing = vec![0.0; count];
        Self {
            outlet: nothing.clone(),
            stroke: nothing.clone(),
            speed: nothing.clone(),
            acceleration: nothing.clone(),
            contact_force: nothing.clone(),
            pressures: [vec![atmosphere; count], vec![atmosphere; count]],
            mass_flow: nothing.clone(),
            hold_force: nothing.clone(),
            share: vec![1.0; count],
        }
    }
}
