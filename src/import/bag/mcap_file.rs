//! The messages of an MCAP one by one, up to its end or to where it breaks off. A chunk's check sum is looked at before its messages are: none is
//! read that is not what was written.

use std::collections::BTreeMap;
use std::io::Read;
use std::rc::Rc;

use mcap::records::Record;
use mcap::sans_io::{LinearReadEvent, LinearReader, LinearReaderOptions};
use mcap::{McapError, parse_record};

use super::message::{Message, Schema, There};
use crate::file::{guarded, megabytes};
use crate::import::packed::Budget;

/// Bytes that are read at once, at most: a length is not believed before what it tells of is there.
const PIECE: usize = 1 << 20;
/// Bytes of a record before its content.
const RECORD_HEAD: u64 = 9;
/// Bytes of all definitions of a bag, at most.
const DEFINITIONS: usize = 1 << 24;

/// Shows every message, and answers with why the file breaks off, if it does.
pub(super) fn visit<E>(
    from: &mut dyn Read,
    budget: &Budget,
    mut show: impl FnMut(&Message<'_>) -> Result<(), E>,
) -> Result<Option<String>, E> {
    let longest = usize::try_from(budget.piece()).unwrap_or(usize::MAX);
    let options = LinearReaderOptions::default()
        .with_validate_chunk_crcs(true)
        .with_prevalidate_chunk_crcs(true)
        .with_record_length_limit(longest);
    let mut reader = LinearReader::new_with_options(options);
    let mut known = Known::default();
    let mut number = 0;
    loop {
        let event = match guarded(|| reader.next_event()) {
            Ok(Some(event)) => event,
            Ok(None) => return Ok(None),
            Err(cause) => return Ok(Some(cause)),
        };
        let (opcode, data) = match event {
            Ok(LinearReadEvent::ReadRequest(wanted)) => {
                match from.read(reader.insert(wanted.clamp(1, PIECE))) {
                    Ok(read) => reader.notify_read(read),
                    Err(cause) => return Ok(Some(cause.to_string())),
                }
                continue;
            }
            Ok(LinearReadEvent::Record { data, opcode }) => (opcode, data),
            Err(error) => return Ok(Some(broken_off(&error, budget))),
        };
        if let Err(cause) = budget.take(RECORD_HEAD + data.len() as u64) {
            return Ok(Some(cause));
        }
        match guarded(|| parse_record(opcode, data)) {
            Ok(Ok(Record::Message { header, data })) => {
                number += 1;
                let Some(there) = known.channels.get(&header.channel_id) else {
                    return Ok(Some(format!("message {number} is of no known channel")));
                };
                show(&Message {
                    there,
                    number,
                    logged: header.log_time,
                    published: header.publish_time,
                    data: &data,
                    budget,
                })?;
            }
            Ok(Ok(record)) => {
                if let Err(cause) = known.note(record) {
                    return Ok(Some(cause));
                }
            }
            Ok(Err(error)) => return Ok(Some(error.to_string())),
            Err(cause) => return Ok(Some(cause)),
        }
    }
}

/// Definitions and channels that were read so far.
#[derive(Default)]
struct Known {
    schemas: BTreeMap<u16, Rc<Schema>>,
    channels: BTreeMap<u16, There>,
    /// Bytes of the definitions.
    defined: usize,
}

impl Known {
    /// Notes a definition or a channel; writers repeat them.
    fn note(&mut self, record: Record<'_>) -> Result<(), String> {
        match record {
            Record::Schema { header, data } => {
                let is_same = |own: &Rc<Schema>| own.name == header.name && own.data == *data;
                if self.schemas.get(&header.id).is_some_and(is_same) {
                    return Ok(());
                }
                self.defined += header.name.len() + data.len();
                if self.defined > DEFINITIONS {
                    return Err(format!(
                        "the definitions of its messages come to more than {}",
                        megabytes(DEFINITIONS as u64)
                    ));
                }
                let schema = Schema {
                    name: header.name,
                    encoding: header.encoding,
                    data: data.into_owned(),
                };
                self.schemas.insert(header.id, Rc::new(schema));
            }
            Record::Channel(channel) => {
                let there = There {
                    topic: channel.topic,
                    encoding: channel.message_encoding,
                    schema: self.schemas.get(&channel.schema_id).cloned(),
                };
                self.channels.insert(channel.id, there);
            }
            _ => {}
        }
        Ok(())
    }
}

/// Why a file breaks off.
fn broken_off(error: &McapError, budget: &Budget) -> String {
    match error {
        McapError::UnexpectedEof => {
            "it ends before the record that closes it: it was not closed, or is cut off".to_owned()
        }
        McapError::ChunkTooLarge(_) | McapError::RecordTooLarge { .. } => budget.refusal(),
        other => other.to_string(),
    }
}
