//! A text looked at: what stands between its fields and before its decimals, where its rows begin, which line names the columns and which their units.

use std::collections::BTreeSet;
use std::path::Path;

use super::marks::marks;
use super::seen::{Because, Cells, Line, Looked, SaidUnit, Seen, TimeSeen};
use super::{names, units};
use crate::import::encoding::Told;
use crate::import::error::ImportError;
use crate::import::map::{Column, Separator};
use crate::import::numbers::{self, Marks};
use crate::import::text::{Sheet, content, fields};
use crate::import::{stamps, words};

/// Separators in the order in which they are believed where several fit.
const SEPARATORS: [(Separator, &str); 5] = [
    (Separator::Character(b'\t'), "tab"),
    (Separator::Character(b';'), ";"),
    (Separator::Character(b'|'), "|"),
    (Separator::Character(b','), ","),
    (Separator::Whitespace, "whitespace"),
];
/// Lines that are tried for each separator, and lines among which the rows begin.
const TRIED: usize = 200;
const HEADER: usize = 200;
/// Share of the fields tried that must be numbers, words or stamps.
const UNDERSTOOD: f64 = 0.6;
/// Rows in a row that make a beginning.
const RUN: usize = 3;

/// Kind of a column's fields.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Kind {
    Empty,
    Number,
    State,
    Stamp,
    Text,
}

/// Looks at a text.
pub(super) fn look(path: &Path) -> Result<Looked, ImportError> {
    let (text, told) = content(path, None)?;
    look_at(path, &text, &told)
}

/// Looks at a text that was taken from a file.
pub(super) fn look_at(path: &Path, text: &str, told: &Told) -> Result<Looked, ImportError> {
    let fail = |cause: &str| ImportError::Read {
        file: path.to_owned(),
        cause: cause.to_owned(),
    };
    let (separator, name, share, kinds) =
        separator(text).ok_or_else(|| fail("no lines of numbers with something between them are in it; `idc import` reads texts, .parquet, .mat, .mcap, .db3"))?;
    let lines: Vec<&str> = text.lines().take(HEADER).collect();
    let first = first_row(&lines, &separator, &kinds)
        .ok_or_else(|| fail("none of its first 200 lines begins a table of numbers"))?;
    let sheet = Sheet::of(text, first, &separator).map_err(|cause| fail(&cause))?;
    let header: Vec<Vec<String>> = sheet.header.iter().map(|l| fields(l, &separator)).collect();
    let names_line = names_line(&header, kinds.len());
    let units_line = units_line(&header, kinds.len(), names_line);
    let of_numbers: Vec<bool> = kinds.iter().map(|kind| *kind == Kind::Number).collect();
    let (marks, marks_because) = marks(path, &sheet, &of_numbers)?;
    let mut head = vec![
        Line {
            key: "encoding",
            value: format!("{:?}", told.name),
            because: Because {
                is_certain: told.is_certain,
                why: told.reason.to_owned(),
            },
        },
        Line {
            key: "separator",
            value: format!("{name:?}"),
            because: Because {
                is_certain: share > 0.98,
                why: format!(
                    "it divides {} lines into {} fields each",
                    sheet.rows.len(),
                    kinds.len()
                ),
            },
        },
        Line {
            key: "decimal_mark",
            value: format!("{:?}", marks.decimal.to_string()),
            because: marks_because,
        },
    ];
    if let Some(mark) = marks.thousands {
        head.push(Line {
            key: "thousands_mark",
            value: format!("{:?}", mark.to_string()),
            because: Because::certain("it stands before every third digit"),
        });
    }
    if first > 0 {
        head.push(Line {
            key: "header_lines",
            value: first.to_string(),
            because: Because::certain(format!("line {} is the first of numbers", first + 1)),
        });
    }
    if let Some(line) = names_line {
        head.push(Line {
            key: "names_line",
            value: (line + 1).to_string(),
            because: Because::certain(format!("it names {} columns", header[line].len())),
        });
    }
    let rows = names_line.map(|line| header[line].as_slice());
    let said = units_line.map(|line| header[line].as_slice());
    Ok(Looked {
        path: path.to_owned(),
        head,
        columns: columns(&sheet, &kinds, marks, rows, said),
        time: TimeSeen::Column,
    })
}

