//! A bench scenario: the device without an arm, on a load cell, on a moved surface, or free.

use std::path::{Path, PathBuf};

pub use super::bench_file::HandScenario;
use super::bench_file::{BenchFile, BenchKeys, CommandKeys, LoadKeys, LoadKind, ValveKeys};
use super::controller::{ControllerScenario, ForceLaw, check_force, controller};
use super::effects::EffectKeys;
use super::estimator::{EstimatorBase, estimator as set_up_estimator};
use super::load::{expectations, of_whole};
use super::rig_device::bench_device;
use super::sensing::{check_set_pressure, sensing};
use super::{DeviceScenario, Expectation};
use crate::effects::{PresentEffect, Subsystem};
use crate::estimation::ContactForceEstimator;
use crate::keys::check::Section;
use crate::keys::document::Document;
use crate::keys::error::ScenarioError;
use crate::physics::valve::ValvePosition;
use crate::plant::{ContactLaw, ContactParameters, Nominal, PlantParameters};
use crate::sensing::{CommandChain, SensingParameters};

/// A bench and what is done on it.
#[derive(Debug, Clone)]
pub struct BenchScenario {
    /// File that it was read from.
    pub path: PathBuf,
    /// Name for people; becomes the recording's title.
    pub title: String,
    /// Physics of device, contact and sensors as the files state them.
    pub nominal: Nominal<PlantParameters>,
    /// The device, its physics apart.
    pub device: DeviceScenario,
    /// Length of the run [s].
    pub duration: f64,
    /// Stroke at the start [m], unless the weight rests on the retracted stop.
    pub start_stroke: f64,
    /// Load that the tool meets.
    pub load: LoadScenario,
    /// A hand that pushes against extension.
    pub hand: Option<HandScenario>,
    /// Physics beyond the nominal device, with all its numbers.
    pub effects: Vec<PresentEffect>,
    /// Commands, in order of time.
    pub command: CommandScenario,
    /// Positions of the 5/2 valve, in order of time: time [s], position. Extending before the first.
    pub valve: Vec<(f64, ValvePosition)>,
    /// Time step of recording and control [s].
    pub step: f64,
    /// Least number of integration sub-steps in it.
    pub substeps: usize,
    /// Seed of all noise.
    pub seed: u64,
    /// Sensing between controller and device.
    pub sensing: SensingParameters,
    /// Controller of the regulator's pressure where forces are commanded.
    pub controller: ControllerScenario,
    /// Estimator of the contact force, set up with nominal noise and device.
    pub estimator: Option<ContactForceEstimator>,
    /// Bounds that the results must keep.
    pub expect: Vec<Expectation>,
}

/// Load that the tool meets.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum LoadScenario {
    /// Nothing.
    Free,
    /// Something that pushes back.
    Contact {
        /// Where it stands along the stroke, from the retracted end [m].
        position: f64,
        /// Its motion; none on a load cell.
        motion: Option<SurfaceMotion>,
    },
}

/// A surface that comes towards the device and goes back: position - peak_to_peak/2 (1 - cos(2 pi frequency (t - start))).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SurfaceMotion {
    /// Travel from end to end [m].
    pub peak_to_peak: f64,
    /// Frequency [Hz].
    pub frequency: f64,
    /// When it starts [s].
    pub start: f64,
}

/// Commands, each held from its time [s] until the next; nothing is asked for before the first.
#[derive(Debug, Clone, PartialEq)]
pub enum CommandScenario {
    /// Set pressures [Pa gauge].
    SetPressure(Vec<(f64, f64)>),
    /// Contact forces [N] for a controller.
    Force(Vec<(f64, f64)>),
}

impl CommandScenario {
    /// Times [s] and values [Pa gauge or N].
    pub fn steps(&self) -> &[(f64, f64)] {
        match self {
            Self::SetPressure(steps) | Self::Force(steps) => steps,
        }
    }
}

