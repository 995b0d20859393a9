//! The messages of an MCAP one by one, up to its end or to where it breaks off. A chunk's check sum is looked at before its messages are: none is
//! read that is not what was written.

use std::collections::BTreeMap;
use std::convert::Infallible;

use mcap::parse_record;
use mcap::records::Record;
use mcap::sans_io::{LinearReadEvent, LinearReader, LinearReaderOptions};

/// Longest record or chunk [B]; a length beyond it is a damaged one.
const LONGEST: usize = 1 << 30;

/// A topic that is there, with the name, the encoding and the text of its definition.
#[derive(Debug, Clone)]
pub(super) struct There {
    pub topic: String,
    pub encoding: String,
    pub schema: Option<(String, String, Vec<u8>)>,
}

/// A message.
pub(super) struct Message<'a> {
    /// Its topic.
    pub there: &'a There,
    /// Its number in the file, from 1.
    pub number: u64,
    /// When it was logged and published [ns].
    pub logged: u64,
    pub published: u64,
    /// What it says.
    pub data: &'a [u8],
}

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

/// What a file holds, up to where it breaks off.
#[derive(Default)]
pub(super) struct Scan {
    /// Topics that have messages, in the order of their names.
    pub there: Vec<There>,
    /// Why it breaks off, if it does.
    pub cause: Option<String>,
    /// Messages, and the times at which the first and the last were logged [ns].
    messages: usize,
    logged: Option<[u64; 2]>,
}

impl Scan {
    /// Looks through a file.
    pub fn of(bytes: &[u8]) -> Self {
        let mut scan = Self::default();
        let mut topics: BTreeMap<String, There> = BTreeMap::new();
        let seen = visit(bytes, |message| -> Result<(), Infallible> {
            scan.messages += 1;
            let [first, last] = scan.logged.unwrap_or([message.logged; 2]);
            scan.logged = Some([first.min(message.logged), last.max(message.logged)]);
            if !topics.contains_key(&message.there.topic) {
                topics.insert(message.there.topic.clone(), message.there.clone());
            }
            Ok(())
        });
        let Ok(cause) = seen;
        scan.cause = cause;
        scan.there = topics.into_values().collect();
        scan
    }

    /// What can be read of it.
    pub fn rest(&self) -> String {
        match self.logged {
            Some([first, last]) => format!(
                "the first {} messages can be read, the last of them {:.3} s after the first",
                self.messages,
                (last - first) as f64 * 1e-9
            ),
            None => "no message of it can be read".to_owned(),
        }
    }
}
