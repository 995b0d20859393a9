//! One cylinder chamber: volume and pressure.
//!
//! ```text
//! V_1 = V_0 + A_1 x,   V_2 = V_0 + A_2 (L - x)                         (source paper, below eq. 6)
//! dP/dt = R T / V (m_dot_in - m_dot_out) - P / V dV/dt                 (eq. 6)
//! ```
//!
//! V_0 dead volume [m3], A piston area [m2], x stroke from the retracted end [m], L full stroke [m].
//!
//! Eq. (6) is the derivative of P V = m R T at constant T, so the mass is carried as the state and the pressure follows exactly from eq. (4):
//! no air is lost to the integrator, however coarse its step.
//! Heat exchange with the walls: `gas_process`; leakage: `leakage`.

use super::gas::Gas;

/// Which side of the piston a chamber is on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Side {
    /// Chamber 1, which pushes the piston out.
    Extending,
    /// Chamber 2, the rod's side, which pulls it back.
    Retracting,
}

/// Geometry of a chamber, both cylinders together.
#[derive(Debug, Clone, Copy)]
pub struct Chamber {
    /// Side of the piston.
    pub side: Side,
    /// Volume with the piston at this chamber's end [m3].
    pub dead_volume: f64,
    /// Piston area on this side [m2].
    pub area: f64,
    /// Full stroke of the piston [m].
    pub full_stroke: f64,
}

impl Chamber {
    /// Volume at a stroke [m3]. Held at a tenth of the dead volume beyond the mechanical end, which only a broken end stop would reach.
    #[inline]
    pub fn volume(&self, stroke: f64) -> f64 {
        let displaced = match self.side {
            Side::Extending => stroke,
            Side::Retracting => self.full_stroke - stroke,
        };
        (self.dead_volume + self.area * displaced).max(0.1 * self.dead_volume)
    }

    /// dV/dx: growth of the volume with the stroke [m2].
    #[inline]
    pub fn growth(&self) -> f64 {
        match self.side {
            Side::Extending => self.area,
            Side::Retracting => -self.area,
        }
    }

    /// Absolute pressure [Pa] of a mass of gas [kg] at a stroke [m].
    pub fn pressure(&self, gas: &Gas, mass: f64, stroke: f64) -> f64 {
        gas.pressure(mass, self.volume(stroke))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_closed_chamber_follows_boyle() {
        let gas = Gas::default();
        let chamber = Chamber {
            side: Side::Retracting,
            dead_volume: 2e-5,
            area: 1.4e-3,
            full_stroke: 0.05,
        };
        let mass = gas.mass(3e5, chamber.volume(0.01));
        let product = 3e5 * chamber.volume(0.01);
        for stroke in [0.0, 0.02, 0.05] {
            let pressure = chamber.pressure(&gas, mass, stroke);
            assert!((pressure * chamber.volume(stroke) / product - 1.0).abs() < 1e-14);
        }
        assert!(chamber.volume(0.0) > chamber.volume(0.05));
    }
}
