//! One step of the bench rig, read from top to bottom.

use std::path::Path;

use super::error::RigError;
use super::estimator::RigEstimator;
use super::load::load_at;
use super::sample::{RigLog, RigSample, RigTruth};
use crate::control::force::{ForceController, ForceObservation, Pressing};
use crate::control::observed::Observed;
use crate::device::{Device, DeviceState, PistonMotion};
use crate::effects::actual;
use crate::physics::valve::ValvePosition;
use crate::plant::{
    Actual, Moment, PistonLoad, PlantParameters, Port, RunningDevice, RunningSensors,
    SensorReadings,
};
use crate::recording::{Recording, RecordingError};
use crate::scenario::bench::{BenchScenario, CommandScenario, LoadScenario};
use crate::scenario::{ScenarioError, load_bench};
use crate::sensing::{Readings, SensorChain, Truth};

/// A bench rig with its job: all that does not change during a run.
#[derive(Debug, Clone)]
pub struct Rig {
    /// The job, with the rig as it is stated.
    pub scenario: BenchScenario,
    /// Controller that answers forces with set pressures, as it is at the start.
    pub controller: ForceController,
    /// The rig's physics as it is.
    pub actual: Actual<PlantParameters>,
}

impl Rig {
    /// Reads a scenario file and makes the bench that it describes.
    ///
    /// # Errors
    /// Those of the file, and of [`Rig::new`].
    pub fn load(path: &Path) -> Result<Self, ScenarioError> {
        Self::new(load_bench(path)?)
    }

    /// Sets up a rig.
    ///
    /// # Errors
    /// A controller whose loop would be unstable.
    pub fn new(scenario: BenchScenario) -> Result<Self, ScenarioError> {
        let largest = match &scenario.command {
            CommandScenario::Force(steps) => steps.iter().map(|step| step.1).fold(0.0, f64::max),
            CommandScenario::SetPressure(_) => 0.0,
        };
        let pressing = (scenario.load != LoadScenario::Free).then_some(Pressing {
            force: largest,
            share: 1.0,
        });
        let controller = ForceController::of_scenario(
            &scenario.controller,
            &scenario.nominal,
            &scenario.sensing,
            pressing,
            scenario.step,
        )?;
        Ok(Self {
            actual: actual(&scenario.nominal, &scenario.effects),
            scenario,
            controller,
        })
    }

    /// Simulates the whole job; `observer` is shown the simulation after every step.
    ///
    /// # Errors
    /// Nothing could be recorded.
    pub fn run(
        &self,
        observer: &mut dyn FnMut(&RigSimulation<'_>),
    ) -> Result<(Recording, Option<RigError>), RecordingError> {
        let mut simulation = RigSimulation::new(self);
        let mut stop = None;
        while !simulation.done() && stop.is_none() {
            stop = simulation.step().err();
            observer(&simulation);
        }
        Ok((simulation.into_recording()?, stop))
    }
}

/// A running bench rig.
pub struct RigSimulation<'a> {
    rig: &'a Rig,
    device: RunningDevice<'a>,
    controller: ForceController,
    /// Set pressure that the controller gave last, held until its next period [Pa gauge].
    answer: f64,
    /// Errors of the sensors.
    errors: RunningSensors,
    sensors: SensorChain,
    readings: Readings,
    /// True state at the last sample.
    truth: RigTruth,
    estimator: Option<RigEstimator>,
    /// Set pressure of the last step [Pa gauge].
    applied: f64,
    steps: usize,
    total_steps: usize,
    log: RigLog,
}

/// The last value whose time has come.
fn held<T: Copy>(steps: &[(f64, T)], time: f64) -> Option<T> {
    // A step that begins within rounding of a command's time takes the command.
    let due = steps.partition_point(|(at, _)| *at <= time + 1e-9);
    due.checked_sub(1).map(|last| steps[last].1)
}

