//! Constant parameters of a device during a run, strict SI.

use crate::physics::axial_load::AxialLoad;
use crate::physics::chamber::{Chamber, Side};
use crate::physics::end_cushioning::EndCushioning;
use crate::physics::gas::Gas;
use crate::physics::gas_process::GasProcess;
use crate::physics::hose::Hose;
use crate::physics::leakage::Leakage;
use crate::physics::piston::PistonAreas;
use crate::physics::push_only::PushOnly;
use crate::physics::regulator::RegulatorParameters;
use crate::physics::seal_friction::SealFriction;
use crate::physics::supply_reservoir::SupplyReservoir;
use crate::physics::valve::ValveParameters;

/// Parameters of the device, all cylinders together.
#[derive(Debug, Clone, PartialEq)]
pub struct DeviceParameters {
    /// Number of identical cylinders in parallel.
    pub cylinder_count: u32,
    /// Bore of a cylinder [m].
    pub bore: f64,
    /// Rod diameter [m].
    pub rod: f64,
    /// Full stroke [m].
    pub full_stroke: f64,
    /// Dead volume of each chamber, all cylinders together [m3].
    pub dead_volume: f64,
    /// Moving mass with tool [kg].
    pub moving_mass: f64,
    /// Supply orifice between regulator and chamber [m2].
    pub supply_orifice: f64,
    /// Exhaust orifice between chamber and atmosphere [m2].
    pub exhaust_orifice: f64,
    /// Discharge coefficient of both orifices [1].
    pub discharge_coefficient: f64,
    /// The pressure regulator.
    pub regulator: RegulatorParameters,
    /// The end stops: one at each end of the stroke.
    pub end_stop: PushOnly,
    /// Friction of seals and guides.
    pub seal_friction: SealFriction,
    /// The working gas.
    pub gas: Gas,
    /// Process of the gas in the chambers under compression.
    pub gas_process: GasProcess,
    /// Line between regulator and valve, if it counts.
    pub hose: Option<Hose>,
    /// Stiffness of the clamp that holds a locked device [N/m].
    pub lock_stiffness: f64,
    /// Air that passes seals and fittings.
    pub leakage: Leakage,
    /// Loads on the piston all along its stroke.
    pub axial_load: AxialLoad,
    /// Cushions at the ends of the stroke.
    pub end_cushioning: EndCushioning,
    /// Reservoir in front of the regulator, if it is finite.
    pub supply_reservoir: Option<SupplyReservoir>,
    /// Pressure that a second regulator holds behind chamber 2 while the device extends [Pa gauge]: what presses back, so that less than the tool's weight can
    /// be pressed with; 0 for a chamber that is open to the atmosphere.
    pub opposing_pressure: f64,
    /// Time from the valve's command to its switching [s].
    pub switching_delay: f64,
}

impl Default for DeviceParameters {
    /// The device of models/device.toml, which a test holds it to: nothing in it that a device need not have.
    fn default() -> Self {
        Self {
            cylinder_count: 2,
            bore: 0.032,
            rod: 0.012,
            full_stroke: 0.05,
            dead_volume: 2e-5,
            moving_mass: 4.0,
            supply_orifice: 2.5e-6,
            exhaust_orifice: 2e-6,
            discharge_coefficient: 0.95,
            regulator: RegulatorParameters::default(),
            end_stop: PushOnly {
                stiffness: 1e6,
                damping: 2e3,
            },
            seal_friction: SealFriction::NONE,
            gas: Gas::default(),
            gas_process: GasProcess::Isothermal,
            hose: None,
            lock_stiffness: 1e8,
            leakage: Leakage::NONE,
            axial_load: AxialLoad::NONE,
            end_cushioning: EndCushioning::NONE,
            supply_reservoir: None,
            opposing_pressure: 0.0,
            switching_delay: 0.0,
        }
    }
}

impl DeviceParameters {
    /// Piston areas, all cylinders together.
    pub fn areas(&self) -> PistonAreas {
        PistonAreas::of_cylinders(self.cylinder_count, self.bore, self.rod)
    }

    /// Chambers 1 and 2.
    pub fn chambers(&self) -> [Chamber; 2] {
        let areas = self.areas();
        let chamber = |side, area| Chamber {
            side,
            area,
            dead_volume: self.dead_volume,
            full_stroke: self.full_stroke,
        };
        [
            chamber(Side::Extending, areas.extending),
            chamber(Side::Retracting, areas.retracting),
        ]
    }

    /// Largest exponent n with which the air in the chambers follows p V^n [1].
    pub(super) fn stiffest_exponent(&self) -> f64 {
        match self.gas_process {
            GasProcess::Isothermal => 1.0,
            GasProcess::WallHeat { .. } => self.gas.heat_capacity_ratio,
        }
    }

    /// Orifices of the valve with their discharge coefficient.
    pub fn valve(&self) -> ValveParameters {
        ValveParameters {
            supply_conductance: self.supply_orifice * self.discharge_coefficient,
            exhaust_conductance: self.exhaust_orifice * self.discharge_coefficient,
        }
    }
}
