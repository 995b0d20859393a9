//! A recorded arm as a case: its file, the recordings to diagnose from and the one to be predicted.

use std::path::{Path, PathBuf};
use std::time::Instant;

use super::arm_recording::{ArmLog, column_of, read};
use super::diagnosed::{DRIVES, Diagnosed, IDENTIFIED, IMPROVED};
use super::error::CaseError;
use super::rig::names_to_fit;
use crate::diagnosis::answer::details::{ChannelMisfit, ChannelNoise};
use crate::diagnosis::arm::drives::drives_text;
use crate::diagnosis::arm::input::{ArmInput, ArmRecording};
use crate::diagnosis::arm::{ArmDiagnosis, diagnose};
use crate::diagnosis::difference::comparison::{Compared, ComparedChannel, Comparison};
use crate::diagnosis::difference::localise::{robust_rms, root_mean_square};
use crate::diagnosis::search::progress::Observer;
use crate::recorded_arm::ArmParameters;
use crate::recorded_arm::motion::Motion;
use crate::recorded_arm::simulate::{Channel, RigidCourse, all_bristles, readings};
use crate::recorded_arm::wrench::CHANNELS as WRENCH;
use crate::recording::csv::columns_text;
use crate::scenario::arm_file::{ArmFile, from_text, improved_arm_text, load_arm_file};

/// File of a recorded arm.
pub const ARM: &str = "arm.toml";
/// Multiples of the nominal current from which a column holds torques: at least so many, and at least that share of the gain [1].
const TORQUES: [f64; 2] = [3.0, 0.5];

/// File, recordings and inputs of a diagnosis.
pub(super) struct ArmCase {
    /// The file.
    pub file: ArmFile,
    /// What a diagnosis is made of.
    pub input: ArmInput,
    /// The recording to be predicted.
    unseen: Option<ArmRecording>,
    /// Remarks on the recordings.
    notes: Vec<String>,
    /// Files of the recordings by their names.
    pub sources: Vec<(String, PathBuf)>,
}

/// The arm file of a folder, with the names of the recordings to diagnose from.
///
/// # Errors
/// What is wrong with the file, or a pattern that no file fits.
pub fn arm_of(folder: &Path) -> Result<(ArmFile, Vec<String>), CaseError> {
    let file = load_arm_file(&folder.join(ARM))?;
    if file.fit.is_empty() {
        return Err(CaseError::NoRecordings {
            file: file.path.display().to_string(),
        });
    }
    let names = names_to_fit(&file.path, &file.fit, file.predict.as_ref(), folder)?;
    Ok((file, names))
}

impl ArmCase {
    /// Reads a folder.
    pub fn from_folder(folder: &Path) -> Result<Self, CaseError> {
        let (file, names) = arm_of(folder)?;
        let logs = names.iter().map(|name| {
            let log = read(&file, folder, name)?;
            log.check_length()?;
            Ok(log)
        });
        let logs: Vec<ArmLog> = logs.collect::<Result<_, CaseError>>()?;
        check_motion(&logs)?;
        let unseen = file.predict.as_ref();
        let unseen = unseen.map(|name| read(&file, folder, name)).transpose()?;
        let channels = channels(&file, &logs)?;
        let nominal = file.arm(&names);
        let recordings = logs.iter().enumerate();
        let input = ArmInput {
            links: file.links.clone(),
            numbers: file.numbers.clone(),
            tolerated: file.tolerated.clone(),
            noise: (channels.iter())
                .filter_map(|(channel, _)| file.noise.of(*channel))
                .collect(),
            recordings: recordings
                .map(|(index, log)| log.recording(index, &only(&channels)))
                .collect(),
            columns: channels.iter().map(|(_, column)| column.clone()).collect(),
            channels: only(&channels),
            nominal,
        };
        check_currents(&file, &input, &logs)?;
        let all = names.iter().chain(file.predict.as_ref());
        Ok(Self {
            notes: logs.iter().chain(&unseen).flat_map(ArmLog::notes).collect(),
            unseen: unseen.map(|log| log.recording(logs.len(), &input.channels)),
            sources: all.map(|name| (name.clone(), folder.join(name))).collect(),
            input,
            file,
        })
    }

    fn names(&self) -> Vec<String> {
        let recordings = self.input.recordings.iter();
        recordings.map(|r| r.name.clone()).collect()
    }

