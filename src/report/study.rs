//! A design study as a document.

use super::assumed::assumed;
use super::provenance::provenance;
use super::study_charts;
use crate::design::robustness::{
    Distribution, DrawnVariable, KeptShare, LimitShare, Quantiles, Robustness,
};
use crate::design::{
    ActiveBound, ActiveLimit, FrontPoint, LimitState, Sensitivity, Side, StudyDocument,
};
use crate::document::{Block, Cell, Column, Document, Fact, Figure, Number, Section, Table, Tone};
use crate::metrics::labels;
use crate::quantity::display_name::{display_name, number};
use crate::quantity::{self, UNKNOWN, capital, change, counted, with_unit};

/// Files of a study beside its page.
const FILES: [(&str, &str); 2] = [
    ("override.toml", "the chosen design as a scenario takes it"),
    ("design.json", "all of this result, for programs"),
];
/// A step that would lower the objective by less is no hint [%].
const IMPROVING_PERCENT: f64 = 0.5;

/// The document of a study.
#[must_use]
pub fn study(study: &StudyDocument) -> Document<'static> {
    let result = &study.result;
    let steps_left = result.improving_steps(IMPROVING_PERCENT).next();
    let hint = steps_left.map(|step| {
        let (name, _) = display_name(&step.variable);
        format!(
            "{} alone would still lower it: more evaluations would help.",
            capital(&name)
        )
    });
    let sections = [
        Some(chosen(study)),
        study_charts::front(result).map(|front| trade_off(study, front)),
        Some(binding(study)),
        limits(study),
        study_charts::robustness(result)
            .and_then(|draws| Some(robustness(result.robustness.as_ref()?, draws))),
        Some(steps(study)),
        Some(measured_by(study)),
        assumed(&study.assumed, "design.json"),
        Some(provenance(&study.provenance)),
    ];
    Document {
        title: result.title.clone(),
        verdict: verdict(study),
        tone: Tone::Found,
        lead: hint.into_iter().collect(),
        facts: facts(study),
        sections: sections.into_iter().flatten().collect(),
        footer: "Made by idc. override.toml beside this page holds the chosen design; a scenario takes it as it stands.".to_owned(),
        ..Document::default()
    }
}

/// A metric or a variable, with its unit.
fn named(key: &str) -> (String, String) {
    let mut known = labels(true).into_iter().chain(labels(false));
    match known.find(|label| label.key == key) {
        Some(label) => (label.name, label.unit.to_owned()),
        None => display_name(key),
    }
}

fn quantity(key: &str, value: Option<f64>) -> Number {
    Number::new(key, value, &named(key).1)
}

/// A value of a file, to its own digits.
fn plain(key: &str, value: Option<f64>) -> Cell {
    let text = value.map_or(UNKNOWN.to_owned(), number);
    Number::bare(key, value, "").written(text).into()
}

/// Words for a limit such as `impact_peak_n at most 400 N`.
fn limit_words(limit: &str) -> String {
    let (key, rest) = limit.split_once(' ').unwrap_or((limit, ""));
    let name = match key {
        "force_n" => "force at rest".to_owned(),
        _ => named(key).0,
    };
    format!("{name} {rest}").trim_end().to_owned()
}

fn changed(percent: Option<f64>) -> Cell {
    Cell::from(percent.map_or(UNKNOWN.to_owned(), change))
}

fn objective(study: &StudyDocument) -> String {
    named(&study.result.objectives.minimised).0
}

/// What the study did to what it minimised, in a sentence.
fn verdict(study: &StudyDocument) -> String {
    let result = &study.result;
    let (name, unit) = named(&result.objectives.minimised);
    let (start, chosen) = (result.start.objective, result.chosen.objective);
    let [from, to] = [start, chosen].map(|value| with_unit(value, &unit));
    let name = capital(&name);
    if !result.start.feasible {
        return format!(
            "{name}: {to} in a design that keeps all limits, which the start, at {from}, does not."
        );
    }
    let price = result.objectives.trade_off.as_deref();
    let price = price.and_then(|key| {
        let (name, unit) = named(key);
        let [from, to] = [result.start.trade_off?, result.chosen.trade_off?];
        let way = if to > from { "rises" } else { "falls" };
        let [from, to] = [from, to].map(|value| with_unit(value, &unit));
        Some(format!(", while {name} {way} from {from} to {to}"))
    });
    match chosen < start {
        true => format!(
            "{name} falls from {from} to {to}{}.",
            price.unwrap_or_default()
        ),
        false => format!("{name} stays at {to}: no better design was found."),
    }
}

