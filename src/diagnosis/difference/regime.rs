//! Which variable says when a mismatch appears: the correlation_ratio of its variance that lies between bins of each.
//!
//! ```text
//! eta^2 = SS_between / SS,     correlation_ratio = (eta^2 - e) / (1 - e)
//! ```
//!
//! e what the variable has by chance: the mean of eta^2 over mismatches shifted in time against it, round about. They have the same trajectory, so that nothing
//! need be known of how far neighbouring samples depend on each other; the test of F would. A variable is named if few shifts have as much.

use crate::diagnosis::recordings::evidence::Evidence;
use crate::plant::{PlantParameters, PlantTrajectory};

/// Bins of a continuous variable.
const BINS: usize = 10;
/// Shifts in time.
const SHIFTS: usize = 99;
/// Shifts that may have as much: one chance in twenty.
const AS_MUCH: usize = 4;
/// Speed below which the piston counts as resting [m/s].
const RESTING: f64 = 2e-3;

/// The variable that every mismatch has.
pub const TIME: &str = "time";

/// A variable that a mismatch may depend on, by its name in an answer.
pub const VARIABLES: [&str; 13] = [
    TIME,
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

/// Share of a mismatch that a variable explains.
#[derive(Debug, Clone, PartialEq)]
pub struct Regime {
    /// Its name.
    pub variable: &'static str,
    /// Share of the variance [1].
    pub correlation_ratio: f64,
}

/// Variables that tell when a mismatch appears, the most informative first. `mismatch` has a value per sample, recording by recording.
pub fn regimes(
    evidence: &Evidence,
    plant: &PlantParameters,
    trajectories: &[PlantTrajectory],
    mismatch: &[f64],
) -> Vec<Regime> {
    let values = variables(evidence, plant, trajectories);
    let mut found: Vec<Regime> = VARIABLES
        .into_iter()
        .zip(&values)
        .filter_map(|(variable, values)| {
            let correlation_ratio = correlation_ratio(values, mismatch)?;
            Some(Regime {
                variable,
                correlation_ratio,
            })
        })
        .collect();
    found.sort_by(|a, b| b.correlation_ratio.total_cmp(&a.correlation_ratio));
    found
}

/// Values of a variable by its name, one per sample, recording by recording; none where there is no such variable.
pub fn values_of(
    variable: &str,
    evidence: &Evidence,
    plant: &PlantParameters,
    trajectories: &[PlantTrajectory],
) -> Option<Vec<f64>> {
    let place = VARIABLES.iter().position(|name| *name == variable)?;
    Some(variables(evidence, plant, trajectories).swap_remove(place))
}

/// Values of the variables, in their order.
fn variables(
    evidence: &Evidence,
    plant: &PlantParameters,
    trajectories: &[PlantTrajectory],
) -> Vec<Vec<f64>> {
    let mut all = vec![Vec::new(); VARIABLES.len()];
    let device = &plant.device;
    let area = f64::from(device.cylinder_count) * std::f64::consts::FRAC_PI_4 * device.bore.powi(2);
    let energy = device.gas.specific_gas_constant * device.gas.temperature;
    for (measured, trajectory) in evidence.recordings.iter().zip(trajectories) {
        let inputs = &measured.inputs;
        let truth = &trajectory.truth;
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
fn correlation_ratio(variable: &[f64], mismatch: &[f64]) -> Option<f64> {
    let pairs = variable.iter().copied().zip(mismatch.iter().copied());
    let (variable, mut mismatch): (Vec<f64>, Vec<f64>) = pairs
        .filter(|(x, y)| x.is_finite() && y.is_finite())
        .unzip();
    let count = mismatch.len();
    if count < 5 * BINS {
        return None;
    }
    let mean = mismatch.iter().sum::<f64>() / count as f64;
    for y in &mut mismatch {
        *y -= mean;
    }
    let square: f64 = mismatch.iter().map(|y| y * y).sum();
    let bins = bins(&variable);
    let kinds = bins.iter().max().map_or(0, |last| last + 1);
    if kinds < 2 || square <= 0.0 {
        return None;
    }
    let mut sizes = vec![0.0; kinds];
    for bin in &bins {
        sizes[*bin] += 1.0;
    }
    let between = |shift: usize| -> f64 {
        let mut sums = vec![0.0; kinds];
        let shifted = mismatch[shift..].iter().chain(&mismatch[..shift]);
        for (bin, y) in bins.iter().zip(shifted) {
            sums[*bin] += y;
        }
        let squares = sums.iter().zip(&sizes).map(|(sum, size)| sum * sum / size);
        squares.sum::<f64>() / square
    };
    let own = between(0);
    let chance: Vec<f64> = (1..=SHIFTS)
        .map(|i| between(i * count / (SHIFTS + 1)))
        .collect();
    let expected = chance.iter().sum::<f64>() / SHIFTS as f64;
    let as_much = chance.iter().filter(|other| **other >= own).count();
    (as_much <= AS_MUCH).then(|| ((own - expected) / (1.0 - expected)).max(0.0))
}

/// Bin of each sample, as many samples in each; equal values stay together.
fn bins(variable: &[f64]) -> Vec<usize> {
    let mut order: Vec<usize> = (0..variable.len()).collect();
    order.sort_by(|a, b| variable[*a].total_cmp(&variable[*b]));
    let most = order.len().div_ceil(BINS);
    let mut bins = vec![0; variable.len()];
    let (mut bin, mut held) = (0, 0);
    for (place, index) in order.iter().enumerate() {
        let new = place > 0 && variable[*index] > variable[order[place - 1]];
        if held >= most && new {
            bin += 1;
            held = 0;
        }
        bins[*index] = bin;
        held += 1;
    }
    bins
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
        let of_sign = correlation_ratio(&sign, &mismatch).unwrap();
        assert!((of_sign - 0.8).abs() < 0.01, "{of_sign}");
        assert!(
            correlation_ratio(&other, &mismatch)
                .is_none_or(|correlation_ratio| correlation_ratio < 0.01)
        );
    }

    #[test]
    fn what_drifts_slowly_is_not_taken_for_a_dependence() {
        // Two slow waves that have nothing to do with each other.
        let wave = |period: f64, i: i32| (f64::from(i) * std::f64::consts::TAU / period).sin();
        let mismatch: Vec<f64> = (0..4000).map(|i| wave(1300.0, i)).collect();
        let other: Vec<f64> = (0..4000).map(|i| wave(910.0, i)).collect();
        assert_eq!(correlation_ratio(&other, &mismatch), None);
        assert!(correlation_ratio(&mismatch, &mismatch).unwrap() > 0.9);
    }
}
