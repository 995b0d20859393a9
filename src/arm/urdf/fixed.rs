//! Frames that are fixed to each other: a controller's base and flange beside the links that a scenario names.

use std::path::Path;

use glamx::DPose3;

use super::error::{ArmError, Refusal};
use super::graph::{Graph, kind_of};
use super::refused;
use super::source::Source;
use super::tree::pose_of;

/// The pose of a link in that of another one, the root where none is named; none if the file has no such link, or joints move between them.
///
/// # Errors
/// The file cannot be read, or a joint of it cannot be honoured.
pub fn fixed_frame(path: &Path, from: Option<&str>, to: &str) -> Result<Option<DPose3>, ArmError> {
    let source = Source::read(path)?;
    let found = || -> Result<Option<DPose3>, Refusal> {
        let graph = Graph::build(&source.robot)?;
        let (Ok(start), Ok(end)) = (
            from.map_or_else(|| graph.root(), |name| graph.link(name, "base")),
            graph.link(to, "frame"),
        ) else {
            return Ok(None);
        };
        let (above_start, above_end) = (rigid(&graph, &start.name)?, rigid(&graph, &end.name)?);
        Ok(above_start.iter().find_map(|(name, above_from_start)| {
            let same = above_end.iter().find(|(other, _)| other == name);
            same.map(|(_, above_from_end)| above_from_start.inverse() * *above_from_end)
        }))
    };
    found().map_err(|refusal| refused(path, &source, refusal))
}

/// A link and those above it up to the next joint that moves, each with the pose of the link in it.
fn rigid(graph: &Graph<'_>, link: &str) -> Result<Vec<(String, DPose3)>, Refusal> {
    let mut pose = DPose3::IDENTITY;
    let mut found = vec![(link.to_owned(), pose)];
    for joint in graph.above(graph.link(link, "frame")?).iter().rev() {
        if kind_of(joint)?.is_some() {
            break;
        }
        let origin = pose_of(&joint.origin, || {
            format!("origin of joint `{}`", joint.name)
        })?;
        pose = origin * pose;
        found.push((joint.parent.link.clone(), pose));
    }
    Ok(found)
}
