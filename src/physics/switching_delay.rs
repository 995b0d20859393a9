//! The 5/2 valve's spool, which goes over some time after the command of its solenoid.
//!
//! ```text
//! position(t) = command(t - theta)
//! ```
//!
//! theta switching delay [s], the same either way: makers state 10 to 30 ms for a pilot-operated valve of this size (ISO 12238).
//! The very first command is where the spool stands from the start. Leaves out: flow while the spool is on its way, a few milliseconds.

use std::collections::VecDeque;

use super::valve::ValvePosition;

/// A command counts as arrived if this close [s]: a step that was cut there ends within rounding of it.
const ROUNDING: f64 = 1e-12;

/// Where the spool is, and the commands that it has still to follow.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Spool {
    /// None before the first command.
    position: Option<ValvePosition>,
    /// Time at which each comes into force [s], and the position that it asks for.
    pending: VecDeque<(f64, ValvePosition)>,
    /// Time since the start [s].
    time: f64,
}

impl Spool {
    /// Commands a position from now on, to be taken after a delay [s].
    pub fn command(&mut self, command: ValvePosition, delay: f64) {
        let Some(position) = self.position else {
            self.position = Some(command);
            return;
        };
        if command != self.pending.back().map_or(position, |last| last.1) {
            self.pending.push_back((self.time + delay, command));
            self.switch();
        }
    }

    /// Where it is; `command` before any was given.
    pub fn position(&self, command: ValvePosition) -> ValvePosition {
        self.position.unwrap_or(command)
    }

    /// Time until it next goes over [s]; infinite if it is where it was commanded.
    pub fn remaining(&self) -> f64 {
        let next = self.pending.front();
        next.map_or(f64::INFINITY, |(arrival, _)| arrival - self.time)
    }

    /// Lets a time [s] pass.
    pub fn advance(&mut self, time: f64) {
        self.time += time;
        self.switch();
    }

    fn switch(&mut self) {
        while let Some(&(arrival, position)) = self.pending.front() {
            if arrival > self.time + ROUNDING {
                break;
            }
            self.pending.pop_front();
            self.position = Some(position);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::ValvePosition::{Extend, Retract};
    use super::*;

    #[test]
    fn every_command_comes_into_force_its_delay_later_whatever_the_steps() {
        for dt in [1e-3, 3e-3, 0.7e-3] {
            let mut spool = Spool::default();
            for step in 0..100 {
                let time = f64::from(step) * dt;
                let command = if time < 0.0205 { Retract } else { Extend };
                spool.command(command, 0.015);
                let mut left = dt;
                while left > 0.0 {
                    let piece = left.min(spool.remaining());
                    spool.advance(piece);
                    left -= piece;
                }
                let commanded = (0.0205 / dt).ceil() * dt;
                let late = (f64::from(step + 1) * dt - commanded) - 0.015;
                if late.abs() > 1e-9 {
                    let expected = if late > 0.0 { Extend } else { Retract };
                    assert_eq!(spool.position(Extend), expected, "{dt} {time}");
                }
            }
        }
    }

    #[test]
    fn without_delay_it_obeys_at_once_and_a_short_command_is_not_swallowed() {
        let mut spool = Spool::default();
        spool.command(Extend, 0.0);
        spool.command(Retract, 0.0);
        assert_eq!(spool.position(Extend), Retract);
        let mut seen = Vec::new();
        let mut spool = Spool::default();
        for step in 0..40 {
            let command = if step == 5 { Retract } else { Extend };
            spool.command(command, 0.02);
            spool.advance(1e-3);
            if spool.position(Extend) == Retract {
                seen.push(step);
            }
        }
        assert_eq!(seen, [24]);
    }
}
