//! Torques that the drives of a cell's arm had to give, by its model: the torque of each but for its joint's dry friction; where the tool moves along the edge, or
//! is off it.
//!
//! ```text
//! tau = M(q) q'' + C(q, q') + G(q) + D q' - J_n F_n + J_t mu F_n sat(v)
//! ```
//!
//! M, C, G with the device's moving mass at its stroke, D viscous friction of the URDF, F_n contact force, J_n, J_t levers of the ball along the part's normal
//! and along the edge, mu friction of the tool, v speed along the edge. A ball that stands a little off its place meets a sharp edge on another normal, and mu is
//! known roughly: the shares of a contact force along normal and across it, and of the friction, are given beside. (Swevers et al., IEEE Control Systems 27(5), 2007: inverse dynamics identification.)

use super::contact_load::{Touching, touching_at};
use super::load::LoadedCell;
use crate::arm::dynamics::inverse_dynamics;
use crate::plant::{ArmTrajectory, JointTrajectory};

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
    /// Torque that the contact force along the normal, the same across it, and the tool's friction take [N m].
    pub contact: Vec<[f64; 3]>,
}

/// A drive that may give less than this may give nothing [N m].
const LEAST_TORQUE: f64 = 1e-3;

/// What the drives have to give at a sample.
struct Load {
    /// Speeds of the motors [rad/s].
    rates: Vec<f64>,
    /// Torques expected but for dry friction [N m].
    torques: Vec<f64>,
    /// Torques of the contact, as in [`Drive`] [N m].
    contact: Vec<[f64; 3]>,
}

impl LoadedCell {
    /// The drives of a recording; none for a joint whose torque was not recorded.
    pub fn drives(
        &self,
        trajectory: &ArmTrajectory,
        torques: &[Option<Vec<f64>>],
        stroke: &[f64],
        force: &[f64],
    ) -> Vec<Option<Drive>> {
        let mut drives: Vec<Option<Drive>> = (torques.iter().zip(&self.chain.joints))
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
            let touches = force[i] > self.scenario.touching();
            // A tool that rests holds on to the edge by as much as friction lets it, which nothing shows.
            if touches && trajectory.rests(i) {
                continue;
            }
            let touching = touching_at(trajectory, i, stroke[i]);
            let pressed = if touches {
                force[i] / -touching.normal.dot(trajectory.slide[i])
            } else {
                0.0
            };
            let load = self.torques_at(trajectory, i, stroke[i], (&touching, pressed));
            for (j, drive) in drives.iter_mut().enumerate() {
                if let (Some(drive), Some(torque)) = (drive, &torques[j])
                    && torque[i].is_finite()
                {
                    drive.torque.push(torque[i]);
                    drive.expected.push(load.torques[j]);
                    drive.rate.push(load.rates[j]);
                    drive.contact.push(load.contact[j]);
                }
            }
        }
        drives
    }

    /// Largest share of the torque that a drive may give, over the drives and the samples of a motion: strokes [m] and contact forces [N] by sample; dry friction
    /// of a drive is counted in full, `limits` are the largest torques [N m].
    pub fn torque_share(
        &self,
        trajectory: &ArmTrajectory,
        (stroke, force): (&[f64], &[f64]),
        friction: &[f64],
        limits: &[f64],
    ) -> f64 {
        let inner = 1..trajectory.len().saturating_sub(1);
        let shares = inner.flat_map(|i| {
            let touching = touching_at(trajectory, i, stroke[i]);
            let load = self.torques_at(trajectory, i, stroke[i], (&touching, force[i]));
            let drives = load.torques.into_iter().zip(friction).zip(limits);
            drives.map(|((torque, friction), most)| {
                (torque.abs() + friction) / most.max(LEAST_TORQUE)
            })
        });
        shares.fold(0.0, f64::max)
    }

    /// Speeds of the motors and what their drives have to give at a sample, at a stroke [m] and a contact force [N].
    fn torques_at(
        &self,
        trajectory: &ArmTrajectory,
        i: usize,
        stroke: f64,
        (touching, pressed): (&Touching, f64),
    ) -> Load {
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
            self.scenario.arm.world_from_base.rotation,
            self.scenario.gravity,
            &q,
            &rates,
            &bends,
            &mut torques,
        );
        let Touching {
            centre,
            normal,
            sliding,
        } = *touching;
        let tangent = trajectory.edge[i].tangent;
        let drag = self.scenario.nominal.cell.friction * pressed * sliding;
        let across = tangent.cross(normal);
        let on_tool = [normal * pressed, across * pressed, -tangent * drag];
        let point = centre - normal * self.scenario.nominal.mounting.tool_radius;
        let of = |joint: &JointTrajectory| {
            let lever = joint.axis[i].cross(point - joint.origin[i]);
            on_tool.map(|force| -lever.dot(force))
        };
        let contact: Vec<[f64; 3]> = joints.iter().map(of).collect();
        for (j, [along, _, drags]) in contact.iter().enumerate() {
            torques[j] += self.chain.joints[j].damping * rates[j] + along + drags;
        }
        Load {
            rates,
            torques,
            contact,
        }
    }
}
