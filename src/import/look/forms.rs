//! Logs that name their columns themselves, looked at: Parquet, MATLAB, bags of ROS 2 messages.

use std::path::Path;

use super::seen::{Because, Cells, Line, Looked, SaidUnit, Seen, TimeSeen};
use super::{names, units};
use crate::import::error::ImportError;
use crate::import::map::{Column, Pressure};
use crate::import::units::named;
use crate::import::{bag, mat_log};
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
    let names = Table::open(path)?.names();
    let mut columns = Vec::new();
    for (place, name) in names.iter().enumerate() {
        // A column that cannot be read is none to choose.
        let Ok(read) = Table::open(path)?.read(&[place]) else {
            continue;
        };
        let cells = match read.into_iter().next() {
            Some(table::Cells::Numbers(numbers)) => Cells::Numbers(numbers),
            Some(table::Cells::Nanoseconds(stamps)) => {
                let mut distinct: Vec<_> = stamps.clone();
                distinct.dedup();
                Cells::Stamps {
                    has: [true, true],
                    distinct: distinct.len(),
                    rows: stamps.len(),
                    because: Because::certain("stamps, which say their unit themselves"),
                    problem: None,
                }
            }
            None => continue,
        };
        columns.push(Seen {
            column: Column::Name(name.clone()),
            name: name.clone(),
            joint: None,
            frames: Vec::new(),
            unit: units::of_name(name),
            cells,
        });
    }
    Ok(Looked {
        path: path.to_owned(),
        head: form("parquet", "it ends in .parquet and is one"),
        columns,
        time: TimeSeen::Column,
    })
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
        head: form("mat5", "it ends in .mat and is of version 5 to 7"),
        columns: columns.into_iter().map(seen).collect(),
        time: TimeSeen::Column,
    })
}

/// Looks at a bag: fields of its topics that are numbers.
pub(super) fn bag(path: &Path) -> Result<Looked, ImportError> {
    let glance = bag::glance::glance(path)?;
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
    Ok(Looked {
        path: path.to_owned(),
        head: form("bag", "it is a bag of ROS 2 messages"),
        columns: glance.fields.into_iter().map(seen).collect(),
        time: TimeSeen::Messages {
            stamped: glance.stamped,
        },
    })
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
