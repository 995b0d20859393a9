//! A log as an MCAP with ROS 2 messages: a channel is a field of a topic's messages, `/wrench.wrench.force.z`, `/joint_states.position[1]`.
//!
//! The messages' definitions stand in the file (schema encoding `ros2msg`), so any is read. Each topic has times of its own.

use std::path::Path;

use super::error::ImportError;
use super::log::{Remark, Rows};
use super::map::FileMap;

mod bag;
mod field;
mod topic;

use bag::{Scan, visit};
use topic::{Topic, topics};

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
        remarks.push(Remark::Truncated(format!(
            "it is cut off or damaged: {cause}; {rest}"
        )));
    }
    let mut topics = topics(path, map, &scan.there)?;
    // Where it ends was found out before.
    visit(&bytes, |message| {
        let known = |topic: &&mut Topic| topic.name == message.there.topic;
        match topics.iter_mut().find(known) {
            Some(topic) => topic.take(path, message),
            None => Ok(()),
        }
    })?;
    topics
        .into_iter()
        .map(|topic| topic.into_rows(path, map, &remarks))
        .collect()
}
