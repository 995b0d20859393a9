//! The piezo pressure regulator: first order with a dead time, relieving.
//!
//!     tau dp/dt = K p_set(t - theta) - p,   C(s)/R(s) = K e^(-theta s) / (tau s + 1)        (source paper, eq. 8, and its delay)
//!
//! p outlet pressure [Pa, gauge], p_set set pressure [Pa, gauge], K gain [1], tau time constant [s], theta dead time [s].
//! The set pressure is held over a step, so the lag is solved exactly. The outlet cannot exceed the supply.
//! Leaves out: the outlet's own flow limit, dead band and hysteresis of the pilot.

use std::collections::VecDeque;

/// What does not change during a run.
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
}

/// What changes.
#[derive(Debug, Clone, PartialEq)]
pub struct RegulatorState {
    /// Outlet pressure, gauge [Pa].
    pub outlet: f64,
    /// Set pressures still on their way: time at which each arrives [s], value [Pa gauge].
    pending: VecDeque<(f64, f64)>,
    /// Set pressure that the lag sees now [Pa gauge].
    arrived: f64,
    /// Time since the start [s].
    time: f64,
}

impl RegulatorState {
    /// At rest at a set pressure [Pa gauge].
    pub fn at_rest(parameters: &RegulatorParameters, set_pressure: f64) -> Self {
        Self {
            outlet: (parameters.gain * set_pressure).clamp(0.0, parameters.supply),
            pending: VecDeque::new(),
            arrived: set_pressure,
            time: 0.0,
        }
    }

    /// Commands a set pressure [Pa gauge] from now on.
    pub fn command(&mut self, parameters: &RegulatorParameters, set_pressure: f64) {
        let last = self.pending.back().map_or(self.arrived, |p| p.1);
        if set_pressure != last {
            self.pending
                .push_back((self.time + parameters.dead_time, set_pressure));
        }
    }

    /// How the outlet moves from now on until the next set pressure arrives, `longest` [s] at most.
    pub fn course(&self, parameters: &RegulatorParameters, longest: f64) -> OutletCourse {
        let next = self.pending.front().map_or(f64::INFINITY, |p| p.0);
        OutletCourse {
            start: self.outlet,
            target: (parameters.gain * self.arrived).clamp(0.0, parameters.supply),
            rate: 1.0 / parameters.time_constant,
            duration: (next - self.time).clamp(0.0, longest),
        }
    }

    /// Goes to the end of a course and takes what arrives there.
    pub fn follow(&mut self, course: &OutletCourse) {
        self.outlet = course.at(course.duration);
        self.time += course.duration;
        while let Some(&(arrival, set_pressure)) = self.pending.front() {
            // The course was cut at the arrival: what is left of it is rounding.
            if arrival > self.time + 1e-12 {
                break;
            }
            self.pending.pop_front();
            self.arrived = set_pressure;
        }
    }

    /// Advances by `dt` [s] and returns the outlet pressure then [Pa gauge]; exact.
    pub fn advance(&mut self, parameters: &RegulatorParameters, dt: f64) -> f64 {
        let mut left = dt;
        while left > 0.0 {
            let course = self.course(parameters, left);
            self.follow(&course);
            left -= course.duration;
        }
        self.outlet
    }
}

/// The outlet over a time in which no new set pressure arrives.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OutletCourse {
    /// Outlet pressure at its start, gauge [Pa].
    start: f64,
    /// Where the lag takes it, gauge [Pa].
    target: f64,
    /// One over the time constant [1/s].
    rate: f64,
    /// How long it holds [s].
    pub duration: f64,
}

impl OutletCourse {
    /// Outlet pressure, gauge [Pa], at a time since its start [s].
    pub fn at(&self, time: f64) -> f64 {
        self.target + (self.start - self.target) * (-time * self.rate).exp()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn step_response(dt: f64, until: f64) -> f64 {
        let parameters = RegulatorParameters {
            gain: 0.98,
            time_constant: 0.15,
            dead_time: 0.0205,
            supply: 6e5,
        };
        let mut state = RegulatorState::at_rest(&parameters, 0.0);
        state.command(&parameters, 2e5);
        for _ in 0..(until / dt).round() as usize {
            state.advance(&parameters, dt);
        }
        state.outlet
    }

    #[test]
    fn a_step_follows_the_closed_form_whatever_the_step() {
        for dt in [1e-3, 2.5e-4, 1e-2] {
            let exact = 0.98 * 2e5 * (1.0 - (-(0.4 - 0.0205f64) / 0.15).exp());
            assert!((step_response(dt, 0.4) / exact - 1.0).abs() < 1e-12);
            assert_eq!(step_response(dt, 0.02), 0.0);
        }
    }

    #[test]
    fn the_outlet_never_exceeds_the_supply() {
        let parameters = RegulatorParameters {
            gain: 1.0,
            time_constant: 0.1,
            dead_time: 0.0,
            supply: 3e5,
        };
        let mut state = RegulatorState::at_rest(&parameters, 0.0);
        state.command(&parameters, 5e5);
        for _ in 0..5000 {
            state.advance(&parameters, 1e-3);
        }
        assert!((state.outlet - 3e5).abs() < 1e-6);
    }
}
