//! The estimator on the rig: fed with what the sensors read, at their rate.

use crate::estimation::{ContactForceEstimator, EstimatorOutput, Measurement};
use crate::physics::valve::ValvePosition;
use crate::sensing::Readings;
use crate::sensing::sample_clock::SampleClock;

/// An estimator with the clock of the sensors.
#[derive(Debug, Clone)]
pub(super) struct RigEstimator {
    estimator: ContactForceEstimator,
    clock: SampleClock,
    held: Option<EstimatorOutput>,
}

impl RigEstimator {
    pub(super) fn new(estimator: &ContactForceEstimator) -> Self {
        Self {
            clock: SampleClock::new(1.0 / estimator.period()),
            estimator: estimator.clone(),
            held: None,
        }
    }

    /// Takes readings in if a sample is due at a time [s]; returns what is held then.
    pub(super) fn update(
        &mut self,
        time: f64,
        readings: &Readings,
        valve: ValvePosition,
    ) -> Option<EstimatorOutput> {
        if self.clock.is_due(time) {
            self.held = Some(self.estimator.update(&Measurement {
                stroke: readings.stroke,
                acceleration: readings.acceleration,
                regulator_pressure: readings.regulator_pressure,
                valve,
            }));
        }
        self.held
    }
}
