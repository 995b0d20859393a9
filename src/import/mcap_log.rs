//! A log as an MCAP with ROS 2 messages: a channel is a field of a topic's messages, `/wrench.wrench.force.z`, `/joint_states.position[1]`.
//!
//! The messages' definitions stand in the file (schema encoding `ros2msg`), so any is read. Each topic has times of its own.

use std::path::Path;

use mcap::{McapError, MessageStream};

use super::error::ImportError;
use super::log::{Remark, Rows};
use super::map::FileMap;

mod field;
mod topic;

use topic::topics;

/// Reads the topics that a map's channels name, the first channel's first.
pub(super) fn read(path: &Path, map: &FileMap) -> Result<Vec<Rows>, ImportError> {
    let fail = |cause: String| ImportError::Read {
        file: path.to_owned(),
        cause,
    };
    let bytes = std::fs::read(path).map_err(|cause| fail(cause.to_string()))?;
    if !bytes.starts_with(mcap::MAGIC) {
        return Err(fail("it is no MCAP: it does not start as one".to_owned()));
    }
    let scan = Scan::of(&bytes);
    let mut remarks = Vec::new();
    if let Some(cause) = &scan.cause {
        // A chunk is checked at its end, when its messages have been read.
        if scan.is_damaged {
            let advice = "copy it once more from where it was recorded, or let `mcap recover` leave out what is damaged";
            return Err(fail(format!("it is damaged: {cause}; {advice}")));
        }
        let rest = scan.rest();
        if !map.accepts_truncated {
            return Err(ImportError::Truncated {
                file: path.to_owned(),
                found: cause.clone(),
                rest,
                advice: "`mcap recover` repairs it, or `accept_truncated = true` in the map's [[file]] uses them"
                    .to_owned(),
            });
        }
        remarks.push(Remark::Truncated(format!("it is cut off: {cause}; {rest}")));
    }
    let mut topics = topics(path, map, &scan.there)?;
    let stream = MessageStream::new(&bytes).map_err(|cause| fail(cause.to_string()))?;
    // Where it ends was found out before.
    for (index, message) in stream.map_while(Result::ok).enumerate() {
        let topic = topics
            .iter_mut()
            .find(|topic| topic.name == message.channel.topic);
        if let Some(topic) = topic {
            topic.take(path, index as u64 + 1, &message)?;
        }
    }
    topics
        .into_iter()
        .map(|topic| topic.into_rows(path, map, &remarks))
        .collect()
}

/// A topic that is there, with the name, the encoding and the text of its definition.
struct There {
    topic: String,
    encoding: String,
    schema: Option<(String, String, Vec<u8>)>,
}

/// What a file holds, up to where it breaks off.
struct Scan {
    /// Topics that have messages, in the order of their names.
    there: Vec<There>,
    /// Messages, and the times at which the first and the last were logged [ns].
    messages: usize,
    logged: [u64; 2],
    /// Why it breaks off, if it does.
    cause: Option<String>,
    /// Are messages before that not what was written?
    is_damaged: bool,
}

impl Scan {
    fn of(bytes: &[u8]) -> Self {
        let mut scan = Self {
            there: Vec::new(),
            messages: 0,
            logged: [u64::MAX, 0],
            cause: None,
            is_damaged: false,
        };
        let stream = match MessageStream::new(bytes) {
            Ok(stream) => stream,
            Err(error) => {
                scan.cause = Some(error.to_string());
                return scan;
            }
        };
        for message in stream {
            let message = match message {
                Ok(message) => message,
                Err(error) => {
                    scan.is_damaged = matches!(error, McapError::BadChunkCrc { .. });
                    scan.cause = Some(error.to_string());
                    break;
                }
            };
            scan.messages += 1;
            let [first, last] = scan.logged;
            scan.logged = [first.min(message.log_time), last.max(message.log_time)];
            let channel = &message.channel;
            if scan.there.iter().all(|there| there.topic != channel.topic) {
                let schema = channel.schema.as_ref();
                scan.there.push(There {
                    topic: channel.topic.clone(),
                    encoding: channel.message_encoding.clone(),
                    schema: schema.map(|s| (s.name.clone(), s.encoding.clone(), s.data.to_vec())),
                });
            }
        }
        scan.there.sort_by(|a, b| a.topic.cmp(&b.topic));
        scan
    }

    /// What can be read of it.
    fn rest(&self) -> String {
        let [first, last] = self.logged;
        let span = last.saturating_sub(first) as f64 * 1e-9;
        match self.messages {
            0 => "no message of it can be read".to_owned(),
            count => format!(
                "the first {count} messages can be read, the last of them {span:.3} s after the first"
            ),
        }
    }
}
