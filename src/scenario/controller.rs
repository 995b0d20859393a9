//! `[controller]` of a scenario of either kind: which force controller, how often it works, and those of its values that the file gives.
//!
//! Values that are left out are tuned to the device where the controller is built (`crate::control::force`), for the rules stand there; so does the check that the
//! loop is stable, which refuses through [`ControllerScenario::refuse`].

use serde::Deserialize;

use crate::device::{DeviceParameters, PressureMap};
use crate::keys::check::Section;
use crate::keys::declaration::{Plain, keys};
use crate::keys::document::Document;
use crate::keys::error::{Location, ScenarioError};
use crate::keys::suggestion::join;
use crate::physics::seal_friction::SealFriction;
use crate::plant::{Nominal, PlantParameters, registry};
use crate::sensing::{CommandChain, SensingParameters};

/// The table's name.
const TABLE: &str = "controller";

keys! {
    /// `[controller]`.
    pub(super) struct ControllerKeys {
        /// which of the keys below there are
        kind: ControllerKind = "kind", or "open_loop";
        /// time between two answers, held in between: whole steps, and no shorter than the sensors' sample period
        period: Option<f64> = "period_ms" in 0.01..=100.0, shown "one sample of `[sensing]`, a step at least";
        /// force commanded over force missing
        proportional_gain: Option<f64> = "proportional_gain" for "proportional_integral" in 0..=1000, shown "tuned: lag over twice the delay";
        /// integral gain on the load cell's error
        integral_gain: Option<f64> = "integral_gain_per_s" for "proportional_integral" | "feedback_linearisation" in 0.0..=1e5, shown "tuned to lag and delay";
        /// rate of the wanted response of the pressure
        rate: Option<f64> = "rate_per_s" for "feedback_linearisation" in 0.1..=1e5, shown "tuned: 4 over the dead time";
        /// time constant of the pressure's approach to what is wanted
        response_time: Option<f64> = "response_time_s" for "disturbance_prediction" in 1e-5..=100.0, shown "tuned: half the dead time, 0.01 at least";
        /// time constant with which the load cell's disagreement with the model is followed
        observer_time: Option<f64> = "observer_time_s" for "disturbance_prediction" in 1e-5..=100.0, shown "tuned: twice the response time";
        /// poles of the filter for speed and acceleration, below half the sampling frequency
        tracking_frequency: Option<f64> = "tracking_frequency_rad_per_s" for "disturbance_prediction" in 0.1..=1e5, shown "tuned: 40";
        /// nominal Coulomb friction
        friction: Option<f64> = "friction_n" for "disturbance_prediction", of registry::SEAL_COULOMB, shown "the device's";
        /// nominal breakaway force
        static_friction: Option<f64> = "static_friction_n" for "disturbance_prediction", of registry::SEAL_STATIC, shown "the device's, `friction_n` at least";
        /// nominal viscous friction
        viscous: Option<f64> = "viscous_n_s_per_m" for "disturbance_prediction", of registry::SEAL_VISCOUS, shown "the device's";
        /// nominal presliding displacement
        presliding: Option<f64> = "presliding_um" for "disturbance_prediction", of registry::SEAL_PRESLIDING, shown "the device's";
        /// how uncertain the nominal dry friction is, as a share of it
        friction_uncertainty: Option<f64> = "friction_uncertainty" for "disturbance_prediction" in 0..=1, shown "tuned: 0.5";
    }
}

impl Plain for ControllerKind {}

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

