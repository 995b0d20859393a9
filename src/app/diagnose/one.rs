//! One case: rig.toml and recordings in, diagnosis.json, prediction.csv, improved.toml, account.txt and unlisted.svg out.

use std::path::{Path, PathBuf};
use std::time::Instant;

use super::super::error::AppError;
use super::super::files::{OutputFolder, Standing, files_of_cell, is_same};
use super::super::recordings::{check_finite, read_rig, shown_columns};
use super::cell;
use super::cell_account::add_cell;
use super::cell_scene::{Drawn, cell_scene};
use super::fit_picture;
use super::outputs::{DIAGNOSIS, HOW_TO_RUN, IMPROVED, NAMES, Outputs, stands_complete};
use super::unlisted_picture::picture;
use crate::diagnosis::answer::Answer;
use crate::diagnosis::case::{self, Case, NamedRecording, tolerated};
use crate::diagnosis::comparison::{Comparison, of_flange};
use crate::diagnosis::details::PredictionError;
use crate::diagnosis::diagnose::{Diagnosis, diagnose};
use crate::diagnosis::estimate::Number;
use crate::diagnosis::flange::{NoContact, Run, Shown};
use crate::diagnosis::flange_answer::FlangeDiagnosis;
use crate::diagnosis::joint_friction::JointFriction;
use crate::diagnosis::progress::Observer;
use crate::diagnosis::recorded::{recorded_of, run_of};
use crate::diagnosis::servo::{Axes, ServoLink};
use crate::effects::{PresentEffect, candidates, sought};
use crate::plant::{Chain, Channel, PlantParameters, simulate};
use crate::recording::csv::columns_text;
use crate::recording::provenance::Provenance;
use crate::recording::scene::Scene;
use crate::replay::LoadedCell;
use crate::scenario::effects::WrittenEffect;
use crate::scenario::recorded_cell::improved_cell_text;
use crate::scenario::rig_file::{RigFile, from_text, improved_text, load_rig};

const RIG: &str = "rig.toml";

/// Where the believed model stands.
enum Model {
    Rig(Box<RigFile>),
    Cell {
        cell: Box<LoadedCell>,
        axes: Option<Axes>,
        servo: Option<ServoLink>,
        frictions: Vec<JointFriction>,
        of_arm: Vec<PredictionError>,
    },
}

/// A case that can be diagnosed, and a folder that its files can go to.
pub(super) struct Prepared {
    name: String,
    work: Work,
    /// Files that it was read from, by their names for people.
    sources: Vec<(String, PathBuf)>,
    folder: OutputFolder,
}

/// What there is to diagnose.
enum Work {
    /// A plant that can be simulated.
    Plant {
        model: Model,
        case: Box<Case>,
        recordings: case::Prepared,
    },
    /// A contact flange, seen from outside.
    Flange {
        rig: Box<RigFile>,
        runs: Vec<(Run, Shown)>,
        unseen: Option<(Run, Shown)>,
    },
}

/// A case that was diagnosed; its files are written.
pub(super) struct Finished {
    /// What was found.
    pub answer: Answer,
    /// diagnosis.json.
    pub document: String,
    /// account.txt.
    pub account: String,
    /// Names of the files written.
    pub names: Vec<&'static str>,
}

/// Is this a folder with a case?
pub(super) fn is_case(folder: &Path) -> bool {
    folder.join(RIG).is_file()
}

/// The diagnosis that stands complete in a folder.
pub(super) fn complete(folder: &Path) -> Option<Answer> {
    let text = std::fs::read_to_string(folder.join(DIAGNOSIS)).ok()?;
    let answer: Answer = serde_json::from_str(&text).ok()?;
    stands_complete(folder).then_some(answer)
}

