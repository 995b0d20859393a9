//! Description of an effect of an arm file: drives, load or wrench sensor of an arm.

use serde::Serialize;

use super::page::{list, size};
use crate::demonstration::{ArmStage, arm_effects};
use crate::diagnosis::answer::words::{capital, display_name};
use crate::document::{Block, Cell, Column, Document, Section, Table};
use crate::recorded_arm::vocabulary::{ArmEffectName, Place};
use crate::run::RunError;

/// Above the list of them, and their pages.
pub(super) const HEADING: &str = "Drives, load and wrench sensor of an arm";

/// An effect, explained.
#[derive(Debug, Serialize)]
pub(super) struct ArmExplained {
    name: &'static str,
    pub meaning: &'static str,
    subsystem: &'static str,
    places: Vec<&'static str>,
    parameters: Vec<ArmNumber>,
    /// A run that shows it.
    command: String,
    /// Lines of a scenario.
    lines: Vec<String>,
    picture: String,
}

/// A number at its usual size, in SI.
#[derive(Debug, Serialize)]
struct ArmNumber {
    key: &'static str,
    usual: f64,
}

impl ArmExplained {
    pub(super) fn new(
        effect: &'static ArmEffectName,
        stage: &ArmStage,
        pictures: &str,
    ) -> Result<Self, RunError> {
        let name = effect.name;
        let edits = stage.edits(effect)?;
        let parameters: Vec<ArmNumber> = (effect.numbers.iter().zip(&edits))
            .map(|(key, edit)| ArmNumber {
                key,
                usual: edit.as_number().unwrap_or_default(),
            })
            .collect();
        // The key of each edit says where it is: arm.effect."NAME place=text".number
        let quoted = edits.first().and_then(|edit| edit.key().split('"').nth(1));
        let places = quoted.unwrap_or_default().split(' ').skip(1);
        let places = places.filter_map(|word| word.split_once('='));
        let mut lines = vec!["[[arm.effect]]".to_owned(), format!("name = \"{name}\"")];
        lines.extend(places.map(|(key, text)| match key == Place::Joint.key() {
            true => format!("{key} = {text}"),
            false => format!("{key} = \"{text}\""),
        }));
        lines.extend(
            parameters
                .iter()
                .map(|n| format!("{} = {}", n.key, size(n.usual))),
        );
        Ok(Self {
            name,
            meaning: effect.meaning,
            subsystem: effect.subsystem,
            places: effect.places.iter().map(|place| place.key()).collect(),
            parameters,
            command: format!(
                "idc run {} --with {name} --out runs/{name}",
                stage.scenario()
            ),
            lines,
            picture: format!("{pictures}/{name}.svg"),
        })
    }

    /// Over its picture.
    pub(super) fn title(&self) -> String {
        let joint = self
            .lines
            .iter()
            .find_map(|line| line.strip_prefix("joint = "));
        match joint {
            Some(joint) => format!("{} of joint {joint}", self.name),
            None => self.name.to_owned(),
        }
    }

    /// For a terminal, and docs/EFFECTS.md.
    pub(super) fn document(&self) -> Document<'static> {
        let columns = Column::list("key | number | #usual");
        let rows = self.parameters.iter().map(|number| {
            let (words, unit, factor) = display_name(number.key);
            let unit = match unit {
                "" => String::new(),
                unit => format!(", {unit}"),
            };
            let cells = [
                number.key.to_owned(),
                format!("{words}{unit}"),
                size(factor * number.usual),
            ];
            cells.map(Cell::from).to_vec()
        });
        let numbers = Table::new("", columns, rows.collect());
        let shown = format!("{}, nominal and with the effect", self.name);
        let parts = [
            ("Numbers", Block::Table(numbers)),
            ("Try it", Block::Lines(self.command.clone())),
            ("In a scenario", Block::Lines(self.lines.join("\n"))),
            ("Picture", Block::File(self.picture.clone(), shown)),
        ];
        let sections = parts.map(|(title, block)| Section::new(title, vec![block]));
        Document {
            title: self.name.to_owned(),
            lead: vec![format!("{}.", capital(self.meaning))],
            sections: sections.into(),
            ..Document::default()
        }
    }
}

/// All effects, those of an arm file last.
pub(super) fn list_of_all() -> Document<'static> {
    let mut all = list();
    all.sections.push(section());
    all
}

/// All of them, each with its meaning.
fn section() -> Section<'static> {
    let row = |effect: &ArmEffectName| {
        let link = Cell::Link(effect.name.to_owned(), format!("#{}", effect.name));
        vec![link, effect.meaning.into()]
    };
    let columns = Column::list("effect | meaning");
    let table = Table::new("", columns, arm_effects().map(row).collect());
    Section::new(HEADING, vec![Block::Table(table)])
}
