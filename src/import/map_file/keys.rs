//! The keys of an import map, as they are written.

use std::path::PathBuf;

use serde::Deserialize;
use serde::de::{Deserializer, Error, Unexpected, Visitor};

use crate::import::map::Column;
use crate::scenario::schema::{Described, describe, key_rows, plain_schema};
use crate::scenario::sections::keys;

/// The file as it is written.
#[derive(Debug, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct MapFile {
    #[allow(dead_code, reason = "checked by Document::new")]
    pub schema: u32,
    pub title: String,
    pub atmosphere_pa: Option<f64>,
    pub file: Vec<FileKeys>,
    #[serde(default)]
    pub constant: Vec<ConstantKeys>,
}

/// `[[file]]`.
#[derive(Debug, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct FileKeys {
    pub path: Option<PathBuf>,
    pub same_log: Option<bool>,
    pub form: FormKey,
    pub sheet: Option<String>,
    pub encoding: Option<String>,
    pub separator: Option<String>,
    pub field_widths: Option<Vec<usize>>,
    pub decimal_mark: Option<String>,
    pub thousands_mark: Option<String>,
    pub header_lines: Option<usize>,
    pub names_line: Option<usize>,
    pub drop_first_rows: Option<usize>,
    pub drop_last_rows: Option<usize>,
    pub accept_truncated: Option<bool>,
    pub skip_stray_lines: Option<bool>,
    pub accept_unused_rows: Option<bool>,
    pub missing: Option<Vec<MarkKey>>,
    pub rows: Option<RowsKeys>,
    pub sample_rate_hz: Option<f64>,
    pub clock: Option<ClockKey>,
    pub clock_offset_s: Option<f64>,
    pub aligned_by: Option<[String; 2]>,
    pub largest_offset_s: Option<f64>,
    pub time: Option<TimeKeys>,
    pub channel: Vec<ChannelKeys>,
}

/// `form`.
#[derive(Debug, Clone, Copy, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "snake_case")]
pub(super) enum FormKey {
    Text,
    Parquet,
    Mat5,
    Bag,
    Tdms,
    Spreadsheet,
    /// As maps called a bag before it could be of SQLite.
    Mcap,
}

/// `clock`.
#[derive(Debug, Clone, Copy, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "snake_case")]
pub(super) enum ClockKey {
    Shared,
    Unknown,
}

/// `[file.time]`.
#[derive(Debug, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct TimeKeys {
    pub column: ColumnKey,
    pub unit: Option<String>,
    pub thousands_mark: Option<String>,
    pub date_column: Option<ColumnKey>,
    pub date_order: Option<DateOrderKey>,
    pub year: Option<i32>,
    pub two_numbers: Option<TwoNumbersKey>,
}

/// `date_order`.
#[derive(Debug, Clone, Copy, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub(super) enum DateOrderKey {
    YearMonthDay,
    DayMonthYear,
    MonthDayYear,
}

/// `two_numbers`.
#[derive(Debug, Clone, Copy, Deserialize, schemars::JsonSchema)]
pub(super) enum TwoNumbersKey {
    #[serde(rename = "mm:ss")]
    MinutesSeconds,
    #[serde(rename = "hh:mm")]
    HoursMinutes,
}

/// `[file.rows]`.
#[derive(Debug, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct RowsKeys {
    pub column: ColumnKey,
    pub value: MarkKey,
}

/// A text or a number that a log writes: of `missing`, of `rows`.
#[derive(Debug, Deserialize, schemars::JsonSchema)]
#[serde(untagged)]
pub(super) enum MarkKey {
    Whole(i64),
    Number(f64),
    Text(String),
}

/// `[[constant]]`.
#[derive(Debug, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct ConstantKeys {
    pub quantity: String,
    pub value: f64,
    pub unit: String,
    pub pressure: Option<PressureKey>,
}

/// `[[file.channel]]`.
#[derive(Debug, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct ChannelKeys {
    pub quantity: String,
    pub column: ColumnKey,
    pub joint: Option<String>,
    pub frame: Option<String>,
    pub unit: String,
    pub gain: Option<f64>,
    pub offset: Option<f64>,
    pub reversed: Option<bool>,
    pub pressure: Option<PressureKey>,
}

/// A column by its number from 1, or by its name.
#[derive(Debug)]
pub(super) struct ColumnKey(pub Column);

impl schemars::JsonSchema for ColumnKey {
    fn schema_name() -> std::borrow::Cow<'static, str> {
        "Column".into()
    }

    fn json_schema(_: &mut schemars::SchemaGenerator) -> schemars::Schema {
        schemars::json_schema!({
            "anyOf": [
                { "type": "integer", "minimum": 1 },
                { "type": "string", "minLength": 1 },
            ]
        })
    }
}

impl<'de> Deserialize<'de> for ColumnKey {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(ColumnVisitor)
    }
}

/// Reads a column's number or name.
struct ColumnVisitor;

impl Visitor<'_> for ColumnVisitor {
    type Value = ColumnKey;

    fn expecting(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str("a column's number from 1, or its name in quotes")
    }

    fn visit_i64<E: Error>(self, number: i64) -> Result<ColumnKey, E> {
        match usize::try_from(number) {
            Ok(number) if number > 0 => Ok(ColumnKey(Column::Number(number))),
            _ => Err(E::invalid_value(Unexpected::Signed(number), &self)),
        }
    }

    fn visit_str<E: Error>(self, name: &str) -> Result<ColumnKey, E> {
        if name.trim().is_empty() {
            return Err(E::invalid_value(Unexpected::Str(name), &self));
        }
        Ok(ColumnKey(Column::Name(name.to_owned())))
    }
}

/// `pressure`.
#[derive(Debug, Clone, Copy, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "snake_case")]
pub(super) enum PressureKey {
    Gauge,
    Absolute,
}

/// JSON Schema of a map; what a key means is read off the page of maps.
pub(super) fn schema() -> serde_json::Value {
    const PAGE: &str = include_str!("../../../assets/import/README.md");
    let rows = key_rows(PAGE);
    // The page has a table for each of these, in its order.
    let tables = [
        "",
        "file",
        "file.time",
        "file.rows",
        "file.channel",
        "constant",
    ];
    describe(plain_schema::<MapFile>(), |table, key| {
        let place = tables.iter().position(|name| *name == table)?;
        let row = rows.get(place)?.iter().find(|row| row.names(key))?;
        let absent = match row.cells.get(2).map(String::as_str) {
            None | Some("-") => String::new(),
            Some(absent) => format!(" Without it: {absent}."),
        };
        Some(Described::text(format!("{}.{absent}", row.cells[1])))
    })
}

/// Tables of a map with their keys.
pub(super) fn sections() -> Vec<(String, Vec<&'static str>)> {
    vec![
        ("".to_owned(), keys::<MapFile>().to_vec()),
        ("file".to_owned(), keys::<FileKeys>().to_vec()),
        ("file.time".to_owned(), keys::<TimeKeys>().to_vec()),
        ("file.rows".to_owned(), keys::<RowsKeys>().to_vec()),
        ("file.channel".to_owned(), keys::<ChannelKeys>().to_vec()),
        ("constant".to_owned(), keys::<ConstantKeys>().to_vec()),
    ]
}
