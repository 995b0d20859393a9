//! The text of a URDF file, checked and parsed.

use std::path::{Path, PathBuf};

use roxmltree::{Document, Error};
use urdf_rs::Robot;

use super::error::ArmError;
use super::robot::robot;
use super::walk::{Fault, Walked, is_xacro, walk};
use super::{xacro, xml_fault};
use crate::xml;

/// A URDF file that has been read.
pub(super) struct Source {
    pub robot: Robot,
    pub walked: Walked,
    /// The folder from which its relative paths start.
    pub folder: PathBuf,
}

impl Source {
    /// Reads and checks a file; one with macros is given to the program `xacro` first.
    pub fn read(path: &Path) -> Result<Self, ArmError> {
        let bytes = crate::file::read(path).map_err(|source| ArmError::Unreadable {
            file: path.to_path_buf(),
            source,
        })?;
        if let Some(size) = crate::mesh_file::pointer_size(&bytes) {
            let file = path.to_path_buf();
            return Err(ArmError::Pointer { file, size });
        }
        let text = String::from_utf8(bytes).map_err(|error| {
            let before = &error.as_bytes()[..error.utf8_error().valid_up_to()];
            ArmError::Faulty {
                file: path.to_path_buf(),
                line: before.split(|byte| *byte == b'\n').count() as u32,
                fault: "it is not written in UTF-8: save it so".to_owned(),
            }
        })?;
        let text = text.trim_start_matches('\u{feff}');
        let ending = path.extension().is_some_and(|ending| ending == "xacro");
        if ending {
            return Self::expanded(path, 1, "it is a file of macros");
        }
        // Of a file that is cut off or holds something else the parser says less.
        for (part, fault) in [
            ("<robot", "it has no <robot> element"),
            ("</robot>", "it is cut off before </robot>"),
        ] {
            let other_root = text.contains("<sdf") || text.contains("<mujoco");
            if !text.contains(part) && !other_root {
                return Err(ArmError::Incomplete {
                    file: path.to_path_buf(),
                    fault,
                });
            }
        }
        match checked(text) {
            Ok((robot, walked)) => Ok(Self::new(path, robot, walked)),
            Err(fault) if fault.xacro => Self::expanded(path, fault.line, &fault.words),
            Err(Fault { line, words, .. }) => Err(ArmError::Faulty {
                file: path.to_path_buf(),
                line,
                fault: words,
            }),
        }
    }

    fn new(path: &Path, robot: Robot, walked: Walked) -> Self {
        let folder = path
            .parent()
            .filter(|folder| !folder.as_os_str().is_empty());
        Self {
            robot,
            walked,
            folder: folder.unwrap_or(Path::new(".")).to_path_buf(),
        }
    }

    fn expanded(path: &Path, line: u32, why: &str) -> Result<Self, ArmError> {
        let refused = |reason: String| ArmError::Xacro {
            file: path.to_path_buf(),
            line,
            why: why.to_owned(),
            reason,
        };
        let text = xacro::expanded(path).map_err(refused)?;
        match checked(text.trim_start_matches('\u{feff}')) {
            Ok((robot, mut walked)) => {
                let note = "its macros were evaluated by the program xacro; lines are those of what it wrote";
                walked.notes.insert(0, note.to_owned());
                // Lines of another text lead nowhere.
                walked.lines.clear();
                Ok(Self::new(path, robot, walked))
            }
            Err(fault) => Err(refused(format!("in what it wrote: {}", fault.words))),
        }
    }
}

fn checked(text: &str) -> Result<(Robot, Walked), Fault> {
    xml::check(text).map_err(|excess| Fault {
        line: excess.line,
        words: excess.reason,
        xacro: false,
    })?;
    let text = without_default_namespace(text);
    let (text, undeclared) = declared(text)?;
    let document = Document::parse(&text).map_err(|error| xml_fault::in_words(&text, &error))?;
    let mut walked = walk(&document)?;
    for prefix in undeclared {
        let note = format!("the prefix `{prefix}:` is used without being declared");
        walked.notes.push(note);
    }
    let robot = robot(document.root_element(), &walked.left_out);
    Ok((robot, walked))
}

/// Range of the tag that opens the robot, behind its name.
fn root_tag(text: &str) -> Option<std::ops::Range<usize>> {
    let start = text.find("<robot")? + "<robot".len();
    Some(start..start + text[start..].find('>')?)
}

/// The text without a namespace of its own for all of its elements, as Drake's files have it.
fn without_default_namespace(text: &str) -> String {
    let cut = || {
        let tag = root_tag(text)?;
        let start = tag.start + text[tag.clone()].find(" xmlns=")?;
        let value = start + " xmlns=".len();
        let quote = text[value..]
            .chars()
            .next()
            .filter(|c| "\"'".contains(*c))?;
        let end = value + 1 + text[value + 1..].find(quote)? + 1;
        Some(format!("{}{}", &text[..start], &text[end..]))
    };
    cut().unwrap_or_else(|| text.to_owned())
}

/// The text with its prefixes declared, and those that were not.
fn declared(mut text: String) -> Result<(String, Vec<String>), Fault> {
    const MOST: usize = 20;
    let mut undeclared = Vec::new();
    while undeclared.len() < MOST {
        match Document::parse(&text) {
            Err(Error::UnknownNamespace(prefix, position)) => {
                let Some(tag) = root_tag(&text) else {
                    let error = Error::UnknownNamespace(prefix, position);
                    return Err(xml_fault::in_words(&text, &error));
                };
                // Of xacro the walk says what it is.
                let known = is_xacro(&prefix);
                text.insert_str(tag.start, &format!(" xmlns:{prefix}=\"{prefix}\""));
                if !known {
                    undeclared.push(prefix);
                }
            }
            _ => break,
        }
    }
    Ok((text, undeclared))
}
