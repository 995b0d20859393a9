//! The messages of a SQLite bag (rosbag2_storage_sqlite3) one by one: tables `topics` and `messages`, and since ROS 2 Iron `message_definitions`.

use std::collections::BTreeMap;
use std::path::Path;

use rusqlite::{Connection, Error, OpenFlags};

use super::message::{Message, There};

/// A message's columns.
const MESSAGES: &str = "SELECT topic_id, timestamp, data FROM messages ORDER BY id";
const TOPICS: &str = "SELECT id, name, type, serialization_format FROM topics";
const DEFINITIONS: &str =
    "SELECT topic_type, encoding, encoded_message_definition FROM message_definitions";

/// Shows every message, and answers with why the file breaks off, if it does.
pub(super) fn visit<E>(
    path: &Path,
    mut show: impl FnMut(&Message<'_>) -> Result<(), E>,
) -> Result<Option<String>, E> {
    let opened = open(path).and_then(|connection| {
        let topics = topics(&connection)?;
        Ok((connection, topics))
    });
    let (connection, topics) = match opened {
        Ok(opened) => opened,
        Err(error) => return Ok(Some(error.to_string())),
    };
    let mut statement = match connection.prepare(MESSAGES) {
        Ok(statement) => statement,
        Err(error) => return Ok(Some(error.to_string())),
    };
    let mut rows = match statement.query([]) {
        Ok(rows) => rows,
        Err(error) => return Ok(Some(error.to_string())),
    };
    let mut number = 0;
    loop {
        let row = match rows.next() {
            Ok(Some(row)) => row,
            Ok(None) => return Ok(None),
            Err(error) => return Ok(Some(error.to_string())),
        };
        number += 1;
        let read = || -> Result<(i64, i64, &[u8]), Error> {
            let data = row.get_ref(2)?.as_blob()?;
            Ok((row.get(0)?, row.get(1)?, data))
        };
        let (topic, stamp, data) = match read() {
            Ok(read) => read,
            Err(error) => return Ok(Some(format!("message {number}: {error}"))),
        };
        let Some(there) = topics.get(&topic) else {
            return Ok(Some(format!("message {number} is of no known topic")));
        };
        let stamp = u64::try_from(stamp).unwrap_or(0);
        show(&Message {
            there,
            number,
            logged: stamp,
            published: stamp,
            data,
        })?;
    }
}

/// Opens a file to be read alone: nothing is written beside it, unless its last messages stand in a journal that must be read too.
fn open(path: &Path) -> Result<Connection, Error> {
    let mut journal = path.as_os_str().to_owned();
    journal.push("-wal");
    let has_journal = std::fs::metadata(journal).is_ok_and(|about| about.len() > 0);
    let flags = OpenFlags::SQLITE_OPEN_READ_ONLY | OpenFlags::SQLITE_OPEN_NO_MUTEX;
    match path.to_str() {
        Some(name) if !has_journal => {
            let escaped = name
                .replace('%', "%25")
                .replace('?', "%3f")
                .replace('#', "%23");
            let flags = flags | OpenFlags::SQLITE_OPEN_URI;
            Connection::open_with_flags(format!("file:{escaped}?immutable=1"), flags)
        }
        _ => Connection::open_with_flags(path, flags),
    }
}

/// Topics by their number, with their definitions, or an empty encoding where the bag has none.
fn topics(connection: &Connection) -> Result<BTreeMap<i64, There>, Error> {
    let mut definitions: BTreeMap<String, (String, Vec<u8>)> = BTreeMap::new();
    let has_definitions = "SELECT count(*) FROM sqlite_master WHERE name = 'message_definitions'";
    let count: i64 = connection.query_row(has_definitions, [], |row| row.get(0))?;
    if count > 0 {
        let mut statement = connection.prepare(DEFINITIONS)?;
        let mut rows = statement.query([])?;
        while let Some(row) = rows.next()? {
            let text: String = row.get(2)?;
            if !text.is_empty() {
                definitions.insert(row.get(0)?, (row.get(1)?, text.into_bytes()));
            }
        }
    }
    let mut topics = BTreeMap::new();
    let mut statement = connection.prepare(TOPICS)?;
    let mut rows = statement.query([])?;
    while let Some(row) = rows.next()? {
        let name: String = row.get(2)?;
        let (encoding, text) = definitions.get(&name).cloned().unwrap_or_default();
        let there = There {
            topic: row.get(1)?,
            encoding: row.get(3)?,
            schema: Some((name, encoding, text)),
        };
        topics.insert(row.get(0)?, there);
    }
    Ok(topics)
}
