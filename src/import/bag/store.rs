//! Where a bag's messages are kept: MCAP or SQLite, one file, or several in the folder that `ros2 bag record` writes.

use std::collections::BTreeMap;
use std::convert::Infallible;
use std::path::{Path, PathBuf};

use super::message::{Message, There};
use super::{mcap_file, sqlite_file};

/// Endings of files that are bags.
const ENDINGS: [&str; 2] = ["mcap", "db3"];
/// Beginning of a SQLite file (its format, 1.3).
const SQLITE: &[u8] = b"SQLite format 3\0";

/// The files of a bag, in order.
pub(super) struct Stores(Vec<Store>);

/// One of them.
enum Store {
    Mcap(Vec<u8>),
    Sqlite(PathBuf),
}

impl Stores {
    /// Opens a file, or all of a folder's.
    pub fn open(path: &Path) -> Result<Self, String> {
        if !path.is_dir() {
            return Ok(Self(vec![Store::open(path)?]));
        }
        let entries = std::fs::read_dir(path).map_err(|cause| cause.to_string())?;
        let mut files: Vec<PathBuf> = entries.filter_map(|e| Some(e.ok()?.path())).collect();
        files.sort_by_key(|file| (number(file), file.clone()));
        let ends = |file: &&PathBuf, endings: &[&str]| {
            let ending = file.extension().and_then(|ending| ending.to_str());
            ending.is_some_and(|ending| endings.contains(&ending))
        };
        let own: Vec<&PathBuf> = files.iter().filter(|file| ends(file, &ENDINGS)).collect();
        if own.is_empty() {
            let packed = files.iter().find(|file| ends(file, &["zstd", "zst"]));
            return Err(match packed {
                Some(file) => format!(
                    "its file {} is packed: `zstd -d` unpacks it",
                    file.display()
                ),
                None => "it is a folder without .mcap or .db3 files, and no bag".to_owned(),
            });
        }
        let stores = own.into_iter().map(|file| Store::open(file));
        Ok(Self(stores.collect::<Result<_, _>>()?))
    }

    /// Shows every message, and answers with why the bag breaks off, if it does.
    pub fn visit<E>(
        &self,
        mut show: impl FnMut(&Message<'_>) -> Result<(), E>,
    ) -> Result<Option<String>, E> {
        let mut before = 0;
        for store in &self.0 {
            let mut last = before;
            let mut counted = |message: &Message<'_>| {
                last = before + message.number;
                show(&Message {
                    number: last,
                    ..*message
                })
            };
            let cause = match store {
                Store::Mcap(bytes) => mcap_file::visit(bytes, &mut counted)?,
                Store::Sqlite(path) => sqlite_file::visit(path, &mut counted)?,
            };
            if cause.is_some() {
                return Ok(cause);
            }
            before = last;
        }
        Ok(None)
    }

    /// The command that repairs such a bag.
    pub fn repaired_by(&self) -> &'static str {
        match self.0.first() {
            Some(Store::Sqlite(_)) => "sqlite3 OLD.db3 .recover | sqlite3 NEW.db3",
            _ => "mcap recover",
        }
    }
}

impl Store {
    /// Opens a file as what it begins with says, whatever its name.
    fn open(path: &Path) -> Result<Self, String> {
        let bytes = std::fs::read(path).map_err(|cause| cause.to_string())?;
        if bytes.starts_with(mcap::MAGIC) {
            return Ok(Self::Mcap(bytes));
        }
        if bytes.starts_with(SQLITE) {
            return Ok(Self::Sqlite(path.to_owned()));
        }
        Err("it is no MCAP and no SQLite bag: it does not start as one".to_owned())
    }
}

/// The number that a bag's file ends with, by which they are in order: `ride_2.db3` before `ride_10.db3`.
fn number(file: &Path) -> u64 {
    let stem = file.file_stem().unwrap_or_default().to_string_lossy();
    let number = stem.rsplit('_').next().map(str::parse);
    number.and_then(Result::ok).unwrap_or(0)
}

/// Content of a bag, up to where it breaks off.
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
    /// Looks through a bag.
    pub fn of(stores: &Stores) -> Self {
        let mut scan = Self::default();
        let mut topics: BTreeMap<String, There> = BTreeMap::new();
        let seen = stores.visit(|message| -> Result<(), Infallible> {
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

    /// The readable part of it.
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
