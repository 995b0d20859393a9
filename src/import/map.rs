//! The import map: which column of a log is what. A small TOML file, one for all logs of a kind.
//!
//! ```text
//! SI value = unit(gain * number + offset)          negated where `reversed`; absolute where a pressure was gauge
//! ```

use std::path::PathBuf;

use super::stamps::{self, DateOrder, TwoNumbers};
use super::units::{LogUnit, raised};
use crate::file::Limit;
use crate::recording::{PhaseSpan, Unit};

/// Ending of a quantity whose pressure is above the atmosphere.
pub const GAUGE: &str = "_gauge";

/// A map, checked.
#[derive(Debug, Clone, PartialEq)]
pub struct ImportMap {
    /// File that it was read from.
    pub path: PathBuf,
    /// Name for people.
    pub title: String,
    /// The logs that make one recording, the one whose clock counts first.
    pub files: Vec<FileMap>,
    /// Constant quantities that no log holds.
    pub constants: Vec<Constant>,
    /// Phases of the job, where they are known.
    pub phases: Vec<PhaseSpan>,
    /// Whether the file itself says what it holds: no unit was chosen by hand, so none is doubted.
    pub says_itself: bool,
}

/// A quantity that no log holds, with the value that it has throughout.
#[derive(Debug, Clone, PartialEq)]
pub struct Constant {
    /// The quantity.
    pub quantity: String,
    /// Its unit in SI.
    pub unit: Unit,
    /// Its value [SI]; NaN where there is none, as where no part stands.
    pub value: f64,
}

/// One log.
#[derive(Debug, Clone, PartialEq)]
pub struct FileMap {
    /// Where it is, if the map says so.
    pub path: Option<PathBuf>,
    /// Whether it is the log of the file before it: another clock of that, or other rows.
    pub same_log: bool,
    /// Its form.
    pub form: Form,
    /// Rows left out at either end.
    pub dropped: [usize; 2],
    /// Whether the readable part of a log that is cut off is to be used.
    pub accepts_truncated: bool,
    /// What it may come to when it is unpacked and read.
    pub limit: Limit,
    /// Whether fewer than nine in ten of its rows may be used.
    pub accepts_unused_rows: bool,
    /// Whether a channel may have no value at all.
    pub accepts_empty: bool,
    /// Marks that stand for no value.
    pub missing: Missing,
    /// Which of its rows are meant, where it holds those of several variables.
    pub rows: Option<RowChoice>,
    /// Its clock.
    pub clock: Clock,
    /// Its times; none for those at which a bag's messages were logged, that a TDMS file's waveforms say, and where rows follow each other at a rate.
    pub time: Option<TimeMap>,
    /// Samples a second, of rows without times, or whose `time` counts them [Hz].
    pub sample_rate: Option<f64>,
    /// Its channels.
    pub channels: Vec<ChannelMap>,
}

/// Form of a log.
#[derive(Debug, Clone, PartialEq)]
pub enum Form {
    /// Text, a row a line.
    Text(TextForm),
    /// Parquet.
    Parquet,
    /// MATLAB's MAT, version 5.
    Mat5,
    /// A bag of ROS 2 messages: MCAP or SQLite, a file or the folder of one.
    Bag,
    /// TDMS of LabVIEW.
    Tdms,
    /// A sheet of a spreadsheet, read as the text that it would be exported as.
    Spreadsheet {
        /// Its name; none for the only one that holds anything.
        sheet: Option<String>,
        /// The form of that text.
        text: TextForm,
    },
}

/// Form of a text.
#[derive(Debug, Clone, PartialEq)]
pub struct TextForm {
    /// Its encoding, if the map says so.
    pub encoding: Option<String>,
    /// Separator of fields.
    pub separator: Separator,
    /// Mark before the decimals.
    pub decimal_mark: char,
    /// A mark that stands before every third digit of its numbers and means nothing.
    pub thousands_mark: Option<char>,
    /// Lines before the first row.
    pub header_lines: usize,
    /// The one of them, from 1, that names the columns.
    pub names_line: Option<usize>,
    /// Whether lines among the rows that are none are left out.
    pub skips_stray_lines: bool,
}

