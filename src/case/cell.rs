//! A case of a cell: a folder with recordings alone, files of a real cell or folders of runs of this program. What lacks measured columns, or is named
//! `predict`, is to be predicted.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::arm_prediction::arm_prediction;
use super::cell_drives::CellDrives;
use super::error::CaseError;
use super::explanations::whole;
use super::recordings::{SAMPLES, is_run};
use crate::diagnosis::answer::details::PredictionError;
use crate::diagnosis::experiment::ride::{ArmCommands, ArmReach, Course};
use crate::diagnosis::fit::free::{Free, Prior};
use crate::diagnosis::joints::friction::{DriveLoad, JointFriction, joint_friction};
use crate::diagnosis::joints::servo::{Axes, ServoLink, pushed_servo_link, servo_link};
use crate::diagnosis::recordings::input::{DiagnosisInput, NamedRecording, tolerated};
use crate::diagnosis::recordings::recorded::{QUANTITIES, Recorded, RecordedError, check, hold};
use crate::effects::{CATALOGUE, CELL_EFFECTS, Coordinate, Effect, JOINT_EFFECTS, sought};
use crate::plant::{CHANNELS, InitialState, PlantInputs, PlantParameters, Quantity, registry};
use crate::recording::csv::{CellRecording, read_cell_csv};
use crate::recording::samples::{cell_recording, read_table};
use crate::replay::{Drive, LoadedCell};
use crate::scenario::RecordedCell;

/// Name of a recording that is to be predicted, whatever it holds.
const PREDICT: &str = "predict";
/// Noise of a channel that cells do not have: nothing is as much.
const UNMEASURED: f64 = 1e9;

/// Samples next to one that touches which may touch too.
const HELD: usize = 2;
/// Time after the first touch in which an arm swings faster than its encoders are sampled [s].
const STRUCK: f64 = 0.1;

/// A case of a cell, with what its servos were found to do.
pub(super) struct CellCase {
    pub input: DiagnosisInput,
    /// Commands and encoders of the first recording.
    pub axes: Option<Axes>,
    pub servo: Option<ServoLink>,
    /// Friction of the joints, from their drives' torques.
    pub frictions: Vec<JointFriction>,
    /// Drives and wrench, where the cell names an arm file.
    pub arm: Option<CellDrives>,
    /// Errors of what is said of the arm in the recording that is to be predicted.
    pub of_arm: Vec<PredictionError>,
    /// Where the arm went in its recordings while the device pressed.
    courses: Vec<Course>,
    /// Bandwidth of the servos [Hz].
    bandwidth: f64,
}

impl CellCase {
    /// How far an experiment may move the arm; none where it stood still in all recordings.
    pub fn arm_reach(&self, cell: &LoadedCell) -> Option<ArmReach> {
        let limits = &cell.scenario.limits;
        let (of_replay, bandwidth) = (cell.clone(), self.bandwidth);
        let replay = move |commands: ArmCommands| inputs(&of_replay, commands, None, bandwidth);
        let reach = ArmReach::new(self.courses.clone(), limits.joint_motion, Arc::new(replay))?;
        let Some(torques) = limits.joint_torque.clone() else {
            return Some(reach);
        };
        let cell = cell.clone();
        let share =
            move |plant: &PlantParameters, inputs: &PlantInputs, touched: (&[f64], &[f64])| {
                let friction = &plant.cell.joint_friction;
                let trajectory = inputs.cell.as_ref();
                trajectory.map_or(0.0, |own| {
                    cell.torque_share(own, touched, friction, &torques)
                })
            };
        Some(reach.with_torques(Arc::new(share)))
    }
}

/// Name, file and content.
type Named = (String, String, CellRecording);

/// Whether this is a folder with recordings.
pub fn is_cell_case(folder: &Path) -> bool {
    folder.is_dir() && !recordings(folder).is_empty()
}

fn recordings(folder: &Path) -> Vec<PathBuf> {
    if folder.is_file() {
        return vec![folder.to_owned()];
    }
    let own = folder.join(SAMPLES);
    if own.is_file() {
        return vec![own];
    }
    let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
    let recording = |path: PathBuf| {
        let run = path.join(SAMPLES);
        if run.is_file() {
            return Some(run);
        }
        let csv = path.is_file() && path.extension().is_some_and(|e| e == "csv");
        csv.then_some(path)
    };
    let mut files: Vec<PathBuf> = entries
        .filter_map(|entry| recording(entry.path()))
        .collect();
    files.sort();
    files
}