fn facts(study: &StudyDocument) -> Vec<Fact> {
    let result = &study.result;
    let names = &result.objectives;
    let of = |key: &str, over: &str, values: [Option<f64>; 2]| {
        let over = match names.scenarios {
            count if count > 1 => format!(", {over} of {count} scenarios"),
            _ => String::new(),
        };
        let start = quantity(key, values[0]).with_unit();
        Fact::new(
            named(key).0,
            quantity(key, values[1]),
            format!("start {start}{over}"),
        )
    };
    let values = [result.start.objective, result.chosen.objective].map(Some);
    let first = of(&names.minimised, &names.minimised_over, values);
    let over = names.trade_off_over.as_deref().unwrap_or_default();
    let second = names.trade_off.as_ref();
    let second = second.map(|key| of(key, over, [result.start.trade_off, result.chosen.trade_off]));
    let range = |[least, most]: [f64; 2]| {
        format!(
            "{} to {} N",
            quantity::number(least, "N"),
            quantity::number(most, "N")
        )
    };
    let failed: usize = result.infeasible.values().sum();
    let others = [
        Fact::new(
            "force at rest",
            range(result.chosen.force_range),
            format!("start {}", range(result.start.force_range)),
        ),
        Fact::new(
            "designs evaluated",
            result.evaluations.to_string(),
            format!("{failed} of them not feasible; seed {}", result.seed),
        ),
    ];
    [first].into_iter().chain(second).chain(others).collect()
}

fn chosen(study: &StudyDocument) -> Section<'static> {
    let result = &study.result;
    let row = |(key, value): (&str, f64)| {
        let (name, unit) = display_name(key);
        let own = study.variables.iter().find(|own| own.key == key);
        let range = match own {
            None => "follows".to_owned(),
            Some(own) => match &own.choices {
                None => format!("{} to {}", number(own.min), number(own.max)),
                Some(choices) => {
                    let choices: Vec<String> = choices.iter().copied().map(number).collect();
                    choices.join(", ")
                }
            },
        };
        let bound = result
            .active_bounds
            .iter()
            .find(|bound| bound.variable == key);
        let remark = bound.map_or("", |bound| match bound.side {
            Side::Min => "at its lower end",
            Side::Max => "at its upper end",
        });
        let drawn = own.map(|own| Cell::Interval([own.min, value, value, value, own.max]));
        vec![
            Cell::from(name),
            Cell::from(unit),
            plain(key, result.start.design.get(key)),
            plain(key, Some(value)),
            Cell::from(range),
            drawn.unwrap_or_default(),
            Cell::from(remark),
        ]
    };
    let columns =
        Column::list("variable | unit | #start | #chosen | bounds | place between them | remark");
    let rows = result.chosen.design.iter().map(row).collect();
    let table = Table::new("What was varied, between which bounds.", columns, rows);
    let files = FILES.map(|(name, words)| Block::File(name.to_owned(), words.to_owned()));
    let blocks = [Block::Table(table)].into_iter().chain(files);
    Section::new("Chosen design", blocks.collect())
}

fn trade_off(study: &StudyDocument, front: Figure<'static>) -> Section<'static> {
    let result = &study.result;
    let names = &result.objectives;
    let second = names.trade_off.as_deref().unwrap_or_default();
    let keys: Vec<&str> = result.chosen.design.iter().map(|(key, _)| key).collect();
    let with = |(name, unit): (String, String)| match unit.is_empty() {
        true => Column::of_numbers(name),
        false => Column::of_numbers(format!("{name}, {unit}")),
    };
    let objectives = [second, &names.minimised].map(|key| with(named(key)));
    let columns = objectives
        .into_iter()
        .chain(keys.iter().map(|key| with(display_name(key))));
    let row = |point: &FrontPoint| {
        let of = |key: &str, value| Cell::from(Number::bare(key, Some(value), &named(key).1));
        let own = [
            of(second, point.trade_off),
            of(&names.minimised, point.objective),
        ];
        let values = keys.iter().map(|key| plain(key, point.design.get(key)));
        own.into_iter().chain(values).collect()
    };
    let rows = result.front.iter().map(row).collect();
    let table = Table::new(
        "Designs of which none is better in both.",
        columns.collect(),
        rows,
    );
    let words = format!("The {} designs of the front", result.front.len());
    let designs = Block::Folded(words, vec![Block::Table(table.sortable())]);
    let panels = front.panels.into_iter().map(Block::Panel);
    Section::new("Trade-off", panels.chain([designs]).collect())
}

/// What binds, and what more room would do.
fn binding(study: &StudyDocument) -> Section<'static> {
    let result = &study.result;
    let tried = |key: &str| {
        let mut steps = result.sensitivities.iter();
        steps.any(|step| step.variable == key && step.beyond_bound)
    };
    let bounds = result.active_bounds.iter().map(|bound: &ActiveBound| {
        let (name, unit) = display_name(&bound.variable);
        let side = match bound.side {
            Side::Min => "at least",
            Side::Max => "at most",
        };
        let effect = match bound.objective_change_percent {
            Some(percent) => change(percent),
            None if tried(&bound.variable) => "cannot be simulated".to_owned(),
            None => "its catalogue ends there".to_owned(),
        };
        [
            format!("{name} {side} {} {unit}", number(bound.bound))
                .trim_end()
                .to_owned(),
            "bound of the variable".to_owned(),
            "a step beyond it".to_owned(),
            effect,
        ]
    });
    let limits = result.active_limits.iter().map(|limit: &ActiveLimit| {
        let looser = format!("{} {}", number(limit.loosened_to), limit.unit);
        [
            limit_words(&limit.limit),
            "limit".to_owned(),
            format!("at {}, chosen anew", looser.trim_end()),
            limit
                .objective_change_percent
                .map_or(UNKNOWN.to_owned(), change),
        ]
    });
    let rows: Vec<Vec<Cell>> = bounds
        .chain(limits)
        .map(|row| row.map(Cell::from).to_vec())
        .collect();
    let block = match rows.is_empty() {
        true => Block::Paragraph("Nothing: neither a bound nor a limit.".to_owned()),
        false => {
            let columns = vec![
                Column::of_words("what binds"),
                Column::of_words("kind"),
                Column::of_words("with more room"),
                Column::of_numbers(objective(study)),
            ];
            Block::Table(Table::new(
                "What more room would change of what was minimised, as a share of it.",
                columns,
                rows,
            ))
        }
    };
    Section::new("What binds", vec![block])
}

