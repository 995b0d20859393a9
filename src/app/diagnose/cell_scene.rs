//! A recorded cell in space: the arm as its encoders read, pale, beside that of the improved model and that of the nominal one, and the edge coloured by
//! where the nominal model's force is off.
//!
//! ```text
//! q = q_s + k (q_o - q_s)                 k = 1, 2, 5, 10 .. 100
//! ```
//!
//! q drawn, q_s joint angles and stroke of the improved model, q_o recorded or nominal ones. What an arm gives is less than a millimetre, and nobody would
//! see it: k makes the recorded arm's departure some 30 mm.

use glam::DVec3;
use glamx::DPose3;

use super::super::error::AppError;
use super::super::picture::{PART, device_bodies, visual_shapes};
use crate::arm::VisualShape;
use crate::arm::kinematics::link_poses;
use crate::arm::{Arm, load_arm};
use crate::cell::{CellError, arm_options};
use crate::diagnosis::difference::comparison::Compared;
use crate::diagnosis::joints::servo::Axes;
use crate::diagnosis::recordings::recorded::COLUMNS;
use crate::plant::{ArmTrajectory, Channel, PlantParameters, follow};
use crate::replay::LoadedCell;
use crate::scene::colour::Colour;
use crate::scene::{ContactArrow, EdgePath, Scene, SceneBody, ScenePoses, SceneShape};
use crate::workpiece::load_mesh;

/// Time between two frames [s].
const FRAME_INTERVAL: f64 = 0.02;
/// The recorded arm.
const PALE: Colour = [225, 230, 240, 90];
/// The arm of the nominal model.
const AMBER: Colour = [235, 165, 60, 90];
/// Largest distance at which the recorded tool is drawn from the simulated one, about [m].
const SEEN: f64 = 0.03;
/// Departures are drawn this many times as large [1], the largest that keeps within that.
const SCALES: [f64; 7] = [1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0];
/// Segments of the edge.
const SEGMENTS: usize = 200;

/// Drawn part of a recording.
pub(super) struct Drawn<'a> {
    /// Commands and encoders.
    pub axes: &'a Axes,
    /// Its channels beside the models.
    pub compared: &'a Compared,
    /// The edge beside the ball.
    pub trajectory: &'a ArmTrajectory,
}

/// The scene of a recording.
///
/// # Errors
/// The arm's file or the part's mesh, should they have changed since they were read.
pub(super) fn cell_scene(
    cell: &LoadedCell,
    drawn: &Drawn<'_>,
    [nominal, improved]: [&PlantParameters; 2],
) -> Result<Scene, AppError> {
    let scenario = &cell.scenario;
    let arm = load_arm(&scenario.arm.urdf, &arm_options(&scenario.arm)).map_err(CellError::from)?;
    let time = &drawn.axes.time;
    let frames = frames(time);
    let recorded = recorded_angles(drawn.axes);
    let simulated = simulated_angles(drawn.axes, improved);
    let nominal = simulated_angles(drawn.axes, nominal);
    let channels = drawn.compared.channels.iter();
    let mut strokes = channels.filter(|c| c.column == COLUMNS[Channel::Stroke as usize]);
    let strokes = strokes.next().map(|c| {
        let each = [&c.improved, &c.measured, &c.nominal];
        each.map(|values| held(values.clone(), time.len()))
    });
    let [out, measured_out, nominal_out] =
        strokes.unwrap_or_else(|| [(); 3].map(|()| vec![0.0; time.len()]));
    let apart = largest_departure(
        &poses(cell, &simulated, &frames),
        &poses(cell, &recorded, &frames),
    ) + largest(out.iter().zip(&measured_out).map(|(a, b)| (a - b).abs()));
    let scale = scale(apart);
    let drawn_apart = |from: &[f64], to: &[f64]| -> Vec<f64> {
        let pairs = from.iter().zip(to);
        pairs.map(|(from, to)| from + scale * (to - from)).collect()
    };
    let arm_apart = |other: &[Vec<f64>]| -> Vec<Vec<f64>> {
        let joints = simulated.iter().zip(other);
        joints.map(|(from, to)| drawn_apart(from, to)).collect()
    };
    let [recorded, nominal] = [arm_apart(&recorded), arm_apart(&nominal)];
    let [measured_out, nominal_out] =
        [&measured_out, &nominal_out].map(|other| drawn_apart(&out, other));
    let mut bodies = Vec::new();
    for (name, angles, stroke, colour) in [
        ("simulated", &simulated, out, None),
        ("recorded", &recorded, measured_out, Some(PALE)),
        ("nominal", &nominal, nominal_out, Some(AMBER)),
    ] {
        let poses = poses(cell, angles, &frames);
        let mut own = arm_bodies(cell, &arm, &poses);
        own.extend(of_device(cell, &poses, &frames, &stroke));
        for body in &mut own {
            body.entity = format!("{name}/{}", body.entity);
            if let Some(colour) = colour {
                let shapes = body.shapes.iter_mut();
                shapes.for_each(|shape| shape.colour = colour);
            }
        }
        bodies.extend(own);
    }
    bodies.push(part(cell)?);
    let edge = &drawn.trajectory.edge;
    let stations = frames.iter().map(|i| edge[*i].station);
    Ok(Scene {
        title: title(&drawn.compared.name, scale),
        bodies,
        frame_times: frames.iter().map(|i| time[*i] - time[0]).collect(),
        frame_path_lengths: stations.collect(),
        edge_path: edge_path(drawn),
        contact_arrows: vec![
            ContactArrow {
                point_in_world: DVec3::ZERO,
                force_in_world: DVec3::ZERO,
            };
            frames.len()
        ],
        ..Scene::default()
    })
}

