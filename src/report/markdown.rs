//! The results as Markdown, for the text panel of a recording.
//!
//! Timing is left out, so that the same scenario gives the same text.

use super::rows::{ReportRow, comparison, rows, shown, tally};
use super::text::far_of;
use crate::metrics::{BoundCheck, ForceTenth, PassSummary, Summary, columns};
use crate::quantity::column;

/// The results of a run as Markdown, with the scenario's expectations first.
#[must_use]
pub fn markdown(title: &str, summary: &Summary, verdicts: &[BoundCheck]) -> String {
    let untimed = Summary {
        timing: None,
        ..summary.clone()
    };
    let mut out = format!("# {}\n", escape(title));
    if !verdicts.is_empty() {
        out.push_str(&format!("\n## {}\n\n", tally(verdicts)));
        expectations(&mut out, verdicts);
    }
    if let Some(far) = far_of(&untimed) {
        out.push_str(&format!("\n**{}**\n", escape(&far)));
    }
    let rows = rows(&untimed);
    for part in rows.chunk_by(|before, after| before.part() == after.part()) {
        results(&mut out, part);
    }
    passes(&mut out, &untimed.passes);
    tenths(&mut out, &untimed.force_by_tenth);
    out
}

/// Text in which nothing is taken for Markdown or for the end of a cell.
fn escape(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for letter in text.chars() {
        if letter.is_control() {
            out.push(' ');
            continue;
        }
        if "\\`*_[]<>|#~$&!".contains(letter) {
            out.push('\\');
        }
        out.push(letter);
    }
    out
}

fn row(out: &mut String, cells: &[&str]) {
    out.push_str(&format!("| {} |\n", cells.join(" | ")));
}

fn results(out: &mut String, part: &[ReportRow<Summary>]) {
    let Some(first) = part.first() else {
        return;
    };
    out.push('\n');
    row(out, &[first.part(), "value", "unit", ""]);
    row(out, &["---", "---:", "---", "---"]);
    for entry in part {
        let (label, note) = (escape(entry.metric.label), escape(&entry.note));
        row(out, &[&label, &escape(&entry.text()), entry.unit(), &note]);
    }
}

/// A row a pass, where there are several.
fn passes(out: &mut String, passes: &[PassSummary]) {
    if passes.len() < 2 {
        return;
    }
    out.push_str("\n## Passes\n\n");
    let columns = || columns::<PassSummary>();
    let names = columns().map(|(name, metric)| format!("{name}, {}", metric.unit));
    let heads: Vec<String> = std::iter::once("pass".to_owned()).chain(names).collect();
    row(out, &heads.iter().map(String::as_str).collect::<Vec<_>>());
    row(out, &vec!["---:"; columns().count() + 1]);
    for pass in passes {
        let values = columns().map(|(_, metric)| escape(&shown((metric.value)(pass), metric.unit)));
        let cells: Vec<String> = std::iter::once(pass.pass.to_string())
            .chain(values)
            .collect();
        row(out, &cells.iter().map(String::as_str).collect::<Vec<_>>());
    }
}

fn tenths(out: &mut String, tenths: &[ForceTenth]) {
    if tenths.is_empty() {
        return;
    }
    let column = |value: fn(&ForceTenth) -> Option<f64>| {
        column(&tenths.iter().map(value).collect::<Vec<_>>(), "N")
    };
    let means = column(|tenth| tenth.force_mean_n);
    let spreads = column(|tenth| tenth.force_standard_deviation_n);
    out.push_str("\n## Force along the path\n\n");
    row(out, &["from mm", "to mm", "mean N", "standard deviation N"]);
    row(out, &["---:", "---:", "---:", "---:"]);
    for ((tenth, mean), spread) in tenths.iter().zip(&means).zip(&spreads) {
        let [from, to] = [tenth.from_mm, tenth.to_mm].map(|end| tenth.end_text(end));
        row(out, &[&from, &to, mean, spread]);
    }
}

fn expectations(out: &mut String, verdicts: &[BoundCheck]) {
    row(out, &["", "expected", "value", "bound"]);
    row(out, &["---", "---", "---:", "---"]);
    for verdict in verdicts {
        let word = if verdict.kept { "ok" } else { "**OUTSIDE**" };
        let (value, bound) = comparison(verdict);
        row(out, &[word, &escape(&verdict.name()), &value, &bound]);
    }
}

#[cfg(test)]
mod tests {
    use super::super::test_summaries::{checked, nominal};
    use super::*;

    #[test]
    fn tables_are_rectangular_whatever_the_names() {
        let mut summary = nominal();
        summary.most_loaded_joint = Some("a|b\n*c*".into());
        let out = markdown("edge | 1\n# two", &summary, &checked(&summary));
        assert!(out.starts_with("# edge \\| 1 \\# two\n"), "{out}");
        let cells = |line: &str| line.replace("\\|", "").matches('|').count();
        for line in out.lines().filter(|line| line.starts_with('|')) {
            assert_eq!(cells(line), 5, "{line}");
        }
        assert!(out.contains("a\\|b \\*c\\*"));
        assert!(
            out.contains("| **OUTSIDE** | stroke\\_margin\\_mm |"),
            "{out}"
        );
    }

    #[test]
    fn it_does_not_depend_on_the_wall_clock() {
        let timed = nominal();
        let mut untimed = nominal();
        untimed.timing = None;
        assert!(timed.timing.is_some());
        assert_eq!(markdown("x", &timed, &[]), markdown("x", &untimed, &[]));
    }
}
