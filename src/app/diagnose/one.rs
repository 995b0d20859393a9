//! One case: rig.toml and recordings in, diagnosis.json, prediction.csv, improved.toml, account.txt and unlisted.svg out.

use std::path::{Path, PathBuf};

use super::super::error::AppError;
use super::super::files::{DIAGNOSIS, OutputFolder, OverwritePolicy, is_same};
use super::cell_scene::{Drawn, cell_scene};
use super::fit_picture;
use super::flange_picture;
use super::outputs::{Finished, NAMES, Outputs, lacking};
use super::postures_picture;
use super::removal_picture;
use super::unlisted_picture::picture;
use crate::case::{
    Case, Diagnosed, EXPLANATIONS, Explanations, IMPROVED, PosturesCase, PosturesDiagnosed, RIG,
    RemovalCase, RemovalDiagnosed, diagnose, is_arm_case, is_postures_case,
};
use crate::diagnosis::answer::Answer;
use crate::diagnosis::answer::account::SectionKind;
use crate::diagnosis::answer::details::DETAILS_SCHEMA;
use crate::diagnosis::difference::comparison::Comparison;
use crate::diagnosis::effort::EffortLimit;
use crate::diagnosis::search::progress::Observer;
use crate::diagnosis::settings::Settings;
use crate::plant::LawText;
use crate::recording::provenance::Provenance;
use crate::recording::seal::{SealError, read_sealed};
use crate::replay::LoadedCell;
use crate::scenario::removal_table::is_removal_table;
use crate::scene::Scene;
use crate::shell::word;

/// What can be diagnosed.
enum Subject {
    /// Recordings of a rig or a cell.
    Recordings(Box<Case>),
    /// A table of runs.
    Table(Box<RemovalCase>),
    /// Still postures of a wrench sensor.
    Postures(Box<PosturesCase>),
}

/// A case that can be diagnosed, and a folder that its files can go to, where they are to be written.
pub(super) struct Prepared {
    subject: Subject,
    settings: Settings,
    folder: Option<OutputFolder>,
    /// What is asked for besides the files, as the seal has it.
    asked: String,
    /// Explanations of an earlier diagnosis in the folder, where recordings have come since.
    earlier: Option<Explanations>,
}

/// Whether this is a folder with a case.
pub(super) fn is_case(folder: &Path) -> bool {
    folder.join(RIG).is_file() || is_arm_case(folder) || is_postures_case(folder)
}

impl Subject {
    /// The files that it is made of, as they stand now.
    fn provenance(&self) -> Result<Provenance, AppError> {
        Ok(match self {
            Self::Recordings(case) => case.provenance()?,
            Self::Table(case) => case.provenance()?,
            Self::Postures(case) => case.provenance()?,
        })
    }
}

/// Makes the folder for the files of a case's diagnosis.
fn prepare(case: &Path, out: &Path, policy: OverwritePolicy) -> Result<OutputFolder, AppError> {
    if policy == OverwritePolicy::Refuse && out.join(DIAGNOSIS).exists() {
        return Err(AppError::Diagnosed {
            folder: out.display().to_string(),
        });
    }
    if is_same(case, out) {
        return Err(AppError::AmongInputs {
            folder: out.display().to_string(),
        });
    }
    OutputFolder::prepare(out, &NAMES, policy)
}

/// A diagnosis that stands, with diagnosis.json.
pub(super) struct Existing {
    /// The finding.
    pub answer: Answer,
    /// diagnosis.json.
    pub document: String,
}

impl Prepared {
    /// Reads rig and recordings and takes a law to be tried, then makes the folder: bad input leaves nothing behind.
    pub(super) fn new(
        (folder, recordings): (&Path, &[PathBuf]),
        (cell, tried, limit): (Option<&LoadedCell>, Option<LawText>, EffortLimit),
        out: Option<(&Path, OverwritePolicy)>,
    ) -> Result<Self, AppError> {
        let is_table = cell.is_none() && is_removal_table(&folder.join(RIG));
        let is_other = folder.join(RIG).is_file() || is_arm_case(folder);
        let is_still = cell.is_none() && !is_other && is_postures_case(folder);
        if (is_table || is_still) && tried.is_some() {
            return Err(AppError::NoLawOfTable {
                folder: folder.display().to_string(),
            });
        }
        let mut asked = format!("{limit:?}");
        let subject = if is_table {
            Subject::Table(Box::new(RemovalCase::from_folder(folder)?))
        } else if is_still {
            Subject::Postures(Box::new(PosturesCase::from_folder(folder)?))
        } else {
            let mut case = match cell {
                Some(cell) => Case::of_cell(folder, cell, recordings)?,
                None => Case::with_recordings(folder, recordings)?,
            };
            if let Some(law) = tried {
                asked += &format!(" {law:?}");
                case.try_law(law)?;
            }
            Subject::Recordings(Box::new(case))
        };
        let state = out.map(|(out, _)| out.join(EXPLANATIONS));
        let state = state.filter(|state| !recordings.is_empty() && state.is_file());
        let earlier = state.map(|state| Explanations::read(&state)).transpose()?;
        // What is gone on from is taken in by what comes of it; results of another case are not.
        let goes_on = match (&earlier, &subject) {
            (Some(earlier), Subject::Recordings(case)) => {
                earlier.lost(&case.provenance()?).is_none()
            }
            _ => false,
        };
        let policy = |policy| match goes_on {
            true => OverwritePolicy::Replace,
            false => policy,
        };
        let prepared = out.map(|(out, asked)| prepare(folder, out, policy(asked)));
        Ok(Self {
            earlier,
            subject,
            settings: Settings {
                limit,
                ..Settings::default()
            },
            folder: prepared.transpose()?,
            asked,
        })
    }

