//! The piezo pressure regulator: first order with a dead time, relieving.
//!
//! ```text
//! tau dp/dt = K p_set(t - theta) - p,   C(s)/R(s) = K e^(-theta s) / (tau s + 1)        (source paper, eq. 8, and its delay)
//! ```
//!
//! p outlet pressure [Pa, gauge], p_set set pressure [Pa, gauge], K gain [1], tau time constant [s], theta dead time [s].
//! The set pressure is held over a step, so the lag is solved exactly. The outlet cannot exceed the supply.
//!
//! Further properties of a real one, each off by default and exact as well: play (`hysteresis`), limited rates (`rate_limit`), and an oscillator in
//! place of the lag (`second_order`). Leaves out: the outlet's drop with the flow through it.

mod hysteresis;
mod rate_limit;
mod second_order;
mod trajectory;

use std::collections::VecDeque;

pub use hysteresis::play;
pub use rate_limit::RateLimit;
pub use second_order::SecondOrder;
pub use trajectory::OutletTrajectory;

/// Constant parameters during a run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RegulatorParameters {
    /// Steady outlet pressure over set pressure [1].
    pub gain: f64,
    /// Time constant of the lag [s].
    pub time_constant: f64,
    /// Dead time before the lag sees a change of the set pressure [s].
    pub dead_time: f64,
    /// Pressure of the supply, gauge [Pa].
    pub supply: f64,
    /// Half the width of the play between the set pressure and the pressure acted on [Pa].
    pub hysteresis: f64,
    /// Largest rates of the outlet.
    pub rate_limit: RateLimit,
    /// An oscillator in place of the lag, whose time constant then counts no more.
    pub second_order: Option<SecondOrder>,
}

impl Default for RegulatorParameters {
    /// That of models/device.toml.
    fn default() -> Self {
        Self {
            gain: 1.0,
            time_constant: 0.15,
            dead_time: 0.02,
            supply: 6e5,
            hysteresis: 0.0,
            rate_limit: RateLimit::NONE,
            second_order: None,
        }
    }
}

/// The state that changes.
#[derive(Debug, Clone, PartialEq)]
pub struct RegulatorState {
    /// Outlet pressure, gauge [Pa]; to be read, and set by `place`.
    pub outlet: f64,
    /// The pressure that the laws move, gauge [Pa]: the outlet's, unless that is cut off.
    pilot: f64,
    /// Its rate, where the law has one of its own [Pa/s].
    rate: f64,
    /// Set pressures still on their way: time at which each arrives [s], value [Pa gauge].
    pending: VecDeque<(f64, f64)>,
    /// Set pressure that arrived last [Pa gauge].
    arrived: f64,
    /// Pressure acted on: within the play of the one that arrived [Pa gauge].
    acted_on: f64,
    /// Time since the start [s].
    time: f64,
}

impl RegulatorState {
    /// At rest at a set pressure [Pa gauge], in the middle of its play.
    pub fn at_rest(parameters: &RegulatorParameters, set_pressure: f64) -> Self {
        let outlet = (parameters.gain * set_pressure).clamp(0.0, parameters.supply);
        Self {
            outlet,
            pilot: outlet,
            rate: 0.0,
            pending: VecDeque::new(),
            arrived: set_pressure,
            acted_on: set_pressure,
            time: 0.0,
        }
    }

    /// Set pressure acted on: the one that arrived, within the play [Pa gauge].
    pub fn acted_on(&self) -> f64 {
        self.acted_on
    }

    /// Puts the outlet at a pressure [Pa gauge], at rest there, whatever brought it.
    pub fn place(&mut self, outlet: f64) {
        (self.outlet, self.pilot, self.rate) = (outlet, outlet, 0.0);
    }

    /// Commands a set pressure [Pa gauge] from now on.
    pub fn command(&mut self, parameters: &RegulatorParameters, set_pressure: f64) {
        let last = self.pending.back().map_or(self.arrived, |p| p.1);
        if set_pressure != last {
            self.pending
                .push_back((self.time + parameters.dead_time, set_pressure));
        }
    }

    /// Trajectory of the outlet from now on until the next set pressure arrives or another law takes over, `longest` [s] at most.
    pub fn trajectory(&self, parameters: &RegulatorParameters, longest: f64) -> OutletTrajectory {
        let next = self.pending.front().map_or(f64::INFINITY, |p| p.0);
        let target = (parameters.gain * self.acted_on).clamp(0.0, parameters.supply);
        let free = (next - self.time).clamp(0.0, longest);
        let limit = &parameters.rate_limit;
        let (law, holds) = match parameters.second_order {
            None => limit.of_lag(self.pilot, target, 1.0 / parameters.time_constant),
            Some(oscillator) => {
                limit.of_oscillator(self.pilot, self.rate, target, oscillator, free)
            }
        };
        OutletTrajectory {
            start: self.pilot,
            target,
            supply: parameters.supply,
            law,
            duration: free.min(holds),
        }
    }

    /// Goes to the end of a trajectory and takes what arrives there.
    pub fn follow(&mut self, parameters: &RegulatorParameters, trajectory: &OutletTrajectory) {
        (self.pilot, self.rate) = trajectory.state_at(trajectory.duration);
        self.outlet = self.pilot.clamp(0.0, parameters.supply);
        self.time += trajectory.duration;
        while let Some(&(arrival, set_pressure)) = self.pending.front() {
            // The trajectory was cut at the arrival: what is left of it is rounding.
            if arrival > self.time + 1e-12 {
                break;
            }
            self.pending.pop_front();
            self.arrived = set_pressure;
            self.acted_on = play(self.acted_on, set_pressure, parameters.hysteresis);
        }
    }

    /// Lets a supply that has fallen to a pressure [Pa gauge] hold the outlet down; the pilot stays where it is.
    pub fn starve(&mut self, supply: f64) {
        self.outlet = self.outlet.min(supply);
    }

    /// Advances by `dt` [s] and returns the outlet pressure then [Pa gauge]; exact.
    pub fn advance(&mut self, parameters: &RegulatorParameters, dt: f64) -> f64 {
        let mut left = dt;
        while left > 0.0 {
            let trajectory = self.trajectory(parameters, left);
            self.follow(parameters, &trajectory);
            left -= trajectory.duration;
        }
        self.outlet
    }
}

#[cfg(test)]
mod tests;
