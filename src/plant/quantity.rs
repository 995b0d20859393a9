//! A number of a rig's description that a fit may move: how to read it, how to change it.

use super::parameters::PlantParameters;

/// A number of a rig's description.
#[derive(Clone, Copy)]
pub struct Quantity {
    /// Name with its unit, as in an answer: `coulomb_force_n`.
    pub name: &'static str,
    /// Which of several alike: joint, coefficient; from 0.
    pub index: usize,
    /// Reads it.
    pub get: fn(&PlantParameters, usize) -> f64,
    /// Changes it.
    pub set: fn(&mut PlantParameters, usize, f64),
}

impl std::fmt::Debug for Quantity {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        formatter.write_str(self.name)
    }
}

impl Quantity {
    /// Its value.
    pub fn get(&self, plant: &PlantParameters) -> f64 {
        (self.get)(plant, self.index)
    }

    /// Changes it.
    pub fn set(&self, plant: &mut PlantParameters, value: f64) {
        (self.set)(plant, self.index, value);
    }
}
