//! Pushes against an arm that holds still: its joints hardly move, and dry friction takes a part, so that the currents come back to other levels.
//!
//! ```text
//! D(t)^2 = sum over joints of ((i - b(t))/s)^2
//! ```
//!
//! i current or torque, averaged over a tenth of a second, b level between those before and after, s its noise. A push begins and ends where D passes a share of its
//! largest value; its force is that of least squares over the levers, as far as friction leaves it.

use glam::DVec3;
use nalgebra::{Matrix3, Vector3};

use super::input::ArmInput;
use super::pushed::levers;
use crate::recorded_arm::ArmParameters;
use crate::recorded_arm::motion::sample_time;
use crate::recorded_arm::push::Push;
use crate::recorded_arm::simulate::Channel;

/// Time that an arm must hold still [s], and how far a joint may move meanwhile [rad].
const HELD: (f64, f64) = (5.0, 1e-2);
/// Time over which readings are averaged [s].
const AVERAGED: f64 = 0.1;
/// Time over which a push changes them [s].
const CHANGES: f64 = 0.25;
/// Change of an averaged reading over that time, over the noise of one sample, from which something pushes [1].
const SIGNIFICANT: f64 = 4.0;
/// Time between two changes that belong to one push [s].
const ONE_PUSH: f64 = 0.9;
/// Share of the largest departure that a force which is held keeps [1].
const HOLDS: f64 = 0.6;
/// Share of the largest departure within which a push acts [1].
const SHARE: f64 = 0.3;
/// Largest departure of a push, over the noise of one sample [1].
const LARGE: f64 = 5.0;
/// Time before and after a push over which levels are taken [s].
const LEVELS: f64 = 0.4;

/// Pushes while the arm holds still, in the order of time.
#[must_use]
pub fn held_pushes(input: &ArmInput, arm: &ArmParameters) -> Vec<Push> {
    (0..input.recordings.len())
        .filter(|r| holds(input, *r))
        .flat_map(|r| of_recording(input, arm, r))
        .collect()
}

/// Whether no joint moves in a recording.
fn holds(input: &ArmInput, recording: usize) -> bool {
    let motion = &input.recordings[recording].motion;
    let span =
        motion.time.last().copied().unwrap_or(0.0) - motion.time.first().copied().unwrap_or(0.0);
    let still = |q: &Vec<f64>| {
        let (low, high) = q
            .iter()
            .fold((f64::MAX, f64::MIN), |(a, b), q| (a.min(*q), b.max(*q)));
        high - low < HELD.1
    };
    span >= HELD.0 && motion.position.iter().all(still)
}

fn of_recording(input: &ArmInput, arm: &ArmParameters, recording: usize) -> Vec<Push> {
    let own = &input.recordings[recording];
    let step = sample_time(&own.motion.time);
    let drives: Vec<(usize, usize, Vec<f64>)> = (input.channels.iter().enumerate())
        .filter_map(|(c, channel)| match channel {
            Channel::Drive(joint) => {
                let over: Vec<f64> = own.readings[c].iter().map(|r| r / input.noise[c]).collect();
                Some((c, *joint, averaged(&over, (AVERAGED / step) as usize)))
            }
            _ => None,
        })
        .collect();
    let count = own.motion.len();
    let lag = ((CHANGES / step) as usize).max(1);
    let changes = |i: usize| {
        let largest = drives.iter().map(|(_, _, d)| {
            let j = (i + lag).min(count - 1);
            (d[j] - d[i]).abs()
        });
        largest.fold(0.0, f64::max)
    };
    let busy: Vec<bool> = (0..count).map(|i| changes(i) > SIGNIFICANT).collect();
    let mut stretches: Vec<[usize; 2]> = Vec::new();
    let bridge = (ONE_PUSH / step) as usize;
    for i in (0..count).filter(|i| busy[*i]) {
        let end = (i + lag).min(count - 1);
        match stretches.last_mut() {
            Some([_, last]) if i <= *last + bridge => *last = end,
            _ => stretches.push([i, end]),
        }
    }
    let level = |range: std::ops::Range<usize>| -> Vec<f64> {
        let means = drives.iter().map(|(_, _, d)| mean(d, range.clone()));
        means.collect()
    };
    let quiet = (LEVELS / step) as usize;
    let away = |a: &[f64], b: &[f64]| -> f64 {
        let squares = a.iter().zip(b).map(|(a, b)| (a - b).powi(2));
        squares.sum::<f64>().sqrt()
    };
    let mut found = Vec::new();
    let mut next = stretches.into_iter().peekable();
    while let Some([first, mut last]) = next.next() {
        let before = level(first.saturating_sub(quiet)..first.max(1));
        // A force that is held still departs as far as while it grew.
        while let Some([start, end]) = next.peek().copied() {
            let most = (first..=last)
                .map(|i| away(&level(i..i + 1), &before))
                .fold(0.0, f64::max);
            if away(&level(last..start.max(last + 1)), &before) < HOLDS * most {
                break;
            }
            last = end;
            next.next();
        }
        found.extend(push(input, arm, recording, &drives, [first, last]));
    }
    found
}