/// Name of a recording: its file's, of a run its folder's.
fn name_of(path: &Path) -> String {
    let named = if is_run(path) { path.parent() } else { None };
    let name = named.unwrap_or(path).file_name().unwrap_or_default();
    name.display().to_string()
}

fn read_one(cell: &LoadedCell, path: &Path) -> Result<CellRecording, CaseError> {
    let joints = cell.joints.len();
    if !is_run(path) {
        return Ok(read_cell_csv(path, joints)?);
    }
    let scenario = &cell.scenario;
    let atmosphere = scenario.nominal.device.gas.atmosphere;
    let samples = read_table(path)?;
    let taken = cell_recording(&samples, joints, scenario.sample_rate, atmosphere);
    taken.map_err(|source| {
        CaseError::from(RecordedError::Missing {
            file: path.display().to_string(),
            source: Box::new(source),
        })
    })
}

/// A recording by what a user names: a file, or the folder of a run.
fn named_by_user(path: &Path) -> (String, PathBuf) {
    let run = path.join(SAMPLES);
    let file = if run.is_file() { run } else { path.to_owned() };
    (whole(path).display().to_string(), file)
}

/// The recordings of a folder with those beside them, and the one in which nothing was measured.
fn known_and_unseen(
    cell: &LoadedCell,
    folder: &Path,
    added: &[PathBuf],
) -> Result<(Vec<Named>, Option<Named>), CaseError> {
    let mut known = Vec::new();
    let mut unseen = Vec::new();
    let own = recordings(folder).into_iter();
    let own = own.map(|path| (name_of(&path), path));
    for (name, path) in own.chain(added.iter().map(|path| named_by_user(path))) {
        let recording = read_one(cell, &path)?;
        let is_unseen = recording.readings.is_empty() || name == PREDICT;
        let named = (name, path.display().to_string(), recording);
        if is_unseen {
            unseen.push(named);
        } else {
            known.push(named);
        }
    }
    if known.is_empty() {
        return Err(CaseError::NothingMeasured {
            folder: folder.display().to_string(),
        });
    }
    if let [_, second, ..] = &unseen[..] {
        return Err(CaseError::TwoUnseen {
            file: second.1.clone(),
            first: unseen[0].0.clone(),
        });
    }
    Ok((known, unseen.pop()))
}

fn file_of((name, file, _): &Named) -> (&str, &Path) {
    (name, Path::new(file))
}

/// Reads a case.
pub(super) fn read(
    cell: &LoadedCell,
    folder: &Path,
    added: &[PathBuf],
) -> Result<CellCase, CaseError> {
    let (known, mut unseen) = known_and_unseen(cell, folder, added)?;
    let scenario = &cell.scenario;
    let axes = all_axes(&known);
    let (noise, bandwidth) = (scenario.joint_noise, scenario.nominal.cell.servo_bandwidth);
    let servo = if scenario.observed.motors_by_encoders {
        let own = scenario.arm.servo.natural_frequency;
        pushed_servo_link(&axes, noise, bandwidth, own)
    } else {
        servo_link(&axes, noise, bandwidth)
    };
    let mut nominal = cell.plant();
    let own = sought(&mut nominal);
    let shown = servo.as_ref().and_then(|servo| servo.shown(&nominal));
    let bandwidth = match (&servo, &shown) {
        (Some(servo), Some(_)) => servo.bandwidth,
        _ => scenario.nominal.cell.servo_bandwidth,
    };
    let files: Vec<(&str, &Path)> = known.iter().map(file_of).collect();
    let arm = CellDrives::read(cell, &files, unseen.as_ref().map(file_of))?;
    // An arm file says more of the drives than their dry friction.
    let frictions = match arm {
        Some(_) => Vec::new(),
        None => frictions(cell, &known, &nominal),
    };
    let of_arm = unseen.as_ref().map(|(name, _, recording)| {
        let drives = drives(cell, recording);
        arm_prediction(cell, name, recording, servo.as_ref(), &frictions, &drives)
    });
    if let Some((_, _, recording)) = &mut unseen {
        // Where the motors went is to be predicted too.
        recording.encoders.fill(None);
    }
    let courses = courses(&known);
    let mut named = |(name, file, recording): (String, String, CellRecording)| {
        recorded(cell, &file, recording, bandwidth).map(|recorded| NamedRecording {
            name,
            file,
            recorded,
        })
    };
    let recordings = known
        .into_iter()
        .map(&mut named)
        .collect::<Result<_, _>>()?;
    let unseen = unseen.map(&mut named).transpose()?;
    let [pressure, stroke, force] = scenario.noise;
    Ok(CellCase {
        input: DiagnosisInput {
            tolerated: tolerated_numbers(cell, &nominal),
            nominal: nominal.clone(),
            noise: [pressure, stroke, force, UNMEASURED],
            recordings,
            unseen,
            candidates: candidates(cell).into_iter().chain(own).collect(),
            shown: shown
                .into_iter()
                .chain(frictions.iter().filter_map(|f| f.shown(&nominal)))
                .collect(),
            tried: None,
            data_faults: Vec::new(),
            limits: scenario.limits.clone(),
            kept: Vec::new(),
            rate: scenario.sample_rate,
        },
        axes: axes.into_iter().next(),
        servo,
        frictions,
        arm,
        of_arm: of_arm.unwrap_or_default(),
        courses,
        bandwidth,
    })
}

