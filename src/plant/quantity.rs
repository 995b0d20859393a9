//! Numbers of a rig's or a cell's description, and what an answer or a file calls them.

use super::parameters::PlantParameters;

/// A number of the description, declared once, in [`super::registry`] alone.
#[derive(Debug)]
pub struct Number {
    /// Name with its SI unit; of a number of the rig file its dotted key there.
    pub name: &'static str,
    /// What it is, in a few words.
    pub meaning: &'static str,
    /// Key of the device model file, which ends with the unit there.
    pub device_key: Option<&'static str>,
    /// Least and largest plausible value; infinite where none is known.
    pub range: [f64; 2],
    /// Value where a file gives none.
    pub default: Option<f64>,
    pub(super) get: fn(&PlantParameters, usize) -> f64,
    pub(super) set: fn(&mut PlantParameters, usize, f64),
}

impl Number {
    /// By a name of its own, as an answer has it.
    pub const fn named(&'static self, name: &'static str) -> Quantity {
        Quantity {
            name,
            index: 0,
            number: self,
        }
    }

    /// By its own name.
    pub const fn quantity(&'static self) -> Quantity {
        self.named(self.name)
    }
}

/// A number of the description under a name: how to read it, how to change it.
#[derive(Clone, Copy)]
pub struct Quantity {
    /// Name with its unit, as in an answer: `coulomb_force_n`.
    pub name: &'static str,
    /// Which of several alike: joint, coefficient; from 0.
    pub index: usize,
    /// Which.
    pub number: &'static Number,
}

impl std::fmt::Debug for Quantity {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        formatter.write_str(self.name)
    }
}

impl Quantity {
    /// The one of several alike.
    pub const fn of(self, index: usize) -> Self {
        Self { index, ..self }
    }

    /// Its value.
    pub fn get(&self, plant: &PlantParameters) -> f64 {
        (self.number.get)(plant, self.index)
    }

    /// Changes it.
    pub fn set(&self, plant: &mut PlantParameters, value: f64) {
        (self.number.set)(plant, self.index, value);
    }
}
