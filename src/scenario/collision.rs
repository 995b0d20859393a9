//! `[collision]` and `[[obstacle]]` of a scenario file.

use super::file::{CollisionKeys, ObstacleKeys};
use super::{CollisionScenario, Obstacle, ObstacleShape};
use crate::keys::check::{Section, pose};
use crate::keys::document::Document;
use crate::keys::error::ScenarioError;

/// What must not meet.
pub(super) fn collision(
    document: &Document<'_>,
    keys: &CollisionKeys,
    obstacles: &[ObstacleKeys],
) -> Result<CollisionScenario, ScenarioError> {
    let mut found: Vec<Obstacle> = Vec::with_capacity(obstacles.len());
    for (index, keys) in obstacles.iter().enumerate() {
        let section = Section::new(document, format!("obstacle[{index}]"));
        let obstacle = obstacle(&section, keys, index)?;
        if found.iter().any(|other| other.name == obstacle.name) {
            let again = format!("\"{}\" again", obstacle.name);
            return Err(section.refuse("name", again, "each name once".to_owned()));
        }
        found.push(obstacle);
    }
    Ok(CollisionScenario {
        margin: keys.margin,
        floor_height: keys.floor_height,
        allowed_pairs: keys.allowed_pairs.clone().unwrap_or_default(),
        obstacles: found,
    })
}

fn obstacle(
    section: &Section<'_>,
    keys: &ObstacleKeys,
    index: usize,
) -> Result<Obstacle, ScenarioError> {
    let shape = match (&keys.box_size, &keys.mesh) {
        (Some(_), Some(_)) => {
            let reason =
                format!("`obstacle[{index}].box_mm` is given too, expected one of the two");
            return Err(section.misplaced("mesh", reason));
        }
        (None, None) => {
            return Err(section.missing("box_mm", "box_mm = [x, y, z], or mesh with mesh_unit"));
        }
        (Some(size), None) => {
            if keys.mesh_unit.is_some() {
                let reason = "a box has no mesh; its size is in millimetres".to_owned();
                return Err(section.misplaced("mesh_unit", reason));
            }
            ObstacleShape::Box(*size)
        }
        (None, Some(mesh)) => ObstacleShape::Mesh {
            path: section.file("mesh", mesh)?,
            scale: match keys.mesh_unit {
                Some(unit) => unit.length(),
                None => return Err(section.missing("mesh_unit", "mm, m or inch")),
            },
        },
    };
    let given = |name: &String| section.text("name", name);
    Ok(Obstacle {
        name: match keys.name.as_ref().map(given) {
            Some(name) => name?,
            None => format!("obstacle {}", index + 1),
        },
        shape,
        world_from_obstacle: pose(keys.position, keys.rotation),
    })
}
