//! From what a scenario chooses to a controller: what it leaves out is tuned, what is unstable is refused by place and key.
//!
//! The controller knows a first-order lag with a dead time. Whatever else lies in the loop is put into these two:
//!
//! ```text
//! theta' = theta + T_rc / 2,   tau' = tau + T_rc / 2        a second lag T_rc, of the set value's RC (Skogestad 2003, half rule)
//! theta'' = theta' + T_f                                    for gains and their stability: the delay of the load cell's filter
//! ```

use super::{
    ControllerError, ControllerParameters, DisturbancePredictionParameters,
    FeedbackLinearisationParameters, ForceController, ProportionalIntegralParameters,
    StabilityLimit,
};
use crate::device::DeviceParameters;
use crate::physics::push_only::PushOnly;
use crate::plant::{Nominal, PlantParameters};
use crate::scenario::{ControllerScenario, ForceLaw, ScenarioError, attainable_set_pressure};
use crate::sensing::{CommandChain, SensingParameters};
use crate::unit::Unit;

/// A parameter's name here and the key that gives it in a scenario file.
const KEYS: [(&str, &str); 6] = [
    ("proportional_gain", "proportional_gain"),
    ("integral_gain", "integral_gain_per_s"),
    ("rate", "rate_per_s"),
    ("response_time", "response_time_s"),
    ("observer_time", "observer_time_s"),
    ("tracking_frequency", "tracking_frequency_rad_per_s"),
];

/// How a device presses on its contact.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pressing {
    /// Largest force [N], at which a contact is stiffest.
    pub force: f64,
    /// Share of the slide's motion that goes into the contact, and of the contact's force that the slide feels [1].
    pub share: f64,
}

impl Pressing {
    /// The nominal contact as the slide feels it.
    fn felt(self, nominal: &Nominal<PlantParameters>) -> PushOnly {
        let share = self.share.powi(2);
        PushOnly {
            stiffness: share * nominal.contact.stiffness_at(self.force),
            damping: share * nominal.contact.damping,
        }
    }
}

impl ForceController {
    /// The controller that a scenario chooses, for a nominal device behind these sensors that presses so; without there is no force to feed back.
    /// `step` is the scenario's time step [s].
    ///
    /// # Errors
    /// A loop that would be unstable, or a value out of what the controller takes.
    pub fn of_scenario(
        choice: &ControllerScenario,
        nominal: &Nominal<PlantParameters>,
        sensing: &SensingParameters,
        pressing: Option<Pressing>,
        step: f64,
    ) -> Result<Self, ScenarioError> {
        let sensed_device = sensed_device(&nominal.device, sensing);
        let contact = match (choice.law, pressing) {
            (ForceLaw::OpenLoop, _) | (_, None) => return Ok(Self::pressure_map(&sensed_device)),
            (_, Some(pressing)) => pressing.felt(nominal),
        };
        let period = choice.steps(step) as f64 * step;
        let delayed = delayed(&sensed_device, sensing.force_delay());
        let parameters = parameters(&choice.law, &delayed);
        parameters
            .check(&delayed, contact, period)
            .and_then(|()| Self::new(&parameters, &sensed_device, contact, period))
            .map_err(|error| refusal(choice, &parameters, period, error))
    }
}

/// The device as the controller knows it.
fn sensed_device(device: &DeviceParameters, sensing: &SensingParameters) -> DeviceParameters {
    let mut sensed_device = device.clone();
    let regulator = &mut sensed_device.regulator;
    regulator.supply = attainable_set_pressure(device, &sensing.command).0;
    if let CommandChain::Real(chain) = &sensing.command {
        let lag = chain.pwm.resistance * chain.pwm.capacitance;
        regulator.time_constant += 0.5 * lag;
        regulator.dead_time += 0.5 * lag;
    }
    sensed_device
}

fn delayed(device: &DeviceParameters, delay: f64) -> DeviceParameters {
    let mut delayed = device.clone();
    delayed.regulator.dead_time += delay;
    delayed
}

