//! Masses of the arm that are estimated, and the torques with what that leaves open of them.

use crate::cell::EstimatedArm;
use crate::document::{Block, Cell, Column, Number, Section, Table};
use crate::quantity::significant;

/// Masses that are estimated and the spread of the torques; `file` holds them.
pub fn estimated(arm: &EstimatedArm, file: &str) -> Section<'static> {
    let number = |value: f64, unit: &str| {
        Cell::from(Number::bare("", Some(value), unit).written(significant(value, 2)))
    };
    let rows = arm.links.iter().map(|link| {
        vec![
            Cell::from(link.link.as_str()),
            number(link.mass_kg, "kg"),
            Cell::from(link.estimated.as_ref()),
        ]
    });
    let masses = Table::new(
        "Links of whose weight the URDF file does not say all, with all that is fixed to them.",
        Column::list("link | #mass [kg] | estimated"),
        rows.collect(),
    );
    let rows = arm.joints.iter().map(|joint| {
        let torques = [
            joint.least_n_m,
            joint.largest_n_m,
            joint.greatest_n_m,
            joint.limit_n_m,
        ];
        let torques = torques.map(|torque| number(torque, "N m"));
        [Cell::from(joint.joint.as_str())]
            .into_iter()
            .chain(torques)
            .collect()
    });
    let columns = Column::list("joint | #least | #as estimated | #greatest | #limit");
    let torques = Table::new(
        "Largest torque of each drive along the planned motion [N m].",
        columns,
        rows.collect(),
    );
    let words = format!(
        "These masses are estimated from the shapes of the links and the robot's whole mass. If each of them is off by up to {} %, either way, torques lie between least and greatest. {file} has them as estimated_masses; [[arm.link_masses]] in the scenario takes what is known.",
        significant(arm.mass_spread_percent, 2)
    );
    Section::new(
        "Estimated masses",
        vec![
            Block::Paragraph(words),
            Block::Table(masses),
            Block::Table(torques),
        ],
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn masses_and_torques_that_are_estimated_are_shown() {
        let arm = serde_json::json!({
            "mass_spread_percent": 50.0,
            "links": [{ "link": "link_1", "mass_kg": 81.25, "estimated": "mass, centre and inertia" }],
            "joints": [{ "joint": "joint_1", "largest_n_m": 512.0, "least_n_m": 261.0, "greatest_n_m": 763.0, "limit_n_m": 1200.0 }],
        });
        let arm: EstimatedArm = serde_json::from_value(arm).unwrap();
        let section = estimated(&arm, "summary.json");
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
    }
}
