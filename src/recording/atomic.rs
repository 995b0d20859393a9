//! Files that appear whole or not at all.
//!
//! The content goes to a temporary file in the target's directory, which is renamed onto the
//! target once everything is on disk. A run that is refused half-way, or interrupted, leaves the old file
//! or none, and nothing unfinished beside it.

use std::collections::BTreeSet;
use std::ffi::OsStr;
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::Duration;

use tempfile::{Builder, NamedTempFile, TempDir};

use super::RecordingError;

/// Beginning of the names of temporary files and folders.
const UNFINISHED: &str = ".unfinished-";

/// A file being written; it gets its name when the writing has succeeded.
pub type UnfinishedFile = BufWriter<NamedTempFile>;

/// Writes `path` by means of `write`, replacing what was there only if all went well.
///
/// # Errors
/// [`RecordingError::Write`] with the path and the cause, be it the disk's or that of `write`.
pub fn write_atomic<E: std::fmt::Display>(
    path: &Path,
    write: impl FnOnce(&mut UnfinishedFile) -> Result<(), E>,
) -> Result<(), RecordingError> {
    let fail = |cause: &dyn std::fmt::Display| RecordingError::write(path, cause);
    let directory = match path.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => parent,
        _ => Path::new("."),
    };
    let (file, begun) = {
        let mut begun = begun();
        let file = temporary_file_in(directory).map_err(|e| fail(&e))?;
        let path = Begun::note(&mut begun, file.path());
        (file, path)
    };
    let mut writer = BufWriter::new(file);
    write(&mut writer).map_err(|e| fail(&e))?;
    let file = writer.into_inner().map_err(|e| fail(&e))?;
    file.as_file().sync_all().map_err(|e| fail(&e))?;
    let unbroken = self::begun();
    file.persist(path).map_err(|e| fail(&e.error))?;
    drop(unbroken);
    drop(begun);
    Ok(())
}

/// Writes a text file whole.
///
/// # Errors
/// As [`write_atomic`].
pub fn write_text(path: &Path, text: &str) -> Result<(), RecordingError> {
    write_atomic(path, |file| file.write_all(text.as_bytes()))
}

/// Files and folders being written now: temporary files and folders, and folders that were made and may be empty yet. While the lock is held nothing is begun and
/// nothing put in its place, so that files that belong together are never parted.
static BEGUN: Mutex<BTreeSet<PathBuf>> = Mutex::new(BTreeSet::new());

fn begun() -> MutexGuard<'static, BTreeSet<PathBuf>> {
    // A path too many or too few is sound.
    BEGUN.lock().unwrap_or_else(PoisonError::into_inner)
}

/// A path that is being written until this is dropped.
struct Begun(PathBuf);

