//! Parameters of an estimator beside the device: noise, tolerances, how fast things may change.

use super::EstimationError;

/// Standard deviations of the white noise on each sample.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SensorNoise {
    /// Of the stroke [m].
    pub stroke: f64,
    /// Of the acceleration [m/s2].
    pub acceleration: f64,
    /// Of the regulator's outlet pressure [Pa].
    pub regulator_pressure: f64,
}

/// Limits within which the true device lies about its data: half widths, every value within them equally likely (JCGM 100:2008, 4.3.7),
/// so that the standard uncertainty is the limit over the square root of 3.
///
/// An offset of the stroke shifts volumes as a dead volume does; state it there.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tolerances {
    /// Of the moving mass, relative [1].
    pub moving_mass: f64,
    /// Of each orifice with its discharge coefficient, independent, relative [1].
    pub orifices: f64,
    /// Of the dead volume, relative [1].
    pub dead_volume: f64,
    /// Of the piston areas, as a factor on the gas force, relative [1].
    pub piston_area: f64,
    /// Of the dry friction's level, relative [1].
    pub dry_friction: f64,
    /// Of the viscous friction, relative [1].
    pub viscous_friction: f64,
    /// Of the presliding displacement, relative [1].
    pub presliding_displacement: f64,
    /// Bias of the regulator's outlet sensor [Pa].
    pub regulator_pressure_bias: f64,
    /// Of the same sensor's scale, relative [1].
    pub regulator_pressure_scale: f64,
    /// Bias of the accelerometer [m/s2]; estimated on the way, for the stroke shows it.
    pub acceleration_bias: f64,
    /// Of the component of gravity along extension [m/s2].
    pub gravity_along_axis: f64,
}

impl Tolerances {
    /// A device exactly as its data say.
    pub const NONE: Self = Self {
        moving_mass: 0.0,
        orifices: 0.0,
        dead_volume: 0.0,
        piston_area: 0.0,
        dry_friction: 0.0,
        viscous_friction: 0.0,
        presliding_displacement: 0.0,
        regulator_pressure_bias: 0.0,
        regulator_pressure_scale: 0.0,
        acceleration_bias: 0.0,
        gravity_along_axis: 0.0,
    };

    /// Standard uncertainty of a limit.
    pub(super) fn standard(limit: f64) -> f64 {
        limit / 3.0f64.sqrt()
    }
}

impl Default for Tolerances {
    /// As usual for a device whose parts were not measured one by one.
    fn default() -> Self {
        Self {
            moving_mass: 0.01,
            orifices: 0.05,
            dead_volume: 0.10,
            piston_area: 0.0,
            dry_friction: 0.20,
            viscous_friction: 0.20,
            presliding_displacement: 0.50,
            regulator_pressure_bias: 1500.0,
            regulator_pressure_scale: 0.0,
            acceleration_bias: 0.05,
            gravity_along_axis: 0.02,
        }
    }
}

/// One hypothesis of how fast things change.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ProcessModel {
    /// Random walk of the acceleration [m/s2 per square root of a second].
    pub acceleration_walk: f64,
    /// Random walk of the pressure that the regulator's outlet lags behind [Pa per square root of a second].
    pub pressure_walk: f64,
    /// Mean time for which the hypothesis stays true [s].
    pub dwell: f64,
}

/// All of it.
#[derive(Debug, Clone, PartialEq)]
pub struct EstimatorParameters {
    /// Noise of the sensors.
    pub noise: SensorNoise,
    /// Uncertainty of the device.
    pub tolerances: Tolerances,
    /// Hypotheses that run side by side, equally likely at the start.
    pub models: Vec<ProcessModel>,
    /// Component of gravity along extension, less the flange's own acceleration there [m/s2].
    pub gravity_along_axis: f64,
}

impl EstimatorParameters {
    /// With the models that `usual_models` explains, gravity across the axis.
    pub fn new(noise: SensorNoise, tolerances: Tolerances) -> Self {
        Self {
            noise,
            tolerances,
            models: Self::usual_models(),
            gravity_along_axis: 0.0,
        }
    }

    /// Pressing on a surface that moves 20 mm peak to peak, at 0.1 Hz with the outlet at rest and at 0.5 Hz; vibration; a new set pressure (2 bar
    /// within 50 ms); impact (70 m/s2 within a few ms).
    ///
    /// A jerk j [m/s3 rms] that is alike for a time t is to the filter a walk of j sqrt(2 t). A sine of f [Hz] is alike for 1 / (2 pi f): 1.6 s with
    /// 0.0018 m/s3 at 0.1 Hz, 0.32 s with 0.22 m/s3 at 0.5 Hz.
    pub fn usual_models() -> Vec<ProcessModel> {
        let model = |acceleration_walk, pressure_walk, dwell| ProcessModel {
            acceleration_walk,
            pressure_walk,
            dwell,
        };
        vec![
            model(0.003, 200.0, 3.0),
            model(0.2, 2e3, 1.0),
            model(1.5, 2e3, 0.3),
            model(5.0, 1e6, 0.1),
            model(500.0, 1e6, 0.02),
        ]
    }

    /// Refuses what cannot be meant.
    pub(super) fn check(&self) -> Result<(), EstimationError> {
        let noise = &self.noise;
        let mut positive = vec![
            ("standard deviation of the stroke", noise.stroke, "m"),
            (
                "standard deviation of the acceleration",
                noise.acceleration,
                "m/s2",
            ),
            (
                "standard deviation of the regulator pressure",
                noise.regulator_pressure,
                "Pa",
            ),
        ];
        for model in &self.models {
            positive.push((
                "random walk of the acceleration",
                model.acceleration_walk,
                "m/s2 per square root of a second",
            ));
            positive.push((
                "random walk of the pressure",
                model.pressure_walk,
                "Pa per square root of a second",
            ));
            positive.push(("dwell of a process model", model.dwell, "s"));
        }
        for (name, value, unit) in positive {
            if !(value.is_finite() && value > 0.0) {
                return Err(EstimationError::NotPositive { name, value, unit });
            }
        }
        if self.models.is_empty() {
            return Err(EstimationError::NoModel);
        }
        if !self.gravity_along_axis.is_finite() {
            return Err(EstimationError::NotFinite {
                name: "gravity along the axis",
                value: self.gravity_along_axis,
            });
        }
        self.tolerances.check()
    }
}

impl Tolerances {
    fn check(&self) -> Result<(), EstimationError> {
        let relative = [
            ("the moving mass", self.moving_mass),
            ("the orifices", self.orifices),
            ("the dead volume", self.dead_volume),
            ("the piston area", self.piston_area),
            ("the dry friction", self.dry_friction),
            ("the viscous friction", self.viscous_friction),
            ("the presliding displacement", self.presliding_displacement),
            (
                "the regulator pressure's scale",
                self.regulator_pressure_scale,
            ),
        ];
        let absolute = [
            (
                "the regulator pressure's bias",
                self.regulator_pressure_bias,
                "Pa",
            ),
            ("the accelerometer's bias", self.acceleration_bias, "m/s2"),
            ("gravity along the axis", self.gravity_along_axis, "m/s2"),
        ];
        let all = relative.map(|(name, value)| (name, value, "(relative)"));
        for (name, value, unit) in all.into_iter().chain(absolute) {
            if !(value.is_finite() && value >= 0.0) {
                return Err(EstimationError::Tolerance { name, value, unit });
            }
        }
        match relative.into_iter().find(|(_, value)| *value >= 1.0) {
            Some((name, value)) => Err(EstimationError::WholeOfIt { name, value }),
            None => Ok(()),
        }
    }
}
