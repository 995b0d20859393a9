//! Logs that name their columns themselves, looked at: Parquet, MATLAB, TDMS, spreadsheets, bags of ROS 2 messages.

use std::path::Path;

use super::seen::{Because, Cells, Line, Looked, SaidUnit, Seen, TimeSeen};
use super::time::toml_text;
use super::{lerobot, names, text, units};
use crate::file::Limit;
use crate::import::encoding::DetectedEncoding;
use crate::import::error::ImportError;
use crate::import::map::{Column, Pressure};
use crate::import::units::named;
use crate::import::{bag, mat_log, parquet_log, spreadsheet, stamps, tdms_log};
use crate::recording::RecordingError;
use crate::recording::table::{self, Table};

fn form(name: &str, why: &str) -> Vec<Line> {
    vec![Line {
        key: "form",
        value: format!("{name:?}"),
        because: Because::certain(why),
    }]
}

/// Looks at a Parquet table; columns that hold neither numbers nor stamps are left out.
pub(super) fn parquet(path: &Path) -> Result<Looked, ImportError> {
    let names = Table::open(path, Limit::default())?.names();
    let robot = lerobot::feature_names(path);
    let (mut columns, mut unread) = (Vec::new(), None);
    for (place, name) in names.iter().enumerate() {
        // A column that cannot be read is none to choose.
        let read = match Table::open(path, Limit::default())?.read(&[place]) {
            Ok(read) => read,
            Err(error) => {
                unread.get_or_insert(error);
                continue;
            }
        };
        let Some(cells) = read.into_iter().next().map(cells) else {
            continue;
        };
        let whole = name.split('[').next().unwrap_or(name);
        columns.push(Seen {
            column: Column::Name(name.clone()),
            name: robot.get(name).unwrap_or(name).clone(),
            joint: None,
            frames: Vec::new(),
            // An element of a list has the list's.
            unit: units::of_name(if name.ends_with(']') { whole } else { name })
                .or_else(|| units::of_name(name).filter(|_| !is_element(name))),
            cells,
        });
    }
    let holds_none = columns.iter().all(|column| column.cells == Cells::Other);
    if let (true, Some(error @ RecordingError::Read { .. })) = (holds_none, unread) {
        return Err(error.into());
    }
    if holds_none {
        let names: Vec<String> = names.iter().map(|name| format!("`{name}`")).collect();
        return Err(ImportError::Read {
            file: path.to_owned(),
            cause: format!(
                "its columns {} hold neither numbers nor stamps",
                names.join(", ")
            ),
        });
    }
    Ok(Looked {
        path: path.to_owned(),
        head: form("parquet", "it begins as one"),
        columns,
        ..Looked::default()
    })
}

/// Whether a column is an element of a list: `[1]` behind its name is no unit.
fn is_element(name: &str) -> bool {
    let inside = name
        .strip_suffix(']')
        .and_then(|name| name.rsplit_once('['));
    inside.is_some_and(|(_, index)| index.chars().all(|c| c.is_ascii_digit()))
}

/// Cells of a table that knows their types.
fn cells(read: table::Cells) -> Cells {
    match read {
        table::Cells::Numbers(numbers) => Cells::Numbers(numbers),
        table::Cells::Nanoseconds(stamps) => {
            let mut distinct: Vec<_> = stamps.clone();
            distinct.dedup();
            Cells::Stamps {
                has: [true, true],
                distinct: distinct.len(),
                rows: stamps.len(),
                because: Because::certain("stamps, which say their unit themselves"),
                problem: None,
                times: stamps.into_iter().flatten().collect(),
            }
        }
        table::Cells::Texts(texts) => of_texts(texts),
    }
}

/// Cells that hold texts: stamps or numbers, if nearly all of them are that.
fn of_texts(texts: Vec<Option<String>>) -> Cells {
    let filled: Vec<String> = texts.iter().flatten().cloned().collect();
    let most = |count: usize| !filled.is_empty() && 10 * count >= 9 * filled.len();
    let numbers = parquet_log::numbers(&table::Cells::Texts(texts));
    if most(numbers.iter().filter(|number| number.is_finite()).count()) {
        return Cells::Numbers(numbers);
    }
    if most(filled.iter().filter(|text| stamps::is_stamp(text)).count()) {
        return Cells::stamped(&filled);
    }
    Cells::Other
}

