//! Rates of the piston's swing on what it meets within a step, and of a line, for the choice of sub-steps.

use super::DeviceParameters;
use super::load::{Load, PistonMotion};

/// Longest sub-step that a line is taken in however fast it is [s], for accuracy alone: tests/equations/lines.rs.
const LONGEST: f64 = 2.5e-4;
/// Largest sub-step of a slow line times its rate [1].
const RATE_LIMIT: f64 = 1.2;
/// Approach of the piston to something in a step, beside its way at speed and under pressure [m].
const MARGIN: f64 = 3e-4;

/// Rates [1/s], and what tells how far the piston gets.
#[derive(Debug, Clone, Copy)]
pub(super) struct PistonRates {
    /// Of seals and axial load, which are everywhere.
    everywhere: f64,
    /// Of an end stop.
    stop: f64,
    /// Of an end cushion.
    cushion: f64,
    /// Distance from an end at which its cushion begins [m]; 0 without cushions.
    cushion_length: f64,
    full_stroke: f64,
    /// Acceleration at full supply pressure, twice what it takes [m/s2].
    swiftness: f64,
}

impl PistonRates {
    pub(super) fn new(parameters: &DeviceParameters) -> Self {
        let mass = parameters.moving_mass;
        let (stop, seals) = (&parameters.end_stop, &parameters.seal_friction);
        let cushion = &parameters.end_cushioning;
        let stiffness = seals.stiffness() + parameters.axial_load.return_stiffness;
        Self {
            everywhere: (stiffness / mass).sqrt().max(seals.viscous / mass),
            stop: (stop.stiffness / mass).sqrt().max(stop.damping / mass),
            cushion: cushion.damping / mass,
            cushion_length: if cushion.is_none() {
                0.0
            } else {
                cushion.length
            },
            full_stroke: parameters.full_stroke,
            swiftness: parameters.regulator.supply * parameters.areas().extending / mass,
        }
    }

    /// The fastest rate that the piston can meet over a step [1/s]: stops, cushions and load count if they are within its reach, for they
    /// are far stiffer than the air.
    pub(super) fn within<L: Load>(&self, load: &L, motion: PistonMotion, dt: f64) -> f64 {
        let reach = MARGIN + dt * (2.0 * motion.speed.abs() + dt * self.swiftness);
        let to_end = motion.stroke.min(self.full_stroke - motion.stroke);
        let mut fastest = self.everywhere.max(load.rate_within(motion, reach, dt));
        if to_end < reach {
            fastest = fastest.max(self.stop);
        }
        if to_end < self.cushion_length + reach {
            fastest = fastest.max(self.cushion);
        }
        fastest
    }
}

/// Longest sub-step [s] for a line, if there is one, before a valve that lets `valve_rate` [m3/s] through at most, as a rate times a volume.
pub(super) fn longest_line_step(parameters: &DeviceParameters, valve_rate: f64) -> f64 {
    let Some(hose) = &parameters.hose else {
        return f64::INFINITY;
    };
    let gas = &parameters.gas;
    let rt = gas.specific_gas_constant * gas.temperature;
    let through = rt / hose.resistance_at_rest(gas.atmosphere);
    // As a whole: what segments exchange faster than that follows, and is implicit.
    let mut rate = (valve_rate + through) / hose.volume;
    if let Some(reservoir) = &parameters.supply_reservoir {
        rate += reservoir.rate(gas) + through / reservoir.volume;
    }
    LONGEST.max(RATE_LIMIT / rate)
}
