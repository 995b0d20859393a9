//! The page of a sweep.

use super::super::error::AppError;
use super::table::RUNS;
use crate::document::{
    Block, Cell, Column, Document, Horizontal, Panel, Role, Section, Series, Stroke, Table, Tone,
};
use crate::metrics::Label;
use crate::quantity::display_name::{display_name, number as plain};
use crate::quantity::{UNKNOWN, column, number};
use crate::recording::long_column::LongColumn;
use crate::report::sources;
use crate::stats::quantiles;
use crate::vary::{MetricOfRuns, QUANTILES, ReadColumns, Swept, percent, short};

/// Metrics that are drawn.
const DRAWN: usize = 4;
/// Points of a cloud at most, every so many of all runs.
const POINTS: usize = 2000;
/// Steps of a curve of shares.
const STEPS: usize = 100;

/// The document of a sweep, of its result and the table beside it.
pub(in super::super) fn document(
    swept: &Swept,
    columns: ReadColumns<'_>,
) -> Result<Document<'static>, AppError> {
    let clean = !swept.codes.keys().any(|code| *code > 0);
    let stopped = swept.stopped.iter();
    let stopped = stopped.map(|(run, reason)| format!("Run {run}: {reason}"));
    let mut sections = vec![drivers(swept)];
    sections.extend(pictures(swept, columns)?.map(Section::appendix));
    sections.push(distribution(swept).appendix());
    sections.push(varied(swept));
    sections.push(sources(&swept.program, &swept.files));
    Ok(Document {
        title: format!("Sweep of {}", swept.title),
        verdict: swept.verdict(),
        tone: if clean { Tone::Good } else { Tone::Found },
        lead: swept.findings().into_iter().chain(stopped).collect(),
        sections,
        footer: format!(
            "Made by idc vary. {RUNS} beside this page has a row for each run; a run is done again in full by idc run with its values (--set)."
        ),
        ..Document::default()
    })
}

fn named(label: &Label) -> String {
    match label.unit {
        "" => label.name.clone(),
        unit => format!("{} [{unit}]", label.name),
    }
}

fn named_key(key: &str) -> String {
    match display_name(short(key)) {
        (name, unit) if unit.is_empty() => name,
        (name, unit) => format!("{name} [{unit}]"),
    }
}

/// Each metric that differs, with its label.
fn differing(swept: &Swept) -> Vec<(Label, &MetricOfRuns)> {
    let labels = swept.labels().into_iter();
    labels
        .filter_map(|label| {
            let metric = swept.metrics.iter().find(|m| m.name == label.key)?;
            metric.varies().then_some((label, metric))
        })
        .collect()
}

fn drivers(swept: &Swept) -> Section<'static> {
    let rows = differing(swept).into_iter().flat_map(|(label, metric)| {
        let sure = metric.sure().map(|driver| {
            let [low, high] = driver.interval;
            vec![
                Cell::from(display_name(short(&driver.key)).0),
                Cell::from(percent(driver.share)),
                Cell::from(format!("{} to {}", percent(low), percent(high))),
                Cell::Interval([0.0, low, driver.share, high, 1.0]),
                Cell::from(percent(driver.shuffled)),
                Cell::from(match driver.rank_correlation {
                    Some(correlation) => format!("{correlation:.2}"),
                    None => UNKNOWN.to_owned(),
                }),
            ]
        });
        let mut rows: Vec<Vec<Cell>> = sure.chain(unsure(metric)).collect();
        for (place, row) in rows.iter_mut().enumerate() {
            let name = if place == 0 {
                named(&label)
            } else {
                String::new()
            };
            row.insert(0, Cell::from(name));
        }
        rows
    });
    let rows: Vec<Vec<Cell>> = rows.collect();
    let words = "Share of a number's variance over the runs that goes with one variable alone (first-order index), with its interval at 95 %; what is missing \
                 to 100 % is due to variables together, and to what is drawn at random. By chance: what the same values get at most, 95 times of 100, where they are shuffled \
                 among the runs; a share is named where its whole interval lies above that. Rank correlation: 1 where the number only grows with the variable, -1 where it only falls.";
    let columns = Column::list(
        "number | driven by | #share [%] | #interval [%] | interval drawn | #by chance [%] | #rank correlation",
    );
    let block = match rows.is_empty() {
        true => Block::Paragraph(
            "No number differs between the runs, or there are too few runs to say.".to_owned(),
        ),
        false => Block::Table(Table::new("", columns, rows)),
    };
    Section::new(
        "Which variable drives which number",
        vec![Block::Hint(words.to_owned()), block],
    )
}

/// The variables whose shares of a number do not differ from chance, in a row, with how large one of them may be all the same.
fn unsure(metric: &MetricOfRuns) -> Option<Vec<Cell>> {
    let others: Vec<_> = metric
        .drivers
        .iter()
        .filter(|driver| !driver.is_sure())
        .collect();
    let names: Vec<String> = others
        .iter()
        .map(|driver| display_name(short(&driver.key)).0)
        .collect();
    let most = others
        .iter()
        .map(|driver| driver.interval[1])
        .fold(0.0, f64::max);
    let chance = others
        .iter()
        .map(|driver| driver.shuffled)
        .fold(0.0, f64::max);
    (!others.is_empty()).then(|| {
        vec![
            Cell::from(format!("no more than chance: {}", names.join(", "))),
            Cell::from(UNKNOWN),
            Cell::from(format!("each at most {}", percent(most))),
            Cell::from(""),
            Cell::from(percent(chance)),
            Cell::from(UNKNOWN),
        ]
    })
}

