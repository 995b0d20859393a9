//! The rows of the reports: which metrics, in which parts, with what beside them.

use super::number::{UNDEFINED, optional, printable, significant};
use crate::metrics::{Metric, Summary, Verdict, metric};

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

impl Row {
    /// The value as it is printed.
    pub(super) fn text(&self) -> String {
        match self.value {
            // A share that falls short must not read as the whole.
            Some(value) if self.metric.unit == "%" && (99.995..100.0).contains(&value) => {
                "<100".to_owned()
            }
            value => optional(value, DIGITS),
        }
    }

    /// The unit as it is printed; nothing for a pure number.
    pub(super) fn unit(&self) -> &'static str {
        match self.metric.unit {
            "1" => "",
            unit => unit,
        }
    }
}

/// The rows in order; without that of the timing if there is none.
pub(super) fn rows(summary: &Summary) -> Vec<Row> {
    let row = |part, name: &str| {
        if name == "real_time_factor" && summary.timing.is_none() {
            return None;
        }
        let metric = metric(name)?;
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
            format!(
                "largest, at {}",
                printable(summary.most_loaded_joint.as_ref()?)
            )
        }
        "duration_s" => format!("following {} s of it", short(summary.follow_duration_s?)),
        "real_time_factor" => format!(
            "computed in {} s",
            significant(summary.timing?.wall_time_s, 3)
        ),
        _ => return None,
    })
}

/// Values as texts of one precision, five digits for the largest of them and at most three decimals.
pub(super) fn alike(values: &[Option<f64>]) -> Vec<String> {
    let largest = values
        .iter()
        .flatten()
        .fold(0.0, |most: f64, value| most.max(value.abs()));
    let decimals = match largest {
        largest if largest < 100.0 => 3,
        largest if largest < 1000.0 => 2,
        largest if largest < 10_000.0 => 1,
        _ => 0,
    };
    let text = |value: &Option<f64>| match value {
        Some(value) => format!("{value:.decimals$}"),
        None => UNDEFINED.to_owned(),
    };
    values.iter().map(text).collect()
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
    use crate::metrics::Timing;

    #[test]
    fn every_row_names_a_metric() {
        for name in PARTS.iter().flat_map(|(_, names)| names.iter()) {
            assert!(metric(name).is_some(), "{name}");
        }
        let count: usize = PARTS.iter().map(|(_, names)| names.len()).sum();
        let untimed = Summary::default();
        let timed = Summary {
            timing: Some(Timing::new(1.0, 1.0)),
            ..Summary::default()
        };
        assert_eq!(
            (rows(&untimed).len(), rows(&timed).len()),
            (count - 1, count)
        );
    }

    #[test]
    fn a_share_that_falls_short_does_not_read_as_the_whole() {
        let shown = |share| {
            let summary = Summary {
                within_5_percent_share_percent: Some(share),
                ..Summary::default()
            };
            let rows = rows(&summary);
            let row = rows
                .iter()
                .find(|row| row.metric.label == "within 5 % of desired");
            row.map(Row::text)
        };
        assert_eq!(shown(99.94).as_deref(), Some("99.94"));
        assert_eq!(shown(99.996).as_deref(), Some("<100"));
        assert_eq!(shown(100.0).as_deref(), Some("100.0"));
    }

    #[test]
    fn neighbours_have_the_same_decimals() {
        assert_eq!(
            alike(&[Some(320.0), Some(5.125), None]),
            ["320.00", "5.12", "-"]
        );
        assert_eq!(alike(&[Some(0.25)]), ["0.250"]);
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
