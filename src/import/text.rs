//! A log as text: a row a line, fields divided by a character, by white space, or by their widths.

use std::path::Path;

use csv::StringRecord;

use super::error::ImportError;
use super::log::{Remark, Rows, Times, places};
use super::map::{Column, FileMap, Separator, TextForm};

/// Words that stand for no value.
const NOTHING: [&str; 6] = ["", "nan", "-nan", "na", "null", "-"];

/// Reads the rows of a text.
pub(super) fn read(path: &Path, form: &TextForm, map: &FileMap) -> Result<Rows, ImportError> {
    let bytes = std::fs::read(path).map_err(|cause| ImportError::Read {
        file: path.to_owned(),
        cause: cause.to_string(),
    })?;
    // A vendor's degree sign in another encoding is no reason to refuse the numbers.
    let text = String::from_utf8_lossy(&bytes);
    // Of a line that ends with both, the reader counts the end to the next one.
    let text = text.trim_start_matches('\u{feff}').replace("\r\n", "\n");
    let whole = text.ends_with('\n');
    let (header, body) = split_after(&text, form.header_lines);
    let rows =
        records(body, header.len() as u64, &form.separator).map_err(|cause| ImportError::Read {
            file: path.to_owned(),
            cause: cause.to_string(),
        })?;
    let Some((_, first)) = rows.first() else {
        return Err(ImportError::Read {
            file: path.to_owned(),
            cause: format!("no rows after {} header lines", header.len()),
        });
    };
    let names = match form.names_line.and_then(|line| header.get(line - 1)) {
        Some(line) => records(line, 0, &form.separator).ok(),
        None => None,
    };
    let names: Option<Vec<String>> = names.and_then(|lines| {
        let (_, names) = lines.into_iter().next()?;
        Some(names.iter().map(str::to_owned).collect())
    });
    let count = first.len();
    let (time_place, channel_places) = places(path, map, names.as_deref(), count)?;
    let needed = channel_places
        .iter()
        .chain(&time_place)
        .max()
        .map_or(0, |most| most + 1);
    let mut found = Rows {
        channels: (0..map.channels.len()).collect(),
        columns: vec![Vec::new(); channel_places.len()],
        ..Rows::default()
    };
    let mut times = Vec::new();
    for (index, (line, row)) in rows.iter().enumerate() {
        let is_last = index + 1 == rows.len();
        // A log that was cut off ends within a field, and what stands of it may be another number.
        let fields = match &form.separator {
            Separator::Widths(widths) if is_last => whole_fields(body, widths),
            _ => row.len(),
        };
        if is_last && !whole && fields < count {
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
        let reading = Reading {
            path,
            line: *line,
            decimal_mark: form.decimal_mark,
        };
        if let (Some(place), Some(time)) = (time_place, &map.time) {
            times.push(reading.time(&row[place], &time.column, time.thousands_mark)?);
        }
        for (numbers, (place, channel)) in found
            .columns
            .iter_mut()
            .zip(channel_places.iter().zip(&map.channels))
        {
            numbers.push(reading.number(&row[*place], &channel.column)?);
        }
        found.lines.push(*line);
        // A number that was cut off is shorter than the one before it.
        let before = index
            .checked_sub(1)
            .and_then(|i| rows[i].1.iter().next_back());
        let is_shorter = before.is_some_and(|text| row[row.len() - 1].len() < text.len());
        if is_last && !whole && needed == row.len() && is_shorter {
            found.remarks.push(Remark::Unended(*line));
        }
    }
    found.time = Times::Numbers(times);
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

/// Where a field stands.
struct Reading<'a> {
    path: &'a Path,
    line: u64,
    decimal_mark: char,
}

impl Reading<'_> {
    fn number(&self, field: &str, column: &Column) -> Result<f64, ImportError> {
        if NOTHING.contains(&field.to_ascii_lowercase().as_str()) {
            return Ok(f64::NAN);
        }
        self.parse(field)
            .ok_or_else(|| self.refuse(field, column, self.expected(field)))
    }

    fn time(
        &self,
        field: &str,
        column: &Column,
        thousands_mark: Option<char>,
    ) -> Result<f64, ImportError> {
        let plain: String = field
            .chars()
            .filter(|c| Some(*c) != thousands_mark)
            .collect();
        self.parse(&plain)
            .filter(|time| time.is_finite())
            .ok_or_else(|| {
                let marks = field.matches(['.', ',', '\'']).count();
                let expected = if marks > 1 && thousands_mark.is_none() {
                    "a time; `thousands_mark` tells of marks before every third digit".to_owned()
                } else {
                    self.expected(field)
                };
                self.refuse(field, column, expected)
            })
    }

    fn parse(&self, field: &str) -> Option<f64> {
        if self.decimal_mark == '.' {
            return field.parse().ok();
        }
        if field.contains('.') {
            return None;
        }
        field.replace(self.decimal_mark, ".").parse().ok()
    }

    fn expected(&self, field: &str) -> String {
        let other = if self.decimal_mark == '.' { ',' } else { '.' };
        if field.replace(other, ".").parse::<f64>().is_ok() {
            return format!("a number; with `decimal_mark = \"{other}\"` it would be one");
        }
        "a number".to_owned()
    }

    fn refuse(&self, field: &str, column: &Column, expected: String) -> ImportError {
        ImportError::Number {
            file: self.path.to_owned(),
            line: self.line,
            column: column.clone(),
            found: field.to_owned(),
            expected,
        }
    }
}
