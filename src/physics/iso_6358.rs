//! Mass flow through a bought component, from the two numbers of its data sheet.
//!
//! ```text
//! m_dot = C p_1 rho_0 sqrt(T_0 / T_1)                                              for u <= b          (ISO 6358: choked)
//! m_dot = C p_1 rho_0 sqrt(T_0 / T_1) sqrt(1 - ((u - b) / (1 - b))^2)              for u >  b          (subsonic: an ellipse)
//! ```
//!
//! m_dot mass flow [kg/s], C sonic conductance [m3/(s Pa)], b critical pressure ratio [1], p_1 upstream and p_2 downstream pressure, absolute [Pa],
//! u = p_2 / p_1, T_1 upstream temperature [K], rho_0 and T_0 density and temperature of the standard reference atmosphere (ANR, ISO 8778).
//!
//! The source paper's eqs. (9) to (11) (`orifice`) know an area and a discharge coefficient instead. Equal choked flow makes one of the other,
//!
//! ```text
//! C rho_0 sqrt(T_0) = A C_d f(r) / sqrt(R)
//! ```
//!
//! and b = r of eq. (11) then gives nearly the same subsonic flow. A real valve has a lower b, 0.2 to 0.5: the same choked flow, less of it near u = 1.
//! As in `orifice`, the flow is linear in the pressure difference above `LAMINAR_RATIO`, and goes either way.

use super::gas::Gas;
use super::orifice::{FlowFunction, LAMINAR_RATIO};

/// Density of air at the standard reference atmosphere, 20 degrees Celsius, 1 bar, 65 % humidity [kg/m3].
pub const REFERENCE_DENSITY: f64 = 1.185;
/// Temperature of the standard reference atmosphere [K].
pub const REFERENCE_TEMPERATURE: f64 = 293.15;

/// A component by its ISO 6358 parameters.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FlowRating {
    /// Sonic conductance C [m3/(s Pa)]; 1 dm3/(s bar) is 1e-8.
    pub sonic_conductance: f64,
    /// Critical pressure ratio b [1], in 0..1.
    pub critical_ratio: f64,
}

impl FlowRating {
    /// Data-sheet values of an orifice. `conductance_area` is A C_d [m2]; the critical ratio is that of eq. (11).
    pub fn of_orifice(conductance_area: f64, gas: &Gas) -> Self {
        let function = FlowFunction::new(gas);
        Self {
            sonic_conductance: conductance_area * conductance_per_area(gas),
            critical_ratio: function.critical_ratio(),
        }
    }

    /// A C_d [m2] of the orifice with the same choked flow.
    pub fn conductance_area(&self, gas: &Gas) -> f64 {
        self.sonic_conductance / conductance_per_area(gas)
    }

    /// Share of the choked flow [1] at a pressure ratio in 0..=1.
    pub fn share(&self, ratio: f64) -> f64 {
        if ratio <= self.critical_ratio {
            1.0
        } else if ratio > LAMINAR_RATIO {
            self.ellipse(LAMINAR_RATIO) * (1.0 - ratio) / (1.0 - LAMINAR_RATIO)
        } else {
            self.ellipse(ratio)
        }
    }

    fn ellipse(&self, ratio: f64) -> f64 {
        let along = (ratio - self.critical_ratio) / (1.0 - self.critical_ratio);
        (1.0 - along * along).sqrt()
    }

    /// Mass flow from `from` to `to` [kg/s], negative when `to` has the higher pressure. Pressures absolute [Pa]; `temperature` [K] is that of the
    /// side with the higher pressure.
    pub fn mass_flow(&self, temperature: f64, from: f64, to: f64) -> f64 {
        let (upstream, downstream) = (from.max(to), from.min(to));
        let choked = self.sonic_conductance
            * upstream
            * REFERENCE_DENSITY
            * (REFERENCE_TEMPERATURE / temperature).sqrt();
        (choked * self.share(downstream / upstream)).copysign(from - to)
    }
}

/// Volume that a mass flow [kg/s] has at the standard reference atmosphere, as data sheets state flows (ANR) [m3/s].
pub fn reference_volume_flow(mass_flow: f64) -> f64 {
    mass_flow / REFERENCE_DENSITY
}

/// C over A C_d at equal choked flow [m/(s Pa)]; the temperature of the gas cancels.
fn conductance_per_area(gas: &Gas) -> f64 {
    let choked = FlowFunction::new(gas).value(0.0);
    choked / (REFERENCE_DENSITY * (gas.specific_gas_constant * REFERENCE_TEMPERATURE).sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A maker's worked example: C = 2 dm3/(s bar), b = 0.3, from 0.4 to 0.3 MPa gauge at 20 degrees Celsius, atmosphere 0.1 MPa.
    const EXAMPLE: FlowRating = FlowRating {
        sonic_conductance: 2e-8,
        critical_ratio: 0.3,
    };

    fn litres_per_minute(mass_flow: f64) -> f64 {
        reference_volume_flow(mass_flow) * 6e4
    }

    #[test]
    fn the_worked_example_gives_600_and_420_litres_per_minute() {
        let largest = litres_per_minute(EXAMPLE.mass_flow(293.15, 5e5, 1e5));
        assert!((largest - 600.0).abs() < 1e-9, "{largest}");
        let actual = litres_per_minute(EXAMPLE.mass_flow(293.15, 5e5, 4e5));
        assert!((actual - 420.0).abs() < 0.5, "{actual}");
        let exact = (1.0 - (0.5f64 / 0.7).powi(2)).sqrt();
        assert!((exact - 0.6999).abs() < 5e-5 && (EXAMPLE.share(0.8) - exact).abs() < 1e-15);
    }

    #[test]
    fn an_orifice_and_its_rating_are_the_same_when_choked_and_near_when_not() {
        let gas = Gas::default();
        let function = FlowFunction::new(&gas);
        let rating = FlowRating::of_orifice(2e-6, &gas);
        assert!((rating.conductance_area(&gas) / 2e-6 - 1.0).abs() < 1e-15);
        let mut largest = 0.0f64;
        for i in 0..=1000 {
            let to = 7e5 * f64::from(i) * 1e-3;
            let orifice = function.mass_flow(2e-6, 7e5, to);
            let rated = rating.mass_flow(gas.temperature, 7e5, to);
            let choked = function.mass_flow(2e-6, 7e5, 0.0);
            if to < 0.528 * 7e5 {
                assert!((rated / orifice - 1.0).abs() < 1e-14, "{to}");
            }
            largest = largest.max((rated - orifice).abs() / choked);
        }
        assert!(largest > 1e-3 && largest < 2e-3, "{largest}");
    }

    #[test]
    fn flow_is_continuous_goes_either_way_and_carries_less_of_hot_air() {
        for ratio in [0.3, LAMINAR_RATIO] {
            let step = EXAMPLE.share(ratio + 1e-12) - EXAMPLE.share(ratio - 1e-12);
            assert!(step.abs() < 1e-9, "{ratio}: {step}");
        }
        assert_eq!(EXAMPLE.mass_flow(293.15, 4e5, 4e5), 0.0);
        let forth = EXAMPLE.mass_flow(293.15, 4e5, 3e5);
        assert_eq!(EXAMPLE.mass_flow(293.15, 3e5, 4e5), -forth);
        let hot = EXAMPLE.mass_flow(4.0 * 293.15, 4e5, 3e5);
        assert!((hot / forth - 0.5).abs() < 1e-15);
    }
}