/// The controller of a scenario.
#[derive(Debug, Clone, PartialEq)]
pub struct ControllerScenario {
    /// Which one.
    pub law: ForceLaw,
    /// Time between two answers, held in between [s]: whole steps of the scenario.
    pub period: f64,
    /// Where the keys stand that the file gives.
    locations: Vec<(String, Location)>,
    /// Where the table stands, or its file.
    table: Location,
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
        /// The nominal seals; the device's own when nothing is said.
        seals: Option<SealFriction>,
        /// Uncertainty of the nominal dry friction [1].
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
        let given = self.locations.iter().find(|(name, _)| name == key);
        ScenarioError::Value {
            location: given.map_or(&self.table, |(_, location)| location).clone(),
            key: join(TABLE, key),
            found,
            expected,
        }
    }

    /// Whether the file gives a key.
    pub fn gives(&self, key: &str) -> bool {
        self.locations.iter().any(|(name, _)| name == key)
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
    section.of_kind::<ControllerKeys>(None)?;
    let location = |key: &str| (key.to_owned(), document.location(&join(TABLE, key)));
    Ok(ControllerScenario {
        law: law(&section, keys, &device.seal_friction)?,
        period: period(&section, keys.period, sensing, step)?,
        locations: section
            .given()
            .filter(|key| !["kind", "period_ms"].contains(key))
            .map(location)
            .collect(),
        table: document.location(TABLE),
    })
}

fn law(
    section: &Section<'_>,
    keys: &ControllerKeys,
    seals: &SealFriction,
) -> Result<ForceLaw, ScenarioError> {
    Ok(match keys.kind {
        ControllerKind::OpenLoop => ForceLaw::OpenLoop,
        ControllerKind::ProportionalIntegral => ForceLaw::ProportionalIntegral {
            proportional_gain: keys.proportional_gain,
            integral_gain: keys.integral_gain,
        },
        ControllerKind::FeedbackLinearisation => ForceLaw::FeedbackLinearisation {
            rate: keys.rate,
            integral_gain: keys.integral_gain,
        },
        ControllerKind::DisturbancePrediction => ForceLaw::DisturbancePrediction {
            response_time: keys.response_time,
            observer_time: keys.observer_time,
            tracking_frequency: keys.tracking_frequency,
            seals: nominal_seals(section, keys, seals)?,
            friction_uncertainty: keys.friction_uncertainty,
        },
    })
}

/// The device's seals with what the file says is nominal otherwise; none if it says nothing of them.
fn nominal_seals(
    section: &Section<'_>,
    keys: &ControllerKeys,
    own: &SealFriction,
) -> Result<Option<SealFriction>, ScenarioError> {
    let given = [
        keys.friction,
        keys.static_friction,
        keys.viscous,
        keys.presliding,
    ];
    if given.iter().all(Option::is_none) {
        return Ok(None);
    }
    let [friction, static_friction, viscous, presliding] = given;
    let coulomb = friction.unwrap_or(own.coulomb);
    let static_force = static_friction.unwrap_or(own.static_force.max(coulomb));
    if static_force < coulomb {
        let expected = format!("at least the nominal sliding friction, {coulomb} N");
        return Err(section.refuse_si("static_friction_n", static_force, expected));
    }
    Ok(Some(SealFriction {
        coulomb,
        static_force,
        stribeck_velocity: own.stribeck_velocity,
        viscous: viscous.unwrap_or(own.viscous),
        presliding_displacement: presliding.unwrap_or(own.presliding_displacement),
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
    let Some(period) = given else {
        return Ok(step * (sample / step - ROUNDING).ceil().max(1.0));
    };
    let key = "period_ms";
    let steps = period / step;
    if steps < 1.0 - ROUNDING || (steps - steps.round()).abs() > ROUNDING * steps {
        let expected = format!("whole steps of simulation.step_ms, {} ms", step * 1e3);
        return Err(section.refuse_si(key, period, expected));
    }
    if period < sample * (1.0 - ROUNDING) {
        let expected = format!(
            "at least the sample period of [sensing], {} ms",
            sample * 1e3
        );
        return Err(section.refuse_si(key, period, expected));
    }
    Ok(period)
}

/// Largest set pressure that this way of commanding the device can give, gauge [Pa], and what sets the limit, before the words "0 to ... bar".
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

/// Refuses a contact force [N] for which the device would need a set pressure that it cannot be given.
pub(super) fn check_force(
    section: &Section<'_>,
    force: f64,
    nominal: &Nominal<PlantParameters>,
    command: &CommandChain,
) -> Result<(), ScenarioError> {
    let (device, gravity_along_axis) = (&nominal.device, nominal.gravity_along_extension);
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
