//! Drives and wrench sensor of a cell's arm: diagnosed from the same recordings as device, part and contact, once what these do to the flange is known.
//!
//! The improved cell says which force the part puts on the tool and how the slide moves. Both act on the flange as from outside ([`OutsideWrench`]); what
//! currents, torques and the raw wrench show beyond that is the arm's, the load's or a sensor's.

use std::path::Path;

use super::arm::{channels, check_currents, misfit, predicted};
use super::arm_recording::{ArmLog, read_log_of};
use super::diagnosed::{DRIVES, Diagnosed, IDENTIFIED, IMPROVED_ARM};
use super::error::CaseError;
use super::recordings::is_run;
use crate::diagnosis::answer::details::ChannelNoise;
use crate::diagnosis::answer::{Answer, Extent, Verdict};
use crate::diagnosis::arm::drives::drives_text;
use crate::diagnosis::arm::input::{ArmInput, ArmRecording};
use crate::diagnosis::arm::{ArmDiagnosis, diagnose};
use crate::diagnosis::difference::comparison::{Compared, ComparedChannel, Comparison};
use crate::diagnosis::search::progress::Observer;
use crate::plant::{ArmTrajectory, PlantInputs, PlantParameters, simulate};
use crate::recorded_arm::device_mount::DeviceMount;
use crate::recorded_arm::motion::{Motion, every, sample_time};
use crate::recorded_arm::outside::{Outside, OutsideWrench};
use crate::recorded_arm::simulate::Channel;
use crate::recorded_arm::sliding_mass::SlidingMass;
use crate::recorded_arm::{ArmParameters, Quantity, Tolerated};
use crate::replay::{LoadedCell, ToolContact};
use crate::scenario::arm_file::{ArmFile, from_text, improved_arm_text};

/// Samples per second that tell all of an arm's drives [Hz]. Where there are more, those between are left out: averaged, friction would turn more slowly than it
/// does.
const RATE: f64 = 150.0;
/// Time before and after a blow in which an arm swings as no rigid model of it does, and beside a rest of a tool that touches [s].
const STRUCK: f64 = 0.05;
/// How far the point of a contact may lie beside the device's axis and its nominal place [m].
const BESIDE: f64 = 1e-3;
/// How far the tool's friction may be off, as a share of it [1].
const DRAG: f64 = 0.05;
/// Force from which a tool touches [N].
const TOUCHES: f64 = 1e-3;
/// Second difference of the force on the flange from sample to sample that is a blow: of a touch, of a slide at its stop [N].
const BLOW: f64 = 3.0;

/// Drives and wrench of a cell's recordings.
pub(super) struct CellDrives {
    file: ArmFile,
    /// Logs in the order of the cell's recordings.
    known: Vec<ArmLog>,
    unseen: Option<ArmLog>,
    channels: Vec<Channel>,
    columns: Vec<String>,
}

impl CellDrives {
    /// Of recordings by name and file; none where the cell names no arm file.
    pub fn read(
        cell: &LoadedCell,
        known: &[(&str, &Path)],
        unseen: Option<(&str, &Path)>,
    ) -> Result<Option<Self>, CaseError> {
        let Some(file) = cell.scenario.arm.recorded_arm.as_deref() else {
            return Ok(None);
        };
        let file = file.clone();
        let rate = cell.scenario.sample_rate;
        let log = |(name, path): &(&str, &Path)| {
            let log = read_log_of(&file, path, name)?;
            Ok::<_, CaseError>(if is_run(path) { log.read_at(rate) } else { log })
        };
        let logs: Vec<ArmLog> = known.iter().map(log).collect::<Result<_, _>>()?;
        let unseen = unseen.as_ref().map(log).transpose()?;
        let measured = channels(&file, &logs);
        let Ok(measured) = measured else {
            return Err(CaseError::NoDrives {
                file: known
                    .first()
                    .map_or_else(String::new, |(_, path)| path.display().to_string()),
                arm: file.path.display().to_string(),
            });
        };
        let (channels, columns) = measured.into_iter().unzip();
        let read = Self {
            file,
            known: logs,
            unseen,
            channels,
            columns,
        };
        let at_rest = read.input(
            read.known
                .iter()
                .enumerate()
                .map(|(i, log)| log.recording(i, &read.channels))
                .collect(),
        );
        check_currents(&read.file, &at_rest, &read.known)?;
        Ok(Some(read))
    }

