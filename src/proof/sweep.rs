//! Every effect at sizes from the largest plausible down to where it is lost, and devices with nothing missing; each a device of its own.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};

use serde::Serialize;
use serde::de::DeserializeOwned;

use super::case_conditions::CaseConditions;
use super::error::ProofError;
use super::outcome::{Made, Outcome};
use super::prove::{Diagnose, score};
use super::queue;
use crate::laboratory::{EFFECTS, Known, LabEffect, Recipe, UNLISTED_EFFECTS, sizes, write_case};
use crate::recording::atomic::{UnfinishedFolder, write_text};
use crate::recording::claim::clear_unfinished;
use crate::recording::seal::{SealError, read_sealed, sealed};

/// Seed of the first effect's first device; each effect has this many to itself.
const SEEDS_PER_EFFECT: u64 = 1000;
/// Seed of the first device with nothing missing.
const EMPTY_SEED: u64 = 1_000_000;
/// Seeds of a draw of devices.
pub(super) const SEEDS_PER_DRAW: u64 = 10_000_000;
/// Folder of the outcomes.
const OUTCOMES: &str = "outcomes";

/// Plan of a sweep.
#[derive(Debug, Clone, PartialEq)]
pub struct SweepPlan {
    /// Effects by name; none for all of the vocabulary.
    pub effects: Vec<String>,
    /// Devices for each effect.
    pub seeds: u64,
    /// Which devices are drawn.
    pub draw: u64,
    /// Sizes of each effect.
    pub sizes: usize,
    /// Devices with nothing missing.
    pub empty: u64,
    /// Length of each recording [s].
    pub duration: f64,
    /// Conditions under which they are made.
    pub conditions: CaseConditions,
    /// Cases at a time.
    pub jobs: usize,
    /// Go on with what is there.
    pub resume: bool,
    /// Put new outcomes in place of what is there.
    pub replace: bool,
}

struct Task {
    effect: Option<&'static LabEffect>,
    size: usize,
    seed: u64,
}

impl SweepPlan {
    fn tasks(&self) -> Result<Vec<Task>, ProofError> {
        let all = || EFFECTS.iter().chain(&UNLISTED_EFFECTS).enumerate();
        let mut tasks = Vec::new();
        let mut chosen: Vec<(usize, &'static LabEffect)> = Vec::new();
        for name in &self.effects {
            let found = all().find(|(_, effect)| effect.name == *name);
            chosen.push(found.ok_or_else(|| ProofError::Effect {
                name: name.clone(),
                known: all().map(|(_, e)| e.name).collect::<Vec<_>>().join(", "),
            })?);
        }
        if self.effects.is_empty() {
            chosen = all().take(EFFECTS.len()).collect();
        }
        let first = SEEDS_PER_DRAW * self.draw;
        // Seed by seed: what a sweep that is stopped has done is of all effects.
        for seed in 0..self.seeds {
            for (index, effect) in &chosen {
                for size in 0..self.sizes {
                    tasks.push(Task {
                        effect: Some(effect),
                        size,
                        seed: first + SEEDS_PER_EFFECT * (*index as u64 + 1) + seed,
                    });
                }
            }
        }
        tasks.extend((0..self.empty).map(|i| Task {
            effect: None,
            size: 0,
            seed: first + EMPTY_SEED + i,
        }));
        Ok(tasks)
    }

    /// Checks that it can be done.
    ///
    /// # Errors
    /// An effect that there is not.
    pub fn check(&self) -> Result<(), ProofError> {
        self.tasks().map(drop)
    }

    fn made(&self, task: &Task) -> Made {
        Made {
            effect: task.effect.map(|effect| effect.name.to_owned()),
            size: task.size,
            sizes: if task.effect.is_some() { self.sizes } else { 1 },
            seed: task.seed,
            duration_s: self.duration,
            conditions: self.conditions,
        }
    }
}

impl Task {
    fn name(&self) -> String {
        match self.effect {
            Some(effect) => format!("{}-{}-{}", effect.name, self.size, self.seed),
            None => format!("empty-{}", self.seed),
        }
    }
}

/// Does what a plan asks for and is not done yet; `say` gets for each case how many are done, of how many, and what was answered. Outcomes stand in `out`/outcomes, one file each.
///
/// # Errors
/// An effect that there is not, outcomes of another sweep in `out`, a file that cannot be written.
pub fn sweep(
    plan: &SweepPlan,
    out: &Path,
    diagnose: &Diagnose<'_>,
    say: &(dyn Fn(usize, usize, &str) + Sync),
) -> Result<Vec<Outcome>, ProofError> {
    let tasks = plan.tasks()?;
    let names: Vec<String> = tasks.iter().map(Task::name).collect();
    let made: Vec<Made> = tasks.iter().map(|task| plan.made(task)).collect();
    let course = Course {
        out,
        jobs: plan.jobs,
        resume: plan.resume,
        replace: plan.replace,
    };
    carry_out(
        &course,
        &names,
        (&|outcome: &Outcome| outcome.made.clone(), &made),
        &|index| attempt(plan, &tasks[index], out, diagnose),
        &|outcome| format!("answered {}", outcome.answered()),
        say,
    )
}

/// How cases are gone through.
#[derive(Debug, Clone, Copy)]
pub struct Course<'a> {
    /// Folder in which the outcomes are kept.
    pub out: &'a Path,
    /// Cases at a time.
    pub jobs: usize,
    /// Go on with what is there.
    pub resume: bool,
    /// Put new outcomes in place of what is there.
    pub replace: bool,
}

