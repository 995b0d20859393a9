//! A case of a diagnosis: a folder with recordings, and the nominal model of what they were recorded from.

mod arm;
mod arm_prediction;
mod arm_recording;
mod band;
mod cell;
mod cell_account;
mod cell_drives;
mod diagnosed;
mod error;
mod explanations;
mod flange_prediction;
mod ground;
mod improved;
mod postures;
mod recordings;
mod removal_table;
mod rig;
mod stills;

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Instant;

pub use arm::{
    ARM, ArmLogs, ArmPrediction, LogSummary, PredictedColumn, arm_of, logs_of, predict_arm,
    unrecorded,
};
pub use arm_recording::usual_column;
pub use band::{Predicted, predicted_by};
pub use cell::is_cell_case;
pub use diagnosed::{DRIVES, Diagnosed, IDENTIFIED, IMPROVED, IMPROVED_ARM};
pub use error::CaseError;
pub use explanations::{EXPLANATIONS, Explanations, Kept};
pub use flange_prediction::{FlangePrediction, predict_flange_run};
pub use postures::{
    POSTURES, PosturesCase, PosturesDiagnosed, PosturesPrediction, is_postures_case,
    predict_postures,
};
pub use recordings::{check_finite, read_in_any_unit, read_rig, shown_columns};
pub use removal_table::{RemovalCase, RemovalDiagnosed, TablePrediction, predict_table};
pub use rig::{RIG, rig_of, to_fit};

use crate::diagnosis::answer::Answer;
use crate::diagnosis::answer::details::UnknownGround;
use crate::diagnosis::answer::estimate::Estimate;
use crate::diagnosis::answer::finding::Diagnosis;
use crate::diagnosis::data_fault::fault::DataFault;
use crate::diagnosis::data_fault::{as_read, refined, reported};
use crate::diagnosis::diagnose as search;
use crate::diagnosis::difference::comparison::{Comparison, of_flange};
use crate::diagnosis::experiment::ride::ArmReach;
use crate::diagnosis::flange::Run;
use crate::diagnosis::flange::answer::FlangeDiagnosis;
use crate::diagnosis::flange::fit::fit_flange;
use crate::diagnosis::joints::servo::Axes;
use crate::diagnosis::recordings::input::{DiagnosisInput, prepare};
use crate::diagnosis::recordings::recorded::COLUMNS;
use crate::diagnosis::search::known::{KnownEffects, KnownFit, known_fit};
use crate::diagnosis::search::progress::Observer;
use crate::diagnosis::settings::Settings;
use crate::effects::own_effect;
use crate::flange::FittedFlange;
use crate::plant::{
    Channel, DeviceParts, LawText, OperatingLimits, OwnLaw, PlantInputs, PlantParameters, simulate,
};
use crate::recording::csv::columns_text;
use crate::recording::provenance::Provenance;
use crate::replay::LoadedCell;
use crate::scenario::files_of_cell;
use crate::scenario::recorded_cell::improved_cell_text;
use crate::scenario::rig_file::{Improved, Known, RigFile, from_text, improved_text};
use arm::ArmCase;
use cell::CellCase;
use rig::MeasuredRun;

/// Model and recordings, read and checked.
pub struct Case {
    /// Name of the folder.
    pub name: String,
    folder: PathBuf,
    /// Recordings beside those that its file names.
    added: Vec<PathBuf>,
    kind: Kind,
}

/// Kind of rig of the recordings.
enum Kind {
    Rig {
        rig: Box<RigFile>,
        input: Box<DiagnosisInput>,
    },
    Cell {
        cell: Box<LoadedCell>,
        read: Box<CellCase>,
    },
    /// A contact flange, seen from outside.
    Flange {
        rig: Box<RigFile>,
        runs: Vec<MeasuredRun>,
        unseen: Option<Box<MeasuredRun>>,
    },
    /// A recorded arm.
    Arm(Box<ArmCase>),
}

/// Whether a folder holds a recorded arm.
#[must_use]
pub fn is_arm_case(folder: &Path) -> bool {
    !folder.join(RIG).is_file() && folder.join(ARM).is_file()
}

