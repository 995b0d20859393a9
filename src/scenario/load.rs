//! From the keys of a scenario file to the scenario: what its values must be to each other.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use glam::DVec3;

use super::arm_file::{ArmFile, EffectTables, load_arm_file};
use super::assumed;
use super::cell::ContactKeys;
use super::collision::collision;
use super::controller::{ForceLaw, controller};
use super::device::load_with_overrides;
use super::effects::{EffectKeys, effects};
use super::file::{self, ScenarioFile};
use super::program::program;
use super::sensing::sensing;
use super::tool;
use super::workpiece::workpiece;
use super::{
    ArmScenario, DeviceScenario, DriveScenario, Expectation, LimitOverride, PassScenario,
    ProcessScenario, RemovalScenario, Scenario,
};
use crate::effects::{Effect, PresentEffect, every};
use crate::keys::check::{Section, pose};
use crate::keys::declaration::tables;
use crate::keys::document::{Document, read_text};
use crate::keys::error::ScenarioError;
use crate::plant::{ContactLaw, Nominal, Periodic, PlantParameters};

/// Reads the scenario of a cell from a document that does not say otherwise.
pub(super) fn from_document(
    path: &Path,
    document: &Document<'_>,
) -> Result<Scenario, ScenarioError> {
    let file: ScenarioFile = document.read()?;
    let section = |table: &str| Section::new(document, table);
    let (device, mut nominal) = device(&section("device"), &file.device)?;
    contact(&section("contact"), &file.contact, &mut nominal);
    check_lock(&section("contact"), &device, &nominal)?;
    let sensing = sensing(document, &file.sensing, file.simulation.step)?;
    let controller = controller(
        document,
        &file.controller,
        &nominal.device,
        &sensing,
        file.simulation.step,
    )?;
    if device.locked && controller.law != ForceLaw::OpenLoop {
        let reason = "the slide is clamped (device.locked), so that no pressure changes the force";
        return Err(section("controller").misplaced("kind", reason.to_owned()));
    }
    Ok(Scenario {
        path: path.to_owned(),
        title: section("").text("title", &file.title)?,
        passes: passes(document, &file)?,
        tool: (file.tool.as_ref())
            .map(|keys| tool::tool(&section("tool"), keys, nominal.mounting.tool_radius))
            .transpose()?,
        removal: removal(document, &file)?,
        arm: arm(&section("arm"), file.arm)?,
        workpiece: workpiece(&section("workpiece"), &file.workpiece)?,
        process: process(
            &section("process"),
            file.process,
            nominal.device.full_stroke,
        )?,
        sensing,
        controller,
        collision: collision(document, &file.collision, &file.obstacle)?,
        program: program(&section("program"), file.program)?,
        simulation: file.simulation,
        limits: file.limits.limits(),
        expect: expectations(&section("expect"), &file.expect)?,
        effects: of_whole(document, &file.effect, &nominal)?,
        assumed: assumed::of_cell(document, &tables::<ScenarioFile>()),
        nominal: Nominal(nominal),
        device,
    })
}

/// The effects of a file that may name any.
pub(super) fn of_whole(
    document: &Document<'_>,
    keys: &EffectKeys,
    nominal: &PlantParameters,
) -> Result<Vec<PresentEffect>, ScenarioError> {
    let known: Vec<&'static Effect> = every().collect();
    effects(document, keys, &known, nominal)
}

pub(super) fn arm(
    section: &Section<'_>,
    keys: file::ArmKeys,
) -> Result<ArmScenario, ScenarioError> {
    let document = section.document();
    let packages = Section::new(document, "arm.packages");
    let folder = |(name, folder): (&String, &std::path::PathBuf)| {
        Ok((name.clone(), packages.directory(name, folder)?))
    };
    Ok(ArmScenario {
        urdf: section.file("urdf", &keys.urdf)?,
        base_link: (keys.base_link.as_deref())
            .map(|name| section.text("base_link", name))
            .transpose()?,
        flange_link: section.text("flange_link", &keys.flange_link)?,
        flange_from_mount: pose(DVec3::ZERO, keys.flange_rotation).rotation,
        whole_mass: keys.mass,
        mass_spread: keys.mass_spread,
        link_masses: link_masses(document, &keys.link_masses)?,
        package_directories: keys.packages.iter().map(folder).collect::<Result<_, _>>()?,
        limit_overrides: limit_overrides(document, keys.limit_overrides)?,
        drives: drives(document, keys.drives)?,
        world_from_base: pose(keys.base_position, keys.base_rotation),
        payload: keys.payload,
        seed_posture: keys.seed_posture,
        servo: keys.servo,
        recorded_arm: recorded_arm(section, keys.recorded_arm.as_deref(), &keys.effects)?,
    })
}

