//! Force along the edge of contact that a turning tool needs to cut and to rub.
//!
//! ```text
//! F_t = u Q / v + mu F,     P = F_t v
//! ```
//!
//! F_t tangential force [N], against the motion of the tool's surface, u specific cutting energy [J/m3], Q volume removed per time [m3/s], v speed of the
//! tool's surface [m/s], mu friction of what rubs [1], F normal force [N], P power at the tool [W]. Energy per volume: Malkin, Grinding Technology, 2008, sec. 5.
//! Leaves out: that u grows as chips get thinner (size effect).

/// What a material asks of a turning tool.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CuttingForce {
    /// Specific cutting energy [J/m3].
    pub specific_energy: f64,
    /// Friction of the tool's surface [1].
    pub friction: f64,
}

impl CuttingForce {
    /// Tangential force [N] at a removal rate [m3/s], a surface speed [m/s] and a normal force [N]; none of a tool that stands.
    pub fn tangential(&self, rate: f64, speed: f64, force: f64) -> f64 {
        if speed <= 0.0 {
            return 0.0;
        }
        self.specific_energy * rate / speed + self.friction * force
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn power_is_energy_per_volume_and_rubbing() {
        let aluminium = CuttingForce {
            specific_energy: 2e9,
            friction: 0.3,
        };
        let (rate, speed, force) = (3e-9, 8.0, 10.0);
        let power = speed * aluminium.tangential(rate, speed, force);
        assert!((power - (6.0 + 24.0)).abs() < 1e-12, "{power}");
        assert_eq!(aluminium.tangential(rate, 0.0, force), 0.0);
    }
}
