//! The messages of an MCAP one by one, up to its end or to where it breaks off. A chunk's check sum is looked at before its messages are: none is
//! read that is not what was written.

use std::collections::BTreeMap;

use mcap::records::Record;
use mcap::sans_io::{LinearReadEvent, LinearReader, LinearReaderOptions};
use mcap::{McapError, parse_record};

use super::message::{Message, There};

/// Longest record or chunk [B]; a length beyond it is a damaged one.
const LONGEST: usize = 1 << 30;

/// Shows every message, and answers with why the file breaks off, if it does.
pub(super) fn visit<E>(
    bytes: &[u8],
    mut show: impl FnMut(&Message<'_>) -> Result<(), E>,
) -> Result<Option<String>, E> {
    let options = LinearReaderOptions::default()
        .with_validate_chunk_crcs(true)
        .with_prevalidate_chunk_crcs(true)
        .with_record_length_limit(LONGEST);
    let mut reader = LinearReader::new_with_options(options);
    let mut rest = bytes;
    let mut schemas = BTreeMap::new();
    let mut channels: BTreeMap<u16, There> = BTreeMap::new();
    let mut number = 0;
    while let Some(event) = reader.next_event() {
        let record = match event {
            Ok(LinearReadEvent::ReadRequest(wanted)) => {
                let (now, after) = rest.split_at(wanted.min(rest.len()));
                reader.insert(now.len()).copy_from_slice(now);
                reader.notify_read(now.len());
                rest = after;
                continue;
            }
            Ok(LinearReadEvent::Record { data, opcode }) => parse_record(opcode, data),
            Err(McapError::UnexpectedEof) => {
                return Ok(Some(
                    "it ends before the record that closes it: it was not closed, or is cut off"
                        .to_owned(),
                ));
            }
            Err(error) => return Ok(Some(error.to_string())),
        };
        match record {
            Ok(Record::Schema { header, data }) => {
                schemas.insert(header.id, (header.name, header.encoding, data.into_owned()));
            }
            Ok(Record::Channel(channel)) => {
                let there = There {
                    topic: channel.topic,
                    encoding: channel.message_encoding,
                    schema: schemas.get(&channel.schema_id).cloned(),
                };
                channels.insert(channel.id, there);
            }
            Ok(Record::Message { header, data }) => {
                number += 1;
                let Some(there) = channels.get(&header.channel_id) else {
                    return Ok(Some(format!("message {number} is of no known channel")));
                };
                show(&Message {
                    there,
                    number,
                    logged: header.log_time,
                    published: header.publish_time,
                    data: &data,
                })?;
            }
            Ok(_) => {}
            Err(error) => return Ok(Some(error.to_string())),
        }
    }
    Ok(None)
}
