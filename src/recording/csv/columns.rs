//! The columns of a real rig's recording.

use super::super::schema::{self, JointSignal};
use crate::unit::{SiUnit as Unit, column_name};

/// Column of the sample times.
pub(super) const TIME: &str = "time_s";

/// A column besides the time.
#[derive(Clone)]
pub(super) struct Column {
    /// Its name.
    pub name: &'static str,
    /// Its quantity in the schema.
    pub quantity: &'static str,
    /// Its unit.
    pub unit: Unit,
    /// Whether it drives the rig. It cannot be absent then.
    pub is_input: bool,
    /// Whether it is held from its sample to the next. Then it cannot be empty at the start.
    pub is_held: bool,
    /// Least and largest plausible value.
    pub range: [f64; 2],
    /// Unit of which a column outside the range may be.
    pub larger_than_si: Option<&'static str>,
    /// A column that never gets there, though above zero, is in a larger unit.
    pub least_maximum: f64,
}

const fn column(
    name: &'static str,
    quantity: &'static str,
    unit: Unit,
    is_input: bool,
    range: [f64; 2],
    larger_than_si: Option<&'static str>,
) -> Column {
    Column {
        name,
        quantity,
        unit,
        is_input,
        is_held: false,
        range,
        larger_than_si,
        least_maximum: 0.0,
    }
}

/// The columns: three inputs, then the measured ones.
#[rustfmt::skip] // A table: one column a line.
pub(super) static COLUMNS: [Column; 7] = [
    // 2000 Pa would not move a seal.
    Column { is_held: true, least_maximum: 2000.0, ..column("set_pressure_pa", schema::SET_PRESSURE_GAUGE, Unit::Pascal, true, [-1e3, 2e6], None) },
    Column { is_held: true, ..column("solenoid", schema::VALVE_EXTENDS, Unit::One, true, [0.0, 1.0], None) },
    column("surface_m", schema::SURFACE_POSITION, Unit::Metre, true, [-2.0, 2.0], Some("mm")),
    // Noise alone reaches above 50 Pa.
    Column { least_maximum: 50.0, ..column("regulator_pressure_pa", schema::MEASURED_REGULATOR_PRESSURE_GAUGE, Unit::Pascal, false, [-1.1e5, 2e6], None) },
    column("stroke_m", schema::MEASURED_STROKE, Unit::Metre, false, [-0.5, 1.5], Some("mm")),
    column("force_n", schema::MEASURED_FORCE, Unit::Newton, false, [-2e4, 2e4], Some("mN")),
    column("acceleration_m_per_s2", schema::MEASURED_ACCELERATION, Unit::MetrePerSecondSquared, false, [-1e4, 1e4], Some("mm/s2")),
];

/// Least and largest value of a quantity that is plausible in a recording of a real rig; any for one that such a recording does not have.
#[must_use]
pub fn plausible_range(quantity: &str) -> [f64; 2] {
    COLUMNS
        .iter()
        .find(|column| column.quantity == quantity)
        .map_or([f64::NEG_INFINITY, f64::INFINITY], |column| column.range)
}

/// Column that holds a quantity in a recording of a rig or a cell; one of the quantity and its unit where such recordings do not have it.
#[must_use]
pub fn column_of(quantity: &str, unit: Unit) -> String {
    if let Some(column) = COLUMNS.iter().find(|column| column.quantity == quantity) {
        return column.name.to_owned();
    }
    match schema::parse_joint_quantity(quantity) {
        Some((joint, JointSignal::Reference)) => format!("joint_{joint}_command_rad"),
        Some((joint, JointSignal::Encoder)) => format!("joint_{joint}_rad"),
        _ if quantity == schema::PATH_LENGTH => "path_m".to_owned(),
        _ => column_name(quantity, unit),
    }
}
