//! Frequency response of what a controller acts on, linear about rest on a contact, and where a loop turns by 180 degrees.
//!
//! ```text
//! regulator   e^(-theta s) / (tau s + 1)
//! sampling    ((1 - e^(-s T)) / (s T))^2:   a set pressure held over a period, a force that is the mean over one: one period of delay in all
//! chamber     p_1 = H p - Z rho A_1 v,   Z = 1 / (s C_1 + Y),   1/Y = 1/G + 1/(s C_h + 1/R_h),   H = Y Z / (1 + s C_h R_h);   C = V / (R T)
//! contact     F = (c s + k) / (M s^2 + c s + k + s B) A_1 H p,   B = rho (A_1^2 Z_1 + A_2^2 Z_2)
//! ```
//!
//! G the orifice's laminar conductance, its largest [kg/(s Pa)]; large motions see a smaller one and a slower chamber. C_h and R_h the line's capacity and
//! resistance, if there is one. Taken at full stroke, where chamber 1 is slowest, and with the atmosphere's density, where the air damps least.
//! Seal friction, which only takes from the loop's gain, is left out.

use nalgebra::Complex;

use crate::device::DeviceParameters;
use crate::physics::orifice::FlowFunction;
use crate::physics::push_only::PushOnly;

/// Frequencies looked at for each factor of ten.
const PER_DECADE: usize = 400;
/// Lowest frequency over the highest [1].
const RANGE: f64 = 1e-5;
/// Halvings to a crossover.
const HALVINGS: usize = 50;

/// Where a loop turns by 180 degrees.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct PhaseCrossover {
    /// Frequency [rad/s].
    pub frequency: f64,
    /// Gain [1].
    pub gain: f64,
}

/// Of all frequencies up to `highest` [rad/s] at which the loop is real and negative, the one with the largest gain.
pub(super) fn phase_crossover(
    response: impl Fn(f64) -> Complex<f64>,
    highest: f64,
) -> Option<PhaseCrossover> {
    let count = (-RANGE.log10() * PER_DECADE as f64) as i32;
    let frequency = |i: i32| highest * RANGE.powf(1.0 - f64::from(i) / f64::from(count));
    let mut worst: Option<PhaseCrossover> = None;
    let mut take = |frequency: f64| {
        let gain = -response(frequency).re;
        if gain > worst.map_or(0.0, |w| w.gain) {
            worst = Some(PhaseCrossover { frequency, gain });
        }
    };
    for i in 0..count {
        let (mut low, mut high) = (frequency(i), frequency(i + 1));
        let rising = response(high).im > 0.0;
        if (response(low).im > 0.0) == rising {
            continue;
        }
        for _ in 0..HALVINGS {
            let middle = 0.5 * (low + high);
            if (response(middle).im > 0.0) == rising {
                high = middle;
            } else {
                low = middle;
            }
        }
        take(high);
    }
    // At half the sampling frequency every sampled loop is real.
    take(highest);
    worst
}

/// Small motions of regulator, chambers and tool about rest.
#[derive(Debug, Clone)]
pub(super) struct LinearPlant {
    time_constant: f64,
    dead_time: f64,
    period: f64,
    conductances: [f64; 2],
    capacities: [f64; 2],
    areas: [f64; 2],
    /// Capacity [kg/Pa] and resistance [Pa s/kg] of the line.
    line: Option<[f64; 2]>,
    mass: f64,
    density: f64,
    contact: PushOnly,
}

impl LinearPlant {
    pub(super) fn new(device: &DeviceParameters, contact: PushOnly, period: f64) -> Self {
        let gas = &device.gas;
        let rt = gas.specific_gas_constant * gas.temperature;
        let (flow, valve, areas) = (FlowFunction::new(gas), device.valve(), device.areas());
        let step = 1e-4 * gas.atmosphere;
        let conductance = |area| flow.mass_flow(area, gas.atmosphere + step, gas.atmosphere) / step;
        Self {
            time_constant: device.regulator.time_constant,
            dead_time: device.regulator.dead_time,
            period,
            conductances: [valve.supply_conductance, valve.exhaust_conductance].map(conductance),
            capacities: device
                .chambers()
                .map(|chamber| chamber.volume(device.full_stroke) / rt),
            areas: [areas.extending, areas.retracting],
            line: device
                .hose
                .map(|hose| [hose.volume / rt, hose.resistance_at_rest(gas.atmosphere)]),
            mass: device.moving_mass,
            density: gas.atmosphere / rt,
            contact,
        }
    }

