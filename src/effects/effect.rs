//! A physical effect that a model may lack: an edit of the rig's description.

use super::quantity::Coordinate;
use crate::listed::listed;
use crate::plant::registry::Number;
use crate::plant::{PlantParameters, Quantity};

listed! {
    /// Part of the chain in which an effect enters.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
    pub enum Subsystem,
    /// Name in an answer.
    name: &'static str {
        /// Forces on the piston.
        ForceBalance = "force_balance",
        /// Air.
        Chambers = "chambers",
        /// From set pressure to outlet, and the valve.
        Regulator = "regulator",
        /// Tool on workpiece.
        Contact = "contact",
        /// Sensors.
        Sensors = "sensors",
        /// The arm that carries the device.
        Arm = "arm",
        /// The part.
        Workpiece = "workpiece",
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
    /// Whether it is a part of the answer, or only of the model.
    pub reported: bool,
    /// Values between which a fit chooses, where there are no values between them; nothing for what varies continuously.
    pub choices: &'static [f64],
}

/// Knowledge at hand when an effect is asked where a fit might start.
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

/// Name in an answer of a number of the rig file that is off.
pub const NUMBER_OFF: &str = "number_off";

/// Which of several alike an effect is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Which {
    /// The only one.
    Only,
    /// That of one joint.
    Joint {
        /// Name in the vocabulary.
        kind: &'static str,
        /// Joint, base first, from 0.
        joint: usize,
    },
    /// A number of the rig file that is off.
    Number {
        /// Its place among those that may be.
        place: usize,
        /// Its dotted key in the rig file.
        key: &'static str,
    },
    /// A law that a user wrote, by its place in the description.
    Own {
        /// Its place among the description's own, from 0.
        place: usize,
    },
}

/// An effect.
#[derive(Clone)]
pub struct Effect {
    /// Name in an answer, which is unique.
    pub name: &'static str,
    /// Its file, whose header says what it is.
    pub text: &'static str,
    /// Which of several alike it is.
    pub which: Which,
    /// Where it enters.
    pub subsystem: Subsystem,
    /// Its numbers, reported ones first; of the one of several alike.
    pub parameters: fn(&PlantParameters, usize) -> Vec<Parameter>,
    /// Its numbers at a size that devices and cells usually show, beside their nominal values; all of them, in that order.
    pub usual: fn(&PlantParameters, usize) -> Vec<f64>,
    /// Values to start from, one list of all parameters each.
    pub starts: fn(&Clues<'_>, usize) -> Vec<Vec<f64>>,
    /// Effects of the same group exclude one another.
    pub group: Option<&'static str>,
    /// The phase, one for each recording, of what is periodic.
    pub phase: Option<&'static Number>,
}

/// An effect of a name and a part of the chain, without numbers yet: the only one of its kind, beside which all others can stand.
pub const fn effect(name: &'static str, subsystem: Subsystem) -> Effect {
    Effect {
        name,
        text: "",
        which: Which::Only,
        subsystem,
        parameters: |_, _| Vec::new(),
        usual: |_, _| Vec::new(),
        starts: |_, _| Vec::new(),
        group: None,
        phase: None,
    }
}

impl std::fmt::Debug for Effect {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        formatter.write_str(self.name)
    }
}

impl Effect {
    /// Its numbers, reported ones first.
    pub fn parameters(&self, plant: &PlantParameters) -> Vec<Parameter> {
        (self.parameters)(plant, self.index())
    }

    /// Whether a quantity is one of its numbers.
    pub fn frees(&self, plant: &PlantParameters, quantity: &Quantity) -> bool {
        let parameters = self.parameters(plant);
        parameters.iter().any(|own| own.quantity.is(quantity))
    }

    /// Its numbers at a size that devices and cells usually show, beside their nominal values; all of them, in that order.
    pub fn usual(&self, plant: &PlantParameters) -> Vec<f64> {
        (self.usual)(plant, self.index())
    }

    /// Values to start from, one list of all parameters each.
    pub fn starts(&self, clues: &Clues<'_>) -> Vec<Vec<f64>> {
        (self.starts)(clues, self.index())
    }

    /// Which of several alike, from 0.
    fn index(&self) -> usize {
        match self.which {
            Which::Only => 0,
            Which::Joint { joint, .. } => joint,
            Which::Own { place } | Which::Number { place, .. } => place,
        }
    }

    /// The same of one joint, from 0. Its name is kept as long as the program runs: one for each joint that an arm may have.
    pub(super) fn of_joint(self, joint: usize) -> Self {
        let kind = self.name;
        Self {
            name: format!("{kind}_{}", joint + 1).leak(),
            which: Which::Joint { kind, joint },
            ..self
        }
    }

    /// Its name in the vocabulary, and the joint that it is about, from 1.
    pub fn vocabulary(&self) -> (&'static str, Option<usize>) {
        match self.which {
            Which::Only | Which::Own { .. } => (self.name, None),
            Which::Number { .. } => (NUMBER_OFF, None),
            Which::Joint { kind, joint } => (kind, Some(joint + 1)),
        }
    }

    /// Key of the rig file's number that it says is off; none of any other effect.
    pub fn number_key(&self) -> Option<&'static str> {
        match self.which {
            Which::Number { key, .. } => Some(key),
            Which::Only | Which::Joint { .. } | Which::Own { .. } => None,
        }
    }

    /// Whether a quantity is its phase in one of the recordings.
    pub fn has_phase(&self, quantity: &Quantity) -> bool {
        self.phase
            .is_some_and(|phase| std::ptr::eq(phase, quantity.number))
    }

    /// Whether it cannot stand beside another one.
    pub fn excludes(&self, other: &Effect) -> bool {
        self.name == other.name || (self.group.is_some() && self.group == other.group)
    }
}
