//! Where a bag's messages are kept: MCAP or SQLite, one file, or several in the folder that `ros2 bag record` writes; packed with zstd or gzip or not.

use std::collections::BTreeMap;
use std::convert::Infallible;
use std::io::{BufReader, Read};
use std::path::{Path, PathBuf};

use tempfile::TempDir;

use super::listed::Listed;
use super::message::{Message, There};
use super::{mcap_file, sqlite_file};
use crate::file::{self, Limit};
use crate::import::packed::{Budget, GZIP, ZSTD, begins_packed, plain_name, unpacked};
use crate::import::rows::Remark;
use crate::import::signature;

/// Endings of files that are bags.
const ENDINGS: [&str; 2] = ["mcap", "db3"];
/// Beginning of a SQLite file (its format, 1.3).
const SQLITE: &[u8] = b"SQLite format 3\0";
/// First bytes of a file that are looked at.
const LOOKED_AT: u64 = 1 << 16;

/// The files of a bag, in order.
pub(super) struct Stores {
    all: Vec<Store>,
    /// Files that its metadata name and that are not there.
    pub missing: Vec<String>,
    /// Messages that its metadata count.
    counted: Option<u64>,
    /// Remarks on its files.
    pub notes: Vec<Remark>,
    limit: Limit,
    /// Bytes of its files.
    size: u64,
}

/// One of them.
enum Store {
    /// An MCAP file.
    Mcap(PathBuf),
    /// One that was packed.
    Unpacked(Vec<u8>),
    /// A SQLite file, and the folder of the copy that it is, if it is one.
    Sqlite(
        PathBuf,
        #[expect(dead_code, reason = "it is removed when the bag has been read")] Option<TempDir>,
    ),
}

impl Stores {
    /// Opens a file, or all of a folder's.
    pub fn open(path: &Path, limit: Limit) -> Result<Self, String> {
        let mut stores = Self {
            all: Vec::new(),
            missing: Vec::new(),
            counted: None,
            notes: Vec::new(),
            limit,
            size: 0,
        };
        if !path.is_dir() {
            stores.add(path)?;
            return Ok(stores);
        }
        let entries = std::fs::read_dir(path).map_err(|cause| cause.to_string())?;
        let mut files: Vec<PathBuf> = entries.filter_map(|e| Some(e.ok()?.path())).collect();
        files.retain(|file| is_named_as_bag(file));
        files.sort_by_key(|file| (number(file), file.clone()));
        match Listed::of(path) {
            Ok(None) => {}
            Ok(Some(listed)) => {
                let (own, others) = listed.parted(files);
                stores.missing = listed.missing(&own);
                stores.counted = listed.messages;
                stores.notes.extend(others.iter().map(|file| {
                    Remark::Note(format!(
                        "{} is not among the files that its metadata.yaml names, and was left out",
                        short(file)
                    ))
                }));
                files = own;
            }
            Err(cause) => stores.notes.push(Remark::Note(format!(
                "its metadata.yaml cannot be read ({cause}), and says nothing of missing files"
            ))),
        }
        if files.is_empty() {
            return Err("it is a folder without .mcap or .db3 files, and no bag".to_owned());
        }
        for file in &files {
            let added = stores.add(file);
            added.map_err(|cause| format!("its file {}: {cause}", short(file)))?;
        }
        Ok(stores)
    }

