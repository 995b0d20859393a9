//! The spring between a joint's motor and its link, with play between teeth.
//!
//! ```text
//! T = K z + K b e',   z = e - sign(e) p/2 where |e| >= p/2, else T = 0
//! ```
//!
//! e deflection [rad], T torque [N m], K stiffness [N m/rad], b damping over stiffness [s], p play from flank to flank [rad]. (Spong, J. Dyn. Syst. Meas.
//! Control 109, 1987; the play as in Nordin, Gutman, Automatica 38, 2002, sec. 2.)

/// Spring, damping and play of one joint.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct JointSpring {
    /// Stiffness [N m/rad].
    pub stiffness: f64,
    /// Damping over stiffness [s].
    pub damping_time: f64,
    /// Play from flank to flank [rad].
    pub play: f64,
}

impl JointSpring {
    /// Whether the teeth are together at a deflection [rad].
    pub fn engaged(&self, deflection: f64) -> bool {
        deflection.abs() >= 0.5 * self.play
    }

    /// Stiffness [N m/rad] at a deflection [rad], and the deflection at which that spring rests [rad].
    pub fn at(&self, deflection: f64) -> (f64, f64) {
        let rest = match self.play {
            0.0 => 0.0,
            play => 0.5 * play * deflection.signum(),
        };
        match self.engaged(deflection) {
            true => (self.stiffness, rest),
            false => (0.0, rest),
        }
    }

    /// Deflection at rest under a torque [N m].
    pub fn under(&self, torque: f64) -> f64 {
        let side = if torque == 0.0 { 0.0 } else { torque.signum() };
        torque / self.stiffness + 0.5 * side * self.play
    }
}
