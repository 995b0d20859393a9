//! Description of an effect, for a terminal, a program and docs/EFFECTS.md.

use serde::Serialize;

use crate::demonstration::{self as scene, Scene, Stage};
use crate::diagnosis::answer::words::{capital, display_name};
use crate::document::{Block, Cell, Column, Document, Section, Table};
use crate::effects::{Effect, Header, Subsystem, Which, kinds};
use crate::plant::PlantParameters;
use crate::quantity::significant;

/// Where the pictures stand in the project.
pub(super) const PICTURES: &str = "docs/pictures/effects";
/// Digits of a number in a table.
const DIGITS: usize = 3;

/// An effect, explained.
#[derive(Debug, Serialize)]
pub(super) struct Explained {
    name: &'static str,
    pub meaning: &'static str,
    cause: &'static str,
    subsystem: &'static str,
    /// Chain of the rig that alone shows it; none of a whole device and its cell.
    #[serde(skip_serializing_if = "Option::is_none")]
    chain: Option<&'static str>,
    of_joint: bool,
    equation: &'static [&'static str],
    legend: &'static str,
    source: &'static str,
    parameters: Vec<Number>,
    signature: &'static str,
    confused_with: Vec<Rival>,
    /// A run that shows it.
    #[serde(skip_serializing_if = "Option::is_none")]
    command: Option<String>,
    /// Lines of a file.
    lines: Vec<String>,
    picture: String,
}

/// One number of an effect: range and usual size in the unit of its key, as the file takes it.
#[derive(Debug, Serialize)]
struct Number {
    key: &'static str,
    range: [f64; 2],
    usual: f64,
    /// That of the picture.
    shown: f64,
    /// Whether it is a part of a diagnosis's answer.
    reported: bool,
}

/// An effect with which another is confused.
#[derive(Debug, Serialize)]
struct Rival {
    name: &'static str,
    distinguished_by: &'static str,
}

/// A subsystem in words.
pub(super) fn heading(subsystem: Subsystem) -> &'static str {
    match subsystem {
        Subsystem::ForceBalance => "Forces on the piston",
        Subsystem::Chambers => "Chambers and supply",
        Subsystem::Regulator => "Regulator and valve",
        Subsystem::Contact => "Tool on workpiece",
        Subsystem::Sensors => "Sensors",
        Subsystem::Arm => "Arm",
        Subsystem::Workpiece => "Part",
    }
}

/// All of them, in the order in which they are listed.
pub(super) const SUBSYSTEMS: [Subsystem; 7] = [
    Subsystem::ForceBalance,
    Subsystem::Chambers,
    Subsystem::Regulator,
    Subsystem::Contact,
    Subsystem::Sensors,
    Subsystem::Arm,
    Subsystem::Workpiece,
];

/// Letters that a picture's title has room for.
const TITLE: usize = 90;

/// An effect with its size, over its picture.
pub(super) fn title(effect: &Effect, nominal: &PlantParameters, joint: usize) -> String {
    let (name, of_joint) = effect.vocabulary();
    let which = of_joint.map_or(String::new(), |_| format!(" of joint {joint}"));
    let mut title = format!("{name}{which}");
    let mut before = ": ";
    let parameters = effect.parameters(nominal);
    for (parameter, value) in parameters.iter().zip(scene::sizes(effect, nominal)) {
        let key = parameter.quantity.name;
        if !parameter.reported && key != "sine_m" {
            continue;
        }
        let (words, unit, factor) = display_name(key);
        let words = words.replace("sine", "amplitude");
        let size = format!("{before}{words} {} {unit}", size(factor * value));
        if title.len() + size.len() <= TITLE {
            title += size.trim_end();
        }
        before = ", ";
    }
    title
}

/// A size as people say it: no more digits than it has.
pub(super) fn size(value: f64) -> String {
    let text = significant(value, DIGITS);
    match text.contains('.') && !text.contains('·') {
        true => text.trim_end_matches('0').trim_end_matches('.').to_owned(),
        false => text,
    }
}

impl Explained {
    pub(super) fn new(effect: &Effect, stage: &Stage) -> Self {
        let header: &'static Header = effect.header();
        let name = effect.vocabulary().0;
        let of_joint = effect.which != Which::Only;
        let parameters = effect.parameters(&stage.nominal);
        let usual = effect.usual(&stage.nominal);
        let shown = scene::sizes(effect, &stage.nominal);
        let numbers: Vec<Number> = (parameters.iter().zip(usual).zip(shown))
            .map(|((parameter, usual), shown)| Number {
                key: parameter.quantity.name,
                range: parameter.bounds,
                usual: rounded(usual),
                shown: rounded(shown),
                reported: parameter.reported,
            })
            .collect();
        let mut lines = vec!["[[effect]]".to_owned(), format!("name = \"{name}\"")];
        lines.extend(of_joint.then(|| format!("joint = {}", stage.most_observable_joint)));
        lines.extend(numbers.iter().map(|n| format!("{} = {}", n.key, n.shown)));
        let (chain, command) = match scene::of(effect).scene {
            Scene::Part(parts) => (Some(parts.name()), None),
            Scene::Run(run) => {
                let out = format!("runs/{name}");
                let asked = scene::asked(effect);
                let command = format!("idc run {} --with {asked} --out {out}", run.path);
                (None, Some(command))
            }
        };
        Self {
            name,
            meaning: &header.meaning,
            cause: &header.cause,
            subsystem: effect.subsystem.name(),
            chain,
            of_joint,
            equation: &header.equation,
            legend: &header.legend,
            source: &header.source,
            parameters: numbers,
            signature: &header.signature,
            confused_with: (header.rivals.iter())
                .map(|(name, distinguished_by)| Rival {
                    name,
                    distinguished_by,
                })
                .collect(),
            command,
            lines,
            picture: format!("{PICTURES}/{name}.svg"),
        }
    }

