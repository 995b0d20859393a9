//! What does not change in a device during a run, strict SI.

use crate::physics::chamber::{Chamber, Side};
use crate::physics::end_stop::EndStop;
use crate::physics::gas::Gas;
use crate::physics::piston::PistonAreas;
use crate::physics::regulator::RegulatorParameters;
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
    /// The end stops.
    pub end_stop: EndStop,
    /// The working gas.
    pub gas: Gas,
    /// Stiffness of the clamp that holds a locked device [N/m].
    pub lock_stiffness: f64,
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

    /// Orifices of the valve with their discharge coefficient.
    pub fn valve(&self) -> ValveParameters {
        ValveParameters {
            supply_conductance: self.supply_orifice * self.discharge_coefficient,
            exhaust_conductance: self.exhaust_orifice * self.discharge_coefficient,
        }
    }
}
