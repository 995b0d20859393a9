//! Where a term beside the rig's device, contact and sensors may enter.

use crate::listed::listed;

listed! {
    /// A port.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
    pub enum Port: 15,
    /// Name in files and answers.
    name: &'static str {
        /// A force on the piston along extension [N].
        PistonForce = "piston_force",
        /// Dry friction of the piston beside that of its seals, against the motion [N].
        Friction = "friction",
        /// A pressure added to the set pressure, before the regulator follows it [Pa].
        SetPressure = "set_pressure",
        /// A pressure added to the regulator's outlet [Pa].
        OutletPressure = "outlet_pressure",
        /// Air into chamber 1 [kg/s].
        FirstChamberFlow = "first_chamber_flow",
        /// Air into chamber 2 [kg/s].
        SecondChamberFlow = "second_chamber_flow",
        /// Area of a leak from chamber 1 to the atmosphere, with the valve's discharge coefficient [m2].
        FirstChamberLeak = "first_chamber_leak",
        /// The same from chamber 2 [m2].
        SecondChamberLeak = "second_chamber_leak",
        /// Area added to the valve's supply orifice [m2].
        SupplyOrifice = "supply_orifice",
        /// Area added to its exhaust orifice [m2].
        ExhaustOrifice = "exhaust_orifice",
        /// A displacement of the surface along extension [m].
        Surface = "surface",
        /// Added to the stiffness of the contact [N/m].
        ContactStiffness = "contact_stiffness",
        /// Added to the load cell's reading [N].
        ForceReading = "force_reading",
        /// Added to the position sensor's reading [m].
        StrokeReading = "stroke_reading",
        /// Added to the pressure sensor's reading [Pa].
        PressureReading = "pressure_reading",
    }
}

impl Port {
    /// Whether it changes what a sensor says, and nothing else.
    pub fn is_reading(self) -> bool {
        matches!(
            self,
            Self::ForceReading | Self::StrokeReading | Self::PressureReading
        )
    }

    /// Whether what acts there is never less than nothing: the area of an opening, friction.
    pub fn is_positive(self) -> bool {
        matches!(
            self,
            Self::FirstChamberLeak | Self::SecondChamberLeak | Self::Friction
        )
    }

    /// Its unit as a key ends with it.
    pub fn suffix(self) -> &'static str {
        match self {
            Self::PistonForce | Self::Friction | Self::ForceReading => "n",
            Self::SetPressure | Self::OutletPressure | Self::PressureReading => "pa",
            Self::FirstChamberLeak
            | Self::SecondChamberLeak
            | Self::SupplyOrifice
            | Self::ExhaustOrifice => "m2",
            Self::ContactStiffness => "n_per_m",
            Self::FirstChamberFlow | Self::SecondChamberFlow => "kg_per_s",
            Self::Surface | Self::StrokeReading => "m",
        }
    }

    /// Its unit.
    pub fn unit(self) -> &'static str {
        match self {
            Self::PistonForce | Self::Friction | Self::ForceReading => "N",
            Self::SetPressure | Self::OutletPressure | Self::PressureReading => "Pa",
            Self::FirstChamberLeak
            | Self::SecondChamberLeak
            | Self::SupplyOrifice
            | Self::ExhaustOrifice => "m^2",
            Self::ContactStiffness => "N/m",
            Self::FirstChamberFlow | Self::SecondChamberFlow => "kg/s",
            Self::Surface | Self::StrokeReading => "m",
        }
    }

    /// Part of the chain that it belongs to, as in an answer.
    pub fn subsystem(self) -> &'static str {
        match self {
            Self::PistonForce | Self::Friction => "force_balance",
            Self::SetPressure | Self::OutletPressure => "regulator",
            Self::FirstChamberFlow
            | Self::SecondChamberFlow
            | Self::FirstChamberLeak
            | Self::SecondChamberLeak
            | Self::SupplyOrifice
            | Self::ExhaustOrifice => "chambers",
            Self::Surface | Self::ContactStiffness => "contact",
            Self::ForceReading | Self::StrokeReading | Self::PressureReading => "sensors",
        }
    }
}
