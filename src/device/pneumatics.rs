//! The device's equations put together: flows between its parts and the force on its piston, at a state.

use std::borrow::Borrow;

use super::leaks::LeakFlows;
use super::load::{PistonMotion, Predicted};
use super::rates::PistonRates;
use super::state::{AirState, DeviceState, Disturbance, EnergyLedger};
use super::{DeviceParameters, Load};
use crate::physics::chamber::Chamber;
use crate::physics::gas_process::GasProcess;
use crate::physics::hose::Hose;
use crate::physics::line_chain::UPSTREAM;
use crate::physics::orifice::FlowFunction;
use crate::physics::piston::PistonAreas;
use crate::physics::regulator::RegulatorState;
use crate::physics::switching_delay::Spool;
use crate::physics::valve::{ValveParameters, ValvePosition};

/// Force of the device on its moving part over a step, for a solver that treats it implicitly:
///
/// ```text
/// F(x, v) = force - damping (v - v_predicted) - stiffness (x - x_predicted)          at the end of the step
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DeviceForce {
    /// Mean force along extension on the predicted motion [N].
    pub force: f64,
    /// Damping of stops, cushions and seals [N s/m].
    pub damping: f64,
    /// Stiffness of the seals before they slide, and of the axial load [N/m].
    pub stiffness: f64,
}

/// A device: parameters, its own or borrowed, with all that follows from them, and no state.
#[derive(Debug, Clone)]
pub struct Device<P = DeviceParameters> {
    parameters: P,
    pub(super) flow: FlowFunction,
    pub(super) chambers: [Chamber; 2],
    pub(super) areas: PistonAreas,
    pub(super) valve: ValveParameters,
    /// Rates of its piston's swing.
    pub(super) piston_rates: PistonRates,
    /// Rate at which a volume comes to the pressure beside it, times that volume [m3/s].
    chamber_rate_volume: f64,
    /// The same of a further opening, by its area [m/s].
    leak_rate: f64,
    /// Rate at which a reservoir without a line is drawn from or filled [1/s].
    reservoir_rate: f64,
}

/// Rates of the air and, if asked for, of its energy, with the chamber pressures [Pa absolute] that they belong to.
pub(super) struct AirRates {
    pub air: AirState,
    pub ledger: EnergyLedger,
    pub pressures: [f64; 2],
}

impl<P: Borrow<DeviceParameters>> Device<P> {
    /// Prepares a device.
    pub fn new(parameters: P) -> Self {
        let own: &DeviceParameters = parameters.borrow();
        let gas = &own.gas;
        let flow = FlowFunction::new(gas);
        let valve = own.valve();
        let rt = gas.specific_gas_constant * gas.temperature;
        let rate_volume = |conductance: f64| conductance * rt.sqrt() * flow.laminar_slope();
        let leakage = &own.leakage;
        // A leak between the chambers works on both.
        let leaks = own.discharge_coefficient * (2.0 * leakage.cross_piston + leakage.external);
        let port = valve.supply_conductance.max(valve.exhaust_conductance);
        Self {
            chambers: own.chambers(),
            areas: own.areas(),
            piston_rates: PistonRates::new(own),
            chamber_rate_volume: own.stiffest_exponent() * rate_volume(port + leaks),
            leak_rate: own.stiffest_exponent() * rate_volume(own.discharge_coefficient),
            reservoir_rate: match (&own.supply_reservoir, &own.hose) {
                (Some(reservoir), None) => {
                    reservoir.rate(gas) + rate_volume(valve.supply_conductance) / reservoir.volume
                }
                // With a line it is implicit.
                _ => 0.0,
            },
            flow,
            valve,
            parameters,
        }
    }

    /// The parameters.
    pub fn parameters(&self) -> &DeviceParameters {
        self.parameters.borrow()
    }

