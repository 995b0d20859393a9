//! From a scenario file to the checked scenario in SI. Each number's default and range stand here, in the key's own unit; scenarios/README.md repeats them.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use glam::DVec3;

use super::check::Section;
use super::collision::collision;
use super::controller::{ForceLaw, controller};
use super::device::load_with_overrides;
use super::document::{Document, read_text};
use super::effects::{EffectKeys, effects};
use super::error::ScenarioError;
use super::file::{self, ScenarioFile};
use super::judged;
use super::sections::scenario_sections;
use super::sensing::sensing;
use super::tool;
use super::workpiece::workpiece;
use super::{
    ArmScenario, ContactScenario, DeviceScenario, DriveScenario, Expectation, FeedFollows,
    FeedMeasure, LimitOverride, PassScenario, ProcessScenario, RemovalScenario, Scenario,
    ServoScenario, SimulationScenario,
};
use crate::effects::{Effect, PresentEffect, every};
use crate::plant::{CellParameters, PlantParameters, registry};

/// Reads the scenario of a cell from a document that does not say otherwise.
pub(super) fn from_document(
    path: &Path,
    document: &Document<'_>,
) -> Result<Scenario, ScenarioError> {
    let file: ScenarioFile = document.parse(&scenario_sections())?;
    let section = |table: &str| Section::new(document, table);
    let device = device(&section("device"), &file.device)?;
    let contact = contact(&section("contact"), &file.contact, device.ideal)?;
    check_lock(&section("contact"), &file.contact, &device, &contact)?;
    let simulation = simulation(&section("simulation"), &file.simulation)?;
    let sensing = sensing(document, &file.sensing, simulation.step)?;
    let controller = controller(
        document,
        &file.controller,
        &device.parameters,
        &sensing,
        simulation.step,
    )?;
    if device.locked && controller.law != ForceLaw::OpenLoop {
        let reason = "the slide is clamped (device.locked), so that no pressure changes the force";
        return Err(section("controller").misplaced("kind", reason.to_owned()));
    }
    Ok(Scenario {
        path: path.to_owned(),
        title: section("").text("title", &file.title)?,
        arm: arm(&section("arm"), &file.arm)?,
        workpiece: workpiece(&section("workpiece"), &file.workpiece)?,
        passes: passes(document, &file)?,
        process: process(&section("process"), &file.process, &device)?,
        tool: (file.tool.as_ref())
            .map(|keys| tool::tool(&section("tool"), keys, device.tool_radius))
            .transpose()?,
        removal: removal(document, &file)?,
        sensing,
        controller,
        collision: collision(document, &file.collision, &file.obstacle)?,
        simulation,
        expect: expectations(&section("expect"), &file.expect)?,
        effects: of_whole(document, &file.effect, &device, &contact)?,
        judged: judged::of_cell(document),
        device,
        contact,
    })
}

/// The effects of a file that may name any.
pub(super) fn of_whole(
    document: &Document<'_>,
    keys: &EffectKeys,
    device: &DeviceScenario,
    contact: &ContactScenario,
) -> Result<Vec<PresentEffect>, ScenarioError> {
    let known: Vec<&'static Effect> = every().collect();
    let law = (contact.stiffness, contact.damping);
    // Of the arm's joints a file that is read says little; the cell knows them (`cell::plant`).
    let believed = PlantParameters::of_cell(device.parameters.clone(), law, CellParameters::RIGID);
    effects(document, keys, &known, &believed)
}

