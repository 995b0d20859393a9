//! Files that appear whole or not at all.
//!
//! The content goes to a temporary file in the target's directory, which is renamed onto the
//! target once everything is on disk. A run that is killed or refused half-way leaves the old file
//! or none.

use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};

use tempfile::{Builder, NamedTempFile, TempDir};

use super::RecordingError;

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
    let file = temporary_file_in(directory).map_err(|e| fail(&e))?;
    let mut writer = BufWriter::new(file);
    write(&mut writer).map_err(|e| fail(&e))?;
    let file = writer.into_inner().map_err(|e| fail(&e))?;
    file.as_file().sync_all().map_err(|e| fail(&e))?;
    file.persist(path).map_err(|e| fail(&e.error))?;
    Ok(())
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
    temporary: TempDir,
    target: PathBuf,
}

impl UnfinishedFolder {
    /// Begins one for files that are to stand in `target`. Dropped unfinished, it leaves nothing.
    ///
    /// # Errors
    /// [`RecordingError::Write`] if `target` cannot be written.
    pub fn within(target: &Path) -> Result<Self, RecordingError> {
        let temporary = Builder::new().prefix(".unfinished-").tempdir_in(target);
        Ok(Self {
            temporary: temporary.map_err(|e| RecordingError::write(target, e))?,
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
        for name in names {
            let target = self.target.join(name);
            std::fs::rename(self.path().join(name), &target)
                .map_err(|e| RecordingError::write(&target, e))?;
        }
        Ok(())
    }
}

fn temporary_file_in(directory: &Path) -> std::io::Result<NamedTempFile> {
    let mut builder = Builder::new();
    builder.prefix(".unfinished-");
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
