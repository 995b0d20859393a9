//! The clocks of a log: one for all of its columns, or one for each group behind a column of times.

use super::assign::described;
use super::names::parts;
use super::seen::{Cells, Looked, Seen};
use super::time::is_time;

/// Columns with their clock.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Group {
    /// Place of the clock.
    pub clock: usize,
    /// Places of the columns that it is of.
    pub columns: Vec<usize>,
}

/// Clocks of a log.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) enum Clocks {
    /// One for all columns, if any.
    One,
    /// Several, each with the columns behind it.
    Each(Vec<Group>),
    /// Several, and it is unknown which is whose.
    Open(String),
}

/// Clocks of a log, of which `logs` are there one behind the other.
pub(super) fn clocks(looked: &Looked, logs: usize) -> Clocks {
    let columns = &looked.columns;
    let times: Vec<usize> = (0..columns.len())
        .filter(|place| is_time(*place, &columns[*place], logs))
        .collect();
    if let Some(labelled) = labelled(columns, logs) {
        return Clocks::Each(groups(columns.len(), &labelled));
    }
    let [first, .., last] = times[..] else {
        return Clocks::One;
    };
    let groups = groups(columns.len(), &times);
    let has_values = |group: &Group| group.columns.iter().any(|place| is_value(&columns[*place]));
    let between = (0..first).any(|place| is_value(&columns[place]));
    let all = groups.iter().all(has_values) && !between;
    let named: Vec<bool> = groups.iter().map(|group| is_of(columns, group)).collect();
    if all && named.iter().all(|named| *named) {
        return Clocks::Each(groups);
    }
    // Two writings of one clock stand side by side, and agree.
    let beside = (first..=last).all(|place| times.contains(&place) || !is_value(&columns[place]));
    let one = columns_pair(columns, &times);
    if (beside || groups.iter().filter(|group| has_values(group)).count() < 2) && !one {
        return Clocks::One;
    }
    if same(columns, &times) {
        return Clocks::One;
    }
    let names: Vec<String> = times
        .iter()
        .map(|place| described(&columns[*place]))
        .collect();
    Clocks::Open(format!(
        "{} may all be times: which of them is the clock of which column? A [[file]] for each clock, the further ones with `same_log = true`, has the columns of that clock",
        names.join(", ")
    ))
}

/// Columns of times that bear the same label: `Name`, `X_Value`, `Time.1`; none unless the first column is one of several.
fn labelled(columns: &[Seen], logs: usize) -> Option<Vec<usize>> {
    let label = |column: &Seen| -> String {
        let name = column.name.trim_end_matches([')', ' ']);
        let name = name.trim_end_matches(|c: char| c.is_ascii_digit());
        name.trim_end_matches(['.', '_', '(', ' ']).to_lowercase()
    };
    let own = label(columns.first()?);
    let unit = |column: &Seen| column.unit.as_ref().map(|said| said.unit);
    let same: Vec<usize> = (0..columns.len())
        .filter(|place| {
            let column = &columns[*place];
            label(column) == own && unit(column) == unit(&columns[0]) && may_be_clock(column, logs)
        })
        .collect();
    let known = !own.is_empty();
    let bears = columns.iter().filter(|column| label(column) == own).count();
    (known && same.len() > 1 && same[0] == 0 && same.len() == bears).then_some(same)
}

/// Whether a column could be times, whatever its name.
fn may_be_clock(column: &Seen, logs: usize) -> bool {
    match &column.cells {
        Cells::Numbers(values) => {
            super::time::rises(values, logs).is_some_and(|rise| rise.is_rising(logs))
        }
        Cells::Stamps { has, .. } => has[1],
        Cells::States(_) | Cells::Other => false,
    }
}

fn is_value(column: &Seen) -> bool {
    matches!(column.cells, Cells::Numbers(_) | Cells::States(_))
}

/// Each clock with the columns from it to the next.
fn groups(count: usize, clocks: &[usize]) -> Vec<Group> {
    let ends = clocks.iter().skip(1).copied().chain([count]);
    let group = |(clock, end): (&usize, usize)| Group {
        clock: *clock,
        columns: (clock + 1..end).collect(),
    };
    clocks.iter().zip(ends).map(group).collect()
}

/// What a name says beside that it is of times, in small letters.
fn rest_of_name(column: &Seen) -> Vec<String> {
    let words = [
        "t",
        "time",
        "zeit",
        "temps",
        "tempo",
        "tiempo",
        "timestamp",
        "x",
        "value",
    ];
    let all = parts(&column.name).into_iter();
    all.filter(|part| !words.contains(&part.as_str())).collect()
}

/// Whether a clock is named by one of its columns: `t_F` of `F`, or has but a number: `t1`.
fn is_of(columns: &[Seen], group: &Group) -> bool {
    let rest = rest_of_name(&columns[group.clock]);
    let is_number = |part: &String| part.bytes().all(|byte| byte.is_ascii_digit());
    if !rest.is_empty() && rest.iter().all(is_number) {
        return true;
    }
    let names = |place: &usize| parts(&columns[*place].name);
    !rest.is_empty()
        && group
            .columns
            .iter()
            .flat_map(names)
            .any(|part| rest.contains(&part))
}

/// Whether two clocks bear the names of two columns, wherever those stand.
fn columns_pair(columns: &[Seen], clocks: &[usize]) -> bool {
    let of = |clock: usize| {
        let rest = rest_of_name(&columns[clock]);
        (0..columns.len()).find(|place| {
            !clocks.contains(place)
                && is_value(&columns[*place])
                && parts(&columns[*place].name)
                    .iter()
                    .any(|part| rest.contains(part))
        })
    };
    let mut found: Vec<usize> = clocks.iter().filter_map(|clock| of(*clock)).collect();
    found.sort_unstable();
    found.dedup();
    found.len() > 1
}

/// Whether columns of times hold the same numbers, in the same unit.
fn same(columns: &[Seen], clocks: &[usize]) -> bool {
    let first = columns[clocks[0]].numbers();
    let alike = |place: &usize| {
        let own = columns[*place].numbers();
        let unit = |place: usize| columns[place].unit.as_ref().map(|said| said.unit);
        !own.is_empty() && own == first && unit(*place) == unit(clocks[0])
    };
    clocks.iter().all(alike)
}
