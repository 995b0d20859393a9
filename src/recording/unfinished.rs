//! What is being written: temporary files and folders by their names and locks, and what an interruption takes away.

use std::collections::BTreeSet;
use std::ffi::OsStr;
use std::fs::{File, TryLockError};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::Duration;

/// Beginning of the names of temporary files and folders.
pub(super) const UNFINISHED: &str = ".unfinished-";

/// Files and folders being written now: temporary files and folders, and folders that were made and may be empty yet. While the lock is held nothing is begun and
/// nothing put in its place, so that files that belong together are never parted.
static BEGUN: Mutex<BTreeSet<PathBuf>> = Mutex::new(BTreeSet::new());

pub(super) fn begun() -> MutexGuard<'static, BTreeSet<PathBuf>> {
    // A path too many or too few is sound.
    BEGUN.lock().unwrap_or_else(PoisonError::into_inner)
}

/// A path that is being written until this is dropped.
#[derive(Debug)]
pub(super) struct Begun(PathBuf);

impl Begun {
    pub(super) fn note(begun: &mut BTreeSet<PathBuf>, path: &Path) -> Self {
        begun.insert(path.to_owned());
        Self(path.to_owned())
    }
}

impl Drop for Begun {
    fn drop(&mut self) {
        begun().remove(&self.0);
    }
}

/// Makes a folder and those above it. Where the program is interrupted, those that were made and are still empty go again.
///
/// # Errors
/// As `std::fs::create_dir_all`.
pub fn make_folder(path: &Path) -> std::io::Result<()> {
    let mut begun = begun();
    let absent: Vec<PathBuf> = (path.ancestors())
        .take_while(|folder| !folder.as_os_str().is_empty() && !folder.exists())
        .map(Path::to_owned)
        .collect();
    std::fs::create_dir_all(path)?;
    begun.extend(absent);
    Ok(())
}

/// Removes all that is being written, as the program is about to end: from here on nothing is begun, and nothing put in its place.
pub fn abandon() {
    /// Other threads go on until the end, and may just be opening or removing a file.
    const TRIES: usize = 50;
    const BETWEEN: Duration = Duration::from_millis(4);
    let begun = begun();
    for _ in 0..TRIES {
        // What a folder holds comes after it in this order, and goes first.
        let gone = begun.iter().rev().map(|path| abandoned(path));
        if gone.collect::<Vec<_>>().into_iter().all(|gone| gone) {
            break;
        }
        std::thread::sleep(BETWEEN);
    }
    // For good.
    std::mem::forget(begun);
}

/// Removes a temporary file or folder, or a folder that is empty. Whether it is gone, or to stay as it holds something whole.
fn abandoned(path: &Path) -> bool {
    let is_temporary = |name: &OsStr| name.to_string_lossy().starts_with(UNFINISHED);
    if path.file_name().is_some_and(is_temporary) {
        drop(std::fs::remove_dir_all(path).or_else(|_| std::fs::remove_file(path)));
        return !path.exists();
    }
    drop(std::fs::remove_dir(path));
    let entries = std::fs::read_dir(path).map(|entries| entries.flatten().collect::<Vec<_>>());
    entries.map_or(true, |found| {
        !found.is_empty() && !found.iter().any(|entry| is_temporary(&entry.file_name()))
    })
}

/// Folder of a file.
pub(super) fn folder_of(path: &Path) -> &Path {
    match path.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => parent,
        _ => Path::new("."),
    }
}

/// Takes the lock of an open file or folder; none where that is not known, false where another has it.
pub(super) fn lock(file: &File) -> Option<bool> {
    match file.try_lock() {
        Ok(()) => Some(true),
        Err(TryLockError::WouldBlock) => Some(false),
        Err(TryLockError::Error(_)) => None,
    }
}

/// Whether a path leads to this open file or folder still.
#[cfg(unix)]
pub(super) fn is_still_at(file: &File, path: &Path) -> bool {
    use std::os::unix::fs::MetadataExt as _;
    let place = |found: std::fs::Metadata| (found.dev(), found.ino());
    match (file.metadata(), std::fs::symlink_metadata(path)) {
        (Ok(one), Ok(other)) => place(one) == place(other),
        _ => false,
    }
}

/// Elsewhere an open file cannot be taken away.
#[cfg(not(unix))]
pub(super) fn is_still_at(_file: &File, _path: &Path) -> bool {
    true
}

/// What the system says of a temporary file, without the name that nobody knows it by.
pub(super) fn without_place(cause: &dyn std::fmt::Display) -> String {
    let text = cause.to_string();
    match text.rsplit_once(" at path \"") {
        Some((cause, _)) => cause.to_owned(),
        None => text,
    }
}