/// Looks at the channels of a TDMS file.
pub(super) fn tdms(path: &Path) -> Result<Looked, ImportError> {
    let contents = tdms_log::contents(path, Limit::default())?;
    let readable = contents
        .channels
        .iter()
        .filter(|channel| channel.problem.is_none());
    let waveforms = readable.clone().filter(|own| own.waveform.is_some());
    let is_waveforms = waveforms.count() > 0;
    let columns = readable
        // Beside waveforms channels without times cannot be placed.
        .filter(|channel| !is_waveforms || channel.waveform.is_some())
        .map(|channel| {
            let name = channel.column();
            let said = channel.unit.as_deref().and_then(units::of_cell);
            Seen {
                unit: said.or_else(|| units::of_name(&name)),
                column: Column::Name(name.clone()),
                name,
                joint: None,
                frames: Vec::new(),
                cells: cells(channel.cells.clone()),
            }
        });
    let why = match is_waveforms {
        true => "it begins as one; its channels are waveforms and say their times themselves",
        false => "it begins as one",
    };
    let why = match &contents.torn {
        Some(found) => format!("{why}; it is cut off: {found}"),
        None => why.to_owned(),
    };
    Ok(Looked {
        path: path.to_owned(),
        head: form("tdms", &why),
        columns: columns.collect(),
        time: match is_waveforms {
            true => TimeSeen::Waveforms,
            false => TimeSeen::Column,
        },
        ..Looked::default()
    })
}

/// Looks at the sheet of a spreadsheet that holds the most numbers.
pub(super) fn spreadsheet(path: &Path) -> Result<Looked, ImportError> {
    let sheet = spreadsheet::likely(path, Limit::default())?;
    let detected = DetectedEncoding {
        name: "utf-8".to_owned(),
        reason: "",
        is_certain: true,
    };
    let mut looked = text::look_at(path, &sheet.text, &detected)?;
    // Numbers have no marks there, unless they stand as texts.
    let is_plain = |line: &Line| line.key == "decimal_mark" && line.value == "\".\"";
    let of_files = ["encoding", "separator"];
    looked
        .head
        .retain(|line| !of_files.contains(&line.key) && !is_plain(line));
    let because = match &sheet.others[..] {
        [] => Because::certain("it alone holds anything"),
        others => Because::likely(format!(
            "it holds the most numbers; there are {} too",
            others.join(", ")
        )),
    };
    let own = Line {
        key: "sheet",
        value: toml_text(&sheet.name),
        because,
    };
    let head = form("spreadsheet", "it begins as one");
    looked.head = [head, vec![own], looked.head].concat();
    Ok(looked)
}

/// Looks at a MAT file.
pub(super) fn mat(path: &Path) -> Result<Looked, ImportError> {
    let columns = mat_log::columns(path)?;
    let seen = |(name, values): (String, Vec<f64>)| Seen {
        column: Column::Name(name.clone()),
        unit: units::of_name(&name),
        name,
        joint: None,
        frames: Vec::new(),
        cells: Cells::Numbers(values),
    };
    Ok(Looked {
        path: path.to_owned(),
        head: form("mat5", "it is of version 5 to 7"),
        columns: columns.into_iter().map(seen).collect(),
        ..Looked::default()
    })
}

