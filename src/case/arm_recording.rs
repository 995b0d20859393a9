//! A log of a recorded arm, read: which joint and which sensor each column is of, and what cannot be a log of that arm.

use std::path::{Path, PathBuf};

use super::error::CaseError;
use crate::arm::JointKind;
use crate::diagnosis::arm::input::ArmRecording;
use crate::recorded_arm::motion::{Motion, cut_off_for};
use crate::recorded_arm::simulate::Channel;
use crate::recorded_arm::wrench::CHANNELS as WRENCH;
use crate::recording::RecordingError;
use crate::recording::csv::Log;
use crate::recording::log::read_log;
use crate::recording::samples::rows;
use crate::recording::schema::plain_joint;
use crate::scenario::arm_file::ArmFile;

/// Samples below which a log carries no information on drives.
const LEAST_SAMPLES: usize = 100;
/// Samples below which postures carry no information on a wrench sensor.
const LEAST_POSTURES: usize = 4;
/// Times that a joint's limits are exceeded from which its angles are in degrees [1].
const DEGREES: f64 = 3.0;
/// Largest angle of a joint without limits: more than that are degrees [rad].
const ENDLESS: f64 = 60.0;

/// What a column is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Signal {
    Command,
    Position,
    Speed,
    Current,
    Torque,
    Link,
}

/// Ends of columns of a joint, of a prismatic one too.
const SIGNALS: [(&str, Signal); 11] = [
    ("command_rad", Signal::Command),
    ("command_m", Signal::Command),
    ("rad_per_s", Signal::Speed),
    ("m_per_s", Signal::Speed),
    ("link_rad", Signal::Link),
    ("link_m", Signal::Link),
    ("current_a", Signal::Current),
    ("torque_n_m", Signal::Torque),
    ("force_n", Signal::Torque),
    ("rad", Signal::Position),
    ("m", Signal::Position),
];
/// Ends as an import writes them, and the usual ones.
const IMPORTED: [(&str, &str); 5] = [
    ("drive_torque_n_m", "torque_n_m"),
    ("encoder_rad", "rad"),
    ("position_rad", "rad"),
    ("reference_rad", "command_rad"),
    ("velocity_rad_per_s", "rad_per_s"),
];

/// Ends of columns of a run that say how something is, beside those that say how a sensor reads it.
const TRUTHS: [(&str, &str); 2] = [
    ("position_rad", "encoder_rad"),
    ("torque_n_m", "drive_torque_n_m"),
];

/// Leaves out what no sensor read where a sensor read the same.
fn leave_out_truths(columns: &mut Vec<(String, Vec<f64>)>) {
    let names: Vec<String> = columns.iter().map(|(name, _)| name.clone()).collect();
    columns.retain(|(name, _)| {
        let is_read = |(truth, read): &(&str, &str)| {
            let joint = name
                .strip_suffix(truth)
                .filter(|joint| joint.ends_with('_'));
            joint.is_some_and(|joint| {
                !name.ends_with(read) && names.contains(&format!("{joint}{read}"))
            })
        };
        !TRUTHS.iter().any(is_read)
    });
}

/// The joint of a column, by its number or by its name among `joints`, and the column's usual end.
fn joint_and_end<'a>(
    joints: impl IntoIterator<Item = (usize, &'a str)>,
    column: &str,
) -> Option<(usize, &'static str)> {
    let usual = |rest: &str| {
        let imported = IMPORTED.iter().find(|(end, _)| *end == rest);
        let rest = imported.map_or(rest, |(_, usual)| usual);
        let found = SIGNALS.iter().find(|(end, _)| *end == rest);
        found.map(|(end, _)| *end)
    };
    if let Some(rest) = column.strip_prefix("joint_")
        && let Some((number, rest)) = rest.split_once('_')
        && let Ok(number) = number.parse()
    {
        return Some((number, usual(rest)?));
    }
    let mut named = joints.into_iter().filter_map(|(number, name)| {
        let plain = plain_joint(name);
        let rest = column.strip_prefix(name);
        let rest = rest.or_else(|| column.strip_prefix(plain.as_str()))?;
        Some((number, usual(rest.strip_prefix('_')?)?))
    });
    named.next()
}