/// The arm file with the effects that the scenario puts into it.
fn recorded_arm(
    section: &Section<'_>,
    path: Option<&Path>,
    effects: &EffectTables,
) -> Result<Option<Box<ArmFile>>, ScenarioError> {
    let Some(path) = path else {
        if effects.is_empty() {
            return Ok(None);
        }
        let expected = "the arm file that [[arm.effect]] changes (`idc new arm` writes one)";
        return Err(section.missing("recorded_arm", expected));
    };
    let file = load_arm_file(&section.file("recorded_arm", path)?)?;
    let file = file.with_effects(section.document(), ("arm.effect", effects))?;
    Ok(Some(Box::new(file)))
}

fn link_masses(
    document: &Document<'_>,
    masses: &[file::LinkMassKeys],
) -> Result<BTreeMap<String, f64>, ScenarioError> {
    let mut found = BTreeMap::new();
    for (index, keys) in masses.iter().enumerate() {
        let section = Section::new(document, format!("arm.link_masses[{index}]"));
        let link = section.text("link", &keys.link)?;
        if found.insert(link.clone(), keys.mass).is_some() {
            let expected = "each link once".to_owned();
            return Err(section.refuse("link", format!("\"{link}\" again"), expected));
        }
    }
    Ok(found)
}

fn limit_overrides(
    document: &Document<'_>,
    overrides: Vec<LimitOverride>,
) -> Result<Vec<LimitOverride>, ScenarioError> {
    let mut joints = BTreeSet::new();
    for (index, limits) in overrides.iter().enumerate() {
        let section = Section::new(document, format!("arm.limit_overrides[{index}]"));
        once(&section, &limits.joint, &mut joints)?;
        if limits.effort.is_none() && limits.velocity.is_none() {
            return Err(section.missing("effort_n_m", "it or velocity_deg_per_s to be given"));
        }
    }
    Ok(overrides)
}

/// A joint that no table before has named.
fn once(
    section: &Section<'_>,
    joint: &str,
    before: &mut BTreeSet<String>,
) -> Result<(), ScenarioError> {
    if before.insert(section.text("joint", joint)?) {
        return Ok(());
    }
    let expected = "each joint once".to_owned();
    Err(section.refuse("joint", format!("\"{joint}\" again"), expected))
}

fn drives(
    document: &Document<'_>,
    drives: Vec<DriveScenario>,
) -> Result<Vec<DriveScenario>, ScenarioError> {
    let mut joints = BTreeSet::new();
    for (index, drive) in drives.iter().enumerate() {
        let section = Section::new(document, format!("arm.drives[{index}]"));
        once(&section, &drive.joint, &mut joints)?;
        if drive.backlash > 0.0 && drive.stiffness.is_infinite() {
            let expected = "the stiffness of the teeth beside a backlash";
            return Err(section.missing("stiffness_n_m_per_rad", expected));
        }
    }
    Ok(drives)
}

/// Whether it is a rig file. Whatever is wrong with it is said when it is read as what it is.
pub(super) fn is_rig(path: &Path) -> Result<bool, ScenarioError> {
    let text = read_text(path)?;
    let document = Document::new(path, &text, file::SCHEMA)?;
    Ok(document.location("cylinder").position.is_some())
}

/// The device of a scenario, and its physics: its model with what the scenario overrides.
pub(super) fn device(
    section: &Section<'_>,
    keys: &file::DeviceKeys,
) -> Result<(DeviceScenario, PlantParameters), ScenarioError> {
    let overrides = Section::new(section.document(), "device.override");
    let model = section.file("model", &keys.model)?;
    if is_rig(&model)? {
        let found = format!("\"{}\", a rig file", keys.model.display());
        let expected = "a device model file; a scenario of kind = \"bench\" takes a rig file";
        return Err(section.refuse("model", found, expected.to_owned()));
    }
    let ideal = keys.ideal.unwrap_or(false);
    let layer = keys.overrides.as_ref().map(|keys| (overrides, keys));
    let (mut device, plant) = load_with_overrides(&model, layer, ideal)?;
    device.locked = keys.locked;
    Ok((device, plant))
}

