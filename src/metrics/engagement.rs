//! Engagement of the tool with the edge: peak of the force and time to settle.
//!
//! The window runs from the first touch, whatever phase it falls into, to the start of following. Where the largest force since the sample before is recorded,
//! a touch that bounces off between two samples counts too.

use super::force::within;
use super::statistics::largest;
use super::window::raw;
use super::{FOLLOW_PHASE, MetricsError, NARROW_BAND, Summary, TOUCH_SHARE};
use crate::recording::{Recording, Unit, schema};

/// Fills in what is known of the engagement.
pub(super) fn measure(
    summary: &mut Summary,
    recording: &Recording,
    desired: f64,
) -> Result<(), MetricsError> {
    let Some(force) = raw(recording, schema::CONTACT_FORCE, Unit::Newton)? else {
        return Ok(());
    };
    let time = recording.time();
    let follow = recording.phase(FOLLOW_PHASE);
    // A run that stopped before following still had a peak.
    let end = follow.map_or(time.len(), |follow| {
        time.partition_point(|&time| time < follow.start)
    });
    let between = raw(recording, schema::CONTACT_FORCE_PEAK, Unit::Newton)?;
    let peaks = between.unwrap_or(force);
    let touch = peaks[..end]
        .iter()
        .position(|&force| force > TOUCH_SHARE * desired);
    let Some(touch) = touch else {
        return Ok(());
    };
    let (time, force) = (&time[touch..end], &force[touch..end]);
    if force.iter().any(|force| !force.is_finite()) {
        return Ok(());
    }
    let peak = largest(peaks[touch..end].iter().copied());
    summary.engagement_peak_n = peak;
    summary.engagement_overshoot_percent =
        peak.map(|peak| (100.0 * (peak - desired) / desired).max(0.0));
    // Without a start of following nothing says that the force would have stayed.
    summary.settling_time_s = follow.and_then(|_| settling_time(time, force, desired));
    Ok(())
}

/// Time from the first sample until the force stays in the narrow band; `None` if it is not there
/// at the last.
fn settling_time(time: &[f64], force: &[f64], desired: f64) -> Option<f64> {
    let settled = force
        .iter()
        .rposition(|&force| !within(force, desired, NARROW_BAND))
        .map_or(0, |outside| outside + 1);
    time.get(settled).map(|settled| settled - time[0])
}

#[cfg(test)]
mod tests {
    use super::super::test_recordings::{Builder, assert_near, limits};
    use super::super::{Summary, summarise};

    fn measured(builder: &Builder) -> Summary {
        summarise(&builder.build(), &limits()).unwrap()
    }

    #[test]
    fn a_decaying_ring_settles_when_its_envelope_says() {
        // Touch at 1 s, then 100 + 50 exp(-t / 0.1): within 5 N for good at t = 0.1 ln 10.
        let mut builder = Builder::nominal();
        builder.engage_with(1.0, |since| 100.0 + 50.0 * (-since / 0.1).exp());
        let summary = measured(&builder);
        assert_near(summary.engagement_peak_n, 150.0, 1e-9);
        assert_near(summary.engagement_overshoot_percent, 50.0, 1e-9);
        let settling = 0.1 * 10.0_f64.ln();
        assert!((summary.settling_time_s.unwrap() - settling).abs() <= Builder::STEP);
    }

    #[test]
    fn a_force_that_leaves_the_band_again_has_not_settled() {
        let mut builder = Builder::nominal();
        builder.engage_with(1.0, |since| if since < 0.4 { 100.0 } else { 94.0 });
        let summary = measured(&builder);
        assert_eq!(summary.settling_time_s, None);
        assert_eq!(summary.engagement_peak_n, Some(100.0));
        assert_eq!(summary.engagement_overshoot_percent, Some(0.0));

        // A dip that is over by the end of the dwell only delays it.
        builder.engage_with(1.0, |since| {
            if (0.3..0.4).contains(&since) {
                94.0
            } else {
                100.0
            }
        });
        let settling = measured(&builder).settling_time_s.unwrap();
        assert!((settling - 0.4).abs() <= Builder::STEP, "{settling}");
    }

    /// On a stiff part a run of 1 ms steps said 1097 N where the first touch, over between two samples, was of 1270 N.
    #[test]
    fn a_touch_that_is_over_between_two_samples_is_the_peak_and_begins_the_window() {
        let mut builder = Builder::nominal();
        builder.engage_with(1.0, |since| if since < 0.2 { 0.0 } else { 100.0 });
        let mut peaks = builder.force.clone();
        let bounce = builder.time.partition_point(|time| *time < 1.1);
        peaks[bounce] = 270.0;
        builder.peaks = Some(peaks);
        let summary = measured(&builder);
        assert_near(summary.engagement_peak_n, 270.0, 1e-9);
        // From the bounce at 1.1 s to the touch that stays at 1.2 s.
        assert!((summary.settling_time_s.unwrap() - 0.1).abs() <= 2.0 * Builder::STEP);
        builder.peaks = None;
        assert_near(measured(&builder).engagement_peak_n, 100.0, 1e-9);
    }

    #[test]
    fn the_force_while_following_does_not_count() {
        let mut builder = Builder::nominal();
        builder.engage_with(1.0, |_| 100.0);
        builder.follow_with(|_| 300.0);
        let summary = measured(&builder);
        assert_eq!(summary.engagement_peak_n, Some(100.0));
        assert_eq!(summary.settling_time_s, Some(0.0));
    }

    #[test]
    fn a_run_that_never_follows_has_a_peak_and_no_settling_time() {
        let mut builder = Builder::nominal();
        builder.engage_with(1.0, |_| 130.0);
        builder.phases.retain(|phase| phase.name != "follow");
        builder.follow_with(|_| 100.0);
        let summary = measured(&builder);
        assert_eq!(summary.engagement_peak_n, Some(130.0));
        assert_eq!(summary.settling_time_s, None);
        assert_eq!(summary.force_mean_n, None);
    }
}
