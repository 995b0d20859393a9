//! The rows of the reports: which metrics, in which parts, with what beside them.

use super::number::significant;
use crate::metrics::{ForceTenth, METRICS, Metric, Summary, Verdict};

/// Significant digits of a result; forces near the desired one differ in the fourth.
pub(super) const DIGITS: usize = 4;

/// Parts of a report and the metrics in each, by key.
const PARTS: [(&str, &[&str]); 5] = [
    (
        "Force",
        &[
            "force_mean_n",
            "force_standard_deviation_n",
            "coefficient_of_variation_percent",
            "largest_deviation_n",
            "within_5_percent_share_percent",
            "within_10_percent_share_percent",
            "loss_of_contact_share_percent",
        ],
    ),
    ("Touch", &["engagement_peak_n", "settling_time_s"]),
    ("Stroke", &["stroke_used_mm", "stroke_margin_mm"]),
    (
        "Path",
        &["path_length_mm", "path_error_rms_um", "path_error_max_um"],
    ),
    (
        "Run",
        &[
            "friction_force_mean_n",
            "joint_torque_share_percent",
            "air_mass_balance_relative",
            "duration_s",
            "real_time_factor",
        ],
    ),
];

/// One row: a metric, its value, and what a reader wants beside it.
pub(super) struct Row {
    /// Part of the report.
    pub(super) part: &'static str,
    /// The metric.
    pub(super) metric: &'static Metric,
    /// Its value in the metric's unit.
    pub(super) value: Option<f64>,
    /// Its meaning in short, or a fact that belongs to it.
    pub(super) note: String,
}

/// The rows in order.
pub(super) fn rows(summary: &Summary) -> Vec<Row> {
    let row = |part, name: &str| {
        let metric = METRICS.iter().find(|metric| metric.name == name)?;
        Some(Row {
            part,
            metric,
            value: (metric.value)(summary),
            note: fact(metric.name, summary).unwrap_or_else(|| metric.meaning.to_owned()),
        })
    };
    PARTS
        .iter()
        .flat_map(|&(part, names)| names.iter().filter_map(move |name| row(part, name)))
        .collect()
}

/// What says more beside a value than its meaning.
fn fact(name: &str, summary: &Summary) -> Option<String> {
    let short = |value| significant(value, DIGITS);
    Some(match name {
        "force_mean_n" => format!("desired {} N", short(summary.desired_force_n)),
        "engagement_peak_n" => match summary.engagement_overshoot_percent? {
            0.0 => "not above the desired force".to_owned(),
            over => format!("{} % above desired", significant(over, 3)),
        },
        "stroke_used_mm" => {
            let (least, greatest) = (summary.stroke_min_mm?, summary.stroke_max_mm?);
            format!("from {} to {} mm", short(least), short(greatest))
        }
        "path_length_mm" => format!("at {} mm/s on average", short(summary.feed_mean_mm_per_s?)),
        "joint_torque_share_percent" => {
            format!("of its limit, {}", summary.most_loaded_joint.as_ref()?)
        }
        "duration_s" => format!("following {} s of it", short(summary.follow_duration_s?)),
        "real_time_factor" => format!("computed in {} s", significant(summary.timing?.wall_time_s, 3)),
        _ => return None,
    })
}

/// Decimals that serve all tenths of the path alike: those of the finest spread.
pub(super) fn tenth_decimals(tenths: &[ForceTenth]) -> usize {
    let spread = tenths.iter().filter_map(|tenth| tenth.force_standard_deviation_n);
    let largest = spread.fold(0.0, f64::max);
    match largest {
        spread if spread >= 10.0 => 0,
        spread if spread >= 1.0 => 1,
        _ => 2,
    }
}

/// Value and bound of a verdict, with enough digits to tell them apart.
pub(super) fn comparison(verdict: &Verdict) -> (String, String) {
    let Some(value) = verdict.value else {
        return ("undefined".to_owned(), bound(verdict));
    };
    let bounds = [verdict.min, verdict.max].into_iter().flatten();
    let digits = (DIGITS..17)
        .find(|&digits| {
            let shown = significant(value, digits);
            bounds.clone().all(|bound| {
                let shown: f64 = shown.parse().unwrap_or(f64::NAN);
                value.total_cmp(&bound) == shown.total_cmp(&bound)
            })
        })
        .unwrap_or(17);
    (significant(value, digits), bound(verdict))
}

fn bound(verdict: &Verdict) -> String {
    match (verdict.min, verdict.max) {
        (Some(min), Some(max)) => format!("{min} to {max}"),
        (Some(min), None) => format!("at least {min}"),
        (None, Some(max)) => format!("at most {max}"),
        (None, None) => String::new(),
    }
}

/// How many expectations were kept, in one line.
pub(super) fn tally(verdicts: &[Verdict]) -> String {
    let kept = verdicts.iter().filter(|verdict| verdict.kept).count();
    format!("{kept} of {} expectations kept", verdicts.len())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::metrics::metric;

    #[test]
    fn every_row_names_a_metric() {
        for name in PARTS.iter().flat_map(|(_, names)| names.iter()) {
            assert!(metric(name).is_some(), "{name}");
        }
        let count: usize = PARTS.iter().map(|(_, names)| names.len()).sum();
        assert_eq!(rows(&Summary::default()).len(), count);
    }

    #[test]
    fn a_value_just_outside_does_not_look_like_its_bound() {
        let verdict = |value, kept| Verdict {
            metric: "force_mean_n",
            unit: "N",
            value,
            min: None,
            max: Some(1.0),
            kept,
        };
        let shown = |value, kept| comparison(&verdict(Some(value), kept)).0;
        assert_eq!(shown(0.5, true), "0.5000");
        assert_eq!(shown(1.0, true), "1.000");
        assert_eq!(shown(1.00000012, false), "1.0000001");
        assert_eq!(shown(0.99999, true), "0.99999");
        assert_eq!(
            comparison(&verdict(None, false)),
            ("undefined".to_owned(), "at most 1".to_owned())
        );
    }
}
