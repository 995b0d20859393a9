//! The regulator as a controller knows it: where the outlet will be when a set pressure given now begins to act, and what to give.
//!
//! ```text
//! p(t + theta) = e^(-theta/tau) p(t) + (1/tau) integral_0^theta e^(-(theta - s)/tau) K p_set(t + s - theta) ds            (prediction)
//! p_set = (p + (p_goal - p) (1 - e^(-T/T_r)) / (1 - e^(-T/tau))) / K                                                     (lead)
//! ```
//!
//! From the measured outlet and the set pressures on their way the outlet after the dead time is known without feedback (Smith 1957; Manitius and
//! Olbrot 1979, finite spectrum assignment), and there the lag is inverted: over a period T the outlet closes the share of its distance to p_goal that a
//! lag of T_r would. The supply bounds what is asked for, so a large step takes as long as the supply needs.
//!
//! The outlet's departure from the prediction over a period, taken as a set pressure too high or too low and slowly followed, is added to both: so a gain
//! that is a little off leaves no lasting error.

use std::collections::VecDeque;

use crate::physics::regulator::RegulatorParameters;

/// Time constant with which the regulator's bias is followed [s].
const BIAS_TIME: f64 = 0.5;
/// Largest bias, as a share of the supply [1].
const LARGEST_BIAS: f64 = 0.1;

/// The model.
#[derive(Debug, Clone)]
pub(super) struct RegulatorModel {
    parameters: RegulatorParameters,
    period: f64,
    /// Set pressures of the last periods [Pa gauge], oldest first; the oldest acted before the last period began.
    sent: VecDeque<f64>,
    length: usize,
    /// Outlet pressure foreseen for the next call [Pa gauge], if no limit acts until then.
    foreseen: Option<f64>,
    /// Outlet in excess of what the set pressure gives at rest [Pa].
    bias: f64,
}

impl RegulatorModel {
    pub(super) fn new(parameters: RegulatorParameters, period: f64) -> Self {
        // A dead time of whole periods must not become one more by rounding.
        let length = (parameters.dead_time / period - 1e-9).ceil() as usize + 1;
        Self {
            parameters,
            period,
            sent: VecDeque::with_capacity(length + 1),
            length,
            foreseen: None,
            bias: 0.0,
        }
    }

    /// Takes the outlet as it is now [Pa gauge].
    pub(super) fn observe(&mut self, outlet: f64) {
        // What was sent before the first call is what holds the outlet.
        while self.sent.len() < self.length {
            self.sent.push_back(outlet / self.parameters.gain);
        }
        if let Some(foreseen) = self.foreseen {
            let own = -(-self.period / self.parameters.time_constant).exp_m1();
            let largest = LARGEST_BIAS * self.parameters.supply;
            self.bias += self.period / (self.period + BIAS_TIME) * (outlet - foreseen) / own;
            self.bias = self.bias.clamp(-largest, largest);
        }
    }

    /// Goes through the dead time: hands over each piece of it as its length [s] and the outlet in its middle [Pa gauge], and returns the outlet at its
    /// end.
    pub(super) fn through_dead_time(&self, outlet: f64, piece: impl FnMut(f64, f64)) -> f64 {
        self.ahead(outlet, self.period, self.parameters.dead_time, piece)
    }

    /// The outlet after a time `until` [s], the newest set pressure having been sent `age` [s] before.
    fn ahead(&self, outlet: f64, age: f64, until: f64, mut piece: impl FnMut(f64, f64)) -> f64 {
        let mut pressure = outlet;
        for (i, set_pressure) in self.sent.iter().rev().enumerate().rev() {
            let arrival = self.parameters.dead_time - age - i as f64 * self.period;
            let end = if i == 0 {
                until
            } else {
                until.min(arrival + self.period)
            };
            let duration = end - arrival.max(0.0);
            if duration <= 0.0 {
                continue;
            }
            let middle = self.relaxed(pressure, *set_pressure, 0.5 * duration);
            piece(duration, middle);
            pressure = self.relaxed(middle, *set_pressure, 0.5 * duration);
        }
        pressure
    }

    fn relaxed(&self, outlet: f64, set_pressure: f64, duration: f64) -> f64 {
        let target = self.target(set_pressure).clamp(0.0, self.parameters.supply);
        target + (outlet - target) * (-duration / self.parameters.time_constant).exp()
    }

    /// Where a set pressure takes the outlet before any limit [Pa gauge].
    fn target(&self, set_pressure: f64) -> f64 {
        self.parameters.gain * set_pressure + self.bias
    }

