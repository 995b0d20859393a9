//! A plan: a head, then a task a line.

use std::collections::{BTreeMap, BTreeSet};
use std::fs::File;
use std::io::{BufRead, BufReader, Write};
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::TaskError;
use crate::recording::RecordingError;
use crate::recording::atomic::write_atomic;
use crate::recording::provenance::{Provenance, SourceFile};

/// What all tasks share.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Head {
    /// What the tasks are: `vary` or `fleet`.
    pub plan: String,
    /// The program and the libraries that decide about numbers.
    pub program: String,
    /// Number of tasks.
    pub tasks: usize,
    /// What the command that made it needs to do a task.
    pub work: Value,
    /// Files that every task reads, from the plan's folder or from the root.
    pub files: Vec<SourceFile>,
}

/// A task.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Task {
    /// Its name: the hash (SHA-256) of all that its result depends on.
    pub id: String,
    /// The task whose result it begins with.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub after: Option<String>,
    /// What it does.
    pub work: Value,
    /// Files that it alone reads, besides those of the head.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub files: Vec<SourceFile>,
}

/// A plan that is being read.
#[derive(Debug)]
pub struct Plan {
    path: PathBuf,
    /// What all tasks share.
    pub head: Head,
    lines: BufReader<File>,
    line: usize,
}

/// What an earlier plan was made of: its program, and files with their hashes.
#[derive(Debug, Default)]
pub struct Made {
    program: String,
    files: BTreeMap<String, String>,
}

impl Made {
    /// That of a plan, as far as it can be read; none where there is none.
    #[must_use]
    pub fn of(plan: &Path) -> Option<Self> {
        let lines = BufReader::new(crate::file::open(plan).ok()?).lines();
        let mut lines = lines.map_while(Result::ok);
        let head: Head = serde_json::from_str(&lines.next()?).ok()?;
        let own = lines.filter_map(|line| Some(serde_json::from_str::<Task>(&line).ok()?.files));
        let files = own.flatten().chain(head.files);
        Some(Self {
            files: files.map(|file| (file.file, file.sha256)).collect(),
            program: head.program,
        })
    }

    /// What a plan of now has otherwise, in words; none where that is nothing.
    #[must_use]
    pub fn changed(&self, now: &Self) -> Option<String> {
        /// Names that are shown.
        const SHOWN: usize = 3;
        if self.program != now.program {
            return Some(format!("the program changed (it was {})", self.program));
        }
        let other = |(file, hash): &(&String, &String)| {
            self.files.get(*file).is_some_and(|old| old != *hash)
        };
        let names = now
            .files
            .iter()
            .filter(other)
            .map(|(file, _)| file.as_str());
        let names: Vec<&str> = names.collect();
        let shown = names
            .iter()
            .take(SHOWN)
            .copied()
            .collect::<Vec<_>>()
            .join(", ");
        match names.len() {
            0 => None,
            1..=SHOWN => Some(format!("{shown} changed")),
            count => Some(format!("{shown} and {} others changed", count - SHOWN)),
        }
    }
}

/// A name made of parts, none of which can be taken for two.
#[must_use]
pub fn name_of<'a>(parts: impl IntoIterator<Item = &'a str>) -> String {
    let mut bytes = Vec::new();
    for part in parts {
        bytes.extend((part.len() as u64).to_le_bytes());
        bytes.extend(part.as_bytes());
    }
    SourceFile::holding("", &bytes).sha256
}

impl Head {
    /// The program as it stands in heads and names.
    #[must_use]
    pub fn this_program() -> String {
        Provenance::this_program()
    }
}

impl Plan {
    /// Writes a plan, its tasks one at a time.
    ///
    /// # Errors
    /// The file cannot be written, or a task cannot be made; no plan is left then.
    pub fn write<E: From<TaskError>>(
        path: &Path,
        head: &Head,
        tasks: impl IntoIterator<Item = Result<Task, E>>,
    ) -> Result<(), E> {
        let mut fault = None;
        let written = write_atomic(path, |file| -> std::io::Result<()> {
            serde_json::to_writer(&mut *file, head)?;
            file.write_all(b"\n")?;
            for task in tasks {
                match task {
                    Ok(task) => serde_json::to_writer(&mut *file, &task)?,
                    Err(error) => {
                        fault = Some(error);
                        return Err(std::io::Error::other("not planned"));
                    }
                }
                file.write_all(b"\n")?;
            }
            Ok(())
        });
        match fault {
            Some(error) => Err(error),
            None => written.map_err(|error| TaskError::from(error).into()),
        }
    }

    /// Opens one; its tasks follow as they are asked for.
    ///
    /// # Errors
    /// It cannot be read, is no plan, or is one of another version.
    pub fn open(path: &Path) -> Result<Self, TaskError> {
        let file = crate::file::open(path).map_err(|e| RecordingError::read(path, e))?;
        let mut lines = BufReader::new(file);
        let mut text = String::new();
        (lines.read_line(&mut text)).map_err(|e| RecordingError::read(path, e))?;
        let head: Head = serde_json::from_str(&text).map_err(|e| TaskError::NoPlan {
            file: path.display().to_string(),
            line: 1,
            reason: e.to_string(),
        })?;
        let this = Head::this_program();
        if head.program != this {
            return Err(TaskError::OtherVersion {
                file: path.display().to_string(),
                made: head.program,
                this,
            });
        }
        Ok(Self {
            path: path.to_owned(),
            head,
            lines,
            line: 1,
        })
    }

