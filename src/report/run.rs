//! A run, of a cell or of a bench, as a document.

use super::assumed::assumed;
use super::estimated::estimated;
use super::finished_edge::finished_edge;
use super::provenance::provenance;
use super::signals::{along_the_path, joints, signals};
use super::{SUMMARY, Sketches};
use crate::document::{Block, Cell, Column, Document, Fact, Number, Section, Table, Tone};
use crate::metrics::{BoundCheck, Measured, Metric, NARROW_BAND, WIDE_BAND, columns, key_facts};
use crate::quantity::{self, UNKNOWN, change, counted, significant, with_unit};
use crate::recording::Recording;
use crate::recording::csv::EdgeProfile;
use crate::run::{RunResult, RunSummary};

/// Key numbers at most.
const MOST_FACTS: usize = 6;

/// A run with what is shown of it.
#[derive(Clone, Copy)]
pub struct RunReport<'a> {
    /// Its numbers.
    pub result: &'a RunResult,
    /// Its signals.
    pub recording: &'a Recording,
    /// Its pictures.
    pub sketches: &'a Sketches,
    /// The finished edge.
    pub profile: Option<&'a EdgeProfile>,
}

impl<'a> RunReport<'a> {
    /// The document.
    #[must_use]
    pub fn document(&self) -> Document<'a> {
        let result = self.result;
        let (verdict, tone) = verdict(result);
        let notes = result.notes.iter().map(|note| format!("Note: {note}."));
        let drives = drives(result).map(|drives| format!("Drives at their limit: {drives}."));
        let far = far_from_desired(result).filter(|far| !verdict.contains(far.as_str()));
        let far = far.map(|far| format!("{far}."));
        let sections = [
            self.profile.map(|profile| finished_edge(profile, result)),
            pictures(self.sketches, result),
            signals(self.recording),
            along_the_path(self.recording, result),
            joints(self.recording, result),
            levels(result),
            passes(result),
            bounds(result),
            Some(numbers(result)),
            result
                .estimated_masses
                .as_ref()
                .map(|arm| estimated(arm, SUMMARY)),
            assumed(&result.assumed, SUMMARY),
            Some(from(result)),
        ];
        Document {
            title: result.title.clone(),
            tone,
            verdict,
            lead: (far.into_iter().chain(tolerance(result)))
                .chain(drives)
                .chain(notes)
                .collect(),
            facts: facts(result),
            sections: sections.into_iter().flatten().collect(),
            footer: "Made by idc, which simulates the device and its cell. recording.rrd, where it stands beside this page, shows the run in space: `idc view recording.rrd`.".to_owned(),
            ..Document::default()
        }
    }
}

/// A force that is far from the desired one, however its bounds are; none within 5 % of it.
fn far_from_desired(result: &RunResult) -> Option<String> {
    let of = |key: &str| result.metric(key);
    let (desired, mean) = (of("desired_force_n")?, of("force_mean_n")?);
    let off_percent = of("force_rms_error_percent")?;
    if off_percent <= 100.0 * NARROW_BAND {
        return None;
    }
    let off = 100.0 * (mean - desired) / desired;
    Some(format!(
        "{} the desired force: {} desired, {} on average ({}), RMS error {}",
        match off_percent <= 100.0 * WIDE_BAND {
            true => "Off",
            false => "Far from",
        },
        with_unit(desired, "N"),
        with_unit(mean, "N"),
        change(off),
        with_unit(off_percent, "%")
    ))
}