    /// Goes on from the explanations of the others where recordings have come; or why it cannot, where it could be expected to.
    pub(super) fn begins_anew(&mut self) -> Result<Option<String>, AppError> {
        let (Some(earlier), Subject::Recordings(case)) = (&self.earlier, &mut self.subject) else {
            return Ok(None);
        };
        let outdated = earlier.outdated(&case.provenance()?);
        if outdated.is_none() {
            case.go_on_from(earlier);
        }
        Ok(outdated)
    }

    /// The diagnosis that stands complete, of the same files and settings; or why what stands is none. Neither where nothing stands.
    pub(super) fn existing(&self) -> Result<Option<Result<Existing, String>>, AppError> {
        let Some(folder) = self.folder.as_ref().map(OutputFolder::path) else {
            return Ok(None);
        };
        let document = match read_sealed(&folder.join(DIAGNOSIS), &self.asked) {
            Ok(document) => document,
            Err(SealError::Absent) => return Ok(None),
            Err(why) => return Ok(Some(Err(format!("of what stands, {why}")))),
        };
        let Ok(answer) = serde_json::from_str::<Answer>(&document) else {
            return Ok(Some(Err(format!("{DIAGNOSIS} cannot be read"))));
        };
        if let Some(name) = lacking(folder) {
            return Ok(Some(Err(format!("{name} is missing"))));
        }
        if answer.details.schema != DETAILS_SCHEMA {
            return Ok(Some(Err(format!("{DIAGNOSIS} is of another form"))));
        }
        let now = self.subject.provenance()?;
        Ok(Some(match answer.details.provenance.changed(&now) {
            Some(why) => Err(why),
            None => Ok(Existing { answer, document }),
        }))
    }

    /// Diagnoses it and writes its files; `observer` gets its progress.
    pub(super) fn run(self, observer: &mut Observer<'_>) -> Result<Finished, AppError> {
        match &self.subject {
            Subject::Recordings(case) => self.of_recordings(case, observer),
            Subject::Table(case) => self.of_table(case),
            Subject::Postures(case) => self.of_postures(case),
        }
    }

    /// The improved file as it is called once it stands; none where nothing is written.
    fn improved_file(&self) -> Option<PathBuf> {
        Some(self.folder.as_ref()?.path().join(IMPROVED))
    }

    fn of_table(&self, case: &RemovalCase) -> Result<Finished, AppError> {
        let RemovalDiagnosed {
            mut answer,
            diagnosis,
            improved,
            prediction,
        } = case.diagnose()?;
        if let (Some(file), false) = (self.improved_file(), diagnosis.effects.is_empty()) {
            let file = word(&file);
            let how = format!(
                "`idc predict {file} TABLE.csv` predicts the runs of another table with what was found."
            );
            answer.details.account.add(SectionKind::HowToRun, vec![how]);
        }
        let picture = removal_picture::picture(&diagnosis, case.file.is_feed)?;
        let outputs = Outputs {
            answer,
            improved,
            prediction: prediction.as_deref(),
            explanations: None,
            beside: &[],
            picture: None,
            fit_picture: Some(&picture),
            scene: None,
            comparison: Comparison::default(),
        };
        outputs.write(self.folder.as_ref(), &self.asked)
    }

