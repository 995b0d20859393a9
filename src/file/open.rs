//! Files opened: a pipe would be waited for without end, and a device has none.

use std::fs::{File, FileType, Metadata};
use std::io::{Error, ErrorKind, Read, Result};
use std::path::Path;

use super::limit::{Limit, RAISED_BY, megabytes};

/// Opens a regular file.
///
/// # Errors
/// There is none, it cannot be opened, or it is something else.
pub fn open(path: impl AsRef<Path>) -> Result<File> {
    check(&path)?;
    let file = File::open(&path)?;
    // It may have been replaced.
    refuse_others(file.metadata()?.file_type())?;
    Ok(file)
}

/// Refuses what is no regular file, without opening it.
///
/// # Errors
/// There is none, or it is something else.
pub fn check(path: impl AsRef<Path>) -> Result<Metadata> {
    let about = std::fs::metadata(path)?;
    refuse_others(about.file_type())?;
    Ok(about)
}

/// All bytes of a regular file, up to so many.
///
/// # Errors
/// As [`open`], and of one that is longer.
pub fn read_up_to(path: impl AsRef<Path>, most: u64) -> Result<Vec<u8>> {
    let file = open(path)?;
    let size = file.metadata()?.len();
    if size > most {
        return Err(too_large(size, most));
    }
    let mut bytes = Vec::with_capacity(usize::try_from(size).unwrap_or(0));
    // What a system's own files hold they do not say.
    file.take(most.saturating_add(1)).read_to_end(&mut bytes)?;
    match bytes.len() as u64 {
        found if found > most => Err(too_large(found, most)),
        _ => Ok(bytes),
    }
}

/// All bytes of a file that is held whole.
///
/// # Errors
/// As [`read_up_to`].
pub fn read(path: impl AsRef<Path>) -> Result<Vec<u8>> {
    read_up_to(path, Limit::default().whole())
}

/// The text of a file that is held whole.
///
/// # Errors
/// As [`read_up_to`], and of one that is no UTF-8.
pub fn read_text(path: impl AsRef<Path>) -> Result<String> {
    text(read(path)?)
}

/// The text of a file of settings: a scenario, a map.
///
/// # Errors
/// As [`read_text`].
pub fn read_settings(path: impl AsRef<Path>) -> Result<String> {
    text(read_up_to(path, Limit::default().settings())?)
}

fn text(bytes: Vec<u8>) -> Result<String> {
    String::from_utf8(bytes)
        .map_err(|_| Error::new(ErrorKind::InvalidData, "stream did not contain valid UTF-8"))
}

fn too_large(size: u64, most: u64) -> Error {
    let cause = format!(
        "it has {}, expected {} at most; {RAISED_BY}",
        megabytes(size),
        megabytes(most)
    );
    Error::new(ErrorKind::FileTooLarge, cause)
}

fn refuse_others(kind: FileType) -> Result<()> {
    if kind.is_file() {
        return Ok(());
    }
    if kind.is_dir() {
        return Err(Error::new(
            ErrorKind::IsADirectory,
            "it is a folder, expected a file",
        ));
    }
    let cause = format!(
        "it is {}, expected a regular file: write what it gives to one first",
        name(kind)
    );
    Err(Error::new(ErrorKind::InvalidInput, cause))
}

#[cfg(unix)]
fn name(kind: FileType) -> &'static str {
    use std::os::unix::fs::FileTypeExt;
    if kind.is_fifo() {
        "a pipe"
    } else if kind.is_socket() {
        "a socket"
    } else {
        "a device"
    }
}

#[cfg(not(unix))]
fn name(_: FileType) -> &'static str {
    "a device"
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn regular_files_alone_are_opened() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("a.toml");
        std::fs::write(&file, "a = 1\n").unwrap();
        assert_eq!(read_settings(&file).unwrap(), "a = 1\n");
        let said = read_up_to(&file, 5).unwrap_err().to_string();
        assert!(
            said.contains("at most") && said.contains("--largest-mb"),
            "{said}"
        );
        let said = read(folder.path()).unwrap_err().to_string();
        assert!(said.contains("folder"), "{said}");
        let none = read(folder.path().join("b")).unwrap_err();
        assert_eq!(none.kind(), ErrorKind::NotFound);
    }

    #[cfg(unix)]
    #[test]
    fn a_pipe_is_not_waited_for_and_a_device_is_not_read() {
        let folder = tempfile::tempdir().unwrap();
        let pipe = folder.path().join("pipe");
        let made = std::process::Command::new("mkfifo").arg(&pipe).status();
        assert!(made.unwrap().success());
        let said = open(&pipe).unwrap_err().to_string();
        assert!(said.contains("a pipe"), "{said}");
        let said = read("/dev/zero").unwrap_err().to_string();
        assert!(said.contains("a device"), "{said}");
    }
}
