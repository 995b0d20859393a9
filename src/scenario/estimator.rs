//! `[estimator]` of a bench: nominal noise and device of the estimator, checked and set up.

use serde::Deserialize;

use super::sensing::white;
use crate::device::DeviceParameters;
use crate::estimation::{ContactForceEstimator, EstimatorParameters, SensorNoise, Tolerances};
use crate::keys::check::Section;
use crate::keys::declaration::{Plain, keys};
use crate::keys::document::Document;
use crate::keys::error::ScenarioError;
use crate::plant::{Nominal, PlantParameters, registry};
use crate::sensing::{Measurement, SensingParameters};

/// Name of the table.
const TABLE: &str = "estimator";

/// Limits that the other keys start from.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "snake_case")]
pub(super) enum KnownTo {
    /// As of a device whose parts were not measured one by one.
    #[default]
    Usual,
    /// The device is exactly as its data say.
    None,
}

keys! {
    /// `[estimator]`.
    pub(super) struct EstimatorKeys {
        /// nominal standard deviation of the stroke's samples; when left out, what `[sensing]` gives them, rounding to steps included, and this value if that is 0
        stroke_noise: Option<f64> = "stroke_noise_mm" in 1e-6..=10.0, shown "0.02";
        /// of the acceleration's, likewise
        acceleration_noise: Option<f64> = "acceleration_noise_m_per_s2" in 1e-6..=1000.0, shown "0.25";
        /// of the regulator pressure's, likewise
        regulator_pressure_noise: Option<f64> = "regulator_pressure_noise_pa" in 1e-3..=1e6, shown "600";
        /// nominal moving mass; the device's when left out
        moving_mass_value: Option<f64> = "moving_mass_kg", of registry::MOVING_MASS;
        /// nominal Coulomb friction, with static friction in proportion; the device's when left out
        seal_coulomb_force: Option<f64> = "seal_coulomb_force_n", of registry::SEAL_COULOMB;
        /// where the tolerances below start: at the defaults below, of a device whose parts were not measured one by one, or all at 0
        tolerances: KnownTo = "tolerances", or "usual";
        /// of the moving mass, relative
        moving_mass: f64 = "moving_mass_tolerance" in 0.0..=0.9, from Tolerances::default().moving_mass, else tolerances.base().moving_mass;
        /// of each orifice, relative
        orifice: f64 = "orifice_tolerance" in 0.0..=0.9, from Tolerances::default().orifices, else tolerances.base().orifices;
        /// of the dead volume, relative
        dead_volume: f64 = "dead_volume_tolerance" in 0.0..=0.9, from Tolerances::default().dead_volume, else tolerances.base().dead_volume;
        /// of the gas force by the areas, relative
        piston_area: f64 = "piston_area_tolerance" in 0.0..=0.9, from Tolerances::default().piston_area, else tolerances.base().piston_area;
        /// of the dry friction's level, relative
        dry_friction: f64 = "dry_friction_tolerance" in 0.0..=0.9, from Tolerances::default().dry_friction, else tolerances.base().dry_friction;
        /// of the viscous friction, relative
        viscous_friction: f64 = "viscous_friction_tolerance" in 0.0..=0.9, from Tolerances::default().viscous_friction, else tolerances.base().viscous_friction;
        /// of the presliding displacement, relative
        presliding_displacement: f64 = "presliding_displacement_tolerance" in 0.0..=0.9, from Tolerances::default().presliding_displacement, else tolerances.base().presliding_displacement;
        /// of the regulator pressure sensor's scale, relative
        regulator_pressure_scale: f64 = "regulator_pressure_scale_tolerance" in 0.0..=0.9, from Tolerances::default().regulator_pressure_scale, else tolerances.base().regulator_pressure_scale;
        /// bias of that sensor
        regulator_pressure_bias: f64 = "regulator_pressure_tolerance_pa" in 0.0..=1e6, from Tolerances::default().regulator_pressure_bias, else tolerances.base().regulator_pressure_bias;
        /// bias of the accelerometer, which is estimated on the way
        acceleration_bias: f64 = "acceleration_tolerance_m_per_s2" in 0..=100, from Tolerances::default().acceleration_bias, else tolerances.base().acceleration_bias;
        /// of the component of gravity along extension
        gravity: f64 = "gravity_tolerance_m_per_s2" in 0..=30, from Tolerances::default().gravity_along_axis, else tolerances.base().gravity_along_axis;
    }
}

impl Plain for KnownTo {}

