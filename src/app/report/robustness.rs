//! How robust the chosen design is, on the page of a study.

use serde_json::Value;

use super::design::{bare, limit_words, list, named, quantity, text};
use crate::document::{Block, Cell, Section, Table};
use crate::quantity::UNKNOWN;
use crate::quantity::display_name::{display_name, number};

/// The section; none if nothing was drawn at the chosen design.
pub(super) fn robustness<'a>(document: &Value, svg: Option<&str>) -> Option<Section<'a>> {
    let robustness = document.get("robustness")?;
    let picture = svg.map(|svg| Block::Picture(bare(svg).to_owned()));
    let blocks = [kept(robustness), quantiles(robustness), drawn(robustness)];
    let blocks = picture.into_iter().chain(blocks.map(Block::Table));
    Some(Section::new("Robustness", blocks.collect()))
}

fn percent(value: &Value) -> String {
    value
        .as_f64()
        .map_or(UNKNOWN.to_owned(), |value| format!("{value:.0}"))
}

fn kept(robustness: &Value) -> Table {
    let row = |name: String, share: &Value| {
        let [low, high] = [0, 1].map(|end| percent(&share["interval_percent"][end]));
        let cells = [
            name,
            share["kept"].to_string(),
            percent(&share["share_percent"]),
            format!("{low} to {high}"),
        ];
        cells.map(Cell::from).to_vec()
    };
    let all = row("all limits".to_owned(), &robustness["all_limits"]);
    let limits =
        list(&robustness["limits"]).map(|limit| row(limit_words(text(&limit["limit"])), limit));
    let rows = [all].into_iter().chain(limits).collect();
    let caption = format!(
        "Of {} draws at the chosen design, seed {}, those that keep the limits, with the exact binomial interval at 95 %.",
        robustness["runs"], robustness["seed"]
    );
    let columns = ["limit", "#draws", "#share, %", "#interval, %"];
    Table::new(&caption, &columns, rows)
}

fn quantiles(robustness: &Value) -> Table {
    let row = |told: &Value| {
        let key = text(&told["metric"]);
        let of = |which: &str| quantity(key, &told[which]);
        let values = ["chosen", "percent_5", "percent_50", "percent_95"].map(of);
        let cells = [named(key).0].into_iter().chain(values);
        cells.map(Cell::from).collect()
    };
    let caption =
        "Values below which 5, 50 and 95 % of the draws lie, beside the chosen design as it is.";
    let columns = ["quantity", "#as it is", "#5 %", "#50 %", "#95 %"];
    Table::new(
        caption,
        &columns,
        list(&robustness["quantiles"]).map(row).collect(),
    )
}

fn drawn(robustness: &Value) -> Table {
    let row = |variable: &Value| {
        let (name, unit) = display_name(text(&variable["key"]));
        let cells = [name, unit, words(&variable["distribution"])];
        cells.map(Cell::from).to_vec()
    };
    let caption = "What was drawn, as a Latin hypercube.";
    let columns = ["variable", "unit", "distribution"];
    Table::new(
        caption,
        &columns,
        list(&robustness["variables"]).map(row).collect(),
    )
}

/// A distribution in words.
fn words(distribution: &Value) -> String {
    let of = |value: &Value| value.as_f64().map_or(UNKNOWN.to_owned(), number);
    let ends = &distribution["uniform"];
    if ends.is_array() {
        return format!("evenly from {} to {}", of(&ends[0]), of(&ends[1]));
    }
    let normal = &distribution["normal"];
    let [low, high] = [0, 1].map(|end| normal["bounds"][end].as_f64());
    let bounds = [("at least", low), ("at most", high)];
    let bounds = bounds
        .iter()
        .filter_map(|(words, bound)| bound.map(|bound| format!(", {words} {}", number(bound))));
    let bounds: String = bounds.collect();
    format!(
        "normal, mean {}, standard deviation {}{bounds}",
        of(&normal["mean"]),
        of(&normal["standard_deviation"])
    )
}