    /// Set pressure [Pa gauge], before any limit, that takes the outlet from `outlet` towards `goal` as a lag of `response_time` [s] would, and
    /// after that along with it at `rate` [Pa/s].
    pub(super) fn lead(&self, outlet: f64, goal: f64, rate: f64, response_time: f64) -> f64 {
        let share = -(-self.period / response_time).exp_m1();
        self.set_for_change(outlet, (goal - outlet) * share + rate * self.period)
    }

    /// Set pressure [Pa gauge], before any limit, that changes the outlet from `outlet` by `change` [Pa] over a period.
    pub(super) fn set_for_change(&self, outlet: f64, change: f64) -> f64 {
        let own = -(-self.period / self.parameters.time_constant).exp_m1();
        (outlet + change / own - self.bias) / self.parameters.gain
    }

    /// Sends a set pressure, limited to what the regulator takes, and returns it [Pa gauge]. `outlet` is the outlet as it is now [Pa gauge].
    pub(super) fn send(&mut self, set_pressure: f64, outlet: f64) -> f64 {
        let limited = set_pressure.clamp(0.0, self.parameters.supply);
        self.sent.push_back(limited);
        while self.sent.len() > self.length {
            self.sent.pop_front();
        }
        let within = |set: &f64| (1.0..self.parameters.supply).contains(&self.target(*set));
        self.foreseen = self
            .sent
            .iter()
            .all(within)
            .then(|| self.ahead(outlet, 0.0, self.period, |_, _| ()));
        limited
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::physics::regulator::RegulatorState;

    fn parameters(dead_time: f64) -> RegulatorParameters {
        RegulatorParameters {
            gain: 0.98,
            time_constant: 0.15,
            dead_time,
            supply: 6e5,
            ..RegulatorParameters::default()
        }
    }

    #[test]
    fn the_prediction_is_what_the_regulator_then_does() {
        for (dead_time, period) in [
            (0.02, 1e-3),
            (0.02, 4e-3),
            (0.0215, 4e-3),
            (0.0, 1e-3),
            (3e-3, 4e-3),
        ] {
            let parameters = parameters(dead_time);
            let mut model = RegulatorModel::new(parameters, period);
            let mut state = RegulatorState::at_rest(&parameters, 1e5);
            for i in 0..40 {
                model.observe(state.outlet);
                let predicted = model.through_dead_time(state.outlet, |_, _| ());
                let set_pressure = if i % 7 < 3 {
                    4e5
                } else {
                    0.5e5 * f64::from(i % 5)
                };
                let set = model.send(set_pressure, state.outlet);
                // What is sent now must not matter until the dead time is over.
                let mut ahead = state.clone();
                ahead.command(&parameters, set);
                let truth = ahead.advance(&parameters, dead_time);
                assert!(
                    (predicted - truth).abs() < 1e-6,
                    "{dead_time} {period}: {predicted} {truth}"
                );
                state.command(&parameters, set);
                state.advance(&parameters, period);
            }
        }
    }

    #[test]
    fn the_pieces_fill_the_dead_time() {
        let mut model = RegulatorModel::new(parameters(0.0215), 4e-3);
        let mut sum = 0.0;
        model.observe(1e5);
        model.through_dead_time(1e5, |duration, _| sum += duration);
        assert!((sum - 0.0215).abs() < 1e-15);
    }

    #[test]
    fn the_lead_makes_the_lag_as_quick_as_asked() {
        let parameters = parameters(0.0);
        let (mut state, mut model) = (
            RegulatorState::at_rest(&parameters, 1e5),
            RegulatorModel::new(parameters, 1e-3),
        );
        let start = state.outlet;
        for _ in 0..10 {
            model.observe(state.outlet);
            let wanted = model.lead(state.outlet, 1.1e5, 0.0, 0.01);
            let set = model.send(wanted, state.outlet);
            state.command(&parameters, set);
            state.advance(&parameters, 1e-3);
        }
        let expected = 1.1e5 + (start - 1.1e5) * (-1.0f64).exp();
        assert!((state.outlet / expected - 1.0).abs() < 1e-12);
    }

    #[test]
    fn a_gain_that_is_off_leaves_no_lasting_error() {
        let model_parameters = parameters(0.02);
        let truth = RegulatorParameters {
            gain: 0.9,
            ..model_parameters
        };
        let mut state = RegulatorState::at_rest(&truth, 1e5);
        let mut model = RegulatorModel::new(model_parameters, 1e-3);
        for _ in 0..6000 {
            model.observe(state.outlet);
            let ahead = model.through_dead_time(state.outlet, |_, _| ());
            let set = model.send(model.lead(ahead, 2e5, 0.0, 0.01), state.outlet);
            state.command(&truth, set);
            state.advance(&truth, 1e-3);
        }
        assert!((state.outlet - 2e5).abs() < 1.0, "{}", state.outlet);
    }
}
