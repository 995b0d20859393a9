//! One step of the coupled cell, read from top to bottom.

mod checks;
mod observed;
mod record;
mod saturation;
mod start;
#[cfg(test)]
mod stored;

use std::time::{Duration, Instant};

use glam::DVec3;

use self::saturation::Saturation;
use super::cutting::Cutting;
use super::error::SimulationError;
use super::sample::{FrameLog, SampleLog};
use super::slide::{self, SlideStep};
use super::world::{World, WorldDescription};
use crate::arm::chain::MAX_JOINTS;
use crate::arm::dynamics::inverse_dynamics;
use crate::cell::Cell;
use crate::collision::ClearanceWatch;
use crate::control::force::{ForceController, ForceObservation};
use crate::control::law::{DriveLimit, JointLaw};
use crate::control::servo::{AxisCommand, Servo};
use crate::control::transmission::Motor;
use crate::device::{Device, PistonMotion, PressureMap};
use crate::path::{Phase, Reference};
use crate::physics::command_lag::CommandLag;
use crate::plant::{Moment, PistonLoad, RunningDevice, RunningSensors, Touch};
use crate::removal::EdgeState;
use crate::sensing::noise::{Noise, Stream};
use crate::sensing::{Readings, SensorChain};

/// Signals of a sample of a cell whose tool turns, those of its joints apart.
const SIGNALS_OF_TURNING: usize = 32;
/// Time between two frames of the picture [s].
const FRAME_INTERVAL: f64 = 0.02;

/// Time spent in each part of the step, measured only on request [s].
#[derive(Debug, Clone, Copy, Default)]
pub struct StepTimes {
    /// Reference and set pressure.
    pub reference: Duration,
    /// Device and contact.
    pub slide: Duration,
    /// Joint laws: inverse dynamics, servo.
    pub servo: Duration,
    /// Rapier, friction included.
    pub rigid_bodies: Duration,
    /// Recording.
    pub sample: Duration,
}

/// A running cell.
pub struct Simulation<'a> {
    cell: &'a Cell,
    world: World,
    device: RunningDevice<'a>,
    servo: Servo,
    /// Response of each axis's drive to its command, where the drives lag.
    lags: Vec<CommandLag>,
    /// The motor of each axis that does not move with its link.
    motors: Vec<Option<Motor>>,
    /// Torque of each axis's drive over the last step [N m], of a refined one the largest.
    torques: [f64; MAX_JOINTS],
    /// Drives at their limit, and the lasting loss of the path that came of it.
    saturation: Saturation,
    /// Last reading of each encoder [rad], and their noise.
    encoders: [f64; MAX_JOINTS],
    encoder_noise: Noise,
    /// Where the plan is now.
    reference: Reference,
    controller: ForceController,
    /// Set pressure that the controller gave last, held until its next period [Pa gauge].
    answer: f64,
    /// Set pressure that is given for the step, in place of the controller's [Pa gauge].
    given: Option<f64>,
    /// Errors of the sensors.
    errors: RunningSensors,
    sensors: SensorChain,
    readings: Readings,
    /// Where the tool touches the part, or is about to.
    touches: Vec<Touch>,
    /// Mean forces of the step on them.
    pressed: Vec<(DVec3, f64)>,
    /// Acceleration that gravity, the arm and friction gave the slide over the last step [m/s2].
    carried: f64,
    steps: usize,
    total_steps: usize,
    stopped: bool,
    laws: Vec<JointLaw>,
    limits: Vec<Option<DriveLimit>>,
    /// Whether the tool has touched the part.
    touched: bool,
    /// Largest contact force over the last step [N].
    peak: std::cell::Cell<f64>,
    slide_force: f64,
    log: SampleLog,
    frames: FrameLog,
    /// Where the tool touches, by sample [m]; of a cell whose arm's sensors are read after the run.
    contact_points: Option<Vec<DVec3>>,
    next_frame: f64,
    clearance: ClearanceWatch,
    /// The tool's cutting, if it turns.
    cutting: Option<Cutting>,
    /// Time by which the plan is behind the clock, where the feed follows what is measured [s], and its rate [1].
    feed_lag: f64,
    feed_override: f64,
}

