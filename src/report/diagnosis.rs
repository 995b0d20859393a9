//! The page of a diagnosis.

use super::diagnosis_charts::{balance, channel, origin, unlisted};
use super::diagnosis_tables::{
    detectable, how_well, identified, own_numbers, paragraphs, ruled_out,
};
use super::provenance::provenance;
use crate::diagnosis::answer::account::SectionKind;
use crate::diagnosis::answer::details::remaining_errors;
use crate::diagnosis::answer::estimate::Estimate;
use crate::diagnosis::answer::statements::TRUSTED;
use crate::diagnosis::answer::words::{capital, of_column, percent, reference_noise};
use crate::diagnosis::answer::{Answer, FoundEffect, Verdict};
use crate::diagnosis::difference::comparison::{Compared, Comparison};
use crate::document::{Block, Cell, Column, Document, Fact, Number, Section, Strip, Table, Tone};
use crate::effects::UNLISTED;
use crate::effects::meaning;
use crate::quantity::significant;

/// Recordings that are shown at once; the others are folded away.
const SHOWN: usize = 2;

/// Parts of the account that say what was found, those of a contact flange last.
const FOUND: [SectionKind; 6] = [
    SectionKind::Missing,
    SectionKind::Impact,
    SectionKind::Ringing,
    SectionKind::Settling,
    SectionKind::SteadyError,
    SectionKind::ErrorWhileMoving,
];

/// Parts of the account that are sections of their own, with the recordings last.
const OTHERS: [SectionKind; 8] = [
    SectionKind::Tried,
    SectionKind::NextExperiment,
    SectionKind::Arm,
    SectionKind::PathPlaces,
    SectionKind::NotWritten,
    SectionKind::Controller,
    SectionKind::HowToRun,
    SectionKind::Recordings,
];

/// The document of a diagnosis: account.txt, the page, the viewer's text.
#[must_use]
pub fn diagnosis<'a>(answer: &Answer, comparison: &'a Comparison) -> Document<'a> {
    let details = &answer.details;
    let headline = details.account.headline.replace('_', " ");
    let sections = [
        what_is_missing(answer),
        where_it_shows(answer, comparison),
        before_and_after(answer, comparison),
        balances(comparison),
        how_well(answer),
        detectable(answer),
        identified(answer),
        own_numbers(answer),
        ruled_out(answer),
    ];
    let others = OTHERS.into_iter().filter_map(|kind| {
        let blocks: Vec<Block<'a>> = paragraphs(answer, &[kind]).collect();
        (!blocks.is_empty()).then(|| Section::new(kind.title(), blocks))
    });
    let sections = sections.into_iter().flatten().chain(others);
    Document {
        title: format!("Diagnosis of {}", details.case),
        verdict: format!("{}.", capital(&headline)),
        tone: match answer.verdict {
            Verdict::Explained => Tone::Found,
            Verdict::NothingMissing => Tone::Good,
            Verdict::Unlisted => Tone::Open,
        },
        lead: lead(answer),
        facts: facts(answer),
        sections: sections.chain([provenance(&details.provenance)]).collect(),
        footer: "Made by idc, which simulates the device and its cell, and finds what physics recordings contain that the model leaves out. Zoom a chart by drawing over it, or with two fingers; a double click shows all.".to_owned(),
        ..Document::default()
    }
}

/// Meaning of each effect, in words.
fn lead(answer: &Answer) -> Vec<String> {
    let said = |effect: &FoundEffect| {
        let words = effect.meaning();
        (words != meaning("")).then(|| capital(&words) + ".")
    };
    let known = answer.effects.iter();
    let known = known.filter(|e| e.name != UNLISTED && e.confidence >= TRUSTED);
    let mut lead: Vec<String> = known.filter_map(said).collect();
    let faults = answer.details.data_faults.iter();
    lead.extend(faults.map(|fault| capital(&fault.words) + "."));
    if answer.verdict == Verdict::NothingMissing {
        let left = answer.details.account.section(SectionKind::Remaining);
        lead.extend(left.into_iter().flat_map(|left| left.paragraphs.clone()));
    }
    lead
}