impl Prepared {
    /// Reads rig and recordings, then makes the folder: bad input leaves nothing behind.
    pub(super) fn new(
        folder: &Path,
        cell: Option<&LoadedCell>,
        out: &Path,
        standing: Standing,
    ) -> Result<Self, AppError> {
        let work = match cell {
            Some(cell) => plant_work(cell_case(folder, cell)?)?,
            None => {
                let rig = rig_of(folder)?;
                match rig.plant.chain {
                    Chain::ContactFlange => flange_work(rig, folder)?,
                    _ => plant_work(rig_case(rig, folder)?)?,
                }
            }
        };
        if standing == Standing::Refuse && out.join(DIAGNOSIS).exists() {
            return Err(AppError::Diagnosed {
                folder: out.display().to_string(),
            });
        }
        if is_same(folder, out) {
            return Err(AppError::AmongInputs {
                folder: out.display().to_string(),
            });
        }
        let own = folder.canonicalize();
        let own = own.as_deref().unwrap_or(folder);
        Ok(Self {
            name: own.file_name().unwrap_or_default().display().to_string(),
            sources: sources(folder, cell, &work),
            folder: OutputFolder::prepare(out, &NAMES, standing)?,
            work,
        })
    }

    /// Diagnoses it and writes its files; `observer` is told of its progress.
    pub(super) fn run(self, observer: &mut Observer<'_>) -> Result<Finished, AppError> {
        let start = Instant::now();
        let provenance = provenance(&self.sources)?;
        let (model, case, recordings) = match self.work {
            Work::Plant {
                model,
                case,
                recordings,
            } => (model, case, recordings),
            Work::Flange { rig, runs, unseen } => {
                let of = (self.name.as_str(), provenance);
                return flange(of, &self.folder, &rig, runs, unseen, start);
            }
        };
        let diagnosis = diagnose(&case, recordings, observer);
        let found = &diagnosis.best().fit.prediction.plant;
        let (improved, plant) = match &model {
            Model::Rig(rig) => {
                let text = improved(rig, &diagnosis);
                // As the file says it, so that whoever takes the file gets the same.
                let plant = from_text(Path::new(IMPROVED), &text)?.plant;
                (text, plant)
            }
            Model::Cell { cell, .. } => {
                let scenario = &cell.scenario;
                let effects = written(&scenario.effects, &diagnosis);
                (improved_cell_text(scenario, &effects)?, found.clone())
            }
        };
        let prediction = prediction(&case, &plant)?;
        let picture = picture(&diagnosis)?;
        let fit_picture = fit_picture::picture(&diagnosis)?;
        let mut answer = diagnosis.answer(start.elapsed().as_secs_f64());
        if let Model::Cell { of_arm, .. } = &model {
            answer.details.prediction.extend(of_arm.iter().cloned());
        }
        answer.details.case.clone_from(&self.name);
        answer.details.provenance = provenance;
        if let Model::Cell {
            cell,
            servo,
            frictions,
            of_arm,
            ..
        } = &model
        {
            let account = &mut answer.details.account;
            add_cell(account, cell, servo.as_ref(), frictions, of_arm, &diagnosis);
            if diagnosis.shape.is_some() {
                let place = "A cell's improved.toml has no place for a term without a name: it stands in prediction.csv alone.";
                account.add("What improved.toml leaves out", vec![place.to_owned()]);
            }
        }
        if !diagnosis.best().finds_nothing() {
            let improved = self.folder.path().join(IMPROVED);
            let how = how_to_run(&model, &improved.display().to_string());
            answer.details.account.add(HOW_TO_RUN, vec![how]);
        }
        let comparison = diagnosis.comparison(&case, &plant);
        let outputs = Outputs {
            answer,
            improved: &improved,
            prediction: prediction.as_deref(),
            picture: picture.as_deref(),
            fit_picture: fit_picture.as_deref(),
            scene: scene(&model, &case, &comparison, [&case.believed, &plant])?,
            comparison: &comparison,
        };
        outputs.write(&self.folder)
    }
}

