//! What is recorded at each step, and how it becomes a recording.

use glam::DVec3;
use glamx::DPose3;

use crate::path::Phase;
use crate::recording::schema::{self, JointSignal, joint_quantity};
use crate::recording::{Channel, PhaseSpan, Recording, RecordingError};

/// Signals of all steps, in the order of `schema::SIGNALS`, the sensors and then the joints. Kept by rows, which a step writes in one go, until the run has ended.
#[derive(Debug, Clone)]
pub struct SampleLog {
    joints: usize,
    time: Vec<f64>,
    rows: Vec<f64>,
    phases: Vec<PhaseSpan>,
}

impl SampleLog {
    /// An empty log for an arm of `joints` axes, with room for `capacity` samples.
    pub fn new(joints: usize, capacity: usize) -> Self {
        Self {
            joints,
            time: Vec::with_capacity(capacity),
            rows: Vec::with_capacity(capacity * Self::width(joints)),
            phases: Vec::new(),
        }
    }

    fn width(joints: usize) -> usize {
        schema::SIGNALS.len() + schema::CELL_SENSORS.len() + JointSignal::ALL.len() * joints
    }

    /// Adds a sample: `signals` in the order of `schema::SIGNALS` and `schema::CELL_SENSORS`, then those of each joint in the order of `JointSignal::ALL`.
    pub fn push(
        &mut self,
        time: f64,
        phase: Phase,
        signals: &[f64],
        joints: &[[f64; JointSignal::ALL.len()]],
    ) {
        match self.phases.last_mut() {
            Some(span) if span.name == phase.name() => span.end = time,
            last => {
                if let Some(span) = last {
                    span.end = time;
                }
                self.phases.push(PhaseSpan {
                    name: phase.name().to_owned(),
                    start: time,
                    end: time,
                });
            }
        }
        self.time.push(time);
        self.rows.extend_from_slice(signals);
        self.rows.extend_from_slice(joints.as_flattened());
    }

    /// The recording.
    ///
    /// # Errors
    /// Nothing was recorded.
    pub fn into_recording(self) -> Result<Recording, RecordingError> {
        let singles = schema::SIGNALS
            .iter()
            .chain(
                schema::CELL_SENSORS
                    .iter()
                    .filter_map(|sensor| schema::definition(sensor)),
            )
            .map(|signal| (signal.quantity.to_owned(), signal.unit));
        let joints = (1..=self.joints).flat_map(|joint| {
            JointSignal::ALL.map(|signal| (joint_quantity(joint, signal), signal.unit()))
        });
        let width = Self::width(self.joints);
        let column = |index: usize| {
            self.rows
                .iter()
                .skip(index)
                .step_by(width)
                .copied()
                .collect()
        };
        let channels = singles
            .chain(joints)
            .enumerate()
            .map(|(index, (quantity, unit))| Channel::new(quantity, unit, column(index)))
            .collect();
        Recording::new(self.time, channels, self.phases)
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
