//! `[estimator]` of a bench: what the estimator believes of noise and device, checked and set up.

use std::ops::RangeInclusive;

use serde::Deserialize;

use super::check::Section;
use super::document::Document;
use super::error::ScenarioError;
use super::sensing::white;
use crate::device::DeviceParameters;
use crate::estimation::{ContactForceEstimator, EstimatorParameters, SensorNoise, Tolerances};
use crate::plant::registry;
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

/// `[estimator]`.
#[derive(Debug, Default, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct EstimatorKeys {
    pub stroke_noise_mm: Option<f64>,
    pub acceleration_noise_m_per_s2: Option<f64>,
    pub regulator_pressure_noise_pa: Option<f64>,
    pub moving_mass_kg: Option<f64>,
    pub seal_coulomb_force_n: Option<f64>,
    #[serde(default)]
    pub tolerances: KnownTo,
    pub moving_mass_tolerance: Option<f64>,
    pub orifice_tolerance: Option<f64>,
    pub dead_volume_tolerance: Option<f64>,
    pub piston_area_tolerance: Option<f64>,
    pub dry_friction_tolerance: Option<f64>,
    pub viscous_friction_tolerance: Option<f64>,
    pub presliding_displacement_tolerance: Option<f64>,
    pub regulator_pressure_scale_tolerance: Option<f64>,
    pub regulator_pressure_tolerance_pa: Option<f64>,
    pub acceleration_tolerance_m_per_s2: Option<f64>,
    pub gravity_tolerance_m_per_s2: Option<f64>,
}

/// Basis of a bench's estimator.
pub(super) struct EstimatorBase<'a> {
    pub device: &'a DeviceParameters,
    pub sensing: &'a SensingParameters,
    pub gravity_along_extension: f64,
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
    let section = Section::new(document, TABLE);
    let device = believed_device(&section, keys, base.device)?;
    let parameters = EstimatorParameters {
        gravity_along_axis: base.gravity_along_extension,
        ..EstimatorParameters::new(
            noise(&section, keys, base.sensing)?,
            tolerances(&section, keys)?,
        )
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

/// The device as the estimator believes it to be.
fn believed_device(
    section: &Section<'_>,
    keys: &EstimatorKeys,
    device: &DeviceParameters,
) -> Result<DeviceParameters, ScenarioError> {
    let mut believed = device.clone();
    let known_or = |number, key, given, default| section.known_or(number, key, given, default);
    let (mass, given) = (&registry::MOVING_MASS, keys.moving_mass_kg);
    believed.moving_mass = known_or(mass, "moving_mass_kg", given, device.moving_mass)?;
    let seals = &mut believed.seal_friction;
    let (force, given) = (&registry::SEAL_COULOMB, keys.seal_coulomb_force_n);
    let coulomb = known_or(force, "seal_coulomb_force_n", given, seals.coulomb)?;
    seals.static_force = if seals.coulomb > 0.0 {
        seals.static_force * coulomb / seals.coulomb
    } else {
        coulomb.max(seals.static_force)
    };
    seals.coulomb = coulomb;
    Ok(believed)
}

/// Standard deviations of the sensors as the file gives them, else as `[sensing]` makes them; rounding to a step is an error even within it
/// (JCGM 100:2008, F.2.2.1).
#[rustfmt::skip] // A table: one key a line.
fn noise(
    section: &Section<'_>,
    keys: &EstimatorKeys,
    sensing: &SensingParameters,
) -> Result<SensorNoise, ScenarioError> {
    let rounded = |noise: f64, step: f64| (noise * noise + step * step / 12.0).sqrt();
    let stroke = believed(&sensing.stroke, white::STROKE, |s| {
        rounded(s.noise, s.resolution)
    });
    let acceleration = believed(&sensing.acceleration, white::ACCELERATION, |s| {
        rounded(s.noise, s.resolution)
    });
    let pressure = believed(&sensing.regulator_pressure, white::PRESSURE, |s| {
        rounded(s.noise.hypot(s.adc.noise * s.step()), s.step())
    });
    let number = |key, given, default, range| section.number_or(key, given, default, range);
    Ok(SensorNoise {
        stroke: number("stroke_noise_mm", keys.stroke_noise_mm, stroke, 1e-6..=10.0)?,
        acceleration: number("acceleration_noise_m_per_s2", keys.acceleration_noise_m_per_s2, acceleration, 1e-6..=1000.0)?,
        regulator_pressure: number("regulator_pressure_noise_pa", keys.regulator_pressure_noise_pa, pressure, 1e-3..=1e6)?,
    })
}

/// Standard deviation of a channel; of one without noise that of usual white noise, for no filter can do without.
fn believed<S>(channel: &Measurement<S>, usual: f64, real: impl FnOnce(&S) -> f64) -> f64 {
    let deviation = match channel {
        Measurement::Ideal => 0.0,
        Measurement::White { standard_deviation } => *standard_deviation,
        Measurement::Real(sensor) => real(sensor),
    };
    if deviation > 0.0 { deviation } else { usual }
}

#[rustfmt::skip] // A table: one key a line.
fn tolerances(section: &Section<'_>, keys: &EstimatorKeys) -> Result<Tolerances, ScenarioError> {
    const RELATIVE: RangeInclusive<f64> = 0.0..=0.9;
    let base = match keys.tolerances {
        KnownTo::Usual => Tolerances::default(),
        KnownTo::None => Tolerances::NONE,
    };
    let number = |key, given, default, range| section.number_or(key, given, default, range);
    Ok(Tolerances {
        moving_mass: number("moving_mass_tolerance", keys.moving_mass_tolerance, base.moving_mass, RELATIVE)?,
        orifices: number("orifice_tolerance", keys.orifice_tolerance, base.orifices, RELATIVE)?,
        dead_volume: number("dead_volume_tolerance", keys.dead_volume_tolerance, base.dead_volume, RELATIVE)?,
        piston_area: number("piston_area_tolerance", keys.piston_area_tolerance, base.piston_area, RELATIVE)?,
        dry_friction: number("dry_friction_tolerance", keys.dry_friction_tolerance, base.dry_friction, RELATIVE)?,
        viscous_friction: number("viscous_friction_tolerance", keys.viscous_friction_tolerance, base.viscous_friction, RELATIVE)?,
        presliding_displacement: number("presliding_displacement_tolerance", keys.presliding_displacement_tolerance, base.presliding_displacement, RELATIVE)?,
        regulator_pressure_scale: number("regulator_pressure_scale_tolerance", keys.regulator_pressure_scale_tolerance, base.regulator_pressure_scale, RELATIVE)?,
        regulator_pressure_bias: number("regulator_pressure_tolerance_pa", keys.regulator_pressure_tolerance_pa, base.regulator_pressure_bias, 0.0..=1e6)?,
        acceleration_bias: number("acceleration_tolerance_m_per_s2", keys.acceleration_tolerance_m_per_s2, base.acceleration_bias, 0.0..=100.0)?,
        gravity_along_axis: number("gravity_tolerance_m_per_s2", keys.gravity_tolerance_m_per_s2, base.gravity_along_axis, 0.0..=30.0)?,
    })
}
