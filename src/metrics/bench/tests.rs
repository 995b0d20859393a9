//! Planted runs and the numbers that they must give.

use super::*;
use crate::recording::RecordedChannel;

/// Two seconds at 1 kHz: set to 1 bar at 0.5 s and 3 bar at 1.25 s, force 100 N/bar with a lag of 50 ms, after 10 ms of dead time.
fn stairs(overshoot: f64) -> (Recording, BenchLimits) {
    let time: Vec<f64> = (0..=2000).map(|i| f64::from(i) * 1e-3).collect();
    let respond = |t: f64, at: f64| {
        let since = t - at - 0.01;
        if since < 0.0 {
            0.0
        } else {
            1.0 - (-since / 0.05).exp()
        }
    };
    let gauge: Vec<f64> = time
        .iter()
        .map(|&t| 1e5 * respond(t, 0.5) + 2e5 * respond(t, 1.25))
        .collect();
    let force: Vec<f64> = time
        .iter()
        .zip(&gauge)
        .map(|(&t, p)| {
            p * 1e-3
                + if (1.40..1.41).contains(&t) {
                    overshoot
                } else {
                    0.0
                }
        })
        .collect();
    let set = |t: f64| {
        if t < 0.5 {
            0.0
        } else if t < 1.25 {
            1e5
        } else {
            3e5
        }
    };
    let absolute = |p: f64| p + 1e5;
    let channels = vec![
        RecordedChannel::new(
            schema::SET_PRESSURE,
            Unit::Pascal,
            time.iter().map(|&t| absolute(set(t))).collect(),
        ),
        RecordedChannel::new(
            schema::REGULATOR_PRESSURE,
            Unit::Pascal,
            gauge.iter().map(|&p| absolute(p)).collect(),
        ),
        RecordedChannel::new(schema::CONTACT_FORCE, Unit::Newton, force.clone()),
        RecordedChannel::new(
            schema::MEASURED_FORCE,
            Unit::Newton,
            force.iter().map(|f| 1.208 * f).collect(),
        ),
        RecordedChannel::new(
            schema::STROKE,
            Unit::Metre,
            time.iter().map(|t| 0.01 + 0.01 * t).collect(),
        ),
    ];
    let limits = BenchLimits {
        command_times: vec![0.5, 1.25],
        disturbed_from: None,
        moving: None,
        stroke_limits: (0.0, 0.05),
        atmosphere: 1e5,
    };
    (Recording::new(time, channels, vec![]).unwrap(), limits)
}

fn near(value: Option<f64>, expected: f64, tolerance: f64) {
    let value = value.unwrap();
    assert!(
        (value - expected).abs() < tolerance,
        "{value} against {expected}"
    );
}

#[test]
fn levels_delay_slope_and_settling_are_those_planted() {
    let (recording, limits) = stairs(0.0);
    let summary = summarise_bench(&recording, &limits).unwrap();
    assert_eq!(summary.levels.len(), 2);
    near(summary.regulator_delay_s, 0.06, 2e-3);
    near(summary.levels[0].force_mean_n, 100.0, 0.01);
    near(summary.levels[1].force_mean_n, 300.0, 0.01);
    near(summary.force_slope_n_per_bar, 100.0, 1e-6);
    // Two levels are always on a line.
    assert_eq!(summary.force_linearity_percent, None);
    // 200 N of change: within 5 % after 10 ms + 50 ms ln 20.
    near(
        summary.force_settling_time_s,
        0.01 + 0.05 * 20f64.ln(),
        2e-3,
    );
    near(summary.force_overshoot_percent, 0.0, 0.1);
    near(summary.measured_force_error_percent, 20.8, 1e-6);
    near(summary.stroke_max_mm, 30.0, 1e-9);
    near(summary.stroke_margin_mm, 15.1, 0.1);
    near(summary.first_contact_s, 0.511, 1.1e-3);
}