/// Conclusion in a sentence, and its tone: what stopped it, what is out of bounds, or what came of it.
fn verdict(result: &RunResult) -> (String, Tone) {
    if let Some(reason) = &result.stopped {
        return (format!("Stopped early: {reason}"), Tone::Bad);
    }
    let all = &result.expectations;
    let broken: Vec<String> = (all.iter().filter(|bound| !bound.kept))
        .map(|bound| out_of_bounds(result, bound))
        .collect();
    if !broken.is_empty() {
        let broken = broken.join("; ");
        return (format!("Outside its bounds: {broken}."), Tone::Bad);
    }
    let near = if all.is_empty() {
        Tone::Plain
    } else {
        Tone::Good
    };
    let (outcome, tone) = match finished(result) {
        Some(outcome) => (outcome, tone_of_edge(result, near)),
        None => (
            far_from_desired(result).unwrap_or_else(|| reached(result)),
            tone_of_force(result, near),
        ),
    };
    match all.len() {
        0 => (format!("{outcome}."), tone),
        1 => (format!("{outcome}. Its bound is kept."), tone),
        count => (format!("{outcome}. All {count} bounds are kept."), tone),
    }
}

/// Tone where the force of a run is far from the desired one, or else the given one.
fn tone_of_force(result: &RunResult, near: Tone) -> Tone {
    let off = result.metric("force_rms_error_percent");
    match off.filter(|_| result.metric("desired_force_n").is_some()) {
        Some(off) if off > 100.0 * WIDE_BAND => Tone::Bad,
        Some(off) if off > 100.0 * NARROW_BAND => Tone::Open,
        _ => near,
    }
}

/// What a turning tool made of the edge; none of another run.
fn finished(result: &RunResult) -> Option<String> {
    let of = |key: &str, unit| result.metric(key).map(|value| with_unit(value, unit));
    let leg = of("chamfer_leg_mean_mm", "mm")?;
    let burr = match result.metric("burr_before_max_mm") {
        Some(before) if before > 0.0 => format!(
            "Burr of up to {} before, {} after; chamfer",
            with_unit(before, "mm"),
            of("residual_burr_max_mm", "mm")?
        ),
        _ => "Chamfer".to_owned(),
    };
    Some(format!(
        "{burr} of {leg} on average, {} of the edge out of tolerance, in {}",
        of("out_of_tolerance_share_percent", "%")?,
        of("duration_s", "s")?
    ))
}

/// An edge of which a part is out of tolerance leaves a question, unless bounds say what is good.
fn tone_of_edge(result: &RunResult, near: Tone) -> Tone {
    match (near, result.metric("out_of_tolerance_share_percent")) {
        (Tone::Plain, Some(share)) if share > 0.0 => Tone::Open,
        _ => near,
    }
}

/// Force that a run reached.
fn reached(result: &RunResult) -> String {
    let newtons = |key: &str| result.metric(key).map(|value| with_unit(value, "N"));
    let Some(mean) = newtons("force_mean_n") else {
        return "Done".to_owned();
    };
    let spread = newtons("force_standard_deviation_n");
    let spread = spread.map_or(String::new(), |d| format!(", standard deviation {d}"));
    match newtons("desired_force_n") {
        Some(desired) => format!("{mean} on average where {desired} is desired{spread}"),
        None => format!("{mean} in contact{spread}"),
    }
}

/// A bound that was not kept, in words: `force, mean is 289.1 N, expected at most 1 N`.
fn out_of_bounds(result: &RunResult, bound: &BoundCheck) -> String {
    let metrics = result.metrics();
    let label = metrics.iter().find(|(label, _)| label.key == bound.metric);
    let (name, unit) = label.map_or((bound.metric.to_string(), ""), |(label, _)| {
        (label.name.clone(), label.unit)
    });
    let pass = bound
        .pass
        .map_or(String::new(), |pass| format!("pass {pass}: "));
    let value = bound
        .value
        .map_or("not determined".to_owned(), |v| with_unit(v, unit));
    let text = format!("{pass}{name} is {value}, expected {} {unit}", bound.ends());
    text.trim_end().to_owned()
}

/// Limits of the finished edge, in a sentence; none of another run.
fn tolerance(result: &RunResult) -> Option<String> {
    let limits = result.chamfer?;
    let least = quantity::number(limits.leg_min_mm, "mm");
    let leg = match limits.leg_max_mm {
        Some(most) => format!("{least} to {}", with_unit(most, "mm")),
        None => format!("at least {least} mm"),
    };
    let burr = with_unit(limits.residual_burr_max_mm, "mm");
    Some(format!(
        "Tolerance: chamfer leg {leg}, burr at most {burr}."
    ))
}

