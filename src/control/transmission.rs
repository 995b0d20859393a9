//! The transmission between a joint's motor and its link: a spring, and play between teeth.
//!
//! ```text
//! B theta'' = tau - T                                      motor, seen from the joint
//! ```
//!
//! theta motor's angle over the gear, where the encoder sits [rad], tau torque of the drive less its losses [N m], B rotor's inertia seen from the joint
//! [kg m2], T torque of the joint's spring at theta less the link's angle (`physics::joint_spring`).
//!
//! The motor takes a step of the midpoint rule against the link as it moves now; the link then meets the spring with the motor in the middle of the step.

use super::law::{DriveLimit, JointLaw};
use crate::physics::joint_spring::JointSpring;

/// A motor behind its transmission.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Motor {
    spring: JointSpring,
    /// Inertia of the rotor seen from the joint [kg m2].
    inertia: f64,
    /// Angle over the gear [rad].
    pub angle: f64,
    /// Its rate [rad/s].
    pub speed: f64,
    /// Angle [rad] and rate [rad/s] in the middle of the last step.
    pub middle: (f64, f64),
    /// Torque of its drive over the last step [N m], and whether the drive's limit cut it.
    pub drive: (f64, bool),
}

impl Motor {
    /// At rest where its servo holds it, carrying a torque [N m]; gives the link's angle too.
    pub fn at_rest(spring: JointSpring, inertia: f64, angle: f64, torque: f64) -> (Self, f64) {
        let link = angle - spring.under(torque);
        let motor = Self {
            spring,
            inertia,
            angle,
            speed: 0.0,
            middle: (angle, 0.0),
            drive: (torque, false),
        };
        (motor, link)
    }

    /// Advances over `dt` [s] under the drive's law within its limit, the link being at an angle [rad] and a speed [rad/s]; gives the law of the link.
    pub fn advance(
        &mut self,
        (drive, limit): (&JointLaw, &DriveLimit),
        (link, link_speed): (f64, f64),
        dt: f64,
    ) -> JointLaw {
        let mut tried = *self;
        let law = tried.follow(drive, (link, link_speed), dt);
        let (angle, speed) = tried.middle;
        let torque = drive.at(angle, speed) - limit.losses.at(0.0, speed);
        tried.drive = (torque, false);
        if torque.abs() <= limit.effort || !torque.is_finite() {
            *self = tried;
            return law;
        }
        let torque = limit.effort.copysign(torque);
        self.drive = (torque, true);
        self.follow(&limit.held(torque), (link, link_speed), dt)
    }

    /// Advances under a law of the drive, whatever torque it takes.
    fn follow(&mut self, drive: &JointLaw, (link, link_speed): (f64, f64), dt: f64) -> JointLaw {
        let (stiffness, side) = self.spring.at(self.angle - link);
        let damping = self.spring.damping_time * stiffness;
        let ahead = link + 0.5 * dt * link_speed;
        let torque = drive.force
            - drive.stiffness * (self.angle - drive.rest)
            - stiffness * (self.angle - ahead - side)
            + damping * link_speed;
        let resistance = 2.0 * self.inertia / dt
            + drive.damping
            + damping
            + 0.5 * dt * (drive.stiffness + stiffness);
        let speed = (2.0 * self.inertia / dt * self.speed + torque) / resistance;
        self.middle = (self.angle + 0.5 * dt * speed, speed);
        self.angle += dt * speed;
        self.speed = 2.0 * speed - self.speed;
        JointLaw {
            force: damping * speed,
            stiffness,
            rest: self.middle.0 - side,
            damping,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SPRING: JointSpring = JointSpring {
        stiffness: 1e5,
        damping_time: 2e-3,
        play: 4e-3,
    };
    /// A drive without limit.
    const FREE: DriveLimit = DriveLimit {
        effort: f64::INFINITY,
        losses: JointLaw {
            force: 0.0,
            stiffness: 0.0,
            rest: 0.0,
            damping: 0.0,
        },
    };

    /// A link of 5 kg m2 under a torque, its motor held by a stiff servo.
    fn settled(parameters: JointSpring, torque: f64) -> f64 {
        let (mut motor, mut link) = Motor::at_rest(parameters, 2.0, 0.3, 0.0);
        let servo = JointLaw {
            force: 0.0,
            stiffness: 1e6,
            rest: 0.3,
            damping: 4e3,
        };
        let (mut speed, dt, inertia) = (0.0, 1e-3, 5.0);
        for _ in 0..4000 {
            let law = motor.advance((&servo, &FREE), (link, speed), dt);
            let pull = law.force - law.stiffness * (link - law.rest) + torque - 20.0 * speed;
            speed =
                (inertia / dt * speed + pull) / (inertia / dt + law.damping + dt * law.stiffness);
            link += dt * speed;
        }
        link - motor.angle
    }

    #[test]
    fn a_loaded_link_is_off_its_motor_by_spring_and_half_the_play() {
        for torque in [150.0, -60.0f64] {
            let expected = torque / 1e5 + 2e-3 * torque.signum();
            assert!((settled(SPRING, torque) - expected).abs() < 1e-6);
        }
        let tight = JointSpring {
            play: 0.0,
            ..SPRING
        };
        assert!((settled(tight, 150.0) - 1.5e-3).abs() < 1e-7);
    }

    #[test]
    fn it_starts_at_rest_under_its_load() {
        let (mut motor, link) = Motor::at_rest(SPRING, 2.0, 0.3, 80.0);
        let servo = JointLaw {
            force: 80.0,
            stiffness: 1e6,
            rest: 0.3,
            damping: 4e3,
        };
        let law = motor.advance((&servo, &FREE), (link, 0.0), 1e-3);
        assert!((law.at(link, 0.0) - 80.0).abs() < 1e-6);
        assert!(motor.speed.abs() < 1e-9);
    }

    #[test]
    fn a_drive_beyond_its_limit_turns_its_motor_with_the_limit() {
        // Free of its link by the play; from rest the limit over the rotor's inertia is its acceleration.
        let (mut motor, link) = Motor::at_rest(SPRING, 2.0, 0.3, 0.0);
        let servo = JointLaw {
            force: 0.0,
            stiffness: 1e6,
            rest: 0.4,
            damping: 4e3,
        };
        let limit = DriveLimit {
            effort: 90.0,
            ..FREE
        };
        motor.advance((&servo, &limit), (link, 0.0), 1e-3);
        assert_eq!(motor.drive, (90.0, true));
        assert!((motor.speed - 90.0 / 2.0 * 1e-3).abs() < 1e-9);
        motor.advance((&servo, &FREE), (link, 0.0), 1e-3);
        assert!(motor.drive.0 > 90.0 && !motor.drive.1);
    }
}
