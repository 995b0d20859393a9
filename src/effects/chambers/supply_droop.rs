//! The supply falls when much air is drawn: a small reservoir and compressor.
//!
//!     V dp/dt = R T_0 (m_dot_c s(p) - m_dot_drawn),   outlet <= p
//!
//! p absolute pressure of the reservoir and of the outlet [Pa], V volume of the reservoir [m3], m_dot_c flow of the compressor [kg/s], s 1 until the
//! reservoir is full and 0 then, m_dot_drawn what the regulator lets through [kg/s], R specific gas constant [J/(kg K)], T_0 temperature [K].
//! Source: Isothermal tank, source paper eq. (4).
//!
//! Signature: The outlet cannot hold high set pressures after much air was drawn, and comes back slowly.
//!
//! Confused with:
//! - regulator_rate_limit: the same rate at every pressure and after any history.
//! - regulator_gain_error: always, whatever was drawn before.

use super::*;
use crate::physics::supply_reservoir::SupplyReservoir;
use crate::plant::PlantParameters;

fn reservoir(p: &PlantParameters) -> SupplyReservoir {
    p.device
        .supply_reservoir
        .unwrap_or_else(|| SupplyReservoir::new(1e-3, 1e-3))
}

const RESERVOIR: Quantity = Quantity {
    name: "reservoir_volume_m3",
    index: 0,
    get: |p, _| reservoir(p).volume,
    set: |p, _, v| {
        p.device.supply_reservoir = Some(SupplyReservoir {
            volume: v,
            ..reservoir(p)
        })
    },
};
const COMPRESSOR: Quantity = Quantity {
    name: "compressor_flow_kg_per_s",
    index: 0,
    get: |p, _| reservoir(p).compressor_flow,
    set: |p, _, v| {
        p.device.supply_reservoir = Some(SupplyReservoir {
            compressor_flow: v,
            ..reservoir(p)
        })
    },
};

/// The effect.
pub const EFFECT: Effect = Effect {
    name: "supply_droop",
    text: include_str!("supply_droop.rs"),
    which: Which::Only,
    subsystem: Subsystem::Chambers,
    group: None,
    parameters: |_, _| {
        vec![
            reported(RESERVOIR, Logarithmic, [1e-5, 0.1]),
            reported(COMPRESSOR, Logarithmic, [1e-6, 0.1]),
        ]
    },
    usual: |_, _| vec![1e-3, 5e-4],
    starts: |_, _| {
        vec![
            vec![1e-4, 5e-5],
            vec![1e-4, 2e-4],
            vec![4e-4, 5e-5],
            vec![4e-4, 2e-4],
            vec![1.5e-3, 1e-4],
        ]
    },
};
