//! Links that swing on the springs of their joints.
//!
//! ```text
//! M d'' + D d' + K d = J_n F + J_t T + J . S + J_a (c F - a . S - G) - tau           links against motors
//! T = -mu F sat(v / v_s),   v = v_motors + J_t . d'
//! ```
//!
//! d deflections [rad], M mass matrix without the moving mass's along the slide, which there goes its own way [kg m2], D = b K and K of springs with play
//! (`physics::joint_spring`), J_n, J_t, J_a levers of the ball along bisector, edge and slide [m], F contact force, c its share along the slide, G what the
//! device pushes the moving mass with, T friction along the edge, regularised so that there is none at rest, S friction across it (`contact_friction`), a the
//! slide's direction, tau what the motors' acceleration takes. Gravity and Coriolis torques are taken to be compensated.
//!
//! Trapezoidal in springs and contact, implicit in friction, all in the speeds at the end of a step.

use super::arm_trajectory::{ArmTrajectory, ContactKinematics, INERTIA_EVERY, SLIDING};
use super::cell_parameters::{CellParameters, MOST_JOINTS};
use crate::physics::joint_spring::JointSpring;
use glam::DVec3;
use nalgebra::DMatrix;

/// Stiffness of a joint that does not give [N m/rad]: no torque of an arm turns it by what a sensor sees.
const FIRM: f64 = 3e8;

/// One number a joint.
type Joints = [f64; MOST_JOINTS];

/// Links on their springs.
#[derive(Debug, Clone)]
pub(super) struct JointDeflections<'a> {
    trajectory: &'a ArmTrajectory,
    cell: &'a CellParameters,
    count: usize,
    deflection: Joints,
    speed: Joints,
    /// Levers along the normal of the contact at no stroke [m], and what a stroke adds [1].
    levers: [Joints; 2],
    /// Inverse of what multiplies the speeds, and what it goes with.
    inverse: Option<(Key, Vec<f64>)>,
}

/// Conditions of an inverse.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Key {
    inertia: usize,
    touching: bool,
    step: f64,
    /// Joints whose teeth are apart, one bit each.
    apart: u8,
}

impl Key {
    /// Whether its inverse is that of another: steps are differences of time stamps, equal but for rounding.
    fn serves(&self, other: &Self) -> bool {
        let step = self.step;
        (step - other.step).abs() < 1e-9 * step && Self { step, ..*other } == *self
    }
}

/// Forces that bend the arm.
#[derive(Debug, Clone, Copy)]
pub(super) struct Bending {
    /// Contact force [N].
    pub contact: f64,
    /// Stiffness of the contact [N/m].
    pub stiffness: f64,
    /// Its damping [N s/m].
    pub damping: f64,
    /// Friction on the ball [N], of which what acts across the edge is taken.
    pub friction: DVec3,
    /// Force of the device on the moving mass, its weight included [N].
    pub push: f64,
    /// Stroke [m].
    pub stroke: f64,
    /// Its rate [m/s].
    pub speed: f64,
}

/// Effect of swinging over a step.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(super) struct DeflectedContact {
    /// Where the surface goes, seen along the slide: coefficients of 1, t, t2 [m].
    pub surface: [f64; 3],
    /// Loss of the contact force's share along the slide by the slide's turning [1].
    pub turned: f64,
    /// Acceleration of the slide along its axis [m/s2].
    pub acceleration: f64,
}

impl<'a> JointDeflections<'a> {
    /// At rest; none where no joint gives.
    pub fn new(trajectory: &'a ArmTrajectory, cell: &'a CellParameters) -> Option<Self> {
        let count = trajectory.joints.len();
        let gives = cell.joint_stiffness[..count].iter().any(|k| k.is_finite());
        let plays = cell.joint_play[..count].iter().any(|play| *play > 0.0);
        ((gives || plays) && count > 0).then_some(Self {
            trajectory,
            cell,
            count,
            deflection: [0.0; MOST_JOINTS],
            speed: [0.0; MOST_JOINTS],
            levers: [[0.0; MOST_JOINTS]; 2],
            inverse: None,
        })
    }