impl KnownTo {
    /// Tolerances that the file does not give.
    fn base(self) -> Tolerances {
        match self {
            Self::Usual => Tolerances::default(),
            Self::None => Tolerances::NONE,
        }
    }
}

/// Basis of a bench's estimator.
pub(super) struct EstimatorBase<'a> {
    pub nominal: &'a Nominal<PlantParameters>,
    pub sensing: &'a SensingParameters,
    pub start_stroke: f64,
    /// Time step [s].
    pub step: f64,
}

/// Sets the estimator up that the keys ask for.
pub(super) fn estimator(
    document: &Document<'_>,
    keys: &EstimatorKeys,
    base: &EstimatorBase<'_>,
) -> Result<ContactForceEstimator, ScenarioError> {
    let device = nominal_device(keys, &base.nominal.device);
    let parameters = EstimatorParameters {
        gravity_along_axis: base.nominal.gravity_along_extension,
        ..EstimatorParameters::new(noise(keys, base.sensing), tolerances(keys))
    };
    let period = if base.sensing.sample_rate == f64::INFINITY {
        base.step
    } else {
        base.sensing.sample_period()
    };
    let refuse = |reason: String| Section::new(document, "").misplaced(TABLE, reason);
    let steps = period / base.step;
    if (steps - steps.round()).abs() > 1e-6 * steps {
        return Err(refuse(format!(
            "it needs samples at equal intervals, and {period} s between samples are no whole number of steps of {} s",
            base.step
        )));
    }
    ContactForceEstimator::new(&device, &parameters, base.start_stroke, period)
        .map_err(|error| refuse(error.to_string()))
}

/// The device as it is nominally.
fn nominal_device(keys: &EstimatorKeys, device: &DeviceParameters) -> DeviceParameters {
    let mut nominal = device.clone();
    nominal.moving_mass = keys.moving_mass_value.unwrap_or(device.moving_mass);
    let seals = &mut nominal.seal_friction;
    let coulomb = keys.seal_coulomb_force.unwrap_or(seals.coulomb);
    seals.static_force = if seals.coulomb > 0.0 {
        seals.static_force * coulomb / seals.coulomb
    } else {
        coulomb.max(seals.static_force)
    };
    seals.coulomb = coulomb;
    nominal
}

/// Standard deviations of the sensors as the file gives them, else as `[sensing]` makes them; rounding to a step is an error even within it
/// (JCGM 100:2008, F.2.2.1).
fn noise(keys: &EstimatorKeys, sensing: &SensingParameters) -> SensorNoise {
    let rounded = |noise: f64, step: f64| (noise * noise + step * step / 12.0).sqrt();
    let stroke = nominal_noise(&sensing.stroke, white::STROKE, |s| {
        rounded(s.noise, s.resolution)
    });
    let acceleration = nominal_noise(&sensing.acceleration, white::ACCELERATION, |s| {
        rounded(s.noise, s.resolution)
    });
    let pressure = nominal_noise(&sensing.regulator_pressure, white::PRESSURE, |s| {
        rounded(s.noise.hypot(s.adc.noise * s.step()), s.step())
    });
    SensorNoise {
        stroke: keys.stroke_noise.unwrap_or(stroke),
        acceleration: keys.acceleration_noise.unwrap_or(acceleration),
        regulator_pressure: keys.regulator_pressure_noise.unwrap_or(pressure),
    }
}

/// Standard deviation of a channel; of one without noise that of usual white noise, for no filter can do without.
fn nominal_noise<S>(channel: &Measurement<S>, usual: f64, real: impl FnOnce(&S) -> f64) -> f64 {
    let deviation = match channel {
        Measurement::Ideal => 0.0,
        Measurement::White { standard_deviation } => *standard_deviation,
        Measurement::Real(sensor) => real(sensor),
    };
    if deviation > 0.0 { deviation } else { usual }
}

fn tolerances(keys: &EstimatorKeys) -> Tolerances {
    Tolerances {
        moving_mass: keys.moving_mass,
        orifices: keys.orifice,
        dead_volume: keys.dead_volume,
        piston_area: keys.piston_area,
        dry_friction: keys.dry_friction,
        viscous_friction: keys.viscous_friction,
        presliding_displacement: keys.presliding_displacement,
        regulator_pressure_scale: keys.regulator_pressure_scale,
        regulator_pressure_bias: keys.regulator_pressure_bias,
        acceleration_bias: keys.acceleration_bias,
        gravity_along_axis: keys.gravity,
    }
}
