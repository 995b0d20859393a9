//! Where recordings part from a model: by recording and channel, as intervals, and by link of the chain.
//!
//! The piston is held to its measured motion, so that each link is seen with its own measured input: the regulator from set pressure to outlet, the piston by
//! the force that it lacks, the contact and the load cell by the force that they should show where the tool is.

use super::evidence::{Evidence, Prediction};
use super::fit::robust_sum;
use super::mismatch::merged;
use crate::plant::{CHANNELS, Channel};

/// Chance that any interval is flagged where there is noise alone [1].
const FALSE_ALARM: f64 = 0.01;
/// Half the time over which residuals are taken together [s].
const HALF_WINDOW: f64 = 0.01;
/// Error in time that is forgiven where links are looked at [s].
const ROUGH_TIME: f64 = 0.006;
/// Root mean square, in standard deviations, up to which a channel shows its noise: that is known no better [1].
pub const NOISE_ALONE: f64 = 1.15;

/// How far a channel of a recording is from what is predicted.
#[derive(Debug, Clone, PartialEq)]
pub struct Misfit {
    /// Index of the recording.
    pub recording: usize,
    /// The channel.
    pub channel: Channel,
    /// Samples that count.
    pub samples: usize,
    /// Robust root mean square, in standard deviations of the noise [1].
    pub sigmas: f64,
}

/// A time in which a channel parts from a model.
#[derive(Debug, Clone, PartialEq)]
pub struct Parting {
    /// Index of the recording.
    pub recording: usize,
    /// The channel.
    pub channel: Channel,
    /// Its start and end [s].
    pub span: [f64; 2],
}

/// Residuals of each recording and channel.
pub fn by_channel<'a>(
    evidence: &'a Evidence,
    residuals: &'a [f64],
) -> impl Iterator<Item = (usize, Channel, &'a [f64])> {
    let mut start = 0;
    let recordings = evidence.recordings.iter().enumerate();
    recordings.flat_map(move |(recording, measured)| {
        let count = measured.inputs.time.len();
        let first = start;
        start += CHANNELS.len() * count;
        CHANNELS.into_iter().enumerate().map(move |(at, channel)| {
            let from = first + at * count;
            (recording, channel, &residuals[from..from + count])
        })
    })
}

/// Robust root mean square; none where nothing counts.
pub fn robust_rms(residuals: &[f64]) -> Option<(usize, f64)> {
    let samples = residuals.iter().filter(|r| r.is_finite()).count();
    (samples > 0).then(|| (samples, (robust_sum(residuals) / samples as f64).sqrt()))
}

/// How far each channel is from a prediction; channels that were not measured are left out.
pub fn misfits(evidence: &Evidence, residuals: &[f64]) -> Vec<Misfit> {
    let channels = by_channel(evidence, residuals);
    channels
        .filter_map(|(recording, channel, residuals)| {
            let (samples, sigmas) = robust_rms(residuals)?;
            Some(Misfit {
                recording,
                channel,
                samples,
                sigmas,
            })
        })
        .collect()
}

/// Where channels part from a prediction: where means over a short time are larger than noise ever gives, or but once in a hundred such cases.
pub fn partings(evidence: &Evidence, residuals: &[f64]) -> Vec<Parting> {
    // Of N normal numbers, the chance that one exceeds z is below N exp(-z^2/2).
    let limit = (2.0 * (residuals.len() as f64 / FALSE_ALARM).ln()).sqrt();
    let mut found = Vec::new();
    for (recording, channel, residuals) in by_channel(evidence, residuals) {
        let time = &evidence.recordings[recording].inputs.time;
        let sums = running(residuals);
        let parts = |i: usize| {
            let from = time.partition_point(|t| *t < time[i] - HALF_WINDOW);
            let to = time.partition_point(|t| *t <= time[i] + HALF_WINDOW);
            let (sum, count) = (sums[to].0 - sums[from].0, sums[to].1 - sums[from].1);
            count > 0.0 && sum.abs() > limit * count.sqrt()
        };
        let spans = merged(time, parts);
        found.extend(spans.into_iter().map(|span| Parting {
            recording,
            channel,
            span,
        }));
    }
    found
}

/// Running sums and counts of what is finite.
fn running(values: &[f64]) -> Vec<(f64, f64)> {
    let mut sums = Vec::with_capacity(values.len() + 1);
    let mut at = (0.0, 0.0);
    sums.push(at);
    for value in values {
        if value.is_finite() {
            at = (at.0 + value, at.1 + 1.0);
        }
        sums.push(at);
    }
    sums
}

