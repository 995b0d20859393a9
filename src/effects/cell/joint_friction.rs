//! A joint rubs more, or less, than believed: bearings and gears, dry.
//!
//!     tau = tau_frictionless + F sat(q'/v_0)      (Swevers et al., IEEE Control Systems 27(5), 2007)
//!
//! Signature: the torque of one drive has a part with the sign of its joint's speed, the same size whatever the load; tool and surface hardly show it.
//! Confused with: nothing, for it is seen in a link of its own, from the motion to the drives' torques, beside which the device is looked at.

use super::*;
use Coordinate::Linear;

/// Name in the vocabulary.
pub(super) const NAME: &str = "joint_friction";

pub(super) const fn effect<const J: usize>() -> Effect {
    Effect {
        name: numbered(
            [
                "joint_friction_1",
                "joint_friction_2",
                "joint_friction_3",
                "joint_friction_4",
                "joint_friction_5",
                "joint_friction_6",
                "joint_friction_7",
                "joint_friction_8",
            ],
            J,
        ),
        subsystem: super::super::Subsystem::Arm,
        group: None,
        parameters: |_| {
            vec![reported(
                Quantity {
                    name: "friction_n_m",
                    get: |p| p.cell.joint_friction[J],
                    set: |p, v| p.cell.joint_friction[J] = v,
                },
                Linear(1.0),
                [0.0, 1e4],
            )]
        },
        usual: |p| vec![p.cell.joint_friction[J] + 20.0],
        starts: |clues: &Clues<'_>| vec![vec![clues.plant.cell.joint_friction[J]]],
    }
}
