//! The import map: which column of a log is what. A small TOML file, one for all logs of a kind.
//!
//!     SI value = unit(gain * number + offset)          negated where `reversed`; absolute where a pressure was gauge

use std::path::{Path, PathBuf};

use serde::Deserialize;

use super::units::{self, LogUnit};
use crate::recording::Unit;
use crate::scenario::ScenarioError;
use crate::scenario::check::Section;
use crate::scenario::document::{Document, read_text};
use crate::scenario::sections::keys;

/// Version of the format.
const SCHEMA: u32 = 1;
/// Atmosphere where the map says nothing [Pa].
const STANDARD_ATMOSPHERE: f64 = 101_325.0;
/// What a quantity ends with whose pressure is above the atmosphere.
pub const GAUGE: &str = "_gauge";

/// The file as it is written.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct MapFile {
    #[allow(dead_code, reason = "checked by Document::new")]
    schema: u32,
    title: String,
    atmosphere_pa: Option<f64>,
    file: Vec<FileKeys>,
}

/// `[[file]]`.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct FileKeys {
    path: Option<PathBuf>,
    form: FormKey,
    separator: Option<String>,
    field_widths: Option<Vec<usize>>,
    decimal_mark: Option<String>,
    header_lines: Option<usize>,
    names_line: Option<usize>,
    drop_first_rows: Option<usize>,
    drop_last_rows: Option<usize>,
    clock: Option<ClockKey>,
    clock_offset_s: Option<f64>,
    aligned_by: Option<[String; 2]>,
    largest_offset_s: Option<f64>,
    time: Option<TimeKeys>,
    channel: Vec<ChannelKeys>,
}

/// `form`.
#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(rename_all = "snake_case")]
enum FormKey {
    Text,
    Parquet,
    Mat5,
    Mcap,
}

/// `clock`.
#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(rename_all = "snake_case")]
enum ClockKey {
    Shared,
    Unknown,
}

/// `[file.time]`.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct TimeKeys {
    column: ColumnKey,
    unit: String,
    thousands_mark: Option<String>,
}

/// `[[file.channel]]`.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct ChannelKeys {
    quantity: String,
    column: ColumnKey,
    unit: String,
    gain: Option<f64>,
    offset: Option<f64>,
    reversed: Option<bool>,
    pressure: Option<PressureKey>,
}

/// A column by its number from 1, or by its name.
#[derive(Debug, Deserialize)]
#[serde(untagged)]
enum ColumnKey {
    Number(usize),
    Name(String),
}

/// `pressure`.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
#[serde(rename_all = "snake_case")]
enum PressureKey {
    Gauge,
    Absolute,
}

/// A map, checked.
#[derive(Debug, Clone, PartialEq)]
pub struct ImportMap {
    /// File that it was read from.
    pub path: PathBuf,
    /// Name for people.
    pub title: String,
    /// The logs that make one recording, the one whose clock counts first.
    pub files: Vec<FileMap>,
}

/// One log.
#[derive(Debug, Clone, PartialEq)]
pub struct FileMap {
    /// Where it is, if the map says so.
    pub path: Option<PathBuf>,
    /// How it is written.
    pub form: Form,
    /// Rows left out at either end.
    pub dropped: [usize; 2],
    /// Its clock.
    pub clock: Clock,
    /// Its times; none where the form has its own.
    pub time: Option<TimeMap>,
    /// Its channels.
    pub channels: Vec<ChannelMap>,
}

/// How a log is written.
#[derive(Debug, Clone, PartialEq)]
pub enum Form {
    /// Text, a row a line.
    Text(TextForm),
    /// Parquet.
    Parquet,
    /// MATLAB's MAT, version 5.
    Mat5,
    /// MCAP with ROS 2 messages.
    Mcap,
}

/// How a text is written.
#[derive(Debug, Clone, PartialEq)]
pub struct TextForm {
    /// What stands between fields.
    pub separator: Separator,
    /// What stands before the decimals.
    pub decimal_mark: char,
    /// Lines before the first row.
    pub header_lines: usize,
    /// The one of them, from 1, that names the columns.
    pub names_line: Option<usize>,
}

/// What stands between fields.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Separator {
    /// A character of ASCII.
    Character(u8),
    /// Any number of spaces and tabs.
    Whitespace,
    /// Nothing: each field has a width, in characters.
    Widths(Vec<usize>),
}

/// A log's clock against that of the first.
#[derive(Debug, Clone, PartialEq)]
pub enum Clock {
    /// The same but for an offset that is added [s].
    Shared {
        /// Added to its times [s].
        offset: f64,
    },
    /// Off by what is to be found.
    Unknown {
        /// A quantity of the first log and one of this that rise and fall together.
        by: [String; 2],
        /// Largest offset that is looked at [s].
        largest: f64,
    },
}

