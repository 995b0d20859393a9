//! The outlet's largest rates: what the regulator's own valve can fill or vent behind it.
//!
//! ```text
//! dp/dt = min(max((K p_set - p) / tau, -fall), rise)                                 first order
//! p'' = w^2 (K p_set - p) - 2 zeta w p',  p' held at -fall or rise while p'' would drive it beyond         second order
//! ```
//!
//! Either is solved exactly, piece by piece. First order: a ramp until the distance to the target is the limit times tau, then the lag. Second order:
//! free until the rate meets its limit, a ramp until the oscillator would slow down by itself, then free again; the rate is monotonic between
//! the zeros of p'', so that the meeting is bracketed.

use super::second_order::SecondOrder;
use super::trajectory::Law;

/// Relative tolerance within which a piece counts as over, so that its end does not start it again [1].
const ROUNDING: f64 = 1e-9;

/// Halvings of a bracket: to the resolution of the number.
const HALVINGS: usize = 60;

/// Largest rates of the outlet.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RateLimit {
    /// Upwards [Pa/s]; infinite for none.
    pub rise: f64,
    /// Downwards [Pa/s]; infinite for none.
    pub fall: f64,
}

impl RateLimit {
    /// None.
    pub const NONE: Self = Self {
        rise: f64::INFINITY,
        fall: f64::INFINITY,
    };

    /// The limit in a direction [Pa/s], with its sign.
    fn towards(&self, direction: f64) -> f64 {
        if direction > 0.0 {
            self.rise
        } else {
            -self.fall
        }
    }

    /// Law from a pressure [Pa] on its way to a target [Pa] by a lag of a rate [1/s], and for how long [s].
    pub(super) fn of_lag(&self, start: f64, target: f64, lag: f64) -> (Law, f64) {
        let limit = self.towards(target - start);
        let until = target - limit / lag;
        let left = (until - start) * limit.signum();
        if left > ROUNDING * (target.abs() + (limit / lag).abs()) {
            (Law::Ramp { rate: limit }, left / limit.abs())
        } else {
            (Law::Lag { rate: lag }, f64::INFINITY)
        }
    }

    /// Law from a pressure [Pa] and rate [Pa/s] on about a target [Pa], and for how long [s], `longest` [s] at most.
    pub(super) fn of_oscillator(
        &self,
        start: f64,
        rate: f64,
        target: f64,
        oscillator: SecondOrder,
        longest: f64,
    ) -> (Law, f64) {
        let rate = rate.clamp(-self.fall, self.rise);
        let free = Law::Oscillation { oscillator, rate };
        let deviation = start - target;
        // Its energy only falls, so that its rate stays below this.
        let fastest = rate.hypot(oscillator.natural_frequency * deviation);
        if fastest <= self.rise.min(self.fall) {
            return (free, longest);
        }
        let limit = self.towards(rate);
        let share = 2.0 * oscillator.damping_ratio / oscillator.natural_frequency;
        let until = target - share * limit;
        let left = (until - start) * limit.signum();
        let at_limit = rate.abs() >= limit.abs() * (1.0 - ROUNDING);
        if at_limit && left > ROUNDING * (target.abs() + (share * limit).abs()) {
            return (Law::Ramp { rate: limit }, left / limit.abs());
        }
        let acceleration = oscillator.acceleration(deviation, rate);
        let jerk = oscillator.acceleration(rate, acceleration);
        let span = longest.min(oscillator.next_zero(acceleration, jerk));
        let rate_at = |time| oscillator.after(deviation, rate, time).1;
        let beyond = |rate: f64| rate.abs() > self.towards(rate).abs() * (1.0 + ROUNDING);
        if !beyond(rate_at(span)) {
            return (free, span);
        }
        let (mut before, mut after) = (0.0, span);
        for _ in 0..HALVINGS {
            let middle = 0.5 * (before + after);
            if beyond(rate_at(middle)) {
                after = middle;
            } else {
                before = middle;
            }
        }
        (free, before)
    }
}
