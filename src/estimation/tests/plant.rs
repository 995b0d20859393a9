//! A truth that the estimator does not share a line of integration with: the device on a moved surface, every equation in one Runge-Kutta step.
//!
//! ```text
//! dm_i/dt = m_dot_i,  M dv/dt = F_gas - F_seal - F_contact + M g,  dz/dt = v - |v| s z / g(v)
//! ```

use crate::device::DeviceParameters;
use crate::estimation::{EstimatorParameters, Measurement, SensorNoise, Tolerances};
use crate::physics::chamber::Chamber;
use crate::physics::gas::Gas;
use crate::physics::gas_process::GasProcess;
use crate::physics::orifice::FlowFunction;
use crate::physics::piston::PistonAreas;
use crate::physics::push_only::PushOnly;
use crate::physics::regulator::RegulatorParameters;
use crate::physics::seal_friction::SealFriction;
use crate::physics::valve::ValvePosition;
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;

/// Sampling period of every test [s].
pub const PERIOD: f64 = 1e-3;
/// Steps of the truth within a period.
const STEPS: usize = 10;
/// Where the surface stands at first [m].
const SURFACE: f64 = 0.035;

/// The device of the paper with seal friction.
pub fn device() -> DeviceParameters {
    DeviceParameters {
        cylinder_count: 2,
        bore: 0.032,
        rod: 0.012,
        full_stroke: 0.05,
        dead_volume: 2e-5,
        moving_mass: 4.0,
        supply_orifice: 2.5e-6,
        exhaust_orifice: 2e-6,
        discharge_coefficient: 0.95,
        regulator: RegulatorParameters {
            gain: 1.0,
            time_constant: 0.15,
            dead_time: 0.02,
            supply: 6e5,
            ..RegulatorParameters::default()
        },
        end_stop: PushOnly {
            stiffness: 1e6,
            damping: 2e3,
        },
        gas: Gas::default(),
        gas_process: GasProcess::Isothermal,
        hose: None,
        seal_friction: SealFriction {
            coulomb: 10.0,
            static_force: 10.0,
            stribeck_velocity: 0.01,
            viscous: 0.0,
            presliding_displacement: 5e-5,
            pressure_coefficient: 0.0,
        },
        lock_stiffness: 1e8,
        ..DeviceParameters::default()
    }
}

/// Noise that amounts to 1 N on each of pressure and acceleration, and 20 um of stroke.
pub fn noise(device: &DeviceParameters) -> SensorNoise {
    SensorNoise {
        stroke: 2e-5,
        acceleration: 1.0 / device.moving_mass,
        regulator_pressure: 1.0 / device.areas().extending,
    }
}

/// Motion in a run.
#[derive(Debug, Clone, Copy)]
pub struct Motion {
    /// Force that the outlet pressure gives at rest at the start, friction aside [N].
    pub force: f64,
    /// The same that the regulator is set to from 0.5 s on [N].
    pub later_force: f64,
    /// Distance from the surface at the start [m]; with chambers at the atmosphere when it is not touching.
    pub approach: f64,
    /// Peak to peak of the surface [m].
    pub peak_to_peak: f64,
    /// Its frequency [Hz].
    pub frequency: f64,
    /// Component of gravity along extension [m/s2].
    pub gravity: f64,
    /// Duration [s].
    pub duration: f64,
}

/// One sample of a run, with the truth.
#[derive(Debug, Clone, Copy)]
pub struct Sample {
    pub measurement: Measurement,
    pub force: f64,
    pub time: f64,
    /// Dry friction over its Coulomb level [1].
    pub friction_share: f64,
    pub pressures: [f64; 2],
}

/// Deviation of one device from its data, in shares of the tolerances: -1..=1.
#[derive(Debug, Clone, Copy)]
pub struct Deviation {
    shares: [f64; 11],
}

impl Deviation {
    pub const NONE: Self = Self { shares: [0.0; 11] };

