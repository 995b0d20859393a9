//! Which column of a log holds the times, and in what unit.

use super::names::{Thing, said};
use super::seen::{Because, Cells, Looked, Seen, TimeSeen};
use super::units::shown;
use crate::import::map::Column;
use crate::import::units::{self, LogUnit};
use crate::recording::Unit;
use crate::recording::csv::median_step;

/// Rates that are usual of an actuator's log, and units in the order in which they are tried [Hz].
const USUAL: std::ops::RangeInclusive<f64> = 20.0..=20e3;
const TRIED: [&str; 4] = ["s", "ms", "us", "ns"];
/// Share of the stamps that must differ from one another for them to be the times of samples.
const DISTINCT: f64 = 0.5;

/// Statement of the map on the times.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct TimeChoice {
    /// Keys and values of its table.
    pub keys: Vec<(&'static str, String)>,
    pub because: Because,
    /// The open question.
    pub open: Option<String>,
    /// Places of the columns that it takes.
    pub places: Vec<usize>,
}

/// A column as the map writes it.
pub(super) fn written(column: &Column) -> String {
    match column {
        Column::Number(number) => number.to_string(),
        Column::Name(name) => toml_text(name),
    }
}

/// A text in the quotes of TOML.
pub(super) fn toml_text(text: &str) -> String {
    let mut quoted = String::from("\"");
    for c in text.chars() {
        match c {
            '"' | '\\' => quoted.extend(['\\', c]),
            '\t' => quoted.push_str("\\t"),
            c if c.is_control() => quoted.push_str(&format!("\\u{:04X}", u32::from(c))),
            c => quoted.push(c),
        }
    }
    quoted.push('"');
    quoted
}

/// Chooses the times of a log, of which `logs` are there one behind the other; none where nothing looks like times.
pub(super) fn choose(looked: &Looked, logs: usize) -> Option<TimeChoice> {
    if looked.time == TimeSeen::Waveforms {
        return None;
    }
    if let TimeSeen::Messages { column, because } = &looked.time {
        return Some(TimeChoice {
            keys: vec![("column", format!("{column:?}"))],
            because: because.clone(),
            open: None,
            places: Vec::new(),
        });
    }
    let all = looked.columns.iter().enumerate();
    let worth = all.filter_map(|(place, column)| Some((worth(place, column, logs)?, place)));
    // The first of those that are worth as much.
    let (_, place) = worth.max_by_key(|(worth, place)| (*worth, usize::MAX - place))?;
    let column = &looked.columns[place];
    let mut choice = TimeChoice {
        keys: vec![("column", written(&column.column))],
        because: Because::certain(""),
        open: None,
        places: vec![place],
    };
    match &column.cells {
        Cells::Stamps { .. } => of_stamps(looked, place, &mut choice),
        _ => of_numbers(column, logs, &mut choice),
    }
    Some(choice)
}

/// Aptness of a column as times.
fn worth(place: usize, column: &Seen, logs: usize) -> Option<i32> {
    let name = said(&column.name);
    let named = name.thing.is_some_and(|(thing, _)| thing == Thing::Time);
    let first = i32::from(place == 0);
    match &column.cells {
        Cells::Numbers(values) => {
            let (rising, _) = rises(values, logs)?;
            let unit = column.unit.as_ref();
            let in_time = unit.is_some_and(|said| said.unit.si == Unit::Second);
            let another = unit.is_some() && !in_time;
            let is_other = name.thing.is_some() && !named;
            let worth = 3 * i32::from(named) + 2 * i32::from(in_time) + first;
            (rising && worth > 0 && !another && !is_other).then_some(worth + 1)
        }
        Cells::Stamps {
            has,
            distinct,
            rows,
            ..
        } => {
            let coarse = (*distinct as f64) < DISTINCT * *rows as f64;
            // A date by itself is the day of the times in another column.
            (has[1]).then_some(3 * i32::from(named) + 2 + first - 4 * i32::from(coarse))
        }
        Cells::States(_) | Cells::Other => None,
    }
}

/// Whether numbers rise throughout, but for the beginnings of further logs; with their usual step.
fn rises(values: &[f64], logs: usize) -> Option<(bool, f64)> {
    if values.iter().any(|value| !value.is_finite()) || values.len() < 3 {
        return None;
    }
    // The newest first.
    if logs == 1 && values.windows(2).all(|pair| pair[1] < pair[0]) {
        let turned: Vec<f64> = values.iter().rev().copied().collect();
        return rises(&turned, logs);
    }
    let falls = values.windows(2).filter(|pair| pair[1] < pair[0]).count();
    let first = values.windows(2).position(|pair| pair[1] < pair[0]);
    let first = &values[..first.map_or(values.len(), |at| at + 1)];
    let same = first.windows(2).filter(|pair| pair[1] == pair[0]).count();
    Some((falls < logs && 2 * same < first.len(), median_step(first)))
}

fn of_stamps(looked: &Looked, place: usize, choice: &mut TimeChoice) {
    let Cells::Stamps {
        has,
        because,
        problem,
        ..
    } = &looked.columns[place].cells
    else {
        return;
    };
    choice.because = because.clone();
    choice.open.clone_from(problem);
    if has[0] {
        return;
    }
    let date = looked.columns.iter().position(|column| {
        matches!(
            &column.cells,
            Cells::Stamps {
                has: [true, false],
                ..
            }
        )
    });
    let Some(date) = date else {
        choice.because.why += ", without a date: seconds since midnight";
        return;
    };
    let column = &looked.columns[date];
    choice.keys.push(("date_column", written(&column.column)));
    choice.places.push(date);
    if let Cells::Stamps {
        problem, because, ..
    } = &column.cells
    {
        choice.because.why += &format!(", dates apart: {}", because.why);
        choice.open.clone_from(problem);
    }
}

fn of_numbers(column: &Seen, logs: usize, choice: &mut TimeChoice) {
    let step = rises(column.numbers(), logs).map_or(0.0, |(_, step)| step);
    if let Some(said) = &column.unit {
        let rate = 1.0 / said.unit.to_si(step);
        choice.keys.push(("unit", format!("{:?}", said.unit.name)));
        choice.because = said.because.clone();
        choice.because.why += &format!(", which makes {} samples a second", shown(rate));
        return;
    }
    let fits =
        |name: &&str| units::named(name).filter(|unit| USUAL.contains(&(1.0 / unit.to_si(step))));
    let found: Vec<&LogUnit> = TRIED.iter().filter_map(fits).collect();
    let whole = (step - step.round()).abs() < 1e-9 * step;
    let best = match &found[..] {
        [only] => Some(*only),
        // Whole numbers count the smaller unit.
        [larger, smaller, ..] => Some(if whole { *smaller } else { *larger }),
        [] => None,
    };
    match best {
        Some(unit) => {
            let rate = 1.0 / unit.to_si(step);
            choice.keys.push(("unit", format!("{:?}", unit.name)));
            let others: Vec<&str> = found
                .iter()
                .filter(|u| **u != unit)
                .map(|u| u.name)
                .collect();
            let also = if others.is_empty() {
                String::new()
            } else {
                format!(" ({} would be usual too)", others.join(", "))
            };
            choice.because = Because::likely(format!(
                "nothing says it; steps of {} make {} samples a second of it{also}",
                shown(step),
                shown(rate)
            ));
        }
        None => {
            choice.because = Because::likely("it rises from row to row");
            choice.open = Some(format!(
                "its unit: steps of {} are usual of no unit; add `unit` to it, one of {}",
                shown(step),
                super::units::choices(Unit::Second)
            ));
        }
    }
}
