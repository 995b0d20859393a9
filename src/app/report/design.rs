//! The page of a design study.

use serde_json::Value;

use super::super::files::{DESIGN, OVERRIDE};
use super::judged::judged;
use super::provenance::provenance_of;
use crate::diagnosis::answer::words::capital;
use crate::document::{Block, Cell, Document, Fact, Section, Table, Tone};
use crate::metrics::labels;
use crate::quantity::display_name::{display_name, number};
use crate::quantity::{UNKNOWN, change, optional, with_unit};

/// The page.
pub(super) fn page<'a>(
    document: &Value,
    front: Option<&str>,
    robustness: Option<Section<'a>>,
) -> Document<'a> {
    let sections = [
        Some(chosen(document)),
        front.map(|svg| trade_off(document, svg)),
        Some(binding(document)),
        limits(document),
        robustness,
        Some(steps(document)),
        Some(measured_by(document)),
        judged(document, DESIGN),
        Some(provenance_of(document)),
    ];
    Document {
        title: document["title"].as_str().unwrap_or("A study").to_owned(),
        verdict: verdict(document),
        tone: Tone::Found,
        facts: facts(document),
        sections: sections.into_iter().flatten().collect(),
        footer: "Made by idc. override.toml beside this page holds the chosen design; a scenario takes it as it stands.".to_owned(),
        ..Document::default()
    }
}

pub(super) fn list(value: &Value) -> impl Iterator<Item = &Value> {
    value.as_array().into_iter().flatten()
}

pub(super) fn text(value: &Value) -> &str {
    value.as_str().unwrap_or_default()
}

/// A metric's or a variable's name and unit.
pub(super) fn named(key: &str) -> (String, String) {
    let mut known = labels(true).into_iter().chain(labels(false));
    match known.find(|label| label.key == key) {
        Some(label) => (label.name, label.unit.to_owned()),
        None => display_name(key),
    }
}

/// A metric's value with its unit.
pub(super) fn quantity(key: &str, value: &Value) -> String {
    let (_, unit) = named(key);
    value
        .as_f64()
        .map_or(UNKNOWN.to_owned(), |value| with_unit(value, &unit))
}

/// A change in percent, or a dash.
fn changed(value: &Value) -> String {
    value.as_f64().map_or(UNKNOWN.to_owned(), change)
}

/// A limit without its key: `impact peak at most 400 N`.
pub(super) fn limit_words(limit: &str) -> String {
    let (key, rest) = limit.split_once(' ').unwrap_or((limit, ""));
    let name = match key {
        "force_n" => "force at rest".to_owned(),
        _ => named(key).0,
    };
    format!("{name} {rest}").trim_end().to_owned()
}

/// Improvement of the objective by the study.
fn verdict(document: &Value) -> String {
    let minimised = text(&document["objectives"]["minimised"]);
    let (name, unit) = named(minimised);
    // design.json is in the units of its keys.
    let of = |candidate: &str| document[candidate]["objective"].as_f64();
    let [Some(start), Some(chosen)] = ["start", "chosen"].map(of) else {
        return "Studied.".to_owned();
    };
    let [from, to] = [start, chosen].map(|value| with_unit(value, &unit));
    let name = capital(&name);
    if document["start"]["feasible"] == false {
        return format!(
            "{name}: {to} in a design that keeps all limits, which the start, at {from}, does not."
        );
    }
    match chosen < start {
        true => format!("{name} falls from {from} to {to}."),
        false => format!("{name} stays at {to}: no better design was found."),
    }
}

fn facts(document: &Value) -> Vec<Fact> {
    let objectives = &document["objectives"];
    let of = |key: &str, over: &Value, which: &str| {
        let [start, chosen] =
            ["start", "chosen"].map(|candidate| quantity(key, &document[candidate][which]));
        let over = match (over.as_str(), objectives["scenarios"].as_u64()) {
            (Some(over), Some(count)) if count > 1 => format!(", {over} of {count} scenarios"),
            _ => String::new(),
        };
        Fact {
            name: named(key).0,
            value: chosen,
            remark: format!("start {start}{over}"),
        }
    };
    let minimised = text(&objectives["minimised"]);
    let second = objectives["trade_off"].as_str();
    let second = second.map(|key| of(key, &objectives["trade_off_over"], "trade_off"));
    let range = |candidate: &str| {
        let ends = [0, 1].map(|i| document[candidate]["force_range_n"][i].as_f64());
        format!("{} to {} N", optional(ends[0], "N"), optional(ends[1], "N"))
    };
    let failed: u64 = document["infeasible"].as_object().map_or(0, |reasons| {
        reasons.values().filter_map(Value::as_u64).sum()
    });
    let others = [
        Fact {
            name: "force at rest".to_owned(),
            value: range("chosen"),
            remark: format!("start {}", range("start")),
        },
        Fact {
            name: "designs evaluated".to_owned(),
            value: document["evaluations"].to_string(),
            remark: format!("{failed} of them not feasible; seed {}", document["seed"]),
        },
    ];
    let first = of(minimised, &objectives["minimised_over"], "objective");
    [first].into_iter().chain(second).chain(others).collect()
}

