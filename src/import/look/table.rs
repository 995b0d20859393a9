//! Where the table of a text is: what divides its fields, what its columns are, at which line its rows begin, and which lines among them are none.

use super::seen::Because;
use crate::import::map::Separator;
use crate::import::numbers;
use crate::import::text::{Record, elements, fields};
use crate::import::{stamps, words};

/// Separators in the order in which they are taken where several fit.
const SEPARATORS: [(Separator, &str); 5] = [
    (Separator::Character(b'\t'), "tab"),
    (Separator::Character(b';'), ";"),
    (Separator::Character(b'|'), "|"),
    (Separator::Character(b','), ","),
    (Separator::Whitespace, "whitespace"),
];
/// Lines that are tried for each separator, and lines among which the rows begin.
const TRIED: usize = 200;
const HEADER: usize = 2000;
/// Share of the fields tried that must be numbers, words or stamps.
const UNDERSTOOD: f64 = 0.45;
/// Share of the separators' fields from which on it is certain.
const SURE: f64 = 0.98;
/// One in so many rows whose first field is empty is no accident.
const OFTEN: usize = 20;
/// Rows in a row that make a beginning.
const RUN: usize = 3;

/// Kind of a column's fields.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    Empty,
    Number,
    State,
    Stamp,
    Text,
}

/// A table in a text.
pub(super) struct Table {
    pub separator: Separator,
    /// Its name in a map, and how sure it is.
    pub name: &'static str,
    pub because: Because,
    /// Kinds of the columns.
    pub kinds: Vec<Kind>,
    /// Whether its rows may end early.
    pub is_ragged: bool,
    /// Line of the first row, from 0.
    pub first: usize,
}

/// Why no table was found.
pub(super) enum NoTable {
    /// No line holds numbers with something between them.
    Nowhere,
    /// None of the first lines begins one.
    NoBeginning,
}

/// Kind of a field: a number, a word of two states, a stamp or nothing.
pub(super) fn kind(field: &str) -> Kind {
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

/// The table of a text.
pub(super) fn find(text: &str) -> Result<Table, NoTable> {
    let filled: Vec<&str> = text
        .lines()
        .filter(|line| !line.trim().is_empty())
        .collect();
    // The header, if there is one, stands before.
    let behind = &filled[filled.len() / 2..];
    let shape = shape(behind, &filled)
        .or_else(|| shape(&filled, &filled))
        .or_else(|| alone(&filled))
        .ok_or(NoTable::Nowhere)?;
    let lines: Vec<&str> = text.lines().take(HEADER).collect();
    let first = first_row(&lines, &shape).ok_or(NoTable::NoBeginning)?;
    let count = shape.kinds.len();
    Ok(Table {
        because: Because {
            is_certain: shape.share > SURE,
            why: match (shape.is_ragged, count) {
                (true, _) => {
                    format!("it divides lines into up to {count} fields, and rows end early")
                }
                (false, 1) => "every line holds one number".to_owned(),
                (false, _) => format!("it divides lines into {count} fields each"),
            },
        },
        separator: shape.separator,
        name: shape.name,
        kinds: shape.kinds,
        is_ragged: shape.is_ragged,
        first,
    })
}

/// How lines are divided.
struct Shape {
    separator: Separator,
    name: &'static str,
    share: f64,
    kinds: Vec<Kind>,
    is_ragged: bool,
}

/// Every so many of the lines, so that they are as many as are tried.
fn some<'a>(lines: &[&'a str]) -> Vec<&'a str> {
    let step = lines.len().div_ceil(TRIED).max(1);
    lines.iter().step_by(step).copied().collect()
}

/// The separator under which most of some lines is understood, with that share and the kinds of the columns.
fn shape(lines: &[&str], all: &[&str]) -> Option<Shape> {
    let tried = some(lines);
    let mut best: Option<Shape> = None;
    for (separator, name) in SEPARATORS {
        let divided = |lines: &[&str]| -> Vec<Vec<String>> {
            lines.iter().map(|line| fields(line, &separator)).collect()
        };
        let mut rows = divided(&tried);
        let mut counts: Vec<usize> = rows.iter().map(Vec::len).collect();
        counts.sort_unstable();
        let Some(&usual) = counts.get(counts.len() / 2) else {
            continue;
        };
        // A table whose rows end early begins with whole ones.
        let beginning = divided(&all[..all.len().min(TRIED)]);
        let width = beginning.iter().find(|row| is_numbers(row)).map(Vec::len);
        let whole = |row: &&Vec<String>| Some(row.len()) == width && is_numbers(row);
        let is_ragged = usual > 1
            && width.is_some_and(|width| width > usual)
            && beginning.iter().filter(whole).count() >= RUN
            && (rows.iter().filter(|row| row.len() == usual)).all(|row| is_numbers(row));
        let width = width.filter(|_| is_ragged).unwrap_or(usual);
        if width < 2 {
            continue;
        }
        // Clocks that are slower than others end early, and have no fields later on.
        rows.extend(beginning.into_iter().filter(|row| is_numbers(row)));
        let fits = |row: &&Vec<String>| row.len() == width || (is_ragged && row.len() < width);
        let same: Vec<&Vec<String>> = rows.iter().filter(fits).collect();
        let kinds: Vec<Kind> = (0..width).map(|column| usual_kind(&same, column)).collect();
        let understood = same.iter().flat_map(|row| row.iter());
        let understood = understood.filter(|field| kind(field) != Kind::Text || is_vector(field));
        let understood = understood.count();
        let there = if is_ragged {
            same.iter().map(|row| row.len()).sum()
        } else {
            width * rows.len()
        };
        let share = understood as f64 / there as f64;
        // Spaces divide what other marks do as well, but for empty fields.
        let more = if separator == Separator::Whitespace {
            0.05
        } else {
            1e-9
        };
        let is_better = best.as_ref().is_none_or(|shape| share > shape.share + more);
        if kinds.contains(&Kind::Number) && share >= UNDERSTOOD && is_better {
            best = Some(Shape {
                separator,
                name,
                share,
                kinds,
                is_ragged,
            });
        }
    }
    best
}

