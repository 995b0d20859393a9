//! Files that belong together put in their places: all of them, or none.
//!
//! Where the target holds nothing else, the folder in which they were written takes its place in one step of the file system's, so that not even a process that is
//! killed leaves a mixture. Elsewhere they go one by one, and where one cannot be put, those before it go back.

use std::fs;
use std::io::{Error, ErrorKind};
use std::path::{Path, PathBuf};

use super::RecordingError;
use super::claim::beside;
use super::unfinished::{UNFINISHED, folder_of};

/// Files that are to be put in their places.
pub(super) struct Placing<'a> {
    /// Folder in which they stand, in the target.
    pub place: &'a Path,
    /// Folder that they are for.
    pub target: &'a Path,
    /// Their names, the last of which says that the others stand.
    pub names: &'a [&'a str],
    /// Names of files that are not to stand any more.
    pub gone: &'a [&'a str],
    /// Names of folders that stay with the files.
    pub along: &'a [&'a str],
}

/// What else stands in the target, and is to stay.
#[derive(Default)]
struct Others {
    files: Vec<PathBuf>,
    folders: Vec<PathBuf>,
}

impl Placing<'_> {
    /// Puts them there. Where the folder has moved, as to be removed, its new path; `note` gets it before.
    pub(super) fn finish(
        &self,
        note: &mut dyn FnMut(&Path),
    ) -> Result<Option<PathBuf>, RecordingError> {
        let fail = |e: Error| RecordingError::write(self.target, e);
        let alone =
            self.names.len() == 1 && !self.gone.iter().any(|n| self.target.join(n).exists());
        if !alone && let Some(place) = self.as_a_whole(note).map_err(fail)? {
            return Ok(Some(place));
        }
        let pair = |name: &&str| (self.place.join(name), self.target.join(name));
        let moves: Vec<_> = self.names.iter().map(pair).collect();
        for (_, to) in &moves {
            fs::create_dir_all(folder_of(to)).map_err(|e| RecordingError::write(to, e))?;
        }
        let gone: Vec<_> = self
            .gone
            .iter()
            .map(|name| self.target.join(name))
            .collect();
        put_back_or_keep(&moves, &gone, true).map(|()| None)
    }

    /// Lets the folder take the target's place, with what else stands there; none where that is not possible, and nothing is changed.
    fn as_a_whole(&self, note: &mut dyn FnMut(&Path)) -> Result<Option<PathBuf>, Error> {
        let target = self.target.canonicalize()?;
        let (Some(parent), Some(name)) = (target.parent(), target.file_name()) else {
            return Ok(None);
        };
        // A shell that stands in it would stand in one that is gone.
        if std::env::current_dir().is_ok_and(|here| here.starts_with(&target)) {
            return Ok(None);
        }
        if !has_same_owner(&target, self.place)? {
            return Ok(None);
        }
        let Some(others) = self.others(&target)? else {
            return Ok(None);
        };
        let own = self.place.file_name().unwrap_or_default().to_string_lossy();
        let own = own.trim_start_matches(UNFINISHED);
        let moved = parent.join(format!("{}{own}", beside(&name.to_string_lossy())));
        note(&moved);
        if !possible(fs::rename(self.place, &moved))? {
            return Ok(None);
        }
        let swapped = swapped(&moved, &target, &others);
        match swapped {
            Ok(true) => Ok(Some(moved)),
            other => {
                // As it was. What of that fails is in no place where it would pass for a result.
                for folder in &others.folders {
                    drop(fs::rename(moved.join(folder), target.join(folder)));
                }
                for file in &others.files {
                    drop(fs::remove_file(moved.join(file)));
                }
                fs::rename(&moved, self.place)?;
                other.map(|_| None)
            }
        }
    }

    /// What else stands in the target; none where that cannot be taken along.
    fn others(&self, target: &Path) -> Result<Option<Others>, Error> {
        let mut others = Others::default();
        let mut folders = vec![PathBuf::new()];
        while let Some(folder) = folders.pop() {
            for entry in fs::read_dir(target.join(&folder))? {
                let entry = entry?;
                let path = folder.join(entry.file_name());
                let text = entry.file_name().to_string_lossy().into_owned();
                let kind = entry.file_type()?;
                let known = |names: &[&str]| names.iter().any(|name| Path::new(name) == path);
                let claimed = format!("{UNFINISHED}claim");
                if entry.path().file_name() == self.place.file_name() || text == claimed {
                    continue;
                }
                if kind.is_dir() && known(self.along) {
                    others.folders.push(path);
                } else if kind.is_dir()
                    && self.names.iter().any(|n| Path::new(n).starts_with(&path))
                {
                    folders.push(path);
                } else if !kind.is_file() || text.starts_with(UNFINISHED) {
                    // Another process's among them.
                    return Ok(None);
                } else if !known(self.names) && !known(self.gone) {
                    others.files.push(path);
                }
            }
        }
        Ok(Some(others))
    }
}