/// Drives that were at their limit, with time and duration; none if none was.
#[must_use]
pub fn drives(result: &RunResult) -> Option<String> {
    let RunSummary::Cell(summary) = &result.summary else {
        return None;
    };
    let saturated = summary.joints.iter().filter_map(|joint| {
        let from = with_unit(joint.saturated_from_s?, "s");
        let time = with_unit(joint.saturated_s, "s");
        Some(format!("{} from {from} on for {time}", joint.joint))
    });
    let all: Vec<String> = saturated.collect();
    (!all.is_empty()).then(|| all.join(", "))
}

fn facts(result: &RunResult) -> Vec<Fact> {
    match &result.summary {
        RunSummary::Cell(summary) => facts_of(summary.as_ref()),
        RunSummary::Bench(summary) => facts_of(summary.as_ref()),
    }
}

/// The key numbers of those that a run determines.
fn facts_of<S: Measured>(summary: &S) -> Vec<Fact> {
    let fact = |metric: &'static Metric<S>| {
        let value = (metric.value)(summary)?;
        let number = Number::new(metric.name, Some(value), metric.shown_unit());
        Some(Fact::new(
            metric.full_label(),
            number,
            metric.remark(summary),
        ))
    };
    key_facts::<S>()
        .into_iter()
        .filter_map(fact)
        .take(MOST_FACTS)
        .collect()
}

/// Pictures: cell, or bench, and edge, to be turned where there is space.
fn pictures<'a>(sketches: &'a Sketches, result: &RunResult) -> Option<Section<'a>> {
    let (title, cell) = match result.is_bench() {
        true => (
            "The bench",
            "The device on its base and what it meets, with the contact force.",
        ),
        false => (
            "Cell and edge",
            "Arm, device and part in the middle of following; the arrow is the contact force with its friction.",
        ),
    };
    let edge = "The part and its edge, coloured by the mean force error of each of 400 pieces while following; pale where the part hides it.";
    let pictures = [(cell, &sketches.cell), (edge, &sketches.edge)].into_iter();
    let pictures: Vec<(String, String)> = pictures
        .filter_map(|(words, svg)| Some((words.to_owned(), svg.clone()?)))
        .collect();
    let mut blocks = match &sketches.space {
        Some(space) => vec![Block::InSpace(space, pictures)],
        None if pictures.is_empty() => vec![],
        None => vec![Block::Sketches(pictures)],
    };
    if let Some(lean) = &sketches.lean {
        let words = "The tool across the edge in the middle of following, as it is planned; process.lean_deg and process.tool_axis set it.";
        blocks.push(Block::Sketches(vec![(words.to_owned(), lean.clone())]));
    }
    (!blocks.is_empty()).then(|| Section::new(title, blocks))
}

/// A row for each of several summaries, with the numbers that have a column.
fn rows_of<S: Measured>(caption: &str, [first, list]: [&str; 2], all: &[S]) -> Table {
    let heads = columns::<S>().map(|(heading, metric)| match metric.shown_unit() {
        "" => Column::of_numbers(heading),
        unit => Column::of_numbers(format!("{heading} [{unit}]")),
    });
    let row = |(index, summary): (usize, &S)| {
        let number = Number::default().written((index + 1).to_string());
        let values = columns::<S>().map(|(_, metric)| {
            let value = (metric.value)(summary);
            let key = format!("{list}.{index}.{}", metric.name);
            Cell::Number(Number::bare(&key, value, metric.shown_unit()))
        });
        [Cell::from(number)].into_iter().chain(values).collect()
    };
    let heads = [Column::of_numbers(first)].into_iter().chain(heads);
    Table::new(
        caption,
        heads.collect(),
        all.iter().enumerate().map(row).collect(),
    )
}

