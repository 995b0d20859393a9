//! The planned joints over time as one message `trajectory_msgs/msg/JointTrajectory` in an MCAP, as `ros2 bag` reads it.

use std::collections::BTreeMap;

use super::error::ProgramError;
use super::trajectory::Sampled;
use crate::ros_bag::{BagError, BagFile, Coded, Packing};

/// The bytes of a bag.
///
/// # Errors
/// The library does not write it.
pub fn bag(sampled: &Sampled) -> Result<Vec<u8>, ProgramError> {
    packed(&message(sampled)).map_err(|error| ProgramError::Bag(error.to_string()))
}

fn packed(message: &Coded) -> Result<Vec<u8>, BagError> {
    let mut file = BagFile::begin(Packing::Plain)?;
    let kind = "trajectory_msgs/msg/JointTrajectory";
    let topic = file.topic("/joint_trajectory", kind, &BTreeMap::new())?;
    file.write(topic, 0, 0, message.bytes())?;
    file.finish()
}

fn message(sampled: &Sampled) -> Coded {
    let mut coded = Coded::default();
    coded.time(0);
    coded.text("");
    coded.count(sampled.joints.len());
    for name in &sampled.joints {
        coded.text(name);
    }
    coded.count(sampled.samples.len());
    let joints = sampled.joints.len();
    for (time, at) in &sampled.samples {
        for values in [&at.position, &at.velocity, &at.acceleration] {
            coded.numbers(values[..joints].iter().copied());
        }
        coded.count(0);
        coded.time((1e9 * time).round() as u64);
    }
    coded
}
