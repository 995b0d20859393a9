//! The result as a plain table for the terminal, in at most 80 columns; what is longer goes on below, and nothing is cut.

use std::fmt::Write;

use super::result::{ActiveBound, Candidate, Sensitivity, StudyResult};
use super::robustness::KeptShare;
use super::study::Study;
use super::variable::{Domain, Variable};
use crate::quantity::change as percent;
use crate::quantity::display_name::{number, symbol, with_unit};

const WIDTH: usize = 80;
/// Rows of the front that are printed; design.json has them all.
const FRONT_ROWS: usize = 10;
/// A step that would still lower the objective by more than this [%] is pointed out.
const LEAST_PROGRESS: f64 = 0.5;

/// The table.
#[must_use]
pub fn text(study: &Study, result: &StudyResult) -> String {
    let mut out = String::new();
    line(&mut out, &result.title.replace(char::is_control, " "));
    line(&mut out, &"-".repeat(WIDTH));
    variables(&mut out, study, result);
    metrics(&mut out, study, result);
    limits(&mut out, result);
    binding(&mut out, result);
    steps(&mut out, result);
    front(&mut out, result);
    robustness(&mut out, result);
    search(&mut out, result);
    out
}

/// A line; one that is too long goes on below between words, further in.
fn line(out: &mut String, text: &str) {
    let text = text.trim_end();
    let indent = text.len() - text.trim_start().len();
    let mut left = text;
    let mut before = String::new();
    while before.chars().count() + left.chars().count() > WIDTH {
        let room = WIDTH - before.chars().count();
        let first = left.len() - left.trim_start().len();
        let letters = left.char_indices().enumerate();
        let mut gaps = letters.filter(|(_, (at, letter))| *letter == ' ' && *at > first);
        let mut last = None;
        // A word that is longer than a line stands on one of its own.
        let beyond = gaps.find_map(|(place, (at, _))| match place <= room {
            true => {
                last = Some(at);
                None
            }
            false => Some(at),
        });
        let Some(at) = last.or(beyond) else {
            break;
        };
        out.push_str(before.as_str());
        out.push_str(left[..at].trim_end());
        out.push('\n');
        left = left[at..].trim_start();
        before = " ".repeat(indent + 4);
    }
    out.push_str(&before);
    out.push_str(left);
    out.push('\n');
}

fn heading(out: &mut String, name: &str, columns: &str) {
    out.push('\n');
    named_line(out, name, 35, columns);
}

fn columns(names: [&str; 2], last: &str) -> String {
    format!("{:>10} {:>10}  {last}", names[0], names[1])
}

fn row(out: &mut String, name: &str, values: [String; 2], last: &str) {
    let columns = columns([&values[0], &values[1]], last);
    named_line(out, &format!("  {name}"), 35, &columns);
}

/// A name in a column of a width with the others beside it; below it, where it is wider.
fn named_line(out: &mut String, name: &str, width: usize, others: &str) {
    if name.chars().count() < width || others.trim().is_empty() {
        line(out, &format!("{name:<width$}{others}"));
    } else {
        line(out, name);
        line(out, &format!("{:<width$}{others}", ""));
    }
}

fn variables(out: &mut String, study: &Study, result: &StudyResult) {
    heading(out, "Variables", &columns(["start", "chosen"], "bounds"));
    for (key, chosen) in result.chosen.design.iter() {
        let start = result
            .start
            .design
            .get(key)
            .map_or_else(String::new, number);
        let variable = study.variables.iter().find(|variable| variable.key == key);
        let last =
            variable.map_or_else(|| "follows".to_owned(), |variable| bounds(variable, result));
        row(out, key, [start, number(chosen)], &last);
    }
}

fn bounds(variable: &Variable, result: &StudyResult) -> String {
    let active = result
        .active_bounds
        .iter()
        .find(|bound| bound.variable == variable.key);
    if let Some(bound) = active {
        return format!(
            "AT ITS {} {}",
            bound.side.to_uppercase(),
            number(bound.bound)
        );
    }
    let [min, max] = variable.domain.ends().map(number);
    match variable.domain {
        Domain::Catalogue(_) => format!("{min} .. {max}"),
        _ => format!("{min} to {max}"),
    }
}

