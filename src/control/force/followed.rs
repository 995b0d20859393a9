//! Knowledge of the controllers with a model about the device, from its measurements: regulator, chambers and motion.

use super::ForceObservation;
use super::chamber_model::ChamberModel;
use super::motion_tracker::MotionTracker;
use super::regulator_model::RegulatorModel;
use crate::device::DeviceParameters;

/// The models with their state.
#[derive(Debug, Clone)]
pub(super) struct Followed {
    pub regulator: RegulatorModel,
    pub chambers: ChamberModel,
    pub motion: MotionTracker,
    period: f64,
    /// Outlet pressure at the last call [Pa gauge].
    outlet: Option<f64>,
}

/// The chambers after the regulator's dead time.
pub(super) struct Ahead {
    pub chambers: ChamberModel,
    /// Outlet pressure then [Pa gauge].
    pub outlet: f64,
    /// Stroke then [m].
    pub stroke: f64,
    /// The dead time [s].
    pub time: f64,
}

impl Followed {
    /// Of a device; `frequency` are the poles of the motion's filter [rad/s].
    pub fn new(device: &DeviceParameters, frequency: f64, period: f64) -> Self {
        Self {
            regulator: RegulatorModel::new(device.regulator, period),
            chambers: ChamberModel::new(device),
            motion: MotionTracker::new(frequency, period),
            period,
            outlet: None,
        }
    }

    /// Takes the measurements into the models.
    pub fn follow(&mut self, observation: &ForceObservation) {
        self.motion
            .update(observation.stroke, observation.acceleration);
        let outlet = observation.regulator_pressure;
        self.regulator.observe(outlet);
        match self.outlet {
            None => self.chambers.settle(outlet),
            Some(before) => self.chambers.advance(
                0.5 * (before + outlet),
                self.motion.stroke,
                self.motion.speed,
                self.period,
            ),
        }
        self.outlet = Some(outlet);
    }

    /// Prediction after the dead time, at a speed [m/s] until then.
    pub fn ahead(&self, observation: &ForceObservation, speed: f64) -> Ahead {
        let stroke = self.motion.stroke;
        let mut chambers = self.chambers.clone();
        let mut time = 0.0;
        let outlet =
            self.regulator
                .through_dead_time(observation.regulator_pressure, |duration, outlet| {
                    chambers.advance(outlet, stroke + speed * time, speed, duration);
                    time += duration;
                });
        Ahead {
            chambers,
            outlet,
            stroke: stroke + speed * time,
            time,
        }
    }
}
