//! A cell's arm over a recording, reduced to what the device at its end feels.
//!
//! ```text
//! d = x c - s                  penetration along the bisector n of the edge, the links' swing aside (`joint_deflections`)
//! s = n . (b - e) - r - l      standoff at no stroke
//! c = -n . a                   share of the stroke that goes into the part
//! ```
//!
//! b ball's centre at no stroke, a slide's axis, e point of the edge, r radius of the ball, l how far the part stands out (a burr is met by the ball alone,
//! `simulate`), x stroke. Joints that are off turn all behind them about their axes, from the last one to the first: the product of exponentials (Brockett,
//! 1984; Lynch, Park, Modern Robotics, 2017, sec. 4.1), exact whatever their size.
//!
//! ```text
//! l = n . u,   u = shift n_0 + tilt (t_0 x n_0) x (e - e_0)          small displacement of a rigid part (Siciliano et al., Robotics, 2009, sec. 2.4)
//! ```
//!
//! e_0, t_0, n_0 middle of the edge, its direction and bisector there.

use super::cell_parameters::{CellParameters, MOST_JOINTS};
use super::observation::Observation;
use super::servo::follow;
use super::sharp_edge::{EdgeStation, SharpEdge};
use glam::{DQuat, DVec3};
use nalgebra::DMatrix;
use std::sync::Arc;

/// One joint over a recording.
#[derive(Debug, Clone, PartialEq)]
pub struct JointTrajectory {
    /// Commanded angle [rad].
    pub command: Vec<f64>,
    /// Angle of the motor that everything else in the trajectory goes with [rad].
    pub angle: Vec<f64>,
    /// Its axis in the base frame [1].
    pub axis: Vec<DVec3>,
    /// A point on its axis in the base frame [m].
    pub origin: Vec<DVec3>,
    /// Acceleration of that angle [rad/s2].
    pub acceleration: Vec<f64>,
    /// Torque that accelerates what is behind it [N m].
    pub torque: Vec<f64>,
}

/// A cell's arm over a recording.
#[derive(Debug, Clone, PartialEq)]
pub struct ArmTrajectory {
    /// Sample times [s].
    pub time: Vec<f64>,
    /// The joints, base first.
    pub joints: Vec<JointTrajectory>,
    /// Bandwidth of the servos that gave `angle` [Hz].
    pub bandwidth: f64,
    /// Centre of the ball at no stroke [m].
    pub ball: Vec<DVec3>,
    /// Direction of the slide [1].
    pub slide: Vec<DVec3>,
    /// The edge beside the ball.
    pub edge: Vec<EdgeStation>,
    /// The edge as the ball meets it; none where it is met along its bisector.
    pub sharp: Option<Arc<SharpEdge>>,
    /// Its observation.
    pub observed: Observation,
    /// Its middle, about which a part that does not lie where it should is turned.
    pub middle: EdgeStation,
    /// Radius of the ball [m].
    pub ball_radius: f64,
    /// Contact Jacobians of the joints; see [`ArmTrajectory::jacobian_at`].
    pub jacobians: Vec<ContactJacobian>,
    /// Mass matrices of every [`INERTIA_EVERY`]th sample, without the moving mass's along the slide [kg m2].
    pub inertia: Vec<DMatrix<f64>>,
    /// Moving mass [kg].
    pub moving_mass: f64,
    /// Distance of the moving mass's centre behind the ball's [m].
    pub mass_behind_ball: f64,
    /// Stroke at which the moving mass's centre is taken to be accelerated [m].
    pub usual_stroke: f64,
    /// Gravity [m/s2].
    pub gravity: DVec3,
}

/// Contact Jacobians of the joints in one sample: of the ball at no stroke, and what a stroke adds to them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ContactJacobian {
    /// Along the bisector [m], [1].
    pub normal: [[f64; MOST_JOINTS]; 2],
    /// Along the edge [m], [1].
    pub tangential: [[f64; MOST_JOINTS]; 2],
    /// Along the slide [m].
    pub axial: [f64; MOST_JOINTS],
}

