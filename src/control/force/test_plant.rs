//! A device on a moved surface for the controllers' tests, with sensors that may be real.

use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;

use super::{ForceController, ForceObservation};
use crate::device::{Device, DeviceParameters, DeviceState, Load, PistonMotion};
use crate::physics::gas::Gas;
use crate::physics::gas_process::GasProcess;
use crate::physics::push_only::PushOnly;
use crate::physics::regulator::RegulatorParameters;
use crate::physics::seal_friction::SealFriction;

/// The contact of the bench's load cell.
pub const CONTACT: PushOnly = PushOnly {
    stiffness: 1.5e5,
    damping: 400.0,
};

/// The default device with a Coulomb friction [N].
pub fn device(coulomb: f64) -> DeviceParameters {
    DeviceParameters {
        cylinder_count: 2,
        bore: 0.032,
        rod: 0.012,
        full_stroke: 0.05,
        dead_volume: 20e-6,
        moving_mass: 4.0,
        supply_orifice: 2.5e-6,
        exhaust_orifice: 2.0e-6,
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
        seal_friction: SealFriction {
            coulomb,
            static_force: coulomb,
            ..SealFriction::NONE
        },
        gas: Gas::default(),
        gas_process: GasProcess::Isothermal,
        hose: None,
        lock_stiffness: 1e8,
        ..DeviceParameters::default()
    }
}

/// A surface that stands at a stroke and moves to and fro from a time on: x_s = x_0 - pp/2 (1 - cos(w (t - t_0))).
#[derive(Debug, Clone, Copy)]
pub struct Surface {
    /// Stroke at which it is met [m].
    pub position: f64,
    /// Peak to peak [m].
    pub peak_to_peak: f64,
    /// Frequency [Hz].
    pub frequency: f64,
    /// When it starts [s].
    pub start: f64,
}

impl Surface {
    fn motion(&self, time: f64) -> (f64, f64) {
        let w = std::f64::consts::TAU * self.frequency;
        let phase = w * (time - self.start).max(0.0);
        let half = 0.5 * self.peak_to_peak;
        (
            self.position - half * (1.0 - phase.cos()),
            -half * w * phase.sin(),
        )
    }
}

/// Loads on the piston during a period that began at `time`.
struct SurfaceLoad {
    surface: Surface,
    time: f64,
}

impl SurfaceLoad {
    /// Penetration [m] and its rate [m/s] into a surface at a place that moves.
    fn penetration((position, speed): (f64, f64), motion: PistonMotion) -> (f64, f64) {
        (motion.stroke - position, motion.speed - speed)
    }
}

impl Load for SurfaceLoad {
    type Now = (f64, f64);

    fn now(&self, time: f64) -> Self::Now {
        self.surface.motion(self.time + time)
    }

    fn force(&self, now: &Self::Now, motion: PistonMotion, touching: bool) -> f64 {
        let (penetration, rate) = Self::penetration(*now, motion);
        if touching {
            -CONTACT.linear(penetration, rate)
        } else {
            0.0
        }
    }

    fn touches(&self, now: &Self::Now, motion: PistonMotion) -> bool {
        let (penetration, rate) = Self::penetration(*now, motion);
        CONTACT.pushes(penetration, rate)
    }

    fn rate(&self) -> f64 {
        200.0
    }
}

/// Errors of the sensors.
#[derive(Debug, Clone, Copy)]
pub struct Sensors {
    /// Standard deviation of the load cell's noise [N].
    pub force_noise: f64,
    /// Step of the stroke [m]; 0 for none.
    pub stroke_step: f64,
    /// Step of the regulator's actual value [Pa]; 0 for none.
    pub pressure_step: f64,
    /// Standard deviation of the accelerometer's noise [m/s2].
    pub acceleration_noise: f64,
    /// Bias of the accelerometer [m/s2].
    pub acceleration_bias: f64,
}

impl Sensors {
    /// Without errors.
    pub const IDEAL: Self = Self {
        force_noise: 0.0,
        stroke_step: 0.0,
        pressure_step: 0.0,
        acceleration_noise: 0.0,
        acceleration_bias: 0.0,
    };
    /// 1 N of noise, 20 um of stroke, an accelerometer of 5 mg noise and 20 mg bias.
    pub const REAL: Self = Self {
        force_noise: 1.0,
        stroke_step: 2e-5,
        pressure_step: 0.0,
        acceleration_noise: 0.05,
        acceleration_bias: 0.2,
    };
}