/// Which joint, by its number in columns, what of it, and the usual name of such a column.
fn joint_signal(arm: &ArmFile, column: &str) -> Option<(usize, Signal, String)> {
    let names = arm.nominal.chain.joints.iter().map(|j| j.name.as_str());
    let joints = arm.numbers.iter().copied().zip(names);
    let (number, end) = joint_and_end(joints, column)?;
    let (_, signal) = SIGNALS.iter().find(|(own, _)| *own == end)?;
    Some((number, *signal, format!("joint_{number}_{end}")))
}

/// The usual name of a joint's column, `joint_2_rad`, whatever calls the joint: its number or its name, of joints that are counted from 1.
#[must_use]
pub fn usual_column(joints: &[&str], column: &str) -> Option<String> {
    let counted = joints.iter().enumerate();
    let counted = counted.map(|(index, name)| (index + 1, *name));
    let (number, end) = joint_and_end(counted, column)?;
    Some(format!("joint_{number}_{end}"))
}

/// Column of a channel of a wrench sensor.
fn wrench_column(channel: usize) -> String {
    let unit = if channel < 3 { "n" } else { "n_m" };
    format!("wrench_{}_{unit}", WRENCH[channel])
}

/// The usual column of a channel.
pub(super) fn column_of(arm: &ArmFile, channel: Channel) -> String {
    match channel {
        Channel::Drive(joint) => {
            let is_prismatic = arm.nominal.chain.joints[joint].kind == JointKind::Prismatic;
            let what = match (arm.nominal.drives[joint].logs_current, is_prismatic) {
                (true, _) => "current_a",
                (false, false) => "torque_n_m",
                (false, true) => "force_n",
            };
            format!("joint_{}_{what}", arm.numbers[joint])
        }
        Channel::Link(joint) => match arm.nominal.chain.joints[joint].kind {
            JointKind::Prismatic => format!("joint_{}_link_m", arm.numbers[joint]),
            JointKind::Revolute => format!("joint_{}_link_rad", arm.numbers[joint]),
        },
        Channel::Wrench(channel) => wrench_column(channel),
    }
}

/// A log with its columns sorted.
pub(super) struct ArmLog {
    /// Its file.
    path: PathBuf,
    /// Its name.
    name: String,
    log: Log,
    /// Positions by joint, base first.
    positions: Vec<Vec<f64>>,
    /// Readings by channel, with the name of its column.
    pub channels: Vec<(Channel, String, Vec<f64>)>,
}

/// Reads a log of an arm.
pub(super) fn read(arm: &ArmFile, folder: &Path, name: &str) -> Result<ArmLog, CaseError> {
    read_log_of(arm, &folder.join(name), name)
}

/// Reads a log of an arm from a file, with a name for people.
pub(super) fn read_log_of(arm: &ArmFile, path: &Path, name: &str) -> Result<ArmLog, CaseError> {
    let path = path.to_owned();
    let wrench: Vec<String> = (0..WRENCH.len()).map(wrench_column).collect();
    let of_wrench = |column: &str| wrench.iter().position(|own| own == column);
    let wanted = |column: &str| joint_signal(arm, column).is_some() || of_wrench(column).is_some();
    let mut log = read_log(&path, wanted)?;
    leave_out_truths(&mut log.columns);
    let count = arm.numbers.len();
    let mut positions = vec![None; count];
    let mut channels = Vec::new();
    for (column, values) in std::mem::take(&mut log.columns) {
        let Some((number, signal, usual)) = joint_signal(arm, &column) else {
            let channel = of_wrench(&column).filter(|_| arm.nominal.wrench.is_some());
            match channel {
                Some(channel) => channels.push((Channel::Wrench(channel), column, values)),
                None => log.ignored.push(column),
            }
            continue;
        };
        let Some(joint) = arm.numbers.iter().position(|own| *own == number) else {
            let found = format!("of joint {number}");
            let file = arm.path.display();
            let expected = format!("columns of joints 1 to {count}, the drives of {file}");
            return Err(column_error(&path, &column, found, expected));
        };
        let drive = &arm.nominal.drives[joint];
        match signal {
            Signal::Command | Signal::Speed => {}
            Signal::Position if positions[joint].is_some() => {
                let found = format!("a second position of joint {number}");
                return Err(column_error(
                    &path,
                    &column,
                    found,
                    "one of each".to_owned(),
                ));
            }
            Signal::Position => positions[joint] = Some(values),
            Signal::Link => channels.push((Channel::Link(joint), usual, values)),
            Signal::Current if drive.logs_current => {
                channels.push((Channel::Drive(joint), usual, values));
            }
            Signal::Torque if !drive.logs_current => {
                channels.push((Channel::Drive(joint), usual, values));
            }
            Signal::Current => {
                let found = "there, and its drive has no gain".to_owned();
                let expected = format!(
                    "`gain_n_m_per_a` of joint {number} in {}, or a column of its torque",
                    arm.path.display()
                );
                return Err(column_error(&path, &column, found, expected));
            }
            // Where currents are logged too, torques are what a controller made of them.
            Signal::Torque => log.ignored.push(column),
        }
    }
    check_torques(arm, &path, &log, &channels)?;
    let found = all_positions(arm, &path, positions, &log)?;
    channels.sort_by_key(|(channel, ..)| *channel);
    Ok(ArmLog {
        path,
        name: name.to_owned(),
        log,
        positions: found,
        channels,
    })
}

