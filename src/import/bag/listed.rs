//! What `metadata.yaml` says of a bag's folder: its files in their order, and how many messages they hold.

use std::path::{Path, PathBuf};

use yaml_rust2::{Yaml, YamlLoader};

use crate::import::packed::plain_name;

/// Name of the file, and bytes of it that are read at most.
const NAME: &str = "metadata.yaml";
const LARGEST: u64 = 1 << 24;

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
        match std::fs::metadata(&path) {
            Err(_) => return Ok(None),
            Ok(about) if about.len() > LARGEST => return Err("it is too large".to_owned()),
            Ok(_) => {}
        }
        let text = crate::file::read_text(&path).map_err(|cause| cause.to_string())?;
        Self::parse(&text)
    }

    fn parse(text: &str) -> Result<Option<Self>, String> {
        let documents = YamlLoader::load_from_str(text).map_err(|cause| cause.to_string())?;
        let Some(document) = documents.first() else {
            return Ok(None);
        };
        let about = &document["rosbag2_bagfile_information"];
        let paths = about["relative_file_paths"].as_vec();
        // Earlier versions name the folder too.
        let name = |path: &Yaml| {
            let name = Path::new(path.as_str()?).file_name()?;
            Some(name.to_string_lossy().into_owned())
        };
        let files: Vec<String> = paths.into_iter().flatten().filter_map(name).collect();
        let messages = about["message_count"].as_i64();
        Ok((!files.is_empty()).then_some(Self {
            files,
            messages: messages.and_then(|count| u64::try_from(count).ok()),
        }))
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
