//! Where the part would have to lie, and how the tool would have to stand.

use glam::{DMat3, DQuat, DVec3, EulerRot};
use glamx::DPose3;
use rayon::prelude::*;

use super::amounts::held_back;
use super::kind::Kind;
use super::remedy::Remedy;
use super::trial::Trial;
use crate::cell::{Setup, Stance};
use crate::path::{Plan, ToolAxis};
use crate::scenario::KeyValue;

/// Distances by which the part is moved, the shortest first [mm].
const DISTANCES: [f64; 13] = [
    1.0, 3.0, 8.0, 20.0, 45.0, 90.0, 160.0, 260.0, 400.0, 650.0, 1000.0, 1600.0, 2500.0,
];
/// Ways beyond the shortest that are tried [mm]: just within reach a joint may be at the end of its torque.
const BEYOND: [f64; 3] = [0.0, 10.0, 50.0];
/// Distances in which what was found near is run.
const NEAR_RUNS: usize = 2;
/// Places anywhere that are run.
const FAR_RUNS: usize = 3;
/// Places anywhere that are tried at a time, and at most.
const AT_A_TIME: usize = 8;
const MOST: usize = 72;
/// Changes of the tool's lean, the smallest first [deg].
const LEANS: [f64; 10] = [
    5.0, -5.0, 10.0, -10.0, 20.0, -20.0, 30.0, -30.0, 45.0, -45.0,
];
/// Leans that are run.
const LEAN_RUNS: usize = 3;
/// Largest lean of a scenario [deg].
const MOST_LEAN: f64 = 60.0;
/// Distances by which the base is moved [m].
const BASE_WAYS: [f64; 4] = [0.1, 0.3, 0.6, 1.0];

/// The shortest way found of the part at the end of which the job can be done.
pub(super) fn moved(trial: &Trial<'_>, setup: &Setup) -> Option<Remedy> {
    let stance = setup.stance();
    moved_little(trial, setup, &stance).or_else(|| {
        let stances = anywhere(setup, &stance, false);
        among(trial, setup, &stances, Kind::PartMoved)
    })
}

/// A place and rotation of the part at which the job can be done.
pub(super) fn turned(trial: &Trial<'_>, setup: &Setup) -> Option<Remedy> {
    let stances = anywhere(setup, &setup.stance(), true);
    among(trial, setup, &stances, Kind::PartTurned)
}

fn moved_little(trial: &Trial<'_>, setup: &Setup, stance: &Stance) -> Option<Remedy> {
    let directions = directions(setup, stance);
    let (mut shorter, mut runs) = (0.0, 0);
    for distance in DISTANCES {
        let tried: Vec<_> = directions
            .iter()
            .filter(|&&way| may_reach(setup, &along(stance, way, distance)))
            .copied()
            .collect();
        if !tried.is_empty() && !trial.may_outline(tried.len()) {
            return None;
        }
        let found = tried.par_iter().find_map_first(|&direction| {
            let there = along(stance, direction, distance);
            setup.outline(&there).is_ok().then_some(direction)
        });
        if let Some(direction) = found {
            let way = shortest(setup, stance, direction, [shorter, distance]);
            for beyond in BEYOND {
                let there = along(stance, direction, way + beyond);
                if setup.is_possible(&there)
                    && let Some(remedy) = tried_at(trial, setup, &there, Kind::PartMoved)
                {
                    return Some(remedy);
                }
            }
            runs += 1;
            if runs == NEAR_RUNS {
                return None;
            }
        }
        shorter = distance;
    }
    None
}

/// The first of several stances, in their order, at which the job can be done.
fn among(trial: &Trial<'_>, setup: &Setup, stances: &[Stance], kind: Kind) -> Option<Remedy> {
    let mut runs = 0;
    for some in stances.chunks(AT_A_TIME) {
        if !trial.may_outline(some.len()) {
            return None;
        }
        let possible: Vec<&Stance> = some
            .par_iter()
            .filter(|there| setup.outline(there).is_ok() && setup.is_possible(there))
            .collect();
        for there in possible {
            if let Some(remedy) = tried_at(trial, setup, there, kind) {
                return Some(remedy);
            }
            runs += 1;
            if runs == FAR_RUNS {
                return None;
            }
        }
    }
    None
}

