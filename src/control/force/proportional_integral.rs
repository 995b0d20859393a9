//! PI on the load cell around the pressure map.
//!
//! ```text
//! p_set = (F_d - m g_a + k_p e + I) / (K A_1),   e = F_m - F,   dI/dt = k_i e + (p_lim - p_set) K A_1 / T_t
//! ```
//!
//! F_d desired and F measured force [N], m g_a weight along the axis [N], p_lim the set pressure within the regulator's limits [Pa gauge],
//! T_t = k_p / k_i the tracking time of the anti-windup by back-calculation [s]; F_m the force that the map alone is going to give, through the
//! regulator's lag and dead time [N]: so the feedback answers disturbances and leaves the desired force's steps to the map.
//! Astrom and Hagglund, Advanced PID Control (2006), sections 3.5 (windup) and 5.4 (feed-forward); gains by Skogestad's rule (2003).
//! Without contact the integral is empty and the map acts alone.

use super::{ForceObservation, ProportionalIntegralParameters, contact_gate};
use crate::device::{DeviceParameters, PressureMap};
use crate::physics::regulator::{RegulatorParameters, RegulatorState};

/// The controller with its state.
#[derive(Debug, Clone)]
pub struct ProportionalIntegral {
    gains: ProportionalIntegralParameters,
    map: PressureMap,
    regulator: RegulatorParameters,
    /// Outlet pressure by the map alone.
    expected: Option<RegulatorState>,
    /// Force of one pascal of set pressure [N/Pa].
    force_per_pressure: f64,
    /// I [N].
    integral: f64,
    period: f64,
}

impl ProportionalIntegral {
    pub(super) fn new(
        gains: &ProportionalIntegralParameters,
        device: &DeviceParameters,
        period: f64,
    ) -> Self {
        Self {
            gains: *gains,
            map: PressureMap::new(device),
            regulator: device.regulator,
            expected: None,
            force_per_pressure: device.regulator.gain * device.areas().extending,
            integral: 0.0,
            period,
        }
    }

    pub(super) fn set_pressure(&mut self, observation: &ForceObservation) -> f64 {
        let desired = observation.desired_axial_force;
        let gravity = observation.gravity_along_axis;
        let open_loop = self.map.set_pressure(desired, gravity);
        let expected = self.expected.get_or_insert_with(|| {
            let given = observation.regulator_pressure / self.regulator.gain;
            RegulatorState::at_rest(&self.regulator, given)
        });
        let expected_force = self
            .map
            .force(expected.outlet / self.regulator.gain, gravity);
        expected.command(&self.regulator, open_loop);
        expected.advance(&self.regulator, self.period);
        if !contact_gate::presses(observation.measured_axial_force, desired) {
            self.integral = 0.0;
            return open_loop;
        }
        let error = expected_force - observation.measured_axial_force;
        self.integral += self.gains.integral_gain * error * self.period;
        let correction = self.gains.proportional_gain * error + self.integral;
        let wanted = self.map.unlimited(desired + correction, gravity);
        let limited = wanted.clamp(0.0, self.regulator.supply);
        self.track(limited - wanted);
        limited
    }

    /// Back-calculation: takes out of the integral what the limits cut off [Pa].
    fn track(&mut self, cut: f64) {
        let gains = &self.gains;
        let share = if gains.proportional_gain > 0.0 {
            (self.period * gains.integral_gain / gains.proportional_gain).min(1.0)
        } else {
            1.0
        };
        self.integral += share * cut * self.force_per_pressure;
    }
}
