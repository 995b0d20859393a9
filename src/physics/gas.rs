//! The working gas: dry air as an ideal gas at constant temperature.
//!
//! ```text
//! P = rho R T,   P V = m R T          (source paper, eqs. 2 to 4)
//! ```
//!
//! P absolute pressure [Pa], rho density [kg/m3], R specific gas constant [J/(kg K)], T temperature [K], V volume [m3], m mass [kg].

use serde::{Deserialize, Serialize};

/// Gas properties shared by every pneumatic element.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Gas {
    /// Specific gas constant [J/(kg K)].
    pub specific_gas_constant: f64,
    /// Ratio of specific heats [1].
    pub heat_capacity_ratio: f64,
    /// Temperature, the same everywhere [K].
    pub temperature: f64,
    /// Pressure of the surroundings, absolute [Pa].
    pub atmosphere: f64,
}

impl Gas {
    /// Pressure of a mass of gas in a volume, eq. (4): absolute [Pa] from [kg] and [m3].
    #[inline]
    pub fn pressure(&self, mass: f64, volume: f64) -> f64 {
        mass * self.specific_gas_constant * self.temperature / volume
    }

    /// Specific heat at constant volume [J/(kg K)].
    pub fn specific_heat_volume(&self) -> f64 {
        self.specific_gas_constant / (self.heat_capacity_ratio - 1.0)
    }

    /// Specific heat at constant pressure [J/(kg K)].
    pub fn specific_heat_pressure(&self) -> f64 {
        self.heat_capacity_ratio * self.specific_heat_volume()
    }

    /// Mass of the gas that fills a volume at an absolute pressure, eq. (4): [kg] from [Pa] and [m3].
    pub fn mass(&self, pressure: f64, volume: f64) -> f64 {
        pressure * volume / (self.specific_gas_constant * self.temperature)
    }
}

impl Default for Gas {
    /// Dry air at 20 degrees Celsius and standard atmosphere.
    fn default() -> Self {
        Self {
            specific_gas_constant: 287.05,
            heat_capacity_ratio: 1.4,
            temperature: 293.15,
            atmosphere: 101_325.0,
        }
    }
}