impl<'a> RigSimulation<'a> {
    /// The rig at rest, both chambers and the regulator's outlet at the atmosphere.
    pub fn new(rig: &'a Rig) -> Self {
        let (scenario, actual) = (&rig.scenario, &rig.actual);
        let parameters = &actual.device;
        let weight = parameters.moving_mass * actual.gravity_along_extension;
        let stroke = if scenario.start_stroke == 0.0 {
            weight.min(0.0) / parameters.end_stop.stiffness
        } else {
            scenario.start_stroke
        };
        let motion = PistonMotion { stroke, speed: 0.0 };
        let device = Device::new(parameters);
        let at_rest = device.at_rest(stroke, 0.0);
        let total_steps = (scenario.duration / scenario.step - 1e-9).ceil() as usize;
        let mut simulation = Self {
            rig,
            device: RunningDevice::new(actual, device, (motion, at_rest)),
            controller: rig.controller.clone(),
            answer: 0.0,
            errors: RunningSensors::new(actual.sensors),
            sensors: SensorChain::new(&scenario.sensing, scenario.seed),
            readings: Readings::default(),
            truth: RigTruth::default(),
            estimator: scenario.estimator.as_ref().map(RigEstimator::new),
            applied: 0.0,
            steps: 0,
            total_steps,
            log: RigLog::new(total_steps + 1),
        };
        simulation.device.state.valve = held(&scenario.valve, 0.0).unwrap_or(ValvePosition::Extend);
        simulation.sample();
        simulation
    }

    /// Steps done.
    pub fn steps(&self) -> usize {
        self.steps
    }

    /// Steps of the whole job.
    pub fn total_steps(&self) -> usize {
        self.total_steps
    }

    /// Whether the job is done.
    pub fn done(&self) -> bool {
        self.steps >= self.total_steps
    }

    /// State of the device.
    pub fn device(&self) -> &DeviceState {
        &self.device.state
    }

    /// Motion of the piston.
    pub fn motion(&self) -> PistonMotion {
        self.device.motion
    }

    /// Time [s].
    pub fn time(&self) -> f64 {
        self.steps as f64 * self.rig.scenario.step
    }

    /// Number of samples recorded so far.
    pub fn sample_count(&self) -> usize {
        self.log.count()
    }

    /// Recorded values from a sample on, with all channels.
    ///
    /// # Errors
    /// Nothing was.
    pub fn since(&self, first: usize) -> Result<Recording, RecordingError> {
        self.log.since(first)
    }

    /// The record so far.
    ///
    /// # Errors
    /// Nothing was.
    pub fn into_recording(self) -> Result<Recording, RecordingError> {
        self.log.into_recording()
    }

    /// One step: command -> controller -> set value -> device and piston under the load -> sensors -> sample.
    ///
    /// # Errors
    /// The reason why the run stopped.
    pub fn step(&mut self) -> Result<(), RigError> {
        let wanted = self.set_pressure(self.time());
        self.step_at(wanted)
    }

    /// The same with a set pressure [Pa gauge] that is given, whatever the scenario commands.
    ///
    /// # Errors
    /// The reason why the run stopped.
    pub fn step_at(&mut self, wanted: f64) -> Result<(), RigError> {
        let scenario = &self.rig.scenario;
        let time = self.time();
        self.device.state.valve = held(&scenario.valve, time).unwrap_or(ValvePosition::Extend);
        self.applied = self.sensors.command(wanted, scenario.step);
        let (mut load, moment) = self.load();
        let cut = (scenario.step, scenario.substeps);
        self.device
            .face_terms(&mut load, moment.as_ref(), scenario.step);
        self.device.advance::<true>(&load, self.applied, cut);
        self.device.note_flow(scenario.step);
        self.steps += 1;
        self.sample();
        self.check()
    }

    /// Set pressure from now on [Pa gauge].
    fn set_pressure(&mut self, time: f64) -> f64 {
        let scenario = &self.rig.scenario;
        match &scenario.command {
            CommandScenario::SetPressure(steps) => held(steps, time).unwrap_or(0.0),
            CommandScenario::Force(steps) => {
                let Some(desired) = held(steps, time) else {
                    return 0.0;
                };
                if !self
                    .steps
                    .is_multiple_of(scenario.controller.steps(scenario.step))
                {
                    return self.answer;
                }
                self.answer = self.controller.set_pressure(&ForceObservation {
                    time,
                    desired_axial_force: desired,
                    gravity_along_axis: scenario.nominal.gravity_along_extension,
                    measured_axial_force: self.readings.force,
                    stroke: self.readings.stroke,
                    acceleration: self.readings.acceleration,
                    regulator_pressure: self.readings.regulator_pressure,
                });
                self.answer
            }
        }
    }

