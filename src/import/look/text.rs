//! A text looked at: what stands between its fields and before its decimals, where its rows begin, which line names the columns and which their units,
//! and what among its rows is none.

use std::collections::BTreeSet;
use std::path::Path;

use super::marks::marks;
use super::seen::{Because, Cells, Line, Looked, SaidUnit, Seen, TimeSeen};
use super::table::{self, Kind, NoTable, Table, kind};
use super::{long, names, rate, units};
use crate::file::Limit;
use crate::import::encoding::DetectedEncoding;
use crate::import::error::ImportError;
use crate::import::map::Column;
use crate::import::numbers::{self, Marks};
use crate::import::stamps;
use crate::import::text::{Record, Sheet, content, fields};

/// Texts in place of numbers that a map names, at most.
const MARKS: usize = 8;
/// Lines that a note shows, at most.
const LISTED: usize = 3;

/// Rows with their lines.
type Numbered = (u64, Record);

/// Looks at a text.
pub(super) fn look(path: &Path) -> Result<Looked, ImportError> {
    let (text, detected) = content(path, None, Limit::default())?;
    look_at(path, &text, &detected)
}

/// Looks at a text that was taken from a file.
pub(super) fn look_at(
    path: &Path,
    text: &str,
    detected: &DetectedEncoding,
) -> Result<Looked, ImportError> {
    let fail = |cause: &str| ImportError::Read {
        file: path.to_owned(),
        cause: cause.to_owned(),
    };
    let table = table::find(text).map_err(|none| {
        fail(match none {
            NoTable::Nowhere => "no lines of numbers with something between them are in it; `idc import` reads texts, .parquet, .mat, .mcap, .db3",
            NoTable::NoBeginning => "none of its first 2000 lines begins a table of numbers",
        })
    })?;
    let mut sheet = Sheet::of(text, table.first, &table.separator, Limit::default())
        .map_err(|cause| fail(&cause))?;
    let header: Vec<Vec<String>> = (sheet.header.iter())
        .map(|line| fields(line, &table.separator))
        .collect();
    let mut names_line = names_line(&header, table.kinds.len());
    let units_line = units_line(&header, table.kinds.len(), names_line);
    let mut notes = Vec::new();
    if let Some(line) = names_line
        && let Some(note) = misaligned(&header[line], &table.kinds, line)
    {
        notes.push(note);
        names_line = None;
    }
    let left_out = leave_out(&table, &mut sheet.rows, &mut notes);
    let of_numbers: Vec<bool> = (table.kinds.iter())
        .map(|kind| *kind == Kind::Number)
        .collect();
    let (marks, because, question) = marks(path, &sheet, &of_numbers)?;
    let mut head = head(detected, &table, marks, because);
    if let Some(line) = names_line {
        head.push(Line {
            key: "names_line",
            value: (line + 1).to_string(),
            because: Because::certain(format!("it names {} columns", header[line].len())),
        });
    }
    head.extend(left_out);
    let rows = names_line.map(|line| header[line].as_slice());
    let said = units_line.map(|line| header[line].as_slice());
    head.extend(missing(&table, &sheet.rows));
    let mut columns = columns(&sheet.rows, &table.kinds, marks, rows, said);
    if header
        .iter()
        .any(|line| line.first().is_some_and(|cell| cell == "X_Dimension"))
    {
        of_labview(&mut columns);
    }
    let variables = long::variables(&table, &sheet.rows, &columns);
    let asked = question.map(|question| ("decimal_mark", question));
    Ok(Looked {
        path: path.to_owned(),
        head,
        columns,
        time: TimeSeen::Column,
        asked: asked.into_iter().collect(),
        notes,
        rates: rate::said(&header),
        samples: (sheet.rows.first())
            .map_or_else(Vec::new, |(_, row)| row.iter().map(str::to_owned).collect()),
        odd_units: odd_units(said, table.kinds.len()),
        variables,
    })
}

