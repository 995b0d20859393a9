//! Recordings as messages of ROS 2 in an MCAP: `recording.mcap`, for Foxglove, `ros2 bag` and `idc import`.
//!
//! ```text
//! /joint_states       sensor_msgs/msg/JointState       positions, speeds and torques of all joints, base first
//! /contact_wrench     geometry_msgs/msg/WrenchStamped  force of the tool on the part, in the world; /wrench: what the arm's wrench sensor reads
//! /pressures/NAME     sensor_msgs/msg/FluidPressure    absolute pressures
//! /signals/NAME       std_msgs/msg/Float64             every other channel
//! /phases             JSON                             each phase at its start
//! ```
//!
//! A message a sample and topic, logged at the sample's time to 1 ns. What has no value is NaN. The metadata of a topic's channel hold `unit`, `meaning` and, in
//! `idc_columns`, which field is which channel, by the name that it has in a table: a reader needs no list of its own. Equal recordings give equal bytes.

use std::collections::{BTreeMap, BTreeSet};
use std::io::Write as _;
use std::path::Path;

use serde::{Deserialize, Serialize};

use super::atomic::write_atomic;
use super::schema::{self, JointSignal, joint_quantity, wrench_quantity};
use super::{PhaseSpan, RecordedChannel, Recording, RecordingError, Unit};
use crate::ros_bag::{BagError, BagFile, Coded, Packing, TopicId};
use crate::unit::column_name;

/// Version of the layout, raised when a reader of the old one would misread the new one.
pub const LAYOUT_VERSION: &str = "1";
/// Keys of a channel's metadata.
pub const LAYOUT_KEY: &str = "idc_layout_version";
/// See [`FieldColumn`].
pub const COLUMNS_KEY: &str = "idc_columns";
/// Topic of the phases.
pub const PHASES: &str = "/phases";
const NOTE: &str = "idc";

const STATES: [JointSignal; 3] = [
    JointSignal::Position,
    JointSignal::Velocity,
    JointSignal::Torque,
];
/// Their lists in a JointState.
const LISTS: [&str; 3] = ["position", "velocity", "effort"];
/// Components of a wrench, as a sensor's channels and as fields of a message.
const COMPONENTS: [(&str, &str); 6] = [
    ("force_x", "wrench.force.x"),
    ("force_y", "wrench.force.y"),
    ("force_z", "wrench.force.z"),
    ("torque_x", "wrench.torque.x"),
    ("torque_y", "wrench.torque.y"),
    ("torque_z", "wrench.torque.z"),
];

/// A channel of the recording as a field of a topic's messages.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct FieldColumn {
    /// Its name as a column of a table, with its unit: `joint_1_position_rad`.
    pub column: String,
    /// The field: `position[0]`.
    pub field: String,
    /// Its place among the recording's channels, from 0.
    pub place: usize,
}

/// A phase as its message has it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct PhaseMessage {
    /// Its name.
    pub name: String,
    /// Its start [s].
    pub start_s: f64,
    /// Its end [s].
    pub end_s: f64,
}

/// A time as a stamp [ns].
#[must_use]
pub fn nanoseconds(time: f64) -> u64 {
    (1e9 * time).round() as u64
}

/// Writes a recording as an MCAP. `joints` are the names of the arm's joints, base first; one without gets `joint_1`. `about` is kept beside the signals.
///
/// # Errors
/// [`RecordingError::Write`] if the file cannot be written, or times are negative or within a nanosecond of each other; nothing is left then.
pub fn write_bag(
    path: &Path,
    recording: &Recording,
    joints: &[String],
    about: &BTreeMap<String, String>,
) -> Result<(), RecordingError> {
    check_times(recording).map_err(|cause| RecordingError::write(path, cause))?;
    let bytes = bytes(recording, joints, about).map_err(|e| RecordingError::write(path, e))?;
    write_atomic(path, |file| file.write_all(&bytes))
}

fn bytes(
    recording: &Recording,
    joints: &[String],
    about: &BTreeMap<String, String>,
) -> Result<Vec<u8>, BagError> {
    let mut file = BagFile::begin(Packing::Zstd)?;
    let layout = (LAYOUT_KEY.to_owned(), LAYOUT_VERSION.to_owned());
    let mut about = about.clone();
    about.extend([layout]);
    file.note(NOTE, &about)?;
    write_messages(&mut file, recording, &topics(recording, joints))?;
    file.finish()
}

/// Refuses times that a log of nanoseconds cannot tell apart.
fn check_times(recording: &Recording) -> Result<(), String> {
    let starts = recording.phases().iter().map(|phase| phase.start);
    let first = starts.chain(recording.time().first().copied());
    if let Some(time) = first.into_iter().find(|time| *time < 0.0) {
        return Err(format!("the time {time} s is negative, and MCAP has none"));
    }
    let same = |pair: &&[f64]| nanoseconds(pair[0]) == nanoseconds(pair[1]);
    match recording.time().windows(2).find(same) {
        Some(pair) => Err(format!(
            "the times {} and {} s are less than 1 ns apart, and MCAP has no finer ones",
            pair[0], pair[1]
        )),
        None => Ok(()),
    }
}

