//! Stability of the loops, checked before a controller is built.
//!
//! **Force loop** (PI, integral of the feedback linearisation): L = C(e^(jwT)) G(jw) with G of `loop_response`; stable if |L| < 1 wherever it turns by
//! 180 degrees (Nyquist; L has no poles in the right half plane and falls off).
//!
//! **Outlet's loop** (lead after the dead time, `regulator_model`): with the model exact its only pole is e^(-T/T_r), always stable. With a regulator P
//! that differs from the model P_m it is stable as far as what the model misses comes back small (Normey-Rico and Camacho 2007, ch. 6):
//!
//! ```text
//! M = T_0 (P / P_m - 1),   T_0 = n a^N (1 - a) z^(-N) / (z - e^(-T/T_r)),   n = (1 - e^(-T/T_r)) / (1 - a) - 1,   a = e^(-T/tau)
//! ```
//!
//! N periods of dead time; |M| < 1 wherever it turns by 180 degrees, for a time constant 20 % off either way and up to one period more dead time.

use nalgebra::Complex;

use super::loop_response::{LinearPlant, PhaseCrossover, phase_crossover};
use super::{ControllerError, StabilityLimit};
use crate::physics::regulator::RegulatorParameters;

/// Share by which the regulator's time constant may be off [1].
const TIME_CONSTANT_OFF: f64 = 0.2;
/// Response time, over the period, from which the search for the smallest stable one starts; below it a sampled lead does not change any more.
const SHORTEST: f64 = 0.05;

/// Gains of a force loop: proportional [1] and integral [1/s].
#[derive(Debug, Clone, Copy)]
pub(super) struct LoopGains {
    pub proportional: f64,
    pub integral: f64,
}

impl LoopGains {
    /// Refuses gains that make the loop unstable; the limit is that of `key` with the other gain in proportion.
    pub(super) fn check(
        &self,
        plant: &LinearPlant,
        period: f64,
        key: &'static str,
        value: f64,
    ) -> Result<(), ControllerError> {
        match self.crossover(plant, period) {
            Some(PhaseCrossover { frequency, gain }) if gain >= 1.0 => {
                Err(ControllerError::Unstable {
                    key,
                    value,
                    frequency,
                    gain,
                    assumption: "",
                    limit: StabilityLimit::AtMost(value / gain),
                })
            }
            _ => Ok(()),
        }
    }

    pub(super) fn crossover(&self, plant: &LinearPlant, period: f64) -> Option<PhaseCrossover> {
        let one = Complex::new(1.0, 0.0);
        let response = |frequency: f64| {
            let sum = one / (one - one / plant.shift(frequency));
            let controller = sum * (self.integral * period) + self.proportional;
            controller * plant.response(frequency)
        };
        phase_crossover(response, plant.highest())
    }
}

/// Refuses a response time [s] of the lead that is too short for the regulator being a little other than its model.
///
/// `value_of` turns a response time into the value of the parameter `key` for the message.
pub(super) fn check_response_time(
    regulator: &RegulatorParameters,
    response_time: f64,
    period: f64,
    key: &'static str,
    value_of: impl Fn(f64) -> StabilityLimit,
) -> Result<(), ControllerError> {
    let worst = |time: f64| worst_miss(regulator, time, period);
    let Some(PhaseCrossover { frequency, gain }) = worst(response_time).filter(|w| w.gain >= 1.0)
    else {
        return Ok(());
    };
    let (mut unstable, mut stable) = (SHORTEST * period, 2.0 * regulator.time_constant);
    for _ in 0..40 {
        let middle = (unstable * stable).sqrt();
        if worst(middle).is_some_and(|w| w.gain >= 1.0) {
            unstable = middle;
        } else {
            stable = middle;
        }
    }
    let value = match value_of(response_time) {
        StabilityLimit::AtMost(value) | StabilityLimit::AtLeast(value) => value,
    };
    Err(ControllerError::Unstable {
        key,
        value,
        frequency,
        gain,
        assumption: " if the regulator's time constant is 20 % off and its dead time a period longer",
        limit: value_of(stable),
    })
}

/// The worst of what the model may miss.
fn worst_miss(
    regulator: &RegulatorParameters,
    response_time: f64,
    period: f64,
) -> Option<PhaseCrossover> {
    let mut worst: Option<PhaseCrossover> = None;
    for factor in [1.0 - TIME_CONSTANT_OFF, 1.0 + TIME_CONSTANT_OFF] {
        for late in [0, 1] {
            let found = phase_crossover(
                |w| missed(regulator, response_time, period, factor, late, w),
                std::f64::consts::PI / period,
            );
            if found.map_or(0.0, |f| f.gain) > worst.map_or(0.0, |w| w.gain) {
                worst = found;
            }
        }
    }
    worst
}

/// M at a frequency [rad/s], for a time constant of `factor` times the model's and `late` periods more dead time.
fn missed(
    regulator: &RegulatorParameters,
    response_time: f64,
    period: f64,
    factor: f64,
    late: i32,
    frequency: f64,
) -> Complex<f64> {
    let z = Complex::new(0.0, frequency * period).exp();
    let a = (-period / regulator.time_constant).exp();
    let true_a = (-period / (factor * regulator.time_constant)).exp();
    let pole = (-period / response_time).exp();
    let n = (1.0 - pole) / (1.0 - a) - 1.0;
    let periods = (regulator.dead_time / period).round() as i32;
    let nominal = z.powi(-periods) * (n * a.powi(periods) * (1.0 - a)) / (z - pole);
    let ratio = (z - a) * ((1.0 - true_a) / (1.0 - a)) / (z - true_a) * z.powi(-late);
    nominal * (ratio - 1.0)
}

#[cfg(test)]
mod tests;