/// A link of the chain, seen with its own measured input.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Link {
    /// Set pressure to outlet.
    Regulator,
    /// Outlet to the forces on the piston, along its measured motion: chambers and force balance.
    Piston,
    /// Motion to force reading: contact and load cell.
    Contact,
}

/// What a link leaves unexplained, one value per sample, recording by recording; NaN where it does not show.
#[derive(Debug, Clone)]
pub struct LinkResidual {
    /// The link.
    pub link: Link,
    /// Measured less predicted, in standard deviations; what may be an error in time counts less.
    pub sigmas: Vec<f64>,
    /// Robust root mean square of them [1].
    pub size: f64,
    /// One standard deviation, in the unit of the link: that of the outlet [Pa], that of forces [N].
    pub unit: f64,
}

/// What each link leaves, of a prediction with the piston held to its measured motion.
pub fn links(evidence: &Evidence, held: &Prediction) -> Vec<LinkResidual> {
    let mass = held.plant.device.moving_mass;
    let [outlet, _, force, acceleration] = evidence.noise;
    let on_piston = force.hypot(mass * acceleration);
    let all = [
        (Link::Regulator, outlet, at_regulator(evidence, held)),
        (
            Link::Piston,
            on_piston,
            on_the_piston(evidence, held, on_piston),
        ),
        (Link::Contact, force, in_contact(evidence, held)),
    ];
    all.into_iter()
        .filter_map(|(link, unit, sigmas)| {
            let (_, size) = robust_rms(&sigmas)?;
            Some(LinkResidual {
                link,
                sigmas,
                size,
                unit,
            })
        })
        .collect()
}

fn at_regulator(evidence: &Evidence, held: &Prediction) -> Vec<f64> {
    by_channel(evidence, &held.residuals)
        .filter(|(_, channel, _)| *channel == Channel::RegulatorPressure)
        .flat_map(|(_, _, residuals)| residuals.iter().copied())
        .collect()
}

/// The force that the piston lacks: M (a_m - g) + F_m - P, P that of the chambers, seals and end stops along the measured motion.
fn on_the_piston(evidence: &Evidence, held: &Prediction, deviation: f64) -> Vec<f64> {
    let plant = &held.plant;
    let mass = plant.device.moving_mass;
    let weight = mass * plant.gravity_along_extension;
    let shares = evidence.shares(ROUGH_TIME, false);
    let mut all = Vec::new();
    let mut first = 0;
    for (measured, course) in evidence.recordings.iter().zip(&held.courses) {
        let count = measured.inputs.time.len();
        let truth = &course.truth;
        for i in 0..count {
            let outside = weight + truth.hold_force[i] - truth.contact_force[i];
            let inside = mass * truth.acceleration[i] - outside;
            let force = if measured.free {
                0.0
            } else {
                measured.readings[2][i]
            };
            let lacking = mass * measured.readings[3][i] - weight + force - inside;
            let share = shares[first + 2 * count + i].min(shares[first + 3 * count + i]);
            all.push(share * lacking / deviation);
        }
        first += CHANNELS.len() * count;
    }
    all
}

/// Force reading less that of the contact at the measured stroke; the noise of the stroke goes through the contact's stiffness and damping.
fn in_contact(evidence: &Evidence, held: &Prediction) -> Vec<f64> {
    let plant = &held.plant;
    let contact = &plant.contact;
    let shares = evidence.shares(ROUGH_TIME, false);
    let [_, stroke_noise, force_noise, _] = evidence.noise;
    let mut all = Vec::new();
    let mut first = 0;
    for measured in &evidence.recordings {
        let time = &measured.inputs.time;
        let count = time.len();
        let readings = &measured.readings;
        for i in 0..count {
            let (before, after) = (i.saturating_sub(1), (i + 1).min(count - 1));
            let span = time[after] - time[before];
            let (deviation, its_rate) = contact.deviation(time[i]);
            let depth =
                |i: usize| readings[1][i] / plant.sensors.stroke_gain - measured.inputs.surface[i];
            let rate = (depth(after) - depth(before)) / span - its_rate;
            let expected = contact.force(depth(i) - deviation, rate);
            let slope = if expected > 0.0 {
                contact
                    .stiffness_at(expected)
                    .hypot(contact.damping * 2f64.sqrt() / span)
            } else {
                0.0
            };
            let noise = force_noise.hypot(stroke_noise * slope);
            let share = shares[first + 2 * count + i];
            all.push(share * (readings[2][i] - expected) / noise);
        }
        first += CHANNELS.len() * count;
    }
    all
}
