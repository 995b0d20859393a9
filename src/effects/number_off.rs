//! A number of the rig file is off, beyond its tolerance or without one. A drawing of another size, a slip of the pen, a part that was exchanged.
//!
//! ```text
//! number = value
//! ```
//!
//! number one of the rig file by its key, value what the recordings ask for in its place.
//! Source: Definition; a rig file is nominal.
//!
//! Signature: That of the number: a bore scales all forces of pressure, a stroke is met at the far stop, a time constant delays the outlet.
//!
//! Confused with:
//! - force_sensor_gain_error: scales the reading of the force alone, the motion is nominal; a bore scales both.
//! - regulator_gain_error: scales the outlet, which is measured.

use super::parts::*;
use crate::effects::effect::Which;
use crate::plant::DeviceParts;
use crate::plant::registry::Number;

/// A number that may be off, where it enters, and the shares of the sheet's value from which a fit starts.
struct Suspect {
    number: &'static Number,
    shares: &'static [f64],
    /// Share of the sheet's value down to which, and times up to which, it is sought [1].
    range: [f64; 2],
}

/// Range of most numbers.
const USUAL: [f64; 2] = [0.4, 2.5];
/// That of an end stop, whose numbers few have measured.
const OF_STOP: [f64; 2] = [0.03, 30.0];

/// Numbers that may be off and that no other effect frees: mass, orifices, dead volume, the gains, the contact's stiffness and a lean of the axis have effects
/// of their own (`moving_mass_error`, `supply_restriction`, `axial_force_offset` ..). The temperature acts as the discharge coefficient does, by its root.
static SUSPECTS: [Suspect; 10] = [
    Suspect {
        number: &BORE,
        shares: &[0.94, 0.98, 1.02, 1.07],
        range: USUAL,
    },
    Suspect {
        number: &ROD,
        shares: &[0.8, 1.25],
        range: USUAL,
    },
    Suspect {
        number: &STROKE,
        shares: &[0.95, 0.98, 1.02, 1.05],
        range: USUAL,
    },
    Suspect {
        number: &REGULATOR_TIME_CONSTANT,
        shares: &[0.5, 0.7, 1.4, 2.0],
        range: USUAL,
    },
    Suspect {
        number: &DISCHARGE_COEFFICIENT,
        shares: &[0.75, 1.2],
        range: USUAL,
    },
    Suspect {
        number: &CONTACT_DAMPING,
        shares: &[0.3, 3.0],
        range: USUAL,
    },
    Suspect {
        number: &END_STOP_STIFFNESS,
        shares: &[0.2, 0.6, 2.0],
        range: OF_STOP,
    },
    Suspect {
        number: &END_STOP_DAMPING,
        shares: &[0.3, 2.0],
        range: OF_STOP,
    },
    Suspect {
        number: &ATMOSPHERE,
        shares: &[0.9],
        range: USUAL,
    },
    Suspect {
        number: &HEAT_CAPACITY_RATIO,
        shares: &[0.9, 1.1],
        range: USUAL,
    },
];

const fn of(name: &'static str, subsystem: Subsystem, place: usize, key: &'static str) -> Effect {
    Effect {
        text: include_str!("number_off.rs"),
        which: Which::Number { place, key },
        parameters,
        usual: |p, place| vec![1.05 * SUSPECTS[place].number.quantity().get(p)],
        starts: |c, place| {
            let suspect = &SUSPECTS[place];
            shares(suspect.shares, suspect.number.quantity().get(c.plant))
        },
        ..effect(name, subsystem)
    }
}

/// One for each such number, in the order of the suspects.
#[rustfmt::skip] // A table: one number a line.
pub static NUMBERS_OFF: [Effect; 10] = [
    of("number_off (cylinder.bore_m)", Subsystem::ForceBalance, 0, "cylinder.bore_m"),
    of("number_off (cylinder.rod_m)", Subsystem::ForceBalance, 1, "cylinder.rod_m"),
    of("number_off (cylinder.stroke_m)", Subsystem::ForceBalance, 2, "cylinder.stroke_m"),
    of("number_off (regulator.time_constant_s)", Subsystem::Regulator, 3, "regulator.time_constant_s"),
    of("number_off (valve.discharge_coefficient)", Subsystem::Chambers, 4, "valve.discharge_coefficient"),
    of("number_off (contact.damping_n_s_per_m)", Subsystem::Contact, 5, "contact.damping_n_s_per_m"),
    of("number_off (end_stop.stiffness_n_per_m)", Subsystem::ForceBalance, 6, "end_stop.stiffness_n_per_m"),
    of("number_off (end_stop.damping_n_s_per_m)", Subsystem::ForceBalance, 7, "end_stop.damping_n_s_per_m"),
    of("number_off (gas.atmosphere_pa)", Subsystem::Chambers, 8, "gas.atmosphere_pa"),
    of("number_off (gas.heat_capacity_ratio)", Subsystem::Chambers, 9, "gas.heat_capacity_ratio"),
];

/// Those that can show in a rig with so much of the device.
#[must_use]
pub fn numbers_off(parts: DeviceParts) -> &'static [Effect] {
    match parts {
        DeviceParts::Whole => &NUMBERS_OFF,
        // Its area alone acts.
        DeviceParts::MovedPiston => &NUMBERS_OFF[..1],
        DeviceParts::Regulator => &NUMBERS_OFF[3..4],
        DeviceParts::DrivenSlide | DeviceParts::ClosedChamber | DeviceParts::ContactFlange => &[],
    }
}

fn parameters(plant: &crate::plant::PlantParameters, place: usize) -> Vec<Parameter> {
    let Suspect {
        number,
        range: [down, up],
        ..
    } = SUSPECTS[place];
    let nominal = number.quantity().get(plant);
    let [least, most] = number.range;
    let bounds = [(down * nominal).max(least), (up * nominal).min(most)];
    // A rod is thinner than its piston.
    let bounds = match place {
        0 => [bounds[0].max(1.05 * plant.device.rod), bounds[1]],
        1 => [bounds[0], bounds[1].min(0.95 * plant.device.bore)],
        _ => bounds,
    };
    vec![reported(number.quantity(), Logarithmic, bounds)]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::effects::NUMBER_OFF;

    #[test]
    fn each_is_the_number_that_its_key_names_and_can_be_made_another() {
        for (suspect, effect) in SUSPECTS.iter().zip(&NUMBERS_OFF) {
            let key = effect.number_key();
            assert_eq!(key, Some(suspect.number.name));
            assert!(effect.name.contains(suspect.number.name));
            assert_eq!(effect.vocabulary(), (NUMBER_OFF, None));
        }
    }

    #[test]
    fn each_may_be_off_by_its_shares_within_what_can_be() {
        let plant = crate::plant::PlantParameters::default();
        for (place, suspect) in SUSPECTS.iter().enumerate() {
            let nominal = suspect.number.quantity().get(&plant);
            let [low, high] = parameters(&plant, place)[0].bounds;
            let [least, most] = suspect.number.range;
            assert!(least <= low && high <= most, "{low} to {high}");
            let [down, up] = suspect.range;
            // Only a rod's end and a bore's are nearer than that, and what no key allows.
            let is_free = place > 1 && down * nominal > least && up * nominal < most;
            if is_free {
                assert!((low / nominal - down).abs() < 1e-12, "{low} of {nominal}");
                assert!((high / nominal - up).abs() < 1e-12, "{high} of {nominal}");
            }
        }
        assert!(parameters(&plant, 0)[0].bounds[0] > plant.device.rod);
        assert!(parameters(&plant, 1)[0].bounds[1] < plant.device.bore);
    }
}
