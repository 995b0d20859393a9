//! End stops of the stroke: one at each end, pushing only.
//!
//!     F = k d + c d_dot, never pulling
//!
//! d penetration [m], k stiffness [N/m], c damping [N s/m], F away from the stop [N].

/// An end stop.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EndStop {
    /// Stiffness [N/m].
    pub stiffness: f64,
    /// Damping [N s/m].
    pub damping: f64,
}

impl EndStop {
    /// Force along extension [N] and the damping [N s/m] that acts, at a stroke and speed of extension, for stops at 0 and `full_stroke` [m].
    pub fn force(&self, full_stroke: f64, stroke: f64, speed: f64) -> (f64, f64) {
        let (direction, penetration, rate) = if stroke < 0.0 {
            (1.0, -stroke, -speed)
        } else if stroke > full_stroke {
            (-1.0, stroke - full_stroke, speed)
        } else {
            return (0.0, 0.0);
        };
        let push = self.stiffness * penetration + self.damping * rate;
        if push > 0.0 {
            (direction * push, self.damping)
        } else {
            (0.0, 0.0)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_pushes_inwards_and_never_pulls() {
        let stop = EndStop {
            stiffness: 1e6,
            damping: 2e3,
        };
        assert_eq!(stop.force(0.05, 0.02, 1.0).0, 0.0);
        assert!((stop.force(0.05, -1e-4, 0.0).0 - 100.0).abs() < 1e-9);
        assert!((stop.force(0.05, 0.0501, 0.0).0 + 100.0).abs() < 1e-6);
        assert_eq!(stop.force(0.05, -1e-5, 1.0).0, 0.0);
    }
}
