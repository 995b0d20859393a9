//! The results of a bench run: a table of the levels commanded, and its numbers.

use super::rows::{comparison, far_from_desired, printable, shown, tally};
use super::text::Style;
use crate::metrics::{BENCH_METRICS, BenchSummary, BoundCheck, LevelSummary, Metric, columns};
use crate::quantity::optional;

/// Letters of a column of the table of levels.
const LEVEL_WIDTH: usize = 10;

/// A level's values in the columns of the table.
fn values(level: &LevelSummary) -> Vec<String> {
    let value = |metric: &Metric<LevelSummary>| optional((metric.value)(level), metric.unit);
    columns().map(|(_, metric)| value(metric)).collect()
}

/// Metrics that have a value, the number of the timing only if it was timed.
fn rows(summary: &BenchSummary) -> impl Iterator<Item = (&'static Metric<BenchSummary>, f64)> {
    BENCH_METRICS
        .iter()
        .filter_map(|metric| (metric.value)(summary).map(|value| (metric, value)))
}

/// Remark on a force that is not the desired one.
fn far_of(summary: &BenchSummary) -> Option<String> {
    far_from_desired(
        summary.desired_force_n?,
        summary.force_mean_n?,
        summary.force_rms_error_percent?,
    )
}

/// The table for a terminal.
#[must_use]
pub fn bench_text(
    title: &str,
    summary: &BenchSummary,
    verdicts: &[BoundCheck],
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
            let cell = |text: &String| format!("{text:>LEVEL_WIDTH$}");
            texts.iter().map(cell).collect()
        };
        let names = columns::<LevelSummary>().map(|(name, _)| name.to_owned());
        line(style.faint(&cells(names.collect())));
        let units = columns::<LevelSummary>().map(|(_, metric)| format!("[{}]", metric.unit));
        line(style.faint(&cells(units.collect())));
        for level in &summary.levels {
            line(cells(values(level)));
        }
        line(rule.clone());
    }
    for (metric, value) in rows(summary) {
        line(format!(
            "{:<28} {:>10} {:<6}  {}",
            metric.label,
            shown(Some(value), metric.shown_unit()),
            metric.shown_unit(),
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
    if let Some(far) = far_of(summary) {
        line(style.verdict(false, &far));
    }
    out
}

/// The same as Markdown, without the timing, so that the same scenario gives the same text.
#[must_use]
pub fn bench_markdown(title: &str, summary: &BenchSummary, verdicts: &[BoundCheck]) -> String {
    let untimed = BenchSummary {
        timing: None,
        ..summary.clone()
    };
    let row = |cells: Vec<String>| format!("| {} |\n", cells.join(" | "));
    let mut out = format!("# {}\n\n", printable(title));
    if !verdicts.is_empty() {
        out.push_str(&format!("## {}\n\n", tally(verdicts)));
    }
    if let Some(far) = far_of(&untimed) {
        out.push_str(&format!("**{far}**\n\n"));
    }
    if !untimed.levels.is_empty() {
        let columns = || columns::<LevelSummary>();
        let headings = columns().map(|(name, metric)| format!("{name}, {}", metric.unit));
        out.push_str(&row(headings.collect()));
        out.push_str(&row(columns().map(|_| "---:".to_owned()).collect()));
        for level in &untimed.levels {
            out.push_str(&row(values(level)));
        }
        out.push('\n');
    }
    out.push_str("| | value | unit | |\n| --- | ---: | --- | --- |\n");
    for (metric, value) in rows(&untimed) {
        let cells = [
            metric.label,
            &shown(Some(value), metric.shown_unit()),
            metric.shown_unit(),
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
        assert!(out.lines().all(|line| line.chars().count() <= 88), "{out}");
        for part in ["set", "[bar]", "1.800", "290.0", "mean", "N"] {
            assert!(out.contains(part), "{part}");
        }
        assert!(!out.contains("overshoot"), "undefined numbers are left out");
        let page = bench_markdown("paper", &summary(), &[]);
        assert!(
            page.contains("| at, s | set, bar | outlet, bar |"),
            "{page}"
        );
        assert!(page.contains("| 0.500 | 1.800 |"), "{page}");
    }
}