fn facts(answer: &Answer) -> Vec<Fact> {
    let details = &answer.details;
    let mut facts = Vec::new();
    let mut add = |name: &str, value: String, remark: String| {
        facts.push(Fact {
            name: name.to_owned(),
            value: value.into(),
            remark,
        });
    };
    if let Some(share) = details.explained_share {
        let errors = remaining_errors(&details.misfit, &details.prediction);
        let left = match errors.first() {
            Some(error) if error.is_beyond_noise() => {
                let (words, unit, factor) = of_column(&error.column);
                format!(
                    "left: {} {unit} RMS in the {words} ({} σ, robust)",
                    significant(factor * error.rms, 2),
                    significant(error.sigmas, 2)
                )
            }
            _ => format!(
                "no more than {} is left",
                reference_noise(details.remaining.is_some())
            ),
        };
        add("of the mismatch explained", percent(share), left);
    }
    let worst = details
        .prediction
        .iter()
        .filter_map(|error| Some((error, error.noise?, error.before_sigmas?)))
        .max_by(|(.., a), (.., b)| a.total_cmp(b));
    if let Some((error, noise, _)) = worst.filter(|_| answer.verdict != Verdict::NothingMissing) {
        let (words, unit, factor) = of_column(&error.channel);
        add(
            &format!("RMS error of {words}, not fitted to"),
            format!(
                "{} → {} {unit}",
                significant(factor * error.before, 3),
                significant(factor * error.after, 3)
            ),
            format!(
                "{}: {} {unit}",
                reference_noise(details.remaining.is_some()),
                significant(factor * noise, 2)
            ),
        );
    }
    let count = details.misfit.iter().map(|m| &m.recording);
    let recordings: std::collections::BTreeSet<_> = count.collect();
    let samples: usize = details.misfit.iter().map(|m| m.samples).sum();
    if samples > 0 {
        add(
            "recordings",
            recordings.len().to_string(),
            format!("{samples} readings"),
        );
    }
    facts
}

/// The parameters of what was found, with their intervals on one scale.
fn parameters<'a>(answer: &Answer) -> Option<Block<'a>> {
    let found = answer
        .effects
        .iter()
        .enumerate()
        .flat_map(|found| found.1.parameters.iter().map(move |p| (found, p)));
    let known: Vec<_> = found.collect();
    // Intervals relative to their values, on one scale.
    let relative = |e: &Estimate| [e.low, e.high].map(|end| (end - e.value) / e.value.abs());
    let ends = known.iter().flat_map(|(_, (_, e))| relative(e));
    let widest = ends
        .filter(|e| e.is_finite())
        .fold(0.0, |most: f64, e| most.max(e.abs()));
    let widest = widest.clamp(1e-6, 1.0);
    let rows = known.iter().map(|((index, effect), (name, estimate))| {
        let (words, unit, factor) = effect.display_name(name);
        let number = |key: &str, value: f64| {
            let key = format!("effects.{index}.parameters.{name}.{key}");
            Cell::from(Number::bare(&key, None, "").written(significant(factor * value, 4)))
        };
        let confidence = Number::bare(&format!("effects.{index}.confidence"), None, "");
        let [low, high] = relative(estimate);
        // Which joint is known or not; it has no interval.
        let certain = estimate.low == estimate.high;
        let unless_certain = |cell: Cell| if certain { Cell::from("") } else { cell };
        vec![
            Cell::from(effect.name.replace('_', " ") + &effect.parameters.place_words()),
            Cell::from(effect.subsystem.replace('_', " ")),
            confidence.written(percent(effect.confidence)).into(),
            Cell::from(words),
            match certain && estimate.value.fract() == 0.0 {
                true => Cell::from(format!("{}", estimate.value)),
                false => number("value", estimate.value),
            },
            unless_certain(number("low", estimate.low)),
            unless_certain(number("high", estimate.high)),
            Cell::from(match estimate.at_limit {
                Some(_) => format!("{unit}, at the end of its range"),
                None => unit,
            }),
            match low.is_finite() && high.is_finite() {
                true => unless_certain(Cell::Interval([-widest, low, 0.0, high, widest])),
                false => Cell::from(""),
            },
        ]
    });
    let rows: Vec<Vec<Cell>> = rows.collect();
    if !rows.is_empty() {
        let scale = format!("{} %", significant(100.0 * widest, 2));
        let columns = Column::list(
            "effect | where | #probability | parameter | #value | #low | #high | unit | interval",
        );
        let caption = format!(
            "Intervals are those of 95 %; drawn relative to the value, from -{scale} to +{scale}."
        );
        return Some(Block::Table(Table::new(&caption, columns, rows)));
    }
    None
}

