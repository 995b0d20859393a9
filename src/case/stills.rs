//! Tables that look like still postures of a wrench sensor.

use std::path::Path;

use crate::diagnosis::postures::model::WRENCH_COLUMNS;
use crate::recording::csv::header_of;

/// A table in a folder that looks like still postures.
pub(super) fn stills_in(folder: &Path) -> Option<String> {
    let entries = std::fs::read_dir(folder).ok()?.flatten();
    let mut names: Vec<String> = entries
        .filter_map(|entry| entry.file_name().into_string().ok())
        .filter(|name| name.to_ascii_lowercase().ends_with(".csv"))
        .collect();
    names.sort_unstable();
    names.into_iter().find(|name| {
        let header = header_of(&folder.join(name)).unwrap_or_default();
        let has = |column: &str| header.iter().any(|own| own == column);
        has("quaternion_w") && has(WRENCH_COLUMNS[0]) && !has("time_s")
    })
}
