//! An air motor or turbine whose speed falls in proportion to the torque on it.
//!
//! ```text
//! omega = omega_0 (1 - T / T_0)
//! ```
//!
//! omega speed [rad/s], omega_0 that without load, T torque [N m], T_0 torque at which it stalls; power is greatest, omega_0 T_0 / 4, at half of it.
//! The straight line is that of vane motors and turbines (Atlas Copco, Pocket Guide to Air Motors, 2015). Leaves out: governors, and the rotor's inertia.

/// Speed line of a spindle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Spindle {
    /// Speed without load [rad/s].
    pub free_speed: f64,
    /// Torque at which it stalls [N m]; infinite for a speed that no load changes.
    pub stall_torque: f64,
}

impl Spindle {
    /// Speed [rad/s] under a torque [N m]; zero where it stalls.
    pub fn speed(&self, torque: f64) -> f64 {
        self.free_speed * (1.0 - torque / self.stall_torque).max(0.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn power_is_greatest_at_half_the_stall_torque() {
        let spindle = Spindle {
            free_speed: 2000.0,
            stall_torque: 0.4,
        };
        let power = |torque: f64| torque * spindle.speed(torque);
        assert!((power(0.2) - 200.0).abs() < 1e-12);
        assert!(power(0.19) < power(0.2) && power(0.21) < power(0.2));
        assert_eq!(spindle.speed(0.5), 0.0);
        let stiff = Spindle {
            stall_torque: f64::INFINITY,
            ..spindle
        };
        assert_eq!(stiff.speed(100.0), 2000.0);
    }
}
