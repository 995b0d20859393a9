//! Disturbances of the force are estimated, predicted over the dead time, and cancelled through the inverted regulator and chamber.
//!
//! ```text
//! F = F_gas(p_1, p_2) - k f(z) - b v + m g_a - m a + o                       p_1, p_2 and f from models, o and k estimated
//! F_gas,d(t+h) = F_d + k f(z(t+h)) + b v(t+h) - m g_a + m a - o              the force of the gas that is wanted after the dead time
//! dp_1,d/dt = (p_1,d(t+h) - p_1(t+h)) / T_r + slope of F_gas,d / A_1         p_d, the outlet for it, by the orifice law inverted (eqs. 6 and 9)
//! p_set = p_d through the inverted lag of the regulator, from its outlet at t + h                 (`regulator_model`)
//! ```
//!
//! F contact force [N], f nominal dry friction [N], k its true share [1], b viscous coefficient [N s/m], z bristle deflection [m], v and a speed and
//! acceleration, o whatever is left [N], h the dead time and half a period [s], T_r the response time [s].
//!
//! - The dead time: the model runs ahead by it, so the loop does not contain it while the model holds; the load cell's disagreement with the model
//!   is the disturbance, filtered and fed back. Zhong and Normey-Rico 2002 (disturbance-observer-based dead-time compensator); Normey-Rico and
//!   Camacho 2007, filtered Smith predictor.
//! - The friction: the seals' deflection is a function of the path (Dahl 1968), and over 20 ms the path follows from speed and acceleration, so a reversal
//!   is cancelled when it comes, not a dead time later: this is where it may beat the bound of `limit`. The friction's level is learnt at reversals
//!   (Canudas de Wit and Lischinsky 1997, adaptive friction compensation): `disturbance_level`.
//! - The path is that of the surface, the stroke less what the contact gives way: the piston's own would answer the force, and compensating friction
//!   for the motion that the compensation makes is a loop of its own, unstable before the seals slide.
//!
//! It knows areas, volumes, orifices, moving mass, the regulator's constants, the nominal seals and the contact's stiffness; not the surface's motion.

use super::chamber_model::ChamberModel;
use super::disturbance_level::DisturbanceLevel;
use super::followed::Followed;
use super::motion_tracker::MotionTracker;
use super::seal_model::SealModel;
use super::{DisturbancePredictionParameters, ForceObservation, contact_gate};
use crate::device::DeviceParameters;
use crate::physics::push_only::PushOnly;

/// Time over which the friction's level may drift by the load cell's noise [s].
const FRICTION_TIME: f64 = 1.0;
/// Time after touch from which friction is learnt: an impact's ringing would be taken for it [s].
const TOUCH_TIME: f64 = 0.5;

/// The controller with its state.
#[derive(Debug, Clone)]
pub struct DisturbancePrediction {
    parameters: DisturbancePredictionParameters,
    followed: Followed,
    /// The surface's motion, which the force does not change.
    surface: MotionTracker,
    pressed: bool,
    /// Time since the tool touched [s].
    pressed_for: f64,
    seals: SealModel,
    level: DisturbanceLevel,
    moving_mass: f64,
    contact_stiffness: f64,
    area: f64,
    time_constant: f64,
    period: f64,
}

impl DisturbancePrediction {
    pub(super) fn new(
        parameters: &DisturbancePredictionParameters,
        device: &DeviceParameters,
        contact: PushOnly,
        period: f64,
    ) -> Self {
        let nominal = parameters.seals;
        Self {
            parameters: *parameters,
            followed: Followed::new(device, parameters.tracking_frequency, period),
            surface: MotionTracker::new(parameters.tracking_frequency, period),
            pressed: false,
            pressed_for: 0.0,
            seals: SealModel::new(nominal),
            level: DisturbanceLevel::new(
                [parameters.observer_time, FRICTION_TIME],
                parameters.friction_uncertainty,
                nominal.coulomb,
                period,
            ),
            moving_mass: device.moving_mass,
            contact_stiffness: contact.stiffness,
            area: device.areas().extending,
            time_constant: device.regulator.time_constant,
            period,
        }
    }

