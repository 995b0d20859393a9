//! The rows of a text as a map has them: what it drops is dropped before anything is read, then what holds nothing of its columns.

use std::path::Path;

use super::columns::{Place, place_of};
use super::reading::Reading;
use super::{Record, Sheet, content, fields};
use crate::import::error::ImportError;
use crate::import::map::{FileMap, Separator, TextForm};
use crate::import::rows::{Remark, Rows, Stray, Times};

/// Letters of a line that a remark shows.
const SHOWN: usize = 40;

/// Where a map's columns stand.
struct Places {
    channels: Vec<Place>,
    time: Option<usize>,
    date: Option<usize>,
    choice: Option<usize>,
}

impl Places {
    fn of(
        path: &Path,
        map: &FileMap,
        names: Option<&[String]>,
        count: usize,
    ) -> Result<Self, ImportError> {
        let place = |column| place_of(path, column, names, count);
        let column = |column| place(column).map(|place| place.column);
        let time = map.time.as_ref();
        let date = time.and_then(|time| time.date_column.as_ref());
        let channels = map.channels.iter().map(|channel| place(&channel.column));
        Ok(Self {
            channels: channels.collect::<Result<_, _>>()?,
            time: time.map(|time| column(&time.column)).transpose()?,
            date: date.map(column).transpose()?,
            choice: (map.rows.as_ref().map(|rows| column(&rows.column))).transpose()?,
        })
    }

    /// The columns that a row must have.
    fn needed(&self) -> impl Iterator<Item = usize> {
        let channels = self.channels.iter().map(|place| place.column);
        channels.chain(self.time).chain(self.date)
    }
}

/// Reads the rows of a text.
pub(in crate::import) fn read(
    path: &Path,
    form: &TextForm,
    map: &FileMap,
) -> Result<Rows, ImportError> {
    let (text, _) = content(path, form.encoding.as_deref(), map.limit)?;
    read_content(path, &text, form, map)
}

/// Reads the rows of a text that was taken from a file.
pub(in crate::import) fn read_content(
    path: &Path,
    text: &str,
    form: &TextForm,
    map: &FileMap,
) -> Result<Rows, ImportError> {
    let fail = |cause: String| ImportError::Read {
        file: path.to_owned(),
        cause,
    };
    let sheet = Sheet::of(text, form.header_lines, &form.separator, map.limit).map_err(fail)?;
    if sheet.rows.is_empty() {
        return Err(fail(format!(
            "no rows after {} header lines",
            sheet.header.len()
        )));
    }
    let names = form.names_line.and_then(|line| sheet.header.get(line - 1));
    let names = names.map(|line| fields(line, &form.separator));
    let rows = kept(path, map, &sheet.rows)?;
    // Rows may end early, but some have every column.
    let count = rows.iter().map(|(_, row)| row.len()).max().unwrap_or(0);
    let places = Places::of(path, map, names.as_deref(), count)?;
    check_quoted(path, form, rows, names.as_deref(), text)?;
    let reading = Reading {
        path,
        rows,
        form,
        map,
    };
    let mut found = Rows {
        channels: (0..map.channels.len()).collect(),
        columns: vec![Vec::new(); places.channels.len()],
        is_trimmed: true,
        ..Rows::default()
    };
    if map.dropped != [0, 0] {
        found.remarks.push(Remark::Dropped(map.dropped));
    }
    let end = End::of(&sheet, rows);
    let taken = end.check(path, map, rows, &mut found)?;
    let used = choose(&reading, &places, taken, &mut found)?;
    for row in &used {
        let columns = found.columns.iter_mut();
        for (numbers, (place, channel)) in columns.zip(places.channels.iter().zip(&map.channels)) {
            numbers.push(reading.number(*row, *place, channel)?);
        }
        found.lines.push(rows[*row].0);
    }
    found.time = match (places.time, &map.time) {
        (Some(place), Some(time)) => reading.times(&used, [Some(place), places.date], time)?,
        // At a rate, one behind the other.
        _ => Times::of_rate(used.len()),
    };
    if let Some(line) = end.unended(rows, &places, taken) {
        found.remarks.push(Remark::Unended(line));
    }
    Ok(found)
}

/// The rows that the map does not drop.
fn kept<'a>(
    path: &Path,
    map: &FileMap,
    rows: &'a [(u64, Record)],
) -> Result<&'a [(u64, Record)], ImportError> {
    let [first, last] = map.dropped;
    let end = rows.len().saturating_sub(last);
    if end < first + 2 {
        return Err(ImportError::TooShort {
            file: path.to_owned(),
            rows: rows.len(),
            dropped: first + last,
        });
    }
    Ok(&rows[first..end])
}

