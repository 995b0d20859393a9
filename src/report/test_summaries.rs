//! A made-up summary for the tests of the reports.

use crate::metrics::{BoundCheck, ForceTenth, METRICS, Summary, Timing, check};
use crate::scenario::Expectation;

/// A run as one would like it.
pub(super) fn nominal() -> Summary {
    let tenth = |index: u32| ForceTenth {
        from_mm: 30.0 * f64::from(index),
        to_mm: 30.0 * f64::from(index + 1),
        force_mean_n: Some(320.0 + 0.03 * f64::from(index)),
        force_standard_deviation_n: Some(1.0 - 0.05 * f64::from(index)),
    };
    Summary {
        desired_force_n: 320.0,
        force_mean_n: Some(320.1),
        force_standard_deviation_n: Some(1.0),
        coefficient_of_variation_percent: Some(0.3124),
        force_rms_error_n: Some(1.005),
        force_rms_error_percent: Some(0.314),
        largest_deviation_n: Some(4.21),
        within_5_percent_share_percent: Some(100.0),
        within_10_percent_share_percent: Some(100.0),
        loss_of_contact_share_percent: Some(0.0),
        friction_force_mean_n: Some(47.98),
        force_peak_approach_n: Some(0.0),
        force_peak_engage_n: Some(351.7),
        force_peak_follow_n: Some(324.2),
        force_peak_retract_n: Some(321.0),
        engagement_peak_n: Some(351.7),
        engagement_overshoot_percent: Some(9.906),
        settling_time_s: Some(0.412),
        stroke_used_mm: Some(0.1342),
        stroke_min_mm: Some(24.93),
        stroke_max_mm: Some(25.07),
        stroke_margin_mm: Some(21.43),
        path_error_rms_um: Some(12.6),
        path_error_max_um: Some(48.1),
        path_lag_rms_um: Some(31.2),
        path_lag_max_um: Some(81.7),
        path_length_mm: Some(300.0),
        feed_mean_mm_per_s: Some(49.3),
        follow_duration_s: Some(6.085),
        joint_torque_share_percent: Some(61.2),
        most_loaded_joint: Some("shoulder_lift_joint".into()),
        drives_saturated_s: Some(0.0),
        air_mass_balance_relative: Some(3.2e-14),
        duration_s: 12.0,
        joints: Vec::new(),
        force_by_tenth: (0..10).map(tenth).collect(),
        timing: Some(Timing::new(12.0, 0.48)),
        ..Summary::default()
    }
}

/// One expectation that the run above keeps and one that it does not.
pub(super) fn checked(summary: &Summary) -> Vec<BoundCheck> {
    let expectation = |metric: &str, min, max| Expectation {
        metric: metric.into(),
        min,
        max,
    };
    let expectations = [
        expectation("coefficient_of_variation_percent", None, Some(1.0)),
        expectation("stroke_margin_mm", Some(22.0), None),
    ];
    check(METRICS, summary, &expectations).unwrap()
}
