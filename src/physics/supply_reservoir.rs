//! A finite reservoir in front of the regulator, refilled by a small compressor.
//!
//!     p V = m R T_0,   dm/dt = m_dot_c s(p) - m_dot_drawn                         (isothermal tank, source paper eq. 4)
//!     s(p) = 1 below 0.999 p_f, from there linearly to 0 at p_f
//!
//! p absolute pressure [Pa], V volume [m3], m air in it [kg], m_dot_c flow of the compressor [kg/s], p_f pressure at which it unloads [Pa],
//! m_dot_drawn what the regulator lets through to the device, never negative [kg/s]: a relieving regulator lets air out to the atmosphere.
//!
//! The compressor switches off over the last thousandth of the pressure instead of at once, so that the law is continuous; no drop that a
//! device would notice depends on it. Leaves out: the drop along the pipe, and a compressor's hysteresis between loading and unloading.

use super::gas::Gas;

/// Share of the full pressure over which the compressor unloads [1].
const UNLOADING: f64 = 1e-3;

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
