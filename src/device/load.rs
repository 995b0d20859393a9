//! What acts on the piston from outside the device.

/// Largest sub-step times the fastest rate of stops and load at which a swing is followed closely, its phase to 6e-7 rad a sub-step [rad].
pub const FINE_SWING: f64 = 0.15;

/// Motion of the piston.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct PistonMotion {
    /// Stroke from the retracted end [m].
    pub stroke: f64,
    /// Speed of extension [m/s].
    pub speed: f64,
}

/// Load: the forces on the piston from outside the device. Times are since the start of the step that is being integrated [s].
pub trait Load {
    /// Whether the piston moves under the force. If not, it keeps its speed.
    const MOVES: bool = true;

    /// What of the load depends on time alone: looked at once for all that is asked of one time.
    type Now: Copy;

    /// It at a time [s].
    fn now(&self, time: f64) -> Self::Now;

    /// Force along extension from outside the device [N]: weight, contact, hand. `touching` holds the contact as it was found by `touches`
    /// for the whole of a sub-step, so that the law is smooth in it.
    fn force(&self, now: &Self::Now, motion: PistonMotion, touching: bool) -> f64;

    /// Share of `force` [N] that the contact takes, positive against extension.
    fn contact(&self, _now: &Self::Now, _motion: PistonMotion, _touching: bool) -> f64 {
        0.0
    }

    /// Whether the contact pushes on the piston.
    fn touches(&self, now: &Self::Now, motion: PistonMotion) -> bool;

    /// Takes note of a sub-step that is done: its start and length [s], the motion at both ends.
    fn note(&self, _start: f64, _length: f64, _ends: [PistonMotion; 2]) {}

    /// The fastest rate [1/s] of whatever hangs on the piston, for the choice of sub-steps.
    fn rate(&self) -> f64;

    /// Largest sub-step times that rate [rad].
    fn swing(&self) -> f64 {
        FINE_SWING
    }

    /// As `rate`, of what the piston can meet over a step of `dt` [s] in which it moves no further than `reach` [m].
    fn rate_within(&self, _motion: PistonMotion, _reach: f64, _dt: f64) -> f64 {
        self.rate()
    }
}

/// A piston that somebody else moves: at the same speed throughout.
pub(super) struct Predicted;

impl Load for Predicted {
    const MOVES: bool = false;

    type Now = ();

    fn now(&self, _: f64) {}

    fn force(&self, (): &(), _: PistonMotion, _: bool) -> f64 {
        0.0
    }

    fn touches(&self, (): &(), _: PistonMotion) -> bool {
        false
    }

    fn rate(&self) -> f64 {
        0.0
    }
}
