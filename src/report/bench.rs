//! The results of a bench run: a table of the levels commanded, and its numbers.

use super::number::{optional, printable, significant};
use super::rows::{DIGITS, comparison, tally};
use super::text::Style;
use crate::metrics::{BENCH_METRICS, BenchSummary, LevelSummary, Metric, Verdict};

/// Columns of the table of levels: heading, value.
type Column = (&'static str, fn(&LevelSummary) -> Option<f64>);

const LEVELS: [Column; 8] = [
    ("at s", |level| Some(level.start_s)),
    ("set bar", |level| Some(level.set_pressure_bar_gauge)),
    ("outlet bar", |level| {
        Some(level.regulator_pressure_bar_gauge)
    }),
    ("delay s", |level| level.regulator_delay_s),
    ("force N", |level| level.force_mean_n),
    ("read N", |level| level.measured_force_mean_n),
    ("settled s", |level| level.force_settling_time_s),
    ("stroke mm", |level| level.stroke_mm),
];

/// Metrics that have a value, the number of the timing only if it was timed.
fn rows(summary: &BenchSummary) -> impl Iterator<Item = (&'static Metric<BenchSummary>, f64)> {
    BENCH_METRICS
        .iter()
        .filter_map(|metric| (metric.value)(summary).map(|value| (metric, value)))
}

fn unit(metric: &Metric<BenchSummary>) -> &'static str {
    match metric.unit {
        "1" => "",
        unit => unit,
    }
}

/// The table for a terminal.
#[must_use]
pub fn bench_text(
    title: &str,
    summary: &BenchSummary,
    verdicts: &[Verdict],
    style: Style,
) -> String {
    let rule = style.faint(&"-".repeat(80));
    let mut out = format!("{}\n{rule}\n", style.heading(&printable(title)));
    let mut line = |text: String| {
        out.push_str(text.trim_end());
        out.push('\n');
    };
    if !summary.levels.is_empty() {
        let cells = |texts: Vec<String>| -> String {
            texts.iter().map(|text| format!("{text:>10}")).collect()
        };
        let headings = LEVELS.iter().map(|(name, _)| (*name).to_owned()).collect();
        line(style.faint(&cells(headings)));
        for level in &summary.levels {
            let values = LEVELS
                .iter()
                .map(|(_, value)| optional(value(level), DIGITS));
            line(cells(values.collect()));
        }
        line(rule.clone());
    }
    for (metric, value) in rows(summary) {
        line(format!(
            "{:<28} {:>10} {:<6}  {}",
            metric.label,
            significant(value, DIGITS),
            unit(metric),
            style.faint(metric.meaning),
        ));
    }
    if !verdicts.is_empty() {
        line(rule);
        for verdict in verdicts {
            let (value, bound) = comparison(verdict);
            let word = if verdict.kept { "ok" } else { "OUTSIDE" };
            let word = style.verdict(verdict.kept, &format!("{word:<7}"));
            line(format!("{word} {} {value}  {bound}", verdict.metric));
        }
        let kept = verdicts.iter().all(|verdict| verdict.kept);
        line(style.verdict(kept, &tally(verdicts)));
    }
    out
}

/// The same as Markdown, without the timing, so that the same scenario gives the same text.
#[must_use]
pub fn bench_markdown(title: &str, summary: &BenchSummary, verdicts: &[Verdict]) -> String {
    let untimed = BenchSummary {
        timing: None,
        ..summary.clone()
    };
    let row = |cells: Vec<String>| format!("| {} |\n", cells.join(" | "));
    let mut out = format!("# {}\n\n", printable(title));
    if !verdicts.is_empty() {
        out.push_str(&format!("## {}\n\n", tally(verdicts)));
    }
    if !untimed.levels.is_empty() {
        out.push_str(&row(LEVELS
            .iter()
            .map(|(name, _)| (*name).to_owned())
            .collect()));
        out.push_str(&row(LEVELS.iter().map(|_| "---:".to_owned()).collect()));
        for level in &untimed.levels {
            let values = LEVELS
                .iter()
                .map(|(_, value)| optional(value(level), DIGITS));
            out.push_str(&row(values.collect()));
        }
        out.push('\n');
    }
    out.push_str("| | value | unit | |\n| --- | ---: | --- | --- |\n");
    for (metric, value) in rows(&untimed) {
        let cells = [
            metric.label,
            &significant(value, DIGITS),
            unit(metric),
            metric.meaning,
        ];
        out.push_str(&row(cells.map(str::to_owned).to_vec()));
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    fn summary() -> BenchSummary {
        BenchSummary {
            force_mean_n: Some(290.0),
            duration_s: 6.0,
            levels: vec![LevelSummary {
                start_s: 0.5,
                set_pressure_bar_gauge: 1.8,
                regulator_pressure_bar_gauge: 1.8,
                regulator_delay_s: Some(1.0),
                force_mean_n: Some(290.0),
                force_standard_deviation_n: Some(0.1),
                measured_force_mean_n: None,
                force_settling_time_s: Some(2.4),
                force_overshoot_percent: Some(0.0),
                stroke_mm: Some(40.0),
            }],
            ..BenchSummary::default()
        }
    }

    #[test]
    fn it_fits_a_terminal_and_names_what_was_measured() {
        let out = bench_text("paper", &summary(), &[], Style::Plain);
        assert!(
            out.lines().all(|line| line.len() <= 88 && line.is_ascii()),
            "{out}"
        );
        for part in ["set bar", "1.800", "290.0", "mean", "N"] {
            assert!(out.contains(part), "{part}");
        }
        assert!(!out.contains("overshoot"), "undefined numbers are left out");
        let page = bench_markdown("paper", &summary(), &[]);
        assert!(page.contains("| 0.5000 | 1.800 |"), "{page}");
    }
}
