//! Record at each step, and its conversion to a recording.

use std::borrow::Cow;

use glam::DVec3;
use glamx::DPose3;

use crate::path::Phase;
use crate::recording::schema::{self, JointSignal, joint_quantity};
use crate::recording::{PhaseSpan, RecordedChannel, Recording, RecordingError};

/// Signals of all steps, in the order of `schema::SIGNALS`, the sensors and then the joints. Kept by rows, which a step writes in one go, until the run has ended.
#[derive(Debug, Clone)]
pub struct SampleLog {
    joints: usize,
    /// Whether the tool turns.
    cutting: bool,
    time: Vec<f64>,
    rows: Vec<f64>,
    phases: Vec<PhaseSpan>,
}

impl SampleLog {
    /// An empty log for an arm of `joints` axes, with room for `capacity` samples; of a tool that turns, or does not.
    pub fn new(joints: usize, cutting: bool, capacity: usize) -> Self {
        Self {
            joints,
            cutting,
            time: Vec::with_capacity(capacity),
            rows: Vec::with_capacity(capacity * Self::width(joints, cutting)),
            phases: Vec::new(),
        }
    }

    fn width(joints: usize, cutting: bool) -> usize {
        let of_tool = if cutting {
            schema::CUTTING_SIGNALS.len()
        } else {
            0
        };
        schema::SIGNALS.len()
            + schema::CELL_SENSORS.len()
            + of_tool
            + JointSignal::ALL.len() * joints
    }

    /// Adds a sample: `signals` in the order of `schema::SIGNALS` and `schema::CELL_SENSORS`, of a turning tool those of `schema::CUTTING_SIGNALS`, then those of
    /// each joint in the order of `JointSignal::ALL`. Phases of passes after the first carry their number: `follow_2`.
    pub fn push(
        &mut self,
        time: f64,
        (phase, pass): (Phase, usize),
        signals: &[f64],
        joints: &[[f64; JointSignal::ALL.len()]],
    ) {
        let name = match pass {
            0 => Cow::Borrowed(phase.name()),
            later => Cow::Owned(format!("{}_{}", phase.name(), later + 1)),
        };
        match self.phases.last_mut() {
            Some(span) if span.name == *name => span.end = time,
            last => {
                if let Some(span) = last {
                    span.end = time;
                }
                self.phases.push(PhaseSpan {
                    name: name.into_owned(),
                    start: time,
                    end: time,
                });
            }
        }
        self.time.push(time);
        self.rows.extend_from_slice(signals);
        debug_assert_eq!(
            signals.len() + joints.as_flattened().len(),
            Self::width(self.joints, self.cutting)
        );
        self.rows.extend_from_slice(joints.as_flattened());
    }

    /// Contact force of the last sample [N]; zero before the first.
    pub fn last_contact_force(&self) -> f64 {
        const PLACE: usize = 1;
        debug_assert_eq!(schema::SIGNALS[PLACE].quantity, schema::CONTACT_FORCE);
        let width = Self::width(self.joints, self.cutting);
        let last = self.count().checked_sub(1);
        last.map_or(0.0, |last| self.rows[last * width + PLACE])
    }

    /// Number of samples.
    pub fn count(&self) -> usize {
        self.time.len()
    }

    /// The recording.
    ///
    /// # Errors
    /// Nothing was recorded.
    pub fn into_recording(self) -> Result<Recording, RecordingError> {
        let channels = self.channels();
        Recording::new(self.time, channels, self.phases)
    }

    /// The samples from one on.
    #[must_use]
    pub fn since(&self, first: usize) -> Self {
        let first = first.min(self.count());
        let time = self.time[first..].to_vec();
        let start = time.first().copied().unwrap_or_default();
        let reaches = |phase: &&PhaseSpan| phase.end > start || Some(&phase.end) == time.last();
        let phases = self.phases.iter().filter(reaches).map(|phase| PhaseSpan {
            start: phase.start.max(start),
            ..phase.clone()
        });
        Self {
            joints: self.joints,
            cutting: self.cutting,
            phases: phases.collect(),
            rows: self.rows[first * Self::width(self.joints, self.cutting)..].to_vec(),
            time,
        }
    }

    fn channels(&self) -> Vec<RecordedChannel> {
        let singles = schema::SIGNALS
            .iter()
            .chain(
                schema::CELL_SENSORS
                    .iter()
                    .filter_map(|sensor| schema::definition(sensor)),
            )
            .chain(schema::CUTTING_SIGNALS.iter().filter(|_| self.cutting))
            .map(|signal| (signal.quantity.to_owned(), signal.unit));
        let joints = (1..=self.joints).flat_map(|joint| {
            JointSignal::ALL.map(|signal| (joint_quantity(joint, signal), signal.unit()))
        });
        let width = Self::width(self.joints, self.cutting);
        let column = |index: usize| {
            self.rows
                .iter()
                .skip(index)
                .step_by(width)
                .copied()
                .collect()
        };
        singles
            .chain(joints)
            .enumerate()
            .map(|(index, (quantity, unit))| RecordedChannel::new(quantity, unit, column(index)))
            .collect()
    }
}

/// Poses for the picture, fewer than samples.
#[derive(Debug, Clone, Default)]
pub struct FrameLog {
    /// Times [s].
    pub times: Vec<f64>,
    /// Length of edge behind the tool [m].
    pub path_lengths: Vec<f64>,
    /// Poses of the moving links in the world, the slide last; one list a frame.
    pub links: Vec<Vec<DPose3>>,
    /// Where the tool touches [m].
    pub contact_points: Vec<DVec3>,
    /// Force on the part [N].
    pub contact_forces: Vec<DVec3>,
}

impl FrameLog {
    /// The frames from one on.
    #[must_use]
    pub fn since(&self, first: usize) -> Self {
        let first = first.min(self.times.len());
        Self {
            times: self.times[first..].to_vec(),
            path_lengths: self.path_lengths[first..].to_vec(),
            links: self.links[first..].to_vec(),
            contact_points: self.contact_points[first..].to_vec(),
            contact_forces: self.contact_forces[first..].to_vec(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_has_come_since_is_the_rest_of_the_whole() {
        let mut log = SampleLog::new(0, true, 8);
        let width = SampleLog::width(0, true);
        for index in 0..8_u32 {
            let phase = if index < 5 {
                Phase::Approach
            } else {
                Phase::Follow
            };
            let row = vec![f64::from(index); width];
            log.push(f64::from(index), (phase, 0), &row, &[]);
        }
        let rest = log.since(3).into_recording().unwrap();
        assert_eq!(rest.time(), [3.0, 4.0, 5.0, 6.0, 7.0]);
        assert_eq!(rest.channels()[width - 1].values, rest.time());
        let spans = rest.phases().iter().map(|p| (p.name.as_str(), p.start));
        let spans: Vec<_> = spans.collect();
        assert_eq!(spans, [("approach", 3.0), ("follow", 5.0)]);
        assert_eq!(log.since(6).phases.len(), 1);
        assert!(log.since(8).into_recording().is_err());
        let all = log.since(0).into_recording().unwrap();
        assert_eq!(all, log.into_recording().unwrap());
    }
}
