//! A line between regulator and valve: resistance, then volume.
//!
//!     m_dot = (p_in - p_h) / R_h,   p_h V_h = m_h R T           (lumped line, Richer and Hurmuzlu 2000, without the wave's delay)
//!     R_h = 128 mu l / (pi d^4 rho)                             (laminar: Hagen and Poiseuille)
//!
//! R_h resistance, pressure drop over mass flow [Pa s/kg], V_h volume [m3], m_h air in it [kg], l length [m], d inner diameter [m],
//! mu viscosity [Pa s], rho density at the pressure where the line mostly works [kg/m3].
//! Leaves out: turbulence, the wave's delay of l over the speed of sound, 3 ms/m.

/// Viscosity of air at 20 degrees Celsius [Pa s].
const VISCOSITY: f64 = 1.82e-5;

/// The line.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Hose {
    /// Volume [m3].
    pub volume: f64,
    /// Resistance [Pa s/kg].
    pub resistance: f64,
}

impl Hose {
    /// Of a length and inner diameter [m], its resistance at a density [kg/m3].
    pub fn of_geometry(length: f64, diameter: f64, density: f64) -> Self {
        let area = 0.25 * std::f64::consts::PI * diameter * diameter;
        Self {
            volume: area * length,
            resistance: 128.0 * VISCOSITY * length
                / (std::f64::consts::PI * diameter.powi(4) * density),
        }
    }

    /// Mass flow into the line's volume [kg/s] from a pressure before it and the pressure in it [Pa].
    pub fn mass_flow(&self, before: f64, within: f64) -> f64 {
        (before - within) / self.resistance
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_metre_of_4_mm_hose_is_12_6_cm3_and_drops_96_pa_at_1_l_per_min_and_atmosphere() {
        let hose = Hose::of_geometry(1.0, 0.004, 1.204);
        assert!((hose.volume - 12.566e-6).abs() < 1e-9);
        let litre_per_minute = 1e-3 / 60.0 * 1.204;
        let drop = hose.resistance * litre_per_minute;
        // 8 mu l Q / (pi r^4)
        let textbook = 8.0 * 1.82e-5 * (1e-3 / 60.0) / (std::f64::consts::PI * 0.002f64.powi(4));
        assert!((drop / textbook - 1.0).abs() < 1e-12);
        assert!((hose.mass_flow(2e5 + drop, 2e5) / litre_per_minute - 1.0).abs() < 1e-12);
    }
}
