//! Several runs, or several diagnoses, side by side.

use std::path::Path;

use super::signals::{ROLES, chart_groups};
use crate::diagnosis::answer::Answer;
use crate::diagnosis::answer::estimate::Estimate;
use crate::diagnosis::answer::words::{display_name, of_column};
use crate::document::{
    Block, Cell, Column, Document, Fact, Number, Panel, Section, Series, Stroke, Table,
};
use crate::quantity::{capital, change, percent, significant};
use crate::recording::{Recording, schema};
use crate::run::RunResult;

/// Signals that are drawn over one another at most.
pub const MOST_DRAWN: usize = ROLES.len();
/// Of more the title says how many there are.
const NAMED: usize = 3;
/// Signals of a run that are compared: one line of each, however many sensors see it.
const SIGNALS: [&str; 7] = [
    schema::CONTACT_FORCE,
    schema::STROKE,
    schema::REGULATOR_PRESSURE,
    schema::CHAMBER_1_PRESSURE,
    schema::PATH_ERROR,
    schema::PATH_LAG,
    schema::PATH_ERROR_AXIAL,
];
/// The parameter that says which joint; no number to compare.
const JOINT: &str = "joint";

/// A number of all of them.
#[derive(Debug, Clone, PartialEq)]
pub struct ComparedNumber {
    /// Its name.
    pub name: String,
    /// Its unit as it is shown; empty for a pure number.
    pub unit: String,
    /// Its key.
    pub key: String,
    /// What a value is multiplied by to be in that unit.
    pub factor: f64,
    /// Its values, as the files have them; none where one has no such number.
    pub values: Vec<Option<f64>>,
}

/// Results side by side.
#[derive(Debug, Clone, Default)]
pub struct Comparison {
    /// Their folders.
    pub names: Vec<String>,
    /// What came of each, in a line.
    pub verdicts: Vec<String>,
    /// Their numbers.
    pub numbers: Vec<ComparedNumber>,
    /// Recordings that are drawn over one another, by their place.
    pub drawn: Vec<(usize, Recording)>,
}

impl ComparedNumber {
    /// One of its values as it is shown.
    #[must_use]
    pub fn shown(&self, place: usize) -> Number {
        let value = self.values[place].map(|value| self.factor * value);
        Number::bare(&self.key, value, &self.unit)
    }

    /// Change of a value against the first; none where there is nothing to compare.
    #[must_use]
    pub fn change(&self, place: usize) -> Option<String> {
        let (first, own) = (self.values[0]?, self.values[place]?);
        let share = 100.0 * (own - first) / first.abs();
        match share {
            _ if own == first => Some("=".to_owned()),
            share if !share.is_finite() => None,
            share if share.abs() >= 1000.0 => Some(format!("x{}", significant(own / first, 2))),
            share => Some(change(share)),
        }
    }
}

impl Comparison {
    /// Of runs.
    #[must_use]
    pub fn of_runs(
        names: Vec<String>,
        results: &[RunResult],
        drawn: Vec<(usize, Recording)>,
    ) -> Self {
        let mut numbers: Vec<ComparedNumber> = Vec::new();
        for (label, _) in results.iter().flat_map(RunResult::metrics) {
            if !numbers.iter().any(|known| known.key == label.key) {
                let values = results.iter().map(|result| result.metric(label.key));
                numbers.push(ComparedNumber {
                    unit: label.unit.to_owned(),
                    key: label.key.to_owned(),
                    factor: 1.0,
                    values: values.collect(),
                    name: label.name,
                });
            }
        }
        Self {
            verdicts: results.iter().map(|result| result.title.clone()).collect(),
            names,
            numbers,
            drawn,
        }
    }

    /// Of diagnoses.
    #[must_use]
    pub fn of_diagnoses(names: Vec<String>, answers: &[Answer]) -> Self {
        let mut compared = Self {
            verdicts: answers.iter().map(verdict).collect(),
            names,
            ..Self::default()
        };
        let number = |key: String, name: String, unit: &str, factor| ComparedNumber {
            name,
            unit: unit.to_owned(),
            key,
            factor,
            values: vec![None; answers.len()],
        };
        for (place, answer) in answers.iter().enumerate() {
            for effect in &answer.effects {
                // Frictions of two joints are two effects.
                let of_joint =
                    |(name, joint): &&(String, Estimate)| name == JOINT && joint.value > 0.0;
                let own = match effect.parameters.iter().find(of_joint) {
                    Some((_, joint)) => format!("{}_{}", effect.name, joint.value),
                    None => {
                        let place = effect.parameters.place.iter();
                        let place = place.map(|(key, place)| format!("_{key}_{place}"));
                        effect.name.clone() + &place.collect::<String>()
                    }
                };
                let words = own.replace('_', " ");
                let key = format!("{own}.probability");
                let probability = number(key, format!("{words}: probability"), "", 1.0);
                compared.add(probability, place, effect.confidence);
                let parameters = effect.parameters.iter().filter(|(name, _)| name != JOINT);
                for (name, estimate) in parameters {
                    let (shown, unit, factor) = display_name(name);
                    let key = format!("{own}.{name}");
                    let parameter = number(key, format!("{words}: {shown}"), unit, factor);
                    compared.add(parameter, place, estimate.value);
                }
            }
            for error in &answer.details.prediction {
                let (shown, unit, factor) = of_column(&error.channel);
                let key = format!("prediction.{}", error.channel);
                let name = format!("error of {shown}, not fitted to");
                compared.add(number(key, name, unit, factor), place, error.after);
            }
        }
        compared
    }