    /// Diagnoses it; what the improved file says is what predicts.
    pub fn diagnosed(
        &self,
        start: Instant,
        observer: &mut Observer<'_>,
    ) -> Result<Diagnosed, CaseError> {
        let ArmDiagnosis {
            mut answer,
            tolerated,
            fitted,
            drives,
        } = diagnose(&self.input, observer);
        for note in &self.notes {
            answer.note(note.clone());
        }
        let names = self.names();
        let improved = improved_arm_text(&self.file, &fitted, &names);
        // As the file says it, so that whoever takes the file gets the same.
        let read = from_text(Path::new(IMPROVED), &improved);
        let model = match answer.kept("improved.toml as it should be", read) {
            Some(file) => file.arm(&names),
            None => fitted,
        };
        let comparison = self.comparison(&tolerated, &model);
        let prediction = Self::prediction(&comparison)?;
        if answer.details.noise.is_empty() {
            answer.details.noise = self.noise();
        }
        if answer.details.misfit.is_empty() {
            answer.details.misfit = self.misfits(&comparison);
        }
        let mut beside = vec![(DRIVES, drives_text(&drives))];
        let urdf = answer.kept(IDENTIFIED, self.file.identified_urdf(&model));
        beside.extend(urdf.flatten().map(|text| (IDENTIFIED, text)));
        answer.seconds = start.elapsed().as_secs_f64();
        Ok(Diagnosed {
            answer,
            improved,
            prediction,
            comparison,
            diagnosis: None,
            explanations: None,
            plant: None,
            beside,
        })
    }

    fn comparison(&self, tolerated: &ArmParameters, improved: &ArmParameters) -> Comparison {
        let models = [&self.input.nominal, tolerated, improved];
        let compared = |recording: &ArmRecording, unseen: bool| {
            let [nominal, tolerated, improved] =
                models.map(|arm| predicted(arm, &recording.motion, &self.input.channels));
            let nothing = || vec![f64::NAN; recording.motion.len()];
            let both = nominal.into_iter().zip(tolerated).zip(improved);
            let channels = both.zip(&recording.readings).zip(&self.input.columns);
            let channels =
                channels.map(|((((nominal, tolerated), improved), measured), column)| {
                    ComparedChannel {
                        column: column.clone(),
                        measured: measured.clone(),
                        nominal,
                        tolerated,
                        improved,
                        left_out: nothing(),
                    }
                });
            Compared {
                name: recording.name.clone(),
                unseen,
                time: recording.motion.time.clone(),
                channels: channels.collect(),
            }
        };
        let fitted = self.input.recordings.iter().map(|r| compared(r, false));
        let unseen = self.unseen.iter().map(|r| compared(r, true));
        Comparison {
            recordings: fitted.chain(unseen).collect(),
            balances: Vec::new(),
        }
    }

    /// The improved arm's prediction of the recording that was kept back.
    fn prediction(comparison: &Comparison) -> Result<Option<String>, CaseError> {
        let Some(unseen) = comparison.recordings.iter().find(|run| run.unseen) else {
            return Ok(None);
        };
        let columns = unseen.channels.iter();
        let columns: Vec<(&str, &[f64])> = columns
            .map(|c| (c.column.as_str(), c.improved.as_slice()))
            .collect();
        Ok(Some(columns_text(&unseen.time, &columns)?))
    }

    fn noise(&self) -> Vec<ChannelNoise> {
        let pairs = self.input.columns.iter().zip(&self.input.noise);
        pairs
            .map(|(column, noise)| ChannelNoise {
                channel: column.clone(),
                standard_deviation: *noise,
                shown: Vec::new(),
            })
            .collect()
    }

    /// What the nominal and the improved arm leave of each channel that was fitted to.
    fn misfits(&self, comparison: &Comparison) -> Vec<ChannelMisfit> {
        let fitted = comparison.recordings.iter().filter(|run| !run.unseen);
        let all = fitted.flat_map(|run| {
            let channels = run.channels.iter().zip(&self.input.noise);
            channels.filter_map(|(channel, noise)| misfit(&run.name, channel, *noise))
        });
        all.collect()
    }
}