/// The making of an outcome, and those that are asked for.
type Makings<'a, O> = (&'a (dyn Fn(&O) -> Made + Sync), &'a [Made]);

/// Attempts each case whose outcome does not stand in the folder yet, and keeps it there.
pub(super) fn carry_out<O: Serialize + DeserializeOwned + Send>(
    course: &Course<'_>,
    names: &[String],
    made: Makings<'_, O>,
    attempt: &(dyn Fn(usize) -> Result<O, ProofError> + Sync),
    words: &(dyn Fn(&O) -> String + Sync),
    say: &(dyn Fn(usize, usize, &str) + Sync),
) -> Result<Vec<O>, ProofError> {
    let folder = course.out.join(OUTCOMES);
    if !course.resume && !course.replace && folder.exists() {
        return Err(ProofError::OutcomesExist { folder });
    }
    std::fs::create_dir_all(&folder).map_err(|cause| ProofError::read(&folder, cause))?;
    let done = AtomicUsize::new(0);
    for place in [course.out, &folder] {
        clear_unfinished(place);
    }
    let finished = queue::all(names.len(), course.jobs, |index| {
        let name = &names[index];
        let path = folder.join(format!("{name}.json"));
        let exists = match course.replace {
            true => None,
            false => existing(&path, (name, &made.1[index]), made.0)?,
        };
        let exists = exists.and_then(|exists| match exists {
            Ok(outcome) => Some(outcome),
            Err(why) => {
                let count = done.load(Ordering::Relaxed);
                say(count, names.len(), &format!("{name}: done again: {why}"));
                None
            }
        });
        let outcome = match exists {
            Some(outcome) => outcome,
            None => {
                let outcome = attempt(index)?;
                let text = serde_json::to_string_pretty(&outcome)
                    .map_err(|cause| ProofError::read(&path, cause))?;
                write_text(&path, &sealed(&(text + "\n"), name, BTreeMap::new()))?;
                outcome
            }
        };
        let count = done.fetch_add(1, Ordering::Relaxed) + 1;
        say(count, names.len(), &format!("{name}: {}", words(&outcome)));
        Ok::<O, ProofError>(outcome)
    });
    let mut outcomes = Vec::new();
    for (name, outcome) in names.iter().zip(finished) {
        // A fault of the program in one case is not written: it is tried again by --resume.
        match outcome {
            Some(outcome) => outcomes.push(outcome?),
            None => {
                let fault = format!("{name}: a fault of the program, see above");
                say(names.len(), names.len(), &fault);
            }
        }
    }
    Ok(outcomes)
}

/// The outcome of this case that stands in a file already, or why it is to be done again; neither where there is none.
fn existing<O: DeserializeOwned>(
    path: &Path,
    (name, made): (&str, &Made),
    making: &dyn Fn(&O) -> Made,
) -> Result<Option<Result<O, String>>, ProofError> {
    let text = match read_sealed(path, name) {
        Ok(text) => text,
        Err(SealError::Absent) => return Ok(None),
        Err(why) => return Ok(Some(Err(why.to_string()))),
    };
    let Ok(outcome) = serde_json::from_str::<O>(&text) else {
        return Ok(Some(Err("it cannot be read".to_owned())));
    };
    let found = making(&outcome);
    if found == *made {
        return Ok(Some(Ok(outcome)));
    }
    Err(ProofError::OtherPlan {
        path: path.to_owned(),
        found: found.to_string(),
        expected: made.to_string(),
    })
}