/// What a topic's messages are made of.
enum Content<'a> {
    /// Joints by name; of each list one channel a joint, or none.
    Joints(Vec<String>, [Vec<&'a RecordedChannel>; 3]),
    /// A frame, and a channel for each component that was recorded.
    Wrench(&'static str, [Option<&'a RecordedChannel>; 6]),
    /// An absolute pressure.
    Pressure(&'a RecordedChannel),
    /// Any other.
    Number(&'a RecordedChannel),
}

/// A topic.
struct Topic<'a> {
    name: String,
    content: Content<'a>,
    metadata: BTreeMap<String, String>,
}

impl Content<'_> {
    /// The type of its messages.
    fn kind(&self) -> &'static str {
        match self {
            Self::Joints(..) => "sensor_msgs/msg/JointState",
            Self::Wrench(..) => "geometry_msgs/msg/WrenchStamped",
            Self::Pressure(_) => "sensor_msgs/msg/FluidPressure",
            Self::Number(_) => "std_msgs/msg/Float64",
        }
    }

    /// Its channels with their fields.
    fn fields(&self) -> Vec<(&RecordedChannel, String)> {
        match self {
            Self::Joints(_, lists) => {
                let mut all = Vec::new();
                for (list, own) in lists.iter().zip(LISTS) {
                    for (index, channel) in list.iter().enumerate() {
                        all.push((*channel, format!("{own}[{index}]")));
                    }
                }
                all
            }
            Self::Wrench(_, channels) => {
                let pairs = channels.iter().zip(COMPONENTS);
                pairs
                    .filter_map(|(channel, (_, field))| Some(((*channel)?, field.to_owned())))
                    .collect()
            }
            Self::Pressure(channel) => vec![(channel, "fluid_pressure".to_owned())],
            Self::Number(channel) => vec![(channel, "data".to_owned())],
        }
    }

    /// What is said of it.
    fn meaning(&self) -> Option<String> {
        let own = |channel: &RecordedChannel| Some(schema::meaning(&channel.quantity)?.to_owned());
        match self {
            Self::Joints(..) => Some(
                "Positions and speeds of the arm's joints, and torques of their drives.".to_owned(),
            ),
            Self::Wrench(frame, _) if *frame == WORLD => Some(
                "Force of the tool on the workpiece, friction included, in the world's axes."
                    .to_owned(),
            ),
            Self::Wrench(..) => Some("Readings of the arm's wrench sensor, raw.".to_owned()),
            Self::Pressure(channel) | Self::Number(channel) => own(channel),
        }
    }

    /// Codes the message of a sample.
    fn code(&self, coded: &mut Coded, time: u64, sample: usize) {
        coded.clear();
        let head = |coded: &mut Coded, frame: &str| {
            coded.time(time);
            coded.text(frame);
        };
        match self {
            Self::Joints(names, lists) => {
                head(coded, "");
                coded.count(names.len());
                for name in names {
                    coded.text(name);
                }
                for list in lists {
                    coded.numbers(list.iter().map(|channel| channel.values[sample]));
                }
            }
            Self::Wrench(frame, channels) => {
                head(coded, frame);
                for channel in channels {
                    coded.number(channel.map_or(f64::NAN, |channel| channel.values[sample]));
                }
            }
            Self::Pressure(channel) => {
                head(coded, "");
                coded.number(channel.values[sample]);
                // A variance that is not known.
                coded.number(0.0);
            }
            Self::Number(channel) => coded.number(channel.values[sample]),
        }
    }
}

const WORLD: &str = "world";

/// The channels of a recording, each in one topic.
fn topics<'a>(recording: &'a Recording, joints: &[String]) -> Vec<Topic<'a>> {
    let find = |quantity: String, unit: Unit| {
        let found = recording.channel(&quantity);
        found.filter(|channel| channel.unit == unit)
    };
    let mut contents: Vec<Content<'a>> = Vec::new();
    let of_joint =
        |joint: usize, signal: JointSignal| find(joint_quantity(joint, signal), signal.unit());
    let count = (1..=recording.channels().len())
        .take_while(|joint| of_joint(*joint, JointSignal::Position).is_some())
        .count();
    if count > 0 {
        let list = |signal| {
            let list: Option<Vec<_>> = (1..=count).map(|joint| of_joint(joint, signal)).collect();
            list.unwrap_or_default()
        };
        let name = |joint: usize| match joints.get(joint) {
            Some(name) => name.clone(),
            None => format!("joint_{}", joint + 1),
        };
        contents.push(Content::Joints(
            (0..count).map(name).collect(),
            STATES.map(list),
        ));
    }
    let component = |name: &str| match name.starts_with("torque") {
        true => Unit::NewtonMetre,
        false => Unit::Newton,
    };
    let contact = |(name, _): (&str, &str)| find(format!("contact_{name}"), component(name));
    let sensor = |(name, _): (&str, &str)| find(wrench_quantity(name), component(name));
    for (frame, channels) in [
        (WORLD, COMPONENTS.map(contact)),
        ("wrench_sensor", COMPONENTS.map(sensor)),
    ] {
        if channels.iter().any(Option::is_some) {
            contents.push(Content::Wrench(frame, channels));
        }
    }
    let taken: BTreeSet<&str> = (contents.iter().flat_map(Content::fields))
        .map(|(channel, _)| channel.quantity.as_str())
        .collect();
    let alone = |channel: &&RecordedChannel| !taken.contains(channel.quantity.as_str());
    let alone: Vec<&RecordedChannel> = recording.channels().iter().filter(alone).collect();
    contents.extend(alone.into_iter().map(|channel| match channel.unit {
        // A FluidPressure is absolute.
        Unit::Pascal if !channel.quantity.ends_with("_gauge") => Content::Pressure(channel),
        _ => Content::Number(channel),
    }));
    contents
        .into_iter()
        .map(|own| topic(own, recording))
        .collect()
}

