//! The tables of a diagnosis: how well it fits, the rig's own numbers, what was ruled out.

use crate::diagnosis::answer::Answer;
use crate::diagnosis::answer::account::SectionKind;
use crate::diagnosis::answer::details::{
    ChannelMisfit, Considered, DetectableReport, IdentifiedNumber, PredictionError, RuledOutReport,
    ToleratedNumber,
};
use crate::diagnosis::answer::estimate::Limit;
use crate::diagnosis::answer::words::{display_name, odds, of_column, percent, reference_noise};
use crate::document::{Block, Cell, Column, Number, Section, Table};
use crate::quantity::{change, significant};

pub(super) fn how_well<'a>(answer: &Answer) -> Option<Section<'a>> {
    let details = &answer.details;
    let reference_noise = reference_noise(details.remaining.is_some());
    let tables = [
        misfit(&details.misfit, reference_noise),
        prediction(&details.prediction, reference_noise),
    ];
    let mut blocks: Vec<Block<'a>> = tables.into_iter().flatten().map(Block::Table).collect();
    let kinds = [
        SectionKind::Remaining,
        SectionKind::Simulated,
        SectionKind::UnseenRun,
        SectionKind::Runs,
    ];
    blocks.extend(paragraphs(answer, &kinds));
    (!blocks.is_empty()).then(|| Section::new("How well it fits", blocks))
}

/// Departure of each channel of each recording, in multiples of the reference noise.
fn misfit(misfit: &[ChannelMisfit], reference_noise: &str) -> Option<Table> {
    // Of one recording, and where no other is fitted, none was left out.
    let has_left_out = misfit.iter().any(|m| m.left_out_sigmas.is_some());
    let row = |(index, m): (usize, &ChannelMisfit)| {
        let (words, unit, factor) = of_column(&m.channel);
        let number = |key: &str, value: f64, unit: &str| {
            let key = format!("misfit.{index}.{key}");
            let number = Number::new(&key, None, unit);
            Cell::from(number.written(significant(value, 3)))
        };
        let sigmas = |key: &str, value: f64| number(key, value, "");
        let left_out =
            (m.left_out_sigmas).map_or(Cell::from("–"), |value| sigmas("left_out_sigmas", value));
        let cells = [
            Cell::from(m.recording.clone()),
            Cell::from(words),
            Cell::from(m.samples.to_string()),
            number("believed_rms", factor * m.nominal_rms, unit),
            number("improved_rms", factor * m.improved_rms, unit),
            sigmas("believed_sigmas", m.nominal_sigmas),
            sigmas("tolerated_sigmas", m.tolerated_sigmas),
            sigmas("improved_sigmas", m.improved_sigmas),
        ];
        let left_out = has_left_out.then_some(left_out);
        cells.into_iter().chain(left_out).collect()
    };
    (!misfit.is_empty()).then(|| {
        let (more, column) = match has_left_out {
            true => (" The last column is a fit to the other recordings.", " | #not fitted to, σ"),
            false => ("", ""),
        };
        let caption = format!(
            "What the models leave of each channel: root mean square, then a robust one in multiples of {reference_noise} (1 is as much).{more}"
        );
        let columns = format!("recording | channel | #readings | #nominal | #improved | #nominal, σ | #within tolerances, σ | #improved, σ{column}");
        Table::new(
            &caption,
            Column::list(&columns),
            misfit.iter().enumerate().map(row).collect(),
        )
    })
}

/// Errors on what was not fitted to.
fn prediction(errors: &[PredictionError], reference_noise: &str) -> Option<Table> {
    let row = |(index, e): (usize, &PredictionError)| {
        let (words, unit, factor) = of_column(&e.channel);
        let number = |key: &str, value: f64| {
            let key = format!("prediction.{index}.{key}");
            let number = Number::new(&key, None, unit);
            Cell::from(number.written(significant(factor * value, 3)))
        };
        vec![
            Cell::from(e.recording.clone()),
            Cell::from(words),
            number("believed", e.nominal),
            number("before", e.before),
            number("after", e.after),
            (e.noise).map_or(Cell::from("–"), |noise| number("noise", noise)),
            e.after_sigmas.map_or(Cell::from("–"), |sigmas| {
                Cell::from(significant(sigmas, 3))
            }),
        ]
    };
    (!errors.is_empty()).then(|| {
        Table::new(
            "Root mean square of the errors on what was not fitted to; σ: the robust one in multiples of the last but one column.",
            vec![Column::of_words("recording"), Column::of_words("channel"), Column::of_numbers("nominal"), Column::of_numbers("within tolerances"), Column::of_numbers("improved"), Column::of_numbers(reference_noise), Column::of_numbers("improved, σ")],
            errors.iter().enumerate().map(row).collect(),
        )
    })
}

/// The smallest effects that the recordings would have shown.
pub fn detectable<'a>(answer: &Answer) -> Option<Section<'a>> {
    let all = &answer.details.detectable;
    let row = |smallest: &DetectableReport| {
        vec![
            Cell::from(smallest.effect.clone()),
            Cell::from(smallest.words()),
        ]
    };
    (!all.is_empty()).then(|| {
        let table = Table::new(
            "The smallest effects that these recordings would have shown, each alone and nine times in ten, if not always by its name.",
            Column::list("effect | numbers"),
            all.iter().map(row).collect(),
        );
        Section::new("What would have shown", vec![Block::Table(table)])
    })
}