/// Makes a case, diagnoses and scores it; nothing of it is left but the outcome.
fn attempt(
    plan: &SweepPlan,
    task: &Task,
    out: &Path,
    diagnose: &Diagnose<'_>,
) -> Result<Outcome, ProofError> {
    let mut share = 0.0;
    let mut effects = Vec::new();
    if let Some(effect) = task.effect {
        share = sizes(effect.name, task.seed, plan.duration, plan.sizes)?[task.size];
        effects.push((effect.name, share));
    }
    let name = task.name();
    let recipe = Recipe {
        name: name.clone(),
        seed: task.seed,
        effects,
        law: None,
        duration: plan.duration,
        conditions: plan.conditions.of(task.seed, plan.duration),
    };
    let case = recipe.make()?;
    let room = UnfinishedFolder::within(out)?;
    let place = |part: &str| -> PathBuf { room.path().join(part) };
    write_case(&case, &place("case"), None)?;
    let answer = diagnose(&place("case"), &place("answer"));
    // Only now is there a sealed file at all.
    write_case(&case, &place("again"), Some(&place("sealed")))?;
    let score = score(&name, answer, &place("answer"), &place("sealed"))?;
    let numbers = case.sealed.effects.iter().flat_map(|e| &e.parameters);
    let parameters = numbers.filter_map(|(name, known)| match known {
        Known::Number(value) => Some((name.clone(), *value)),
        Known::Names(_) => None,
    });
    Ok(Outcome {
        made: plan.made(task),
        share,
        shows: case.sealed.shows,
        parameters: parameters.collect(),
        score,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnosis::answer::details::Details;
    use crate::diagnosis::answer::{Answer, SCHEMA, Verdict};

    #[test]
    fn a_sweep_goes_on_where_it_was_stopped_and_only_as_it_began() {
        let room = tempfile::tempdir().unwrap();
        let out = room.path().join("sweep");
        let mut plan = SweepPlan {
            effects: vec!["force_sensor_gain_error".to_owned()],
            seeds: 1,
            draw: 0,
            sizes: 2,
            empty: 1,
            duration: 2.0,
            conditions: CaseConditions::Laboratory,
            jobs: 2,
            resume: false,
            replace: false,
        };
        let asked = AtomicUsize::new(0);
        let diagnose = |folder: &Path, _: &Path| {
            assert!(folder.join("rig.toml").is_file());
            asked.fetch_add(1, Ordering::Relaxed);
            Ok(Answer {
                schema: SCHEMA,
                verdict: Verdict::NothingMissing,
                explained: None,
                effects: Vec::new(),
                mismatch: Vec::new(),
                seconds: 1.0,
                alternatives: Vec::new(),
                notes: Vec::new(),
                details: Details::default(),
            })
        };
        let first = sweep(&plan, &out, &diagnose, &|_, _, _| ()).unwrap();
        assert_eq!((first.len(), asked.load(Ordering::Relaxed)), (3, 3));
        assert!(
            first[0].shows > 100.0 && first[1].shows < 6.0,
            "{} {}",
            first[0].shows,
            first[1].shows
        );
        assert!(!first[0].score.named_exactly && first[2].score.named_exactly);
        assert_eq!(
            std::fs::read_dir(&out).unwrap().count(),
            1,
            "no case is left"
        );

        let existing = sweep(&plan, &out, &diagnose, &|_, _, _| ()).unwrap_err();
        assert!(matches!(existing, ProofError::OutcomesExist { .. }));
        plan.replace = true;
        let again = sweep(&plan, &out, &diagnose, &|_, _, _| ()).unwrap();
        assert_eq!((again.len(), asked.load(Ordering::Relaxed)), (3, 6));
        plan.replace = false;
        plan.resume = true;
        std::fs::remove_file(out.join("outcomes/empty-1000000.json")).unwrap();
        let second = sweep(&plan, &out, &diagnose, &|_, _, _| ()).unwrap();
        let made = |all: &[Outcome]| all.iter().map(|o| o.made.clone()).collect::<Vec<_>>();
        assert_eq!(made(&second), made(&first));
        assert_eq!(asked.load(Ordering::Relaxed), 7);
        plan.duration = 3.0;
        let other = sweep(&plan, &out, &diagnose, &|_, _, _| ()).unwrap_err();
        assert!(matches!(other, ProofError::OtherPlan { .. }), "{other}");
        plan.effects = vec!["gremlins".to_owned()];
        assert!(
            sweep(&plan, &out, &diagnose, &|_, _, _| ())
                .unwrap_err()
                .to_string()
                .contains("gremlins")
        );
    }
}