    /// Opens a file as what it begins with says, whatever its name.
    fn add(&mut self, path: &Path) -> Result<(), String> {
        let unread = |cause: std::io::Error| cause.to_string();
        let file = file::open(path).map_err(unread)?;
        self.size += file.metadata().map_err(unread)?.len();
        let mut start = Vec::new();
        (file.take(LOOKED_AT).read_to_end(&mut start)).map_err(unread)?;
        let packed = match start.starts_with(GZIP) || start.starts_with(ZSTD) {
            true => {
                let bytes = file::read_up_to(path, self.limit.whole()).map_err(unread)?;
                unpacked(&bytes, self.limit)?
            }
            false => None,
        };
        let bytes = packed.as_deref().unwrap_or(&start);
        if !bytes.starts_with(mcap::MAGIC) && !bytes.starts_with(SQLITE) {
            return Err(match signature::of_bytes(bytes) {
                Some(other) => format!("it is {}, and no bag in MCAP or SQLite", other.what),
                None => "it is no MCAP and no SQLite bag: it does not start as one".to_owned(),
            });
        }
        if bytes.starts_with(mcap::MAGIC) {
            self.all.push(match packed {
                Some(bytes) => Store::Unpacked(bytes),
                None => Store::Mcap(path.to_owned()),
            });
            return Ok(());
        }
        let journals = sqlite_file::journals(path);
        if packed.is_none() && journals.is_empty() {
            self.all.push(Store::Sqlite(path.to_owned(), None));
            return Ok(());
        }
        let failed = |cause: std::io::Error| format!("it cannot be copied to be read: {cause}");
        let folder = tempfile::tempdir().map_err(failed)?;
        let copy = folder.path().join("bag.db3");
        match packed {
            Some(bytes) => std::fs::write(&copy, bytes).map_err(failed)?,
            None => {
                std::fs::copy(path, &copy).map_err(failed)?;
            }
        }
        for journal in journals {
            let about = file::check(&journal).map_err(failed)?;
            self.size += about.len();
            let ending = if short(&journal).ends_with("-wal") {
                "bag.db3-wal"
            } else {
                "bag.db3-journal"
            };
            std::fs::copy(&journal, folder.path().join(ending)).map_err(failed)?;
            self.notes.push(Remark::Note(format!(
                "it was not closed: its journal {} was read with it",
                short(&journal)
            )));
        }
        self.all.push(Store::Sqlite(copy, Some(folder)));
        Ok(())
    }

    /// Shows every message, and answers with why the bag breaks off, if it does.
    pub fn visit<E>(
        &self,
        mut show: impl FnMut(&Message<'_>) -> Result<(), E>,
    ) -> Result<Option<String>, E> {
        let mut before = 0;
        let budget = Budget::new(self.limit, self.size);
        for store in &self.all {
            let mut last = before;
            let mut counted = |message: &Message<'_>| {
                last = before + message.number;
                show(&Message {
                    number: last,
                    ..*message
                })
            };
            let cause = match store {
                Store::Mcap(path) => match file::open(path) {
                    Ok(file) => mcap_file::visit(&mut BufReader::new(file), &budget, &mut counted)?,
                    Err(cause) => return Ok(Some(cause.to_string())),
                },
                Store::Unpacked(bytes) => {
                    mcap_file::visit(&mut bytes.as_slice(), &budget, &mut counted)?
                }
                Store::Sqlite(path, _) => sqlite_file::visit(path, &budget, &mut counted)?,
            };
            if cause.is_some() {
                return Ok(cause);
            }
            before = last;
        }
        Ok(None)
    }

    /// Number of its files.
    pub fn count(&self) -> usize {
        self.all.len()
    }

    /// The command that repairs such a bag.
    pub fn repaired_by(&self) -> &'static str {
        match self.all.first() {
            Some(Store::Sqlite(..)) => "sqlite3 OLD.db3 .recover | sqlite3 NEW.db3",
            _ => "mcap recover",
        }
    }
}

/// Name of a file, for people.
fn short(file: &Path) -> String {
    let name = file.file_name().unwrap_or(file.as_os_str());
    name.to_string_lossy().into_owned()
}

/// Whether a file's name is that of a bag's file, packed or not.
fn is_named_as_bag(file: &Path) -> bool {
    let name = short(&plain_name(file)).to_lowercase();
    ENDINGS
        .iter()
        .any(|ending| name.ends_with(&format!(".{ending}")))
}

/// Whether a file is a bag that is packed.
pub(in crate::import) fn is_packed(path: &Path) -> bool {
    let start = || -> Option<Vec<u8>> {
        let mut start = Vec::new();
        let file = file::open(path).ok()?;
        begins_packed(file)?
            .take(SQLITE.len() as u64)
            .read_to_end(&mut start)
            .ok()?;
        Some(start)
    };
    start().is_some_and(|start| start.starts_with(mcap::MAGIC) || start.starts_with(SQLITE))
}

/// The number that a bag's file ends with, by which they are in order: `ride_2.db3` before `ride_10.db3`.
fn number(file: &Path) -> u64 {
    let plain = plain_name(file);
    let stem = plain.file_stem().unwrap_or_default().to_string_lossy();
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

    /// Messages that were counted when it was written, where that is known and there are fewer.
    pub fn lost(&self, stores: &Stores) -> Option<String> {
        let counted = stores
            .counted
            .filter(|counted| *counted > self.messages as u64)?;
        Some(format!(
            "its metadata.yaml counts {counted} messages, and {} are there",
            self.messages
        ))
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
