//! A rig run on the inputs of a recording.

use super::arm_trajectory::ContactKinematics;
use super::carrier::{Hold, ReplayCarrier, hermite};
use super::chain;
use super::contact::StepContact;
use super::contact_friction::{AxialFriction, ContactFriction};
use super::initial_state::{HeldMotion, InitialState};
use super::inputs::PlantInputs;
use super::joint_deflections::{Bending, DeflectedContact, JointDeflections};
use super::moment::Moment;
use super::nudging::Nudging;
use super::parameters::PlantParameters;
use super::port::Port;
use super::riding::Riding;
use super::terms::ForceTerms;
use super::trajectory::Trajectory;
use crate::device::{Device, DeviceState, PistonMotion};
use crate::physics::regulator::RegulatorState;
use crate::physics::valve::ValvePosition;
use crate::stats::median_step;

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
    let axial: Vec<f64>;
    let force = if along_slide {
        let pairs = truth.contact_force.iter().zip(&truth.share);
        axial = pairs.map(|(force, share)| force * share).collect();
        &axial
    } else {
        &truth.contact_force
    };
    let mut readings = [
        sensors.pressure_readings(&inputs.time, &truth.outlet),
        truth
            .stroke
            .iter()
            .map(|stroke| sensors.stroke_gain * stroke)
            .collect(),
        sensors.force_readings(&inputs.time, force, &truth.acceleration),
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
#[expect(
    clippy::too_many_lines,
    reason = "the loop of all fits: its state stays in registers"
)]
pub fn true_trajectory(
    plant: &PlantParameters,
    inputs: &PlantInputs,
    nudging: Option<&Nudging>,
) -> Trajectory {
    if let Some(truth) = chain::true_trajectory(plant, inputs) {
        return truth;
    }
    let device = Device::new(plant.with_friction_of_terms(plant.device.clone()));
    let mass = plant.device.moving_mass;
    let kinematics = inputs
        .cell
        .as_ref()
        .map(|trajectory| trajectory.contact_kinematics(&plant.cell));
    let moved = kinematics.as_ref().map(ContactKinematics::surface);
    let surface = moved.as_ref().unwrap_or(&inputs.surface);
    let pull = |i: usize| {
        let kinematics = kinematics.as_ref().map(|kinematics| kinematics.pull[i]);
        mass * kinematics.unwrap_or(plant.gravity_along_extension)
    };
    let pressing = inputs
        .cell
        .as_ref()
        .is_some_and(|c| c.observed.starts_pressing);
    let (mut motion, mut state) = match &inputs.initial {
        InitialState::AtRest => at_rest(plant, &device, inputs, pressing, pull(0)),
        InitialState::Anywhere(held) => on_its_way(plant, &device, inputs, held),
    };
    let mut joint_deflections = inputs
        .cell
        .as_ref()
        .and_then(|trajectory| JointDeflections::new(trajectory, &plant.cell));
    if let (true, Some(joint_deflections), Some(kinematics)) =
        (pressing, &mut joint_deflections, &kinematics)
    {
        let push = device.piston_force(&state, motion) + pull(0) + kinematics.carried[0];
        joint_deflections.settle(0, push);
    }
    let sharp = inputs.cell.as_ref().and_then(|trajectory| {
        let sharp = trajectory.sharp.as_ref()?;
        Some((trajectory, sharp))
    });
    let count = inputs.time.len();
    let mut truth = Trajectory::default();
    let mut entered = 0.0;
    let law = plant.contact.in_recording(inputs.place);
    let rate = law.rate(mass);
    let usual = median_step(&inputs.time);
    let mut contact_friction = ContactFriction::default();
    for i in 0..count {
        state.valve = if inputs.extends[i] {
            ValvePosition::Extend
        } else {
            ValvePosition::Retract
        };
        let last = i + 1 == count;
        let h = if last {
            usual
        } else {
            inputs.time[i + 1] - inputs.time[i]
        };
        let next = if last { i } else { i + 1 };
        let present = surface[i].is_finite() && surface[next].is_finite();
        let mut carrier = ReplayCarrier {
            contact: StepContact::plain(&law),
            present,
            weight: [pull(i), (pull(next) - pull(i)) / h],
            share: 1.0,
            burr: None,
            burr_damped: sharp.is_some(),
            deflected: DeflectedContact::default(),
            start: inputs.time[i],
            surface: [0.0; 4],
            rate: if present { rate } else { 0.0 },
            hold: None,
            terms: ForceTerms::default(),
            friction: AxialFriction::default(),
        };
        if let Some(kinematics) = &kinematics {
            carrier.share = kinematics.share[i];
            let rise = (kinematics.burr[next] - kinematics.burr[i]) / h;
            carrier.burr = Some([kinematics.burr[i], rise]);
        }
        carrier.hold = match (nudging, inputs.initial.held_at(i)) {
            (_, Some(held)) => Some(hold(plant, h, [&held.stroke, &held.speed], (i, next), 1.0)),
            (Some(nudging), None) => {
                let motion = [nudging.stroke.as_slice(), &nudging.speed];
                Some(hold(plant, h, motion, (i, next), nudging.gain[i]))
            }
            (None, None) => None,
        };
        if present {
            carrier.surface = hermite(
                h,
                [surface[i], surface[next]],
                [inputs.slope(surface, i), inputs.slope(surface, next)],
            );
        }
        let mut normal = None;
        if let (Some((trajectory, sharp)), Some(kinematics)) = (sharp, &kinematics) {
            let stroke = motion.stroke + 0.5 * h * motion.speed;
            let away = joint_deflections
                .as_ref()
                .map(|joint_deflections| joint_deflections.away(i, stroke));
            let away = away.unwrap_or_default();
            let riding = Riding::on(trajectory, sharp, kinematics, i, h, stroke, away);
            carrier.share = riding.share;
            carrier.surface = riding.surface;
            normal = Some(riding.normal);
            let centre = kinematics.balls[i] + kinematics.slides[i] * motion.stroke
                - kinematics.aside[i]
                + away;
            let force = carrier.contact_force(0.0, motion);
            let give = joint_deflections.as_ref().map_or(0.0, |joint_deflections| {
                h * joint_deflections.mobility(i, motion.stroke, riding.normal)
            });
            carrier.friction = contact_friction.advance(
                centre,
                (riding.normal, force),
                (plant.cell.friction, plant.contact.stiffness_at(force)),
                give,
                (kinematics.slides[i], motion.stroke),
            );
        }
        // Of what moves with a term a sample is told as it is then, and a step as it is in its middle.
        let (mut added_outlet, mut risen) = (0.0, 0.0);
        if plant.has_terms() {
            let pressures = device.pressures(&state, motion.stroke);
            let moment = Moment {
                time: inputs.time[i],
                stroke: motion.stroke,
                speed: motion.speed,
                pressures,
                mass_flow: (state.air.entered - entered) / usual,
                set_pressure: inputs.set_pressure[i],
                surface: inputs.surface[i],
                contact_force: carrier.contact_force(0.0, motion),
            };
            added_outlet = plant.term(Port::OutletPressure, &moment);
            let displaced = plant.term(Port::Surface, &moment);
            carrier.surface[0] += displaced;
            risen = plant.term(Port::Surface, &moment.ahead(0.5 * h)) - displaced;
            carrier.stiffen(plant.term(Port::ContactStiffness, &moment), mass);
            state.disturbance = plant.disturbance(&moment, h);
            carrier.terms = ForceTerms::over(plant, &moment);
        }
        if let Some(joint_deflections) = &mut joint_deflections {
            joint_deflections.face(i, normal);
            carrier.deflected = joint_deflections.now(i, motion.stroke, carrier.share);
        }
        truth.note(&device, &state, motion, &carrier, added_outlet);
        carrier.surface[0] += risen;
        truth.mass_flow.push((state.air.entered - entered) / usual);
        entered = state.air.entered;
        if last {
            break;
        }
        // Over a gap in the recording the inputs are held, in steps of the usual length.
        let least = if joint_deflections.is_some() {
            FLEXING_PARTS
        } else {
            1.0
        };
        let parts = (h / usual - 0.01).ceil().max(1.0) * least;
        for part in 0..parts as usize {
            let mut leg = carrier;
            if part > 0 {
                leg.move_start(h * part as f64 / parts);
            }
            if let (Some(joint_deflections), Some(kinematics)) =
                (&mut joint_deflections, &kinematics)
            {
                leg.deflected = joint_deflections.now(i, motion.stroke, leg.share);
                let contact = leg.contact_force(0.0, motion);
                let forces = Bending {
                    contact,
                    stiffness: plant.contact.stiffness_at(contact),
                    damping: plant.contact.damping,
                    friction: leg.friction.force,
                    push: device.piston_force(&state, motion)
                        + leg.weight[0]
                        + kinematics.carried[i],
                    stroke: motion.stroke,
                    speed: motion.speed,
                };
                let deflected =
                    joint_deflections.advance(kinematics, i, h / parts, leg.share, forces);
                leg.deflected = deflected;
                leg.weight[0] -= mass * deflected.acceleration;
            }
            device.advance_carried_unaudited(
                &mut state,
                &mut motion,
                inputs.set_pressure[i],
                &leg,
                h / parts,
                1,
            );
        }
    }
    truth
}