impl<'a> Simulation<'a> {
    /// Puts the cell at the start of its job: the arm at rest, the slide out against its stop, the device at pressure.
    pub fn new(cell: &'a Cell) -> Self {
        let scenario = &cell.setup.scenario;
        let mut world = World::new(&WorldDescription::of(cell));
        let reference = cell.plan.reference(0.0);
        let gravity = cell.gravity_along(reference.axis);
        let desired = cell.setup.passes[0].force * reference.share;
        let parameters = &scenario.nominal.device;
        let set_pressure = PressureMap::new(parameters).set_pressure(desired, gravity);
        let stroke = if scenario.device.locked {
            scenario.process.working_stroke
        } else {
            // The stop carries what will later press on the edge.
            parameters.full_stroke + desired.max(0.0) / parameters.end_stop.stiffness
        };
        let motion = PistonMotion { stroke, speed: 0.0 };
        let device = Device::new(&cell.setup.actual.device);
        let at_rest = (motion, device.at_rest(stroke, set_pressure));
        let device = RunningDevice::new(&cell.setup.actual, device, at_rest);
        let mut positions = cell.plan.start();
        let arm = &cell.setup.actual.cell;
        for (position, offset) in positions.iter_mut().zip(arm.encoder_offset) {
            *position -= offset;
        }
        let lags = start::lags(arm.servo_bandwidth, &positions);
        positions.push(stroke);
        let count = positions.len();
        let inertias = start::inertias(cell, &positions);
        let motors = start::motors(cell, &inertias, &mut positions);
        world.set_positions(&positions);
        let servo = start::servo(cell, &inertias);
        let mut sensors = SensorChain::new(&scenario.sensing, scenario.simulation.seed);
        sensors.settle(set_pressure);
        let total_steps = (cell.plan.duration() / scenario.simulation.step).ceil() as usize;
        Self {
            cell,
            world,
            servo,
            lags,
            motors,
            torques: [0.0; MAX_JOINTS],
            saturation: Saturation::default(),
            encoders: [0.0; MAX_JOINTS],
            encoder_noise: Noise::new(scenario.simulation.seed, Stream::Encoders),
            reference,
            controller: cell.controller.clone(),
            answer: set_pressure,
            given: None,
            errors: RunningSensors::new(cell.setup.actual.sensors),
            sensors,
            readings: Readings {
                stroke,
                regulator_pressure: device.state.regulator.outlet,
                ..Readings::default()
            },
            touches: Vec::new(),
            pressed: Vec::new(),
            carried: gravity,
            device,
            steps: 0,
            total_steps,
            stopped: false,
            laws: vec![JointLaw::default(); count],
            limits: vec![None; count],
            touched: false,
            peak: std::cell::Cell::new(0.0),
            slide_force: 0.0,
            log: SampleLog::new(count - 1, scenario.tool.is_some(), total_steps),
            frames: FrameLog::default(),
            contact_points: scenario.arm.recorded_arm.as_ref().map(|_| Vec::new()),
            next_frame: 0.0,
            clearance: start::clearance(cell, &positions),
            cutting: Cutting::new(cell),
            feed_lag: 0.0,
            feed_override: 1.0,
        }
    }

    /// Steps done.
    pub fn steps(&self) -> usize {
        self.steps
    }

    /// Steps of the whole job.
    pub fn total_steps(&self) -> usize {
        self.total_steps
    }

    /// Whether the job is done, or was stopped by an error.
    pub fn done(&self) -> bool {
        let feed_lag = self.feed_lag / self.cell.setup.scenario.simulation.step;
        self.stopped || self.steps as f64 >= self.total_steps as f64 + feed_lag.ceil()
    }

    /// The record so far.
    pub fn logs(&self) -> (&SampleLog, &FrameLog) {
        (&self.log, &self.frames)
    }

    /// Steps of the arm for one in which its mass matrix was taken anew, on average so far [1].
    pub fn steps_per_mass_matrix(&self) -> f64 {
        let (steps, asked) = self.world.asked();
        steps as f64 / asked.max(1) as f64
    }

    /// Where the tool touches, by sample [m]; none where the cell names no arm file.
    pub fn take_contact_points(&mut self) -> Vec<DVec3> {
        self.contact_points.take().unwrap_or_default()
    }