/// A column by its number from 1, or by its name.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Column {
    /// Number.
    Number(usize),
    /// Name.
    Name(String),
}

impl std::fmt::Display for Column {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Number(number) => write!(f, "column {number}"),
            Self::Name(name) => write!(f, "column `{name}`"),
        }
    }
}

/// A log's times.
#[derive(Debug, Clone, PartialEq)]
pub struct TimeMap {
    /// Where.
    pub column: Column,
    /// In what.
    pub unit: &'static LogUnit,
    /// A mark that stands before every third digit and means nothing.
    pub thousands_mark: Option<char>,
}

/// A log's channel.
#[derive(Debug, Clone, PartialEq)]
pub struct ChannelMap {
    /// What it is; ends with `_gauge` where it is a pressure above the atmosphere.
    pub quantity: String,
    /// Where.
    pub column: Column,
    /// In what, after gain and offset.
    pub unit: &'static LogUnit,
    /// What a number is multiplied by, as of a sensor in volts.
    pub gain: f64,
    /// What is added then, in the unit.
    pub offset: f64,
    /// Is the log's sign the other one?
    pub reversed: bool,
    /// What is added in SI: the atmosphere, or less it, where log and quantity differ [Pa].
    pub above: f64,
}

impl ChannelMap {
    /// A number of the log in SI.
    #[must_use]
    pub fn to_si(&self, number: f64) -> f64 {
        let value = self.unit.to_si(self.gain * number + self.offset);
        self.above + if self.reversed { -value } else { value }
    }
}

/// Reads and checks a map.
///
/// # Errors
/// File, line, column and key of what is wrong, what was found and what was expected.
pub fn load_map(path: &Path) -> Result<ImportMap, ScenarioError> {
    let text = read_text(path)?;
    let document = Document::new(path, &text, SCHEMA)?;
    let keys: MapFile = document.parse(&sections())?;
    let top = Section::new(&document, "");
    let atmosphere = top.number_or(
        "atmosphere_pa",
        keys.atmosphere_pa,
        STANDARD_ATMOSPHERE,
        3e4..=1.2e5,
    )?;
    let mut files = Vec::new();
    for (index, file) in keys.file.iter().enumerate() {
        files.push(file_map(&document, index, file, atmosphere)?);
    }
    if files.is_empty() {
        return Err(top.missing("file", "one [[file]] at least"));
    }
    let map = ImportMap {
        path: path.to_owned(),
        title: top.text("title", &keys.title)?,
        files,
    };
    check_together(&document, &map)?;
    Ok(map)
}