/// Positions of all joints, base first; refused where one is missing or no position of it.
fn all_positions(
    arm: &ArmFile,
    path: &Path,
    positions: Vec<Option<Vec<f64>>>,
    log: &Log,
) -> Result<Vec<Vec<f64>>, CaseError> {
    let count = positions.len();
    let mut found = Vec::with_capacity(count);
    for (joint, values) in positions.into_iter().enumerate() {
        let unit = match arm.nominal.chain.joints[joint].kind {
            JointKind::Revolute => "rad",
            JointKind::Prismatic => "m",
        };
        let column = format!("joint_{}_{unit}", arm.numbers[joint]);
        let Some(values) = values else {
            let expected = format!("it: positions of all {count} joints are inputs");
            let found = match stray_position(&log.ignored) {
                Some(other) => format!(
                    "missing, and `{other}` is of no joint of {}, whose joints are {}",
                    arm.urdf.display(),
                    names_of(arm)
                ),
                None => "missing".to_owned(),
            };
            return Err(column_error(path, &column, found, expected));
        };
        check_positions(arm, (path, &column), joint, &values, &log.lines)?;
        found.push(values);
    }
    Ok(found)
}

/// The first column that is an angle of something that is no joint.
fn stray_position(ignored: &[String]) -> Option<&String> {
    let mut all = ignored.iter();
    all.find(|column| column.ends_with("_rad") && !column.ends_with("_command_rad"))
}

/// Joints of the arm, base first.
fn names_of(arm: &ArmFile) -> String {
    let joints = arm.nominal.chain.joints.iter();
    joints
        .map(|j| j.name.as_str())
        .collect::<Vec<_>>()
        .join(", ")
}

fn column_error(path: &Path, column: &str, found: String, expected: String) -> CaseError {
    CaseError::Recording(RecordingError::Column {
        path: path.to_owned(),
        column: column.to_owned(),
        found,
        expected,
    })
}

/// Refuses torques of drives whose currents are expected.
fn check_torques(
    arm: &ArmFile,
    path: &Path,
    log: &Log,
    channels: &[(Channel, String, Vec<f64>)],
) -> Result<(), CaseError> {
    let torque = log.ignored.iter().find_map(|column| {
        let (number, signal, _) = joint_signal(arm, column)?;
        (signal == Signal::Torque).then_some((column, number))
    });
    let Some((column, number)) = torque else {
        return Ok(());
    };
    let joint = arm.numbers.iter().position(|own| *own == number);
    let has_current = |joint| {
        let mut channels = channels.iter();
        channels.any(|(channel, ..)| *channel == Channel::Drive(joint))
    };
    if joint.is_some_and(has_current) {
        return Ok(());
    }
    let found = format!("there, and no current of joint {number}");
    let expected = format!(
        "joint_{number}_current_a, as its drive in {} has `gain_n_m_per_a`; without that key torques are taken",
        arm.path.display()
    );
    Err(column_error(path, column, found, expected))
}

