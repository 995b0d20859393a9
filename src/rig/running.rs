//! The step of a bench, whoever says what loads it: device and piston under a load, then the sensors. A bench's scenario drives it, and so does an FMU.

use super::error::RigError;
use super::sample::RigTruth;
use crate::device::{Device, PistonMotion};
use crate::physics::valve::ValvePosition;
use crate::plant::{
    Actual, Moment, PausedDevice, PistonLoad, PlantParameters, Port, RunningDevice, RunningSensors,
    SensorReadings,
};
use crate::sensing::{Readings, SensingParameters, SensorChain, Truth};

/// A rig that runs.
#[derive(Debug, Clone)]
pub struct RunningRig<'a> {
    pub(super) actual: &'a Actual<PlantParameters>,
    pub(super) device: RunningDevice<'a>,
    gauges: Gauges,
}

/// What a rig has beside its device.
#[derive(Debug, Clone)]
struct Gauges {
    /// Errors of the sensors.
    errors: RunningSensors,
    sensors: SensorChain,
    readings: Readings,
    /// Set pressure of the last step [Pa gauge].
    applied: f64,
}

/// A rig that has stopped between two steps: what it needs to go on, apart from its description.
#[derive(Debug, Clone)]
pub struct PausedRig {
    device: PausedDevice,
    gauges: Gauges,
}

impl<'a> RunningRig<'a> {
    /// The rig at rest, both chambers and the regulator's outlet at the atmosphere, at a stroke [m], or on the inner stop where that is 0.
    pub fn new(
        actual: &'a Actual<PlantParameters>,
        start_stroke: f64,
        (sensing, seed): (&SensingParameters, u64),
    ) -> Self {
        let parameters = &actual.device;
        let weight = parameters.moving_mass * actual.gravity_along_extension;
        let stroke = if start_stroke == 0.0 {
            weight.min(0.0) / parameters.end_stop.stiffness
        } else {
            start_stroke
        };
        let motion = PistonMotion { stroke, speed: 0.0 };
        let device = Device::new(parameters);
        let at_rest = device.at_rest(stroke, 0.0);
        Self {
            actual,
            device: RunningDevice::new(actual, device, (motion, at_rest)),
            gauges: Gauges {
                errors: RunningSensors::new(actual.sensors),
                sensors: SensorChain::new(sensing, seed),
                readings: Readings::default(),
                applied: 0.0,
            },
        }
    }

    /// One that goes on, by a description that may have changed meanwhile.
    pub fn resumed(actual: &'a Actual<PlantParameters>, paused: PausedRig) -> Self {
        let mut gauges = paused.gauges;
        gauges.errors.set_errors(actual.sensors);
        Self {
            actual,
            device: RunningDevice::resumed(actual, paused.device),
            gauges,
        }
    }

    /// What it needs to go on.
    pub fn pause(self) -> PausedRig {
        PausedRig {
            device: self.device.pause(),
            gauges: self.gauges,
        }
    }

    /// Commands the 5/2 valve.
    pub fn switch(&mut self, valve: ValvePosition) {
        self.device.state.valve = valve;
    }

    /// Set pressure of the last step [Pa gauge].
    pub fn applied(&self) -> f64 {
        self.gauges.applied
    }

    /// Readings of the sensors.
    pub fn readings(&self) -> &Readings {
        &self.gauges.readings
    }

    /// Absolute pressures in chambers 1 and 2 [Pa].
    pub fn pressures(&self) -> [f64; 2] {
        let device = &self.device;
        (device.device).pressures(&device.state, device.motion.stroke)
    }

    /// Forces along extension: of the device on its moving part, seals included, and of the seals alone [N].
    pub fn device_forces(&self) -> [f64; 2] {
        let RunningDevice {
            device,
            state,
            motion,
            ..
        } = &self.device;
        let seal = device.seal_force(state, motion.speed);
        [device.gas_force(state, motion.stroke) + seal, seal]
    }

    /// One step under a load, at a set pressure that is wanted [Pa gauge], of a length [s] in at least so many sub-steps.
    pub fn step(&mut self, wanted: f64, mut load: PistonLoad<'a>, cut: (f64, usize)) {
        let length = cut.0;
        let Gauges {
            sensors, applied, ..
        } = &mut self.gauges;
        *applied = sensors.command(wanted, length);
        let moment = self.meet_terms(&mut load);
        self.device.face_terms(&mut load, moment.as_ref(), length);
        self.device.advance::<true>(&load, self.gauges.applied, cut);
        self.device.note_flow(length);
    }

    /// Puts on a load what the terms do to it now; gives the moment that they are of.
    fn meet_terms(&self, load: &mut PistonLoad<'a>) -> Option<Moment> {
        let surface = load.surface();
        (self.device).meet_terms(load, self.gauges.applied, surface)
    }

    /// True state of the rig at a time [s] under a load.
    pub fn truth(&self, time: f64, mut load: PistonLoad<'a>) -> RigTruth {
        let moment = self.meet_terms(&mut load);
        self.truth_under(time, &load, moment.as_ref())
    }

    fn truth_under(&self, time: f64, load: &PistonLoad<'_>, moment: Option<&Moment>) -> RigTruth {
        let (plant, device, motion) = (self.actual, &self.device.device, self.device.motion);
        let force = device.piston_force(&self.device.state, motion);
        let contact_force = load.contact_force(0.0, motion);
        let added_outlet = moment.map_or(0.0, |now| plant.term(Port::OutletPressure, now));
        let outside = load.axial.at(0.0) + load.term_force(0.0, motion);
        RigTruth {
            time,
            motion,
            acceleration: (force + outside - contact_force) / device.parameters().moving_mass,
            contact_force,
            regulator_pressure: self.device.state.regulator.outlet + added_outlet,
        }
    }

    /// Lets the sensors read at a time [s], later than the last, under a load; gives what they read of.
    pub fn read(&mut self, time: f64, mut load: PistonLoad<'a>) -> RigTruth {
        let moment = self.meet_terms(&mut load);
        let truth = self.truth_under(time, &load, moment.as_ref());
        let there = SensorReadings {
            force: truth.contact_force,
            stroke: truth.motion.stroke,
            regulator_pressure: truth.regulator_pressure,
        };
        let gauges = &mut self.gauges;
        let mut read = gauges.errors.read(time, &there, truth.acceleration);
        if let Some(moment) = moment {
            read.add(self.actual.reading_terms(&Moment {
                contact_force: truth.contact_force,
                ..moment
            }));
        }
        gauges.readings = gauges.sensors.measure(
            time,
            &Truth {
                force: read.force,
                stroke: read.stroke,
                acceleration: truth.acceleration,
                regulator_pressure: read.regulator_pressure,
            },
        );
        truth
    }

    /// Whether the numbers at a time [s] are still those of a device.
    ///
    /// # Errors
    /// The one that is not.
    pub fn check(&self, time: f64) -> Result<(), RigError> {
        let air = &self.device.state.air;
        let named = [
            ("the air in chamber 1 [kg]", air.masses[0]),
            ("the air in chamber 2 [kg]", air.masses[1]),
        ];
        let bad = named
            .into_iter()
            .find(|(_, mass)| !mass.is_finite() || *mass <= 0.0)
            .or_else(|| {
                let stroke = self.device.motion.stroke;
                (!stroke.is_finite()).then_some(("the stroke [m]", stroke))
            });
        match bad {
            None => Ok(()),
            Some((quantity, value)) => Err(RigError::NotFinite {
                time,
                quantity,
                value,
            }),
        }
    }
}
