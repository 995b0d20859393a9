//! A rig run on the inputs of a recording.

use super::arm_trajectory::ContactKinematics;
use super::contact::ContactParameters;
use super::contact_friction::{AxialFriction, BallTouch, ContactFriction};
use super::cubic::Cubic;
use super::hold::Hold;
use super::initial_state::{HeldMotion, InitialState};
use super::inputs::PlantInputs;
use super::joint_deflections::{Bending, JointDeflections};
use super::load::{PistonLoad, Touch};
use super::moment::Moment;
use super::nudging::Nudging;
use super::parameters::PlantParameters;
use super::parts;
use super::port::Port;
use super::riding::Riding;
use super::running_device::RunningDevice;
use super::trajectory::{LoadCellSignal, Trajectory};
use crate::device::{Device, DeviceParameters, DeviceState, PistonMotion};
use crate::physics::regulator::RegulatorState;
use crate::physics::valve::ValvePosition;
use crate::stats::median_step;
use glam::DVec3;
use std::borrow::Cow;

/// A simulated recording.
#[derive(Debug, Clone, PartialEq)]
pub struct PlantTrajectory {
    /// The true trajectory.
    pub truth: Trajectory,
    /// Readings of the sensors, without noise, in the order of [`CHANNELS`].
    pub readings: [Vec<f64>; 4],
}

/// Runs a rig and reads its sensors.
pub fn simulate(plant: &PlantParameters, inputs: &PlantInputs) -> PlantTrajectory {
    let truth = true_trajectory(plant, inputs, None);
    let readings = readings(plant, inputs, &truth);
    PlantTrajectory { truth, readings }
}

/// Readings of the sensors, in the order of [`CHANNELS`].
pub fn readings(
    plant: &PlantParameters,
    inputs: &PlantInputs,
    truth: &Trajectory,
) -> [Vec<f64>; 4] {
    let sensors = &plant.sensors;
    let along_slide = inputs
        .cell
        .as_ref()
        .is_some_and(|c| c.observed.force_along_slide);
    let along = |force: &[f64], share: &[f64]| -> Vec<f64> {
        let pairs = force.iter().zip(share);
        let share_of = |share: f64| if along_slide { share } else { 1.0 };
        pairs
            .map(|(force, share)| force * share_of(*share))
            .collect()
    };
    let cell = &truth.load_cell;
    let force = match sensors.is_late() && cell.is_known() {
        true => {
            let force = along(&cell.contact_force, &cell.share);
            let read = sensors.force_readings(&cell.time, &force, &cell.acceleration);
            cell.samples.iter().map(|at| read[*at]).collect()
        }
        false => {
            let force = along(&truth.contact_force, &truth.share);
            sensors.force_readings(&inputs.time, &force, &truth.acceleration)
        }
    };
    let mut readings = [
        sensors.pressure_readings(&inputs.time, &truth.outlet),
        truth
            .stroke
            .iter()
            .map(|stroke| sensors.stroke_gain * stroke)
            .collect(),
        force,
        truth.acceleration.clone(),
    ];
    let ports = [
        Port::PressureReading,
        Port::StrokeReading,
        Port::ForceReading,
    ];
    for (readings, port) in readings.iter_mut().zip(ports) {
        if plant.acts_at(port) {
            for (i, reading) in readings.iter_mut().enumerate() {
                *reading += plant.term(port, &truth.moment(inputs, i));
            }
        }
    }
    readings
}

/// Runs a rig from the state in which a recording starts. A rig that is out of all proportion gives values that are not finite. A nudging holds the piston
/// to a measured motion.
pub fn true_trajectory(
    plant: &PlantParameters,
    inputs: &PlantInputs,
    nudging: Option<&Nudging>,
) -> Trajectory {
    if let Some(truth) = parts::true_trajectory(plant, inputs) {
        return truth;
    }
    let device = plant.device_under_terms();
    let replay = Replay::new(plant, inputs, nudging);
    let mut rig = replay.start(Device::new(&device));
    let mut truth = Trajectory::default();
    for i in 0..inputs.time.len() {
        replay.advance(&mut rig, i, &mut truth);
    }
    truth
}

