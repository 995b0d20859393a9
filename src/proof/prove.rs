//! Diagnoses cases, then opens what was sealed and scores them.

use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};

use super::error::ProofError;
use super::queue;
use super::score::{CaseScore, judge, worst_channel};
use super::summary::ProofSummary;
use crate::diagnosis::answer::Answer;
use crate::diagnosis::recordings::recorded::QUANTITIES;
use crate::laboratory::SealedCase;
use crate::recording::csv::read_readings;

/// Diagnoses the case in a folder, writes diagnosis.json and prediction.csv into another one, and hands back the answer or why there is none.
pub type Diagnose<'a> = dyn Fn(&Path, &Path) -> Result<Answer, String> + Sync + 'a;

/// File with what the improved model predicts.
const PREDICTION: &str = "prediction.csv";

/// Diagnoses the cases below `cases`, all or those named, into folders below `out`, `jobs` at a time; then scores them by what is sealed in `sealed`.
/// `progress` gets how many are done, of how many.
///
/// # Errors
/// There are no such cases, or a sealed file cannot be read.
pub fn prove(
    cases: &Path,
    sealed: &Path,
    only: &[String],
    out: &Path,
    jobs: usize,
    diagnose: &Diagnose<'_>,
    progress: &(dyn Fn(usize, usize) + Sync),
) -> Result<ProofSummary, ProofError> {
    let folders = folders(cases, only)?;
    let done = AtomicUsize::new(0);
    let answers = queue::all(folders.len(), jobs, |index| {
        let (name, folder) = &folders[index];
        let answer = diagnose(folder, &out.join(name));
        progress(done.fetch_add(1, Ordering::Relaxed) + 1, folders.len());
        answer
    });
    let mut scores = Vec::new();
    for ((name, _), answer) in folders.iter().zip(answers) {
        let fault = || Err("a fault of the program, see above".to_owned());
        scores.push(score(
            name,
            answer.unwrap_or_else(fault),
            &out.join(name),
            sealed,
        )?);
    }
    Ok(ProofSummary::new(scores))
}

/// Folders with a case, by name.
///
/// # Errors
/// There are none, or not all that are named.
pub fn folders(cases: &Path, only: &[String]) -> Result<Vec<(String, PathBuf)>, ProofError> {
    let entries = std::fs::read_dir(cases).map_err(|cause| ProofError::read(cases, cause))?;
    let mut found = Vec::new();
    for entry in entries {
        let path = entry
            .map_err(|cause| ProofError::read(cases, cause))?
            .path();
        let name = path.file_name().map(|n| n.to_string_lossy().into_owned());
        let Some(name) = name.filter(|_| path.join("rig.toml").is_file()) else {
            continue;
        };
        if only.is_empty() || only.contains(&name) {
            found.push((name, path));
        }
    }
    found.sort();
    let lacks = only
        .iter()
        .any(|name| !found.iter().any(|(own, _)| own == name));
    if found.is_empty() || lacks {
        return Err(ProofError::NoCases {
            folder: cases.to_owned(),
            only: only.to_vec(),
        });
    }
    Ok(found)
}

/// Scores an answer that stands, with its prediction in `answered`, by the truth in `sealed`.
pub(super) fn score(
    name: &str,
    answer: Result<Answer, String>,
    answered: &Path,
    sealed: &Path,
) -> Result<CaseScore, ProofError> {
    let path = sealed.join(format!("{name}.json"));
    let text = crate::file::read_text(&path).map_err(|cause| ProofError::read(&path, cause))?;
    let truth: SealedCase =
        serde_json::from_str(&text).map_err(|cause| ProofError::read(&path, cause))?;
    let answer = match answer {
        Ok(answer) => answer,
        Err(failure) => return Ok(CaseScore::failed(&truth, failure)),
    };
    let measured = readings(&sealed.join(format!("{name}.predict.csv")))?;
    let prediction = readings(&answered.join(PREDICTION)).ok();
    let worst = prediction
        .filter(|predicted| same_times(&predicted.0, &measured.0))
        .map(|predicted| worst_channel(&predicted.1, &measured.1, &truth.noise));
    Ok(judge(&answer, &truth, worst))
}

type Readings = (Vec<f64>, [Vec<f64>; 4]);

fn readings(path: &Path) -> Result<Readings, ProofError> {
    let recording = read_readings(path)?.recording;
    let count = recording.sample_count();
    let values = QUANTITIES.map(|quantity| {
        recording
            .channel(quantity)
            .map_or_else(|| vec![f64::NAN; count], |channel| channel.values.clone())
    });
    Ok((recording.time().to_vec(), values))
}

fn same_times(one: &[f64], other: &[f64]) -> bool {
    /// Stamps are written to this [s].
    const WRITTEN: f64 = 5e-4;
    one.len() == other.len() && one.iter().zip(other).all(|(a, b)| (a - b).abs() < WRITTEN)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnosis::answer::details::Details;
    use crate::diagnosis::answer::{SCHEMA, Verdict};
    use crate::laboratory::{Conditions, Recipe, write_case};

    fn nothing() -> Answer {
        Answer {
            schema: SCHEMA,
            verdict: Verdict::NothingMissing,
            explained: None,
            effects: Vec::new(),
            mismatch: Vec::new(),
            seconds: 1.0,
            alternatives: Vec::new(),
            notes: Vec::new(),
            details: Details::default(),
        }
    }

    #[test]
    fn nothing_sealed_is_there_until_all_is_answered() {
        let room = tempfile::tempdir().unwrap();
        let place = |name: &str| room.path().join(name);
        let recipe = Recipe {
            name: "one".to_owned(),
            seed: 1,
            effects: Vec::new(),
            law: None,
            duration: 2.0,
            conditions: Conditions::default(),
        };
        let case = recipe.make().unwrap();
        write_case(&case, &place("cases").join("one"), Some(&place("safe"))).unwrap();
        let diagnose = |folder: &Path, out: &Path| {
            assert!(folder.join("rig.toml").is_file() && !place("sealed").exists());
            // A prediction that is perfect: what was measured.
            std::fs::create_dir_all(out).unwrap();
            std::fs::copy(place("safe").join("one.predict.csv"), out.join(PREDICTION)).unwrap();
            std::fs::rename(place("safe"), place("sealed")).unwrap();
            Ok(nothing())
        };
        let go = |only: &[String]| {
            prove(
                &place("cases"),
                &place("sealed"),
                only,
                &place("out"),
                1,
                &diagnose,
                &|done, total| assert_eq!((done, total), (1, 1)),
            )
        };
        let error = go(&["two".to_owned()]).unwrap_err().to_string();
        assert!(error.contains("named two"), "{error}");
        let summary = go(&[]).unwrap();
        assert_eq!((summary.clean, summary.predicted), ([1, 1], [1, 1]));
        assert_eq!(summary.cases[0].prediction, Some(0.0));
    }
}
