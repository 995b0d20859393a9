//! The fields of a text as numbers and times, each refused with its line, its column and what was expected.

use std::path::Path;

use super::Record;
use super::columns::{Place, elements};
use crate::import::error::ImportError;
use crate::import::map::{ChannelMap, Column, FileMap, TextForm, TimeMap};
use crate::import::numbers::{self, Marks};
use crate::import::rows::Times;
use crate::import::units::LogUnit;
use crate::import::{stamps, words};
use crate::recording::Unit;

/// Digits from which a whole number is more than a double holds.
const LONG: usize = 16;

/// The rows of a file, to be read as numbers.
pub(super) struct Reading<'a> {
    pub path: &'a Path,
    pub rows: &'a [(u64, Record)],
    pub form: &'a TextForm,
    pub map: &'a FileMap,
}

impl Reading<'_> {
    fn marks(&self) -> Marks {
        Marks {
            decimal: self.form.decimal_mark,
            thousands: self.form.thousands_mark,
        }
    }

    /// The number of a channel in a row.
    pub fn number(
        &self,
        row: usize,
        place: Place,
        channel: &ChannelMap,
    ) -> Result<f64, ImportError> {
        let (line, fields) = &self.rows[row];
        let whole = &fields[place.column];
        let field = match place.element {
            None => whole,
            Some(_) if whole.is_empty() => whole,
            Some(element) => {
                let found = elements(whole).and_then(|all| all.get(element).copied());
                found.ok_or_else(|| {
                    let expected = format!("a vector with an element {element}, counted from 0");
                    self.refuse(row, &channel.column, whole, expected)
                })?
            }
        };
        if self.map.missing.has_text(field) {
            return Ok(f64::NAN);
        }
        // Only what has no unit can be of two states.
        let of_states = channel.unit.si == Unit::One;
        let number = if of_states {
            self.marks().number_or_word(field)
        } else {
            self.marks().number(field)
        };
        number.ok_or_else(|| {
            let expected = match self.expected(field, *line, place.column, self.marks()) {
                plain if of_states && plain == "a number" => {
                    format!("a number or a word such as {}", words::EXAMPLES)
                }
                plain if plain == "a number" => plain + &how_to_go_on(field),
                other => other,
            };
            self.refuse(row, &channel.column, field, expected)
        })
    }

    /// Whether a field holds a time, as the map has it.
    pub fn is_time(&self, row: usize, place: usize) -> bool {
        let Some(field) = self.rows[row].1.get(place) else {
            return false;
        };
        match &self.map.time {
            Some(time) if time.unit.is_none() && self.map.sample_rate.is_none() => {
                stamps::is_stamp(field)
            }
            Some(time) => self
                .time_marks(time)
                .number(field)
                .is_some_and(f64::is_finite),
            None => false,
        }
    }

    /// Whether a field holds a number or a mark of none.
    pub fn is_number(&self, row: usize, place: Place) -> bool {
        let field = self.rows[row].1.get(place.column).unwrap_or("");
        place.element.is_some()
            || self.map.missing.has_text(field)
            || self.marks().number_or_word(field).is_some()
    }

    /// Times of these rows, of a column of numbers or of stamps, whose dates may stand in another.
    pub fn times(
        &self,
        rows: &[usize],
        [place, date]: [Option<usize>; 2],
        map: &TimeMap,
    ) -> Result<Times, ImportError> {
        let place = place.unwrap_or_default();
        if map.unit.is_some() || self.map.sample_rate.is_some() {
            if let Some(times) = map.unit.and_then(|unit| self.long_times(rows, place, unit)) {
                return Ok(Times::Nanoseconds(times));
            }
            let times = rows.iter().map(|row| self.time(*row, place, map));
            return Ok(Times::Numbers(times.collect::<Result<_, _>>()?));
        }
        let stamp = |row: &usize| {
            let fields = &self.rows[*row].1;
            match date {
                Some(date) => format!("{} {}", &fields[date], &fields[place]),
                None => fields[place].to_owned(),
            }
        };
        let texts: Vec<String> = rows.iter().map(stamp).collect();
        let read = stamps::nanoseconds(&texts, map.reading());
        read.map(Times::Nanoseconds).map_err(|unread| {
            let found = &texts[unread.index];
            let expected = unread.expected + &self.how_to_leave_out(rows[unread.index], found);
            self.refuse(rows[unread.index], &map.column, found, expected)
        })
    }

    /// Times that are whole numbers of more digits than a double holds [ns since 1970, or since a start].
    fn long_times(&self, rows: &[usize], place: usize, unit: &LogUnit) -> Option<Vec<i64>> {
        let tick = (unit.factor * 1e9).round();
        let is_whole = tick >= 1.0 && (unit.factor * 1e9 - tick).abs() < 1e-9 * tick;
        let first = &self.rows[*rows.first()?].1[place];
        if !is_whole || first.len() < LONG {
            return None;
        }
        let time = |row: &usize| {
            let ticks: i128 = self.rows[*row].1[place].parse().ok()?;
            i64::try_from((ticks + unit.zero as i128) * tick as i128).ok()
        };
        rows.iter().map(time).collect()
    }

    fn time_marks(&self, map: &TimeMap) -> Marks {
        let own = self.marks();
        Marks {
            thousands: map.thousands_mark.or(own.thousands),
            // A time whose marks all are of thousands has no decimals.
            decimal: match map.thousands_mark {
                Some(mark) if mark == own.decimal => {
                    if mark == '.' {
                        ','
                    } else {
                        '.'
                    }
                }
                _ => own.decimal,
            },
        }
    }

    fn time(&self, row: usize, place: usize, map: &TimeMap) -> Result<f64, ImportError> {
        let (line, fields) = &self.rows[row];
        let field = &fields[place];
        let marks = self.time_marks(map);
        let time = marks.number(field).filter(|time| time.is_finite());
        time.ok_or_else(|| {
            let expected = if stamps::is_stamp(field) {
                "a number; stamps say their unit themselves: leave out `unit` in [file.time]"
                    .to_owned()
            } else {
                self.expected(field, *line, place, marks)
                    .replacen("a number", "a time", 1)
                    + &self.how_to_leave_out(row, field)
            };
            self.refuse(row, &map.column, field, expected)
        })
    }

    /// How a line that is no row is left out.
    fn how_to_leave_out(&self, row: usize, found: &str) -> String {
        if numbers::seen(found) != numbers::Seen::Other || stamps::is_stamp(found) {
            return String::new();
        }
        let behind = self.rows.len() - row;
        format!(
            "; `skip_stray_lines = true` in [[file]] leaves out lines that are no rows, `drop_last_rows = {behind}` all from here on"
        )
    }

    fn expected(&self, field: &str, line: u64, place: usize, marks: Marks) -> String {
        let column = self.rows.iter();
        let column = column.filter_map(|(line, row)| Some((*line, row.get(place)?)));
        numbers::expected(field, line, marks, column)
    }

    fn refuse(&self, row: usize, column: &Column, found: &str, expected: String) -> ImportError {
        ImportError::Number {
            file: self.path.to_owned(),
            line: self.rows[row].0,
            column: column.clone(),
            found: found.to_owned(),
            expected,
        }
    }
}

/// What to do with a text where a number is expected: a vector has elements, a mark of a missing value is named.
fn how_to_go_on(field: &str) -> String {
    if elements(field).is_some_and(|all| {
        all.iter()
            .all(|text| numbers::seen(text) != numbers::Seen::Other)
    }) {
        return "; of a vector `column = \"NAME[0]\"` takes the first element".to_owned();
    }
    let plain = field.replace(['"', '\\'], "");
    format!("; where it stands for no value, `missing = [\"{plain}\"]` in [[file]] says so")
}
