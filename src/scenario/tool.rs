//! `[tool]` and `[removal]` of a scenario file.

use super::file::{RemovalKeys, RemovalWord, SpindleSense, SpindleStart, ToolKeys, ToolShapeWord};
use super::{RemovalScenario, ToolScenario};
use crate::keys::check::Section;
use crate::keys::error::ScenarioError;
use crate::physics::cutting_force::CuttingForce;
use crate::physics::removal_law::RemovalLaw;
use crate::physics::spindle::Spindle;
use crate::removal::{ToolShape, TurningTool};

/// The tool, its ball of a radius [m].
pub(super) fn tool(
    section: &Section<'_>,
    keys: &ToolKeys,
    ball_radius: f64,
) -> Result<ToolScenario, ScenarioError> {
    section.of_kind::<ToolKeys>(None)?;
    Ok(ToolScenario {
        tool: TurningTool {
            shape: shape(section, keys, ball_radius)?,
            sense: match keys.sense {
                SpindleSense::Clockwise => 1.0,
                SpindleSense::Counterclockwise => -1.0,
            },
            lead: keys.lead,
            lean: keys.lean,
        },
        spindle: Spindle {
            free_speed: keys.spindle_speed,
            stall_torque: keys.stall_torque,
        },
        while_following: keys.start == SpindleStart::Follow,
    })
}

fn shape(
    section: &Section<'_>,
    keys: &ToolKeys,
    ball_radius: f64,
) -> Result<ToolShape, ScenarioError> {
    // What a shape needs is there by now.
    let needed = |value: Option<f64>| value.unwrap_or_default();
    Ok(match keys.shape {
        ToolShapeWord::Ball => ToolShape::Ball {
            radius: ball_radius,
        },
        ToolShapeWord::Belt => ToolShape::Belt {
            wheel_radius: needed(keys.wheel_radius),
        },
        ToolShapeWord::Cone => {
            let flank = needed(keys.cone_length);
            let contact = keys.cone_contact.unwrap_or(0.5 * flank);
            if contact > flank {
                let expected = format!(
                    "at most cone_length_mm, {} mm: beyond it the tip does not reach the edge",
                    flank * 1e3
                );
                return Err(section.refuse_si("cone_contact_mm", contact, expected));
            }
            ToolShape::Cone {
                half_angle: 0.5 * needed(keys.cone_angle),
                flank,
                contact,
                tip_radius: keys.cone_tip_radius,
            }
        }
    })
}

/// What the tool takes off.
pub(super) fn removal(
    section: &Section<'_>,
    keys: &RemovalKeys,
) -> Result<RemovalScenario, ScenarioError> {
    section.of_kind::<RemovalKeys>(None)?;
    // What a law needs is there by now.
    let needed = |value: Option<f64>| value.unwrap_or_default();
    let threshold = match (keys.law, keys.threshold_force) {
        (RemovalWord::Threshold, None) => {
            let expected = "it to be given with law = \"threshold\"";
            return Err(section.missing("threshold_force_n", expected));
        }
        (_, given) => needed(given),
    };
    let mut law = match keys.law {
        RemovalWord::Preston | RemovalWord::Threshold => {
            RemovalLaw::preston(needed(keys.coefficient))
        }
        RemovalWord::Power => RemovalLaw {
            rate: needed(keys.rate),
            reference_speed: needed(keys.reference_speed),
            reference_force: needed(keys.reference_force),
            reference_area: keys.reference_area,
            speed_exponent: keys.speed_exponent,
            force_exponent: needed(keys.force_exponent),
            area_exponent: keys.area_exponent,
            threshold_force: threshold,
            wear_work: f64::INFINITY,
        },
    };
    if let RemovalWord::Threshold = keys.law {
        law.threshold_force = threshold;
        // Q = K v (F - F_t), whatever the threshold is.
        law.reference_force += threshold;
    }
    if law.threshold_force >= law.reference_force {
        let expected = format!("less than reference_force_n, {} N", law.reference_force);
        return Err(section.refuse_si("threshold_force_n", law.threshold_force, expected));
    }
    law.wear_work = keys.wear_work;
    Ok(RemovalScenario {
        law,
        contact_area: keys.contact_area,
        wear_at_start: keys.wear_at_start,
        contact_length: keys.contact_length,
        cutting: CuttingForce {
            specific_energy: keys.specific_energy,
            friction: keys.friction,
        },
    })
}
