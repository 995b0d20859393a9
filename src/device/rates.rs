//! Rates of the piston's swing on what it meets within a step, for the choice of sub-steps.

use super::DeviceParameters;
use super::load::{Load, PistonMotion};

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

impl DeviceParameters {
    /// The fastest rate of the piston's swing on seals, end stops and cushions [1/s]: a simulation takes as many more sub-steps there.
    #[must_use]
    pub fn fastest_rate(&self) -> f64 {
        PistonRates::new(self).fastest()
    }
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

    /// The fastest rate of what is in the device itself [1/s].
    fn fastest(&self) -> f64 {
        self.everywhere.max(self.stop).max(self.cushion)
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
