//! The outlet over a time in which one law holds: lag, ramp or oscillation.

use super::second_order::SecondOrder;

/// Law of a pressure's motion.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Law {
    /// Exponentially to the target, at one over the time constant [1/s].
    Lag { rate: f64 },
    /// At a constant rate [Pa/s].
    Ramp { rate: f64 },
    /// As an oscillator about the target, with a rate at the start [Pa/s].
    Oscillation { oscillator: SecondOrder, rate: f64 },
}

/// The outlet over a time in which no new set pressure arrives and one law holds.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OutletTrajectory {
    /// Pressure at its start, gauge [Pa].
    pub(super) start: f64,
    /// Where the regulator would take it, gauge [Pa].
    pub(super) target: f64,
    /// The highest there can be, gauge [Pa].
    pub(super) supply: f64,
    pub(super) law: Law,
    /// Duration for which it holds [s].
    pub duration: f64,
}

impl OutletTrajectory {
    /// Outlet pressure, gauge [Pa], at a time since its start [s]. What would swing beyond the supply or below the atmosphere is cut off there.
    #[inline]
    pub fn at(&self, time: f64) -> f64 {
        match self.law {
            Law::Lag { rate } => self.target + (self.start - self.target) * (-time * rate).exp(),
            _ => self.state_at(time).0.clamp(0.0, self.supply),
        }
    }

    /// Outlet pressures, gauge [Pa], half a time `step` [s] and all of it after the time `since` its start [s] at which it is `now` [Pa]; of a lag with one
    /// exponential.
    #[inline]
    pub fn ahead(&self, now: f64, since: f64, step: f64) -> [f64; 2] {
        match self.law {
            Law::Lag { rate } => {
                let decay = (-0.5 * step * rate).exp();
                let deviation = (now - self.target) * decay;
                [self.target + deviation, self.target + deviation * decay]
            }
            _ => [self.at(since + 0.5 * step), self.at(since + step)],
        }
    }

    /// Outlet pressure at its start, gauge [Pa].
    #[inline]
    pub fn start(&self) -> f64 {
        self.start.clamp(0.0, self.supply)
    }

    /// Way of the outlet in its first time [s] [Pa]; of a lag and a ramp as fast as it begins, which costs no exponential.
    #[inline]
    pub fn travel(&self, time: f64) -> f64 {
        match self.law {
            Law::Lag { rate } => (self.target - self.start).abs() * (rate * time).min(1.0),
            Law::Ramp { rate } => rate.abs() * time,
            Law::Oscillation { .. } => (self.at(time) - self.at(0.0)).abs(),
        }
    }

    /// Pressure [Pa gauge], nothing cut off, and its rate [Pa/s] at a time since its start [s]; a lag needs no rate and tells none.
    pub(super) fn state_at(&self, time: f64) -> (f64, f64) {
        match self.law {
            Law::Lag { .. } => (self.at(time), 0.0),
            Law::Ramp { rate } => (self.start + rate * time, rate),
            Law::Oscillation { oscillator, rate } => {
                let (deviation, rate) = oscillator.after(self.start - self.target, rate, time);
                (self.target + deviation, rate)
            }
        }
    }
}