    /// The nominal arm, with what the scenario says of each recording.
    fn nominal(&self) -> ArmParameters {
        let names = self.known.iter().chain(&self.unseen);
        let names: Vec<String> = names.map(|log| log.name().to_owned()).collect();
        self.file.arm(&names)
    }

    fn input(&self, recordings: Vec<ArmRecording>) -> ArmInput {
        let noise = self.channels.iter();
        ArmInput {
            nominal: self.nominal(),
            links: self.file.links.clone(),
            numbers: self.file.numbers.clone(),
            tolerated: self
                .file
                .tolerated
                .iter()
                .copied()
                .chain(of_contact())
                .collect(),
            noise: noise.filter_map(|c| self.file.noise.of(*c)).collect(),
            channels: self.channels.clone(),
            columns: self.columns.clone(),
            recordings,
        }
    }

    /// Diagnoses them with what an improved cell does to the flange, and puts what is found into the answer.
    pub fn add_to(
        &self,
        diagnosed: &mut Diagnosed,
        cell: &LoadedCell,
        (plant, known, unseen): (&PlantParameters, &[&PlantInputs], Option<&PlantInputs>),
        observer: &mut Observer<'_>,
    ) -> Result<(), CaseError> {
        let mut nominal = self.nominal();
        for (drive, offset) in nominal.drives.iter_mut().zip(plant.cell.encoder_offset) {
            drive.encoder_offset = offset;
        }
        let flange = Flange {
            cell,
            plant,
            nominal: &nominal,
        };
        let of = |(index, (log, inputs)): (usize, (&ArmLog, &PlantInputs))| {
            let mut recording = log.recording(index, &self.channels);
            flange.apply_to(&mut recording, inputs);
            recording
        };
        let logs = self.known.iter().zip(known.iter().copied());
        let whole: Vec<ArmRecording> = logs.enumerate().map(of).collect();
        let unseen = self.unseen.as_ref().zip(unseen);
        let unseen = unseen.map(|both| of((whole.len(), both)));
        let mut input = self.input(whole.iter().map(thinned).collect());
        input.nominal = nominal;
        let found = diagnose(&input, observer);
        input.recordings = whole;
        self.report(diagnosed, &input, found, unseen.as_ref())
    }

    /// Puts what was found into the answer and the files.
    fn report(
        &self,
        diagnosed: &mut Diagnosed,
        input: &ArmInput,
        found: ArmDiagnosis,
        unseen: Option<&ArmRecording>,
    ) -> Result<(), CaseError> {
        let ArmDiagnosis {
            answer,
            tolerated,
            fitted,
            drives,
        } = found;
        let names: Vec<String> = input.recordings.iter().map(|r| r.name.clone()).collect();
        let improved = improved_arm_text(&self.file, &fitted, &names);
        let read = from_text(Path::new(IMPROVED_ARM), &improved);
        let read = diagnosed.answer.kept(IMPROVED_ARM, read);
        let outside_error = fitted.outside_error;
        let mut model = read.map_or(fitted, |file| file.arm(&names));
        // Of this contact, not of the arm.
        model.outside_error = outside_error;
        let models = [&input.nominal, &tolerated, &model];
        for recording in input.recordings.iter().chain(unseen) {
            let all = models.map(|arm| predicted(arm, &recording.motion, &input.channels));
            if let Some(compared) = of_recording(&mut diagnosed.comparison, &recording.name) {
                add_channels(compared, recording, (&input.columns, all));
            }
        }
        if let (Some(prediction), Some(own)) = (&mut diagnosed.prediction, unseen) {
            let all = predicted(&model, &own.motion, &input.channels);
            add_columns(prediction, &input.columns, &all);
        }
        add_misfits(&mut diagnosed.answer, &diagnosed.comparison, input);
        add_answer(&mut diagnosed.answer, answer);
        diagnosed.beside.push((DRIVES, drives_text(&drives)));
        let urdf = self.file.identified_urdf(&model);
        let urdf = diagnosed.answer.kept(IDENTIFIED, urdf).flatten();
        diagnosed.beside.extend(urdf.map(|text| (IDENTIFIED, text)));
        diagnosed.beside.push((IMPROVED_ARM, improved));
        Ok(())
    }
}