/// What drives a rig from sample to sample.
struct Replay<'a> {
    plant: &'a PlantParameters,
    inputs: &'a PlantInputs,
    nudging: Option<&'a Nudging>,
    /// Motion of a cell's contact.
    kinematics: Option<ContactKinematics>,
    /// Where the surface stands along the stroke [m].
    surface: Cow<'a, [f64]>,
    /// The contact as this recording has it.
    contact: ContactParameters,
    /// Usual time from sample to sample [s].
    usual: f64,
}

/// State of a rig.
struct RunningRig<'a> {
    device: RunningDevice<'a>,
    joints: Option<JointDeflections<'a>>,
    friction: ContactFriction,
}

/// From a sample to the next.
#[derive(Debug, Clone, Copy)]
struct Span {
    from: usize,
    to: usize,
    /// Time between them [s].
    length: f64,
}

impl<'a> Replay<'a> {
    fn new(
        plant: &'a PlantParameters,
        inputs: &'a PlantInputs,
        nudging: Option<&'a Nudging>,
    ) -> Self {
        let cell = inputs.cell.as_ref();
        let kinematics = cell.map(|trajectory| trajectory.contact_kinematics(&plant.cell));
        let moved = kinematics.as_ref().map(ContactKinematics::surface);
        Self {
            plant,
            inputs,
            nudging,
            kinematics,
            surface: moved.map_or(Cow::Borrowed(&inputs.surface), Cow::Owned),
            contact: plant.contact.in_recording(inputs.place),
            usual: median_step(&inputs.time),
        }
    }

    /// Gravity and the arm's acceleration on the moving mass along extension at a sample [N].
    fn pull(&self, i: usize) -> f64 {
        let kinematics = self.kinematics.as_ref();
        let pull = kinematics.map_or(self.plant.gravity_along_extension, |k| k.pull[i]);
        self.plant.device.moving_mass * pull
    }

