//! What is recorded at each step, and how it becomes a recording.

use glam::DVec3;
use glamx::DPose3;

use crate::path::Phase;
use crate::recording::schema::{self, JointSignal, joint_quantity};
use crate::recording::{Channel, PhaseSpan, Recording, RecordingError};

/// Signals of all steps, a column each, in the order of `schema::SIGNALS` and then of the joints.
#[derive(Debug, Clone)]
pub struct SampleLog {
    joints: usize,
    time: Vec<f64>,
    columns: Vec<Vec<f64>>,
    phases: Vec<PhaseSpan>,
}

impl SampleLog {
    /// An empty log for an arm of `joints` axes, with room for `capacity` samples.
    pub fn new(joints: usize, capacity: usize) -> Self {
        let columns = schema::SIGNALS.len() + JointSignal::ALL.len() * joints;
        Self {
            joints,
            time: Vec::with_capacity(capacity),
            columns: (0..columns).map(|_| Vec::with_capacity(capacity)).collect(),
            phases: Vec::new(),
        }
    }

    /// Adds a sample: `signals` in the order of `schema::SIGNALS`, then position, reference, velocity and torque of each joint.
    pub fn push(&mut self, time: f64, phase: Phase, signals: &[f64], joints: &[[f64; 4]]) {
        match self.phases.last_mut() {
            Some(span) if span.name == phase.name() => span.end = time,
            last => {
                if let Some(span) = last {
                    span.end = time;
                }
                self.phases.push(PhaseSpan { name: phase.name().to_owned(), start: time, end: time });
            }
        }
        self.time.push(time);
        let values = signals.iter().chain(joints.iter().flatten());
        for (column, value) in self.columns.iter_mut().zip(values) {
            column.push(*value);
        }
    }

    /// The recording; values that are not finite end it.
    ///
    /// # Errors
    /// Nothing was recorded.
    pub fn into_recording(self) -> Result<Recording, RecordingError> {
        let singles = schema::SIGNALS.iter().map(|signal| (signal.quantity.to_owned(), signal.unit));
        let joints = (1..=self.joints)
            .flat_map(|joint| JointSignal::ALL.map(|signal| (joint_quantity(joint, signal), signal.unit())));
        let channels = singles
            .chain(joints)
            .zip(self.columns)
            .map(|((quantity, unit), values)| Channel::new(quantity, unit, values))
            .collect();
        Recording::new(self.time, channels, self.phases)
    }

    /// Number of samples.
    pub fn len(&self) -> usize {
        self.time.len()
    }

    /// Is there no sample?
    pub fn is_empty(&self) -> bool {
        self.time.is_empty()
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
