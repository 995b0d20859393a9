//! The numbers of a run: how uniform the contact force was, and what it cost.
//!
//! [`summarise`] turns a [`Recording`] into a [`Summary`], [`METRICS`] lists its numbers with their
//! units, and [`check`] compares them with the bounds of a scenario. docs/METRICS.md is made from
//! their declarations. Nothing here knows how a recording came about, so a real one is judged alike.
//!
//! A number that the recording does not determine is `None`: the phase or channel is missing, a
//! value that it needs is not finite, or the tool never touched the part.

pub mod bench;
mod catalogue;
mod edge;
mod engagement;
mod error;
mod expect;
mod force;
mod label;
mod limits;
mod load;
mod motion;
mod note;
mod passes;
mod statistics;
mod summary;
#[cfg(test)]
pub(crate) mod test_planted;
#[cfg(test)]
mod test_recordings;
mod window;

pub use bench::{
    BENCH_METRICS, BenchLimits, BenchSummary, LEVEL_METRICS, LevelSummary, summarise_bench,
};
pub use catalogue::{Measured, Metric, Part, columns, key_facts};
pub use edge::EdgeLimits;
pub use error::MetricsError;
pub use expect::{BoundCheck, check, check_cell, validate, validate_cell};
pub use label::{Label, labels, metric_names, most_important};
pub use limits::{FOLLOW_PHASE, NARROW_BAND, SummaryLimits, TOUCH_SHARE, WIDE_BAND};
pub use summary::{
    ForceTenth, JointTorqueShare, METRICS, PASS_METRICS, PassSummary, Summary, Timing, metric,
};

use crate::recording::Recording;
use crate::recording::csv::EdgeProfile;
use window::Window;

/// Measures a recording. `timing` is left empty; the caller knows the wall clock.
///
/// # Errors
/// Names a limit that makes no sense, a channel in another unit, or a second `follow` phase.
pub fn summarise(recording: &Recording, limits: &SummaryLimits) -> Result<Summary, MetricsError> {
    limits.check()?;
    let run = Window::run(recording);
    let follow = Window::follow(recording)?;
    let mut summary = Summary {
        desired_force_n: limits.desired_force,
        duration_s: run.duration(),
        ..Summary::default()
    };
    force::peaks(&mut summary, recording)?;
    engagement::measure(&mut summary, recording, limits.desired_force)?;
    if let Some(follow) = follow {
        force::measure(&mut summary, &follow, limits.desired_force)?;
        motion::measure(&mut summary, &follow, limits.stroke_limits)?;
    }
    load::measure(&mut summary, &run, limits)?;
    summary.passes = passes::measure(recording, limits)?;
    edge::of_tool(&mut summary, &run)?;
    Ok(summary)
}

/// Adds the numbers of an edge that a turning tool has worked.
pub fn summarise_edge(summary: &mut Summary, profile: &EdgeProfile, limits: &EdgeLimits) {
    edge::measure(summary, profile, limits);
}

#[cfg(test)]
mod tests {
    use super::test_recordings::{Builder, assert_near, limits};
    use super::*;
    use crate::recording::{PhaseSpan, RecordedChannel, Unit, schema};

    #[test]
    fn an_empty_recording_leaves_everything_undefined_but_its_duration() {
        let recording = Recording::new(vec![0.0, 2.0], vec![], vec![]).unwrap();
        let summary = summarise(&recording, &limits()).unwrap();
        assert_eq!(summary.duration_s, 2.0);
        for metric in METRICS {
            let defined = ["duration_s", "desired_force_n"].contains(&metric.name);
            assert_eq!(
                (metric.value)(&summary).is_some(),
                defined,
                "{}",
                metric.name
            );
        }
    }

    #[test]
    fn a_complete_recording_defines_everything_but_the_timing_and_the_finished_edge() {
        let summary = summarise(&Builder::nominal().build(), &limits()).unwrap();
        for metric in METRICS {
            let is_none = (metric.value)(&summary).is_none();
            assert_eq!(is_none, metric.is_optional, "{}", metric.name);
        }
    }

    #[test]
    fn the_same_recording_gives_the_same_bytes_and_they_read_back() {
        let text = || {
            let summary = summarise(&Builder::nominal().build(), &limits()).unwrap();
            serde_json::to_string(&summary).unwrap()
        };
        assert_eq!(text(), text());
        assert!(!text().contains("timing"));
        let read: Summary = serde_json::from_str(&text()).unwrap();
        let summary = summarise(&Builder::nominal().build(), &limits()).unwrap();
        for metric in METRICS.iter().filter(|m| (m.value)(&summary).is_some()) {
            // The reader may be off by a bit in the last place.
            let written = (metric.value)(&summary).unwrap();
            assert_near((metric.value)(&read), written, 1e-15);
        }
        assert_eq!(read.joints.len(), 2);
        assert_eq!(read.force_by_tenth.len(), 10);
    }

    #[test]
    fn a_value_that_is_not_finite_makes_its_numbers_undefined() {
        let mut builder = Builder::nominal();
        builder.force[3000] = f64::NAN;
        let summary = summarise(&builder.build(), &limits()).unwrap();
        assert_eq!(summary.force_mean_n, None);
        assert_eq!(summary.within_5_percent_share_percent, None);
        assert!(summary.engagement_peak_n.is_some());
        assert!(summary.stroke_used_mm.is_some());
    }

    #[test]
    fn what_cannot_be_measured_against_is_refused_by_name() {
        let recording = Builder::nominal().build();
        let refuse = |change: fn(&mut SummaryLimits)| {
            let mut changed = limits();
            change(&mut changed);
            summarise(&recording, &changed).unwrap_err().to_string()
        };
        let force = refuse(|limits| limits.desired_force = -3.0);
        assert_eq!(
            force,
            "the desired force is -3 N; expected a positive number"
        );
        assert!(refuse(|limits| limits.stroke_limits = (0.05, 0.0)).contains("the stroke"));
        assert!(refuse(|limits| limits.joint_efforts = vec![1.0]).contains("2 joints is 1"));
        assert!(refuse(|limits| limits.joint_efforts[1] = f64::NAN).contains("`wrist`"));

        let pascal = RecordedChannel::new(schema::CONTACT_FORCE, Unit::Pascal, vec![0.0]);
        let recording = Recording::new(vec![0.0], vec![pascal], vec![]).unwrap();
        let error = summarise(&recording, &limits()).unwrap_err().to_string();
        assert_eq!(error, "channel `contact_force` is in Pa; expected N");

        let span = |start, end| PhaseSpan {
            name: FOLLOW_PHASE.into(),
            start,
            end,
        };
        let phases = vec![span(0.0, 1.0), span(2.0, 3.0)];
        let recording = Recording::new(vec![0.0], vec![], phases).unwrap();
        let error = summarise(&recording, &limits()).unwrap_err().to_string();
        assert!(error.contains("2 phases named `follow`"), "{error}");
    }
}