/// Puts what a file says of the contact into a description that has the usual one of its device.
pub(super) fn contact(section: &Section<'_>, keys: &ContactKeys, plant: &mut PlantParameters) {
    let is_given = |key: &str| section.given().any(|given| given == key);
    let contact = &mut plant.contact;
    if is_given("stiffness_n_per_m") {
        contact.law = ContactLaw::Linear {
            stiffness: keys.stiffness,
        };
    }
    if is_given("damping_n_s_per_m") {
        contact.damping = keys.damping;
    }
    contact.spindle_frequency = keys.spindle_frequency;
    if keys.runout_amplitude > 0.0 {
        // A ball that turns towards the part finds its surface nearer.
        contact.runout = Periodic {
            sine: -keys.runout_amplitude,
            frequency: keys.runout_frequency,
            ..Periodic::NONE
        };
    }
    plant.cell.friction = keys.friction;
}

/// A clamp that yields as much as the contact would not lock the device.
fn check_lock(
    section: &Section<'_>,
    device: &DeviceScenario,
    nominal: &PlantParameters,
) -> Result<(), ScenarioError> {
    const LEAST_RATIO: f64 = 10.0;
    let largest = nominal.device.lock_stiffness / LEAST_RATIO;
    let stiffness = nominal.contact.stiffness_at(0.0);
    if device.locked && stiffness > largest {
        let expected = format!(
            "at most {largest} N/m, a tenth of the device's lock_stiffness_n_per_m, as the device is locked"
        );
        return Err(section.refuse_si("stiffness_n_per_m", stiffness, expected));
    }
    Ok(())
}

/// The process with a device of a full stroke [m].
fn process(
    section: &Section<'_>,
    mut process: ProcessScenario,
    full_stroke: f64,
) -> Result<ProcessScenario, ScenarioError> {
    if process.working_stroke.is_nan() {
        process.working_stroke = full_stroke / 2.0;
    }
    if process.working_stroke >= full_stroke {
        let expected = format!("less than the device's stroke_mm, {} mm", full_stroke * 1e3);
        return Err(section.refuse_si("working_stroke_mm", process.working_stroke, expected));
    }
    if process.tool_axis.is_some() && section.given().any(|key| key == "lean_deg") {
        let reason = "`process.lean_deg` is given too, expected one of the two".to_owned();
        return Err(section.misplaced("tool_axis", reason));
    }
    if process.corner_feed > process.feed {
        let expected = format!("at most feed_mm_per_s, {} mm/s", process.feed * 1e3);
        return Err(section.refuse_si("corner_feed_mm_per_s", process.corner_feed, expected));
    }
    Ok(process)
}

/// The passes in their order.
fn passes(
    document: &Document<'_>,
    file: &ScenarioFile,
) -> Result<Vec<PassScenario>, ScenarioError> {
    if file.pass.is_empty() {
        return Ok(vec![PassScenario::default(); file.process.passes]);
    }
    let process = Section::new(document, "process");
    if process.given().any(|key| key == "passes") {
        let reason = "there are [[pass]] tables, which are as many as there are passes";
        return Err(process.misplaced("passes", reason.to_owned()));
    }
    let pass = |(index, keys): (usize, &file::PassKeys)| {
        let section = Section::new(document, format!("pass[{index}].expect"));
        Ok(PassScenario {
            force: keys.force,
            feed: keys.feed,
            expect: expectations(&section, &keys.expect)?,
        })
    };
    file.pass.iter().enumerate().map(pass).collect()
}

/// What is taken off needs a tool that turns.
fn removal(
    document: &Document<'_>,
    file: &ScenarioFile,
) -> Result<Option<RemovalScenario>, ScenarioError> {
    let Some(keys) = &file.removal else {
        return Ok(None);
    };
    let section = Section::new(document, "removal");
    if file.tool.is_none() {
        let reason = "there is no [tool], and a tool that does not turn takes nothing off";
        return Err(section.misplaced_itself(reason.to_owned()));
    }
    tool::removal(&section, keys).map(Some)
}

/// Whether a metric of this name exists is for whoever computes them to say.
pub(super) fn expectations(
    section: &Section<'_>,
    bounds: &std::collections::BTreeMap<String, file::BoundKeys>,
) -> Result<Vec<Expectation>, ScenarioError> {
    bounds
        .iter()
        .map(|(metric, bound)| {
            let finite = |value: Option<f64>| value.is_none_or(f64::is_finite);
            let found = match (bound.min, bound.max) {
                (None, None) => "empty".to_owned(),
                (Some(min), Some(max)) if min > max => format!("{{ min = {min}, max = {max} }}"),
                (min, max) if finite(min) && finite(max) => {
                    return Ok(Expectation {
                        metric: metric.clone(),
                        min,
                        max,
                    });
                }
                _ => "not finite".to_owned(),
            };
            let expected = "min, max or both, finite and min not above max".to_owned();
            Err(section.refuse(metric, found, expected))
        })
        .collect()
}
