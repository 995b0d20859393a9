//! One moment of a joint along its motion.

/// One moment of a joint.
#[derive(Debug, Clone, Copy)]
pub struct JointMoment {
    /// Time since the recording's start [s].
    pub time: f64,
    /// Position [rad].
    pub position: f64,
    /// Speed [rad/s].
    pub speed: f64,
    /// Acceleration [rad/s2].
    pub acceleration: f64,
    /// Share of the sliding friction that is reached [1].
    pub bristles: f64,
    /// Dry friction, cold [N m].
    pub dry: f64,
    /// Torque that the gear carries [N m].
    pub carried: f64,
}