/// The part at a stance, if check and run pass there.
fn tried_at(trial: &Trial<'_>, setup: &Setup, there: &Stance, kind: Kind) -> Option<Remedy> {
    let edits = pose_edits(there.world_from_part, kind == Kind::PartTurned);
    let friction = held_back(&setup.scenario);
    trial.passes(&edits, friction).then(|| {
        let own = setup.stance().world_from_part.translation;
        let way = there.world_from_part.translation - own;
        let turned = match kind {
            Kind::PartTurned => " and turned",
            _ => "",
        };
        Remedy {
            kind: kind.name(),
            words: format!("the part moved by ({}) mm{turned}", listed(way)),
            edits,
        }
    })
}

/// Keys of the part's pose.
#[must_use]
pub fn pose_edits(world_from_part: DPose3, turned: bool) -> Vec<KeyValue> {
    let place = format!("[{}]", listed(world_from_part.translation));
    let mut edits = vec![KeyValue::typed("workpiece.position_mm", &place)];
    if turned {
        let [roll, pitch, yaw] = angles(world_from_part.rotation);
        let value = format!("[{roll}, {pitch}, {yaw}]");
        edits.push(KeyValue::typed("workpiece.rotation_deg", &value));
    }
    edits
}

/// Roll, pitch, yaw to a hundredth of a degree [deg].
fn angles(rotation: DQuat) -> [f64; 3] {
    let (yaw, pitch, roll) = rotation.to_euler(EulerRot::ZYX);
    [roll, pitch, yaw].map(|angle| (100.0 * angle.to_degrees()).round() / 100.0 + 0.0)
}

/// A place in millimetres, to a tenth.
fn listed(place: DVec3) -> String {
    let [x, y, z] = (place * 1e4).to_array().map(|v| v.round() / 10.0 + 0.0);
    format!("{x}, {y}, {z}")
}

/// A pose as a scenario's file holds it: a tenth of a millimetre, a hundredth of a degree.
fn as_written(pose: DPose3, turned: bool) -> DPose3 {
    let place = (pose.translation * 1e4).round() / 1e4;
    if !turned {
        return DPose3::from_parts(place, pose.rotation);
    }
    let [roll, pitch, yaw] = angles(pose.rotation).map(f64::to_radians);
    DPose3::from_parts(place, DQuat::from_euler(EulerRot::ZYX, yaw, pitch, roll))
}

/// The stance with the part a distance [mm] along a direction, as a file holds it.
fn along(stance: &Stance, direction: DVec3, distance: f64) -> Stance {
    let own = stance.world_from_part;
    let place = own.translation + 1e-3 * distance * direction;
    Stance {
        world_from_part: as_written(DPose3::from_parts(place, own.rotation), false),
        ..*stance
    }
}

/// Ways that are tried: straight up and down, along the world's axes, to and from the robot's base.
fn directions(setup: &Setup, stance: &Stance) -> Vec<DVec3> {
    let to_base = base(setup) - middle(setup, stance.world_from_part);
    let level = DVec3::new(to_base.x, to_base.y, 0.0).normalize_or_zero();
    let mut directions = vec![level, -level, DVec3::Z, -DVec3::Z];
    for axis in [DVec3::X, DVec3::Y] {
        for direction in [axis, -axis] {
            if directions.iter().all(|other| other.dot(direction) < 0.99) {
                directions.push(direction);
            }
        }
    }
    directions.retain(|direction| *direction != DVec3::ZERO);
    directions
}

fn base(setup: &Setup) -> DVec3 {
    setup.scenario.arm.world_from_base.translation
}

/// Middle of the followed edge in the world [m].
fn middle(setup: &Setup, world_from_part: DPose3) -> DVec3 {
    let edge = &setup.part.edge;
    world_from_part.transform_point(edge.at(0.5 * edge.length).point)
}

/// Whether no point of the edge is farther from the arm than arm and device are long.
fn may_reach(setup: &Setup, stance: &Stance) -> bool {
    const LOOKS: usize = 8;
    let nominal = &setup.scenario.nominal;
    let mounting = &nominal.mounting;
    let tool = mounting.tool_centre + nominal.device.full_stroke + mounting.tool_radius;
    let first = setup.arm.chain.joints.first();
    let shoulder = first.map_or(DVec3::ZERO, |joint| joint.parent_from_joint.translation);
    let shoulder = setup.scenario.arm.world_from_base.transform_point(shoulder);
    let reach = setup.arm.chain.reach() + tool;
    let edge = &setup.part.edge;
    (0..=LOOKS).all(|look| {
        let point = edge.at(edge.length * look as f64 / LOOKS as f64).point;
        let point = stance.world_from_part.transform_point(point);
        point.distance(shoulder) < reach
    })
}