fn limits(study: &StudyDocument) -> Option<Section<'static>> {
    let result = &study.result;
    let row = |(before, after): (&LimitState, &LimitState)| {
        let state = match (after.kept, after.active) {
            (true, true) => "just kept",
            (true, false) => "kept",
            (false, _) => "broken",
        };
        let was = if before.kept { "kept" } else { "broken" };
        vec![
            Cell::from(limit_words(&after.limit)),
            quantity(&after.key, Some(before.value)).into(),
            Cell::Verdict(was.to_owned(), before.kept),
            quantity(&after.key, Some(after.value)).into(),
            Cell::Verdict(state.to_owned(), after.kept),
        ]
    };
    let rows: Vec<Vec<Cell>> = result
        .start
        .limits
        .iter()
        .zip(&result.chosen.limits)
        .map(row)
        .collect();
    let columns = Column::list("limit | #start | start keeps it | #chosen | chosen keeps it");
    (!rows.is_empty()).then(|| {
        let table = Table::new("The worst of the scenarios.", columns, rows);
        Section::new("Limits", vec![Block::Table(table)])
    })
}

/// Each variable alone.
fn steps(study: &StudyDocument) -> Section<'static> {
    let row = |step: &Sensitivity| {
        let (name, unit) = display_name(&step.variable);
        let breaks: Vec<String> = step.breaks.iter().map(|limit| limit_words(limit)).collect();
        let remark = match (&step.failure, breaks.is_empty()) {
            (Some(reason), _) => reason.clone(),
            (None, false) => format!("breaks: {}", breaks.join("; ")),
            (None, true) if step.beyond_bound => "beyond its bound".to_owned(),
            _ => String::new(),
        };
        vec![
            Cell::from(name),
            Cell::from(change(step.change_percent)),
            plain(&step.variable, Some(step.value)),
            Cell::from(unit),
            changed(step.objective_change_percent),
            Cell::from(remark),
        ]
    };
    let columns = vec![
        Column::of_words("variable"),
        Column::of_numbers("changed by"),
        Column::of_numbers("to"),
        Column::of_words("unit"),
        Column::of_numbers(objective(study)),
        Column::of_words("remark"),
    ];
    let table = Table::new(
        "Each variable alone, a tenth more and less, or to the next entry of its catalogue: what that changes, as a share of the chosen design's value.",
        columns,
        study.result.sensitivities.iter().map(row).collect(),
    );
    Section::new("One variable alone", vec![Block::Table(table)])
}

