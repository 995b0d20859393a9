//! The table that a user sees after a run, in at most 80 columns.

use std::fmt::Write;

use super::rows::{ReportRow, comparison, far_from_desired, printable, rows, shown, tally};
use crate::metrics::{BoundCheck, ForceTenth, Metric, PassSummary, Summary, columns};
use crate::quantity::{UNKNOWN, column};

const WIDTH: usize = 80;

/// Style of the table.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Style {
    /// Without colours, for files and pipes.
    #[default]
    Plain,
    /// With ANSI colours, for a terminal.
    Coloured,
}

impl Style {
    fn paint(self, code: &str, text: &str) -> String {
        match self {
            Self::Plain => text.to_owned(),
            Self::Coloured => format!("\x1b[{code}m{text}\x1b[0m"),
        }
    }

    pub(super) fn heading(self, text: &str) -> String {
        self.paint("1", text)
    }

    pub(super) fn faint(self, text: &str) -> String {
        self.paint("2", text)
    }

    pub(super) fn verdict(self, kept: bool, text: &str) -> String {
        self.paint(if kept { "32" } else { "1;31" }, text)
    }
}

/// The results of a run as a table, with the scenario's expectations below it.
#[must_use]
pub fn text(title: &str, summary: &Summary, verdicts: &[BoundCheck], style: Style) -> String {
    let rule = style.faint(&"-".repeat(WIDTH));
    let mut out = format!("{}\n{rule}\n", style.heading(&printable(title)));
    let rows = rows(summary);
    let mut part = "";
    for row in &rows {
        let opening = if row.part() == part { "" } else { row.part() };
        part = row.part();
        line(&mut out, opening, row, style);
    }
    tenths(&mut out, &summary.force_by_tenth, style);
    passes(&mut out, &summary.passes, style);
    if rows.iter().any(|row| row.value.is_none()) {
        let note = format!("{UNKNOWN} not determined by this run; see docs/METRICS.md");
        push(&mut out, &style.faint(&note));
    }
    if !verdicts.is_empty() {
        push(&mut out, &rule);
        expectations(&mut out, verdicts, style);
    }
    if let Some(far) = far_of(summary) {
        push(&mut out, &style.verdict(false, &far));
    }
    out
}

/// Remark on a force that is not the desired one.
pub(super) fn far_of(summary: &Summary) -> Option<String> {
    far_from_desired(
        summary.desired_force_n,
        summary.force_mean_n?,
        summary.force_rms_error_percent?,
    )
}

fn push(out: &mut String, line: &str) {
    out.push_str(line.trim_end());
    out.push('\n');
}

fn line(out: &mut String, opening: &str, row: &ReportRow<Summary>, style: Style) {
    let text = format!(
        "{} {:<24} {:>9} {:<4}  {}",
        style.heading(&format!("{opening:<7}")),
        row.metric.label,
        row.text(),
        row.unit(),
        style.faint(&row.note),
    );
    push(out, &text);
}

fn tenths(out: &mut String, tenths: &[ForceTenth], style: Style) {
    if tenths.is_empty() {
        return;
    }
    let cells =
        |texts: Vec<String>| -> String { texts.iter().map(|text| format!("{text:>7}")).collect() };
    let column = |value: fn(&ForceTenth) -> Option<f64>| {
        cells(column(&tenths.iter().map(value).collect::<Vec<_>>(), "N"))
    };
    let ends = cells(
        tenths
            .iter()
            .map(|tenth| tenth.end_text(tenth.to_mm))
            .collect(),
    );
    let means = column(|tenth| tenth.force_mean_n);
    let spreads = column(|tenth| tenth.force_standard_deviation_n);
    let name = |name: &str| style.heading(&format!("{name:<7}"));
    push(out, &format!("{}{}", name("To mm"), style.faint(&ends)));
    push(out, &format!("{}{means}", name("Mean N")));
    push(out, &format!("{}{spreads}", name("SD N")));
}

