//! Results that are read back sealed: what they are of, by which program, with which files beside them, and a checksum of it all. One that was cut off, edited, put
//! in the place of another, or made by another program does not fit its seal.

use std::collections::BTreeMap;
use std::io::Read as _;
use std::path::Path;

use serde::{Deserialize, Serialize};

use super::RecordingError;
use super::provenance::{Provenance, SourceFile};

/// Key of the seal, the last of its document.
const KEY: &str = "\"seal\":";
/// Lines that tell the time that the work took: the same work takes another time.
const TIMES: [&str; 3] = ["\"seconds\":", "\"wall_time_s\":", "\"real_time_factor\":"];
/// No result is larger [byte].
const LARGEST: u64 = 1 << 30;

/// What is said of a result.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
struct Seal {
    /// What it is of, as the name of a task.
    of: String,
    /// Program that made it.
    program: String,
    /// Files beside it, by name, with their hashes (SHA-256).
    files: BTreeMap<String, String>,
    /// Hash (SHA-256) of the document up to here, but for lines that tell a time, and of the seal without this.
    sha256: String,
}

/// A result that is not what was written.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum SealError {
    /// There is none.
    #[error("there is none")]
    Absent,
    /// A file that cannot be read as one.
    #[error("{0}")]
    Unreadable(String),
    /// A document without a seal, or one of which a part is not as it was written.
    #[error("it is not as it was written (its checksum differs)")]
    Changed,
    /// A result of something else.
    #[error("it is of something else ({0})")]
    OfAnother(String),
    /// A result of another program.
    #[error("it was made by {0}")]
    OtherProgram(String),
    /// A file beside it.
    #[error("{0} beside it is missing, or not as it was written")]
    Beside(String),
}

/// Hashes (SHA-256) of files of a folder, by their names.
///
/// # Errors
/// One that cannot be read.
pub fn hashes<'a>(
    folder: &Path,
    names: impl IntoIterator<Item = &'a str>,
) -> Result<BTreeMap<String, String>, RecordingError> {
    let hash = |name: &str| {
        let file = SourceFile::of(name, &folder.join(name))?;
        Ok((file.file, file.sha256))
    };
    names.into_iter().map(hash).collect()
}

/// A document (a JSON object) with its seal.
#[must_use]
pub fn sealed(document: &str, of: &str, files: BTreeMap<String, String>) -> String {
    sealed_by(document, of, Provenance::this_program(), files)
}

fn sealed_by(document: &str, of: &str, program: String, files: BTreeMap<String, String>) -> String {
    let end = document.trim_end();
    let after = &document[end.len()..];
    let body = end.strip_suffix('}').unwrap_or(end).trim_end();
    let (before, behind) = match document.starts_with("{\n") {
        true => ("\n  ", "\n"),
        false => ("", ""),
    };
    let comma = if body.ends_with('{') { "" } else { "," };
    let mut seal = Seal {
        of: of.to_owned(),
        program,
        files,
        sha256: String::new(),
    };
    let text = |seal: &Seal| serde_json::to_string(seal).unwrap_or_default();
    let timed = |line: &&str| TIMES.iter().any(|key| line.trim_start().starts_with(key));
    let lines: Vec<&str> = body.split('\n').filter(|line| !timed(line)).collect();
    let hashed = format!("{}{}{after}", lines.join("\n"), text(&seal));
    seal.sha256 = SourceFile::holding("", hashed.as_bytes()).sha256;
    format!("{body}{comma}{before}{KEY}{}{behind}}}{after}", text(&seal))
}

/// A sealed document that is of this, as it was written and by this program; files that it names stand beside it as they were written.
///
/// # Errors
/// What does not fit.
pub fn read_sealed(path: &Path, of: &str) -> Result<String, SealError> {
    let unreadable = |e: std::io::Error| SealError::Unreadable(e.to_string());
    match std::fs::metadata(path) {
        Err(e) if e.kind() == std::io::ErrorKind::NotFound => return Err(SealError::Absent),
        Err(e) => return Err(unreadable(e)),
        Ok(found) if !found.is_file() || found.len() > LARGEST => return Err(SealError::Changed),
        Ok(_) => (),
    }
    let mut text = String::new();
    let file = crate::file::open(path).map_err(unreadable)?;
    match file.take(LARGEST).read_to_string(&mut text) {
        Err(e) if e.kind() == std::io::ErrorKind::InvalidData => return Err(SealError::Changed),
        read => read.map_err(unreadable)?,
    };
    let files = check(&text, of)?;
    let folder = path.parent().unwrap_or(Path::new(""));
    for (name, hash) in &files {
        let beside = folder.join(name);
        let is_same = |file: SourceFile| file.sha256 == *hash;
        if !beside.is_file() || !SourceFile::of(name, &beside).is_ok_and(is_same) {
            return Err(SealError::Beside(name.clone()));
        }
    }
    Ok(text)
}