/// What is known of a contact within bounds.
fn of_contact() -> impl Iterator<Item = Tolerated> {
    let within = |quantity, most: f64| Tolerated {
        quantity,
        bounds: [-most, most],
    };
    let points = (0..3).map(move |axis| within(Quantity::OutsidePoint(axis), BESIDE));
    points.chain([within(Quantity::OutsideDrag, DRAG)])
}

/// What a cell does to the flange of its arm.
struct Flange<'a> {
    cell: &'a LoadedCell,
    plant: &'a PlantParameters,
    nominal: &'a ArmParameters,
}

impl Flange<'_> {
    /// Puts it into a recording, and takes out readings where nobody knows it: a tool that rests holds on to the part by whatever friction it came to rest with,
    /// and what strikes does so faster than an arm is modelled.
    fn apply_to(&self, recording: &mut ArmRecording, inputs: &PlantInputs) {
        let Some(trajectory) = &inputs.cell else {
            return;
        };
        let truth = simulate(self.plant, inputs).truth;
        let friction = self.plant.cell.friction;
        let contacts =
            self.cell
                .tool_contacts(trajectory, &truth.stroke, &truth.contact_force, friction);
        let mass = self.plant.device.moving_mass;
        let slide: Vec<f64> = truth.acceleration.iter().map(|a| mass * a).collect();
        let known = is_known(trajectory, &truth.contact_force, &slide);
        let motion = &recording.motion;
        let last = inputs.time.len().saturating_sub(1);
        // Both are of one file; lines that one of them leaves out repeat others.
        let place = |t: &f64| inputs.time.partition_point(|own| own < t).min(last);
        let places: Vec<usize> = motion.time.iter().map(place).collect();
        let both = places.iter().enumerate().map(|(i, place)| {
            let slide = [
                truth.stroke[*place],
                truth.speed[*place],
                truth.acceleration[*place],
            ];
            self.at(motion, i, slide, &contacts[*place])
        });
        let (wrench, drag) = both.unzip();
        for readings in &mut recording.readings {
            for (reading, place) in readings.iter_mut().zip(&places) {
                if !known[*place] {
                    *reading = f64::NAN;
                }
            }
        }
        recording.motion.outside = Some(Outside { wrench, drag });
    }

    /// What acts on the flange at a sample, and what of it friction of the tool is: stroke [m], its rate and acceleration, and the contact.
    fn at(
        &self,
        motion: &Motion,
        i: usize,
        slide: [f64; 3],
        contact: &ToolContact,
    ) -> (OutsideWrench, OutsideWrench) {
        let of = |all: &[Vec<f64>]| all.iter().map(|own| own[i]).collect::<Vec<f64>>();
        let [q, qd, qdd] =
            [&motion.position, &motion.speed, &motion.acceleration].map(|all| of(all));
        let mounting = &self.cell.scenario.nominal.mounting;
        let device_mount = DeviceMount {
            arm: self.nominal,
            mount: &self.cell.chain,
            world_from_base: self.cell.scenario.arm.world_from_base,
            slide: SlidingMass {
                mass: self.plant.device.moving_mass,
                centre: mounting.moving_centre_of_mass,
            },
        };
        let centre = device_mount.on_axis(&q, mounting.tool_centre + slide[0]);
        let point = centre + contact.from_centre;
        let [pressed, drag] =
            [contact.force, contact.drag].map(|force| device_mount.pressed(&q, point, force));
        (pressed + device_mount.sliding([&q, &qd, &qdd], slide), drag)
    }
}

/// Whether it is known what the part and the slide do to the flange, by sample; force of the contact [N], and that which accelerates the slide.
fn is_known(trajectory: &ArmTrajectory, force: &[f64], slide: &[f64]) -> Vec<bool> {
    let held = |i: usize| force[i] > TOUCHES && trajectory.rests(i);
    let mut known = vec![true; force.len()];
    let around = (STRUCK / sample_time(&trajectory.time)).round() as usize;
    for i in (0..force.len()).filter(|i| held(*i)) {
        // As it breaks loose, friction grows to that of a sliding tool from what held it.
        known[i.saturating_sub(around)..(i + around).min(force.len())].fill(false);
    }
    let second = |values: &[f64], i: usize| values[i + 1] - 2.0 * values[i] + values[i - 1];
    for i in 1..force.len().saturating_sub(1) {
        if second(force, i).abs().max(second(slide, i).abs()) > BLOW {
            let (from, to) = (i.saturating_sub(around), (i + around).min(force.len()));
            known[from..to].fill(false);
        }
    }
    known
}