impl Case {
    /// Reads a folder with a rig.toml or an arm.toml and the recordings that it names.
    ///
    /// # Errors
    /// A folder that holds none, or what is wrong with rig file or recordings.
    pub fn from_folder(folder: &Path) -> Result<Self, CaseError> {
        if is_arm_case(folder) {
            let case = Box::new(ArmCase::from_folder(folder)?);
            return Ok(Self::new(folder, Kind::Arm(case)));
        }
        let rig = Box::new(rig_of(folder)?);
        if rig.plant.parts == DeviceParts::ContactFlange {
            let (runs, unseen) = rig::flange_runs(&rig, folder)?;
            let unseen = unseen.map(Box::new);
            return Ok(Self::new(folder, Kind::Flange { rig, runs, unseen }));
        }
        let input = Box::new(rig::input_of(&rig, folder)?);
        // Refused before anything is written.
        prepare(&input)?;
        Ok(Self::new(folder, Kind::Rig { rig, input }))
    }

    /// Reads recordings of a rig that stand anywhere, whatever its file names.
    ///
    /// # Errors
    /// What is wrong with one of them, or a rig whose recordings are not fitted together.
    pub fn of_rig(rig: &RigFile, folder: &Path, names: &[String]) -> Result<Self, CaseError> {
        let mut rig = rig.clone();
        if rig.plant.parts == DeviceParts::ContactFlange {
            return Err(CaseError::TriedOnFlange {
                folder: folder.display().to_string(),
            });
        }
        rig.fit = names.to_vec();
        rig.predict = None;
        let rig = Box::new(rig);
        let input = Box::new(rig::input_of(&rig, folder)?);
        prepare(&input)?;
        Ok(Self::new(folder, Kind::Rig { rig, input }))
    }

    /// Reads a case of a device on a bench, with recordings beside those that its rig file names.
    ///
    /// # Errors
    /// A case of another kind, what is wrong with rig file or recordings.
    pub fn with_recordings(folder: &Path, recordings: &[PathBuf]) -> Result<Self, CaseError> {
        if recordings.is_empty() {
            return Self::from_folder(folder);
        }
        let refused = || CaseError::NothingToAddTo {
            folder: folder.display().to_string(),
        };
        if is_arm_case(folder) {
            return Err(refused());
        }
        let mut rig = Box::new(rig_of(folder)?);
        if rig.plant.parts != DeviceParts::Whole {
            return Err(refused());
        }
        rig.fit = to_fit(&rig, folder)?;
        let names = recordings.iter().map(|own| explanations::whole(own));
        rig.fit.extend(names.map(|own| own.display().to_string()));
        let input = Box::new(rig::input_of(&rig, folder)?);
        prepare(&input)?;
        Ok(Self {
            added: recordings.to_vec(),
            ..Self::new(folder, Kind::Rig { rig, input })
        })
    }

    /// Has the diagnosis go on from explanations that were found in a part of the recordings.
    pub fn go_on_from(&mut self, explanations: &Explanations) {
        let input = match &mut self.kind {
            Kind::Rig { input, .. } => Some(input.as_mut()),
            Kind::Cell { read, .. } => Some(&mut read.input),
            Kind::Flange { .. } | Kind::Arm(_) => None,
        };
        if let Some(input) = input {
            let kept = explanations.explanations.iter();
            input.kept = kept.map(|own| own.explanation.clone()).collect();
        }
    }

    /// Fits effects that are known to the recordings, without a search; none where only a search can.
    ///
    /// # Errors
    /// A recording that cannot be made fit.
    pub fn known_fit(&self, sets: &[KnownEffects]) -> Result<Option<KnownFit>, CaseError> {
        let Some(input) = self
            .input()
            .filter(|i| i.nominal.parts == DeviceParts::Whole)
        else {
            return Ok(None);
        };
        let prepared = prepare(input)?;
        Ok(known_fit(
            input,
            &prepared.evidence,
            sets,
            &Settings::default(),
        ))
    }

    /// Reads a folder with recordings of a cell, files or folders of runs, with such recordings beside them.
    ///
    /// # Errors
    /// A folder without any, or what is wrong with one.
    pub fn of_cell(
        folder: &Path,
        cell: &LoadedCell,
        recordings: &[PathBuf],
    ) -> Result<Self, CaseError> {
        let read = Box::new(cell::read(cell, folder, recordings)?);
        prepare(&read.input)?;
        let cell = Box::new(cell.clone());
        Ok(Self {
            added: recordings.to_vec(),
            ..Self::new(folder, Kind::Cell { cell, read })
        })
    }

