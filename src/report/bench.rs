//! The results of a bench run: a table of the levels commanded, and its numbers.

use super::rows::{comparison, far_from_desired, printable, shown, tally};
use super::text::Style;
use crate::metrics::{BENCH_METRICS, BenchSummary, BoundCheck, LevelSummary, Metric};
use crate::quantity::optional;

/// A column of the table of levels.
pub struct LevelColumn {
    /// Its heading.
    pub name: &'static str,
    /// Its unit.
    pub unit: &'static str,
    /// A level's value in that unit.
    pub value: fn(&LevelSummary) -> Option<f64>,
}

const fn column(
    name: &'static str,
    unit: &'static str,
    value: fn(&LevelSummary) -> Option<f64>,
) -> LevelColumn {
    LevelColumn { name, unit, value }
}

/// Columns on each command, in a row.
#[rustfmt::skip]
pub const LEVELS: [LevelColumn; 8] = [
    column("at", "s", |level| Some(level.start_s)),
    column("set", "bar", |level| Some(level.set_pressure_bar_gauge)),
    column("outlet", "bar", |level| Some(level.regulator_pressure_bar_gauge)),
    column("delay", "s", |level| level.regulator_delay_s),
    column("force", "N", |level| level.force_mean_n),
    column("read", "N", |level| level.measured_force_mean_n),
    column("settled", "s", |level| level.force_settling_time_s),
    column("stroke", "mm", |level| level.stroke_mm),
];
/// Letters of a column of the table of levels.
const LEVEL_WIDTH: usize = 10;

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
        let names = LEVELS.iter().map(|column| column.name.to_owned());
        line(style.faint(&cells(names.collect())));
        let units = LEVELS.iter().map(|column| format!("[{}]", column.unit));
        line(style.faint(&cells(units.collect())));
        for level in &summary.levels {
            let value = |column: &LevelColumn| optional((column.value)(level), column.unit);
            line(cells(LEVELS.iter().map(value).collect()));
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
        let heading = |column: &LevelColumn| format!("{}, {}", column.name, column.unit);
        out.push_str(&row(LEVELS.iter().map(heading).collect()));
        out.push_str(&row(LEVELS.iter().map(|_| "---:".to_owned()).collect()));
        for level in &untimed.levels {
            let value = |column: &LevelColumn| optional((column.value)(level), column.unit);
            out.push_str(&row(LEVELS.iter().map(value).collect()));
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
