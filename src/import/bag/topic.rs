//! Topics of a bag: which of them a map's channels name, their fields and their times, and the rows that their messages make.

use std::path::Path;

use super::definition::definition;
use super::field::{Definition, Field, Kind, Picked};
use super::message::{Message, There};
use crate::import::error::ImportError;
use crate::import::map::{ChannelMap, Column, FileMap};
use crate::import::rows::{Remark, Rows, Times, nearest_first};
use crate::import::units;
use crate::recording::Unit;

/// Time columns that are no fields of a message.
const LOG_TIME: &str = "log_time";
const PUBLISH_TIME: &str = "publish_time";

/// Most names that are kept for a message to list.
const KEPT: usize = 64;

/// A topic's messages, or those of one joint or frame, their fields read.
pub(super) struct Topic {
    /// Its name.
    pub name: String,
    /// The joint and the frame whose messages are meant; any where there is none.
    picked: Picked,
    /// Joints, or frames, that other messages are of.
    others: Vec<String>,
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

/// The topics that a map's channels name, with the fields to read of each.
pub(super) fn topics(
    path: &Path,
    map: &FileMap,
    there: &[There],
) -> Result<Vec<Topic>, ImportError> {
    let mut topics: Vec<Topic> = Vec::new();
    for (index, channel) in map.channels.iter().enumerate() {
        let (owner, field_path) = owner(path, &channel.column, there)?;
        let picked = Picked {
            joint: channel.joint.clone(),
            frame: channel.frame.clone(),
        };
        let known = |topic: &Topic| topic.name == owner.topic && topic.picked == picked;
        let place = match topics.iter().position(known) {
            Some(place) => place,
            None => {
                let definition = definition(owner).map_err(|found| ImportError::Kind {
                    file: path.to_owned(),
                    column: channel.column.clone(),
                    found,
                    expected:
                        "messages of ROS 2: encoding `cdr`, their definition of encoding `ros2msg`"
                            .to_owned(),
                })?;
                let time = time_field(path, map, &owner.topic, &definition)?;
                topics.push(Topic {
                    name: owner.topic.clone(),
                    picked,
                    others: Vec::new(),
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
        let field = field_of(path, channel, &topic.name, &topic.definition, field_path)?;
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

/// The field of a channel, which must be a number, or a list of them where a joint is named.
fn field_of(
    path: &Path,
    channel: &ChannelMap,
    topic: &str,
    definition: &Definition,
    field_path: &str,
) -> Result<Field, ImportError> {
    let refuse = |found: String, expected: String| ImportError::Kind {
        file: path.to_owned(),
        column: channel.column.clone(),
        found,
        expected,
    };
    if channel.frame.is_some() && !definition.has_frames() {
        let expected = "messages with a header, for `frame` to name one of its frames".to_owned();
        return Err(refuse(
            format!("of {topic}, whose messages have no frames"),
            expected,
        ));
    }
    if channel.joint.is_some() {
        if !definition.has_joints() {
            let expected =
                "messages with a list `name` or `joint_names`, for `joint` to name one of it"
                    .to_owned();
            return Err(refuse(
                format!("of {topic}, whose messages name no joints"),
                expected,
            ));
        }
        // The element is found in each message, by the joint's place in it.
        let list = definition.field(&format!("{field_path}[0]"));
        let list = list.filter(|(_, kind)| *kind == Kind::Number);
        let (element, _) = list.ok_or_else(|| {
            let found = format!("no list with a number for each joint in {topic}");
            let lists = definition.lists();
            let lists: Vec<String> = lists.iter().map(|list| format!("{topic}.{list}")).collect();
            let expected = match &lists[..] {
                [] => "a topic whose messages hold one".to_owned(),
                lists => format!("one of {}, without an index", lists.join(", ")),
            };
            refuse(found, expected)
        })?;
        return Ok(element);
    }
    let (field, kind) = find(path, &channel.column, topic, definition, field_path)?;
    if kind == Kind::Number {
        return Ok(field);
    }
    let numbers = numbers_of(topic, definition, field_path);
    Err(refuse(
        kind.words().to_owned(),
        format!("a number: {numbers}"),
    ))
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
            return Err(refuse("no times of a bag", expected));
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
    pub fn take(&mut self, path: &Path, message: &Message<'_>) -> Result<(), ImportError> {
        let fail = |cause: String| ImportError::Read {
            file: path.to_owned(),
            cause: format!(
                "message {}, of {}, does not fit its definition: {cause}",
                message.number, self.name
            ),
        };
        let plain = message.plain().map_err(fail)?;
        let reading = self.definition.decode(&plain).map_err(fail)?;
        let nanoseconds = |ns: u64| i64::try_from(ns).unwrap_or(i64::MAX);
        let place = match reading.place_of(&self.picked) {
            Ok(place) => place,
            Err(others) => {
                for name in others {
                    if self.others.len() < KEPT && !self.others.contains(&name) {
                        self.others.push(name);
                    }
                }
                return Ok(());
            }
        };
        let (mut seconds, mut stamp) = (0.0, 0);
        match &self.time {
            TimeField::Log => stamp = nanoseconds(message.logged),
            TimeField::Publish => stamp = nanoseconds(message.published),
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
        let value = |field: &Field| {
            let number = match place {
                Some(place) => reading.number(&field.at(place)),
                None => reading.number(field),
            };
            number.unwrap_or(f64::NAN)
        };
        let values = self.fields.iter().map(value).collect();
        self.rows
            .push((message.logged, message.number, seconds, stamp, values));
        Ok(())
    }

    /// Refuses a joint or a frame that no message is of.
    fn picks_nothing(&self, path: &Path, column: Column) -> ImportError {
        let (key, name) = match (&self.picked.joint, &self.picked.frame) {
            (Some(joint), _) => ("joint", joint.as_str()),
            (None, frame) => ("frame", frame.as_deref().unwrap_or_default()),
        };
        ImportError::Kind {
            file: path.to_owned(),
            column,
            found: format!("of no {key} `{name}`"),
            expected: format!(
                "`{key}` to be one of those in {}: {}",
                self.name,
                nearest_first(name, &self.others)
            ),
        }
    }

    /// Refuses stamps that all are zero.
    fn has_no_stamps(&self, path: &Path, map: &FileMap) -> ImportError {
        let column = map.time.as_ref().map(|time| time.column.clone());
        ImportError::TimeUnit {
            file: path.to_owned(),
            column: column.unwrap_or(Column::Name(LOG_TIME.to_owned())),
            found: format!(
                "0 in all {} messages of {}, which is no stamp",
                self.rows.len(),
                self.name
            ),
            expected: format!("stamps; `{LOG_TIME}` takes the times at which they were logged"),
        }
    }

    /// Its rows, in the order in which they were logged: within a file they may stand in another.
    pub fn into_rows(
        mut self,
        path: &Path,
        map: &FileMap,
        remarks: &[Remark],
    ) -> Result<Rows, ImportError> {
        self.rows.sort_by_key(|row| (row.0, row.1));
        if self.rows.is_empty() {
            let column = map.channels[self.channels[0]].column.clone();
            return Err(self.picks_nothing(path, column));
        }
        for (place, channel) in self.channels.iter().enumerate() {
            let empty = self.rows.iter().all(|row| row.4[place].is_nan());
            if empty && !map.accepts_empty {
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
        if matches!(self.time, TimeField::Stamp(_)) && self.rows.iter().all(|row| row.3 == 0) {
            return Err(self.has_no_stamps(path, map));
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
            ..Rows::default()
        })
    }
}
