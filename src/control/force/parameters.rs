//! Which controller, and its parameters, strict SI.

use super::loop_response::LinearPlant;
use super::stability::{LoopGains, check_response_time};
use super::{ControllerError, StabilityLimit};
use crate::device::DeviceParameters;
use crate::physics::push_only::PushOnly;
use crate::physics::seal_friction::SealFriction;

/// Delay of sampling and of whatever the models leave out, for the default gains [s].
const SPARE_DELAY: f64 = 4e-3;

/// A controller.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum ControllerParameters {
    /// The pressure map alone.
    OpenLoop,
    /// PI on the load cell around the map.
    ProportionalIntegral(ProportionalIntegralParameters),
    /// The chamber's equation inverted, and an integral of the load cell's error.
    FeedbackLinearisation(FeedbackLinearisationParameters),
    /// Disturbances estimated, predicted over the dead time, and cancelled.
    DisturbancePrediction(DisturbancePredictionParameters),
}

/// Parameters of the PI controller.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ProportionalIntegralParameters {
    /// Proportional gain, force commanded over force missing [1]; 0 or more, below the stability limit.
    pub proportional_gain: f64,
    /// Integral gain [1/s]; 0 or more, below the stability limit.
    pub integral_gain: f64,
}

impl ProportionalIntegralParameters {
    /// Skogestad's rule (2003) for a lag tau with delay D, the closed loop as quick as the delay: k_p = tau / (2 D), k_i = k_p / min(tau, 8 D).
    pub fn tuned(device: &DeviceParameters) -> Self {
        let (lag, delay) = (device.regulator.time_constant, loop_delay(device));
        let proportional_gain = lag / (2.0 * delay);
        Self {
            proportional_gain,
            integral_gain: proportional_gain / lag.min(8.0 * delay),
        }
    }
}

/// Parameters of the feedback linearisation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FeedbackLinearisationParameters {
    /// Rate r of the wanted second-order response of the pressure [1/s]; above 0, below the stability limit.
    pub rate: f64,
    /// Integral gain on the load cell's error [1/s]; 0 or more, below the stability limit.
    pub integral_gain: f64,
}

impl FeedbackLinearisationParameters {
    /// The pressure settles as a lag of half the dead time (10 ms at least) would; integral gain by Skogestad's rule for the dead time and a spare D: 1 / (2 D).
    pub fn tuned(device: &DeviceParameters) -> Self {
        let response = default_response(device);
        Self {
            rate: 2.0 / response,
            integral_gain: 0.5 / (device.regulator.dead_time + SPARE_DELAY),
        }
    }

    /// Lag that the law comes to at its upper bound [s].
    fn response_time(&self) -> f64 {
        2.0 / self.rate
    }
}

/// Parameters of the disturbance prediction.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DisturbancePredictionParameters {
    /// Time constant of the pressure's approach to what is wanted [s]; above 0, above the stability limit.
    pub response_time: f64,
    /// Time constant with which the load cell's disagreement with the model is followed [s]; above 0.
    pub observer_time: f64,
    /// Poles of the filter that gives speed and acceleration [rad/s]; above 0, below half the sampling frequency.
    pub tracking_frequency: f64,
    /// The nominal seals.
    pub seals: SealFriction,
    /// Uncertainty of the nominal dry friction, as a share of it [1]; 0 to 1.
    pub friction_uncertainty: f64,
}

impl DisturbancePredictionParameters {
    /// The device's own seals, half uncertain; response time as for the feedback linearisation, the observer half as quick.
    pub fn tuned(device: &DeviceParameters) -> Self {
        Self {
            response_time: default_response(device),
            observer_time: 2.0 * default_response(device),
            tracking_frequency: 40.0,
            seals: device.seal_friction,
            friction_uncertainty: 0.5,
        }
    }
}

/// Delay of the force loop without the regulator's lag [s].
fn loop_delay(device: &DeviceParameters) -> f64 {
    let contact = PushOnly {
        stiffness: 1.0,
        damping: 0.0,
    };
    let chamber = LinearPlant::new(device, contact, 1.0).chamber_time();
    device.regulator.dead_time + chamber + SPARE_DELAY
}