/// Marks that a log writes where it has no value.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Missing {
    /// Texts, in small letters.
    pub texts: Vec<String>,
    /// Numbers, as the log writes them.
    pub numbers: Vec<f64>,
}

impl Missing {
    /// Whether a number stands for no value.
    #[must_use]
    pub fn has(&self, number: f64) -> bool {
        self.numbers.contains(&number)
    }

    /// Whether a text does.
    #[must_use]
    pub fn has_text(&self, text: &str) -> bool {
        !self.texts.is_empty() && self.texts.contains(&text.to_lowercase())
    }
}

/// Rows that are meant: those with this text in that column.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct RowChoice {
    /// Where.
    pub column: Column,
    /// What stands there.
    pub value: String,
}

/// Separator of fields.
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
    /// In what; none for stamps, which say it themselves.
    pub unit: Option<&'static LogUnit>,
    /// A mark that stands before every third digit and means nothing.
    pub thousands_mark: Option<char>,
    /// Of stamps: where the date stands, if not beside the time.
    pub date_column: Option<Column>,
    /// Of stamps: the order of day, month and year, if the map says so.
    pub date_order: Option<DateOrder>,
    /// Of stamps without a year: the year.
    pub year: Option<i32>,
    /// Of stamps of two numbers, `14:02`: what they are, if the map says so.
    pub two_numbers: Option<TwoNumbers>,
}

impl TimeMap {
    /// What it says of stamps.
    pub(super) fn reading(&self) -> stamps::Reading {
        stamps::Reading {
            order: self.date_order,
            year: self.year,
            two_numbers: self.two_numbers,
        }
    }
}

/// A log's channel.
#[derive(Debug, Clone, PartialEq)]
pub struct ChannelMap {
    /// Its quantity; ends with `_gauge` where it is a pressure above the atmosphere.
    pub quantity: String,
    /// Where.
    pub column: Column,
    /// Of messages with lists: the joint whose element is meant, by its name in the message.
    pub joint: Option<String>,
    /// Of messages with frames: the one whose messages are meant.
    pub frame: Option<String>,
    /// In what, after gain and offset.
    pub unit: &'static LogUnit,
    /// Factor on a number, as of a sensor in volts.
    pub gain: f64,
    /// Offset added then, in the unit.
    pub offset: f64,
    /// Whether the log's sign is the other one.
    pub reversed: bool,
    /// Against what the log's pressure is, where it is one.
    pub pressure: Option<Pressure>,
    /// Offset added in SI: the atmosphere, or less it, where log and quantity differ [Pa].
    pub above: f64,
}

/// Against what a pressure is measured.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Pressure {
    /// The atmosphere.
    Gauge,
    /// Nothing.
    Absolute,
}

impl ChannelMap {
    /// A number of the log in SI.
    #[must_use]
    pub fn to_si(&self, number: f64) -> f64 {
        let value = self.unit.to_si(raised(self.gain * number, self.offset));
        raised(if self.reversed { -value } else { value }, self.above)
    }

    /// The number of the log of a value in SI.
    #[must_use]
    pub fn written(&self, value: f64) -> f64 {
        let own = value - self.above;
        let own = if self.reversed { -own } else { own };
        (own / self.unit.factor - self.unit.zero - self.offset) / self.gain
    }

    /// Whether a number is taken as it stands, its unit apart.
    #[must_use]
    pub fn is_plain(&self) -> bool {
        self.gain == 1.0 && self.offset == 0.0
    }
}

#[cfg(test)]
impl ChannelMap {
    /// A channel without gain, its pressure gauge, for tests.
    pub(super) fn unconverted(quantity: &str, unit: &str) -> Self {
        let unit = super::units::named(unit).expect("tests name units that are there");
        Self {
            quantity: quantity.to_owned(),
            column: Column::Number(2),
            joint: None,
            frame: None,
            unit,
            gain: 1.0,
            offset: 0.0,
            reversed: false,
            pressure: (unit.si == crate::recording::Unit::Pascal).then_some(Pressure::Gauge),
            above: 0.0,
        }
    }
}
