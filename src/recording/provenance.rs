//! Origin of a result: programs by version, files by their hash (SHA-256), seeds.

use std::fmt::Write as _;
use std::path::Path;

use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};

use super::RecordingError;

/// Libraries whose version decides about numbers, as Cargo.toml pins them.
const LIBRARIES: [(&str, &str); 2] = [("rapier3d-f64", "0.36.1"), ("rerun", "0.36.3")];

/// The program with its version.
const PROGRAM: &str = concat!("idc ", env!("CARGO_PKG_VERSION"));

/// Its version, and which build of it this is.
pub const BUILD: &str = concat!(env!("CARGO_PKG_VERSION"), " (", env!("IDC_SOURCES"), ")");

/// Hash of the sources that it was built of, and of the versions of all crates (`build.rs`).
#[cfg(test)]
const SOURCES: &str = env!("IDC_SOURCES");

fn libraries() -> Vec<String> {
    LIBRARIES
        .map(|(name, version)| format!("{name} {version}"))
        .to_vec()
}

/// Where a result comes from.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Provenance {
    /// The program with its version.
    pub program: String,
    /// Libraries with their versions.
    pub libraries: Vec<String>,
    /// Files that were read.
    pub files: Vec<SourceFile>,
    /// Seed of what is drawn at random; none where nothing is.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub seed: Option<u64>,
}

/// A file that was read.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SourceFile {
    /// Its name, as it was called by.
    pub file: String,
    /// Its length [byte].
    pub bytes: u64,
    /// Its hash, hexadecimal.
    pub sha256: String,
}

impl Provenance {
    /// That of a result of this program, of files by their names for people and where they are.
    ///
    /// # Errors
    /// [`RecordingError::Read`] for a file that is gone.
    pub fn of<'a>(
        files: impl IntoIterator<Item = (&'a str, &'a Path)>,
        seed: Option<u64>,
    ) -> Result<Self, RecordingError> {
        let files = files.into_iter().map(|(name, path)| source(name, path));
        Ok(Self {
            program: PROGRAM.to_owned(),
            libraries: libraries(),
            files: files.collect::<Result<_, _>>()?,
            seed,
        })
    }
}

impl Provenance {
    /// This program by its version and its sources, with the libraries that decide about numbers.
    #[must_use]
    pub fn this_program() -> String {
        format!("idc {BUILD} with {}", libraries().join(", "))
    }

    /// What another one has otherwise, in words: what comes of it is another result. None where that is nothing.
    #[must_use]
    pub fn changed(&self, now: &Self) -> Option<String> {
        let same = |one: &SourceFile, other: &SourceFile| one.sha256 == other.sha256;
        let alike = self.files.len() == now.files.len()
            && self
                .files
                .iter()
                .zip(&now.files)
                .all(|(one, other)| same(one, other));
        if alike {
            let is_same = (&self.program, &self.libraries, self.seed)
                == (&now.program, &now.libraries, now.seed);
            return (!is_same).then(|| "the program or the seed has changed".to_owned());
        }
        let known = |file: &&SourceFile| self.files.iter().any(|old| same(old, file));
        let other = now.files.iter().find(|file| !known(file));
        Some(match other {
            Some(file) if self.files.iter().any(|old| old.file == file.file) => {
                format!("{} has changed", file.file)
            }
            Some(file) => format!("{} is new", file.file),
            None => "files have been taken away, or change places".to_owned(),
        })
    }

    /// Its sources, however the files were called and wherever they stood.
    #[must_use]
    pub fn content(&self) -> String {
        let mut content = format!("{} {}", self.program, self.libraries.join(" "));
        for file in &self.files {
            content += &format!(" {}", file.sha256);
        }
        if let Some(seed) = self.seed {
            content += &format!(" seed {seed}");
        }
        content
    }
}

impl SourceFile {
    /// A file of this name that holds these bytes.
    #[must_use]
    pub fn holding(name: &str, bytes: &[u8]) -> Self {
        Self {
            file: name.to_owned(),
            bytes: bytes.len() as u64,
            sha256: hexadecimal(&Sha256::digest(bytes)),
        }
    }
}

fn hexadecimal(hash: &[u8]) -> String {
    let mut text = String::with_capacity(2 * hash.len());
    for byte in hash {
        // Writing into a text cannot fail.
        let _ = write!(text, "{byte:02x}");
    }
    text
}

impl SourceFile {
    /// A file that is there, by its name for people.
    ///
    /// # Errors
    /// [`RecordingError::Read`] if it is gone.
    pub fn of(name: &str, path: &Path) -> Result<Self, RecordingError> {
        source(name, path)
    }
}

fn source(name: &str, path: &Path) -> Result<SourceFile, RecordingError> {
    let fail = |cause: std::io::Error| RecordingError::read(path, cause);
    let mut hash = Sha256::new();
    let mut file = crate::file::open(path).map_err(fail)?;
    let bytes = std::io::copy(&mut file, &mut hash).map_err(fail)?;
    Ok(SourceFile {
        file: name.to_owned(),
        bytes,
        sha256: hexadecimal(&hash.finalize()),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_has_its_published_hash() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("abc");
        std::fs::write(&path, "abc").unwrap();
        let provenance = Provenance::of([("abc", path.as_path())], Some(7)).unwrap();
        // FIPS 180-2, appendix B.1.
        let published = "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad";
        assert_eq!(provenance.files[0].sha256, published);
        assert_eq!(provenance.files[0].bytes, 3);
    }

    #[test]
    fn the_program_is_named_by_its_sources_as_they_stand() {
        // By another route: the files as this test finds them.
        let root = Path::new(env!("CARGO_MANIFEST_DIR"));
        let mut waiting = vec!["src".to_owned()];
        let mut names = vec!["Cargo.lock".to_owned()];
        while let Some(folder) = waiting.pop() {
            for entry in std::fs::read_dir(root.join(&folder)).unwrap() {
                let entry = entry.unwrap();
                let name = format!("{folder}/{}", entry.file_name().to_str().unwrap());
                let list = if entry.path().is_dir() {
                    &mut waiting
                } else {
                    &mut names
                };
                list.push(name);
            }
        }
        names.sort();
        let mut bytes = Vec::new();
        for name in names {
            let content = std::fs::read(root.join(&name)).unwrap();
            for part in [name.as_bytes(), &content] {
                bytes.extend((part.len() as u64).to_le_bytes());
                bytes.extend(part);
            }
        }
        let hash = SourceFile::holding("", &bytes).sha256;
        assert_eq!(SOURCES, &hash[..16]);
        assert!(Provenance::this_program().contains(SOURCES));
    }

    #[test]
    fn content_is_what_is_in_the_files_and_not_their_names() {
        let folder = tempfile::tempdir().unwrap();
        let content = |name: &str, text: &str, seed: u64| {
            let path = folder.path().join(name);
            std::fs::write(&path, text).unwrap();
            let of = Provenance::of([(name, path.as_path())], Some(seed));
            of.unwrap().content()
        };
        let one = content("a.toml", "abc", 1);
        assert_eq!(one, content("b.toml", "abc", 1));
        assert_ne!(one, content("a.toml", "abd", 1));
        assert_ne!(one, content("a.toml", "abc", 2));
    }

    #[test]
    fn libraries_are_those_that_are_pinned() {
        let manifest = include_str!("../../Cargo.toml");
        for (name, version) in LIBRARIES {
            let declares = |line: &&str| line.contains(name) && line.contains("version = ");
            let line = manifest.lines().find(declares).unwrap();
            assert!(line.contains(&format!("={version}")), "{line}");
        }
    }
}
