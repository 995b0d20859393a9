//! Who writes where: a folder or a file that one process writes is claimed by it, and what killed processes have left unfinished goes.
//!
//! A claim is a lock of the system's on a file in the folder: it ends with its process, however that ends. Where a file system knows no locks, nothing is claimed and
//! nothing is cleared away.

use std::fs::{File, OpenOptions};
use std::path::{Path, PathBuf};

use super::provenance::SourceFile;
use super::unfinished::{Begun, UNFINISHED, begun, folder_of, is_still_at, lock};

/// The claim on a folder, in it.
const CLAIM: &str = ".unfinished-claim";

/// A folder or a file that this process alone writes, until this is dropped.
#[derive(Debug)]
#[must_use]
pub struct Claim {
    path: PathBuf,
    file: File,
    /// Goes with an interruption.
    #[expect(dead_code, reason = "held until it is dropped")]
    begun: Begun,
}

impl Claim {
    /// Claims a folder that is there; none where another process has it.
    ///
    /// # Errors
    /// It cannot be written.
    pub fn of_folder(folder: &Path) -> std::io::Result<Option<Self>> {
        Self::take(folder.join(CLAIM))
    }

    /// Claims a file, there or not, in a folder that is there; none where another process has it.
    ///
    /// # Errors
    /// The folder cannot be written.
    pub fn of_file(file: &Path) -> std::io::Result<Option<Self>> {
        // A name of any length.
        let name = file.file_name().unwrap_or_default().to_string_lossy();
        let short = SourceFile::holding("", name.as_bytes()).sha256;
        Self::take(folder_of(file).join(format!("{CLAIM}-{}", &short[..16])))
    }

    fn take(path: PathBuf) -> std::io::Result<Option<Self>> {
        let mut begun = begun();
        loop {
            let mut options = OpenOptions::new();
            options.write(true).create(true).truncate(false);
            let file = options.open(&path)?;
            if lock(&file) == Some(false) {
                return Ok(None);
            }
            // The one before may have ended, and taken its file away, since it was opened here.
            if is_still_at(&file, &path) {
                let begun = Begun::note(&mut begun, &path);
                return Ok(Some(Self { path, file, begun }));
            }
        }
    }
}

impl Drop for Claim {
    fn drop(&mut self) {
        // A folder that was put in place as a whole has taken it along.
        if is_still_at(&self.file, &self.path) {
            drop(std::fs::remove_file(&self.path));
        }
    }
}

/// Removes from a folder what killed processes have left unfinished there.
pub fn clear_unfinished(folder: &Path) {
    clear(folder, UNFINISHED);
}

/// Removes what was left beside a folder while its results were put in place. A folder of tasks that had been taken along goes back.
pub fn clear_beside(folder: &Path, along: &[&str]) {
    let Ok(folder) = folder.canonicalize() else {
        return;
    };
    let (Some(parent), Some(name)) = (folder.parent(), folder.file_name()) else {
        return;
    };
    let start = beside(&name.to_string_lossy());
    for left in unfinished(parent, &start) {
        for own in along {
            if !folder.join(own).exists() {
                drop(std::fs::rename(left.join(own), folder.join(own)));
            }
        }
    }
    clear(parent, &start);
}

/// Beginning of the names of folders that are about to take the place of one of this name.
pub(super) fn beside(name: &str) -> String {
    format!("{UNFINISHED}{name}~")
}

fn unfinished(folder: &Path, start: &str) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
    entries
        .filter(|entry| entry.file_name().to_string_lossy().starts_with(start))
        .map(|entry| entry.path())
        .collect()
}

fn clear(folder: &Path, start: &str) {
    for path in unfinished(folder, start) {
        let is_link = path.is_symlink();
        // What is locked is being written; what cannot be opened, or knows no locks, is not known.
        let free = || File::open(&path).is_ok_and(|file| lock(&file) == Some(true));
        if is_link || (path.is_file() || path.is_dir()) && free() {
            drop(std::fs::remove_file(&path).or_else(|_| std::fs::remove_dir_all(&path)));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::atomic::{UnfinishedFolder, write_atomic};
    use super::*;

    fn names(folder: &Path) -> Vec<String> {
        let entries = std::fs::read_dir(folder).unwrap();
        let mut names: Vec<String> = entries
            .map(|entry| entry.unwrap().file_name().to_string_lossy().into_owned())
            .collect();
        names.sort();
        names
    }

    #[test]
    fn a_folder_and_a_file_are_claimed_once_and_free_again() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join(format!("{}.csv", "x".repeat(250)));
        let one = Claim::of_folder(folder.path()).unwrap().unwrap();
        let two = Claim::of_file(&file).unwrap().unwrap();
        assert!(Claim::of_folder(folder.path()).unwrap().is_none());
        assert!(Claim::of_file(&file).unwrap().is_none());
        let other = Claim::of_file(&folder.path().join("y.csv")).unwrap();
        assert!(other.is_some());
        drop((one, two, other));
        assert!(names(folder.path()).is_empty());
        drop(Claim::of_folder(folder.path()).unwrap().unwrap());
    }

    #[test]
    fn what_is_left_goes_and_what_is_being_written_stays() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path();
        std::fs::write(path.join(".unfinished-dead"), "x").unwrap();
        std::fs::create_dir_all(path.join(".unfinished-deaf/deep")).unwrap();
        std::fs::write(path.join("result"), "x").unwrap();
        let _claim = Claim::of_folder(path).unwrap().unwrap();
        let living = UnfinishedFolder::within(path).unwrap();
        let written = write_atomic(&path.join("new"), |_| {
            clear_unfinished(path);
            // The claim, the folder and this file.
            assert_eq!(names(path).len(), 4, "{:?}", names(path));
            Ok::<_, String>(())
        });
        written.unwrap();
        assert!(living.path().is_dir() && !path.join(".unfinished-deaf").exists());
    }

    #[test]
    fn a_folder_of_tasks_that_was_on_its_way_comes_back() {
        let room = tempfile::tempdir().unwrap();
        let [folder, left] = ["out", ".unfinished-out~ab"].map(|name| room.path().join(name));
        std::fs::create_dir_all(&folder).unwrap();
        std::fs::create_dir_all(left.join("tasks/one")).unwrap();
        std::fs::create_dir_all(room.path().join(".unfinished-other~ab")).unwrap();
        clear_beside(&folder, &["tasks"]);
        assert!(folder.join("tasks/one").is_dir() && !left.exists());
        assert!(room.path().join(".unfinished-other~ab").is_dir());
    }
}