/// The shortest distance [mm], whole or to a tenth below 10, between one at which it cannot and one at which it can be done.
fn shortest(setup: &Setup, stance: &Stance, direction: DVec3, [no, yes]: [f64; 2]) -> f64 {
    const STEPS: usize = 5;
    let (mut no, mut yes) = (no, yes);
    for _ in 0..STEPS {
        let middle = 0.5 * (no + yes);
        let middle = if middle < 10.0 {
            (middle * 10.0).round() / 10.0
        } else {
            middle.round()
        };
        if middle <= no || middle >= yes {
            break;
        }
        if setup.outline(&along(stance, direction, middle)).is_ok() {
            yes = middle;
        } else {
            no = middle;
        }
    }
    yes
}

/// Stances all about the robot, the nearest to the part's own first; with the part turned about the vertical, and so that its edge faces the robot, if asked for.
#[must_use]
pub fn anywhere(setup: &Setup, stance: &Stance, turned: bool) -> Vec<Stance> {
    let reach = setup.arm.chain.reach();
    let base = base(setup);
    let own = stance.world_from_part;
    let from_base = middle(setup, own) - base;
    let azimuth = from_base.y.atan2(from_base.x);
    let (shares, heights, azimuths): (&[f64], &[f64], &[f64]) = if turned {
        (&[0.55, 0.42, 0.7], &[0.25, 0.1, 0.45], &[0.0])
    } else {
        (
            &[0.3, 0.42, 0.55, 0.7, 0.85],
            &[-0.15, 0.0, 0.1, 0.25, 0.45],
            &[0.0, 45.0, -45.0, 90.0, -90.0, 180.0],
        )
    };
    let mut found = Vec::new();
    for (share, height, aside) in places(shares, heights, azimuths) {
        let (sin, cos) = (azimuth + aside.to_radians()).sin_cos();
        let outward = DVec3::new(cos, sin, 0.0);
        let target = base + outward * (share * reach) + DVec3::Z * (height * reach);
        let rotations = if turned {
            rotations(setup, own.rotation, outward)
        } else {
            vec![own.rotation]
        };
        for rotation in rotations {
            let rotation = as_written(DPose3::from_rotation(rotation), turned).rotation;
            let there = DPose3::from_rotation(rotation);
            let place = target - middle(setup, there);
            let world_from_part = as_written(DPose3::from_parts(place, rotation), turned);
            found.push(Stance {
                world_from_part,
                ..*stance
            });
        }
    }
    if !turned {
        let far = |there: &Stance| there.world_from_part.translation.distance(own.translation);
        found.sort_by(|a, b| far(a).total_cmp(&far(b)));
    }
    found.retain(|there| may_reach(setup, there));
    found.truncate(MOST);
    found
}

/// All combinations, the first of each list first.
fn places(shares: &[f64], heights: &[f64], azimuths: &[f64]) -> Vec<(f64, f64, f64)> {
    let mut all = Vec::new();
    for &aside in azimuths {
        for &share in shares {
            for &height in heights {
                all.push((share, height, aside));
            }
        }
    }
    all
}

/// Rotations of the part: its own about the vertical such that the edge faces the robot, then otherwise; then the edge aslant above, facing the robot.
fn rotations(setup: &Setup, own: DQuat, outward: DVec3) -> Vec<DQuat> {
    let edge = &setup.part.edge;
    let bisector = own * edge.at(0.5 * edge.length).bisector;
    let facing = bisector.y.atan2(bisector.x);
    let wanted = (-outward.y).atan2(-outward.x);
    let level = bisector.truncate().length() > 1e-6;
    let first = if level { wanted - facing } else { 0.0 };
    let turns = [0.0, 90.0, -90.0, 180.0].map(|turn: f64| first + turn.to_radians());
    let upright = turns.map(|turn| DQuat::from_rotation_z(turn) * own);
    let mut all = upright.to_vec();
    all.extend(edge_towards_robot(setup, outward));
    all
}