/// Mean over samples.
fn mean(d: &[f64], range: std::ops::Range<usize>) -> f64 {
    let end = range.end.clamp(1, d.len());
    let part = &d[range.start.min(end - 1)..end];
    part.iter().sum::<f64>() / part.len() as f64
}

/// A push within a stretch of samples; none where nothing departs far.
fn push(
    input: &ArmInput,
    arm: &ArmParameters,
    recording: usize,
    drives: &[(usize, usize, Vec<f64>)],
    [first, last]: [usize; 2],
) -> Option<Push> {
    let motion = &input.recordings[recording].motion;
    let time = &motion.time;
    let step = sample_time(time);
    let samples = |seconds: f64| (seconds / step) as usize;
    let before = first.saturating_sub(samples(LEVELS))..first.max(1);
    let after = last..last + samples(LEVELS);
    let levels: Vec<[f64; 2]> = (drives.iter())
        .map(|(_, _, d)| [mean(d, before.clone()), mean(d, after.clone())])
        .collect();
    let departure = |i: usize, place: usize| {
        let share = (i - first) as f64 / (last - first).max(1) as f64;
        let [a, b] = levels[place];
        drives[place].2[i] - (a + share * (b - a))
    };
    let size = |i: usize| {
        let squares = (0..drives.len()).map(|place| departure(i, place).powi(2));
        squares.sum::<f64>().sqrt()
    };
    let largest = (first..=last).max_by(|a, b| size(*a).total_cmp(&size(*b)))?;
    let most = size(largest);
    if most < LARGE {
        return None;
    }
    let acts = |i: &usize| size(*i) > SHARE * most;
    let start = (first..=largest).find(acts)?;
    let end = (largest..=last).rev().find(acts)?;
    let lever = levers(arm, motion, largest);
    let (mut a, mut b) = (Matrix3::identity() * 1e-9, Vector3::zeros());
    for (place, (c, joint, _)) in drives.iter().enumerate() {
        let per_torque = arm.drives[*joint].inverse_gain / input.noise[*c];
        let row = Vector3::new(lever[*joint].x, lever[*joint].y, lever[*joint].z) * -per_torque;
        a += row * row.transpose();
        b += row * departure(largest, place);
    }
    let force = a.cholesky()?.solve(&b);
    Some(Push {
        recording,
        start: time[start],
        end: time[end],
        edge: 0.25,
        force: DVec3::new(force[0], force[1], force[2]),
    })
}

/// Mean over so many samples about each.
fn averaged(values: &[f64], count: usize) -> Vec<f64> {
    let half = count / 2;
    let of = |i: usize| {
        let window = &values[i.saturating_sub(half)..(i + half + 1).min(values.len())];
        window.iter().sum::<f64>() / window.len() as f64
    };
    (0..values.len()).map(of).collect()
}