fn default_response(device: &DeviceParameters) -> f64 {
    (0.5 * device.regulator.dead_time).max(0.01)
}

impl ControllerParameters {
    /// Checks every parameter and the loops' stability.
    ///
    /// # Errors
    /// The first that is out of range, or the loop that is unstable.
    pub fn check(
        &self,
        device: &DeviceParameters,
        contact: PushOnly,
        period: f64,
    ) -> Result<(), ControllerError> {
        above_zero("period", period)?;
        above_zero("contact stiffness", contact.stiffness)?;
        let plant = LinearPlant::new(device, contact, period);
        match self {
            Self::OpenLoop => Ok(()),
            Self::ProportionalIntegral(gains) => gains.check(&plant, period),
            Self::FeedbackLinearisation(gains) => gains.check(device, plant, period),
            Self::DisturbancePrediction(parameters) => parameters.check(device, &plant, period),
        }
    }
}

impl ProportionalIntegralParameters {
    fn check(&self, plant: &LinearPlant, period: f64) -> Result<(), ControllerError> {
        not_below_zero("proportional_gain", self.proportional_gain)?;
        not_below_zero("integral_gain", self.integral_gain)?;
        let (key, value) = if self.proportional_gain > 0.0 {
            ("proportional_gain", self.proportional_gain)
        } else {
            ("integral_gain", self.integral_gain)
        };
        LoopGains {
            proportional: self.proportional_gain,
            integral: self.integral_gain,
        }
        .check(plant, period, key, value)
    }
}

impl FeedbackLinearisationParameters {
    fn check(
        &self,
        device: &DeviceParameters,
        plant: LinearPlant,
        period: f64,
    ) -> Result<(), ControllerError> {
        above_zero("rate", self.rate)?;
        not_below_zero("integral_gain", self.integral_gain)?;
        check_response_time(
            &device.regulator,
            self.response_time(),
            period,
            "rate",
            |time| StabilityLimit::AtMost(2.0 / time),
        )?;
        LoopGains {
            proportional: 0.0,
            integral: self.integral_gain,
        }
        .check(
            &plant.without_lags(),
            period,
            "integral_gain",
            self.integral_gain,
        )
    }
}

impl DisturbancePredictionParameters {
    fn check(
        &self,
        device: &DeviceParameters,
        plant: &LinearPlant,
        period: f64,
    ) -> Result<(), ControllerError> {
        above_zero("response_time", self.response_time)?;
        above_zero("observer_time", self.observer_time)?;
        above_zero("tracking_frequency", self.tracking_frequency)?;
        if self.tracking_frequency >= plant.highest() {
            return Err(ControllerError::OutOfRange {
                key: "tracking_frequency",
                value: self.tracking_frequency,
                expected: "below half the sampling frequency, pi over the control period",
            });
        }
        not_below_zero("coulomb", self.seals.coulomb)?;
        not_below_zero("viscous", self.seals.viscous)?;
        above_zero(
            "presliding_displacement",
            self.seals.presliding_displacement,
        )?;
        if !(0.0..=1.0).contains(&self.friction_uncertainty) {
            return Err(ControllerError::OutOfRange {
                key: "friction_uncertainty",
                value: self.friction_uncertainty,
                expected: "0 to 1",
            });
        }
        check_response_time(
            &device.regulator,
            self.response_time,
            period,
            "response_time",
            StabilityLimit::AtLeast,
        )
    }
}

fn above_zero(key: &'static str, value: f64) -> Result<(), ControllerError> {
    if value.is_finite() && value > 0.0 {
        return Ok(());
    }
    Err(ControllerError::OutOfRange {
        key,
        value,
        expected: "a number above 0",
    })
}

fn not_below_zero(key: &'static str, value: f64) -> Result<(), ControllerError> {
    if value.is_finite() && value >= 0.0 {
        return Ok(());
    }
    Err(ControllerError::OutOfRange {
        key,
        value,
        expected: "0 or more",
    })
}
