//! Recordings as rows that a fit compares, and what a model gives there.
//!
//! A joint that stands still holds whatever friction it came to rest with, so its current counts only while it moves, and once it has moved over several
//! lengths of its bristles.

use std::sync::{Arc, OnceLock};

use super::input::ArmInput;
use crate::recorded_arm::bristles::bristles;
use crate::recorded_arm::delay::delayed;
use crate::recorded_arm::law::JointLaw;
use crate::recorded_arm::motion::{Motion, sample_time};
use crate::recorded_arm::simulate::{Channel, RigidCourse, moments, readings};
use crate::recorded_arm::{ArmParameters, Quantity};
use crate::stats::median;

/// Speed below which a joint stands still, as a share of the largest that its description allows [1].
const STANDSTILL: f64 = 1e-2;
/// Time below that speed from which a joint has come to rest [s].
const RESTS: f64 = 0.1;
/// Lengths of bristles after which friction has forgotten how the joint came to rest [1].
const FORGOTTEN: f64 = 6.0;
/// Torque that changes faster than the low-pass passes, over the noise of a drive and over its own usual size, from which accelerations are not resolved [1].
const FAST: [f64; 2] = [4.0, 8.0];
/// Time about such a change over which the low-pass smears it [s].
const SMEARED: f64 = 0.03;
/// Samples at either end of a recording in which derivatives are not to be trusted.
const ENDS: usize = 6;

/// One row: recording and sample.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Row {
    /// Recording.
    pub recording: usize,
    /// Sample.
    pub sample: usize,
}

/// Rows by channel.
#[derive(Debug, Clone)]
pub struct Evidence<'a> {
    /// Where it comes from.
    pub input: &'a ArmInput,
    /// Rows that count, by channel.
    pub rows: Vec<Vec<Row>>,
    /// Measured values there over the noise.
    pub measured: Vec<Vec<f64>>,
}

/// Values by channel and row, over the noise; a channel that is zero throughout has none.
pub type Column = Vec<Vec<f64>>;

/// What a model gives, with what can be shared with a model that is nearly the same.
#[derive(Debug, Clone)]
pub struct Course {
    arm: ArmParameters,
    bristles: Vec<Arc<Vec<Vec<f64>>>>,
    rigid: Vec<Arc<RigidCourse>>,
    /// Values of all channels, once they were asked for.
    values: OnceLock<Column>,
}

impl<'a> Evidence<'a> {
    /// Of recordings, but those left out.
    #[must_use]
    pub fn of(input: &'a ArmInput, left_out: &[bool]) -> Self {
        let mut rows = vec![Vec::new(); input.channels.len()];
        let mut measured = rows.iter().map(|_| Vec::new()).collect::<Vec<Vec<f64>>>();
        for (r, recording) in input.recordings.iter().enumerate() {
            if left_out.get(r).copied().unwrap_or(false) {
                continue;
            }
            let moving: Vec<Vec<bool>> = (0..input.nominal.joints())
                .map(|joint| slides(input, r, joint))
                .collect();
            let resolved = resolved(input, &recording.motion);
            let count = recording.motion.len();
            for (c, channel) in input.channels.iter().enumerate() {
                let readings = match channel {
                    Channel::Drive(_) => recording.motion.through_low_pass(&recording.readings[c]),
                    Channel::Link(_) | Channel::Wrench(_) => recording.readings[c].clone(),
                };
                for sample in ENDS..count.saturating_sub(ENDS) {
                    let reading = readings[sample];
                    let counts = match channel {
                        Channel::Drive(joint) => moving[*joint][sample] && resolved[*joint][sample],
                        Channel::Link(_) | Channel::Wrench(_) => true,
                    };
                    if counts && reading.is_finite() {
                        rows[c].push(Row {
                            recording: r,
                            sample,
                        });
                        measured[c].push(reading / input.noise[c]);
                    }
                }
            }
        }
        Self {
            input,
            rows,
            measured,
        }
    }