/// Those that the study names; design.json has them all.
fn metrics(out: &mut String, study: &Study, result: &StudyResult) {
    let names = &result.objectives;
    let title = match names.scenarios {
        1 => "Objective".to_owned(),
        count => format!("Objective, {} of {count} scenarios", names.minimised_over),
    };
    heading(out, &title, &columns(["start", "chosen"], "change"));
    compared(
        out,
        &names.minimised,
        [result.start.objective, result.chosen.objective],
    );
    for scenario in &result.chosen.scenarios {
        let find = |candidate: &Candidate, metric: &str| {
            let found = candidate.scenarios.iter().find(|s| s.name == scenario.name);
            found.and_then(|found| found.metrics.get(metric).copied())
        };
        heading(
            out,
            &format!("In {}", scenario.name.replace(char::is_control, " ")),
            "",
        );
        for (metric, chosen) in scenario
            .metrics
            .iter()
            .filter(|(metric, _)| named(study, metric))
        {
            let start = find(&result.start, metric).unwrap_or(f64::NAN);
            compared(out, metric, [start, *chosen]);
        }
    }
}

fn named(study: &Study, metric: &str) -> bool {
    study.locations.iter().any(|(_, named, _)| named == metric)
}

fn compared(out: &mut String, metric: &str, [start, chosen]: [f64; 2]) {
    let change = 100.0 * (chosen - start) / start.abs();
    let change = match change.is_finite() {
        true => percent(change),
        false => String::new(),
    };
    let shown = |value: f64| {
        if value.is_nan() {
            "-".to_owned()
        } else {
            number(value)
        }
    };
    row(out, metric, [shown(start), shown(chosen)], &change);
}

fn limits(out: &mut String, result: &StudyResult) {
    if result.chosen.limits.is_empty() {
        return;
    }
    heading(out, "Limits", &columns(["start", "chosen"], ""));
    for (before, after) in result.start.limits.iter().zip(&result.chosen.limits) {
        let last = match (before.kept, after.active) {
            (true, true) => "JUST KEPT",
            (false, true) => "JUST KEPT, was broken",
            (false, false) => "was broken",
            (true, false) => "",
        };
        row(
            out,
            &after.limit,
            [number(before.value), number(after.value)],
            last,
        );
    }
}

fn direction(change: f64) -> String {
    if change.abs() < 0.05 {
        return "no difference".to_owned();
    }
    let size = percent(change.abs()).replace('+', "");
    if change < 0.0 {
        format!("lower by {size}")
    } else {
        format!("higher by {size}")
    }
}

/// The quantity past a bound.
fn past(bound: &ActiveBound, result: &StudyResult) -> String {
    let beyond = |step: &&Sensitivity| step.variable == bound.variable && step.beyond_bound;
    match bound.objective_change_percent {
        Some(change) => format!("beyond it: {}", direction(change)),
        None if result.sensitivities.iter().any(|step| beyond(&step)) => {
            "beyond it: cannot be simulated".to_owned()
        }
        None => "its catalogue ends there".to_owned(),
    }
}

/// Active bounds, in sentences.
fn binding(out: &mut String, result: &StudyResult) {
    let metric = &result.objectives.minimised;
    out.push('\n');
    line(
        out,
        &format!("What binds, and what more room would do to {metric}"),
    );
    let mut any = false;
    for bound in &result.active_bounds {
        let beyond = format!(
            "bound {} {} {}",
            bound.variable,
            bound.side,
            number(bound.bound)
        );
        named_line(out, &format!("  {beyond}"), 49, &past(bound, result));
        any = true;
    }
    for limit in &result.active_limits {
        let effect = limit
            .objective_change_percent
            .map_or_else(|| "not found".to_owned(), direction);
        let name = format!("limit {}", limit.limit);
        let looser = format!("at {} {}: {effect}", number(limit.loosened_to), limit.unit);
        named_line(out, &format!("  {name}"), 49, &looser.replace(" : ", ": "));
        any = true;
    }
    if !any {
        line(out, "  nothing: neither a bound nor a limit");
    }
}

