//! A log as an MCAP with ROS 2 messages: a channel is a field of a topic's messages, `/wrench.wrench.force.z`, `/joint_states.position[1]`.
//!
//! The messages' definitions stand in the file (schema encoding `ros2msg`), so any is read. Each topic has times of its own.

use std::path::Path;

use mcap::{McapError, MessageStream};

use super::error::ImportError;
use super::log::{Remark, Rows, Times, nearest_first};
use super::map::{Column, FileMap};
use super::units;
use crate::recording::Unit;

mod field;

use field::{Definition, Field, Kind};

/// Time columns that are no fields of a message.
const LOG_TIME: &str = "log_time";
const PUBLISH_TIME: &str = "publish_time";

/// A topic's messages, their fields read.
struct Topic {
    name: String,
    channels: Vec<usize>,
    definition: Definition,
    fields: Vec<Field>,
    time: TimeField,
    /// When each was logged, its number in the file, its time and its values.
    rows: Vec<(u64, u64, f64, i64, Vec<f64>)>,
}

/// Where a message's time is taken from.
enum TimeField {
    Log,
    Publish,
    Stamp(Field),
    Number(Field),
}

/// Reads the topics that a map's channels name, the first channel's first.
pub(super) fn read(path: &Path, map: &FileMap) -> Result<Vec<Rows>, ImportError> {
    let fail = |cause: String| ImportError::Read {
        file: path.to_owned(),
        cause,
    };
    let bytes = std::fs::read(path).map_err(|cause| fail(cause.to_string()))?;
    if !bytes.starts_with(mcap::MAGIC) {
        return Err(fail("it is no MCAP: it does not start as one".to_owned()));
    }
    let scan = Scan::of(&bytes);
    let mut remarks = Vec::new();
    if let Some(cause) = &scan.cause {
        // A chunk is checked at its end, when its messages have been read.
        if scan.is_damaged {
            let advice = "copy it once more from where it was recorded, or let `mcap recover` leave out what is damaged";
            return Err(fail(format!("it is damaged: {cause}; {advice}")));
        }
        let rest = scan.rest();
        if !map.accepts_truncated {
            return Err(ImportError::Truncated {
                file: path.to_owned(),
                found: cause.clone(),
                rest,
                advice: "`mcap recover` repairs it, or `accept_truncated = true` in the map's [[file]] uses them"
                    .to_owned(),
            });
        }
        remarks.push(Remark::Truncated(format!("it is cut off: {cause}; {rest}")));
    }
    let mut topics = topics(path, map, &scan.there)?;
    let stream = MessageStream::new(&bytes).map_err(|cause| fail(cause.to_string()))?;
    // Where it ends was found out before.
    for (index, message) in stream.map_while(Result::ok).enumerate() {
        let topic = topics
            .iter_mut()
            .find(|topic| topic.name == message.channel.topic);
        if let Some(topic) = topic {
            topic.take(path, index as u64 + 1, &message)?;
        }
    }
    topics
        .into_iter()
        .map(|topic| topic.into_rows(path, map, &remarks))
        .collect()
}

/// A topic that is there, with the name, the encoding and the text of its definition.
struct There {
    topic: String,
    encoding: String,
    schema: Option<(String, String, Vec<u8>)>,
}

/// What a file holds, up to where it breaks off.
struct Scan {
    /// Topics that have messages, in the order of their names.
    there: Vec<There>,
    /// Messages, and the times at which the first and the last were logged [ns].
    messages: usize,
    logged: [u64; 2],
    /// Why it breaks off, if it does.
    cause: Option<String>,
    /// Are messages before that not what was written?
    is_damaged: bool,
}

impl Scan {
    fn of(bytes: &[u8]) -> Self {
        let mut scan = Self {
            there: Vec::new(),
            messages: 0,
            logged: [u64::MAX, 0],
            cause: None,
            is_damaged: false,
        };
        let stream = match MessageStream::new(bytes) {
            Ok(stream) => stream,
            Err(error) => {
                scan.cause = Some(error.to_string());
                return scan;
            }
        };
        for message in stream {
            let message = match message {
                Ok(message) => message,
                Err(error) => {
                    scan.is_damaged = matches!(error, McapError::BadChunkCrc { .. });
                    scan.cause = Some(error.to_string());
                    break;
                }
            };
            scan.messages += 1;
            let [first, last] = scan.logged;
            scan.logged = [first.min(message.log_time), last.max(message.log_time)];
            let channel = &message.channel;
            if scan.there.iter().all(|there| there.topic != channel.topic) {
                let schema = channel.schema.as_ref();
                scan.there.push(There {
                    topic: channel.topic.clone(),
                    encoding: channel.message_encoding.clone(),
                    schema: schema.map(|s| (s.name.clone(), s.encoding.clone(), s.data.to_vec())),
                });
            }
        }
        scan.there.sort_by(|a, b| a.topic.cmp(&b.topic));
        scan
    }