    /// Point of Halton's sequence (1960) from 1 on, the lowest bases for the tolerances that weigh most. A device's errors hardly change during a
    /// run, so that it is covered throughout or not at all, and independent draws would need hundreds of devices.
    pub fn halton(index: usize) -> Self {
        Self {
            shares: BASES.map(|base| 2.0 * radical_inverse(index, base) - 1.0),
        }
    }

    /// The true device, and biases of pressure [Pa], acceleration [m/s2] and gravity [m/s2], relative error of pressure [1].
    fn apply(&self, data: &DeviceParameters, limits: &Tolerances) -> (DeviceParameters, [f64; 4]) {
        let s = &self.shares;
        let mut device = data.clone();
        device.moving_mass *= 1.0 + s[0] * limits.moving_mass;
        device.supply_orifice *= 1.0 + s[1] * limits.orifices;
        device.exhaust_orifice *= 1.0 + s[2] * limits.orifices;
        device.dead_volume *= 1.0 + s[3] * limits.dead_volume;
        let level = 1.0 + s[4] * limits.dry_friction;
        device.seal_friction.coulomb *= level;
        device.seal_friction.static_force *= level;
        device.seal_friction.viscous *= 1.0 + s[5] * limits.viscous_friction;
        device.seal_friction.presliding_displacement *= 1.0 + s[6] * limits.presliding_displacement;
        let biases = [
            s[7] * limits.regulator_pressure_bias,
            s[8] * limits.acceleration_bias,
            s[9] * limits.gravity_along_axis,
            s[10] * limits.regulator_pressure_scale,
        ];
        (device, biases)
    }
}

/// Bases of Halton's sequence, in the order of `Deviation::apply`.
const BASES: [usize; 11] = [17, 7, 5, 19, 2, 29, 13, 3, 23, 11, 31];

/// Digits of a number in a base, mirrored behind the point [1].
fn radical_inverse(mut index: usize, base: usize) -> f64 {
    let (mut value, mut weight) = (0.0, 1.0);
    while index > 0 {
        weight /= base as f64;
        value += weight * (index % base) as f64;
        index /= base;
    }
    value
}

/// Masses, stroke, speed, deflection.
type State = [f64; 5];

struct Plant<'a> {
    /// As the data say, and as it is.
    data: &'a DeviceParameters,
    device: DeviceParameters,
    chambers: [Chamber; 2],
    areas: PistonAreas,
    flow: FlowFunction,
    motion: Motion,
    gravity: f64,
}

impl Plant<'_> {
    fn pressures(&self, state: &State) -> [f64; 2] {
        [0, 1].map(|i| self.chambers[i].pressure(&self.device.gas, state[i], state[2]))
    }

    /// Outlet that follows its setting at 0.5 s, gauge [Pa].
    fn outlet(&self, time: f64) -> f64 {
        let weight = self.data.moving_mass * self.motion.gravity;
        let pressure = |force: f64| ((force - weight) / self.data.areas().extending).max(0.0);
        if self.motion.force == self.motion.later_force {
            return pressure(self.motion.force);
        }
        let (first, later) = (
            pressure(self.motion.force),
            pressure(self.motion.later_force),
        );
        let left = (-(time - 0.5).max(0.0) / self.device.regulator.time_constant).exp();
        later + (first - later) * left
    }

    fn contact(&self, state: &State, time: f64) -> f64 {
        let phase = std::f64::consts::TAU * self.motion.frequency * time;
        let half = 0.5 * self.motion.peak_to_peak;
        let surface = SURFACE - half * (1.0 - phase.cos());
        let speed = -half * std::f64::consts::TAU * self.motion.frequency * phase.sin();
        let depth = state[2] - surface;
        if depth > 0.0 {
            (1.5e5 * depth + 400.0 * (state[3] - speed)).max(0.0)
        } else {
            0.0
        }
    }

    fn rates(&self, state: &State, time: f64) -> State {
        let (device, gas) = (&self.device, &self.device.gas);
        let pressures = self.pressures(state);
        let valve = device.valve();
        let outlet = gas.atmosphere + self.outlet(time);
        let flow = |area, from, to| self.flow.mass_flow(area, from, to);
        let flows = [
            flow(valve.supply_conductance, outlet, pressures[0]),
            flow(valve.exhaust_conductance, gas.atmosphere, pressures[1]),
        ];
        let speed = state[3];
        let seals = &device.seal_friction;
        let push = self
            .areas
            .gas_force(pressures[0], pressures[1], gas.atmosphere);
        let resist = seals.force(state[4], speed) + self.contact(state, time);
        let bend = if seals.is_dry() {
            speed - speed.abs() * seals.stiffness() * state[4] / seals.steady(speed)
        } else {
            0.0
        };
        let acceleration = (push - resist) / device.moving_mass + self.gravity;
        [flows[0], flows[1], speed, acceleration, bend]
    }

    fn step(&self, state: &mut State, time: f64, h: f64) {
        let ahead = |k: &State, t: f64| std::array::from_fn(|i| state[i] + t * k[i]);
        let k1 = self.rates(state, time);
        let k2 = self.rates(&ahead(&k1, 0.5 * h), time + 0.5 * h);
        let k3 = self.rates(&ahead(&k2, 0.5 * h), time + 0.5 * h);
        let k4 = self.rates(&ahead(&k3, h), time + h);
        for i in 0..5 {
            state[i] += h / 6.0 * (k1[i] + 2.0 * (k2[i] + k3[i]) + k4[i]);
        }
    }
}

