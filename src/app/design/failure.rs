//! Why a design could not be simulated, in the same words for the same cause.

use crate::cell::CellError;
use crate::design::EvaluateError;
use crate::rig::RigError;
use crate::run::RunError;
use crate::scenario::ScenarioError;
use crate::simulation::SimulationError;

/// A failed evaluation.
pub(super) struct Failure {
    /// Without numbers: designs are counted by it.
    reason: String,
    /// The whole sentence.
    detail: String,
}

impl Failure {
    fn new(reason: impl Into<String>, error: &impl std::fmt::Display) -> Self {
        Self {
            reason: reason.into(),
            detail: error.to_string(),
        }
    }

    /// The same, with the scenario's name.
    pub(super) fn in_scenario(self, name: &str) -> EvaluateError {
        EvaluateError {
            reason: format!("{name}: {}", self.reason),
            detail: format!("{name}: {}", self.detail),
        }
    }
}

impl From<ScenarioError> for Failure {
    fn from(error: ScenarioError) -> Self {
        let key = error.key().map(|key| format!("{key} refused"));
        Self::new(key.unwrap_or_else(|| "scenario refused".to_owned()), &error)
    }
}

impl From<CellError> for Failure {
    fn from(error: CellError) -> Self {
        let reason = match &error {
            CellError::Weight { .. } => "the tool's weight presses harder",
            CellError::Supply { .. } => "the supply cannot give the force",
            CellError::Plan { .. } => "the arm cannot follow the edge",
            _ => "cell refused",
        };
        Self::new(reason, &error)
    }
}

impl From<RigError> for Failure {
    fn from(error: RigError) -> Self {
        let RigError::NotFinite { quantity, .. } = &error;
        Self::new(format!("{quantity} not finite"), &error)
    }
}

impl From<SimulationError> for Failure {
    fn from(error: SimulationError) -> Self {
        let reason = match &error {
            SimulationError::StrokeRanOut { .. } => "the stroke ran out",
            SimulationError::SlippedOff { .. } => "the tool slipped off the edge",
            SimulationError::NotFinite { quantity, .. } => {
                return Self::new(format!("{quantity} not finite"), &error);
            }
            SimulationError::Collision { .. } => "bodies collided",
            SimulationError::Stalled { .. } => "the spindle stalled",
            SimulationError::AxisLost { .. } => "an axis lost its path",
            SimulationError::Saturated { .. } => "a drive came to its limit",
        };
        Self::new(reason, &error)
    }
}

impl From<RunError> for Failure {
    fn from(error: RunError) -> Self {
        Self::new("run not measurable", &error)
    }
}