/// Where the arm went while the device pressed.
fn courses(known: &[Named]) -> Vec<Course> {
    let course = |(name, _, recording): &Named| {
        let mut commands = commands(recording);
        hold(&mut commands.set_pressure);
        Course::of(name, &commands)
    };
    known.iter().filter_map(course).collect()
}

/// What the arm is commanded in a recording.
fn commands(recording: &CellRecording) -> ArmCommands {
    ArmCommands {
        time: recording.time.clone(),
        path: recording.path.clone(),
        joints: recording.commands.clone(),
        set_pressure: recording.set_pressure.clone(),
    }
}

/// Inputs of the plant by what the arm is commanded, and where its encoders say that it went.
fn inputs(
    cell: &LoadedCell,
    commands: ArmCommands,
    encoders: Option<&[Option<Vec<f64>>]>,
    bandwidth: f64,
) -> PlantInputs {
    let ArmCommands {
        time,
        path,
        joints,
        set_pressure,
    } = commands;
    let trajectory = cell.trajectory_of(&time, &path, &joints, encoders, bandwidth);
    PlantInputs {
        set_pressure,
        extends: vec![true; time.len()],
        surface: trajectory.contact_kinematics(&cell.plant().cell).surface(),
        cell: Some(Arc::new(trajectory)),
        motion: None,
        initial: InitialState::AtRest,
        place: 0,
        time,
    }
}

/// Friction of each joint by the drives' torques, where they were recorded.
fn frictions(cell: &LoadedCell, known: &[Named], nominal: &PlantParameters) -> Vec<JointFriction> {
    let joints = cell.joints.len();
    let mut loads: Vec<Vec<DriveLoad>> = vec![Vec::new(); joints];
    for (_, _, recording) in known {
        for (loads, load) in loads.iter_mut().zip(drives(cell, recording)) {
            loads.push(load);
        }
    }
    let tolerance = cell.scenario.tolerance;
    let of = |joint: usize| {
        let nominal = nominal.cell.joint_friction[joint];
        joint_friction(joint, &loads[joint], nominal, tolerance)
    };
    (0..joints).filter_map(of).collect()
}

/// The drives' torques in a recording; none where they, stroke or force were not recorded.
fn drives(cell: &LoadedCell, recording: &CellRecording) -> Vec<DriveLoad> {
    let reading = |quantity: &str| {
        let found = recording
            .readings
            .iter()
            .find(|(name, _)| *name == quantity);
        found.map(|(_, values)| values)
    };
    let [_, stroke, force, _] = QUANTITIES.map(reading);
    let (Some(stroke), Some(force)) = (stroke, force) else {
        return Vec::new();
    };
    if recording.torques.iter().any(Option::is_none) {
        return Vec::new();
    }
    let trajectory = cell.trajectory_of(
        &recording.time,
        &recording.path,
        &recording.commands,
        Some(&recording.encoders),
        cell.scenario.nominal.cell.servo_bandwidth,
    );
    let drives = cell.drives(&trajectory, &recording.torques, stroke, force);
    let load = |drive: Drive| DriveLoad {
        torque: drive.torque,
        expected: drive.expected,
        rate: drive.rate,
        rated: drive.rated,
        contact: drive.contact,
    };
    drives.into_iter().flatten().map(load).collect()
}

