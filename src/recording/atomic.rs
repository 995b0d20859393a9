//! Files that appear whole or not at all.
//!
//! The content goes to a temporary file in the target's directory, which is renamed onto the
//! target once everything is on disk. A run that is refused half-way, or interrupted, leaves the old file
//! or none, and nothing unfinished beside it. What a killed process has left goes with the next one that writes there: a temporary file or folder is locked
//! as long as its process lives.

use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};

use tempfile::{Builder, NamedTempFile};

use super::RecordingError;
use super::placing::{Placing, put_back_or_keep};
use super::unfinished::{Begun, UNFINISHED, begun, folder_of, is_still_at, lock, without_place};

pub use super::unfinished::{abandon, make_folder};

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
    let (file, begun) = prepared(path, write)?;
    let unbroken = self::begun();
    file.persist(path).map_err(|e| fail(&e.error))?;
    drop(unbroken);
    drop(begun);
    Ok(())
}

/// A temporary file with all that belongs into `path`, on disk.
fn prepared<E: std::fmt::Display>(
    path: &Path,
    write: impl FnOnce(&mut UnfinishedFile) -> Result<(), E>,
) -> Result<(NamedTempFile, Begun), RecordingError> {
    let fail = |cause: &dyn std::fmt::Display| RecordingError::write(path, without_place(cause));
    let (file, begun) = {
        let mut begun = begun();
        let file = temporary_file_in(folder_of(path)).map_err(|e| fail(&e))?;
        let path = Begun::note(&mut begun, file.path());
        (file, path)
    };
    let mut writer = BufWriter::new(file);
    write(&mut writer).map_err(|e| fail(&e))?;
    let file = writer.into_inner().map_err(|e| fail(&e))?;
    file.as_file().sync_all().map_err(|e| fail(&e))?;
    Ok((file, begun))
}

/// Writes several files, each whole: all are on disk before the first is put in its place, and where one cannot be, those before it go back.
///
/// # Errors
/// [`RecordingError::Write`] with the file and the cause.
pub fn write_all<P: AsRef<Path>, C: AsRef<[u8]>>(files: &[(P, C)]) -> Result<(), RecordingError> {
    let mut ready = Vec::new();
    for (path, content) in files {
        let path = path.as_ref();
        let (file, begun) = prepared(path, |file| file.write_all(content.as_ref()))?;
        ready.push((file, begun, path));
    }
    let _unbroken = begun();
    let moves = ready
        .iter()
        .map(|(from, _, to)| (from.path().to_owned(), (*to).to_owned()));
    put_back_or_keep(&moves.collect::<Vec<_>>(), &[], false)
}

/// Writes a text file whole.
///
/// # Errors
/// As [`write_atomic`].
pub fn write_text(path: &Path, text: &str) -> Result<(), RecordingError> {
    write_atomic(path, |file| file.write_all(text.as_bytes()))
}

/// A folder within another in which files that belong together are written, to appear together.
pub struct UnfinishedFolder {
    place: PathBuf,
    target: PathBuf,
    begun: Vec<Begun>,
    /// Locked as long as this lives.
    _alive: Option<File>,
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
        loop {
            let made = builder.tempdir_in(target);
            let fail = |e| RecordingError::write(target, without_place(&e));
            let place = made.map_err(fail)?.keep();
            // A folder cannot be opened everywhere.
            let alive = File::open(&place)
                .ok()
                .filter(|folder| lock(folder) == Some(true));
            if alive
                .as_ref()
                .is_some_and(|folder| !is_still_at(folder, &place))
            {
                // Another process took it for one that nobody has.
                continue;
            }
            return Ok(Self {
                begun: vec![Begun::note(&mut begun, &place)],
                place,
                target: target.to_owned(),
                _alive: alive,
            });
        }
    }

    /// Where to write.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.place
    }

    /// Puts the files of these names where they belong, the last one last, and takes away those of a result before that it does not have (`gone`): all of it, or
    /// nothing. Folders of the names `along` stay with the files.
    ///
    /// # Errors
    /// [`RecordingError::Write`] with the file that cannot be put there; what stood stands.
    pub fn finish(
        mut self,
        names: &[&str],
        gone: &[&str],
        along: &[&str],
    ) -> Result<(), RecordingError> {
        let mut unbroken = begun();
        let placing = Placing {
            place: &self.place,
            target: &self.target,
            names,
            gone,
            along,
        };
        let mut note = |path: &Path| self.begun.push(Begun::note(&mut unbroken, path));
        if let Some(place) = placing.finish(&mut note)? {
            self.place = place;
        }
        // Dropping takes the lock.
        drop(unbroken);
        Ok(())
    }

    /// Lets it be the folder of this path, with all that is in it; an empty one may stand there.
    ///
    /// # Errors
    /// [`RecordingError::Write`] if it cannot be put there.
    pub fn become_folder(self, target: &Path) -> Result<(), RecordingError> {
        let _unbroken = begun();
        std::fs::rename(self.path(), target).map_err(|e| RecordingError::write(target, e))
    }
}

impl Drop for UnfinishedFolder {
    fn drop(&mut self) {
        // What stays goes with the next process that writes there.
        drop(std::fs::remove_dir_all(&self.place));
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
    loop {
        let file = builder.tempfile_in(directory)?;
        lock(file.as_file());
        if is_still_at(file.as_file(), file.path()) {
            return Ok(file);
        }
    }
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
        unfinished.finish(&["a", "b"], &[], &[]).unwrap();
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
