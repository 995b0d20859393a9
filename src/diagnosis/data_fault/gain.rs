//! Slips of unit and sign: a gain among the usual factors.

use super::curvature::curvature_ratio;
use super::fault::{DataFault, Kind};
use crate::diagnosis::recordings::input::DiagnosisInput;
use crate::plant::{CHANNELS, Channel, InitialState, PlantInputs, simulate};

/// Standard gravity [m/s2]: a kilogram-force in newton.
const STANDARD_GRAVITY: f64 = 9.80665;
/// A pound-force in newton.
const POUND_FORCE: f64 = 4.448_221_615;
/// A pound-force per square inch in pascal.
const PSI: f64 = 6_894.757_293;
/// Times that the nominal model may be off [1]: usual factors are farther from one another.
const NEAR: f64 = 1.6;
/// Correlation with the nominal model from which it says the factor [1].
const ALIKE: f64 = 0.7;

/// Usual factors of a channel's unit [1].
fn usual(channel: Channel) -> &'static [f64] {
    match channel {
        Channel::Force => &[
            1.0 / STANDARD_GRAVITY,
            STANDARD_GRAVITY,
            1.0 / POUND_FORCE,
            POUND_FORCE,
            1e-3,
            1e3,
        ],
        Channel::RegulatorPressure => &[1e-5, 1e-2, 1e-3, 1e-6, 1.0 / PSI],
        Channel::Stroke => &[1e3, 1e2, 1.0 / 0.0254, 1e6],
        Channel::Acceleration => &[1.0 / STANDARD_GRAVITY, STANDARD_GRAVITY, 1e3, 1e2],
    }
}

/// Channels in another unit or with the other sign.
pub(super) fn gains(case: &DiagnosisInput) -> Vec<DataFault> {
    let simulated: Vec<[Vec<f64>; 4]> = (case.recordings.iter())
        .map(|r| {
            // In another unit the first readings say another start than the true one.
            let inputs = PlantInputs {
                initial: InitialState::AtRest,
                ..r.recorded.inputs.clone()
            };
            simulate(&case.nominal, &inputs).readings
        })
        .collect();
    let mut faults = Vec::new();
    for channel in CHANNELS {
        let found = match channel {
            Channel::Acceleration => curvature_ratio(case).map(|(ratio, _)| ratio),
            _ => slope(case, &simulated, channel as usize),
        };
        let Some(found) = found else { continue };
        let factors = usual(channel).iter().chain(&[1.0]);
        let nearest = factors
            .min_by(|a, b| off(found, **a).total_cmp(&off(found, **b)))
            .copied()
            .unwrap_or(1.0);
        let gain = nearest * found.signum();
        if gain != 1.0 && off(found, nearest) < NEAR.ln() {
            faults.push(DataFault::of(Kind::Gain(gain), channel, None, 0.99));
        }
    }
    faults
}

/// Distance of the size of a factor from another, as a logarithm [1].
fn off(found: f64, factor: f64) -> f64 {
    (found.abs() / factor).ln().abs()
}

/// Slope of what was measured against what the nominal model gives; none where they are not alike.
fn slope(case: &DiagnosisInput, simulated: &[[Vec<f64>; 4]], channel: usize) -> Option<f64> {
    let (mut both, mut own, mut other) = (0.0, 0.0, 0.0);
    for (recording, simulated) in case.recordings.iter().zip(simulated) {
        let measured = &recording.recorded.readings[channel];
        let pairs = || {
            let pairs = measured.iter().zip(&simulated[channel]);
            pairs.filter(|(m, s)| m.is_finite() && s.is_finite())
        };
        let count = pairs().count().max(1) as f64;
        let mean = pairs().fold([0.0; 2], |[m, s], pair| {
            [m + pair.0 / count, s + pair.1 / count]
        });
        for (m, s) in pairs() {
            let (m, s) = (m - mean[0], s - mean[1]);
            both += m * s;
            own += m * m;
            other += s * s;
        }
    }
    let correlation = both / (own * other).sqrt();
    (correlation.abs() >= ALIKE).then(|| both / other)
}
