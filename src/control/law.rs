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

/// Limit of the drive in a joint's law.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DriveLimit {
    /// Largest torque of the drive [N m]; infinite for none.
    pub effort: f64,
    /// Share of the law that is the joint's own losses, not the drive's: constant and damping.
    pub losses: JointLaw,
}

impl DriveLimit {
    /// A law in which the drive gives a torque [N m] whatever the joint does; the losses stay.
    pub fn held(&self, torque: f64) -> JointLaw {
        JointLaw {
            force: torque + self.losses.force,
            damping: self.losses.damping,
            ..JointLaw::default()
        }
    }
}
