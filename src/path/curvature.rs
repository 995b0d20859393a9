//! Feed where the edge bends: no faster than an acceleration across the path allows, as machine tools hold it.
//!
//! ```text
//! v = min(v_0, sqrt(a / kappa)),   kappa = |dt/ds|,   sqrt(a r) on an arc of radius r
//! ```
//!
//! v_0 feed asked for [m/s], a largest acceleration across the path [m/s2], kappa curvature of the edge [1/m], t its direction, s length along it [m]. The feed is that of
//! the point of contact; a corner, about which the tool turns on the spot, has a feed of its own.

use super::toolpath::{ToolPath, ToolpathSection};

/// Length over which the edge's direction is compared [m]: longer than the facets that a mesh makes of an arc.
const WINDOW: f64 = 2e-3;
/// Distance between the places at which that is done [m].
const SPACING: f64 = 1e-3;

/// The largest feed from one place to another of a stretch of the edge [m/s].
pub(super) fn feed_limit(
    path: &ToolPath,
    section: &ToolpathSection,
    [from, to]: [f64; 2],
    acceleration: f64,
) -> f64 {
    let ends = [section.start, section.start + section.length];
    // A bend that begins just beyond has its whole curvature in no window before it.
    let [from, to] = [from - 0.5 * WINDOW, to + 0.5 * WINDOW].map(|at| at.clamp(ends[0], ends[1]));
    let count = ((to - from) / SPACING).ceil().max(1.0);
    let curvature = |place: f64| {
        // Not across a corner, which lies between two stretches.
        let [low, high] =
            [place - 0.5 * WINDOW, place + 0.5 * WINDOW].map(|at| at.clamp(ends[0], ends[1]));
        let turned = path.at(low).tangent.angle_between(path.at(high).tangent);
        turned / (high - low).max(1e-9)
    };
    let places = (0..=count as usize).map(|i| from + (to - from) * i as f64 / count);
    let largest = places.map(curvature).fold(0.0, f64::max);
    (acceleration / largest).sqrt()
}

#[cfg(test)]
mod tests {
    use glamx::DPose3;

    use super::*;
    use crate::path::toolpath::{Stretch, ToolAxis};
    use crate::workpiece::{EdgeSearch, list_edges, load_mesh};

    /// Once round the bracket: arcs of 20 and 15 mm between straight stretches.
    fn bracket() -> ToolPath {
        let file = concat!(env!("CARGO_MANIFEST_DIR"), "/assets/bracket.stl");
        let mesh = load_mesh(file.as_ref(), 1e-3).unwrap();
        let list = list_edges(&mesh, &EdgeSearch::default());
        ToolPath::along(list.loops[0].clone(), DPose3::IDENTITY, ToolAxis::Lean(0.0)).unwrap()
    }

    #[test]
    fn on_an_arc_the_feed_is_the_root_of_acceleration_times_radius() {
        let path = bracket();
        let acceleration = 0.02;
        let mut limits = Vec::new();
        for section in path.sections() {
            if let Stretch::Edge { .. } = section.stretch {
                let count = (section.length / 1e-3) as usize;
                let at = |i: usize| section.start + section.length * i as f64 / count as f64;
                limits.extend(
                    (0..count)
                        .map(|i| feed_limit(&path, section, [at(i), at(i + 1)], acceleration)),
                );
            }
        }
        for radius in [0.020f64, 0.015] {
            let expected = (acceleration * radius).sqrt();
            let on_it = limits
                .iter()
                .filter(|limit| (**limit / expected - 1.0).abs() < 0.01);
            // Three quarter arcs of 20 mm, one of 15 mm, a value each millimetre.
            let arcs = if radius > 0.018 { 3.0 } else { 1.0 };
            let length = 1e3 * arcs * radius * std::f64::consts::FRAC_PI_2;
            let count = on_it.count() as f64;
            assert!(
                (count / length - 1.0).abs() < 0.15,
                "{radius} m: {count} of {length}"
            );
        }
        assert!(
            limits
                .iter()
                .all(|limit| *limit > 0.98 * (acceleration * 0.015).sqrt())
        );
        let straight = limits.iter().filter(|limit| **limit > 1.0).count();
        assert!(straight > 250, "{straight}");
    }
}