/// Looks at a bag: fields of its topics that are numbers.
pub(super) fn bag(path: &Path) -> Result<Looked, ImportError> {
    let glance = bag::glance::glance(path, Limit::default())?;
    let seen = |field: bag::glance::FieldSeen| {
        let joint = field.joint.clone();
        let name = match &joint {
            Some(joint) => format!("{} {joint}", field.column),
            None => field.column.clone(),
        };
        let cells = if field.is_bool {
            Cells::States(field.values)
        } else {
            Cells::Numbers(field.values)
        };
        Seen {
            unit: unit_of(&field.message, &field.path, joint.as_deref())
                .or_else(|| units::of_name(&name)),
            column: Column::Name(field.column),
            name,
            joint,
            frames: field.frames,
            cells,
        }
    };
    let why = [
        vec!["it is a bag of ROS 2 messages".to_owned()],
        glance.notes,
    ]
    .concat();
    let (column, because) = times_of(glance.stamped, glance.zero_stamps);
    Ok(Looked {
        path: path.to_owned(),
        head: form("bag", &why.join("; ")),
        columns: glance.fields.into_iter().map(seen).collect(),
        time: TimeSeen::Messages { column, because },
        ..Looked::default()
    })
}

/// Share of the messages that may lack their stamps for the others to be the times.
const UNSTAMPED: f64 = 0.1;

/// Times of a bag's messages: their stamps, if they have them; a stamp of zero is none.
fn times_of(stamped: bool, [zero, all]: [usize; 2]) -> (&'static str, Because) {
    const LOGGED: &str = "log_time";
    if !stamped {
        let why = "not every message has a stamp; this is when it was logged";
        return (LOGGED, Because::certain(why));
    }
    if zero == 0 {
        return (
            "header.stamp",
            Because::certain("every message has a stamp"),
        );
    }
    if zero == all {
        let why = "the stamps of all messages are 0, which is none; this is when they were logged";
        return (LOGGED, Because::certain(why));
    }
    let found = format!("the stamps of {zero} of {all} messages are 0, which is none");
    if zero as f64 > UNSTAMPED * all as f64 {
        let why = format!("{found}; this is when they were logged");
        return (LOGGED, Because::likely(why));
    }
    let why = format!("{found}: those are left out; `log_time` is when all were logged");
    ("header.stamp", Because::likely(why))
}

/// Units that the definitions of the usual messages state (REP 103: SI throughout).
fn unit_of(message: &str, path: &str, joint: Option<&str>) -> Option<SaidUnit> {
    let message = message.replace("/msg/", "/");
    let slides = joint.is_some_and(|joint| {
        let thing = names::said(joint).thing;
        thing.is_some_and(|(thing, _)| thing == names::Thing::Stroke)
    });
    let start = path.split(['.', '[']).next().unwrap_or(path);
    let (name, pressure) = match (message.as_str(), start) {
        ("sensor_msgs/FluidPressure", "fluid_pressure") => ("Pa", Some(Pressure::Absolute)),
        ("sensor_msgs/JointState", "position") if slides => ("m", None),
        ("sensor_msgs/JointState", "position") => ("rad", None),
        ("sensor_msgs/JointState", "velocity") if slides => ("m/s", None),
        ("sensor_msgs/JointState", "velocity") => ("rad/s", None),
        ("sensor_msgs/JointState", "effort") if slides => ("N", None),
        ("sensor_msgs/JointState", "effort") => ("N m", None),
        ("sensor_msgs/Imu", "linear_acceleration") => ("m/s2", None),
        ("sensor_msgs/Imu", "angular_velocity") => ("rad/s", None),
        ("sensor_msgs/Range", "range") => ("m", None),
        ("sensor_msgs/Temperature", "temperature") => ("degC", None),
        ("geometry_msgs/WrenchStamped" | "geometry_msgs/Wrench", _) if path.contains("force") => {
            ("N", None)
        }
        ("geometry_msgs/WrenchStamped" | "geometry_msgs/Wrench", _) => ("N m", None),
        ("geometry_msgs/PointStamped" | "geometry_msgs/PoseStamped", _)
            if !path.contains("orientation") =>
        {
            ("m", None)
        }
        ("std_msgs/Bool", _) => ("1", None),
        _ => return None,
    };
    let absolute = if pressure.is_some() { ", absolute" } else { "" };
    Some(SaidUnit {
        unit: named(name)?,
        pressure,
        because: Because::certain(format!("{message} is in {name}{absolute}")),
    })
}
