//! Feedback linearisation of chamber 1 with the regulator's set pressure as input, with a bounded input gain.
//!
//! ```text
//! dy/dt = (R T / V) m_dot(p, y) - y dV/dt / V,   dp/dt = (K u - p) / tau                                 y = p_1, u set pressure, p outlet
//! u = (p + tau w) / K,   w = [(V / R T)(v + 2 (A v_x / V) dy/dt + y A a / V) - m_y dy/dt] / m_p,   v = r^2 (y_d - y) - 2 r dy/dt
//! ```
//!
//! m_p and m_y slopes of the flow over outlet and chamber pressure [kg/(s Pa)], v_x and a speed and acceleration of the piston, r the wanted
//! rate [1/s]; y_d the pressure that gives the desired force plus an integral of the load cell's error (eq. 6, 8 and 9 of the source paper inverted).
//!
//! Where it is singular: m_p is infinite where the pressures are equal (eq. 10 has infinite slope; zero flow, every state of rest), and there u no longer
//! depends on the error: w tends to dy/dt, infinity over infinity. And m_p is zero where the chamber exhausts choked (p < 0.528 y): then no u changes
//! the flow. Bigras, Khayati and Wong (2002) meet the same with a port restriction and keep the law regular by modifying its input gain.
//! Here both slopes are held within g/20 <= |.| <= g,  g = 2 r V / (R T), the conductance with which the chamber is as quick as wanted. A chamber
//! that is quicker than that needs no inversion: at the upper bound the law becomes u = (p + tau r/2 (y_d - y)) / K, a first-order lag of 2/r.
//! The law acts on the state after the dead time, predicted by the model; the integral takes the load cell's error against the force that the model
//! foresaw a dead time ago, so that it answers disturbances and not the chamber's filling. What the bounds cannot do (choked exhaust) the regulator's limits cut off.

use std::collections::VecDeque;

use super::chamber_model::ChamberModel;
use super::followed::{Ahead, Followed};
use super::{FeedbackLinearisationParameters, ForceObservation, contact_gate};
use crate::device::DeviceParameters;

/// Smallest input gain over the largest [1].
const SMALLEST_GAIN: f64 = 0.05;
/// Poles of the motion's filter over the wanted rate [1].
const TRACKING: f64 = 0.3;

/// The controller with its state.
#[derive(Debug, Clone)]
pub struct FeedbackLinearisation {
    gains: FeedbackLinearisationParameters,
    followed: Followed,
    law: Law,
    moving_mass: f64,
    area: f64,
    largest_force: f64,
    /// Periods of the dead time.
    delay: usize,
    period: f64,
    /// Forces foreseen during the dead time without the integral's part [N], oldest first.
    foreseen: VecDeque<f64>,
    integral: f64,
}

impl FeedbackLinearisation {
    pub(super) fn new(
        gains: &FeedbackLinearisationParameters,
        device: &DeviceParameters,
        period: f64,
    ) -> Self {
        Self {
            gains: *gains,
            followed: Followed::new(device, TRACKING * gains.rate, period),
            law: Law::new(gains.rate, device.regulator.time_constant, period),
            area: device.areas().extending,
            largest_force: device.areas().extending * device.regulator.supply,
            moving_mass: device.moving_mass,
            delay: (device.regulator.dead_time / period).round() as usize,
            period,
            foreseen: VecDeque::new(),
            integral: 0.0,
        }
    }

    pub(super) fn set_pressure(&mut self, observation: &ForceObservation) -> f64 {
        self.followed.follow(observation);
        let desired = observation.desired_axial_force;
        let speed = self.followed.motion.speed;
        let Ahead {
            chambers: ahead,
            outlet,
            stroke,
            ..
        } = self.followed.ahead(observation, speed);
        let wanted = desired + self.integral - self.moving_mass * observation.gravity_along_axis;
        let motion = PistonState {
            stroke,
            speed,
            acceleration: self.followed.motion.acceleration,
        };
        let goal = ahead.pressure_for(wanted);
        let change = self.law.outlet_change(&ahead, outlet, goal, motion);
        let regulator = &mut self.followed.regulator;
        let set_pressure = regulator.set_for_change(outlet, change);
        let missing = self.area * (goal - ahead.pressures[0]);
        self.integrate(observation, desired - missing);
        let regulator = &mut self.followed.regulator;
        regulator.send(set_pressure, observation.regulator_pressure)
    }

