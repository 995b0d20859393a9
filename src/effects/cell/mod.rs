//! What a robot cell's model may lack beside its device: effects of the arm and of the part.

mod burr;
mod compliant_joint;
mod joint_encoder_offset;
mod part_misplaced;
mod servo_lag;

pub use servo_lag::SERVO_LAG;

use super::effect::{Clues, Effect, Parameter};
use super::quantity::{Coordinate, Quantity};
use crate::plant::MOST_JOINTS;

/// Effects that the recordings of the device show, whatever its arm.
pub static CELL_EFFECTS: [Effect; 2] = [part_misplaced::EFFECT, burr::EFFECT];

/// Effects of each joint, base first.
pub static JOINT_EFFECTS: [[Effect; 2]; MOST_JOINTS] = [
    joint::<0>(),
    joint::<1>(),
    joint::<2>(),
    joint::<3>(),
    joint::<4>(),
    joint::<5>(),
    joint::<6>(),
    joint::<7>(),
];

const fn joint<const J: usize>() -> [Effect; 2] {
    [
        compliant_joint::effect::<J>(),
        joint_encoder_offset::effect::<J>(),
    ]
}

/// Name in the vocabulary of an effect of the catalogue, and the joint that it is about, from 1.
#[must_use]
pub fn vocabulary(name: &str) -> (&str, Option<usize>) {
    for of_joint in [compliant_joint::NAME, joint_encoder_offset::NAME] {
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
        for (index, [spring, encoder]) in JOINT_EFFECTS.iter().enumerate() {
            let joint = index + 1;
            assert_eq!(vocabulary(spring.name), ("compliant_joint", Some(joint)));
            let name = vocabulary(encoder.name);
            assert_eq!(name, ("joint_encoder_offset", Some(joint)));
        }
        assert_eq!(vocabulary("burr"), ("burr", None));
    }
}