pub(super) fn own_numbers<'a>(answer: &Answer) -> Option<Section<'a>> {
    let tolerated = &answer.details.tolerated;
    let row = |(index, number): (usize, &ToleratedNumber)| {
        let shown = |key: &str, value: f64| {
            let key = format!("tolerated.{index}.{key}");
            Cell::from(Number::bare(&key, None, "").written(significant(value, 4)))
        };
        let (words, unit, factor) = display_name(&number.key);
        let found = number.found;
        let shift = 100.0 * (found.value / number.nominal - 1.0);
        vec![
            Cell::from(words),
            shown("believed", factor * number.nominal),
            shown("found.value", factor * found.value),
            shown("found.low", factor * found.low),
            shown("found.high", factor * found.high),
            Cell::from(unit),
            Cell::from(match shift.is_finite() {
                true => change(shift),
                false => String::new(),
            }),
            match found.at_limit {
                Some(Limit::Lower) => Cell::Verdict("lower end".to_owned(), false),
                Some(Limit::Upper) => Cell::Verdict("upper end".to_owned(), false),
                None => Cell::from(""),
            },
        ]
    };
    let rows: Vec<Vec<Cell>> = tolerated.iter().enumerate().map(row).collect();
    let table = Table::new(
        "The rig file's own numbers, moved within their tolerances.",
        Column::list("number | #nominal | #found | #low | #high | unit | #change | at a limit"),
        rows,
    );
    let words = paragraphs(answer, &[SectionKind::OwnNumbers]);
    let blocks = words.chain((!tolerated.is_empty()).then_some(Block::Table(table)));
    let blocks: Vec<Block<'a>> = blocks.collect();
    (!blocks.is_empty()).then(|| Section::new("The rig's own numbers", blocks))
}

/// Numbers of a sensor and its tool.
pub(super) fn identified<'a>(answer: &Answer) -> Option<Section<'a>> {
    let row = |(index, number): (usize, &IdentifiedNumber)| {
        let (words, unit, factor) = display_name(&number.key);
        let shown = |key: &str, value: f64| {
            let key = format!("identified.{index}.found.{key}");
            Cell::from(Number::bare(&key, None, "").written(significant(factor * value, 4)))
        };
        let found = number.found;
        vec![
            Cell::from(words),
            shown("value", found.value),
            shown("low", found.low),
            shown("high", found.high),
            Cell::from(unit),
        ]
    };
    let all = &answer.details.identified;
    let table = Table::new(
        "Numbers of sensor and tool, with their 95 % intervals.",
        Column::list("number | #value | #low | #high | unit"),
        all.iter().enumerate().map(row).collect(),
    );
    (!all.is_empty()).then(|| Section::new("What was identified", vec![Block::Table(table)]))
}

pub(super) fn ruled_out<'a>(answer: &Answer) -> Option<Section<'a>> {
    let details = &answer.details;
    let mut blocks = Vec::new();
    let names = |effects: &[String]| {
        let names: Vec<String> = effects.iter().map(|name| name.replace('_', " ")).collect();
        match names.is_empty() {
            true => "nothing missing".to_owned(),
            false => names.join(" and "),
        }
    };
    let row = |other: &Considered| {
        let against = match other.log10_odds {
            power if other.is_close() => Cell::Verdict(odds(power), false),
            power => Cell::from(odds(power)),
        };
        let verdict = match (other.is_close(), other.is_ruled_out()) {
            (true, _) => "not ruled out",
            (_, true) => "ruled out",
            _ => "fell behind",
        };
        vec![
            Cell::from(names(&other.effects)),
            Cell::from(verdict),
            against,
            Cell::from(other.explained_share.map_or("–".to_owned(), percent)),
            Cell::from(if other.in_full { "in full" } else { "roughly" }),
        ]
    };
    if !details.considered.is_empty() {
        blocks.push(Block::Table(Table::new(
            "Other explanations, against the one given. Ruled out: fitted in full, at odds below 1 to 100; fell behind: the same by a rough fit, with the piston held to its measured motion, where a law that acts on the motion alone can seem to explain more than it does.",
            Column::list("explanation | verdict | #odds | #of the mismatch explained | fitted"),
            details.considered.iter().map(row).collect(),
        )));
    }
    // A part of the device has one channel.
    let own = details.misfit.first();
    let (_, unit, factor) = of_column(own.map_or("", |misfit| misfit.channel.as_str()));
    let row = |variant: &RuledOutReport| {
        vec![
            Cell::from(names(&variant.effects)),
            Cell::from(format!("{} {unit}", significant(factor * variant.rms, 3))),
        ]
    };
    if !details.ruled_out.is_empty() {
        blocks.push(Block::Table(Table::new(
            "Variants of the answer, fitted anew: without one of its effects, or with another law in its place.",
            Column::list("explanation | #leaves, RMS"),
            details.ruled_out.iter().map(row).collect(),
        )));
    }
    blocks.extend(paragraphs(
        answer,
        &[SectionKind::RuledOut, SectionKind::Ambiguous],
    ));
    (!blocks.is_empty()).then(|| Section::new("Other explanations", blocks))
}

/// What the account says of these, a paragraph each.
pub(super) fn paragraphs<'a>(
    answer: &Answer,
    kinds: &[SectionKind],
) -> impl Iterator<Item = Block<'a>> {
    let account = &answer.details.account;
    let sections = kinds.iter().filter_map(|kind| account.section(*kind));
    let paragraphs = sections.flat_map(|section| &section.paragraphs);
    paragraphs.map(|text| Block::Paragraph(text.clone()))
}
