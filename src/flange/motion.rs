//! Motion of a flange's slide and tool head between arm and workpiece.
//!
//! ```text
//! m_h y_h'' = F_s - N             head:       structure F_s, contact N
//! m_s y_s'' = P + F_f - S - F_s   slide:      air P, friction F_f, stop S
//! m_w y_w'' = N - F_w             workpiece:  what carries it F_w, which is what a force plate below it reads
//! ```
//!
//! y places towards the workpiece [m], 0 as head and workpiece touch unloaded. The arm's place is its speed, integrated. Semi-implicit Euler
//! (Hairer, Lubich, Wanner 2006, chapter I.1): the stiffest part swings at some 1 kHz, which the step follows.

use super::FlangeModel;
use super::contact::contact_force;
use super::regulation::{Air, Regulation};
use super::seal::Seal;
use super::stop::stop_force;
use super::structure::Structure;

/// Step of the integration [s].
pub const STEP: f64 = 2e-5;
/// Time between two samples of what comes of it [s].
pub const SAMPLED: f64 = 1e-4;
/// Contact force from which the tool is said to touch [N].
const TOUCHES: f64 = 2.0;

/// Commands of the arm and the flange.
#[derive(Debug, Clone, PartialEq)]
pub struct FlangeCourse {
    /// Time of the first value [s].
    pub start: f64,
    /// Time between values [s].
    pub period: f64,
    /// The arm's speed towards the workpiece [m/s].
    pub speed: Vec<f64>,
    /// Distance at the start [m].
    pub gap: f64,
    /// Force set before contact [N].
    pub before: f64,
    /// Force set after it [N].
    pub after: f64,
    /// Time in which the one becomes the other [s].
    pub ramp: f64,
}

impl FlangeCourse {
    fn set(&self, touched: Option<f64>, time: f64) -> f64 {
        let Some(touched) = touched else {
            return self.before;
        };
        let share = if self.ramp > 0.0 {
            ((time - touched) / self.ramp).clamp(0.0, 1.0)
        } else {
            1.0
        };
        self.before + (self.after - self.before) * share
    }

    fn speed_at(&self, place: f64) -> f64 {
        let last = self.speed.len() - 1;
        let index = (place as usize).min(last);
        let next = (index + 1).min(last);
        let share = (place - index as f64).min(1.0);
        self.speed[index] + (self.speed[next] - self.speed[index]) * share
    }
}

/// Force at the workpiece every [`SAMPLED`] from the start of a course until a time [s].
#[must_use]
pub fn flange_force(model: &FlangeModel, course: &FlangeCourse, until: f64) -> Vec<f64> {
    flange_force_stepped(model, course, until, STEP)
}

/// The same with another step [s], of which [`SAMPLED`] is a multiple.
#[must_use]
pub fn flange_force_stepped(
    model: &FlangeModel,
    course: &FlangeCourse,
    until: f64,
    step: f64,
) -> Vec<f64> {
    let every = (SAMPLED / step).round().max(1.0) as usize;
    let count = ((until - course.start) / step).max(0.0) as usize;
    let mut state = State::at_start(course);
    let parts = Parts::of(model);
    let mut forces = Vec::with_capacity(count / every + 1);
    for index in 0..count {
        let elapsed = index as f64 * step;
        let arm = course.speed_at(elapsed / course.period);
        let set = course.set(state.touched, course.start + elapsed);
        let read = state.advance(&parts, (arm, set), (course.start + elapsed, step));
        if index % every == 0 {
            forces.push(read);
        }
    }
    forces
}

/// The laws, with their numbers.
struct Parts {
    masses: [f64; 3],
    structure: Structure,
    below: Structure,
    contact: [f64; 2],
    seal: Seal,
    regulation: Regulation,
}

impl Parts {
    fn of(model: &FlangeModel) -> Self {
        let slide = (model.mass - model.head_mass).max(0.1 * model.mass);
        let head = model.head_mass;
        let both = head * slide / (head + slide);
        let (stiffness, ratio) = (model.structure_stiffness, model.structure_damping);
        let below = (model.workpiece_stiffness, model.workpiece_damping);
        Self {
            masses: [head, slide, model.workpiece_mass],
            structure: Structure::new(stiffness, ratio, both, model.structure_quadratic),
            below: Structure::new(below.0, below.1, model.workpiece_mass, 0.0),
            contact: [model.contact_stiffness, model.contact_damping],
            seal: Seal {
                coulomb: model.coulomb,
                presliding: model.presliding,
                viscous: model.viscous,
                relaxation: model.relaxation,
            },
            regulation: Regulation {
                gas_stiffness: model.gas_stiffness,
                time: model.regulator_time,
                valve_time: model.valve_time,
            },
        }
    }
}

struct State {
    arm: f64,
    /// Head, slide, workpiece.
    place: [f64; 3],
    speed: [f64; 3],
    air: Air,
    seal: f64,
    touched: Option<f64>,
}

impl State {
    /// The set force presses the slide on its stop, and all comes with the arm.
    fn at_start(course: &FlangeCourse) -> Self {
        let arm = -course.gap;
        let place = arm + super::stop::pressed(course.before);
        let speed = course.speed.first().copied().unwrap_or(0.0);
        Self {
            arm,
            place: [place, place, 0.0],
            speed: [speed, speed, 0.0],
            air: Air {
                force: course.before,
                vented: 0.0,
            },
            seal: 0.0,
            touched: None,
        }
    }

    /// Goes a step further; the force at the workpiece before it [N].
    fn advance(&mut self, parts: &Parts, (arm, set): (f64, f64), (time, step): (f64, f64)) -> f64 {
        let [head, slide, part] = self.place;
        let [head_speed, slide_speed, part_speed] = self.speed;
        self.arm += arm * step;
        let read = parts.below.force(part, part_speed);
        let [stiffness, damping] = parts.contact;
        let contact = contact_force(stiffness, damping, head - part, head_speed - part_speed);
        if self.touched.is_none() && contact > TOUCHES {
            self.touched = Some(time);
        }
        let carried = (parts.structure).force(slide - head, slide_speed - head_speed);
        let (stroke, rate) = (self.arm - slide, arm - slide_speed);
        self.seal = parts.seal.advanced(self.seal, rate, step);
        let friction = parts.seal.force(self.seal, rate);
        let stop = stop_force(stroke, rate);
        let shut = if stroke > 0.0 || rate > 0.0 {
            rate
        } else {
            0.0
        };
        self.air = parts.regulation.advanced(self.air, shut, set, step);
        let forces = [
            carried - contact,
            self.air.force + friction + stop - carried,
            contact - read,
        ];
        for (body, force) in forces.into_iter().enumerate() {
            self.speed[body] += force / parts.masses[body] * step;
            self.place[body] += self.speed[body] * step;
        }
        read
    }
}