/// A sample at the end of a control period.
#[derive(Debug, Clone, Copy)]
pub struct Sample {
    /// Time [s].
    pub time: f64,
    /// True contact force, mean over the period [N].
    pub force: f64,
}

/// Piston, device and sensors.
pub struct Bench {
    device: Device,
    state: DeviceState,
    motion: PistonMotion,
    surface: Surface,
    sensors: Sensors,
    random: ChaCha8Rng,
    period: f64,
    steps: usize,
    force: f64,
    acceleration: f64,
}

impl Bench {
    /// At rest on the surface with a force [N].
    pub fn new(
        device: &DeviceParameters,
        surface: Surface,
        sensors: Sensors,
        period: f64,
        force: f64,
    ) -> Self {
        let device = Device::new(device.clone());
        let stroke = surface.position + force / CONTACT.stiffness;
        let area = device.parameters().areas().extending;
        let gain = device.parameters().regulator.gain;
        Self {
            state: device.at_rest(stroke, force / (area * gain)),
            motion: PistonMotion { stroke, speed: 0.0 },
            device,
            surface,
            sensors,
            random: ChaCha8Rng::seed_from_u64(7),
            period,
            steps: 0,
            force,
            acceleration: 0.0,
        }
    }

    /// Puts the piston back from the surface by a gap [m], at rest.
    pub fn draw_back(&mut self, gap: f64) {
        self.motion.stroke = self.surface.position - gap;
        self.force = 0.0;
    }

    /// Absolute pressures in the chambers [Pa], in truth.
    pub fn pressures(&self) -> [f64; 2] {
        self.device.pressures(&self.state, self.motion.stroke)
    }

    /// Normal with unit standard deviation (sum of twelve).
    fn normal(&mut self) -> f64 {
        (0..12).map(|_| self.random.random::<f64>()).sum::<f64>() - 6.0
    }

    /// Measurements of the controller.
    pub fn observe(&mut self, desired: f64) -> ForceObservation {
        let sensors = self.sensors;
        let stepped = |value: f64, step: f64| {
            if step > 0.0 {
                (value / step).round() * step
            } else {
                value
            }
        };
        ForceObservation {
            time: self.steps as f64 * self.period,
            desired_axial_force: desired,
            gravity_along_axis: 0.0,
            measured_axial_force: self.force + sensors.force_noise * self.normal(),
            stroke: stepped(self.motion.stroke, sensors.stroke_step),
            acceleration: self.acceleration
                + sensors.acceleration_bias
                + sensors.acceleration_noise * self.normal(),
            regulator_pressure: stepped(self.state.regulator.outlet, sensors.pressure_step),
        }
    }

    /// One control period.
    pub fn step(&mut self, set_pressure: f64) -> Sample {
        let pieces = (2e3 * self.period).ceil() as i32;
        let dt = self.period / f64::from(pieces);
        let before = self.motion.speed;
        let pressed = |load: &SurfaceLoad, time: f64, motion: PistonMotion| {
            let now = load.now(time);
            -load.force(&now, motion, load.touches(&now, motion))
        };
        let mut sum = 0.0;
        for i in 0..pieces {
            let load = SurfaceLoad {
                surface: self.surface,
                time: self.steps as f64 * self.period + f64::from(i) * dt,
            };
            sum += 0.5 * pressed(&load, 0.0, self.motion);
            self.device.advance_loaded::<_, false>(
                &mut self.state,
                &mut self.motion,
                set_pressure,
                &load,
                dt,
                1,
            );
            sum += 0.5 * pressed(&load, dt, self.motion);
        }
        self.force = sum / f64::from(pieces);
        self.acceleration = (self.motion.speed - before) / self.period;
        self.steps += 1;
        Sample {
            time: self.steps as f64 * self.period,
            force: self.force,
        }
    }

    /// Runs a controller for a time [s] with a desired force [N] of the time.
    pub fn run(
        &mut self,
        controller: &mut ForceController,
        duration: f64,
        desired: impl Fn(f64) -> f64,
    ) -> Vec<Sample> {
        (0..(duration / self.period).round() as usize)
            .map(|_| {
                let wanted = desired(self.steps as f64 * self.period);
                let observation = self.observe(wanted);
                let set_pressure = controller.set_pressure(&observation);
                self.step(set_pressure)
            })
            .collect()
    }
}
