//! Ports and variables for people, in the units that they use.

use crate::plant::{Port, Variable};

/// A quantity for people: its words, its unit, and what a value in SI is multiplied by.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DisplayQuantity {
    /// Words.
    pub words: &'static str,
    /// Unit.
    pub unit: &'static str,
    /// Factor.
    pub factor: f64,
}

/// Quantity added at a port.
#[must_use]
pub fn port(port: Port) -> DisplayQuantity {
    let (words, unit, factor) = match port {
        Port::PistonForce => ("force on the piston", "N", 1.0),
        Port::Friction => ("friction of the piston", "N", 1.0),
        Port::SetPressure => ("pressure added to the set pressure", "mbar", 1e-2),
        Port::OutletPressure => ("pressure at the regulator's outlet", "mbar", 1e-2),
        Port::FirstChamberFlow => ("flow of air into chamber 1", "g/s", 1e3),
        Port::SecondChamberFlow => ("flow of air into chamber 2", "g/s", 1e3),
        Port::FirstChamberLeak => ("area of a leak from chamber 1", "mm2", 1e6),
        Port::SecondChamberLeak => ("area of a leak from chamber 2", "mm2", 1e6),
        Port::SupplyOrifice => ("area added to the supply orifice", "mm2", 1e6),
        Port::ExhaustOrifice => ("area added to the exhaust orifice", "mm2", 1e6),
        Port::ContactStiffness => ("stiffness added to the contact", "N/mm", 1e-3),
        Port::Surface => ("displacement of the surface", "mm", 1e3),
        Port::ForceReading => ("error of the load cell's reading", "N", 1.0),
        Port::StrokeReading => ("error of the position sensor's reading", "mm", 1e3),
        Port::PressureReading => ("error of the pressure sensor's reading", "mbar", 1e-2),
    };
    DisplayQuantity {
        words,
        unit,
        factor,
    }
}

/// On what it depends.
#[must_use]
pub fn variable(variable: Variable) -> DisplayQuantity {
    let (words, unit, factor) = match variable {
        Variable::Time => ("time", "s", 1.0),
        Variable::Stroke => ("stroke", "mm", 1e3),
        Variable::Velocity => ("speed of extension", "mm/s", 1e3),
        Variable::ChamberPressure => ("pressure in chamber 1", "bar", 1e-5),
        Variable::PressureDifference => ("pressure difference across the piston", "bar", 1e-5),
        Variable::MassFlow => ("flow of air drawn", "g/s", 1e3),
        Variable::SetPressure => ("set pressure", "bar", 1e-5),
        Variable::Surface => ("place of the surface", "mm", 1e3),
        Variable::ContactForce => ("contact force", "N", 1.0),
    };
    DisplayQuantity {
        words,
        unit,
        factor,
    }
}
