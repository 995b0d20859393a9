//! The numbers of a rig file: where each stands in the rig's description, and the range in which it is plausible as SI.

use crate::device::DeviceParameters;
use crate::physics::regulator::RegulatorParameters;
use crate::plant::Quantity;
use crate::plant::{
    CellParameters, Chain, ContactLaw, ContactParameters, LinkParameters, Periodic,
    PlantParameters, SensorErrors,
};

/// A number of the file.
pub(super) struct Row {
    /// The number, by its dotted key.
    pub quantity: Quantity,
    /// Least and largest plausible value.
    pub range: [f64; 2],
}

/// The one number that is whole, by its table and key, with the range in which it is plausible.
pub(super) const COUNT: (&str, &str, [f64; 2]) = ("cylinder", "count", [1.0, 16.0]);

macro_rules! row {
    ($key:literal, $($place:ident).+, $range:expr) => {
        Row {
            quantity: Quantity {
                name: $key, index: 0,
                get: |plant, _| plant.$($place).+,
                set: |plant, _, value| plant.$($place).+ = value,
            },
            range: $range,
        }
    };
}

/// The numbers of the rig, in the order of the format.
#[rustfmt::skip] // A table: one key a line.
pub(super) static QUANTITIES: [Row; 19] = [
    row!("cylinder.bore_m", device.bore, [0.002, 0.3]),
    row!("cylinder.rod_m", device.rod, [0.0005, 0.2]),
    row!("cylinder.stroke_m", device.full_stroke, [0.001, 1.0]),
    row!("cylinder.dead_volume_m3", device.dead_volume, [1e-8, 5e-3]),
    row!("cylinder.moving_mass_kg", device.moving_mass, [0.05, 200.0]),
    row!("cylinder.gravity_along_axis_m_per_s2", gravity_along_extension, [-30.0, 30.0]),
    row!("end_stop.stiffness_n_per_m", device.end_stop.stiffness, [1e4, 1e9]),
    row!("end_stop.damping_n_s_per_m", device.end_stop.damping, [0.0, 1e6]),
    row!("regulator.gain", device.regulator.gain, [0.2, 5.0]),
    row!("regulator.time_constant_s", device.regulator.time_constant, [5e-4, 10.0]),
    row!("valve.supply_orifice_m2", device.supply_orifice, [1e-8, 2e-4]),
    row!("valve.exhaust_orifice_m2", device.exhaust_orifice, [1e-8, 2e-4]),
    row!("valve.discharge_coefficient", device.discharge_coefficient, [0.1, 1.0]),
    row!("gas.specific_gas_constant_j_per_kg_k", device.gas.specific_gas_constant, [50.0, 5000.0]),
    row!("gas.heat_capacity_ratio", device.gas.heat_capacity_ratio, [1.01, 1.67]),
    row!("gas.temperature_k", device.gas.temperature, [200.0, 500.0]),
    row!("gas.atmosphere_pa", device.gas.atmosphere, [5e4, 1.1e5]),
    Row { quantity: CONTACT_STIFFNESS, range: [1e3, 1e9] },
    row!("contact.damping_n_s_per_m", contact.damping, [0.0, 1e6]),
];

/// Stiffness of the contact, which stands in its law.
const CONTACT_STIFFNESS: Quantity = Quantity {
    name: "contact.stiffness_n_per_m",
    index: 0,
    get: |plant, _| match plant.contact.law {
        ContactLaw::Linear { stiffness } | ContactLaw::Hertz { stiffness } => stiffness,
    },
    set: |plant, _, stiffness| plant.contact.law = ContactLaw::Linear { stiffness },
};

/// Keys of `[sensors]` with their plausible ranges: the rate, then the channels' noise in the order of `plant::CHANNELS`.
pub(super) const SENSOR_KEYS: [(&str, [f64; 2]); 5] = [
    ("sensors.rate_hz", [10.0, 20e3]),
    ("sensors.regulator_pressure_pa", [1.0, 1e5]),
    ("sensors.stroke_m", [1e-8, 5e-3]),
    ("sensors.force_n", [1e-4, 1e3]),
    ("sensors.acceleration_m_per_s2", [1e-4, 100.0]),
];

/// Drift of the pressure sensor, one standard deviation, of which only a part of the device may be told: its table and key with its plausible range.
pub(super) const DRIFT: (&str, &str, [f64; 2]) =
    ("sensors", "regulator_pressure_drift_pa_per_s", [0.0, 1e4]);