pub(super) fn arm(
    section: &Section<'_>,
    keys: &file::ArmKeys,
) -> Result<ArmScenario, ScenarioError> {
    let packages = Section::new(section.document(), "arm.packages");
    let folder = |(name, folder): (&String, &std::path::PathBuf)| {
        Ok((name.clone(), packages.directory(name, folder)?))
    };
    let base_link = keys.base_link.as_deref();
    let posture = keys.seed_posture_deg.as_deref();
    Ok(ArmScenario {
        urdf: section.file("urdf", &keys.urdf)?,
        base_link: base_link
            .map(|name| section.text("base_link", name))
            .transpose()?,
        flange_link: section.text("flange_link", &keys.flange_link)?,
        flange_from_mount: section
            .pose(
                ("flange_position_mm", None),
                ("flange_rotation_deg", keys.flange_rotation_deg.as_deref()),
            )?
            .rotation,
        whole_mass: keys
            .mass_kg
            .map(|mass| section.number("mass_kg", mass, 0.1..=100_000.0))
            .transpose()?,
        mass_spread: section.number("mass_spread", keys.mass_spread.unwrap_or(0.5), 0.0..=1.0)?,
        link_masses: link_masses(section.document(), &keys.link_masses)?,
        package_directories: keys.packages.iter().map(folder).collect::<Result<_, _>>()?,
        limit_overrides: limit_overrides(section.document(), &keys.limit_overrides)?,
        drives: drives(section.document(), &keys.drives)?,
        world_from_base: section.pose(
            ("base_position_mm", keys.base_position_mm.as_deref()),
            ("base_rotation_deg", keys.base_rotation_deg.as_deref()),
        )?,
        payload: keys
            .payload_kg
            .map(|mass| section.number("payload_kg", mass, 0.1..=3000.0))
            .transpose()?,
        seed_posture: posture
            .map(|angles| section.numbers("seed_posture_deg", angles, -360.0..=360.0))
            .transpose()?,
        servo: servo(&Section::new(section.document(), "arm.servo"), &keys.servo)?,
    })
}

fn link_masses(
    document: &Document<'_>,
    masses: &[file::LinkMassKeys],
) -> Result<BTreeMap<String, f64>, ScenarioError> {
    let mut found = BTreeMap::new();
    for (index, keys) in masses.iter().enumerate() {
        let section = Section::new(document, format!("arm.link_masses[{index}]"));
        let link = section.text("link", &keys.link)?;
        let mass = section.number("mass_kg", keys.mass_kg, 0.001..=100_000.0)?;
        if found.insert(link.clone(), mass).is_some() {
            let expected = "each link once".to_owned();
            return Err(section.refuse("link", format!("\"{link}\" again"), expected));
        }
    }
    Ok(found)
}

fn limit_overrides(
    document: &Document<'_>,
    overrides: &[file::LimitKeys],
) -> Result<Vec<LimitOverride>, ScenarioError> {
    let mut joints = BTreeSet::new();
    let mut limits = Vec::with_capacity(overrides.len());
    for (index, keys) in overrides.iter().enumerate() {
        let section = Section::new(document, format!("arm.limit_overrides[{index}]"));
        let joint = once(&section, &keys.joint, &mut joints)?;
        if keys.effort_n_m.is_none() && keys.velocity_deg_per_s.is_none() {
            return Err(section.missing("effort_n_m", "it or velocity_deg_per_s to be given"));
        }
        let effort = keys.effort_n_m;
        let velocity = keys.velocity_deg_per_s;
        limits.push(LimitOverride {
            joint,
            effort: effort
                .map(|value| section.number("effort_n_m", value, 0.1..=100_000.0))
                .transpose()?,
            velocity: velocity
                .map(|value| section.number("velocity_deg_per_s", value, 1.0..=2000.0))
                .transpose()?,
        });
    }
    Ok(limits)
}

/// A joint that no table before has named.
fn once(
    section: &Section<'_>,
    joint: &str,
    before: &mut BTreeSet<String>,
) -> Result<String, ScenarioError> {
    let joint = section.text("joint", joint)?;
    if before.insert(joint.clone()) {
        return Ok(joint);
    }
    let expected = "each joint once".to_owned();
    Err(section.refuse("joint", format!("\"{joint}\" again"), expected))
}

fn drives(
    document: &Document<'_>,
    drives: &[file::DriveKeys],
) -> Result<Vec<DriveScenario>, ScenarioError> {
    let mut joints = BTreeSet::new();
    let mut checked = Vec::with_capacity(drives.len());
    for (index, keys) in drives.iter().enumerate() {
        let section = Section::new(document, format!("arm.drives[{index}]"));
        let joint = once(&section, &keys.joint, &mut joints)?;
        let drive = drive(&section, keys, joint)?;
        if drive.backlash > 0.0 && drive.stiffness.is_infinite() {
            let expected = "the stiffness of the teeth beside a backlash";
            return Err(section.missing("stiffness_n_m_per_rad", expected));
        }
        checked.push(drive);
    }
    Ok(checked)
}