    /// State at rest at a stroke [m], chamber 1 at the regulated pressure [Pa gauge] and chamber 2 at the atmosphere or at the opposing pressure, a reservoir full.
    pub fn at_rest(&self, stroke: f64, set_pressure: f64) -> DeviceState {
        let gas = &self.parameters().gas;
        let mut regulator = RegulatorState::at_rest(&self.parameters().regulator, set_pressure);
        if let Some(reservoir) = &self.parameters().supply_reservoir {
            regulator.starve(reservoir.full_pressure - gas.atmosphere);
        }
        let behind = gas.atmosphere + self.parameters().opposing_pressure;
        let pressures = [gas.atmosphere + regulator.outlet, behind];
        let masses = [0, 1].map(|i| gas.mass(pressures[i], self.chambers[i].volume(stroke)));
        let hose = self.parameters().hose.as_ref();
        let segment = hose.map_or(0.0, |h| gas.mass(pressures[0], h.segment_volume()));
        let mut upstream = [0.0; UPSTREAM];
        upstream[..hose.map_or(0, |h| h.segments() - 1)].fill(segment);
        let air = AirState {
            masses,
            energies: masses.map(|mass| mass * gas.specific_heat_volume() * gas.temperature),
            hose_mass: hose.map_or(0.0, |h| gas.mass(pressures[0], h.last_volume())),
            upstream,
            reservoir_mass: self
                .parameters()
                .supply_reservoir
                .map_or(0.0, |reservoir| reservoir.full_mass(gas)),
            ..AirState::default()
        };
        DeviceState {
            air,
            regulator,
            valve: ValvePosition::Extend,
            spool: Spool::default(),
            seal_deflection: 0.0,
            seal_stroke: stroke,
            disturbance: Disturbance::default(),
            ledger: EnergyLedger::default(),
        }
    }

    /// Absolute pressures of chambers 1 and 2 [Pa] at a stroke [m].
    pub fn pressures(&self, state: &DeviceState, stroke: f64) -> [f64; 2] {
        self.pressures_of(&state.air, [0, 1].map(|i| self.chambers[i].volume(stroke)))
    }

    /// Temperatures of the air in chambers 1 and 2 [K].
    pub fn temperatures(&self, state: &DeviceState) -> [f64; 2] {
        [0, 1].map(|i| self.temperature_of(&state.air, i))
    }

    /// Force of the gas on the piston along extension [N] at a stroke [m].
    pub fn gas_force(&self, state: &DeviceState, stroke: f64) -> f64 {
        self.gas_force_of(self.pressures(state, stroke))
    }

    /// Force of the seals on the piston along extension [N].
    pub fn seal_force(&self, state: &DeviceState, speed: f64) -> f64 {
        -self
            .parameters()
            .seal_friction
            .force(state.seal_deflection, speed)
    }

    /// Force of the end stops along extension [N].
    pub fn stop_force(&self, motion: PistonMotion) -> f64 {
        match self.stop_at(motion) {
            0 => 0.0,
            stop => self.stop_force_of(stop, motion),
        }
    }

    /// Internal energy of the air in both chambers [J].
    pub fn internal_energy(&self, state: &DeviceState) -> f64 {
        let gas = &self.parameters().gas;
        match self.parameters().gas_process {
            GasProcess::Isothermal => {
                let mass = state.air.masses[0] + state.air.masses[1];
                mass * gas.specific_heat_volume() * gas.temperature
            }
            GasProcess::WallHeat { .. } => state.air.energies[0] + state.air.energies[1],
        }
    }