/// Loads that the device feels of it, one value per sample.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct ContactKinematics {
    /// Standoff s [m].
    pub standoff: Vec<f64>,
    /// Share c [1].
    pub share: Vec<f64>,
    /// Gravity less the flange's acceleration, along the slide [m/s2].
    pub pull: Vec<f64>,
    /// Height of the burr under the ball [m].
    pub burr: Vec<f64>,
    /// Speed of the ball along the edge [m/s].
    pub speed: Vec<f64>,
    /// Force that accelerates the moving mass with the flange, along the slide [N].
    pub carried: Vec<f64>,
    /// Centre of the ball at no stroke [m].
    pub balls: Vec<DVec3>,
    /// Direction of the slide [1].
    pub slides: Vec<DVec3>,
    /// Displacement of the part under the ball [m].
    pub aside: Vec<DVec3>,
}

/// Samples to a mass matrix: an arm hardly changes its posture in so many.
pub const INERTIA_EVERY: usize = 16;
/// Commanded speed along the edge below which a tool may still hold on to it by friction [m/s].
const RESTING: f64 = 3e-3;
/// Speed along the edge at which friction is full [m/s].
pub(super) const SLIDING: f64 = 1e-3;

impl ArmTrajectory {
    /// Number of samples.
    pub fn len(&self) -> usize {
        self.time.len()
    }

    /// Whether there is no sample.
    pub fn is_empty(&self) -> bool {
        self.time.is_empty()
    }

    /// Whether the tool rests where it is, instead of being moved along the edge.
    pub fn rests(&self, i: usize) -> bool {
        let (before, after) = (i.saturating_sub(1), (i + 1).min(self.len() - 1));
        let way = self.edge[after].station - self.edge[before].station;
        way.abs() < RESTING * (self.time[after] - self.time[before])
    }

    /// Levers of a sample, for `levers`.
    pub fn jacobian_at(&self, i: usize) -> ContactJacobian {
        let edge = &self.edge[i];
        let zero = [0.0; MOST_JOINTS];
        let mut levers = ContactJacobian {
            normal: [zero; 2],
            tangential: [zero; 2],
            axial: zero,
        };
        for (j, joint) in self.joints.iter().enumerate() {
            let axis = joint.axis[i];
            let swings = [
                axis.cross(self.ball[i] - joint.origin[i]),
                axis.cross(self.slide[i]),
            ];
            for (part, swing) in swings.into_iter().enumerate() {
                levers.normal[part][j] = swing.dot(edge.bisector);
                levers.tangential[part][j] = swing.dot(edge.tangent);
            }
            levers.axial[j] = swings[0].dot(self.slide[i]);
        }
        levers
    }

    /// Loads that the device feels.
    pub fn contact_kinematics(&self, cell: &CellParameters) -> ContactKinematics {
        let turns = self.turns(cell);
        let count = self.len();
        let mut balls = Vec::with_capacity(count);
        let mut slides = Vec::with_capacity(count);
        for i in 0..count {
            let (mut ball, mut slide) = (self.ball[i], self.slide[i]);
            for (joint, turn) in self.joints.iter().zip(&turns).rev() {
                let angle = turn.at(i);
                if angle != 0.0 {
                    let turned = DQuat::from_axis_angle(joint.axis[i], angle);
                    ball = joint.origin[i] + turned * (ball - joint.origin[i]);
                    slide = turned * slide;
                }
            }
            balls.push(ball);
            slides.push(slide);
        }
        let mut kinematics = ContactKinematics::default();
        for i in 0..count {
            self.note(&mut kinematics, cell, i, &balls, &slides);
        }
        kinematics.balls = balls;
        kinematics.slides = slides;
        kinematics
    }

