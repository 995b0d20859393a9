//! The bounds that a scenario sets on its results.

use std::borrow::Cow;

use serde::{Deserialize, Serialize};

use super::MetricsError;
use super::catalogue::Metric;
use super::{METRICS, PASS_METRICS, Summary};
use crate::scenario::Expectation;

/// Whether a result kept its bounds.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct BoundCheck {
    /// Name of the metric as in summary.json.
    pub metric: Cow<'static, str>,
    /// The pass of which it is, from 1; none of a number of the whole run.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub pass: Option<usize>,
    /// Its unit.
    #[serde(default)]
    pub unit: Cow<'static, str>,
    /// Its value in that unit; `None` if the run does not determine it.
    pub value: Option<f64>,
    /// Least allowed value.
    pub min: Option<f64>,
    /// Largest allowed value.
    pub max: Option<f64>,
    /// Whether it is within the bounds. A value that is not determined never is.
    pub kept: bool,
}

/// Checks that every expectation can be checked. To be asked before a run, not after it.
///
/// # Errors
/// Names the first metric that does not exist, with the nearest that does, or the first bounds that
/// make no sense.
pub fn validate<S>(
    metrics: &'static [Metric<S>],
    expectations: &[Expectation],
) -> Result<(), MetricsError> {
    expectations
        .iter()
        .try_for_each(|expectation| find(metrics, expectation).map(|_| ()))
}

impl BoundCheck {
    /// The bounds, in words: `at least 2 and at most 5`.
    #[must_use]
    pub fn ends(&self) -> String {
        let end = |words: &str, end: Option<f64>| end.map(|end| format!("{words} {end}"));
        let ends = [end("at least", self.min), end("at most", self.max)];
        ends.into_iter().flatten().collect::<Vec<_>>().join(" and ")
    }

    /// Its metric, of a pass with its number.
    #[must_use]
    pub fn name(&self) -> String {
        match self.pass {
            None => self.metric.to_string(),
            Some(pass) => format!("pass {pass}: {}", self.metric),
        }
    }
}

/// The bound that stands unless a scenario sets one on its number: no drive is at its limit.
const IMPLICIT_METRIC: &str = "drives_saturated_s";

/// As [`validate`], for a cell and each of its passes.
///
/// # Errors
/// As [`validate`].
pub fn validate_cell(
    expectations: &[Expectation],
    of_passes: &[Vec<Expectation>],
) -> Result<(), MetricsError> {
    validate(METRICS, expectations)?;
    let mut of_passes = of_passes.iter();
    of_passes.try_for_each(|expectations| validate(PASS_METRICS, expectations))
}

/// Compares the results of a cell with its bounds: those of the run, those of each pass, and where it is broken the one that stands without being set.
///
/// # Errors
/// As [`validate`].
pub fn check_cell(
    summary: &Summary,
    expectations: &[Expectation],
    of_passes: &[Vec<Expectation>],
) -> Result<Vec<BoundCheck>, MetricsError> {
    let mut checks = check(METRICS, summary, expectations)?;
    for (index, expectations) in of_passes.iter().enumerate() {
        let number = index + 1;
        let begun = summary.passes.iter().find(|pass| pass.pass == number);
        let of_pass = match begun {
            Some(pass) => check(PASS_METRICS, pass, expectations)?,
            None => undetermined(expectations)?,
        };
        checks.extend(of_pass.into_iter().map(|check| BoundCheck {
            pass: Some(number),
            ..check
        }));
    }
    let is_set = expectations.iter().any(|own| own.metric == IMPLICIT_METRIC);
    let implicit = Expectation {
        metric: IMPLICIT_METRIC.to_owned(),
        min: None,
        max: Some(0.0),
    };
    if !is_set && summary.drives_saturated_s.is_some() {
        let implicit = check(METRICS, summary, &[implicit])?;
        checks.extend(implicit.into_iter().filter(|check| !check.kept));
    }
    Ok(checks)
}

/// Bounds on a pass that was never begun.
fn undetermined(expectations: &[Expectation]) -> Result<Vec<BoundCheck>, MetricsError> {
    let unknown = |expectation: &Expectation| {
        let metric = find(PASS_METRICS, expectation)?;
        Ok(BoundCheck {
            metric: metric.name.into(),
            pass: None,
            unit: metric.unit.into(),
            value: None,
            min: expectation.min,
            max: expectation.max,
            kept: false,
        })
    };
    expectations.iter().map(unknown).collect()
}

/// Compares results with their bounds, in the order of the expectations.
///
/// # Errors
/// As [`validate`].
pub fn check<S>(
    metrics: &'static [Metric<S>],
    summary: &S,
    expectations: &[Expectation],
) -> Result<Vec<BoundCheck>, MetricsError> {
    expectations
        .iter()
        .map(|expectation| {
            let metric = find(metrics, expectation)?;
            let (min, max) = (expectation.min, expectation.max);
            let value = (metric.value)(summary);
            let within = |value: f64| {
                min.is_none_or(|min| value >= min) && max.is_none_or(|max| value <= max)
            };
            Ok(BoundCheck {
                metric: metric.name.into(),
                pass: None,
                unit: metric.unit.into(),
                value,
                min,
                max,
                kept: value.is_some_and(within),
            })
        })
        .collect()
}

