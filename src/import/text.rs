//! A log as text: a row a line, fields divided by a character, by white space, or by their widths.

use std::path::Path;

use csv::StringRecord;

use super::encoding::{Told, decode};
use super::error::ImportError;
use super::map::{ChannelMap, Column, FileMap, Separator, TextForm, TimeMap};
use super::numbers::{self, Marks};
use super::packed::text_bytes;
use super::rows::{Remark, Rows, Times, place, places};
use super::{stamps, words};
use crate::recording::Unit;

/// The lines of a text, those before its rows apart.
pub(super) struct Sheet {
    /// Lines before the rows.
    pub header: Vec<String>,
    /// Fields of each row, with its line from 1.
    pub rows: Vec<(u64, StringRecord)>,
    /// Whether the last line ends.
    is_whole: bool,
    /// Fields that the last row holds to their ends.
    last_fields: usize,
}

impl Sheet {
    /// Takes a text apart, or says what the reader cannot.
    pub fn of(text: &str, header_lines: usize, separator: &Separator) -> Result<Self, String> {
        let (header, body) = split_after(text, header_lines);
        let rows = records(body, header.len() as u64, separator).map_err(|e| e.to_string())?;
        let last = rows.last().map_or(0, |(_, row)| row.len());
        Ok(Self {
            // A log that was cut off ends within a field, and what stands of it may be another number.
            last_fields: match separator {
                Separator::Widths(widths) => whole_fields(body, widths),
                _ => last,
            },
            header: header.into_iter().map(str::to_owned).collect(),
            rows,
            is_whole: text.ends_with('\n'),
        })
    }
}

/// A text's content in its encoding, its lines ended alike.
pub(super) fn content(path: &Path, encoding: Option<&str>) -> Result<(String, Told), ImportError> {
    let bytes = text_bytes(path)?;
    let (text, told) = decode(path, &bytes, encoding)?;
    // Of a line that ends with both, the reader counts the end to the next one.
    let text = text.replace("\r\n", "\n");
    let text = if text.contains('\n') {
        text
    } else {
        text.replace('\r', "\n")
    };
    Ok((text, told))
}

/// The fields of one line.
pub(super) fn fields(line: &str, separator: &Separator) -> Vec<String> {
    let records = records(line, 0, separator).unwrap_or_default();
    let first = records.into_iter().next();
    first.map_or_else(Vec::new, |(_, record)| {
        record.iter().map(str::to_owned).collect()
    })
}

/// Reads the rows of a text.
pub(super) fn read(path: &Path, form: &TextForm, map: &FileMap) -> Result<Rows, ImportError> {
    let (text, _) = content(path, form.encoding.as_deref())?;
    read_content(path, &text, form, map)
}

/// Reads the rows of a text that was taken from a file.
pub(super) fn read_content(
    path: &Path,
    text: &str,
    form: &TextForm,
    map: &FileMap,
) -> Result<Rows, ImportError> {
    let fail = |cause: String| ImportError::Read {
        file: path.to_owned(),
        cause,
    };
    let sheet = Sheet::of(text, form.header_lines, &form.separator).map_err(fail)?;
    let Some((_, first)) = sheet.rows.first() else {
        return Err(fail(format!(
            "no rows after {} header lines",
            sheet.header.len()
        )));
    };
    let names = form.names_line.and_then(|line| sheet.header.get(line - 1));
    let names = names.map(|line| fields(line, &form.separator));
    let count = first.len();
    let (time_place, channel_places) = places(path, map, names.as_deref(), count)?;
    let date_place = match map.time.as_ref().and_then(|time| time.date_column.as_ref()) {
        Some(column) => Some(place(path, column, names.as_deref(), count)?),
        None => None,
    };
    let all = channel_places.iter().chain(&time_place).chain(&date_place);
    let needed = all.max().map_or(0, |most| most + 1);
    let mut found = Rows {
        channels: (0..map.channels.len()).collect(),
        columns: vec![Vec::new(); channel_places.len()],
        ..Rows::default()
    };
    let reading = Reading {
        path,
        rows: &sheet.rows,
        form,
    };
    for (index, (line, row)) in sheet.rows.iter().enumerate() {
        let is_last = index + 1 == sheet.rows.len();
        let fields = if is_last {
            sheet.last_fields
        } else {
            row.len()
        };
        if is_last && !sheet.is_whole && fields < count {
            let torn = torn(path, *line, fields, count, found.lines.len());
            if !map.accepts_truncated {
                return Err(torn);
            }
            let rest = format!("its last row, line {line}, is torn and was left out");
            found.remarks.push(Remark::Truncated(rest));
            break;
        }
        if row.len() < needed {
            return Err(ImportError::Fields {
                file: path.to_owned(),
                line: *line,
                found: row.len(),
                expected: needed,
            });
        }
        let columns = found.columns.iter_mut();
        for (numbers, (place, channel)) in columns.zip(channel_places.iter().zip(&map.channels)) {
            numbers.push(reading.number(index, *place, channel)?);
        }
        found.lines.push(*line);
        // A number that was cut off is shorter than the one before it.
        let before = index.checked_sub(1);
        let before = before.and_then(|i| sheet.rows[i].1.iter().next_back());
        let is_shorter = before.is_some_and(|text| row[row.len() - 1].len() < text.len());
        if is_last && !sheet.is_whole && needed == row.len() && is_shorter {
            found.remarks.push(Remark::Unended(*line));
        }
    }
    if let (Some(place), Some(time)) = (time_place, &map.time) {
        found.time = reading.times(found.lines.len(), [Some(place), date_place], time)?;
    }
    Ok(found)
}

