//! A robot cell explained: one that is simulated, or one of which there are recordings.

use std::path::Path;

use super::super::error::AppError;
use super::super::picture::{across_the_edge, in_the_middle};
use super::report::{Report, shown};
use crate::cell::{Cell, EstimatedArm, FlangeLoad};
use crate::metrics;
use crate::path::Pass;
use crate::quantity::significant;
use crate::removal::ToolShape;
use crate::replay::LoadedCell;
use crate::run::RunError;
use crate::scenario::{
    ArmScenario, BurrScenario, Scenario, WorkpieceScenario, keys_given, load_recorded_cell,
};
use crate::shell::word;
use crate::workpiece::EdgeCurve;

/// Bytes of a sample in recording.rrd and samples.parquet together, and what each axis of the arm adds, from runs of the shipped scenarios.
const BYTES: f64 = 280.0;
const BYTES_PER_AXIS: f64 = 45.0;

/// The table of a scenario's own numbers of the device.
pub(super) const OVERRIDES: &str = "device.override";

/// A cell that can be run.
pub(super) fn cell(scenario: Scenario, overridden: &[String]) -> Result<Report, AppError> {
    let file = scenario.path.clone();
    let known = metrics::validate_cell(&scenario.expect, &scenario.expect_of_passes());
    known.map_err(RunError::metrics(&file))?;
    let cell = Cell::new(scenario)?;
    let scenario = &cell.setup.scenario;
    let mut report = Report::new(&file, "a robot cell to simulate", Some(&scenario.title));
    arm(&mut report, &scenario.arm, cell.setup.arm.chain.len());
    estimated(&mut report, cell.estimated.as_ref())?;
    report.device(&scenario.nominal.device);
    flange(&mut report, &FlangeLoad::of(scenario, &cell.setup.arm));
    overrides(&mut report, overridden);
    if scenario.device.locked {
        report.fact("", "its slide is clamped (device.locked)");
    }
    part(&mut report, &scenario.workpiece, &cell.setup.part.edge);
    let process = &scenario.process;
    job(&mut report, &cell);
    tool(&mut report, &cell);
    grinding(&mut report, &cell);
    report.drawing = Some(across_the_edge(&cell));
    report.number("force_n", process.force);
    report.number("feed_mm_per_s", process.feed * 1e3);
    report.number("edge_length_mm", cell.setup.part.edge.length * 1e3);
    let phases = cell.plan.phases();
    let phases = phases
        .iter()
        .map(|(phase, from, to)| format!("{} {:.1} s", phase.name(), to - from));
    report.fact("phases", phases.collect::<Vec<_>>().join(", "));
    let axes = cell.setup.arm.chain.len() as f64;
    let bytes = BYTES + BYTES_PER_AXIS * axes;
    let (duration, step) = (cell.plan.duration(), scenario.simulation.step);
    report.extent(duration, step, (duration / step).ceil(), bytes);
    report.bounds(&scenario.expect);
    files(&mut report, &scenario.arm, &scenario.workpiece);
    for note in &cell.setup.notes {
        report.note(note.as_str());
    }
    report.next(format!("idc run {}", word(&file)));
    Ok(report)
}

/// Force and feed of each pass along the edge.
fn job(report: &mut Report, cell: &Cell) {
    let stroke = shown(cell.setup.scenario.process.working_stroke * 1e3);
    let pass_text =
        |pass: &Pass| format!("{} N at {} mm/s", shown(pass.force), shown(pass.feed * 1e3));
    let count = cell.setup.passes.len();
    for (index, pass) in cell.setup.passes.iter().enumerate() {
        let pass_text = pass_text(pass);
        match (count, index) {
            (1, _) => report.fact("job", format!("{pass_text}, working stroke {stroke} mm")),
            (_, 0) => {
                report.fact("job", format!("{count} passes, working stroke {stroke} mm"));
                report.fact("", format!("pass 1: {pass_text}"));
            }
            _ => report.fact("", format!("pass {}: {pass_text}", index + 1)),
        }
    }
    report.number("passes", count);
}

