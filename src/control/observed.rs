//! What there is to see of a running device after a step, for a controller outside of the program.

use crate::unit::SiUnit as Unit;

/// The device after a step, in the order of [`OBSERVED`].
pub type Observed = [f64; OBSERVED.len()];

/// A number that is seen: its name, its unit, and what it is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Sight {
    /// Name without unit.
    pub quantity: &'static str,
    /// Unit.
    pub unit: Unit,
    /// What it is.
    pub meaning: &'static str,
}

const fn sight(quantity: &'static str, unit: Unit, meaning: &'static str) -> Sight {
    Sight {
        quantity,
        unit,
        meaning,
    }
}

/// All that is seen.
pub const OBSERVED: [Sight; 15] = [
    sight("time", Unit::Second, "Time since the start."),
    sight(
        "desired_force",
        Unit::Newton,
        "Contact force that the scenario asks for; NaN of a bench that commands pressures.",
    ),
    sight(
        "desired_axial_force",
        Unit::Newton,
        "Its part along the stroke.",
    ),
    sight(
        "contact_force",
        Unit::Newton,
        "True force of the tool on the part along the contact normal.",
    ),
    sight(
        "measured_force",
        Unit::Newton,
        "Reading of the load cell, along the stroke.",
    ),
    sight("stroke", Unit::Metre, "True stroke, zero when retracted."),
    sight(
        "stroke_velocity",
        Unit::MetrePerSecond,
        "True speed of extension.",
    ),
    sight("measured_stroke", Unit::Metre, "Reading of the stroke."),
    sight(
        "set_pressure_gauge",
        Unit::Pascal,
        "Set pressure that the regulator acts on, gauge.",
    ),
    sight(
        "regulator_pressure_gauge",
        Unit::Pascal,
        "True pressure at the regulator's outlet, gauge.",
    ),
    sight(
        "measured_regulator_pressure_gauge",
        Unit::Pascal,
        "Reading of that pressure, gauge.",
    ),
    sight(
        "chamber_1_pressure",
        Unit::Pascal,
        "True pressure in the chamber that extends, absolute.",
    ),
    sight(
        "chamber_2_pressure",
        Unit::Pascal,
        "True pressure in the chamber that retracts, absolute.",
    ),
    sight(
        "gravity_along_extension",
        Unit::MetrePerSecondSquared,
        "Gravity along the stroke, positive in extension.",
    ),
    sight(
        "phase",
        Unit::One,
        "Phase of a cell's job: 0 approach, 1 engage, 2 follow, 3 retract; NaN of a bench.",
    ),
];
