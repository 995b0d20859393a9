//! Files that a cell is made of.

use std::path::PathBuf;

use super::{
    ArmScenario, BurrScenario, DeviceScenario, Obstacle, ObstacleShape, WorkpieceScenario,
};

/// The files that a cell is made of, that of its scenario first.
pub fn files_of_cell<'a>(
    path: &'a PathBuf,
    arm: &'a ArmScenario,
    device: &'a DeviceScenario,
    workpiece: &'a WorkpieceScenario,
    obstacles: &'a [Obstacle],
) -> Vec<&'a PathBuf> {
    let mut files = vec![path];
    let burr = match &workpiece.burr {
        BurrScenario::Table { path } => Some(path),
        _ => None,
    };
    let others = [&device.model, &arm.urdf, &workpiece.mesh];
    let obstacles = obstacles
        .iter()
        .filter_map(|obstacle| match &obstacle.shape {
            ObstacleShape::Mesh { path, .. } => Some(path),
            ObstacleShape::Box(_) => None,
        });
    let arm_file = arm.recorded_arm.as_ref().map(|file| &file.path);
    for file in others
        .into_iter()
        .chain(arm_file)
        .chain(burr)
        .chain(obstacles)
    {
        if !files.contains(&file) {
            files.push(file);
        }
    }
    files
}