/// Commands of a bench.
fn levels<'a>(result: &RunResult) -> Option<Section<'a>> {
    let RunSummary::Bench(summary) = &result.summary else {
        return None;
    };
    let caption = "Steady values of each command, up to the next or to where something else begins to move; settled: until the force stays within 5 % of its change.";
    (!summary.levels.is_empty()).then(|| {
        let table = rows_of(caption, ["command", "levels"], &summary.levels);
        Section::new("Commands", vec![Block::Table(table)])
    })
}

/// Passes of a cell, where there are several.
fn passes<'a>(result: &RunResult) -> Option<Section<'a>> {
    let RunSummary::Cell(summary) = &result.summary else {
        return None;
    };
    let caption = "Each pass along the edge, against its own desired force; the other numbers of the force are those of the first.";
    (summary.passes.len() > 1).then(|| {
        let table = rows_of(caption, ["pass", "passes"], &summary.passes);
        Section::new("Passes", vec![Block::Table(table)])
    })
}

/// Bounds of the scenario.
fn bounds<'a>(result: &RunResult) -> Option<Section<'a>> {
    let metrics = result.metrics();
    let row = |bound: &BoundCheck| {
        let word = if bound.kept { "ok" } else { "OUTSIDE" };
        let label = metrics.iter().find(|(label, _)| label.key == bound.metric);
        let (name, unit) = label.map_or((bound.name(), ""), |(label, _)| {
            let pass = bound
                .pass
                .map_or(String::new(), |pass| format!("pass {pass}: "));
            (format!("{pass}{}", label.name), label.unit)
        });
        let value = Number::new(&bound.metric, bound.value, unit);
        vec![
            Cell::Verdict(word.to_owned(), bound.kept),
            Cell::from(name),
            Cell::from(value.written(distinguishable(bound, unit))),
            Cell::from(bound.ends()),
        ]
    };
    let rows: Vec<Vec<Cell>> = result.expectations.iter().map(row).collect();
    let kept = result
        .expectations
        .iter()
        .filter(|bound| bound.kept)
        .count();
    (!rows.is_empty()).then(|| {
        let caption = format!("{kept} of {} kept.", counted(rows.len(), "bound"));
        let columns = Column::list("verdict | number | #value | bounds");
        Section::new(
            "Bounds",
            vec![Block::Table(Table::new(&caption, columns, rows))],
        )
    })
}

/// A value with enough digits to tell it from its bounds.
fn distinguishable(bound: &BoundCheck, unit: &str) -> String {
    let Some(value) = bound.value else {
        return UNKNOWN.to_owned();
    };
    // `<0.001` reads as nothing.
    let differs = |shown: &String| {
        let shown: f64 = shown.parse().unwrap_or(0.0);
        let same = |end: f64| value.total_cmp(&end) == shown.total_cmp(&end);
        [bound.min, bound.max].into_iter().flatten().all(same)
    };
    let short = std::iter::once(quantity::number(value, unit));
    let longer = (quantity::DIGITS..17).map(|digits| significant(value, digits));
    let found = short.chain(longer).find(differs);
    found.unwrap_or_else(|| value.to_string())
}

/// Every number that matters in its part of the report, and all of them with their keys.
fn numbers<'a>(result: &RunResult) -> Section<'a> {
    let table = match &result.untimed() {
        RunSummary::Cell(summary) => rows(summary.as_ref()),
        RunSummary::Bench(summary) => rows(summary.as_ref()),
    };
    let every = Block::Folded("Every number, with its key".to_owned(), vec![every(result)]);
    let of_first = "Force, peaks, touch, stroke and path are those of the first pass.";
    let of_first = passes(result).map(|_| Block::Paragraph(of_first.to_owned()));
    let blocks = of_first.into_iter().chain([Block::Table(table), every]);
    Section::new("Numbers", blocks.collect())
}

