//! Work against precision: error over cost of the cell at several steps, and of MuJoCo on the same arm and path.
//!
//! Each is held against its own run at 0.05 ms while the edge is followed: 90th percentile of the joints' angles and of the position of the ball's centre. MuJoCo
//! has no pneumatics: its slide is driven by the device's force as the cell's finest run has recorded it, and it takes the best of its integrators at each step.

use std::error::Error;

use glam::DVec3;
use glamx::DPose3;
use idc_cell::arm::chain::MAX_JOINTS;
use idc_cell::arm::kinematics::link_poses;
use idc_cell::cell::Cell;
use idc_cell::recording::Recording;
use idc_cell::recording::schema::{self, JointSignal, joint_quantity};
use idc_cell::stats::quantile;

use crate::job::{self, Following, follow_span};
use crate::peer::Peer;
use crate::{median, per_step_of};

/// Steps of the cell [s].
const STEPS: [f64; 6] = [0.25e-3, 0.5e-3, 1e-3, 2e-3, 4e-3, 8e-3];
/// Step of today's samples, at whose error cells and MuJoCo are compared [s].
const USUAL: f64 = 1e-3;
/// Steps of MuJoCo [s].
const PEER_STEPS: [f64; 5] = [0.25e-3, 0.5e-3, 1e-3, 2e-3, 4e-3];
/// Step of the runs that errors are taken against [s].
const FINEST: f64 = 5e-5;
/// Time from the start of following over which errors are taken [s].
const SPAN: f64 = 12.0;
/// Times at which runs are compared are so far apart [s].
const APART: f64 = 8e-3;
/// The same of the record that MuJoCo is given [s].
const RECORD_APART: f64 = 0.5e-3;
/// Simulated time of one measurement of cost [s], and how many there are.
const TIMED: (f64, usize) = (4.0, 5);

/// A point of the picture.
struct Point {
    name: String,
    step: f64,
    /// Time that a simulated second takes [s].
    cost: f64,
    /// Error of the joints [rad] and of the ball's centre [m].
    error: [f64; 2],
    /// Steps for one in which the mass matrix was taken anew.
    held: f64,
}

/// The cell of a scenario at a step [s], of which at most so many pass for one of Rapier's.
fn cell_at(name: &str, step: f64, arm_steps: Option<usize>) -> Result<Cell, Box<dyn Error>> {
    let mut scenario = job::scenario(name)?;
    scenario.simulation.step = step;
    if let Some(arm_steps) = arm_steps {
        scenario.simulation.arm_steps = arm_steps;
    }
    Ok(Cell::new(scenario)?)
}

/// The whole job, which must be done to its end.
fn run(cell: &Cell) -> Result<(Recording, f64), Box<dyn Error>> {
    let run = cell.run(&mut |_| ())?;
    match run.stop {
        None => Ok((run.recording, run.steps_per_mass_matrix)),
        Some(stop) => Err(stop.to_string().into()),
    }
}

/// Rows of a recording at times from the start of following on [s] so far apart.
fn rows(cell: &Cell, recording: &Recording, apart: f64) -> Vec<usize> {
    let step = cell.setup.scenario.simulation.step;
    let first = (follow_span(cell).0 / APART).ceil() as usize;
    let count = (SPAN / apart) as usize;
    let row = |i: usize| ((first as f64 * APART + i as f64 * apart) / step).round() as usize - 1;
    (0..=count)
        .map(row)
        .filter(|row| *row < recording.sample_count())
        .collect()
}

/// Angles of the joints [rad] and the ball's centre [m] at the times of comparison.
fn course(cell: &Cell, recording: &Recording) -> (Vec<Vec<f64>>, Vec<DVec3>) {
    let chain = cell.setup.bodies();
    let joints = chain.len() - 1;
    let channel = |name: &str| recording.values(name).expect("every cell records it");
    let names: Vec<String> = (1..=joints)
        .map(|joint| joint_quantity(joint, JointSignal::Position))
        .collect();
    let angles: Vec<&[f64]> = names.iter().map(|name| channel(name)).collect();
    let stroke = channel(schema::STROKE);
    let base = cell.setup.scenario.arm.world_from_base;
    let centre = DVec3::Z * cell.setup.actual.mounting.tool_centre;
    let rows = rows(cell, recording, APART);
    let at = |row: usize| -> Vec<f64> { angles.iter().map(|angle| angle[row]).collect() };
    let tip = |row: usize| {
        let mut position = at(row);
        position.push(stroke[row]);
        let mut links = [DPose3::IDENTITY; MAX_JOINTS];
        link_poses(&chain, base, &position, &mut links[..=joints]);
        links[joints].transform_point(centre)
    };
    (
        rows.iter().map(|row| at(*row)).collect(),
        rows.iter().map(|row| tip(*row)).collect(),
    )
}

