//! Steps of the arm for which Rapier is not asked (`held_arm`), and what acts on a tool that slides.
//!
//! ```text
//! F = N n - mu N u / |u|
//! ```
//!
//! N normal force [N], n normal out of the part, mu coefficient of friction [1], u velocity of the tool along the part where they touch, in the middle of the step [m/s].
//! That holds where u neither ends nor turns within the step; where it may, the tool may stick, and Rapier's own contact finds its friction.

use glam::DVec3;

use super::World;
use crate::arm::chain::MAX_JOINTS;
use crate::simulation::contact::ContactReading;
use crate::simulation::held_arm::{Acting, Engine, Joints};

/// Change of a sliding tool's velocity from the middle of a step to its ends up to which it is taken to slide on, of that velocity [1].
const SLIDES_ON: f64 = 0.1;
/// Error of that direction, as it was expected, from which on friction is taken anew [rad].
const TURNS: f64 = 1e-5;
/// Times that friction is taken at most.
const LOOKS: usize = 4;

/// What acts on the tool from outside over a step.
struct Outside {
    /// Forces [N] so far off the ball's centre [m].
    forces: Vec<(DVec3, DVec3)>,
    /// Where it slides along a normal, and how fast [m/s].
    slips: Vec<(DVec3, DVec3)>,
    reading: ContactReading,
    /// Forces of the joints by it [N m or N].
    joints: Joints,
}

/// How the arm is moved by a step.
enum Way {
    /// By what Rapier had last: it is done.
    Held,
    /// By Rapier, with what acts on the tool, which slides.
    Sliding(Outside),
    /// By Rapier, which finds the friction of a tool that may stick.
    Open,
}

impl World {
    /// What acts on a tool that is pressed with forces [N] along normals if it slides as the joints' speeds are; none where it does not move.
    fn sliding(&self, pressed: &[(DVec3, f64)], speeds: &[f64]) -> Option<Outside> {
        let mut outside = Outside {
            forces: Vec::new(),
            slips: Vec::new(),
            reading: ContactReading::default(),
            joints: [0.0; MAX_JOINTS],
        };
        if self.pushed.0 != DVec3::ZERO {
            outside.forces.push(self.pushed);
        }
        for &(normal, force) in pressed.iter().filter(|(_, force)| *force > 0.0) {
            let mut friction = DVec3::ZERO;
            if self.friction > 0.0 {
                let slip = self.slip(normal, speeds);
                friction = -slip.try_normalize()? * (self.friction * force);
                outside.slips.push((normal, slip));
            }
            let arm = -normal * self.tool.radius;
            outside.forces.push((normal * force + friction, arm));
            outside.reading.normal_force += force;
            outside.reading.friction += friction;
        }
        let joints = &mut outside.joints[..self.joints.len()];
        for (force, arm) in &outside.forces {
            self.lever.add_force(*force, *arm, joints);
        }
        Some(outside)
    }

    /// Velocity of the tool along the part where it touches along a normal [m/s].
    fn slip(&self, normal: DVec3, speeds: &[f64]) -> DVec3 {
        let velocity = self.lever.velocity(speeds, -normal * self.tool.radius);
        velocity - normal * velocity.dot(normal)
    }

    /// Speeds of the joints in the middle of the step as the step before lets expect them [rad/s or m/s].
    fn expected(&self) -> Joints {
        let mut middle = [0.0; MAX_JOINTS];
        for (i, middle) in middle.iter_mut().enumerate().take(self.joints.len()) {
            *middle = self.velocities[i] + 0.5 * self.gained[i];
        }
        middle
    }

    /// Speeds of the joints in the middle of the step whose end they are at [rad/s or m/s].
    fn middle(&self) -> Joints {
        let mut middle = [0.0; MAX_JOINTS];
        for (i, middle) in middle.iter_mut().enumerate().take(self.joints.len()) {
            *middle = 0.5 * (self.applied[i].1 + self.velocities[i]);
        }
        middle
    }

    /// Whether the tool slides on all through the step at whose end the joints' speeds are.
    fn slides_on(&self, outside: &Outside) -> bool {
        let mut start = [0.0; MAX_JOINTS];
        for (start, applied) in start.iter_mut().zip(&self.applied) {
            *start = applied.1;
        }
        outside.slips.iter().all(|(normal, slip)| {
            let near =
                |speeds| (self.slip(*normal, speeds) - *slip).length() < SLIDES_ON * slip.length();
            near(&start[..self.joints.len()]) && near(&self.velocities)
        })
    }

    /// Whether the tool slid otherwise in the middle of the step than was expected: friction is then another.
    fn slides_otherwise(&self, outside: &Outside, middle: &[f64]) -> bool {
        outside.slips.iter().any(|(normal, slip)| {
            let found = self.slip(*normal, middle);
            slip.cross(found).length() > TURNS * slip.length_squared()
        })
    }

    /// Gives the joints the speeds of the step's end, the tool pressed with forces [N] along normals: by what Rapier had last where it may, else by Rapier.
    pub(super) fn take(&mut self, pressed: &[(DVec3, f64)]) {
        match self.hold(pressed) {
            Way::Held => return,
            Way::Sliding(outside) => self.ask_sliding(&outside),
            Way::Open => self.ask(pressed),
        }
        self.limit_drives();
    }