/// A recording of as many samples as tell all of an arm's drives.
fn thinned(recording: &ArmRecording) -> ArmRecording {
    let rate = 1.0 / sample_time(&recording.motion.time);
    let apart = ((rate / RATE).floor() as usize).max(1);
    ArmRecording {
        name: recording.name.clone(),
        motion: recording.motion.every(apart),
        readings: (recording.readings.iter())
            .map(|readings| every(readings, apart))
            .collect(),
    }
}

fn of_recording<'a>(comparison: &'a mut Comparison, name: &str) -> Option<&'a mut Compared> {
    let mut all = comparison.recordings.iter_mut();
    all.find(|own| own.name == name)
}

/// Puts the channels of a recording beside those of its device, at their samples.
fn add_channels(
    compared: &mut Compared,
    recording: &ArmRecording,
    (columns, [nominal, tolerated, improved]): (&[String], [Vec<Vec<f64>>; 3]),
) {
    let time = &recording.motion.time;
    let place = |t: &f64| time.partition_point(|own| own < t).min(time.len() - 1);
    let places: Vec<usize> = compared.time.iter().map(place).collect();
    let there = |values: &[f64]| -> Vec<f64> { places.iter().map(|i| values[*i]).collect() };
    for (c, column) in columns.iter().enumerate() {
        compared.channels.push(ComparedChannel {
            column: column.clone(),
            measured: there(&recording.readings[c]),
            nominal: there(&nominal[c]),
            tolerated: there(&tolerated[c]),
            improved: there(&improved[c]),
            left_out: vec![f64::NAN; places.len()],
        });
    }
}

/// Puts columns beside those of a prediction of the same samples.
fn add_columns(prediction: &mut String, columns: &[String], values: &[Vec<f64>]) {
    let mut lines = prediction.lines();
    let mut text = lines.next().unwrap_or_default().to_owned();
    for column in columns {
        text += &format!(",{column}");
    }
    text.push('\n');
    for (i, line) in lines.enumerate() {
        text += line;
        for own in values {
            match own.get(i).filter(|value| value.is_finite()) {
                Some(value) => text += &format!(",{value}"),
                None => text.push(','),
            }
        }
        text.push('\n');
    }
    *prediction = text;
}

/// Noise and misfit of the arm's channels.
fn add_misfits(answer: &mut Answer, comparison: &Comparison, input: &ArmInput) {
    for (column, noise) in input.columns.iter().zip(&input.noise) {
        answer.details.noise.push(ChannelNoise {
            channel: column.clone(),
            standard_deviation: *noise,
            shown: Vec::new(),
        });
        for run in comparison.recordings.iter().filter(|run| !run.unseen) {
            let own = run
                .channels
                .iter()
                .find(|channel| channel.column == *column);
            let misfit = own.and_then(|own| misfit(&run.name, own, *noise));
            answer.details.misfit.extend(misfit);
        }
    }
}

/// What a part of an account says which of: the device's side, the arm's.
const OF_DEVICE: &str = "Of device, part and contact:";
const OF_ARM: &str = "Of the arm, its load and its sensor:";

/// The answer on an arm, beside that on device, part and contact.
fn add_answer(answer: &mut Answer, arm: Answer) {
    answer.verdict = match (answer.verdict, arm.verdict) {
        (Verdict::Unlisted, _) | (_, Verdict::Unlisted) => Verdict::Unlisted,
        (Verdict::Explained, _) | (_, Verdict::Explained) => Verdict::Explained,
        _ => Verdict::NothingMissing,
    };
    if arm.explained == Some(Extent::Partly) && answer.explained.is_some() {
        answer.explained = arm.explained;
    }
    let finds_nothing = answer.effects.is_empty();
    let lacks = !arm.effects.is_empty();
    answer.effects.extend(arm.effects);
    answer.alternatives.extend(arm.alternatives);
    answer.mismatch.extend(arm.mismatch);
    let own = &mut answer.details.account;
    let found = arm.details.account;
    if finds_nothing {
        own.headline = found.headline;
    } else if lacks {
        own.headline += &format!("; of arm and sensor {}", found.headline);
    }
    for section in found.sections {
        own.add_to(section.kind, [OF_DEVICE, OF_ARM], section.paragraphs);
    }
}