    fn of_postures(&self, case: &PosturesCase) -> Result<Finished, AppError> {
        let PosturesDiagnosed {
            mut answer,
            improved,
            prediction,
            left,
        } = case.diagnose()?;
        if let Some(file) = self.improved_file() {
            let file = word(&file);
            let how = format!(
                "`idc predict {file} TABLE.csv` predicts what the sensor reads in other postures, with what was found."
            );
            answer.details.account.add(SectionKind::HowToRun, vec![how]);
        }
        let picture = answer.kept("fit.svg", postures_picture::picture(&left));
        let outputs = Outputs {
            answer,
            improved,
            prediction: prediction.as_deref(),
            explanations: None,
            beside: &[],
            picture: None,
            fit_picture: picture.as_deref(),
            scene: None,
            comparison: Comparison::default(),
        };
        outputs.write(self.folder.as_ref(), &self.asked)
    }

    fn of_recordings(
        &self,
        case: &Case,
        observer: &mut Observer<'_>,
    ) -> Result<Finished, AppError> {
        let mut diagnosed = diagnose(case, &self.settings, observer)?;
        let scene = scene(case, &diagnosed);
        let scene = diagnosed.answer.kept("the scene of diagnosis.rrd", scene);
        let Diagnosed {
            mut answer,
            improved,
            prediction,
            comparison,
            diagnosis,
            explanations,
            beside,
            ..
        } = diagnosed;
        let explanations = explanations.map(|own| own.text());
        let explanations = explanations.and_then(|text| answer.kept(EXPLANATIONS, text));
        let mut fit = flange_picture::picture(&answer, &comparison);
        let mut shape = None;
        if let Some(diagnosis) = &diagnosis {
            shape = answer.kept("unlisted.svg", picture(diagnosis)).flatten();
            fit = fit_picture::picture(diagnosis);
            if let (Some(file), false) = (self.improved_file(), diagnosis.best().finds_nothing()) {
                let how = how_to_run(case.cell(), &file);
                answer.details.account.add(SectionKind::HowToRun, vec![how]);
            }
        }
        if let (Some(file), true) = (self.improved_file(), case.is_of_arm()) {
            let how = how_to_go_on_with_arm(&answer, &file);
            answer.details.account.add(SectionKind::HowToRun, how);
        }
        let fit = answer.kept("fit.svg", fit).flatten();
        let outputs = Outputs {
            answer,
            improved,
            prediction: prediction.as_deref(),
            explanations: explanations.as_deref(),
            beside: &beside,
            picture: shape.as_deref(),
            fit_picture: fit.as_deref(),
            scene: scene.flatten(),
            comparison,
        };
        outputs.write(self.folder.as_ref(), &self.asked)
    }
}

/// Next steps with what was found of an arm.
fn how_to_go_on_with_arm(answer: &Answer, file: &Path) -> Vec<String> {
    let improved = word(file);
    let mut how = vec![
        "drives.csv holds the numbers of the drives with their 95 % intervals, identified.urdf the URDF with the masses, centres, damping and friction that were found.".to_owned(),
        format!("`idc check {improved} --design PATH.csv` writes a path of the joints that would tell more."),
    ];
    if !answer.effects.is_empty() {
        how.push(format!(
            "`idc predict {improved} LOG.csv` predicts what the arm's sensors read along another path, with what was found."
        ));
    }
    how
}

/// Next steps with the improved file.
fn how_to_run(cell: Option<&LoadedCell>, file: &Path) -> String {
    let improved = word(file);
    match cell {
        Some(cell) if cell.scenario.has_job => format!(
            "`idc run {improved}` runs the cell with what was found, on the job of the scenario file; `idc compare` tells its run from others."
        ),
        Some(_) => format!(
            "`idc diagnose RUNS --scenario {improved}` takes what was found as nominal. The file has no job, so `idc run` does not take it."
        ),
        None => format!(
            "`idc predict {improved} INPUTS.csv` predicts a recording with what was found; a bench runs it as its device, with `device.model = {:?}`.",
            file.display().to_string()
        ),
    }
}

/// The first recording of a cell in space.
fn scene(case: &Case, diagnosed: &Diagnosed) -> Result<Option<Scene>, AppError> {
    let (Some(cell), Some(axes)) = (case.cell(), case.axes()) else {
        return Ok(None);
    };
    let first = case.input().and_then(|input| input.recordings.first());
    let trajectory = first.and_then(|first| first.recorded.inputs.cell.as_deref());
    let compared = diagnosed.comparison.recordings.first();
    let plants = case
        .input()
        .map(|input| &input.nominal)
        .zip(diagnosed.plant.as_ref());
    let (Some(compared), Some(trajectory), Some((nominal, improved))) =
        (compared, trajectory, plants)
    else {
        return Ok(None);
    };
    let drawn = Drawn {
        axes,
        compared,
        trajectory,
    };
    cell_scene(cell, &drawn, [nominal, improved]).map(Some)
}
