//! Force of the gas on the piston and its load.
//!
//! ```text
//! F = p_1 A_1 - p_2 A_2 - p_a (A_1 - A_2)
//! ```
//!
//! p_1, p_2 absolute chamber pressures [Pa], A_1, A_2 areas [m2], p_a atmosphere [Pa], F positive in extension [N].
//!
//! Source paper, eq. (1), which leaves out the last term: with absolute pressures the atmosphere also presses on the rod's cross section A_1 - A_2,
//! and without it a device open to the air on both sides would push.

/// Piston areas, all cylinders together.
#[derive(Debug, Clone, Copy)]
pub struct PistonAreas {
    /// Area of chamber 1 [m2].
    pub extending: f64,
    /// Area of chamber 2, less the rod's [m2].
    pub retracting: f64,
}

impl PistonAreas {
    /// Areas of `count` equal cylinders of a bore and rod diameter [m].
    pub fn of_cylinders(count: u32, bore: f64, rod: f64) -> Self {
        let circle = |d: f64| 0.25 * std::f64::consts::PI * d * d;
        let count = f64::from(count);
        Self {
            extending: count * circle(bore),
            retracting: count * (circle(bore) - circle(rod)),
        }
    }

    /// Cross section of the rods, on which the atmosphere presses [m2].
    #[inline]
    pub fn rod(&self) -> f64 {
        self.extending - self.retracting
    }

    /// Force of the gas along extension [N] from absolute pressures [Pa].
    #[inline]
    pub fn gas_force(&self, pressure_1: f64, pressure_2: f64, atmosphere: f64) -> f64 {
        pressure_1 * self.extending - pressure_2 * self.retracting - atmosphere * self.rod()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn open_to_the_air_it_does_not_push_and_at_3_bar_it_gives_482_n() {
        let areas = PistonAreas::of_cylinders(2, 0.032, 0.012);
        assert!(areas.gas_force(101_325.0, 101_325.0, 101_325.0).abs() < 1e-10);
        let force = areas.gas_force(401_325.0, 101_325.0, 101_325.0);
        assert!((force - 482.5).abs() < 0.1, "{force}");
    }
}