    /// Puts a law of a user's among what may be missing. However the search ends, the answer says how it fares.
    ///
    /// # Errors
    /// A law that is not finite somewhere in the recordings, a contact flange.
    pub fn try_law(&mut self, law: LawText) -> Result<(), CaseError> {
        let input = match &mut self.kind {
            Kind::Rig { input, .. } => input,
            Kind::Cell { read, .. } => &mut read.input,
            Kind::Flange { .. } => {
                return Err(CaseError::TriedOnFlange {
                    folder: self.folder.display().to_string(),
                });
            }
            Kind::Arm(_) => {
                return Err(CaseError::TriedOnArm {
                    folder: self.folder.display().to_string(),
                });
            }
        };
        check_in_recordings(&law, input)?;
        let mut own = OwnLaw::new(&Arc::new(law));
        own.acts = false;
        let effect = own_effect(&own.text, input.nominal.own.len());
        input.nominal.own.push(own);
        input.candidates.push(effect);
        input.tried = Some(effect);
        Ok(())
    }

    fn new(folder: &Path, kind: Kind) -> Self {
        let whole = folder.canonicalize();
        let whole = whole.as_deref().unwrap_or(folder);
        Self {
            name: whole.file_name().unwrap_or_default().display().to_string(),
            folder: folder.to_owned(),
            added: Vec::new(),
            kind,
        }
    }

    /// The cell that the recordings are of; none where they are of a rig.
    #[must_use]
    pub fn cell(&self) -> Option<&LoadedCell> {
        match &self.kind {
            Kind::Cell { cell, .. } => Some(cell),
            _ => None,
        }
    }

    /// Whether it is of a recorded arm.
    #[must_use]
    pub fn is_of_arm(&self) -> bool {
        matches!(self.kind, Kind::Arm(_))
    }

    /// Commands and encoders of the first recording of a cell.
    #[must_use]
    pub fn axes(&self) -> Option<&Axes> {
        match &self.kind {
            Kind::Cell { read, .. } => read.axes.as_ref(),
            _ => None,
        }
    }

    /// Inputs of the search; none of a contact flange or an arm.
    #[must_use]
    pub fn input(&self) -> Option<&DiagnosisInput> {
        match &self.kind {
            Kind::Rig { input, .. } => Some(input),
            Kind::Cell { read, .. } => Some(&read.input),
            Kind::Flange { .. } | Kind::Arm(_) => None,
        }
    }

    /// The rig file of a whole device on a bench; none of anything else.
    #[must_use]
    pub fn bench_rig(&self) -> Option<&RigFile> {
        match &self.kind {
            Kind::Rig { rig, .. } if rig.plant.parts == DeviceParts::Whole => Some(rig),
            _ => None,
        }
    }

    /// How far an experiment may move what the recordings are of, by its file; none where no experiment is proposed.
    #[must_use]
    pub fn operating_limits(&self) -> Option<OperatingLimits> {
        match &self.kind {
            Kind::Cell { cell, .. } => Some(cell.scenario.limits.clone()),
            _ => self.bench_rig().map(|rig| rig.limits.clone()),
        }
    }

    /// How far an experiment may move the arm of a cell; none on a bench, or where it never moved while the device pressed.
    #[must_use]
    pub fn arm_reach(&self) -> Option<ArmReach> {
        match &self.kind {
            Kind::Cell { cell, read } => read.arm_reach(cell),
            _ => None,
        }
    }

    fn rig_source(&self) -> (String, PathBuf) {
        match &self.kind {
            Kind::Rig { rig, .. } | Kind::Flange { rig, .. } => (RIG.to_owned(), rig.path.clone()),
            Kind::Cell { .. } => (RIG.to_owned(), self.folder.join(RIG)),
            Kind::Arm(case) => (ARM.to_owned(), case.file.path.clone()),
        }
    }