    /// The rig in the state in which the recording starts.
    fn start(&self, device: Device<&'a DeviceParameters>) -> RunningRig<'a> {
        let (plant, inputs) = (self.plant, self.inputs);
        let cell = inputs.cell.as_ref();
        let pressing = cell.is_some_and(|c| c.observed.starts_pressing);
        let (motion, state) = match &inputs.initial {
            InitialState::AtRest => at_rest(plant, &device, inputs, pressing, self.pull(0)),
            InitialState::Anywhere(held) => on_its_way(plant, &device, inputs, held),
        };
        let mut joints = cell.and_then(|trajectory| JointDeflections::new(trajectory, &plant.cell));
        if let (true, Some(joints), Some(kinematics)) = (pressing, &mut joints, &self.kinematics) {
            let push = device.piston_force(&state, motion) + self.pull(0) + kinematics.carried[0];
            joints.settle(0, push);
        }
        RunningRig {
            device: RunningDevice::new(plant, device, (motion, state)),
            joints,
            friction: ContactFriction::default(),
        }
    }

    /// The time from a sample on; behind the last one as long as usual.
    fn span(&self, from: usize) -> Span {
        let time = &self.inputs.time;
        let to = (from + 1).min(time.len() - 1);
        let length = match to == from {
            true => self.usual,
            false => time[to] - time[from],
        };
        Span { from, to, length }
    }

    /// Notes a sample, and runs on to the next.
    fn advance(&self, rig: &mut RunningRig<'_>, i: usize, truth: &mut Trajectory) {
        let (inputs, span) = (self.inputs, self.span(i));
        rig.device.state.valve = match inputs.extends[i] {
            true => ValvePosition::Extend,
            false => ValvePosition::Retract,
        };
        let present = [span.from, span.to].map(|j| self.surface[j].is_finite()) == [true; 2];
        let riding = self.riding(rig, span);
        let touch = self.touch(span, riding.as_ref());
        let touches = [touch];
        let met = usize::from(present);
        let mut load = self.load(span, &touches[..met]);
        if let Some(riding) = &riding {
            load.stroke = riding.surface;
            load.friction = self.rub(rig, i, &load, riding);
        } else if present {
            let ends = [span.from, span.to];
            let slopes = ends.map(|j| inputs.slope(&self.surface, j));
            load.stroke = Cubic::hermite(span.length, ends.map(|j| self.surface[j]), slopes);
        }
        if let Some(joints) = &mut rig.joints {
            joints.face(i, riding.map(|riding| riding.normal));
        }
        let set_pressure = inputs.set_pressure[i];
        let flexes = rig.joints.is_some();
        let parts = if span.to == i {
            1
        } else {
            self.parts(span, flexes)
        };
        let dt = span.length / parts as f64;
        for part in 0..parts {
            let start = span.length * part as f64 / parts as f64;
            let touches = [touch.later(start)];
            let mut leg = load.later(start, &touches[..met]);
            // Of what moves with a term a sample takes what is then, and a step what is in its middle.
            let moment = (rig.device).meet_terms(&mut leg, set_pressure, inputs.surface[i]);
            let felt = || {
                let motion = rig.device.motion;
                let joints = rig.joints.as_ref();
                let bent = joints.map(|joints| joints.now(i, motion.stroke, touch.share));
                Felt::of(
                    &rig.device,
                    &leg.deflected(&bent.unwrap_or_default()),
                    &touches[0],
                )
            };
            if part == 0 {
                let outlet = |now| self.plant.term(Port::OutletPressure, &now);
                truth.note(&rig.device, &felt(), moment.map_or(0.0, outlet));
            }
            if self.is_felt_late() {
                truth
                    .load_cell
                    .note(inputs.time[i] + start, &felt(), part == 0);
            }
            if span.to == i {
                return;
            }
            rig.device.face_terms(&mut leg, moment.as_ref(), dt);
            let leg = self.bend(rig, i, &leg, touch.share, dt);
            rig.device.advance::<false>(&leg, set_pressure, (dt, 1));
            rig.device.note_flow(dt);
        }
    }

    /// Whether a late load cell is followed between the samples: where the piston is held to a measured motion errors in time are forgiven.
    fn is_felt_late(&self) -> bool {
        self.plant.sensors.is_late() && self.nudging.is_none()
    }

    /// Steps into which a span is cut, of an arm that flexes or another; over a gap in the recording the inputs are held, in steps of the usual length.
    fn parts(&self, span: Span, flexes: bool) -> usize {
        let longest = [
            (flexes, self.usual / FLEXING_PARTS),
            (self.plant.has_fast_terms(), TERMS_HELD),
            (self.is_felt_late(), LOAD_CELL_EVERY),
        ];
        let longest = longest.into_iter().filter(|(applies, _)| *applies);
        let longest = longest.fold(self.usual, |least, (_, step)| least.min(step));
        let usual = (self.usual / longest - 0.01).ceil().max(1.0);
        ((span.length / self.usual - 0.01).ceil().max(1.0) * usual) as usize
    }

    /// Where the ball rides on a sharp edge over a span.
    fn riding(&self, rig: &RunningRig<'_>, span: Span) -> Option<Riding> {
        let (trajectory, kinematics) = (self.inputs.cell.as_ref()?, self.kinematics.as_ref()?);
        let sharp = trajectory.sharp.as_ref()?;
        let motion = rig.device.motion;
        let stroke = motion.stroke + 0.5 * span.length * motion.speed;
        let joints = rig.joints.as_ref();
        let away = joints.map_or(DVec3::ZERO, |joints| joints.away(span.from, stroke));
        let over = (span.from, span.length);
        Some(Riding::on(
            trajectory, sharp, kinematics, over, stroke, away,
        ))
    }

    /// Where the tool meets the surface over a span.
    fn touch(&self, span: Span, riding: Option<&Riding>) -> Touch {
        let Some(kinematics) = &self.kinematics else {
            return Touch::AXIAL;
        };
        let [burr, next] = [span.from, span.to].map(|j| kinematics.burr[j]);
        Touch {
            normal: riding.map_or(Touch::AXIAL.normal, |riding| riding.normal),
            penetration: burr,
            rate: (next - burr) / span.length,
            share: riding.map_or(kinematics.share[span.from], |riding| riding.share),
            // Of a ball that is met along the bisector its own motion is damped, whatever the shape that it meets.
            damped: riding.is_some(),
        }
    }

    /// Load over a span but for surface, friction and terms.
    fn load<'b>(&'b self, span: Span, touches: &'b [Touch]) -> PistonLoad<'b> {
        let mass = self.plant.device.moving_mass;
        let [pull, next] = [span.from, span.to].map(|j| self.pull(j));
        let mut load = PistonLoad::new(&self.contact, mass, touches, self.inputs.time[span.from]);
        load.axial = Cubic([pull, (next - pull) / span.length, 0.0, 0.0]);
        load.hold = self.hold(span);
        load
    }

    /// Hold to a measured motion over a span.
    fn hold(&self, span: Span) -> Option<Hold> {
        let (stroke, speed, share) = match (self.nudging, self.inputs.initial.held_at(span.from)) {
            (_, Some(held)) => (&held.stroke, &held.speed, 1.0),
            (Some(nudging), None) => (&nudging.stroke, &nudging.speed, nudging.gain[span.from]),
            (None, None) => return None,
        };
        let (stiffness, damping) = Nudging::gains(self.plant.device.moving_mass);
        let gain = self.plant.sensors.stroke_gain;
        let ends = |values: &[f64]| [span.from, span.to].map(|j| values[j] / gain);
        Some(Hold {
            stroke: Cubic::hermite(span.length, ends(stroke), ends(speed)),
            stiffness: share * stiffness,
            damping: share * damping,
        })
    }

    /// Friction of the ball on the part at the start of a span.
    fn rub(
        &self,
        rig: &mut RunningRig<'_>,
        i: usize,
        load: &PistonLoad<'_>,
        riding: &Riding,
    ) -> AxialFriction {
        let Some(kinematics) = &self.kinematics else {
            return AxialFriction::default();
        };
        let (motion, slide) = (rig.device.motion, kinematics.slides[i]);
        let centre =
            kinematics.balls[i] + slide * motion.stroke - kinematics.aside[i] + riding.away;
        let force = load.contact_force(0.0, motion);
        let give = rig.joints.as_ref().map_or(0.0, |joints| {
            riding.length * joints.mobility(i, motion.stroke, riding.normal)
        });
        let plant = self.plant;
        let touch = BallTouch {
            centre,
            normal: riding.normal,
            force,
            stiffness: plant.contact.stiffness_at(force),
        };
        let slide = (slide, motion.stroke);
        (rig.friction).advance(&touch, plant.cell.friction, give, slide)
    }

    /// A load over `dt` [s] from sample `i` on, on joints that bend under it, `share` of the contact force being along the slide.
    fn bend<'b>(
        &self,
        rig: &mut RunningRig<'_>,
        i: usize,
        load: &PistonLoad<'b>,
        share: f64,
        dt: f64,
    ) -> PistonLoad<'b> {
        let (Some(joints), Some(kinematics)) = (&mut rig.joints, &self.kinematics) else {
            return *load;
        };
        let (plant, motion) = (self.plant, rig.device.motion);
        let now = load.deflected(&joints.now(i, motion.stroke, share));
        let contact = now.contact_force(0.0, motion);
        let forces = Bending {
            contact,
            stiffness: plant.contact.stiffness_at(contact),
            damping: plant.contact.damping,
            friction: load.friction.force,
            push: rig.device.force() + load.axial.0[0] + kinematics.carried[i],
            stroke: motion.stroke,
            speed: motion.speed,
        };
        let bent = joints.advance(kinematics, i, dt, share, forces);
        let mut load = load.deflected(&bent);
        load.axial.0[0] -= plant.device.moving_mass * bent.acceleration;
        load
    }
}

