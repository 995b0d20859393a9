//! A hold of the piston to a measured motion over one step.

use super::cubic::Cubic;
use crate::device::PistonMotion;

/// Largest sub-step times the fastest rate of a piston that is held to its measured motion [rad]: what it does then is compared roughly.
pub(super) const HELD_SWING: f64 = 0.6;

/// Spring and damper to a motion.
#[derive(Debug, Clone, Copy)]
pub(super) struct Hold {
    /// Stroke over the step [m].
    pub stroke: Cubic,
    /// Stiffness [N/m].
    pub stiffness: f64,
    /// Damping [N s/m].
    pub damping: f64,
}

impl Hold {
    /// Force along extension [N].
    pub fn force(&self, time: f64, motion: PistonMotion) -> f64 {
        self.stiffness * (self.stroke.at(time) - motion.stroke)
            + self.damping * (self.stroke.rate(time) - motion.speed)
    }
}
