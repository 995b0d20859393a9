//! The chambers as a controller knows them, for there is no sensor in them: fed with the measured outlet and stroke.
//!
//! ```text
//! V_i dp_i/dt = R T m_dot_i - p_i dV_i/dt                                            (source paper, eq. 6)
//! p' = (p + h (R T / V) g s) / (1 + h (R T / V) g + h dV/dt / V),   g = m_dot(s, p) / (s - p)
//! ```
//!
//! s the pressure beside the chamber [Pa absolute], g the orifice's conductance at the start of a step h [kg/(s Pa)]. Linear in p', so it neither
//! overshoots nor needs small steps; the chamber forgets a wrong start within some milliseconds, for it is open to s.
//! Leaves out: the gas's own temperature, the line's volume.

use crate::device::DeviceParameters;
use crate::physics::chamber::Chamber;
use crate::physics::gas::Gas;
use crate::physics::hose::Hose;
use crate::physics::orifice::FlowFunction;
use crate::physics::piston::PistonAreas;
use crate::physics::valve::ValveParameters;

/// Longest step of the model [s].
const LONGEST_STEP: f64 = 1e-3;
/// Relative pressure difference over which a slope is taken [1]: within the laminar range.
const SLOPE_STEP: f64 = 2e-4;

/// The model with its state.
#[derive(Debug, Clone)]
pub(super) struct ChamberModel {
    gas: Gas,
    /// Absolute pressure behind chamber 2 [Pa].
    behind: f64,
    flow: FlowFunction,
    chambers: [Chamber; 2],
    areas: PistonAreas,
    valve: ValveParameters,
    line: Option<Hose>,
    supply: f64,
    /// Absolute pressures of chambers 1 and 2 [Pa].
    pub pressures: [f64; 2],
}

impl ChamberModel {
    /// Chambers of a device at the atmosphere.
    pub(super) fn new(device: &DeviceParameters) -> Self {
        Self {
            flow: FlowFunction::new(&device.gas),
            chambers: device.chambers(),
            areas: device.areas(),
            valve: device.valve(),
            line: device.hose,
            supply: device.regulator.supply,
            pressures: [device.gas.atmosphere; 2],
            gas: device.gas,
            behind: device.gas.atmosphere + device.opposing_pressure,
        }
    }

    /// Chamber 1 at an outlet pressure [Pa gauge], chamber 2 at the pressure behind it.
    pub(super) fn settle(&mut self, outlet: f64) {
        self.pressures = [self.gas.atmosphere + outlet, self.behind];
    }

    /// Force of the gas along extension [N].
    pub(super) fn gas_force(&self) -> f64 {
        self.areas
            .gas_force(self.pressures[0], self.pressures[1], self.gas.atmosphere)
    }

    /// Pressure of chamber 1 [Pa absolute] that gives a force of the gas [N] with chamber 2 as it is, between atmosphere and supply.
    pub(super) fn pressure_for(&self, gas_force: f64) -> f64 {
        let atmosphere = self.gas.atmosphere;
        let held = self.pressures[1] * self.areas.retracting + atmosphere * self.areas.rod();
        ((gas_force + held) / self.areas.extending).clamp(atmosphere, atmosphere + self.supply)
    }

    /// Advances by a time [s] at an outlet pressure [Pa gauge], stroke [m] and speed [m/s].
    pub(super) fn advance(&mut self, outlet: f64, stroke: f64, speed: f64, duration: f64) {
        let count = (duration / LONGEST_STEP - 1e-9).ceil().max(1.0);
        let h = duration / count;
        let (supply, exhaust) = (
            self.valve.supply_conductance,
            self.valve.exhaust_conductance,
        );
        for _ in 0..count as usize {
            let before = self.before_valve(outlet);
            self.pressures = [
                self.stepped(0, supply, before, stroke, speed, h),
                self.stepped(1, exhaust, self.behind, stroke, speed, h),
            ];
        }
    }

    /// Absolute pressure before the valve [Pa]: the outlet's less what the line takes at the present flow.
    fn before_valve(&self, outlet: f64) -> f64 {
        let outlet = self.gas.atmosphere + outlet;
        let Some(line) = &self.line else {
            return outlet;
        };
        let (area, chamber) = (self.valve.supply_conductance, self.pressures[0]);
        line.balance(outlet, chamber, (0.0, outlet), |before| {
            self.flow.flow_slope(area, before, chamber)
        })
    }

    /// Pressure of a chamber after a step [Pa], with another pressure beside it.
    fn stepped(
        &self,
        chamber: usize,
        conductance: f64,
        beside: f64,
        stroke: f64,
        speed: f64,
        h: f64,
    ) -> f64 {
        let pressure = self.pressures[chamber];
        let volume = self.chambers[chamber].volume(stroke);
        let growth = self.growth(chamber, speed);
        let rate = self.rt() / volume * self.conductance(conductance, beside, pressure);
        // A stroke that is measured to jump must not turn the pressure's sign.
        let emptied = (h * growth / volume).max(-0.5);
        (pressure + h * rate * beside) / (1.0 + h * rate + emptied)
    }

