//! Folders of tasks that are done, each renamed to its task's name once it is whole.

use std::path::{Path, PathBuf};

use serde::de::DeserializeOwned;

use super::TaskError;
use super::plan::Plan;
use crate::recording::RecordingError;
use crate::recording::atomic::{UnfinishedFolder, make_folder, write_text};
use crate::recording::claim::clear_unfinished;
use crate::recording::provenance::SourceFile;
use crate::recording::seal::{SealError, read_sealed, sealed};

/// Folder of the folders, beside the plan.
pub const TASKS: &str = "tasks";
/// Its result, in a task's folder.
pub const RESULT: &str = "result.json";

/// A result that was taken away, as it is not what was written.
#[derive(Debug, Clone, PartialEq)]
pub struct Unfit {
    /// Its task's name.
    pub id: String,
    /// What is wrong with it.
    pub why: String,
}

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
            path: plan.parent().unwrap_or(Path::new("")).join(TASKS),
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
    /// There is none, or it is not what was written.
    pub fn read<T: DeserializeOwned>(&self, id: &str) -> Result<T, RecordingError> {
        let path = self.folder(id).join(RESULT);
        let text = read_sealed(&path, id).map_err(|e| RecordingError::read(&path, e))?;
        serde_json::from_str(&text).map_err(|e| RecordingError::read(&path, e))
    }

    /// Takes away what stands in the place of a task's result and is none: cut off, edited, of another task, by another program, or without its files. Says
    /// what was wrong; none where the result is sound, or not there.
    ///
    /// # Errors
    /// It cannot be taken away.
    pub fn take_unfit(&self, id: &str) -> Result<Option<Unfit>, RecordingError> {
        let folder = self.folder(id);
        let why = match read_sealed(&folder.join(RESULT), id) {
            Ok(_) => return Ok(None),
            // An engine makes the folder before the task begins.
            Err(SealError::Absent) if is_empty(&folder) => return Ok(None),
            Err(why) => why.to_string(),
        };
        let removed = match folder.is_symlink() || !folder.is_dir() {
            true => std::fs::remove_file(&folder),
            false => std::fs::remove_dir_all(&folder),
        };
        removed.map_err(|e| RecordingError::write(&folder, e))?;
        let id = id.to_owned();
        Ok(Some(Unfit { id, why }))
    }

    /// The same of all tasks of a plan, and of what killed processes have left unfinished.
    ///
    /// # Errors
    /// The plan's, or something cannot be taken away.
    pub fn vet(&self, plan: Plan) -> Result<Vec<Unfit>, TaskError> {
        clear_unfinished(&self.path);
        let mut found = Vec::new();
        for task in plan {
            found.extend(self.take_unfit(&task?.id)?);
        }
        Ok(found)
    }

    /// Number of a plan's tasks that are not done.
    ///
    /// # Errors
    /// The plan's.
    pub fn missing(&self, plan: Plan) -> Result<usize, TaskError> {
        let mut missing = 0;
        for task in plan {
            missing += usize::from(!self.exists(&task?.id));
        }
        Ok(missing)
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
        let hash = |(name, text): &(String, String)| {
            (
                name.clone(),
                SourceFile::holding("", text.as_bytes()).sha256,
            )
        };
        let files = others.iter().map(hash).collect();
        let text = sealed(result, id, files);
        write_text(&unfinished.path().join(RESULT), &text)?;
        let target = self.folder(id);
        match unfinished.become_folder(&target) {
            // Another was quicker, with the same.
            Err(_) if read_sealed(&target.join(RESULT), id).is_ok() => Ok(()),
            done => done,
        }
    }
}

/// Whether nothing stands at a path, or an empty folder.
fn is_empty(folder: &Path) -> bool {
    match std::fs::read_dir(folder) {
        Ok(mut entries) => entries.next().is_none(),
        Err(_) => !folder.exists() && !folder.is_symlink(),
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

    #[test]
    fn a_result_that_is_not_what_was_written_is_taken_away_and_a_sound_one_stays() {
        let folder = tempfile::tempdir().unwrap();
        let store = Store::of(&folder.path().join("plan.jsonl"));
        store.make().unwrap();
        let put = |id: &str| {
            let others = [("model.toml".to_owned(), "x = 1".to_owned())];
            store
                .put(id, &others, "{\"code\":0,\"metrics\":[1.5]}")
                .unwrap();
        };
        let [result, model] = [RESULT, "model.toml"].map(|name| store.folder("a").join(name));
        let damages: [(&str, &dyn Fn()); 7] = [
            ("cut off", &|| {
                let text = std::fs::read(&result).unwrap();
                std::fs::write(&result, &text[..text.len() / 2]).unwrap();
            }),
            ("a digit", &|| {
                let text = std::fs::read_to_string(&result).unwrap();
                std::fs::write(&result, text.replace("1.5", "1.6")).unwrap();
            }),
            ("of another task", &|| {
                put("b");
                std::fs::copy(store.folder("b").join(RESULT), &result).unwrap();
            }),
            ("without a seal", &|| {
                std::fs::write(&result, "{\"code\":0,\"metrics\":[]}").unwrap();
            }),
            ("without its file", &|| {
                std::fs::remove_file(&model).unwrap();
            }),
            ("without a result", &|| {
                std::fs::remove_file(&result).unwrap();
            }),
            ("a file in its place", &|| {
                std::fs::remove_dir_all(store.folder("a")).unwrap();
                std::fs::write(store.folder("a"), "x").unwrap();
            }),
        ];
        for (name, damage) in damages {
            put("a");
            assert_eq!(store.take_unfit("a").unwrap(), None, "{name}");
            damage();
            assert!(store.take_unfit("a").unwrap().is_some(), "{name}");
            assert!(!store.folder("a").exists(), "{name}");
            assert_eq!(store.take_unfit("a").unwrap(), None, "{name}");
        }
    }
}
