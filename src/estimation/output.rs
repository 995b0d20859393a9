//! The force that a belief implies, with its variance.

use super::belief::{
    ACCELERATION, Belief, DEAD_VOLUME, MASSES, PRESLIDING, SIZE, SPEED, STATES, STROKE,
    TURNING_DEFLECTION, TURNING_STROKE,
};
use super::chambers::Chambers;
use super::parameters::Tolerances;
use super::seals::Seals;
use crate::device::DeviceParameters;
use crate::physics::piston::PistonAreas;
use crate::stats::NORMAL_95;

/// Standard deviations to either side of the 95 % band of a sum of independent contributions, some of them even within limits.
///
/// `fourth_powers` is the sum of the fourth powers of those contributions' shares of the standard deviation: 0 gives the normal 1.960, a single
/// one with nothing else (1) 1.645 within 0.05 % of the closed form, two equal ones (0.5) 1.851 (exact 1.902). Fitted to sums of one even and one
/// normal contribution, from which it is off by less than 0.01; as JCGM 100:2008, G.2 asks where limits prevail.
pub(super) fn coverage_factor(fourth_powers: f64) -> f64 {
    NORMAL_95 - fourth_powers * (0.119 + 0.196 * fourth_powers)
}

/// Estimate after a sample.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EstimatorOutput {
    /// Contact force, positive when the tool presses [N].
    pub force: f64,
    /// Its standard deviation, tolerances of the device included [N].
    pub standard_deviation: f64,
    /// Standard deviations from the estimate to either end of the 95 % band: 1.96, less where one tolerance prevails [1].
    pub coverage_factor: f64,
    /// Absolute pressures of chambers 1 and 2 [Pa].
    pub chamber_pressures: [f64; 2],
    /// Force of the gas along extension [N].
    pub gas_force: f64,
    /// Friction that resists extension [N].
    pub friction: f64,
    /// Stroke [m].
    pub stroke: f64,
    /// Speed of extension [m/s].
    pub speed: f64,
    /// Acceleration [m/s2].
    pub acceleration: f64,
    /// Differences of stroke, acceleration and regulator pressure from their predictions over the standard deviations they should have, under
    /// the process model that was likeliest before the samples; not a number where one was missing.
    pub normalized_innovations: [f64; 3],
}

impl EstimatorOutput {
    /// Limits of the 95 % band [N].
    pub fn band(&self) -> [f64; 2] {
        let half = self.coverage_factor * self.standard_deviation;
        [self.force - half, self.force + half]
    }

    /// Standard deviation of the normal distribution that has this 95 % band [N].
    pub fn normal_deviation(&self) -> f64 {
        self.standard_deviation * self.coverage_factor / NORMAL_95
    }

    /// Whether the 95 % band covers a force [N].
    pub fn covers(&self, force: f64) -> bool {
        (force - self.force).abs() <= self.coverage_factor * self.standard_deviation
    }
}

/// Parts of the force under one belief.
#[derive(Debug, Clone, Copy)]
pub(super) struct ForceParts {
    pub(super) force: f64,
    pub(super) variance: f64,
    /// Sum of the fourth powers of what each tolerance contributes to the standard deviation [N4].
    pub(super) fourth_powers: f64,
    pub(super) pressures: [f64; 2],
    pub(super) gas: f64,
    pub(super) friction: f64,
}

/// Eq. (1) solved for the load.
#[derive(Debug, Clone)]
pub(super) struct ForceOutput {
    areas: PistonAreas,
    atmosphere: f64,
    moving_mass: f64,
    tolerances: Tolerances,
    pub(super) gravity_along_axis: f64,
}

impl ForceOutput {
    pub(super) fn new(
        device: &DeviceParameters,
        tolerances: Tolerances,
        gravity_along_axis: f64,
    ) -> Self {
        Self {
            areas: device.areas(),
            atmosphere: device.gas.atmosphere,
            moving_mass: device.moving_mass,
            tolerances,
            gravity_along_axis,
        }
    }