fn all_axes(known: &[Named]) -> Vec<Axes> {
    let of = |(_, _, recording): &Named| Axes {
        time: recording.time.clone(),
        commands: recording.commands.clone(),
        encoders: recording.encoders.clone(),
    };
    known.iter().map(of).collect()
}

fn recorded(
    cell: &LoadedCell,
    file: &str,
    recording: CellRecording,
    bandwidth: f64,
) -> Result<Recorded, CaseError> {
    let scenario = &cell.scenario;
    let CellRecording {
        time,
        path,
        commands: joints,
        encoders,
        mut set_pressure,
        readings,
        ..
    } = recording;
    let filled = hold(&mut set_pressure);
    let commands = ArmCommands {
        time,
        path,
        joints,
        set_pressure,
    };
    let inputs = inputs(cell, commands, Some(&encoders), bandwidth);
    check(file, &inputs)?;
    let nothing = vec![f64::NAN; inputs.time.len()];
    let mut readings = QUANTITIES.map(|quantity| {
        let found = readings.iter().find(|(name, _)| *name == quantity);
        found.map_or_else(|| nothing.clone(), |(_, values)| values.clone())
    });
    let pressed = pressed(&readings[2]);
    if scenario.observed.sharp_edge {
        forget_what_friction_holds(&mut readings, &pressed, &inputs, scenario);
    }
    if scenario.observed.motors_by_encoders {
        forget_what_strikes(&mut readings, &pressed, &inputs.time, scenario.touching());
    }
    Ok(Recorded {
        inputs,
        readings,
        filled,
    })
}

/// Largest force reading next to each sample [N].
fn pressed(force: &[f64]) -> Vec<f64> {
    let of = |i: usize| {
        let (from, to) = (i.saturating_sub(HELD), (i + HELD + 1).min(force.len()));
        let near = force[from..to].iter();
        near.copied().fold(f64::NEG_INFINITY, f64::max)
    };
    (0..force.len()).map(of).collect()
}

/// A tool that rests on the edge holds on to it, across too, by as much as friction lets it: where it stands then is no matter of the model, and what a
/// leaned device carries of it neither.
fn forget_what_friction_holds(
    readings: &mut [Vec<f64>; CHANNELS.len()],
    pressed: &[f64],
    inputs: &PlantInputs,
    scenario: &RecordedCell,
) {
    let Some(trajectory) = &inputs.cell else {
        return;
    };
    let [_, stroke, force, _] = readings;
    let [_, _, noise] = scenario.noise;
    for (i, pressed) in pressed.iter().enumerate() {
        if !trajectory.rests(i) || *pressed < scenario.touching() {
            continue;
        }
        stroke[i] = f64::NAN;
        let lean = trajectory.edge[i]
            .bisector
            .cross(trajectory.slide[i])
            .length();
        if scenario.nominal.cell.friction * pressed * lean > noise {
            force[i] = f64::NAN;
        }
    }
}

/// Where motors are known by their encoders' samples alone, what an arm does just after the tool strikes is faster than these: a model of it is wrong by a few
/// standard deviations there, and small effects would be found in that.
fn forget_what_strikes(
    readings: &mut [Vec<f64>; CHANNELS.len()],
    pressed: &[f64],
    time: &[f64],
    touching: f64,
) {
    let [_, stroke, force, _] = readings;
    let mut free = f64::NEG_INFINITY;
    for (i, pressed) in pressed.iter().enumerate() {
        // Between the samples of a sensor nothing is read.
        if *pressed < touching && pressed.is_finite() {
            free = time[i];
        } else if *pressed >= touching && time[i] - free < STRUCK {
            stroke[i] = f64::NAN;
            force[i] = f64::NAN;
        }
    }
}