/// The chosen design beside the start, within what was varied.
fn chosen<'a>(document: &Value) -> Section<'a> {
    let bound = |key: &str| list(&document["active_bounds"]).find(|b| b["variable"] == key);
    let varied = |key: &str| list(&document["variables"]).find(|v| v["key"] == key);
    let row = |(key, value): (&String, &Value)| {
        let (name, unit) = display_name(key);
        let own = varied(key);
        let ends = own.and_then(|own| Some([own["min"].as_f64()?, own["max"].as_f64()?]));
        let start = document["start"]["design"][key].as_f64();
        let chosen = value.as_f64();
        let range = match (ends, own.map(|own| list(&own["choices"]).count())) {
            (Some([min, max]), Some(0)) => format!("{} to {}", number(min), number(max)),
            (Some(_), _) => {
                let choices = list(&own.unwrap_or(&Value::Null)["choices"])
                    .filter_map(Value::as_f64)
                    .map(number);
                choices.collect::<Vec<_>>().join(", ")
            }
            _ => "follows".to_owned(),
        };
        let remark = bound(key).map_or(String::new(), |bound| match text(&bound["side"]) {
            "min" => "at its lower end".to_owned(),
            _ => "at its upper end".to_owned(),
        });
        let drawn = match (ends, chosen) {
            (Some([min, max]), Some(at)) => Cell::Interval([min, at, at, at, max]),
            _ => Cell::from(""),
        };
        vec![
            Cell::from(name),
            Cell::from(unit),
            Cell::from(start.map_or(UNKNOWN.to_owned(), number)),
            Cell::from(chosen.map_or(UNKNOWN.to_owned(), number)),
            Cell::from(range),
            drawn,
            Cell::from(remark),
        ]
    };
    let design = document["chosen"]["design"].as_object();
    let rows: Vec<Vec<Cell>> = design.into_iter().flatten().map(row).collect();
    let table = Table::new(
        "What was varied; the mark stands where the chosen value lies between its bounds.",
        &[
            "variable",
            "unit",
            "#start",
            "#chosen",
            "bounds",
            "place between them",
            "remark",
        ],
        rows,
    );
    let files = [
        (OVERRIDE, "the chosen design as a scenario takes it"),
        (DESIGN, "all of this result, for programs"),
    ];
    let files = files.map(|(name, words)| Block::File(name.to_owned(), words.to_owned()));
    let blocks = [Block::Table(table)].into_iter().chain(files);
    Section::new("Chosen design", blocks.collect())
}

fn trade_off<'a>(document: &Value, svg: &str) -> Section<'a> {
    let objectives = &document["objectives"];
    let [minimised, second] = ["minimised", "trade_off"].map(|key| text(&objectives[key]));
    let designs: Vec<&Value> = list(&document["front"]).collect();
    let keys: Vec<&String> = designs
        .first()
        .and_then(|point| point["design"].as_object())
        .into_iter()
        .flat_map(serde_json::Map::keys)
        .collect();
    let with = |(name, unit): (String, String)| match unit.is_empty() {
        true => format!("#{name}"),
        false => format!("#{name}, {unit}"),
    };
    let columns = [named(second), named(minimised)].into_iter().map(with);
    let columns: Vec<String> = columns
        .chain(keys.iter().map(|key| with(display_name(key))))
        .collect();
    let columns: Vec<&str> = columns.iter().map(String::as_str).collect();
    let row = |point: &&Value| {
        let of = |key: &str, which: &str| optional(point[which].as_f64(), &named(key).1);
        let own = [of(second, "trade_off"), of(minimised, "objective")];
        let values = keys.iter().map(|key| {
            let value = point["design"][key.as_str()].as_f64();
            value.map_or(UNKNOWN.to_owned(), number)
        });
        own.into_iter().chain(values).map(Cell::from).collect()
    };
    let caption = "Designs of which none is better in both.";
    let table = Table::new(caption, &columns, designs.iter().map(row).collect());
    let words = format!("The {} designs of the front", designs.len());
    Section::new(
        "Trade-off",
        vec![
            Block::Picture(bare(svg).to_owned()),
            Block::Folded(words, vec![Block::Table(table)]),
        ],
    )
}