    /// Departure of each joint from the trajectory.
    fn turns(&self, cell: &CellParameters) -> Vec<Turn> {
        let moved = cell.servo_bandwidth != self.bandwidth;
        let turn = |(joint, offset): (&JointTrajectory, f64)| {
            // The servo closes on the encoder: the arm stands off by what it reads too much.
            if moved {
                let of = |bandwidth| follow(&self.time, &joint.command, bandwidth).angle;
                let (there, here) = (of(cell.servo_bandwidth), of(self.bandwidth));
                let away = there.iter().zip(&here);
                Turn::Trajectory(away.map(|(there, here)| there - here - offset).collect())
            } else {
                Turn::Constant(-offset)
            }
        };
        self.joints
            .iter()
            .zip(cell.encoder_offset)
            .map(turn)
            .collect()
    }

    fn note(
        &self,
        kinematics: &mut ContactKinematics,
        cell: &CellParameters,
        i: usize,
        balls: &[DVec3],
        slides: &[DVec3],
    ) {
        let edge = &self.edge[i];
        let n = edge.bisector;
        let (ball, slide) = (balls[i], slides[i]);
        let along = (ball + slide * self.usual_stroke - edge.point).dot(edge.tangent);
        let station = edge.station + along;
        let aside = cell.aside(&self.middle, edge.point + edge.tangent * along);
        let (standoff, share) = match &self.sharp {
            None => (
                n.dot(ball - edge.point - aside) - self.ball_radius,
                -n.dot(slide),
            ),
            Some(sharp) => {
                // As it would be at the usual stroke.
                let centre = ball + slide * self.usual_stroke - aside;
                let touch = sharp.touch(centre, station);
                let share = -touch.normal.dot(slide);
                let standoff = touch.distance - self.ball_radius + share * self.usual_stroke;
                (standoff, share)
            }
        };
        let speed = self.slope(i, |j| balls[j]).dot(edge.tangent);
        let mass_at = |j: usize| balls[j] + slides[j] * (self.usual_stroke - self.mass_behind_ball);
        let acceleration = self.curvature(i, mass_at);
        kinematics.aside.push(aside);
        kinematics.standoff.push(standoff);
        kinematics.share.push(share);
        kinematics.burr.push(cell.burr.at(station));
        kinematics.speed.push(speed);
        kinematics
            .carried
            .push(self.moving_mass * acceleration.dot(slide));
        kinematics
            .pull
            .push((self.gravity - acceleration).dot(slide));
    }

    /// Rate of a point that is known at the samples [m/s].
    fn slope(&self, i: usize, at: impl Fn(usize) -> DVec3) -> DVec3 {
        let (before, after) = (i.saturating_sub(1), (i + 1).min(self.len() - 1));
        (at(after) - at(before)) / (self.time[after] - self.time[before])
    }

    /// Acceleration of such a point [m/s2]; none at the ends, where everything rests.
    fn curvature(&self, i: usize, at: impl Fn(usize) -> DVec3) -> DVec3 {
        if i == 0 || i + 1 == self.len() {
            return DVec3::ZERO;
        }
        let [before, after] = [
            self.time[i] - self.time[i - 1],
            self.time[i + 1] - self.time[i],
        ];
        let rise = (at(i + 1) - at(i)) / after - (at(i) - at(i - 1)) / before;
        rise * 2.0 / (before + after)
    }
}

/// Departure of a joint from a trajectory [rad].
enum Turn {
    Constant(f64),
    Trajectory(Vec<f64>),
}

impl Turn {
    fn at(&self, i: usize) -> f64 {
        match self {
            Self::Constant(angle) => *angle,
            Self::Trajectory(angles) => angles[i],
        }
    }
}

impl ContactKinematics {
    /// Where the edge stands along the slide [m].
    pub fn surface(&self) -> Vec<f64> {
        let pairs = self.standoff.iter().zip(&self.share);
        pairs.map(|(standoff, share)| standoff / share).collect()
    }
}