    /// Moves the joints by a step of the arm as Rapier had it last, the tool pressed with forces [N] along normals. Where it may not, the joints are as they were.
    fn hold(&mut self, pressed: &[(DVec3, f64)]) -> Way {
        if self.rates.every_step() {
            return Way::Open;
        }
        let slides = self.slide_on(pressed);
        if let Some((outside, true)) = &slides
            && self.rates.may_hold(&self.off_seen())
            && self.within_limits()
        {
            self.reading = outside.reading;
            self.held.pass(self.step);
            self.rates.held();
            return Way::Held;
        }
        self.take_back();
        slides.map_or(Way::Open, |(outside, _)| Way::Sliding(outside))
    }

    /// Gives the joints the speeds of the step's end with a tool that slides on all through it, its friction in the direction in which it slides in the middle. That is
    /// sought as the fixed point that it is: where friction damps faster than the step resolves, it is none, and Rapier finds it. Beside what acts on the tool, whether the
    /// arm is known.
    fn slide_on(&mut self, pressed: &[(DVec3, f64)]) -> Option<(Outside, bool)> {
        let count = self.joints.len();
        let mut middle = self.expected();
        for _ in 0..LOOKS {
            let outside = self.sliding(pressed, &middle[..count])?;
            if !self.forecast(&outside) {
                return outside.slips.is_empty().then_some((outside, false));
            }
            if !self.slides_on(&outside) {
                return None;
            }
            middle = self.middle();
            if !self.slides_otherwise(&outside, &middle[..count]) {
                return Some((outside, true));
            }
            self.take_back();
        }
        None
    }

    /// Gives the joints the speeds of the step's start.
    fn take_back(&mut self) {
        for (speed, applied) in self.velocities.iter_mut().zip(&self.applied) {
            *speed = applied.1;
        }
    }

    /// Whether no drive gives more than it can; notes what they give.
    fn within_limits(&mut self) -> bool {
        for i in 0..self.joints.len() {
            let Some(limit) = self.drives[i].limit else {
                continue;
            };
            let (force, speed) = self.at_moment(i);
            let torque = force - limit.losses.at(0.0, speed);
            if torque.is_nan() || torque.abs() > limit.effort {
                return false;
            }
            (self.drives[i].torque, self.drives[i].cut) = (torque, false);
        }
        true
    }

    /// Gives the joints the speeds of the step's end by the arm as Rapier had it last; whether that is known.
    fn forecast(&mut self, outside: &Outside) -> bool {
        let h = self.step;
        let mut acting = Acting {
            step: h,
            force: outside.joints,
            added: [0.0; MAX_JOINTS],
        };
        for i in 0..self.joints.len() {
            let yielding = self.yielding(i);
            acting.added[i] = h * yielding;
            acting.force[i] += self.early(i) - yielding * self.velocities[i];
        }
        let Some(gained) = self.held.forecast(&acting) else {
            return false;
        };
        for (speed, gained) in self.velocities.iter_mut().zip(gained) {
            *speed += gained;
        }
        true
    }

    /// How a joint's law yields to the speed at the end of the step [N s/m or N m s/rad].
    fn yielding(&self, i: usize) -> f64 {
        let (law, theta) = (&self.laws[i], self.moments[i]);
        theta * (law.damping + self.step * theta * law.stiffness)
    }

    /// Asks Rapier for the step of a tool that slides, and learns from it.
    fn ask_sliding(&mut self, outside: &Outside) {
        let ahead = self.held.ahead(self.step);
        self.part_contact.lift();
        self.push(&outside.forces);
        self.advance(&ahead);
        self.reading = outside.reading;
        let lacking = self.learn(outside.joints, &ahead);
        let laws = self.laws.iter().zip(lacking);
        let stiff = laws.filter(|(law, _)| law.stiffness > 0.0);
        let error = stiff.map(|(law, lacking)| lacking.abs() / law.stiffness);
        self.rates.learnt(error.fold(0.0, f64::max));
    }

    /// Learns from Rapier's step alone, in which the tool was pressed with forces [N] along normals and Rapier found its friction.
    pub(super) fn learn_anew(&mut self, pressed: &[(DVec3, f64)]) {
        let (push, arm) = self.pushed;
        let mut joints = [0.0; MAX_JOINTS];
        let out = &mut joints[..self.joints.len()];
        self.lever.add_force(push, arm, out);
        for (normal, force) in pressed {
            let share = force / self.reading.normal_force.max(f64::MIN_POSITIVE);
            let force = *normal * *force + self.reading.friction * share;
            (self.lever).add_force(force, -*normal * self.tool.radius, out);
        }
        self.held.forget();
        self.learn(joints, &[0.0; MAX_JOINTS]);
    }

    /// Learns from Rapier's step, given the forces of the joints by what acted on the tool and what was added to them; gives what was lacking [N m or N].
    fn learn(&mut self, outside: Joints, ahead: &Joints) -> Joints {
        let mut accelerations = [0.0; MAX_JOINTS];
        let mut force = outside;
        for i in 0..self.joints.len() {
            accelerations[i] = (self.velocities[i] - self.applied[i].1) / self.step;
            force[i] += self.at_moment(i).0;
        }
        let mass = self.bare_mass();
        self.held.learn(&Engine {
            mass: &mass,
            accelerations: &accelerations,
            force: &force,
            ahead,
            step: self.step,
        })
    }

    /// Mass matrix of Rapier's last step without what the laws add to it, from its factors.
    fn bare_mass(&self) -> nalgebra::DMatrix<f64> {
        let h = self.step;
        let factors = self.multibody().inv_augmented_mass();
        let mut mass = factors.l() * factors.u();
        factors.p().inv_permute_rows(&mut mass);
        for i in 0..self.joints.len() {
            mass[(i, i)] -= h * self.yielding(i);
        }
        mass
    }
}