/// Kind of a field: a number, a word of two states, a stamp or nothing.
fn kind(field: &str) -> Kind {
    if numbers::is_nothing(field) {
        return Kind::Empty;
    }
    if numbers::seen(field) != numbers::Seen::Other {
        return Kind::Number;
    }
    if words::of_word(field).is_some() {
        return Kind::State;
    }
    if stamps::is_stamp(field) {
        return Kind::Stamp;
    }
    Kind::Text
}

/// The separator under which most is understood, with that share and the kinds of the columns.
fn separator(text: &str) -> Option<(Separator, &'static str, f64, Vec<Kind>)> {
    let filled: Vec<&str> = text
        .lines()
        .filter(|line| !line.trim().is_empty())
        .collect();
    // The header, if there is one, stands before.
    let body = &filled[filled.len() / 2..];
    let step = body.len().div_ceil(TRIED).max(1);
    let tried: Vec<&str> = body.iter().step_by(step).copied().collect();
    let mut best: Option<(Separator, &'static str, f64, Vec<Kind>)> = None;
    for (separator, name) in SEPARATORS {
        let rows: Vec<Vec<String>> = tried.iter().map(|line| fields(line, &separator)).collect();
        let mut counts: Vec<usize> = rows.iter().map(Vec::len).collect();
        counts.sort_unstable();
        let Some(&usual) = counts.get(counts.len() / 2) else {
            continue;
        };
        if usual < 2 {
            continue;
        }
        let same: Vec<&Vec<String>> = rows.iter().filter(|row| row.len() == usual).collect();
        let kinds: Vec<Kind> = (0..usual).map(|column| usual_kind(&same, column)).collect();
        let understood = same.iter().flat_map(|row| row.iter());
        let understood = understood.filter(|field| kind(field) != Kind::Text).count();
        let share = understood as f64 / (usual * tried.len()) as f64;
        let has_numbers = kinds.contains(&Kind::Number);
        let is_better = best
            .as_ref()
            .is_none_or(|(_, _, most, _)| share > *most + 1e-9);
        if has_numbers && share >= UNDERSTOOD && is_better {
            best = Some((separator, name, share, kinds));
        }
    }
    best
}

/// Kind of most of a column's fields.
fn usual_kind(rows: &[&Vec<String>], column: usize) -> Kind {
    let of = |wanted: Kind| {
        let own = rows.iter().filter(|row| kind(&row[column]) == wanted);
        own.count()
    };
    let filled = rows.len() - of(Kind::Empty);
    if filled == 0 {
        return Kind::Empty;
    }
    let all = [Kind::Number, Kind::State, Kind::Stamp, Kind::Text];
    let counts = all.map(|kind| (of(kind), kind));
    // Words beside numbers are a column of neither.
    match counts.iter().find(|(count, _)| 10 * count >= 9 * filled) {
        Some((_, kind)) => *kind,
        None => Kind::Text,
    }
}

/// The line, from 0, at which the rows begin.
fn first_row(lines: &[&str], separator: &Separator, kinds: &[Kind]) -> Option<usize> {
    let is_row = |line: &str| {
        let row = fields(line, separator);
        // An empty last field may be left out.
        let fits = row.len() == kinds.len()
            || (row.len() + 1 == kinds.len() && kinds.last() == Some(&Kind::Empty));
        let agrees = |(field, own): (&String, &Kind)| match kind(field) {
            Kind::Empty => true,
            found => found == *own || matches!(own, Kind::Text | Kind::Empty),
        };
        let mut pairs = row.iter().zip(kinds);
        // The first columns of a sheet may be empty.
        let first = kinds.first() == Some(&Kind::Empty)
            || row.first().is_some_and(|field| !field.is_empty());
        fits && first && pairs.all(agrees)
    };
    let filled: Vec<(usize, &str)> = lines
        .iter()
        .enumerate()
        .filter(|(_, line)| !line.trim().is_empty())
        .map(|(at, line)| (at, *line))
        .collect();
    let starts = |window: &[(usize, &str)]| window.iter().all(|(_, line)| is_row(line));
    let run = RUN.min(filled.len());
    let found = filled.windows(run.max(1)).find(|window| starts(window))?;
    Some(found[0].0)
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
        let fits = row.len() + 1 >= count && 2 * texts >= count.min(row.len()) && texts >= 2;
        if fits && !is_units && best.is_none_or(|(_, most)| worth >= most) {
            best = Some((line, worth));
        }
    }
    best.map(|(line, _)| line)
}