/// The lines of a map on what divides fields, what stands in numbers and where rows begin.
fn head(detected: &DetectedEncoding, table: &Table, marks: Marks, because: Because) -> Vec<Line> {
    let line = |key, value, because| Line {
        key,
        value,
        because,
    };
    let of_encoding = Because {
        is_certain: detected.is_certain,
        why: detected.reason.to_owned(),
    };
    let mut head = vec![
        line("encoding", format!("{:?}", detected.name), of_encoding),
        line(
            "separator",
            format!("{:?}", table.name),
            table.because.clone(),
        ),
        line(
            "decimal_mark",
            format!("{:?}", marks.decimal.to_string()),
            because,
        ),
    ];
    if let Some(mark) = marks.thousands {
        // One space stands for all of them.
        let mark = if numbers::is_space(mark) { ' ' } else { mark };
        head.push(line(
            "thousands_mark",
            format!("{:?}", mark.to_string()),
            Because::certain("it stands before every third digit"),
        ));
    }
    if table.first > 0 {
        head.push(line(
            "header_lines",
            table.first.to_string(),
            Because::certain(format!("line {} is the first of numbers", table.first + 1)),
        ));
    }
    head
}

/// Takes out lines that are no rows, with the keys that have them left out and notes on where they stand. Where rows begin anew behind them, those are of another
/// recording.
fn leave_out(table: &Table, rows: &mut Vec<Numbered>, notes: &mut Vec<String>) -> Vec<Line> {
    let strays: BTreeSet<usize> = table.strays(rows).into_iter().collect();
    if strays.is_empty() {
        return Vec::new();
    }
    let line = |key, value: String, why: String| Line {
        key,
        value,
        because: Because::likely(why),
    };
    let mut lines = Vec::new();
    let begins_anew = strays
        .iter()
        .copied()
        .find(|stray| begins_anew(table, rows, &strays, *stray));
    let is_stray = |row: &usize| strays.contains(row);
    let end = match begins_anew {
        Some(stray) => {
            // The block of lines before it belongs to it.
            let start = (0..=stray).rev().take_while(is_stray).last();
            let start = start.unwrap_or(stray);
            let next = (stray..rows.len()).find(|row| !is_stray(row));
            notes.push(another(rows[start].0, rows[next.unwrap_or(stray)].0));
            start
        }
        None => {
            let last = (0..rows.len()).rev().take_while(is_stray).last();
            last.unwrap_or(rows.len())
        }
    };
    if end < rows.len() {
        let count = rows.len() - end;
        let what = if begins_anew.is_some() {
            "another table whose times begin anew".to_owned()
        } else {
            shown(&rows[end..])
        };
        lines.push(line(
            "drop_last_rows",
            count.to_string(),
            format!("the last {count} lines are no rows of this table: {what}"),
        ));
    }
    let among: BTreeSet<usize> = strays.range(..end).copied().collect();
    if !among.is_empty() {
        let all: Vec<Numbered> = among.iter().map(|row| rows[*row].clone()).collect();
        lines.push(line(
            "skip_stray_lines",
            "true".to_owned(),
            format!(
                "{} lines among the rows are none: {}",
                all.len(),
                shown(&all)
            ),
        ));
    }
    if begins_anew.is_none() {
        let all: Vec<Numbered> = strays.iter().map(|row| rows[*row].clone()).collect();
        notes.push(format!("Left out, as no rows: {}.", shown(&all)));
    }
    rows.truncate(end);
    let mut index = 0;
    rows.retain(|_| {
        index += 1;
        !among.contains(&(index - 1))
    });
    lines
}

/// A note on another table, of lines from `start` and rows from `first` on.
fn another(start: u64, first: u64) -> String {
    let names = first - 1;
    format!(
        "From line {start} on another table follows, whose times begin anew: another recording. A map of its own reads it, with `header_lines = {names}` and `names_line = {names}`, without `drop_last_rows`."
    )
}

/// Whether the column that leads rows falls back behind a line that is no row.
fn begins_anew(table: &Table, rows: &[Numbered], strays: &BTreeSet<usize>, stray: usize) -> bool {
    let Some(lead) = table.lead() else {
        return false;
    };
    let is_row = |row: &usize| !strays.contains(row);
    let before = (0..stray).rev().find(is_row);
    let after = (stray..rows.len()).find(is_row);
    let (Some(before), Some(after)) = (before, after) else {
        return false;
    };
    let texts = [before, after].map(|row| rows[row].1.get(lead).unwrap_or("").to_owned());
    let read = |text: &str| {
        let marks = |decimal| Marks {
            decimal,
            thousands: None,
        };
        marks('.').number(text).or_else(|| marks(',').number(text))
    };
    if let (Some(before), Some(after)) = (read(&texts[0]), read(&texts[1])) {
        return after < before;
    }
    stamps::nanoseconds(&texts, stamps::Reading::default()).is_ok_and(|times| times[1] < times[0])
}