/// Retracted on its stop, all at the atmosphere; or out on its stop at the first pressure set. A rig that presses what it holds pushes its stop in.
fn at_rest(
    plant: &PlantParameters,
    device: &Device<&DeviceParameters>,
    inputs: &PlantInputs,
    pressing: bool,
    pull: f64,
) -> (PistonMotion, DeviceState) {
    let stop = plant.device.end_stop.stiffness;
    let resting = |stroke: f64| PistonMotion { stroke, speed: 0.0 };
    if !pressing {
        let motion = resting(plant.cell.start_stroke + pull.min(0.0) / stop);
        return (motion, device.at_rest(motion.stroke, 0.0));
    }
    let out = plant.device.full_stroke;
    let set = inputs.set_pressure[0];
    let push = device.piston_force(&device.at_rest(out, set), resting(out)) + pull;
    let motion = resting(out + push.max(0.0) / stop);
    (motion, device.at_rest(motion.stroke, set))
}

/// In mid-motion: the piston where it was measured, else on the surface if there is pressure behind it, else on the stop that the valve sends it to.
fn on_its_way(
    plant: &PlantParameters,
    device: &Device<&DeviceParameters>,
    inputs: &PlantInputs,
    held: &HeldMotion,
) -> (PistonMotion, DeviceState) {
    let full = plant.device.full_stroke;
    let gain = plant.sensors.stroke_gain;
    let motion = match &held.motion {
        Some(measured) => PistonMotion {
            stroke: measured.stroke[0] / gain,
            speed: measured.speed[0] / gain,
        },
        None => PistonMotion {
            stroke: match (inputs.extends[0], inputs.surface[0].is_finite()) {
                (true, true) => inputs.surface[0].clamp(0.0, full),
                (true, false) => full,
                (false, _) => 0.0,
            },
            speed: 0.0,
        },
    };
    let set = held.outlet / plant.device.regulator.gain;
    // What the valve lets out is at the atmosphere by then.
    let mut state = device.at_rest(motion.stroke, if inputs.extends[0] { set } else { 0.0 });
    state.regulator = RegulatorState::at_rest(&plant.device.regulator, set);
    (motion, state)
}