/// What there is to do with the improved file.
fn how_to_run(model: &Model, improved: &str) -> String {
    match model {
        Model::Cell { cell, .. } if cell.scenario.has_job => format!(
            "`idc run {improved}` runs the cell with what was found, on the job of the scenario file; `idc compare` tells its run from others."
        ),
        Model::Cell { .. } => format!(
            "`idc diagnose RUNS --scenario {improved}` takes what was found as believed. The file has no job, so `idc run` does not take it."
        ),
        Model::Rig(_) => format!(
            "`idc predict {improved} INPUTS.csv` predicts a recording with what was found; a bench runs it as its device, with `device.model = \"{improved}\"`."
        ),
    }
}

/// What the first recording of a cell looks like in space.
fn scene(
    model: &Model,
    case: &Case,
    comparison: &Comparison,
    plants: [&PlantParameters; 2],
) -> Result<Option<Scene>, AppError> {
    let Model::Cell { cell, axes, .. } = model else {
        return Ok(None);
    };
    let first = case.recordings.first();
    let course = first.and_then(|first| first.recorded.inputs.cell.as_deref());
    let (Some(axes), Some(compared), Some(course)) = (axes, comparison.recordings.first(), course)
    else {
        return Ok(None);
    };
    let drawn = Drawn {
        axes,
        compared,
        course,
    };
    cell_scene(cell, &drawn, plants).map(Some)
}

/// The files that a case is read from.
fn sources(folder: &Path, cell: Option<&LoadedCell>, work: &Work) -> Vec<(String, PathBuf)> {
    let within = |name: &str| (name.to_owned(), folder.join(name));
    let models: Vec<(String, PathBuf)> = match cell.map(|cell| &cell.scenario) {
        Some(cell) => files_of_cell(&cell.path, &cell.arm, &cell.device, &cell.workpiece)
            .into_iter()
            .map(|path| (path.display().to_string(), path.clone()))
            .collect(),
        None => vec![within(RIG)],
    };
    let recordings: Vec<(String, PathBuf)> = match work {
        // Of a run of one's own the recording is a file in the folder that it is called by.
        Work::Plant { case, .. } => (case.recordings.iter().chain(&case.unseen))
            .map(|recording| (recording.name.clone(), PathBuf::from(&recording.file)))
            .collect(),
        Work::Flange { runs, unseen, .. } => (runs.iter().chain(unseen))
            .map(|(run, _)| within(&run.name))
            .collect(),
    };
    models.into_iter().chain(recordings).collect()
}

fn provenance(sources: &[(String, PathBuf)]) -> Result<Provenance, AppError> {
    let sources = sources
        .iter()
        .map(|(name, path)| (name.as_str(), path.as_path()));
    Ok(Provenance::of(sources, None)?)
}

/// prediction.csv: what the improved model says of the recording that is to be predicted.
fn prediction(case: &Case, plant: &PlantParameters) -> Result<Option<String>, AppError> {
    let Some(unseen) = &case.unseen else {
        return Ok(None);
    };
    let inputs = &unseen.recorded.inputs;
    let predicted = simulate(plant, inputs).readings;
    check_finite(IMPROVED, &unseen.file, &inputs.time, &predicted)?;
    let columns = shown_columns(plant.chain, case.noise.map(f64::is_finite), &predicted);
    Ok(Some(columns_text(&inputs.time, &columns)?))
}

fn plant_work((model, case): (Model, Case)) -> Result<Work, AppError> {
    Ok(Work::Plant {
        recordings: case::prepare(&case)?,
        model,
        case: Box::new(case),
    })
}