    /// The part of it that remains when a controller's model carries the lags of regulator, line and chambers: the dead time and the contact.
    pub(super) fn without_lags(self) -> Self {
        Self {
            time_constant: 0.0,
            capacities: [0.0; 2],
            line: None,
            ..self
        }
    }

    /// Half the sampling frequency [rad/s].
    pub(super) fn highest(&self) -> f64 {
        std::f64::consts::PI / self.period
    }

    /// e^(jwT).
    pub(super) fn shift(&self, frequency: f64) -> Complex<f64> {
        Complex::new(0.0, frequency * self.period).exp()
    }

    /// Time constant of chamber and line together, about [s].
    pub(super) fn chamber_time(&self) -> f64 {
        let line = self.line.map_or(0.0, |[capacity, resistance]| {
            resistance * (capacity + self.capacities[0])
        });
        self.capacities[0] / self.conductances[0] + line
    }

    /// Measured contact force over the force that a set pressure stands for [1].
    pub(super) fn response(&self, frequency: f64) -> Complex<f64> {
        let s = Complex::new(0.0, frequency);
        let one = Complex::new(1.0, 0.0);
        let sampling = (one - (-s * self.period).exp()) / (s * self.period);
        let regulator = (-s * self.dead_time).exp() / (s * self.time_constant + one);
        let mut supply = one / self.conductances[0];
        let mut line_share = one;
        if let Some([capacity, resistance]) = self.line {
            supply += one / (s * capacity + one / resistance);
            line_share = one / (one + s * capacity * resistance);
        }
        let admittance = one / supply;
        let impedances = [
            one / (s * self.capacities[0] + admittance),
            one / (s * self.capacities[1] + self.conductances[1]),
        ];
        let passed = admittance * impedances[0] * line_share;
        let air_damping = (impedances[0] * self.areas[0].powi(2)
            + impedances[1] * self.areas[1].powi(2))
            * self.density;
        let contact = s * self.contact.damping + self.contact.stiffness;
        let mechanics = contact / (s * s * self.mass + contact + s * air_damping);
        sampling * sampling * regulator * passed * mechanics
    }
}

#[cfg(test)]
mod tests {
    use super::super::test_plant::{Bench, CONTACT, Sensors, Surface, device};
    use super::*;

    #[test]
    fn the_crossover_of_a_lag_with_dead_time_is_the_textbooks() {
        // Pure dead time and integrator: -90 degrees and w theta: crosses at pi / (2 theta) with k theta 2 / pi.
        let (k, theta) = (10.0, 0.05);
        let found = phase_crossover(
            |w| Complex::new(0.0, -w * theta).exp() * k / Complex::new(0.0, w),
            1e3,
        )
        .unwrap();
        let expected = std::f64::consts::FRAC_PI_2 / theta;
        assert!((found.frequency / expected - 1.0).abs() < 1e-9);
        assert!((found.gain - k / expected).abs() < 1e-9);
    }

    #[test]
    fn the_response_is_the_devices() {
        let device = device(0.0);
        let period = 1e-3;
        let surface = Surface {
            position: 0.0485,
            peak_to_peak: 0.0,
            frequency: 1.0,
            start: 0.0,
        };
        let plant = LinearPlant::new(&device, CONTACT, period);
        let area = device.areas().extending;
        // Amplitudes that keep the valve laminar; whole turns in a second.
        for (turns, amplitude) in [(2.0, 0.3), (10.0, 0.3), (20.0, 0.3), (30.0, 0.3)] {
            let mut bench = Bench::new(&device, surface, Sensors::IDEAL, period, 150.0);
            let w = std::f64::consts::TAU * turns;
            let mut sum = Complex::new(0.0, 0.0);
            for i in 0..3000 {
                let time = f64::from(i) * period;
                let sample = bench.step((150.0 + amplitude * (w * time).sin()) / area);
                if i >= 2000 {
                    let turned = Complex::new(0.0, -w * sample.time).exp();
                    sum += turned * (sample.force - 150.0) * (2.0 * period / amplitude);
                }
            }
            // Of a sine: j times the amplitude.
            let measured = sum * Complex::new(0.0, 1.0);
            let expected = plant.response(w);
            let off = (measured - expected).norm() / expected.norm();
            assert!(off < 0.05, "{turns}: {measured} {expected}");
        }
    }
}
