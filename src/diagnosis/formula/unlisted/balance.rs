//! Residual of the balance at a term's port, straight from the recordings, with the term taken out of the improved model.
//!
//! ```text
//! force on the piston:   M a_m - W + F_m - P,   the piston held to its measured motion
//! reading or outlet:     measured less predicted
//! ```
//!
//! a_m acceleration and F_m force as measured, M mass, W weight, P force of chambers, seals and stops. Medians over narrow ranges of the variable: dots
//! beside the curve that was fitted.

use crate::diagnosis::difference::links::{ON_THE_PISTON, lacking};
use crate::diagnosis::fit::hypothesis::Hypothesis;
use crate::diagnosis::recordings::evidence::{Evidence, Prediction, starts};
use crate::plant::{Basis, Latent, Port};
use crate::stats::{NORMAL_MAD, quantiles};

/// Ranges of the variable.
const RANGES: usize = 60;
/// Samples in a range from which their median is shown.
const LEAST: usize = 8;
/// Standard error of a median from which it is not shown, as a share of the term from its least to its largest value [1].
const UNSURE: f64 = 0.1;
/// Error in time that is forgiven [s], and what a sample must count beside it to be taken: others are near an impact [1].
const FORGIVEN: f64 = 0.006;
const COUNTS: f64 = 0.5;
/// Speed from which the direction of motion is clear [m/s].
const MOVING: f64 = 6e-3;

/// A median of what would close the balance.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Needed {
    /// Value of the variable, or time within a period [SI].
    pub at: f64,
    /// The required value there [SI].
    pub value: f64,
}

/// From the least to the largest value that the variable has in the recordings.
#[must_use]
pub fn visited(evidence: &Evidence, hypothesis: &Hypothesis, latent: &Latent) -> Option<[f64; 2]> {
    let mut ends = [f64::INFINITY, f64::NEG_INFINITY];
    let trajectories = &hypothesis.fit.prediction.trajectories;
    for (measured, trajectory) in evidence.recordings.iter().zip(trajectories) {
        for i in 0..measured.inputs.time.len() {
            let at = trajectory
                .truth
                .moment(&measured.inputs, i)
                .of(latent.variable);
            if at.is_finite() {
                ends = [ends[0].min(at), ends[1].max(at)];
            }
        }
    }
    (ends[0] < ends[1]).then_some(ends)
}

/// Residual of the balance over a range of the variable; nothing where no reading shows it.
#[must_use]
pub fn needed(
    evidence: &Evidence,
    hypothesis: &Hypothesis,
    latent: &Latent,
    [from, to]: [f64; 2],
    peak_to_peak: f64,
) -> Vec<Needed> {
    let channel = match latent.port {
        Port::PistonForce | Port::Friction => None,
        Port::PressureReading | Port::OutletPressure => Some(0),
        Port::StrokeReading => Some(1),
        Port::ForceReading => Some(2),
        Port::SetPressure
        | Port::FirstChamberFlow
        | Port::SecondChamberFlow
        | Port::FirstChamberLeak
        | Port::SecondChamberLeak
        | Port::SupplyOrifice
        | Port::ExhaustOrifice
        | Port::Surface
        | Port::ContactStiffness => return Vec::new(),
    };
    let mut plant = hypothesis.fit.prediction.plant.clone();
    plant.latent = None;
    let without = evidence.predict(&plant, channel.is_none(), None);
    let mut ranges: Vec<Vec<f64>> = vec![Vec::new(); RANGES];
    for (at, value) in samples(evidence, &without, latent, channel) {
        let share = (at - from) / (to - from);
        if value.is_finite() && (0.0..1.0).contains(&share) {
            ranges[(share * RANGES as f64) as usize].push(value);
        }
    }
    let width = (to - from) / RANGES as f64;
    let ranges = ranges.into_iter().enumerate();
    ranges
        .filter(|(_, values)| values.len() >= LEAST)
        .filter_map(|(index, values)| {
            let (value, error) = middle(&values)?;
            (error < UNSURE * peak_to_peak).then_some(Needed {
                at: from + width * (index as f64 + 0.5),
                value,
            })
        })
        .collect()
}

/// Value of the variable and what is needed, sample by sample.
fn samples(
    evidence: &Evidence,
    without: &Prediction,
    latent: &Latent,
    channel: Option<usize>,
) -> Vec<(f64, f64)> {
    let shares = evidence.shares(FORGIVEN, false);
    let seen = channel.map_or(&ON_THE_PISTON[..], |_| &[]);
    let mut all = Vec::new();
    let recordings = evidence.recordings.iter().zip(&without.trajectories);
    for ((measured, trajectory), start) in recordings.zip(starts(evidence)) {
        let count = measured.inputs.time.len();
        for i in 0..count {
            let counts = |channel: &usize| shares[start + channel * count + i] > COUNTS;
            if !seen.iter().chain(&channel).all(counts) {
                continue;
            }
            let moment = trajectory.truth.moment(&measured.inputs, i);
            let mut value = match channel {
                None => lacking(measured, &trajectory.truth, &without.plant, i),
                Some(channel) => measured.readings[channel][i] - trajectory.readings[channel][i],
            };
            if latent.turns_with_motion() {
                if moment.speed.abs() < MOVING {
                    continue;
                }
                // Friction is reported as it resists.
                let against = latent.port == Port::Friction;
                value *= moment.speed.signum() * if against { -1.0 } else { 1.0 };
            }
            let at = moment.of(latent.variable);
            let at = match latent.basis {
                Basis::Hats { .. } | Basis::Formula(_) => at,
                Basis::Waves { frequency } => at.rem_euclid(1.0 / frequency),
            };
            all.push((at, value));
        }
    }
    all
}

/// Median with its standard error, from the quartiles as of a normal distribution.
fn middle(values: &[f64]) -> Option<(f64, f64)> {
    let quartiles = quantiles(values, &[0.25, 0.5, 0.75])?;
    let deviation = 0.5 * NORMAL_MAD * (quartiles[2] - quartiles[0]);
    Some((
        quartiles[1],
        1.253 * deviation / (values.len() as f64).sqrt(),
    ))
}