/// Retracted on its stop, all at the atmosphere; or out on its stop at the first pressure set. A rig that presses what it holds pushes its stop in.
fn at_rest(
    plant: &PlantParameters,
    device: &Device,
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
    device: &Device,
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

/// A hold to a measured stroke [m] and speed [m/s] from one sample to the next, h [s] later.
fn hold(
    plant: &PlantParameters,
    h: f64,
    [stroke, speed]: [&[f64]; 2],
    (i, next): (usize, usize),
    share: f64,
) -> Hold {
    let (stiffness, damping) = Nudging::gains(plant.device.moving_mass);
    let gain = plant.sensors.stroke_gain;
    let pair = |values: &[f64]| [values[i] / gain, values[next] / gain];
    Hold {
        stroke: hermite(h, pair(stroke), pair(speed)),
        stiffness: share * stiffness,
        damping: share * damping,
    }
}

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

    fn note(
        &mut self,
        device: &Device,
        state: &DeviceState,
        motion: PistonMotion,
        carrier: &ReplayCarrier<'_>,
        added_outlet: f64,
    ) {
        let mass = device.parameters().moving_mass;
        let pressures = device.pressures(state, motion.stroke);
        let contact_force = carrier.contact_force(0.0, motion);
        let hold_force = carrier.hold_force(0.0, motion);
        let term_force = carrier.term_force(0.0, motion);
        let outside = carrier.weight_at(0.0) + hold_force + term_force
            - carrier.axial_share() * contact_force
            - carrier.friction.at(motion.stroke);
        let force = device.piston_force(state, motion) + outside;
        self.outlet.push(state.regulator.outlet + added_outlet);
        self.stroke.push(motion.stroke);
        self.speed.push(motion.speed);
        self.acceleration.push(force / mass);
        self.contact_force.push(contact_force);
        self.hold_force.push(hold_force);
        self.share.push(carrier.axial_share());
        self.pressures[0].push(pressures[0]);
        self.pressures[1].push(pressures[1]);
    }
}
