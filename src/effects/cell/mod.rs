//! Effects that a robot cell's model may lack beside its device: those of the arm and of the part.

mod burr;
mod compliant_joint;
mod joint_backlash;
mod joint_encoder_offset;
mod joint_friction;
mod part_misplaced;
mod servo_lag;

pub use servo_lag::SERVO_LAG;

use std::sync::LazyLock;

use super::parts::*;
use crate::plant::MOST_JOINTS;

/// Effects that the recordings of the device show, whatever its arm.
pub static CELL_EFFECTS: [Effect; 2] = [part_misplaced::EFFECT, burr::EFFECT];

/// Effects of each joint that recordings of the device show, base first.
pub static JOINT_EFFECTS: LazyLock<Vec<[Effect; 3]>> = LazyLock::new(|| {
    let of = |joint| {
        [
            compliant_joint::EFFECT,
            joint_encoder_offset::EFFECT,
            joint_backlash::EFFECT,
        ]
        .map(|effect| effect.of_joint(joint))
    };
    (0..MOST_JOINTS).map(of).collect()
});

/// Dry friction of each joint, base first; seen in its drive's torque alone.
pub static JOINT_FRICTION: LazyLock<Vec<Effect>> = LazyLock::new(|| {
    (0..MOST_JOINTS)
        .map(|joint| joint_friction::EFFECT.of_joint(joint))
        .collect()
});
