//! The numbers of a rig file: where each stands in the rig's description, and the range in which it is plausible as SI.

use crate::device::DeviceParameters;
use crate::effects::Quantity;
use crate::physics::regulator::RegulatorParameters;
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
                name: $key,
                get: |plant| plant.$($place).+,
                set: |plant, value| plant.$($place).+ = value,
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
    get: |plant| match plant.contact.law {
        ContactLaw::Linear { stiffness } | ContactLaw::Hertz { stiffness } => stiffness,
    },
    set: |plant, stiffness| plant.contact.law = ContactLaw::Linear { stiffness },
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
        chain: Chain::Whole,
        links: LinkParameters::NONE,
    }
}