/// Parameters as given, the others tuned to the device.
fn parameters(law: &ForceLaw, device: &DeviceParameters) -> ControllerParameters {
    match *law {
        ForceLaw::OpenLoop => ControllerParameters::OpenLoop,
        ForceLaw::ProportionalIntegral {
            proportional_gain,
            integral_gain,
        } => {
            let tuned = ProportionalIntegralParameters::tuned(device);
            ControllerParameters::ProportionalIntegral(ProportionalIntegralParameters {
                proportional_gain: proportional_gain.unwrap_or(tuned.proportional_gain),
                integral_gain: integral_gain.unwrap_or(tuned.integral_gain),
            })
        }
        ForceLaw::FeedbackLinearisation {
            rate,
            integral_gain,
        } => {
            let tuned = FeedbackLinearisationParameters::tuned(device);
            ControllerParameters::FeedbackLinearisation(FeedbackLinearisationParameters {
                rate: rate.unwrap_or(tuned.rate),
                integral_gain: integral_gain.unwrap_or(tuned.integral_gain),
            })
        }
        ForceLaw::DisturbancePrediction {
            response_time,
            observer_time,
            tracking_frequency,
            seals,
            friction_uncertainty,
        } => {
            let tuned = DisturbancePredictionParameters::tuned(device);
            ControllerParameters::DisturbancePrediction(DisturbancePredictionParameters {
                response_time: response_time.unwrap_or(tuned.response_time),
                observer_time: observer_time.unwrap_or(tuned.observer_time),
                tracking_frequency: tracking_frequency.unwrap_or(tuned.tracking_frequency),
                seals: seals.unwrap_or(tuned.seals),
                friction_uncertainty: friction_uncertainty.unwrap_or(tuned.friction_uncertainty),
            })
        }
    }
}

/// The refusal at the key's place in the file.
fn refusal(
    choice: &ControllerScenario,
    parameters: &ControllerParameters,
    period: f64,
    error: ControllerError,
) -> ScenarioError {
    let key_of = |name: &'static str| {
        KEYS.iter()
            .find(|(own, _)| *own == name)
            .map_or(name, |(_, key)| *key)
    };
    match error {
        ControllerError::OutOfRange {
            key,
            value,
            expected,
        } => {
            let key = key_of(key);
            let expected = match key {
                "tracking_frequency_rad_per_s" => {
                    let half = std::f64::consts::PI / period;
                    format!("less than {half:.1} rad/s, half the sampling frequency of the control")
                }
                _ => expected.to_owned(),
            };
            choice.refuse(key, Unit::of_key(key).show(value), expected)
        }
        ControllerError::Unstable {
            key,
            value,
            frequency,
            gain,
            assumption,
            limit,
        } => {
            let at_fault = Fault::of(choice, parameters, key_of(key), value, limit);
            let default = if choice.gives(at_fault.key) {
                ""
            } else {
                ", its default"
            };
            let found = format!(
                "{}{default}, with which the loop is unstable: at {frequency:.0} rad/s it turns by 180 degrees with a gain of {gain:.2}{assumption}",
                Unit::of_key(at_fault.key).show(significant(at_fault.value, f64::round))
            );
            choice.refuse(at_fault.key, found, at_fault.expected)
        }
    }
}

/// The key to blame for an unstable loop.
struct Fault {
    key: &'static str,
    value: f64,
    expected: String,
}

impl Fault {
    fn of(
        choice: &ControllerScenario,
        parameters: &ControllerParameters,
        key: &'static str,
        value: f64,
        limit: StabilityLimit,
    ) -> Self {
        let ControllerParameters::ProportionalIntegral(gains) = parameters else {
            return Self {
                key,
                value,
                expected: shown(key, limit),
            };
        };
        // Both gains scale the loop, and the limit holds for both in proportion.
        let scale = match limit {
            StabilityLimit::AtMost(most) | StabilityLimit::AtLeast(most) => most / value,
        };
        let mut both = [
            ("proportional_gain", gains.proportional_gain),
            ("integral_gain_per_s", gains.integral_gain),
        ];
        if choice.gives(both[1].0) && !choice.gives(both[0].0) || both[0].1 == 0.0 {
            both.reverse();
        }
        let [blamed, other] = both.map(|(key, value)| {
            let most = shown(key, StabilityLimit::AtMost(scale * value));
            (key, value, most)
        });
        let together = format!("{} with {} {}", blamed.2, other.0, other.2);
        Self {
            key: blamed.0,
            value: blamed.1,
            expected: if other.1 == 0.0 { blamed.2 } else { together },
        }
    }
}

/// A limit rounded to its stable side.
fn shown(key: &str, limit: StabilityLimit) -> String {
    let (word, value) = match limit {
        StabilityLimit::AtMost(value) => ("at most", significant(value, f64::floor)),
        StabilityLimit::AtLeast(value) => ("at least", significant(value, f64::ceil)),
    };
    format!("{word} {}", Unit::of_key(key).show(value))
}

/// A number to four significant digits.
fn significant(value: f64, rounded: impl Fn(f64) -> f64) -> f64 {
    if value == 0.0 || !value.is_finite() {
        return value;
    }
    let decimals = 3 - value.abs().log10().floor() as i32;
    // Divided by a whole power of ten, so that few digits are shown.
    if decimals >= 0 {
        let power = 10f64.powi(decimals);
        rounded(value * power) / power
    } else {
        let power = 10f64.powi(-decimals);
        rounded(value / power) * power
    }
}

#[cfg(test)]
mod tests;
