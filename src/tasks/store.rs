//! Folders of tasks that are done, each renamed to its task's name once it is whole.

use std::path::{Path, PathBuf};

use serde::de::DeserializeOwned;

use crate::recording::RecordingError;
use crate::recording::atomic::{UnfinishedFolder, make_folder, write_text};

/// Its result, in a task's folder.
pub const RESULT: &str = "result.json";

/// Folder of the folders.
#[derive(Debug, Clone)]
pub struct Store {
    path: PathBuf,
}

impl Store {
    /// The store beside a plan.
    #[must_use]
    pub fn of(plan: &Path) -> Self {
        Self {
            path: plan.parent().unwrap_or(Path::new("")).join("tasks"),
        }
    }

    /// Its path.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Makes it.
    ///
    /// # Errors
    /// It cannot be made.
    pub fn make(&self) -> Result<(), RecordingError> {
        make_folder(&self.path).map_err(|e| RecordingError::write(&self.path, e))
    }

    /// Removes all that is in it.
    ///
    /// # Errors
    /// Something cannot be removed.
    pub fn clear(&self) -> Result<(), RecordingError> {
        match std::fs::remove_dir_all(&self.path) {
            Err(error) if error.kind() != std::io::ErrorKind::NotFound => {
                Err(RecordingError::write(&self.path, error))
            }
            _ => Ok(()),
        }
    }

    /// Folder of a task.
    #[must_use]
    pub fn folder(&self, id: &str) -> PathBuf {
        self.path.join(id)
    }

    /// Whether a task is done.
    #[must_use]
    pub fn exists(&self, id: &str) -> bool {
        self.folder(id).join(RESULT).is_file()
    }

    /// A task's result.
    ///
    /// # Errors
    /// There is none, or it cannot be read.
    pub fn read<T: DeserializeOwned>(&self, id: &str) -> Result<T, RecordingError> {
        let path = self.folder(id).join(RESULT);
        let text = crate::file::read(&path).map_err(|e| RecordingError::read(&path, e))?;
        serde_json::from_slice(&text).map_err(|e| RecordingError::read(&path, e))
    }

    /// Puts what a task came to in its place: other files first, by name, then its result.
    ///
    /// # Errors
    /// The disk's.
    pub fn put(
        &self,
        id: &str,
        others: &[(String, String)],
        result: &str,
    ) -> Result<(), RecordingError> {
        let unfinished = UnfinishedFolder::within(&self.path)?;
        for (name, text) in others {
            write_text(&unfinished.path().join(name), text)?;
        }
        write_text(&unfinished.path().join(RESULT), result)?;
        let target = self.folder(id);
        match unfinished.become_folder(&target) {
            // Another was quicker, with the same.
            Err(_) if self.exists(id) => Ok(()),
            done => done,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_task_s_folder_is_whole_or_absent_and_the_first_one_stays() {
        let folder = tempfile::tempdir().unwrap();
        let store = Store::of(&folder.path().join("plan.jsonl"));
        store.make().unwrap();
        assert!(!store.exists("a"));
        // As Snakemake leaves it before it begins.
        std::fs::create_dir(store.folder("a")).unwrap();
        let others = [("model.toml".to_owned(), "x = 1".to_owned())];
        store.put("a", &others, "{\"code\":0}").unwrap();
        assert!(store.exists("a") && store.folder("a").join("model.toml").is_file());
        store.put("a", &[], "{\"code\":1}").unwrap();
        let read: serde_json::Value = store.read("a").unwrap();
        assert_eq!(read["code"], 0);
        let left = std::fs::read_dir(store.path()).unwrap().count();
        assert_eq!(left, 1);
        store.clear().unwrap();
        assert!(!store.exists("a"));
    }
}