    /// Number of rows.
    #[must_use]
    pub fn count(&self) -> usize {
        self.rows.iter().map(Vec::len).sum()
    }

    /// The course of a model, sharing with another what is the same.
    #[must_use]
    pub fn course(&self, arm: &ArmParameters, known: Option<&Course>) -> Course {
        course_along(self.input, arm, known)
    }

    /// What the model of a course gives in some channels, over the noise; the others are empty.
    #[must_use]
    pub fn values(&self, course: &Course, asked: &[usize]) -> Column {
        let channels: Vec<Channel> = asked.iter().map(|c| self.input.channels[*c]).collect();
        let mut out = vec![Vec::new(); self.rows.len()];
        let all: Vec<Vec<Vec<f64>>> = self
            .input
            .recordings
            .iter()
            .enumerate()
            .map(|(r, recording)| {
                readings(
                    &course.arm,
                    &recording.motion,
                    &channels,
                    &course.bristles[r],
                    &course.rigid[r],
                )
            })
            .collect();
        for (place, c) in asked.iter().enumerate() {
            out[*c] = self.rows[*c]
                .iter()
                .map(|row| all[row.recording][place][row.sample] / self.input.noise[*c])
                .collect();
        }
        out
    }

    /// What the model of a course gives in all channels, over the noise.
    pub fn values_of<'c>(&self, course: &'c Course) -> &'c Column {
        let all = || (0..self.rows.len()).collect::<Vec<usize>>();
        course.values.get_or_init(|| self.values(course, &all()))
    }

    /// Change of the values for one unit of a quantity, at the model of a course whose own values are given.
    #[must_use]
    pub fn derivative(&self, course: &Course, quantity: Quantity) -> Column {
        if let Quantity::LawAmplitude(law, which) = quantity {
            return self.of_law(course, &course.arm.laws[law], which);
        }
        let asked = self.moved_by(quantity, &course.arm);
        let value = quantity.value(&course.arm);
        let step = quantity.step(value);
        let at = |value: f64| {
            let mut arm = course.arm.clone();
            quantity.set(&mut arm, value);
            self.values(&self.course(&arm, Some(course)), &asked)
        };
        let mut above = at(value + step);
        // One side says it all of what readings depend on linearly.
        let is_straight = match quantity {
            Quantity::Ripple(..) | Quantity::PushForce(..) => true,
            Quantity::LinkCentre(..) => false,
            _ => !quantity.is_curved(),
        };
        let (below, apart) = match course.values.get() {
            Some(here) if is_straight => (here, step),
            None if is_straight => (&self.values(course, &asked), step),
            _ => (&at(value - step), 2.0 * step),
        };
        for (above, below) in above.iter_mut().zip(below) {
            for (above, below) in above.iter_mut().zip(below) {
                *above = (*above - below) / apart;
            }
            if above.iter().all(|v| *v == 0.0) {
                above.clear();
            }
        }
        above
    }

    /// Change of the values for one unit of a law's factor, on which its torque depends linearly.
    fn of_law(&self, course: &Course, law: &JointLaw, which: usize) -> Column {
        let mut unit = *law;
        unit.amplitude = [0.0; 2];
        unit.amplitude[which] = 1.0;
        let joint = law.joint;
        let mut out = vec![Vec::new(); self.rows.len()];
        let channels = self.input.channels.iter();
        let Some(c) = { channels }.position(|c| *c == Channel::Drive(joint)) else {
            return out;
        };
        let factor = course.arm.drives[joint].inverse_gain / self.input.noise[c];
        let all: Vec<Vec<f64>> = (self.input.recordings.iter().enumerate())
            .map(|(r, recording)| {
                let (bristles, rigid) = course.parts(r);
                let drive = &course.arm.drives[joint];
                let moments = moments(drive, &recording.motion, bristles, &rigid.carried, joint);
                let torque: Vec<f64> = moments.map(|m| factor * unit.torque(&m)).collect();
                delayed(&recording.motion.time, &torque, course.arm.delay)
            })
            .collect();
        let rows = self.rows[c].iter();
        out[c] = rows.map(|row| all[row.recording][row.sample]).collect();
        out
    }

    /// Channels that a quantity can move.
    fn moved_by(&self, quantity: Quantity, arm: &ArmParameters) -> Vec<usize> {
        let channels = self.input.channels.iter().enumerate();
        let moved = channels.filter(|(_, channel)| is_moved(quantity, **channel, arm));
        moved.map(|(c, _)| c).collect()
    }
}