    /// Bends the joints to where they carry what is on them, at a sample.
    pub fn settle(&mut self, i: usize, push: f64) {
        for j in 0..self.count {
            let load =
                self.trajectory.jacobians[i].axial[j] * push + self.trajectory.joints[j].torque[i];
            self.deflection[j] = -self.spring(j).under(load);
        }
    }

    /// Takes the levers at a sample, along the bisector of the edge or another normal.
    pub fn face(&mut self, i: usize, normal: Option<DVec3>) {
        let Some(normal) = normal else {
            self.levers = self.trajectory.jacobians[i].normal;
            return;
        };
        for (j, joint) in self.trajectory.joints.iter().enumerate() {
            let axis = joint.axis[i];
            let ball = axis.cross(self.trajectory.ball[i] - joint.origin[i]);
            self.levers[0][j] = ball.dot(normal);
            self.levers[1][j] = axis.cross(self.trajectory.slide[i]).dot(normal);
        }
    }

    /// Displacement of the ball by the swing at a stroke [m].
    pub fn away(&self, i: usize, stroke: f64) -> DVec3 {
        (0..self.count)
            .map(|j| self.swing(i, j, stroke) * self.deflection[j])
            .sum()
    }

    /// Where a turn of a joint takes the ball at a stroke [m].
    fn swing(&self, i: usize, joint: usize, stroke: f64) -> DVec3 {
        let tip = self.trajectory.ball[i] + self.trajectory.slide[i] * stroke;
        let joint = &self.trajectory.joints[joint];
        joint.axis[i].cross(tip - joint.origin[i])
    }

    /// Speed that a force across the edge on the ball gives it over a step as long as the last one, at a stroke [m] and on a normal [m/(s N)].
    pub fn mobility(&self, i: usize, stroke: f64, normal: DVec3) -> f64 {
        let across = self.trajectory.edge[i].tangent.cross(normal);
        let mut levers = [0.0; MOST_JOINTS];
        for (j, lever) in levers.iter_mut().enumerate().take(self.count) {
            *lever = self.swing(i, j, stroke).dot(across);
        }
        dot(&levers, &self.solve(&levers))
    }

    /// Levers along the normal at a stroke [m].
    fn normal(&self, stroke: f64) -> Joints {
        let [fixed, turn] = &self.levers;
        std::array::from_fn(|j| fixed[j] + stroke * turn[j])
    }

    /// Spring of a joint, of one that does not give stiffer than any.
    fn spring(&self, joint: usize) -> JointSpring {
        JointSpring {
            stiffness: self.cell.joint_stiffness[joint].min(FIRM),
            damping_time: self.cell.joint_damping[joint],
            play: self.cell.joint_play[joint],
        }
    }

    /// Where the surface is now, and where it goes.
    pub fn now(&self, i: usize, stroke: f64, share: f64) -> DeflectedContact {
        self.deflected(&self.normal(stroke), share, i)
    }

    fn deflected(&self, normal: &Joints, share: f64, i: usize) -> DeflectedContact {
        DeflectedContact {
            surface: [
                dot(normal, &self.deflection) / share,
                dot(normal, &self.speed) / share,
                0.0,
            ],
            turned: dot(self.turning(i), &self.deflection),
            acceleration: 0.0,
        }
    }

    fn turning(&self, i: usize) -> &Joints {
        match self.trajectory.sharp {
            None => &self.trajectory.jacobians[i].normal[1],
            Some(_) => &self.levers[1],
        }
    }