/// Whether one folder can stand for another without changing hands.
#[cfg(unix)]
fn has_same_owner(one: &Path, other: &Path) -> Result<bool, Error> {
    use std::os::unix::fs::MetadataExt as _;
    let [one, other] = [fs::metadata(one)?, fs::metadata(other)?];
    Ok((one.uid(), one.gid()) == (other.uid(), other.gid()))
}

#[cfg(not(unix))]
fn has_same_owner(_one: &Path, _other: &Path) -> Result<bool, Error> {
    Ok(false)
}

/// Takes along what else stands in the target, then swaps the two; whether that is possible here.
fn swapped(folder: &Path, target: &Path, others: &Others) -> Result<bool, Error> {
    fs::set_permissions(folder, fs::metadata(target)?.permissions())?;
    for file in &others.files {
        if !possible(fs::hard_link(target.join(file), folder.join(file)))? {
            return Ok(false);
        }
    }
    for own in &others.folders {
        if !possible(fs::rename(target.join(own), folder.join(own)))? {
            return Ok(false);
        }
    }
    possible(exchange(folder, target))
}

/// Whether it was done; false where it cannot be on this file system, or in this folder.
fn possible(done: Result<(), Error>) -> Result<bool, Error> {
    match done {
        Ok(()) => Ok(true),
        Err(error) => match error.kind() {
            ErrorKind::Unsupported
            | ErrorKind::InvalidInput
            | ErrorKind::PermissionDenied
            | ErrorKind::CrossesDevices
            | ErrorKind::ResourceBusy
            | ErrorKind::TooManyLinks
            | ErrorKind::InvalidFilename => Ok(false),
            _ => Err(error),
        },
    }
}

#[cfg(any(target_os = "linux", target_os = "android", target_vendor = "apple"))]
fn exchange(one: &Path, other: &Path) -> Result<(), Error> {
    use rustix::fs::{CWD, RenameFlags, renameat_with};
    Ok(renameat_with(CWD, one, CWD, other, RenameFlags::EXCHANGE)?)
}

#[cfg(not(any(target_os = "linux", target_os = "android", target_vendor = "apple")))]
fn exchange(_one: &Path, _other: &Path) -> Result<(), Error> {
    Err(ErrorKind::Unsupported.into())
}

/// Puts files in their places, each from the first path to the second, and takes others away. Where one cannot be, what stood there comes back. With `marked` the
/// last one says that the others stand: its old one goes first.
pub(super) fn put_back_or_keep(
    moves: &[(PathBuf, PathBuf)],
    gone: &[PathBuf],
    marked: bool,
) -> Result<(), RecordingError> {
    let targets = || moves.iter().map(|(_, to)| to).chain(gone);
    // A rename alone is whole by itself.
    let only = moves.len() == 1 && !gone.iter().any(|path| path.exists());
    let mut kept: Vec<(PathBuf, PathBuf)> = Vec::new();
    let mut done = || -> Result<(), (PathBuf, Error)> {
        for path in targets().filter(|path| !only && path.exists()) {
            let name = format!("{UNFINISHED}{}-{}", std::process::id(), kept.len());
            let copy = folder_of(path).join(name);
            if possible(fs::hard_link(path, &copy)).map_err(|e| (path.clone(), e))? {
                kept.push((copy, path.clone()));
            }
        }
        let mark = moves
            .last()
            .filter(|(_, to)| marked && !only && to.exists());
        for path in mark.map(|(_, to)| to).into_iter().chain(gone) {
            match fs::remove_file(path) {
                Err(e) if e.kind() != ErrorKind::NotFound => return Err((path.clone(), e)),
                _ => (),
            }
        }
        for (from, to) in moves {
            fs::rename(from, to).map_err(|e| (to.clone(), e))?;
        }
        Ok(())
    };
    let result = done();
    if result.is_err() && !only {
        for (from, to) in moves {
            // It was put there, and nothing stood there before.
            if !from.exists() && !kept.iter().any(|(_, old)| old == to) {
                drop(fs::remove_file(to));
            }
        }
    }
    for (copy, path) in &kept {
        if result.is_err() {
            drop(fs::rename(copy, path));
        }
        // Also where both are one file, which a rename leaves alone.
        drop(fs::remove_file(copy));
    }
    result.map_err(|(path, error)| RecordingError::write(&path, error))
}