    /// The load on the piston now, and the moment that its terms are of.
    fn load(&self) -> (PistonLoad<'a>, Option<Moment>) {
        let mut load = load_at(&self.rig.scenario, &self.rig.actual, self.time());
        let surface = load.surface();
        let moment = (self.device).meet_terms(&mut load, self.applied, surface);
        (load, moment)
    }

    /// True state of the rig now.
    pub fn truth(&self) -> RigTruth {
        let (load, moment) = self.load();
        self.truth_under(&load, moment.as_ref())
    }

    /// Contact force asked for at the last sample [N]; NaN where pressures are.
    fn desired_force(&self) -> f64 {
        match &self.rig.scenario.command {
            CommandScenario::Force(steps) => held(steps, self.truth.time).unwrap_or(0.0),
            CommandScenario::SetPressure(_) => f64::NAN,
        }
    }

    /// What there is to see of it after the last step.
    pub fn observed(&self) -> Observed {
        let (truth, readings, device) = (&self.truth, &self.readings, &self.device);
        let stroke = truth.motion.stroke;
        let [extending, retracting] = device.device.pressures(&device.state, stroke);
        let desired = self.desired_force();
        [
            truth.time,
            desired,
            desired,
            truth.contact_force,
            readings.force,
            stroke,
            truth.motion.speed,
            readings.stroke,
            self.applied,
            truth.regulator_pressure,
            readings.regulator_pressure,
            extending,
            retracting,
            self.rig.actual.gravity_along_extension,
            f64::NAN,
        ]
    }

    fn truth_under(&self, load: &PistonLoad<'_>, moment: Option<&Moment>) -> RigTruth {
        let (plant, device, motion) = (&self.rig.actual, &self.device.device, self.device.motion);
        let force = device.piston_force(&self.device.state, motion);
        let contact_force = load.contact_force(0.0, motion);
        let added_outlet = moment.map_or(0.0, |now| plant.term(Port::OutletPressure, now));
        let outside = load.axial.at(0.0) + load.term_force(0.0, motion);
        RigTruth {
            time: self.time(),
            motion,
            acceleration: (force + outside - contact_force) / device.parameters().moving_mass,
            contact_force,
            regulator_pressure: self.device.state.regulator.outlet + added_outlet,
        }
    }

    fn sample(&mut self) {
        let (load, moment) = self.load();
        let truth = self.truth_under(&load, moment.as_ref());
        let there = SensorReadings {
            force: truth.contact_force,
            stroke: truth.motion.stroke,
            regulator_pressure: truth.regulator_pressure,
        };
        self.truth = truth;
        let mut read = self.errors.read(truth.time, &there, truth.acceleration);
        if let Some(moment) = moment {
            read.add(self.rig.actual.reading_terms(&Moment {
                contact_force: truth.contact_force,
                ..moment
            }));
        }
        self.readings = self.sensors.measure(
            truth.time,
            &Truth {
                force: read.force,
                stroke: read.stroke,
                acceleration: truth.acceleration,
                regulator_pressure: read.regulator_pressure,
            },
        );
        let desired = self.desired_force();
        let estimate = self.estimator.as_mut().and_then(|estimator| {
            estimator.update(truth.time, &self.readings, self.device.state.valve)
        });
        self.log.push(&RigSample {
            device: &self.device.device,
            state: &self.device.state,
            truth: &truth,
            readings: &self.readings,
            surface: load_at(&self.rig.scenario, &self.rig.actual, truth.time).surface(),
            set_pressure: self.applied,
            desired_force: desired,
            estimate,
        });
    }

    fn check(&self) -> Result<(), RigError> {
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
                time: self.time(),
                quantity,
                value,
            }),
        }
    }
}