fn steps(out: &mut String, result: &StudyResult) {
    heading(
        out,
        "One variable alone",
        &columns(["to", "objective"], "limits"),
    );
    for step in &result.sensitivities {
        let name = format!(
            "{} {}",
            step.variable,
            percent(step.change_percent).replace(' ', "")
        );
        let objective = step
            .objective_change_percent
            .map_or_else(|| "-".to_owned(), percent);
        row(out, &name, [number(step.value), objective], &remark(step));
    }
    if let Some(step) = result.improving_steps(LEAST_PROGRESS).next() {
        let hint = format!(
            "  {} alone would still lower it: more evaluations would help.",
            step.variable
        );
        line(out, &hint);
    }
}

fn remark(step: &Sensitivity) -> String {
    if step.failure.is_some() {
        return "not possible".to_owned();
    }
    match (step.breaks.first(), step.beyond_bound) {
        (Some(first), _) => format!("breaks {first}"),
        (None, true) => "beyond its bound".to_owned(),
        (None, false) => String::new(),
    }
}

fn front(out: &mut String, result: &StudyResult) {
    let Some(trade_off) = &result.objectives.trade_off else {
        return;
    };
    out.push('\n');
    line(
        out,
        &format!("Front: {} against {trade_off}", result.objectives.minimised),
    );
    let count = result.front.len();
    let rows = count.min(FRONT_ROWS);
    for i in 0..rows {
        let point = &result.front[if rows > 1 {
            i * (count - 1) / (rows - 1)
        } else {
            0
        }];
        let values = [
            (trade_off, point.trade_off),
            (&result.objectives.minimised, point.objective),
        ];
        let [x, y] = values.map(|(key, value)| with_unit(key, value));
        line(out, &format!("  {x:>16} {y:>16}"));
    }
    if count > rows {
        line(out, &format!("  ({rows} of {count} points)"));
    }
}

/// How robust the chosen design is.
fn robustness(out: &mut String, result: &StudyResult) {
    let Some(robustness) = &result.robustness else {
        return;
    };
    out.push('\n');
    let title = format!("Robustness: {} draws at the chosen design", robustness.runs);
    line(out, &format!("{title:<48} {:>7}  95 % interval", "keep"));
    shared(out, "all limits", &robustness.all_limits);
    for limit in &robustness.limits {
        shared(out, &limit.limit, &limit.share);
    }
    heading(
        out,
        "Quantiles of the draws",
        &columns(["5 %", "50 %"], "95 %"),
    );
    for told in &robustness.quantiles {
        let ends = [told.percent_5, told.percent_50].map(number);
        row(out, &told.metric, ends, &number(told.percent_95));
    }
    for (reason, count) in &robustness.failed {
        line(out, &format!("  {count:>6}  {reason}"));
    }
}

fn shared(out: &mut String, name: &str, share: &KeptShare) {
    let [low, high] = share.interval_percent;
    let told = format!("{:>5.0} %  {low:.0} to {high:.0} %", share.share_percent);
    named_line(out, &format!("  {name}"), 49, &told);
}

fn search(out: &mut String, result: &StudyResult) {
    let infeasible: usize = result.infeasible.values().sum();
    out.push('\n');
    line(
        out,
        &format!(
            "{} designs evaluated, {infeasible} of them not feasible",
            result.evaluations
        ),
    );
    for (reason, count) in &result.infeasible {
        line(out, &format!("  {count:>6}  {reason}"));
    }
    let [low, high] = result.chosen.force_range;
    let unit = symbol("force_n");
    // Writing to a String cannot fail.
    let _ = writeln!(
        out,
        "Force at rest: {} to {} {unit}",
        number(low),
        number(high)
    );
}
