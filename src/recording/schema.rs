//! The signals that the simulated cell records: names, units and meanings.
//!
//! This is the one list. A real recording that uses the same names is drawn and compared the same
//! way. In files a column is `<name>_<unit>` ([`super::unit::column_name`]).

use super::Unit;

/// Sample time; the recording's own column.
pub const TIME: &str = "time";
/// Name of the phase at each sample; the recording's own column, text.
pub const PHASE: &str = "phase";
/// Length of planned path behind the tool.
pub const PATH_LENGTH: &str = "path_length";
/// Force on the workpiece along the contact normal.
pub const CONTACT_FORCE: &str = "contact_force";
/// World x component of the force on the workpiece.
pub const CONTACT_FORCE_X: &str = "contact_force_x";
/// World y component of the force on the workpiece.
pub const CONTACT_FORCE_Y: &str = "contact_force_y";
/// World z component of the force on the workpiece.
pub const CONTACT_FORCE_Z: &str = "contact_force_z";
/// Size of the contact force's tangential part.
pub const FRICTION_FORCE: &str = "friction_force";
/// Largest contact force since the sample before.
pub const CONTACT_FORCE_PEAK: &str = "contact_force_peak";
/// Contact force that the scenario asks for.
pub const DESIRED_FORCE: &str = "desired_force";
/// Force of air and seals on the device's moving part.
pub const DEVICE_FORCE: &str = "device_force";
/// Position of the device's slide.
pub const STROKE: &str = "stroke";
/// Velocity of the device's slide.
pub const STROKE_VELOCITY: &str = "stroke_velocity";
/// Pressure in the chamber that extends the slide.
pub const CHAMBER_1_PRESSURE: &str = "chamber_1_pressure";
/// Pressure in the chamber that retracts the slide.
pub const CHAMBER_2_PRESSURE: &str = "chamber_2_pressure";
/// Pressure at the regulator's outlet.
pub const REGULATOR_PRESSURE: &str = "regulator_pressure";
/// Pressure that the regulator is told to hold.
pub const SET_PRESSURE: &str = "set_pressure";
/// Air in chamber 1.
pub const CHAMBER_1_MASS: &str = "chamber_1_mass";
/// Air in chamber 2.
pub const CHAMBER_2_MASS: &str = "chamber_2_mass";
/// Air in the line between regulator and valve.
pub const HOSE_MASS: &str = "hose_mass";
/// Air that has entered the chambers.
pub const MASS_ENTERED: &str = "mass_entered";
/// Air that has left the chambers.
pub const MASS_LEFT: &str = "mass_left";
/// Distance of the tool beside the planned path, across path and contact normal.
pub const PATH_ERROR: &str = "path_error";
/// Distance by which the tool lags behind its plan along the path.
pub const PATH_LAG: &str = "path_lag";
/// Distance of the flange from its planned path along the tool's axis.
pub const PATH_ERROR_AXIAL: &str = "path_error_axial";
/// Speed of the tool along the edge.
pub const FEED: &str = "feed";

/// Speed of the tool's surface where it touches.
pub const CUTTING_SPEED: &str = "cutting_speed";
/// Volume that the tool takes off per time.
pub const REMOVAL_RATE: &str = "removal_rate";
/// Torque of the tool's contact on its spindle.
pub const SPINDLE_TORQUE: &str = "spindle_torque";
/// Power that the spindle gives at the tool.
pub const SPINDLE_POWER: &str = "spindle_power";
/// Work of normal force and cutting speed that the tool has done.
pub const TOOL_WEAR: &str = "tool_wear";

/// Force of the device's seals on its moving part.
pub const SEAL_FORCE: &str = "seal_force";
/// Acceleration of the device's slide.
pub const ACCELERATION: &str = "acceleration";
/// Where the load's surface stands along the stroke.
pub const SURFACE_POSITION: &str = "surface_position";
/// Whether the 5/2 valve is in its extending position.
pub const VALVE_EXTENDS: &str = "valve_extends";
/// Contact force as the load cell's software reads it, filtered.
pub const MEASURED_FORCE: &str = "measured_force";
/// Contact force as the load cell's software reads it, before its filter.
pub const MEASURED_FORCE_UNFILTERED: &str = "measured_force_unfiltered";
/// Stroke as the position sensor reads it.
pub const MEASURED_STROKE: &str = "measured_stroke";
/// Acceleration as the accelerometer reads it.
pub const MEASURED_ACCELERATION: &str = "measured_acceleration";
/// Regulator outlet as its sensor reads it.
pub const MEASURED_REGULATOR_PRESSURE: &str = "measured_regulator_pressure";
/// Pressure that the regulator is told to hold, against the atmosphere.
pub const SET_PRESSURE_GAUGE: &str = "set_pressure_gauge";
/// Regulator outlet as its sensor reads it, against the atmosphere.
pub const MEASURED_REGULATOR_PRESSURE_GAUGE: &str = "measured_regulator_pressure_gauge";
/// Speed of the arm's tool along its path, as the arm tells it.
pub const TOOL_SPEED: &str = "tool_speed";
/// Speed along its path that the arm is commanded.
pub const COMMANDED_TOOL_SPEED: &str = "commanded_tool_speed";
/// Contact force estimated without a load cell.
pub const ESTIMATED_FORCE: &str = "estimated_force";
/// Standard deviation that the estimator gives it.
pub const ESTIMATED_FORCE_DEVIATION: &str = "estimated_force_deviation";