    /// Files that it was read from, by their names for people.
    fn sources(&self) -> Vec<(String, PathBuf)> {
        let within = |name: &str| (name.to_owned(), self.folder.join(name));
        let mut sources = match self.cell().map(|cell| &cell.scenario) {
            Some(cell) => files_of_cell(&cell.path, &cell.arm, &cell.device, &cell.workpiece, &[])
                .into_iter()
                .map(|path| (path.display().to_string(), path.clone()))
                .collect(),
            None => vec![self.rig_source()],
        };
        if let Kind::Flange { runs, unseen, .. } = &self.kind {
            let all = runs.iter().chain(unseen.as_deref());
            sources.extend(all.map(|(run, _)| within(&run.name)));
        }
        if let Kind::Arm(case) = &self.kind {
            let urdf = case.file.urdf.clone();
            sources.push((urdf.display().to_string(), urdf));
            sources.extend(case.sources.iter().cloned());
        }
        // Of a run of this program the recording is a file in the folder that it is called by.
        let recordings = self
            .input()
            .map(|input| input.recordings.iter().chain(&input.unseen));
        let named = recordings.into_iter().flatten();
        sources.extend(named.map(|r| (r.name.clone(), PathBuf::from(&r.file))));
        sources
    }

    /// The files that it is made of, as they stand now.
    ///
    /// # Errors
    /// One that is gone.
    pub fn provenance(&self) -> Result<Provenance, CaseError> {
        let sources = self.sources();
        let named = sources
            .iter()
            .map(|(name, path)| (name.as_str(), path.as_path()));
        Ok(Provenance::of(named, None)?)
    }
}

/// Diagnoses a case; `observer` gets its progress.
///
/// # Errors
/// An improved model that cannot be written or simulated, a source that cannot be read again.
pub fn diagnose(
    case: &Case,
    settings: &Settings,
    observer: &mut Observer<'_>,
) -> Result<Diagnosed, CaseError> {
    let start = Instant::now();
    let provenance = case.provenance()?;
    let mut diagnosed = match &case.kind {
        Kind::Rig { rig, input } => {
            let mut diagnosis = search::diagnose(input, prepare(input)?, settings, observer);
            let faults = refined_by(&mut diagnosis, input);
            let mut improved = improved::improved_rig(rig, &diagnosis);
            for fault in &faults {
                improved += &format!(
                    "\n# Found in the recordings, and not in this model: {}\n",
                    fault.words()
                );
            }
            // As the file says it, so that whoever takes the file gets the same.
            let model = |rig: RigFile| Model {
                plant: rig.plant,
                bare: rig.bare,
                known: rig.known.unwrap_or_default(),
            };
            let read = from_text(Path::new(IMPROVED), &improved).map(model);
            of_plant((input, &faults), diagnosis, improved, read, start)
        }
        Kind::Cell { cell, read } => {
            let diagnosis =
                search::diagnose(&read.input, prepare(&read.input)?, settings, observer);
            let effects = improved::written(&cell.scenario.effects, &diagnosis);
            let arm_file = read.arm.as_ref().map(|_| IMPROVED_ARM);
            let improved = improved_cell_text(&cell.scenario, &effects, arm_file);
            let written = improved.as_ref().map(|_| ());
            let plant = written
                .map(|()| Model::of(&diagnosis))
                .map_err(ToString::to_string);
            let improved = improved.unwrap_or_else(|error| format!("# Not written: {error}\n"));
            let of_data = (&read.input, &read.input.data_faults[..]);
            let mut diagnosed = of_plant(of_data, diagnosis, improved, plant, start);
            if let Some(diagnosis) = &diagnosed.diagnosis {
                cell_account::add_cell(&mut diagnosed.answer.details, diagnosis, cell, read);
            }
            if let (Some(arm), Some(plant)) = (&read.arm, diagnosed.plant.clone()) {
                let known: Vec<&PlantInputs> = (read.input.recordings.iter())
                    .map(|own| &own.recorded.inputs)
                    .collect();
                let unseen = read.input.unseen.as_ref().map(|own| &own.recorded.inputs);
                arm.add_to(&mut diagnosed, cell, (&plant, &known, unseen), observer)?;
            }
            diagnosed
        }
        Kind::Flange { rig, runs, unseen } => of_flange_runs(rig, runs, unseen.as_deref(), start)?,
        Kind::Arm(case) => case.diagnosed(start, observer)?,
    };
    diagnosed.answer.details.case.clone_from(&case.name);
    if let (Some(diagnosis), Some(_)) = (&diagnosed.diagnosis, case.operating_limits()) {
        let scenario = case.cell().map(|cell| cell.scenario.path.as_path());
        let of = (case.folder.as_path(), scenario, &case.added[..]);
        diagnosed.explanations = Some(Explanations::of(of, diagnosis, &provenance));
    }
    diagnosed.answer.details.provenance = provenance;
    Ok(diagnosed)
}

