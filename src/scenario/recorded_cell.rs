//! The scenario file of a recorded cell, `kind = "recorded_cell"`: arm, device, part and contact by their nominal values, and the sensors of
//! recordings of it. It has no job: that is in the recordings' commands. The scenario of a cell that this project runs is read as such a belief, too; what is in its
//! `[process]` is in the recordings' commands.

use std::path::{Path, PathBuf};

use glam::DVec3;

use super::any;
use super::file::{self, Kind, KindOnly};
use super::load;
use super::sensing::white;
use super::workpiece::workpiece;
use super::{ArmScenario, BurrScenario, DeviceScenario, Misplacement, Scenario, WorkpieceScenario};
use crate::effects::PresentEffect;
use crate::keys::check::Section;
use crate::keys::declaration::{names, tables};
use crate::keys::document::{Document, read_text};
use crate::keys::error::ScenarioError;
use crate::plant::{Nominal, Observation, OperatingLimits, Periodic, PlantParameters};
use crate::sensing::{FilterParameters, Measurement};

mod improved;
mod keys;

pub use improved::improved_cell_text;
pub(super) use keys::RecordedCellFile;

/// A cell of which there are recordings.
#[derive(Debug, Clone)]
pub struct RecordedCell {
    /// File that it was read from.
    pub path: PathBuf,
    /// Its text.
    text: String,
    /// Effects that the file names, in the order of the catalogue, with all their numbers.
    pub effects: Vec<PresentEffect>,
    /// Name for people.
    pub title: String,
    /// The robot arm.
    pub arm: ArmScenario,
    /// Physics of device and contact as the file states them; of the joints too, once the arm is loaded.
    pub nominal: Nominal<PlantParameters>,
    /// The device between flange and tool, its physics apart.
    pub device: DeviceScenario,
    /// The workpiece and the edge that the tool rides.
    pub workpiece: WorkpieceScenario,
    /// Gravity in the world [m/s2].
    pub gravity: DVec3,
    /// Number of joints to which the file gives a spring between motor and link; none where joints do not give.
    pub springs: Option<usize>,
    /// Standard deviation of the damping over stiffness of those springs [s].
    pub joint_damping_deviation: f64,
    /// Standard deviation of the encoders' noise [rad].
    pub joint_noise: f64,
    /// Standard deviations of the noise of regulator outlet [Pa], stroke [m] and force [N].
    pub noise: [f64; 3],
    /// Relative tolerance of the device's and the contact's numbers [1].
    pub tolerance: f64,
    /// Largest distance of the slide's start from its retracted stop [m].
    pub start_stroke_tolerance: f64,
    /// Its observation.
    pub observed: Observation,
    /// Whether its file tells a job, so that it can be run.
    pub has_job: bool,
    /// Samples per second of its sensors, if they are fewer than the recording's rows [Hz].
    pub sample_rate: f64,
    /// How far an experiment may move it.
    pub limits: OperatingLimits,
}

/// Relative tolerance of a number that a scenario states: none of a data sheet is truer.
const TOLERANCE: f64 = 0.005;
/// Noise of encoders that a scenario says have none [rad].
const ENCODER_NOISE: f64 = 2e-6;
/// Force above which a tool touches, in standard deviations of the load cell's noise [1].
const TOUCHING: f64 = 6.0;

impl RecordedCell {
    /// Force above which the tool touches: no noise reads as much [N].
    #[must_use]
    pub fn touching(&self) -> f64 {
        let [_, _, force] = self.noise;
        TOUCHING * force
    }
}

/// Reads and checks the scenario file of a recorded cell and the device model file that it names.
///
/// # Errors
/// File, line, column and key of what is wrong, what was found and what was expected.
pub fn load_recorded_cell(path: &Path) -> Result<RecordedCell, ScenarioError> {
    let text = read_text(path)?;
    let document = Document::new(path, &text, file::SCHEMA)?;
    let KindOnly { kind } = document.parse(&names(&tables::<RecordedCellFile>()))?;
    if kind == Kind::Cell {
        return of_scenario(any::load(path)?, &document, &text);
    }
    let file: RecordedCellFile = document.read()?;
    if file.kind != Kind::RecordedCell {
        return Err(ScenarioError::OtherKind {
            file: path.to_owned(),
            found: file.kind.name(),
            expected: Kind::RecordedCell.name(),
        });
    }
    let section = |table: &str| Section::new(&document, table);
    let (device, mut nominal) = load::device(&section("device"), &file.device)?;
    if device.locked {
        let reason =
            "a locked device does not move: its recordings carry no information".to_owned();
        return Err(section("device").misplaced("locked", reason));
    }
    let part = workpiece(&section("workpiece"), &file.workpiece)?;
    load::contact(&section("contact"), &file.contact, &mut nominal);
    nominal.contact.runout = Periodic::NONE;
    let is_misplaced = section("workpiece")
        .given()
        .any(|key| key == "misplacement");
    refuse_what_is_sought(&document, &part, is_misplaced)?;
    refuse_what_commands_say(&document)?;
    let (joints, sensors, assumed) = (file.joints, file.sensors, file.belief);
    let mut arm = load::arm(&section("arm"), file.arm)?;
    arm.servo.lag_bandwidth = joints.servo_bandwidth;
    let cell = &mut nominal.cell;
    cell.joint_damping.fill(joints.damping_time);
    for (own, stiffness) in cell.joint_stiffness.iter_mut().zip(&joints.stiffness) {
        *own = *stiffness;
    }
    Ok(RecordedCell {
        path: path.to_owned(),
        effects: load::of_whole(&document, &file.effect, &nominal)?,
        text: text.clone(),
        title: section("").text("title", &file.title)?,
        arm,
        workpiece: part,
        nominal: Nominal(nominal),
        gravity: assumed.gravity,
        tolerance: assumed.tolerance,
        start_stroke_tolerance: assumed.start_stroke_tolerance,
        device,
        observed: Observation::COMPENSATED,
        has_job: false,
        sample_rate: f64::INFINITY,
        springs: Some(joints.stiffness.len()),
        joint_damping_deviation: joints.damping_time_tolerance,
        joint_noise: sensors.joints,
        noise: [sensors.regulator_pressure, sensors.stroke, sensors.force],
        limits: file.limits.limits(),
    })
}

