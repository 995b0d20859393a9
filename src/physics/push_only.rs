//! A spring and damper side by side that push and never pull: end stops, the tool on a load cell or surface.
//!
//! ```text
//! F = max(0, k d + c d_dot)   for d > 0,   0 otherwise
//! ```
//!
//! d penetration [m], k stiffness [N/m], c damping [N s/m], F [N] apart.

/// Stiffness and damping.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PushOnly {
    /// Stiffness [N/m].
    pub stiffness: f64,
    /// Damping [N s/m].
    pub damping: f64,
}

impl PushOnly {
    /// Force apart [N] at a penetration [m] and its rate [m/s].
    pub fn force(&self, penetration: f64, rate: f64) -> f64 {
        if self.pushes(penetration, rate) {
            self.linear(penetration, rate)
        } else {
            0.0
        }
    }

    /// Whether it pushes.
    #[inline]
    pub fn pushes(&self, penetration: f64, rate: f64) -> bool {
        penetration > 0.0 && self.linear(penetration, rate) > 0.0
    }

    /// The law without its limits, as it holds throughout a contact [N].
    #[inline]
    pub fn linear(&self, penetration: f64, rate: f64) -> f64 {
        self.stiffness * penetration + self.damping * rate
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_pushes_while_pressed_and_never_pulls() {
        let spring = PushOnly {
            stiffness: 1e6,
            damping: 2e3,
        };
        assert_eq!(spring.force(-1e-3, 5.0), 0.0);
        assert!((spring.force(1e-4, 0.0) - 100.0).abs() < 1e-12);
        assert!((spring.force(1e-4, 0.01) - 120.0).abs() < 1e-12);
        assert_eq!(spring.force(1e-5, -1.0), 0.0);
    }
}
