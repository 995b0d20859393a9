//! In which order columns count the joints of an arm.

use crate::arm::KinematicChain;
use crate::keys::check::Section;
use crate::keys::document::Document;
use crate::keys::error::ScenarioError;

/// Number of each joint in columns, base first, of drives in the order of columns.
pub(super) fn column_order(
    document: &Document<'_>,
    chain: &KinematicChain,
    drives: &[&str],
) -> Result<Vec<usize>, ScenarioError> {
    let all: Vec<&str> = chain
        .joints
        .iter()
        .map(|joint| joint.name.as_str())
        .collect();
    for (index, name) in drives.iter().enumerate() {
        let section = Section::new(document, format!("drive[{index}]"));
        if !all.contains(name) {
            let expected = format!(
                "a moving joint of the URDF on the way to the flange: {}",
                all.join(", ")
            );
            return Err(section.refuse("joint", format!("{name:?}"), expected));
        }
        if drives[..index].contains(name) {
            let expected = "each joint once".to_owned();
            return Err(section.refuse("joint", format!("{name:?} again"), expected));
        }
    }
    let number = |name: &&str| {
        let place = drives.iter().position(|drive| drive == name);
        place.map(|place| place + 1).ok_or_else(|| {
            let expected = format!(
                "a table [[drive]] with joint = {name:?}: the URDF moves {}, each of which has a drive",
                all.join(", ")
            );
            Section::new(document, "").missing("drive", &expected)
        })
    };
    all.iter().map(number).collect()
}
