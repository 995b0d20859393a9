//! The arm's joint servo: per axis proportional, integral and derivative, on top of the torque that the planned motion needs.
//!
//! ```text
//! tau = tau_ff + k_p (q_ref - q) + k_d (v_ref - v) + k_i integral(q_ref - q) dt,   |tau| <= effort
//! k_p = m w^2,  k_d = 2 z w m,  k_i = k_p / T_i
//! ```
//!
//! m the axis's own inertia at the start [kg m2], w natural frequency [rad/s], z damping ratio, T_i integral time [s]. tau_ff is the inverse dynamics of
//! the reference with the device's moving mass, less the contact force's share.
//! The proportional and derivative parts go to the engine as an implicit law, so a stiff servo is stable at any step. What a drive gives is known only when
//! the step is done: whoever takes it holds it to `limit` (`simulation::world`, `transmission`) and says so by `hold`, upon which the integral waits.

use super::law::{DriveLimit, JointLaw};
use crate::arm::chain::KinematicChain;

/// Gains of one axis.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Gains {
    proportional: f64,
    derivative: f64,
    integral: f64,
    effort: f64,
    joint_damping: f64,
    joint_friction: f64,
}

/// Parameters of the servo, the same for all axes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ServoParameters {
    /// Natural frequency [rad/s].
    pub natural_frequency: f64,
    /// Damping ratio [1].
    pub damping_ratio: f64,
    /// Integral time [s]; infinite for none.
    pub integral_time: f64,
}

/// Speed v_0 over which a joint's dry friction turns from one side to the other, as v / sqrt(v^2 + v_0^2) [rad/s].
const FRICTION_SPEED: f64 = 1e-3;

/// The servo of all axes.
#[derive(Debug, Clone)]
pub struct Servo {
    gains: Vec<Gains>,
    integrals: Vec<f64>,
    saturated: Vec<bool>,
    /// The joint's own damping and friction in each axis's last law.
    losses: Vec<JointLaw>,
}

/// Task of the servo for one axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AxisCommand {
    /// Reference in the middle of the step [rad].
    pub position: f64,
    /// Reference speed [rad/s].
    pub velocity: f64,
    /// Torque that the motion needs [N m].
    pub feed_forward: f64,
}

impl Servo {
    /// A servo for the axes of `arm` with their own dry frictions [N m] and inertias [kg m2].
    pub fn new(
        arm: &KinematicChain,
        frictions: &[f64],
        inertias: &[f64],
        parameters: &ServoParameters,
    ) -> Self {
        let gains = arm
            .joints
            .iter()
            .zip(frictions)
            .zip(inertias)
            .map(|((joint, friction), inertia)| {
                let proportional = inertia * parameters.natural_frequency.powi(2);
                Gains {
                    proportional,
                    derivative: 2.0
                        * parameters.damping_ratio
                        * parameters.natural_frequency
                        * inertia,
                    integral: proportional / parameters.integral_time,
                    effort: joint.effort,
                    joint_damping: joint.damping,
                    joint_friction: *friction,
                }
            })
            .collect::<Vec<_>>();
        let count = gains.len();
        Self {
            gains,
            integrals: vec![0.0; count],
            saturated: vec![false; count],
            losses: vec![JointLaw::default(); count],
        }
    }

    /// Law of an axis over the coming step of length `dt` [s], joint damping and friction included.
    pub fn law(
        &mut self,
        axis: usize,
        command: &AxisCommand,
        position: f64,
        velocity: f64,
        dt: f64,
    ) -> JointLaw {
        let gains = &self.gains[axis];
        let error = command.position - (position + 0.5 * dt * velocity);
        if !self.saturated[axis] {
            self.integrals[axis] += gains.integral * error * dt;
        }
        let constant =
            command.feed_forward + self.integrals[axis] + gains.derivative * command.velocity;
        let losses = self.joint_losses(axis, velocity);
        self.losses[axis] = losses;
        JointLaw {
            force: constant + losses.force,
            stiffness: gains.proportional,
            rest: command.position,
            damping: gains.derivative + losses.damping,
        }
    }

    /// Limit of an axis's drive under its last law.
    pub fn limit(&self, axis: usize) -> DriveLimit {
        DriveLimit {
            effort: self.gains[axis].effort,
            losses: self.losses[axis],
        }
    }

    /// Says whether the limit of an axis's drive cut its last law; its integral waits as long as it does.
    pub fn hold(&mut self, axis: usize, cut: bool) {
        self.saturated[axis] = cut;
    }

    /// The joint's own viscous and dry friction, the latter linear about the present speed.
    fn joint_losses(&self, axis: usize, velocity: f64) -> JointLaw {
        let gains = &self.gains[axis];
        let size = (velocity * velocity + FRICTION_SPEED * FRICTION_SPEED).sqrt();
        let level = velocity / size;
        let slope = gains.joint_friction * FRICTION_SPEED * FRICTION_SPEED / size.powi(3);
        JointLaw {
            force: slope * velocity - gains.joint_friction * level,
            damping: gains.joint_damping + slope,
            ..JointLaw::default()
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::arm::chain::{BodyInertia, Joint, JointKind};

    fn servo() -> Servo {
        let joint = Joint {
            name: "axis".into(),
            kind: JointKind::Revolute,
            parent_from_joint: glamx::DPose3::IDENTITY,
            axis: glam::DVec3::Z,
            lower: -3.0,
            upper: 3.0,
            effort: 50.0,
            velocity: 2.0,
            damping: 0.0,
            friction: 0.0,
            body: BodyInertia::ZERO,
        };
        let arm = KinematicChain {
            joints: vec![joint],
            tip_from_last: glamx::DPose3::IDENTITY,
        };
        let parameters = ServoParameters {
            natural_frequency: 100.0,
            damping_ratio: 1.0,
            integral_time: 0.1,
        };
        Servo::new(&arm, &[0.0], &[2.0], &parameters)
    }

    #[test]
    fn a_law_gives_the_stated_gains() {
        let command = AxisCommand {
            position: 0.0,
            velocity: 0.0,
            feed_forward: 7.0,
        };
        let law = servo().law(0, &command, 0.0, 0.0, 1e-3);
        assert_eq!((law.stiffness, law.damping, law.force), (2e4, 400.0, 7.0));
    }

    #[test]
    fn the_integral_waits_while_the_limit_cuts_the_drive() {
        let mut servo = servo();
        let command = AxisCommand {
            position: 0.1,
            velocity: 0.0,
            feed_forward: 0.0,
        };
        let first = servo.law(0, &command, 0.0, 0.0, 1e-3).force;
        servo.hold(0, true);
        for _ in 0..100 {
            assert_eq!(servo.law(0, &command, 0.0, 0.0, 1e-3).force, first);
        }
        servo.hold(0, false);
        assert!(servo.law(0, &command, 0.0, 0.0, 1e-3).force > first);
    }

    #[test]
    fn a_drive_held_at_its_limit_keeps_the_joint_s_losses() {
        let mut servo = servo();
        servo.gains[0].joint_damping = 3.0;
        servo.gains[0].joint_friction = 2.0;
        let command = AxisCommand {
            position: 0.1,
            velocity: 0.0,
            feed_forward: 0.0,
        };
        servo.law(0, &command, 0.0, 2e-4, 1e-3);
        let limit = servo.limit(0);
        let total = limit.held(limit.effort).at(1e-5, 0.05);
        assert!(total < 50.0 - 3.0 * 0.05);
        assert!((total - limit.losses.at(0.0, 0.05) - 50.0).abs() < 1e-12);
    }
}
