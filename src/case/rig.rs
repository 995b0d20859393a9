//! A rig file and the recordings that it names.

use std::cell::RefCell;
use std::path::Path;

use super::error::CaseError;
use super::recordings::{read_in_any_unit, read_rig};
use super::stills::stills_in;
use crate::diagnosis::data_fault::take_off;
use crate::diagnosis::flange::{ForceRamp, NoContact, Run, RunMetrics};
use crate::diagnosis::recordings::input::{DiagnosisInput, NamedRecording, of_link, tolerated};
use crate::diagnosis::recordings::recorded::{recorded_of, run_of};
use crate::effects::{candidates, numbers_off, sought};
use crate::scenario::rig_file::{RigFile, load_rig};

/// Rig file of a case.
pub const RIG: &str = "rig.toml";

/// The rig file of a case.
///
/// # Errors
/// A folder without one, one without recordings, or what is wrong with the file.
pub fn rig_of(folder: &Path) -> Result<RigFile, CaseError> {
    if !folder.join(RIG).is_file() {
        if let Some(table) = stills_in(folder) {
            return Err(CaseError::PosturesUnstated {
                folder: folder.display().to_string(),
                table,
            });
        }
        return Err(CaseError::NoRig {
            folder: folder.display().to_string(),
        });
    }
    let rig = load_rig(&folder.join(RIG))?;
    if rig.fit.is_empty() {
        return Err(CaseError::NoRecordings {
            file: rig.path.display().to_string(),
        });
    }
    if rig.plant.latent.is_some() {
        return Err(CaseError::Latent {
            file: rig.path.display().to_string(),
        });
    }
    Ok(rig)
}

/// Names of the recordings to diagnose from; one with a star stands for all in the folder that fit it, but the one to be predicted, in order.
///
/// # Errors
/// A pattern that no file fits.
pub fn to_fit(rig: &RigFile, folder: &Path) -> Result<Vec<String>, CaseError> {
    names_to_fit(&rig.path, &rig.fit, rig.predict.as_ref(), folder)
}

/// As [`to_fit`], of names in any file.
pub(super) fn names_to_fit(
    file: &Path,
    fit: &[String],
    predict: Option<&String>,
    folder: &Path,
) -> Result<Vec<String>, CaseError> {
    let mut names: Vec<String> = Vec::new();
    for name in fit {
        if !name.contains('*') {
            names.push(name.clone());
            continue;
        }
        let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
        let mut found: Vec<String> = entries
            .filter_map(|entry| entry.file_name().into_string().ok())
            .filter(|file| fits(name, file))
            .filter(|file| predict != Some(file) && !names.contains(file))
            .collect();
        if found.is_empty() {
            return Err(CaseError::NoneLike {
                file: file.display().to_string(),
                pattern: name.clone(),
            });
        }
        found.sort_unstable();
        names.append(&mut found);
    }
    Ok(names)
}

/// Whether a file's name is the one that is written, or fits it where it has stars.
fn fits(written: &str, file: &str) -> bool {
    let Some((first, rest)) = written.split_once('*') else {
        return written == file;
    };
    let Some(mut left) = file.strip_prefix(first) else {
        return false;
    };
    let mut parts: Vec<&str> = rest.split('*').collect();
    let last = parts.pop().unwrap_or_default();
    for part in parts {
        match left.split_once(part) {
            Some((_, behind)) => left = behind,
            None => return false,
        }
    }
    left.ends_with(last)
}

/// Inputs of a diagnosis.
pub(super) fn input_of(rig: &RigFile, folder: &Path) -> Result<DiagnosisInput, CaseError> {
    let parts = rig.plant.parts;
    // A column that is implausible as SI may be in another unit: the message stands unless that is found.
    let implausible = RefCell::new(None);
    let read = |name: &String| -> Result<NamedRecording, CaseError> {
        let path = folder.join(name);
        let file = path.display().to_string();
        let recording = read_rig(parts, &path).or_else(|error| {
            let Some(recording) = read_in_any_unit(parts, &path) else {
                return Err(error);
            };
            implausible.borrow_mut().get_or_insert(error);
            Ok(recording)
        })?;
        let recorded = recorded_of(parts, &file, &recording)?;
        let recorded = recorded.of_sensors(rig.sensors());
        Ok(NamedRecording {
            name: name.clone(),
            file,
            recorded,
        })
    };
    let tolerances = rig.tolerances.iter();
    let mut nominal = rig.plant.clone();
    let own = sought(&mut nominal);
    let mut input = DiagnosisInput {
        nominal,
        tolerated: tolerances
            .map(|t| tolerated(t.quantity, t.value, t.tolerance))
            .chain(of_link(rig.plant.parts, rig.noise[0], rig.pressure_drift))
            .collect(),
        noise: rig.noise,
        recordings: to_fit(rig, folder)?
            .iter()
            .map(read)
            .collect::<Result<_, _>>()?,
        unseen: rig.predict.as_ref().map(read).transpose()?,
        candidates: (candidates(rig.plant.parts).into_iter())
            .chain(numbers_off(rig.plant.parts))
            .chain(own)
            .collect(),
        shown: Vec::new(),
        tried: None,
        data_faults: Vec::new(),
        limits: rig.limits.clone(),
        kept: Vec::new(),
        rate: rig.rate,
    };
    take_off(&mut input);
    match implausible.into_inner() {
        Some(error) if !input.is_in_si() => Err(error.into()),
        _ => Ok(input),
    }
}

/// A run of a contact flange with its features.
pub(super) type MeasuredRun = (Run, RunMetrics);

/// Runs of a contact flange: those to diagnose from and the one to be predicted.
pub(super) fn flange_runs(
    rig: &RigFile,
    folder: &Path,
) -> Result<(Vec<MeasuredRun>, Option<MeasuredRun>), CaseError> {
    let shown = |name: &String| flange_run(rig, folder, name);
    let runs = to_fit(rig, folder)?
        .iter()
        .map(shown)
        .collect::<Result<_, _>>()?;
    Ok((runs, rig.predict.as_ref().map(shown).transpose()?))
}

/// A run of a contact flange in a folder.
pub(super) fn flange_run(
    rig: &RigFile,
    folder: &Path,
    name: &str,
) -> Result<MeasuredRun, CaseError> {
    let path = folder.join(name);
    let file = path.display().to_string();
    let mut run = run_of(&file, name, &read_rig(rig.plant.parts, &path)?)?;
    let ramp = (rig.force_ramps.iter()).find(|ramp| fits(&ramp.recording, name));
    run.force_ramp = ramp.map(|ramp| ForceRamp {
        before: ramp.before,
        time: ramp.time,
    });
    let refused = |source: NoContact| CaseError::NoContact {
        folder: folder.display().to_string(),
        source,
    };
    let shown = run.metrics().map_err(refused)?;
    Ok((run, shown))
}

#[cfg(test)]
mod tests {
    use super::fits;

    #[test]
    fn stars_stand_for_anything() {
        assert!(fits("run.csv", "run.csv") && !fits("run.csv", "a_run.csv"));
        assert!(fits("*.csv", "run.csv") && !fits("*.csv", "run.parquet"));
        assert!(fits("a*b*c", "a1b2c") && fits("a*b*c", "abc") && !fits("a*b*c", "acb"));
        assert!(
            fits("*_ramp0.1_*", "run_ramp0.1_force.csv")
                && !fits("*_ramp0.1_*", "run_ramp0.2_force.csv")
        );
        assert!(!fits("ab*ba", "aba"));
    }
}
