//! The effects that are known.

use super::cell::{CELL_EFFECTS, JOINT_EFFECTS, JOINT_FRICTION, SERVO_LAG};
use super::effect::Effect;
use super::{chambers, contact, force_balance, regulator, sensors};

/// All effects, in the order in which they are tried.
pub static CATALOGUE: &[Effect] = &[
    force_balance::coulomb_viscous_friction::EFFECT,
    force_balance::stribeck_friction::EFFECT,
    force_balance::presliding_hysteresis::EFFECT,
    force_balance::pressure_dependent_friction::EFFECT,
    force_balance::return_spring_load::EFFECT,
    force_balance::axial_force_offset::EFFECT,
    force_balance::end_cushioning::EFFECT,
    chambers::cross_piston_leakage::EFFECT,
    chambers::external_leakage::EFFECT,
    chambers::supply_droop::EFFECT,
    regulator::regulator_hysteresis::EFFECT,
    regulator::regulator_rate_limit::EFFECT,
    regulator::regulator_second_order::EFFECT,
    regulator::solenoid_switching_delay::EFFECT,
    force_balance::moving_mass_error::EFFECT,
    chambers::heat_transfer::EFFECT,
    chambers::exhaust_restriction::EFFECT,
    chambers::supply_restriction::EFFECT,
    chambers::extra_dead_volume::EFFECT,
    chambers::hose_volume::EFFECT,
    regulator::transport_delay::EFFECT,
    regulator::regulator_gain_error::EFFECT,
    contact::contact_stiffness_error::EFFECT,
    contact::hertzian_contact::EFFECT,
    contact::tool_runout::EFFECT,
    contact::surface_waviness::EFFECT,
    contact::surface_offset::EFFECT,
    sensors::force_sensor_bias_drift::EFFECT,
    sensors::force_sensor_gain_error::EFFECT,
    sensors::force_sensor_lag::EFFECT,
    sensors::force_sensor_saturation::EFFECT,
    sensors::inertial_crosstalk::EFFECT,
    sensors::stroke_sensor_gain_error::EFFECT,
    sensors::channel_time_offset::EFFECT,
];

/// All effects of a whole device and of the cell about it, those of joints one by one.
pub fn every() -> impl Iterator<Item = &'static Effect> {
    CATALOGUE
        .iter()
        .chain(&CELL_EFFECTS)
        .chain(JOINT_EFFECTS.iter().flatten())
        .chain(JOINT_FRICTION.iter())
        .chain([&SERVO_LAG])
}

/// Name of an effect that the vocabulary does not have.
pub const UNLISTED: &str = "unlisted";

/// Name in the vocabulary of an effect, and the joint that it is about, from 1.
#[must_use]
pub fn vocabulary(name: &str) -> (&str, Option<usize>) {
    let effect = every().find(|effect| effect.name == name);
    match effect {
        Some(effect) => effect.vocabulary(),
        None => (name, None),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::effects::{LINK_EFFECTS, Parameter};
    use crate::plant::{ContactParameters, PlantParameters};

    #[test]
    fn a_fit_looks_where_its_number_is_plausible() {
        let plant = PlantParameters {
            contact: ContactParameters::usual(false),
            ..PlantParameters::default()
        };
        for effect in every().chain(LINK_EFFECTS) {
            for Parameter {
                quantity, bounds, ..
            } in effect.parameters(&plant)
            {
                let [low, high] = quantity.number.range;
                let within = low <= bounds[0] && bounds[1] <= high;
                assert!(within, "{effect:?}: {quantity:?}, {low} to {high}");
            }
        }
    }

    #[test]
    fn a_joint_s_effect_says_which_joint() {
        for (index, [spring, encoder, play]) in JOINT_EFFECTS.iter().enumerate() {
            let joint = index + 1;
            assert_eq!(vocabulary(spring.name), ("compliant_joint", Some(joint)));
            let name = vocabulary(encoder.name);
            assert_eq!(name, ("joint_encoder_offset", Some(joint)));
            assert_eq!(play.vocabulary(), ("joint_backlash", Some(joint)));
        }
        assert_eq!(vocabulary("burr"), ("burr", None));
    }
}