/// What designs were measured by, in each scenario, and which could not be.
fn measured_by(study: &StudyDocument) -> Section<'static> {
    let result = &study.result;
    let names = &result.objectives;
    let mut keys: Vec<&str> = [Some(names.minimised.as_str()), names.trade_off.as_deref()]
        .into_iter()
        .flatten()
        .collect();
    for limit in &result.chosen.limits {
        if !keys.contains(&limit.key.as_str()) {
            keys.push(&limit.key);
        }
    }
    let keys = &keys;
    let rows = result.chosen.scenarios.iter().flat_map(|scenario| {
        let start = result
            .start
            .scenarios
            .iter()
            .find(|start| start.name == scenario.name);
        keys.iter().filter_map(move |key| {
            let to = *scenario.metrics.get(*key)?;
            let from = start.and_then(|start| start.metrics.get(*key).copied());
            let percent = from.map(|from| 100.0 * (to - from) / from.abs());
            let percent = percent.filter(|percent| percent.is_finite());
            Some(vec![
                Cell::from(scenario.name.as_str()),
                Cell::from(named(key).0),
                quantity(key, from).into(),
                quantity(key, Some(to)).into(),
                Cell::from(percent.map_or(String::new(), change)),
            ])
        })
    });
    let columns = Column::list("scenario | number | #start | #chosen | #change");
    let table = Table::new(
        "What the study names, in each scenario.",
        columns,
        rows.collect(),
    );
    let count = counted(study.scenarios.len(), "scenario");
    let simulated = format!(
        "Each design is simulated in {count}: {}.",
        study.scenarios.join(", ")
    );
    let mut blocks = vec![Block::Paragraph(simulated), Block::Table(table)];
    let reasons: Vec<Vec<Cell>> = (result.infeasible.iter())
        .map(|(reason, count)| {
            let words = match reason.contains(' ') && reason.contains('_') {
                true => limit_words(reason),
                false => reason.clone(),
            };
            vec![Cell::from(words), Cell::from(count.to_string())]
        })
        .collect();
    if !reasons.is_empty() {
        let caption =
            "Designs that were not feasible, by the limit most exceeded or by the reason.";
        let columns = Column::list("reason | #designs");
        blocks.push(Block::Table(Table::new(caption, columns, reasons)));
    }
    Section::new("What it was measured by", blocks)
}

/// How robust the chosen design is.
fn robustness(found: &Robustness, draws: Figure<'static>) -> Section<'static> {
    let panels = draws.panels.into_iter().map(Block::Panel);
    let tables = [kept(found), quantiles(found), drawn(found)].map(Block::Table);
    Section::new("Robustness", panels.chain(tables).collect())
}

fn kept(found: &Robustness) -> Table {
    let row = |name: String, share: &KeptShare| {
        let [low, high] = share.interval_percent;
        let cells = [
            name,
            share.kept.to_string(),
            format!("{:.0}", share.share_percent),
            format!("{low:.0} to {high:.0}"),
        ];
        cells.map(Cell::from).to_vec()
    };
    let limits = found.limits.iter();
    let limits = limits.map(|limit: &LimitShare| row(limit_words(&limit.limit), &limit.share));
    let all = row("all limits".to_owned(), &found.all_limits);
    let caption = format!(
        "Of {} draws at the chosen design, seed {}, those that keep the limits, with the exact binomial interval at 95 %.",
        found.runs, found.seed
    );
    let columns = Column::list("limit | #draws | #share, % | #interval, %");
    Table::new(&caption, columns, [all].into_iter().chain(limits).collect())
}

fn quantiles(found: &Robustness) -> Table {
    let row = |own: &Quantiles| {
        let values = [own.chosen, own.percent_5, own.percent_50, own.percent_95];
        let values = values.map(|value| Cell::from(quantity(&own.metric, Some(value))));
        [Cell::from(named(&own.metric).0)]
            .into_iter()
            .chain(values)
            .collect()
    };
    let caption =
        "Values below which 5, 50 and 95 % of the draws lie, beside the chosen design as it is.";
    let columns = Column::list("quantity | #as it is | #5 % | #50 % | #95 %");
    Table::new(caption, columns, found.quantiles.iter().map(row).collect())
}

fn drawn(found: &Robustness) -> Table {
    let row = |variable: &DrawnVariable| {
        let (name, unit) = display_name(&variable.key);
        [name, unit, words(&variable.distribution)]
            .map(Cell::from)
            .to_vec()
    };
    let heads = Column::list("variable | unit | distribution");
    let rows = found.variables.iter().map(row).collect();
    Table::new("What was drawn, as a Latin hypercube.", heads, rows)
}

fn words(distribution: &Distribution) -> String {
    match distribution {
        Distribution::Uniform([low, high]) => {
            format!("evenly from {} to {}", number(*low), number(*high))
        }
        Distribution::Normal {
            mean,
            standard_deviation,
            bounds: [low, high],
        } => {
            let bounds = [("at least", low), ("at most", high)].into_iter();
            let bounds = bounds.filter(|(_, bound)| bound.is_finite());
            let bounds: String = bounds
                .map(|(words, bound)| format!(", {words} {}", number(*bound)))
                .collect();
            let (mean, deviation) = (number(*mean), number(*standard_deviation));
            format!("normal, mean {mean}, standard deviation {deviation}{bounds}")
        }
    }
}