    /// The record so far, and the end of the run: samples, frames, and the edge as a turning tool left it.
    pub fn into_logs(self) -> (SampleLog, FrameLog, Option<EdgeState>) {
        let edge = self.cutting.map(Cutting::into_edge);
        (self.log, self.frames, edge)
    }

    /// One step of the coupled cell.
    ///
    /// # Errors
    /// The reason why the run stopped; the last sample is recorded if it is finite.
    pub fn step(&mut self) -> Result<(), SimulationError> {
        self.given = None;
        self.step_timed(None)
    }

    /// The same with a set pressure [Pa gauge] that is given, whatever the controller would.
    ///
    /// # Errors
    /// As `step`.
    pub fn step_at(&mut self, wanted: f64) -> Result<(), SimulationError> {
        self.given = Some(wanted);
        self.step_timed(None)
    }

    /// One step, the time of its parts added to `times` if given.
    ///
    /// # Errors
    /// As `step`.
    pub fn step_timed(&mut self, mut times: Option<&mut StepTimes>) -> Result<(), SimulationError> {
        let mut clock = times.as_ref().map(|_| Instant::now());
        let mut lap = |part: fn(&mut StepTimes) -> &mut Duration| {
            if let (Some(times), Some(clock)) = (times.as_deref_mut(), clock.as_mut()) {
                let now = Instant::now();
                *part(times) += now - *clock;
                *clock = now;
            }
        };
        let step = self.cell.setup.scenario.simulation.step;
        let begin = self.steps as f64 * step;
        let near = !self.touches.is_empty();
        let parts = self.cell.resolution.parts(near);
        let dt = step / parts as f64;
        self.world.set_step(dt);
        self.peak.set(0.0);
        self.torques = [0.0; MAX_JOINTS];
        let mut set_pressure = 0.0;
        for part in 0..parts {
            let start = begin + part as f64 * dt;
            let reference = self.lead(start, dt);
            let middle = self.reference.middle(&reference, dt);
            self.reference = reference;
            if part == 0 {
                set_pressure = self.set_pressure(&reference);
            }
            lap(|t| &mut t.reference);
            let slide = self.advance_slide(set_pressure, start, dt);
            lap(|t| &mut t.slide);
            let drive_commands = self.drive_commands(&middle, dt);
            self.set_laws(&drive_commands, slide.device, dt);
            lap(|t| &mut t.servo);
            self.cut(dt);
            self.move_bodies(&slide, dt);
            self.note_drives(&drive_commands, start, dt);
            self.touch(&reference, dt);
            lap(|t| &mut t.rigid_bodies);
        }
        self.steps += 1;
        let reference = self.reference;
        let result = self.sample(&reference, set_pressure);
        self.stopped = result.is_err();
        lap(|t| &mut t.sample);
        result.map_err(|error| self.saturation.before(error))
    }

    fn slide(&self) -> usize {
        self.laws.len() - 1
    }

    /// Contact force that the pass asks for [N].
    fn desired(&self, reference: &Reference) -> f64 {
        self.cell.setup.passes[reference.pass].force
    }

    /// The reference at the end of a step that starts at a time [s]: later by what a feed that follows force or power has lost.
    fn lead(&mut self, start: f64, dt: f64) -> Reference {
        let follows = self.cell.setup.scenario.process.feed_follows;
        if let (Some(follows), Some(cutting)) = (follows, &self.cutting) {
            let wanted = match self.reference.phase {
                Phase::Follow => {
                    (follows.limit / cutting.measured(follows.by)).clamp(follows.least_share, 1.0)
                }
                _ => 1.0,
            };
            self.feed_override +=
                (wanted - self.feed_override) * (-(-dt / follows.time_constant).exp_m1());
            self.feed_lag += (1.0 - self.feed_override) * dt;
        }
        let mut reference = self.cell.plan.reference(start + dt - self.feed_lag);
        if self.feed_override < 1.0 {
            reference.feed *= self.feed_override;
            for axis in 0..MAX_JOINTS {
                reference.velocity[axis] *= self.feed_override;
                reference.acceleration[axis] *= self.feed_override * self.feed_override;
            }
        }
        reference
    }

    /// The turning tool over the step, pressed as the slide has it.
    fn cut(&mut self, dt: f64) {
        if let Some(cutting) = &mut self.cutting {
            let (force, normal) = cutting.advance(&self.reference, &self.pressed, dt);
            self.world.push_tool(force, normal);
        }
    }