fn check_positions(
    arm: &ArmFile,
    (path, column): (&Path, &str),
    joint: usize,
    values: &[f64],
    lines: &[u64],
) -> Result<(), CaseError> {
    if let Some(index) = values.iter().position(|value| value.is_nan()) {
        return Err(CaseError::Recording(RecordingError::Line {
            path: path.to_owned(),
            line: lines[index],
            column: column.to_owned(),
            found: "empty".to_owned(),
            expected: "a position at each stamp".to_owned(),
        }));
    }
    let own = &arm.nominal.chain.joints[joint];
    let limit = own.lower.abs().max(own.upper.abs());
    let (most, unit) = match (own.kind, limit.is_finite()) {
        (JointKind::Revolute, true) => (DEGREES * limit.max(1.0), "rad"),
        (JointKind::Revolute, false) => (ENDLESS, "rad"),
        (JointKind::Prismatic, true) => (DEGREES * limit, "m"),
        (JointKind::Prismatic, false) => (f64::INFINITY, "m"),
    };
    let Some(index) = values.iter().position(|value| value.abs() > most) else {
        return Ok(());
    };
    let other = if unit == "rad" { "degrees" } else { "mm" };
    let limits = match limit.is_finite() {
        true => format!(
            "{} to {} {unit}, the limits of the URDF",
            own.lower, own.upper
        ),
        false => format!("an angle in {unit}"),
    };
    Err(CaseError::Recording(RecordingError::Line {
        path: path.to_owned(),
        line: lines[index],
        column: column.to_owned(),
        found: format!("{} {unit}", values[index]),
        expected: format!("{limits}; it looks like {other}: give {unit}"),
    }))
}

impl ArmLog {
    /// Refuses a log that is too short to be diagnosed from.
    pub fn check_length(&self) -> Result<(), CaseError> {
        let is_drive = |(channel, ..): &(Channel, String, Vec<f64>)| {
            matches!(channel, Channel::Drive(_) | Channel::Link(_))
        };
        let least = match self.channels.iter().any(is_drive) {
            true => LEAST_SAMPLES,
            false => LEAST_POSTURES,
        };
        if self.log.time.len() < least {
            return Err(CaseError::ShortLog {
                file: self.path.display().to_string(),
                found: self.log.time.len(),
                least,
            });
        }
        Ok(())
    }

    /// Whether joints move, and whether one of them turns back: a log without that is shorter than a period of its motion.
    pub fn moves_and_returns(&self) -> (bool, bool) {
        /// Way that is motion and not noise, in a joint [rad or m].
        const WAY: f64 = 0.02;
        let mut both = (false, false);
        for values in &self.positions {
            // The extreme since the last turn, which a way back beyond noise ends.
            let (mut extreme, mut direction) = (values[0], 0.0);
            for value in values {
                let on = (value - extreme) * direction;
                if direction == 0.0 && (value - extreme).abs() > WAY {
                    (both.0, direction) = (true, (value - extreme).signum());
                    extreme = *value;
                } else if direction != 0.0 && on > 0.0 {
                    extreme = *value;
                } else if direction != 0.0 && on < -WAY * direction.abs() {
                    both.1 = true;
                }
            }
        }
        both
    }

    /// The rows at which sensors that are read so often [Hz] were read; between them a run repeats readings.
    pub fn read_at(mut self, rate: f64) -> Self {
        let rows = rows(&self.log.time, rate);
        let taken = |values: &mut Vec<f64>| *values = rows.iter().map(|r| values[*r]).collect();
        let channels = self.channels.iter_mut().map(|(_, _, values)| values);
        (self.positions.iter_mut().chain(channels)).for_each(taken);
        self.log.time = rows.iter().map(|row| self.log.time[*row]).collect();
        self.log.lines = rows.iter().map(|row| self.log.lines[*row]).collect();
        self
    }

    /// Its name.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Its file.
    pub fn file(&self) -> String {
        self.path.display().to_string()
    }

    /// Remarks on what was left out.
    pub fn notes(&self) -> Vec<String> {
        let name = &self.name;
        let mut notes = Vec::new();
        if let Some(first) = self.log.repeated.first() {
            let count = self.log.repeated.len();
            notes.push(format!(
                "{name} repeats stamps: {count} of its lines, the first line {first}, were left out"
            ));
        }
        if !self.log.ignored.is_empty() {
            let ignored = self.log.ignored.join(", ");
            notes.push(format!("{name}: columns that are not used: {ignored}"));
        }
        notes
    }

    /// As a recording with readings of channels; `index` counts the recordings.
    pub fn recording(&self, index: usize, channels: &[Channel]) -> ArmRecording {
        let readings = channels.iter().map(|channel| {
            let own = self.channels.iter().find(|(own, ..)| own == channel);
            own.map_or_else(
                || vec![f64::NAN; self.log.time.len()],
                |(_, _, values)| values.clone(),
            )
        });
        ArmRecording {
            name: self.name.clone(),
            motion: Motion::of_positions(
                index,
                &self.log.time,
                &self.positions,
                cut_off_for(&self.log.time, &self.positions),
            ),
            readings: readings.collect(),
        }
    }
}