    /// What can be read of it.
    fn rest(&self) -> String {
        let [first, last] = self.logged;
        let span = last.saturating_sub(first) as f64 * 1e-9;
        match self.messages {
            0 => "no message of it can be read".to_owned(),
            count => format!(
                "the first {count} messages can be read, the last of them {span:.3} s after the first"
            ),
        }
    }
}

/// The topics that a map's channels name, with the fields to read of each.
fn topics(path: &Path, map: &FileMap, there: &[There]) -> Result<Vec<Topic>, ImportError> {
    let mut topics: Vec<Topic> = Vec::new();
    for (index, channel) in map.channels.iter().enumerate() {
        let (owner, field_path) = owner(path, &channel.column, there)?;
        let known = topics.iter().position(|topic| topic.name == owner.topic);
        let place = match known {
            Some(place) => place,
            None => {
                let definition = definition(path, &channel.column, owner)?;
                let time = time_field(path, map, &owner.topic, &definition)?;
                topics.push(Topic {
                    name: owner.topic.clone(),
                    channels: Vec::new(),
                    definition,
                    fields: Vec::new(),
                    time,
                    rows: Vec::new(),
                });
                topics.len() - 1
            }
        };
        let topic = &mut topics[place];
        let (field, kind) = find(
            path,
            &channel.column,
            &topic.name,
            &topic.definition,
            field_path,
        )?;
        if kind != Kind::Number {
            return Err(ImportError::Kind {
                file: path.to_owned(),
                column: channel.column.clone(),
                found: kind.words().to_owned(),
                expected: format!(
                    "a number: {}",
                    numbers_of(&topic.name, &topic.definition, field_path)
                ),
            });
        }
        topic.channels.push(index);
        topic.fields.push(field);
    }
    Ok(topics)
}

/// The topic of a column `topic.field`, and the field.
fn owner<'a>(
    path: &Path,
    column: &'a Column,
    there: &'a [There],
) -> Result<(&'a There, &'a str), ImportError> {
    let name = match column {
        Column::Name(name) => name,
        Column::Number(number) => {
            return Err(ImportError::Kind {
                file: path.to_owned(),
                column: column.clone(),
                found: format!("the number {number}"),
                expected: "a topic and a field of its messages: \"/topic.field\"".to_owned(),
            });
        }
    };
    let fits = |there: &&There| {
        let rest = name.strip_prefix(&there.topic)?;
        rest.strip_prefix('.')
    };
    let longest = there
        .iter()
        .filter_map(|there| Some((there, fits(&there)?)))
        .max_by_key(|(there, _)| there.topic.len());
    longest.ok_or_else(|| {
        let names: Vec<String> = there.iter().map(|there| there.topic.clone()).collect();
        let wanted = name.split('.').next().unwrap_or(name);
        ImportError::NoColumn {
            file: path.to_owned(),
            column: column.clone(),
            there: match &names[..] {
                [] => "no messages in it".to_owned(),
                names => format!(
                    "the topics {} (a column is \"/topic.field\")",
                    nearest_first(wanted, names)
                ),
            },
        }
    })
}

fn definition(path: &Path, column: &Column, owner: &There) -> Result<Definition, ImportError> {
    let refuse = |found: String| ImportError::Kind {
        file: path.to_owned(),
        column: column.clone(),
        found,
        expected: "messages of ROS 2: encoding `cdr`, their definition of encoding `ros2msg`"
            .to_owned(),
    };
    match &owner.schema {
        Some((name, encoding, data)) if encoding == "ros2msg" && owner.encoding == "cdr" => {
            let text = String::from_utf8_lossy(data);
            Definition::parse(name, &text).map_err(|cause| {
                refuse(format!(
                    "of messages whose definition cannot be read ({cause})"
                ))
            })
        }
        Some((_, encoding, _)) => Err(refuse(format!(
            "of messages of encoding `{}` with a definition of encoding `{encoding}`",
            owner.encoding
        ))),
        None => Err(refuse("of messages without a definition".to_owned())),
    }
}

/// A field by its path, with the names there are where it is not.
fn find(
    path: &Path,
    column: &Column,
    topic: &str,
    definition: &Definition,
    field_path: &str,
) -> Result<(Field, Kind), ImportError> {
    definition
        .field(field_path)
        .ok_or_else(|| ImportError::NoColumn {
            file: path.to_owned(),
            column: column.clone(),
            there: numbers_of(topic, definition, field_path),
        })
}

/// Columns of a topic that are numbers, the nearest first.
fn numbers_of(topic: &str, definition: &Definition, near: &str) -> String {
    let fields = definition.numbers().into_iter();
    let names: Vec<String> = fields.map(|field| format!("{topic}.{field}")).collect();
    nearest_first(&format!("{topic}.{near}"), &names)
}