/// Rotations of the part in which the middle of its edge lies level across a direction that leads away from the robot, its bisector half up and half back to it.
#[must_use]
fn edge_towards_robot(setup: &Setup, outward: DVec3) -> Vec<DQuat> {
    let edge = &setup.part.edge;
    let at = edge.at(0.5 * edge.length);
    let tangent = (at.tangent - at.bisector * at.tangent.dot(at.bisector)).normalize_or(DVec3::X);
    let own = DMat3::from_cols(tangent, at.bisector, tangent.cross(at.bisector));
    let bisector = (DVec3::Z - outward).normalize_or(DVec3::Z);
    let across = DVec3::Z.cross(outward).normalize_or(DVec3::Y);
    [across, -across]
        .map(|tangent| {
            let wanted = DMat3::from_cols(tangent, bisector, tangent.cross(bisector));
            DQuat::from_mat3(&(wanted * own.transpose())).normalize()
        })
        .to_vec()
}

/// The nominal pose moved to the actual one, as if it had been measured.
pub(super) fn located(trial: &Trial<'_>, setup: &Setup) -> Option<Remedy> {
    let nominal = setup.scenario.workpiece.world_from_part;
    let edge = &setup.part.edge;
    let bisector = nominal.rotation * edge.at(0.5 * edge.length).bisector;
    let shift = setup.scenario.workpiece.misplacement.shift;
    let place = nominal.translation + bisector * shift;
    let mut edits = pose_edits(DPose3::from_parts(place, nominal.rotation), false);
    edits.push(KeyValue::number("workpiece.misplacement.shift_mm", 0.0));
    let friction = held_back(&setup.scenario);
    trial.passes(&edits, friction).then(|| Remedy {
        kind: Kind::Located.name(),
        words: "the part located anew, without its shift".to_owned(),
        edits,
    })
}

/// A place of the robot's base at which the job can be done.
pub(super) fn base_moved(trial: &Trial<'_>, setup: &Setup) -> Option<Remedy> {
    let stance = setup.stance();
    let own = base(setup);
    let to_part = middle(setup, stance.world_from_part) - own;
    let level = DVec3::new(to_part.x, to_part.y, 0.0).normalize_or(DVec3::X);
    let ways = [level, -level, DVec3::Z, -DVec3::Z];
    let friction = held_back(&setup.scenario);
    for far in BASE_WAYS {
        for way in ways {
            let place = own + far * way;
            let list = format!("[{}]", listed(place));
            let edits = vec![KeyValue::typed("arm.base_position_mm", &list)];
            if trial.passes(&edits, friction) {
                return Some(Remedy {
                    kind: Kind::BaseMoved.name(),
                    words: format!("the robot's base moved by ({}) mm", listed(place - own)),
                    edits,
                });
            }
            if trial.is_over() {
                return None;
            }
        }
    }
    None
}

/// A lean near the scenario's at which the job can be done.
pub(super) fn leaned(trial: &Trial<'_>, setup: &Setup) -> Option<Remedy> {
    let stance = setup.stance();
    let ToolAxis::Lean(own) = stance.tool_axis else {
        return None;
    };
    // In whole degrees, as they are written.
    let leans = LEANS.map(|change| (own.to_degrees() + change).round() + 0.0);
    let leans: Vec<f64> = leans
        .into_iter()
        .filter(|lean| lean.abs() <= MOST_LEAN)
        .collect();
    if !trial.may_outline(leans.len()) {
        return None;
    }
    let possible: Vec<f64> = leans
        .into_par_iter()
        .filter(|lean| {
            let tool_axis = ToolAxis::Lean(lean.to_radians());
            setup.is_possible(&Stance {
                tool_axis,
                ..stance
            })
        })
        .collect();
    let friction = held_back(&setup.scenario);
    let edits = |lean: f64| vec![KeyValue::number("process.lean_deg", lean)];
    let mut possible = possible.into_iter().take(LEAN_RUNS).map(edits);
    let edits = possible.find(|edits| trial.passes(edits, friction))?;
    Some(Remedy {
        kind: Kind::Lean.name(),
        words: "the tool leaned".to_owned(),
        edits,
    })
}

/// A roll, in place of the one that is given, at which the job can be done.
pub(super) fn rolled(trial: &Trial<'_>, setup: &Setup) -> Option<Remedy> {
    let free = Stance {
        roll: None,
        ..setup.stance()
    };
    if !trial.may_outline(1) {
        return None;
    }
    let roll = setup.tried(&free, Plan::new).ok()?.roll.to_degrees();
    let roll = (10.0 * roll).round() / 10.0 + 0.0;
    let edits = vec![KeyValue::number("process.roll_deg", roll)];
    trial
        .passes(&edits, held_back(&setup.scenario))
        .then(|| Remedy {
            kind: Kind::Roll.name(),
            words: "the flange turned about the tool's axis".to_owned(),
            edits,
        })
}
