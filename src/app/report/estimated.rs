//! Masses of the arm that are estimated, and the torques with what that leaves open of them.

use serde_json::Value;

use crate::document::{Block, Cell, Section, Table};
use crate::quantity::significant;

/// The part of a page that says so; none where no mass is estimated. `file` is the document's.
pub(super) fn estimated(document: &Value, file: &str) -> Option<Section<'static>> {
    let estimated = &document["estimated_masses"];
    let number = |row: &Value, key: &str| {
        Cell::from(
            row[key]
                .as_f64()
                .map_or_else(String::new, |value| significant(value, 2)),
        )
    };
    let text =
        |row: &Value, key: &str| Cell::from(row[key].as_str().unwrap_or_default().to_owned());
    let links = estimated["links"].as_array()?;
    let rows = links.iter().map(|link| {
        vec![
            text(link, "link"),
            number(link, "mass_kg"),
            text(link, "estimated"),
        ]
    });
    let masses = Table::new(
        "Links of whose weight the URDF file does not say all, with all that is fixed to them.",
        &["link", "#mass [kg]", "estimated"],
        rows.collect(),
    );
    let rows = estimated["joints"].as_array()?.iter().map(|joint| {
        vec![
            text(joint, "joint"),
            number(joint, "least_n_m"),
            number(joint, "largest_n_m"),
            number(joint, "greatest_n_m"),
            number(joint, "limit_n_m"),
        ]
    });
    let spread = estimated["mass_spread_percent"].as_f64()?;
    let torques = Table::new(
        "Largest torque of each drive along the planned motion [N m].",
        &["joint", "#least", "#as estimated", "#greatest", "#limit"],
        rows.collect(),
    );
    let words = format!(
        "These masses are estimated from the shapes of the links and the robot's whole mass. If each of them is off by up to {} %, either way, torques lie between least and greatest. {file} has them as estimated_masses; [[arm.link_masses]] in the scenario takes what is known.",
        significant(spread, 2)
    );
    Some(Section::new(
        "Estimated masses",
        vec![
            Block::Paragraph(words),
            Block::Table(masses),
            Block::Table(torques),
        ],
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_page_shows_masses_and_torques_only_where_some_are_estimated() {
        let document = serde_json::json!({ "estimated_masses": {
            "mass_spread_percent": 50.0,
            "links": [{ "link": "link_1", "mass_kg": 81.25, "estimated": "mass, centre and inertia" }],
            "joints": [{ "joint": "joint_1", "largest_n_m": 512.0, "least_n_m": 261.0, "greatest_n_m": 763.0, "limit_n_m": 1200.0 }],
        } });
        let section = estimated(&document, "summary.json").unwrap();
        let [
            Block::Paragraph(words),
            Block::Table(_),
            Block::Table(torques),
        ] = &section.blocks[..]
        else {
            panic!("other blocks");
        };
        assert!(words.contains("off by up to 50 %"), "{words}");
        assert_eq!(torques.rows.len(), 1);
        assert!(estimated(&serde_json::json!({}), "summary.json").is_none());
    }
}
