//! Residual of each link of the chain, given its own measured input, and moved within the rig file's tolerances to explain its own output alone.
//!
//! The chain is cut at the motion: the piston is held to the measured one, so that the regulator is seen from set pressure to outlet, the piston by the force
//! that it lacks, the contact and the load cell by the force that they should show where the tool is. What a joint fit of a model that lacks something
//! would blame on one link for the sake of another does not show here.

use super::localise::robust_rms;
use crate::diagnosis::fit::free::Free;
use crate::diagnosis::fit::with_values;
use crate::diagnosis::recordings::evidence::{Evidence, Measured, Prediction, by_channel, starts};
use crate::diagnosis::settings::HUBER;
use crate::plant::{Channel, PlantParameters, PlantTrajectory, Trajectory, readings};
use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

/// Error in time that is forgiven [s].
const ROUGH_TIME: f64 = 0.006;
/// Step of the difference quotients in the fit's coordinate [1].
const STEP: f64 = 0.1;

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

/// Unexplained residual of a link, one value per sample, recording by recording; NaN where it does not show.
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

/// All links.
const LINKS: [Link; 3] = [Link::Regulator, Link::Piston, Link::Contact];

/// Residual of each link of a prediction with the piston held to its measured motion, after one step of Gauss and Newton of `tolerated` for that link alone.
#[must_use]
pub fn links(evidence: &Evidence, held: &Prediction, tolerated: &[Free]) -> Vec<LinkResidual> {
    let values: Vec<f64> = tolerated
        .iter()
        .map(|f| f.clamp(f.quantity.get(&held.plant)))
        .collect();
    let steps: Vec<f64> = tolerated
        .iter()
        .zip(&values)
        .map(|(f, v)| {
            let ahead = f.coordinate.value(f.coordinate.of(*v) + STEP);
            if ahead > f.bounds[1] { -STEP } else { STEP }
        })
        .collect();
    let moved: Vec<PlantParameters> = (0..tolerated.len())
        .map(|i| {
            let f = &tolerated[i];
            let mut plant = held.plant.clone();
            f.quantity.set(
                &mut plant,
                f.coordinate.value(f.coordinate.of(values[i]) + steps[i]),
            );
            plant
        })
        .collect();
    let moved: Vec<Prediction> = moved
        .par_iter()
        .map(|plant| evidence.predict(plant, true, Some(held)))
        .collect();
    let of_link = |link: Link| {
        let here = residuals(link, evidence, held);
        let columns: Vec<Vec<f64>> = moved
            .iter()
            .zip(&steps)
            .map(|(there, step)| {
                let there = residuals(link, evidence, there);
                let pairs = there.iter().zip(&here);
                pairs.map(|(there, here)| (there - here) / step).collect()
            })
            .collect();
        let adjusted = adjusted(&here, &columns, tolerated, &values);
        let plant = with_values(&held.plant, tolerated, &adjusted);
        let sigmas = residuals(link, evidence, &evidence.predict(&plant, true, Some(held)));
        let (_, before) = robust_rms(&here)?;
        let (_, after) = robust_rms(&sigmas)?;
        let (sigmas, size) = if after < before {
            (sigmas, after)
        } else {
            (here, before)
        };
        let unit = unit(link, evidence, &held.plant);
        Some(LinkResidual {
            link,
            sigmas,
            size,
            unit,
        })
    };
    LINKS.into_iter().filter_map(of_link).collect()
}

/// Values after one step for these residuals alone, priors included.
fn adjusted(here: &[f64], columns: &[Vec<f64>], free: &[Free], values: &[f64]) -> Vec<f64> {
    let count = free.len();
    let weight = |r: f64| {
        if r.abs() <= HUBER {
            1.0
        } else {
            HUBER / r.abs()
        }
    };
    let product = |one: &[f64], other: &[f64]| -> f64 {
        let samples = one.iter().zip(other).zip(here);
        samples
            .map(|((one, other), r)| weight(*r) * one * other)
            .filter(|product| product.is_finite())
            .sum()
    };
    let mut normal = DMatrix::from_fn(count, count, |i, j| product(&columns[i], &columns[j]));
    let mut gradient = DVector::from_fn(count, |i, _| product(&columns[i], here));
    for (i, f) in free.iter().enumerate() {
        let slope = f.departure_slope(values[i]);
        normal[(i, i)] += slope * slope + 1e-9;
        gradient[i] += slope * f.departure(values[i]);
    }
    let Some(step) = normal.cholesky().map(|c| c.solve(&gradient)) else {
        return values.to_vec();
    };
    let moved =
        |(i, f): (usize, &Free)| f.clamp(f.coordinate.value(f.coordinate.of(values[i]) - step[i]));
    free.iter().enumerate().map(moved).collect()
}

