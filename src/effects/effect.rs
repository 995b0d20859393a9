//! A physical effect that a model may lack: an edit of the rig's description.

use super::quantity::{Coordinate, Quantity};
use crate::plant::PlantParameters;

/// Part of the chain in which an effect enters.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Subsystem {
    /// Forces on the piston.
    ForceBalance,
    /// Air.
    Chambers,
    /// From set pressure to outlet, and the valve.
    Regulator,
    /// Tool on workpiece.
    Contact,
    /// Sensors.
    Sensors,
    /// The arm that carries the device.
    Arm,
    /// The part.
    Workpiece,
}

impl Subsystem {
    /// Name in an answer.
    pub fn name(self) -> &'static str {
        match self {
            Self::ForceBalance => "force_balance",
            Self::Chambers => "chambers",
            Self::Regulator => "regulator",
            Self::Contact => "contact",
            Self::Sensors => "sensors",
            Self::Arm => "arm",
            Self::Workpiece => "workpiece",
        }
    }
}

/// One number of an effect.
#[derive(Debug, Clone, Copy)]
pub struct Parameter {
    /// The quantity.
    pub quantity: Quantity,
    /// Coordinate of the fit.
    pub coordinate: Coordinate,
    /// Least and largest value.
    pub bounds: [f64; 2],
    /// Is it a part of the answer, or only of the model?
    pub reported: bool,
    /// Values between which a fit chooses, where there are no values between them; nothing for what varies continuously.
    pub choices: &'static [f64],
}

/// What is known when an effect is asked where a fit might start.
pub struct Clues<'a> {
    /// The description so far.
    pub plant: &'a PlantParameters,
    /// Largest force reading [N].
    pub largest_force: f64,
    /// Strongest periodic parts of what is left in the force while touching: frequency [Hz], strongest first.
    pub periodic: &'a [f64],
    /// Places along a cell's edge where what is left in the stroke looks like a bump, strongest first [m].
    pub bumps: &'a [f64],
}

/// An effect.
pub struct Effect {
    /// Name in an answer.
    pub name: &'static str,
    /// Where it enters.
    pub subsystem: Subsystem,
    /// Its numbers, reported ones first.
    pub parameters: fn(&PlantParameters) -> Vec<Parameter>,
    /// Its numbers at a size that devices and cells usually show, beside what is believed of them; all of them, in that order.
    pub usual: fn(&PlantParameters) -> Vec<f64>,
    /// Values to start from, one list of all parameters each.
    pub starts: fn(&Clues<'_>) -> Vec<Vec<f64>>,
    /// Effects of the same group exclude one another.
    pub group: Option<&'static str>,
}

impl std::fmt::Debug for Effect {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        formatter.write_str(self.name)
    }
}

impl Effect {
    /// Can it not stand beside another one?
    pub fn excludes(&self, other: &Effect) -> bool {
        self.name == other.name || (self.group.is_some() && self.group == other.group)
    }
}
