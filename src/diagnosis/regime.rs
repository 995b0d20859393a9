//! Which variable says when a mismatch appears: the share of its variance that lies between bins of each, by analysis of variance.
//!
//!     eta^2 = SS_between / SS,     F = (SS_between / (k - 1)) / (SS_within / (n - k)),     n = N (1 - rho) / (1 + rho)
//!
//! k bins of as many samples each, N samples, rho their autocorrelation at one step. The share is given less what chance would give (Wherry's adjustment),
//! and F is judged as normal by Paulson's transformation (Ann. Math. Stat. 13, 1942).

use super::evidence::Evidence;
use crate::plant::{PlantCourse, PlantParameters};

/// Bins of a continuous variable.
const BINS: usize = 10;
/// Standard deviations beyond which F is no chance, one in a hundred over all variables and links [1].
const SURE: f64 = 3.6;
/// Speed below which the piston counts as resting [m/s].
const RESTING: f64 = 2e-3;

/// A variable that a mismatch may depend on, by its name in an answer.
pub const VARIABLES: [&str; 13] = [
    "time",
    "stroke_m",
    "velocity",
    "velocity_sign",
    "acceleration",
    "chamber_pressure",
    "pressure_difference",
    "pressure_rate",
    "mass_flow",
    "set_pressure",
    "surface_m",
    "contact_force",
    "phase",
];

/// How much of a mismatch a variable tells.
#[derive(Debug, Clone, PartialEq)]
pub struct Regime {
    /// Its name.
    pub variable: &'static str,
    /// Share of the variance [1].
    pub share: f64,
}

/// Variables that tell when a mismatch appears, the most telling first. `mismatch` has a value per sample, recording by recording.
pub fn regimes(
    evidence: &Evidence,
    plant: &PlantParameters,
    courses: &[PlantCourse],
    mismatch: &[f64],
) -> Vec<Regime> {
    let values = variables(evidence, plant, courses);
    let mut found: Vec<Regime> = VARIABLES
        .into_iter()
        .zip(&values)
        .filter_map(|(variable, values)| {
            let share = share(values, mismatch)?;
            Some(Regime { variable, share })
        })
        .collect();
    found.sort_by(|a, b| b.share.total_cmp(&a.share));
    found
}

/// Values of the variables, in their order.
fn variables(
    evidence: &Evidence,
    plant: &PlantParameters,
    courses: &[PlantCourse],
) -> Vec<Vec<f64>> {
    let mut all = vec![Vec::new(); VARIABLES.len()];
    let device = &plant.device;
    let area = f64::from(device.cylinder_count) * std::f64::consts::FRAC_PI_4 * device.bore.powi(2);
    let energy = device.gas.specific_gas_constant * device.gas.temperature;
    for (measured, course) in evidence.recordings.iter().zip(courses) {
        let inputs = &measured.inputs;
        let truth = &course.truth;
        let mass = |i: usize| {
            let volume = device.dead_volume + area * truth.stroke[i];
            truth.pressures[0][i] * volume / energy
        };
        let count = inputs.time.len();
        for i in 0..count {
            let (before, after) = (i.saturating_sub(1), (i + 1).min(count - 1));
            let span = inputs.time[after] - inputs.time[before];
            let rate = |value: &dyn Fn(usize) -> f64| (value(after) - value(before)) / span;
            let speed = truth.speed[i];
            let sign = if speed.abs() < RESTING {
                0.0
            } else {
                speed.signum()
            };
            let touching = f64::from(u8::from(truth.contact_force[i] > 0.0));
            let extends = f64::from(u8::from(inputs.extends[i]));
            let values = [
                inputs.time[i],
                truth.stroke[i],
                speed,
                sign,
                truth.acceleration[i],
                truth.pressures[0][i],
                truth.pressures[0][i] - truth.pressures[1][i],
                rate(&|i| truth.pressures[0][i]),
                rate(&mass),
                inputs.set_pressure[i],
                inputs.surface[i],
                truth.contact_force[i],
                2.0 * touching + extends,
            ];
            for (all, value) in all.iter_mut().zip(values) {
                all.push(value);
            }
        }
    }
    all
}

