//! Still postures of a wrench sensor as a case: postures.toml and tables with a posture a row.

use std::path::{Path, PathBuf};
use std::time::Instant;

use glam::DVec3;
use nalgebra::{Matrix3, Quaternion, Rotation3, UnitQuaternion, Vector3};

use super::diagnosed::IMPROVED;
use super::error::CaseError;
use super::rig::names_to_fit;
use crate::diagnosis::answer::Answer;
use crate::diagnosis::answer::details::PredictionError;
use crate::diagnosis::difference::localise::root_mean_square;
use crate::diagnosis::postures::diagnosed::{PosturesDiagnosis, diagnose};
use crate::diagnosis::postures::estimate::{Interval, Numbers};
use crate::diagnosis::postures::found::PosturesInput;
use crate::diagnosis::postures::frame::{Axes, Frame, axes_angles};
use crate::diagnosis::postures::model::{Model, WRENCH_COLUMNS, residuals};
use crate::diagnosis::postures::nominal::{Bounded, Declared, Nominal};
use crate::diagnosis::postures::{Posture, StillRecording, least_turn};
use crate::recording::csv::{header_of, read_named};
use crate::recording::long_column::LongColumn;
use crate::recording::provenance::Provenance;
use crate::scenario::postures_file::{
    DeclaredValue, PoseOf, PosturesFile, ReadingAxes, ReadingOf, WrenchValues, from_text,
    improved_postures_text, load_postures_file,
};

/// File of still postures.
pub const POSTURES: &str = "postures.toml";
/// Fewest postures: one more than numbers of force and pose take.
const LEAST_POSTURES: usize = 4;
/// Least turn beside one axis [1], its sine.
const LEAST_TURN: f64 = 0.05;
/// How far a logged quaternion's norm may be from 1 [1].
const NORM: f64 = 0.02;
/// Longest lever of a tool's weight [m].
const LONGEST: f64 = 5.0;

/// File and tables, read and checked.
pub struct PosturesCase {
    /// Name of the folder.
    pub name: String,
    folder: PathBuf,
    /// The file.
    pub file: PosturesFile,
    /// What is diagnosed.
    pub input: PosturesInput,
    /// Postures to predict.
    pub unseen: Option<StillTable>,
}

/// A table of postures.
pub struct StillTable {
    /// Its postures; forces without a reading are NaN.
    pub recording: StillRecording,
    /// Line of each.
    lines: Vec<u64>,
}

/// Result of a diagnosis, with the files that it comes to.
pub struct PosturesDiagnosed {
    /// The finding.
    pub answer: Answer,
    /// The improved file.
    pub improved: String,
    /// Its prediction of the table that was kept back.
    pub prediction: Option<String>,
    /// What is left of the readings: as declared, as found; by channel.
    pub left: [[Vec<f64>; 6]; 2],
}

/// Whether a folder holds still postures.
#[must_use]
pub fn is_postures_case(folder: &Path) -> bool {
    folder.join(POSTURES).is_file()
}

impl PosturesCase {
    /// Reads the folder of a case.
    ///
    /// # Errors
    /// What is wrong with file or tables.
    pub fn from_folder(folder: &Path) -> Result<Self, CaseError> {
        Self::from_file(&folder.join(POSTURES))
    }

    /// Reads a file and its tables.
    ///
    /// # Errors
    /// What is wrong with them.
    pub fn from_file(path: &Path) -> Result<Self, CaseError> {
        let file = load_postures_file(path)?;
        let folder = path.parent().unwrap_or(Path::new("")).to_owned();
        let names = names_to_fit(path, &file.fit, file.predict.as_ref(), &folder)?;
        let mut recordings = Vec::new();
        for name in &names {
            let table = read_table(&file, &folder.join(name), name, true)?;
            recordings.push(table.recording);
        }
        let with = |r: &StillRecording| r.postures.iter().any(|p| p.torque.is_some());
        if !recordings.iter().all(with) {
            // What is known of some recordings alone is left aside.
            let all = recordings.iter_mut().flat_map(|r| &mut r.postures);
            all.for_each(|posture| posture.torque = None);
        }
        check_postures(path, &recordings)?;
        let unseen = file.predict.as_ref();
        let unseen = unseen.map(|name| read_table(&file, &folder.join(name), name, false));
        let whole = folder.canonicalize().unwrap_or_else(|_| folder.clone());
        Ok(Self {
            name: whole.file_name().unwrap_or_default().display().to_string(),
            input: PosturesInput {
                nominal: nominal_of(&file),
                recordings,
            },
            unseen: unseen.transpose()?,
            folder,
            file,
        })
    }

