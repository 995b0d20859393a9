//! Laws of a user's own.

use super::{ANY, Number, numbers};
use crate::plant::{MOST_CONSTANTS, PlantParameters};

#[rustfmt::skip] // A table: one number a line.
numbers! { OWN:
    /// constant of a law of the user's own, by its place among those of all laws
    OWN_CONSTANT = "own_constant", ANY, (constant, set_constant);
}

fn constant(plant: &PlantParameters, index: usize) -> f64 {
    let law = plant.own.get(index / MOST_CONSTANTS);
    law.map_or(0.0, |law| law.values[index % MOST_CONSTANTS])
}

fn set_constant(plant: &mut PlantParameters, index: usize, value: f64) {
    if let Some(law) = plant.own.get_mut(index / MOST_CONSTANTS) {
        law.acts = true;
        law.values[index % MOST_CONSTANTS] = value;
    }
}
