//! Uniformity of the contact force while the tool follows the edge.

use super::statistics::{Travel, extent, largest, moments, root_mean_square};
use super::window::Window;
use super::{FOLLOW_PHASE, ForceTenth, MetricsError, NARROW_BAND, Summary, TOUCH_SHARE, WIDE_BAND};
use crate::recording::{Recording, Unit, schema};

/// Whether a force is within a band about the desired one, given as a share of it.
pub(super) fn within(force: f64, desired: f64, band: f64) -> bool {
    (force - desired).abs() <= band * desired
}

/// Fills in what is known of the force in the following phase.
pub(super) fn measure(
    summary: &mut Summary,
    follow: &Window,
    desired: f64,
) -> Result<(), MetricsError> {
    let friction = follow.finite(schema::FRICTION_FORCE, Unit::Newton)?;
    summary.friction_force_mean_n = friction.and_then(moments).map(|friction| friction.mean);
    let Some(force) = follow.finite(schema::CONTACT_FORCE, Unit::Newton)? else {
        return Ok(());
    };
    let force_moments = moments(force);
    summary.force_mean_n = force_moments.map(|force| force.mean);
    summary.force_standard_deviation_n = force_moments.map(|force| force.standard_deviation);
    summary.coefficient_of_variation_percent = force_moments
        .filter(|force| force.mean > 0.0)
        .map(|force| 100.0 * force.standard_deviation / force.mean);
    let errors: Vec<f64> = force.iter().map(|force| force - desired).collect();
    summary.force_rms_error_n = root_mean_square(&errors);
    summary.force_rms_error_percent = summary.force_rms_error_n.map(|n| 100.0 * n / desired);
    summary.largest_deviation_n = largest(errors);

    let path = follow.finite(schema::PATH_LENGTH, Unit::Metre)?;
    if let Some(travel) = path.and_then(Travel::along) {
        let share = |band| travel.share_percent(force, |force| within(force, desired, band));
        summary.within_5_percent_share_percent = Some(share(NARROW_BAND));
        summary.within_10_percent_share_percent = Some(share(WIDE_BAND));
        let lost = travel.share_percent(force, |force| force <= TOUCH_SHARE * desired);
        summary.loss_of_contact_share_percent = Some(lost);
        summary.force_by_tenth = tenths(&travel, force);
    }
    Ok(())
}

/// Fills in the largest force of every phase.
pub(super) fn peaks(summary: &mut Summary, recording: &Recording) -> Result<(), MetricsError> {
    let peak = |phase| -> Result<Option<f64>, MetricsError> {
        let Some(window) = Window::phase(recording, phase)? else {
            return Ok(None);
        };
        largest_force(&window)
    };
    summary.force_peak_approach_n = peak("approach")?;
    summary.force_peak_engage_n = peak("engage")?;
    summary.force_peak_follow_n = peak(FOLLOW_PHASE)?;
    summary.force_peak_retract_n = peak("retract")?;
    Ok(())
}

/// Largest force in a window: of what happened between the samples too, where that was recorded.
pub(super) fn largest_force(window: &Window) -> Result<Option<f64>, MetricsError> {
    let between = window.finite(schema::CONTACT_FORCE_PEAK, Unit::Newton)?;
    let force = match between {
        None => window.finite(schema::CONTACT_FORCE, Unit::Newton)?,
        recorded => recorded,
    };
    Ok(force.and_then(extent).map(|(_, most)| most))
}