    /// A value of one of the results, in the row of its key.
    fn add(&mut self, number: ComparedNumber, place: usize, value: f64) {
        let known = self
            .numbers
            .iter()
            .position(|known| known.key == number.key);
        let index = known.unwrap_or(self.numbers.len());
        if known.is_none() {
            self.numbers.push(number);
        }
        self.numbers[index].values[place] = Some(value);
    }

    /// The document.
    #[must_use]
    pub fn document(&self) -> Document<'_> {
        let names = short(&self.names);
        let facts = names.iter().zip(&self.verdicts);
        let facts = facts.map(|(name, verdict)| Fact::new(name, "", verdict));
        let mut drawn = self.over_one_another(&names);
        let (few, many) = (self.drawn.len(), names.len());
        if !drawn.is_empty() && few < many {
            let words = format!("Signals of {few} of the {many} runs, from the first to the last.");
            drawn.insert(0, Block::Paragraph(words));
        }
        let signals = Section::new("Over one another", drawn);
        let numbers = Section::new("Numbers", vec![Block::Table(self.table(&names))]);
        let sections = [signals, numbers].into_iter();
        Document {
            title: "Comparison".to_owned(),
            verdict: match names.len() {
                ..=NAMED => names.join(" / "),
                count => format!("{count} side by side"),
            },
            // Of more, the table below has the names.
            facts: facts
                .take(if many <= MOST_DRAWN { many } else { 0 })
                .collect(),
            sections: sections.filter(|s| !s.blocks.is_empty()).collect(),
            footer: "Made by idc compare.".to_owned(),
            file: "a page (--out)".to_owned(),
            ..Document::default()
        }
    }

    fn over_one_another(&self, names: &[String]) -> Vec<Block<'_>> {
        let mut blocks = Vec::new();
        for group in chart_groups() {
            let lines = group.lines.iter().filter(|line| SIGNALS.contains(&line.0));
            for (quantity, words, ..) in lines {
                let line = |(index, (place, recording)): (usize, &(usize, Recording))| {
                    let values = &recording.channel(quantity)?.values;
                    let values: Vec<f64> = values.iter().map(|v| v * group.factor).collect();
                    let time = recording.time().to_vec();
                    // Where runs agree, both are seen.
                    let stroke = match index % 2 {
                        0 => Stroke::Plain,
                        _ => Stroke::Dashed,
                    };
                    Some(Series::new(
                        &names[*place],
                        time,
                        values,
                        ROLES[index],
                        stroke,
                    ))
                };
                let series: Vec<Series<'_>> =
                    self.drawn.iter().enumerate().filter_map(line).collect();
                if !series.is_empty() {
                    blocks.push(Block::Panel(Panel {
                        title: format!("{}: {words}", group.title),
                        vertical_label: group.label.to_owned(),
                        series,
                        group: "runs".to_owned(),
                        ..Panel::default()
                    }));
                }
            }
        }
        blocks
    }

    fn table(&self, names: &[String]) -> Table {
        let mut columns = Column::list("number | unit");
        for (place, name) in names.iter().enumerate() {
            columns.push(Column::of_numbers(name));
            if place > 0 {
                columns.push(Column::of_numbers("change"));
            }
        }
        let row = |number: &ComparedNumber| {
            let mut cells = vec![
                Cell::from(number.name.as_str()),
                Cell::from(number.unit.as_str()),
            ];
            for place in 0..number.values.len() {
                cells.push(number.shown(place).into());
                if place > 0 {
                    cells.push(Cell::from(number.change(place).unwrap_or_default()));
                }
            }
            cells
        };
        Table::new("", columns, self.numbers.iter().map(row).collect())
    }
}

fn verdict(answer: &Answer) -> String {
    let headline = capital(&answer.details.account.headline.replace('_', " "));
    match answer.details.explained_share {
        Some(share) => format!("{headline} ({} of the mismatch explained)", percent(share)),
        None => headline,
    }
}

/// Folders by their last parts, as many of them as tell them apart.
fn short(names: &[String]) -> Vec<String> {
    let parts = |name: &String| -> Vec<String> {
        let parts = Path::new(name).components();
        parts
            .map(|part| part.as_os_str().display().to_string())
            .collect()
    };
    let parts: Vec<Vec<String>> = names.iter().map(parts).collect();
    let most = parts.iter().map(Vec::len).max().unwrap_or(1);
    let ends = |count: usize| -> Vec<String> {
        let end = |parts: &Vec<String>| parts[parts.len().saturating_sub(count)..].join("/");
        parts.iter().map(end).collect()
    };
    let differ = |count: &usize| {
        let mut ends = ends(*count);
        ends.sort();
        ends.dedup();
        ends.len() == names.len()
    };
    // The same folder twice is called the same.
    ends((1..=most).find(differ).unwrap_or(1))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn folders_are_called_by_the_ends_that_differ() {
        let called = |names: &[&str]| {
            let names: Vec<String> = names.iter().map(|name| (*name).to_owned()).collect();
            short(&names)
        };
        assert_eq!(called(&["runs/step", "runs/push/"]), ["step", "push"]);
        let both = ["runs/mine/found", "runs/yours/found"];
        assert_eq!(called(&both), ["mine/found", "yours/found"]);
        assert_eq!(called(&["a", "a"]), ["a", "a"]);
        assert_eq!(called(&["found", "other/found"]), ["found", "other/found"]);
    }
}