/// The line of the header, from 0, that holds units.
fn units_line(header: &[Vec<String>], count: usize, names: Option<usize>) -> Option<usize> {
    let fits = |line: &usize| {
        let row = &header[*line];
        Some(*line) != names && row.len() + 1 >= count && units_of_row(row).is_some()
    };
    (0..header.len()).rev().find(fits)
}

/// Units of a row of them; none where it is not one. The first cell may be a label.
fn units_of_row(row: &[String]) -> Option<Vec<Option<SaidUnit>>> {
    let said: Vec<Option<SaidUnit>> = row.iter().map(|cell| units::of_cell(cell)).collect();
    // The label may stand before each unit.
    let label = row.first().filter(|label| units::of_cell(label).is_none());
    let blank = |cell: &&String| {
        let plain = cell.trim_matches(|c| "[](){}".contains(c)).to_lowercase();
        Some(*cell) == label || ["", "-", "1", "bool", "boolean", "n/a"].contains(&plain.as_str())
    };
    let filled = row.iter().skip(1).filter(|cell| !blank(cell)).count();
    let known = said.iter().skip(1).flatten().count();
    (known > 0 && known == filled).then_some(said)
}

fn columns(
    sheet: &Sheet,
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
        let field = |(_, row): &(u64, csv::StringRecord)| row.get(place).unwrap_or("").to_owned();
        let number = |text: String| marks.number_or_word(&text).unwrap_or(f64::NAN);
        let numbers = || sheet.rows.iter().map(|row| number(field(row))).collect();
        let unit = name.and_then(|name| units::of_name(name));
        Seen {
            column: match name.filter(|name| is_unique(name)) {
                Some(name) => Column::Name(name.clone()),
                None => Column::Number(place + 1),
            },
            name: name.cloned().unwrap_or_default(),
            joint: None,
            frames: Vec::new(),
            unit: unit.or_else(|| units::of_cell(said?.get(place)?)),
            cells: match kind {
                Kind::Number => Cells::Numbers(numbers()),
                Kind::State => Cells::States(numbers()),
                Kind::Stamp => stamped(&sheet.rows.iter().map(field).collect::<Vec<_>>()),
                Kind::Text | Kind::Empty => Cells::Other,
            },
        }
    };
    kinds.iter().enumerate().map(column).collect()
}

/// A column of stamps.
pub(super) fn stamped(texts: &[String]) -> Cells {
    let first = texts.first().map_or("", String::as_str);
    let distinct: BTreeSet<&String> = texts.iter().collect();
    Cells::Stamps {
        has: stamps::parts(first).unwrap_or_default(),
        distinct: distinct.len(),
        rows: texts.len(),
        because: Because::certain(format!("stamps such as `{first}`")),
        problem: stamps::nanoseconds(texts, None, None)
            .err()
            .map(|unread| format!("`{}` needs {}", texts[unread.index], unread.expected)),
    }
}