fn tenths(travel: &Travel, force: &[f64]) -> Vec<ForceTenth> {
    let total = 1e3 * travel.total();
    travel
        .parts(force, 10)
        .into_iter()
        .enumerate()
        .map(|(index, force)| {
            let moments = moments(force);
            ForceTenth {
                from_mm: total * index as f64 / 10.0,
                to_mm: total * (index + 1) as f64 / 10.0,
                force_mean_n: moments.map(|force| force.mean),
                force_standard_deviation_n: moments.map(|force| force.standard_deviation),
            }
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::super::test_recordings::{Builder, assert_near, limits};
    use super::super::{Summary, summarise};
    use std::f64::consts::{PI, SQRT_2};

    fn measured(builder: &Builder) -> Summary {
        summarise(&builder.build(), &limits()).unwrap()
    }

    #[test]
    fn a_sine_about_a_mean_has_its_closed_form() {
        // Whole periods: standard deviation a / sqrt 2, largest deviation |mean - desired| + a.
        let (mean, amplitude) = (101.0, 4.0);
        let mut builder = Builder::nominal();
        builder.follow_with(|share| mean + amplitude * (2.0 * PI * 5.0 * share).sin());
        let summary = measured(&builder);
        assert_near(summary.force_mean_n, mean, 1e-12);
        assert_near(
            summary.force_standard_deviation_n,
            amplitude / SQRT_2,
            1e-12,
        );
        let variation = 100.0 * amplitude / (SQRT_2 * mean);
        assert_near(summary.coefficient_of_variation_percent, variation, 1e-12);
        assert_near(summary.largest_deviation_n, 5.0, 1e-4);
        // An offset of 1 N and a spread of 4 / sqrt 2 N add in squares: 3 N.
        assert_near(summary.force_rms_error_n, 3.0, 1e-12);
        assert_near(summary.force_rms_error_percent, 3.0, 1e-12);
        assert_near(summary.within_5_percent_share_percent, 100.0, 1e-12);

        // About the desired force, |a sin| <= 5 holds for 2 asin(5 / a) / pi of the length.
        builder.follow_with(|share| 100.0 + 8.0 * (2.0 * PI * 5.0 * share).sin());
        let share = 100.0 * 2.0 * (5.0_f64 / 8.0).asin() / PI;
        let summary = measured(&builder);
        assert!((summary.within_5_percent_share_percent.unwrap() - share).abs() < 0.3);
        assert_near(summary.within_10_percent_share_percent, 100.0, 1e-12);
    }

    #[test]
    fn every_phase_has_its_largest_force_and_the_touch_does_not_hide_that_of_lifting_off() {
        let mut builder = Builder::nominal();
        builder.follow_with(|share| if share == 0.5 { 130.0 } else { 100.0 });
        builder.engage_with(1.5, |since| 100.0 + 20.0 * (-since).exp());
        let last = builder.force.len() - 1;
        builder.force[last - 100] = 700.0;
        let summary = measured(&builder);
        assert_eq!(summary.force_peak_approach_n, Some(0.0));
        assert_eq!(summary.force_peak_engage_n, Some(120.0));
        assert_eq!(summary.force_peak_follow_n, Some(130.0));
        assert_eq!(summary.force_peak_retract_n, Some(700.0));
        assert_eq!(summary.engagement_peak_n, Some(120.0));
        builder.phases.retain(|phase| phase.name != "retract");
        assert_eq!(measured(&builder).force_peak_retract_n, None);
    }

    #[test]
    fn shares_go_by_length_and_not_by_time() {
        // s = t^2 over the phase: the first half of the time covers a quarter of the length.
        let mut builder = Builder::nominal();
        builder.path_with(|share| share * share);
        builder.follow_with(|share| if share < 0.5 { 107.0 } else { 100.0 });
        let summary = measured(&builder);
        assert!((summary.within_5_percent_share_percent.unwrap() - 75.0).abs() < 0.1);
        assert_near(summary.within_10_percent_share_percent, 100.0, 1e-12);
        assert!((summary.force_mean_n.unwrap() - 103.5).abs() < 0.01);
        assert_eq!(summary.loss_of_contact_share_percent, Some(0.0));
    }

    #[test]
    fn lost_contact_is_seen_where_it_happens() {
        let mut builder = Builder::nominal();
        builder.follow_with(|share| {
            if (0.8..0.9).contains(&share) {
                0.0
            } else {
                100.0
            }
        });
        let summary = measured(&builder);
        assert!((summary.loss_of_contact_share_percent.unwrap() - 10.0).abs() < 0.1);
        assert_eq!(summary.force_by_tenth.len(), 10);
        let tenth = &summary.force_by_tenth[8];
        assert_near(Some(tenth.from_mm), 160.0, 1e-12);
        assert_near(Some(tenth.to_mm), 180.0, 1e-12);
        assert!(tenth.force_mean_n.unwrap() < 2.0);
        for untouched in [0, 5, 7] {
            let tenth = &summary.force_by_tenth[untouched];
            assert_eq!(tenth.force_mean_n, Some(100.0));
            assert_eq!(tenth.force_standard_deviation_n, Some(0.0));
        }
    }

    #[test]
    fn without_contact_there_is_no_coefficient_of_variation() {
        let mut builder = Builder::nominal();
        builder.force.fill(0.0);
        let summary = measured(&builder);
        assert_eq!(summary.force_mean_n, Some(0.0));
        assert_eq!(summary.coefficient_of_variation_percent, None);
        assert_eq!(summary.largest_deviation_n, Some(100.0));
        assert_eq!(summary.within_5_percent_share_percent, Some(0.0));
        assert_near(summary.loss_of_contact_share_percent, 100.0, 1e-12);
        assert_eq!(summary.engagement_peak_n, None);
        assert_eq!(summary.engagement_overshoot_percent, None);
        assert_eq!(summary.settling_time_s, None);
    }

    #[test]
    fn a_tool_at_rest_has_no_shares_of_length() {
        let mut builder = Builder::nominal();
        builder.path_with(|_| 0.5);
        let summary = measured(&builder);
        assert_eq!(summary.within_5_percent_share_percent, None);
        assert_eq!(summary.path_length_mm, None);
        assert_eq!(summary.feed_mean_mm_per_s, None);
        assert!(summary.force_by_tenth.is_empty());
        assert!(summary.force_mean_n.is_some());
    }
}