    /// Diagnoses it; what the improved file says is what predicts.
    ///
    /// # Errors
    /// Postures that do not determine the numbers, a source that cannot be read again.
    pub fn diagnose(&self) -> Result<PosturesDiagnosed, CaseError> {
        let start = Instant::now();
        let PosturesDiagnosis {
            mut answer,
            nominal,
            found,
            numbers,
        } = diagnose(&self.input).ok_or_else(|| CaseError::NotTurned {
            file: self.file.path.display().to_string(),
            degrees: 0.0,
        })?;
        let values = improved_values(&self.file.values, &found, &numbers, self.has_torques());
        let headline = &answer.details.account.headline;
        let improved = improved_postures_text(&self.file, &values, headline);
        let read = from_text(Path::new(IMPROVED), &improved).map_err(|e| e.to_string());
        let read = read.and_then(|file| model_of(&file).map_err(|e| e.to_string()));
        let read = answer.kept("improved.toml as it should be", read);
        let model = read.unwrap_or(found);
        let mut prediction = None;
        if let Some(unseen) = &self.unseen {
            prediction = Some(predicted(unseen, &model, self.has_torques()));
            let errors = [&nominal, &model].map(|m| residuals(&unseen.recording.postures, m));
            let noise = self.input.nominal.noise;
            let rows = WRENCH_COLUMNS
                .iter()
                .enumerate()
                .filter_map(|(place, column)| {
                    let [before, after] =
                        [0, 1].map(|m| root_mean_square(errors[m][place].iter().copied()));
                    let over = |rms: f64| Some(rms / noise[place / 3]).filter(|r| r.is_finite());
                    Some(PredictionError {
                        recording: unseen.recording.name.clone(),
                        channel: (*column).to_owned(),
                        nominal: before?,
                        before: before?,
                        after: after?,
                        noise: Some(noise[place / 3]).filter(|noise| *noise > 0.0),
                        before_sigmas: over(before?),
                        after_sigmas: over(after?),
                    })
                });
            answer.details.prediction = rows.collect();
        }
        answer.details.case.clone_from(&self.name);
        answer.details.provenance = self.provenance()?;
        answer.seconds = start.elapsed().as_secs_f64();
        let all = self.input.recordings.iter().flat_map(|r| &r.postures);
        let all: Vec<Posture> = all.copied().collect();
        Ok(PosturesDiagnosed {
            answer,
            improved,
            prediction,
            left: [residuals(&all, &nominal), residuals(&all, &model)],
        })
    }

    /// Whether its recordings have torques.
    #[must_use]
    pub fn has_torques(&self) -> bool {
        let mut all = self.input.recordings.iter().flat_map(|r| &r.postures);
        all.all(|posture| posture.torque.is_some())
    }

    /// The files that it is made of, as they stand now.
    ///
    /// # Errors
    /// One that is gone.
    pub fn provenance(&self) -> Result<Provenance, CaseError> {
        let fitted = self.input.recordings.iter().map(|r| &r.name);
        let tables = fitted.chain(self.file.predict.as_ref());
        let mut sources: Vec<(String, PathBuf)> = tables
            .map(|name| (name.clone(), self.folder.join(name)))
            .collect();
        sources.insert(0, (POSTURES.to_owned(), self.file.path.clone()));
        let named = sources
            .iter()
            .map(|(name, path)| (name.as_str(), path.as_path()));
        Ok(Provenance::of(named, None)?)
    }
}

/// Refuses postures that do not determine the numbers, and torques in another unit.
fn check_postures(path: &Path, recordings: &[StillRecording]) -> Result<(), CaseError> {
    let file = path.display().to_string();
    let all: Vec<Posture> = (recordings.iter())
        .flat_map(|r| r.postures.iter().copied())
        .collect();
    if all.len() < LEAST_POSTURES {
        return Err(CaseError::FewPostures {
            file,
            found: all.len(),
            least: LEAST_POSTURES,
        });
    }
    let turn = least_turn(&all);
    if turn < LEAST_TURN {
        return Err(CaseError::NotTurned {
            file,
            degrees: turn.asin().to_degrees(),
        });
    }
    let spread = |of: &dyn Fn(&Posture) -> Option<Vector3<f64>>| {
        let known: Vec<Vector3<f64>> = all.iter().filter_map(of).collect();
        let mean = known.iter().sum::<Vector3<f64>>() / known.len().max(1) as f64;
        known
            .iter()
            .map(|v| (v - mean).norm_squared())
            .sum::<f64>()
            .sqrt()
    };
    let lever = spread(&|p| p.torque) / spread(&|p| Some(p.force));
    if lever > LONGEST {
        return Err(CaseError::LongLever { file, lever });
    }
    Ok(())
}

