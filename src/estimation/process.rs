//! Belief before the first sample, and its trajectory from one sample to the next.
//!
//! ```text
//! x <- x + v T + a T^2/2,   v <- v + a T,   a <- a + walk                             (the motion that the surface imposes)
//! p_o <- p_t + (p_o - p_t) exp(-T/tau),     p_t <- p_t + walk                          (source paper, eq. 8, set pressure unknown)
//! ```

use super::belief::{
    ACCELERATION, ACCELERATION_BIAS, Belief, DEAD_VOLUME, EXHAUST, MASSES, OUTLET, PRESLIDING,
    PRESSURE_BIAS, PRESSURE_SCALE, SIZE, SPEED, STROKE, SUPPLY, TARGET, TURNING_DEFLECTION,
    TURNING_STROKE,
};
use super::chambers::{Chambers, Drive};
use super::parameters::{EstimatorParameters, ProcessModel, Tolerances};
use crate::device::DeviceParameters;
use crate::physics::valve::ValvePosition;

/// Possible motion before the first sample, standard deviations: stroke [m], speed [m/s], acceleration [m/s2].
const START_MOTION: [f64; 3] = [1e-3, 0.05, 1.0];

/// Process noise of one model over one period.
#[derive(Debug, Clone)]
pub(super) struct ProcessNoise {
    /// Covariances between two elements.
    entries: [(usize, usize, f64); 9],
}

impl ProcessNoise {
    /// A walk of the acceleration integrated twice, one of the regulator's target seen through its lag.
    pub(super) fn new(model: &ProcessModel, period: f64, time_constant: f64) -> Self {
        let q = model.acceleration_walk.powi(2);
        let t = period;
        let w = model.pressure_walk.powi(2);
        let lag = time_constant.max(t);
        Self {
            entries: [
                (STROKE, STROKE, q * t.powi(5) / 20.0),
                (STROKE, SPEED, q * t.powi(4) / 8.0),
                (STROKE, ACCELERATION, q * t.powi(3) / 6.0),
                (SPEED, SPEED, q * t.powi(3) / 3.0),
                (SPEED, ACCELERATION, q * t * t / 2.0),
                (ACCELERATION, ACCELERATION, q * t),
                (OUTLET, OUTLET, w * t.powi(3) / (3.0 * lag * lag)),
                (OUTLET, TARGET, w * t * t / (2.0 * lag)),
                (TARGET, TARGET, w * t),
            ],
        }
    }
}

/// Before the first sample: motion within its start, outlet anywhere within the supply, parameters within their tolerances.
pub(super) fn first_belief(
    device: &DeviceParameters,
    parameters: &EstimatorParameters,
    initial_stroke: f64,
) -> Belief {
    let tolerances = &parameters.tolerances;
    let mut mean = [0.0; SIZE];
    mean[STROKE] = initial_stroke;
    let mut deviations = [0.0; SIZE];
    [
        deviations[STROKE],
        deviations[SPEED],
        deviations[ACCELERATION],
    ] = START_MOTION;
    deviations[OUTLET] = device.regulator.supply;
    // Any deflection within the presliding range is as likely as any other.
    deviations[TURNING_DEFLECTION] = if device.seal_friction.is_dry() {
        Tolerances::standard(device.seal_friction.static_force / device.seal_friction.coulomb)
    } else {
        0.0
    };
    for (element, limit) in [
        (ACCELERATION_BIAS, tolerances.acceleration_bias),
        (PRESSURE_BIAS, tolerances.regulator_pressure_bias),
        (PRESSURE_SCALE, tolerances.regulator_pressure_scale),
        (SUPPLY, tolerances.orifices),
        (EXHAUST, tolerances.orifices),
        (DEAD_VOLUME, tolerances.dead_volume),
        (PRESLIDING, tolerances.presliding_displacement),
    ] {
        deviations[element] = Tolerances::standard(limit);
    }
    let mut belief = Belief::uncorrelated(mean, deviations);
    // The turning point is where it stands, and the outlet has long followed its target.
    belief.mean[TURNING_STROKE] = initial_stroke;
    belief.combine(TURNING_STROKE, &[(STROKE, 1.0)]);
    belief.combine(TARGET, &[(OUTLET, 1.0)]);
    belief
}

/// Carries a belief over a period.
pub(super) fn predict(
    belief: &mut Belief,
    chambers: &Chambers,
    noise: &ProcessNoise,
    valve: ValvePosition,
) {
    let period = chambers.period();
    let mean = &belief.mean;
    let drive = Drive {
        stroke: mean[STROKE],
        speed: mean[SPEED],
        acceleration: mean[ACCELERATION],
        outlet: mean[OUTLET],
        target: mean[TARGET],
    };
    // Chambers first: they answer to the motion and outlet as they are at the start.
    for (i, element) in MASSES.into_iter().enumerate() {
        let (mass, terms) = chambers.advance(i, belief.mean[element], &drive, valve);
        belief.mean[element] = mass;
        belief.combine(element, &terms);
    }
    let half_square = 0.5 * period * period;
    belief.combine(
        STROKE,
        &[(STROKE, 1.0), (SPEED, period), (ACCELERATION, half_square)],
    );
    belief.combine(SPEED, &[(SPEED, 1.0), (ACCELERATION, period)]);
    let left = chambers.remaining();
    belief.combine(OUTLET, &[(OUTLET, left), (TARGET, 1.0 - left)]);
    belief.mean[STROKE] += period * drive.speed + half_square * drive.acceleration;
    belief.mean[SPEED] += period * drive.acceleration;
    belief.mean[OUTLET] = chambers.outlet(&drive);
    for &(i, j, covariance) in &noise.entries {
        belief.add_noise(i, j, covariance);
    }
}
