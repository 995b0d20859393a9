//! A finite reservoir in front of the regulator, refilled by a small compressor.
//!
//! ```text
//! p V = m R T_0,   dm/dt = m_dot_c s(p) - m_dot_drawn                         (isothermal tank, source paper eq. 4)
//! s(p) = 1 below 0.999 p_f, from there linearly to 0 at p_f
//! ```
//!
//! p absolute pressure [Pa], V volume [m3], m air in it [kg], m_dot_c flow of the compressor [kg/s], p_f pressure at which it unloads [Pa],
//! m_dot_drawn what the regulator lets through to the device, never negative [kg/s]: a relieving regulator lets air out to the atmosphere.
//!
//! The compressor switches off over the last thousandth of the pressure instead of at once, so that the law is continuous; no drop that a
//! device would notice depends on it. Leaves out: the drop along the pipe, and a compressor's hysteresis between loading and unloading.

use super::flow_slope::FlowSlope;
use super::gas::Gas;

/// Share of the full pressure over which the compressor unloads [1].
const UNLOADING: f64 = 1e-3;
/// Evaluations at most when its pressure is sought.
const MOST_TRIALS: usize = 60;

/// Reservoir and compressor.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SupplyReservoir {
    /// Volume [m3].
    pub volume: f64,
    /// Pressure when full, absolute [Pa].
    pub full_pressure: f64,
    /// Flow of the compressor while it loads [kg/s].
    pub compressor_flow: f64,
}

impl SupplyReservoir {
    /// Of a volume [m3] and a compressor's flow [kg/s], 7 bar absolute when full.
    pub fn new(volume: f64, compressor_flow: f64) -> Self {
        Self {
            volume,
            full_pressure: 7e5,
            compressor_flow,
        }
    }

    /// Air in it when full [kg].
    pub fn full_mass(&self, gas: &Gas) -> f64 {
        gas.mass(self.full_pressure, self.volume)
    }

    /// Absolute pressure [Pa] of a mass of air [kg].
    pub fn pressure(&self, gas: &Gas, mass: f64) -> f64 {
        gas.pressure(mass, self.volume)
    }

    /// Flow of the compressor [kg/s] at a pressure in the reservoir, absolute [Pa].
    pub fn compressed(&self, pressure: f64) -> f64 {
        let below = 1.0 - pressure / self.full_pressure;
        self.compressor_flow * (below / UNLOADING).clamp(0.0, 1.0)
    }

    /// Pressure in it [Pa absolute] at the end of an implicit step: mass = held + time (compressed - drawn), with what comes back as relief left out.
    /// `drawn` gives, for a pressure before what is fed, something of the feeder's own and the flow there with its slope, never falling; the
    /// regulator lets through at most the pressure `regulated` [Pa absolute]. Returns the feeder's own with the pressure.
    pub fn balance<T>(
        &self,
        gas: &Gas,
        regulated: f64,
        (held, time): (f64, f64),
        drawn: impl Fn(f64) -> (T, FlowSlope),
    ) -> (T, f64) {
        let capacity = gas.mass(1.0, self.volume);
        // Pressure after a flow was drawn, and that the compressor worked meanwhile.
        let left = |flow: f64| {
            let base = (held - time * flow.max(0.0)) / capacity;
            let lift = time * self.compressor_flow / capacity;
            let slope = lift / (UNLOADING * self.full_pressure);
            let unloading = (base + lift / UNLOADING) / (1.0 + slope);
            base.max(unloading.min(base + lift))
        };
        let (own, flow) = drawn(regulated);
        let pressure = left(flow.flow);
        if pressure >= regulated {
            return (own, pressure);
        }
        let (mut low, mut high) = (pressure.max(0.0), regulated);
        let mut trial = low.max(held / capacity).min(high);
        for _ in 0..MOST_TRIALS {
            let (_, flow) = drawn(trial);
            let excess = trial - left(flow.flow);
            if excess > 0.0 {
                high = trial;
            } else {
                low = trial;
            }
            let slope = 1.0 + time / capacity * if flow.flow > 0.0 { flow.slope } else { 0.0 };
            let newton = trial - excess / slope;
            if (newton - trial).abs() <= 1e-12 * trial {
                trial = newton;
                break;
            }
            trial = if newton >= low && newton <= high {
                newton
            } else {
                0.5 * (low + high)
            };
        }
        (drawn(trial).0, trial)
    }

    /// The fastest rate of its pressure [1/s]: that of the compressor as it unloads.
    pub fn rate(&self, gas: &Gas) -> f64 {
        self.compressor_flow / (UNLOADING * self.full_mass(gas))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_steady_draw_empties_it_linearly_and_the_compressor_stops_when_full() {
        let gas = Gas::default();
        let reservoir = SupplyReservoir::new(2e-3, 1e-4);
        let full = reservoir.full_mass(&gas);
        assert!((full - 7e5 * 2e-3 / (287.05 * 293.15)).abs() < 1e-15);
        assert_eq!(reservoir.compressed(7e5), 0.0);
        assert_eq!(reservoir.compressed(6.9e5), 1e-4);
        assert!((reservoir.compressed(6.9965e5) - 5e-5).abs() < 1e-16);
        assert_eq!(reservoir.compressed(7.1e5), 0.0);
        let after = reservoir.pressure(&gas, full - 3.0 * (3e-4 - 1e-4));
        assert!((7e5 - after - 6e-4 * 287.05 * 293.15 / 2e-3).abs() < 1e-6);
    }
}