#[rustfmt::skip] // A table: one key a line.
fn drive(section: &Section<'_>, keys: &file::DriveKeys, joint: String) -> Result<DriveScenario, ScenarioError> {
    let friction = keys.friction_n_m;
    Ok(DriveScenario {
        joint,
        friction: friction.map(|value| section.known(&registry::DRIVE_FRICTION, "friction_n_m", value)).transpose()?,
        stiffness: section.known_or_default(&registry::JOINT_STIFFNESS, "stiffness_n_m_per_rad", keys.stiffness_n_m_per_rad)?,
        damping_time: section.known_or_default(&registry::JOINT_DAMPING, "damping_time_ms", keys.damping_time_ms)?,
        backlash: section.known_or_default(&registry::JOINT_PLAY, "backlash_deg", keys.backlash_deg)?,
    })
}

#[rustfmt::skip] // A table: one key a line.
fn servo(section: &Section<'_>, keys: &file::ServoKeys) -> Result<ServoScenario, ScenarioError> {
    Ok(ServoScenario {
        natural_frequency: section.number("natural_frequency_hz", keys.natural_frequency_hz.unwrap_or(40.0), 1.0..=200.0)?,
        damping_ratio: section.number("damping_ratio", keys.damping_ratio.unwrap_or(1.0), 0.1..=10.0)?,
        integral_time: section.number("integral_time_s", keys.integral_time_s.unwrap_or(0.1), 0.001..=f64::INFINITY)?,
        contact_feed_forward: keys.contact_feed_forward.unwrap_or(true),
        lag_bandwidth: section.known_or_default(&registry::SERVO_BANDWIDTH, "lag_bandwidth_hz", keys.lag_bandwidth_hz)?,
        encoder_noise: section.number("encoder_noise_rad", keys.encoder_noise_rad.unwrap_or(0.0), 0.0..=0.01)?,
    })
}

/// Whether it is a rig file. Whatever is wrong with it is said when it is read as what it is.
pub(super) fn is_rig(path: &Path) -> Result<bool, ScenarioError> {
    let text = read_text(path)?;
    let document = Document::new(path, &text, file::SCHEMA)?;
    Ok(document.place("cylinder").position.is_some())
}

/// The device of a scenario: its model with what the scenario overrides.
pub(super) fn device(
    section: &Section<'_>,
    keys: &file::DeviceKeys,
) -> Result<DeviceScenario, ScenarioError> {
    let overrides = Section::new(section.document(), "device.override");
    let model = section.file("model", &keys.model)?;
    if is_rig(&model)? {
        let found = format!("\"{}\", a rig file", keys.model.display());
        let expected = "a device model file; a scenario of kind = \"bench\" takes a rig file";
        return Err(section.refuse("model", found, expected.to_owned()));
    }
    let ideal = keys.ideal.unwrap_or(false);
    let mut device = load_with_overrides(&model, Some((overrides, &keys.overrides)), ideal)?;
    device.locked = keys.locked.unwrap_or(false);
    Ok(device)
}

#[rustfmt::skip] // A table: one key a line.
pub(super) fn contact(section: &Section<'_>, keys: &file::ContactKeys, ideal: bool) -> Result<ContactScenario, ScenarioError> {
    Ok(ContactScenario {
        stiffness: section.known_or(&registry::CONTACT_STIFFNESS, "stiffness_n_per_m", keys.stiffness_n_per_m, registry::CONTACT_STIFFNESS.default_of(ideal))?,
        damping: section.known_or(&registry::CONTACT_DAMPING, "damping_n_s_per_m", keys.damping_n_s_per_m, registry::CONTACT_DAMPING.default_of(ideal))?,
        friction: section.known_or_default(&registry::EDGE_FRICTION, "friction_coefficient", keys.friction_coefficient)?,
        spindle_frequency: section.known_or_default(&registry::SPINDLE_FREQUENCY, "spindle_frequency_hz", keys.spindle_frequency_hz)?,
        runout_amplitude: section.number("runout_um", keys.runout_um.unwrap_or(0.0), 0.0..=1000.0)?,
        runout_frequency: section.known_or_default(&registry::RUNOUT_FREQUENCY, "runout_frequency_hz", keys.runout_frequency_hz.or(keys.spindle_frequency_hz.filter(|known| *known > 0.0)))?,
    })
}