/// The runs of a contact flange.
fn flange_work(rig: RigFile, folder: &Path) -> Result<Work, AppError> {
    let shown = |name: &String| -> Result<(Run, Shown), AppError> {
        let path = folder.join(name);
        let file = path.display().to_string();
        let run = run_of(&file, name, &read_rig(rig.plant.chain, &path)?)?;
        let refused = |source: NoContact| AppError::NoContact {
            folder: folder.display().to_string(),
            source,
        };
        let shown = run.shown().map_err(refused)?;
        Ok((run, shown))
    };
    Ok(Work::Flange {
        runs: to_fit(&rig, folder)?
            .iter()
            .map(shown)
            .collect::<Result<_, _>>()?,
        unseen: rig.predict.as_ref().map(shown).transpose()?,
        rig: Box::new(rig),
    })
}

/// Names of the recordings to diagnose from; one with a star stands for all in the folder that fit it, but the one to be predicted, in order.
pub(in super::super) fn to_fit(rig: &RigFile, folder: &Path) -> Result<Vec<String>, AppError> {
    let mut names: Vec<String> = Vec::new();
    for name in &rig.fit {
        let Some((before, after)) = name.split_once('*') else {
            names.push(name.clone());
            continue;
        };
        let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
        let mut found: Vec<String> = entries
            .filter_map(|entry| entry.file_name().into_string().ok())
            .filter(|file| file.len() >= before.len() + after.len())
            .filter(|file| file.starts_with(before) && file.ends_with(after))
            .filter(|file| rig.predict.as_ref() != Some(file) && !names.contains(file))
            .collect();
        if found.is_empty() {
            return Err(AppError::NoneLike {
                file: rig.path.display().to_string(),
                pattern: name.clone(),
            });
        }
        found.sort_unstable();
        names.append(&mut found);
    }
    Ok(names)
}

/// Writes what the runs of a contact flange show.
fn flange(
    (name, provenance): (&str, Provenance),
    folder: &OutputFolder,
    rig: &RigFile,
    runs: Vec<(Run, Shown)>,
    unseen: Option<(Run, Shown)>,
    start: Instant,
) -> Result<Finished, AppError> {
    let (runs, shown): (Vec<Run>, Vec<Shown>) = runs.into_iter().unzip();
    let (unseen, foretold) = unseen.unzip();
    let named = |(run, shown): (&Run, Shown)| (run.name.clone(), shown);
    let diagnosis = FlangeDiagnosis {
        runs: runs.iter().zip(shown).map(named).collect(),
        unseen: unseen.as_ref().zip(foretold).map(named),
        mass: rig.plant.device.moving_mass,
        time_constant: rig.plant.device.regulator.time_constant,
        noise: rig.noise[Channel::Force as usize],
    };
    let mut answer = diagnosis.answer(start.elapsed().as_secs_f64());
    answer.details.case = name.to_owned();
    answer.details.provenance = provenance;
    // What was found cannot be simulated from outside: it stands in the file as a comment.
    let mut improved = improved_text(rig, &[], &[], None);
    for effect in &answer.effects {
        improved += &format!("\n# Found, and not simulated: {}\n", effect.name);
        for (key, number) in &effect.parameters {
            let (value, low, high) = (number.value, number.low, number.high);
            improved += &format!("# {key} = {value:.5e}   # {low:.3e} to {high:.3e}\n");
        }
    }
    let outputs = Outputs {
        answer,
        improved: &improved,
        prediction: None,
        picture: None,
        fit_picture: None,
        comparison: &of_flange(&runs, unseen.as_ref()),
        scene: None,
    };
    outputs.write(folder)
}

/// The rig file of a case.
pub(in super::super) fn rig_of(folder: &Path) -> Result<RigFile, AppError> {
    if !is_case(folder) {
        return Err(AppError::NoCase {
            folder: folder.display().to_string(),
        });
    }
    let rig = load_rig(&folder.join(RIG))?;
    if rig.fit.is_empty() {
        return Err(AppError::NoRecordings {
            file: rig.path.display().to_string(),
        });
    }
    if rig.plant.latent.is_some() {
        return Err(AppError::Latent {
            file: rig.path.display().to_string(),
        });
    }
    Ok(rig)
}