    /// Advances by `dt` [s] while the piston moves as predicted, and returns the force on the moving part. `set_pressure` [Pa gauge] is commanded at
    /// the start of the step and held. `substeps` is the least number of pneumatic sub-steps; stiff parts get more.
    pub fn advance(
        &self,
        state: &mut DeviceState,
        set_pressure: f64,
        motion: PistonMotion,
        dt: f64,
        substeps: usize,
    ) -> DeviceForce {
        self.drag_seals(state, motion);
        let mut moved = motion;
        let impulse = self
            .integrate::<_, true>(state, &mut moved, set_pressure, &Predicted, dt, substeps)
            .gas;
        let seals = self.seals_over(
            [(&state.air, motion.stroke + motion.speed * dt)],
            state.disturbance.friction,
        );
        let deflection =
            seals.deflection_after(state.seal_deflection, motion.speed * dt, motion.speed);
        let stop_damping = match self.stop_at(motion) {
            0 => 0.0,
            _ => self.parameters().end_stop.damping,
        };
        let cushion_damping = self.cushion_damping(self.cushion_at(motion), motion.stroke);
        let travel = motion.speed * dt;
        let (stop, cushion) = (self.stop_force(motion), self.cushion_force(motion));
        let axial = self.axial_force(motion.stroke + travel);
        let seal = seals.force(deflection, motion.speed);
        let besides_gas = stop + cushion + axial - seal;
        let ledger = &mut state.ledger;
        ledger.stop_work -= stop * travel;
        ledger.cushion_work -= cushion * travel;
        ledger.axial_work += axial * travel;
        ledger.seal_work += seal * travel;
        // Who holds the piston at its speed takes all that the device does to it.
        ledger.load_work -= impulse * motion.speed + besides_gas * travel;
        DeviceForce {
            force: impulse / dt + besides_gas,
            damping: stop_damping + cushion_damping + seals.viscous,
            stiffness: seals.tangent_stiffness(deflection, motion.speed)
                + self.parameters().axial_load.return_stiffness,
        }
    }

    /// Advances device and piston together by `dt` [s]: the piston, of the device's moving mass, moves under the device's force and its load's.
    /// `substeps` is the least number; stiff parts get more, and contacts, stops and reversals are met where they happen. Without the energy ledger it is a
    /// fifth faster; with it, returns the piston's impulse on its contact along extension [N s].
    pub fn advance_loaded<L: Load, const LEDGER: bool>(
        &self,
        state: &mut DeviceState,
        motion: &mut PistonMotion,
        set_pressure: f64,
        load: &L,
        dt: f64,
        substeps: usize,
    ) -> f64 {
        self.integrate::<L, LEDGER>(state, motion, set_pressure, load, dt, substeps)
            .load
    }

    /// Bends the bristles by the motion since they were last looked at.
    fn drag_seals(&self, state: &mut DeviceState, motion: PistonMotion) {
        let seals = self.seals_over([(&state.air, motion.stroke)], state.disturbance.friction);
        state.seal_deflection = seals.deflection_after(
            state.seal_deflection,
            motion.stroke - state.seal_stroke,
            motion.speed,
        );
        state.seal_stroke = motion.stroke;
    }

    pub(super) fn gas_force_of(&self, pressures: [f64; 2]) -> f64 {
        self.areas
            .gas_force(pressures[0], pressures[1], self.parameters().gas.atmosphere)
    }

    /// Which end stop pushes: -1 the retracted one, 1 the extended one, 0 none.
    pub(super) fn stop_at(&self, motion: PistonMotion) -> i8 {
        let end_stop = &self.parameters().end_stop;
        let beyond = motion.stroke - self.parameters().full_stroke;
        if end_stop.pushes(-motion.stroke, -motion.speed) {
            -1
        } else {
            i8::from(end_stop.pushes(beyond, motion.speed))
        }
    }

    /// Force of a stop along extension [N], as it holds while it pushes.
    pub(super) fn stop_force_of(&self, stop: i8, motion: PistonMotion) -> f64 {
        let end_stop = &self.parameters().end_stop;
        match stop {
            -1 => end_stop.linear(-motion.stroke, -motion.speed),
            1 => -end_stop.linear(motion.stroke - self.parameters().full_stroke, motion.speed),
            _ => 0.0,
        }
    }

    pub(super) fn pressures_of(&self, air: &AirState, volumes: [f64; 2]) -> [f64; 2] {
        let gas = &self.parameters().gas;
        match self.parameters().gas_process {
            GasProcess::Isothermal => [
                gas.pressure(air.masses[0], volumes[0]),
                gas.pressure(air.masses[1], volumes[1]),
            ],
            GasProcess::WallHeat { .. } => {
                let share = gas.heat_capacity_ratio - 1.0;
                [
                    share * air.energies[0] / volumes[0],
                    share * air.energies[1] / volumes[1],
                ]
            }
        }
    }

    pub(super) fn temperature_of(&self, air: &AirState, chamber: usize) -> f64 {
        let gas = &self.parameters().gas;
        match self.parameters().gas_process {
            GasProcess::Isothermal => gas.temperature,
            GasProcess::WallHeat { .. } => {
                air.energies[chamber] / (air.masses[chamber] * gas.specific_heat_volume())
            }
        }
    }

