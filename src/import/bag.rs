//! A log as a bag of ROS 2 messages, MCAP or SQLite: a channel is a field of a topic's messages, `/wrench.wrench.force.z`, `/joint_states.position[1]`, or of
//! a joint by its name.
//!
//! The messages' definitions stand in the file (encoding `ros2msg`), so any is read; of a SQLite bag from before ROS 2 Iron they do not, and the usual ones
//! are known (`crate::ros_bag`). Each topic has times of its own.

use std::path::Path;

use super::error::ImportError;
use super::map::FileMap;
use super::rows::{Remark, Rows};
use crate::file::Limit;

mod definition;
mod extent;
mod field;
pub(super) mod glance;
mod listed;
mod mcap_file;
mod message;
pub(super) mod own;
mod sqlite_file;
mod store;
mod topic;

pub(super) use store::is_packed;
use store::{Scan, Stores};
use topic::topics;

/// Reads the topics that a map's channels name, the first channel's first.
pub(super) fn read(path: &Path, map: &FileMap) -> Result<Vec<Rows>, ImportError> {
    let stores = open(path, map.limit)?;
    let scan = Scan::of(&stores);
    let mut remarks = stores.notes.clone();
    remarks.extend(missing(path, map, &stores)?);
    if stores.missing.is_empty() && scan.cause.is_none() {
        remarks.extend(scan.lost(&stores).map(Remark::Note));
    }
    if let Some(cause) = &scan.cause {
        let rest = scan.rest();
        if !map.accepts_truncated {
            let repaired = stores.repaired_by();
            return Err(ImportError::Truncated {
                file: path.to_owned(),
                found: cause.clone(),
                rest,
                advice: format!(
                    "`{repaired}` repairs it, or `accept_truncated = true` in the map's [[file]] uses them"
                ),
            });
        }
        remarks.push(Remark::Truncated(format!(
            "it is cut off or damaged: {cause}; {rest}"
        )));
    }
    let mut topics = topics(path, map, &scan.there)?;
    // Where it ends was found out before.
    stores.visit(|message| {
        let of_message = |topic: &&mut topic::Topic| topic.name == message.there.topic;
        topics
            .iter_mut()
            .filter(of_message)
            .try_for_each(|topic| topic.take(path, message))
    })?;
    topics
        .into_iter()
        .map(|topic| topic.into_rows(path, map, &remarks))
        .collect()
}

/// Remark on files that the bag's own list has and its folder has not, where the map accepts that.
fn missing(path: &Path, map: &FileMap, stores: &Stores) -> Result<Option<Remark>, ImportError> {
    if stores.missing.is_empty() {
        return Ok(None);
    }
    let found = format!(
        "its metadata.yaml names {}, not there",
        stores.missing.join(", ")
    );
    let count = stores.count();
    let rest = format!(
        "{count} of its {} files are there",
        count + stores.missing.len()
    );
    if map.accepts_truncated {
        return Ok(Some(Remark::Truncated(format!("{found}; {rest}"))));
    }
    Err(ImportError::Truncated {
        file: path.to_owned(),
        found,
        rest,
        advice: "put them back, or `accept_truncated = true` in the map's [[file]] uses those that are there"
            .to_owned(),
    })
}

fn open(path: &Path, limit: Limit) -> Result<Stores, ImportError> {
    Stores::open(path, limit).map_err(|cause| ImportError::Read {
        file: path.to_owned(),
        cause,
    })
}
