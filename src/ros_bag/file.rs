//! Files of messages: MCAP of the profile `ros2`, chunked, with its summary and statistics. Same messages, same bytes: no clock, one thread that packs, and a
//! summary in order of its records' numbers, which the crate has in that of a hash.
//!
//! Format: <https://mcap.dev/spec>, what ROS 2 expects of it: <https://mcap.dev/spec/registry>.

use std::collections::BTreeMap;
use std::io::Cursor;

use flate2::Crc;
use mcap::records::{MessageHeader, Metadata, op};
use mcap::{Compression, MAGIC, McapError, WriteOptions, Writer};

use super::definitions::definition;

/// Name of what writes them.
const LIBRARY: &str = concat!("idc ", env!("CARGO_PKG_VERSION"));
/// Bytes of a chunk before it is packed; fixed so that the bytes of a file do not depend on a library's default.
const CHUNK: u64 = 1 << 20;

/// Bytes of a record before its content: its kind and its length.
const HEAD: usize = 9;
/// Bytes of the footer with the magic behind it: where summary and its offsets start, and the sum over both.
const FOOTER: usize = HEAD + 20 + MAGIC.len();

/// How chunks are packed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Packing {
    /// Not at all.
    Plain,
    /// With zstd.
    Zstd,
}

/// A topic of a file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct TopicId(u16);

/// A file that is being written, in memory.
pub struct BagFile(Writer<Cursor<Vec<u8>>>);

impl BagFile {
    /// Begins one.
    ///
    /// # Errors
    /// It cannot be written to.
    pub fn begin(packing: Packing) -> Result<Self, McapError> {
        let options = WriteOptions::new()
            .profile("ros2")
            .library(LIBRARY)
            .chunk_size(Some(CHUNK))
            // Of several threads the bytes would be others.
            .compression_threads(0)
            .compression(match packing {
                Packing::Plain => None,
                Packing::Zstd => Some(Compression::Zstd),
            });
        options.create(Cursor::new(Vec::new())).map(Self)
    }

    /// Notes texts about the whole file, under a name.
    ///
    /// # Errors
    /// It cannot be written to.
    pub fn note(
        &mut self,
        name: &str,
        metadata: &BTreeMap<String, String>,
    ) -> Result<(), McapError> {
        self.0.write_metadata(&Metadata {
            name: name.to_owned(),
            metadata: metadata.clone(),
        })
    }

    /// A topic of one of the usual messages, `std_msgs/msg/Float64`, with texts about it.
    ///
    /// # Errors
    /// It cannot be written to.
    pub fn topic(
        &mut self,
        name: &str,
        kind: &str,
        metadata: &BTreeMap<String, String>,
    ) -> Result<TopicId, McapError> {
        let text = definition(kind).unwrap_or_default();
        let schema = self.0.add_schema(kind, "ros2msg", text.as_bytes())?;
        self.0
            .add_channel(schema, name, "cdr", metadata)
            .map(TopicId)
    }

    /// A topic of messages in JSON, by their schema.
    ///
    /// # Errors
    /// It cannot be written to.
    pub fn json_topic(
        &mut self,
        name: &str,
        kind: &str,
        schema: &serde_json::Value,
        metadata: &BTreeMap<String, String>,
    ) -> Result<TopicId, McapError> {
        let text = schema.to_string();
        let schema = self.0.add_schema(kind, "jsonschema", text.as_bytes())?;
        self.0
            .add_channel(schema, name, "json", metadata)
            .map(TopicId)
    }

    /// Writes a message, logged at a time [ns].
    ///
    /// # Errors
    /// It cannot be written to.
    pub fn write(
        &mut self,
        topic: TopicId,
        sequence: u32,
        time: u64,
        data: &[u8],
    ) -> Result<(), McapError> {
        let header = MessageHeader {
            channel_id: topic.0,
            sequence,
            log_time: time,
            publish_time: time,
        };
        self.0.write_to_known_channel(&header, data)
    }

    /// Writes the summary, and gives the bytes of the file.
    ///
    /// # Errors
    /// It cannot be written to.
    pub fn finish(mut self) -> Result<Vec<u8>, McapError> {
        self.0.finish()?;
        let mut bytes = self.0.into_inner().into_inner();
        order_summary(&mut bytes).ok_or(McapError::UnexpectedEof)?;
        Ok(bytes)
    }
}

/// Puts the definitions and the channels of a summary in the order of their numbers.
fn order_summary(file: &mut [u8]) -> Option<()> {
    let footer = file.len().checked_sub(FOOTER)?;
    let number = |from: usize| -> Option<usize> {
        let bytes = file.get(from..from + 8)?.try_into().ok()?;
        usize::try_from(u64::from_le_bytes(bytes)).ok()
    };
    let start = number(footer + HEAD)?;
    let mut runs: Vec<(u8, Vec<&[u8]>)> = Vec::new();
    let mut at = start;
    while at < footer {
        let length = HEAD + number(at + 1)?;
        let record = file.get(at..at + length)?;
        match runs.last_mut() {
            Some((kind, run)) if *kind == record[0] => run.push(record),
            _ => runs.push((record[0], vec![record])),
        }
        at += length;
    }
    for (kind, run) in &mut runs {
        if [op::SCHEMA, op::CHANNEL].contains(kind) {
            run.sort_by_key(|record| record.get(HEAD..HEAD + 2).map(|id| [id[1], id[0]]));
        }
    }
    let ordered: Vec<u8> = runs.into_iter().flat_map(|(_, run)| run.concat()).collect();
    file[start..footer].copy_from_slice(&ordered);
    let (summed, rest) = file.split_at_mut(footer + HEAD + 16);
    let mut sum = Crc::new();
    sum.update(&summed[start..]);
    rest[..4].copy_from_slice(&sum.sum().to_le_bytes());
    Some(())
}
