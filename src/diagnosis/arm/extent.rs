//! Where an effect acts: stretches of channels that it moves beyond their noise.

use super::effect::Candidate;
use super::evidence::{Evidence, course_along};
use super::input::ArmInput;
use crate::recorded_arm::simulate::{Channel, readings};
use crate::recorded_arm::{ArmParameters, Quantity};

/// Standard deviations of its noise by which a channel must be moved [1].
pub const MOVED: f64 = 3.0;
/// Samples that far apart belong to one stretch [s].
const MERGED: f64 = 0.04;
/// What is added at either end of a stretch [s].
const MARGIN: f64 = 0.02;

/// A stretch of a channel.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stretch {
    /// Recording.
    pub recording: usize,
    /// Channel, its place among those measured.
    pub channel: usize,
    /// Start [s].
    pub start: f64,
    /// End [s].
    pub end: f64,
}

/// A description with effects put back to what is declared.
#[must_use]
pub fn without(input: &ArmInput, arm: &ArmParameters, effects: &[Candidate]) -> ArmParameters {
    let mut bare = arm.clone();
    for effect in effects {
        for parameter in &effect.free {
            match parameter.quantity {
                Quantity::PushForce(..) | Quantity::LawAmplitude(..) => {
                    parameter.quantity.set(&mut bare, 0.0);
                }
                Quantity::PushStart(_)
                | Quantity::PushEnd(_)
                | Quantity::PushEdge(_)
                | Quantity::LawPlace(_)
                | Quantity::LawWidth(_) => {}
                quantity => quantity.set(&mut bare, quantity.value(&input.nominal)),
            }
        }
    }
    bare
}

/// Change of all channels by effects, by recording, channel and sample, over the noise.
#[must_use]
pub fn changes(input: &ArmInput, arm: &ArmParameters, effects: &[Candidate]) -> Vec<Vec<Vec<f64>>> {
    let bare = without(input, arm, effects);
    let with = course_along(input, arm, None);
    let course = course_along(input, &bare, Some(&with));
    let mut all = Vec::new();
    for (r, recording) in input.recordings.iter().enumerate() {
        let read = |course: &super::evidence::Course, arm: &ArmParameters| {
            let (bristles, rigid) = course.parts(r);
            readings(arm, &recording.motion, &input.channels, bristles, rigid)
        };
        let (a, b) = (read(&with, arm), read(&course, &bare));
        let change = a.iter().zip(&b).zip(&input.noise).map(|((a, b), noise)| {
            let pairs = a.iter().zip(b);
            pairs.map(|(a, b)| (a - b) / noise).collect::<Vec<f64>>()
        });
        all.push(change.collect());
    }
    all
}

/// Largest change that two neighbouring samples of a channel share, over the noise that is left in what the fit compares [1].
#[must_use]
pub fn largest(evidence: &Evidence, changes: &[Vec<Vec<f64>>]) -> f64 {
    let mut largest: f64 = 0.0;
    for (c, rows) in evidence.rows.iter().enumerate() {
        let is_drive = matches!(evidence.input.channels[c], Channel::Drive(_));
        for pair in rows.windows(2) {
            let recording = pair[0].recording;
            if recording != pair[1].recording {
                continue;
            }
            let motion = &evidence.input.recordings[recording].motion;
            let share = if is_drive { motion.noise_share() } else { 1.0 };
            let of = |row: &super::evidence::Row| changes[recording][c][row.sample].abs();
            largest = largest.max(of(&pair[0]).min(of(&pair[1])) / share);
        }
    }
    largest
}

/// Stretches in which channels are moved.
#[must_use]
pub fn stretches(input: &ArmInput, changes: &[Vec<Vec<f64>>]) -> Vec<Stretch> {
    let mut found = Vec::new();
    for (recording, channels) in changes.iter().enumerate() {
        let time = &input.recordings[recording].motion.time;
        for (channel, change) in channels.iter().enumerate() {
            let moved = (0..change.len()).filter(|i| change[*i].abs() > MOVED);
            let mut open: Option<(usize, usize)> = None;
            let mut close = |open: Option<(usize, usize)>| {
                if let Some((first, last)) = open.filter(|(first, last)| last > first) {
                    found.push(Stretch {
                        recording,
                        channel,
                        start: time[first] - MARGIN,
                        end: time[last] + MARGIN,
                    });
                }
            };
            for i in moved {
                match open {
                    Some((first, last)) if time[i] - time[last] <= MERGED + 1e-9 => {
                        open = Some((first, i));
                    }
                    _ => {
                        close(open);
                        open = Some((i, i));
                    }
                }
            }
            close(open);
        }
    }
    found
}