/// Normal deviate by the central limit of 12 (variance 1, limits at 6).
fn normal(generator: &mut ChaCha8Rng) -> f64 {
    (0..12)
        .map(|_| generator.random_range(0.0..1.0))
        .sum::<f64>()
        - 6.0
}

/// Runs the truth and samples it with noise.
pub fn run(
    data: &DeviceParameters,
    parameters: &EstimatorParameters,
    deviation: &Deviation,
    motion: &Motion,
    seed: u64,
) -> Vec<Sample> {
    let (device, [pressure_bias, acceleration_bias, tilt, scale]) =
        deviation.apply(data, &parameters.tolerances);
    let mut generator = ChaCha8Rng::seed_from_u64(seed);
    let gas = device.gas;
    let chambers = device.chambers();
    let plant = Plant {
        data,
        chambers,
        areas: device.areas(),
        flow: FlowFunction::new(&gas),
        gravity: motion.gravity + tilt,
        device,
        motion: *motion,
    };
    let outlet = plant.outlet(0.0);
    let stroke = if motion.approach > 0.0 {
        SURFACE - motion.approach
    } else {
        let weight = plant.device.moving_mass * plant.gravity;
        SURFACE + (outlet * plant.device.areas().extending + weight) / 1.5e5
    };
    let mut state = [
        gas.mass(gas.atmosphere + outlet, chambers[0].volume(stroke)),
        gas.mass(gas.atmosphere, chambers[1].volume(stroke)),
        stroke,
        0.0,
        0.0,
    ];
    let noise = &parameters.noise;
    let samples = (motion.duration / PERIOD).round() as usize;
    (0..samples)
        .map(|sample| {
            let time = sample as f64 * PERIOD;
            let mut noisy = |value: f64, sd: f64| value + sd * normal(&mut generator);
            let acceleration = plant.rates(&state, time)[3];
            let measurement = Measurement {
                stroke: noisy(state[2], noise.stroke),
                acceleration: noisy(acceleration + acceleration_bias, noise.acceleration),
                regulator_pressure: noisy(
                    plant.outlet(time) * (1.0 + scale) + pressure_bias,
                    noise.regulator_pressure,
                ),
                valve: ValvePosition::Extend,
            };
            let seals = &plant.device.seal_friction;
            let result = Sample {
                measurement,
                force: plant.contact(&state, time),
                time,
                friction_share: if seals.is_dry() {
                    seals.force(state[4], 0.0) / seals.coulomb
                } else {
                    state[3].signum()
                },
                pressures: plant.pressures(&state),
            };
            let h = PERIOD / STEPS as f64;
            for i in 0..STEPS {
                plant.step(&mut state, time + h * i as f64, h);
            }
            result
        })
        .collect()
}