    /// Rates of the air at an outlet pressure of the regulator [Pa absolute], under outside influences. Into its one caller: a tenth of a step.
    #[inline(always)]
    pub(super) fn air_rates<const LEDGER: bool>(
        &self,
        air: &AirState,
        valve: ValvePosition,
        outlet: f64,
        motion: PistonMotion,
        disturbance: &Disturbance,
    ) -> AirRates {
        let parameters = self.parameters();
        let gas = &parameters.gas;
        // Written out, here and in `pressures_of`: `map` is not inlined, and costs a tenth of a step.
        let [first, second] = &self.chambers;
        let volumes = [first.volume(motion.stroke), second.volume(motion.stroke)];
        let pressures = self.pressures_of(air, volumes);
        let (supplied, vented) = (valve.supplied(), 1 - valve.supplied());
        let reservoir = parameters.supply_reservoir.as_ref();
        let stored = reservoir.map_or(f64::INFINITY, |r| r.pressure(gas, air.reservoir_mass));
        let outlet = outlet.min(stored);
        let before = match &parameters.hose {
            None => outlet,
            Some(hose) => gas.pressure(air.hose_mass, hose.last_volume()),
        };
        let mut flows = [0.0; 2];
        let supply = self.supply_conductance(disturbance);
        let exhaust = self.exhaust_conductance(disturbance);
        flows[supplied] = (self.flow).mass_flow(supply, before, pressures[supplied]);
        flows[vented] = (self.flow).mass_flow(exhaust, self.behind(valve), pressures[vented]);
        let disturbance_flows = disturbance.mass_flows;
        let leaks = self.leak_flows(air, pressures, disturbance.leaks);
        let mut rates = AirState::default();
        let mut ledger = EnergyLedger::default();
        if let GasProcess::WallHeat { conductance } = parameters.gas_process {
            for i in 0..2 {
                let own = self.temperature_of(air, i);
                let upstream = if flows[i] > 0.0 { gas.temperature } else { own };
                flows[i] *= (gas.temperature / upstream).sqrt();
                let enthalpy = gas.specific_heat_pressure() * upstream * flows[i]
                    + leaks.enthalpies[i]
                    + gas.specific_heat_pressure() * gas.temperature * disturbance_flows[i];
                let heat = conductance * (gas.temperature - own);
                let work = pressures[i] * self.chambers[i].growth() * motion.speed;
                rates.energies[i] = enthalpy + heat - work;
                ledger.enthalpy_in += enthalpy;
                ledger.heat_in += heat;
            }
        } else if LEDGER {
            let rt = gas.specific_gas_constant * gas.temperature;
            for i in 0..2 {
                let work = pressures[i] * self.chambers[i].growth() * motion.speed;
                let flow = flows[i] + leaks.masses[i] + disturbance_flows[i];
                ledger.enthalpy_in += gas.specific_heat_pressure() * gas.temperature * flow;
                ledger.heat_in += work - rt * flow;
            }
        }
        for i in 0..2 {
            rates.masses[i] = flows[i] + leaks.masses[i] + disturbance_flows[i];
        }
        let mut from_regulator = flows[supplied];
        if let Some(hose) = &parameters.hose {
            let (into, last) = (self.line_flows(hose, air, outlet), hose.segments() - 1);
            for j in 0..last {
                rates.upstream[j] = into[j] - into[j + 1];
            }
            rates.hose_mass = into[last] - from_regulator;
            from_regulator = into[0];
        }
        if let Some(reservoir) = reservoir {
            rates.reservoir_mass = reservoir.compressed(stored) - from_regulator.max(0.0);
        }
        let through_valve = [from_regulator, flows[vented]];
        for flow in [through_valve, leaks.external, disturbance_flows].as_flattened() {
            rates.entered += flow.max(0.0);
            rates.left -= flow.min(0.0);
        }
        AirRates {
            air: rates,
            ledger,
            pressures,
        }
    }

