//! What a robot cell's model may lack beside its device: effects of the arm and of the part.

mod burr;
mod compliant_joint;
mod joint_backlash;
mod joint_encoder_offset;
mod joint_friction;
mod part_misplaced;
mod servo_lag;

pub use servo_lag::SERVO_LAG;

use super::effect::{Clues, Effect, Parameter};
use super::quantity::{Coordinate, Quantity};
use crate::plant::MOST_JOINTS;

/// Effects that the recordings of the device show, whatever its arm.
pub static CELL_EFFECTS: [Effect; 2] = [part_misplaced::EFFECT, burr::EFFECT];

/// Effects of each joint, base first.
pub static JOINT_EFFECTS: [[Effect; 3]; MOST_JOINTS] = [
    joint::<0>(),
    joint::<1>(),
    joint::<2>(),
    joint::<3>(),
    joint::<4>(),
    joint::<5>(),
    joint::<6>(),
    joint::<7>(),
];

/// Dry friction of each joint, base first; seen in its drive's torque alone.
pub static JOINT_FRICTION: [Effect; MOST_JOINTS] = [
    joint_friction::effect::<0>(),
    joint_friction::effect::<1>(),
    joint_friction::effect::<2>(),
    joint_friction::effect::<3>(),
    joint_friction::effect::<4>(),
    joint_friction::effect::<5>(),
    joint_friction::effect::<6>(),
    joint_friction::effect::<7>(),
];

const fn joint<const J: usize>() -> [Effect; 3] {
    [
        compliant_joint::effect::<J>(),
        joint_encoder_offset::effect::<J>(),
        joint_backlash::effect::<J>(),
    ]
}

/// Name in the vocabulary of an effect of the catalogue, and the joint that it is about, from 1.
#[must_use]
pub fn vocabulary(name: &str) -> (&str, Option<usize>) {
    for of_joint in [
        compliant_joint::NAME,
        joint_encoder_offset::NAME,
        joint_backlash::NAME,
        joint_friction::NAME,
    ] {
        let number = name
            .strip_prefix(of_joint)
            .and_then(|n| n.strip_prefix('_'));
        if let Some(joint) = number.and_then(|n| n.parse().ok()) {
            return (of_joint, Some(joint));
        }
    }
    (name, None)
}

/// One of the names that end with a joint's number.
const fn numbered(names: [&'static str; MOST_JOINTS], joint: usize) -> &'static str {
    names[joint]
}

fn reported(quantity: Quantity, coordinate: Coordinate, bounds: [f64; 2]) -> Parameter {
    Parameter {
        quantity,
        coordinate,
        bounds,
        reported: true,
        choices: &[],
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_joint_s_effect_says_which_joint() {
        for (index, [spring, encoder, play]) in JOINT_EFFECTS.iter().enumerate() {
            let joint = index + 1;
            assert_eq!(vocabulary(spring.name), ("compliant_joint", Some(joint)));
            let name = vocabulary(encoder.name);
            assert_eq!(name, ("joint_encoder_offset", Some(joint)));
            assert_eq!(vocabulary(play.name), ("joint_backlash", Some(joint)));
        }
        assert_eq!(vocabulary("burr"), ("burr", None));
    }
}
