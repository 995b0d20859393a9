//! The signals that the simulated cell records: names, units and meanings.
//!
//! This is the one list. A real recording that uses the same names is drawn and compared the same
//! way. In files a column is `<name>_<unit>` ([`crate::unit::column_name`]).

use super::Unit;
use crate::listed::listed;
use PlotGroup::{Force, ForceBalance, PathError, Pressure, Stroke};

/// Sample time; the recording's own column.
pub const TIME: &str = "time";
/// Name of the phase at each sample; the recording's own column, text.
pub const PHASE: &str = "phase";

/// Speed of the arm's tool along its path, as the arm tells it.
pub const TOOL_SPEED: &str = "tool_speed";
/// Speed along its path that the arm is commanded.
pub const COMMANDED_TOOL_SPEED: &str = "commanded_tool_speed";

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

/// Signals, each declared once: the constant of its name, and its row in a list.
macro_rules! signals {
    (
        $(#[$about:meta])* $list:ident: $count:literal;
        $($name:ident = $quantity:literal, $unit:ident, $group:expr, $label:literal, $meaning:literal;)*
    ) => {
        $(#[doc = $meaning] pub const $name: &str = $quantity;)*

        $(#[$about])*
        pub const $list: [SignalDefinition; $count] = [
            $(SignalDefinition { quantity: $quantity, unit: Unit::$unit, group: $group, label: $label, meaning: $meaning }),*
        ];
    };
}

signals! {
    /// Signals that exist once, in the order of the table's columns.
    SIGNALS: 24;
    PATH_LENGTH = "path_length", Metre, None, "path length", "Length of planned path behind the tool.";
    CONTACT_FORCE = "contact_force", Newton, Some(Force), "contact force",
        "Force of the tool on the workpiece along the contact normal, positive when pressing.";
    CONTACT_FORCE_PEAK = "contact_force_peak", Newton, None, "contact force, largest",
        "Largest contact force since the sample before, as the contact is integrated between them.";
    DESIRED_FORCE = "desired_force", Newton, Some(Force), "desired force", "Contact force that the scenario asks for.";
    CONTACT_FORCE_X = "contact_force_x", Newton, Some(ForceBalance), "contact force x",
        "World x component of the force of the tool on the workpiece, friction included.";
    CONTACT_FORCE_Y = "contact_force_y", Newton, Some(ForceBalance), "contact force y",
        "World y component of the force of the tool on the workpiece, friction included.";
    CONTACT_FORCE_Z = "contact_force_z", Newton, Some(ForceBalance), "contact force z",
        "World z component of the force of the tool on the workpiece, friction included.";
    FRICTION_FORCE = "friction_force", Newton, Some(ForceBalance), "friction force",
        "Size of the part of the contact force that lies across the contact normal.";
    DEVICE_FORCE = "device_force", Newton, Some(ForceBalance), "device force",
        "Force of the device on its moving part: air, end stops, and the clamp of a locked one; positive along extension.";
    STROKE = "stroke", Metre, Some(Stroke), "stroke", "Position of the slide, zero when retracted, positive along extension.";
    STROKE_VELOCITY = "stroke_velocity", MetrePerSecond, None, "stroke velocity", "Velocity of the slide, positive along extension.";
    CHAMBER_1_PRESSURE = "chamber_1_pressure", Pascal, Some(Pressure), "chamber 1", "Absolute pressure in the chamber that extends the slide.";
    CHAMBER_2_PRESSURE = "chamber_2_pressure", Pascal, Some(Pressure), "chamber 2", "Absolute pressure in the chamber that retracts the slide.";
    REGULATOR_PRESSURE = "regulator_pressure", Pascal, Some(Pressure), "regulator", "Absolute pressure at the regulator's outlet.";
    SET_PRESSURE = "set_pressure", Pascal, Some(Pressure), "set", "Set pressure of the regulator, absolute.";
    CHAMBER_1_MASS = "chamber_1_mass", Kilogram, None, "air in chamber 1", "Mass of air in chamber 1.";
    CHAMBER_2_MASS = "chamber_2_mass", Kilogram, None, "air in chamber 2", "Mass of air in chamber 2.";
    HOSE_MASS = "hose_mass", Kilogram, None, "air in the line", "Mass of air in the line between regulator and valve.";
    MASS_ENTERED = "mass_entered", Kilogram, None, "air entered", "Mass of air that has entered the chambers since the start.";
    MASS_LEFT = "mass_left", Kilogram, None, "air left", "Mass of air that has left the chambers since the start.";
    PATH_ERROR = "path_error", Metre, Some(PathError), "lateral",
        "Distance of the tool tip beside the planned path, across path and contact normal, positive to the left of travel.";
    PATH_LAG = "path_lag", Metre, Some(PathError), "lag", "Distance by which the tool tip lags behind the planned one along the path.";
    PATH_ERROR_AXIAL = "path_error_axial", Metre, Some(PathError), "axial",
        "Distance of the flange from its planned path along the tool's axis, positive towards the part.";
    FEED = "feed", MetrePerSecond, None, "feed", "Speed of the tool along the edge.";
}

signals! {
    /// Signals of a tool that turns, recorded behind the sensors.
    CUTTING_SIGNALS: 5;
    CUTTING_SPEED = "cutting_speed", MetrePerSecond, None, "cutting speed", "Speed of the tool's surface where it touches.";
    REMOVAL_RATE = "removal_rate", CubicMetrePerSecond, None, "removal rate", "Volume that the tool takes off per time.";
    SPINDLE_TORQUE = "spindle_torque", NewtonMetre, None, "spindle torque", "Torque of the tool's contact on its spindle.";
    SPINDLE_POWER = "spindle_power", Watt, None, "spindle power", "Power that the spindle gives at the tool.";
    TOOL_WEAR = "tool_wear", Joule, None, "tool wear", "Work of normal force and cutting speed that the tool has done.";
}

/// Sensors of a cell, recorded behind its signals.
pub const CELL_SENSORS: [&str; 3] = [MEASURED_REGULATOR_PRESSURE, MEASURED_STROKE, MEASURED_FORCE];

signals! {
    /// Signals that only a bench rig records, or sensors.
    BENCH_SIGNALS: 13;
    SEAL_FORCE = "seal_force", Newton, Some(ForceBalance), "seal force", "Force of the device's seals on its moving part, positive along extension.";
    ACCELERATION = "acceleration", MetrePerSecondSquared, None, "acceleration", "Acceleration of the slide, positive along extension.";
    SURFACE_POSITION = "surface_position", Metre, Some(Stroke), "surface", "Where the surface of the load stands along the stroke, from the retracted end.";
    VALVE_EXTENDS = "valve_extends", One, None, "valve extends", "1 while the 5/2 valve joins chamber 1 to the regulator, 0 while it joins chamber 2 to it.";
    MEASURED_FORCE = "measured_force", Newton, Some(Force), "measured", "Contact force as the load cell's software reads it, filtered.";
    MEASURED_FORCE_UNFILTERED = "measured_force_unfiltered", Newton, Some(Force), "measured, unfiltered",
        "Contact force as the load cell's software reads it, before its filter.";
    MEASURED_STROKE = "measured_stroke", Metre, Some(Stroke), "measured", "Stroke as the position sensor reads it.";
    MEASURED_ACCELERATION = "measured_acceleration", MetrePerSecondSquared, None, "measured acceleration",
        "Acceleration of the slide as the accelerometer reads it.";
    MEASURED_REGULATOR_PRESSURE = "measured_regulator_pressure", Pascal, Some(Pressure), "regulator, measured",
        "Absolute pressure at the regulator's outlet as its sensor reads it.";
    SET_PRESSURE_GAUGE = "set_pressure_gauge", Pascal, None, "set, gauge",
        "Set pressure of the regulator, gauge, as a recording of a real rig has it.";
    MEASURED_REGULATOR_PRESSURE_GAUGE = "measured_regulator_pressure_gauge", Pascal, None, "regulator, measured, gauge",
        "Gauge pressure at the regulator's outlet as its sensor reads it, as a recording of a real rig has it.";
    ESTIMATED_FORCE = "estimated_force", Newton, Some(Force), "estimated",
        "Contact force estimated without a load cell, from regulator pressure, stroke and acceleration.";
    ESTIMATED_FORCE_DEVIATION = "estimated_force_deviation", Newton, None, "estimated, deviation",
        "Half the 95 % band of the estimated contact force over 1.96: its standard deviation, less where one tolerance prevails.";
}

listed! {
    /// A signal that every joint has.
    #[derive(Debug, Clone, Copy, PartialEq, Eq)]
    pub enum JointSignal: 5,
    /// The words behind the joint's number.
    name: &'static str {
        /// Measured angle.
        Position = "position",
        /// Commanded angle of the servo.
        Reference = "reference",
        /// Measured angular velocity.
        Velocity = "velocity",
        /// Torque of the drive.
        Torque = "torque",
        /// Reading of the encoder, on the motor's side.
        Encoder = "encoder",
    }
}

impl JointSignal {
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
            Self::Reference => "Commanded angle of the joint's servo.",
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

/// What an arm's drive reads.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum DriveReading {
    /// Current.
    Current,
    /// Torque; that of the simulated servo is [`JointSignal::Torque`].
    Torque,
}

impl DriveReading {
    const ALL: [Self; 2] = [Self::Current, Self::Torque];

    /// The words behind the joint's number.
    const fn name(self) -> &'static str {
        match self {
            Self::Current => "current",
            Self::Torque => "drive_torque",
        }
    }

    /// Its unit.
    #[must_use]
    pub const fn unit(self) -> Unit {
        match self {
            Self::Current => Unit::Ampere,
            Self::Torque => Unit::NewtonMetre,
        }
    }

    /// Its meaning, in one sentence.
    const fn meaning(self) -> &'static str {
        match self {
            Self::Current => "Current of the joint's drive as it is read, by the cell's arm file.",
            Self::Torque => "Torque of the joint's drive as it is read, by the cell's arm file.",
        }
    }
}

