//! `[tool]` and `[removal]` of a scenario file.

use super::check::Section;
use super::error::ScenarioError;
use super::file::{RemovalKeys, RemovalWord, SpindleSense, SpindleStart, ToolKeys, ToolShapeWord};
use super::{RemovalScenario, ToolScenario};
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
    let speed = section.number("spindle_speed_rpm", keys.spindle_speed_rpm, 1.0..=200_000.0)?;
    let angle =
        |key: &str, value: Option<f64>| section.number(key, value.unwrap_or(0.0), -180.0..=180.0);
    let stall = keys.stall_torque_n_mm.unwrap_or(f64::INFINITY);
    Ok(ToolScenario {
        tool: TurningTool {
            shape: shape(section, keys, ball_radius)?,
            sense: match keys.spindle_sense.unwrap_or(SpindleSense::Clockwise) {
                SpindleSense::Clockwise => 1.0,
                SpindleSense::Counterclockwise => -1.0,
            },
            lead: angle("spindle_lead_deg", keys.spindle_lead_deg)?,
            lean: angle("spindle_lean_deg", keys.spindle_lean_deg)?,
        },
        spindle: Spindle {
            free_speed: speed,
            stall_torque: section.number("stall_torque_n_mm", stall, 0.01..=f64::INFINITY)?,
        },
        while_following: matches!(keys.spindle_start, None | Some(SpindleStart::Follow)),
    })
}

fn shape(
    section: &Section<'_>,
    keys: &ToolKeys,
    ball_radius: f64,
) -> Result<ToolShape, ScenarioError> {
    let of_cone = [
        ("cone_angle_deg", keys.cone_angle_deg),
        ("cone_length_mm", keys.cone_length_mm),
        ("cone_contact_mm", keys.cone_contact_mm),
        ("cone_tip_radius_mm", keys.cone_tip_radius_mm),
    ];
    let of_belt = [("wheel_radius_mm", keys.wheel_radius_mm)];
    let (name, others): (&str, &[(&str, Option<f64>)]) = match keys.shape {
        ToolShapeWord::Ball => (
            "ball",
            &[of_belt[0], of_cone[0], of_cone[1], of_cone[2], of_cone[3]],
        ),
        ToolShapeWord::Cone => ("cone", &of_belt),
        ToolShapeWord::Belt => ("belt", &of_cone),
    };
    if let Some((key, _)) = others.iter().find(|(_, value)| value.is_some()) {
        return Err(section.misplaced(key, format!("shape = \"{name}\" has no such number")));
    }
    let needed = |key: &str, value: Option<f64>, range| match value {
        Some(value) => section.number(key, value, range),
        None => Err(section.missing(key, &format!("it to be given with shape = \"{name}\""))),
    };
    match keys.shape {
        ToolShapeWord::Ball => Ok(ToolShape::Ball {
            radius: ball_radius,
        }),
        ToolShapeWord::Belt => Ok(ToolShape::Belt {
            wheel_radius: needed("wheel_radius_mm", keys.wheel_radius_mm, 0.5..=500.0)?,
        }),
        ToolShapeWord::Cone => {
            let length_mm = keys.cone_length_mm;
            let length = needed("cone_length_mm", length_mm, 0.5..=200.0)?;
            let contact_mm = keys
                .cone_contact_mm
                .or(length_mm.map(|length| 0.5 * length));
            let contact = needed("cone_contact_mm", contact_mm, 0.0..=200.0)?;
            if contact > length {
                let expected = format!(
                    "at most cone_length_mm, {} mm: beyond it the tip does not reach the edge",
                    length_mm.unwrap_or_default()
                );
                let value = contact_mm.unwrap_or_default();
                return Err(section.refuse_number("cone_contact_mm", value, expected));
            }
            let tip = keys.cone_tip_radius_mm.unwrap_or(0.0);
            Ok(ToolShape::Cone {
                half_angle: 0.5 * needed("cone_angle_deg", keys.cone_angle_deg, 1.0..=179.0)?,
                flank: length,
                contact,
                tip_radius: section.number("cone_tip_radius_mm", tip, 0.0..=100.0)?,
            })
        }
    }
}