/// The course of a model along the motion of all recordings.
#[must_use]
pub fn course_along(input: &ArmInput, arm: &ArmParameters, known: Option<&Course>) -> Course {
    let rigid = |(r, known): (usize, Option<&Course>)| match known {
        Some(known) if known.arm.is_rigidly_as(arm) => Arc::clone(&known.rigid[r]),
        Some(known) if known.arm.moves_as(arm) && !known.arm.is_soft() && !arm.is_soft() => {
            Arc::new(known.rigid[r].with_bodies_of(arm))
        }
        _ => Arc::new(RigidCourse::of(arm, &input.recordings[r].motion)),
    };
    let lengths =
        |arm: &ArmParameters| -> Vec<f64> { arm.drives.iter().map(|d| d.bristle_length).collect() };
    let same = known.is_some_and(|known| lengths(&known.arm) == lengths(arm));
    let bend = |r: usize| match known {
        Some(known) if same => Arc::clone(&known.bristles[r]),
        _ => {
            let positions = input.recordings[r].motion.position.iter();
            let joints = positions.zip(lengths(arm));
            Arc::new(joints.map(|(q, length)| bristles(q, length)).collect())
        }
    };
    Course {
        arm: arm.clone(),
        bristles: (0..input.recordings.len()).map(bend).collect(),
        rigid: (0..input.recordings.len())
            .map(|r| rigid((r, known)))
            .collect(),
        values: OnceLock::new(),
    }
}

impl Course {
    /// Its model.
    #[must_use]
    pub fn arm(&self) -> &ArmParameters {
        &self.arm
    }

    /// Bristles and rigid bodies along a recording.
    #[must_use]
    pub fn parts(&self, recording: usize) -> (&[Vec<f64>], &RigidCourse) {
        (&self.bristles[recording], &self.rigid[recording])
    }

    /// Torque that a gear carries along a recording [N m].
    #[must_use]
    pub fn carried(&self, recording: usize) -> &[Vec<f64>] {
        &self.rigid[recording].carried
    }

    /// Share of the sliding friction along a recording [1].
    #[must_use]
    pub fn bristles(&self, recording: usize) -> &[Vec<f64>] {
        &self.bristles[recording]
    }
}

fn is_moved(quantity: Quantity, channel: Channel, arm: &ArmParameters) -> bool {
    use Quantity as Q;
    match quantity {
        Q::LinkMass(_)
        | Q::LinkCentre(..)
        | Q::LinkInertia(..)
        | Q::LoadMass
        | Q::LoadMoment(_) => !matches!(channel, Channel::Wrench(_)),
        Q::PayloadMass | Q::PayloadMoment(_) => !matches!(channel, Channel::Wrench(_)),
        Q::Tilt(_)
        | Q::EncoderOffset(_)
        | Q::ToolMass
        | Q::ToolCentre(_)
        | Q::OutsidePoint(_)
        | Q::OutsideDrag => true,
        Q::Compliance(_) => !matches!(channel, Channel::Wrench(_)),
        Q::Delay | Q::PushForce(..) | Q::PushStart(_) | Q::PushEnd(_) | Q::PushEdge(_) => {
            matches!(channel, Channel::Drive(_))
        }
        Q::Zero(k) | Q::Drift(k) | Q::WrenchGain(k) | Q::Crosstalk(_, k) => {
            channel == Channel::Wrench(k)
        }
        Q::SensorRotation => matches!(channel, Channel::Wrench(_)),
        Q::LawAmplitude(law, _) | Q::LawPlace(law) | Q::LawWidth(law) => {
            let joint = arm.laws.get(law).map(|law| law.joint);
            match channel {
                Channel::Drive(of) => joint.is_none_or(|joint| joint == of),
                _ => false,
            }
        }
        Q::InverseGain(j)
        | Q::MotorInertia(j)
        | Q::Coulomb(j)
        | Q::Viscous(j)
        | Q::BristleLength(j)
        | Q::StaticExcess(j)
        | Q::StribeckVelocity(j)
        | Q::LoadFriction(j)
        | Q::WarmFraction(j)
        | Q::WarmTime(j)
        | Q::Offset(j)
        | Q::Ripple(j, _)
        | Q::RippleCycles(j)
        | Q::SpringStiffness(j) => channel == Channel::Drive(j),
    }
}