/// Fields that the last line holds to their ends; all of them if it is as long as the first.
fn whole_fields(body: &str, widths: &[usize]) -> usize {
    let mut filled = body.lines().filter(|line| !line.trim().is_empty());
    let first = filled.next().map_or(0, |line| line.chars().count());
    let last = filled
        .next_back()
        .map_or(first, |line| line.chars().count());
    if last >= first {
        return widths.len();
    }
    let mut end = 0;
    let reaches = |width: &&usize| {
        end += **width;
        end <= last
    };
    widths.iter().take_while(reaches).count()
}

/// Refuses a log whose last line ends within a row.
fn torn(path: &Path, line: u64, fields: usize, expected: usize, rows: usize) -> ImportError {
    ImportError::Truncated {
        file: path.to_owned(),
        found: format!("its last row, line {line}, ends after {fields} of {expected} fields"),
        rest: format!("the {rows} rows before it can be read"),
        advice: "`accept_truncated = true` in the map's [[file]] uses them".to_owned(),
    }
}

/// A text's first lines, and what follows them.
fn split_after(text: &str, count: usize) -> (Vec<&str>, &str) {
    let mut rest = text;
    let mut lines = Vec::new();
    while lines.len() < count && !rest.is_empty() {
        let (line, after) = rest.split_once('\n').unwrap_or((rest, ""));
        lines.push(line);
        rest = after;
    }
    (lines, rest)
}

/// The fields of each line that has any, with its number from 1, that many lines standing before.
fn records(
    text: &str,
    before: u64,
    separator: &Separator,
) -> Result<Vec<(u64, StringRecord)>, csv::Error> {
    let plain = |split: &dyn Fn(&str) -> StringRecord| {
        let lines = (before + 1..).zip(text.lines());
        let filled = lines.filter(|(_, line)| !line.trim().is_empty());
        Ok(filled.map(|(number, line)| (number, split(line))).collect())
    };
    match separator {
        Separator::Character(character) => {
            let mut reader = csv::ReaderBuilder::new()
                .delimiter(*character)
                .has_headers(false)
                .flexible(true)
                .trim(csv::Trim::All)
                .from_reader(text.as_bytes());
            let numbered = |record: Result<StringRecord, csv::Error>| {
                let record = record?;
                let line = record.position().map_or(0, csv::Position::line);
                Ok((before + line, record))
            };
            reader.records().map(numbered).collect()
        }
        Separator::Whitespace => plain(&|line| line.split_whitespace().collect::<Vec<_>>().into()),
        Separator::Widths(widths) => plain(&|line| cut(line, widths).into()),
    }
}

/// The fields of a line, each of a width in characters.
fn cut<'a>(line: &'a str, widths: &[usize]) -> Vec<&'a str> {
    let mut rest = line;
    let field = |width: &usize| {
        let end = rest.char_indices().nth(*width);
        let (field, after) = rest.split_at(end.map_or(rest.len(), |(at, _)| at));
        rest = after;
        field.trim()
    };
    widths.iter().map(field).collect()
}

/// The rows of a file, to be read as numbers.
struct Reading<'a> {
    path: &'a Path,
    rows: &'a [(u64, StringRecord)],
    form: &'a TextForm,
}

impl Reading<'_> {
    fn marks(&self) -> Marks {
        Marks {
            decimal: self.form.decimal_mark,
            thousands: self.form.thousands_mark,
        }
    }

    fn number(&self, row: usize, place: usize, channel: &ChannelMap) -> Result<f64, ImportError> {
        let (line, fields) = &self.rows[row];
        let field = &fields[place];
        // Only what has no unit can be of two states.
        let of_states = channel.unit.si == Unit::One;
        let number = if of_states {
            self.marks().number_or_word(field)
        } else {
            self.marks().number(field)
        };
        number.ok_or_else(|| {
            let expected = match self.expected(field, *line, place, self.marks()) {
                plain if of_states && plain == "a number" => {
                    format!("a number or a word such as {}", words::EXAMPLES)
                }
                other => other,
            };
            self.refuse(row, &channel.column, field, expected)
        })
    }

    /// Times of the first rows, of a column of numbers or of stamps, whose dates may stand in another.
    fn times(
        &self,
        count: usize,
        [place, date]: [Option<usize>; 2],
        map: &TimeMap,
    ) -> Result<Times, ImportError> {
        let place = place.unwrap_or_default();
        let rows = &self.rows[..count];
        if map.unit.is_some() {
            let times = (0..count).map(|row| self.time(row, place, map));
            return Ok(Times::Numbers(times.collect::<Result<_, _>>()?));
        }
        let stamp = |(_, fields): &(u64, StringRecord)| match date {
            Some(date) => format!("{} {}", &fields[date], &fields[place]),
            None => fields[place].to_owned(),
        };
        let stamps: Vec<String> = rows.iter().map(stamp).collect();
        let read = stamps::nanoseconds(&stamps, map.date_order, map.year);
        read.map(Times::Nanoseconds).map_err(|unread| {
            let found = &stamps[unread.index];
            self.refuse(unread.index, &map.column, found, unread.expected)
        })
    }

    fn time(&self, row: usize, place: usize, map: &TimeMap) -> Result<f64, ImportError> {
        let (line, fields) = &self.rows[row];
        let field = &fields[place];
        let own = self.marks();
        let marks = Marks {
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
        };
        let time = marks.number(field).filter(|time| time.is_finite());
        time.ok_or_else(|| {
            let expected = if stamps::is_stamp(field) {
                "a number; stamps say their unit themselves: leave out `unit` in [file.time]"
                    .to_owned()
            } else {
                self.expected(field, *line, place, marks)
                    .replacen("a number", "a time", 1)
            };
            self.refuse(row, &map.column, field, expected)
        })
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
