//! From a folder of recordings to plans: one to diagnose them, one to follow what was found through all days.

use std::collections::BTreeMap;
use std::path::Path;

use super::super::error::AppError;
use super::super::vary::Files;
use super::work::{Asked, KIND, Shared, is_rig};
use crate::cell::arm_options;
use crate::fleet::{Dated, Layout, Persistent, Recording, persistent};
use crate::recording::RecordingError;
use crate::recording::provenance::SourceFile;
use crate::replay::LoadedCell;
use crate::scenario::{files_of_cell, led_to};
use crate::tasks::{Head, Plan, Store, Task, name_of};

/// Writes the plan of the diagnoses: each begins with what the device's last one came to, and is named by it, so that a recording that comes later changes none
/// before it.
pub(super) fn write(layout: &Layout, scenario: &Path, plan: &Path) -> Result<(), AppError> {
    let folder = plan.parent().unwrap_or(Path::new("."));
    let mut files = Files::new(folder);
    let shared = nominal(scenario, &mut files)?;
    let count = layout.devices.iter().map(|device| device.recordings.len());
    let head = head(scenario, folder, count.sum(), shared)?;
    let rig = is_rig(scenario);
    let mut after: BTreeMap<String, String> = BTreeMap::new();
    let mut tasks = Vec::new();
    for device in &layout.devices {
        for dated in &device.recordings {
            let own = hashed(dated, &mut files)?;
            let asked = asked(&device.name, dated, folder, rig);
            let before = after.get(&device.name).cloned();
            let id = name(&head, &own, before.as_deref().unwrap_or(""));
            after.insert(device.name.clone(), id.clone());
            tasks.push(Ok::<_, AppError>(Task {
                id,
                after: before,
                work: serde_json::to_value(asked)?,
                files: own,
            }));
        }
    }
    Plan::write(plan, &head, tasks)
}

/// Writes the plan of the fits: what was found in a device for days is fitted to those of its recordings in which it was not, so that its numbers are known of
/// every day. Returns for each recording, by its place, the task that tells its numbers.
pub(super) fn write_fits(plan: &Path, fits: &Path) -> Result<Vec<Option<String>>, AppError> {
    let opened = Plan::open(plan)?;
    let head = opened.head.clone();
    let found = persistent(&recordings(plan, &[])?);
    let mut tasks = Vec::new();
    let mut places = Vec::new();
    for task in opened {
        let task = task?;
        let mut asked: Asked = serde_json::from_value(task.work.clone())?;
        let own: Option<&Persistent> = found.get(&asked.device);
        let fit = own.filter(|own| !own.effects.is_empty() && own.lacks(&task.id));
        places.push(fit.map(|fit| {
            let names: Vec<&str> = fit.effects.iter().map(|e| e.name.as_str()).collect();
            let numbers = fit
                .effects
                .iter()
                .flat_map(|e| &e.values)
                .map(f64::to_string);
            let started = numbers.collect::<Vec<_>>().join(" ");
            let id = name(
                &head,
                &task.files,
                &format!("fit {} from {started}", names.join(" ")),
            );
            asked.fit = Some(fit.effects.clone());
            tasks.push((id.clone(), asked.clone(), task.files.clone()));
            id
        }));
    }
    let head = Head {
        tasks: tasks.len(),
        ..head
    };
    let tasks = tasks.into_iter().map(|(id, asked, files)| {
        Ok::<_, AppError>(Task {
            id,
            after: None,
            work: serde_json::to_value(asked)?,
            files,
        })
    });
    Plan::write(fits, &head, tasks)?;
    Ok(places)
}

fn head(
    scenario: &Path,
    folder: &Path,
    tasks: usize,
    files: Vec<SourceFile>,
) -> Result<Head, AppError> {
    Ok(Head {
        plan: KIND.to_owned(),
        program: Head::this_program(),
        tasks,
        work: serde_json::to_value(Shared {
            scenario: led_to(scenario, folder),
        })?,
        files,
    })
}

/// Files of the nominal model.
fn nominal(scenario: &Path, files: &mut Files) -> Result<Vec<SourceFile>, AppError> {
    let mut found = vec![files.one(scenario)?];
    if !is_rig(scenario) {
        let cell = LoadedCell::load(scenario)?.scenario;
        let own = files_of_cell(&cell.path, &cell.arm, &cell.device, &cell.workpiece, &[]);
        let meshes = crate::arm::mesh_files(&cell.arm.urdf, &arm_options(&cell.arm));
        let meshes = meshes.map_err(crate::cell::CellError::from)?;
        for path in own.into_iter().skip(1).cloned().chain(meshes) {
            found.push(files.one(&path)?);
        }
    }
    Ok(found)
}

fn hashed(dated: &Dated, files: &mut Files) -> Result<Vec<SourceFile>, AppError> {
    dated.files.iter().map(|path| files.one(path)).collect()
}

fn asked(device: &str, dated: &Dated, folder: &Path, rig: bool) -> Asked {
    let base = match dated.path.is_dir() {
        true => dated.path.as_path(),
        false => dated.path.parent().unwrap_or(Path::new("")),
    };
    let within = |path: &Path| {
        path.strip_prefix(base)
            .unwrap_or(path)
            .display()
            .to_string()
    };
    Asked {
        device: device.to_owned(),
        name: dated.name.clone(),
        day: dated.day,
        path: led_to(&dated.path, folder),
        files: match rig {
            true => dated.files.iter().map(|path| within(path)).collect(),
            false => Vec::new(),
        },
        fit: None,
    }
}

/// Name of a task: of the program, the nominal model, the recording's content, and what it begins with.
fn name(head: &Head, files: &[SourceFile], begins: &str) -> String {
    let hash = |file: &SourceFile| file.sha256.clone();
    let shared: Vec<String> = head.files.iter().map(hash).collect();
    let own: Vec<String> = files.iter().map(hash).collect();
    let first = [KIND, head.program.as_str()].into_iter();
    let shared = shared.iter().map(String::as_str);
    let own = own.iter().map(String::as_str);
    name_of(
        first
            .chain(shared)
            .chain(["of"])
            .chain(own)
            .chain(["from", begins]),
    )
}

/// Refuses a scenario that is among the recordings' files, or gone.
pub(super) fn check(scenario: &Path) -> Result<(), AppError> {
    let found = std::fs::metadata(scenario);
    Ok(found
        .map(drop)
        .map_err(|e| RecordingError::read(scenario, e))?)
}

/// All recordings of a plan, in its order, with the fits that tell their numbers.
pub fn recordings(plan: &Path, fits: &[Option<String>]) -> Result<Vec<Recording>, AppError> {
    let store = Store::of(plan);
    let read = |(place, task): (usize, Result<Task, _>)| {
        let task = task?;
        let asked: Asked = serde_json::from_value(task.work)?;
        let fit = fits.get(place).and_then(Option::as_ref);
        Ok(Recording {
            device: asked.device,
            name: asked.name,
            day: asked.day,
            result: store.read(&task.id)?,
            followed: fit.map(|fit| store.read(fit)).transpose()?,
            id: task.id,
        })
    };
    Plan::open(plan)?.enumerate().map(read).collect()
}