/// Checks that a law is finite at every sample of the recordings, as the nominal model runs them.
fn check_in_recordings(law: &LawText, input: &DiagnosisInput) -> Result<(), CaseError> {
    for recording in input.recordings.iter().chain(&input.unseen) {
        let inputs = &recording.recorded.inputs;
        let trajectory = simulate(&input.nominal, inputs);
        for (sample, time) in inputs.time.iter().enumerate() {
            law.check_at(&trajectory.truth.moment(inputs, sample))
                .map_err(|error| {
                    let text = law.expression.text();
                    let before = text.get(..error.span.start).unwrap_or_default();
                    CaseError::TriedNotFinite {
                        part: text.get(error.span.clone()).unwrap_or(text).to_owned(),
                        location: before.chars().count() + 1,
                        recording: recording.name.clone(),
                        time_s: *time,
                    }
                })?;
        }
    }
    Ok(())
}

/// Faults of the data as the best explanation has them, in the notes of the diagnosis too, which begin with them.
fn refined_by(diagnosis: &mut Diagnosis, input: &DiagnosisInput) -> Vec<DataFault> {
    let residuals = &diagnosis.best().fit.prediction.residuals;
    let faults = refined(
        &input.data_faults,
        &diagnosis.evidence,
        &input.noise,
        residuals,
    );
    let words = faults.iter().map(DataFault::words);
    diagnosis.notes.splice(..input.data_faults.len(), words);
    faults
}

/// A model that predicts.
#[derive(Clone)]
struct Model {
    plant: PlantParameters,
    /// The same without what was found.
    bare: PlantParameters,
    known: Known,
}

impl Model {
    /// The best explanation as it was fitted.
    fn of(diagnosis: &Diagnosis) -> Self {
        Self {
            plant: diagnosis.best().fit.prediction.plant.clone(),
            bare: diagnosis.baseline.plant.clone(),
            known: improved::known(diagnosis),
        }
    }
}

/// Files of what was found; a step that fails is noted, and what was found stands without it. `read` is the improved model as its file says it.
fn of_plant(
    (input, faults): (&DiagnosisInput, &[DataFault]),
    mut diagnosis: Diagnosis,
    improved: String,
    read: Result<Model, impl std::fmt::Display>,
    start: Instant,
) -> Diagnosed {
    let best = Model::of(&diagnosis);
    let (model, failed) = match read {
        Ok(model) => (model, None),
        Err(error) => (
            best.clone(),
            Some(format!("improved.toml is not as it should be: {error}")),
        ),
    };
    diagnosis.notes.extend(failed);
    let with = |plant: &PlantParameters| Model {
        plant: plant.clone(),
        ..best.clone()
    };
    let models = [
        ("the improved model", model),
        ("the explanation as it was fitted", best.clone()),
        (
            "the nominal model within its tolerances",
            with(&diagnosis.baseline.plant),
        ),
        ("the nominal model", with(&diagnosis.nominal)),
    ];
    let (predicted, notes) = first_prediction((input, faults), &models);
    diagnosis.notes.extend(notes);
    let (prediction, unknown) = predicted.unzip();
    let unknown = unknown.unwrap_or_default();
    let name = input
        .unseen
        .as_ref()
        .map_or("", |unseen| unseen.name.as_str());
    diagnosis.notes.extend(UnknownGround::words(name, &unknown));
    let [(_, Model { plant, .. }), ..] = models;
    let mut answer = diagnosis.answer(start.elapsed().as_secs_f64());
    answer.details.unknown_ground = unknown;
    Diagnosed {
        prediction,
        comparison: diagnosis.comparison(input, &plant),
        answer: reported(answer, faults),
        improved,
        diagnosis: Some(diagnosis),
        explanations: None,
        plant: Some(plant),
        beside: Vec::new(),
    }
}

/// The prediction by the first model that stays finite, with a note where that is not the first.
fn first_prediction(
    (input, faults): (&DiagnosisInput, &[DataFault]),
    models: &[(&str, Model)],
) -> (Option<(String, Vec<UnknownGround>)>, Option<String>) {
    let mut failed: Option<String> = None;
    for (name, model) in models {
        match prediction(input, faults, model) {
            Ok(predicted) => {
                let note = failed.map(|error| format!("prediction.csv is that of {name}: {error}"));
                return (predicted, note);
            }
            Err(error) => failed = failed.or(Some(error.to_string())),
        }
    }
    let note = failed.map(|error| format!("there is no prediction.csv: {error}"));
    (None, note)
}