fn sections() -> Vec<(&'static str, &'static [&'static str])> {
    vec![
        ("", keys::<MapFile>()),
        ("file", keys::<FileKeys>()),
        ("file.time", keys::<TimeKeys>()),
        ("file.channel", keys::<ChannelKeys>()),
    ]
}

fn file_map(
    document: &Document<'_>,
    index: usize,
    keys: &FileKeys,
    atmosphere: f64,
) -> Result<FileMap, ScenarioError> {
    let table = format!("file[{index}]");
    let section = Section::new(document, table.clone());
    let time = keys
        .time
        .as_ref()
        .map(|time| time_map(document, &table, time))
        .transpose()?;
    if time.is_none() && !matches!(keys.form, FormKey::Mcap) {
        return Err(section.missing("time", "the column that holds the times, and its unit"));
    }
    let channels = keys.channel.iter().enumerate();
    Ok(FileMap {
        path: keys.path.as_ref().map(|path| document.folder().join(path)),
        form: form(&section, keys)?,
        dropped: [
            keys.drop_first_rows.unwrap_or(0),
            keys.drop_last_rows.unwrap_or(0),
        ],
        clock: clock(&section, index, keys)?,
        time,
        channels: channels
            .map(|(i, channel)| {
                channel_map(
                    document,
                    format!("{table}.channel[{i}]"),
                    channel,
                    atmosphere,
                )
            })
            .collect::<Result<_, _>>()?,
    })
}

fn form(section: &Section<'_>, keys: &FileKeys) -> Result<Form, ScenarioError> {
    let of_text = [
        ("separator", keys.separator.is_some()),
        ("field_widths", keys.field_widths.is_some()),
        ("decimal_mark", keys.decimal_mark.is_some()),
        ("header_lines", keys.header_lines.is_some()),
        ("names_line", keys.names_line.is_some()),
    ];
    let other = match keys.form {
        FormKey::Text => return text_form(section, keys).map(Form::Text),
        FormKey::Parquet => Form::Parquet,
        FormKey::Mat5 => Form::Mat5,
        FormKey::Mcap => Form::Mcap,
    };
    match of_text.iter().find(|(_, given)| *given) {
        Some((key, _)) => Err(section.misplaced(key, "only a text has it".to_owned())),
        None => Ok(other),
    }
}

fn text_form(section: &Section<'_>, keys: &FileKeys) -> Result<TextForm, ScenarioError> {
    let separator = match (&keys.separator, &keys.field_widths) {
        (Some(_), Some(_)) => {
            let reason = "fields have widths, or something between them".to_owned();
            return Err(section.misplaced("field_widths", reason));
        }
        (None, Some(widths)) if widths.is_empty() || widths.contains(&0) => {
            let expected = "a width of at least 1 for each field".to_owned();
            return Err(section.refuse("field_widths", format!("{widths:?}"), expected));
        }
        (None, Some(widths)) => Separator::Widths(widths.clone()),
        (None, None) => Separator::Character(b','),
        (Some(name), None) => match name.as_str() {
            "whitespace" => Separator::Whitespace,
            "tab" => Separator::Character(b'\t'),
            name => {
                let character = single(section, "separator", name, "\"whitespace\" or \"tab\"")?;
                Separator::Character(u8::try_from(character).map_err(|_| {
                    let expected = "a character of ASCII".to_owned();
                    section.refuse("separator", format!("{name:?}"), expected)
                })?)
            }
        },
    };
    let header_lines = keys
        .header_lines
        .unwrap_or(usize::from(keys.names_line.is_some()));
    if let Some(line) = keys.names_line {
        section.count("names_line", line, 1..=header_lines.max(1))?;
    }
    let decimal_mark = match &keys.decimal_mark {
        Some(mark) => single(section, "decimal_mark", mark, "such as \".\" or \",\"")?,
        None => '.',
    };
    if u8::try_from(decimal_mark).is_ok_and(|mark| separator == Separator::Character(mark)) {
        let expected = "another character than between fields".to_owned();
        return Err(section.refuse("decimal_mark", format!("{decimal_mark:?}"), expected));
    }
    Ok(TextForm {
        separator,
        decimal_mark,
        header_lines,
        names_line: keys.names_line,
    })
}

/// A text of one character.
fn single(
    section: &Section<'_>,
    key: &str,
    text: &str,
    besides: &str,
) -> Result<char, ScenarioError> {
    let mut characters = text.chars();
    match (characters.next(), characters.next()) {
        (Some(character), None) => Ok(character),
        _ => Err(section.refuse(
            key,
            format!("{text:?}"),
            format!("one character, {besides}"),
        )),
    }
}

fn clock(section: &Section<'_>, index: usize, keys: &FileKeys) -> Result<Clock, ScenarioError> {
    match keys.clock.unwrap_or(ClockKey::Shared) {
        ClockKey::Shared => {
            for (key, given) in [
                ("aligned_by", keys.aligned_by.is_some()),
                ("largest_offset_s", keys.largest_offset_s.is_some()),
            ] {
                if given {
                    let reason = "the clock is shared; \"unknown\" has it found".to_owned();
                    return Err(section.misplaced(key, reason));
                }
            }
            let offset =
                section.number_or("clock_offset_s", keys.clock_offset_s, 0.0, -1e9..=1e9)?;
            Ok(Clock::Shared { offset })
        }
        ClockKey::Unknown if index == 0 => {
            let reason = "the first file's clock is the recording's".to_owned();
            Err(section.misplaced("clock", reason))
        }
        ClockKey::Unknown => {
            if keys.clock_offset_s.is_some() {
                let reason = "the clock is unknown; \"shared\" has an offset".to_owned();
                return Err(section.misplaced("clock_offset_s", reason));
            }
            let Some(by) = keys.aligned_by.clone() else {
                let expected =
                    "a quantity of the first file and one of this that rise and fall together";
                return Err(section.missing("aligned_by", expected));
            };
            let largest = section.number_or(
                "largest_offset_s",
                keys.largest_offset_s,
                10.0,
                1e-3..=3600.0,
            )?;
            Ok(Clock::Unknown { by, largest })
        }
    }
}

fn time_map(
    document: &Document<'_>,
    table: &str,
    keys: &TimeKeys,
) -> Result<TimeMap, ScenarioError> {
    let section = Section::new(document, format!("{table}.time"));
    let mark = |text: &String| single(&section, "thousands_mark", text, "such as \".\" or \"'\"");
    Ok(TimeMap {
        column: column(&section, &keys.column)?,
        unit: unit(&section, &keys.unit, Some(Unit::Second))?,
        thousands_mark: keys.thousands_mark.as_ref().map(mark).transpose()?,
    })
}

fn channel_map(
    document: &Document<'_>,
    table: String,
    keys: &ChannelKeys,
    atmosphere: f64,
) -> Result<ChannelMap, ScenarioError> {
    let section = Section::new(document, table);
    let unit = unit(&section, &keys.unit, None)?;
    let plain = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '_';
    if keys.quantity.is_empty() || !keys.quantity.chars().all(plain) {
        let expected = "a name of small letters, digits and underscores, without a unit".to_owned();
        return Err(section.refuse("quantity", format!("{:?}", keys.quantity), expected));
    }
    let gauge = keys.quantity.ends_with(GAUGE);
    let above = match (unit.si, keys.pressure) {
        (Unit::Pascal, None) => {
            let expected = "\"gauge\" or \"absolute\": what the log holds";
            return Err(section.missing("pressure", expected));
        }
        (Unit::Pascal, Some(PressureKey::Gauge)) if !gauge => atmosphere,
        (Unit::Pascal, Some(PressureKey::Absolute)) if gauge => -atmosphere,
        (Unit::Pascal, Some(_)) | (_, None) => 0.0,
        (_, Some(_)) => {
            let reason = format!("{} is no unit of a pressure", unit.name);
            return Err(section.misplaced("pressure", reason));
        }
    };
    Ok(ChannelMap {
        quantity: keys.quantity.clone(),
        column: column(&section, &keys.column)?,
        unit,
        gain: gain(&section, keys.gain)?,
        offset: section.number_or("offset", keys.offset, 0.0, -1e12..=1e12)?,
        reversed: keys.reversed.unwrap_or(false),
        above,
    })
}

fn gain(section: &Section<'_>, given: Option<f64>) -> Result<f64, ScenarioError> {
    match given {
        Some(gain) if gain == 0.0 || !gain.is_finite() => Err(section.refuse(
            "gain",
            gain.to_string(),
            "a number other than 0; `reversed = true` for the other sign".to_owned(),
        )),
        given => Ok(given.unwrap_or(1.0)),
    }
}

fn column(section: &Section<'_>, key: &ColumnKey) -> Result<Column, ScenarioError> {
    match key {
        ColumnKey::Number(0) => {
            let expected = "a number from 1 on, or a name".to_owned();
            Err(section.refuse("column", "0".to_owned(), expected))
        }
        ColumnKey::Number(number) => Ok(Column::Number(*number)),
        ColumnKey::Name(name) => Ok(Column::Name(section.text("column", name)?)),
    }
}

fn unit(
    section: &Section<'_>,
    name: &str,
    kind: Option<Unit>,
) -> Result<&'static LogUnit, ScenarioError> {
    let known = units::named(name).filter(|unit| kind.is_none_or(|kind| unit.si == kind));
    known.ok_or_else(|| {
        let expected = match kind {
            Some(kind) => units::of_kind(kind).join(", "),
            None => {
                let all: Vec<&str> = units::UNITS.iter().map(|unit| unit.name).collect();
                all.join(", ")
            }
        };
        section.refuse("unit", format!("{name:?}"), format!("one of {expected}"))
    })
}