/// Effects that a cell may show. A surface that is off is a part that is misplaced there.
fn candidates(cell: &LoadedCell) -> Vec<&'static Effect> {
    let joints = cell.joints.len();
    let of_device = CATALOGUE.iter().filter(|e| e.name != "surface_offset");
    of_device
        .chain(&CELL_EFFECTS)
        .chain(JOINT_EFFECTS[..joints].iter().flatten())
        // Joints whose gravity is compensated are described by their springs alone.
        .filter(|e| {
            cell.scenario.observed.gravity_on_joints || e.vocabulary().0 != "joint_backlash"
        })
        .collect()
}

fn tolerated_numbers(cell: &LoadedCell, nominal: &PlantParameters) -> Vec<Free> {
    let scenario = &cell.scenario;
    let numbers = [
        &registry::MOVING_MASS,
        &registry::DEAD_VOLUME,
        &registry::SUPPLY_ORIFICE,
        &registry::EXHAUST_ORIFICE,
        &registry::REGULATOR_GAIN,
        &registry::REGULATOR_TIME_CONSTANT,
        &registry::CONTACT_STIFFNESS,
        &registry::CONTACT_DAMPING,
    ];
    let mut free: Vec<Free> = if scenario.tolerance > 0.0 {
        let of =
            |quantity: Quantity| tolerated(quantity, quantity.get(nominal), scenario.tolerance);
        numbers.map(|number| of(number.quantity())).to_vec()
    } else {
        Vec::new()
    };
    let about = |quantity: Quantity, mean: f64, deviation: f64, bounds: [f64; 2]| Free {
        quantity,
        start: mean,
        coordinate: Coordinate::Linear(deviation),
        bounds,
        prior: Prior::Normal { mean, deviation },
    };
    let off = scenario.start_stroke_tolerance;
    if off > 0.0 {
        // Anywhere between the stop and as far from it.
        let start = registry::START_STROKE.quantity();
        free.push(about(start, 0.5 * off, 0.5 * off / 3f64.sqrt(), [0.0, off]));
    }
    let deviation = scenario.joint_damping_deviation;
    if deviation > 0.0 {
        let damping = registry::JOINT_DAMPING.quantity();
        let time = damping.get(&scenario.nominal);
        let bounds = [0.1 * time, time + 4.0 * deviation];
        free.push(about(damping, time, deviation, bounds));
    }
    free
}

const _: () = assert!(CHANNELS.len() == 4);

#[cfg(test)]
mod tests {
    use super::*;

    /// Backlash of one joint was answered with that of a second one beside it: of what the first touch did to the arm between two samples of its encoders.
    #[test]
    fn what_strikes_is_forgotten_and_what_stays_is_not() {
        let time: Vec<f64> = (0..1000).map(|i| f64::from(i) * 1e-3).collect();
        // Touches at 0.3 s, bounces, and stays from 0.34 s on; read at every fourth row.
        let force = |t: f64| match t {
            t if t < 0.3 || (0.32..0.34).contains(&t) => 0.3,
            _ => 100.0,
        };
        let read = |(i, t): (usize, &f64)| match i % 4 {
            0 => force(*t),
            _ => f64::NAN,
        };
        let forces: Vec<f64> = time.iter().enumerate().map(read).collect();
        let nothing = vec![0.0; time.len()];
        let mut readings = [nothing.clone(), nothing.clone(), forces, nothing];
        let near = pressed(&readings[2]);
        forget_what_strikes(&mut readings, &near, &time, 4.8);
        let kept = |channel: usize, t: usize| readings[channel][t].is_finite();
        assert!(kept(2, 200) && kept(2, 288) && kept(2, 452) && kept(2, 900));
        assert!(!kept(2, 304) && !kept(2, 348) && !kept(2, 420));
        assert!(kept(1, 200) && !kept(1, 400) && kept(1, 452));
        assert!(kept(0, 400), "the outlet has no part in it");
        let mut pressing = [vec![0.0; 4], vec![0.0; 4], vec![100.0; 4], vec![0.0; 4]];
        let near = pressed(&pressing[2]);
        forget_what_strikes(&mut pressing, &near, &time[..4], 4.8);
        assert!(pressing[2].iter().all(|force| force.is_finite()));
    }
}