/// The plot in which a signal is drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum PlotGroup {
    /// Contact force with its desired value and band.
    Force,
    /// Slide position with its end stops.
    Stroke,
    /// Pressures.
    Pressure,
    /// Distance from the planned path.
    PathError,
    /// Joint torques as a share of their limits.
    JointTorque,
    /// The force on the slide and the components of the contact force.
    ForceBalance,
}

/// One signal of the cell.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct SignalDefinition {
    /// Name without unit.
    pub quantity: &'static str,
    /// Unit.
    pub unit: Unit,
    /// The plot it is drawn in; `None` if it is stored only.
    pub group: Option<PlotGroup>,
    /// Name in the plot's legend.
    pub label: &'static str,
    /// Its meaning, in one sentence.
    pub meaning: &'static str,
}

const fn signal(
    quantity: &'static str,
    unit: Unit,
    group: Option<PlotGroup>,
    label: &'static str,
    meaning: &'static str,
) -> SignalDefinition {
    SignalDefinition {
        quantity,
        unit,
        group,
        label,
        meaning,
    }
}

/// Signals that exist once, in the order of the table's columns.
#[rustfmt::skip]
pub const SIGNALS: [SignalDefinition; 24] = [
    signal(PATH_LENGTH, Unit::Metre, None, "path length",
        "Length of planned path behind the tool."),
    signal(CONTACT_FORCE, Unit::Newton, Some(PlotGroup::Force), "contact force",
        "Force of the tool on the workpiece along the contact normal, positive when pressing."),
    signal(CONTACT_FORCE_PEAK, Unit::Newton, None, "contact force, largest",
        "Largest contact force since the sample before, as the contact is integrated between them."),
    signal(DESIRED_FORCE, Unit::Newton, Some(PlotGroup::Force), "desired force",
        "Contact force that the scenario asks for."),
    signal(CONTACT_FORCE_X, Unit::Newton, Some(PlotGroup::ForceBalance), "contact force x",
        "World x component of the force of the tool on the workpiece, friction included."),
    signal(CONTACT_FORCE_Y, Unit::Newton, Some(PlotGroup::ForceBalance), "contact force y",
        "World y component of the force of the tool on the workpiece, friction included."),
    signal(CONTACT_FORCE_Z, Unit::Newton, Some(PlotGroup::ForceBalance), "contact force z",
        "World z component of the force of the tool on the workpiece, friction included."),
    signal(FRICTION_FORCE, Unit::Newton, Some(PlotGroup::ForceBalance), "friction force",
        "Size of the part of the contact force that lies across the contact normal."),
    signal(DEVICE_FORCE, Unit::Newton, Some(PlotGroup::ForceBalance), "device force",
        "Force of the device on its moving part: air, end stops, and the clamp of a locked one; positive along extension."),
    signal(STROKE, Unit::Metre, Some(PlotGroup::Stroke), "stroke",
        "Position of the slide, zero when retracted, positive along extension."),
    signal(STROKE_VELOCITY, Unit::MetrePerSecond, None, "stroke velocity",
        "Velocity of the slide, positive along extension."),
    signal(CHAMBER_1_PRESSURE, Unit::Pascal, Some(PlotGroup::Pressure), "chamber 1",
        "Absolute pressure in the chamber that extends the slide."),
    signal(CHAMBER_2_PRESSURE, Unit::Pascal, Some(PlotGroup::Pressure), "chamber 2",
        "Absolute pressure in the chamber that retracts the slide."),
    signal(REGULATOR_PRESSURE, Unit::Pascal, Some(PlotGroup::Pressure), "regulator",
        "Absolute pressure at the regulator's outlet."),
    signal(SET_PRESSURE, Unit::Pascal, Some(PlotGroup::Pressure), "set",
        "Absolute pressure that the regulator is told to hold."),
    signal(CHAMBER_1_MASS, Unit::Kilogram, None, "air in chamber 1",
        "Mass of air in chamber 1."),
    signal(CHAMBER_2_MASS, Unit::Kilogram, None, "air in chamber 2",
        "Mass of air in chamber 2."),
    signal(HOSE_MASS, Unit::Kilogram, None, "air in the line",
        "Mass of air in the line between regulator and valve."),
    signal(MASS_ENTERED, Unit::Kilogram, None, "air entered",
        "Mass of air that has entered the chambers since the start."),
    signal(MASS_LEFT, Unit::Kilogram, None, "air left",
        "Mass of air that has left the chambers since the start."),
    signal(PATH_ERROR, Unit::Metre, Some(PlotGroup::PathError), "lateral",
        "Distance of the tool tip beside the planned path, across path and contact normal, positive to the left of travel."),
    signal(PATH_LAG, Unit::Metre, Some(PlotGroup::PathError), "lag",
        "Distance by which the tool tip lags behind the planned one along the path."),
    signal(PATH_ERROR_AXIAL, Unit::Metre, Some(PlotGroup::PathError), "axial",
        "Distance of the flange from its planned path along the tool's axis, positive towards the part."),
    signal(FEED, Unit::MetrePerSecond, None, "feed",
        "Speed of the tool along the edge."),
];