/// Factor by which departures are drawn enlarged [1], of which the largest is `apart` [m].
fn scale(apart: f64) -> f64 {
    let scale = SCALES.into_iter().rfind(|scale| scale * apart <= SEEN);
    scale.unwrap_or(SCALES[0])
}

fn title(recording: &str, scale: f64) -> String {
    match scale {
        1.0 => format!("{recording}: improved arm, recorded pale, nominal amber"),
        scale => format!(
            "{recording}: improved arm, recorded pale, nominal amber, their departures x{scale}"
        ),
    }
}

fn largest(values: impl Iterator<Item = f64>) -> f64 {
    values.fold(0.0, f64::max)
}

/// Largest distance between the last links of two arms [m].
fn largest_departure(one: &[Vec<DPose3>], other: &[Vec<DPose3>]) -> f64 {
    let last = |links: &Vec<DPose3>| links.last().map(|pose| pose.translation);
    let pairs = one.iter().zip(other);
    largest(pairs.filter_map(|(a, b)| Some((last(a)? - last(b)?).length())))
}

fn frames(time: &[f64]) -> Vec<usize> {
    let mut frames: Vec<usize> = Vec::new();
    for (index, own) in time.iter().enumerate() {
        if own - time[0] >= FRAME_INTERVAL * frames.len() as f64 - 1e-9 {
            frames.push(index);
        }
    }
    frames
}

/// Angles of each joint as its encoder read, as commanded where it has none.
fn recorded_angles(axes: &Axes) -> Vec<Vec<f64>> {
    let joints = axes.commands.iter().zip(&axes.encoders);
    joints
        .map(|(command, encoder)| match encoder {
            Some(encoder) => held(encoder.clone(), command.len()),
            None => command.clone(),
        })
        .collect()
}

/// Angles of each joint by the model: what its servo makes of its command, less what its encoder reads beyond the truth.
fn simulated_angles(axes: &Axes, model: &PlantParameters) -> Vec<Vec<f64>> {
    let joints = axes.commands.iter().zip(model.cell.encoder_offset);
    joints
        .map(|(command, offset)| {
            let mut angle = follow(&axes.time, command, model.cell.servo_bandwidth).angle;
            for angle in &mut angle {
                *angle -= offset;
            }
            angle
        })
        .collect()
}

/// Values with gaps filled by the value before; nought before the first, or without any.
fn held(mut values: Vec<f64>, count: usize) -> Vec<f64> {
    values.resize(count, f64::NAN);
    let mut last = 0.0;
    for value in &mut values {
        if value.is_nan() {
            *value = last;
        }
        last = *value;
    }
    values
}

/// Poses of the links in the world, frame by frame.
fn poses(cell: &LoadedCell, angles: &[Vec<f64>], frames: &[usize]) -> Vec<Vec<DPose3>> {
    let of = |index: &usize| {
        let q: Vec<f64> = angles.iter().map(|angle| angle[*index]).collect();
        let mut poses = vec![DPose3::IDENTITY; q.len()];
        link_poses(
            &cell.chain,
            cell.scenario.arm.world_from_base,
            &q,
            &mut poses,
        );
        poses
    };
    frames.iter().map(of).collect()
}

fn arm_bodies(cell: &LoadedCell, arm: &Arm, poses: &[Vec<DPose3>]) -> Vec<SceneBody> {
    let link = |index: usize| SceneBody {
        entity: format!("arm/{}", arm.link_names[index]),
        shapes: visual_shapes(arm, index).collect(),
        world_from_body: match index {
            0 => ScenePoses::Static(cell.scenario.arm.world_from_base),
            _ => ScenePoses::Moving(poses.iter().map(|links| links[index - 1]).collect()),
        },
    };
    (0..=arm.chain.len()).map(link).collect()
}

