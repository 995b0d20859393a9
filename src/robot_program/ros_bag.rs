//! The planned joints over time as one message `trajectory_msgs/msg/JointTrajectory` in an MCAP, as `ros2 bag` reads it.
//!
//! Definition: <https://docs.ros.org/en/jazzy/p/trajectory_msgs/>; coding: CDR, little endian (OMG DDS-XTypes 1.3, 7.4), each number on a multiple of its size.

use std::collections::BTreeMap;
use std::io::Cursor;

use mcap::records::MessageHeader;
use mcap::{McapError, WriteOptions};

use super::error::ProgramError;
use super::trajectory::Sampled;

const TYPE: &str = "trajectory_msgs/msg/JointTrajectory";
const DEFINITION: &str = "\
std_msgs/Header header
string[] joint_names
JointTrajectoryPoint[] points
================================================================================
MSG: std_msgs/Header
builtin_interfaces/Time stamp
string frame_id
================================================================================
MSG: builtin_interfaces/Time
int32 sec
uint32 nanosec
================================================================================
MSG: trajectory_msgs/JointTrajectoryPoint
float64[] positions
float64[] velocities
float64[] accelerations
float64[] effort
builtin_interfaces/Duration time_from_start
================================================================================
MSG: builtin_interfaces/Duration
int32 sec
uint32 nanosec
";

/// The bytes of a bag.
///
/// # Errors
/// The library does not write it.
pub fn bag(sampled: &Sampled) -> Result<Vec<u8>, ProgramError> {
    packed(&message(sampled)).map_err(|error| ProgramError::Bag(error.to_string()))
}

fn packed(data: &[u8]) -> Result<Vec<u8>, McapError> {
    let options = WriteOptions::new().compression(None).profile("ros2");
    let mut writer = options.create(Cursor::new(Vec::new()))?;
    let schema = writer.add_schema(TYPE, "ros2msg", DEFINITION.as_bytes())?;
    let channel_id = writer.add_channel(schema, "/joint_trajectory", "cdr", &BTreeMap::new())?;
    let header = MessageHeader {
        channel_id,
        sequence: 0,
        log_time: 0,
        publish_time: 0,
    };
    writer.write_to_known_channel(&header, data)?;
    writer.finish()?;
    Ok(writer.into_inner().into_inner())
}

/// Bytes of a message behind its four of encapsulation.
#[derive(Default)]
struct Coded(Vec<u8>);

impl Coded {
    fn put<const N: usize>(&mut self, bytes: [u8; N]) {
        let padded = self.0.len().next_multiple_of(N);
        self.0.resize(padded, 0);
        self.0.extend(bytes);
    }

    fn count(&mut self, count: usize) {
        self.put(u32::try_from(count).unwrap_or(u32::MAX).to_le_bytes());
    }

    fn text(&mut self, text: &str) {
        self.count(text.len() + 1);
        self.0.extend(text.as_bytes());
        self.0.push(0);
    }

    fn numbers(&mut self, values: &[f64]) {
        self.count(values.len());
        for value in values {
            self.put(value.to_le_bytes());
        }
    }

    fn time(&mut self, time: f64) {
        let nanoseconds = (1e9 * time).round() as u64;
        self.count((nanoseconds / 1_000_000_000) as usize);
        self.count((nanoseconds % 1_000_000_000) as usize);
    }
}

fn message(sampled: &Sampled) -> Vec<u8> {
    let mut coded = Coded::default();
    coded.time(0.0);
    coded.text("");
    coded.count(sampled.joints.len());
    for name in &sampled.joints {
        coded.text(name);
    }
    coded.count(sampled.samples.len());
    let joints = sampled.joints.len();
    for (time, at) in &sampled.samples {
        coded.numbers(&at.position[..joints]);
        coded.numbers(&at.velocity[..joints]);
        coded.numbers(&at.acceleration[..joints]);
        coded.numbers(&[]);
        coded.time(*time);
    }
    [vec![0, 1, 0, 0], coded.0].concat()
}