pub(super) fn misfit(
    recording: &str,
    channel: &ComparedChannel,
    noise: f64,
) -> Option<ChannelMisfit> {
    let left = |model: &[f64]| -> Vec<f64> {
        let pairs = channel.measured.iter().zip(model);
        pairs.map(|(measured, model)| measured - model).collect()
    };
    let sigmas = |left: &[f64]| robust_rms(&left.iter().map(|l| l / noise).collect::<Vec<_>>());
    let models = [&channel.nominal, &channel.tolerated, &channel.improved];
    let [nominal, tolerated, improved] = models.map(|model| left(model));
    let (samples, nominal_sigmas) = sigmas(&nominal)?;
    let (_, tolerated_sigmas) = sigmas(&tolerated)?;
    let (_, improved_sigmas) = sigmas(&improved)?;
    let rms = |values: &[f64]| root_mean_square(values.iter().copied()).unwrap_or(0.0);
    let own = rms(&channel.measured);
    Some(ChannelMisfit {
        recording: recording.to_owned(),
        channel: channel.column.clone(),
        samples,
        nominal_sigmas,
        tolerated_sigmas,
        improved_sigmas,
        left_out_sigmas: None,
        nominal_rms: rms(&nominal),
        tolerated_rms: rms(&tolerated),
        improved_rms: rms(&improved),
        improved_share: match own > 0.0 {
            true => rms(&improved) / own,
            false => 0.0,
        },
    })
}

/// What an arm reads in channels along a motion.
pub(super) fn predicted(
    arm: &ArmParameters,
    motion: &Motion,
    channels: &[Channel],
) -> Vec<Vec<f64>> {
    let rigid = RigidCourse::of(arm, motion);
    let bristles = all_bristles(arm, motion);
    readings(arm, motion, channels, &bristles, &rigid)
}

pub(super) fn only(channels: &[(Channel, String)]) -> Vec<Channel> {
    channels.iter().map(|(channel, _)| *channel).collect()
}

/// Channels that one of the recordings holds and whose noise is known, with their columns.
pub(super) fn channels(
    file: &ArmFile,
    logs: &[ArmLog],
) -> Result<Vec<(Channel, String)>, CaseError> {
    let mut found: Vec<(Channel, String)> = Vec::new();
    for (channel, column, values) in logs.iter().flat_map(|log| &log.channels) {
        let is_new = found.iter().all(|(own, _)| own != channel);
        let is_known = file.noise.of(*channel).is_some();
        if is_new && is_known && values.iter().any(|value| value.is_finite()) {
            found.push((*channel, column.clone()));
        }
    }
    found.sort_by_key(|(channel, _)| *channel);
    if found.is_empty() {
        return Err(CaseError::NothingMeasured {
            folder: file
                .path
                .parent()
                .unwrap_or(Path::new(""))
                .display()
                .to_string(),
        });
    }
    Ok(found)
}

/// Refuses recordings of which none holds a whole period of its motion.
fn check_motion(logs: &[ArmLog]) -> Result<(), CaseError> {
    let all: Vec<(bool, bool)> = logs.iter().map(ArmLog::moves_and_returns).collect();
    let Some(moving) = all.iter().position(|(moves, _)| *moves) else {
        return Ok(());
    };
    if all.iter().any(|(_, returns)| *returns) {
        return Ok(());
    }
    Err(CaseError::NoPeriod {
        file: logs[moving].file(),
    })
}

/// Refuses currents that are torques: they are as many times larger as a drive gives newton metres an ampere.
pub(super) fn check_currents(
    file: &ArmFile,
    input: &ArmInput,
    logs: &[ArmLog],
) -> Result<(), CaseError> {
    let (mut torques, mut seen) = (None, 0);
    for (recording, log) in input.recordings.iter().zip(logs) {
        let nominal = predicted(&input.nominal, &recording.motion, &input.channels);
        let channels = input
            .channels
            .iter()
            .zip(nominal.iter().zip(&recording.readings));
        for (place, (channel, (nominal, measured))) in channels.enumerate() {
            let Channel::Drive(joint) = *channel else {
                continue;
            };
            let gain = 1.0 / input.nominal.drives[joint].inverse_gain;
            let pairs = nominal.iter().zip(measured).filter(|(_, m)| m.is_finite());
            let (both, own, other) = pairs.fold((0.0, 0.0, 0.0), |(both, own, other), (n, m)| {
                (both + n * m, own + n * n, other + m * m)
            });
            let alike = both / (own * other).sqrt();
            let is_current = input.nominal.drives[joint].logs_current;
            // Of a joint that the nominal arm describes at all.
            if !is_current || own <= 0.0 || alike.is_nan() || alike < 0.8 {
                continue;
            }
            seen += 1;
            let times = both / own;
            if gain > TORQUES[0] && times > TORQUES[0].max(TORQUES[1] * gain) {
                torques.get_or_insert((log, place, times));
            } else {
                return Ok(());
            }
        }
    }
    match torques {
        Some((log, place, times)) if seen > 1 => Err(CaseError::TorquesAsCurrents {
            file: log.file(),
            column: column_of(file, input.channels[place]),
            times,
        }),
        _ => Ok(()),
    }
}

