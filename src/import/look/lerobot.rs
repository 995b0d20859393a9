//! Names of the elements of LeRobot's lists, which stand beside its tables and not in them: `observation.state[0]` is `observation.state.shoulder_pan.pos`.
//!
//! Source: LeRobot dataset format 2 and 3, `meta/info.json`, `features`.

use std::collections::BTreeMap;
use std::path::Path;

use serde_json::Value;

/// File of the names, from the dataset's folder.
const INFO: &str = "meta/info.json";
/// Folders above a table in which a dataset's folder may be: `data/chunk-000/episode_000000.parquet`.
const ABOVE: usize = 4;

/// Elements by their columns, with the name of the list before their own; none of a table of anything else.
pub(super) fn feature_names(path: &Path) -> BTreeMap<String, String> {
    let whole = path.canonicalize().unwrap_or_else(|_| path.to_owned());
    let mut folders = whole.ancestors().skip(1).take(ABOVE);
    let info = folders.find_map(|folder| crate::file::read_text(folder.join(INFO)).ok());
    let info: Option<Value> = info.and_then(|text| serde_json::from_str(&text).ok());
    let features = info.as_ref().and_then(|info| info["features"].as_object());
    let mut all = BTreeMap::new();
    for (feature, said) in features.into_iter().flatten() {
        // A list, or lists by what they are: `{ "motors": [..] }`.
        let names = match &said["names"] {
            Value::Object(groups) => groups.values().next().and_then(Value::as_array),
            names => names.as_array(),
        };
        for (place, name) in names.into_iter().flatten().enumerate() {
            if let Some(name) = name.as_str() {
                all.insert(format!("{feature}[{place}]"), format!("{feature}.{name}"));
            }
        }
    }
    all
}