#[test]
fn a_peak_is_an_overshoot_and_delays_settling() {
    let (recording, limits) = stairs(50.0);
    let summary = summarise_bench(&recording, &limits).unwrap();
    // At 1.409 s the lag has 200 exp(-149/50) N left to go.
    near(
        summary.force_overshoot_percent,
        (50.0 - 200.0 * (-0.149f64 / 0.05).exp()) / 2.0,
        0.2,
    );
    near(summary.force_settling_time_s, 0.16, 2e-3);
}

/// The motion of a surface once passed for a step's overshoot, and it never settled.
#[test]
fn a_surface_that_moves_is_no_response_to_a_command() {
    let (recording, mut limits) = stairs(50.0);
    let whole = summarise_bench(&recording, &limits).unwrap();
    // Before the peak at 1.40 s the second step has made 94 % of its way: what it settles to is the mean of the last fifth before.
    limits.disturbed_from = Some(1.39);
    let rested = summarise_bench(&recording, &limits).unwrap();
    assert!(rested.force_overshoot_percent.unwrap() < 5.0);
    assert!(whole.force_overshoot_percent.unwrap() > 15.0);
    assert_eq!(rested.levels[0], whole.levels[0]);
    // Moved from before the second command on: the first one's response is the last.
    limits.disturbed_from = Some(1.2);
    let moved = summarise_bench(&recording, &limits).unwrap();
    assert_eq!(moved.levels[1].force_settling_time_s, None);
    assert_eq!(moved.levels[1].force_overshoot_percent, None);
    assert_eq!(
        moved.force_settling_time_s,
        moved.levels[0].force_settling_time_s
    );
    near(moved.levels[1].force_mean_n, 300.0, 0.01);
    // Moved throughout: there is none.
    limits.disturbed_from = Some(0.0);
    let never = summarise_bench(&recording, &limits).unwrap();
    assert_eq!(never.force_settling_time_s, None);
    assert_eq!(never.force_overshoot_percent, None);
    assert_eq!(never.force_peak_n, whole.force_peak_n);
}

#[test]
fn the_moving_section_counts_where_the_surface_moves() {
    let time: Vec<f64> = (0..1000).map(|i| f64::from(i) * 1e-3).collect();
    let force = |t: f64| {
        if t < 0.5 {
            50.0
        } else {
            202.0 + 2.0 * (t * 200.0).sin().signum()
        }
    };
    let channels = vec![
        RecordedChannel::new(
            schema::CONTACT_FORCE,
            Unit::Newton,
            time.iter().map(|&t| force(t)).collect(),
        ),
        RecordedChannel::new(schema::DESIRED_FORCE, Unit::Newton, vec![200.0; 1000]),
    ];
    let recording = Recording::new(time, channels, vec![]).unwrap();
    let limits = BenchLimits {
        command_times: vec![0.0],
        disturbed_from: Some(0.4),
        moving: Some((0.5, 1.0)),
        stroke_limits: (0.0, 0.05),
        atmosphere: 1e5,
    };
    let summary = summarise_bench(&recording, &limits).unwrap();
    near(summary.force_mean_n, 202.0, 0.1);
    near(summary.desired_force_n, 200.0, 1e-12);
    near(summary.force_rms_error_n, 8f64.sqrt(), 0.05);
    near(summary.force_largest_error_percent, 2.0, 1e-9);
    near(
        summary.coefficient_of_variation_percent,
        100.0 * 2.0 / 202.0,
        0.02,
    );
}

#[test]
fn names_stand_in_the_file() {
    let (recording, limits) = stairs(0.0);
    let mut summary = summarise_bench(&recording, &limits).unwrap();
    summary.timing = Some(Timing::new(8.0, 2.0));
    let file = serde_json::to_value(&summary).unwrap();
    for metric in BENCH_METRICS {
        let found = file
            .get(metric.name)
            .or_else(|| file["timing"].get(metric.name));
        let found = found.and_then(serde_json::Value::as_f64);
        assert_eq!(found, (metric.value)(&summary), "{}", metric.name);
    }
}