/// Share of the variance between bins of a variable; none where it is no more than chance gives.
fn share(variable: &[f64], mismatch: &[f64]) -> Option<f64> {
    let mut pairs: Vec<(f64, f64)> = variable
        .iter()
        .copied()
        .zip(mismatch.iter().copied())
        .filter(|(x, y)| x.is_finite() && y.is_finite())
        .collect();
    let total = pairs.len() as f64;
    if pairs.len() < 5 * BINS {
        return None;
    }
    let mean = pairs.iter().map(|(_, y)| y).sum::<f64>() / total;
    let square: f64 = pairs.iter().map(|(_, y)| (y - mean).powi(2)).sum();
    let product: f64 = pairs
        .windows(2)
        .map(|w| (w[0].1 - mean) * (w[1].1 - mean))
        .sum();
    if square <= 0.0 {
        return None;
    }
    let correlation = (product / square).clamp(0.0, 0.999);
    let independent = total * (1.0 - correlation) / (1.0 + correlation);
    pairs.sort_by(|a, b| a.0.total_cmp(&b.0));
    let bins = bins(&pairs);
    let between: f64 = bins
        .iter()
        .map(|bin| {
            let count = bin.len() as f64;
            let own = bin.iter().map(|(_, y)| y).sum::<f64>() / count;
            count * (own - mean).powi(2)
        })
        .sum();
    let (freedom, rest) = (bins.len() as f64 - 1.0, independent - bins.len() as f64);
    if freedom < 1.0 || rest < 1.0 {
        return None;
    }
    let raw = (between / square).min(1.0 - 1e-12);
    let ratio = raw / (1.0 - raw) * rest / freedom;
    (paulson(ratio, freedom, rest) > SURE).then(|| 1.0 - (1.0 - raw) * (independent - 1.0) / rest)
}

/// Bins of as many samples each; equal values stay together.
fn bins(sorted: &[(f64, f64)]) -> Vec<&[(f64, f64)]> {
    let most = sorted.len().div_ceil(BINS);
    let mut bins = Vec::new();
    let mut start = 0;
    while start < sorted.len() {
        let mut end = (start + most).min(sorted.len());
        let last = sorted[end - 1].0;
        end += sorted[end..].partition_point(|(x, _)| *x <= last);
        bins.push(&sorted[start..end]);
        start = end;
    }
    bins
}

/// F as a normal number.
fn paulson(ratio: f64, freedom: f64, rest: f64) -> f64 {
    let (a, b) = (2.0 / (9.0 * freedom), 2.0 / (9.0 * rest));
    let root = ratio.cbrt();
    ((1.0 - b) * root - (1.0 - a)) / (b * root * root + a).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::{Rng, SeedableRng};
    use rand_distr::StandardNormal;

    #[test]
    fn the_share_of_a_known_dependence_comes_back_and_noise_has_none() {
        let mut random = rand_chacha::ChaCha8Rng::seed_from_u64(3);
        let mut normal = || random.sample::<f64, _>(StandardNormal);
        let count = 4000;
        let sign: Vec<f64> = (0..count).map(|_| normal().signum()).collect();
        let other: Vec<f64> = (0..count).map(|_| normal()).collect();
        // Variance 4 of the sign, 1 of noise.
        let mismatch: Vec<f64> = sign.iter().map(|s| 2.0 * s + normal()).collect();
        let of_sign = share(&sign, &mismatch).unwrap();
        assert!((of_sign - 0.8).abs() < 0.01, "{of_sign}");
        assert_eq!(share(&other, &mismatch), None);
        let noise: Vec<f64> = (0..count).map(|_| normal()).collect();
        assert_eq!(share(&sign, &noise), None);
    }

    #[test]
    fn paulson_gives_the_tables_of_f() {
        // 95 % points: F(5, 20) = 2.711, F(10, 100) = 1.927.
        assert!((paulson(2.711, 5.0, 20.0) - 1.645).abs() < 0.02);
        assert!((paulson(1.927, 10.0, 100.0) - 1.645).abs() < 0.02);
    }
}