/// Sees whether a document fits its seal; returns the files beside it.
fn check(text: &str, of: &str) -> Result<BTreeMap<String, String>, SealError> {
    let start = text.rfind(KEY).ok_or(SealError::Changed)?;
    let mut seals = serde_json::Deserializer::from_str(&text[start + KEY.len()..]).into_iter();
    let seal: Seal = match seals.next() {
        Some(Ok(seal)) => seal,
        _ => return Err(SealError::Changed),
    };
    let body = text[..start].trim_end();
    let after = &text[text.trim_end().len()..];
    let document = format!("{}}}{after}", body.strip_suffix(',').unwrap_or(body));
    let again = sealed_by(
        &document,
        &seal.of,
        seal.program.clone(),
        seal.files.clone(),
    );
    if again != text {
        return Err(SealError::Changed);
    }
    if seal.program != Provenance::this_program() {
        return Err(SealError::OtherProgram(seal.program));
    }
    match seal.of == of {
        true => Ok(seal.files),
        false => Err(SealError::OfAnother(seal.of)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn documents() -> [String; 3] {
        let value = serde_json::json!({ "code": 0, "metrics": [1.25, null, 3e-7], "reason": "a \"seal\": b" });
        let pretty = serde_json::to_string_pretty(&value).unwrap();
        [value.to_string(), pretty + "\n", "{}".to_owned()]
    }

    #[test]
    fn a_sealed_document_is_read_back_and_says_the_same() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("result.json");
        std::fs::write(folder.path().join("model.toml"), "x = 1").unwrap();
        for document in documents() {
            let files = hashes(folder.path(), ["model.toml"]).unwrap();
            let text = sealed(&document, "task", files);
            std::fs::write(&path, &text).unwrap();
            assert_eq!(read_sealed(&path, "task").unwrap(), text);
            let [mut read, own]: [serde_json::Value; 2] =
                [&text, &document].map(|text| serde_json::from_str(text).unwrap());
            read.as_object_mut().unwrap().remove("seal");
            assert_eq!(read, own);
        }
    }

    #[test]
    fn each_byte_counts_and_so_does_what_it_is_of() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("result.json");
        let text = sealed(&documents()[1], "task", BTreeMap::new());
        for at in 0..text.len() {
            let mut damaged = text.clone().into_bytes();
            damaged[at] ^= 1;
            std::fs::write(&path, &damaged).unwrap();
            assert!(read_sealed(&path, "task").is_err(), "byte {at}");
            std::fs::write(&path, &text[..at]).unwrap();
            assert!(read_sealed(&path, "task").is_err(), "{at} bytes");
        }
        std::fs::write(&path, &text).unwrap();
        let other = read_sealed(&path, "other").unwrap_err();
        assert_eq!(other, SealError::OfAnother("task".to_owned()));
        let old = sealed_by("{}", "task", "idc 0.1.0".to_owned(), BTreeMap::new());
        std::fs::write(&path, old).unwrap();
        let old = read_sealed(&path, "task").unwrap_err();
        assert_eq!(old, SealError::OtherProgram("idc 0.1.0".to_owned()));
        std::fs::write(&path, &documents()[1]).unwrap();
        assert_eq!(read_sealed(&path, "task"), Err(SealError::Changed));
        std::fs::remove_file(&path).unwrap();
        assert_eq!(read_sealed(&path, "task"), Err(SealError::Absent));
    }

    #[test]
    fn the_time_that_the_work_took_is_no_part_of_it() {
        let text = |seconds: &str| {
            sealed(
                &format!("{{\n  \"seconds\": {seconds},\n  \"n\": 1\n}}\n"),
                "",
                BTreeMap::new(),
            )
        };
        let seal = |text: &str| text[text.rfind(KEY).unwrap()..].to_owned();
        assert_eq!(seal(&text("1.5")), seal(&text("22")));
        check(&text("1.5"), "").unwrap();
    }

    #[test]
    fn a_file_beside_it_is_there_and_as_it_was() {
        let folder = tempfile::tempdir().unwrap();
        let [path, beside] = ["result.json", "a.csv"].map(|name| folder.path().join(name));
        std::fs::write(&beside, "1").unwrap();
        let text = sealed("{}", "", hashes(folder.path(), ["a.csv"]).unwrap());
        std::fs::write(&path, text).unwrap();
        read_sealed(&path, "").unwrap();
        std::fs::write(&beside, "2").unwrap();
        let changed = Err(SealError::Beside("a.csv".to_owned()));
        assert_eq!(read_sealed(&path, ""), changed);
        std::fs::remove_file(&beside).unwrap();
        assert_eq!(read_sealed(&path, ""), changed);
    }
}