/// Time over which terms of what changes fast are held at most [s]: chambers fill within a few milliseconds.
const TERMS_HELD: f64 = 5e-4;
/// Time between the forces that a late or slow load cell feels at most [s]: a contact begins and ends within a few milliseconds.
const LOAD_CELL_EVERY: f64 = 1.25e-4;
/// Steps into which a sample is cut where links swing.
const FLEXING_PARTS: f64 = 2.0;

impl Trajectory {
    /// The variables at a sample.
    pub fn moment(&self, inputs: &PlantInputs, i: usize) -> Moment {
        Moment {
            time: inputs.time[i],
            stroke: self.stroke[i],
            speed: self.speed[i],
            pressures: [self.pressures[0][i], self.pressures[1][i]],
            mass_flow: self.mass_flow[i],
            set_pressure: inputs.set_pressure[i],
            surface: inputs.surface[i],
            contact_force: self.contact_force[i],
        }
    }

    fn note(&mut self, device: &RunningDevice<'_>, felt: &Felt, added_outlet: f64) {
        let (state, motion) = (&device.state, device.motion);
        let pressures = device.device.pressures(state, motion.stroke);
        self.outlet.push(state.regulator.outlet + added_outlet);
        self.stroke.push(motion.stroke);
        self.speed.push(motion.speed);
        self.acceleration.push(felt.acceleration);
        self.contact_force.push(felt.contact_force);
        self.hold_force.push(felt.hold_force);
        self.share.push(felt.share);
        self.pressures[0].push(pressures[0]);
        self.pressures[1].push(pressures[1]);
        self.mass_flow.push(device.mass_flow);
    }
}

/// What acts on the moving mass at a moment.
struct Felt {
    /// Contact force [N], and its share along the stroke [1].
    contact_force: f64,
    share: f64,
    /// Force of what holds it to a measured motion [N].
    hold_force: f64,
    /// Acceleration along extension [m/s2].
    acceleration: f64,
}

