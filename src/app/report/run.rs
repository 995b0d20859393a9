//! The page of a run: of a cell or of a bench.

use std::borrow::Cow;

use serde_json::Value;

use super::super::error::AppError;
use super::super::files::{SUMMARY, Sketches};
use super::estimated::estimated;
use super::finished_edge::finished_edge;
use super::judged::judged;
use super::provenance::provenance_of;
use super::run_result::RunResult;
use super::signals::{along_the_path, joints, signals};
use crate::document::{Block, Cell, Document, Fact, Section, Table, Tone, html};
use crate::metrics::{
    Label, LevelSummary, METRICS, Measured, Metric, NARROW_BAND, Part, PassSummary, WIDE_BAND,
    columns,
};
use crate::quantity::{UNKNOWN, change, optional, with_unit};
use crate::recording::Recording;
use crate::recording::csv::EdgeProfile;
use crate::report::{far_from_desired, shown};

/// The page of a run.
pub(in super::super) fn of_run(run: &RunResult<'_>) -> String {
    html(&page(run))
}

/// The page of a run that has just ended: summary.json, its signals and its pictures.
pub(in super::super) fn page_of_run(
    document: &str,
    recording: &Recording,
    profile: Option<&EdgeProfile>,
    sketches: &Sketches,
) -> Result<String, AppError> {
    Ok(of_run(&RunResult {
        document: serde_json::from_str(document)?,
        recording: Cow::Borrowed(recording),
        cell: Some(Cow::Borrowed(&sketches.cell)),
        edge: sketches.edge.as_deref().map(Cow::Borrowed),
        lean: sketches.lean.as_deref().map(Cow::Borrowed),
        space: sketches.space.as_ref().map(Cow::Borrowed),
        profile: profile.map(Cow::Borrowed),
    }))
}

/// The page.
fn page<'a>(run: &'a RunResult<'_>) -> Document<'a> {
    let (verdict, tone) = verdict(run);
    let notes = run.document["notes"].as_array().into_iter().flatten();
    let notes = notes.filter_map(Value::as_str);
    let notes = notes.map(|note| format!("Note: {note}."));
    let said = |far: &String| !verdict.contains(far.as_str());
    let far = far(run).filter(said).map(|far| format!("{far}."));
    let sections = [
        (run.profile.as_ref()).map(|profile| finished_edge(profile, &run.document)),
        pictures(run),
        signals(run),
        along_the_path(run),
        joints(run),
        levels(run),
        passes(run),
        metrics(run),
        estimated(&run.document, SUMMARY),
        judged(&run.document, SUMMARY),
        Some(from(run)),
    ];
    Document {
        title: run.title().to_owned(),
        tone,
        lead: far.into_iter().chain(notes).collect(),
        verdict,
        facts: facts(run),
        sections: sections.into_iter().flatten().collect(),
        footer: "Made by idc, which simulates the device and its cell. recording.rrd, where it stands beside this page, shows the run in space: `idc view recording.rrd`.".to_owned(),
    }
}

/// Remark on a force that is not the desired one.
fn far(run: &RunResult<'_>) -> Option<String> {
    far_from_desired(
        run.metric("desired_force_n")?,
        run.metric("force_mean_n")?,
        run.metric("force_rms_error_percent")?,
    )
}

/// Departure of the force from the desired one.
fn tone_of_force(run: &RunResult<'_>, near: Tone) -> Tone {
    match run.metric("force_rms_error_percent") {
        Some(off) if run.metric("desired_force_n").is_some() && off > 100.0 * WIDE_BAND => {
            Tone::Bad
        }
        Some(off) if run.metric("desired_force_n").is_some() && off > 100.0 * NARROW_BAND => {
            Tone::Open
        }
        _ => near,
    }
}

