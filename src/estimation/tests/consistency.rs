//! Innovations, chamber pressures, missing samples, transients.

use super::ensemble::{moved, parameters};
use super::plant::{Deviation, Motion, PERIOD, Sample, device, run};
use crate::device::DeviceParameters;
use crate::estimation::{ContactForceEstimator, EstimatorOutput, EstimatorParameters, Tolerances};

fn follow(
    data: &DeviceParameters,
    given: &EstimatorParameters,
    stroke: f64,
    samples: &[Sample],
) -> Vec<EstimatorOutput> {
    let mut estimator = ContactForceEstimator::new(data, given, stroke, PERIOD).unwrap();
    samples
        .iter()
        .map(|sample| estimator.update(&sample.measurement))
        .collect()
}

fn exact(motion: &Motion) -> (Vec<Sample>, Vec<EstimatorOutput>) {
    let data = device();
    let given = parameters(&data, Tolerances::NONE);
    let samples = run(&data, &given, &Deviation::NONE, motion, 7);
    let estimates = follow(&data, &given, samples[0].measurement.stroke, &samples);
    (samples, estimates)
}

#[test]
fn innovations_have_the_variance_foreseen_and_no_memory() {
    let (_, estimates) = exact(&moved(290.0, 0.5));
    for channel in 0..3 {
        let of: Vec<f64> = estimates[300..]
            .iter()
            .map(|estimate| estimate.normalized_innovations[channel])
            .collect();
        let n = of.len() as f64;
        let square: f64 = of.iter().map(|v| v * v).sum::<f64>() / n;
        let next: f64 = of.windows(2).map(|w| w[0] * w[1]).sum::<f64>() / n / square;
        // 2700 samples: standard deviations of 0.027 and 0.019.
        assert!((square - 1.0).abs() < 0.10, "channel {channel}: {square}");
        assert!(next.abs() < 0.06, "channel {channel}: {next}");
    }
}

#[test]
fn chamber_pressures_come_out_within_noise() {
    let (samples, estimates) = exact(&moved(290.0, 0.5));
    let mut squares = [0.0; 2];
    let mut lag: f64 = 0.0;
    for (sample, estimate) in samples.iter().zip(&estimates).skip(300) {
        let pressures = estimate.chamber_pressures.iter().zip(sample.pressures);
        for (square, (estimated, true_one)) in squares.iter_mut().zip(pressures) {
            *square += (estimated - true_one).powi(2);
        }
        lag = lag.max((sample.pressures[0] - 101_325.0 - 290.0 / device().areas().extending).abs());
    }
    let rms = squares.map(|square| (square / (samples.len() - 300) as f64).sqrt());
    // Chamber 1 is up to `lag` away from the outlet, which a static map would miss.
    assert!(lag > 700.0, "{lag}");
    assert!(rms[0] < 150.0 && rms[1] < 50.0, "{rms:?} Pa");
}

#[test]
fn a_missing_sample_is_skipped_and_costs_certainty() {
    let data = device();
    let given = parameters(&data, Tolerances::NONE);
    let mut samples = run(&data, &given, &Deviation::NONE, &moved(290.0, 0.5), 7);
    let whole = follow(&data, &given, 0.035, &samples);
    for sample in &mut samples[1000..1100] {
        sample.measurement.stroke = f64::NAN;
        sample.measurement.acceleration = f64::INFINITY;
        sample.measurement.regulator_pressure = f64::NAN;
    }
    let holed = follow(&data, &given, 0.035, &samples);
    assert_eq!(whole[..1000], holed[..1000]);
    assert!(holed[1099].standard_deviation > 1.5 * whole[1099].standard_deviation);
    assert!(
        holed[1050]
            .normalized_innovations
            .iter()
            .all(|v| v.is_nan())
    );
    assert!(
        holed[1000..1100]
            .iter()
            .zip(&samples[1000..])
            .all(|(e, s)| e.covers(s.force))
    );
    let settled = holed[1400].standard_deviation / whole[1400].standard_deviation;
    assert!((settled - 1.0).abs() < 0.1, "{settled}");
    // From the very first sample on, too.
    let mut estimator = ContactForceEstimator::new(&data, &given, 0.035, PERIOD).unwrap();
    let blind = estimator.update(&samples[1050].measurement);
    assert!(blind.force.is_finite() && blind.standard_deviation > 300.0);
}

#[test]
fn samples_far_off_leave_no_lasting_trace() {
    let data = device();
    let given = parameters(&data, Tolerances::default());
    let mut samples = run(&data, &given, &Deviation::NONE, &moved(290.0, 0.5), 7);
    let spikes = [
        (500, [0.1, 9e3, 1.1e6]),
        (700, [-0.05, -9e3, -1e5]),
        (900, [1e9, -1e9, 1e30]),
        (1100, [-1e300, f64::MAX, f64::NEG_INFINITY]),
    ];
    for (at, [stroke, acceleration, pressure]) in spikes {
        samples[at].measurement.stroke = stroke;
        samples[at + 50].measurement.acceleration = acceleration;
        samples[at + 100].measurement.regulator_pressure = pressure;
    }
    let estimates = follow(&data, &given, 0.035, &samples);
    let finite = |e: &EstimatorOutput| e.force.is_finite() && e.standard_deviation.is_finite();
    assert_eq!(estimates.iter().position(|e| !finite(e)), None);
    for (sample, estimate) in samples.iter().zip(&estimates).skip(2000) {
        let error = estimate.force - sample.force;
        assert!(error.abs() < 20.0, "{} s: {error} N", sample.time);
    }
}

/// Share of samples within the band from a time on, and largest error over the last 0.3 s [N].
fn transient(motion: &Motion, from: f64) -> (f64, f64) {
    let (samples, estimates) = exact(motion);
    let late: Vec<_> = samples
        .iter()
        .zip(&estimates)
        .filter(|(sample, _)| sample.time > from)
        .collect();
    let covered = late.iter().filter(|(s, e)| e.covers(s.force)).count();
    let last = late[late.len() - 300..]
        .iter()
        .map(|(s, e)| (s.force - e.force).abs())
        .fold(0.0, f64::max);
    (covered as f64 / late.len() as f64, last)
}

#[test]
fn a_step_of_the_pressure_is_followed() {
    let motion = Motion {
        later_force: 450.0,
        duration: 3.0,
        ..moved(150.0, 0.5)
    };
    let (covered, last) = transient(&motion, 0.5);
    assert!(covered > 0.9, "{covered}");
    assert!(last < 10.0, "{last}");
}

#[test]
fn running_out_and_striking_is_followed() {
    let motion = Motion {
        force: 0.0,
        later_force: 290.0,
        approach: 0.010,
        peak_to_peak: 0.0,
        duration: 2.5,
        ..moved(0.0, 0.5)
    };
    let (covered, last) = transient(&motion, 0.5);
    assert!(covered > 0.85, "{covered}");
    assert!(last < 15.0, "{last}");
}

/// Cost: `cargo test --release estimation_cost -- --ignored --nocapture`.
#[test]
#[ignore = "prints a time"]
fn estimation_cost() {
    let data = device();
    let given = parameters(&data, Tolerances::default());
    let samples = run(&data, &given, &Deviation::NONE, &moved(290.0, 0.5), 7);
    let start = std::time::Instant::now();
    let mut sum = 0.0;
    for _ in 0..10 {
        sum += follow(&data, &given, 0.035, &samples)[2000].force;
    }
    let each = start.elapsed().as_secs_f64() / 10.0 / samples.len() as f64;
    println!("{:.2} us an update ({sum})", 1e6 * each);
}
