//! The page of a comparison.

use super::super::report::{ROLES, RunResult, chart_groups};
use super::numbers::{Compared, MOST, Row, short};
use crate::document::{
    Block, Cell, Document, Fact, Horizontal, Panel, Section, Series, Stroke, Table, Tone,
};
use crate::recording::schema;

/// Names that a heading has room for.
const NAMED: usize = 3;
/// Signals that are drawn over one another.
const SIGNALS: [&str; 7] = [
    schema::CONTACT_FORCE,
    schema::STROKE,
    schema::REGULATOR_PRESSURE,
    schema::CHAMBER_1_PRESSURE,
    schema::PATH_ERROR,
    schema::PATH_LAG,
    schema::PATH_ERROR_AXIAL,
];

pub(super) fn page(compared: &Compared) -> Document<'_> {
    let names = short(&compared.names);
    let facts = compared.names.iter().zip(&compared.verdicts);
    let facts = facts.map(|(name, verdict)| Fact {
        name: name.clone(),
        value: String::new(),
        remark: verdict.clone(),
    });
    let mut drawn = over_one_another(compared, &names);
    let (few, many) = (compared.drawn.len(), names.len());
    if !drawn.is_empty() && few < many {
        let words = format!("Signals of {few} of the {many} runs, from the first to the last.");
        drawn.insert(0, Block::Paragraph(words));
    }
    let signals = Section::new("Over one another", drawn);
    let numbers = Section::new("Numbers", vec![Block::Table(table(compared, &names))]);
    let sections = [signals, numbers].into_iter();
    Document {
        title: "Comparison".to_owned(),
        verdict: match names.len() {
            ..=NAMED => names.join(" / "),
            count => format!("{count} side by side"),
        },
        tone: Tone::Plain,
        // Of more, the table below has the names.
        facts: facts
            .take(if names.len() <= MOST { MOST } else { 0 })
            .collect(),
        sections: sections.filter(|s| !s.blocks.is_empty()).collect(),
        footer: "Made by idc compare.".to_owned(),
        ..Document::default()
    }
}

fn over_one_another<'a>(compared: &'a Compared, names: &[String]) -> Vec<Block<'a>> {
    let mut blocks = Vec::new();
    for group in chart_groups() {
        for (quantity, words, ..) in group.lines.iter().filter(|line| SIGNALS.contains(&line.0)) {
            let line = |(index, (place, run)): (usize, &(usize, RunResult<'_>))| {
                let values = &run.recording.channel(quantity)?.values;
                let values: Vec<f64> = values.iter().map(|v| v * group.factor).collect();
                let time = run.recording.time().to_vec();
                // Where runs agree, both are seen.
                let stroke = match index % 2 {
                    0 => Stroke::Plain,
                    _ => Stroke::Dashed,
                };
                let name = names[*place].clone();
                Some(Series::new(name, time, values, ROLES[index], stroke))
            };
            let series: Vec<Series<'_>> =
                compared.drawn.iter().enumerate().filter_map(line).collect();
            if !series.is_empty() {
                blocks.push(Block::Panel(Panel {
                    title: format!("{}: {words}", group.title),
                    vertical_label: group.label.to_owned(),
                    horizontal: Horizontal::Time,
                    series,
                    group: "runs".to_owned(),
                    ..Panel::default()
                }));
            }
        }
    }
    blocks
}

fn table(compared: &Compared, names: &[String]) -> Table {
    let mut columns = vec!["number".to_owned(), "unit".to_owned()];
    for (place, name) in names.iter().enumerate() {
        columns.push(format!("#{name}"));
        if place > 0 {
            columns.push("#change".to_owned());
        }
    }
    let columns: Vec<&str> = columns.iter().map(String::as_str).collect();
    let row = |row: &Row| {
        let mut cells = vec![Cell::from(row.name.clone()), Cell::from(row.unit.clone())];
        for place in 0..row.values.len() {
            cells.push(Cell::from(row.shown(place)));
            if place > 0 {
                cells.push(Cell::from(row.change(place).unwrap_or_default()));
            }
        }
        cells
    };
    Table::new("", &columns, compared.rows.iter().map(row).collect())
}
