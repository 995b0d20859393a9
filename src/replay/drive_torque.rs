//! Torques that the drives of a cell's arm had to give, by its model: the torque of each but for its joint's dry friction; where the tool moves along the edge, or
//! is off it.
//!
//! ```text
//! tau = M(q) q'' + C(q, q') + G(q) + D q' - J_n F_n + J_t mu F_n sat(v)
//! ```
//!
//! M, C, G with the device's moving mass at its stroke, D viscous friction of the URDF, F_n contact force, J_n, J_t levers of the ball along the part's normal
//! and along the edge, mu friction of the tool, v speed along the edge. (Swevers et al., IEEE Control Systems 27(5), 2007: inverse dynamics identification.)

use super::{LoadedCell, ReplayCell};
use crate::arm::dynamics::inverse_dynamics;
use crate::plant::ArmTrajectory;

/// A drive over samples of a recording.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Drive {
    /// Torque that it gave [N m].
    pub torque: Vec<f64>,
    /// Torque that it had to give but for dry friction [N m].
    pub expected: Vec<f64>,
    /// Speed of its motor [rad/s].
    pub rate: Vec<f64>,
    /// Largest torque that it is rated for [N m].
    pub rated: f64,
}

/// Contact force above which the tool touches [N].
const TOUCHING: f64 = 10.0;
/// Speed along the edge at which friction is felt in full [m/s].
const SLIDING: f64 = 1e-3;

impl LoadedCell {
    /// The drives of a recording; none for a joint whose torque was not recorded.
    pub fn drives(
        &self,
        trajectory: &ArmTrajectory,
        torques: &[Option<Vec<f64>>],
        stroke: &[f64],
        force: &[f64],
    ) -> Vec<Option<Drive>> {
        let mut drives: Vec<Option<Drive>> = (torques.iter().zip(&self.cell.chain.joints))
            .map(|(torque, joint)| {
                let rated = joint.effort;
                torque.as_ref().map(|_| Drive {
                    rated,
                    ..Drive::default()
                })
            })
            .collect();
        let count = trajectory.len();
        for i in 1..count.saturating_sub(1) {
            if !(force[i].is_finite() && stroke[i].is_finite()) {
                continue;
            }
            let touches = force[i] > TOUCHING;
            // A tool that rests holds on to the edge by as much as friction lets it, which nothing shows.
            if touches && trajectory.rests(i) {
                continue;
            }
            let pressed = if touches { force[i] } else { 0.0 };
            let friction = self.scenario.contact.friction;
            let (rates, expected) = self
                .cell
                .torques_at(trajectory, i, stroke[i], pressed, friction);
            for (j, drive) in drives.iter_mut().enumerate() {
                if let (Some(drive), Some(torque)) = (drive, &torques[j])
                    && torque[i].is_finite()
                {
                    drive.torque.push(torque[i]);
                    drive.expected.push(expected[j]);
                    drive.rate.push(rates[j]);
                }
            }
        }
        drives
    }
}

impl ReplayCell {
    /// Speeds of the motors and what their drives have to give at a sample, at a stroke [m] and a force along the slide [N].
    fn torques_at(
        &self,
        trajectory: &ArmTrajectory,
        i: usize,
        stroke: f64,
        force: f64,
        friction: f64,
    ) -> (Vec<f64>, Vec<f64>) {
        let span = trajectory.time[i + 1] - trajectory.time[i - 1];
        let joints = &trajectory.joints;
        let q: Vec<f64> = joints.iter().map(|j| j.angle[i]).collect();
        let rates: Vec<f64> = joints
            .iter()
            .map(|j| (j.angle[i + 1] - j.angle[i - 1]) / span)
            .collect();
        let bends: Vec<f64> = joints.iter().map(|j| j.acceleration[i]).collect();
        let mut torques = vec![0.0; q.len()];
        inverse_dynamics(
            &self.loaded(stroke),
            self.world_from_base.rotation,
            self.gravity,
            &q,
            &rates,
            &bends,
            &mut torques,
        );
        let edge = &trajectory.edge[i];
        let centre = |i: usize| trajectory.ball[i] + trajectory.slide[i] * stroke;
        let normal = match &trajectory.sharp {
            Some(sharp) => sharp.touch(centre(i), edge.station).normal,
            None => edge.bisector,
        };
        let speed = (centre(i + 1) - centre(i - 1)).dot(edge.tangent) / span;
        let pressed = force / -normal.dot(trajectory.slide[i]);
        let drag = friction * pressed * (speed / SLIDING).clamp(-1.0, 1.0);
        let on_tool = normal * pressed - edge.tangent * drag;
        let point = centre(i) - normal * self.ball_radius;
        for (j, joint) in joints.iter().enumerate() {
            let lever = joint.axis[i].cross(point - joint.origin[i]);
            torques[j] += self.chain.joints[j].damping * rates[j] - lever.dot(on_tool);
        }
        (rates, torques)
    }
}