/// The topic of a content, by its name and with what is said of it.
fn topic<'a>(content: Content<'a>, recording: &Recording) -> Topic<'a> {
    let fields = content.fields();
    let place = |own: &RecordedChannel| {
        let mut all = recording.channels().iter();
        all.position(|channel| channel.quantity == own.quantity)
    };
    let columns = fields.iter().map(|(channel, field)| FieldColumn {
        column: column_name(&channel.quantity, channel.unit),
        field: field.clone(),
        place: place(channel).unwrap_or_default(),
    });
    let columns: Vec<FieldColumn> = columns.collect();
    let mut units: Vec<&str> = Vec::new();
    for (channel, _) in &fields {
        if !units.contains(&channel.unit.symbol()) {
            units.push(channel.unit.symbol());
        }
    }
    let mut metadata = BTreeMap::from([
        ("unit".to_owned(), units.join(", ")),
        (LAYOUT_KEY.to_owned(), LAYOUT_VERSION.to_owned()),
        (
            COLUMNS_KEY.to_owned(),
            serde_json::json!(columns).to_string(),
        ),
    ]);
    metadata.extend(content.meaning().map(|text| ("meaning".to_owned(), text)));
    let name = match &content {
        Content::Joints(..) => "/joint_states".to_owned(),
        Content::Wrench(frame, _) if *frame == WORLD => "/contact_wrench".to_owned(),
        Content::Wrench(..) => "/wrench".to_owned(),
        Content::Pressure(channel) => format!("/pressures/{}", channel.quantity),
        Content::Number(channel) => format!("/signals/{}", channel.quantity),
    };
    Topic {
        name,
        content,
        metadata,
    }
}

/// Writes all messages in order of time, a phase before the samples in it.
fn write_messages(
    file: &mut BagFile,
    recording: &Recording,
    topics: &[Topic<'_>],
) -> Result<(), BagError> {
    let begin = |topic: &Topic<'_>| file.topic(&topic.name, topic.content.kind(), &topic.metadata);
    let ids: Vec<TopicId> = topics.iter().map(begin).collect::<Result<_, _>>()?;
    let lane = match recording.phases() {
        [] => None,
        _ => Some(phase_topic(file)?),
    };
    let mut phases = recording.phases().iter().zip(0..).peekable();
    let mut coded = Coded::default();
    for (sample, &time) in recording.time().iter().enumerate() {
        let now = nanoseconds(time);
        while let Some(due) = phases.next_if(|(phase, _)| nanoseconds(phase.start) <= now) {
            write_phase(file, lane, due)?;
        }
        for (topic, id) in topics.iter().zip(&ids) {
            topic.content.code(&mut coded, now, sample);
            file.write(*id, sample as u32, now, coded.bytes())?;
        }
    }
    phases.try_for_each(|due| write_phase(file, lane, due))
}

fn phase_topic(file: &mut BagFile) -> Result<TopicId, BagError> {
    let number = |of: &str| serde_json::json!({ "type": "number", "description": of });
    let schema = serde_json::json!({
        "title": "idc.Phase",
        "description": "A phase of the job; a sample at time t belongs to it if start_s <= t < end_s, the recording's last one also at its end.",
        "type": "object",
        "properties": {
            "name": { "type": "string", "description": "Its name." },
            "start_s": number("Its start [s]."),
            "end_s": number("Its end [s]."),
        },
        "required": ["name", "start_s", "end_s"],
    });
    let metadata = BTreeMap::from([(LAYOUT_KEY.to_owned(), LAYOUT_VERSION.to_owned())]);
    file.json_topic(PHASES, "idc.Phase", &schema, &metadata)
}

fn write_phase(
    file: &mut BagFile,
    lane: Option<TopicId>,
    (phase, sequence): (&PhaseSpan, u32),
) -> Result<(), BagError> {
    let Some(lane) = lane else { return Ok(()) };
    let message = PhaseMessage {
        name: phase.name.clone(),
        start_s: phase.start,
        end_s: phase.end,
    };
    let text = serde_json::json!(message).to_string();
    file.write(lane, sequence, nanoseconds(phase.start), text.as_bytes())
}