/// The tool that turns, what each pass takes off by its law, and what the edge should be like.
fn grinding(report: &mut Report, cell: &Cell) {
    let scenario = &cell.setup.scenario;
    let Some(turning) = &scenario.tool else {
        return;
    };
    let reference = in_the_middle(cell);
    let tool = &turning.tool;
    let millimetres = |metres: f64| format!("{} mm", shown(metres * 1e3));
    let shape = match tool.shape {
        ToolShape::Ball { radius } => format!("ball of {} radius", millimetres(radius)),
        ToolShape::Cone { half_angle, .. } => {
            format!("cone of {} deg", shown((2.0 * half_angle).to_degrees()))
        }
        ToolShape::Belt { wheel_radius } => {
            format!("belt over a wheel of {} radius", millimetres(wheel_radius))
        }
    };
    let spindle = tool.spindle_axis(reference.axis, reference.normal, reference.tangent);
    let radius = tool.contact_radius(spindle, reference.normal);
    let speed = turning.spindle.free_speed * radius;
    let lead = match tool.lead {
        0.0 => String::new(),
        lead => format!(", leading by {} deg", shown(lead.to_degrees())),
    };
    report.fact(
        "spindle",
        format!(
            "{shape} at {} rpm{lead}; cuts at {} from its axis, {}",
            shown(turning.spindle.free_speed * 30.0 / std::f64::consts::PI),
            format_args!("{} mm", significant(radius * 1e3, 3)),
            format_args!("{} m/s", significant(speed, 3))
        ),
    );
    if let Some(removal) = &scenario.removal {
        for (index, pass) in cell.setup.passes.iter().enumerate() {
            let (area, wear) = (removal.contact_area, removal.wear_at_start);
            let rate = removal.law.removal_rate(pass.force, speed, area, wear);
            let text = format!(
                "pass {}: {} mm3/s as the spindle runs free, a section of {} mm2",
                index + 1,
                significant(rate * 1e9, 3),
                significant(rate / pass.feed * 1e6, 3)
            );
            report.fact("removal", text);
        }
    }
    let chamfer = &scenario.workpiece.chamfer;
    let leg = match chamfer.leg {
        [low, high] if high.is_finite() => {
            format!("leg of {} to {}, ", shown(low * 1e3), millimetres(high))
        }
        [low, _] if low > 0.0 => format!("leg of at least {}, ", millimetres(low)),
        _ => String::new(),
    };
    let burr = millimetres(chamfer.residual_burr);
    report.fact("chamfer", format!("{leg}burr of at most {burr} left"));
}

/// How the tool stands to the edge, in words.
fn tool(report: &mut Report, cell: &Cell) {
    let reference = in_the_middle(cell);
    let angle = reference.axis.angle_between(-reference.normal).to_degrees();
    // Where the handle goes from the bisector: what of the way back along the axis is not along the normal.
    let aside = -reference.axis - reference.normal * reference.share;
    let lean = if angle < 0.05 {
        "along the edge's bisector".to_owned()
    } else {
        format!(
            "leaned {} deg from the edge's bisector, its handle {}",
            shown((angle * 10.0).round() / 10.0),
            towards(aside)
        )
    };
    let roll = (cell.plan.roll.to_degrees() * 10.0).round() / 10.0;
    let chosen = match cell.setup.scenario.process.roll {
        Some(_) => "",
        None => ", found by search",
    };
    let text = format!(
        "points {}, {lean}; flange turned by {} deg about it{chosen}",
        towards(reference.axis),
        shown(roll)
    );
    report.fact("tool", text);
    report.number("lean_deg", angle);
    report.number("roll_deg", roll);
    let margin = cell.setup.scenario.collision.margin;
    let names: Vec<&str> = cell.setup.collision.names().collect();
    let text = format!(
        "none of {} bodies along the whole motion, {} mm apart at least",
        names.len(),
        shown(margin * 1e3)
    );
    report.fact("collisions", text);
}

/// A direction of the world in words: the nearest of its axes, and how far off where it is more than a little.
fn towards(direction: glam::DVec3) -> String {
    use glam::DVec3;
    let axes = [
        (DVec3::Z, "up"),
        (-DVec3::Z, "down"),
        (DVec3::X, "towards +x"),
        (-DVec3::X, "towards -x"),
        (DVec3::Y, "towards +y"),
        (-DVec3::Y, "towards -y"),
    ];
    let Some(direction) = direction.try_normalize() else {
        return "nowhere".to_owned();
    };
    let mut along: Vec<(f64, &str)> = axes
        .iter()
        .map(|(axis, word)| (axis.dot(direction), *word))
        .filter(|(share, _)| *share > 0.25)
        .collect();
    along.sort_by(|a, b| b.0.total_cmp(&a.0));
    let words: Vec<&str> = along.iter().map(|(_, word)| *word).collect();
    words.join(" and ")
}

