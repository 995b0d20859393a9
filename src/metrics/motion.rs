//! Stroke, path error, length and feed while the tool follows the edge.

use super::statistics::{Travel, extent, largest, root_mean_square};
use super::window::Window;
use super::{MetricsError, Summary};
use crate::recording::{Unit, schema};

/// Fills in what is known of the motion in the following phase; `stroke_limits` [m].
pub(super) fn measure(
    summary: &mut Summary,
    follow: &Window,
    stroke_limits: (f64, f64),
) -> Result<(), MetricsError> {
    let stroke = follow.finite(schema::STROKE, Unit::Metre)?;
    if let Some((least, greatest)) = stroke.and_then(extent) {
        let (lower, upper) = stroke_limits;
        summary.stroke_used_mm = Some(1e3 * (greatest - least));
        summary.stroke_min_mm = Some(1e3 * least);
        summary.stroke_max_mm = Some(1e3 * greatest);
        summary.stroke_margin_mm = Some(1e3 * (least - lower).min(upper - greatest));
    }
    if let Some(error) = follow.finite(schema::PATH_ERROR, Unit::Metre)? {
        summary.path_error_rms_um = root_mean_square(error).map(|error| 1e6 * error);
        summary.path_error_max_um = largest(error.iter().copied()).map(|error| 1e6 * error);
    }
    if let Some(lag) = follow.finite(schema::PATH_LAG, Unit::Metre)? {
        summary.path_lag_rms_um = root_mean_square(lag).map(|lag| 1e6 * lag);
        summary.path_lag_max_um = largest(lag.iter().copied()).map(|lag| 1e6 * lag);
    }
    let duration = follow.duration();
    summary.follow_duration_s = Some(duration);
    let path = follow.finite(schema::PATH_LENGTH, Unit::Metre)?;
    if let Some(travel) = path.and_then(Travel::along) {
        summary.path_length_mm = Some(1e3 * travel.total());
        // Something was travelled, so there are two samples and time between them.
        summary.feed_mean_mm_per_s = Some(1e3 * travel.total() / duration);
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::super::summarise;
    use super::super::test_recordings::{Builder, assert_near, limits};
    use std::f64::consts::{PI, SQRT_2};

    #[test]
    fn stroke_is_measured_from_its_ends_and_only_while_following() {
        let mut builder = Builder::nominal();
        builder.stroke.fill(0.050);
        builder.fill_follow(|share| 0.030 + 0.008 * share, |builder| &mut builder.stroke);
        let summary = summarise(&builder.build(), &limits()).unwrap();
        assert_near(summary.stroke_min_mm, 30.0, 1e-12);
        assert!((summary.stroke_max_mm.unwrap() - 38.0).abs() < 0.01);
        assert!((summary.stroke_used_mm.unwrap() - 8.0).abs() < 0.01);
        assert!((summary.stroke_margin_mm.unwrap() - 12.0).abs() < 0.01);

        builder.fill_follow(|_| -0.001, |builder| &mut builder.stroke);
        let summary = summarise(&builder.build(), &limits()).unwrap();
        assert_near(summary.stroke_margin_mm, -1.0, 1e-12);
    }

    #[test]
    fn path_error_is_signed_or_not_and_has_the_same_size() {
        let mut builder = Builder::nominal();
        let wave = |share: f64| 30e-6 * (2.0 * PI * 5.0 * share).sin();
        builder.fill_follow(wave, |builder| &mut builder.path_error);
        let summary = summarise(&builder.build(), &limits()).unwrap();
        assert_near(summary.path_error_rms_um, 30.0 / SQRT_2, 1e-9);
        assert_near(summary.path_error_max_um, 30.0, 1e-6);
        builder.fill_follow(|share| wave(share).abs(), |builder| &mut builder.path_error);
        let unsigned = summarise(&builder.build(), &limits()).unwrap();
        assert_near(unsigned.path_error_rms_um, 30.0 / SQRT_2, 1e-9);
        assert_near(unsigned.path_error_max_um, 30.0, 1e-6);
    }

    #[test]
    fn the_lag_along_the_path_is_a_number_of_its_own() {
        let mut builder = Builder::nominal();
        let wave = |share: f64| 40e-6 * (2.0 * PI * 5.0 * share).sin();
        builder.fill_follow(wave, |builder| &mut builder.path_lag);
        let summary = summarise(&builder.build(), &limits()).unwrap();
        assert_near(summary.path_lag_rms_um, 40.0 / SQRT_2, 1e-9);
        assert_near(summary.path_lag_max_um, 40.0, 1e-6);
        assert_near(summary.path_error_rms_um, 10.0, 1e-9);
    }

    #[test]
    fn feed_is_length_over_time() {
        let summary = summarise(&Builder::nominal().build(), &limits()).unwrap();
        assert_near(summary.path_length_mm, 200.0, 1e-9);
        let duration = 4.0 - Builder::STEP;
        assert_near(summary.follow_duration_s, duration, 1e-9);
        assert_near(summary.feed_mean_mm_per_s, 200.0 / duration, 1e-9);
    }
}
