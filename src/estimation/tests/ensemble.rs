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
        for frequency in [0.05, 0.1, 0.25, 0.5, 1.0] {
            for force in [290.0] {
                let motion = moved(force, frequency);
                let result = ensemble(&data, &told, &told, &motion, 40);
                println!("{}", result.line(&format!("{force} N, {frequency} Hz"), force));
            }
        }
    }
}

#[test]
#[ignore]
fn debug_turn() {
    let data = device();
    let told = parameters(&data, Tolerances::NONE, 0.0);
    for frequency in [0.05, 0.1, 0.25, 0.5, 1.0] {
        let motion = moved(290.0, frequency);
        let mut bins = [[0.0f64; 4]; 14];
        let mut sx = 0.0;
        for seed in 0..40 {
            let samples = run(&data, &told, &Deviation::NONE, &motion, seed);
            let mut e = ContactForceEstimator::new(&data, &told, 0.035, PERIOD).unwrap();
            for (k, s) in samples.iter().enumerate() {
                let est = e.update(&s.measurement);
                let time = k as f64 * PERIOD;
                if time * frequency < 0.25 { continue; }
                if seed == 0 && k % 100 == 0 && k < 2000 { println!("{:?} {:?}", e.model_probabilities(), e.debug()); }
                let dir = s.speed.signum();
                let err = (est.friction - 10.0 * s.friction_share) * dir;
                let b = (((s.friction_share * dir + 1.0) / 2.0 * 12.0) as usize).min(12);
                let b = if s.friction_share * dir > 0.999 { 13 } else { b };
                let ef = est.force - s.force;
                bins[b][0] += 1.0; bins[b][1] += err; bins[b][2] += err * err; bins[b][3] += (est.standard_deviation).powi(2);
                let _ = ef;
                sx += 0.0;
            }
        }
        let _ = sx;
        println!("frequency {frequency}");
        for (i, b) in bins.iter().enumerate() { println!("{i} n {} mean {:.2} rms {:.2} sd {:.2}", b[0], b[1]/b[0], (b[2]/b[0]).sqrt(), (b[3]/b[0]).sqrt()); }
    }
}