    /// Force and variance under a belief.
    pub(super) fn of(&self, belief: &Belief, chambers: &Chambers, seals: &Seals) -> ForceParts {
        let mean = &belief.mean;
        let stroke = mean[STROKE];
        let pressures = [0, 1].map(|i| chambers.pressure(i, mean[MASSES[i]], stroke));
        let slopes = [0, 1].map(|i| chambers.pressure_slopes(i, mean[MASSES[i]], stroke));
        let gas = self
            .areas
            .gas_force(pressures[0], pressures[1], self.atmosphere);
        let seal = seals.after(
            mean[TURNING_DEFLECTION],
            stroke - mean[TURNING_STROKE],
            mean[SPEED],
        );
        let (dry, viscous) = (seals.dry() * seal.value, seals.viscous() * mean[SPEED]);
        let free = self.gravity_along_axis - mean[ACCELERATION];
        let [a1, a2] = [self.areas.extending, -self.areas.retracting];
        let by_displacement = seals.dry() * seal.by_displacement;
        let terms = [
            (MASSES[0], a1 * slopes[0][0]),
            (MASSES[1], a2 * slopes[1][0]),
            (
                STROKE,
                a1 * slopes[0][1] + a2 * slopes[1][1] - by_displacement,
            ),
            (DEAD_VOLUME, a1 * slopes[0][2] + a2 * slopes[1][2]),
            (SPEED, -seals.viscous()),
            (ACCELERATION, -self.moving_mass),
            (TURNING_STROKE, by_displacement),
            (TURNING_DEFLECTION, -seals.dry() * seal.by_deflection),
            (PRESLIDING, -seals.dry() * seal.by_presliding),
        ];
        let alone = [
            (self.tolerances.piston_area, gas),
            (self.tolerances.dry_friction, dry),
            (self.tolerances.viscous_friction, viscous),
            (self.tolerances.moving_mass, self.moving_mass * free),
            (self.tolerances.gravity_along_axis, self.moving_mass),
        ];
        let alone = alone.map(|(limit, slope)| (Tolerances::standard(limit) * slope).powi(2));
        let carried = (STATES..SIZE).map(|parameter| {
            let variance = belief.covariance[parameter][parameter];
            let shared: f64 = terms
                .iter()
                .map(|&(element, slope)| slope * belief.covariance[element][parameter])
                .sum();
            if variance > 0.0 {
                shared * shared / variance
            } else {
                0.0
            }
        });
        let fourth_powers = carried.chain(alone).map(|square| square * square).sum();
        ForceParts {
            force: gas - dry - viscous + self.moving_mass * free,
            variance: belief.variance(&terms) + alone.iter().sum::<f64>(),
            fourth_powers,
            pressures,
            gas,
            friction: dry + viscous,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_coverage_factor_is_that_of_normal_and_of_even_contributions() {
        assert!((coverage_factor(0.0) - 1.960).abs() < 1e-3);
        // One contribution even within its limits: 95 % lie within 0.95 of them, and the standard deviation is the limit over root 3.
        assert!((coverage_factor(1.0) - 0.95 * 3.0f64.sqrt()).abs() < 1e-3);
        // Two equal ones: a triangle of half width 2 and variance 2/3 (each of limit 1), 95 % within 2 (1 - root of 0.05).
        let triangle = 2.0 * (1.0 - 0.05f64.sqrt()) / (2.0f64 / 3.0).sqrt();
        assert!((coverage_factor(0.5) - triangle).abs() < 0.06);
        // Even and normal of equal variance, by simulation of 4 million: 1.918; of 0.8 and 0.2: 1.810.
        assert!((coverage_factor(0.25) - 1.918).abs() < 0.01);
        assert!((coverage_factor(0.64) - 1.810).abs() < 0.01);
    }
}
