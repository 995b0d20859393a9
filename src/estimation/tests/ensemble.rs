//! Error and coverage over devices drawn within their tolerances.

use super::plant::{Deviation, Motion, PERIOD, Sample, device, noise, run};
use crate::device::DeviceParameters;
use crate::estimation::{ContactForceEstimator, Estimate, EstimatorParameters, Tolerances};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;

/// Sums over samples.
#[derive(Debug, Clone, Copy, Default)]
struct Score {
    all: usize,
    covered: usize,
    sliding: usize,
    sliding_square: f64,
    sliding_variance: f64,
    turning: usize,
    turning_covered: usize,
    turning_variance: f64,
    normalized: f64,
    innovations: [f64; 3],
}

impl Score {
    fn add(&mut self, sample: &Sample, estimate: &Estimate) {
        let error = estimate.force - sample.force;
        let variance = estimate.standard_deviation.powi(2);
        let covered = usize::from(estimate.covers(sample.force));
        self.all += 1;
        self.covered += covered;
        self.normalized += error * error / variance;
        for (sum, value) in self
            .innovations
            .iter_mut()
            .zip(estimate.normalized_innovations)
        {
            *sum += value * value;
        }
        if sample.friction_share.abs() > 0.95 {
            self.sliding += 1;
            self.sliding_square += error * error;
            self.sliding_variance += variance;
        } else {
            self.turning += 1;
            self.turning_covered += covered;
            self.turning_variance += variance;
        }
    }

    fn merge(&mut self, other: &Self) {
        self.all += other.all;
        self.covered += other.covered;
        self.sliding += other.sliding;
        self.sliding_square += other.sliding_square;
        self.sliding_variance += other.sliding_variance;
        self.turning += other.turning;
        self.turning_covered += other.turning_covered;
        self.turning_variance += other.turning_variance;
        self.normalized += other.normalized;
        for i in 0..3 {
            self.innovations[i] += other.innovations[i];
        }
    }

    fn coverage(&self) -> f64 {
        self.covered as f64 / self.all as f64
    }

    fn rms_sliding(&self) -> f64 {
        (self.sliding_square / self.sliding as f64).sqrt()
    }

    fn line(&self, name: &str, force: f64) -> String {
        let n = self.all as f64;
        format!(
            "{name:<34} cover {:6.2} %  turning {:6.2} %  rms {:5.2} N {:5.2} %  sd {:5.2} turning {:5.2}  nees {:5.2}  nis {:4.2} {:4.2} {:4.2}",
            100.0 * self.coverage(),
            100.0 * self.turning_covered as f64 / self.turning.max(1) as f64,
            self.rms_sliding(),
            100.0 * self.rms_sliding() / force,
            (self.sliding_variance / self.sliding as f64).sqrt(),
            (self.turning_variance / self.turning.max(1) as f64).sqrt(),
            self.normalized / n,
            self.innovations[0] / n,
            self.innovations[1] / n,
            self.innovations[2] / n,
        )
    }
}

/// Scores an estimator over a run, from the first moment of sliding on.
fn score(samples: &[Sample], data: &DeviceParameters, told: &EstimatorParameters) -> Score {
    let mut estimator = ContactForceEstimator::new(data, told, 0.035, PERIOD).unwrap();
    let mut score = Score::default();
    let mut slid = false;
    for sample in samples {
        let estimate = estimator.update(&sample.measurement);
        slid |= sample.friction_share.abs() > 0.95;
        if slid {
            score.add(sample, &estimate);
        }
    }
    score
}

/// Devices drawn within `parameters.tolerances`, estimators told `told`.
fn ensemble(
    data: &DeviceParameters,
    parameters: &EstimatorParameters,
    told: &EstimatorParameters,
    motion: &Motion,
    devices: u64,
) -> Score {
    let mut sum = Score::default();
    for seed in 0..devices {
        let deviation = Deviation::drawn(&mut ChaCha8Rng::seed_from_u64(1000 + seed));
        let samples = run(data, parameters, &deviation, motion, seed);
        sum.merge(&score(&samples, data, told));
    }
    sum
}

fn moved(force: f64, frequency: f64) -> Motion {
    Motion {
        force,
        peak_to_peak: 0.02,
        frequency,
        gravity: 0.0,
        duration: 1.5 / frequency,
    }
}

fn parameters(data: &DeviceParameters, tolerances: Tolerances, gravity: f64) -> EstimatorParameters {
    EstimatorParameters {
        gravity_along_axis: gravity,
        ..EstimatorParameters::new(noise(data), tolerances)
    }
}

/// Table for docs: `cargo test --release estimation_table -- --ignored --nocapture`.
#[test]
#[ignore = "minutes; prints the table of the documentation"]
fn estimation_table() {
    let data = device();
    for tolerances in [Tolerances::NONE, Tolerances::default()] {
        println!("{tolerances:?}");
        let told = parameters(&data, tolerances, 0.0);
        for frequency in [0.1, 0.5] {
            for force in [100.0, 290.0, 450.0] {
                let motion = moved(force, frequency);
                let result = ensemble(&data, &told, &told, &motion, 40);
                println!("{}", result.line(&format!("{force} N, {frequency} Hz"), force));
            }
        }
    }
}