/// A prediction of a recording by an arm file.
pub struct ArmPrediction {
    /// Stamps [s].
    pub time: Vec<f64>,
    /// Column, what was measured in it (not a number where nothing was), what is predicted, and the noise of its sensor.
    pub columns: Vec<PredictedColumn>,
    /// Remarks.
    pub notes: Vec<String>,
}

/// A column of a prediction.
pub struct PredictedColumn {
    /// Its name.
    pub name: String,
    /// Measured.
    pub measured: Vec<f64>,
    /// Predicted.
    pub predicted: Vec<f64>,
    /// Standard deviation of its sensor's noise.
    pub noise: f64,
}

/// Predicts all that an arm's sensors would read along a recording's motion: currents or torques, the wrench, and angles on the links' side where the recording
/// has them or the file gives their noise.
///
/// # Errors
/// What is wrong with the recording.
pub fn predict_arm(file: &ArmFile, path: &Path) -> Result<ArmPrediction, CaseError> {
    let folder = path.parent().unwrap_or(Path::new(""));
    let name = path.file_name().unwrap_or_default().display().to_string();
    let log = read(file, folder, &name)?;
    let ArmInput {
        channels, noise, ..
    } = unrecorded(file);
    let recording = log.recording(0, &channels);
    let arm = file.arm(&[log.name().to_owned()]);
    let columns = predicted(&arm, &recording.motion, &channels).into_iter();
    let columns = columns.zip(recording.readings).zip(channels).zip(noise);
    let columns = columns.map(
        |(((predicted, measured), channel), noise)| PredictedColumn {
            name: column_of(file, channel),
            measured,
            predicted,
            noise,
        },
    );
    Ok(ArmPrediction {
        columns: columns.collect(),
        time: recording.motion.time,
        notes: log.notes(),
    })
}

/// A log of a case, for people.
pub struct LogSummary {
    /// Its name.
    pub name: String,
    /// Whether it is to be predicted.
    pub unseen: bool,
    /// Number of samples.
    pub samples: usize,
    /// Its duration [s].
    pub duration: f64,
    /// Columns that were measured.
    pub measured: Vec<String>,
}

/// The logs of a folder, read as a diagnosis would.
pub struct ArmLogs {
    /// Each for people.
    pub summaries: Vec<LogSummary>,
    /// Remarks on them.
    pub notes: Vec<String>,
    /// What a diagnosis is made of.
    pub input: ArmInput,
}

/// What a diagnosis of an arm is made of, without recordings: every sensor whose noise the file gives.
#[must_use]
pub fn unrecorded(file: &ArmFile) -> ArmInput {
    let joints = file.numbers.len();
    let drives = (0..joints).map(Channel::Drive);
    let links = (0..joints).map(Channel::Link);
    let wrench = (0..WRENCH.len()).map(Channel::Wrench);
    let wrench = wrench.filter(|_| file.nominal.wrench.is_some());
    let all = drives.chain(links).chain(wrench);
    let known = all.filter_map(|channel| Some((channel, file.noise.of(channel)?)));
    let (channels, noise): (Vec<Channel>, Vec<f64>) = known.unzip();
    ArmInput {
        nominal: file.arm(&[]),
        links: file.links.clone(),
        numbers: file.numbers.clone(),
        tolerated: file.tolerated.clone(),
        columns: channels.iter().map(|c| column_of(file, *c)).collect(),
        channels,
        noise,
        recordings: Vec::new(),
    }
}

/// The logs of a folder, read as a diagnosis would.
///
/// # Errors
/// What is wrong with file or logs.
pub fn logs_of(folder: &Path) -> Result<ArmLogs, CaseError> {
    let case = ArmCase::from_folder(folder)?;
    let all = case.input.recordings.iter().map(|r| (r, false));
    let all = all.chain(case.unseen.iter().map(|r| (r, true)));
    let summaries = all.map(|(recording, unseen)| {
        let time = &recording.motion.time;
        let ends = time.first().zip(time.last());
        let channels = case.input.columns.iter().zip(&recording.readings);
        let measured = channels.filter(|(_, values)| values.iter().any(|v| v.is_finite()));
        LogSummary {
            name: recording.name.clone(),
            unseen,
            samples: time.len(),
            duration: ends.map_or(0.0, |(first, last)| last - first),
            measured: measured.map(|(column, _)| column.clone()).collect(),
        }
    });
    Ok(ArmLogs {
        summaries: summaries.collect(),
        notes: case.notes,
        input: case.input,
    })
}
