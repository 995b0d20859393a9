//! `[controller]` of a scenario of either kind: which force controller, how often it works, and those of its values that the file gives.
//!
//! Values that are left out are tuned to the device where the controller is built (`crate::control::force`), for the rules stand there; so does the check that the
//! loop is stable, which refuses through [`ControllerScenario::refuse`].

use std::ops::RangeInclusive;

use serde::Deserialize;

use super::check::Section;
use super::document::Document;
use super::error::{Place, ScenarioError};
use super::sensing::stages::only;
use super::suggestion::join;
use crate::device::{DeviceParameters, PressureMap};
use crate::physics::seal_friction::SealFriction;
use crate::plant::registry;
use crate::sensing::{CommandChain, SensingParameters};

/// The table's name.
const TABLE: &str = "controller";

/// `[controller]`.
#[derive(Debug, Default, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct ControllerKeys {
    #[serde(default)]
    pub kind: ControllerKind,
    pub period_ms: Option<f64>,
    pub proportional_gain: Option<f64>,
    pub integral_gain_per_s: Option<f64>,
    pub rate_per_s: Option<f64>,
    pub response_time_s: Option<f64>,
    pub observer_time_s: Option<f64>,
    pub tracking_frequency_rad_per_s: Option<f64>,
    pub friction_n: Option<f64>,
    pub static_friction_n: Option<f64>,
    pub viscous_n_s_per_m: Option<f64>,
    pub presliding_um: Option<f64>,
    pub friction_uncertainty: Option<f64>,
}

/// Kind of controller.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "snake_case")]
pub(super) enum ControllerKind {
    /// The pressure map alone.
    #[default]
    OpenLoop,
    /// PI on the load cell around the map.
    ProportionalIntegral,
    /// The chamber's equation inverted.
    FeedbackLinearisation,
    /// Disturbances predicted and cancelled.
    DisturbancePrediction,
}

impl ControllerKind {
    /// Its name, and the keys that it has besides `kind`.
    fn keys(self) -> (&'static str, &'static [&'static str]) {
        match self {
            Self::OpenLoop => ("open_loop", &["period_ms"]),
            Self::ProportionalIntegral => (
                "proportional_integral",
                &["period_ms", "proportional_gain", "integral_gain_per_s"],
            ),
            Self::FeedbackLinearisation => (
                "feedback_linearisation",
                &["period_ms", "rate_per_s", "integral_gain_per_s"],
            ),
            Self::DisturbancePrediction => (
                "disturbance_prediction",
                &[
                    "period_ms",
                    "response_time_s",
                    "observer_time_s",
                    "tracking_frequency_rad_per_s",
                    "friction_n",
                    "static_friction_n",
                    "viscous_n_s_per_m",
                    "presliding_um",
                    "friction_uncertainty",
                ],
            ),
        }
    }
}

/// The controller of a scenario.
#[derive(Debug, Clone, PartialEq)]
pub struct ControllerScenario {
    /// Which one.
    pub law: ForceLaw,
    /// Time between two answers, held in between [s]: whole steps of the scenario.
    pub period: f64,
    /// Where the keys stand that the file gives.
    places: Vec<(String, Place)>,
    /// Where the table stands, or its file.
    table: Place,
}

/// A force controller with what the file says of it; `None` is tuned to the device.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum ForceLaw {
    /// The pressure map alone.
    OpenLoop,
    /// PI on the load cell around the map.
    ProportionalIntegral {
        /// Proportional gain [1].
        proportional_gain: Option<f64>,
        /// Integral gain [1/s].
        integral_gain: Option<f64>,
    },
    /// The chamber's equation inverted.
    FeedbackLinearisation {
        /// Rate of the wanted response [1/s].
        rate: Option<f64>,
        /// Integral gain [1/s].
        integral_gain: Option<f64>,
    },
    /// Disturbances predicted over the dead time and cancelled.
    DisturbancePrediction {
        /// Time constant of the pressure's approach [s].
        response_time: Option<f64>,
        /// Time constant of the disturbance observer [s].
        observer_time: Option<f64>,
        /// Poles of the motion's filter [rad/s].
        tracking_frequency: Option<f64>,
        /// The seals as they are believed to be; the device's own when nothing is said.
        seals: Option<SealFriction>,
        /// Uncertainty of the believed dry friction [1].
        friction_uncertainty: Option<f64>,
    },
}

