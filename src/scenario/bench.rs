//! A bench scenario: the device without an arm, on a load cell, on a moved surface, or free.

use std::path::{Path, PathBuf};

use super::bench_file::{
    BenchFile, BenchKeys, BenchSimulationKeys, CommandKeys, HandKeys, LoadKeys, LoadKind, ValveKeys,
};
use super::check::Section;
use super::controller::{ControllerScenario, ForceLaw, check_force, controller};
use super::document::Document;
use super::effects::{EffectKeys, effects};
use super::error::ScenarioError;
use super::estimator::{EstimatorBase, estimator as set_up_estimator};
use super::load::expectations;
use super::rig_device::{BenchDevice, bench_device, usual_contact};
use super::rig_file::blank;
use super::sections::{bench_sections, keys as keys_of};
use super::sensing::{check_set_pressure, sensing};
use super::{DeviceScenario, Expectation};
use crate::effects::{Effect, PresentEffect, Subsystem, every};
use crate::estimation::ContactForceEstimator;
use crate::physics::valve::ValvePosition;
use crate::plant::{
    ContactLaw, ContactParameters, Latent, OwnLaw, PlantParameters, SensorErrors, registry,
};
use crate::sensing::{CommandChain, SensingParameters};

/// A bench and what is done on it.
#[derive(Debug, Clone)]
pub struct BenchScenario {
    /// File that it was read from.
    pub path: PathBuf,
    /// Name for people; becomes the recording's title.
    pub title: String,
    /// The device.
    pub device: DeviceScenario,
    /// Length of the run [s].
    pub duration: f64,
    /// Component of gravity along extension [m/s2].
    pub gravity_along_extension: f64,
    /// Stroke at the start [m], unless the weight rests on the retracted stop.
    pub start_stroke: f64,
    /// Load that the tool meets.
    pub load: LoadScenario,
    /// A hand that pushes against extension.
    pub hand: Option<HandScenario>,
    /// Physics beyond the believed device, with all its numbers.
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
    /// Errors of a rig file's sensors, ahead of that chain.
    pub sensor_errors: SensorErrors,
    /// A term without a name that the rig file has.
    pub latent: Option<Latent>,
    /// Laws of a user's own that the rig file has.
    pub own: Vec<OwnLaw>,
    /// Controller of the regulator's pressure where forces are commanded.
    pub controller: ControllerScenario,
    /// Estimator of the contact force, set up as it believes noise and device to be.
    pub estimator: Option<ContactForceEstimator>,
    /// Bounds that the results must keep.
    pub expect: Vec<Expectation>,
}