/// The effects that a bench's file names.
fn effects_of_bench(
    document: &Document<'_>,
    keys: &EffectKeys,
    plant: &PlantParameters,
) -> Result<Vec<PresentEffect>, ScenarioError> {
    let effects = of_whole(document, keys, plant)?;
    for present in &effects {
        let reason = match present.effect.subsystem {
            Subsystem::Arm => "a bench has no arm",
            Subsystem::Workpiece => "a bench has no part with an edge",
            Subsystem::Sensors
                if present.effect.name == "channel_time_offset" && present.values[0] < 0.0 =>
            {
                "its offset_s is negative, and a bench that runs reads no force before it is there"
            }
            _ => continue,
        };
        let reason = format!("{}: {reason}", present.effect.name);
        return Err(Section::new(document, present.key.as_str()).misplaced_itself(reason));
    }
    Ok(effects)
}

/// Reads a bench scenario from a document that says that it is one.
pub(super) fn from_document(
    path: &Path,
    document: &Document<'_>,
) -> Result<BenchScenario, ScenarioError> {
    let file: BenchFile = document.read()?;
    let section = |table: &str| Section::new(document, table);
    let (device, mut nominal) = bench_device(&section("device"), &file.device)?;
    let BenchKeys {
        duration,
        gravity,
        start_stroke,
    } = file.bench;
    let along = &mut nominal.gravity_along_extension;
    *along = gravity.unwrap_or(*along);
    let full_stroke = nominal.device.full_stroke;
    within_stroke(
        &section("bench"),
        "start_stroke_mm",
        [start_stroke, full_stroke],
    )?;
    if device.locked {
        let reason = "a bench has no locked device".to_owned();
        return Err(section("device").misplaced("locked", reason));
    }
    let step = file.simulation.step;
    let sensing = sensing(document, &file.sensing, step)?;
    let load = load(
        &section("load"),
        &file.load,
        &mut nominal.contact,
        full_stroke,
    )?;
    let nominal = Nominal(nominal);
    let check_force =
        |section: &Section<'_>, force: f64| check_force(section, force, &nominal, &sensing.command);
    let chain = &sensing.command;
    let command = commands(document, &file.command, duration, chain, check_force)?;
    let controller = controller(document, &file.controller, &nominal.device, &sensing, step)?;
    check_controller(&section("controller"), &controller, &command, &load)?;
    let base = EstimatorBase {
        nominal: &nominal,
        sensing: &sensing,
        start_stroke,
        step,
    };
    let estimator = file.estimator.as_ref();
    let estimator = estimator.map(|keys| set_up_estimator(document, keys, &base));
    Ok(BenchScenario {
        path: path.to_owned(),
        title: section("").text("title", &file.title)?,
        duration,
        start_stroke,
        load,
        effects: effects_of_bench(document, &file.effect, &nominal)?,
        hand: file.hand,
        command,
        valve: valve(document, &file.valve, duration)?,
        step,
        substeps: file.simulation.substeps,
        seed: file.simulation.seed,
        estimator: estimator.transpose()?,
        sensing,
        controller,
        expect: expectations(&section("expect"), &file.expect)?,
        nominal,
        device,
    })
}

/// Refuses a place [m] beyond the device's stroke [m].
fn within_stroke(
    section: &Section<'_>,
    key: &str,
    [place, full_stroke]: [f64; 2],
) -> Result<(), ScenarioError> {
    let expected = format!("at most the device's stroke_mm, {} mm", full_stroke * 1e3);
    match place > full_stroke {
        true => Err(section.refuse_si(key, place, expected)),
        false => Ok(()),
    }
}

/// Load that the tool meets; of the contact the keys given change a part.
fn load(
    section: &Section<'_>,
    keys: &LoadKeys,
    contact: &mut ContactParameters,
    full_stroke: f64,
) -> Result<LoadScenario, ScenarioError> {
    section.of_kind::<LoadKeys>(None)?;
    if keys.kind == LoadKind::Free {
        return Ok(LoadScenario::Free);
    }
    // What a kind needs is there by now.
    let needed = |value: Option<f64>| value.unwrap_or_default();
    let position = needed(keys.position);
    within_stroke(section, "position_mm", [position, full_stroke])?;
    if let Some(stiffness) = keys.stiffness {
        contact.law = ContactLaw::Linear { stiffness };
    }
    contact.damping = keys.damping.unwrap_or(contact.damping);
    Ok(LoadScenario::Contact {
        position,
        motion: (keys.kind == LoadKind::Surface).then(|| SurfaceMotion {
            peak_to_peak: needed(keys.peak_to_peak),
            frequency: needed(keys.frequency),
            start: keys.start,
        }),
    })
}