fn verdict(run: &RunResult<'_>) -> (String, Tone) {
    if let Some(reason) = run.document["stopped"].as_str() {
        return (format!("Stopped early: {reason}"), Tone::Bad);
    }
    let expectations = run.document["expectations"].as_array();
    let all: Vec<&Value> = expectations.into_iter().flatten().collect();
    let broken: Vec<String> = (all.iter())
        .filter(|e| e["kept"] == false)
        .filter_map(|e| told(run, e))
        .collect();
    if !broken.is_empty() {
        return (
            format!("Outside its bounds: {}.", broken.join("; ")),
            Tone::Bad,
        );
    }
    let near = if all.is_empty() {
        Tone::Plain
    } else {
        Tone::Good
    };
    let (said, tone) = match finished(run) {
        Some(said) => (said, tone_of_edge(run, near)),
        None => (
            far(run).unwrap_or_else(|| reached(run)),
            tone_of_force(run, near),
        ),
    };
    match all.len() {
        0 => (format!("{said}."), tone),
        1 => (format!("{said}. Its bound is kept."), tone),
        count => (format!("{said}. All {count} bounds are kept."), tone),
    }
}

/// Burr and chamfer of a finished edge.
fn finished(run: &RunResult<'_>) -> Option<String> {
    let of = |key: &str, unit| run.metric(key).map(|value| with_unit(value, unit));
    let leg = of("chamfer_leg_mean_mm", "mm")?;
    let burr = match run.metric("burr_before_max_mm") {
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

/// What is out of tolerance is open where no bound says how much may be.
fn tone_of_edge(run: &RunResult<'_>, near: Tone) -> Tone {
    match (near, run.metric("out_of_tolerance_share_percent")) {
        (Tone::Plain, Some(share)) if share > 0.0 => Tone::Open,
        _ => near,
    }
}

/// The force beside what was desired.
fn reached(run: &RunResult<'_>) -> String {
    let newtons = |key: &str| run.metric(key).map(|value| with_unit(value, "N"));
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

/// A bound that was not kept, in words.
fn told(run: &RunResult<'_>, bound: &Value) -> Option<String> {
    let key = bound["metric"].as_str()?;
    let metrics = run.metrics();
    let (label, _) = metrics.iter().find(|(label, _)| label.key == key)?;
    let (value, pass) = (bound["value"].as_f64(), bound["pass"].as_u64());
    let pass = pass.map_or(String::new(), |pass| format!("pass {pass}: "));
    let unit = match label.unit {
        "" => String::new(),
        unit => format!(" {unit}"),
    };
    let is = value.map_or("not determined".to_owned(), |v| with_unit(v, label.unit));
    Some(format!(
        "{pass}{} is {is}, expected {}{unit}",
        label.name,
        ends(bound)
    ))
}

/// The ends of a bound, in words.
fn ends(bound: &Value) -> String {
    let ends = [("at least", &bound["min"]), ("at most", &bound["max"])].into_iter();
    let ends = ends.filter_map(|(word, end)| Some(format!("{word} {}", end.as_f64()?)));
    let ends: Vec<String> = ends.collect();
    ends.join(", ")
}

/// Facts about the force beside those about a finished edge.
const FORCE_BESIDE: usize = 2;
fn facts(run: &RunResult<'_>) -> Vec<Fact> {
    let metrics = run.metrics();
    let fact = |key: &str| {
        let (label, value) = metrics.iter().find(|(label, _)| label.key == key)?;
        Some(Fact {
            name: label.name.clone(),
            value: format!("{} {}", shown(Some((*value)?), label.unit), label.unit),
            remark: label.meaning.to_owned(),
        })
    };
    let mut ranked: Vec<&Label> = metrics.iter().map(|(label, _)| label).collect();
    ranked.retain(|label| label.fact.is_some());
    ranked.sort_by_key(|label| label.fact);
    let others = ranked.iter().filter_map(|label| fact(label.key)).take(4);
    let edge = [
        chamfer(run),
        fact("out_of_tolerance_share_percent"),
        burr(run),
        cycle(run),
    ];
    let first = desired(run).into_iter().chain(mean(run));
    let force = first.chain(others).chain(peak(run));
    let count = if edge[0].is_some() {
        FORCE_BESIDE
    } else {
        usize::MAX
    };
    edge.into_iter()
        .flatten()
        .chain(force.take(count))
        .collect()
}

/// The chamfer's leg with its tolerance.
fn chamfer(run: &RunResult<'_>) -> Option<Fact> {
    let mean = run.metric("chamfer_leg_mean_mm")?;
    let ends = ["chamfer_leg_min_mm", "chamfer_leg_max_mm"].map(|key| run.metric(key));
    let [low, high] = [ends[0]?, ends[1]?].map(|end| shown(Some(end), "mm"));
    let asked = &run.document["chamfer"];
    let tolerance = match (asked["leg_min_mm"].as_f64(), asked["leg_max_mm"].as_f64()) {
        (low, Some(high)) => format!("; tolerance {} to {high} mm", low.unwrap_or(0.0)),
        (Some(low), None) if low > 0.0 => format!("; tolerance from {low} mm"),
        _ => String::new(),
    };
    Some(Fact {
        name: "chamfer leg, mean".to_owned(),
        value: with_unit(mean, "mm"),
        remark: format!("{low} to {high} mm along the edge{tolerance}"),
    })
}

/// The burr that is left, beside what there was.
fn burr(run: &RunResult<'_>) -> Option<Fact> {
    let before = run
        .metric("burr_before_max_mm")
        .filter(|before| *before > 0.0)?;
    Some(Fact {
        name: "burr left, highest".to_owned(),
        value: with_unit(run.metric("residual_burr_max_mm")?, "mm"),
        remark: format!("of up to {} before", with_unit(before, "mm")),
    })
}

/// How long a job takes that finishes an edge.
fn cycle(run: &RunResult<'_>) -> Option<Fact> {
    run.metric("chamfer_leg_mean_mm")?;
    Some(Fact {
        name: "cycle time".to_owned(),
        value: with_unit(run.metric("duration_s")?, "s"),
        remark: "approach to retract".to_owned(),
    })
}

/// The command: a force, or a pressure.
fn desired(run: &RunResult<'_>) -> Option<Fact> {
    if let Some(desired) = run.metric("desired_force_n") {
        return Some(Fact {
            name: "desired force".to_owned(),
            value: with_unit(desired, "N"),
            remark: "what the scenario asks for".to_owned(),
        });
    }
    let last = run.document["summary"]["levels"].as_array()?.last()?;
    let bar = |key: &str| last[key].as_f64().map(|value| with_unit(value, "bar"));
    Some(Fact {
        name: "set pressure, last".to_owned(),
        value: bar("set_pressure_bar_gauge")?,
        remark: format!("gauge; outlet {}", bar("regulator_pressure_bar_gauge")?),
    })
}

fn mean(run: &RunResult<'_>) -> Option<Fact> {
    let mean = run.metric("force_mean_n")?;
    let off = |desired: f64| {
        format!(
            "{} from desired",
            change(100.0 * (mean - desired) / desired)
        )
    };
    Some(Fact {
        name: "force reached, mean".to_owned(),
        value: with_unit(mean, "N"),
        remark: run.metric("desired_force_n").map_or(String::new(), off),
    })
}

/// The largest force of all phases.
fn peak(run: &RunResult<'_>) -> Option<Fact> {
    let peaks = METRICS.iter().filter(|metric| metric.part == Part::Peaks);
    let peaks = peaks.filter_map(|metric| Some((metric.column?, run.metric(metric.name)?)));
    let (phase, most) = peaks.max_by(|a, b| a.1.total_cmp(&b.1))?;
    Some(Fact {
        name: "largest force".to_owned(),
        value: with_unit(most, "N"),
        remark: format!("of all phases, in {phase}"),
    })
}

fn pictures<'a>(run: &'a RunResult<'_>) -> Option<Section<'a>> {
    let is_bench = run.document["kind"] == "bench";
    let title = if is_bench {
        "The bench"
    } else {
        "Cell and edge"
    };
    let cell = match is_bench {
        true => "The device on its base and what it meets, with the contact force.",
        false => {
            "Arm, device and part in the middle of following; the arrow is the contact force with its friction."
        }
    };
    let edge = "The part and its edge, coloured by the mean force error of each of 400 pieces while following; pale where the part hides it.";
    let pictures = [(cell, &run.cell), (edge, &run.edge)];
    let pictures: Vec<(String, String)> = (pictures.into_iter())
        .filter_map(|(words, svg)| Some((words.to_owned(), svg.as_ref()?.to_string())))
        .collect();
    let mut blocks = match &run.space {
        Some(space) => vec![Block::InSpace(space, pictures)],
        None if pictures.is_empty() => vec![],
        None => vec![Block::Sketches(pictures)],
    };
    if let Some(lean) = &run.lean {
        let words = "The tool across the edge in the middle of following, as it is planned; process.lean_deg and process.tool_axis set it.";
        blocks.push(Block::Sketches(vec![(words.to_owned(), lean.to_string())]));
    }
    (!blocks.is_empty()).then(|| Section::new(title, blocks))
}

/// Headings of a table with a row for each of these.
fn headings<S: Measured>() -> Vec<String> {
    let heading = |(name, metric): (_, &Metric<S>)| format!("#{name}, {}", metric.unit);
    columns().map(heading).collect()
}

/// Result of each command of a bench.
fn levels<'a>(run: &RunResult<'_>) -> Option<Section<'a>> {
    let levels = run.document["summary"]["levels"].clone();
    let levels: Vec<LevelSummary> = serde_json::from_value(levels).ok()?;
    let names = headings::<LevelSummary>();
    let names: Vec<&str> = names.iter().map(String::as_str).collect();
    let row = |level: &LevelSummary| {
        let cell = |metric: &Metric<LevelSummary>| {
            Cell::from(optional((metric.value)(level), metric.unit))
        };
        columns().map(|(_, metric)| cell(metric)).collect()
    };
    let rows: Vec<Vec<Cell>> = levels.iter().map(row).collect();
    let caption = "Steady values of each command, up to the next or to where something else begins to move; settled: until the force stays within 5 % of its change.";
    (!rows.is_empty()).then(|| {
        Section::new(
            "Commands",
            vec![Block::Table(Table::new(caption, &names, rows))],
        )
    })
}

/// Each pass of a run of several.
fn passes<'a>(run: &'a RunResult<'_>) -> Option<Section<'a>> {
    let passes: Vec<PassSummary> =
        serde_json::from_value(run.document["summary"]["passes"].clone()).ok()?;
    if passes.len() < 2 {
        return None;
    }
    let names = headings::<PassSummary>().into_iter();
    let names: Vec<String> = std::iter::once("#pass".to_owned()).chain(names).collect();
    let row = |pass: &PassSummary| {
        let value =
            |metric: &Metric<PassSummary>| Cell::from(shown((metric.value)(pass), metric.unit));
        let number = Cell::from(pass.pass.to_string());
        let values = columns().map(|(_, metric)| value(metric));
        std::iter::once(number).chain(values).collect()
    };
    let names: Vec<&str> = names.iter().map(String::as_str).collect();
    let caption = "Each pass along the edge, against its own desired force; the other numbers of the force are those of the first.";
    let table = Table::new(caption, &names, passes.iter().map(row).collect());
    Some(Section::new("Passes", vec![Block::Table(table)]))
}

fn metrics<'a>(run: &'a RunResult<'_>) -> Option<Section<'a>> {
    let expectations = run.document["expectations"].as_array();
    let bounds = |key: &str| {
        let own = |e: &&Value| e["metric"] == key && e["pass"].is_null();
        let bound = expectations.into_iter().flatten().find(own)?;
        Some((ends(bound), bound["kept"] == true))
    };
    let row = |(label, value): (Label, Option<f64>)| {
        vec![
            Cell::from(label.name),
            Cell::from(shown(value, label.unit)),
            Cell::from(label.unit),
            match bounds(label.key) {
                Some((text, kept)) => Cell::Judged(text, kept),
                None => Cell::from(""),
            },
            Cell::from(label.meaning),
            Cell::from(label.key),
        ]
    };
    let rows: Vec<Vec<Cell>> = run.metrics().into_iter().map(row).collect();
    let columns = [
        "number",
        "#value",
        "unit",
        "bounds",
        "what it is",
        "key in summary.json",
    ];
    let caption = format!("{UNKNOWN}: not determined by this run.");
    let table = Table::new(&caption, &columns, rows);
    Some(Section::new("Numbers", vec![Block::Table(table)]))
}

fn from<'a>(run: &RunResult<'_>) -> Section<'a> {
    let mut section = provenance_of(&run.document);
    let of = |key: &str| run.document[key].as_str().unwrap_or("–").to_owned();
    let mut told = format!("Scenario {}", of("scenario"));
    if let Some(samples) = run.document["samples"].as_u64() {
        told += &format!(", {samples} samples");
    }
    section.blocks.insert(0, Block::Paragraph(told + "."));
    section
}
