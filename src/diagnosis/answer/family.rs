//! Families: laws that recordings take for one another (docs/CONFUSION.md). That one of a family is at work may be certain while it is open which.

use crate::effects::{Effect, NUMBER_OFF};

/// Laws that are alike.
#[derive(Debug, PartialEq, Eq)]
pub struct Family {
    /// Name in an answer.
    pub name: &'static str,
    /// In words, with an article.
    pub words: &'static str,
    /// Names of its laws in the vocabulary; of a number of the rig file that is off, its key.
    members: &'static [&'static str],
}

/// All families.
#[rustfmt::skip] // A table: one family a line.
pub static FAMILIES: [Family; 10] = [
    Family { name: "leak", words: "a leak", members: &["cross_piston_leakage", "external_leakage", "gap_leakage", "leak_in_proportion", "leak_opened_by_pressure", "orifice_leakage"] },
    Family { name: "dry_friction", words: "dry friction", members: &["coulomb_viscous_friction", "stribeck_friction", "presliding_hysteresis", "pressure_dependent_friction"] },
    Family { name: "delay", words: "a delay of the pressure", members: &["transport_delay", "solenoid_switching_delay", "regulator_second_order", "hose_volume"] },
    Family { name: "late_force_reading", words: "a late force reading", members: &["channel_time_offset", "force_sensor_lag"] },
    Family { name: "force_by_pressure", words: "another scale of force by pressure", members: &["cylinder.bore_m", "force_sensor_gain_error", "regulator_gain_error"] },
    Family { name: "contact_law", words: "another law of the contact", members: &["contact_stiffness_error", "hertzian_contact"] },
    Family { name: "flow_restriction", words: "a narrower or wider way of the air", members: &["supply_restriction", "exhaust_restriction", "valve.discharge_coefficient"] },
    Family { name: "contact_wave", words: "a wave in the contact", members: &["tool_runout", "surface_waviness"] },
    Family { name: "joint_between_motor_and_link", words: "something between a motor and its link", members: &["compliant_joint", "joint_backlash", "joint_friction"] },
    Family { name: "removal_by_force", words: "another law of the force", members: &["removal_force_exponent", "removal_threshold_force", "tool_speed_sag"] },
];

/// How a member of a family moves what all of its family scale.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Scaling {
    /// Name of the family.
    pub family: &'static str,
    /// Name of the law, of a number of the rig file that is off its key.
    member: &'static str,
    /// Part that it is of, as `[shares]` of a rig file names it.
    pub part: &'static str,
    /// Power of its number over the nominal one with which that scales [1].
    pub power: f64,
}

/// Members whose number scales one and the same, each by a part of its own: force by pressure goes with the bore's square, and with either gain.
#[rustfmt::skip] // A table: one member a line.
static SCALINGS: [Scaling; 3] = [
    Scaling { family: "force_by_pressure", member: "cylinder.bore_m", part: "cylinder", power: 2.0 },
    Scaling { family: "force_by_pressure", member: "force_sensor_gain_error", part: "force_sensor", power: 1.0 },
    Scaling { family: "force_by_pressure", member: "regulator_gain_error", part: "regulator", power: 1.0 },
];

/// What a law scales, by its name in an answer, of `number_off` with its key; none of most.
#[must_use]
pub fn scaling(name: &str, key: Option<&str>) -> Option<&'static Scaling> {
    let name = if name == NUMBER_OFF { key? } else { name };
    SCALINGS.iter().find(|s| s.member == name)
}

/// The family of a law by its name in an answer, of `number_off` with its key.
#[must_use]
pub fn family(name: &str, key: Option<&str>) -> Option<&'static Family> {
    let name = if name == NUMBER_OFF { key? } else { name };
    FAMILIES.iter().find(|f| f.members.contains(&name))
}

/// The family that an effect is of.
pub(in crate::diagnosis) fn family_of(effect: &Effect) -> Option<&'static Family> {
    family(effect.vocabulary().0, effect.number_key())
}

/// Whether an effect may stand in another's place: it excludes that, or is of its family.
pub(in crate::diagnosis) fn is_alike(effect: &Effect, other: &Effect) -> bool {
    let family = family_of(effect);
    effect.excludes(other) || (family.is_some() && family == family_of(other))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::effects::{LINK_EFFECTS, NUMBERS_OFF, every};

    #[test]
    fn members_are_known_and_of_one_family_each() {
        let effects = every().chain(LINK_EFFECTS).map(|e| e.vocabulary().0);
        let keys = NUMBERS_OFF.iter().filter_map(Effect::number_key);
        let known: Vec<&str> = effects.chain(keys).collect();
        let mut members: Vec<&str> = FAMILIES.iter().flat_map(|f| f.members).copied().collect();
        let count = members.len();
        // Those of a table of runs have names of their own.
        let of_table = |m: &str| m.starts_with("removal_") || m == "tool_speed_sag";
        assert!(members.iter().all(|m| known.contains(m) || of_table(m)));
        members.sort_unstable();
        members.dedup();
        assert_eq!(members.len(), count);
    }

    #[test]
    fn what_scales_is_of_the_family_that_it_scales() {
        for scaling in &SCALINGS {
            let of = FAMILIES
                .iter()
                .find(|f| f.members.contains(&scaling.member));
            assert_eq!(of.map(|f| f.name), Some(scaling.family));
        }
        let of = |name, key| scaling(name, key).map(|s| (s.part, s.power));
        assert_eq!(
            of(NUMBER_OFF, Some("cylinder.bore_m")),
            Some(("cylinder", 2.0))
        );
        assert_eq!(
            of("force_sensor_gain_error", None),
            Some(("force_sensor", 1.0))
        );
        assert_eq!(of("gap_leakage", None), None);
    }

    #[test]
    fn a_number_that_is_off_is_of_the_family_of_its_key() {
        let of = |name, key| family(name, key).map(|f| f.name);
        assert_eq!(of("gap_leakage", None), Some("leak"));
        assert_eq!(
            of(NUMBER_OFF, Some("cylinder.bore_m")),
            Some("force_by_pressure")
        );
        assert_eq!(of(NUMBER_OFF, Some("cylinder.stroke_m")), None);
        assert_eq!(of("heat_transfer", None), None);
    }
}
