//! What a log of an arm can say and what it cannot, before anybody records.

use serde_json::{Value, json};

use super::report::Report;
use crate::diagnosis::arm::base_parameters::{BaseParameters, base_parameters};
use crate::diagnosis::arm::contact::touching;
use crate::diagnosis::arm::evidence::Evidence;
use crate::diagnosis::arm::identifiability::{Expected, expected, randomly_moved};
use crate::diagnosis::arm::input::ArmInput;
use crate::diagnosis::arm::inseparable::{entangled, sentences};
use crate::diagnosis::arm::quantity_words::named;
use crate::document::{Cell, Column, Table};
use crate::quantity::significant;

/// Adds it: over random motion, and over the recordings where the input has some.
pub(super) fn identifiability(report: &mut Report, input: &ArmInput) {
    let random = randomly_moved(input);
    let any = Evidence::of(&random, &[]);
    let structural = base_parameters(&any);
    report.fact(
        "identifiable",
        format!(
            "{} of {} numbers of links, drives and sensors, alone or as combinations (base parameters), along a random motion within the joints' limits; condition {}",
            structural.rank,
            structural.numbers,
            significant(structural.condition, 2)
        ),
    );
    let touching = touching(input);
    let recorded = Evidence::of(input, &touching);
    let own = (!input.recordings.is_empty()).then(|| base_parameters(&recorded));
    if let Some(own) = &own {
        report.fact(
            "identifiable",
            format!(
                "{} along the recordings, {} of them closer than they are known already; condition {}",
                own.rank,
                own.beyond_noise,
                significant(own.condition, 2)
            ),
        );
    }
    let inseparable = sentences(input, &structural);
    for sentence in &inseparable {
        report.fact("not identifiable", sentence.as_str());
    }
    let evidence = if own.is_some() { &recorded } else { &any };
    let (left, covariance) = expected(evidence);
    let quantities: Vec<_> = left.iter().map(|one| one.quantity).collect();
    let alike = entangled(input, &quantities, &covariance);
    for set in &alike {
        report.fact("hardly distinguished", set.as_str());
    }
    let motion = match own {
        Some(_) => "the recordings",
        None => "a random motion of 40 s",
    };
    for table in tables(input, &left, motion) {
        report.table(table);
    }
    report.number(
        "identifiability",
        json!({
            "random_motion": of_motion(&structural),
            "recordings": own.as_ref().map(of_motion),
            "not_shown": structural.silent.iter().map(|q| name(input, *q)).collect::<Vec<_>>(),
            "together": structural.together.iter().map(|t| json!({
                "number": name(input, t.quantity),
                "with": t.with.iter().map(|q| name(input, *q)).collect::<Vec<_>>(),
            })).collect::<Vec<_>>(),
            "sentences": inseparable,
            "hardly_distinguished": alike,
            "left_of_tolerances": left.iter().map(|one| of_number(input, one)).collect::<Vec<_>>(),
        }),
    );
}

fn name(input: &ArmInput, quantity: crate::recorded_arm::Quantity) -> String {
    let named = named(input, quantity);
    format!("{}: {}", named.owner, named.part)
}

fn of_motion(base: &BaseParameters) -> Value {
    json!({
        "numbers": base.numbers,
        "base_parameters": base.rank,
        "closer_than_known": base.beyond_noise,
        "condition": base.condition,
    })
}

fn of_number(input: &ArmInput, one: &Expected) -> Value {
    let named = named(input, one.quantity);
    let [tolerance, half_width] = one.shown(&input.nominal);
    json!({
        "of": named.owner,
        "number": named.part,
        "unit": named.unit,
        "tolerance": tolerance,
        "half_width": half_width,
    })
}

/// A share of a tolerance.
fn share(left: f64) -> String {
    match left {
        left if left > 0.995 => "all".to_owned(),
        left => format!("{} %", significant(100.0 * left, 2)),
    }
}

/// A table for all that have the same numbers.
fn tables(input: &ArmInput, left: &[Expected], motion: &str) -> Vec<Table> {
    let mut owners: Vec<(String, Vec<(String, String)>)> = Vec::new();
    for one in left {
        let named = named(input, one.quantity);
        let cell = (named.part, share(one.half_width / one.tolerance));
        match owners.iter_mut().find(|(own, _)| *own == named.owner) {
            Some((_, cells)) => cells.push(cell),
            None => owners.push((named.owner, vec![cell])),
        }
    }
    let mut tables: Vec<Table> = Vec::new();
    for (owner, cells) in owners {
        let mut row = vec![Cell::from(owner)];
        row.extend(cells.iter().map(|(_, share)| Cell::from(share.as_str())));
        let names = cells
            .iter()
            .map(|(part, _)| Column::of_words(part.as_str()));
        let columns: Vec<Column> = std::iter::once(Column::of_words("of"))
            .chain(names)
            .collect();
        match tables.iter_mut().find(|table| table.columns == columns) {
            Some(table) => table.rows.push(row),
            None => tables.push(Table::new("", columns, vec![row])),
        }
    }
    if let Some(first) = tables.first_mut() {
        first.caption = format!(
            "Left of each tolerance by {motion} (half of the 95 % interval over the tolerance), if nothing but noise is left:"
        );
    }
    tables
}