    /// Its file.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Its folder.
    #[must_use]
    pub fn folder(&self) -> &Path {
        self.path.parent().unwrap_or(Path::new(""))
    }

    /// The tasks of these names, in the plan's order. Lines of others are passed over unread.
    ///
    /// # Errors
    /// One is not there, or the plan cannot be read.
    pub fn tasks(mut self, ids: &[&str]) -> Result<Vec<Task>, TaskError> {
        let mut missing: BTreeSet<&str> = ids.iter().copied().collect();
        let (mut tasks, mut text) = (Vec::new(), String::new());
        while let Some(id) = missing.first() {
            text.clear();
            self.line += 1;
            let read = self.lines.read_line(&mut text);
            if read.map_err(|e| RecordingError::read(&self.path, e))? == 0 {
                return Err(TaskError::NoTask {
                    file: self.path.display().to_string(),
                    id: (*id).to_owned(),
                });
            }
            let name = text.strip_prefix("{\"id\":\"");
            let name = name.and_then(|rest| rest.split('"').next());
            if name.is_some_and(|name| missing.remove(name)) {
                tasks.push(self.parsed(&text)?);
            }
        }
        Ok(tasks)
    }

    /// Sees whether the files of the head, and of tasks, are what they were when they were named.
    ///
    /// # Errors
    /// One has changed, or is gone.
    pub fn check<'a>(
        &'a self,
        others: impl IntoIterator<Item = &'a SourceFile>,
    ) -> Result<(), TaskError> {
        for file in self.head.files.iter().chain(others) {
            let path = self.folder().join(&file.file);
            let bytes = crate::file::read(&path).map_err(|e| RecordingError::read(&path, e))?;
            if SourceFile::holding("", &bytes).sha256 != file.sha256 {
                return Err(TaskError::Changed {
                    file: path.display().to_string(),
                    plan: self.path.display().to_string(),
                });
            }
        }
        Ok(())
    }

    fn parsed(&self, text: &str) -> Result<Task, TaskError> {
        serde_json::from_str(text).map_err(|e| TaskError::NoPlan {
            file: self.path.display().to_string(),
            line: self.line,
            reason: e.to_string(),
        })
    }
}

impl Iterator for Plan {
    type Item = Result<Task, TaskError>;

    fn next(&mut self) -> Option<Self::Item> {
        let mut text = String::new();
        self.line += 1;
        match self.lines.read_line(&mut text) {
            Ok(0) => None,
            Ok(_) => Some(self.parsed(&text)),
            Err(error) => Some(Err(RecordingError::read(&self.path, error).into())),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn head(tasks: usize) -> Head {
        Head {
            plan: "vary".to_owned(),
            program: Head::this_program(),
            tasks,
            work: Value::Null,
            files: Vec::new(),
        }
    }

    fn task(id: &str) -> Task {
        Task {
            id: id.to_owned(),
            after: None,
            work: serde_json::json!({ "n": id }),
            files: Vec::new(),
        }
    }

    #[test]
    fn a_plan_reads_back_and_a_task_is_found_by_its_name() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("plan.jsonl");
        let tasks = ["aa", "bb", "cc"].map(task);
        let given = tasks.clone().map(Ok::<_, TaskError>);
        Plan::write(&path, &head(3), given).unwrap();
        let read: Result<Vec<Task>, _> = Plan::open(&path).unwrap().collect();
        assert_eq!(read.unwrap(), tasks);
        let found = |ids: &[&str]| Plan::open(&path).unwrap().tasks(ids);
        assert_eq!(found(&["bb"]).unwrap(), tasks[1..2]);
        assert_eq!(
            found(&["cc", "aa"]).unwrap(),
            [tasks[0].clone(), tasks[2].clone()]
        );
        assert_eq!(found(&[]).unwrap(), []);
        for none in [&["b"][..], &["aa", "b"]] {
            let none = found(none).unwrap_err().to_string();
            assert!(none.contains("has no task b"), "{none}");
        }
    }

    #[test]
    fn a_plan_of_another_version_or_of_none_is_refused() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("plan.jsonl");
        let mut other = head(0);
        other.program = "idc 0.0.1".to_owned();
        Plan::write::<TaskError>(&path, &other, []).unwrap();
        let refused = Plan::open(&path).unwrap_err().to_string();
        assert!(refused.contains("was made by idc 0.0.1"), "{refused}");
        std::fs::write(&path, "[1]\n").unwrap();
        let refused = Plan::open(&path).unwrap_err().to_string();
        assert!(refused.contains("plan.jsonl:1"), "{refused}");
    }

    #[test]
    fn names_of_other_parts_are_other_names() {
        let names = [
            name_of(["ab", "c"]),
            name_of(["a", "bc"]),
            name_of(["abc"]),
            name_of(["ab", "c", ""]),
        ];
        for (place, one) in names.iter().enumerate() {
            assert!(!names[place + 1..].contains(one));
        }
        assert_eq!(names[0], name_of(["ab", "c"]));
    }
}
