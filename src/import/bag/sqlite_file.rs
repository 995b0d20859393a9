//! The messages of a SQLite bag (rosbag2_storage_sqlite3) one by one: tables `topics` and `messages`, and since ROS 2 Iron `message_definitions`.

use std::collections::BTreeMap;
use std::fs::File;
use std::io::Read;
use std::path::{Path, PathBuf};

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
        if !is_bag(&connection)? {
            return Ok(None);
        }
        let topics = topics(&connection)?;
        Ok(Some((connection, topics)))
    });
    let (connection, topics) = match opened {
        Ok(Some(opened)) => opened,
        Ok(None) => {
            return Ok(Some(
                "it has no tables `topics` and `messages`, as a bag of ROS 2 has".to_owned(),
            ));
        }
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

/// First bytes of a journal of which something is to be taken back; one that is done with begins with zeros.
const HOT: &[u8] = b"\xd9\xd5\x05\xf9\x20\xa1\x63\xd7";

/// Journals beside a file that was not closed: without them it is not whole, or not as it was last.
pub(super) fn journals(path: &Path) -> Vec<PathBuf> {
    let beside = |ending: &str| {
        let mut name = path.as_os_str().to_owned();
        name.push(ending);
        PathBuf::from(name)
    };
    let (ahead, back) = (beside("-wal"), beside("-journal"));
    let is_filled = std::fs::metadata(&ahead).is_ok_and(|about| about.len() > 0);
    let mut start = Vec::new();
    let read = File::open(&back).and_then(|file| file.take(8).read_to_end(&mut start));
    let is_hot = read.is_ok() && start == HOT;
    [(ahead, is_filled), (back, is_hot)]
        .into_iter()
        .filter_map(|(journal, counts)| counts.then_some(journal))
        .collect()
}

/// Whether it has the tables of a bag.
fn is_bag(connection: &Connection) -> Result<bool, Error> {
    let own = "SELECT count(*) FROM sqlite_master WHERE name IN ('topics', 'messages')";
    let count: i64 = connection.query_row(own, [], |row| row.get(0))?;
    Ok(count == 2)
}

/// Opens a file to be read alone: nothing is written beside it. A copy whose journals were copied too is one that SQLite may mend.
fn open(path: &Path) -> Result<Connection, Error> {
    if !journals(path).is_empty() {
        return Connection::open_with_flags(
            path,
            OpenFlags::SQLITE_OPEN_READ_WRITE | OpenFlags::SQLITE_OPEN_NO_MUTEX,
        );
    }
    let flags = OpenFlags::SQLITE_OPEN_READ_ONLY | OpenFlags::SQLITE_OPEN_NO_MUTEX;
    match path.to_str() {
        Some(name) => {
            let escaped = name
                .replace('%', "%25")
                .replace('?', "%3f")
                .replace('#', "%23");
            let flags = flags | OpenFlags::SQLITE_OPEN_URI;
            Connection::open_with_flags(format!("file:{escaped}?immutable=1"), flags)
        }
        None => Connection::open_with_flags(path, flags),
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