    /// Advances over `h` [s] from sample `i` under forces as they are now, `share` of the contact's along the slide.
    pub fn advance(
        &mut self,
        kinematics: &ContactKinematics,
        i: usize,
        h: f64,
        share: f64,
        forces: Bending,
    ) -> DeflectedContact {
        let normal = self.normal(forces.stroke);
        let jacobian = &self.trajectory.jacobians[i];
        let [fixed, turn] = &jacobian.tangential;
        let tangential: Joints = std::array::from_fn(|j| fixed[j] + forces.stroke * turn[j]);
        let axial = &jacobian.axial;
        let key = Key {
            inertia: i / INERTIA_EVERY,
            touching: forces.contact > 0.0,
            step: h,
            apart: self.apart(),
        };
        let inertia = &self.trajectory.inertia[key.inertia];
        let (stiffness, halved, rest) = self.springs(h);
        // The contact over the step: as it is, with what the piston and the swing do to it by its middle.
        let [spring, damper] = if key.touching {
            [forces.stiffness, forces.damping]
        } else {
            [0.0; 2]
        };
        let implicit = 0.25 * h * spring + 0.5 * damper;
        let lifting = dot(&normal, &self.speed);
        let contact = forces.contact + 0.5 * h * spring * share * forces.speed
            - (0.25 * h * spring - 0.5 * damper) * lifting;
        let tangent = self.trajectory.edge[i].tangent;
        let across_edge = forces.friction - tangent * forces.friction.dot(tangent);
        let mut right = [0.0; MOST_JOINTS];
        for j in 0..self.count {
            let motor = self.trajectory.joints[j].torque[i] - axial[j] * kinematics.carried[i];
            let across = self.swing(i, j, forces.stroke).dot(across_edge);
            let bent = normal[j] + share * axial[j];
            right[j] = bent * contact + across
                - axial[j] * (across_edge.dot(self.trajectory.slide[i]) + forces.push)
                - motor
                - halved[j] * self.speed[j]
                - stiffness[j] * (self.deflection[j] - rest[j]);
            let momentum: f64 = (0..self.count)
                .map(|k| inertia[(j, k)] * self.speed[k])
                .sum();
            right[j] += momentum / h;
        }
        if !(self.inverse.as_ref()).is_some_and(|(known, _)| known.serves(&key)) {
            self.invert(key, |j, k| {
                let own = if j == k { halved[j] } else { 0.0 };
                let bent = normal[j] + share * axial[j];
                inertia[(j, k)] / h + own + implicit * bent * normal[k]
            });
        }
        let freely = self.solve(&right);
        let dragged = self.solve(&tangential);
        let most = self.cell.friction * forces.contact;
        let grip = most / SLIDING;
        let speed = kinematics.speed[i] + dot(&tangential, &freely);
        let give = dot(&tangential, &dragged);
        let mut friction = grip * speed / (1.0 + grip * give);
        if friction.abs() > most {
            friction = most * friction.signum();
        }
        let mut deflected = self.deflected(&normal, share, i);
        for j in 0..self.count {
            let end = freely[j] - friction * dragged[j];
            let rate = (end - self.speed[j]) / h;
            deflected.surface[2] += 0.5 * normal[j] * rate / share;
            deflected.acceleration += axial[j] * rate;
            self.deflection[j] += 0.5 * h * (self.speed[j] + end);
            self.speed[j] = end;
        }
        deflected
    }

    /// Finds the inverse of what multiplies the speeds.
    fn invert(&mut self, key: Key, element: impl FnMut(usize, usize) -> f64) {
        let matrix = DMatrix::from_fn(self.count, self.count, element);
        // A mass matrix with springs has an inverse.
        let inverse = matrix
            .try_inverse()
            .unwrap_or_else(|| DMatrix::zeros(self.count, self.count));
        self.inverse = Some((key, inverse.as_slice().to_vec()));
    }

    /// Joints whose teeth are apart, one bit each.
    fn apart(&self) -> u8 {
        (0..self.count)
            .filter(|j| !self.spring(*j).engaged(self.deflection[*j]))
            .fold(0, |bits, j| bits | 1 << j)
    }

    /// Stiffness [N m/rad], half of what damping and springs take over a step [N m s/rad], and where the springs rest [rad], of each joint.
    fn springs(&self, h: f64) -> (Joints, Joints, Joints) {
        let (mut stiffness, mut halved, mut rest) =
            ([0.0; MOST_JOINTS], [0.0; MOST_JOINTS], [0.0; MOST_JOINTS]);
        for j in 0..self.count {
            let spring = self.spring(j);
            (stiffness[j], rest[j]) = spring.at(self.deflection[j]);
            halved[j] = (0.5 * spring.damping_time + 0.25 * h) * stiffness[j];
        }
        (stiffness, halved, rest)
    }

    fn solve(&self, right: &Joints) -> Joints {
        let mut out = [0.0; MOST_JOINTS];
        if let Some((_, inverse)) = &self.inverse {
            for k in 0..self.count {
                for j in 0..self.count {
                    out[j] += inverse[k * self.count + j] * right[k];
                }
            }
        }
        out
    }
}

fn dot(a: &Joints, b: &Joints) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
