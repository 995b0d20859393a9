//! The coupled pneumatics advanced over one rigid-body step in sub-steps.
//!
//! State: regulator outlet and the air mass of each chamber. Each sub-step is a classical Runge-Kutta step of order four on the masses, with the
//! regulator's lag solved exactly at its nodes and the piston's motion as given:
//!
//!     dm_i/dt = m_dot_i(p_outlet(t), p_i),   p_i = m_i R T / V_i(x(t)),   x(t) = x_0 + v_0 t          (source paper, eqs. 1 to 11)
//!
//! The force handed back is the mean over the step (the impulse is what the rigid body feels), by Simpson's rule on the sub-steps.

use super::DeviceParameters;
use crate::physics::chamber::Chamber;
use crate::physics::orifice::FlowFunction;
use crate::physics::piston::PistonAreas;
use crate::physics::regulator::RegulatorState;
use crate::physics::valve::{ValveParameters, ValvePosition, chamber_flows};

/// Motion of the piston over a step, as its owner foresees it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PistonMotion {
    /// Stroke at the start of the step [m].
    pub stroke: f64,
    /// Speed of extension, held over the step [m/s].
    pub speed: f64,
}

/// Force of the device on its moving part over a step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DeviceForce {
    /// Mean force along extension [N].
    pub force: f64,
    /// Damping within that force that a stiff integrator should treat implicitly [N s/m].
    pub damping: f64,
}

/// What changes in a device during a run.
#[derive(Debug, Clone, PartialEq)]
pub struct DeviceState {
    /// The regulator.
    pub regulator: RegulatorState,
    /// Air in chambers 1 and 2 [kg].
    pub masses: [f64; 2],
    /// Air that has come in since the start, from the regulator and from the atmosphere [kg].
    pub mass_entered: f64,
    /// Air that has gone out since the start [kg].
    pub mass_left: f64,
    /// Position of the solenoid valve.
    pub valve: ValvePosition,
}

/// A device: parameters with all that follows from them, and no state.
#[derive(Debug, Clone)]
pub struct Device {
    parameters: DeviceParameters,
    flow: FlowFunction,
    chambers: [Chamber; 2],
    areas: PistonAreas,
    valve: ValveParameters,
}

impl Device {
    /// Prepares a device.
    pub fn new(parameters: DeviceParameters) -> Self {
        Self {
            flow: FlowFunction::new(&parameters.gas),
            chambers: parameters.chambers(),
            areas: parameters.areas(),
            valve: parameters.valve(),
            parameters,
        }
    }

    /// The parameters.
    pub fn parameters(&self) -> &DeviceParameters {
        &self.parameters
    }

    /// State at rest at a stroke [m], chamber 1 at the regulated pressure [Pa gauge] and chamber 2 at the atmosphere.
    pub fn at_rest(&self, stroke: f64, set_pressure: f64) -> DeviceState {
        let gas = &self.parameters.gas;
        let regulator = RegulatorState::at_rest(&self.parameters.regulator, set_pressure);
        let pressures = [gas.atmosphere + regulator.outlet, gas.atmosphere];
        DeviceState {
            masses: [0, 1].map(|i| gas.mass(pressures[i], self.chambers[i].volume(stroke))),
            regulator,
            mass_entered: 0.0,
            mass_left: 0.0,
            valve: ValvePosition::Extend,
        }
    }

    /// Absolute pressures of chambers 1 and 2 [Pa] at a stroke [m].
    pub fn pressures(&self, state: &DeviceState, stroke: f64) -> [f64; 2] {
        self.pressures_of(state.masses, stroke)
    }

    /// Force of the gas on the piston along extension [N] at a stroke [m].
    pub fn gas_force(&self, state: &DeviceState, stroke: f64) -> f64 {
        self.force_of(self.pressures(state, stroke))
    }

    fn pressures_of(&self, masses: [f64; 2], stroke: f64) -> [f64; 2] {
        [0, 1].map(|i| self.chambers[i].pressure(&self.parameters.gas, masses[i], stroke))
    }

    fn force_of(&self, pressures: [f64; 2]) -> f64 {
        self.areas
            .gas_force(pressures[0], pressures[1], self.parameters.gas.atmosphere)
    }

    /// Advances by `dt` [s] in `substeps` while the piston moves as told, and returns the mean force on the moving part.
    ///
    /// `set_pressure` [Pa gauge] is commanded at the start of the step and held.
    pub fn advance(
        &self,
        state: &mut DeviceState,
        set_pressure: f64,
        motion: PistonMotion,
        dt: f64,
        substeps: usize,
    ) -> DeviceForce {
        state
            .regulator
            .command(&self.parameters.regulator, set_pressure);
        let h = dt / substeps as f64;
        let mut impulse = 0.0;
        for i in 0..substeps {
            let stroke = motion.stroke + motion.speed * h * i as f64;
            impulse += self.substep(state, stroke, motion.speed, h);
        }
        let (stop, damping) = self.parameters.end_stop.force(
            self.parameters.full_stroke,
            motion.stroke,
            motion.speed,
        );
        DeviceForce {
            force: impulse / dt + stop,
            damping,
        }
    }

    /// One Runge-Kutta step; returns the impulse of the gas [N s].
    fn substep(&self, state: &mut DeviceState, stroke: f64, speed: f64, h: f64) -> f64 {
        let gas = &self.parameters.gas;
        let start = state.masses;
        let outlet_start = state.regulator.outlet;
        let outlet_middle = state.regulator.advance(&self.parameters.regulator, 0.5 * h);
        let outlet_end = state.regulator.advance(&self.parameters.regulator, 0.5 * h);
        let (middle, end) = (stroke + 0.5 * h * speed, stroke + h * speed);
        let flows = |outlet: f64, masses: [f64; 2], stroke: f64| {
            chamber_flows(
                &self.valve,
                &self.flow,
                state.valve,
                gas.atmosphere + outlet,
                gas.atmosphere,
                self.pressures_of(masses, stroke),
            )
        };
        let at = |rate: [f64; 2], t: f64| [start[0] + t * rate[0], start[1] + t * rate[1]];
        let k1 = flows(outlet_start, start, stroke);
        let k2 = flows(outlet_middle, at(k1, 0.5 * h), middle);
        let masses_middle = at(k2, 0.5 * h);
        let k3 = flows(outlet_middle, masses_middle, middle);
        let k4 = flows(outlet_end, at(k3, h), end);
        for i in 0..2 {
            for (flow, weight) in [(k1[i], 1.0), (k2[i], 2.0), (k3[i], 2.0), (k4[i], 1.0)] {
                let moved = weight * h / 6.0 * flow;
                state.masses[i] += moved;
                if moved > 0.0 {
                    state.mass_entered += moved;
                } else {
                    state.mass_left -= moved;
                }
            }
        }
        let forces = [
            self.force_of(self.pressures_of(start, stroke)),
            self.force_of(self.pressures_of(masses_middle, middle)),
            self.force_of(self.pressures_of(state.masses, end)),
        ];
        h / 6.0 * (forces[0] + 4.0 * forces[1] + forces[2])
    }
}

#[cfg(test)]
mod tests;
