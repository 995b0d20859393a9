//! The rows of the reports: which metrics, in which parts, with what beside them.

use crate::metrics::{
    BoundCheck, JointTorqueShare, Metric, NARROW_BAND, PassSummary, Summary, WIDE_BAND, metric,
};
use crate::quantity::{self, DIGITS, change, significant, with_unit};

/// Metrics that only a run with a tool that turns has.
const OF_A_TURNING_TOOL: [&str; 12] = [
    "burr_before_max_mm",
    "residual_burr_max_mm",
    "chamfer_leg_mean_mm",
    "chamfer_leg_standard_deviation_mm",
    "out_of_tolerance_share_percent",
    "ends_out_of_tolerance_share_percent",
    "ends_chamfer_leg_max_mm",
    "ends_residual_burr_max_mm",
    "section_variation_percent",
    "removed_volume_mm3",
    "spindle_power_max_w",
    "tool_wear_kj",
];

/// Parts of a report and the metrics in each, by key: what the job is for, then how it was done.
const PARTS: [(&str, &[&str]); 8] = [
    ("Edge", &OF_A_TURNING_TOOL),
    ("Time", &["duration_s"]),
    (
        "Force",
        &[
            "force_mean_n",
            "force_standard_deviation_n",
            "coefficient_of_variation_percent",
            "force_rms_error_n",
            "largest_deviation_n",
            "within_5_percent_share_percent",
            "within_10_percent_share_percent",
            "loss_of_contact_share_percent",
        ],
    ),
    (
        "Peaks",
        &[
            "force_peak_approach_n",
            "force_peak_engage_n",
            "force_peak_follow_n",
            "force_peak_retract_n",
        ],
    ),
    ("Touch", &["engagement_peak_n", "settling_time_s"]),
    ("Stroke", &["stroke_used_mm", "stroke_margin_mm"]),
    (
        "Path",
        &[
            "path_length_mm",
            "path_error_rms_um",
            "path_error_max_um",
            "path_lag_rms_um",
            "path_lag_max_um",
        ],
    ),
    (
        "Run",
        &[
            "friction_force_mean_n",
            "joint_torque_share_percent",
            "drives_saturated_s",
            "air_mass_balance_relative",
            "real_time_factor",
        ],
    ),
];

/// One row: a metric, its value, and what a reader wants beside it.
pub(super) struct ReportRow {
    /// Part of the report.
    pub(super) part: &'static str,
    /// The metric.
    pub(super) metric: &'static Metric<Summary>,
    /// Its value in the metric's unit.
    pub(super) value: Option<f64>,
    /// Its meaning in short, or a fact that belongs to it.
    pub(super) note: String,
}

impl ReportRow {
    /// The value as it is printed.
    pub(super) fn text(&self) -> String {
        shown(self.value, self.unit())
    }

    /// The unit as it is printed; nothing for a pure number.
    pub(super) fn unit(&self) -> &'static str {
        self.metric.shown_unit()
    }
}

/// A metric's value in its unit as it is printed.
#[must_use]
pub fn shown(value: Option<f64>, unit: &str) -> String {
    match value {
        // A share that falls short must not read as the whole.
        Some(value) if unit == "%" && (99.995..100.0).contains(&value) => "<100".to_owned(),
        value => quantity::optional(value, unit),
    }
}

/// Remark where a force is far from the desired one, however its bounds are; none within 5 % of it.
#[must_use]
pub fn far_from_desired(desired: f64, mean: f64, rms_error_percent: f64) -> Option<String> {
    if rms_error_percent <= 100.0 * NARROW_BAND {
        return None;
    }
    let off = 100.0 * (mean - desired) / desired;
    Some(format!(
        "{} the desired force: {} desired, {} on average ({}), RMS error {}",
        match rms_error_percent <= 100.0 * WIDE_BAND {
            true => "Off",
            false => "Far from",
        },
        with_unit(desired, "N"),
        with_unit(mean, "N"),
        change(off),
        with_unit(rms_error_percent, "%")
    ))
}