    /// Flow over pressure difference [kg/(s Pa)]; at equality the laminar one.
    fn conductance(&self, area: f64, beside: f64, pressure: f64) -> f64 {
        let difference = beside - pressure;
        if difference.abs() < SLOPE_STEP * pressure {
            let step = SLOPE_STEP * pressure;
            return self.flow.mass_flow(area, pressure + step, pressure) / step;
        }
        self.flow.mass_flow(area, beside, pressure) / difference
    }

    fn growth(&self, chamber: usize, speed: f64) -> f64 {
        match chamber {
            0 => self.areas.extending * speed,
            _ => -self.areas.retracting * speed,
        }
    }

    fn rt(&self) -> f64 {
        self.gas.specific_gas_constant * self.gas.temperature
    }

    /// R T / V of chamber 1 [Pa/kg] at a stroke [m].
    pub(super) fn pressure_per_mass(&self, stroke: f64) -> f64 {
        self.rt() / self.chambers[0].volume(stroke)
    }

    /// dV/dt / V of chamber 1 [1/s] at a stroke [m] and speed [m/s].
    pub(super) fn growth_rate(&self, stroke: f64, speed: f64) -> f64 {
        self.growth(0, speed) / self.chambers[0].volume(stroke)
    }

    /// Mass flow into chamber 1 [kg/s] at an outlet pressure [Pa gauge].
    pub(super) fn inflow(&self, outlet: f64) -> f64 {
        self.flow.mass_flow(
            self.valve.supply_conductance,
            self.before_valve(outlet),
            self.pressures[0],
        )
    }

    /// Slopes of the inflow to chamber 1 over outlet and chamber pressure [kg/(s Pa)], by central differences.
    pub(super) fn inflow_slopes(&self, outlet: f64) -> [f64; 2] {
        let (outlet, pressure) = (self.gas.atmosphere + outlet, self.pressures[0]);
        let flow =
            |from: f64, to: f64| self.flow.mass_flow(self.valve.supply_conductance, from, to);
        let step = 0.5 * SLOPE_STEP * pressure;
        [
            (flow(outlet + step, pressure) - flow(outlet - step, pressure)) / (2.0 * step),
            (flow(outlet, pressure + step) - flow(outlet, pressure - step)) / (2.0 * step),
        ]
    }

    /// Outlet pressure [Pa gauge], between atmosphere and supply, that makes chamber 1 change at a rate [Pa/s] at a stroke [m] and speed [m/s].
    pub(super) fn outlet_for(&self, rate: f64, stroke: f64, speed: f64) -> f64 {
        let pressure = self.pressures[0];
        let needed =
            (rate + pressure * self.growth_rate(stroke, speed)) / self.pressure_per_mass(stroke);
        let flow = |before: f64| {
            self.flow
                .mass_flow(self.valve.supply_conductance, before, pressure)
                - needed
        };
        let (mut low, mut high) = (self.gas.atmosphere, self.gas.atmosphere + self.supply);
        if flow(low) > 0.0 {
            return 0.0;
        }
        if flow(high) < 0.0 {
            return self.supply;
        }
        // The flow grows with the pressure before the valve: halving cannot fail. 30 halvings of 6 bar leave a milli-pascal.
        for _ in 0..30 {
            let middle = 0.5 * (low + high);
            if flow(middle) < 0.0 {
                low = middle;
            } else {
                high = middle;
            }
        }
        let before = 0.5 * (low + high);
        let outlet = self
            .line
            .map_or(before, |line| line.pressure_before(needed, before));
        (outlet - self.gas.atmosphere).clamp(0.0, self.supply)
    }

    /// Allowed offsets of the outlet [Pa], below and above, from the pressure that will hold chamber 1 at `goal` [Pa absolute], for it to be back there by
    /// the time that the chamber arrives.
    ///
    /// A regulator of time constant tau comes down no faster than p/tau and up no faster than (p_s - p)/tau. While an excess D runs off at the rate r,
    /// the chamber gains (R T / V) A C sqrt(2 rho) (2/3) D^(3/2) / r, which is not to be more than its error e:
    ///
    /// ```text
    /// D = (3/2 e r V / (R T A C sqrt(2 rho)))^(2/3)
    /// ```
    ///
    /// with the flow of an incompressible gas at the drop D, r as at `goal`: right to a tenth of e.
    pub(super) fn returnable(&self, goal: f64, stroke: f64, time_constant: f64) -> [f64; 2] {
        let error = goal - self.pressures[0];
        let gauge = goal - self.gas.atmosphere;
        let density = goal / self.rt();
        let filling =
            self.pressure_per_mass(stroke) * self.valve.supply_conductance * (2.0 * density).sqrt();
        let excess = |error: f64, rate: f64| {
            (1.5 * error.max(0.0) * rate.max(0.0) / (time_constant * filling)).powf(2.0 / 3.0)
        };
        [excess(-error, self.supply - gauge), excess(error, gauge)]
    }

    /// Outlet pressure [Pa gauge] that will hold chamber 1 at `goal` [Pa absolute], changing at a rate [Pa/s]: the drop over the valve is as now.
    pub(super) fn holding_outlet(&self, goal: f64, rate: f64, stroke: f64, speed: f64) -> f64 {
        self.outlet_for(rate, stroke, speed) + goal - self.pressures[0]
    }
}

#[cfg(test)]
mod tests;
