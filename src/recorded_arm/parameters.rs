//! Description of a recorded arm in numbers, what it nominally is or what a diagnosis found; the same type for both.

use glam::{DMat3, DQuat, DVec3};
use glamx::DPose3;

use super::law::JointLaw;
use super::outside::OutsideError;
use super::push::Push;
use super::wrench::WrenchSensor;
use crate::arm::chain::{BodyInertia, KinematicChain, point_mass_inertia};

/// A body so compact that its own inertia counts nothing.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct PointMass {
    /// Mass [kg].
    pub mass: f64,
    /// Mass times its centre, in the flange's axes [kg m].
    pub moment: DVec3,
}

impl PointMass {
    /// Its centre from the flange, in its axes [m].
    #[must_use]
    pub fn centre(&self) -> DVec3 {
        if self.mass > 0.0 {
            self.moment / self.mass
        } else {
            DVec3::ZERO
        }
    }

    /// As a body in the flange's frame.
    fn body(&self) -> BodyInertia {
        BodyInertia {
            mass: self.mass,
            centre_of_mass: self.centre(),
            inertia: DMat3::ZERO,
        }
    }
}

/// One joint's drive, and what acts at its joint.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Drive {
    /// Amperes per newton metre [A/(N m)]; 1 where torques are logged.
    pub inverse_gain: f64,
    /// Whether currents are logged.
    pub logs_current: bool,
    /// Inertia of motor and gear at the joint's side [kg m2].
    pub motor_inertia: f64,
    /// Dry friction [N m].
    pub coulomb: f64,
    /// Viscous friction [N m s/rad].
    pub viscous: f64,
    /// Length over which friction builds up after a reversal [rad].
    pub bristle_length: f64,
    /// Static less dry friction [N m].
    pub static_excess: f64,
    /// Stribeck velocity [rad/s].
    pub stribeck_velocity: f64,
    /// Dry friction per torque that the gear carries [1].
    pub load_friction: f64,
    /// Share by which friction falls as the joint warms [1].
    pub warm_fraction: f64,
    /// Time constant of that [s].
    pub warm_time: f64,
    /// Torque that the motor must give in addition [N m].
    pub offset: f64,
    /// Gear ripple: factors of sine and cosine [N m].
    pub ripple: [f64; 2],
    /// Cycles of the ripple a turn of the joint [1].
    pub ripple_cycles: f64,
    /// Stiffness of what pulls the joint to a rest angle [N m/rad]; its rest is in the offset.
    pub spring_stiffness: f64,
    /// Encoder: measured less true [rad].
    pub encoder_offset: f64,
    /// Compliance of the gear [rad/(N m)].
    pub compliance: f64,
}

/// Length over which friction builds up where nothing is known of it [rad].
pub const USUAL_BRISTLE_LENGTH: f64 = 1e-4;

impl Default for Drive {
    fn default() -> Self {
        Self {
            inverse_gain: 1.0,
            logs_current: false,
            motor_inertia: 0.0,
            coulomb: 0.0,
            viscous: 0.0,
            bristle_length: USUAL_BRISTLE_LENGTH,
            static_excess: 0.0,
            stribeck_velocity: 0.05,
            load_friction: 0.0,
            warm_fraction: 0.0,
            warm_time: 10.0,
            offset: 0.0,
            ripple: [0.0; 2],
            ripple_cycles: 0.0,
            spring_stiffness: 0.0,
            encoder_offset: 0.0,
            compliance: 0.0,
        }
    }
}

/// A recorded arm.
#[derive(Debug, Clone, PartialEq)]
pub struct ArmParameters {
    /// Joints, links without load or tool, and the flange as its tip.
    pub chain: KinematicChain,
    /// Gravity in the base's axes if it stands as declared [m/s2].
    pub gravity: DVec3,
    /// How the base stands turned: about its x, then about the y it had before [rad].
    pub tilt: [f64; 2],
    /// Drives, base first.
    pub drives: Vec<Drive>,
    /// Declared load at the flange, not felt by a wrench sensor.
    pub load: PointMass,
    /// Load that is not declared.
    pub payload: PointMass,
    /// Wrench sensor between flange and tool.
    pub wrench: Option<WrenchSensor>,
    /// How late currents and torques are stamped [s].
    pub delay: f64,
    /// Pushes from outside.
    pub pushes: Vec<Push>,
    /// Laws that act at joints and have no name.
    pub laws: Vec<JointLaw>,
    /// How far what acts from outside is off what recordings state of it.
    pub outside_error: OutsideError,
}

impl ArmParameters {
    /// Number of joints.
    #[must_use]
    pub fn joints(&self) -> usize {
        self.chain.len()
    }

    /// Gravity in the axes of the base as it stands [m/s2].
    #[must_use]
    pub fn true_gravity(&self) -> DVec3 {
        let [roll, pitch] = self.tilt;
        (DQuat::from_rotation_y(pitch) * DQuat::from_rotation_x(roll)).inverse() * self.gravity
    }

    /// The chain with all that its last link carries.
    #[must_use]
    pub fn loaded_chain(&self) -> KinematicChain {
        let mut chain = self.chain.clone();
        let tip = chain.tip_from_last;
        if let Some(last) = chain.joints.last_mut() {
            for body in [self.load.body(), self.payload.body()] {
                last.body = last.body.welded_to(&body.seen_from(&tip));
            }
            if let Some(wrench) = &self.wrench {
                let origin = DPose3::from_translation(DVec3::Z * wrench.height);
                let tool = wrench.tool().seen_from(&origin).seen_from(&tip);
                last.body = last.body.welded_to(&tool);
            }
        }
        chain
    }

    /// Whether joints give under load.
    #[must_use]
    pub fn is_soft(&self) -> bool {
        self.drives.iter().any(|drive| drive.compliance != 0.0)
    }

    /// Whether the rigid bodies of two arms move alike and are alike: all that inverse dynamics depends on.
    #[must_use]
    pub fn is_rigidly_as(&self, other: &Self) -> bool {
        let tool = |arm: &Self| arm.wrench.as_ref().map(|w| (w.height, w.tool()));
        self.moves_as(other)
            && self.chain == other.chain
            && self.load == other.load
            && self.payload == other.payload
            && tool(self) == tool(other)
            && self
                .drives
                .iter()
                .zip(&other.drives)
                .all(|(a, b)| a.compliance == b.compliance)
    }

    /// Whether the links of two arms move alike, whatever they weigh, as long as no joint gives.
    #[must_use]
    pub fn moves_as(&self, other: &Self) -> bool {
        let drives = self.drives.iter().zip(&other.drives);
        self.gravity == other.gravity
            && self.tilt == other.tilt
            && self.outside_error == other.outside_error
            && drives
                .into_iter()
                .all(|(a, b)| a.encoder_offset == b.encoder_offset)
    }
}

/// Gives a link another mass: its inertia tensor scales with it.
pub fn set_mass(body: &mut BodyInertia, mass: f64) {
    if body.mass > 0.0 {
        body.inertia *= mass / body.mass;
    }
    body.mass = mass;
}

/// Inertia of a body about an origin [kg m2].
#[must_use]
pub fn inertia_about_origin(body: &BodyInertia) -> DMat3 {
    body.inertia + point_mass_inertia(body.mass, body.centre_of_mass)
}
