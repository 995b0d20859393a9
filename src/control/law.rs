//! The law that drives a degree of freedom over a step.

/// Force of one degree of freedom: `force - damping v - stiffness (q - rest)`, with q and v at the end of the step.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct JointLaw {
    /// Constant part [N or N m].
    pub force: f64,
    /// Stiffness [N/m or N m/rad].
    pub stiffness: f64,
    /// Position at which the stiffness pulls to nothing [m or rad].
    pub rest: f64,
    /// Damping [N s/m or N m s/rad].
    pub damping: f64,
}

impl JointLaw {
    /// A constant force.
    pub fn constant(force: f64) -> Self {
        Self {
            force,
            ..Self::default()
        }
    }

    /// Force at a position and speed [N or N m].
    pub fn at(&self, position: f64, speed: f64) -> f64 {
        self.force - self.damping * speed - self.stiffness * (position - self.rest)
    }
}