#[cfg(test)]
mod tests {
    use super::super::atomic::{UnfinishedFolder, write_all, write_text};
    use super::*;
    use std::collections::BTreeMap;

    fn content(folder: &Path) -> BTreeMap<String, String> {
        let entries = fs::read_dir(folder).unwrap().map(Result::unwrap);
        let file = |entry: fs::DirEntry| {
            let name = entry.file_name().to_string_lossy().into_owned();
            let text = fs::read_to_string(entry.path()).unwrap_or_default();
            (name, text)
        };
        entries.map(file).collect()
    }

    /// A folder with an old result of three files, a file and a folder of somebody's own, and a new result that is written and not in its place.
    fn begun(room: &Path) -> (PathBuf, UnfinishedFolder) {
        let target = room.join("out");
        fs::create_dir_all(target.join("tasks/one")).unwrap();
        for (name, text) in [
            ("a", "old"),
            ("b", "old"),
            ("mark", "old"),
            ("notes", "mine"),
        ] {
            fs::write(target.join(name), text).unwrap();
        }
        let unfinished = UnfinishedFolder::within(&target).unwrap();
        for name in ["a", "mark"] {
            write_text(&unfinished.path().join(name), "new").unwrap();
        }
        (target, unfinished)
    }

    fn expected(text: &[(&str, &str)]) -> BTreeMap<String, String> {
        let own = |(name, text): &(&str, &str)| ((*name).to_owned(), (*text).to_owned());
        text.iter().map(own).collect()
    }

    const NEW: [(&str, &str); 4] = [
        ("a", "new"),
        ("mark", "new"),
        ("notes", "mine"),
        ("tasks", ""),
    ];

    #[test]
    fn a_result_takes_the_place_of_another_as_a_whole_and_leaves_what_is_not_of_it() {
        let room = tempfile::tempdir().unwrap();
        let (target, unfinished) = begun(room.path());
        unfinished
            .finish(&["a", "mark"], &["b"], &["tasks"])
            .unwrap();
        assert_eq!(content(&target), expected(&NEW));
        assert!(target.join("tasks/one").is_dir());
        assert_eq!(fs::read_dir(room.path()).unwrap().count(), 1);
    }

    #[test]
    fn beside_a_folder_of_somebody_s_own_the_files_go_one_by_one() {
        let room = tempfile::tempdir().unwrap();
        let (target, unfinished) = begun(room.path());
        unfinished.finish(&["a", "mark"], &["b"], &[]).unwrap();
        assert_eq!(content(&target), expected(&NEW));
    }

    #[test]
    fn one_by_one_all_goes_back_where_one_cannot_be_put() {
        let room = tempfile::tempdir().unwrap();
        let (target, unfinished) = begun(room.path());
        let before: Vec<_> = [
            ("a", "old"),
            ("b", "old"),
            ("mark", "old"),
            ("notes", "mine"),
            ("tasks", ""),
        ]
        .into();
        // A file that was never written stands for one that cannot be put.
        let error = unfinished
            .finish(&["a", "new", "mark"], &["b"], &[])
            .unwrap_err();
        assert!(error.to_string().contains("/out/new"), "{error}");
        assert_eq!(content(&target), expected(&before));
    }

    #[test]
    fn several_files_are_written_all_or_none() {
        let room = tempfile::tempdir().unwrap();
        let path = |name: &str| room.path().join(name);
        fs::write(path("a"), "old").unwrap();
        fs::create_dir_all(path("c/in")).unwrap();
        // A folder cannot be replaced.
        let refused = write_all(&[(path("a"), "new"), (path("b"), "new"), (path("c"), "new")]);
        assert!(refused.unwrap_err().to_string().contains("/c"));
        assert_eq!(content(room.path()), expected(&[("a", "old"), ("c", "")]));
        write_all(&[(path("a"), "new"), (path("b"), "new")]).unwrap();
        assert_eq!(
            content(room.path()),
            expected(&[("a", "new"), ("b", "new"), ("c", "")])
        );
    }
}