/// Signals of a tool that turns, recorded behind the sensors.
#[rustfmt::skip]
pub const CUTTING_SIGNALS: [SignalDefinition; 5] = [
    signal(CUTTING_SPEED, Unit::MetrePerSecond, None, "cutting speed",
        "Speed of the tool's surface where it touches."),
    signal(REMOVAL_RATE, Unit::CubicMetrePerSecond, None, "removal rate",
        "Volume that the tool takes off per time."),
    signal(SPINDLE_TORQUE, Unit::NewtonMetre, None, "spindle torque",
        "Torque of the tool's contact on its spindle."),
    signal(SPINDLE_POWER, Unit::Watt, None, "spindle power",
        "Power that the spindle gives at the tool."),
    signal(TOOL_WEAR, Unit::Joule, None, "tool wear",
        "Work of normal force and cutting speed that the tool has done."),
];

/// Sensors of a cell, recorded behind its signals.
pub const CELL_SENSORS: [&str; 3] = [MEASURED_REGULATOR_PRESSURE, MEASURED_STROKE, MEASURED_FORCE];

/// Signals that only a bench rig records, or sensors.
#[rustfmt::skip]
pub const BENCH_SIGNALS: [SignalDefinition; 13] = [
    signal(SEAL_FORCE, Unit::Newton, Some(PlotGroup::ForceBalance), "seal force",
        "Force of the device's seals on its moving part, positive along extension."),
    signal(ACCELERATION, Unit::MetrePerSecondSquared, None, "acceleration",
        "Acceleration of the slide, positive along extension."),
    signal(SURFACE_POSITION, Unit::Metre, Some(PlotGroup::Stroke), "surface",
        "Where the surface of the load stands along the stroke, from the retracted end."),
    signal(VALVE_EXTENDS, Unit::One, None, "valve extends",
        "1 while the 5/2 valve joins chamber 1 to the regulator, 0 while it joins chamber 2 to it."),
    signal(MEASURED_FORCE, Unit::Newton, Some(PlotGroup::Force), "measured",
        "Contact force as the load cell's software reads it, filtered."),
    signal(MEASURED_FORCE_UNFILTERED, Unit::Newton, Some(PlotGroup::Force), "measured, unfiltered",
        "Contact force as the load cell's software reads it, before its filter."),
    signal(MEASURED_STROKE, Unit::Metre, Some(PlotGroup::Stroke), "measured",
        "Stroke as the position sensor reads it."),
    signal(MEASURED_ACCELERATION, Unit::MetrePerSecondSquared, None, "measured acceleration",
        "Acceleration of the slide as the accelerometer reads it."),
    signal(MEASURED_REGULATOR_PRESSURE, Unit::Pascal, Some(PlotGroup::Pressure), "regulator, measured",
        "Absolute pressure at the regulator's outlet as its sensor reads it."),
    signal(SET_PRESSURE_GAUGE, Unit::Pascal, None, "set, gauge",
        "Gauge pressure that the regulator is told to hold, as a recording of a real rig has it."),
    signal(MEASURED_REGULATOR_PRESSURE_GAUGE, Unit::Pascal, None, "regulator, measured, gauge",
        "Gauge pressure at the regulator's outlet as its sensor reads it, as a recording of a real rig has it."),
    signal(ESTIMATED_FORCE, Unit::Newton, Some(PlotGroup::Force), "estimated",
        "Contact force estimated without a load cell, from regulator pressure, stroke and acceleration."),
    signal(ESTIMATED_FORCE_DEVIATION, Unit::Newton, None, "estimated, deviation",
        "Half the 95 % band of the estimated contact force over 1.96: its standard deviation, less where one tolerance prevails."),
];