/// Lines of one number each.
fn alone(lines: &[&str]) -> Option<Shape> {
    let tried = some(lines);
    let are = tried
        .iter()
        .filter(|line| kind(line.trim()) == Kind::Number);
    let share = are.count() as f64 / tried.len() as f64;
    (share >= UNDERSTOOD).then_some(Shape {
        separator: Separator::Character(b';'),
        name: ";",
        share,
        kinds: vec![Kind::Number],
        is_ragged: false,
    })
}

/// Whether a field holds a vector of numbers.
pub(super) fn is_vector(field: &str) -> bool {
    elements(field).is_some_and(|all| all.iter().all(|text| kind(text) == Kind::Number))
}

/// Whether a line is of numbers throughout.
fn is_numbers(row: &[String]) -> bool {
    let kinds: Vec<Kind> = row.iter().map(|field| kind(field)).collect();
    row.len() > 1
        && kinds.iter().all(|kind| *kind != Kind::Text)
        && kinds
            .iter()
            .any(|kind| matches!(kind, Kind::Number | Kind::Stamp))
        && kinds[0] != Kind::Empty
}

/// Kind of most of a column's fields.
fn usual_kind(rows: &[&Vec<String>], column: usize) -> Kind {
    let fields: Vec<Kind> = rows
        .iter()
        .filter_map(|row| row.get(column))
        .map(|field| kind(field))
        .collect();
    let of = |wanted: Kind| fields.iter().filter(|kind| **kind == wanted).count();
    let filled = fields.len() - of(Kind::Empty);
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
fn first_row(lines: &[&str], shape: &Shape) -> Option<usize> {
    let kinds = &shape.kinds;
    let is_row = |line: &str| {
        let row = fields(line, &shape.separator);
        // An empty last field may be left out.
        let fits = row.len() == kinds.len()
            || (row.len() + 1 == kinds.len() && kinds.last() == Some(&Kind::Empty));
        let agrees = |(field, own): (&String, &Kind)| match kind(field) {
            Kind::Empty => true,
            found => found == *own || matches!(own, Kind::Text | Kind::Empty),
        };
        let mut pairs = row.iter().zip(kinds);
        let first = row.first().is_some_and(|field| !field.is_empty())
            || kinds.first() == Some(&Kind::Empty);
        // Names are no row, however many columns hold texts.
        let has_number = row
            .iter()
            .any(|field| matches!(kind(field), Kind::Number | Kind::Stamp));
        fits && first && has_number && pairs.all(agrees)
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

impl Table {
    /// The column by which rows are known: the first of numbers or stamps.
    pub fn lead(&self) -> Option<usize> {
        let leads = |kind: &Kind| matches!(kind, Kind::Number | Kind::Stamp);
        self.kinds.iter().position(leads)
    }

    /// Places of the lines among rows that are none: something else stands where numbers or stamps do.
    pub fn strays(&self, rows: &[(u64, Record)]) -> Vec<usize> {
        let Some(lead) = self.lead() else {
            return Vec::new();
        };
        let leads: Vec<Kind> = rows
            .iter()
            .map(|(_, row)| row.get(lead).map_or(Kind::Empty, kind))
            .collect();
        let empty = leads.iter().filter(|kind| **kind == Kind::Empty).count();
        // A clock that is slower than another leaves its fields empty.
        let may_be_empty = self.is_ragged || empty * OFTEN > rows.len();
        let is_stray = |index: &usize| match leads[*index] {
            Kind::Empty => !may_be_empty && rows[*index].1.iter().any(|field| !field.is_empty()),
            found => found != self.kinds[lead],
        };
        (0..rows.len()).filter(is_stray).collect()
    }
}