impl ControllerScenario {
    /// Steps of the scenario, each `step` [s], from one answer to the next.
    pub fn steps(&self, step: f64) -> usize {
        (self.period / step).round().max(1.0) as usize
    }

    /// Refuses a value that only its controller can judge.
    pub fn refuse(&self, key: &str, found: String, expected: String) -> ScenarioError {
        let given = self.places.iter().find(|(name, _)| name == key);
        ScenarioError::Value {
            place: given.map_or(&self.table, |(_, place)| place).clone(),
            key: join(TABLE, key),
            found,
            expected,
        }
    }

    /// Whether the file gives a key.
    pub fn gives(&self, key: &str) -> bool {
        self.places.iter().any(|(name, _)| name == key)
    }
}

/// `[controller]` for a device with these sensors; `step` is the scenario's time step [s].
pub(super) fn controller(
    document: &Document<'_>,
    keys: &ControllerKeys,
    device: &DeviceParameters,
    sensing: &SensingParameters,
    step: f64,
) -> Result<ControllerScenario, ScenarioError> {
    let section = Section::new(document, TABLE);
    let (name, allowed) = keys.kind.keys();
    only(&section, name, false, allowed)?;
    let place = |key: &str| (key.to_owned(), document.place(&join(TABLE, key)));
    Ok(ControllerScenario {
        law: law(&section, keys, &device.seal_friction)?,
        period: period(&section, keys.period_ms, sensing, step)?,
        places: section
            .given()
            .filter(|key| !["kind", "period_ms"].contains(key))
            .map(place)
            .collect(),
        table: document.place(TABLE),
    })
}

#[rustfmt::skip] // A table: one key a line.
fn law(section: &Section<'_>, keys: &ControllerKeys, seals: &SealFriction) -> Result<ForceLaw, ScenarioError> {
    let number = |key: &str, given: Option<f64>, range: RangeInclusive<f64>| {
        given.map(|value| section.number(key, value, range)).transpose()
    };
    Ok(match keys.kind {
        ControllerKind::OpenLoop => ForceLaw::OpenLoop,
        ControllerKind::ProportionalIntegral => ForceLaw::ProportionalIntegral {
            proportional_gain: number("proportional_gain", keys.proportional_gain, 0.0..=1000.0)?,
            integral_gain: number("integral_gain_per_s", keys.integral_gain_per_s, 0.0..=1e5)?,
        },
        ControllerKind::FeedbackLinearisation => ForceLaw::FeedbackLinearisation {
            rate: number("rate_per_s", keys.rate_per_s, 0.1..=1e5)?,
            integral_gain: number("integral_gain_per_s", keys.integral_gain_per_s, 0.0..=1e5)?,
        },
        ControllerKind::DisturbancePrediction => ForceLaw::DisturbancePrediction {
            response_time: number("response_time_s", keys.response_time_s, 1e-5..=100.0)?,
            observer_time: number("observer_time_s", keys.observer_time_s, 1e-5..=100.0)?,
            tracking_frequency: number("tracking_frequency_rad_per_s", keys.tracking_frequency_rad_per_s, 0.1..=1e5)?,
            seals: believed_seals(section, keys, seals)?,
            friction_uncertainty: number("friction_uncertainty", keys.friction_uncertainty, 0.0..=1.0)?,
        },
    })
}