/// Lines with what stands in them, for a comment.
fn shown(rows: &[Numbered]) -> String {
    const LETTERS: usize = 40;
    let line = |(line, row): &Numbered| {
        let text: Vec<&str> = row.iter().filter(|field| !field.is_empty()).collect();
        let text: String = text
            .join(" ")
            .chars()
            .filter(|c| !c.is_control())
            .take(LETTERS)
            .collect();
        format!("line {line} `{text}`")
    };
    let first: Vec<String> = rows.iter().take(LISTED).map(line).collect();
    let more = match rows.len() {
        0..=LISTED => String::new(),
        count => format!(" and {} more", count - LISTED),
    };
    first.join(", ") + &more
}

/// Texts in place of numbers, as marks of missing values.
fn missing(table: &Table, rows: &[Numbered]) -> Option<Line> {
    let mut found: Vec<(&str, usize, u64)> = Vec::new();
    for (line, row) in rows {
        for (field, own) in row.iter().zip(&table.kinds) {
            let is_mark = *own == Kind::Number
                && matches!(kind(field), Kind::Text | Kind::State)
                && (field.starts_with(['#', '<', '>', '*', '!'])
                    || !field.contains(|c: char| c.is_ascii_digit()));
            if !is_mark {
                continue;
            }
            match found.iter_mut().find(|(text, ..)| *text == field) {
                Some((_, count, _)) => *count += 1,
                None => found.push((field, 1, *line)),
            }
        }
    }
    if found.is_empty() || found.len() > MARKS {
        return None;
    }
    let texts: Vec<String> = (found.iter())
        .map(|(text, ..)| super::time::toml_text(text))
        .collect();
    let why: Vec<String> = (found.iter())
        .map(|(text, count, line)| {
            format!("`{text}` stands in place of {count} numbers, first in line {line}")
        })
        .collect();
    Some(Line {
        key: "missing",
        value: format!("[{}]", texts.join(", ")),
        because: Because::likely(why.join("; ")),
    })
}

/// The line of the header, from 0, that names the columns best.
fn names_line(header: &[Vec<String>], count: usize) -> Option<usize> {
    let worth = |row: &Vec<String>| {
        let texts = row
            .iter()
            .filter(|field| kind(field) == Kind::Text || kind(field) == Kind::State);
        let distinct: BTreeSet<&String> = texts.collect();
        let known = row
            .iter()
            .filter(|field| names::said(field).thing.is_some());
        (distinct.len(), 2 * known.count() + distinct.len())
    };
    let mut best = None;
    for (line, row) in header.iter().enumerate() {
        let (texts, worth) = worth(row);
        let is_units = units_of_row(row).is_some();
        let least = if count == 1 { 1 } else { 2 };
        let fits = row.len() + 1 >= count && 2 * texts >= count.min(row.len()) && texts >= least;
        if fits && !is_units && best.is_none_or(|(_, most)| worth >= most) {
            best = Some((line, worth));
        }
    }
    best.map(|(line, _)| line)
}

/// Why names cannot be matched to their columns, where they are fewer or more: the index of a data frame has no name, a name may hold what divides fields.
fn misaligned(names: &[String], kinds: &[Kind], line: usize) -> Option<String> {
    const REMARKS: [&str; 7] = [
        "comment",
        "comments",
        "kommentar",
        "bemerkung",
        "remark",
        "remarks",
        "note",
    ];
    let last = |place: Option<usize>| place.map_or(0, |last| last + 1);
    let filled = last(names.iter().rposition(|name| !name.is_empty()));
    let columns = last(kinds.iter().rposition(|kind| *kind != Kind::Empty));
    let is_remark = |name: &String| REMARKS.contains(&name.to_lowercase().as_str());
    let fits = if filled > kinds.len() {
        names[kinds.len()..filled].iter().all(is_remark)
    } else {
        names.len() >= columns
    };
    (!fits).then(|| {
        format!(
            "Line {} names {filled} columns, and rows have {columns}: which name is whose cannot be determined, so that columns have numbers here.",
            line + 1
        )
    })
}

/// The line of the header, from 0, that holds units.
fn units_line(header: &[Vec<String>], count: usize, names: Option<usize>) -> Option<usize> {
    let fits = |line: &usize| {
        let row = &header[*line];
        Some(*line) != names && row.len() + 1 >= count && units_of_row(row).is_some()
    };
    (0..header.len()).rev().find(fits)
}

