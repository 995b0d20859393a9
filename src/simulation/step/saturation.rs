//! Drives at their limit: where it began, and whether the arm found its path again before something stopped the run.

use crate::arm::chain::Joint;
use crate::path::Phase;
use crate::simulation::error::SimulationError;

/// Distance of every axis from its command within which the path lost at a limit counts as found again [rad].
const FOUND: f64 = 1e-3;

/// The limits of the drives over a run.
#[derive(Debug, Clone, Default)]
pub(super) struct Saturation {
    lasting: Option<Lasting>,
}

/// From the first drive at its limit until the path is found again.
#[derive(Debug, Clone)]
struct Lasting {
    axis: String,
    effort: f64,
    start: f64,
    phase: &'static str,
    /// When a drive was last at its limit [s].
    last: f64,
}

impl Saturation {
    /// Notes that the drive of a joint was at its limit at a time [s].
    pub fn note(&mut self, joint: &Joint, time: f64, phase: Phase) {
        let lasting = self.lasting.get_or_insert_with(|| Lasting {
            axis: joint.name.clone(),
            effort: joint.effort,
            start: time,
            phase: phase.name(),
            last: time,
        });
        lasting.last = time;
    }

    /// Ends it where no drive is at its limit any more and all axes are within a distance of their commands [rad].
    pub fn settle(&mut self, off: f64, time: f64) {
        if off <= FOUND {
            self.lasting.take_if(|lasting| lasting.last < time);
        }
    }

    /// The first cause of a stop: a drive at its limit, if the path lost by it was not found again. Numbers that are none have their own.
    pub fn before(&self, stop: SimulationError) -> SimulationError {
        match &self.lasting {
            Some(lasting) if !matches!(stop, SimulationError::NotFinite { .. }) => {
                SimulationError::Saturated {
                    axis: lasting.axis.clone(),
                    effort: lasting.effort,
                    time: lasting.start,
                    phase: lasting.phase,
                    stop: Box::new(stop),
                }
            }
            _ => stop,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::arm::chain::{BodyInertia, JointKind};

    fn joint() -> Joint {
        Joint {
            name: "elbow".into(),
            kind: JointKind::Revolute,
            parent_from_joint: glamx::DPose3::IDENTITY,
            axis: glam::DVec3::Z,
            lower: -3.0,
            upper: 3.0,
            effort: 50.0,
            velocity: 2.0,
            damping: 0.0,
            friction: 0.0,
            body: BodyInertia::ZERO,
        }
    }

    fn stop() -> SimulationError {
        SimulationError::SlippedOff {
            time: 3.0,
            edge_length: 0.1,
            off: 6e-3,
            radius: 5e-3,
            force: 100.0,
        }
    }

    #[test]
    fn a_limit_is_the_cause_of_a_stop_unless_the_path_was_found_again() {
        let mut saturation = Saturation::default();
        assert_eq!(saturation.before(stop()), stop());
        saturation.note(&joint(), 1.0, Phase::Engage);
        saturation.settle(0.0, 1.0);
        saturation.note(&joint(), 1.1, Phase::Follow);
        saturation.settle(5e-3, 1.2);
        let message = saturation.before(stop()).to_string();
        let expected = "the drive of joint elbow came to its limit of 50 N m at 1.000 s in phase engage and lost its path; after that ";
        assert_eq!(message, format!("{expected}{}", stop()));
        saturation.settle(5e-4, 1.3);
        assert_eq!(saturation.before(stop()), stop());
    }
}