/// The improved model's prediction of the recording that was kept back.
fn prediction(
    input: &DiagnosisInput,
    faults: &[DataFault],
    Model { plant, bare, known }: &Model,
) -> Result<Option<(String, Vec<UnknownGround>)>, CaseError> {
    let Some(unseen) = &input.unseen else {
        return Ok(None);
    };
    let inputs = &unseen.recorded.inputs;
    let mut predicted = band::predicted((plant, bare), known, inputs);
    check_finite(IMPROVED, &unseen.file, &inputs.time, &predicted.readings)?;
    // As the sensors would read it, at the stamps of their log.
    let mut stamps = Vec::new();
    for readings in [
        &mut predicted.readings,
        &mut predicted.low,
        &mut predicted.high,
    ] {
        (stamps, *readings) = as_read(faults, &inputs.time, std::mem::take(readings));
    }
    predicted.order();
    let shown = shown_columns(
        plant.parts,
        input.noise.map(f64::is_finite),
        &predicted.readings,
    );
    let columns = predicted.columns(&shown);
    let columns: Vec<(&str, &[f64])> = (columns
        .iter()
        .map(|(name, values)| (name.as_str(), values.as_slice())))
    .collect();
    Ok(Some((columns_text(&stamps, &columns)?, predicted.unknown)))
}

/// Results of the runs of a contact flange.
fn of_flange_runs(
    rig: &RigFile,
    runs: &[MeasuredRun],
    unseen: Option<&MeasuredRun>,
    start: Instant,
) -> Result<Diagnosed, CaseError> {
    let named = |(run, shown): &MeasuredRun| (run.name.clone(), shown.clone());
    let others: Vec<&MeasuredRun> = unseen.into_iter().collect();
    let fit = fit_flange(runs, &others, rig.plant.device.moving_mass);
    let (simulated, fitted, forces) = match fit {
        Some(fit) => (Some(fit.report), Some(fit.fitted), fit.forces),
        None => (None, None, Vec::new()),
    };
    let diagnosis = FlangeDiagnosis {
        runs: runs.iter().map(named).collect(),
        unseen: unseen.map(named),
        mass: rig.plant.device.moving_mass,
        time_constant: rig.plant.device.regulator.time_constant,
        noise: rig.noise[Channel::Force as usize],
        simulated,
    };
    let answer = diagnosis.answer(start.elapsed().as_secs_f64());
    let runs: Vec<Run> = runs.iter().map(|(run, _)| run.clone()).collect();
    let comparison = of_flange(&runs, unseen.map(|(run, _)| run), &forces);
    Ok(Diagnosed {
        improved: improved_flange(rig, &answer, fitted.as_ref()),
        prediction: predicted_force(&comparison)?,
        answer,
        comparison,
        diagnosis: None,
        explanations: None,
        plant: None,
        beside: Vec::new(),
    })
}

/// The rig file of a flange with the fitted one; what its runs show stands there as comments.
fn improved_flange(rig: &RigFile, answer: &Answer, flange: Option<&FittedFlange>) -> String {
    let mut improved = improved_text(
        rig,
        &Improved {
            flange,
            ..Improved::default()
        },
    );
    for effect in &answer.effects {
        improved += &format!("\n# Found in the runs: {}\n", effect.name);
        for (
            key,
            Estimate {
                value, low, high, ..
            },
        ) in &effect.parameters
        {
            improved += &format!("# {key} = {value:.5e}   # {low:.3e} to {high:.3e}\n");
        }
    }
    improved
}

/// The force predicted of the run that was kept back, while it is simulated.
fn predicted_force(comparison: &Comparison) -> Result<Option<String>, CaseError> {
    let Some(unseen) = comparison.recordings.iter().find(|run| run.unseen) else {
        return Ok(None);
    };
    let force = &unseen.channels[0].improved;
    let known: Vec<usize> = (0..force.len()).filter(|i| force[*i].is_finite()).collect();
    if known.is_empty() {
        return Ok(None);
    }
    let of = |values: &[f64]| -> Vec<f64> { known.iter().map(|i| values[*i]).collect() };
    let column = COLUMNS[Channel::Force as usize];
    Ok(Some(columns_text(
        &of(&unseen.time),
        &[(column, &of(force))],
    )?))
}
