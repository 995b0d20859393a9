//! The 5/2 solenoid valve: which chamber hangs on the regulator and which on the atmosphere.
//!
//! Extending, chamber 1 is joined to the regulator's outlet through the supply orifice and chamber 2 to the atmosphere through the exhaust orifice;
//! retracting, the other way round (source paper, section 2.1 and fig. 2). Flow goes either way through each: the regulator relieves.
//! When the spool goes over: `switching_delay`.

/// Position of the spool.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ValvePosition {
    /// Chamber 1 on the regulator.
    Extend,
    /// Chamber 2 on the regulator.
    Retract,
}

impl ValvePosition {
    /// Index of the chamber on the regulator; the other one is vented.
    pub fn supplied(self) -> usize {
        match self {
            Self::Extend => 0,
            Self::Retract => 1,
        }
    }
}

/// Orifices of the valve, discharge coefficient included.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ValveParameters {
    /// Supply orifice times discharge coefficient [m2].
    pub supply_conductance: f64,
    /// Exhaust orifice times discharge coefficient [m2].
    pub exhaust_conductance: f64,
}
