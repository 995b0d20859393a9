//! Optional parts of a device, and parts that the description keeps in another form than its file: reading the file makes the part of all its numbers.

use super::{Number, numbers};
use crate::physics::gas_process::GasProcess;
use crate::physics::hose::Hose;
use crate::physics::line_chain::MOST_SEGMENTS;
use crate::physics::regulator::SecondOrder;
use crate::physics::supply_reservoir::SupplyReservoir;
use crate::plant::PlantParameters;

#[rustfmt::skip] // A table: one number a line.
numbers! { PARTS:
    /// an oscillator in place of the first-order lag, at least 0.1; 0 for the lag
    NATURAL_FREQUENCY = "regulator.natural_frequency_rad_per_s" as "regulator_natural_frequency_rad_per_s", [0.0, 1000.0],
        (|p, _| oscillator(p).natural_frequency, |p, _, v| p.device.regulator.second_order = Some(SecondOrder { natural_frequency: v, ..oscillator(p) }));
    /// damping ratio of the oscillator
    DAMPING_RATIO = "regulator.damping_ratio" as "regulator_damping_ratio", [0.01, 100.0],
        (|p, _| oscillator(p).damping_ratio, |p, _, v| p.device.regulator.second_order = Some(SecondOrder { damping_ratio: v, ..oscillator(p) }));
    /// finite reservoir in front of the regulator, at least 10; 0 for a supply that holds its pressure
    RESERVOIR_VOLUME = "supply.reservoir_volume_m3" as "supply_reservoir_volume_cm3", [0.0, 1.0],
        (|p, _| reservoir(p).volume, |p, _, v| p.device.supply_reservoir = Some(SupplyReservoir { volume: v, ..reservoir(p) }));
    /// pressure of the full reservoir, at which the compressor stops
    RESERVOIR_PRESSURE = "supply.reservoir_pressure_pa" as "supply_reservoir_pressure_pa_absolute", [1.1e5, 2e6],
        (|p, _| reservoir(p).full_pressure, |p, _, v| p.device.supply_reservoir = Some(SupplyReservoir { full_pressure: v, ..reservoir(p) }));
    /// flow of the compressor that refills the reservoir
    COMPRESSOR_FLOW = "supply.compressor_flow_kg_per_s" as "compressor_flow_kg_per_s", [0.0, 1.0],
        (|p, _| reservoir(p).compressor_flow, |p, _, v| p.device.supply_reservoir = Some(SupplyReservoir { compressor_flow: v, ..reservoir(p) }));
    /// of each chamber; used by "wall_heat" alone
    WALL_CONDUCTANCE = "gas.wall_conductance_w_per_k" as "wall_conductance_w_per_k", [0.0, 100.0],
        (conductance, |p, _, conductance| p.device.gas_process = GasProcess::WallHeat { conductance });
    /// line between regulator and valve, a smooth tube; 0 for none, its volume being part of the dead volume
    HOSE_LENGTH = "hose.length_m" as "hose_length_m", [0.0, 50.0], (nothing, keep);
    /// its inner diameter
    HOSE_DIAMETER = "hose.diameter_m" as "hose_diameter_mm", [1e-3, 0.025], (nothing, keep);
    /// volume of such a line, given with its resistance instead of its length
    HOSE_VOLUME = "hose.volume_m3" as "hose_volume_cm3", [0.0, 0.01],
        (|p, _| p.device.hose.map_or(0.0, |h| h.volume), |p, _, v| set_line(p, (v, line(p).1, line(p).2)));
    /// its pressure drop over mass flow, more than 0 with a volume
    HOSE_RESISTANCE = "hose.resistance_pa_s_per_kg" as "hose_resistance_pa_s_per_kg", [0.0, 1e12],
        (|p, _| p.device.hose.map_or(0.0, |_| line(p).1), |p, _, v| set_line(p, (line(p).0, v, line(p).2)));
    /// segments of the line, one behind the other
    HOSE_SEGMENTS = "hose.segments", [1.0, MOST_SEGMENTS as f64],
        (|p, _| p.device.hose.map_or(0.0, |h| h.segments() as f64), |p, _, v| set_line(p, (line(p).0, line(p).1, v.round() as usize)));
    /// a way from here to there, which changes nothing by itself
    WAY = "way", super::ANY, (nothing, keep);
}

/// Numbers that stand nowhere in the description.
fn nothing(_: &PlantParameters, _: usize) -> f64 {
    0.0
}

fn keep(_: &mut PlantParameters, _: usize, _: f64) {}

/// The oscillator; where there is none, one as fast as the lag.
fn oscillator(plant: &PlantParameters) -> SecondOrder {
    let regulator = &plant.device.regulator;
    regulator.second_order.unwrap_or(SecondOrder {
        natural_frequency: 1.0 / regulator.time_constant,
        damping_ratio: 1.0,
    })
}

fn reservoir(plant: &PlantParameters) -> SupplyReservoir {
    let own = plant.device.supply_reservoir;
    own.unwrap_or_else(|| SupplyReservoir::new(1e-3, 1e-3))
}

fn conductance(plant: &PlantParameters, _: usize) -> f64 {
    match plant.device.gas_process {
        GasProcess::WallHeat { conductance } => conductance,
        GasProcess::Isothermal => f64::INFINITY,
    }
}

/// Volume [m3], resistance [Pa s/kg] at its smallest flows, and segments of the line; where there is none, of one to begin with.
fn line(plant: &PlantParameters) -> (f64, f64, usize) {
    plant.device.hose.map_or((1e-5, 1e8, 2), |hose| {
        let resistance = hose.resistance_at_rest(plant.device.gas.atmosphere);
        (hose.volume, resistance, hose.segments())
    })
}

fn set_line(plant: &mut PlantParameters, (volume, resistance, segments): (f64, f64, usize)) {
    plant.device.hose = Some(match segments {
        MOST_SEGMENTS => Hose::evenly_spread(volume, resistance),
        _ => Hose::in_segments(volume, resistance, segments),
    });
}
