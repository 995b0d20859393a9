//! A recording of this program as a bag (`crate::recording::bag`): it says itself which field is which channel, and needs no map.

use std::convert::Infallible;
use std::io::Read;
use std::path::Path;

use super::message::There;
use super::store::{Scan, Stores};
use crate::file::{self, Limit};
use crate::import::error::ImportError;
use crate::import::map::{
    ChannelMap, Clock, Column, FileMap, Form, GAUGE, ImportMap, Missing, Pressure,
};
use crate::import::units;
use crate::recording::bag::{
    COLUMNS_KEY, FieldColumn, LAYOUT_KEY, LAYOUT_VERSION, PHASES, PhaseMessage, nanoseconds,
};
use crate::recording::{PhaseSpan, Unit};
use crate::unit::parse_column_name;

/// Phases of a recording, at most: each is a part of a job.
const MOST_PHASES: usize = 1 << 16;

/// Map of a bag that says itself what it holds; none of a file that is no MCAP.
///
/// # Errors
/// The bag is damaged, of another layout, or another program's.
pub fn map_of_bag(path: &Path) -> Result<Option<ImportMap>, ImportError> {
    if !is_mcap(path) {
        return Ok(None);
    }
    let refuse = |cause: String| ImportError::Read {
        file: path.to_owned(),
        cause,
    };
    let limit = Limit::default();
    let stores = Stores::open(path, limit).map_err(refuse)?;
    let scan = Scan::of(&stores);
    if let Some(found) = &scan.cause {
        return Err(ImportError::Truncated {
            file: path.to_owned(),
            found: found.clone(),
            rest: scan.rest(),
            advice: format!("`{}` repairs it", stores.repaired_by()),
        });
    }
    let mut channels: Vec<(usize, ChannelMap)> = Vec::new();
    for there in &scan.there {
        channels.extend(channels_of(there).map_err(refuse)?);
    }
    if channels.is_empty() {
        return Err(refuse(format!(
            "no topic of it says which channels it holds (`{COLUMNS_KEY}` in its channel's metadata), as those that `idc run --mcap` writes do; \
             other bags need an import map: `idc new import MAP --from {}` drafts it, `idc import MAP {}` reads by it",
            path.display(),
            path.display()
        )));
    }
    channels.sort_by_key(|(place, _)| *place);
    let phases = phases(&stores).map_err(refuse)?;
    Ok(Some(ImportMap {
        path: path.to_owned(),
        title: "A recording of idc".to_owned(),
        files: vec![file_map(path, limit, channels)],
        constants: Vec::new(),
        phases,
        says_itself: true,
    }))
}

fn is_mcap(path: &Path) -> bool {
    let mut start = [0; mcap::MAGIC.len()];
    let read = file::open(path).and_then(|mut file| file.read_exact(&mut start));
    read.is_ok() && start == *mcap::MAGIC
}

/// The whole file, by the times at which its messages were logged.
fn file_map(path: &Path, limit: Limit, channels: Vec<(usize, ChannelMap)>) -> FileMap {
    FileMap {
        path: Some(path.to_owned()),
        same_log: false,
        form: Form::Bag,
        dropped: [0, 0],
        accepts_truncated: false,
        limit,
        accepts_unused_rows: false,
        accepts_empty: true,
        missing: Missing::default(),
        rows: None,
        clock: Clock::Shared { offset: 0.0 },
        time: None,
        sample_rate: None,
        channels: channels.into_iter().map(|(_, channel)| channel).collect(),
    }
}

/// The channels that a topic says it holds, with their places.
fn channels_of(there: &There) -> Result<Vec<(usize, ChannelMap)>, String> {
    let Some(text) = there.metadata.get(COLUMNS_KEY) else {
        return Ok(Vec::new());
    };
    let topic = &there.topic;
    let version = there.metadata.get(LAYOUT_KEY).map(String::as_str);
    if version != Some(LAYOUT_VERSION) {
        let found = version.unwrap_or("none");
        return Err(format!(
            "its layout has version {found}, expected {LAYOUT_VERSION}"
        ));
    }
    let columns: Vec<FieldColumn> = serde_json::from_str(text)
        .map_err(|cause| format!("`{COLUMNS_KEY}` of {topic} cannot be read: {cause}"))?;
    let channel = |own: FieldColumn| {
        let found = parse_column_name(&own.column).and_then(|(quantity, unit)| {
            let unit = units::named(unit.symbol())?;
            Some((
                own.place,
                channel(quantity, unit, format!("{topic}.{}", own.field)),
            ))
        });
        found.ok_or_else(|| {
            format!(
                "`{COLUMNS_KEY}` of {topic} names a column `{}`, expected one that ends in a unit such as `_n`, `_m` or `_pa`",
                own.column
            )
        })
    };
    columns.into_iter().map(channel).collect()
}

/// A channel as it stands, in SI.
fn channel(quantity: &str, unit: &'static units::LogUnit, column: String) -> ChannelMap {
    let pressure = match quantity.ends_with(GAUGE) {
        true => Pressure::Gauge,
        false => Pressure::Absolute,
    };
    ChannelMap {
        quantity: quantity.to_owned(),
        column: Column::Name(column),
        joint: None,
        frame: None,
        unit,
        gain: 1.0,
        offset: 0.0,
        reversed: false,
        pressure: (unit.si == Unit::Pascal).then_some(pressure),
        above: 0.0,
    }
}

/// The phases of a bag, in order, their times to 1 ns as those of its samples.
fn phases(stores: &Stores) -> Result<Vec<PhaseSpan>, String> {
    let mut found: Vec<Result<PhaseSpan, String>> = Vec::new();
    let Ok(_) = stores.visit(|message| -> Result<(), Infallible> {
        let there = message.there;
        let is_phase = there.topic == PHASES && there.encoding == "json";
        if is_phase && found.len() <= MOST_PHASES {
            let read: Result<PhaseMessage, _> = serde_json::from_slice(message.data);
            let read = read.map(|own| PhaseSpan {
                name: own.name,
                start: nanoseconds(own.start_s) as f64 / 1e9,
                end: nanoseconds(own.end_s) as f64 / 1e9,
            });
            found.push(read.map_err(|cause| {
                format!(
                    "message {}, of {PHASES}, is no phase: {cause}",
                    message.number
                )
            }));
        }
        Ok(())
    });
    if found.len() > MOST_PHASES {
        return Err(format!("it has more than {MOST_PHASES} phases"));
    }
    found.into_iter().collect()
}
