//! How finely a step is cut, so that what comes of a run does not depend on the step that its scenario asks for.
//!
//! Device and contact are integrated together in sub-steps of their own, while the arm keeps its motion and learns of their force when the step is done. A step
//! is cut into parts so short that neither the slide on its contact or stop nor an axis in its servo swings by more than a given angle in one: between parts
//! arm and slide find to each other.

use super::error::CellError;
use crate::plant::{Actual, PlantParameters};
use crate::scenario::Scenario;

/// Largest part of a step times the fastest rate of slide or servo [rad].
const LARGEST_SWING: f64 = 0.55;
/// Shortest part of a step [s].
const SHORTEST: f64 = 1e-6;

/// Parts of a step.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Resolution {
    /// While the tool is off the part.
    pub apart: usize,
    /// While it is on it or near.
    pub near: usize,
}

impl Resolution {
    /// Resolution of a scenario with the physics of its cell.
    ///
    /// # Errors
    /// A contact too fast for the shortest part.
    pub(super) fn of(
        scenario: &Scenario,
        actual: &Actual<PlantParameters>,
    ) -> Result<Self, CellError> {
        let step = scenario.simulation.step;
        let mass = actual.device.moving_mass;
        let parts = |rate: f64| (step * rate / LARGEST_SWING - 1e-9).ceil().max(1.0);
        let stop = actual.device.end_stop;
        let stop = (stop.stiffness / mass).sqrt().max(stop.damping / mass);
        let slide = actual.contact.rate(mass).max(stop);
        if slide * SHORTEST > LARGEST_SWING {
            let most = LARGEST_SWING / SHORTEST;
            return Err(CellError::Unresolved {
                file: scenario.path.clone(),
                stiffness: scenario.nominal.contact.stiffness_at(0.0),
                damping: scenario.nominal.contact.damping,
                mass,
                most_stiffness: mass * most * most,
                most_damping: mass * most,
            });
        }
        let apart = parts(scenario.arm.servo.natural_frequency * std::f64::consts::TAU);
        Ok(Self {
            apart: apart as usize,
            near: apart.max(parts(slide)) as usize,
        })
    }

    /// What a user may not expect of it.
    pub fn note(&self, scenario: &Scenario) -> Option<String> {
        let step = 1e3 * scenario.simulation.step;
        (self.near > 1).then(|| {
            format!(
                "a step of {step} ms is cut into {} parts while the tool is on or near the part, into {} elsewhere: contact, end stops and servo swing too fast for the whole",
                self.near, self.apart
            )
        })
    }

    /// Parts of a step that begins with the tool near the part, or away from it.
    #[must_use]
    pub fn parts(&self, near: bool) -> usize {
        if near { self.near } else { self.apart }
    }
}