/// Load that the tool meets.
#[expect(clippy::large_enum_variant, reason = "one of a scenario")]
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum LoadScenario {
    /// Nothing.
    Free,
    /// Something that pushes back.
    Contact {
        /// Where it stands along the stroke, from the retracted end [m].
        position: f64,
        /// Contact, and where the surface really stands.
        contact: ContactParameters,
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

/// A hand that pushes against extension: peak_force/2 (1 - cos(2 pi frequency (t - start))).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HandScenario {
    /// Largest force [N].
    pub peak_force: f64,
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

impl BenchScenario {
    /// The rig as its owner believes it to be.
    #[must_use]
    pub fn believed(&self) -> PlantParameters {
        let contact = match self.load {
            LoadScenario::Free => usual_contact(self.device.ideal),
            LoadScenario::Contact { contact, .. } => contact,
        };
        PlantParameters {
            device: self.device.parameters.clone(),
            gravity_along_extension: self.gravity_along_extension,
            contact,
            sensors: self.sensor_errors,
            latent: self.latent.clone(),
            own: self.own.clone(),
            ..blank()
        }
    }

    /// The rig as it is, with its effects put in.
    #[must_use]
    pub fn plant(&self) -> PlantParameters {
        let mut plant = self.believed();
        for effect in &self.effects {
            effect.put_into(&mut plant);
        }
        plant
    }

    /// The scenario with the rig's numbers as they are.
    #[must_use]
    pub fn as_it_is(mut self, plant: &PlantParameters) -> Self {
        self.device.parameters = plant.device.clone();
        self.gravity_along_extension = plant.gravity_along_extension;
        self.sensor_errors = plant.sensors;
        if let LoadScenario::Contact { contact, .. } = &mut self.load {
            *contact = plant.contact;
        }
        self
    }
}

/// The effects that a bench's file names.
fn effects_of_bench(
    document: &Document<'_>,
    keys: &EffectKeys,
    plant: &PlantParameters,
) -> Result<Vec<PresentEffect>, ScenarioError> {
    let known: Vec<&'static Effect> = every().collect();
    let effects = effects(document, keys, &known, plant)?;
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

/// Duration [s], gravity along extension [m/s2] and stroke at the start [m], for a device with its rig file's gravity.
fn conditions(
    section: &Section<'_>,
    keys: &BenchKeys,
    device: &DeviceScenario,
    gravity: f64,
) -> Result<(f64, f64, f64), ScenarioError> {
    let duration = section.number("duration_s", keys.duration_s, 0.01..=3600.0)?;
    let key = "start_stroke_mm";
    let start_stroke = section.number(key, keys.start_stroke_mm.unwrap_or(0.0), 0.0..=500.0)?;
    let full_stroke = device.parameters.full_stroke;
    if start_stroke > full_stroke {
        let expected = format!("at most the device's stroke_mm, {} mm", full_stroke * 1e3);
        return Err(section.refuse_number(key, start_stroke * 1e3, expected));
    }
    let gravity = section.known(
        &registry::GRAVITY,
        "gravity_along_extension_m_per_s2",
        keys.gravity_along_extension_m_per_s2.unwrap_or(gravity),
    )?;
    Ok((duration, gravity, start_stroke))
}

/// Reads a bench scenario from a document that says that it is one.
pub(super) fn from_document(
    path: &Path,
    document: &Document<'_>,
) -> Result<BenchScenario, ScenarioError> {
    let file: BenchFile = document.parse(&bench_sections())?;
    let section = |table: &str| Section::new(document, table);
    let BenchDevice {
        device,
        gravity_along_extension,
        contact,
        sensor_errors,
        latent,
        own,
    } = bench_device(&section("device"), &file.device)?;
    let bench = section("bench");
    let (duration, gravity_along_extension, start_stroke) =
        conditions(&bench, &file.bench, &device, gravity_along_extension)?;
    if device.locked {
        let reason = "a bench has no locked device".to_owned();
        return Err(section("device").misplaced("locked", reason));
    }
    let (step, substeps, seed) = simulation(&section("simulation"), &file.simulation)?;
    let sensing = sensing(document, &file.sensing, step)?;
    let parameters = &device.parameters;
    let check_force = |section: &Section<'_>, force: f64| {
        let gravity = gravity_along_extension;
        check_force(section, force, gravity, parameters, &sensing.command)
    };
    let command = commands(
        document,
        &file.command,
        duration,
        &sensing.command,
        check_force,
    )?;
    let load = load(
        &section("load"),
        &file.load,
        contact,
        device.parameters.full_stroke,
    )?;
    let controller = controller(document, &file.controller, parameters, &sensing, step)?;
    check_controller(&section("controller"), &controller, &command, &load)?;
    let base = EstimatorBase {
        device: &device.parameters,
        sensing: &sensing,
        gravity_along_extension,
        start_stroke,
        step,
    };
    let estimator = file.estimator.as_ref();
    let estimator = estimator.map(|keys| set_up_estimator(document, keys, &base));
    let hand = (file.hand.as_ref()).map(|keys| hand(&section("hand"), keys));
    let mut scenario = BenchScenario {
        path: path.to_owned(),
        title: section("").text("title", &file.title)?,
        duration,
        gravity_along_extension,
        start_stroke,
        load,
        effects: Vec::new(),
        latent,
        own,
        hand: hand.transpose()?,
        command,
        valve: valve(document, &file.valve, duration)?,
        step,
        substeps,
        seed,
        estimator: estimator.transpose()?,
        sensing,
        sensor_errors,
        controller,
        expect: expectations(&section("expect"), &file.expect)?,
        device,
    };
    scenario.effects = effects_of_bench(document, &file.effect, &scenario.believed())?;
    Ok(scenario)
}

#[rustfmt::skip] // A table: one key a line.
fn simulation(
    section: &Section<'_>,
    keys: &BenchSimulationKeys,
) -> Result<(f64, usize, u64), ScenarioError> {
    Ok((
        section.number("step_ms", keys.step_ms.unwrap_or(1.0), 0.01..=20.0)?,
        section.count("device_substeps", keys.device_substeps.unwrap_or(2), 1..=1000)?,
        keys.seed.unwrap_or(1),
    ))
}

/// Load that the tool meets; `contact` is that of the rig, of which the keys given change a part.
fn load(
    section: &Section<'_>,
    keys: &LoadKeys,
    mut contact: ContactParameters,
    full_stroke: f64,
) -> Result<LoadScenario, ScenarioError> {
    let (allowed, reason): (&[&str], _) = match keys.kind {
        LoadKind::Free => (&[], "nothing is met when kind = \"free\""),
        LoadKind::LoadCell => (
            &["position_mm", "stiffness_n_per_m", "damping_n_s_per_m"],
            "a load cell stands still; kind = \"surface\" moves",
        ),
        LoadKind::Surface => (keys_of::<LoadKeys>(), ""),
    };
    let is_other = |key: &&str| *key != "kind" && !allowed.contains(key);
    if let Some(key) = section.given().find(is_other) {
        return Err(section.misplaced(key, reason.to_owned()));
    }
    if keys.kind == LoadKind::Free {
        return Ok(LoadScenario::Free);
    }
    let required = |key: &str, value: Option<f64>| {
        value.ok_or_else(|| section.missing(key, "it to be given for this kind of load"))
    };
    let given = required("position_mm", keys.position_mm)?;
    let position = section.number("position_mm", given, 0.0..=500.0)?;
    if position > full_stroke {
        let expected = format!("at most the device's stroke_mm, {} mm", full_stroke * 1e3);
        return Err(section.refuse_number("position_mm", given, expected));
    }
    if let Some(stiffness) = keys.stiffness_n_per_m {
        let stiffness =
            section.known(&registry::CONTACT_STIFFNESS, "stiffness_n_per_m", stiffness)?;
        contact.law = ContactLaw::Linear { stiffness };
    }
    if let Some(damping) = keys.damping_n_s_per_m {
        contact.damping =
            section.known(&registry::CONTACT_DAMPING, "damping_n_s_per_m", damping)?;
    }
    let motion = if keys.kind == LoadKind::Surface {
        let peak_to_peak = required("peak_to_peak_mm", keys.peak_to_peak_mm)?;
        let frequency = required("frequency_hz", keys.frequency_hz)?;
        Some(SurfaceMotion {
            peak_to_peak: section.number("peak_to_peak_mm", peak_to_peak, 0.0..=500.0)?,
            frequency: section.number("frequency_hz", frequency, 0.001..=100.0)?,
            start: section.number("start_s", keys.start_s.unwrap_or(0.0), 0.0..=3600.0)?,
        })
    } else {
        None
    };
    Ok(LoadScenario::Contact {
        position,
        contact,
        motion,
    })
}

fn hand(section: &Section<'_>, keys: &HandKeys) -> Result<HandScenario, ScenarioError> {
    Ok(HandScenario {
        peak_force: section.number("peak_force_n", keys.peak_force_n, 0.0..=5000.0)?,
        frequency: section.number("frequency_hz", keys.frequency_hz, 0.001..=100.0)?,
        start: section.number("start_s", keys.start_s.unwrap_or(0.0), 0.0..=3600.0)?,
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
    let times = in_order(document, "command", keys.iter().map(|k| k.at_s), duration)?;
    let by_force = keys.first().is_some_and(|first| first.force_n.is_some());
    let mut steps = Vec::with_capacity(keys.len());
    for (index, (keys, at)) in keys.iter().zip(times).enumerate() {
        let section = Section::new(document, format!("command[{index}]"));
        let value = match (by_force, keys.set_pressure_bar_gauge, keys.force_n) {
            (false, Some(pressure), None) => {
                let key = "set_pressure_bar_gauge";
                let wanted = section.number(key, pressure, 0.0..=16.0)?;
                check_set_pressure(&section, key, wanted, chain)?;
                wanted
            }
            (true, None, Some(force)) => {
                let wanted = section.number("force_n", force, 0.0..=5000.0)?;
                check_force(&section, wanted)?;
                wanted
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
    let times = in_order(document, "valve", keys.iter().map(|k| k.at_s), duration)?;
    Ok(times
        .into_iter()
        .zip(keys.iter().map(|keys| keys.position))
        .collect())
}