    /// Integrates the load cell's error against the force that was foreseen [N]; takes what is foreseen now for the dead time's end.
    fn integrate(&mut self, observation: &ForceObservation, foreseen: f64) {
        self.foreseen.push_back(foreseen);
        if self.foreseen.len() > self.delay + 1 {
            self.foreseen.pop_front();
        }
        let expected = self.foreseen.front().copied().unwrap_or(foreseen);
        let measured = observation.measured_axial_force;
        if !contact_gate::presses(measured, observation.desired_axial_force) {
            self.integral = 0.0;
            return;
        }
        self.integral += self.gains.integral_gain * (expected - measured) * self.period;
        self.integral = self.integral.clamp(-self.largest_force, self.largest_force);
    }
}

/// Motion of the piston after the dead time.
#[derive(Debug, Clone, Copy)]
struct PistonState {
    stroke: f64,
    speed: f64,
    acceleration: f64,
}

/// The law without its memory.
#[derive(Debug, Clone)]
struct Law {
    rate: f64,
    /// Time constant of the regulator [s].
    lag: f64,
    /// Time that a rate is held, so that a first-order law at half the wanted rate is met exactly [s].
    hold: f64,
}

impl Law {
    fn new(rate: f64, lag: f64, period: f64) -> Self {
        Self {
            rate,
            lag,
            hold: -(-0.5 * rate * period).exp_m1() / (0.5 * rate),
        }
    }

    /// Change of the outlet over the period [Pa], tau dp/dt = w of the law, from the chambers' state, an outlet pressure [Pa gauge] and a goal for
    /// chamber 1 [Pa absolute].
    fn outlet_change(
        &self,
        chambers: &ChamberModel,
        outlet: f64,
        goal: f64,
        motion: PistonState,
    ) -> f64 {
        let per_mass = chambers.pressure_per_mass(motion.stroke);
        let growth = chambers.growth_rate(motion.stroke, motion.speed);
        let pressure = chambers.pressures[0];
        let pressure_rate = per_mass * chambers.inflow(outlet) - pressure * growth;
        let growth_change = chambers.growth_rate(motion.stroke, motion.acceleration) * pressure;
        let wanted = self.rate * (self.rate * (goal - pressure) - 2.0 * pressure_rate);
        let [outlet_slope, pressure_slope] = self.bounded_slopes(chambers, outlet, per_mass);
        let outlet_rate = ((wanted + 2.0 * growth * pressure_rate + growth_change) / per_mass
            - pressure_slope * pressure_rate)
            / outlet_slope;
        let hold = chambers.holding_outlet(goal, 0.0, motion.stroke, motion.speed);
        let [below, above] = chambers.returnable(goal, motion.stroke, self.lag);
        let back = |bound: f64| 0.5 * self.rate * (bound - outlet);
        self.hold * outlet_rate.clamp(back(hold - below), back(hold + above))
    }

    /// m_p and m_y within their bounds [kg/(s Pa)]: finite, and the input gain never zero.
    fn bounded_slopes(&self, chambers: &ChamberModel, outlet: f64, per_mass: f64) -> [f64; 2] {
        let largest = 2.0 * self.rate / per_mass;
        let [outlet_slope, pressure_slope] = chambers.inflow_slopes(outlet);
        [
            outlet_slope.clamp(SMALLEST_GAIN * largest, largest),
            pressure_slope.clamp(-largest, 0.0),
        ]
    }
}

#[cfg(test)]
mod tests;