    /// Flows of the leaks, of those besides the parameters' from areas [m2].
    #[inline(always)]
    fn leak_flows(&self, air: &AirState, pressures: [f64; 2], further: [f64; 2]) -> LeakFlows {
        if self.parameters().leakage.is_none() && further == [0.0; 2] {
            return LeakFlows::default();
        }
        let chambers = [0, 1].map(|i| (pressures[i], self.temperature_of(air, i)));
        LeakFlows::new(self.parameters(), &self.flow, chambers, further)
    }

    /// Flow into each segment of a line from an outlet pressure [Pa absolute] on [kg/s].
    #[inline(always)]
    fn line_flows(&self, hose: &Hose, air: &AirState, outlet: f64) -> [f64; UPSTREAM + 1] {
        let gas = &self.parameters().gas;
        let (mut into, mut previous, last) = ([0.0; UPSTREAM + 1], outlet, hose.segments() - 1);
        for (j, flow) in into.iter_mut().enumerate().take(last + 1) {
            let pressure = match j == last {
                true => gas.pressure(air.hose_mass, hose.last_volume()),
                false => gas.pressure(air.upstream[j], hose.segment_volume()),
            };
            *flow = hose.mass_flow(previous, pressure);
            previous = pressure;
        }
        into
    }

    /// Absolute pressure behind the exhaust orifice [Pa]: of a second regulator behind chamber 2, if there is one.
    fn behind(&self, valve: ValvePosition) -> f64 {
        let atmosphere = self.parameters().gas.atmosphere;
        match valve {
            ValvePosition::Extend => atmosphere + self.parameters().opposing_pressure,
            ValvePosition::Retract => atmosphere,
        }
    }

    /// Conductance of the supply orifice with what is added to it [m2]: nothing flows through one of less than no area.
    pub(super) fn supply_conductance(&self, disturbance: &Disturbance) -> f64 {
        let added = self.parameters().discharge_coefficient * disturbance.orifices[0];
        (self.valve.supply_conductance + added).max(0.0)
    }

    /// The same of the exhaust orifice [m2].
    fn exhaust_conductance(&self, disturbance: &Disturbance) -> f64 {
        let added = self.parameters().discharge_coefficient * disturbance.orifices[1];
        (self.valve.exhaust_conductance + added).max(0.0)
    }

    /// The smaller volume of each chamber at both ends of a step [m3], if the piston keeps its speed.
    pub(super) fn smallest_volumes(&self, motion: PistonMotion, dt: f64) -> [f64; 2] {
        let end = motion.stroke + motion.speed * dt;
        self.chambers
            .map(|chamber| chamber.volume(motion.stroke).min(chamber.volume(end)))
    }

    /// Natural frequency of the piston on its two air springs [rad/s], the chambers at no less than a pressure [Pa absolute]:
    /// sqrt(sum of n p A^2/V over M), n the exponent of the gas's process.
    pub(super) fn spring_rate(&self, air: &AirState, volumes: [f64; 2], least: f64) -> f64 {
        let exponent = self.parameters().stiffest_exponent();
        let pressures = self.pressures_of(air, volumes);
        let stiffness = |i: usize| {
            exponent * pressures[i].max(least) * self.chambers[i].area.powi(2) / volumes[i]
        };
        ((stiffness(0) + stiffness(1)) / self.parameters().moving_mass).sqrt()
    }

    /// Rate at which the smallest volume of a step comes to the pressure beside it [1/s].
    pub(super) fn air_rate(&self, volumes: [f64; 2], disturbance: &Disturbance) -> f64 {
        let smallest = volumes[0].min(volumes[1]);
        let gas = &self.parameters().gas;
        let wall = match self.parameters().gas_process {
            GasProcess::Isothermal => 0.0,
            GasProcess::WallHeat { conductance } => {
                conductance / (gas.mass(gas.atmosphere, smallest) * gas.specific_heat_volume())
            }
        };
        let [supply, exhaust] = disturbance.orifices;
        let added = disturbance.leaks.iter().sum::<f64>() + supply.max(exhaust).max(0.0);
        (self.chamber_rate_volume + self.leak_rate * added) / smallest + self.reservoir_rate + wall
    }
}

#[cfg(test)]
mod tests;