/// Where a topic's times stand.
fn time_field(
    path: &Path,
    map: &FileMap,
    topic: &str,
    definition: &Definition,
) -> Result<TimeField, ImportError> {
    let Some(time) = &map.time else {
        return Ok(TimeField::Log);
    };
    let refuse = |found: &str, expected: String| ImportError::TimeUnit {
        file: path.to_owned(),
        column: time.column.clone(),
        found: found.to_owned(),
        expected,
    };
    let no_unit = |field: TimeField| match time.unit {
        Some(unit) => Err(refuse(
            "stamps, which say their unit themselves",
            format!("no `unit = \"{}\"` in [file.time]", unit.name),
        )),
        None => Ok(field),
    };
    let name = match &time.column {
        Column::Name(name) => name,
        Column::Number(_) => {
            let expected = format!(
                "`{LOG_TIME}`, `{PUBLISH_TIME}` or a field of every topic's messages, such as `header.stamp`"
            );
            return Err(refuse("no times of an MCAP", expected));
        }
    };
    match name.as_str() {
        LOG_TIME => return no_unit(TimeField::Log),
        PUBLISH_TIME => return no_unit(TimeField::Publish),
        _ => {}
    }
    let Some((field, kind)) = definition.field(name) else {
        return Err(ImportError::NoColumn {
            file: path.to_owned(),
            column: time.column.clone(),
            there: format!(
                "{LOG_TIME}, {PUBLISH_TIME} and, in the messages of {topic}, {}",
                match &definition.times()[..] {
                    [] => "no stamps".to_owned(),
                    stamps => nearest_first(name, stamps),
                }
            ),
        });
    };
    match kind {
        Kind::Stamp => no_unit(TimeField::Stamp(field)),
        Kind::Number if time.unit.is_some() => Ok(TimeField::Number(field)),
        Kind::Number => {
            let units = units::of_kind(Unit::Second).join(", ");
            Err(refuse(
                "numbers",
                format!("`unit` in [file.time]: one of {units}"),
            ))
        }
        Kind::Other(what) => Err(refuse(what, "stamps or numbers".to_owned())),
    }
}

impl Topic {
    /// Reads the fields of a message.
    fn take(
        &mut self,
        path: &Path,
        number: u64,
        message: &mcap::Message<'_>,
    ) -> Result<(), ImportError> {
        let fail = |cause: String| ImportError::Read {
            file: path.to_owned(),
            cause: format!(
                "message {number}, of {}, does not fit its definition: {cause}",
                self.name
            ),
        };
        let reading = self.definition.decode(&message.data).map_err(fail)?;
        let nanoseconds = |ns: u64| i64::try_from(ns).unwrap_or(i64::MAX);
        let (mut seconds, mut stamp) = (0.0, 0);
        match &self.time {
            TimeField::Log => stamp = nanoseconds(message.log_time),
            TimeField::Publish => stamp = nanoseconds(message.publish_time),
            TimeField::Stamp(field) => {
                stamp = reading
                    .stamp(field)
                    .ok_or_else(|| fail("it has no stamp".to_owned()))?;
            }
            TimeField::Number(field) => {
                let time = reading.number(field).filter(|time| time.is_finite());
                seconds = time.ok_or_else(|| fail("it has no time".to_owned()))?;
            }
        }
        let value = |field: &Field| reading.number(field).unwrap_or(f64::NAN);
        let values = self.fields.iter().map(value).collect();
        self.rows
            .push((message.log_time, number, seconds, stamp, values));
        Ok(())
    }

    /// Its rows, in the order in which they were logged: within a file they may stand in another.
    fn into_rows(
        mut self,
        path: &Path,
        map: &FileMap,
        remarks: &[Remark],
    ) -> Result<Rows, ImportError> {
        self.rows.sort_by_key(|row| (row.0, row.1));
        for (place, channel) in self.channels.iter().enumerate() {
            let empty = self.rows.iter().all(|row| row.4[place].is_nan());
            if empty && !self.rows.is_empty() {
                return Err(ImportError::Kind {
                    file: path.to_owned(),
                    column: map.channels[*channel].column.clone(),
                    found: format!(
                        "in none of the {} messages of {}",
                        self.rows.len(),
                        self.name
                    ),
                    expected: "an element that their lists have, counted from 0".to_owned(),
                });
            }
        }
        let time = match self.time {
            TimeField::Number(_) => Times::Numbers(self.rows.iter().map(|row| row.2).collect()),
            _ => Times::Nanoseconds(self.rows.iter().map(|row| row.3).collect()),
        };
        let columns = (0..self.channels.len())
            .map(|place| self.rows.iter().map(|row| row.4[place]).collect())
            .collect();
        Ok(Rows {
            channels: self.channels,
            time,
            columns,
            lines: self.rows.iter().map(|row| row.1).collect(),
            remarks: remarks.to_vec(),
        })
    }
}
