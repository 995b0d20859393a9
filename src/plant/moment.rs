//! The variables of one moment, on which a term at a port may depend.

use crate::listed::listed;

listed! {
    /// A variable.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
    pub enum Variable: 9,
    /// Name in an answer.
    name: &'static str {
        /// Time since the start of the recording [s].
        Time = "time",
        /// Stroke [m].
        Stroke = "stroke_m",
        /// Speed of extension [m/s].
        Velocity = "velocity",
        /// Pressure in chamber 1 [Pa absolute].
        ChamberPressure = "chamber_pressure",
        /// Pressure in chamber 1 less that in chamber 2 [Pa].
        PressureDifference = "pressure_difference",
        /// Air that comes in [kg/s].
        MassFlow = "mass_flow",
        /// Set pressure [Pa gauge].
        SetPressure = "set_pressure",
        /// Where the surface stands [m].
        Surface = "surface_m",
        /// Contact force [N].
        ContactForce = "contact_force",
    }
}

impl Variable {
    /// Its unit as a key ends with it.
    pub fn suffix(self) -> &'static str {
        match self {
            Self::Time => "s",
            Self::Stroke | Self::Surface => "m",
            Self::Velocity => "m_per_s",
            Self::ChamberPressure | Self::PressureDifference | Self::SetPressure => "pa",
            Self::MassFlow => "kg_per_s",
            Self::ContactForce => "n",
        }
    }
}

/// The variables of one moment.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Moment {
    /// Time since the start of the recording [s].
    pub time: f64,
    /// Stroke [m].
    pub stroke: f64,
    /// Speed of extension [m/s].
    pub speed: f64,
    /// Pressures in the chambers [Pa absolute].
    pub pressures: [f64; 2],
    /// Air that comes in [kg/s].
    pub mass_flow: f64,
    /// Set pressure [Pa gauge].
    pub set_pressure: f64,
    /// Where the surface stands [m]; NaN where there is none.
    pub surface: f64,
    /// Contact force [N].
    pub contact_force: f64,
}

impl Moment {
    /// The same a time [s] later, as far as its motion tells.
    #[must_use]
    pub fn ahead(&self, time: f64) -> Self {
        Self {
            time: self.time + time,
            stroke: self.stroke + time * self.speed,
            ..*self
        }
    }

    /// The same with another value of one of them.
    #[must_use]
    pub fn with(mut self, variable: Variable, value: f64) -> Self {
        match variable {
            Variable::Time => self.time = value,
            Variable::Stroke => self.stroke = value,
            Variable::Velocity => self.speed = value,
            Variable::ChamberPressure => self.pressures[0] = value,
            Variable::PressureDifference => self.pressures[0] = self.pressures[1] + value,
            Variable::MassFlow => self.mass_flow = value,
            Variable::SetPressure => self.set_pressure = value,
            Variable::Surface => self.surface = value,
            Variable::ContactForce => self.contact_force = value,
        }
        self
    }

    /// One of them.
    pub fn of(&self, variable: Variable) -> f64 {
        match variable {
            Variable::Time => self.time,
            Variable::Stroke => self.stroke,
            Variable::Velocity => self.speed,
            Variable::ChamberPressure => self.pressures[0],
            Variable::PressureDifference => self.pressures[0] - self.pressures[1],
            Variable::MassFlow => self.mass_flow,
            Variable::SetPressure => self.set_pressure,
            Variable::Surface => self.surface,
            Variable::ContactForce => self.contact_force,
        }
    }
}