/// A row a pass, where there are several: the numbers above are those of the first.
fn passes(out: &mut String, passes: &[PassSummary], style: Style) {
    if passes.len() < 2 {
        return;
    }
    let cells =
        |texts: Vec<String>| -> String { texts.iter().map(|text| format!("{text:>10}")).collect() };
    let heads = |text: fn(&'static str, &Metric<PassSummary>) -> &'static str| {
        let texts = columns().map(|(name, metric)| text(name, metric).to_owned());
        style.faint(&cells(texts.collect()))
    };
    let names = heads(|name, _| name);
    push(out, &format!("{}{names}", style.heading("Pass   ")));
    let units = heads(|_, metric| metric.unit);
    push(out, &format!("{:<7}{units}", ""));
    for pass in passes {
        let value = |metric: &Metric<PassSummary>| shown((metric.value)(pass), metric.unit);
        let texts = columns().map(|(_, metric)| value(metric)).collect();
        push(out, &format!("{:<7}{}", pass.pass, cells(texts)));
    }
}

fn expectations(out: &mut String, verdicts: &[BoundCheck], style: Style) {
    let lines: Vec<(&BoundCheck, String, String)> = verdicts
        .iter()
        .map(|verdict| {
            let (value, bound) = comparison(verdict);
            (verdict, value, bound)
        })
        .collect();
    let name_width = verdicts
        .iter()
        .map(|verdict| verdict.name().len())
        .max()
        .unwrap_or_default();
    let value_width = widest(lines.iter().map(|(_, value, _)| value.as_str()));
    for (verdict, value, bound) in &lines {
        let word = if verdict.kept { "ok" } else { "OUTSIDE" };
        let word = style.verdict(verdict.kept, &format!("{word:<7}"));
        let name = verdict.name();
        let text = format!("{word} {name:<name_width$} {value:>value_width$}  {bound}");
        push(out, &text);
    }
    let kept = verdicts.iter().all(|verdict| verdict.kept);
    // Writing to a String cannot fail.
    let _ = writeln!(out, "{}", style.verdict(kept, &tally(verdicts)));
}

fn widest<'a>(texts: impl Iterator<Item = &'a str>) -> usize {
    texts.map(str::len).max().unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::super::test_summaries::{checked, nominal};
    use super::*;

    #[test]
    fn it_fits_a_terminal() {
        for summary in [nominal(), Summary::default()] {
            let out = text("plate edge", &summary, &checked(&summary), Style::Plain);
            for line in out.lines() {
                let columns = line.chars().count();
                let far = line.contains("the desired force: ");
                assert!(columns <= WIDTH || far, "{columns} columns: {line}");
                let plain = |letter: char| {
                    (' '..='~').contains(&letter) || "µ±–·⁻⁰¹²³⁴⁵⁶⁷⁸⁹".contains(letter)
                };
                assert!(line.chars().all(plain), "{line}");
                assert_eq!(line, line.trim_end());
            }
        }
    }

    #[test]
    fn colours_change_nothing_but_the_colours() {
        let summary = nominal();
        let verdicts = checked(&summary);
        let mut coloured = text("plate edge", &summary, &verdicts, Style::Coloured);
        for code in ["1", "2", "32", "1;31", "0"] {
            coloured = coloured.replace(&format!("\x1b[{code}m"), "");
        }
        let bare = |text: &str| {
            text.lines()
                .map(|l| l.trim_end().to_owned())
                .collect::<Vec<_>>()
        };
        let plain = text("plate edge", &summary, &verdicts, Style::Plain);
        assert_eq!(bare(&coloured), bare(&plain));
    }

    #[test]
    fn numbers_stand_in_their_rows() {
        let summary = nominal();
        let out = text("plate edge", &summary, &checked(&summary), Style::Plain);
        let line = |part: &str| {
            out.lines()
                .find(|line| line.contains(part))
                .unwrap_or_default()
        };
        for (label, parts) in [
            ("Force   mean", ["320.1 N", "desired 320.0 N (<0.1 %)"]),
            (
                "coefficient of variation  ",
                ["0.312 %", "standard deviation / mean"],
            ),
            (
                "joint torque / limit",
                ["61.20 %", "largest, at shoulder_lift_joint"],
            ),
            ("real-time factor", ["25.00", "computed in 0.480 s"]),
            ("OUTSIDE", ["stroke_margin_mm", "at least 22"]),
            ("1 of 2", ["bounds", "kept"]),
        ] {
            for part in parts {
                assert!(line(label).contains(part), "{part} in: {}", line(label));
            }
        }
        assert!(!out.contains("not determined"));
    }

    #[test]
    fn a_force_far_from_the_desired_one_is_said_below_bounds_that_are_kept() {
        let mut summary = nominal();
        assert!(!text("x", &summary, &[], Style::Plain).contains("the desired force:"));
        summary.force_mean_n = Some(800.0);
        summary.force_rms_error_percent = Some(150.0);
        let out = text("x", &summary, &[], Style::Plain);
        let last = out.lines().last().unwrap_or_default();
        assert!(last.starts_with("Far from the desired force"), "{out}");
    }

    #[test]
    fn several_passes_have_a_row_each_and_one_has_none() {
        let mut summary = nominal();
        let pass = |pass, mean| PassSummary {
            pass,
            desired_force_n: 40.0,
            force_mean_n: Some(mean),
            within_5_percent_share_percent: Some(99.996),
            ..PassSummary::default()
        };
        summary.passes = vec![pass(1, 40.1)];
        assert!(!text("x", &summary, &[], Style::Plain).contains("Pass"));
        summary.passes.push(pass(2, 39.2));
        let out = text("x", &summary, &[], Style::Plain);
        let second = out
            .lines()
            .find(|line| line.starts_with("2 "))
            .unwrap_or_default();
        let cells: Vec<&str> = second.split_whitespace().collect();
        assert_eq!(cells[..3], ["2", "40.00", "39.20"]);
        assert!(cells.contains(&"<100"), "{second}");
        assert!(out.lines().all(|line| line.chars().count() <= WIDTH));
    }

    #[test]
    fn what_is_undefined_is_a_dash_and_explained() {
        let out = text("plate edge", &Summary::default(), &[], Style::Plain);
        let peak = out
            .lines()
            .find(|line| line.contains("peak"))
            .unwrap_or_default();
        assert!(peak.contains(" – N"), "{peak}");
        assert!(out.contains("– not determined by this run"));
    }
}
