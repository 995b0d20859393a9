//! One step of the bench rig, read from top to bottom.

use std::path::Path;

use super::error::RigError;
use super::estimator::RigEstimator;
use super::load::load_at;
use super::running::RunningRig;
use super::sample::{RigLog, RigSample, RigTruth};
use crate::control::force::{ForceController, ForceObservation, Pressing};
use crate::control::observed::Observed;
use crate::device::{DeviceState, PistonMotion};
use crate::effects::actual;
use crate::physics::valve::ValvePosition;
use crate::plant::{Actual, PistonLoad, PlantParameters};
use crate::recording::{Recording, RecordingError};
use crate::scenario::bench::{BenchScenario, CommandScenario, LoadScenario};
use crate::scenario::{ScenarioError, load_bench};

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
    running: RunningRig<'a>,
    controller: ForceController,
    /// Set pressure that the controller gave last, held until its next period [Pa gauge].
    answer: f64,
    /// True state at the last sample.
    truth: RigTruth,
    estimator: Option<RigEstimator>,
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
        let scenario = &rig.scenario;
        let sensing = (&scenario.sensing, scenario.seed);
        let total_steps = (scenario.duration / scenario.step - 1e-9).ceil() as usize;
        let mut simulation = Self {
            rig,
            running: RunningRig::new(&rig.actual, scenario.start_stroke, sensing),
            controller: rig.controller.clone(),
            answer: 0.0,
            truth: RigTruth::default(),
            estimator: scenario.estimator.as_ref().map(RigEstimator::new),
            steps: 0,
            total_steps,
            log: RigLog::new(total_steps + 1),
        };
        simulation.switch_valve(0.0);
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
        &self.running.device.state
    }

    /// Motion of the piston.
    pub fn motion(&self) -> PistonMotion {
        self.running.device.motion
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
        self.switch_valve(time);
        let cut = (scenario.step, scenario.substeps);
        self.running.step(wanted, self.load(time), cut);
        self.steps += 1;
        self.sample();
        self.running.check(self.time())
    }

    fn switch_valve(&mut self, time: f64) {
        let valve = held(&self.rig.scenario.valve, time);
        self.running.switch(valve.unwrap_or(ValvePosition::Extend));
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
                let readings = self.running.readings();
                self.answer = self.controller.set_pressure(&ForceObservation {
                    time,
                    desired_axial_force: desired,
                    gravity_along_axis: scenario.nominal.gravity_along_extension,
                    measured_axial_force: readings.force,
                    stroke: readings.stroke,
                    acceleration: readings.acceleration,
                    regulator_pressure: readings.regulator_pressure,
                });
                self.answer
            }
        }
    }

    /// The load on the piston from a time on [s].
    fn load(&self, time: f64) -> PistonLoad<'a> {
        load_at(&self.rig.scenario, &self.rig.actual, time)
    }

    /// True state of the rig now.
    pub fn truth(&self) -> RigTruth {
        let time = self.time();
        self.running.truth(time, self.load(time))
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
        let (truth, running) = (&self.truth, &self.running);
        let readings = running.readings();
        let [extending, retracting] = running.pressures();
        let desired = self.desired_force();
        [
            truth.time,
            desired,
            desired,
            truth.contact_force,
            readings.force,
            truth.motion.stroke,
            truth.motion.speed,
            readings.stroke,
            running.applied(),
            truth.regulator_pressure,
            readings.regulator_pressure,
            extending,
            retracting,
            self.rig.actual.gravity_along_extension,
            f64::NAN,
        ]
    }

    fn sample(&mut self) {
        let time = self.time();
        let load = self.load(time);
        let surface = load.surface();
        let truth = self.running.read(time, load);
        self.truth = truth;
        let desired = self.desired_force();
        let readings = self.running.readings();
        let device = &self.running.device;
        let estimate = (self.estimator.as_mut())
            .and_then(|estimator| estimator.update(time, readings, device.state.valve));
        self.log.push(&RigSample {
            device: &device.device,
            state: &device.state,
            truth: &truth,
            readings,
            surface,
            set_pressure: self.running.applied(),
            desired_force: desired,
            estimate,
        });
    }
}
