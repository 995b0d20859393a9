//! A model discrepancy.

use super::{ANY, Number, numbers};
use crate::plant::{Basis, PlantParameters};

#[rustfmt::skip] // A table: one number a line.
numbers! { LATENT:
    /// coefficient of the term
    LATENT_COEFFICIENT = "latent_coefficient", ANY, (coefficient, set_coefficient);
    /// by how much a coefficient is above the one before it
    LATENT_RISE = "latent_rise", ANY, (rise, set_rise);
    /// frequency of a periodic term
    LATENT_FREQUENCY = "latent_frequency", ANY, (frequency, set_frequency);
}

fn coefficient(plant: &PlantParameters, index: usize) -> f64 {
    let latent = plant.latent.as_ref();
    let coefficient = latent.and_then(|l| l.coefficients.get(index));
    coefficient.copied().unwrap_or(0.0)
}

fn set_coefficient(plant: &mut PlantParameters, index: usize, value: f64) {
    let coefficients = plant.latent.as_mut().map(|l| &mut l.coefficients);
    if let Some(c) = coefficients.and_then(|c| c.get_mut(index)) {
        *c = value;
    }
}

fn rise(plant: &PlantParameters, index: usize) -> f64 {
    let before = index.checked_sub(1);
    coefficient(plant, index) - before.map_or(0.0, |before| coefficient(plant, before))
}

fn set_rise(plant: &mut PlantParameters, index: usize, value: f64) {
    let further = value - rise(plant, index);
    let coefficients = plant.latent.iter_mut().flat_map(|l| &mut l.coefficients);
    coefficients.skip(index).for_each(|c| *c += further);
}

fn frequency(plant: &PlantParameters, _: usize) -> f64 {
    match plant.latent.as_ref().map(|l| &l.basis) {
        Some(Basis::Waves { frequency }) => *frequency,
        _ => 0.0,
    }
}

fn set_frequency(plant: &mut PlantParameters, _: usize, value: f64) {
    if let Some(Basis::Waves { frequency }) = plant.latent.as_mut().map(|l| &mut l.basis) {
        *frequency = value;
    }
}
