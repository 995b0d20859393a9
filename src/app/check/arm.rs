//! The file of a recorded arm explained, and a case of `idc diagnose`: the file with the recordings that it names.

use std::path::Path;

use super::super::error::AppError;
use super::identifiability::identifiability;
use super::report::{Report, shown};
use crate::arm::JointKind;
use crate::case::{ARM, ArmLogs, arm_of, logs_of, unrecorded};
use crate::diagnosis::arm::input::ArmInput;
use crate::quantity::counted;
use crate::scenario::arm_file::{ArmFile, load_arm_file};
use crate::shell::word;

/// The file alone.
pub(super) fn arm(path: &Path) -> Result<Report, AppError> {
    let file = load_arm_file(path)?;
    let kind = "a recorded arm: links, drives, load and sensors by their nominal values";
    let mut report = Report::new(path, kind, None);
    describe(&mut report, &file);
    let folder = path.parent().unwrap_or(Path::new(""));
    identifiability(&mut report, &recorded(&file, folder));
    for name in file.fit.iter().filter(|name| !name.contains('*')) {
        report.file("recording to diagnose from", &folder.join(name));
    }
    if let Some(name) = &file.predict {
        report.file("recording to predict", &folder.join(name));
    }
    if file.fit.is_empty() {
        report.note("`recordings.fit` names no recording; idc diagnose asks for one at least");
    }
    report.next(format!("idc predict {} RECORDING", word(path)));
    Ok(report)
}

/// A folder with the file and its recordings, read as `idc diagnose` would.
pub(super) fn case(folder: &Path) -> Result<Report, AppError> {
    let (file, _) = arm_of(folder)?;
    let kind = "a case to diagnose: a recorded arm and recordings";
    let mut report = Report::new(folder, kind, None);
    describe(&mut report, &file);
    let ArmLogs {
        summaries: logs,
        notes,
        input,
    } = logs_of(folder)?;
    report.file("arm", &folder.join(ARM));
    for log in &logs {
        let what = match log.unseen {
            true => "to be predicted",
            false => "to diagnose from",
        };
        let measured = match log.measured.is_empty() {
            true => "nothing measured".to_owned(),
            false => format!("measured: {}", log.measured.join(", ")),
        };
        report.fact(
            "recording",
            format!(
                "{}, {what}: {} samples in {} s; {measured}",
                log.name,
                log.samples,
                shown(log.duration)
            ),
        );
        report.file(what, &folder.join(&log.name));
    }
    report.number("recordings", logs.iter().filter(|log| !log.unseen).count());
    identifiability(&mut report, &input);
    for note in notes {
        report.note(note);
    }
    report.next(format!("idc diagnose {} --out DIR", word(folder)));
    Ok(report)
}

/// What a diagnosis is made of: with the recordings where all are there and can be read, as a check of the folder says why they cannot.
pub(super) fn recorded(file: &ArmFile, folder: &Path) -> ArmInput {
    let is_case = file.path.file_name().is_some_and(|name| name == ARM);
    match logs_of(folder) {
        Ok(logs) if is_case => logs.input,
        _ => unrecorded(file),
    }
}

fn describe(report: &mut Report, file: &ArmFile) {
    let arm = &file.nominal;
    report.file("URDF", &file.urdf);
    let joints = arm.chain.joints.iter().zip(&file.numbers);
    let mut named: Vec<(usize, String)> = joints
        .map(|(joint, number)| {
            let kind = match joint.kind {
                JointKind::Revolute => "",
                JointKind::Prismatic => " (prismatic)",
            };
            (*number, format!("{number} {}{kind}", joint.name))
        })
        .collect();
    named.sort();
    let named: Vec<String> = named.into_iter().map(|(_, name)| name).collect();
    report.fact("joints", named.join(", "));
    report.number("joints", arm.joints());
    let mass: f64 = arm.chain.joints.iter().map(|joint| joint.body.mass).sum();
    report.fact("moving mass", format!("{} kg", shown(mass)));
    report.number("moving_mass_kg", mass);
    let currents = arm.drives.iter().filter(|d| d.logs_current).count();
    report.fact(
        "drives",
        match (currents, arm.joints() - currents) {
            (_, 0) => "currents are logged".to_owned(),
            (0, _) => "torques are logged".to_owned(),
            (some, others) => format!("{some} log currents, {others} torques"),
        },
    );
    let load = &arm.load;
    if load.mass > 0.0 {
        let at = load.centre().to_array().map(shown).join(", ");
        report.fact("load", format!("{} kg at ({at}) m", shown(load.mass)));
    }
    if let Some(wrench) = &arm.wrench {
        let mass = shown(wrench.tool_mass);
        report.fact("wrench", format!("a sensor with a tool of {mass} kg"));
    }
    let without = file.numbers.iter().zip(&arm.drives).filter(|(_, drive)| {
        drive.coulomb == 0.0 && drive.viscous == 0.0 && drive.motor_inertia == 0.0
    });
    let mut without: Vec<usize> = without.map(|(number, _)| *number).collect();
    without.sort_unstable();
    if !without.is_empty() {
        let joints: Vec<String> = without.iter().map(usize::to_string).collect();
        report.note(format!(
            "joints {} have neither friction nor motor inertia: a diagnosis will name what it finds of them",
            joints.join(", ")
        ));
    }
    let bounds = counted(file.tolerated.len(), "number");
    report.fact("nominal", format!("{bounds} known within bounds"));
    report.number("within_bounds", file.tolerated.len());
    report.fact("rate", format!("{} Hz", shown(file.rate)));
    report.number("rate_hz", file.rate);
}
