//! A load that hangs on the piston all along its stroke: a constant force, and a spring from the retracted end.
//!
//! ```text
//! F = F_0 - k x
//! ```
//!
//! F along extension [N], F_0 constant force: a weight that hangs on, a wrong tilt [N], k stiffness of a return spring, cable or hose [N/m],
//! x stroke from the retracted end, where the spring is relaxed [m].

/// Force and spring.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AxialLoad {
    /// Constant force along extension [N].
    pub force: f64,
    /// Stiffness of what pulls back in proportion to the stroke [N/m].
    pub return_stiffness: f64,
}

impl AxialLoad {
    /// No load.
    pub const NONE: Self = Self {
        force: 0.0,
        return_stiffness: 0.0,
    };

    /// Force along extension [N] at a stroke [m].
    pub fn force_at(&self, stroke: f64) -> f64 {
        self.force - self.return_stiffness * stroke
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_spring_is_relaxed_at_the_retracted_end_and_pulls_back_from_there() {
        let load = AxialLoad {
            force: -12.0,
            return_stiffness: 300.0,
        };
        assert_eq!(load.force_at(0.0), -12.0);
        assert!((load.force_at(0.04) + 24.0).abs() < 1e-12);
        assert_eq!(AxialLoad::NONE.force_at(0.04), 0.0);
    }
}