/// Numbers that a rig with a part of the device must have; all of them for the whole of it.
pub(super) fn needs(chain: Chain, key: &str) -> bool {
    match chain {
        Chain::Whole => true,
        Chain::MovedPiston => ["cylinder.count", "cylinder.bore_m"].contains(&key),
        Chain::DrivenSlide => key == "cylinder.moving_mass_kg",
        Chain::ClosedChamber => false,
        Chain::ContactFlange => {
            ["cylinder.moving_mass_kg", "regulator.time_constant_s"].contains(&key)
        }
        Chain::Regulator => ["regulator.gain", "regulator.time_constant_s"].contains(&key),
    }
}

/// The file that `idc new rig` begins with, whose comments say what the numbers are.
pub(super) const TEMPLATE: &str = include_str!("../../../assets/new/rig.toml");

/// Every number of a rig file: table, key, what it is, least and largest plausible value.
pub(in super::super) fn described_numbers() -> Vec<(String, String, String, [f64; 2])> {
    let (table, key, range) = COUNT;
    let count = (format!("{table}.{key}"), range);
    let (table, key, range) = DRIFT;
    let drift = (format!("{table}.{key}"), range);
    let rows = QUANTITIES
        .iter()
        .map(|row| (row.quantity.name.to_owned(), row.range));
    let sensors = SENSOR_KEYS.map(|(key, range)| (key.to_owned(), range));
    let all = [count]
        .into_iter()
        .chain(rows)
        .chain(sensors)
        .chain([drift]);
    all.map(|(dotted, range)| {
        let (table, key) = dotted.split_once('.').unwrap_or(("", &dotted));
        let text = meaning(table, key).unwrap_or_default();
        (table.to_owned(), key.to_owned(), text, range)
    })
    .collect()
}

/// The comment behind a key of the template.
fn meaning(table: &str, key: &str) -> Option<String> {
    let (_, below) = TEMPLATE.split_once(&format!("\n[{table}]\n"))?;
    let line = below
        .lines()
        .take_while(|line| !line.starts_with('['))
        .find(|line| {
            line.strip_prefix(key)
                .is_some_and(|rest| rest.starts_with(' '))
        })?;
    let (_, comment) = line.rsplit_once("# ")?;
    Some(comment.to_owned())
}

/// Pressure of a regulator's supply of which the file says nothing: as much as a regulator stands, so that it never binds [Pa gauge].
const AMPLE_SUPPLY: f64 = 16e5;

/// The believed model with all that a file does not say: no friction, no leaks, isothermal chambers, ideal sensors. Its numbers are for the file to set.
pub(in super::super) fn blank() -> PlantParameters {
    PlantParameters {
        device: DeviceParameters {
            regulator: RegulatorParameters {
                dead_time: 0.0,
                supply: AMPLE_SUPPLY,
                ..RegulatorParameters::default()
            },
            ..DeviceParameters::default()
        },
        gravity_along_extension: 0.0,
        contact: ContactParameters {
            law: ContactLaw::Linear { stiffness: 0.0 },
            damping: 0.0,
            surface_offset: 0.0,
            runout: Periodic::NONE,
            waviness: Periodic::NONE,
        },
        cell: CellParameters::RIGID,
        sensors: SensorErrors::NONE,
        latent: None,
        own: Vec::new(),
        chain: Chain::Whole,
        links: LinkParameters::NONE,
    }
}

#[cfg(test)]
mod tests {
    use super::super::super::check::Section;
    use super::super::super::document::Document;
    use super::super::values::plain;
    use super::*;

    #[test]
    fn the_file_to_start_from_has_every_number_with_its_unit_and_range() {
        let document = Document::new(std::path::Path::new("rig.toml"), TEMPLATE, 2).unwrap();
        let (drift_table, drift_key, _) = DRIFT;
        for (table, key, text, [low, high]) in described_numbers() {
            if (table.as_str(), key.as_str()) == (drift_table, drift_key) {
                continue;
            }
            assert!(!text.is_empty(), "{table}.{key}");
            let dotted = format!("{table}.{key}");
            let place = Section::new(&document, "").document().place(&dotted);
            let (line, _) = place
                .position
                .unwrap_or_else(|| panic!("{dotted} is not there"));
            let line = TEMPLATE.lines().nth(line as usize - 1).unwrap();
            let range = format!("({} to {})", plain(low), plain(high));
            assert!(line.ends_with(&range), "{dotted}: {line}\nexpected {range}");
        }
    }
}
