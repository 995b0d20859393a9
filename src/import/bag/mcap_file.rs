//! The messages of an MCAP one by one, up to its end or to where it breaks off. A chunk is unpacked to as many bytes as it says, and its check sum looked at,
//! before its messages are: none is read that is not what was written.

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::io::Read;
use std::rc::Rc;

use flate2::Crc;
use mcap::records::{ChunkHeader, Record, op};
use mcap::sans_io::{LinearReadEvent, LinearReader, LinearReaderOptions};
use mcap::{McapError, parse_record};

use super::message::{Message, Schema, There};
use crate::file::{guarded, megabytes};
use crate::import::packed::Budget;

/// Bytes that are read at once, at most: a length is not relied on before its bytes are there.
const PIECE: usize = 1 << 20;
/// Bytes of a record before its content: its kind and its length.
const HEAD: usize = 9;
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
        .with_emit_chunks(true)
        .with_record_length_limit(longest);
    let mut reader = LinearReader::new_with_options(options);
    let mut known = Known::default();
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
        let broken = match opcode {
            op::CHUNK => match chunk(data, budget) {
                Ok(plain) => known.records(&plain, budget, &mut show)?,
                Err(cause) => Some(cause),
            },
            _ => known.record(opcode, data, budget, &mut show)?,
        };
        if broken.is_some() {
            return Ok(broken);
        }
    }
}

/// The records of a chunk, unpacked.
fn chunk<'a>(data: &'a [u8], budget: &Budget) -> Result<Cow<'a, [u8]>, String> {
    let read = guarded(|| parse_record(op::CHUNK, data))?;
    let Record::Chunk { header, data } = read.map_err(|error| error.to_string())? else {
        return Err("a chunk of it is none".to_owned());
    };
    if header.uncompressed_size > budget.piece() {
        return Err(budget.refusal());
    }
    let plain = match header.compression.as_str() {
        "" => data,
        "zstd" => {
            let decoder = zstd::stream::read::Decoder::with_buffer(&*data);
            Cow::Owned(unpacked(decoder.map_err(|e| e.to_string())?, &header)?)
        }
        "lz4" => {
            let decoder = lz4::Decoder::new(&*data);
            Cow::Owned(unpacked(decoder.map_err(|e| e.to_string())?, &header)?)
        }
        other => return Err(McapError::UnsupportedCompression(other.to_owned()).to_string()),
    };
    if header.uncompressed_crc != 0 {
        let (mut sum, saved) = (Crc::new(), header.uncompressed_crc);
        sum.update(&plain);
        let calculated = sum.sum();
        if calculated != saved {
            return Err(McapError::BadChunkCrc { saved, calculated }.to_string());
        }
    }
    Ok(plain)
}

/// As many bytes of a chunk as it says that it holds.
fn unpacked(decoder: impl Read, header: &ChunkHeader) -> Result<Vec<u8>, String> {
    let claimed = header.uncompressed_size;
    let mut plain = Vec::new();
    let read = decoder.take(claimed + 1).read_to_end(&mut plain);
    let found = plain.len() as u64;
    match read {
        Err(cause) if found < claimed => Err(format!("a chunk of it is damaged: {cause}")),
        _ if found != claimed => Err(format!(
            "a chunk of it says that it holds {claimed} bytes, and holds {}",
            if found < claimed { "fewer" } else { "more" }
        )),
        _ => Ok(plain),
    }
}

/// Definitions and channels that were read so far.
#[derive(Default)]
struct Known {
    schemas: BTreeMap<u16, Rc<Schema>>,
    channels: BTreeMap<u16, There>,
    /// Bytes of the definitions.
    defined: usize,
    /// Messages so far.
    number: u64,
}

impl Known {
    /// Takes the records of a chunk; the answer is why it breaks off.
    fn records<E>(
        &mut self,
        mut rest: &[u8],
        budget: &Budget,
        show: &mut impl FnMut(&Message<'_>) -> Result<(), E>,
    ) -> Result<Option<String>, E> {
        while let Some((head, after)) = rest.split_first_chunk::<HEAD>() {
            let length = u64::from_le_bytes(std::array::from_fn(|place| head[place + 1]));
            let length = usize::try_from(length).unwrap_or(usize::MAX);
            let Some((data, behind)) = after.split_at_checked(length) else {
                break;
            };
            let broken = self.record(head[0], data, budget, show)?;
            if broken.is_some() {
                return Ok(broken);
            }
            rest = behind;
        }
        Ok((!rest.is_empty()).then(|| "a chunk of it ends within a record".to_owned()))
    }

    /// Takes a record; the answer is why the file breaks off there.
    fn record<E>(
        &mut self,
        opcode: u8,
        data: &[u8],
        budget: &Budget,
        show: &mut impl FnMut(&Message<'_>) -> Result<(), E>,
    ) -> Result<Option<String>, E> {
        if opcode == 0 {
            return Ok(Some("a record of it has no kind".to_owned()));
        }
        if let Err(cause) = budget.take((HEAD + data.len()) as u64) {
            return Ok(Some(cause));
        }
        match guarded(|| parse_record(opcode, data)) {
            Ok(Ok(Record::Message { header, data })) => {
                self.number += 1;
                let number = self.number;
                let Some(there) = self.channels.get(&header.channel_id) else {
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
                Ok(None)
            }
            Ok(Ok(record)) => Ok(self.note(record).err()),
            Ok(Err(error)) => Ok(Some(error.to_string())),
            Err(cause) => Ok(Some(cause)),
        }
    }

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
                    metadata: Rc::new(channel.metadata),
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
        McapError::RecordTooLarge { .. } => budget.refusal(),
        other => other.to_string(),
    }
}