/// Whether a cell of a row of units names none.
fn is_blank(cell: &str) -> bool {
    let plain = cell.trim_matches(|c| "[](){}".contains(c)).to_lowercase();
    [
        "", "-", "1", "bool", "boolean", "n/a", "none", "no unit", "bit",
    ]
    .contains(&plain.as_str())
}

/// Units of a row of them; none where it is not one. The first cell may be a label.
fn units_of_row(row: &[String]) -> Option<Vec<Option<SaidUnit>>> {
    let said: Vec<Option<SaidUnit>> = row.iter().map(|cell| units::of_cell(cell)).collect();
    // The label may stand before each unit.
    let label = row.first().filter(|label| units::of_cell(label).is_none());
    let blank = |cell: &&String| Some(*cell) == label || is_blank(cell);
    let filled = row.iter().skip(1).filter(|cell| !blank(cell)).count();
    let known = said.iter().skip(1).flatten().count();
    // Most are known, and one that is not is asked for.
    (known > 0 && 2 * known > filled).then_some(said)
}

/// Units of a row of them that nobody here knows.
fn odd_units(row: Option<&[String]>, count: usize) -> Vec<Option<String>> {
    let Some(row) = row else {
        return Vec::new();
    };
    let label = row.first().filter(|label| units::of_cell(label).is_none());
    let odd = |place: usize| {
        let cell = row.get(place)?;
        let is_known = units::of_cell(cell).is_some() || is_blank(cell) || Some(cell) == label;
        (!is_known).then(|| cell.trim_matches(|c| "[](){}".contains(c)).to_owned())
    };
    (0..count).map(odd).collect()
}

fn columns(
    rows: &[Numbered],
    kinds: &[Kind],
    marks: Marks,
    names: Option<&[String]>,
    said: Option<&[String]>,
) -> Vec<Seen> {
    let name_of = |place: usize| {
        let name = names.and_then(|names| names.get(place));
        name.filter(|name| !name.is_empty())
    };
    let is_unique = |name: &String| {
        let all = names.unwrap_or_default().iter();
        all.filter(|other| *other == name).count() == 1
    };
    let column = |(place, kind): (usize, &Kind)| {
        let name = name_of(place);
        let field = |(_, row): &Numbered| row.get(place).unwrap_or("").to_owned();
        let number = |text: String| marks.number_or_word(&text).unwrap_or(f64::NAN);
        let numbers = || rows.iter().map(|row| number(field(row))).collect();
        let of_name = name.and_then(|name| units::of_name(name));
        let of_row = said.and_then(|said| units::of_cell(said.get(place)?));
        Seen {
            column: match name.filter(|name| is_unique(name)) {
                Some(name) => Column::Name(name.clone()),
                None => Column::Number(place + 1),
            },
            name: name.cloned().unwrap_or_default(),
            joint: None,
            frames: Vec::new(),
            unit: agreed(of_name, of_row),
            cells: match kind {
                Kind::Number => Cells::Numbers(numbers()),
                Kind::State => Cells::States(numbers()),
                Kind::Stamp => Cells::stamped(&rows.iter().map(field).collect::<Vec<_>>()),
                Kind::Text | Kind::Empty => Cells::Other,
            },
        }
    };
    kinds.iter().enumerate().map(column).collect()
}

/// Times of LabVIEW's measurement files, which are in seconds.
fn of_labview(columns: &mut [Seen]) {
    let times = columns.iter_mut().filter(|column| column.name == "X_Value");
    for column in times {
        column.unit = units::of_cell("s").map(|said| SaidUnit {
            because: Because::certain("LabVIEW writes `X_Value` in seconds"),
            ..said
        });
    }
}

/// The unit that a name says, or a line of units; not certain where they say two.
fn agreed(name: Option<SaidUnit>, row: Option<SaidUnit>) -> Option<SaidUnit> {
    match (name, row) {
        (Some(mut name), Some(row)) if name.unit != row.unit => {
            name.because = Because::likely(format!(
                "its name says {}, but the line of units {}",
                name.unit.name, row.unit.name
            ));
            Some(name)
        }
        (Some(mut name), Some(row)) => {
            name.pressure = name.pressure.or(row.pressure);
            Some(name)
        }
        (name, row) => name.or(row),
    }
}
