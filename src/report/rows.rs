//! The rows of the reports: which metrics, in which parts, with what beside them.

use crate::metrics::{
    BoundCheck, JointTorqueShare, Measured, Metric, NARROW_BAND, Summary, WIDE_BAND,
};
use crate::quantity::{self, DIGITS, change, significant, with_unit};

/// One row: a metric, its value, and what a reader wants beside it.
pub(super) struct ReportRow<S: 'static> {
    /// The metric.
    pub(super) metric: &'static Metric<S>,
    /// Its value in the metric's unit.
    pub(super) value: Option<f64>,
    /// Its meaning in short, or a fact that belongs to it.
    pub(super) note: String,
}

impl<S> ReportRow<S> {
    /// Heading of its part of the report.
    pub(super) fn part(&self) -> &'static str {
        self.metric.part.title()
    }

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

/// The rows in the order of the parts.
pub(super) fn rows<S: Measured>(summary: &S) -> Vec<ReportRow<S>> {
    let row = |metric: &'static Metric<S>| {
        let value = (metric.value)(summary);
        let shown = metric.has_row && (value.is_some() || !metric.is_optional);
        shown.then(|| ReportRow {
            metric,
            value,
            note: printable(&metric.remark(summary)),
        })
    };
    let mut rows: Vec<_> = S::METRICS.iter().filter_map(row).collect();
    rows.sort_by_key(|row| row.metric.part);
    rows
}

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
    fn parts_stand_together_in_their_order_and_what_is_absent_from_the_file_is_no_row() {
        let bare = rows(&Summary::default());
        assert!(bare.iter().all(|row| !row.metric.is_optional));
        let full = rows(&Summary {
            tool_wear_kj: Some(1.0),
            timing: Some(Timing::new(1.0, 1.0)),
            ..Summary::default()
        });
        assert_eq!(full.len(), bare.len() + 2);
        assert!(full.is_sorted_by_key(|row| row.metric.part));
        assert_eq!(full[0].part(), "Edge");
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