/// A clamp that yields as much as the contact would not lock the device.
fn check_lock(
    section: &Section<'_>,
    keys: &file::ContactKeys,
    device: &DeviceScenario,
    contact: &ContactScenario,
) -> Result<(), ScenarioError> {
    const LEAST_RATIO: f64 = 10.0;
    let largest = device.parameters.lock_stiffness / LEAST_RATIO;
    if device.locked && contact.stiffness > largest {
        let value = keys.stiffness_n_per_m.unwrap_or(contact.stiffness);
        let expected = format!(
            "at most {largest} N/m, a tenth of the device's lock_stiffness_n_per_m, as the device is locked"
        );
        return Err(section.refuse_number("stiffness_n_per_m", value, expected));
    }
    Ok(())
}

#[rustfmt::skip] // A table: one key a line.
fn process(
    section: &Section<'_>,
    keys: &file::ProcessKeys,
    device: &DeviceScenario,
) -> Result<ProcessScenario, ScenarioError> {
    let corner_feed = keys.corner_feed_mm_per_s.unwrap_or(keys.feed_mm_per_s / 2.0);
    let process = ProcessScenario {
        force: section.number("force_n", keys.force_n, 0.1..=5000.0)?,
        feed: section.number("feed_mm_per_s", keys.feed_mm_per_s, 0.1..=1000.0)?,
        corner_feed: section.number("corner_feed_mm_per_s", corner_feed, 0.05..=1000.0)?,
        acceleration: section.number("acceleration_mm_per_s2", keys.acceleration_mm_per_s2.unwrap_or(500.0), 1.0..=20_000.0)?,
        lateral_acceleration: section.number("lateral_acceleration_mm_per_s2", keys.lateral_acceleration_mm_per_s2.unwrap_or(f64::INFINITY), 1.0..=f64::INFINITY)?,
        jerk: section.number("jerk_mm_per_s3", keys.jerk_mm_per_s3.unwrap_or(5000.0), 10.0..=1_000_000.0)?,
        working_stroke: working_stroke(section, keys, device.parameters.full_stroke)?,
        lean: section.number("lean_deg", keys.lean_deg.unwrap_or(0.0), -60.0..=60.0)?,
        feed_follows: feed_follows(section, keys)?,
        tool_axis: tool_axis(section, keys)?,
        roll: keys.roll_deg.map(|roll| section.number("roll_deg", roll, -360.0..=360.0)).transpose()?,
        approach_distance: section.number("approach_distance_mm", keys.approach_distance_mm.unwrap_or(50.0), 1.0..=1000.0)?,
        approach_speed: section.number("approach_speed_mm_per_s", keys.approach_speed_mm_per_s.unwrap_or(100.0), 1.0..=2000.0)?,
        engage_speed: section.number("engage_speed_mm_per_s", keys.engage_speed_mm_per_s.unwrap_or(20.0), 0.1..=200.0)?,
        settle_time: section.number("settle_time_s", keys.settle_time_s.unwrap_or(1.0), 0.0..=60.0)?,
    };
    if process.corner_feed > process.feed {
        let expected = format!("at most feed_mm_per_s, {} mm/s", keys.feed_mm_per_s);
        return Err(section.refuse_number("corner_feed_mm_per_s", corner_feed, expected));
    }
    Ok(process)
}

