//! The passes along the edge, each by the numbers of its own following phase and its own desired force.

use super::window::Window;
use super::{FOLLOW_PHASE, MetricsError, PassSummary, Summary, SummaryLimits, force, motion};
use crate::recording::Recording;

/// The passes of a recording that were begun.
pub(super) fn measure(
    recording: &Recording,
    limits: &SummaryLimits,
) -> Result<Vec<PassSummary>, MetricsError> {
    let forces = std::iter::once(limits.desired_force).chain(limits.later_forces.iter().copied());
    let mut passes = Vec::new();
    for (index, desired) in forces.enumerate() {
        let number = index + 1;
        let window = match number {
            1 => Window::follow(recording)?,
            later => Window::of(recording, &format!("{FOLLOW_PHASE}_{later}")),
        };
        if let Some(window) = window {
            passes.push(of(&window, limits, (number, desired))?);
        }
    }
    Ok(passes)
}

fn of(
    follow: &Window,
    limits: &SummaryLimits,
    (pass, desired): (usize, f64),
) -> Result<PassSummary, MetricsError> {
    let mut all = Summary::default();
    force::measure(&mut all, follow, desired)?;
    motion::measure(&mut all, follow, limits.stroke_limits)?;
    let peak = force::largest_force(follow)?;
    Ok(PassSummary {
        pass,
        desired_force_n: desired,
        force_mean_n: all.force_mean_n,
        force_standard_deviation_n: all.force_standard_deviation_n,
        coefficient_of_variation_percent: all.coefficient_of_variation_percent,
        force_rms_error_n: all.force_rms_error_n,
        force_rms_error_percent: all.force_rms_error_percent,
        largest_deviation_n: all.largest_deviation_n,
        within_5_percent_share_percent: all.within_5_percent_share_percent,
        within_10_percent_share_percent: all.within_10_percent_share_percent,
        loss_of_contact_share_percent: all.loss_of_contact_share_percent,
        force_peak_follow_n: peak,
        path_error_rms_um: all.path_error_rms_um,
        path_error_max_um: all.path_error_max_um,
        path_lag_rms_um: all.path_lag_rms_um,
        path_lag_max_um: all.path_lag_max_um,
        path_length_mm: all.path_length_mm,
        feed_mean_mm_per_s: all.feed_mean_mm_per_s,
        follow_duration_s: all.follow_duration_s,
    })
}

#[cfg(test)]
mod tests {
    use super::super::PASS_METRICS;
    use super::super::test_recordings::{Builder, assert_near, limits};
    use super::*;
    use crate::recording::PhaseSpan;

    #[test]
    fn every_pass_is_measured_against_its_own_force() {
        let mut builder = Builder::nominal();
        builder.follow_with(|share| if share < 0.5 { 100.0 } else { 53.0 });
        let middle = 4.0;
        builder.phases[2].end = middle;
        builder.phases.insert(
            3,
            PhaseSpan {
                name: "follow_2".into(),
                start: middle,
                end: 6.0,
            },
        );
        let limits = SummaryLimits {
            later_forces: vec![50.0, 40.0],
            ..limits()
        };
        let summary = super::super::summarise(&builder.build(), &limits).unwrap();
        // The third was never begun.
        assert_eq!(summary.passes.len(), 2);
        let [first, second] = [&summary.passes[0], &summary.passes[1]];
        assert_eq!((first.pass, second.pass), (1, 2));
        assert_eq!(first.force_mean_n, summary.force_mean_n);
        assert_eq!(second.desired_force_n, 50.0);
        assert_near(second.force_mean_n, 53.0, 1e-12);
        assert_near(second.force_rms_error_percent, 6.0, 1e-9);
        assert_eq!(second.within_5_percent_share_percent, Some(0.0));
        assert_near(second.within_10_percent_share_percent, 100.0, 1e-12);
        assert_near(second.force_peak_follow_n, 53.0, 1e-12);
        assert_eq!(first.force_peak_follow_n, Some(100.0));
    }

    #[test]
    fn the_list_is_a_row_of_the_file_key_by_key() {
        let summary = super::super::summarise(&Builder::nominal().build(), &limits()).unwrap();
        let row = serde_json::to_value(&summary.passes[0]).unwrap();
        let keys: Vec<&str> = row
            .as_object()
            .unwrap()
            .keys()
            .map(String::as_str)
            .collect();
        let listed = std::iter::once("pass").chain(PASS_METRICS.iter().map(|metric| metric.name));
        let mut listed: Vec<&str> = listed.collect();
        let mut keys = keys;
        keys.sort_unstable();
        listed.sort_unstable();
        assert_eq!(keys, listed);
        for metric in PASS_METRICS {
            let value = (metric.value)(&summary.passes[0]);
            assert_eq!(row[metric.name].as_f64(), value, "{}", metric.name);
        }
    }
}
