//! The bounds that a scenario sets on its results.

use serde::Serialize;

use super::MetricsError;
use super::catalogue::Metric;
use crate::scenario::Expectation;

/// Whether a result kept its bounds.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct BoundCheck {
    /// Name of the metric as in summary.json.
    pub metric: &'static str,
    /// Its unit.
    pub unit: &'static str,
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
                metric: metric.name,
                unit: metric.unit,
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
    fn bounds_are_inclusive_and_an_undefined_value_violates() {
        let summary = Summary {
            force_mean_n: Some(100.0),
            ..Summary::default()
        };
        let kept = |metric, min, max| {
            let verdicts = check(METRICS, &summary, &[expectation(metric, min, max)]).unwrap();
            assert_eq!((verdicts[0].metric, verdicts.len()), (metric, 1));
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
