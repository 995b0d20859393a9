//! Evidence for unit tests.

use super::fit::Fit;
use super::fit::free::{Free, Prior};
use super::fit::model_error::ModelError;
use super::recordings::evidence::{Evidence, Measured, Prediction};
use super::search::Search;
use super::settings::Settings;
use crate::effects::Coordinate;
use crate::plant::{
    ContactParameters, InitialState, PlantInputs, PlantParameters, registry, simulate,
};
use nalgebra::DMatrix;

/// A device on a stiff contact.
pub(super) fn plant() -> PlantParameters {
    PlantParameters {
        gravity_along_extension: -9.81,
        contact: ContactParameters::linear(2e5, 400.0),
        ..PlantParameters::default()
    }
}

/// Recordings of half a second on a surface, which say little.
pub(super) fn evidence(recordings: usize) -> Evidence {
    evidence_of(&plant(), vec![vec![2e5; 126]; recordings])
}

/// Recordings of a device on a surface under set pressures [Pa gauge], a value every 4 ms.
pub(super) fn evidence_of(truth: &PlantParameters, set_pressures: Vec<Vec<f64>>) -> Evidence {
    let measured = |(index, set_pressure): (usize, Vec<f64>)| {
        let count = set_pressure.len();
        let inputs = PlantInputs {
            cell: None,
            motion: None,
            initial: InitialState::AtRest,
            place: 0,
            set_pressure,
            extends: vec![true; count],
            surface: vec![0.02; count],
            time: (0..count).map(|i| 0.004 * i as f64).collect(),
        };
        Measured {
            name: format!("{index}.csv"),
            readings: simulate(truth, &inputs).readings,
            inputs,
            free: false,
        }
    };
    let recordings = set_pressures
        .into_iter()
        .enumerate()
        .map(measured)
        .collect();
    Evidence::new(recordings, [400.0, 2e-5, 0.8, 0.15])
}

/// A number that a fit may move, in its own unit.
pub(super) fn free() -> Free {
    Free {
        quantity: registry::SURFACE_OFFSET.quantity(),
        start: 0.0,
        coordinate: Coordinate::Linear(1.0),
        bounds: [-1e3, 1e3],
        prior: Prior::Flat,
    }
}

/// A fit that leaves these residuals, of one free number with these derivatives.
pub(super) fn fit(residuals: Vec<f64>, column: Vec<f64>, value: f64) -> Fit {
    let known: f64 = column.iter().map(|c| c * c).sum();
    Fit {
        free: vec![free()],
        values: vec![value],
        misfit: residuals.iter().map(|r| r * r).sum(),
        prediction: Prediction {
            plant: plant(),
            guided: false,
            trajectories: Vec::new(),
            residuals,
        },
        rough: 0.0,
        prior: 0.0,
        columns: vec![column],
        information: DMatrix::from_element(1, 1, known),
    }
}

/// A search in recordings with nothing tolerated and nothing to look for.
pub(super) fn search(evidence: &Evidence) -> Search<'_> {
    Search {
        evidence,
        nominal: plant(),
        tolerated: Vec::new(),
        candidates: Vec::new(),
        shown: Vec::new(),
        look: 3,
        most_effects: 1,
        model_error: ModelError::NONE,
        unseen: None,
        settings: Settings::DEFAULT,
    }
}