/// An SVG document without what stands before its first element.
pub(super) fn bare(svg: &str) -> &str {
    &svg[svg.find("<svg").unwrap_or(0)..]
}

/// Bounds and limits that keep the objective from being lower.
fn binding<'a>(document: &Value) -> Section<'a> {
    let (objective, _) = named(text(&document["objectives"]["minimised"]));
    let tried = |key: &Value| {
        let mut steps = list(&document["sensitivities"]);
        steps.any(|step| step["variable"] == *key && step["beyond_bound"] == true)
    };
    let bounds = list(&document["active_bounds"]).map(|bound| {
        let (name, unit) = display_name(text(&bound["variable"]));
        let side = match text(&bound["side"]) {
            "min" => "at least",
            _ => "at most",
        };
        let at = bound["bound"].as_f64().map_or(String::new(), number);
        let effect = match bound["objective_change_percent"].as_f64() {
            Some(percent) => change(percent),
            None if tried(&bound["variable"]) => "cannot be simulated".to_owned(),
            None => "its catalogue ends there".to_owned(),
        };
        [
            format!("{name} {side} {at} {unit}").trim_end().to_owned(),
            "bound of the variable".to_owned(),
            "a step beyond it".to_owned(),
            effect,
        ]
    });
    let limits = list(&document["active_limits"]).map(|limit| {
        let looser = limit["loosened_to"].as_f64().map_or(String::new(), number);
        let unit = text(&limit["unit"]);
        [
            limit_words(text(&limit["limit"])),
            "limit".to_owned(),
            format!("at {looser} {unit}, chosen anew").replace(" ,", ","),
            changed(&limit["objective_change_percent"]),
        ]
    });
    let rows = bounds.chain(limits);
    let rows: Vec<Vec<Cell>> = rows.map(|row| row.map(Cell::from).to_vec()).collect();
    let block = match rows.is_empty() {
        true => Block::Paragraph("Nothing: neither a bound nor a limit.".to_owned()),
        false => {
            let effect = format!("#{objective}");
            let columns = ["what binds", "kind", "with more room", &effect];
            let caption = "What more room would do to what was minimised.";
            Block::Table(Table::new(caption, &columns, rows))
        }
    };
    Section::new("What binds", vec![block])
}

fn limits<'a>(document: &Value) -> Option<Section<'a>> {
    let before = list(&document["start"]["limits"]);
    let after = list(&document["chosen"]["limits"]);
    let row = |(before, after): (&Value, &Value)| {
        let key = text(&after["key"]);
        let kept = after["kept"] == true;
        let state = match (kept, after["active"] == true) {
            (true, true) => "just kept",
            (true, false) => "kept",
            (false, _) => "broken",
        };
        let was = match before["kept"] == true {
            true => "kept",
            false => "broken",
        };
        vec![
            Cell::from(limit_words(text(&after["limit"]))),
            Cell::from(quantity(key, &before["value"])),
            Cell::Judged(was.to_owned(), before["kept"] == true),
            Cell::from(quantity(key, &after["value"])),
            Cell::Judged(state.to_owned(), kept),
        ]
    };
    let rows: Vec<Vec<Cell>> = before.zip(after).map(row).collect();
    let columns = [
        "limit",
        "#start",
        "start keeps it",
        "#chosen",
        "chosen keeps it",
    ];
    let caption = "The worst of the scenarios.";
    (!rows.is_empty()).then(|| {
        let table = Table::new(caption, &columns, rows);
        Section::new("Limits", vec![Block::Table(table)])
    })
}

