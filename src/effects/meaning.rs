//! What each effect is, in a line for people.

/// An effect in a few words.
#[must_use]
#[rustfmt::skip] // A table: one effect a line.
pub fn meaning(effect: &str) -> &'static str {
    match super::vocabulary(effect).0 {
        "coulomb_viscous_friction" => "seals and guides rub: a dry part and one that grows with speed",
        "stribeck_friction" => "seals stick: breaking loose takes more force than sliding on",
        "presliding_hysteresis" => "seals bend before they slide, over a displacement that shows",
        "pressure_dependent_friction" => "seals rub the harder, the more the two chambers' pressures differ",
        "return_spring_load" => "something elastic pulls the piston back, in proportion to its stroke",
        "axial_force_offset" => "a constant force acts along the axis, positive in extension",
        "moving_mass_error" => "the moving mass is another one than believed",
        "end_cushioning" => "the piston is damped as it comes near an end of its stroke",
        "cross_piston_leakage" => "air leaks past the piston from chamber to chamber",
        "external_leakage" => "air leaks from chamber 1 to the surroundings",
        "heat_transfer" => "air in the chambers warms up and cools down, and exchanges heat with their walls",
        "exhaust_restriction" => "air leaves through another orifice than believed",
        "supply_restriction" => "air enters through another orifice than believed",
        "extra_dead_volume" => "the chambers' dead volume is another one than believed",
        "hose_volume" => "a line that holds air and resists its flow stands before the valve",
        "supply_droop" => "the supply falls when much air is drawn: a small reservoir and compressor",
        "transport_delay" => "the regulator answers a set pressure only after a dead time",
        "regulator_gain_error" => "the regulator holds another share of its set pressure than believed",
        "regulator_hysteresis" => "the regulator has play: small changes of its set pressure do nothing",
        "regulator_rate_limit" => "the regulator's outlet cannot rise or fall faster than so much",
        "regulator_second_order" => "the regulator overshoots and swings",
        "solenoid_switching_delay" => "the 5/2 valve switches later than it is told to",
        "contact_stiffness_error" => "tool, part or fixture is softer or stiffer than believed",
        "hertzian_contact" => "contact stiffens as it is pressed, as a ball on a flat does",
        "tool_runout" => "the tool turns off its axis and lifts and presses in turn",
        "surface_offset" => "the surface is not where the robot has it, positive along extension",
        "surface_waviness" => "the surface goes up and down about where the robot has it",
        "force_sensor_bias_drift" => "the load cell does not read zero at no force, and drifts",
        "force_sensor_gain_error" => "the load cell reads too much or too little in proportion",
        "force_sensor_lag" => "the load cell's signal is smoothed, and late by it",
        "force_sensor_saturation" => "the load cell's signal ends at a limit",
        "inertial_crosstalk" => "the load cell feels the mass in front of it being accelerated",
        "stroke_sensor_gain_error" => "the position sensor reads too much or too little in proportion",
        "channel_time_offset" => "the load cell's samples are stamped late",
        "viscous_friction_by_direction" => "viscous friction is larger one way than the other",
        "regulator_venting" => "the regulator vents at another pace than it fills",
        "regulator_opens_at_zero" => "the regulator opens its exhaust wide where nothing is set",
        "load_behind_line" => "a load behind a line fills and empties more slowly than the outlet moves",
        "pressure_sensor_offset" => "the pressure sensor does not read zero at the atmosphere",
        "leak_in_proportion" => "the chamber leaks in proportion to its gauge pressure, as through pores",
        "orifice_leakage" => "the chamber leaks as through a short hole",
        "gap_leakage" => "the chamber leaks as through a narrow gap, laminar while the air expands",
        "leak_opened_by_pressure" => "the chamber leaks through something that pressure opens",
        "chamber_shut_later" => "the chamber is still fed when the recording begins",
        "chamber_cooling" => "air that filling has warmed cools after the chamber is shut",
        "part_misplaced" => "the part stands out, or back, along the bisector of its edge, and slopes along it",
        "burr" => "a burr stands on the edge",
        "compliant_joint" => "a joint gives way between its motor and its link, more than believed",
        "joint_backlash" => "a joint has play between its motor and its link",
        "joint_friction" => "a joint rubs more than believed, or less",
        "joint_encoder_offset" => "a joint's encoder reads too much, so that the arm stands off by it",
        "servo_lag" => "the joints' servos follow their commands at another bandwidth than believed",
        _ => "physics beyond the believed model",
    }
}

#[cfg(test)]
mod tests {
    use super::super::{CATALOGUE, LINK_EFFECTS};
    use super::meaning;

    #[test]
    fn every_effect_has_words_of_its_own() {
        let mut seen = std::collections::BTreeSet::new();
        for effect in CATALOGUE.iter().chain(LINK_EFFECTS) {
            assert_ne!(meaning(effect.name), meaning(""), "{effect:?}");
            assert!(seen.insert(meaning(effect.name)), "{effect:?}");
        }
    }
}