impl Begun {
    fn note(begun: &mut BTreeSet<PathBuf>, path: &Path) -> Self {
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

/// A folder within another in which files that belong together are written, to appear together.
pub struct UnfinishedFolder {
    temporary: TempDir,
    target: PathBuf,
    _begun: Begun,
}

impl UnfinishedFolder {
    /// Begins one for files that are to stand in `target`. Dropped unfinished, it leaves nothing.
    ///
    /// # Errors
    /// [`RecordingError::Write`] if `target` cannot be written.
    pub fn within(target: &Path) -> Result<Self, RecordingError> {
        let mut begun = begun();
        let mut builder = Builder::new();
        builder.prefix(UNFINISHED);
        // As of files: it may become a result itself.
        #[cfg(unix)]
        {
            use std::os::unix::fs::PermissionsExt as _;
            builder.permissions(std::fs::Permissions::from_mode(0o777));
        }
        let temporary = builder.tempdir_in(target);
        let temporary = temporary.map_err(|e| RecordingError::write(target, e))?;
        Ok(Self {
            _begun: Begun::note(&mut begun, temporary.path()),
            temporary,
            target: target.to_owned(),
        })
    }

    /// Where to write.
    #[must_use]
    pub fn path(&self) -> &Path {
        self.temporary.path()
    }

    /// Puts the files of these names where they belong.
    ///
    /// # Errors
    /// [`RecordingError::Write`] with the file that cannot be put there.
    pub fn finish(self, names: &[&str]) -> Result<(), RecordingError> {
        let _unbroken = begun();
        for name in names {
            let target = self.target.join(name);
            std::fs::rename(self.path().join(name), &target)
                .map_err(|e| RecordingError::write(&target, e))?;
        }
        Ok(())
    }
}

impl UnfinishedFolder {
    /// Lets it be the folder of this path, with all that is in it; an empty one may stand there.
    ///
    /// # Errors
    /// [`RecordingError::Write`] if it cannot be put there.
    pub fn become_folder(self, target: &Path) -> Result<(), RecordingError> {
        let _unbroken = begun();
        std::fs::rename(self.path(), target).map_err(|e| RecordingError::write(target, e))
    }
}

fn temporary_file_in(directory: &Path) -> std::io::Result<NamedTempFile> {
    let mut builder = Builder::new();
    builder.prefix(UNFINISHED);
    // Temporary files are private by default; results are for everyone whom the umask allows.
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt as _;
        builder.permissions(std::fs::Permissions::from_mode(0o666));
    }
    builder.tempfile_in(directory)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;

    #[test]
    fn a_failed_write_leaves_the_old_file_and_nothing_else() {
        let directory = tempfile::tempdir().unwrap();
        let path = directory.path().join("summary.json");
        write_text(&path, "old").unwrap();
        let error = write_atomic(&path, |file| {
            file.write_all(b"half").map_err(|e| e.to_string())?;
            Err("the solver gave up".to_owned())
        })
        .unwrap_err()
        .to_string();
        assert!(error.contains("summary.json") && error.contains("the solver gave up"));
        assert_eq!(fs::read_to_string(&path).unwrap(), "old");
        assert_eq!(fs::read_dir(directory.path()).unwrap().count(), 1);
    }

    #[test]
    fn a_write_replaces_the_old_file() {
        let directory = tempfile::tempdir().unwrap();
        let path = directory.path().join("a.txt");
        write_text(&path, "old").unwrap();
        write_text(&path, "new").unwrap();
        assert_eq!(fs::read_to_string(&path).unwrap(), "new");
    }

    #[test]
    fn files_that_belong_together_appear_together() {
        let directory = tempfile::tempdir().unwrap();
        let names = || {
            let entries = fs::read_dir(directory.path()).unwrap();
            let mut names: Vec<_> = entries.map(|e| e.unwrap().file_name()).collect();
            names.sort();
            names
        };
        let unfinished = UnfinishedFolder::within(directory.path()).unwrap();
        write_text(&unfinished.path().join("a"), "").unwrap();
        drop(unfinished);
        assert!(names().is_empty());
        let unfinished = UnfinishedFolder::within(directory.path()).unwrap();
        for name in ["a", "b"] {
            write_text(&unfinished.path().join(name), "").unwrap();
        }
        unfinished.finish(&["a", "b"]).unwrap();
        assert_eq!(names(), ["a", "b"]);
        assert!(UnfinishedFolder::within(&directory.path().join("nowhere")).is_err());
    }

    #[cfg(unix)]
    #[test]
    fn a_result_has_the_permissions_of_an_ordinary_file() {
        use std::os::unix::fs::PermissionsExt as _;
        let directory = tempfile::tempdir().unwrap();
        let (ours, ordinary) = (directory.path().join("a"), directory.path().join("b"));
        write_text(&ours, "").unwrap();
        fs::write(&ordinary, "").unwrap();
        let mode = |path: &Path| fs::metadata(path).unwrap().permissions().mode();
        assert_eq!(mode(&ours), mode(&ordinary));
    }

    #[test]
    fn a_missing_directory_is_named() {
        let directory = tempfile::tempdir().unwrap();
        let path = directory.path().join("nowhere/a.txt");
        let error = write_text(&path, "").unwrap_err().to_string();
        assert!(
            error.starts_with("cannot write ") && error.contains("nowhere"),
            "{error}"
        );
    }
}