/// A rig file and the recordings that it names.
fn rig_case(rig: RigFile, folder: &Path) -> Result<(Model, Case), AppError> {
    let case = case_of(&rig, folder)?;
    Ok((Model::Rig(Box::new(rig)), case))
}

/// A cell's recordings.
fn cell_case(folder: &Path, cell: &LoadedCell) -> Result<(Model, Case), AppError> {
    let read = cell::read(cell, folder)?;
    let model = Model::Cell {
        cell: Box::new(cell.clone()),
        axes: read.axes,
        servo: read.servo,
        frictions: read.frictions,
        of_arm: read.of_arm,
    };
    Ok((model, read.case))
}

/// The effects of an improved file: what the believed one names already stays, unless what was found stands in its place.
fn written<'a>(present: &'a [PresentEffect], diagnosis: &'a Diagnosis) -> Vec<WrittenEffect<'a>> {
    let found = &diagnosis.estimates.effects;
    let kept = present.iter().filter_map(|present| {
        let effect = present.effect;
        if found.iter().any(|(new, _)| new.excludes(effect)) || is_sought(present) {
            return None;
        }
        let parameters = effect.parameters(&diagnosis.believed);
        let pairs = parameters.iter().zip(&present.values);
        Some(WrittenEffect {
            effect,
            law: present.law.as_deref(),
            parameters: pairs
                .map(|(p, value)| (p.quantity.name, *value, None))
                .collect(),
        })
    });
    let new = found.iter().map(|(effect, numbers)| {
        let parameters = effect.parameters(&diagnosis.believed);
        let own = |n: &&Number| parameters.iter().any(|p| p.quantity.name == n.name);
        let numbers = numbers.iter().filter(own);
        WrittenEffect {
            effect,
            law: diagnosis.law_of(effect),
            parameters: numbers
                .map(|n| (n.name, n.value, Some(n.interval)))
                .collect(),
        }
    });
    kept.chain(new).collect()
}

/// Is it a law whose numbers were sought? Then it stands in the file only where they were found.
fn is_sought(present: &PresentEffect) -> bool {
    let law = present.law.as_ref();
    law.is_some_and(|law| law.constants.iter().any(|c| c.range.is_some()))
}

fn case_of(rig: &RigFile, folder: &Path) -> Result<Case, AppError> {
    let read = |name: &String| -> Result<NamedRecording, AppError> {
        let path = folder.join(name);
        let file = path.display().to_string();
        let recorded = recorded_of(rig.plant.chain, &file, &read_rig(rig.plant.chain, &path)?)?;
        let recorded = recorded.of_sensors(rig.sensors());
        Ok(NamedRecording {
            name: name.clone(),
            file,
            recorded,
        })
    };
    let tolerances = rig.tolerances.iter();
    let mut believed = rig.plant.clone();
    let own = sought(&mut believed);
    Ok(Case {
        believed,
        tolerated: tolerances
            .map(|t| tolerated(t.quantity, t.value, t.tolerance))
            .chain(case::of_link(
                rig.plant.chain,
                rig.noise[0],
                rig.pressure_drift,
            ))
            .collect(),
        noise: rig.noise,
        recordings: to_fit(rig, folder)?
            .iter()
            .map(read)
            .collect::<Result<_, _>>()?,
        unseen: rig.predict.as_ref().map(read).transpose()?,
        candidates: candidates(rig.plant.chain).into_iter().chain(own).collect(),
        shown: Vec::new(),
    })
}

/// improved.toml: the rig file with what was found.
fn improved(rig: &RigFile, diagnosis: &Diagnosis) -> String {
    let estimates = &diagnosis.estimates;
    let tolerated: Vec<(&str, f64, f64, f64)> = estimates
        .tolerated
        .iter()
        .map(|n| (n.name, n.value, n.interval[0], n.interval[1]))
        .collect();
    let effects = written(&rig.effects, diagnosis);
    improved_text(rig, &tolerated, &effects, diagnosis.best().unlisted())
}
