//! Effects that only a rig with a part of the device shows: a moved piston, a closed chamber, a regulator alone.

mod chamber_cooling;
mod chamber_shut_later;
mod gap_leakage;
mod leak_in_proportion;
mod leak_opened_by_pressure;
mod load_behind_line;
mod orifice_leakage;
mod pressure_sensor_offset;
mod regulator_opens_at_zero;
mod regulator_venting;
mod viscous_friction_by_direction;

use super::catalogue::CATALOGUE;
use super::effect::Effect;
use super::parts::*;
use crate::plant::DeviceParts;

/// All of them, in the order in which they are tried.
pub static LINK_EFFECTS: &[Effect] = &[
    viscous_friction_by_direction::EFFECT,
    regulator_venting::EFFECT,
    regulator_opens_at_zero::EFFECT,
    load_behind_line::EFFECT,
    pressure_sensor_offset::EFFECT,
    leak_in_proportion::EFFECT,
    orifice_leakage::EFFECT,
    gap_leakage::EFFECT,
    leak_opened_by_pressure::EFFECT,
    chamber_cooling::EFFECT,
    chamber_shut_later::EFFECT,
];

/// Effects that can act in a rig with so much of the device.
#[must_use]
pub fn candidates(parts: DeviceParts) -> Vec<&'static Effect> {
    let of = |subsystems: &[Subsystem]| -> Vec<&'static Effect> {
        let all = CATALOGUE.iter().chain(LINK_EFFECTS);
        all.filter(|effect| subsystems.contains(&effect.subsystem))
            .collect()
    };
    match parts {
        DeviceParts::Whole => CATALOGUE.iter().collect(),
        DeviceParts::MovedPiston => of(&[Subsystem::ForceBalance, Subsystem::Sensors]),
        DeviceParts::DrivenSlide => {
            let mut effects = of(&[Subsystem::ForceBalance, Subsystem::Sensors]);
            // There is no pressure.
            effects.retain(|effect| effect.name != "pressure_dependent_friction");
            effects
        }
        DeviceParts::ClosedChamber => {
            let mut effects = of(&[Subsystem::Chambers, Subsystem::Sensors]);
            effects.retain(|effect| LINK_EFFECTS.iter().any(|own| own.name == effect.name));
            effects
        }
        DeviceParts::Regulator => of(&[Subsystem::Regulator, Subsystem::Sensors]),
        // Its parameters are found from its impacts, not by a search (`diagnosis::flange`).
        DeviceParts::ContactFlange => Vec::new(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_whole_device_has_the_catalogue_and_no_effect_has_two_names() {
        assert_eq!(candidates(DeviceParts::Whole).len(), CATALOGUE.len());
        for parts in DeviceParts::ALL {
            let mut names: Vec<&str> = candidates(parts).iter().map(|e| e.name).collect();
            let count = names.len();
            names.sort_unstable();
            names.dedup();
            assert!(names.len() == count, "{parts:?}");
        }
    }
}
