//! Controllers of the regulator's pressure.
//!
//! `ForceController` is the seam: a controller sees what a real one could see and answers with a set pressure, once each control period; whoever calls
//! it holds the answer in between. One controller a file:
//!
//! - open loop: the pressure map alone ([`PressureMap`])
//! - `proportional_integral`: PI on the load cell around the map
//! - `feedback_linearisation`: the chamber's equation inverted, with a bounded input gain
//! - `disturbance_prediction`: what disturbs the force is estimated, predicted over the dead time and cancelled
//!
//! `from_scenario` builds the one that a scenario chooses; docs/CONTROL.md compares them.
//!
//! and what they share: models of the regulator (`regulator_model`) and of the chambers (`chamber_model`), the stability check made at construction
//! (`loop_response`, `stability`), and the best that the dead time allows ([`limit`]).

mod chamber_model;
mod contact_gate;
mod disturbance_level;
mod disturbance_prediction;
mod error;
mod feedback_linearisation;
mod followed;
mod from_scenario;
pub mod limit;
mod loop_response;
mod motion_tracker;
mod observation;
mod parameters;
mod proportional_integral;
mod regulator_model;
mod seal_model;
mod stability;

pub use error::{ControllerError, StabilityLimit};
pub use from_scenario::Pressing;
pub use observation::ForceObservation;
pub use parameters::{
    ControllerParameters, DisturbancePredictionParameters, FeedbackLinearisationParameters,
    ProportionalIntegralParameters,
};

use crate::device::{DeviceParameters, PressureMap};
use crate::physics::push_only::PushOnly;
use disturbance_prediction::DisturbancePrediction;
use feedback_linearisation::FeedbackLinearisation;
use proportional_integral::ProportionalIntegral;

/// The controllers there are.
#[derive(Debug, Clone)]
pub enum ForceController {
    /// Open loop: the pressure that gives the force at rest, gravity compensated as the wrist turns.
    PressureMap(PressureMap),
    /// PI on the load cell around the pressure map.
    ProportionalIntegral(Box<ProportionalIntegral>),
    /// The chamber's equation inverted.
    FeedbackLinearisation(Box<FeedbackLinearisation>),
    /// Disturbances predicted over the dead time.
    DisturbancePrediction(Box<DisturbancePrediction>),
    /// A law from outside this library.
    Own(Box<dyn OwnController>),
}

/// A force controller from outside this library.
pub trait OwnController: std::fmt::Debug + Send + Sync {
    /// Set pressure for the coming period [Pa gauge].
    fn set_pressure(&mut self, observation: &ForceObservation) -> f64;

    /// The same controller in the same state.
    fn boxed_clone(&self) -> Box<dyn OwnController>;
}

impl Clone for Box<dyn OwnController> {
    fn clone(&self) -> Self {
        self.as_ref().boxed_clone()
    }
}

impl ForceController {
    /// The open-loop controller of a device.
    pub fn pressure_map(parameters: &DeviceParameters) -> Self {
        Self::PressureMap(PressureMap::new(parameters))
    }

    /// A controller for a device that presses on `contact`, called every `period` [s].
    ///
    /// # Errors
    /// A parameter out of its range, or gains with which the loop would be unstable.
    pub fn new(
        parameters: &ControllerParameters,
        device: &DeviceParameters,
        contact: PushOnly,
        period: f64,
    ) -> Result<Self, ControllerError> {
        parameters.check(device, contact, period)?;
        Ok(match parameters {
            ControllerParameters::OpenLoop => Self::pressure_map(device),
            ControllerParameters::ProportionalIntegral(gains) => Self::ProportionalIntegral(
                Box::new(ProportionalIntegral::new(gains, device, period)),
            ),
            ControllerParameters::FeedbackLinearisation(gains) => Self::FeedbackLinearisation(
                Box::new(FeedbackLinearisation::new(gains, device, period)),
            ),
            ControllerParameters::DisturbancePrediction(gains) => Self::DisturbancePrediction(
                Box::new(DisturbancePrediction::new(gains, device, contact, period)),
            ),
        })
    }

    /// Set pressure for the coming period [Pa gauge]; none if a measurement is not a number.
    pub fn set_pressure(&mut self, observation: &ForceObservation) -> f64 {
        if !observation.is_finite() {
            return 0.0;
        }
        match self {
            Self::PressureMap(map) => map.set_pressure(
                observation.desired_axial_force,
                observation.gravity_along_axis,
            ),
            Self::ProportionalIntegral(controller) => controller.set_pressure(observation),
            Self::FeedbackLinearisation(controller) => controller.set_pressure(observation),
            Self::DisturbancePrediction(controller) => controller.set_pressure(observation),
            Self::Own(controller) => controller.set_pressure(observation),
        }
    }
}

#[cfg(test)]
mod test_plant;
#[cfg(test)]
mod tests;
