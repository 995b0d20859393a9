//! Logs in which each row has another variable, as trend archives write them: a column names it, another holds its value.

use super::names::{self, Thing};
use super::seen::{Cells, Seen, Variable};
use super::table::{Kind, Table};
use super::units;
use crate::import::text::Record;

/// Variables that a log may have, and rows that each must.
const MOST: usize = 64;
const FEWEST_ROWS: usize = 3;
/// Share of the rows that have another variable than the one before.
const ALTERNATES: f64 = 0.5;
/// Words that name the column of values.
const VALUES: [&str; 8] = [
    "value", "wert", "valor", "valeur", "valore", "val", "reading", "data",
];

/// Rows with their lines.
type Numbered = (u64, Record);

/// The variables of a log that names one in each row; none where it does not, or where no name says what one is.
pub(super) fn variables(table: &Table, rows: &[Numbered], columns: &[Seen]) -> Vec<Variable> {
    let texts = (0..columns.len()).filter(|place| table.kinds[*place] == Kind::Text);
    let mut all = texts.filter_map(|place| by(table, rows, columns, place));
    all.next().unwrap_or_default()
}

/// The variables that a column names.
fn by(table: &Table, rows: &[Numbered], columns: &[Seen], chooser: usize) -> Option<Vec<Variable>> {
    let texts: Vec<&str> = (rows.iter())
        .map(|(_, row)| row.get(chooser).unwrap_or(""))
        .collect();
    let mut names: Vec<&str> = Vec::new();
    for text in &texts {
        if !names.contains(text) {
            names.push(text);
        }
        if names.len() > MOST {
            return None;
        }
    }
    let of = |name: &str| -> Vec<usize> {
        let own = texts.iter().enumerate().filter(|(_, text)| **text == name);
        own.map(|(row, _)| row).collect()
    };
    names.retain(|name| !name.is_empty() && of(name).len() >= FEWEST_ROWS);
    let changes = texts.windows(2).filter(|pair| pair[0] != pair[1]).count();
    let alternates = changes as f64 > ALTERNATES * texts.len() as f64;
    let in_blocks = changes + 1 == names.len() && changes > 0;
    let known = names.iter().any(|name| {
        let thing = names::said(name).thing;
        thing.is_some_and(|(thing, _)| !matches!(thing, Thing::Time | Thing::Other))
    });
    if names.len() < 2 || !known || !(alternates || in_blocks) {
        return None;
    }
    let value = value_column(columns, chooser)?;
    let at = |place: usize, own: &[usize]| -> Seen {
        let column = &columns[place];
        let cells = match &column.cells {
            Cells::Numbers(numbers) => {
                Cells::Numbers(own.iter().map(|row| numbers[*row]).collect())
            }
            Cells::States(numbers) => Cells::States(own.iter().map(|row| numbers[*row]).collect()),
            Cells::Stamps { .. } => {
                let field = |row: &usize| rows[*row].1.get(place).unwrap_or("").to_owned();
                Cells::stamped(&own.iter().map(field).collect::<Vec<_>>())
            }
            Cells::Other => Cells::Other,
        };
        Seen {
            cells,
            ..column.clone()
        }
    };
    let variable = |name: &&str| {
        let own = of(name);
        let unit = units::of_name(name).or_else(|| said_unit(table, rows, &own));
        let column = Seen {
            name: (*name).to_owned(),
            unit: unit.or_else(|| columns[value].unit.clone()),
            ..at(value, &own)
        };
        let others = (0..columns.len()).filter(|place| *place != value);
        Variable {
            chooser: columns[chooser].column.clone(),
            value: (*name).to_owned(),
            column,
            columns: others.map(|place| at(place, &own)).collect(),
        }
    };
    Some(names.iter().map(variable).collect())
}

/// The column that holds the values: by its name, or the only one of numbers that are no times.
fn value_column(columns: &[Seen], chooser: usize) -> Option<usize> {
    let may = |place: &usize| {
        let column = &columns[*place];
        let is_time = names::says_time(&column.name);
        let moves = column.range().is_some_and(|[low, high]| low < high);
        *place != chooser && !is_time && moves && matches!(column.cells, Cells::Numbers(_))
    };
    let all: Vec<usize> = (0..columns.len()).filter(may).collect();
    let named = all.iter().copied().find(|place| {
        let name = columns[*place].name.to_lowercase();
        VALUES.iter().any(|word| name.contains(word))
    });
    match all[..] {
        [only] => Some(only),
        _ => named,
    }
}

/// The unit that another column says in all rows of a variable.
fn said_unit(table: &Table, rows: &[Numbered], own: &[usize]) -> Option<super::seen::SaidUnit> {
    let mut texts = (0..table.kinds.len()).filter(|place| table.kinds[*place] == Kind::Text);
    texts.find_map(|place| {
        let first = rows[*own.first()?].1.get(place)?;
        let same = own.iter().all(|row| rows[*row].1.get(place) == Some(first));
        let unit = units::of_cell(first)?;
        same.then_some(unit)
    })
}