/// A table; without `with_readings` it may hold poses alone.
fn read_table(
    file: &PosturesFile,
    path: &Path,
    name: &str,
    with_readings: bool,
) -> Result<StillTable, CaseError> {
    let header = header_of(path)?;
    let has = |columns: &[String]| columns.iter().any(|name| header.contains(name));
    let with_force = with_readings || has(&file.force);
    let with_torque = has(&file.torque) || (file.names_torque && with_readings);
    let mut names: Vec<&str> = file.quaternion.iter().map(String::as_str).collect();
    if with_force {
        names.extend(file.force.iter().map(String::as_str));
    }
    if with_torque {
        names.extend(file.torque.iter().map(String::as_str));
    }
    let read = read_named(path, &names)?;
    let mut postures = Vec::with_capacity(read.lines.len());
    for (row, line) in read.lines.iter().enumerate() {
        let optional = if with_readings { names.len() } else { 4 };
        for (column, values) in names.iter().zip(&read.columns).take(optional) {
            if !values[row].is_finite() {
                return Err(CaseError::NoReading {
                    file: path.display().to_string(),
                    line: *line,
                    column: (*column).to_owned(),
                });
            }
        }
        let three = |first: usize, unit: f64| {
            Vector3::from_fn(|axis, _| read.columns[first + axis][row] * unit)
        };
        let [x, y, z, w] = [0, 1, 2, 3].map(|place| read.columns[place][row]);
        postures.push(Posture {
            base_from_sensor: rotation(path, *line, Quaternion::new(w, x, y, z))?,
            force: match with_force {
                true => three(4, file.units[0]),
                false => Vector3::repeat(f64::NAN),
            },
            torque: with_torque.then(|| three(if with_force { 7 } else { 4 }, file.units[1])),
        });
    }
    Ok(StillTable {
        recording: StillRecording {
            name: name.to_owned(),
            postures,
        },
        lines: read.lines,
    })
}

fn rotation(path: &Path, line: u64, pose: Quaternion<f64>) -> Result<Matrix3<f64>, CaseError> {
    let norm = pose.norm();
    if (norm - 1.0).abs() > NORM {
        return Err(CaseError::NoRotation {
            file: path.display().to_string(),
            line,
            norm,
        });
    }
    let pose = UnitQuaternion::from_quaternion(pose);
    Ok(pose.to_rotation_matrix().into_inner())
}

fn vector(of: DVec3) -> Vector3<f64> {
    Vector3::new(of.x, of.y, of.z)
}

/// Frame and turn of what readings are declared to be.
fn frame_of(values: &WrenchValues) -> (Frame, Matrix3<f64>) {
    let frame = Frame {
        axes: match values.axes {
            ReadingAxes::Sensor => Axes::Sensor,
            ReadingAxes::Base => Axes::Base,
        },
        inverse: values.pose == PoseOf::BaseInSensor,
        opposite: values.reads == ReadingOf::SensorOnTool,
        ..Frame::PLAIN
    };
    let [roll, pitch, yaw] = values.rotation.to_array();
    let axes = Rotation3::from_euler_angles(roll, pitch, yaw);
    (frame, axes.inverse().into_inner())
}

fn nominal_of(file: &PosturesFile) -> Nominal {
    let values = &file.values;
    let (frame, axes_turn) = frame_of(values);
    let three = |declared: Option<DeclaredValue<[f64; 3]>>| {
        declared.map(|declared| {
            std::array::from_fn(|axis| Bounded {
                value: declared.value[axis],
                low: declared.low[axis],
                high: declared.high[axis],
            })
        })
    };
    Nominal {
        frame,
        axes_turn,
        turn: file.rotation_tolerance,
        gravity: vector(values.gravity),
        tilt: file.tilt_tolerance,
        noise: file.noise.map(|noise| noise.unwrap_or(0.0)),
        declared: Declared {
            mass: values.tool_mass.map(|mass| Bounded {
                value: mass.value,
                low: mass.low,
                high: mass.high,
            }),
            centre: three(values.tool_centre),
            zero: three(values.zero_force),
            torque_zero: three(values.zero_torque),
        },
    }
}

