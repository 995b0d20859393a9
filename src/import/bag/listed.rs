//! What `metadata.yaml` says of a bag's folder: its files in their order, and how many messages they hold.

use std::path::{Path, PathBuf};

use yaml_rust2::parser::{Event, Parser};

use crate::file::{guarded, read_up_to};

use crate::import::packed::plain_name;

/// Name of the file, and bytes of it that are read at most.
const NAME: &str = "metadata.yaml";
const LARGEST: u64 = 1 << 21;
/// The table that is read, and how deep.
const ABOUT: &str = "rosbag2_bagfile_information";
const DEPTH: usize = 3;

/// Files and messages of a bag.
pub(super) struct Listed {
    /// Names of its files, in order.
    files: Vec<String>,
    /// Number of its messages.
    pub messages: Option<u64>,
}

impl Listed {
    /// Reads the file of a folder; none where there is none, or it names no files.
    ///
    /// # Errors
    /// It cannot be read.
    pub fn of(folder: &Path) -> Result<Option<Self>, String> {
        let path = folder.join(NAME);
        if !path.exists() {
            return Ok(None);
        }
        let bytes = read_up_to(&path, LARGEST).map_err(|cause| cause.to_string())?;
        let text = String::from_utf8(bytes).map_err(|cause| cause.to_string())?;
        Self::parse(&text)
    }

    fn parse(text: &str) -> Result<Option<Self>, String> {
        let found = guarded(|| scalars(text)).and_then(|found| found)?;
        let of = |path: &[&str]| {
            let own = found.iter().filter(move |(own, _)| own == path);
            own.map(|(_, value)| value.as_str()).collect::<Vec<_>>()
        };
        // Earlier versions name the folder too.
        let name = |path: &&str| {
            let name = Path::new(*path).file_name()?;
            Some(name.to_string_lossy().into_owned())
        };
        let paths = of(&[ABOUT, "relative_file_paths", ""]);
        let files: Vec<String> = paths.iter().filter_map(name).collect();
        let count = of(&[ABOUT, "message_count"]);
        let messages = count.first().and_then(|count| count.parse().ok());
        Ok((!files.is_empty()).then_some(Self { files, messages }))
    }

    /// Files that are named here, in the order of the list, and others. One may have been packed or unpacked since.
    pub fn parted(&self, files: Vec<PathBuf>) -> (Vec<PathBuf>, Vec<PathBuf>) {
        let place = |file: &PathBuf| self.files.iter().position(|name| is_same(name, file));
        let (mut own, others): (Vec<PathBuf>, Vec<PathBuf>) =
            files.into_iter().partition(|file| place(file).is_some());
        own.sort_by_key(place);
        // Packed and unpacked it counts once.
        own.dedup_by_key(|file| place(file));
        (own, others)
    }

    /// Names here that none of the files has.
    pub fn missing(&self, files: &[PathBuf]) -> Vec<String> {
        let is_gone = |name: &&String| !files.iter().any(|file| is_same(name, file));
        self.files.iter().filter(is_gone).cloned().collect()
    }
}

/// Texts and numbers of the first document with the keys that lead to them, of lists empty ones, as deep as they are wanted. What stands once and is meant
/// many times is not followed, and nothing is kept in one another.
fn scalars(text: &str) -> Result<Vec<(Vec<String>, String)>, String> {
    let mut parser = Parser::new_from_str(text);
    let (mut path, mut found): (Vec<Place>, Vec<(Vec<String>, String)>) = (Vec::new(), Vec::new());
    loop {
        let (event, _) = parser.next_token().map_err(|cause| cause.to_string())?;
        let value = match event {
            Event::DocumentEnd | Event::StreamEnd => return Ok(found),
            Event::SequenceStart(..) => {
                path.push(Place::InList);
                continue;
            }
            Event::MappingStart(..) => {
                path.push(Place::BeforeKey);
                continue;
            }
            Event::SequenceEnd | Event::MappingEnd => {
                path.pop();
                None
            }
            Event::Scalar(value, ..) => Some(value),
            Event::Alias(_) => None,
            Event::Nothing | Event::StreamStart | Event::DocumentStart => continue,
        };
        match (path.last_mut(), value) {
            // What stands in place of a key may be anything.
            (Some(place @ Place::BeforeKey), key) => {
                *place = Place::Behind(key.unwrap_or_default());
            }
            (last, value) => {
                let is_value = matches!(last, Some(Place::Behind(_)));
                if let Some(value) = value.filter(|_| path.len() <= DEPTH) {
                    found.push((path.iter().map(Place::key).collect(), value));
                }
                if let Some(place) = path.last_mut().filter(|_| is_value) {
                    *place = Place::BeforeKey;
                }
            }
        }
    }
}

/// Where a text is read.
enum Place {
    InList,
    BeforeKey,
    Behind(String),
}

impl Place {
    fn key(&self) -> String {
        match self {
            Self::Behind(key) => key.clone(),
            Self::InList | Self::BeforeKey => String::new(),
        }
    }
}

fn is_same(name: &str, file: &Path) -> bool {
    plain_name(Path::new(name)).file_name() == plain_name(file).file_name()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_are_in_the_order_of_the_list_packed_or_not() {
        let text = "rosbag2_bagfile_information:\n  message_count: 30\n  relative_file_paths:\n    - ride/b_0.mcap.zstd\n    - a_1.mcap\n    - \"c 2.mcap\"\n";
        let listed = Listed::parse(text).unwrap().unwrap();
        let there = ["a_1.mcap", "b_0.mcap", "b_0.mcap.zstd", "z_9.mcap"];
        let (own, others) = listed.parted(there.iter().map(PathBuf::from).collect());
        assert_eq!(own, [PathBuf::from("b_0.mcap"), PathBuf::from("a_1.mcap")]);
        assert_eq!(others, [PathBuf::from("z_9.mcap")]);
        assert_eq!(listed.missing(&own), ["c 2.mcap"]);
        assert_eq!(listed.messages, Some(30));
        let none = "rosbag2_bagfile_information:\n  version: 9\n";
        assert!(Listed::parse(none).unwrap().is_none());
        assert!(Listed::parse("a: [1,\n b: {").is_err());
    }
}
