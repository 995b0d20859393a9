//! Drives and wrench sensor of a simulated cell's arm: what they read follows from what the simulation does, and an effect in them is found again.

use glam::DVec3;
use idc_cell::recording::schema::{
    self, DriveReading, JointSignal, drive_quantity, joint_quantity, wrench_quantity,
};
use idc_cell::scenario::arm_file::load_arm_file;

use crate::common::{project, run, scenario};
use crate::program::Bench;

/// An arm file whose drives log torques and lose as much as the URDF's joints by damping and friction, almost without noise.
fn losses_of_urdf() -> String {
    let text = std::fs::read_to_string(project("models/arm/arm10.toml")).unwrap();
    let urdf = project("models/arm/arm10.urdf").display().to_string();
    let mut out = String::new();
    let mut friction = ["1.0", "1.0", "0.5", "0.2", "0.2", "0.2"].iter();
    let mut damping = ["1.0", "1.0", "0.5", "0.1", "0.1", "0.1"].iter();
    for line in text.lines() {
        let key = line.split(' ').next().unwrap_or_default();
        out += &match key {
            "gain_n_m_per_a" | "motor_inertia_kg_m2" => continue,
            "coulomb_friction_n_m" => format!("{key} = {}", friction.next().unwrap()),
            "viscous_friction_n_m_s_per_rad" => format!("{key} = {}", damping.next().unwrap()),
            "current_a" => "torque_n_m = [1e-9, 1e-9, 1e-9, 1e-9, 1e-9, 1e-9]".to_owned(),
            "wrench_force_n" | "wrench_torque_n_m" => format!("{key} = 1e-9"),
            "urdf" => format!("urdf = {urdf:?}"),
            _ => line.to_owned(),
        };
        out.push('\n');
    }
    out
}

#[test]
fn drives_that_lose_as_the_urdf_read_the_torques_of_the_servos_and_the_wrench_is_weight_and_contact()
 {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("arm.toml");
    std::fs::write(&file, losses_of_urdf()).unwrap();
    let mut cell = scenario("drives_and_wrench");
    cell.arm.recorded_arm = Some(Box::new(load_arm_file(&file).unwrap()));
    let finished = run(cell);
    let recording = &finished.recording;
    let values = |quantity: &str| recording.values(quantity).unwrap();
    let follow = recording.phase("follow").unwrap();
    let [from, to] =
        [follow.start, follow.end].map(|t| recording.time().partition_point(|time| *time < t));
    let (from, to) = (from + 200, to - 200);
    for joint in 1..=6 {
        let servo = values(&joint_quantity(joint, JointSignal::Torque));
        let read = values(&drive_quantity(joint, DriveReading::Torque));
        let most = (from..to)
            .map(|i| (servo[i] - read[i]).abs())
            .fold(0.0, f64::max);
        let size = servo[from..to].iter().fold(0.0, |m: f64, t| m.max(t.abs()));
        assert!(most < 0.05 + 0.01 * size, "joint {joint}: {most} of {size}");
    }
    let three = |names: [String; 3], i: usize| DVec3::from(names.map(|name| values(&name)[i]));
    let contact = [
        schema::CONTACT_FORCE_X,
        schema::CONTACT_FORCE_Y,
        schema::CONTACT_FORCE_Z,
    ];
    for i in (from..to).step_by(100) {
        let forces = ["force_x", "force_y", "force_z"].map(wrench_quantity);
        let read = three(forces, i);
        let weight = DVec3::new(0.0, 0.0, -9.81 * 6.5);
        let expected = weight - three(contact.map(str::to_owned), i);
        let error = (read.length() - expected.length()).abs();
        assert!(error < 0.5, "{read} {expected}");
    }
}

/// Names of the effects that a diagnosis of a run with an effect, or without, finds.
fn found(bench: &Bench, effect: Option<&str>) -> Vec<String> {
    let mut run = vec![
        "run",
        "scenario.toml",
        "--out",
        "runs/a",
        "--force",
        "--no-recording",
    ];
    run.extend(effect.iter().flat_map(|effect| ["--with", *effect]));
    let done = bench.idc(&run, &[]);
    assert!(done.code <= 1, "{}\n{}", done.out, done.err);
    let arguments = [
        "diagnose",
        "runs",
        "--scenario",
        "scenario.toml",
        "--json",
        "--out",
        "found",
        "--force",
    ];
    let done = bench.idc(&arguments, &[]);
    assert_eq!(done.code, 0, "{}\n{}", done.out, done.err);
    let answer: serde_json::Value = serde_json::from_str(&done.out).unwrap();
    let effects = answer["effects"].as_array().unwrap().iter();
    effects
        .map(|effect| effect["name"].as_str().unwrap().to_owned())
        .collect()
}

fn bench() -> Bench {
    let bench = Bench::new("drives_and_wrench");
    let text = std::fs::read_to_string(project("models/arm/arm10.toml")).unwrap();
    bench.write("arm.toml", text.replace("arm10.urdf", "arm.urdf"));
    bench.replace("scenario.toml", "../models/arm/arm10.toml", "arm.toml");
    bench
}

#[test]
fn an_effect_of_the_wrench_sensor_and_one_of_a_drive_are_found_in_runs() {
    let bench = bench();
    for (asked, names) in [
        (None, &[][..]),
        (Some("wrench_zero"), &["wrench_zero"][..]),
        (
            Some("joint_torque_offset:joint=2"),
            &["joint_torque_offset"],
        ),
    ] {
        assert_eq!(found(&bench, asked), names, "{asked:?}");
    }
}

#[test]
fn every_effect_of_an_arm_file_goes_in_by_its_name() {
    let bench = bench();
    for effect in idc_cell::recorded_arm::vocabulary::ARM_EFFECTS {
        let template =
            idc_cell::scenario::ScenarioTemplate::read(&bench.path("scenario.toml")).unwrap();
        let request = idc_cell::scenario::EffectRequest::parse(effect.name).unwrap();
        let edits = idc_cell::run::apply_effects(&[request], &template).unwrap();
        let changed = template.with(&edits);
        assert!(changed.is_ok(), "{}: {:?}", effect.name, changed.err());
    }
}

#[test]
fn an_effect_of_drives_without_an_arm_file_is_refused_with_the_key_to_set() {
    let bench = Bench::new("plate_edge_ideal");
    let refused = bench.idc(&["run", "scenario.toml", "--with", "wrench_zero"], &[]);
    assert_eq!(refused.code, 2);
    let line = refused.only_line("error");
    for said in ["wrench_zero", "scenario.toml", "recorded_arm", "[arm]"] {
        assert!(line.contains(said), "{line}");
    }
}
