//! Physics that a user writes as an expression, as an effect like any other: its free constants are its numbers.

use std::sync::{Arc, Mutex};

use super::effect::{Clues, Effect, Parameter, Subsystem, Which};
use super::quantity::Coordinate;
use crate::plant::registry::OWN_CONSTANT;
use crate::plant::{
    Actual, Constant, LawText, MOST_CONSTANTS, Nominal, OwnLaw, PlantParameters, Port,
};

/// An effect that a model has, with all its numbers.
#[derive(Debug, Clone)]
pub struct PresentEffect {
    /// The effect.
    pub effect: &'static Effect,
    /// Its numbers, in the order of its parameters.
    pub values: Vec<f64>,
    /// The law, of an effect that a user wrote.
    pub law: Option<Arc<LawText>>,
    /// Its table in the file, by its dotted key.
    pub key: String,
}

impl PresentEffect {
    /// Makes it a part of a description.
    pub fn apply_to(&self, plant: &mut PlantParameters) {
        if let Some(law) = &self.law {
            plant.own.push(OwnLaw::new(law));
        }
        for (parameter, value) in self.effect.parameters(plant).iter().zip(&self.values) {
            parameter.quantity.set(plant, *value);
        }
    }
}

/// A model with effects, of which a device, its contact and its sensors are made.
pub fn actual(
    nominal: &Nominal<PlantParameters>,
    effects: &[PresentEffect],
) -> Actual<PlantParameters> {
    nominal.with(|plant| {
        for effect in effects {
            effect.apply_to(plant);
        }
        plant.device = plant.device_under_terms().into_owned();
    })
}

/// The effect that the law of a place among a description's own is.
pub fn own_effect(law: &LawText, place: usize) -> &'static Effect {
    static EFFECTS: Mutex<Vec<&'static Effect>> = Mutex::new(Vec::new());
    let which = Which::Own { place };
    let subsystem = subsystem(law.port);
    let mut effects = EFFECTS
        .lock()
        .unwrap_or_else(std::sync::PoisonError::into_inner);
    let same = |e: &&&Effect| e.name == law.name && e.which == which && e.subsystem == subsystem;
    if let Some(known) = effects.iter().find(same) {
        return known;
    }
    // As its name it is kept for as long as the program runs: one for each that files name.
    let effect: &'static Effect = Box::leak(Box::new(Effect {
        name: law.name,
        // The file that has it says what it is.
        text: "",
        which,
        subsystem,
        parameters,
        usual: |plant, place| free_of(plant, place).map(|(_, c)| c.value).collect(),
        starts,
        group: None,
        phase: None,
    }));
    effects.push(effect);
    effect
}

/// Laws of a description whose numbers a diagnosis is to find, and that do not act before it does.
pub fn sought(plant: &mut PlantParameters) -> Vec<&'static Effect> {
    let mut effects = Vec::new();
    for (place, law) in plant.own.iter_mut().enumerate() {
        if law.text.constants.iter().any(|c| c.range.is_some()) {
            law.acts = false;
            effects.push(own_effect(&law.text, place));
        }
    }
    effects
}

fn subsystem(port: Port) -> Subsystem {
    match port {
        Port::PistonForce | Port::Friction => Subsystem::ForceBalance,
        Port::SetPressure | Port::OutletPressure => Subsystem::Regulator,
        Port::FirstChamberFlow
        | Port::SecondChamberFlow
        | Port::FirstChamberLeak
        | Port::SecondChamberLeak
        | Port::SupplyOrifice
        | Port::ExhaustOrifice => Subsystem::Chambers,
        Port::Surface | Port::ContactStiffness => Subsystem::Contact,
        Port::ForceReading | Port::StrokeReading | Port::PressureReading => Subsystem::Sensors,
    }
}

/// Free constants of a law, with their places among all of the description.
fn free_of(plant: &PlantParameters, place: usize) -> impl Iterator<Item = (usize, &Constant)> {
    let constants = plant.own.get(place).into_iter();
    constants
        .flat_map(|law| law.text.constants.iter().enumerate())
        .filter(|(_, constant)| constant.range.is_some())
        .map(move |(index, constant)| (place * MOST_CONSTANTS + index, constant))
}

fn parameters(plant: &PlantParameters, place: usize) -> Vec<Parameter> {
    let parameter = |(index, constant): (usize, &Constant)| {
        let bounds = constant.range?;
        Some(Parameter {
            quantity: OWN_CONSTANT.named(constant.name).of(index),
            coordinate: coordinate(bounds),
            bounds,
            reported: true,
            choices: &[],
        })
    };
    free_of(plant, place).filter_map(parameter).collect()
}

/// Range over which a number of one sign is sought by its size [1].
const WIDE: f64 = 30.0;

fn coordinate([low, high]: [f64; 2]) -> Coordinate {
    if low > 0.0 && high / low > WIDE {
        Coordinate::Logarithmic
    } else {
        Coordinate::Linear(0.1 * (high - low))
    }
}

/// The values in the file, and a fifth and four fifths of the way through all ranges.
fn starts(clues: &Clues<'_>, place: usize) -> Vec<Vec<f64>> {
    let free: Vec<&Constant> = free_of(clues.plant, place).map(|(_, c)| c).collect();
    let through = |share: f64| {
        let at = |c: &&Constant| {
            let bounds @ [low, high] = c.range.unwrap_or([c.value; 2]);
            let coordinate = coordinate(bounds);
            let [a, b] = [low, high].map(|end| coordinate.of(end));
            coordinate.value(a + share * (b - a))
        };
        free.iter().map(at).collect()
    };
    let written = free.iter().map(|c| c.value).collect();
    vec![written, through(0.2), through(0.8)]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_of_one_sign_and_of_unknown_size_is_sought_by_its_size() {
        for (bounds, expected) in [
            ([1.0, 100.0], Coordinate::Logarithmic),
            ([1.0, 21.0], Coordinate::Linear(2.0)),
            ([0.0, 100.0], Coordinate::Linear(10.0)),
            ([-40.0, 100.0], Coordinate::Linear(14.0)),
        ] {
            assert_eq!(coordinate(bounds), expected, "{bounds:?}");
        }
    }
}