/// The numbers that have a row, in the order of the parts; those that the run does not determine in the caption.
fn rows<S: Measured>(summary: &S) -> Table {
    let mut all: Vec<(&'static Metric<S>, Option<f64>)> = S::METRICS
        .iter()
        .filter(|metric| metric.has_row)
        .map(|metric| (metric, (metric.value)(summary)))
        .collect();
    all.sort_by_key(|(metric, _)| metric.part);
    let missing = all
        .iter()
        .filter(|(metric, value)| value.is_none() && !metric.is_optional);
    let missing: Vec<String> = missing.map(|(metric, _)| metric.full_label()).collect();
    all.retain(|(_, value)| value.is_some());
    let mut part = None;
    let row = |(metric, value): &(&'static Metric<S>, Option<f64>)| {
        let opens = part.replace(metric.part) != Some(metric.part);
        vec![
            Cell::from(if opens { metric.part.title() } else { "" }),
            Cell::from(metric.label),
            Cell::from(Number::new(metric.name, *value, metric.shown_unit())),
            Cell::from(metric.remark(summary)),
        ]
    };
    let caption = match missing.is_empty() {
        true => String::new(),
        false => format!("Not determined by this run: {}.", missing.join("; ")),
    };
    let columns = Column::list("part | number | #value | remark");
    Table::new(&caption, columns, all.iter().map(row).collect())
}

fn every<'a>(result: &RunResult) -> Block<'a> {
    let bounds = |key: &str| {
        let own = |bound: &&BoundCheck| bound.metric == key && bound.pass.is_none();
        let bound = result.expectations.iter().find(own)?;
        Some(Cell::Verdict(bound.ends(), bound.kept))
    };
    let row = |(label, value): (crate::metrics::Label, Option<f64>)| {
        vec![
            Cell::from(label.name),
            Cell::from(Number::bare(label.key, value, label.unit)),
            Cell::from(label.unit),
            bounds(label.key).unwrap_or_default(),
            Cell::from(label.meaning),
            Cell::from(label.key),
        ]
    };
    let columns =
        Column::list("number | #value | unit | bounds | what it is | key in summary.json");
    let rows = result.metrics().into_iter().map(row).collect();
    let caption = format!("{UNKNOWN}: not determined by this run.");
    Block::Table(Table::new(&caption, columns, rows).sortable())
}

/// Where it comes from.
fn from<'a>(result: &RunResult) -> Section<'a> {
    let mut section = provenance(&result.provenance);
    let words = format!(
        "Scenario {}, {}.",
        result.scenario,
        counted(result.samples, "sample")
    );
    section.blocks.insert(0, Block::Paragraph(words));
    section
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::document::{Style, html, markdown, text};
    use crate::metrics::test_planted::planted;

    // The viewer shows the Markdown.
    #[test]
    fn a_number_that_is_declared_is_rendered_everywhere_without_another_line() {
        let summary = planted();
        let of_passes = rows_of(
            "Passes.",
            ["pass", "passes"],
            std::slice::from_ref(&summary),
        );
        let document = |blocks, facts| Document {
            title: "Planted".to_owned(),
            sections: vec![Section::new("Numbers", blocks)],
            facts,
            ..Document::default()
        };
        let own = document(vec![Block::Table(rows(&summary))], Vec::new());
        let fact = document(Vec::new(), facts_of(&summary));
        for document in [own, fact] {
            let page = html(&document);
            assert!(page.contains("data-key=\"planted_depth_mm\""), "{page}");
            for shown in [text(&document, Style::Plain), markdown(&document), page] {
                let found = shown.contains("planted depth") && shown.contains("12.50 mm");
                assert!(found, "{shown}");
                assert!(
                    !shown.contains("planted share"),
                    "absent numbers are left out"
                );
            }
        }
        let passes = document(vec![Block::Table(of_passes)], Vec::new());
        let page = html(&passes);
        for shown in [text(&passes, Style::Plain), markdown(&passes), page] {
            let plain = shown.replace('\\', "");
            let found = plain.contains("depth [mm]") && plain.contains("12.50");
            assert!(found, "{shown}");
        }
    }
}