/// The metric of an expectation whose bounds make sense.
fn find<S>(
    metrics: &'static [Metric<S>],
    expectation: &Expectation,
) -> Result<&'static Metric<S>, MetricsError> {
    let name = &expectation.metric;
    let found = metrics.iter().find(|metric| metric.name == name);
    let found = found.ok_or_else(|| MetricsError::UnknownMetric {
        metric: name.clone(),
        nearest: nearest(metrics, name),
    })?;
    let refuse = |found: String, expected| {
        Err(MetricsError::Bound {
            metric: name.clone(),
            found,
            expected,
        })
    };
    match (expectation.min, expectation.max) {
        (None, None) => refuse("no bound".into(), "`min`, `max` or both"),
        (Some(min), _) if !min.is_finite() => refuse(format!("min = {min}"), "a finite number"),
        (_, Some(max)) if !max.is_finite() => refuse(format!("max = {max}"), "a finite number"),
        (Some(min), Some(max)) if min > max => {
            refuse(format!("min = {min} and max = {max}"), "min not above max")
        }
        _ => Ok(found),
    }
}

/// The metric whose name is most like a given one.
fn nearest<S>(metrics: &'static [Metric<S>], name: &str) -> &'static str {
    let likeness = |metric: &Metric<S>| strsim::jaro_winkler(name, metric.name);
    metrics
        .iter()
        .max_by(|one, other| likeness(one).total_cmp(&likeness(other)))
        .map_or("", |metric| metric.name)
}

#[cfg(test)]
mod tests {
    use super::super::{METRICS, Summary};
    use super::*;

    fn expectation(metric: &str, min: Option<f64>, max: Option<f64>) -> Expectation {
        Expectation {
            metric: metric.into(),
            min,
            max,
        }
    }

    #[test]
    fn a_drive_at_its_limit_breaks_a_bound_that_nobody_set() {
        let broken = |saturated, expectations: &[Expectation]| {
            let summary = Summary {
                drives_saturated_s: saturated,
                ..Summary::default()
            };
            let checks = check_cell(&summary, expectations, &[]).unwrap();
            checks.iter().filter(|check| !check.kept).count()
        };
        assert_eq!(broken(Some(0.0), &[]), 0);
        assert_eq!(broken(Some(0.038), &[]), 1);
        assert_eq!(broken(None, &[]), 0);
        let lifted = expectation(IMPLICIT_METRIC, None, Some(0.1));
        assert_eq!(broken(Some(0.038), std::slice::from_ref(&lifted)), 0);
        assert_eq!(broken(Some(0.2), &[lifted]), 1);
    }

    #[test]
    fn bounds_of_a_pass_are_held_against_that_pass() {
        let pass = |pass, mean| super::super::PassSummary {
            pass,
            force_mean_n: Some(mean),
            ..Default::default()
        };
        let summary = Summary {
            passes: vec![pass(1, 100.0), pass(2, 50.0)],
            ..Summary::default()
        };
        let own = |max| vec![expectation("force_mean_n", None, Some(max))];
        let of_passes = [own(60.0), own(60.0), own(60.0)];
        validate_cell(&[], &of_passes).unwrap();
        let checks = check_cell(&summary, &[], &of_passes).unwrap();
        let named = checks
            .iter()
            .map(|check| (check.pass, check.value, check.kept));
        let expected = [
            (Some(1), Some(100.0), false),
            (Some(2), Some(50.0), true),
            (Some(3), None, false),
        ];
        assert_eq!(named.collect::<Vec<_>>(), expected);
        assert_eq!(checks[1].name(), "pass 2: force_mean_n");
        let unknown = [vec![expectation("settling_time_s", None, Some(1.0))]];
        assert!(validate_cell(&[], &unknown).is_err());
    }

    #[test]
    fn bounds_are_inclusive_and_an_undefined_value_violates() {
        let summary = Summary {
            force_mean_n: Some(100.0),
            ..Summary::default()
        };
        let kept = |metric, min, max| {
            let verdicts = check(METRICS, &summary, &[expectation(metric, min, max)]).unwrap();
            assert_eq!((verdicts[0].metric.as_ref(), verdicts.len()), (metric, 1));
            verdicts[0].kept
        };
        assert!(kept("force_mean_n", Some(100.0), Some(100.0)));
        assert!(kept("force_mean_n", Some(99.0), None));
        assert!(!kept("force_mean_n", Some(100.1), None));
        assert!(!kept("force_mean_n", None, Some(99.9)));
        assert!(!kept("settling_time_s", None, Some(1e9)));
    }

    #[test]
    fn an_unknown_metric_is_refused_with_the_nearest() {
        for (given, near) in [
            (
                "coefficient_of_variation",
                "coefficient_of_variation_percent",
            ),
            ("force_mean", "force_mean_n"),
            ("settling_time_ms", "settling_time_s"),
            ("Stroke_margin_mm", "stroke_margin_mm"),
            ("froce_mean_n", "force_mean_n"),
        ] {
            let error = validate(METRICS, &[expectation(given, None, Some(1.0))]).unwrap_err();
            let MetricsError::UnknownMetric { metric, nearest } = &error else {
                panic!("{error}");
            };
            assert_eq!((metric.as_str(), *nearest), (given, near));
            assert!(error.to_string().contains(near));
        }
    }

    #[test]
    fn bounds_that_make_no_sense_are_refused() {
        for (min, max, part) in [
            (None, None, "no bound"),
            (Some(f64::NAN), None, "min = NaN"),
            (None, Some(f64::INFINITY), "max = inf"),
            (Some(2.0), Some(1.0), "min = 2 and max = 1"),
        ] {
            let error = validate(METRICS, &[expectation("force_mean_n", min, max)]).unwrap_err();
            assert!(error.to_string().contains(part), "{error}");
        }
    }
}