/// 90th percentiles of the distances of two courses.
fn errors(one: &(Vec<Vec<f64>>, Vec<DVec3>), other: &(Vec<Vec<f64>>, Vec<DVec3>)) -> [f64; 2] {
    let joints = one.0.iter().flatten().zip(other.0.iter().flatten());
    let tips = one.1.iter().zip(&other.1);
    let joints = quantile(joints.map(|(a, b)| (a - b).abs()), 0.9);
    let tips = quantile(tips.map(|(a, b)| a.distance(*b)), 0.9);
    [joints, tips].map(|error| error.expect("following takes time"))
}

/// Draws error over cost of a scenario's cell and of MuJoCo.
pub fn compare(name: &str) -> Result<(), Box<dyn Error>> {
    let finest = cell_at(name, FINEST, None)?;
    let (recording, _) = run(&finest)?;
    let truth = course(&finest, &recording);
    let mut ours = Vec::new();
    let several = STEPS.map(|step| ("cell", step, None));
    let each = STEPS.map(|step| ("cell, Rapier each step", step, Some(1)));
    for (kind, step, arm_steps) in several.into_iter().chain(each) {
        let cell = cell_at(name, step, arm_steps)?;
        let (recording, held) = run(&cell)?;
        let course = course(&cell, &recording);
        let mut following = Following::new(&cell);
        let steps = (TIMED.0 / step) as usize;
        let mut costs: Vec<f64> = (0..TIMED.1)
            .map(|_| per_step_of(following.run(steps, None), steps) / step)
            .collect();
        ours.push(Point {
            name: kind.to_owned(),
            step,
            cost: median(&mut costs),
            error: errors(&course, &truth),
            held,
        });
    }
    let forces = recording
        .values(schema::DEVICE_FORCE)
        .expect("every cell records it");
    let record: Vec<f64> = rows(&finest, &recording, RECORD_APART)
        .into_iter()
        .map(|row| forces[row])
        .collect();
    println!("\n{name}, following, error over cost against the own run at 0.05 ms");
    draw(&ours);
    let usual = ours.iter().find(|point| point.step == USUAL);
    let cell = job::cell(name)?;
    match Peer::led(&cell, &record, RECORD_APART) {
        Err(reason) => println!("MuJoCo: not measured; {reason}"),
        Ok(mut peer) => {
            let theirs = peer.precision(&PEER_STEPS, FINEST, APART)?;
            let theirs: Vec<Point> = theirs
                .into_iter()
                .map(|point| Point {
                    name: format!("MuJoCo {}", point.integrator),
                    step: point.step,
                    cost: point.cost,
                    error: [point.joints, point.tip],
                    held: 1.0,
                })
                .collect();
            draw(&theirs);
            if let Some(usual) = usual {
                at_equal_error(usual, &theirs);
            }
        }
    }
    Ok(())
}

fn draw(points: &[Point]) {
    println!(
        "{:<28} {:>8} {:>14} {:>14} {:>12} {:>8}",
        "", "step ms", "us/s simulated", "joints rad", "tip m", "steps/M"
    );
    for point in points {
        let (step, cost) = (point.step * 1e3, point.cost * 1e6);
        let [joints, tip] = point.error;
        println!(
            "{:<28} {step:>8.2} {cost:>14.0} {joints:>14.3e} {tip:>12.3e} {:>8.1}",
            point.name, point.held
        );
    }
}

/// Cost of MuJoCo's best at the errors of a point, between its steps by the lines that the picture would draw.
fn at_equal_error(usual: &Point, theirs: &[Point]) {
    for (which, name) in ["joints", "tip"].into_iter().enumerate() {
        let wanted = usual.error[which];
        let mut best: Option<(f64, &str)> = None;
        for pair in theirs
            .windows(2)
            .filter(|pair| pair[0].name == pair[1].name)
        {
            let [fine, coarse] = [&pair[0], &pair[1]];
            let (low, high) = (fine.error[which], coarse.error[which]);
            if !(low <= wanted && wanted <= high) {
                continue;
            }
            let share = (wanted / low).ln() / (high / low).ln();
            let cost = fine.cost * (coarse.cost / fine.cost).powf(share);
            if best.is_none_or(|(least, _)| cost < least) {
                best = Some((cost, &fine.name));
            }
        }
        // Where even its largest step errs less, that one is its cheapest.
        for point in theirs.iter().filter(|point| point.error[which] <= wanted) {
            if best.is_none_or(|(least, _)| point.cost < least) {
                best = Some((point.cost, &point.name));
            }
        }
        match best {
            Some((cost, peer)) => println!(
                "at the cell's error of {name} at {} ms, {wanted:.3e}: cell {:.0} us, {peer} {:.0} us a simulated second, {:.2} times the cell's",
                usual.step * 1e3,
                usual.cost * 1e6,
                cost * 1e6,
                cost / usual.cost
            ),
            None => println!("no step of MuJoCo has so small an error of {name} as {wanted:.3e}"),
        }
    }
}