/// Every quantity once, and clocks aligned by quantities that are there.
fn check_together(document: &Document<'_>, map: &ImportMap) -> Result<(), ScenarioError> {
    let mut seen: Vec<&str> = Vec::new();
    for (index, file) in map.files.iter().enumerate() {
        let table = format!("file[{index}]");
        for (i, channel) in file.channels.iter().enumerate() {
            if seen.contains(&channel.quantity.as_str()) {
                let section = Section::new(document, format!("{table}.channel[{i}]"));
                let expected = "every quantity once".to_owned();
                return Err(section.refuse(
                    "quantity",
                    format!("{:?}", channel.quantity),
                    expected,
                ));
            }
            seen.push(&channel.quantity);
        }
        let Clock::Unknown { by, .. } = &file.clock else {
            continue;
        };
        for (k, (owner, name)) in [&map.files[0], file].into_iter().zip(by).enumerate() {
            if !owner.channels.iter().any(|c| c.quantity == *name) {
                let section = Section::new(document, table.clone());
                let names: Vec<&str> = owner.channels.iter().map(|c| c.quantity.as_str()).collect();
                let which = ["the first file", "this file"][k];
                let expected = format!("a quantity of {which}: {}", names.join(", "));
                return Err(section.refuse("aligned_by", format!("{name:?}"), expected));
            }
        }
    }
    Ok(())
}
