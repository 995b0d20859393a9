//! State of a device that changes during a run.

use crate::physics::line_chain::UPSTREAM;
use crate::physics::regulator::RegulatorState;
use crate::physics::switching_delay::Spool;
use crate::physics::valve::ValvePosition;

/// State of a device; its piston's motion is kept beside it.
#[derive(Debug, Clone, PartialEq)]
pub struct DeviceState {
    /// The regulator.
    pub regulator: RegulatorState,
    /// Commanded position of the solenoid valve.
    pub valve: ValvePosition,
    /// Its spool, which takes it after the switching delay.
    pub spool: Spool,
    /// The air in it.
    pub air: AirState,
    /// Deflection of the seals' bristles [m].
    pub seal_deflection: f64,
    /// Stroke at which that was [m].
    pub seal_stroke: f64,
    /// Outside influences that its parameters do not describe.
    pub disturbance: Disturbance,
    /// Energy since the start.
    pub ledger: EnergyLedger,
}

/// Outside influences on a device that its parameters do not describe, set by whoever knows them.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Disturbance {
    /// Pressure added to the set pressure [Pa].
    pub set_pressure: f64,
    /// Pressure added to the regulator's outlet [Pa].
    pub outlet: f64,
    /// Air into chambers 1 and 2, at the gas's temperature [kg/s].
    pub mass_flows: [f64; 2],
    /// Area of a leak from chambers 1 and 2 to the atmosphere, beside that of the parameters [m2].
    pub leaks: [f64; 2],
    /// Area added to the valve's supply and exhaust orifices [m2].
    pub orifices: [f64; 2],
    /// Dry friction beside that of the parameters [N], which must be dry ([`crate::physics::seal_friction::SealFriction::pressed`]).
    pub friction: f64,
}

/// Air, in amounts that are conserved.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct AirState {
    /// Air in chambers 1 and 2 [kg].
    pub masses: [f64; 2],
    /// Its internal energy [J]; used only if the gas has a temperature of its own.
    pub energies: [f64; 2],
    /// Air in the line between regulator and valve [kg], in its last segment if it is distributed; 0 without one.
    pub hose_mass: f64,
    /// Air in the segments before [kg], first the one behind the regulator.
    pub upstream: [f64; UPSTREAM],
    /// Air in the reservoir in front of the regulator [kg]; 0 without one. It is not inside the device.
    pub reservoir_mass: f64,
    /// Air that has come in since the start, from the regulator and from the atmosphere, through the valve or a leak [kg].
    pub entered: f64,
    /// Air that has gone out since the start [kg].
    pub left: f64,
}

impl AirState {
    /// All the air inside [kg].
    pub fn held(&self) -> f64 {
        self.masses[0] + self.masses[1] + self.line_mass()
    }

    /// Air in the whole line [kg].
    pub fn line_mass(&self) -> f64 {
        self.hose_mass + self.upstream.iter().sum::<f64>()
    }

    /// This, plus `rates` over a time [s], but for what only `line_step` moves.
    #[inline(always)]
    pub(super) fn after(&self, rates: &Self, time: f64) -> Self {
        Self {
            masses: [
                self.masses[0] + time * rates.masses[0],
                self.masses[1] + time * rates.masses[1],
            ],
            energies: [
                self.energies[0] + time * rates.energies[0],
                self.energies[1] + time * rates.energies[1],
            ],
            hose_mass: self.hose_mass + time * rates.hose_mass,
            upstream: self.upstream,
            reservoir_mass: self.reservoir_mass + time * rates.reservoir_mass,
            entered: self.entered + time * rates.entered,
            left: self.left + time * rates.left,
        }
    }
}

/// Energy that has passed since the start [J]; kept by `Device::advance_loaded` and `Device::advance`.
///
/// Two balances hold, at any time between any two states:
///
/// ```text
/// U(air in the chambers) = U_0 + enthalpy_in + heat_in - chamber_work
/// M v^2/2                = M v_0^2/2 + chamber_work - atmosphere_work - seal_work - stop_work - cushion_work + axial_work + load_work
/// ```
///
/// `Device::advance` moves the piston as predicted, at one speed throughout its step: there the second has no change on its left, and the load's
/// work is what the caller's prediction puts in to hold that speed, the negative of the returned force times the way. What the mass gains from one step to
/// the next is the caller's own account.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct EnergyLedger {
    /// Enthalpy of the air that came into the chambers, less that of what went out.
    pub enthalpy_in: f64,
    /// Heat from the walls; in an isothermal chamber whatever keeps its temperature.
    pub heat_in: f64,
    /// Work of the air on both sides of the piston.
    pub chamber_work: f64,
    /// Work of the piston on the atmosphere, over the rod's cross section.
    pub atmosphere_work: f64,
    /// Work of the piston on its seals, viscous part included.
    pub seal_work: f64,
    /// Work of the piston on the end stops.
    pub stop_work: f64,
    /// Work of the piston on the cushions at its ends.
    pub cushion_work: f64,
    /// Work of the axial load on the piston.
    pub axial_work: f64,
    /// Work of the load on the piston.
    pub load_work: f64,
}

impl EnergyLedger {
    pub(super) fn after(&self, rates: &Self, time: f64) -> Self {
        Self {
            enthalpy_in: self.enthalpy_in + time * rates.enthalpy_in,
            heat_in: self.heat_in + time * rates.heat_in,
            chamber_work: self.chamber_work + time * rates.chamber_work,
            atmosphere_work: self.atmosphere_work + time * rates.atmosphere_work,
            seal_work: self.seal_work + time * rates.seal_work,
            stop_work: self.stop_work + time * rates.stop_work,
            cushion_work: self.cushion_work + time * rates.cushion_work,
            axial_work: self.axial_work + time * rates.axial_work,
            load_work: self.load_work + time * rates.load_work,
        }
    }
}
