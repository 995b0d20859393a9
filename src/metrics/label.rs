//! Metrics for people: their names and units, and which matter most.

use super::{BENCH_METRICS, METRICS, Metric};

/// Numbers of a cell and of a bench, what matters most first; those that no run determines, and those for which there is no room, are left out.
const OF_CELL: [&str; 8] = [
    "force_mean_n",
    "coefficient_of_variation_percent",
    "largest_deviation_n",
    "engagement_peak_n",
    "stroke_margin_mm",
    "settling_time_s",
    "duration_s",
    "path_error_rms_um",
];
/// What a job that finishes an edge is for, before all that.
const OF_EDGE: [&str; 4] = [
    "chamfer_leg_mean_mm",
    "residual_burr_max_mm",
    "out_of_tolerance_share_percent",
    "duration_s",
];
/// The metric that only a finished edge has.
pub const FINISHED: &str = "chamfer_leg_mean_mm";
const OF_BENCH: [&str; 7] = [
    "force_mean_n",
    "coefficient_of_variation_percent",
    "force_rms_error_percent",
    "force_settling_time_s",
    "impact_peak_n",
    "stroke_margin_mm",
    "regulator_delay_s",
];

/// Metrics of a bench, or of a cell that finishes an edge or follows one, that matter most, the first ones most.
pub fn most_telling(is_bench: bool, is_finished: bool) -> Vec<&'static str> {
    if is_bench {
        return OF_BENCH.to_vec();
    }
    let edge = if is_finished { &OF_EDGE[..] } else { &[] };
    let others = OF_CELL.into_iter().filter(|name| !edge.contains(name));
    edge.iter().copied().chain(others).collect()
}

/// Names of the metrics of a kind of scenario.
pub fn metric_names(is_bench: bool) -> Vec<&'static str> {
    let names = labels(is_bench).into_iter().map(|label| label.key);
    names.collect()
}

/// A metric for people.
#[derive(Debug, Clone, PartialEq)]
pub struct Label {
    /// Key in summary.json.
    pub key: &'static str,
    /// Its name.
    pub name: String,
    /// Its unit; empty for a plain number.
    pub unit: &'static str,
    /// Its meaning.
    pub meaning: &'static str,
}

fn labelled<S>(metrics: &[Metric<S>]) -> Vec<Label> {
    let label = |metric: &Metric<S>| Label {
        key: metric.name,
        name: metric.full_label(),
        unit: metric.shown_unit(),
        meaning: metric.meaning,
    };
    metrics.iter().map(label).collect()
}

/// The metrics of benches, or of cells.
pub fn labels(of_bench: bool) -> Vec<Label> {
    if of_bench {
        labelled(BENCH_METRICS)
    } else {
        labelled(METRICS)
    }
}