fn distribution(swept: &Swept) -> Section<'static> {
    let labels = swept.labels();
    let rows = swept.metrics.iter().filter_map(|metric| {
        let label = labels.iter().find(|label| label.key == metric.name)?;
        let values: Vec<Option<f64>> = QUANTILES.map(|share| metric.quantile(share)).to_vec();
        let first = [Cell::from(named(label))].into_iter();
        let cells = column(&values, label.unit).into_iter().map(Cell::from);
        let runs = Cell::from(metric.runs.to_string());
        Some(first.chain(cells).chain([runs]).collect())
    });
    let heads = QUANTILES.map(|share| match share {
        0.0 => "least".to_owned(),
        1.0 => "greatest".to_owned(),
        0.5 => "median".to_owned(),
        share => format!("{:.0} %", 100.0 * share),
    });
    let mut columns = vec![Column::of_words("number")];
    columns.extend(heads.map(Column::of_numbers));
    columns.push(Column::of_numbers("runs"));
    let caption = "Values below which these shares of the runs lie; runs that do not determine a number are left out.";
    let table = Table::new(caption, columns, rows.collect());
    Section::new("Distribution of every number", vec![Block::Table(table)])
}

fn varied(swept: &Swept) -> Section<'static> {
    let rows = swept.variables.iter().map(|variable| {
        let ends = variable.ends.map_or(UNKNOWN.to_owned(), |[low, high]| {
            format!("{} to {}", plain(low), plain(high))
        });
        let (_, unit) = display_name(short(&variable.key));
        [
            variable.key.clone(),
            ends,
            unit,
            variable.which.clone(),
            variable.values.to_string(),
        ]
        .map(Cell::from)
        .to_vec()
    });
    let caption = format!("The points are {}.", swept.points);
    let columns = Column::list("key | #values | unit | which | #different");
    let table = Table::new(&caption, columns, rows.collect());
    Section::new("What was varied", vec![Block::Table(table)])
}

/// Numbers over what drives them most, and how they are distributed.
fn pictures(swept: &Swept, columns: ReadColumns<'_>) -> Result<Option<Section<'static>>, AppError> {
    let mut blocks = Vec::new();
    for (label, metric) in swept.most_important().take(DRAWN) {
        // The first is the largest share; of a number that nothing drives for sure, the run's own scatter is drawn over it all the same.
        let first = metric.sure().next().or(metric.drivers.first());
        let key = first.map(|driver| driver.key.clone());
        let wanted: Vec<&str> = key.iter().map(String::as_str).chain([label.key]).collect();
        let mut read = columns(&wanted)?;
        let Some(LongColumn::Numbers(values)) = read.remove(label.key) else {
            continue;
        };
        blocks.push(Block::Heading(label.name.clone()));
        let driver = key.and_then(|key| Some((read.remove(&key)?, key)));
        if let Some((LongColumn::Numbers(x), key)) = driver {
            blocks.push(Block::Panel(cloud(&label, &key, &x, &values)));
        }
        blocks.push(Block::Panel(shares(&label, &values)));
    }
    let words = "Above, each run over the variable that drives the number most; below, the share of the runs in which it is no larger.";
    Ok((!blocks.is_empty()).then(|| {
        blocks.insert(0, Block::Hint(words.to_owned()));
        Section::new("Charts", blocks)
    }))
}

fn cloud(label: &Label, key: &str, x: &[f64], values: &[f64]) -> Panel<'static> {
    let each = values.len().div_ceil(POINTS).max(1);
    let (x, y): (Vec<f64>, Vec<f64>) = (x.iter().zip(values))
        .filter(|(x, y)| !x.is_nan() && y.is_finite())
        .map(|(x, y)| (*x, *y))
        .step_by(each)
        .unzip();
    Panel {
        title: if each > 1 {
            format!("every {}th run", number(each as f64, ""))
        } else {
            "each run".to_owned()
        },
        vertical_label: named(label),
        horizontal: Horizontal::Quantity(named_key(key)),
        series: vec![Series::new("", x, y, Role::Regulator, Stroke::Points)],
        ..Panel::default()
    }
}

fn shares(label: &Label, values: &[f64]) -> Panel<'static> {
    let shares: Vec<f64> = (0..=STEPS).map(|step| step as f64 / STEPS as f64).collect();
    let places = quantiles(values, &shares).unwrap_or_default();
    let shares: Vec<f64> = shares.iter().map(|share| 100.0 * share).collect();
    Panel {
        title: "share of the runs at or below".to_owned(),
        vertical_label: "share of the runs [%]".to_owned(),
        horizontal: Horizontal::Quantity(named(label)),
        series: vec![Series::new(
            "",
            places,
            shares,
            Role::Regulator,
            Stroke::Plain,
        )],
        ..Panel::default()
    }
}