/// Rows to be read, by their places: those that are meant, that hold something of the map's columns and that are rows.
fn choose(
    reading: &Reading<'_>,
    places: &Places,
    count: usize,
    found: &mut Rows,
) -> Result<Vec<usize>, ImportError> {
    let needed = places.needed().max().map_or(0, |most| most + 1);
    let (mut others, mut hollow) = (0, 0);
    let mut strays = Vec::new();
    let mut used = Vec::new();
    for (index, (line, row)) in reading.rows[..count].iter().enumerate() {
        let chosen = reading.map.rows.as_ref().zip(places.choice);
        if chosen.is_some_and(|(choice, place)| row.get(place) != Some(choice.value.as_str())) {
            others += 1;
            continue;
        }
        let is_empty = |place: usize| row.get(place).is_none_or(str::is_empty);
        if places.time.is_some() && places.needed().all(is_empty) {
            hollow += 1;
            continue;
        }
        if reading.form.skips_stray_lines && is_stray(reading, places, index) {
            strays.push(Stray {
                line: *line,
                text: shown(row),
            });
            continue;
        }
        if row.len() < needed {
            return Err(ImportError::Fields {
                file: reading.path.to_owned(),
                line: *line,
                found: row.len(),
                expected: needed,
            });
        }
        used.push(index);
    }
    if let (true, Some(choice)) = (used.is_empty(), &reading.map.rows) {
        return Err(ImportError::NoRows {
            file: reading.path.to_owned(),
            column: choice.column.clone(),
            value: choice.value.clone(),
            there: places
                .choice
                .map_or_else(String::new, |place| texts(reading.rows, place)),
        });
    }
    found.there = Some(used.len() + strays.len());
    let remarks = [
        (others > 0).then_some(Remark::Others(others)),
        (hollow > 0).then_some(Remark::Hollow(hollow)),
        (!strays.is_empty()).then_some(Remark::Strays(strays)),
    ];
    found.remarks.extend(remarks.into_iter().flatten());
    Ok(used)
}

/// Whether a line is no row: no time stands where times do; without times, no number anywhere.
fn is_stray(reading: &Reading<'_>, places: &Places, row: usize) -> bool {
    match places.time {
        Some(place) => !reading.is_time(row, place),
        None => !places
            .channels
            .iter()
            .any(|place| reading.is_number(row, *place)),
    }
}

/// The first of the texts that stand in a column, for a message.
fn texts(rows: &[(u64, Record)], place: usize) -> String {
    const LISTED: usize = 8;
    let mut found: Vec<String> = Vec::new();
    for (_, row) in rows {
        let text = format!("`{}`", row.get(place).unwrap_or(""));
        if !found.contains(&text) {
            found.push(text);
        }
        if found.len() > LISTED {
            break;
        }
    }
    let more = found.len() > LISTED;
    found.truncate(LISTED);
    found.join(", ") + if more { " and others" } else { "" }
}

/// The beginning of a line.
fn shown(row: &Record) -> String {
    let text: Vec<&str> = row.iter().collect();
    let text = text.join(" ");
    let text = text.trim();
    match text.char_indices().nth(SHOWN) {
        Some((end, _)) => format!("{} ...", &text[..end]),
        None => text.to_owned(),
    }
}

/// Where the mark between fields is that before decimals, fields must be quoted: else a number is two.
fn check_quoted(
    path: &Path,
    form: &TextForm,
    rows: &[(u64, Record)],
    names: Option<&[String]>,
    text: &str,
) -> Result<(), ImportError> {
    let same = u8::try_from(form.decimal_mark)
        .is_ok_and(|mark| form.separator == Separator::Character(mark));
    if !same {
        return Ok(());
    }
    let expected = names.map_or_else(|| rows[0].1.len(), <[String]>::len);
    let lines: Vec<&str> = text.lines().collect();
    let is_quoted = |line: u64| {
        let line = usize::try_from(line)
            .ok()
            .and_then(|line| lines.get(line - 1));
        line.is_some_and(|line| line.contains('"'))
    };
    for (line, row) in rows {
        // Whole numbers may stand without quotes.
        let fits = row.len() == expected && (is_quoted(*line) || names.is_some());
        if !fits {
            return Err(ImportError::Unquoted {
                file: path.to_owned(),
                line: *line,
                mark: form.decimal_mark,
                found: row.len(),
                expected,
            });
        }
    }
    Ok(())
}

/// How a text ends.
struct End {
    /// Whether its last line ends, or is not among the rows that are kept.
    is_whole: bool,
    /// Fields that the last row holds to their ends.
    fields: usize,
}

impl End {
    fn of(sheet: &Sheet, rows: &[(u64, Record)]) -> Self {
        let last = sheet.rows.last().map(|(line, _)| *line);
        let is_kept = rows.last().map(|(line, _)| *line) == last;
        Self {
            is_whole: sheet.is_whole || !is_kept,
            fields: sheet.last_fields,
        }
    }

    /// Rows that can be read: all, or all but the last, where that is torn and the map accepts it.
    fn check(
        &self,
        path: &Path,
        map: &FileMap,
        rows: &[(u64, Record)],
        found: &mut Rows,
    ) -> Result<usize, ImportError> {
        let Some(((line, _), before)) = rows.split_last() else {
            return Ok(0);
        };
        // Rows may end early, but not earlier than the one before.
        let usual = before.last().map_or(0, |(_, row)| row.len());
        if self.is_whole || self.fields >= usual {
            return Ok(rows.len());
        }
        if !map.accepts_truncated {
            return Err(torn(path, *line, self.fields, usual, before.len()));
        }
        let rest = format!("its last row, line {line}, is torn and was left out");
        found.remarks.push(Remark::Truncated(rest));
        Ok(before.len())
    }

    /// The last line, where it does not end and its last number is shorter than the one before it.
    fn unended(&self, rows: &[(u64, Record)], places: &Places, taken: usize) -> Option<u64> {
        let ((line, row), before) = rows.split_last()?;
        if self.is_whole || taken < rows.len() {
            return None;
        }
        let length = |row: &Record| row.iter().last().map_or(0, str::len);
        let is_shorter = before
            .last()
            .is_some_and(|(_, other)| length(row) < length(other));
        let is_needed = places.needed().max() == Some(row.len() - 1);
        (is_needed && is_shorter).then_some(*line)
    }
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