    /// For a terminal, and docs/EFFECTS.md; its picture lies in a folder.
    pub(super) fn document(&self, pictures: &str) -> Document<'static> {
        let lines = |text: &str| Block::Lines(text.to_owned());
        let words = |text: &str| Block::Paragraph(text.to_owned());
        let columns = Column::list("key | number | range | #usual");
        let rows = self.parameters.iter();
        let rows = rows.map(|number| number.cells().map(Cell::from).to_vec());
        let numbers = Table::new("", columns, rows.collect());
        let rivals = self.confused_with.iter();
        let rivals =
            rivals.map(|rival| vec![self.rival(rival.name), rival.distinguished_by.into()]);
        let columns = Column::list("effect | distinguished by");
        let rivals = Table::new("", columns, rivals.collect());
        let file = match self.chain {
            Some(chain) => format!("In a rig file with chain = \"{chain}\" below [rig]"),
            None => "In a scenario".to_owned(),
        };
        let (picture, name) = (format!("{pictures}/{}.svg", self.name), self.name);
        let source = format!("Source: {}", self.source);
        let equation = vec![
            lines(&self.equation.join("\n")),
            words(self.legend),
            words(&source),
        ];
        let shown = format!("{name}, nominal and with the effect");
        let parts = [
            ("Equation", equation),
            ("Numbers", vec![Block::Table(numbers)]),
            ("Shows as", vec![words(&capital(self.signature))]),
            ("Confused with", vec![Block::Table(rivals)]),
            (
                "Try it",
                self.command.as_deref().map(lines).into_iter().collect(),
            ),
            (&file, vec![lines(&self.lines.join("\n"))]),
            ("Picture", vec![Block::File(picture, shown)]),
        ];
        let sections = parts.map(|(title, blocks)| Section::new(title, blocks));
        let lead = format!("{}. {}", capital(self.meaning), self.cause);
        Document {
            title: name.to_owned(),
            lead: vec![lead.trim_end().to_owned()],
            sections: sections.into(),
            ..Document::default()
        }
    }

    /// What it is confused with: another effect, where there is one of that name, by its own page.
    fn rival(&self, name: &str) -> Cell {
        let first = name.split(' ').next().unwrap_or_default();
        match first.contains('_') && first != self.name {
            true => Cell::Link(name.to_owned(), format!("#{first}")),
            false => Cell::from(name),
        }
    }
}

/// All effects by subsystem, each with its meaning.
pub(super) fn list() -> Document<'static> {
    let row = |effect: &&Effect| {
        let name = effect.vocabulary().0;
        let mark = if scene::is_of_part(effect) { "*" } else { "" };
        let link = Cell::Link(format!("{name}{mark}"), format!("#{name}"));
        vec![link, effect.header().meaning.as_str().into()]
    };
    let sections = by_subsystem().map(|(heading, effects)| {
        let columns = Column::list("effect | meaning");
        let table = Table::new("", columns, effects.iter().map(row).collect());
        Section::new(heading, vec![Block::Table(table)])
    });
    Document {
        sections: sections.collect(),
        ..Document::default()
    }
}

impl Number {
    /// Key, words with unit, range, usual size.
    fn cells(&self) -> [String; 4] {
        let (words, unit, factor) = display_name(self.key);
        let size = |value: f64| size(factor * value);
        let [low, high] = self.range.map(size);
        let unit = match unit {
            "" => String::new(),
            unit => format!(", {unit}"),
        };
        [
            self.key.to_owned(),
            format!("{words}{unit}"),
            format!("{low} to {high}"),
            size(self.usual),
        ]
    }
}

/// A size is what people say: three digits of it.
fn rounded(value: f64) -> f64 {
    format!("{value:.2e}").parse().unwrap_or(value)
}

/// Effects with their subsystem, in the order in which they are listed.
pub(super) fn by_subsystem() -> impl Iterator<Item = (&'static str, Vec<&'static Effect>)> {
    SUBSYSTEMS.into_iter().map(|subsystem| {
        let own = kinds().filter(|effect| effect.subsystem == subsystem);
        (heading(subsystem), own.collect())
    })
}