fn steps<'a>(document: &Value) -> Section<'a> {
    let (objective, _) = named(text(&document["objectives"]["minimised"]));
    let row = |step: &Value| {
        let (name, unit) = display_name(text(&step["variable"]));
        let breaks: Vec<String> = list(&step["breaks"]).map(text).map(limit_words).collect();
        let remark = match (step["failure"].as_str(), breaks.is_empty()) {
            (Some(reason), _) => reason.to_owned(),
            (None, false) => format!("breaks: {}", breaks.join("; ")),
            (None, true) if step["beyond_bound"] == true => "beyond its bound".to_owned(),
            _ => String::new(),
        };
        vec![
            Cell::from(name),
            Cell::from(changed(&step["change_percent"])),
            Cell::from(step["value"].as_f64().map_or(String::new(), number)),
            Cell::from(unit),
            Cell::from(changed(&step["objective_change_percent"])),
            Cell::from(remark),
        ]
    };
    let rows: Vec<Vec<Cell>> = list(&document["sensitivities"]).map(row).collect();
    let effect = format!("#{objective}");
    let columns = ["variable", "#changed by", "#to", "unit", &effect, "remark"];
    let table = Table::new(
        "Each variable alone, a tenth more and less, or to the next entry of its catalogue.",
        &columns,
        rows,
    );
    Section::new("One variable alone", vec![Block::Table(table)])
}

/// Scenarios, objectives, and what each scenario gave.
fn measured_by<'a>(document: &Value) -> Section<'a> {
    let objectives = &document["objectives"];
    let mut keys: Vec<&str> = ["minimised", "trade_off"]
        .into_iter()
        .filter_map(|which| objectives[which].as_str())
        .collect();
    let limited = list(&document["chosen"]["limits"]).map(|limit| text(&limit["key"]));
    for key in limited {
        if !keys.contains(&key) {
            keys.push(key);
        }
    }
    let start_of = |name: &Value| {
        let mut all = list(&document["start"]["scenarios"]);
        all.find(|scenario| scenario["name"] == *name)
    };
    let rows = list(&document["chosen"]["scenarios"]).flat_map(|scenario| {
        let start = start_of(&scenario["name"]);
        keys.iter().filter_map(move |key| {
            let chosen = &scenario["metrics"][*key];
            chosen.as_f64()?;
            let start = start.map_or(&Value::Null, |start| &start["metrics"][*key]);
            let percent = chosen.as_f64().zip(start.as_f64());
            let percent = percent.map(|(to, from)| 100.0 * (to - from) / from.abs());
            let percent = percent.filter(|percent| percent.is_finite());
            Some(vec![
                Cell::from(text(&scenario["name"])),
                Cell::from(named(key).0),
                Cell::from(quantity(key, start)),
                Cell::from(quantity(key, chosen)),
                Cell::from(percent.map_or(String::new(), change)),
            ])
        })
    });
    let columns = ["scenario", "number", "#start", "#chosen", "#change"];
    let table = Table::new(
        "What the study names, in each scenario.",
        &columns,
        rows.collect(),
    );
    let files: Vec<&str> = list(&document["scenarios"]).map(text).collect();
    let simulated = format!(
        "Each design is simulated in {}: {}.",
        match files.len() {
            1 => "one scenario".to_owned(),
            count => format!("{count} scenarios"),
        },
        files.join(", ")
    );
    let mut blocks = vec![Block::Paragraph(simulated), Block::Table(table)];
    let reasons = document["infeasible"].as_object().into_iter().flatten();
    let reasons: Vec<Vec<Cell>> = reasons
        .map(|(reason, count)| {
            let reason = match reason.contains(' ') && reason.contains('_') {
                true => limit_words(reason),
                false => reason.clone(),
            };
            vec![Cell::from(reason), Cell::from(count.to_string())]
        })
        .collect();
    if !reasons.is_empty() {
        let caption =
            "Designs that were not feasible, by the limit most exceeded or by the reason.";
        let table = Table::new(caption, &["reason", "#designs"], reasons);
        blocks.push(Block::Folded(
            "Designs that were not feasible".to_owned(),
            vec![Block::Table(table)],
        ));
    }
    Section::new("What it was measured by", blocks)
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn the_verdict_tells_what_the_study_did_in_its_unit() {
        let study = |start: f64, chosen: f64, feasible: bool| {
            verdict(&json!({
                "objectives": {"minimised": "coefficient_of_variation_percent"},
                "start": {"objective": start, "feasible": feasible},
                "chosen": {"objective": chosen, "feasible": true},
            }))
        };
        assert_eq!(
            study(4.761, 3.662, true),
            "Coefficient of variation falls from 4.761 % to 3.662 %."
        );
        assert_eq!(
            study(3.0, 3.0, true),
            "Coefficient of variation stays at 3.000 %: no better design was found."
        );
        assert_eq!(
            study(3.0, 4.0, false),
            "Coefficient of variation: 4.000 % in a design that keeps all limits, which the start, at 3.000 %, does not."
        );
    }
}