    fn set_pressure(&mut self, reference: &Reference) -> f64 {
        let step = self.cell.setup.scenario.simulation.step;
        if let Some(given) = self.given {
            self.answer = given;
            return self.sensors.command(given, step);
        }
        if !self
            .steps
            .is_multiple_of(self.cell.setup.scenario.controller.steps(step))
        {
            return self.sensors.command(self.answer, step);
        }
        let observation = ForceObservation {
            time: self.steps as f64 * step,
            desired_axial_force: self.desired(reference) * reference.share,
            gravity_along_axis: self.cell.gravity_along(reference.axis),
            measured_axial_force: self.readings.force,
            stroke: self.readings.stroke,
            acceleration: self.readings.acceleration,
            regulator_pressure: self.readings.regulator_pressure,
        };
        self.answer = self.controller.set_pressure(&observation);
        self.sensors.command(self.answer, step)
    }

    /// Loads on the slide from now on, at a time [s], with the moment that its terms are of. Where the surface stands no one knows but where the tool touches it.
    fn load<'b>(&'b self, time: f64, touches: &'b [Touch]) -> (PistonLoad<'b>, Option<Moment>) {
        let mass = self.cell.setup.actual.device.moving_mass;
        let mut load = PistonLoad::new(&self.cell.setup.actual.contact, mass, touches, time);
        load.stroke.0[0] = self.device.motion.stroke;
        load.axial.0[0] = mass * self.carried;
        let moment = (self.device).meet_terms(&mut load, self.answer, f64::NAN);
        (load, moment)
    }

    /// Device and contact over the step; a clamped slide stays where it is.
    fn advance_slide(&mut self, set_pressure: f64, start: f64, dt: f64) -> SlideStep {
        let cell = self.cell;
        let substeps = cell.setup.scenario.simulation.substeps;
        let mut pressed = std::mem::take(&mut self.pressed);
        let mut device = self.device.clone();
        let (mut load, moment) = self.load(start, &self.touches);
        load.peak = Some(&self.peak);
        device.face_terms(&mut load, moment.as_ref(), dt);
        let step = if cell.setup.scenario.device.locked {
            let motion = device.motion;
            (device.device).advance(&mut device.state, set_pressure, motion, dt, substeps);
            SlideStep {
                motion,
                device: self.slide_force,
                load: slide::mean_load(&load, motion, dt, &mut pressed),
            }
        } else {
            slide::advance(
                &mut device,
                &load,
                set_pressure,
                (dt, substeps),
                &mut pressed,
            )
        };
        device.note_flow(dt);
        self.device = device;
        self.pressed = pressed;
        step
    }

    /// Arm and slide over the step.
    fn move_bodies(&mut self, slide: &SlideStep, dt: f64) {
        let slide_axis = self.slide();
        let speed = self.world.velocities()[slide_axis];
        let locked = self.cell.setup.scenario.device.locked;
        let led = if locked { None } else { Some(slide.motion) };
        self.world.step(&self.pressed, led);
        let mass = self.cell.setup.actual.device.moving_mass;
        self.device.motion = PistonMotion {
            stroke: self.world.positions()[slide_axis],
            speed: self.world.velocities()[slide_axis],
        };
        let gained = (self.device.motion.speed - speed) / dt;
        self.slide_force = self.world.applied(slide_axis).0;
        self.carried = gained - (self.slide_force - slide.load) / mass;
    }

    /// Commands of the drives: the reference, as far as they lag behind it.
    fn drive_commands(&mut self, reference: &Reference, dt: f64) -> Reference {
        let mut drive_commands = *reference;
        for (axis, lag) in self.lags.iter_mut().enumerate() {
            drive_commands.acceleration[axis] = lag.advance(reference.position[axis], dt);
            drive_commands.position[axis] = lag.position;
            drive_commands.velocity[axis] = lag.velocity;
        }
        drive_commands
    }

    /// Laws of all degrees of freedom: the axes' servo with feed-forward, the device on the slide.
    fn set_laws(&mut self, reference: &Reference, device: f64, dt: f64) {
        let n = self.slide();
        let feed_forward = self.feed_forward(reference, device);
        for (axis, &feed_forward) in feed_forward.iter().enumerate().take(n) {
            let command = AxisCommand {
                position: reference.position[axis],
                velocity: reference.velocity[axis],
                feed_forward,
            };
            let (position, velocity) =
                (self.world.positions()[axis], self.world.velocities()[axis]);
            // The servo closes on the encoder: the arm stands off by what it reads too much.
            let command = AxisCommand {
                position: command.position - self.cell.setup.actual.cell.encoder_offset[axis],
                ..command
            };
            self.laws[axis] = match &mut self.motors[axis] {
                None => {
                    let law = self.servo.law(axis, &command, position, velocity, dt);
                    self.limits[axis] = Some(self.servo.limit(axis));
                    law
                }
                Some(motor) => {
                    let (angle, speed) = (motor.angle, motor.speed);
                    let drive = self.servo.law(axis, &command, angle, speed, dt);
                    let limit = self.servo.limit(axis);
                    motor.advance((&drive, &limit), (position, velocity), dt)
                }
            };
        }
        let scenario = &self.cell.setup.scenario;
        self.laws[n] = if scenario.device.locked {
            let actual = &self.cell.setup.actual.device;
            let stiffness = actual.lock_stiffness;
            JointLaw {
                force: 0.0,
                stiffness,
                rest: scenario.process.working_stroke,
                damping: 2.0 * (stiffness * actual.moving_mass).sqrt(),
            }
        } else {
            JointLaw::constant(device)
        };
        self.world.set_limits(&self.limits);
        self.world.set_laws(&self.laws);
    }

    /// What the drives gave over a part of the step that began at a time [s], and whether a limit cut them.
    fn note_drives(&mut self, drive_commands: &Reference, start: f64, dt: f64) {
        let time = start + dt;
        let mut off: f64 = 0.0;
        for axis in 0..self.slide() {
            let (angle, (torque, cut)) = match &self.motors[axis] {
                None => (self.world.positions()[axis], self.world.drive(axis)),
                Some(motor) => (motor.angle, motor.drive),
            };
            if torque.abs() > self.torques[axis].abs() {
                self.torques[axis] = torque;
            }
            self.servo.hold(axis, cut);
            let offset = self.cell.setup.actual.cell.encoder_offset[axis];
            // What is given is the middle of the step.
            let commanded =
                drive_commands.position[axis] + 0.5 * dt * drive_commands.velocity[axis] - offset;
            off = off.max((commanded - angle).abs());
            if cut {
                let joint = &self.cell.setup.arm.chain.joints[axis];
                self.saturation.note(joint, time, drive_commands.phase);
            }
        }
        self.saturation.settle(off, time);
    }

    /// Torques that the reference needs, with the contact force that the device's own force implies.
    fn feed_forward(&self, reference: &Reference, device: f64) -> [f64; MAX_JOINTS] {
        let (cell, n) = (self.cell, self.slide());
        let chain = &cell.setup.arm_with_slide;
        let base = cell.setup.scenario.arm.world_from_base;
        let mut position = reference.position;
        position[n] = self.world.positions()[n];
        let mut torque = [0.0; MAX_JOINTS];
        inverse_dynamics(
            chain,
            base.rotation,
            cell.setup.scenario.simulation.gravity,
            &position[..=n],
            &reference.velocity[..=n],
            &reference.acceleration[..=n],
            &mut torque[..=n],
        );
        if cell.setup.scenario.arm.servo.contact_feed_forward {
            let contact = (device - torque[n]) / reference.share;
            let mut pressed = [0.0; MAX_JOINTS];
            (self.world).add_force(reference.normal * contact, &mut pressed[..n]);
            for (torque, pressed) in torque.iter_mut().zip(pressed).take(n) {
                *torque -= pressed;
            }
        }
        torque
    }

    /// Finds where the tool touches the part, on what stands out of it.
    fn touch(&mut self, reference: &Reference, dt: f64) {
        // The ball is where the arm has really taken it: ahead of the reference's foot point by its error along the edge.
        let along = (self.world.tool_centre() - reference.centre).dot(reference.tangent);
        let place = reference.edge_length + along;
        let relief = match &mut self.cutting {
            None => self.cell.relief(place),
            Some(cutting) => (self.cell).relief_ridden(place, Some(cutting.ride(place, dt))),
        };
        self.world.touches(&relief, &mut self.touches);
    }
}