/// Name of a drive's reading; joints are counted from 1, base first: `joint_1_current`.
#[must_use]
pub fn drive_quantity(joint: usize, reading: DriveReading) -> String {
    format!("joint_{joint}_{}", reading.name())
}

/// What a name made by [`drive_quantity`] reads.
fn drive_reading(quantity: &str) -> Option<DriveReading> {
    let (number, name) = quantity.strip_prefix("joint_")?.split_once('_')?;
    number.parse::<usize>().ok()?;
    DriveReading::ALL.into_iter().find(|r| r.name() == name)
}

/// Name of a reading of a wrench sensor's channel, as in `wrench_force_x`.
#[must_use]
pub fn wrench_quantity(channel: &str) -> String {
    format!("{WRENCH}{channel}")
}

const WRENCH: &str = "wrench_";

/// A joint's name as names of quantities have it: small letters, digits and underscores.
#[must_use]
pub fn plain_joint(joint: &str) -> String {
    let plain = |c: char| match c.is_ascii_alphanumeric() {
        true => c.to_ascii_lowercase(),
        false => '_',
    };
    joint.chars().map(plain).collect()
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
            .or_else(|| parse_joint_quantity(quantity).map(|(_, signal)| signal.meaning()))
            .or_else(|| drive_reading(quantity).map(DriveReading::meaning))
            .or_else(|| {
                let of_wrench = quantity.starts_with(WRENCH);
                of_wrench.then_some("Channel of the arm's wrench sensor as it is read, raw.")
            }),
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