    pub(super) fn set_pressure(&mut self, observation: &ForceObservation) -> f64 {
        let presses = contact_gate::presses(
            observation.measured_axial_force,
            observation.desired_axial_force,
        );
        self.followed.follow(observation);
        self.follow_surface(observation, presses);
        self.estimate(observation, presses);
        let speed = self.surface.speed;
        let ahead = self.followed.ahead(observation, speed);
        let response = self.parameters.response_time;
        let horizon = ahead.time + 0.5 * self.period;
        let now = self.wanted_gas_force(observation, horizon);
        let soon = self.wanted_gas_force(observation, horizon + response);
        let slope = (soon - now) / (response * self.area);
        let then = Predicted {
            stroke: ahead.stroke,
            speed: speed + self.surface.acceleration * horizon,
        };
        let chambers = &ahead.chambers;
        let goal = self.outlet_goal(chambers, chambers.pressure_for(now), slope, then);
        let regulator = &mut self.followed.regulator;
        let set_pressure = regulator.lead(ahead.outlet, goal, slope, response);
        regulator.send(set_pressure, observation.regulator_pressure)
    }

    /// Outlet pressure [Pa gauge] for chamber 1 to go to `goal` [Pa absolute], which itself changes at `slope` [Pa/s].
    fn outlet_goal(&self, chambers: &ChamberModel, goal: f64, slope: f64, then: Predicted) -> f64 {
        let error = goal - chambers.pressures[0];
        let approach = slope + error / self.parameters.response_time;
        let hold = chambers.holding_outlet(goal, slope, then.stroke, then.speed);
        let reach = chambers.outlet_for(approach, then.stroke, then.speed);
        let [below, above] = chambers.returnable(goal, then.stroke, self.time_constant);
        // A chamber that is quick by itself needs no more than what will hold it.
        if error > 0.0 {
            reach.clamp(hold, hold + above)
        } else {
            reach.clamp(hold - below, hold)
        }
    }

    /// Follows the surface: the stroke less what the contact gives way.
    fn follow_surface(&mut self, observation: &ForceObservation, presses: bool) {
        if presses != self.pressed {
            self.surface.restart();
            self.pressed = presses;
        }
        let given = if presses {
            observation.measured_axial_force / self.contact_stiffness
        } else {
            0.0
        };
        let moved = self.surface.update(observation.stroke - given, 0.0);
        self.seals.moved(moved, self.surface.speed);
    }

    /// Compares the load cell with the model.
    fn estimate(&mut self, observation: &ForceObservation, presses: bool) {
        if !presses {
            self.level.forget_offset();
            self.pressed_for = 0.0;
            return;
        }
        self.pressed_for += self.period;
        let weight =
            self.moving_mass * (observation.gravity_along_axis - self.followed.motion.acceleration);
        let explained = self.followed.chambers.gas_force() + weight
            - self.seals.viscous(self.followed.motion.speed);
        let unexplained = observation.measured_axial_force - explained;
        if self.pressed_for > TOUCH_TIME {
            self.level.update(unexplained, self.seals.dry());
        } else {
            self.level.follow(unexplained, self.seals.dry());
        }
    }

    /// Force of the gas [N] that gives the desired force after a time [s].
    fn wanted_gas_force(&self, observation: &ForceObservation, time: f64) -> f64 {
        let (speed, acceleration) = (self.surface.speed, self.surface.acceleration);
        let weight = self.moving_mass * (observation.gravity_along_axis - acceleration);
        let friction = self.level.share * self.seals.dry_ahead(speed, acceleration, time)
            + self.seals.viscous(speed + acceleration * time);
        observation.desired_axial_force - weight + friction - self.level.offset
    }
}

/// Motion of the piston after the dead time.
#[derive(Debug, Clone, Copy)]
struct Predicted {
    stroke: f64,
    speed: f64,
}
