//! A case of a recorded cell: a folder with recordings alone. What lacks measured columns is to be predicted.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::super::error::AppError;
use crate::diagnosis::case::{Case, NamedRecording, tolerated};
use crate::diagnosis::free::{Free, Prior};
use crate::diagnosis::recorded::{QUANTITIES, Recorded, RecordedError, hold};
use crate::diagnosis::servo::{Axes, ServoLink, servo_link};
use crate::effects::{CATALOGUE, CELL_EFFECTS, Coordinate, Effect, JOINT_EFFECTS, Quantity};
use crate::plant::{CHANNELS, ContactLaw, PlantInputs, PlantParameters};
use crate::recording::csv::{CellRecording, read_cell_csv};
use crate::replay::LoadedCell;

/// Noise of a channel that cells do not have: nothing is as much.
const UNMEASURED: f64 = 1e9;

/// A case of a cell, with what its servos were found to do.
pub(super) struct CellCase {
    pub case: Case,
    pub servo: Option<ServoLink>,
}

/// Is this a folder with recordings?
pub(super) fn is_case(folder: &Path) -> bool {
    folder.is_dir() && !recordings(folder).is_empty()
}

fn recordings(folder: &Path) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
    let files = entries.map(|entry| entry.path());
    let mut files: Vec<PathBuf> = files
        .filter(|path| path.is_file() && path.extension().is_some_and(|e| e == "csv"))
        .collect();
    files.sort();
    files
}

/// Reads a case.
pub(super) fn read(cell: &LoadedCell, folder: &Path) -> Result<CellCase, AppError> {
    let joints = cell.joints.len();
    let mut known = Vec::new();
    let mut unseen = Vec::new();
    for path in recordings(folder) {
        let recording = read_cell_csv(&path, joints)?;
        let name = path.file_name().unwrap_or_default().display().to_string();
        let named = (name, path.display().to_string(), recording);
        if named.2.readings.is_empty() {
            unseen.push(named);
        } else {
            known.push(named);
        }
    }
    if known.is_empty() {
        return Err(AppError::NothingMeasured {
            folder: folder.display().to_string(),
        });
    }
    if let [_, second, ..] = &unseen[..] {
        return Err(AppError::TwoUnseen {
            file: second.1.clone(),
            first: unseen[0].0.clone(),
        });
    }
    let scenario = &cell.scenario;
    let axes: Vec<Axes> = known
        .iter()
        .map(|(_, _, recording)| axes(recording))
        .collect();
    let servo = servo_link(&axes, scenario.joint_noise, scenario.servo_bandwidth);
    let believed = cell.plant();
    let shown = servo.as_ref().and_then(|servo| servo.shown(&believed));
    let bandwidth = match (&servo, &shown) {
        (Some(servo), Some(_)) => servo.bandwidth,
        _ => scenario.servo_bandwidth,
    };
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
    let unseen = unseen.into_iter().next().map(&mut named).transpose()?;
    let [pressure, stroke, force] = scenario.noise;
    Ok(CellCase {
        case: Case {
            tolerated: tolerated_numbers(cell, &believed),
            believed,
            noise: [pressure, stroke, force, UNMEASURED],
            recordings,
            unseen,
            candidates: candidates(joints),
            shown: shown.into_iter().collect(),
        },
        servo,
    })
}

fn axes(recording: &CellRecording) -> Axes {
    Axes {
        time: recording.time.clone(),
        commands: recording.commands.clone(),
        encoders: recording.encoders.clone(),
    }
}

fn recorded(
    cell: &LoadedCell,
    file: &str,
    recording: CellRecording,
    bandwidth: f64,
) -> Result<Recorded, AppError> {
    let CellRecording {
        time,
        path,
        commands,
        mut set_pressure,
        readings,
        ..
    } = recording;
    let filled = hold(&mut set_pressure);
    let course = cell.course(&time, &path, &commands, bandwidth);
    let inputs = PlantInputs {
        set_pressure,
        extends: vec![true; time.len()],
        surface: course.felt(&cell.plant().cell).surface(),
        cell: Some(Arc::new(course)),
        time,
    };
    inputs.check().map_err(|source| RecordedError::Inputs {
        file: file.to_owned(),
        source,
    })?;
    let nothing = vec![f64::NAN; inputs.time.len()];
    let readings = QUANTITIES.map(|quantity| {
        let found = readings.iter().find(|(name, _)| *name == quantity);
        found.map_or_else(|| nothing.clone(), |(_, values)| values.clone())
    });
    Ok(Recorded {
        inputs,
        readings,
        filled,
    })
}

/// Effects that a cell may show. A surface that is off is a part that is misplaced there.
fn candidates(joints: usize) -> Vec<&'static Effect> {
    let of_device = CATALOGUE.iter().filter(|e| e.name != "surface_offset");
    of_device
        .chain(&CELL_EFFECTS)
        .chain(JOINT_EFFECTS[..joints].iter().flatten())
        .collect()
}

/// A number of the device or the contact that is believed within the file's tolerance.
macro_rules! number {
    ($name:literal, $p:ident => $($place:tt)+) => { Quantity { name: $name, get: |$p| $($place)+, set: |$p, value| $($place)+ = value } };
}

fn tolerated_numbers(cell: &LoadedCell, believed: &PlantParameters) -> Vec<Free> {
    let scenario = &cell.scenario;
    let stiffness = Quantity {
        name: "contact.stiffness_n_per_m",
        get: |p| match p.contact.law {
            ContactLaw::Linear { stiffness } | ContactLaw::Hertz { stiffness } => stiffness,
        },
        set: |p, stiffness| p.contact.law = ContactLaw::Linear { stiffness },
    };
    let quantities = [
        number!("cylinder.moving_mass_kg", p => p.device.moving_mass),
        number!("cylinder.dead_volume_m3", p => p.device.dead_volume),
        number!("valve.supply_orifice_m2", p => p.device.supply_orifice),
        number!("valve.exhaust_orifice_m2", p => p.device.exhaust_orifice),
        number!("regulator.gain", p => p.device.regulator.gain),
        number!("regulator.time_constant_s", p => p.device.regulator.time_constant),
        stiffness,
        number!("contact.damping_n_s_per_m", p => p.contact.damping),
    ];
    let mut free: Vec<Free> = if scenario.tolerance > 0.0 {
        let of =
            |quantity: Quantity| tolerated(quantity, (quantity.get)(believed), scenario.tolerance);
        quantities.map(of).to_vec()
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
        let start = number!("slide.start_stroke_m", p => p.cell.start_stroke);
        free.push(about(start, 0.5 * off, 0.5 * off / 3f64.sqrt(), [0.0, off]));
    }
    let [time, deviation] = scenario.joint_damping;
    if deviation > 0.0 {
        let damping = number!("joints.damping_time_s", p => p.cell.joint_damping);
        let bounds = [0.1 * time, time + 4.0 * deviation];
        free.push(about(damping, time, deviation, bounds));
    }
    free
}

const _: () = assert!(CHANNELS.len() == 4);