impl Felt {
    fn of(device: &RunningDevice<'_>, load: &PistonLoad<'_>, touch: &Touch) -> Self {
        let motion = device.motion;
        let share = load.axial_share(touch);
        let contact_force = load.contact_force(0.0, motion);
        let hold_force = load.hold.map_or(0.0, |hold| hold.force(0.0, motion));
        let outside = load.axial.at(0.0) + hold_force + load.term_force(0.0, motion)
            - share * contact_force
            - load.friction.at(motion.stroke);
        let force = device.force() + outside;
        Self {
            contact_force,
            share,
            hold_force,
            acceleration: force / device.device.parameters().moving_mass,
        }
    }
}

impl LoadCellSignal {
    fn note(&mut self, time: f64, felt: &Felt, is_sample: bool) {
        if is_sample {
            self.samples.push(self.time.len());
        }
        self.time.push(time);
        self.contact_force.push(felt.contact_force);
        self.share.push(felt.share);
        self.acceleration.push(felt.acceleration);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plant::sensors::SensorErrors;
    use crate::plant::{Basis, Latent, Variable};

    /// A device that meets a surface and lets go, sampled every so many steps of 0.25 ms; inputs change at multiples of 4 ms.
    fn recorded(plant: &PlantParameters, every: usize) -> PlantTrajectory {
        let time: Vec<f64> = (0..=2400)
            .step_by(every)
            .map(|i| 2.5e-4 * f64::from(i))
            .collect();
        let extends = |t: &f64| !(0.36..0.44).contains(t);
        let inputs = PlantInputs {
            cell: None,
            motion: None,
            initial: InitialState::AtRest,
            place: 0,
            set_pressure: vec![2e5; time.len()],
            extends: time.iter().map(extends).collect(),
            surface: vec![0.01; time.len()],
            time,
        };
        simulate(plant, &inputs)
    }

    fn plant() -> PlantParameters {
        PlantParameters {
            contact: ContactParameters::linear(1e5, 400.0),
            ..PlantParameters::default()
        }
    }

    /// Largest differences of pressure, stroke and force at every 4 ms from the same with sixteen samples for each.
    fn differences(plant: &PlantParameters) -> [f64; 3] {
        let (coarse, fine) = (recorded(plant, 16), recorded(plant, 1));
        [0, 1, 2].map(|channel| {
            let fine = fine.readings[channel].iter().step_by(16);
            let pairs = coarse.readings[channel].iter().zip(fine);
            pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
        })
    }

    /// A law of the chamber's pressure at the outlet, held over samples of 4 ms, moved the stroke by ten times a sensor's noise, and was not found for that.
    #[test]
    fn a_term_is_the_same_however_seldom_it_is_sampled() {
        let mut plant = plant();
        let bare = differences(&plant);
        plant.latent = Some(Latent {
            port: Port::OutletPressure,
            variable: Variable::ChamberPressure,
            directed: false,
            basis: Basis::Hats { ends: [1e5, 3e5] },
            coefficients: vec![0.0, -3e4],
        });
        let with = differences(&plant);
        assert!(bare[1] < 2e-6 && with[1] < 1e-5, "{bare:?}, {with:?}");
        assert!(with[2] < 1.0, "{with:?}");
    }

    /// What a load cell feels was taken linear between samples of 4 ms: a contact's onset in between was late by a tenth of the force, and a lag was named an offset.
    #[test]
    fn a_late_load_cell_feels_what_there_is_between_the_samples() {
        let plain = differences(&plant());
        for late in [
            SensorErrors {
                force_lag: 1.5e-3,
                ..SensorErrors::NONE
            },
            SensorErrors {
                force_delay: 5.1e-3,
                ..SensorErrors::NONE
            },
        ] {
            let mut plant = plant();
            plant.sensors = late;
            let [_, stroke, force] = differences(&plant);
            assert!(stroke < 2e-6, "{stroke}");
            assert!(
                force < plain[2] + 0.5,
                "{late:?}: {force} N, {} N of one in time",
                plain[2]
            );
        }
    }
}
