//! The messages of a SQLite bag (rosbag2_storage_sqlite3) one by one: tables `topics` and `messages`, and since ROS 2 Iron `message_definitions`.

use std::collections::BTreeMap;
use std::io::Read;
use std::path::{Path, PathBuf};
use std::rc::Rc;

use rusqlite::config::DbConfig;
use rusqlite::limits::Limit;
use rusqlite::{Connection, Error, ErrorCode, OpenFlags};

use super::message::{Message, Schema, There};
use crate::file;
use crate::import::packed::{Budget, LARGEST_MESSAGE};

/// A message's columns. By no index the rows come in the order of their numbers, `id`: asked for, that order might have all of them sorted.
const MESSAGES: &str = "SELECT topic_id, timestamp, data FROM messages NOT INDEXED";
/// Tables as they were declared: what is shown of a view, a virtual table or a computed column is not in the file.
const DECLARED: &str = "SELECT lower(name), sql FROM sqlite_master WHERE lower(name) IN ('topics', 'messages', 'message_definitions')";
const COMPUTED: &str = "SELECT count(*) FROM pragma_table_xinfo(?1) WHERE hidden != 0";
/// Steps of SQLite's machine that any file may take, and those of each of its bytes; between two looks at their count.
const STEPS: u64 = 10_000_000;
const STEPS_A_BYTE: u64 = 4;
const STEPS_AT_ONCE: u32 = 10_000;
const TOPICS: &str = "SELECT id, name, type, serialization_format FROM topics";
const DEFINITIONS: &str =
    "SELECT topic_type, encoding, encoded_message_definition FROM message_definitions";

/// Shows every message, and answers with why the file breaks off, if it does.
pub(super) fn visit<E>(
    path: &Path,
    budget: &Budget,
    mut show: impl FnMut(&Message<'_>) -> Result<(), E>,
) -> Result<Option<String>, E> {
    let opened = open(path).and_then(|connection| {
        if let Some(cause) = is_no_bag(&connection)? {
            return Ok(Err(cause));
        }
        let topics = topics(&connection)?;
        Ok(Ok((connection, topics)))
    });
    let (connection, topics) = match opened {
        Ok(Ok(opened)) => opened,
        Ok(Err(cause)) => return Ok(Some(cause)),
        Err(error) => return Ok(Some(broken_off(&error))),
    };
    let mut statement = match connection.prepare(MESSAGES) {
        Ok(statement) => statement,
        Err(error) => return Ok(Some(broken_off(&error))),
    };
    let mut rows = match statement.query([]) {
        Ok(rows) => rows,
        Err(error) => return Ok(Some(broken_off(&error))),
    };
    let mut number = 0;
    loop {
        let row = match rows.next() {
            Ok(Some(row)) => row,
            Ok(None) => return Ok(None),
            Err(error) => return Ok(Some(broken_off(&error))),
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
        if let Err(cause) = budget.take(data.len() as u64) {
            return Ok(Some(cause));
        }
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
            budget,
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
    let read = file::open(&back).and_then(|file| file.take(8).read_to_end(&mut start));
    let is_hot = read.is_ok() && start == HOT;
    [(ahead, is_filled), (back, is_hot)]
        .into_iter()
        .filter_map(|(journal, counts)| counts.then_some(journal))
        .collect()
}

/// Why a file is no bag, if it is none: it lacks a table, or has in its place what computes its rows.
fn is_no_bag(connection: &Connection) -> Result<Option<String>, Error> {
    let mut statement = connection.prepare(DECLARED)?;
    let mut rows = statement.query([])?;
    let mut tables: Vec<String> = Vec::new();
    while let Some(row) = rows.next()? {
        let name: String = row.get(0)?;
        let declared: Option<String> = row.get(1)?;
        let is_table = declared.is_some_and(|text| text.starts_with("CREATE TABLE "));
        let computed: i64 = connection.query_row(COMPUTED, [&name], |row| row.get(0))?;
        if !is_table || computed > 0 {
            return Ok(Some(format!(
                "its `{name}` is no plain table, as in a bag of ROS 2, but computed by SQL"
            )));
        }
        tables.push(name);
    }
    let lacks = |name: &str| !tables.iter().any(|own| own == name);
    Ok((lacks("topics") || lacks("messages"))
        .then(|| "it has no tables `topics` and `messages`, as a bag of ROS 2 has".to_owned()))
}

/// Why a file breaks off.
fn broken_off(error: &Error) -> String {
    match error.sqlite_error_code() {
        Some(ErrorCode::OperationInterrupted) => {
            "reading it takes more steps than a file of its size needs, as only that of a damaged or a hostile one does"
                .to_owned()
        }
        Some(ErrorCode::TooBig) => format!(
            "it holds a message of more than {}",
            file::megabytes(LARGEST_MESSAGE)
        ),
        _ => error.to_string(),
    }
}

/// Opens a file, and bounds what it may have SQLite do.
fn open(path: &Path) -> Result<Connection, Error> {
    let unread = |cause: std::io::Error| Error::InvalidParameterName(cause.to_string());
    let size = file::check(path).map_err(unread)?.len();
    let mut connection = connect(path)?;
    connection.set_limit(Limit::SQLITE_LIMIT_LENGTH, LARGEST_MESSAGE as i32)?;
    connection.set_limit(Limit::SQLITE_LIMIT_ATTACHED, 0)?;
    connection.set_db_config(DbConfig::SQLITE_DBCONFIG_TRUSTED_SCHEMA, false)?;
    connection.set_db_config(DbConfig::SQLITE_DBCONFIG_ENABLE_TRIGGER, false)?;
    connection.set_db_config(DbConfig::SQLITE_DBCONFIG_ENABLE_VIEW, false)?;
    connection.pragma_update(None, "cell_size_check", true)?;
    let mut left = (STEPS + STEPS_A_BYTE.saturating_mul(size)) / u64::from(STEPS_AT_ONCE);
    let is_over = move || {
        left = left.saturating_sub(1);
        left == 0
    };
    connection.progress_handler(STEPS_AT_ONCE as i32, Some(is_over))?;
    Ok(connection)
}

/// Opens a file to be read alone: nothing is written beside it. A copy whose journals were copied too is one that SQLite may mend.
fn connect(path: &Path) -> Result<Connection, Error> {
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
    let mut definitions: BTreeMap<String, Rc<Schema>> = BTreeMap::new();
    let has_definitions = "SELECT count(*) FROM sqlite_master WHERE name = 'message_definitions'";
    let count: i64 = connection.query_row(has_definitions, [], |row| row.get(0))?;
    if count > 0 {
        let mut statement = connection.prepare(DEFINITIONS)?;
        let mut rows = statement.query([])?;
        while let Some(row) = rows.next()? {
            let text: String = row.get(2)?;
            if !text.is_empty() {
                let schema = Schema {
                    name: row.get(0)?,
                    encoding: row.get(1)?,
                    data: text.into_bytes(),
                };
                definitions.insert(schema.name.clone(), Rc::new(schema));
            }
        }
    }
    let mut topics = BTreeMap::new();
    let mut statement = connection.prepare(TOPICS)?;
    let mut rows = statement.query([])?;
    while let Some(row) = rows.next()? {
        let name: String = row.get(2)?;
        let schema = definitions.get(&name).cloned().unwrap_or_else(|| {
            Rc::new(Schema {
                name,
                ..Schema::default()
            })
        });
        let there = There {
            topic: row.get(1)?,
            encoding: row.get(3)?,
            schema: Some(schema),
            metadata: Rc::default(),
        };
        topics.insert(row.get(0)?, there);
    }
    Ok(topics)
}
