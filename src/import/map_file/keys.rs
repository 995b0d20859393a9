//! The keys of an import map.

use std::path::PathBuf;

use serde::Deserialize;
use serde::de::{Deserializer, Error, Unexpected, Visitor};

use crate::import::map::Column;
use crate::keys::declaration::of_file;
use crate::keys::declaration::{Plain, keys};

impl Plain for FormKey {}
impl Plain for ClockKey {}
impl Plain for DateOrderKey {}
impl Plain for TwoNumbersKey {}
impl Plain for MarkKey {}
impl Plain for Vec<MarkKey> {}
impl Plain for PressureKey {}
impl Plain for ColumnKey {}

keys! {
    /// An import map: what the columns of logs are.
    pub(super) struct MapFile {
        /// version of the format, 1
        schema: u32 = "schema" in 1..=1;
        /// name for people
        title: String = "title";
        /// atmosphere, between gauge and absolute
        atmosphere: f64 = "atmosphere_pa" in 3e4..=1.2e5, or 101_325.0;
        /// the logs, `[[file]]`
        file: Vec<FileKeys> = "file" must stand;
        /// what no log holds and does not change, `[[constant]]`
        constant: Vec<ConstantKeys> = "constant";
    }

    /// `[[file]]`: a log.
    pub(super) struct FileKeys {
        /// the log, from the map's folder
        path: Option<PathBuf> = "path", shown "it is given after the map";
        /// `true` reads the log of the `[[file]]` before it: columns of another clock, or the rows of another variable
        same_log: bool = "same_log", or false, shown "a log of its own";
        /// `"text"`, `"spreadsheet"` (xlsx, xlsb, xls, ods), `"parquet"`, `"mat5"` (MATLAB 5 to 7), `"tdms"` (LabVIEW) or `"bag"` (ROS 2: MCAP or SQLite, a file or
        /// the folder of one; `"mcap"` is the same)
        form: FormKey = "form";
        /// of a spreadsheet: the sheet
        sheet: Option<String> = "sheet", shown "the only one that holds anything; refused where there are several";
        /// of a text: `"utf-8"`, `"windows-1252"`, `"utf-16le"`, `"utf-16be"` or another that the WHATWG lists
        encoding: Option<String> = "encoding", shown "detected from its bytes; refused where they do not decide";
        /// of a text: a character, `"tab"` or `"whitespace"` (any number of spaces and tabs)
        separator: Option<String> = "separator", shown "\",\"";
        /// of a text: the characters of each field, in place of a separator
        field_widths: Option<Vec<usize>> = "field_widths";
        /// of a text: `"."` or `","`; with commas between fields as well, fields with decimals must be quoted
        decimal_mark: Option<String> = "decimal_mark", shown "\".\"";
        /// of a text: a mark before every third digit that means nothing: `1.003,5`, `1'003.5`; `" "` is any space
        thousands_mark: Option<String> = "thousands_mark";
        /// of a text: lines before the first row
        header_lines: Option<usize> = "header_lines", shown "0, or 1 with `names_line`";
        /// of a text: the line, from 1, that names the columns
        names_line: Option<usize> = "names_line", shown "columns have numbers alone";
        /// rows left out at the start, of a bag messages of each topic; of a text nothing is read of them, and lines without fields do not count
        drop_first_rows: usize = "drop_first_rows", or 0;
        /// the same at the end
        drop_last_rows: usize = "drop_last_rows", or 0;
        /// of a text: `true` leaves out lines among its rows in which no time stands (without times, no number): a second header, a footer
        skip_stray_lines: Option<bool> = "skip_stray_lines", shown "such a line is refused";
        /// marks that stand for no value: `["OVER", "#DIV/0!", -9999]`; texts of a text alone
        missing: Option<Vec<MarkKey>> = "missing", shown "empty fields, `nan`, `n/a`, `null`, `-` and the like";
        /// of a text: which rows are meant, where each has another variable: `{ column = "VarName", value = "Force" }`
        rows: Option<RowsKeys> = "rows", shown "all";
        /// `true` accepts that fewer than nine in ten rows are used
        accept_unused_rows: bool = "accept_unused_rows", or false, shown "such a log is refused, and why they are not said";
        /// `true` uses what can be read of a log that is cut off; not for Parquet, of which nothing can
        accept_truncated: Option<bool> = "accept_truncated", shown "such a log is refused, and what could be read of it said";
        /// what the log may come to when it is unpacked and read, in MB
        largest_megabytes: Option<usize> = "largest_mb", shown "400; packed 200 times its size, and 256 at least";
        /// where the times stand
        time: Option<TimeKeys> = "time", shown "refused, unless there is a `sample_rate_hz`; of a bag the times at which messages were logged, of TDMS those that its waveforms say";
        /// samples a second, where no column holds times; with `time` the column counts samples, and has no unit
        sample_rate: Option<f64> = "sample_rate_hz" in 1e-3..=1e7;
        /// `"shared"`: that of the first log; `"unknown"`: off by what is to be found
        clock: ClockKey = "clock", or "shared";
        /// of a shared clock: added to its times
        clock_offset: f64 = "clock_offset_s" in -1e9..=1e9, or 0.0;
        /// of an unknown clock: a quantity of the first log and one of this that rise and fall together, or against each other
        aligned_by: Option<[String; 2]> = "aligned_by", shown "refused";
        /// of an unknown clock: how far off it may be
        largest_offset: f64 = "largest_offset_s" in 1e-3..=3600.0, or 10.0;
        /// its channels, `[[file.channel]]`
        channel: Vec<ChannelKeys> = "channel" must stand;
    }

    /// `[file.time]`.
    pub(super) struct TimeKeys {
        /// column of the times
        column: ColumnKey = "column";
        /// its unit; none for stamps, which say it themselves
        unit: Option<String> = "unit", shown "the column holds stamps";
        /// of a text: a mark before every third digit that means nothing, as spreadsheets write it: `1.003.000`
        thousands_mark: Option<String> = "thousands_mark", shown "that of the file";
        /// of stamps in a text: where the dates stand, if not beside the times
        date_column: Option<ColumnKey> = "date_column";
        /// of stamps in a text: `"day-month-year"`, `"month-day-year"` or `"year-month-day"`
        date_order: Option<DateOrderKey> = "date_order", shown "decided by all dates together; refused where none does";
        /// of stamps whose dates have none: the year
        year: Option<i32> = "year" in 1970..=2200, shown "such dates are refused";
        /// of stamps such as `14:02`: `"mm:ss"` or `"hh:mm"`
        two_numbers: Option<TwoNumbersKey> = "two_numbers", shown "refused, unless others of the log tell; with decimals they are minutes and seconds";
    }

    /// `[file.rows]`.
    pub(super) struct RowsKeys {
        /// column that names the variable of a row
        column: ColumnKey = "column";
        /// what stands there in the rows that are meant
        value: MarkKey = "value";
    }

    /// `[[file.channel]]`.
    pub(super) struct ChannelKeys {
        /// what it is; those of a rig or scenario are named there
        quantity: String = "quantity";
        /// where it is
        column: ColumnKey = "column";
        /// of a bag: the joint whose element of the list `column` is meant, by its name in the messages
        joint: Option<String> = "joint";
        /// of a bag: the frame whose messages are meant, `header.frame_id`
        frame: Option<String> = "frame", shown "messages of all frames";
        /// in what it is, after gain and offset
        unit: String = "unit";
        /// of a sensor in volts: what makes the unit of them, with the offset
        gain: f64 = "gain", or 1.0;
        /// of a sensor in volts: what is added then
        offset: f64 = "offset" in -1e12..=1e12, or 0.0;
        /// `true` where the log's sign is the other one
        reversed: bool = "reversed", or false;
        /// `"gauge"` or `"absolute"`: what the log holds
        pressure: Option<PressureKey> = "pressure", shown "refused where the unit is a pressure's";
    }

    /// `[[constant]]`.
    pub(super) struct ConstantKeys {
        /// what it is
        quantity: String = "quantity";
        /// its value throughout; `nan` where there is none, as where no part stands
        value: f64 = "value";
        /// its unit
        unit: String = "unit";
        /// `"gauge"` or `"absolute"`
        pressure: Option<PressureKey> = "pressure", shown "refused where the unit is a pressure's";
    }
}

/// `form`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, schemars::JsonSchema)]
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
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "snake_case")]
pub(super) enum ClockKey {
    Shared,
    Unknown,
}

/// `date_order`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub(super) enum DateOrderKey {
    YearMonthDay,
    DayMonthYear,
    MonthDayYear,
}

/// `two_numbers`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, schemars::JsonSchema)]
pub(super) enum TwoNumbersKey {
    #[serde(rename = "mm:ss")]
    MinutesSeconds,
    #[serde(rename = "hh:mm")]
    HoursMinutes,
}

/// A text or a number that a log writes: of `missing`, of `rows`.
#[derive(Debug, Clone, PartialEq, Deserialize, schemars::JsonSchema)]
#[serde(untagged)]
pub(super) enum MarkKey {
    Whole(i64),
    Number(f64),
    Text(String),
}

/// `pressure`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "snake_case")]
pub(super) enum PressureKey {
    Gauge,
    Absolute,
}

/// A column by its number from 1, or by its name.
#[derive(Debug, Clone, PartialEq)]
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

/// JSON Schema of a map.
pub(super) fn schema() -> serde_json::Value {
    of_file::<MapFile>("An import map of idc")
}