/// Keys that each law may have beside those of all.
fn keys_of(law: RemovalWord) -> (&'static str, &'static [&'static str]) {
    match law {
        RemovalWord::Preston => ("preston", &["coefficient_mm3_per_j"]),
        RemovalWord::Threshold => ("threshold", &["coefficient_mm3_per_j", "threshold_force_n"]),
        RemovalWord::Power => (
            "power",
            &[
                "rate_mm3_per_s",
                "reference_force_n",
                "reference_speed_m_per_s",
                "force_exponent",
                "speed_exponent",
                "threshold_force_n",
                "reference_area_mm2",
                "area_exponent",
                "contact_area_mm2",
            ],
        ),
    }
}

/// Keys that every law may have.
const OF_ALL: [&str; 6] = [
    "law",
    "wear_work_kj",
    "wear_at_start_kj",
    "contact_length_mm",
    "specific_energy_j_per_mm3",
    "friction_coefficient",
];

/// What the tool takes off.
pub(super) fn removal(
    section: &Section<'_>,
    keys: &RemovalKeys,
) -> Result<RemovalScenario, ScenarioError> {
    let (name, own) = keys_of(keys.law);
    if let Some(key) = section
        .given()
        .find(|key| !own.contains(key) && !OF_ALL.contains(key))
    {
        return Err(section.misplaced(key, format!("law = \"{name}\" has no such number")));
    }
    let needed = |key: &str, value: Option<f64>, range| match value {
        Some(value) => section.number(key, value, range),
        None => Err(section.missing(key, &format!("it to be given with law = \"{name}\""))),
    };
    let wear = keys.wear_work_kj.unwrap_or(f64::INFINITY);
    let area = keys
        .contact_area_mm2
        .or(keys.reference_area_mm2)
        .unwrap_or(1.0);
    let mut law = match keys.law {
        RemovalWord::Preston | RemovalWord::Threshold => RemovalLaw::preston(needed(
            "coefficient_mm3_per_j",
            keys.coefficient_mm3_per_j,
            1e-9..=1e3,
        )?),
        RemovalWord::Power => power(section, keys, &needed)?,
    };
    if let RemovalWord::Threshold = keys.law {
        law.threshold_force = needed("threshold_force_n", keys.threshold_force_n, 0.0..=5000.0)?;
        // Q = K v (F - F_t), whatever the threshold is.
        law.reference_force += law.threshold_force;
    }
    law.wear_work = section.number("wear_work_kj", wear, 1e-3..=f64::INFINITY)?;
    let length = keys.contact_length_mm.unwrap_or(CONTACT_LENGTH);
    let energy = keys.specific_energy_j_per_mm3.unwrap_or(SPECIFIC_ENERGY);
    let friction = keys.friction_coefficient.unwrap_or(FRICTION);
    Ok(RemovalScenario {
        law,
        contact_area: section.number("contact_area_mm2", area, 1e-3..=1e4)?,
        wear_at_start: section.number(
            "wear_at_start_kj",
            keys.wear_at_start_kj.unwrap_or(0.0),
            0.0..=1e6,
        )?,
        contact_length: section.number("contact_length_mm", length, 0.1..=100.0)?,
        cutting: CuttingForce {
            specific_energy: section.number("specific_energy_j_per_mm3", energy, 0.0..=1000.0)?,
            friction: section.number("friction_coefficient", friction, 0.0..=2.0)?,
        },
    })
}

/// Length of edge that the tool touches [mm]; judged: of the ball's flattening and the edge's.
const CONTACT_LENGTH: f64 = 1.0;
/// Energy per volume [J/mm3]; judged: an abrasive on steel takes 10 to 60, a sharp burr tool on aluminium 1 to 3.
const SPECIFIC_ENERGY: f64 = 20.0;
/// Friction of what rubs [1]; judged.
const FRICTION: f64 = 0.3;

type Needed<'a> =
    &'a dyn Fn(&str, Option<f64>, std::ops::RangeInclusive<f64>) -> Result<f64, ScenarioError>;

fn power(
    section: &Section<'_>,
    keys: &RemovalKeys,
    needed: Needed<'_>,
) -> Result<RemovalLaw, ScenarioError> {
    let exponent = |key: &str, value: Option<f64>, default: f64| {
        section.number(key, value.unwrap_or(default), -5.0..=5.0)
    };
    let (threshold, area) = (keys.threshold_force_n, keys.reference_area_mm2);
    let law = RemovalLaw {
        rate: needed("rate_mm3_per_s", keys.rate_mm3_per_s, 1e-9..=1e6)?,
        reference_speed: needed(
            "reference_speed_m_per_s",
            keys.reference_speed_m_per_s,
            1e-3..=500.0,
        )?,
        reference_force: needed("reference_force_n", keys.reference_force_n, 1e-3..=5000.0)?,
        reference_area: section.number("reference_area_mm2", area.unwrap_or(1.0), 1e-3..=1e4)?,
        speed_exponent: exponent("speed_exponent", keys.speed_exponent, 1.0)?,
        force_exponent: needed("force_exponent", keys.force_exponent, 0.1..=5.0)?,
        area_exponent: exponent("area_exponent", keys.area_exponent, 0.0)?,
        threshold_force: section.number(
            "threshold_force_n",
            threshold.unwrap_or(0.0),
            0.0..=5000.0,
        )?,
        wear_work: f64::INFINITY,
    };
    if law.threshold_force >= law.reference_force {
        let expected = format!("less than reference_force_n, {} N", law.reference_force);
        return Err(section.refuse_number("threshold_force_n", law.threshold_force, expected));
    }
    Ok(law)
}