fn of_device(
    cell: &LoadedCell,
    poses: &[Vec<DPose3>],
    frames: &[usize],
    stroke: &[f64],
) -> [SceneBody; 2] {
    let chain = &cell.chain;
    let flange = |links: &Vec<DPose3>| links[chain.len() - 1] * chain.tip_from_last;
    let flanges: Vec<DPose3> = poses.iter().map(flange).collect();
    let slides = flanges.iter().zip(frames).map(|(flange, index)| {
        let out = DVec3::new(0.0, 0.0, stroke[*index]);
        *flange * DPose3::from_translation(out)
    });
    let slides = ScenePoses::Moving(slides.collect());
    device_bodies(&cell.scenario.nominal, ScenePoses::Moving(flanges), slides)
}

fn part(cell: &LoadedCell) -> Result<SceneBody, AppError> {
    let workpiece = &cell.scenario.workpiece;
    let mesh = load_mesh(&workpiece.mesh, workpiece.mesh_scale)?;
    Ok(SceneBody {
        entity: "workpiece".into(),
        shapes: vec![SceneShape {
            body_from_shape: DPose3::IDENTITY,
            geometry: VisualShape::Mesh {
                vertices: mesh.vertices().to_vec(),
                triangles: mesh.triangles().to_vec(),
            },
            colour: PART,
        }],
        world_from_body: ScenePoses::Static(workpiece.world_from_part),
    })
}

/// The edge as far as it was ridden, with the mean of (measured - nominal) / nominal force over each segment.
fn edge_path(drawn: &Drawn<'_>) -> EdgePath {
    let edge = &drawn.trajectory.edge;
    let stations = || edge.iter().map(|place| place.station);
    let low = stations().fold(f64::INFINITY, f64::min);
    let high = stations().fold(f64::NEG_INFINITY, f64::max);
    if low >= high {
        return EdgePath::default();
    }
    let segment = |station: f64| {
        let place = (station - low) / (high - low) * SEGMENTS as f64;
        (place as usize).min(SEGMENTS - 1)
    };
    let mut channels = drawn.compared.channels.iter();
    let force = channels.rfind(|c| c.column == COLUMNS[Channel::Force as usize]);
    let mut sums = vec![(0.0, 0.0); SEGMENTS];
    // Corners: the place of the sample that is nearest to each.
    let mut corners = vec![(f64::INFINITY, DVec3::ZERO); SEGMENTS + 1];
    for (index, place) in edge.iter().enumerate() {
        let exact = (place.station - low) / (high - low) * SEGMENTS as f64;
        let nearest = &mut corners[exact.round() as usize];
        let away = (exact - exact.round()).abs();
        if away < nearest.0 {
            *nearest = (away, place.point);
        }
        let Some(force) = force else { continue };
        let (measured, nominal) = (force.measured[index], force.nominal[index]);
        let error = (measured - nominal) / nominal;
        if nominal > 0.0 && error.is_finite() {
            let sum = &mut sums[segment(place.station)];
            *sum = (sum.0 + error, sum.1 + 1.0);
        }
    }
    let mut path = EdgePath::default();
    let known = |corner: &&(usize, (f64, DVec3))| corner.1.0.is_finite();
    let corners: Vec<(usize, (f64, DVec3))> = corners.into_iter().enumerate().collect();
    let corners: Vec<&(usize, (f64, DVec3))> = corners.iter().filter(known).collect();
    for pair in corners.windows(2) {
        let (sum, count) = sums[pair[0].0];
        path.relative_force_error.push(sum / count);
    }
    path.points_in_world = corners.iter().map(|(_, (_, point))| *point).collect();
    path
}

#[cfg(test)]
mod tests {
    use super::*;

    // Catches: an encoder's offset that is drawn the wrong way round.
    #[test]
    fn an_arm_whose_encoder_reads_too_much_is_drawn_short_of_its_command() {
        let axes = Axes {
            time: vec![0.0, 0.1],
            commands: vec![vec![0.5; 2], vec![0.7; 2]],
            encoders: vec![None, None],
        };
        let mut model = PlantParameters::default();
        model.cell.encoder_offset[1] = 0.2;
        let drawn = simulated_angles(&axes, &model);
        assert_eq!(drawn[0], [0.5; 2]);
        assert!(drawn[1].iter().all(|angle| (angle - 0.5).abs() < 1e-12));
    }

    #[test]
    fn departures_are_drawn_as_large_as_they_can_be_seen_and_it_is_said() {
        assert_eq!(scale(0.4e-3), 50.0);
        assert_eq!(scale(0.0), 100.0);
        // An arm that is far off is drawn where it is.
        assert_eq!(scale(0.2), 1.0);
        assert_eq!(
            title("a.csv", 1.0),
            "a.csv: improved arm, recorded pale, nominal amber"
        );
        assert!(title("a.csv", scale(1e-3)).ends_with("departures x20"));
    }
}
