//! Checks that a file is a whole `.rrd` of our version. Looked at before a viewer is asked to open it, as it would say less, later.

use std::io::{Read as _, Seek as _, SeekFrom};
use std::path::Path;

use ::rerun::external::re_log_encoding::{
    CrateVersion, Decodable as _, OLD_RRD_FOURCC, RRD_FOURCC, StreamFooter, StreamHeader,
};

/// Why a file cannot be shown.
#[derive(Debug, thiserror::Error)]
pub enum RrdFault {
    /// It cannot be read.
    #[error(
        "cannot read {file}: {reason}; expected a recording, such as runs/plate_edge/recording.rrd"
    )]
    Unreadable {
        /// The file.
        file: String,
        /// Why.
        reason: String,
    },
    /// It is something else.
    #[error("{file} is no recording of Rerun's: it does not begin with {}; expected an .rrd file", RRD_FOURCC.escape_ascii())]
    Other {
        /// The file.
        file: String,
    },
    /// It has another version's form.
    #[error(
        "{file} was written by Rerun {found}, expected {expected}; `pip install rerun-sdk=={found}` brings the viewer that fits it"
    )]
    Version {
        /// The file.
        file: String,
        /// Its version.
        found: String,
        /// Ours.
        expected: String,
    },
    /// It has the form of a version that is too old to say which.
    #[error(
        "{file} was written by a Rerun before 0.23, expected {expected}; run the job again, or open it with the viewer that it was made for"
    )]
    Old {
        /// The file.
        file: String,
        /// Ours.
        expected: String,
    },
    /// It ends too soon.
    #[error(
        "{file} is cut off after {length} bytes: it does not end as a recording does; expected a whole file, so copy or record it again"
    )]
    CutOff {
        /// The file.
        file: String,
        /// Its length.
        length: u64,
    },
}

/// The version of Rerun whose files are written here, and whose viewer shows them.
#[must_use]
pub fn viewer_version() -> String {
    CrateVersion::LOCAL.to_string()
}

/// Looks whether a viewer of [`viewer_version`] can show a file whole.
///
/// # Errors
/// [`RrdFault`] says why not.
pub fn check_rrd(path: &Path) -> Result<(), RrdFault> {
    let file = path.display().to_string();
    let unreadable = |reason: &dyn std::fmt::Display| RrdFault::Unreadable {
        file: file.clone(),
        reason: reason.to_string(),
    };
    if path.is_dir() {
        return Err(unreadable(&"it is a folder"));
    }
    let mut input = crate::file::open(path).map_err(|error| unreadable(&error))?;
    let length = input.metadata().map_err(|error| unreadable(&error))?.len();
    let mut head = Vec::new();
    let wanted = StreamHeader::ENCODED_SIZE_BYTES as u64;
    (&mut input)
        .take(wanted)
        .read_to_end(&mut head)
        .map_err(|error| unreadable(&error))?;
    check_head(&head, &file, length)?;
    let tail = (StreamFooter::ENCODED_SIZE_BYTES as u64).min(length);
    let mut foot = Vec::new();
    input
        .seek(SeekFrom::Start(length - tail))
        .and_then(|_| input.read_to_end(&mut foot))
        .map_err(|error| unreadable(&error))?;
    check_foot(&foot, length).ok_or(RrdFault::CutOff { file, length })
}

/// Form and version; a patch level more or less changes neither.
fn check_head(head: &[u8], file: &str, length: u64) -> Result<(), RrdFault> {
    let file = file.to_owned();
    let expected = viewer_version();
    let magic: [u8; 4] = head
        .get(..RRD_FOURCC.len())
        .and_then(|magic| magic.try_into().ok())
        .unwrap_or_default();
    if OLD_RRD_FOURCC.contains(&magic) {
        return Err(RrdFault::Old { file, expected });
    }
    if magic != RRD_FOURCC {
        return Err(RrdFault::Other { file });
    }
    let Some(&version) = head[RRD_FOURCC.len()..].first_chunk::<4>() else {
        return Err(RrdFault::CutOff { file, length });
    };
    let (found, ours) = (CrateVersion::from_bytes(version), CrateVersion::LOCAL);
    if (found.major, found.minor) == (ours.major, ours.minor) {
        Ok(())
    } else {
        let found = found.to_string();
        Err(RrdFault::Version {
            file,
            found,
            expected,
        })
    }
}

/// Checks that the footer says where, within the file, its tables lie.
fn check_foot(foot: &[u8], length: u64) -> Option<()> {
    let footer = StreamFooter::from_rrd_bytes(foot).ok()?;
    let end = length.checked_sub(StreamFooter::ENCODED_SIZE_BYTES as u64)?;
    let lies_within = footer.entries.iter().all(|entry| {
        let span = entry.rrd_footer_byte_span_from_start_excluding_header;
        span.start.checked_add(span.len) == Some(end)
    });
    (lies_within && !footer.entries.is_empty()).then_some(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::recording::Recording;
    use crate::scene::Scene;
    use crate::viewer::{RerunOptions, write_rrd};

    fn fault(bytes: &[u8]) -> Option<String> {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("x.rrd");
        std::fs::write(&path, bytes).unwrap();
        let fault = check_rrd(&path).err()?.to_string();
        Some(fault.replace(&path.display().to_string(), "FILE"))
    }

    fn whole() -> Vec<u8> {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("x.rrd");
        let recording = Recording::new(vec![0.0], vec![], vec![]).unwrap();
        let options = RerunOptions::default();
        write_rrd(&path, &recording, &Scene::default(), &options).unwrap();
        std::fs::read(&path).unwrap()
    }

    #[test]
    fn a_whole_file_passes_and_one_cut_anywhere_does_not() {
        let bytes = whole();
        assert_eq!(fault(&bytes), None);
        for kept in [4, 11, 12, 100, bytes.len() / 2, bytes.len() - 1] {
            let message = fault(&bytes[..kept]).unwrap();
            let expected = format!("FILE is cut off after {kept} bytes");
            assert!(message.starts_with(&expected), "{message}");
        }
        // The end of one file behind the start of another: the tables lie elsewhere.
        let mut spliced = bytes[..bytes.len() / 2].to_vec();
        spliced.extend_from_slice(&bytes[bytes.len() - 40..]);
        assert!(fault(&spliced).unwrap().contains("cut off"));
    }

    #[test]
    fn other_forms_and_versions_are_distinguished() {
        let mut bytes = whole();
        bytes[4..8].copy_from_slice(&[0, 41, 0, 0]);
        let message = fault(&bytes).unwrap();
        assert!(
            message.starts_with("FILE was written by Rerun 0.41.0, expected 0.36."),
            "{message}"
        );
        assert!(fault(b"RRF1").unwrap().contains("before 0.23"));
        assert!(
            fault(b"PAR1xxxxxxxxxxxxxxxx")
                .unwrap()
                .contains("no recording of Rerun's")
        );
        assert!(fault(b"").unwrap().contains("no recording of Rerun's"));
        let missing = check_rrd(Path::new("/nowhere/x.rrd")).unwrap_err();
        assert!(
            missing
                .to_string()
                .starts_with("cannot read /nowhere/x.rrd")
        );
        assert!(
            check_rrd(Path::new(env!("CARGO_MANIFEST_DIR")))
                .unwrap_err()
                .to_string()
                .contains("it is a folder")
        );
    }
}