/// The numbers found, as a file says them.
fn improved_values(
    own: &WrenchValues,
    found: &Model,
    numbers: &Numbers,
    has_torques: bool,
) -> WrenchValues {
    let three = |intervals: [Interval; 3]| DeclaredValue {
        value: intervals.map(|[value, ..]| value),
        low: intervals.map(|[_, low, _]| low),
        high: intervals.map(|[.., high]| high),
    };
    let of_torques = |intervals, own| match has_torques {
        true => Some(three(intervals)),
        false => own,
    };
    let [mass, low, high] = numbers.mass;
    let down = found.weight.normalize() * own.gravity.length();
    let (declared, axes_turn) = frame_of(own);
    WrenchValues {
        gravity: DVec3::new(down.x, down.y, down.z),
        axes: match found.frame.axes {
            Axes::Sensor => ReadingAxes::Sensor,
            Axes::Base => ReadingAxes::Base,
        },
        pose: match found.frame.inverse {
            false => PoseOf::SensorInBase,
            true => PoseOf::BaseInSensor,
        },
        reads: match found.frame.opposite {
            false => ReadingOf::ToolOnSensor,
            true => ReadingOf::SensorOnTool,
        },
        rotation: match found.frame.turn == declared.turn && found.turn == axes_turn {
            true => own.rotation,
            false => axes_angles(found.turn).into(),
        },
        zero_force: Some(three(numbers.zero)),
        zero_torque: of_torques(numbers.torque_zero, own.zero_torque),
        tool_mass: Some(DeclaredValue {
            value: mass,
            low,
            high,
        }),
        tool_centre: of_torques(numbers.centre, own.tool_centre),
    }
}

/// A file's description, as it predicts.
fn model_of(file: &PosturesFile) -> Result<Model, CaseError> {
    let values = &file.values;
    let lacking = |key: &'static str| CaseError::NotDeclared {
        file: file.path.display().to_string(),
        key,
    };
    let zero = values.zero_force.ok_or_else(|| lacking("zero_force_n"))?;
    let mass = values.tool_mass.ok_or_else(|| lacking("tool_mass_kg"))?;
    let torque_zero = values.zero_torque.map_or([f64::NAN; 3], |zero| zero.value);
    let centre = values.tool_centre.map_or([f64::NAN; 3], |at| at.value);
    let (frame, turn) = frame_of(values);
    Ok(Model {
        frame,
        turn,
        zero: Vector3::from(zero.value),
        torque_zero: Vector3::from(torque_zero),
        weight: vector(values.gravity) * mass.value,
        centre: Vector3::from(centre),
    })
}

/// What a description says of a table, as comma-separated values.
fn predicted(table: &StillTable, model: &Model, with_torques: bool) -> String {
    let count = if with_torques { 6 } else { 3 };
    let mut text = format!("line,{}\n", WRENCH_COLUMNS[..count].join(","));
    for (values, line) in read_by(table, model).iter().zip(&table.lines) {
        let values: Vec<String> = values[..count].iter().map(|v| format!("{v:.6}")).collect();
        text += &format!("{line},{}\n", values.join(","));
    }
    text
}

/// What a description says that the sensor reads in each posture, by `WRENCH_COLUMNS`.
fn read_by(table: &StillTable, model: &Model) -> Vec<[f64; 6]> {
    let postures = table.recording.postures.iter();
    postures
        .map(|posture| {
            let [force, torque] = model.reads(&posture.base_from_sensor);
            let mut both = force.iter().chain(&torque).copied();
            [(); 6].map(|()| both.next().unwrap_or(f64::NAN))
        })
        .collect()
}

/// A prediction of a table of postures.
pub struct PosturesPrediction {
    /// As comma-separated values.
    pub csv: String,
    /// The same as columns.
    pub columns: Vec<(String, LongColumn)>,
    /// Number of postures.
    pub postures: usize,
    /// Columns that were measured: root mean square of measured less predicted.
    pub off: Vec<(&'static str, f64)>,
}

/// Predicts a table of postures by a file.
///
/// # Errors
/// What is wrong with file or table, a file that does not declare what predicts.
pub fn predict_postures(path: &Path, table: &Path) -> Result<PosturesPrediction, CaseError> {
    let file = load_postures_file(path)?;
    let model = model_of(&file)?;
    let name = table.file_name().unwrap_or_default().display().to_string();
    let read = read_table(&file, table, &name, false)?;
    let with_torques = model
        .centre
        .iter()
        .chain(&model.torque_zero)
        .all(|v| v.is_finite());
    let left = residuals(&read.recording.postures, &model);
    let off = WRENCH_COLUMNS
        .into_iter()
        .zip(&left)
        .filter_map(|(column, left)| {
            let rms = root_mean_square(left.iter().copied())?;
            rms.is_finite().then_some((column, rms))
        });
    let lines = read.lines.iter().map(|line| *line as f64).collect();
    let values = read_by(&read, &model);
    let count = if with_torques { 6 } else { 3 };
    let wrench = WRENCH_COLUMNS[..count].iter().enumerate();
    let wrench = wrench.map(|(place, name)| {
        let values = values.iter().map(|own| own[place]).collect();
        ((*name).to_owned(), LongColumn::Numbers(values))
    });
    let line = ("line".to_owned(), LongColumn::Numbers(lines));
    Ok(PosturesPrediction {
        columns: [line].into_iter().chain(wrench).collect(),
        off: off.collect(),
        csv: predicted(&read, &model, with_torques),
        postures: read.lines.len(),
    })
}