/// Checks that times follow one another within the run.
fn in_order(
    document: &Document<'_>,
    table: &str,
    times: impl Iterator<Item = f64>,
    duration: f64,
) -> Result<Vec<f64>, ScenarioError> {
    let mut checked: Vec<f64> = Vec::new();
    for (index, time) in times.enumerate() {
        let section = Section::new(document, format!("{table}[{index}]"));
        let at = section.number("at_s", time, 0.0..=duration)?;
        if let Some(&before) = checked.last()
            && at <= before
        {
            let expected = format!("later than the entry ahead of it, {before} s");
            return Err(section.refuse_number("at_s", time, expected));
        }
        checked.push(at);
    }
    Ok(checked)
}

fn commands(
    document: &Document<'_>,
    keys: &[CommandKeys],
    duration: f64,
    chain: &CommandChain,
    check_force: impl Fn(&Section<'_>, f64) -> Result<(), ScenarioError>,
) -> Result<CommandScenario, ScenarioError> {
    let times = in_order(document, "command", keys.iter().map(|k| k.at), duration)?;
    let by_force = keys.first().is_some_and(|first| first.force.is_some());
    let mut steps = Vec::with_capacity(keys.len());
    for (index, (keys, at)) in keys.iter().zip(times).enumerate() {
        let section = Section::new(document, format!("command[{index}]"));
        let value = match (by_force, keys.set_pressure, keys.force) {
            (false, Some(pressure), None) => {
                check_set_pressure(&section, "set_pressure_bar_gauge", pressure, chain)?;
                pressure
            }
            (true, None, Some(force)) => {
                check_force(&section, force)?;
                force
            }
            (_, Some(_), Some(_)) => {
                let reason = "a command gives a set pressure or a force".to_owned();
                return Err(section.misplaced("force_n", reason));
            }
            (false, None, Some(_)) => {
                let reason = "the first command gives a set pressure, so all of them do".to_owned();
                return Err(section.misplaced("force_n", reason));
            }
            (true, Some(_), None) => {
                let reason = "the first command gives a force, so all of them do".to_owned();
                return Err(section.misplaced("set_pressure_bar_gauge", reason));
            }
            (false, None, None) => {
                return Err(section.missing("set_pressure_bar_gauge", "it or force_n to be given"));
            }
            (true, None, None) => {
                return Err(section.missing("force_n", "it to be given, as in the first command"));
            }
        };
        steps.push((at, value));
    }
    Ok(if by_force {
        CommandScenario::Force(steps)
    } else {
        CommandScenario::SetPressure(steps)
    })
}

/// A controller that has nothing to do, or nothing to press on, is refused.
fn check_controller(
    section: &Section<'_>,
    controller: &ControllerScenario,
    command: &CommandScenario,
    load: &LoadScenario,
) -> Result<(), ScenarioError> {
    if let (CommandScenario::SetPressure(_), Some(key)) = (command, section.given().next()) {
        let reason = "no [[command]] gives a force, so there is nothing to control".to_owned();
        return Err(section.misplaced(key, reason));
    }
    if *load == LoadScenario::Free && controller.law != ForceLaw::OpenLoop {
        let reason = "nothing is met when load.kind = \"free\", so there is no force to feed back";
        return Err(section.misplaced("kind", reason.to_owned()));
    }
    Ok(())
}

fn valve(
    document: &Document<'_>,
    keys: &[ValveKeys],
    duration: f64,
) -> Result<Vec<(f64, ValvePosition)>, ScenarioError> {
    let times = in_order(document, "valve", keys.iter().map(|k| k.at), duration)?;
    Ok(times
        .into_iter()
        .zip(keys.iter().map(|keys| keys.position.0))
        .collect())
}
