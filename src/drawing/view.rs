//! From where an edge is seen best.

use glam::DVec3;

use crate::scene::Scene;

/// Steps of the directions that are tried [degrees].
const AZIMUTH_STEP: usize = 15;
const ELEVATIONS: [f64; 6] = [15.0, 25.0, 35.0, 45.0, 55.0, 65.0];
/// Least cosine between the eye's direction and that away from the part [1].
const OUTSIDE: f64 = 0.3;
/// Gain of a direction that is near to the viewer's own.
const USUAL: f64 = 0.08;

/// From the part towards the eye: of the directions on the side that the tool comes from that in which the edge looks longest, a usual one of equals.
#[must_use]
pub fn edge_direction(scene: &Scene) -> DVec3 {
    let usual = DVec3::new(0.75, -1.0, 0.55).normalize();
    let points = &scene.edge_path.points_in_world;
    let pieces: Vec<DVec3> = points.windows(2).map(|two| two[1] - two[0]).collect();
    let forces = scene
        .contact_arrows
        .iter()
        .map(|arrow| arrow.force_in_world);
    // The tool presses into the part.
    let outside = -forces.sum::<DVec3>().normalize_or_zero();
    let length: f64 = pieces.iter().map(|piece| piece.length()).sum();
    let seen = |eye: DVec3| {
        let flat = |piece: &DVec3| piece.reject_from_normalized(eye).length();
        pieces.iter().map(flat).sum::<f64>() / length.max(1e-9)
    };
    let azimuths = (0..360)
        .step_by(AZIMUTH_STEP)
        .map(|a| f64::from(a).to_radians());
    let directions = azimuths.flat_map(|azimuth| {
        ELEVATIONS.map(|elevation| {
            let (height, flat) = elevation.to_radians().sin_cos();
            DVec3::new(flat * azimuth.cos(), flat * azimuth.sin(), height)
        })
    });
    let allowed = directions.filter(|eye| outside == DVec3::ZERO || eye.dot(outside) > OUTSIDE);
    let score = |eye: &DVec3| seen(*eye) + USUAL * eye.dot(usual);
    let best = allowed.max_by(|a, b| score(a).total_cmp(&score(b)));
    // A tool that works from below.
    best.unwrap_or(if outside == DVec3::ZERO {
        usual
    } else {
        (outside + 0.5 * usual).normalize_or(outside)
    })
}