fn what_is_missing<'a>(answer: &Answer) -> Option<Section<'a>> {
    let mut blocks: Vec<Block<'a>> = parameters(answer).into_iter().collect();
    for effect in &answer.effects {
        if let Some(report) = &effect.unlisted {
            blocks.push(Block::Panel(unlisted(report)));
        }
    }
    blocks.extend(paragraphs(answer, &FOUND));
    let shape = answer.details.account.section(SectionKind::Missing);
    let shape = shape.and_then(|section| section.table.clone());
    if answer
        .effects
        .iter()
        .any(|effect| effect.unlisted.is_some())
    {
        blocks.extend(shape.map(Block::Lines));
    }
    (!blocks.is_empty()).then(|| Section::new("What is missing", blocks))
}

/// Strips of the times in which the effects show.
fn where_it_shows<'a>(answer: &Answer, comparison: &Comparison) -> Option<Section<'a>> {
    let mut blocks: Vec<Block<'a>> =
        paragraphs(answer, &[SectionKind::Mismatch, SectionKind::Link]).collect();
    let mut subsystems: Vec<&str> = Vec::new();
    for effect in &answer.effects {
        if !subsystems.contains(&effect.subsystem.as_str()) {
            subsystems.push(&effect.subsystem);
        }
    }
    for recording in &comparison.recordings {
        let start = origin(recording);
        let own = |column: &str| -> Vec<[f64; 2]> {
            let own = answer.mismatch.iter();
            let own = own.filter(|m| m.recording == recording.name && m.channel == column);
            own.map(|m| [m.start_s, m.end_s].map(|t| t - start))
                .collect()
        };
        let rows = recording.channels.iter().map(|channel| &channel.column);
        let rows = rows.map(|column| (of_column(column).0, own(column)));
        let rows: Vec<_> = rows.filter(|(_, spans)| !spans.is_empty()).collect();
        if let (false, [first, .., last]) = (rows.is_empty(), recording.time.as_slice()) {
            let heading = match start {
                0.0 => recording.name.clone(),
                start => format!("{}, time since {start} s", recording.name),
            };
            blocks.push(Block::Strip(Strip {
                title: heading,
                span: [first - start, last - start],
                rows,
            }));
        }
    }
    if !answer.mismatch.is_empty() {
        let hint = match answer.details.runs.is_empty() {
            false => "The strips show each run from contact until it has settled.".to_owned(),
            true => format!(
                "The strips show when the found effects ({}) move a channel by more than three times {}.",
                subsystems.join(", ").replace('_', " "),
                reference_noise(answer.details.remaining.is_some())
            ),
        };
        blocks.push(Block::Hint(hint));
    }
    (!blocks.is_empty()).then(|| Section::new("Where it shows", blocks))
}

fn before_and_after<'a>(answer: &Answer, comparison: &'a Comparison) -> Option<Section<'a>> {
    let charts = |recording: &'a Compared| -> Vec<Block<'a>> {
        let channels = recording.channels.iter();
        let charts = channels.flat_map(|of| channel(answer, recording, of));
        charts
            .filter(|panel| !panel.series.is_empty())
            .map(Block::Panel)
            .collect()
    };
    let mut order: Vec<&Compared> = comparison.recordings.iter().collect();
    // What was measured and not fitted to is the proof: it comes first; what was not measured, last.
    let measured = |of: &Compared| {
        let values = of.channels.iter().flat_map(|channel| &channel.measured);
        values.copied().any(f64::is_finite)
    };
    order.sort_by_key(|recording| (!measured(recording), !recording.unseen));
    let shaded = match answer.mismatch.is_empty() {
        true => "",
        false => "Shaded times are those of the strips above. ",
    };
    let mut blocks = vec![Block::Hint(format!(
        "{shaded}Draw over a chart to zoom it, and all of its recording; a double click shows all."
    ))];
    for (place, recording) in order.into_iter().enumerate() {
        let kept = match recording.unseen {
            true => "kept from the fit",
            false => "diagnosed from",
        };
        let title = format!("{} ({kept})", recording.name);
        if place < SHOWN {
            blocks.push(Block::Heading(title));
            blocks.extend(charts(recording));
        } else {
            blocks.push(Block::Folded(title, charts(recording)));
        }
    }
    (blocks.len() > 1).then(|| Section::new("Before and after", blocks).appendix())
}

fn balances<'a>(comparison: &Comparison) -> Option<Section<'a>> {
    let mut blocks = vec![Block::Hint("What closes each balance along the measured motion, against the variable that says most about it: a law shows as a curve, what is explained lies flat.".to_owned())];
    blocks.extend(comparison.balances.iter().map(|b| Block::Panel(balance(b))));
    (blocks.len() > 1).then(|| Section::new("What each link lacks", blocks).appendix())
}
