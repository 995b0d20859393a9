//! A flange that carries a device whose mass slides: what that mass and a contact of its tool do to the flange, as from outside.
//!
//! Both are given about the origin of the description's flange and in its axes; the slide's own mount may stand turned or shifted to it.

use glam::{DQuat, DVec3};
use glamx::DPose3;

use super::ArmParameters;
use super::outside::OutsideWrench;
use super::sliding_mass::SlidingMass;
use crate::arm::chain::{KinematicChain, MAX_JOINTS};
use crate::arm::dynamics::{LinkState, link_states};
use crate::arm::kinematics::tip_pose;

/// A flange with a device.
pub struct DeviceMount<'a> {
    /// The arm.
    pub arm: &'a ArmParameters,
    /// The arm up to the mount of the slide.
    pub mount: &'a KinematicChain,
    /// Base in the world.
    pub world_from_base: DPose3,
    /// The mass that slides.
    pub slide: SlidingMass,
}

impl DeviceMount<'_> {
    /// Mount of the slide and flange of the description at angles of the joints [rad], in the world.
    fn frames(&self, q: &[f64]) -> [DPose3; 2] {
        [self.mount, &self.arm.chain].map(|chain| tip_pose(chain, self.world_from_base, q))
    }

    /// A point on the slide's axis so far along it from its mount [m], in the world.
    #[must_use]
    pub fn on_axis(&self, q: &[f64], along: f64) -> DVec3 {
        let [slides, _] = self.frames(q);
        slides.transform_point(DVec3::Z * along)
    }

    /// A force on the tool [N] at a point [m], both in the world.
    #[must_use]
    pub fn pressed(&self, q: &[f64], point: DVec3, force: DVec3) -> OutsideWrench {
        let [_, own] = self.frames(q);
        let point = own.inverse().transform_point(point);
        OutsideWrench::at(point, own.rotation.inverse() * force)
    }

    /// The sliding mass beyond what it does at the retracted end: angles, speeds and accelerations of the joints; stroke [m], its rate and acceleration.
    #[must_use]
    pub fn sliding(&self, motion: [&[f64]; 3], stroke: [f64; 3]) -> OutsideWrench {
        let chain = &self.arm.chain;
        let mut links = [LinkState::AT_REST; MAX_JOINTS];
        let gravity = self.arm.true_gravity();
        link_states(chain, DQuat::IDENTITY, gravity, motion, &mut links);
        let last = links[chain.len() - 1]
            .motion()
            .of_fixed(&self.mount.tip_from_last);
        let [slides, own] = self.frames(motion[0]);
        let sliding = self.slide.beyond_retracted(&last, stroke);
        sliding.seen_from(&(own.inverse() * slides))
    }
}
