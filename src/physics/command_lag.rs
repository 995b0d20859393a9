//! Drives that trail their commands: an interpolator or a filter ahead of the servo, critically damped, the same for all axes.
//!
//! ```text
//! q'' = w^2 (u - q) - 2 w q',   w = 2 pi f
//! ```
//!
//! Exact for commands that are linear between steps (Franklin, Powell, Workman, Digital Control, 1998, sec. 4.3: first-order hold).

use std::f64::consts::TAU;

/// Rate times step beyond which a faster lag is the same to all that a step shows, and its acceleration nothing but rounding [rad].
const FASTEST: f64 = 100.0;

/// Response of one axis to its command.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CommandLag {
    rate: f64,
    command: f64,
    /// Commanded angle of the servo [rad].
    pub position: f64,
    /// Its rate [rad/s].
    pub velocity: f64,
}

impl CommandLag {
    /// Of a bandwidth [Hz], at rest at an angle [rad].
    pub fn at_rest(bandwidth: f64, position: f64) -> Self {
        Self {
            rate: TAU * bandwidth,
            command: position,
            position,
            velocity: 0.0,
        }
    }

    /// Advances by `dt` [s] to a command [rad]; gives the acceleration [rad/s2] then.
    pub fn advance(&mut self, command: f64, dt: f64) -> f64 {
        let w = self.rate.min(FASTEST / dt);
        let slope = (command - self.command) / dt;
        // Against the steady answer to a ramp, u - 2 slope/w, the error decays as (a + b t) exp(-w t).
        let behind = self.command - 2.0 * slope / w;
        let a = self.position - behind;
        let b = self.velocity - slope + w * a;
        let decay = (-w * dt).exp();
        self.position = behind + slope * dt + (a + b * dt) * decay;
        self.velocity = slope + (b - w * (a + b * dt)) * decay;
        self.command = command;
        w * w * (command - self.position) - 2.0 * w * self.velocity
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn however_fast_a_lag_is_it_follows_with_an_acceleration_that_is_one() {
        for bandwidth in [1e3, 1e6, 1e12, 1e300] {
            let mut lag = CommandLag::at_rest(bandwidth, 0.0);
            for step in 1..=200 {
                let time = f64::from(step) * 1e-3;
                let acceleration = lag.advance(0.5 * time * time, 1e-3);
                assert!(
                    (lag.position - 0.5 * time * time).abs() < 1e-4,
                    "{bandwidth}"
                );
                assert!((lag.velocity - time).abs() < 2e-3, "{bandwidth}");
                assert!(acceleration.abs() < 2.0, "{bandwidth}: {acceleration}");
            }
        }
    }

    #[test]
    fn a_ramp_is_followed_two_over_w_behind() {
        let mut lag = CommandLag::at_rest(8.0, 0.0);
        let mut acceleration = 0.0;
        for step in 1..=2000 {
            acceleration = lag.advance(0.1 * f64::from(step) * 1e-3, 1e-3);
        }
        let behind = 0.2 - lag.position;
        assert!((behind - 2.0 * 0.1 / (TAU * 8.0)).abs() < 1e-9);
        assert!((lag.velocity - 0.1).abs() < 1e-9 && acceleration.abs() < 1e-6);
    }
}
