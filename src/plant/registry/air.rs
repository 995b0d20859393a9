//! The air, and the valve that it passes.

use super::{Number, numbers};

#[rustfmt::skip] // A table: one number a line.
numbers! { AIR:
    /// orifice between regulator and chamber
    SUPPLY_ORIFICE = "valve.supply_orifice_m2" as "supply_orifice_mm2", [1e-8, 2e-4], (p => p.device.supply_orifice);
    /// orifice between chamber and atmosphere
    EXHAUST_ORIFICE = "valve.exhaust_orifice_m2" as "exhaust_orifice_mm2", [1e-8, 2e-4], (p => p.device.exhaust_orifice);
    /// of both orifices, and of the leaks
    DISCHARGE_COEFFICIENT = "valve.discharge_coefficient" as "discharge_coefficient", [0.1, 1.0], (p => p.device.discharge_coefficient);
    /// time from the command of the 5/2 valve to its switching
    SWITCHING_DELAY = "valve.switching_delay_s" as "valve_switching_delay_ms", [0.0, 1.0], (p => p.device.switching_delay);
    /// leak past the piston seal, as an equivalent orifice
    CROSS_PISTON_LEAK = "leak.cross_piston_m2" as "cross_piston_leak_mm2", [0.0, 1e-4], (p => p.device.leakage.cross_piston);
    /// leak from chamber 1 to the atmosphere, as an equivalent orifice
    EXTERNAL_LEAK = "leak.external_m2" as "external_leak_mm2", [0.0, 1e-4], (p => p.device.leakage.external);
    /// specific gas constant
    GAS_CONSTANT = "gas.specific_gas_constant_j_per_kg_k" as "gas_constant_j_per_kg_k", [50.0, 5000.0], (p => p.device.gas.specific_gas_constant);
    /// ratio of specific heats
    HEAT_CAPACITY_RATIO = "gas.heat_capacity_ratio" as "gas_heat_capacity_ratio", [1.01, 1.67], (p => p.device.gas.heat_capacity_ratio);
    /// temperature of supply, walls and surroundings
    TEMPERATURE = "gas.temperature_k" as "gas_temperature_k", [200.0, 500.0], (p => p.device.gas.temperature);
    /// pressure of the surroundings
    ATMOSPHERE = "gas.atmosphere_pa" as "atmosphere_pa_absolute", [5e4, 1.1e5], (p => p.device.gas.atmosphere);
}
