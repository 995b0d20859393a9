//! The scenario of a cell that this project runs, as what its owner believes of recordings of it. What is in its `[process]` is in the recordings' commands.

use super::super::check::Section;
use super::super::document::Document;
use super::super::error::ScenarioError;
use super::super::sensing::white;
use super::super::{BurrScenario, Misplacement, Scenario};
use super::RecordedCell;
use crate::plant::{Observation, registry};
use crate::sensing::{FilterParameters, Measurement};

/// Relative tolerance of a number that a scenario states: none of a data sheet is truer.
const TOLERANCE: f64 = 0.005;
/// Damping of springs that are not there over their stiffness, and its tolerance [s].
static DAMPING_TIME: [f64; 2] = [registry::JOINT_DAMPING.default, 1e-3];
/// Noise of encoders that a scenario says have none [rad].
const ENCODER_NOISE: f64 = 2e-6;

/// A cell's scenario as the belief of its owner.
pub(super) fn of_scenario(
    scenario: &Scenario,
    document: &Document<'_>,
    text: &str,
) -> Result<RecordedCell, ScenarioError> {
    let section = |table: &str| Section::new(document, table);
    let sought = |what: &str| format!("a diagnosis finds {what}, the file says what is believed");
    if scenario.workpiece.misplacement != Misplacement::default() {
        return Err(section("workpiece").misplaced("misplacement", sought("how the part lies")));
    }
    if scenario.workpiece.burr != BurrScenario::None {
        return Err(section("workpiece").misplaced("burr", sought("a burr")));
    }
    if !scenario.arm.drives.is_empty() {
        return Err(section("arm").misplaced("drives", sought("what joints do")));
    }
    if scenario.contact.runout_amplitude > 0.0 {
        return Err(section("contact").misplaced("runout_um", sought("a runout")));
    }
    if scenario.device.locked {
        let reason = "a locked device moves nowhere, and tells nothing".to_owned();
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
        path: scenario.path.clone(),
        text: text.to_owned(),
        effects: scenario.effects.clone(),
        title: scenario.title.clone(),
        arm: scenario.arm.clone(),
        device: scenario.device.clone(),
        workpiece: scenario.workpiece.clone(),
        contact: scenario.contact,
        gravity: scenario.simulation.gravity,
        servo_bandwidth: scenario.arm.servo.lag_bandwidth,
        joint_stiffness: None,
        joint_damping: DAMPING_TIME,
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