/// A cell's scenario as the belief of its owner.
fn of_scenario(
    scenario: Scenario,
    document: &Document<'_>,
    text: &str,
) -> Result<RecordedCell, ScenarioError> {
    let section = |table: &str| Section::new(document, table);
    let part = &scenario.workpiece;
    refuse_what_is_sought(document, part, part.misplacement != Misplacement::default())?;
    if !scenario.arm.drives.is_empty() {
        return Err(section("arm").misplaced("drives", sought("what joints do")));
    }
    if scenario.nominal.contact.runout != Periodic::NONE {
        return Err(section("contact").misplaced("runout_um", sought("a runout")));
    }
    if scenario.device.locked {
        let reason =
            "a locked device does not move: its recordings carry no information".to_owned();
        return Err(section("device").misplaced("locked", reason));
    }
    let sensing = &scenario.sensing;
    if sensing.force_filter != FilterParameters::None {
        let reason = "a diagnosis takes the readings as they are sampled, not filtered".to_owned();
        return Err(section("sensing").misplaced("filter", reason));
    }
    let noise = [
        noise(
            &section("sensing.regulator_pressure"),
            &sensing.regulator_pressure,
            white::PRESSURE,
        )?,
        noise(&section("sensing.stroke"), &sensing.stroke, white::STROKE)?,
        noise(&section("sensing.force"), &sensing.force, white::FORCE)?,
    ];
    let encoders = scenario.arm.servo.encoder_noise;
    Ok(RecordedCell {
        path: scenario.path,
        text: text.to_owned(),
        effects: scenario.effects,
        title: scenario.title,
        arm: scenario.arm,
        nominal: scenario.nominal,
        device: scenario.device,
        workpiece: scenario.workpiece,
        gravity: scenario.simulation.gravity,
        springs: None,
        joint_damping_deviation: 0.0,
        joint_noise: if encoders > 0.0 {
            encoders
        } else {
            ENCODER_NOISE
        },
        noise,
        tolerance: TOLERANCE,
        start_stroke_tolerance: 0.0,
        observed: Observation::RUN,
        has_job: true,
        sample_rate: sensing.sample_rate,
        limits: scenario.limits,
    })
}

/// Standard deviation of a sensor's noise; usual white noise of one that has none, for nothing is weighed by it.
fn noise<S>(
    section: &Section<'_>,
    channel: &Measurement<S>,
    usual: f64,
) -> Result<f64, ScenarioError> {
    match channel {
        Measurement::White { standard_deviation } if *standard_deviation > 0.0 => {
            Ok(*standard_deviation)
        }
        Measurement::Ideal | Measurement::White { .. } => Ok(usual),
        Measurement::Real(_) => {
            let expected =
                "\"ideal\" or \"white\": a diagnosis finds what sensors do to what they measure";
            Err(section.refuse("kind", "\"real\"".to_owned(), expected.to_owned()))
        }
    }
}

/// Why a file of what is nominal does not say what a diagnosis is to find.
fn sought(what: &str) -> String {
    format!("a diagnosis finds {what}, the file states what is nominal")
}

fn refuse_what_is_sought(
    document: &Document<'_>,
    part: &WorkpieceScenario,
    is_misplaced: bool,
) -> Result<(), ScenarioError> {
    let section = Section::new(document, "workpiece");
    if is_misplaced {
        return Err(section.misplaced("misplacement", sought("how the part lies")));
    }
    if part.burr != BurrScenario::None {
        return Err(section.misplaced("burr", sought("a burr")));
    }
    Ok(())
}

fn refuse_what_commands_say(document: &Document<'_>) -> Result<(), ScenarioError> {
    let arm = Section::new(document, "arm");
    let given = |key: &&str| arm.given().any(|given| given == *key);
    let refused = ["servo", "seed_posture_deg", "limit_overrides"];
    match refused.into_iter().find(given) {
        None => Ok(()),
        Some("servo") => {
            let reason = "a recorded cell's servos stand in [joints]".to_owned();
            Err(arm.misplaced("servo", reason))
        }
        Some(key) => {
            let reason = "the recordings' commands say how the arm moved".to_owned();
            Err(arm.misplaced(key, reason))
        }
    }
}
