//! Legs of a run, from one discontinuity to the next, and a solver taken along them.
//!
//! A solver that chooses its own steps is stopped where the inputs jump and where a contact is made or left: the latter is sought, by bisection, on
//! the solver's own interpolant, as its crate's event functions do.

use idc_cell::physics::valve::ValvePosition;

use super::model::{Leg, Model, State};

/// Times that are closer than this are the same [s].
const ROUNDING: f64 = 1e-12;

/// Commands, in order of time.
#[derive(Debug, Clone)]
pub struct Timetable {
    /// When a set pressure arrives at the regulator's lag [s] and the outlet that it leads to, gauge [Pa].
    pub arrivals: Vec<(f64, f64)>,
    /// Positions of the valve from a time on [s].
    pub valve: Vec<(f64, ValvePosition)>,
    /// End of the run [s].
    pub end: f64,
}

impl Timetable {
    /// Times at which the inputs jump, from 0 to the end, both included.
    pub fn breaks(&self) -> Vec<f64> {
        let arrivals = self.arrivals.iter().map(|a| a.0);
        let valve = self.valve.iter().map(|v| v.0);
        let mut times: Vec<f64> = arrivals.chain(valve).chain([0.0, self.end]).collect();
        times.retain(|time| *time <= self.end);
        times.sort_by(f64::total_cmp);
        times.dedup();
        times
    }

    /// The leg that starts at one of the breaks, the last leg's outlet being known.
    pub fn leg(&self, model: &Model, before: Option<&Leg>, start: f64, state: &State) -> Leg {
        let arrived = self.arrivals.iter().rev().find(|a| a.0 <= start);
        let valve = self.valve.iter().rev().find(|v| v.0 <= start);
        Leg {
            start,
            outlet: before.map_or(0.0, |leg| model.outlet(leg, start)),
            target: arrived.map_or(0.0, |a| a.1),
            valve: valve.map_or(ValvePosition::Extend, |v| v.1),
            contacts: model.contacts(state),
        }
    }
}

/// A solver that chooses its own steps.
pub trait Stepper {
    /// Starts, with a first step `step` [s], or one of its own choice.
    fn start(&mut self, leg: &Leg, time: f64, state: &State, end: f64, step: Option<f64>);

    /// Takes one step, not beyond `stop` [s].
    fn step(&mut self, stop: f64);

    /// Time [s] and state after the last step.
    fn now(&self) -> (f64, State);

    /// Length that it would give its next step [s].
    fn next_step(&self) -> f64;

    /// State within the last step.
    fn at(&mut self, time: f64) -> State;
}

/// Where a solver has to stop although nothing happens.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Stops {
    /// Nowhere: samples are interpolated.
    Free,
    /// At every sample, as for a loop that must know the state.
    Held,
    /// At every sample, and what the solver remembers is of no use, for the loop has changed something.
    Renewed,
}

/// A run of a solver over a timetable.
pub struct Run<'a> {
    /// The equations.
    pub model: &'a Model,
    /// Commands.
    pub timetable: &'a Timetable,
    /// State at the start.
    pub start: State,
    /// Where it stops.
    pub stops: Stops,
    /// Times at which the state is wanted [s], in order.
    pub samples: &'a [f64],
}

impl Run<'_> {
    /// Hands the state at each sample to `seen`.
    pub fn go(&self, solver: &mut dyn Stepper, seen: &mut dyn FnMut(f64, &State)) {
        let mut samples = Samples {
            times: self.samples,
            next: 0,
        };
        let mut state = self.start;
        let mut before: Option<Leg> = None;
        for window in self.timetable.breaks().windows(2) {
            let mut leg = self
                .timetable
                .leg(self.model, before.as_ref(), window[0], &state);
            if self.model.rests(&leg, &state) {
                samples.hand_on(window[1], &mut |_| state, seen);
            } else {
                state = self.leg(&mut leg, window[1], state, solver, &mut samples, seen);
            }
            before = Some(leg);
        }
    }

    /// To the end of a leg; its contacts change on the way.
    fn leg(
        &self,
        leg: &mut Leg,
        end: f64,
        mut state: State,
        solver: &mut dyn Stepper,
        samples: &mut Samples<'_>,
        seen: &mut dyn FnMut(f64, &State),
    ) -> State {
        let mut time = leg.start;
        solver.start(leg, time, &state, end, None);
        while time < end {
            let begun = time;
            let stop = match self.stops {
                Stops::Free => end,
                _ => samples.next_after(time).min(end),
            };
            solver.step(stop);
            (time, state) = solver.now();
            if (time - stop).abs() < ROUNDING {
                time = stop;
            }
            let changed = self.model.contacts(&state) != leg.contacts;
            if changed {
                time = self.change(leg, solver, begun, time);
                state = solver.at(time);
            }
            let mut there = |sample| {
                if sample < time {
                    solver.at(sample)
                } else {
                    state
                }
            };
            samples.hand_on(time, &mut there, seen);
            if changed {
                leg.contacts = self.model.contacts(&state);
                if time < end {
                    solver.start(leg, time, &state, end, None);
                }
            } else if self.stops == Stops::Renewed && time >= stop && time < end {
                let step = solver.next_step();
                solver.start(leg, time, &state, end, Some(step));
            }
        }
        state
    }

    /// When the contacts are first others than the leg's, within the last step [s].
    fn change(&self, leg: &Leg, solver: &mut dyn Stepper, begun: f64, time: f64) -> f64 {
        let (mut before, mut after) = (begun, time);
        while after - before > 0.1 * ROUNDING {
            let middle = 0.5 * (before + after);
            if self.model.contacts(&solver.at(middle)) == leg.contacts {
                before = middle;
            } else {
                after = middle;
            }
        }
        after
    }
}

/// Samples, of which some have been handed on.
struct Samples<'a> {
    times: &'a [f64],
    next: usize,
}

impl Samples<'_> {
    /// Hands on those up to a time [s].
    fn hand_on(
        &mut self,
        until: f64,
        state_at: &mut dyn FnMut(f64) -> State,
        seen: &mut dyn FnMut(f64, &State),
    ) {
        while let Some(&time) = self.times.get(self.next).filter(|time| **time <= until) {
            seen(time, &state_at(time));
            self.next += 1;
        }
    }

    /// The next one that is later than a time [s].
    fn next_after(&self, time: f64) -> f64 {
        let left = &self.times[self.next..];
        left.iter()
            .copied()
            .find(|sample| *sample > time)
            .unwrap_or(f64::INFINITY)
    }
}
