//! The tables of a diagnosis: how well it fits, the rig's own numbers, what was ruled out.

use crate::diagnosis::answer::Answer;
use crate::diagnosis::answer::account::SectionKind;
use crate::diagnosis::answer::details::{
    ChannelMisfit, Considered, DetectableReport, PredictionError, RuledOutReport, ToleratedNumber,
};
use crate::diagnosis::answer::estimate::Limit;
use crate::diagnosis::answer::words::{display_name, odds, of_column, percent, reference_noise};
use crate::document::{Block, Cell, Section, Table};
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
    blocks.extend(account_paragraphs(answer, &kinds));
    (!blocks.is_empty()).then(|| Section::new("How well it fits", blocks))
}

/// Departure of each channel of each recording, in multiples of the reference noise.
fn misfit(misfit: &[ChannelMisfit], reference_noise: &str) -> Option<Table> {
    let row = |m: &ChannelMisfit| {
        let (words, unit, factor) = of_column(&m.channel);
        let sigmas = |v: f64| Cell::from(significant(v, 3));
        vec![
            Cell::from(m.recording.clone()),
            Cell::from(words),
            Cell::from(m.samples.to_string()),
            Cell::from(format!("{} {unit}", significant(factor * m.nominal_rms, 3))),
            Cell::from(format!(
                "{} {unit}",
                significant(factor * m.improved_rms, 3)
            )),
            sigmas(m.nominal_sigmas),
            sigmas(m.tolerated_sigmas),
            sigmas(m.improved_sigmas),
            m.left_out_sigmas.map_or(Cell::from("–"), sigmas),
        ]
    };
    (!misfit.is_empty()).then(|| {
        let caption = format!(
            "What the models leave of each channel: root mean square, then a robust one in multiples of {reference_noise} (1 is as much). The last column is a fit to the other recordings."
        );
        Table::new(
            &caption,
            &[
                "recording",
                "channel",
                "#readings",
                "#nominal",
                "#improved",
                "#nominal, σ",
                "#within tolerances, σ",
                "#improved, σ",
                "#not fitted to, σ",
            ],
            misfit.iter().map(row).collect(),
        )
    })
}

/// Errors on what was not fitted to.
fn prediction(errors: &[PredictionError], reference_noise: &str) -> Option<Table> {
    let row = |e: &PredictionError| {
        let (words, unit, factor) = of_column(&e.channel);
        let number = |v: f64| Cell::from(format!("{} {unit}", significant(factor * v, 3)));
        vec![
            Cell::from(e.recording.clone()),
            Cell::from(words),
            number(e.nominal),
            number(e.before),
            number(e.after),
            e.noise.map_or(Cell::from("–"), number),
            e.after_sigmas.map_or(Cell::from("–"), |sigmas| {
                Cell::from(significant(sigmas, 3))
            }),
        ]
    };
    (!errors.is_empty()).then(|| {
        Table::new(
            "Root mean square of the errors on what was not fitted to; σ: the robust one in multiples of the last but one column.",
            &[
                "recording",
                "channel",
                "#nominal",
                "#within tolerances",
                "#improved",
                &format!("#{reference_noise}"),
                "#improved, σ",
            ],
            errors.iter().map(row).collect(),
        )
    })
}

/// The smallest effects that the recordings would have shown.
pub(super) fn detectable<'a>(answer: &Answer) -> Option<Section<'a>> {
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
            &["effect", "numbers"],
            all.iter().map(row).collect(),
        );
        Section::new("What would have shown", vec![Block::Table(table)])
    })
}

pub(super) fn own_numbers<'a>(answer: &Answer) -> Option<Section<'a>> {
    let tolerated = &answer.details.tolerated;
    let row = |number: &ToleratedNumber| {
        let (words, unit, factor) = display_name(&number.key);
        let found = number.found;
        let shift = 100.0 * (found.value / number.nominal - 1.0);
        vec![
            Cell::from(words),
            Cell::from(significant(factor * number.nominal, 4)),
            Cell::from(significant(factor * found.value, 4)),
            Cell::from(significant(factor * found.low, 4)),
            Cell::from(significant(factor * found.high, 4)),
            Cell::from(unit),
            Cell::from(match shift.is_finite() {
                true => change(shift),
                false => String::new(),
            }),
            match found.at_limit {
                Some(Limit::Lower) => Cell::Judged("lower end".to_owned(), false),
                Some(Limit::Upper) => Cell::Judged("upper end".to_owned(), false),
                None => Cell::from(""),
            },
        ]
    };
    let rows: Vec<Vec<Cell>> = tolerated.iter().map(row).collect();
    let table = Table::new(
        "The rig file's own numbers, moved within their tolerances.",
        &[
            "number",
            "#nominal",
            "#found",
            "#low",
            "#high",
            "unit",
            "#change",
            "at a limit",
        ],
        rows,
    );
    (!tolerated.is_empty())
        .then(|| Section::new("The rig's own numbers", vec![Block::Table(table)]))
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
            power if other.is_close() => Cell::Judged(odds(power), false),
            power => Cell::from(odds(power)),
        };
        let judged = match (other.is_close(), other.is_ruled_out()) {
            (true, _) => "not ruled out",
            (_, true) => "ruled out",
            _ => "fell behind",
        };
        vec![
            Cell::from(names(&other.effects)),
            Cell::from(judged),
            against,
            Cell::from(other.explained_share.map_or("–".to_owned(), percent)),
            Cell::from(if other.in_full { "in full" } else { "roughly" }),
        ]
    };
    if !details.considered.is_empty() {
        blocks.push(Block::Table(Table::new(
            "Other explanations, against the one given. Ruled out: fitted in full, at odds below 1 to 100; fell behind: the same by a rough fit, with the piston held to its measured motion, where a law that acts on the motion alone can seem to explain more than it does.",
            &["explanation", "verdict", "#odds", "#of the mismatch explained", "fitted"],
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
            &["explanation", "#leaves, RMS"],
            details.ruled_out.iter().map(row).collect(),
        )));
    }
    blocks.extend(account_paragraphs(answer, &[SectionKind::Ambiguous]));
    (!blocks.is_empty()).then(|| Section::new("Other explanations", blocks))
}

/// What the account says of these, a paragraph each.
pub(super) fn account_paragraphs<'a>(
    answer: &Answer,
    kinds: &[SectionKind],
) -> impl Iterator<Item = Block<'a>> {
    let account = &answer.details.account;
    let sections = kinds.iter().filter_map(|kind| account.section(*kind));
    let paragraphs = sections.flat_map(|section| &section.paragraphs);
    paragraphs.map(|text| Block::Paragraph(text.clone()))
}