/// The rows in order; without that of the timing if there is none.
pub(super) fn rows(summary: &Summary) -> Vec<ReportRow> {
    let row = |part, name: &str| {
        if name == "real_time_factor" && summary.timing.is_none() {
            return None;
        }
        if OF_A_TURNING_TOOL.contains(&name) && summary.tool_wear_kj.is_none() {
            return None;
        }
        let metric = metric(name)?;
        Some(ReportRow {
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

/// Note beside a value that says more than its meaning.
fn fact(name: &str, summary: &Summary) -> Option<String> {
    let of = |value, unit| with_unit(value, unit);
    Some(match name {
        "force_mean_n" => {
            let desired = summary.desired_force_n;
            let off = 100.0 * (summary.force_mean_n? - desired) / desired;
            format!("desired {} ({})", of(desired, "N"), change(off))
        }
        "force_rms_error_n" => format!(
            "{} of the desired force",
            of(summary.force_rms_error_percent?, "%")
        ),
        "engagement_peak_n" => match summary.engagement_overshoot_percent? {
            0.0 => "not above the desired force".to_owned(),
            over => format!("{} above desired", of(over, "%")),
        },
        "chamfer_leg_mean_mm" => {
            let (least, most) = (summary.chamfer_leg_min_mm?, summary.chamfer_leg_max_mm?);
            let least = quantity::number(least, "mm");
            format!("from {least} to {}", of(most, "mm"))
        }
        "residual_burr_max_mm" => {
            let share = of(summary.residual_burr_share_percent?, "%");
            format!("too much of it on {share}")
        }
        "removed_volume_mm3" => {
            let rate = of(summary.removal_rate_mean_mm3_per_s?, "mm3/s");
            format!("at {rate} while cutting")
        }
        "stroke_used_mm" => {
            let (least, greatest) = (summary.stroke_min_mm?, summary.stroke_max_mm?);
            let least = quantity::number(least, "mm");
            format!("from {least} to {}", of(greatest, "mm"))
        }
        "path_length_mm" => {
            format!("at {} on average", of(summary.feed_mean_mm_per_s?, "mm/s"))
        }
        "joint_torque_share_percent" => {
            format!(
                "largest, at {}",
                printable(summary.most_loaded_joint.as_ref()?)
            )
        }
        "drives_saturated_s" => {
            let first = summary
                .joints
                .iter()
                .filter_map(|joint| Some((joint, joint.saturated_from_s?)));
            let (joint, from) = first.min_by(|a, b| a.1.total_cmp(&b.1))?;
            format!("{}, {}", printable(&joint.joint), of(from, "s"))
        }
        "force_peak_follow_n" if summary.passes.len() > 1 => "of the first pass".to_owned(),
        "out_of_tolerance_share_percent" => format!(
            "with its ends {}",
            of(summary.whole_edge_out_of_tolerance_share_percent?, "%")
        ),
        "ends_out_of_tolerance_share_percent" => {
            format!("{} at either end", of(summary.ends_length_mm?, "mm"))
        }
        "ends_chamfer_leg_max_mm" => {
            let (least, most) = (
                summary.ends_chamfer_leg_min_mm?,
                summary.ends_chamfer_leg_max_mm?,
            );
            format!(
                "from {} to {}",
                quantity::number(least, "mm"),
                of(most, "mm")
            )
        }
        "duration_s" => format!("following {} of it", of(summary.follow_duration_s?, "s")),
        "real_time_factor" => format!("computed in {}", of(summary.timing?.wall_time_s, "s")),
        _ => return None,
    })
}

/// A column of the table of passes.
pub struct PassColumn {
    /// Its heading.
    pub name: &'static str,
    /// Its unit.
    pub unit: &'static str,
    /// A pass's value in that unit.
    pub value: fn(&PassSummary) -> Option<f64>,
}

const fn pass(
    name: &'static str,
    unit: &'static str,
    value: fn(&PassSummary) -> Option<f64>,
) -> PassColumn {
    PassColumn { name, unit, value }
}

/// What a run of several passes says of each, in a row.
#[rustfmt::skip]
pub const PASSES: [PassColumn; 7] = [
    pass("desired", "N", |pass| Some(pass.desired_force_n)),
    pass("mean", "N", |pass| pass.force_mean_n),
    pass("SD", "N", |pass| pass.force_standard_deviation_n),
    pass("RMS error", "%", |pass| pass.force_rms_error_percent),
    pass("in 5 %", "%", |pass| pass.within_5_percent_share_percent),
    pass("largest", "N", |pass| pass.force_peak_follow_n),
    pass("feed", "mm/s", |pass| pass.feed_mean_mm_per_s),
];

/// Drives that were at their limit, with time and duration; none if none was.
#[must_use]
pub fn drives(summary: &Summary) -> Option<String> {
    let one = |joint: &JointTorqueShare| {
        let from = joint.saturated_from_s?;
        Some(format!(
            "{} from {} on for {}",
            printable(&joint.joint),
            with_unit(from, "s"),
            with_unit(joint.saturated_s, "s")
        ))
    };
    let all: Vec<String> = summary.joints.iter().filter_map(one).collect();
    (!all.is_empty()).then(|| all.join(", "))
}

/// Value and bound of a verdict, with enough digits to tell them apart.
pub(super) fn comparison(verdict: &BoundCheck) -> (String, String) {
    let Some(value) = verdict.value else {
        return ("undefined".to_owned(), bound(verdict));
    };
    let bounds = [verdict.min, verdict.max].into_iter().flatten();
    // `<0.001` reads as nothing.
    let tells = |shown: &String| {
        let shown: f64 = shown.parse().unwrap_or(0.0);
        let same = |bound: f64| value.total_cmp(&bound) == shown.total_cmp(&bound);
        bounds.clone().all(same)
    };
    let unit = if verdict.unit == "1" {
        ""
    } else {
        verdict.unit
    };
    let short = std::iter::once(quantity::number(value, unit));
    let longer = (DIGITS..17).map(|digits| significant(value, digits));
    let told = short.chain(longer).find(tells);
    (told.unwrap_or_else(|| value.to_string()), bound(verdict))
}

fn bound(verdict: &BoundCheck) -> String {
    match (verdict.min, verdict.max) {
        (Some(min), Some(max)) => format!("{min} to {max}"),
        (Some(min), None) => format!("at least {min}"),
        (None, Some(max)) => format!("at most {max}"),
        (None, None) => String::new(),
    }
}

/// Number of bounds that were kept, in one line.
pub(super) fn tally(verdicts: &[BoundCheck]) -> String {
    let kept = verdicts.iter().filter(|verdict| verdict.kept).count();
    match verdicts.len() {
        1 => format!("{kept} of 1 bound kept"),
        count => format!("{kept} of {count} bounds kept"),
    }
}

/// A name from a file on one line, without anything that steers a terminal.
pub(super) fn printable(text: &str) -> String {
    text.replace(char::is_control, " ")
}

#[cfg(test)]
mod tests {
    use super::super::test_summaries::nominal;
    use super::*;
    use crate::metrics::Timing;
    use serde_json::Value;

    #[test]
    fn every_row_names_a_metric() {
        for name in PARTS.iter().flat_map(|(_, names)| names.iter()) {
            assert!(metric(name).is_some(), "{name}");
        }
        let count: usize = PARTS.iter().map(|(_, names)| names.len()).sum();
        // A tool that turns; without one its part is left out.
        let untimed = Summary {
            tool_wear_kj: Some(1.0),
            ..Summary::default()
        };
        assert_eq!(rows(&Summary::default()).len(), count - 13);
        let timed = Summary {
            timing: Some(Timing::new(1.0, 1.0)),
            ..untimed.clone()
        };
        assert_eq!(
            (rows(&untimed).len(), rows(&timed).len()),
            (count - 1, count)
        );
    }

    // Catches: a number that is taken from another field. In most runs some fields are equal, here none are.
    #[test]
    fn each_row_shows_the_field_of_its_name() {
        let mut file = serde_json::to_value(nominal()).unwrap();
        let mut next = 1.0;
        let mut tell_apart = |fields: &mut serde_json::Map<String, Value>| {
            for number in fields.values_mut().filter(|value| value.is_number()) {
                next += 1.0;
                *number = Value::from(next);
            }
        };
        tell_apart(file["timing"].as_object_mut().unwrap());
        tell_apart(file.as_object_mut().unwrap());
        let summary: Summary = serde_json::from_value(file.clone()).unwrap();
        let rows = rows(&summary);
        assert!(rows.len() > 20);
        for row in &rows {
            let name = row.metric.name;
            let own = file.get(name).or_else(|| file["timing"].get(name));
            assert_eq!(own.and_then(Value::as_f64), row.value, "{name}");
        }
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
            row.map(ReportRow::text)
        };
        assert_eq!(shown(99.94).as_deref(), Some("99.94"));
        assert_eq!(shown(99.996).as_deref(), Some("<100"));
        assert_eq!(shown(100.0).as_deref(), Some("100.0"));
    }

    #[test]
    fn a_force_that_is_not_the_desired_one_is_said_so_whatever_the_bounds() {
        assert_eq!(far_from_desired(100.0, 99.0, 4.9), None);
        assert_eq!(
            far_from_desired(100.0, 94.0, 6.0).as_deref(),
            Some(
                "Off the desired force: 100.0 N desired, 94.00 N on average (-6.0 %), RMS error 6.000 %"
            )
        );
        let far = far_from_desired(100.0, 249.9, 149.9).unwrap();
        assert!(far.starts_with("Far from the desired force: 100.0 N desired, 249.9 N"));
        assert!(far.contains("(+150 %)"), "{far}");
    }

    #[test]
    fn a_value_just_outside_does_not_look_like_its_bound() {
        let verdict = |value, kept| BoundCheck {
            metric: "force_mean_n",
            pass: None,
            unit: "N",
            value,
            min: None,
            max: Some(1.0),
            kept,
        };
        let shown = |value, kept| comparison(&verdict(Some(value), kept)).0;
        assert_eq!(shown(0.5, true), "0.500");
        assert_eq!(shown(1.0, true), "1.000");
        assert_eq!(shown(1.000_000_12, false), "1.0000001");
        assert_eq!(shown(0.99999, true), "0.99999");
        assert_eq!(
            comparison(&verdict(None, false)),
            ("undefined".to_owned(), "at most 1".to_owned())
        );
    }
}