/// Whether accelerations are resolved well enough to say what a drive gives, by joint and sample: not about a jump of a speed, which the low-pass of the
/// positions smears. `f - f_s` is what of the expected torque changes that fast, against the noise of the drive and against how it usually scatters.
fn resolved(input: &ArmInput, motion: &Motion) -> Vec<Vec<bool>> {
    let mut slow = motion.clone();
    slow.acceleration = motion.slow_acceleration();
    let [carried, carried_slowly] =
        [motion, &slow].map(|motion| RigidCourse::of(&input.nominal, motion).carried);
    let count = motion.len();
    let held = (SMEARED / sample_time(&motion.time)).round() as usize;
    let of = |joint: usize| {
        let channels = input.channels.iter();
        let channel = { channels }.position(|c| *c == Channel::Drive(joint));
        let drive = &input.nominal.drives[joint];
        let noise = channel.map_or(f64::INFINITY, |c| input.noise[c] / drive.inverse_gain);
        let rotor = |i: usize| {
            drive.motor_inertia * (motion.acceleration[joint][i] - slow.acceleration[joint][i])
        };
        let fast = |i: usize| (carried[joint][i] - carried_slowly[joint][i] + rotor(i)).abs();
        let fast: Vec<f64> = (0..count).map(fast).collect();
        let usual = median(fast.iter().copied()).unwrap_or(0.0) / 0.6745;
        let most = (FAST[0] * noise).max(FAST[1] * usual);
        let mut resolved = vec![true; count];
        for i in (0..count).filter(|i| fast[*i] > most) {
            resolved[i.saturating_sub(held)..(i + held + 1).min(count)].fill(false);
        }
        resolved
    };
    (0..input.nominal.joints()).map(of).collect()
}

/// Samples at which a joint slides, so that its friction is known from its motion.
#[must_use]
pub fn slides(input: &ArmInput, recording: usize, joint: usize) -> Vec<bool> {
    let motion = &input.recordings[recording].motion;
    let still = STANDSTILL * input.nominal.chain.joints[joint].velocity.clamp(0.5, 2.0);
    let length = input.nominal.drives[joint].bristle_length;
    let (position, speed, time) = (&motion.position[joint], &motion.speed[joint], &motion.time);
    // It counts as come to rest at the start, and whenever it has stood for a time.
    let mut moved = 0.0;
    let mut slow_since = Some(f64::MIN);
    let mut out = Vec::with_capacity(motion.len());
    for i in 0..motion.len() {
        if speed[i].abs() < still {
            let since = *slow_since.get_or_insert(time[i]);
            if time[i] - since > RESTS {
                moved = 0.0;
            }
        } else {
            slow_since = None;
            if i > 0 {
                moved += (position[i] - position[i - 1]).abs();
            }
        }
        out.push(moved > FORGOTTEN * length && speed[i].abs() >= still);
    }
    out
}
