//! A push from outside at the flange's origin, its direction held in the base's axes.
//!
//! ```text
//! f(t) = F r(t),     r = sin^2 from 0 to 1 over a time e after the start, 1 between, back over e before the end
//! ```
//!
//! F largest force [N], e a share of the duration.

use glam::DVec3;

/// A push.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Push {
    /// Which of the recordings it is in.
    pub recording: usize,
    /// Start [s].
    pub start: f64,
    /// End [s].
    pub end: f64,
    /// Share of the duration in which it grows, and in which it fades [1].
    pub edge: f64,
    /// Largest force, in the base's axes [N].
    pub force: DVec3,
}

impl Push {
    /// Share of the largest force at a time of its recording [1].
    #[must_use]
    pub fn share(&self, time: f64) -> f64 {
        let edge = (self.edge * (self.end - self.start)).max(1e-6);
        let inside = (time - self.start).min(self.end - time);
        let phase = (inside / edge).clamp(0.0, 1.0);
        (std::f64::consts::FRAC_PI_2 * phase).sin().powi(2)
    }
}