/// One standard deviation of what a link leaves, in its unit.
fn unit(link: Link, evidence: &Evidence, plant: &PlantParameters) -> f64 {
    let [outlet, _, force, acceleration] = evidence.noise;
    match link {
        Link::Regulator => outlet,
        Link::Piston => force.hypot(plant.device.moving_mass * acceleration),
        Link::Contact => force,
    }
}

/// Residual of a link of a prediction with the piston held to its measured motion, in standard deviations; what sensors add beyond those of `plain` is
/// taken from the readings first.
pub fn left_by(
    link: Link,
    evidence: &Evidence,
    held: &Prediction,
    plain: &PlantParameters,
) -> Vec<f64> {
    let plain = PlantParameters {
        sensors: plain.sensors,
        ..held.plant.clone()
    };
    if link == Link::Regulator || plain.sensors == held.plant.sensors {
        return residuals(link, evidence, held);
    }
    let without = |(measured, trajectory): (&Measured, &PlantTrajectory)| {
        let mut measured = measured.clone();
        let plain = readings(&plain, &measured.inputs, &trajectory.truth);
        for ((corrected, read), plain) in measured
            .readings
            .iter_mut()
            .zip(&trajectory.readings)
            .zip(&plain)
        {
            for ((corrected, read), plain) in corrected.iter_mut().zip(read).zip(plain) {
                *corrected -= read - plain;
            }
        }
        measured
    };
    let recordings = evidence.recordings.iter().zip(&held.trajectories);
    let corrected = Evidence::new(recordings.map(without).collect(), evidence.noise);
    residuals(link, &corrected, held)
}

fn residuals(link: Link, evidence: &Evidence, held: &Prediction) -> Vec<f64> {
    match link {
        Link::Regulator => at_regulator(evidence, held),
        Link::Piston => on_the_piston(evidence, held, unit(link, evidence, &held.plant)),
        Link::Contact => in_contact(evidence, held),
    }
}

fn at_regulator(evidence: &Evidence, held: &Prediction) -> Vec<f64> {
    by_channel(evidence, &held.residuals)
        .filter(|(_, channel, _)| *channel == Channel::RegulatorPressure)
        .flat_map(|(_, _, residuals)| residuals.iter().copied())
        .collect()
}

/// Channels that see a force on the piston: load cell and accelerometer.
pub(in crate::diagnosis) const ON_THE_PISTON: [usize; 2] =
    [Channel::Force as usize, Channel::Acceleration as usize];

/// The force that the piston lacks at a sample [N]: M (a_m - g) + F_m - P, P that of the chambers, seals and end stops along the measured motion.
pub(in crate::diagnosis) fn lacking(
    measured: &Measured,
    held: &Trajectory,
    plant: &PlantParameters,
    i: usize,
) -> f64 {
    let mass = plant.device.moving_mass;
    let weight = mass * plant.gravity_along_extension;
    let outside = weight + held.hold_force[i] - held.contact_force[i];
    let inside = mass * held.acceleration[i] - outside;
    let force = if measured.free {
        0.0
    } else {
        measured.readings[2][i]
    };
    mass * measured.readings[3][i] - weight + force - inside
}

/// The same at all samples, in standard deviations.
fn on_the_piston(evidence: &Evidence, held: &Prediction, deviation: f64) -> Vec<f64> {
    let plant = &held.plant;
    let shares = evidence.shares(ROUGH_TIME, false);
    let mut all = Vec::new();
    let recordings = evidence.recordings.iter().zip(&held.trajectories);
    for ((measured, trajectory), first) in recordings.zip(starts(evidence)) {
        let count = measured.inputs.time.len();
        for i in 0..count {
            let lacking = lacking(measured, &trajectory.truth, plant, i);
            let share = shares[first + 2 * count + i].min(shares[first + 3 * count + i]);
            all.push(share * lacking / deviation);
        }
    }
    all
}

/// Force reading less that of the contact at the measured stroke; the noise of the stroke goes through the contact's stiffness and damping.
fn in_contact(evidence: &Evidence, held: &Prediction) -> Vec<f64> {
    let plant = &held.plant;
    let shares = evidence.shares(ROUGH_TIME, false);
    let [_, stroke_noise, force_noise, _] = evidence.noise;
    let mut all = Vec::new();
    for (measured, first) in evidence.recordings.iter().zip(starts(evidence)) {
        let contact = plant.contact.in_recording(measured.inputs.place);
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
    }
    all
}
