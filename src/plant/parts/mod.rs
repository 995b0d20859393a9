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
mod device_parts;
mod flange;
mod moved;
mod parameters;
mod regulator_alone;

use super::inputs::PlantInputs;
use super::parameters::PlantParameters;
use super::trajectory::Trajectory;

pub use device_parts::DeviceParts;
pub use parameters::LinkParameters;

/// True trajectory of a rig with a part of the device; none of a whole one.
pub(super) fn true_trajectory(plant: &PlantParameters, inputs: &PlantInputs) -> Option<Trajectory> {
    Some(match plant.parts {
        DeviceParts::Whole => return None,
        DeviceParts::MovedPiston | DeviceParts::DrivenSlide => {
            moved::true_trajectory(plant, inputs)
        }
        DeviceParts::ClosedChamber => closed_chamber::true_trajectory(plant, inputs),
        DeviceParts::Regulator => regulator_alone::true_trajectory(plant, inputs),
        DeviceParts::ContactFlange => flange::true_trajectory(plant, inputs),
    })
}