/// The passes in their order.
fn passes(
    document: &Document<'_>,
    file: &ScenarioFile,
) -> Result<Vec<PassScenario>, ScenarioError> {
    let section = Section::new(document, "process");
    if file.pass.is_empty() {
        let count = file.process.passes.unwrap_or(1);
        return Ok(vec![
            PassScenario::default();
            section.count("passes", count, 1..=100)?
        ]);
    }
    if file.process.passes.is_some() {
        let reason = "there are [[pass]] tables, which are as many as there are passes";
        return Err(section.misplaced("passes", reason.to_owned()));
    }
    let pass = |(index, keys): (usize, &file::PassKeys)| {
        let section = Section::new(document, format!("pass[{index}]"));
        let force = |value| section.number("force_n", value, 0.1..=5000.0);
        let feed = |value| section.number("feed_mm_per_s", value, 0.1..=1000.0);
        Ok(PassScenario {
            force: keys.force_n.map(force).transpose()?,
            feed: keys.feed_mm_per_s.map(feed).transpose()?,
            expect: expectations(
                &Section::new(document, format!("pass[{index}].expect")),
                &keys.expect,
            )?,
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

/// Feed that is lowered by what is measured.
fn feed_follows(
    section: &Section<'_>,
    keys: &file::ProcessKeys,
) -> Result<Option<FeedFollows>, ScenarioError> {
    let Some(keys) = &keys.feed_follows else {
        return Ok(None);
    };
    let section = Section::new(section.document(), "process.feed_follows");
    let (by, limit) = match (keys.force_n, keys.power_w) {
        (Some(force), None) => (
            FeedMeasure::Force,
            section.number("force_n", force, 0.01..=5000.0)?,
        ),
        (None, Some(power)) => (
            FeedMeasure::Power,
            section.number("power_w", power, 0.01..=100_000.0)?,
        ),
        (None, None) => return Err(section.missing("force_n", "it or power_w to be given")),
        (Some(_), Some(_)) => {
            let reason = "`process.feed_follows.force_n` is given too, expected one of the two";
            return Err(section.misplaced("power_w", reason.to_owned()));
        }
    };
    let (share, time) = (keys.least_share, keys.time_constant_s);
    Ok(Some(FeedFollows {
        by,
        limit,
        least_share: section.number("least_share", share.unwrap_or(0.2), 0.01..=1.0)?,
        time_constant: section.number("time_constant_s", time.unwrap_or(0.1), 0.001..=10.0)?,
    }))
}

/// The direction that is given in place of a lean.
fn tool_axis(
    section: &Section<'_>,
    keys: &file::ProcessKeys,
) -> Result<Option<DVec3>, ScenarioError> {
    let Some(axis) = &keys.tool_axis else {
        return Ok(None);
    };
    if keys.lean_deg.is_some() {
        let reason = "`process.lean_deg` is given too, expected one of the two".to_owned();
        return Err(section.misplaced("tool_axis", reason));
    }
    let direction = match axis {
        file::ToolAxisKeys::Word(file::ToolAxisWord::Down) => DVec3::NEG_Z,
        file::ToolAxisKeys::Direction(numbers) => {
            section.vector("tool_axis", Some(numbers), DVec3::NEG_Z, -1e6..=1e6)?
        }
    };
    let expected = || "a direction in the world from the flange to the part, as [0, 0, -1]".into();
    match direction.try_normalize() {
        Some(direction) => Ok(Some(direction)),
        None => Err(section.refuse("tool_axis", "[0, 0, 0]".to_owned(), expected())),
    }
}

/// Half the full stroke unless given; strictly between the end stops.
fn working_stroke(
    section: &Section<'_>,
    keys: &file::ProcessKeys,
    full_stroke: f64,
) -> Result<f64, ScenarioError> {
    let Some(value) = keys.working_stroke_mm else {
        return Ok(full_stroke / 2.0);
    };
    let stroke = section.number("working_stroke_mm", value, 0.1..=500.0)?;
    if stroke >= full_stroke {
        let expected = format!("less than the device's stroke_mm, {} mm", full_stroke * 1e3);
        return Err(section.refuse_number("working_stroke_mm", value, expected));
    }
    Ok(stroke)
}

fn simulation(
    section: &Section<'_>,
    keys: &file::SimulationKeys,
) -> Result<SimulationScenario, ScenarioError> {
    const STANDARD_GRAVITY: DVec3 = DVec3::new(0.0, 0.0, -9.81);
    let substeps = keys.device_substeps.unwrap_or(2);
    let gravity = keys.gravity_m_per_s2.as_deref();
    Ok(SimulationScenario {
        step: section.number("step_ms", keys.step_ms.unwrap_or(1.0), 0.01..=10.0)?,
        substeps: section.count("device_substeps", substeps, 1..=1000)?,
        gravity: section.vector("gravity_m_per_s2", gravity, STANDARD_GRAVITY, -30.0..=30.0)?,
        seed: keys.seed.unwrap_or(1),
    })
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