/// A cell of which there are recordings.
pub(super) fn recorded(file: &Path) -> Result<Report, AppError> {
    let loaded = LoadedCell::new(load_recorded_cell(file)?)?;
    let scenario = &loaded.scenario;
    let kind = "a robot cell of which there are recordings";
    let mut report = Report::new(file, kind, Some(&scenario.title));
    arm(&mut report, &scenario.arm, loaded.joints.len());
    report.device(&scenario.nominal.device);
    overrides(&mut report, &keys_given(file, OVERRIDES)?);
    report.fact(
        "servo",
        format!(
            "{} Hz, critically damped",
            shown(scenario.nominal.cell.servo_bandwidth)
        ),
    );
    for present in &scenario.effects {
        report.fact("nominal effect", present.effect.name);
    }
    files(&mut report, &scenario.arm, &scenario.workpiece);
    report.next(format!(
        "idc diagnose RECORDINGS --all --scenario {} --out DIR",
        word(file)
    ));
    Ok(report)
}

/// What the arm carries on its flange.
fn flange(report: &mut Report, load: &FlangeLoad) {
    let may = match &load.payload {
        Some((payload, origin)) => {
            format!("of {} kg that it may carry ({origin})", shown(*payload))
        }
        None => "what the arm may carry is not known (arm.payload_kg)".to_owned(),
    };
    let text = format!(
        "carries {} kg, housing {} and slide with tool {}; {may}; contact force at most {} N",
        shown(load.mass()),
        shown(load.housing),
        shown(load.moving),
        shown(load.force)
    );
    report.fact("flange", text);
    report.number("flange_load_kg", load.mass());
    report.number(
        "payload_kg",
        load.payload.as_ref().map(|(payload, _)| *payload),
    );
}

fn arm(report: &mut Report, arm: &ArmScenario, axes: usize) {
    let name = arm.urdf.file_stem().unwrap_or_default().display();
    let text = format!(
        "{name}, {axes} axes, device on its link `{}`",
        arm.flange_link
    );
    report.fact("arm", text);
    report.number("axes", axes);
}

/// Masses that are estimated, and the torques with what that leaves open of them.
fn estimated(report: &mut Report, arm: Option<&EstimatedArm>) -> Result<(), AppError> {
    let Some(arm) = arm else {
        return Ok(());
    };
    let total: f64 = arm.links.iter().map(|link| link.mass_kg).sum();
    let names: Vec<&str> = arm.links.iter().map(|link| link.link.as_str()).collect();
    let text = format!(
        "estimated from shapes, {} kg of {}: each within {} % taken",
        significant(total, 2),
        names.join(", "),
        shown(arm.mass_spread_percent)
    );
    report.fact("masses", text);
    for joint in &arm.joints {
        let [least, greatest, limit] = [joint.least_n_m, joint.greatest_n_m, joint.limit_n_m]
            .map(|torque| significant(torque, 2));
        let text = format!(
            "{}: {least} to {greatest} of {limit} N m at most",
            joint.joint
        );
        report.fact("torques", text);
    }
    report.number("estimated_masses", serde_json::to_value(arm)?);
    Ok(())
}

/// Changes of the scenario to the device's model.
pub(super) fn overrides(report: &mut Report, keys: &[String]) {
    if !keys.is_empty() {
        report.fact("", format!("changed by the scenario: {}", keys.join(", ")));
    }
}

fn part(report: &mut Report, workpiece: &WorkpieceScenario, edge: &EdgeCurve) {
    let name = workpiece.mesh.file_stem().unwrap_or_default().display();
    let closed = if edge.closed { ", closed" } else { "" };
    let length = shown((edge.length * 1e6).round() / 1e3);
    report.fact("part", format!("{name}, {}: {length} mm{closed}", edge.id));
    let wrong = &workpiece.misplacement;
    if wrong.shift != 0.0 || wrong.tilt != 0.0 {
        let text = format!(
            "really {} mm off towards the tool, tilted by {} deg",
            shown(wrong.shift * 1e3),
            shown(wrong.tilt.to_degrees())
        );
        report.fact("", text);
    }
    let burr = match &workpiece.burr {
        BurrScenario::None => return,
        BurrScenario::Constant { height } => format!("{} mm everywhere", shown(height * 1e3)),
        BurrScenario::Random { mean_height, .. } => {
            format!("random, {} mm on average", shown(mean_height * 1e3))
        }
        BurrScenario::Bump { height, .. } => format!("one bump of {} mm", shown(height * 1e3)),
        BurrScenario::Table { path } => format!("heights from {}", path.display()),
    };
    report.fact("burr", burr);
}

fn files(report: &mut Report, arm: &ArmScenario, workpiece: &WorkpieceScenario) {
    report.file("arm", &arm.urdf);
    for (name, folder) in &arm.package_directories {
        report.file(format!("package {name}"), folder);
    }
    report.file("part", &workpiece.mesh);
    if let BurrScenario::Table { path } = &workpiece.burr {
        report.file("burr", path);
    }
}