/// The device's seals with what the file believes otherwise; none if it says nothing of them.
#[rustfmt::skip] // A table: one key a line.
fn believed_seals(
    section: &Section<'_>,
    keys: &ControllerKeys,
    own: &SealFriction,
) -> Result<Option<SealFriction>, ScenarioError> {
    let given = [
        keys.friction_n,
        keys.static_friction_n,
        keys.viscous_n_s_per_m,
        keys.presliding_um,
    ];
    if given.iter().all(Option::is_none) {
        return Ok(None);
    }
    let [friction, static_friction, viscous, presliding] = given;
    let known_or = |number, key, given, default| section.known_or(number, key, given, default);
    let coulomb = known_or(&registry::SEAL_COULOMB, "friction_n", friction, own.coulomb)?;
    let least = own.static_force.max(coulomb);
    let key = "static_friction_n";
    let static_force = known_or(&registry::SEAL_STATIC, key, static_friction, least)?;
    if static_force < coulomb {
        let expected = format!("at least the sliding friction that is believed, {coulomb} N");
        return Err(section.refuse_number(key, static_force, expected));
    }
    Ok(Some(SealFriction {
        coulomb,
        static_force,
        stribeck_velocity: own.stribeck_velocity,
        viscous: known_or(&registry::SEAL_VISCOUS, "viscous_n_s_per_m", viscous, own.viscous)?,
        presliding_displacement: known_or(&registry::SEAL_PRESLIDING, "presliding_um", presliding, own.presliding_displacement)?,
        pressure_coefficient: own.pressure_coefficient,
    }))
}

/// Control period [s]: whole steps, and no shorter than the sensors' sample period, which is also its default.
fn period(
    section: &Section<'_>,
    given: Option<f64>,
    sensing: &SensingParameters,
    step: f64,
) -> Result<f64, ScenarioError> {
    // A ratio may be a rounding off the whole number that it is.
    const ROUNDING: f64 = 1e-6;
    let sample = sensing.sample_period();
    let Some(value) = given else {
        return Ok(step * (sample / step - ROUNDING).ceil().max(1.0));
    };
    let key = "period_ms";
    let period = section.number(key, value, 0.01..=100.0)?;
    let steps = period / step;
    if steps < 1.0 - ROUNDING || (steps - steps.round()).abs() > ROUNDING * steps {
        let expected = format!("whole steps of simulation.step_ms, {} ms", step * 1e3);
        return Err(section.refuse_number(key, value, expected));
    }
    if period < sample * (1.0 - ROUNDING) {
        let expected = format!(
            "at least the sample period of [sensing], {} ms",
            sample * 1e3
        );
        return Err(section.refuse_number(key, value, expected));
    }
    Ok(period)
}

/// Largest set pressure that a device with this command's way can be told, gauge [Pa], and what sets the limit, before the words "0 to ... bar".
pub fn attainable_set_pressure(
    device: &DeviceParameters,
    command: &CommandChain,
) -> (f64, &'static str) {
    let (supply, chain) = (
        device.regulator.supply,
        super::largest_set_pressure(command),
    );
    if chain < supply {
        (chain, "[sensing.command] can set")
    } else {
        (supply, "the supply gives")
    }
}

/// Refuses a contact force [N] for which the device would need a set pressure that it cannot be told.
pub(super) fn check_force(
    section: &Section<'_>,
    force: f64,
    gravity_along_axis: f64,
    device: &DeviceParameters,
    command: &CommandChain,
) -> Result<(), ScenarioError> {
    let map = PressureMap::new(device);
    let needed = map.unlimited(force, gravity_along_axis);
    let (largest, giver) = attainable_set_pressure(device, command);
    // One at the very end of the range may be a rounding beyond it.
    let rounding = 1e-9 * largest;
    if (-rounding..=largest + rounding).contains(&needed) {
        return Ok(());
    }
    let [low, high] = [0.0, largest].map(|pressure| map.force(pressure, gravity_along_axis));
    let found = format!(
        "{force} N, which needs {:.2} bar gauge at the regulator; {giver} 0 to {:.2} bar",
        needed / 1e5,
        largest / 1e5
    );
    let expected = format!("{:.1} to {high:.1} N", low.max(0.0));
    Err(section.refuse("force_n", found, expected))
}