/// A signal that every joint has.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum JointSignal {
    /// Measured angle.
    Position,
    /// Angle that the servo is told to hold.
    Reference,
    /// Measured angular velocity.
    Velocity,
    /// Torque of the drive.
    Torque,
    /// Reading of the encoder, on the motor's side.
    Encoder,
}

impl JointSignal {
    /// Every joint signal, in the order of the table's columns.
    pub const ALL: [Self; 5] = [
        Self::Position,
        Self::Reference,
        Self::Velocity,
        Self::Torque,
        Self::Encoder,
    ];

    /// The words behind the joint's number.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Position => "position",
            Self::Reference => "reference",
            Self::Velocity => "velocity",
            Self::Torque => "torque",
            Self::Encoder => "encoder",
        }
    }

    /// Its unit.
    #[must_use]
    pub const fn unit(self) -> Unit {
        match self {
            Self::Position | Self::Reference | Self::Encoder => Unit::Radian,
            Self::Velocity => Unit::RadianPerSecond,
            Self::Torque => Unit::NewtonMetre,
        }
    }

    /// Its meaning, in one sentence.
    #[must_use]
    pub const fn meaning(self) -> &'static str {
        match self {
            Self::Position => "Angle of the joint.",
            Self::Reference => "Angle that the joint's servo is told to hold.",
            Self::Velocity => "Angular velocity of the joint.",
            Self::Torque => "Torque of the joint's drive, gravity feed-forward included.",
            Self::Encoder => {
                "Angle that the joint's encoder reads, on the motor's side of its transmission."
            }
        }
    }
}

/// Name of a joint's signal; joints are counted from 1, base first: `joint_1_torque`.
#[must_use]
pub fn joint_quantity(joint: usize, signal: JointSignal) -> String {
    format!("joint_{joint}_{}", signal.name())
}

/// The joint (from 1) and signal of a name made by [`joint_quantity`].
#[must_use]
pub fn parse_joint_quantity(quantity: &str) -> Option<(usize, JointSignal)> {
    let (number, name) = quantity.strip_prefix("joint_")?.split_once('_')?;
    let joint: usize = number.parse().ok()?;
    let signal = JointSignal::ALL.into_iter().find(|s| s.name() == name)?;
    (joint_quantity(joint, signal) == quantity && joint > 0).then_some((joint, signal))
}

/// The definition of a signal that exists once.
#[must_use]
pub fn definition(quantity: &str) -> Option<&'static SignalDefinition> {
    SIGNALS
        .iter()
        .chain(&BENCH_SIGNALS)
        .chain(&CUTTING_SIGNALS)
        .find(|signal| signal.quantity == quantity)
}

/// Meaning of a quantity, in one sentence; `None` if the list does not know it.
#[must_use]
pub fn meaning(quantity: &str) -> Option<&'static str> {
    match quantity {
        TIME => Some("Time since the start of the run."),
        PHASE => Some("Name of the phase of the job."),
        _ => definition(quantity)
            .map(|signal| signal.meaning)
            .or_else(|| parse_joint_quantity(quantity).map(|(_, signal)| signal.meaning())),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::recording::{RecordedChannel, Recording};

    #[test]
    fn the_list_makes_a_recording() {
        let joint = (1..=7).flat_map(|joint| {
            JointSignal::ALL
                .map(|s| RecordedChannel::new(joint_quantity(joint, s), s.unit(), vec![0.0]))
        });
        let channels = SIGNALS
            .iter()
            .map(|s| RecordedChannel::new(s.quantity, s.unit, vec![0.0]))
            .chain(joint)
            .collect();
        let recording = Recording::new(vec![0.0], channels, vec![]).unwrap();
        for channel in recording.channels() {
            assert!(meaning(&channel.quantity).is_some(), "{}", channel.quantity);
        }
    }

    #[test]
    fn joint_names_read_back() {
        assert_eq!(joint_quantity(3, JointSignal::Torque), "joint_3_torque");
        assert_eq!(
            parse_joint_quantity("joint_12_reference"),
            Some((12, JointSignal::Reference))
        );
        for other in [
            "joint_0_torque",
            "joint_01_torque",
            "joint_1_power",
            "joint_1",
            "stroke",
        ] {
            assert_eq!(parse_joint_quantity(other), None, "{other}");
        }
    }
}
