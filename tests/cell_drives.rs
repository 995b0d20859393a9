//! `idc diagnose --scenario` of a cell with an arm file: drives' torques and a raw wrench by equations of this file, beside device, part and contact. What is
//! planted in them is named, of either side, and where nothing is planted nothing is.

use std::fmt::Write as _;
use std::path::Path;

use glam::{DQuat, DVec3};
use glamx::DPose3;
use idc_cell::arm::dynamics::inverse_dynamics;
use idc_cell::arm::kinematics::tip_pose;
use idc_cell::diagnosis::answer::Answer;
use idc_cell::plant::{PlantInputs, PlantParameters, follow, simulate};
use idc_cell::replay::LoadedCell;
use idc_cell::scenario::load_recorded_cell;
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rand_distr::StandardNormal;

use crate::program::Bench;
use crate::recorded_cell::{CELL, Commands, PROGRAMS, Program, inputs, record};

/// Mass of the housing and distance of its centre from the flange.
const HOUSING: (f64, f64) = (2.5, 0.06);
/// Height of the sensor over the flange, and its turn about z.
const SENSOR: (f64, f64) = (0.02, 0.6);
const COULOMB: [f64; 6] = [9.0, 9.0, 6.0, 2.0, 2.0, 1.5];
const VISCOUS: [f64; 6] = [8.0, 8.0, 6.0, 2.0, 2.0, 1.5];
const ROTOR: [f64; 6] = [2.0, 2.0, 1.0, 0.2, 0.2, 0.1];
/// Noise of torques, of the sensor's forces and moments.
const NOISE: [f64; 3] = [0.15, 0.15, 0.008];

/// What is planted in drives and sensor.
#[derive(Clone, Copy, Default)]
struct Planted {
    /// Dry friction of joint 2 beyond what is nominal.
    friction: f64,
    /// Zero of the sensor.
    zero: [f64; 6],
}

fn arm_file(cell: &LoadedCell) -> String {
    let moving = (
        cell.scenario.nominal.device.moving_mass,
        cell.scenario.nominal.mounting.moving_centre_of_mass,
    );
    let mass = HOUSING.0 + moving.0;
    let centre = (HOUSING.0 * HOUSING.1 + moving.0 * moving.1) / mass;
    // Of two compact bodies on one axis.
    let apart = HOUSING.0 * moving.0 / mass * (HOUSING.1 - moving.1).powi(2);
    let urdf = cell.scenario.arm.urdf.file_name().unwrap().display();
    let mut text = format!(
        "kind = \"recorded_arm\"\nschema = 1\n\n[arm]\nurdf = \"{urdf}\"\nflange = \"flange\"\ngravity_m_per_s2 = [0, 0, -9.81]\n"
    );
    for (joint, name) in cell.joints.iter().enumerate() {
        let _ = write!(
            text,
            "\n[[drive]]\njoint = \"{name}\"\nmotor_inertia_kg_m2 = {{ value = {}, tolerance = 0.1 }}\ncoulomb_friction_n_m = {{ value = {}, tolerance = 0.1 }}\nviscous_friction_n_m_s_per_rad = {{ value = {}, tolerance = 0.1 }}\n",
            ROTOR[joint], COULOMB[joint], VISCOUS[joint]
        );
    }
    let _ = write!(
        text,
        "\n[wrench_sensor]\nheight_m = {}\nrotation_z_rad = {}\nzero_force_n = {{ value = [0, 0, 0], tolerance_n = 0.3 }}\nzero_torque_n_m = {{ value = [0, 0, 0], tolerance_n_m = 0.02 }}\ntool_mass_kg = {mass}\ntool_centre_m = [0, 0, {}]\ntool_inertia_kg_m2 = [{apart}, {apart}, 0]\n\n[sensors]\nrate_hz = 250\njoint_rad = 2e-6\ntorque_n_m = {:?}\nwrench_force_n = {}\nwrench_torque_n_m = {}\n",
        SENSOR.0,
        SENSOR.1,
        centre - SENSOR.0,
        [NOISE[0]; 6],
        NOISE[1],
        NOISE[2]
    );
    text
}

/// Bodies beyond the sensor and forces on them, at an instant.
struct Beyond {
    /// Mass and place in the world.
    bodies: [(f64, DVec3); 2],
    /// Force of the part on the tool, and where.
    contact: (DVec3, DVec3),
    flange: DPose3,
}

/// The flange, what hangs on it and what touches it, at every sample.
fn beyond(
    cell: &LoadedCell,
    plant: &PlantParameters,
    inputs: &PlantInputs,
    q: &[Vec<f64>],
) -> Vec<Beyond> {
    let truth = simulate(plant, inputs).truth;
    let trajectory = inputs.cell.as_ref().unwrap();
    let mounting = &cell.scenario.nominal.mounting;
    let place = |i: usize, along: f64, flange: &DPose3| {
        let _ = i;
        flange.transform_point(DVec3::Z * along)
    };
    (0..inputs.time.len())
        .map(|i| {
            let own: Vec<f64> = q.iter().map(|q| q[i]).collect();
            let flange = tip_pose(&cell.chain, cell.scenario.arm.world_from_base, &own);
            let stroke = truth.stroke[i];
            let ball = place(i, mounting.tool_centre + stroke, &flange);
            let edge = &trajectory.edge[i];
            let before = trajectory.edge[i.saturating_sub(1)].station;
            let after = trajectory.edge[(i + 1).min(inputs.time.len() - 1)].station;
            let along = if after > before { 1.0 } else { 0.0 };
            let force = edge.bisector - edge.tangent * (plant.cell.friction * along);
            Beyond {
                bodies: [
                    (HOUSING.0, place(i, HOUSING.1, &flange)),
                    (
                        plant.device.moving_mass,
                        place(i, mounting.moving_centre_of_mass + stroke, &flange),
                    ),
                ],
                contact: (
                    force * truth.contact_force[i],
                    ball - edge.bisector * mounting.tool_radius,
                ),
                flange,
            }
        })
        .collect()
}

/// Second derivative of samples.
fn second(values: [DVec3; 5], step: f64) -> DVec3 {
    let [a, b, c, d, e] = values;
    (-a + 16.0 * b - 30.0 * c + 16.0 * d - e) / (12.0 * step * step)
}

/// Forces on the tool and where they act, with what its own motion takes: Newton's law for each body, its acceleration by differences in the world.
fn forces(all: &[Beyond], i: usize, step: f64) -> [(DVec3, DVec3); 3] {
    let near =
        |k: usize, body: usize| all[(i + k).saturating_sub(2).min(all.len() - 1)].bodies[body].1;
    let of = |body: usize| {
        let (mass, place) = all[i].bodies[body];
        let acceleration = second([0, 1, 2, 3, 4].map(|k| near(k, body)), step);
        (mass * (DVec3::NEG_Z * 9.81 - acceleration), place)
    };
    [of(0), of(1), all[i].contact]
}

/// Torques of the drives: the links by Newton and Euler, what hangs on the flange by virtual work.
fn torques(
    cell: &LoadedCell,
    q: &[Vec<f64>],
    i: usize,
    step: f64,
    forces: &[(DVec3, DVec3)],
    planted: Planted,
) -> Vec<f64> {
    let chain = {
        let mut bare = cell.chain.clone();
        // The loaded cell's chain holds the housing; here it hangs on the flange.
        bare.joints.clone_from(
            &idc_cell::arm::load_arm(
                &cell.scenario.arm.urdf,
                &idc_cell::cell::arm_options(&cell.scenario.arm),
            )
            .unwrap()
            .chain
            .joints,
        );
        bare
    };
    let at = |k: isize| -> Vec<f64> {
        let place = (i as isize + k).clamp(0, q[0].len() as isize - 1) as usize;
        q.iter().map(|q| q[place]).collect()
    };
    let (own, before, after) = (at(0), at(-1), at(1));
    let rates: Vec<f64> = (0..6)
        .map(|j| (after[j] - before[j]) / (2.0 * step))
        .collect();
    let bends: Vec<f64> = (0..6)
        .map(|j| (after[j] - 2.0 * own[j] + before[j]) / (step * step))
        .collect();
    let base = cell.scenario.arm.world_from_base;
    let mut out = vec![0.0; 6];
    inverse_dynamics(
        &chain,
        base.rotation,
        DVec3::NEG_Z * 9.81,
        &own,
        &rates,
        &bends,
        &mut out,
    );
    let here = tip_pose(&chain, base, &own);
    for (j, torque) in out.iter_mut().enumerate() {
        let mut moved = own.clone();
        moved[j] += 1e-6;
        let there = tip_pose(&chain, base, &moved);
        for (force, point) in forces {
            let fixed = here.inverse().transform_point(*point);
            *torque -= force.dot(there.transform_point(fixed) - *point) / 1e-6;
        }
        let coulomb = COULOMB[j] + if j == 1 { planted.friction } else { 0.0 };
        *torque += ROTOR[j] * bends[j] + coulomb * (rates[j] / 1e-3).tanh() + VISCOUS[j] * rates[j];
    }
    out
}

/// Adds drives and wrench to a recording.
fn with_drives(
    cell: &LoadedCell,
    plant: &PlantParameters,
    program: &Program,
    planted: Planted,
    folder: &Path,
) {
    let (made, inputs): (Commands, PlantInputs) = inputs(cell, plant, program);
    let bandwidth = plant.cell.servo_bandwidth;
    let q: Vec<Vec<f64>> = (made.joints.iter())
        .map(|joint| follow(&made.time, joint, bandwidth).angle)
        .collect();
    let all = beyond(cell, plant, &inputs, &q);
    let step = made.time[1] - made.time[0];
    let mut random =
        ChaCha8Rng::seed_from_u64(41 + program.name.len() as u64 + made.time.len() as u64);
    let mut noisy =
        |value: f64, noise: f64| value + noise * random.sample::<f64, _>(StandardNormal);
    let path = folder.join(format!("{}.csv", program.name));
    let text = std::fs::read_to_string(&path).unwrap();
    let mut out = String::new();
    for (line, i) in text.lines().zip(0..) {
        out += line;
        if i == 0 {
            (1..=6).for_each(|j| out += &format!(",joint_{j}_torque_n_m"));
            out += ",wrench_force_x_n,wrench_force_y_n,wrench_force_z_n,wrench_torque_x_n_m,wrench_torque_y_n_m,wrench_torque_z_n_m\n";
            continue;
        }
        let i = i - 1;
        let forces = forces(&all, i, step);
        for torque in torques(cell, &q, i, step, &forces, planted) {
            let _ = write!(out, ",{}", noisy(torque, NOISE[0]));
        }
        let flange = &all[i].flange;
        let origin = flange.transform_point(DVec3::Z * SENSOR.0);
        let force: DVec3 = forces.iter().map(|(force, _)| *force).sum();
        let moment: DVec3 = forces
            .iter()
            .map(|(force, point)| (*point - origin).cross(*force))
            .sum();
        let turned = DQuat::from_rotation_z(-SENSOR.1) * flange.rotation.inverse();
        let (force, moment) = (turned * force, turned * moment);
        for (k, value) in force
            .to_array()
            .into_iter()
            .chain(moment.to_array())
            .enumerate()
        {
            let noise = NOISE[if k < 3 { 1 } else { 2 }];
            let _ = write!(out, ",{}", noisy(value + planted.zero[k], noise));
        }
        out.push('\n');
    }
    std::fs::write(path, out).unwrap();
}

/// Effects by name and joint of a case that is planted so.
fn found(planted: Planted, plant: impl Fn(&mut PlantParameters)) -> (Vec<String>, Answer, Bench) {
    let bench = Bench::new("plate_edge_ideal");
    bench.write("cell.toml", CELL);
    let cell = LoadedCell::new(load_recorded_cell(&bench.path("cell.toml")).unwrap()).unwrap();
    bench.write("drives.toml", arm_file(&cell));
    bench.replace(
        "cell.toml",
        "flange_link = \"flange\"",
        "flange_link = \"flange\"\nrecorded_arm = \"drives.toml\"",
    );
    let mut parameters = cell.plant();
    plant(&mut parameters);
    let folder = bench.path("case");
    for program in &PROGRAMS {
        record(&cell, &parameters, program, &folder);
        if program.name != "c" {
            with_drives(&cell, &parameters, program, planted, &folder);
        }
    }
    let outcome = bench.idc(
        &[
            "diagnose",
            "case",
            "--scenario",
            "cell.toml",
            "--out",
            "out",
            "--quiet",
        ],
        &[],
    );
    assert_eq!(outcome.code, 0, "{}", outcome.err);
    let text = std::fs::read_to_string(bench.path("out/diagnosis.json")).unwrap();
    let answer: Answer = serde_json::from_str(&text).unwrap();
    let names = answer.effects.iter();
    let names = names
        .map(|e| format!("{}{}", e.name, e.parameters.place_words()))
        .collect();
    (names, answer, bench)
}

#[test]
fn a_cell_whose_drives_and_sensor_are_as_described_lacks_nothing() {
    let (names, answer, bench) = found(Planted::default(), |_| {});
    assert_eq!(names, [""; 0], "{:?}", answer.effects);
    // It predicts what the drives and the sensor will read as well.
    let prediction = std::fs::read_to_string(bench.path("out/prediction.csv")).unwrap();
    let header = prediction.lines().next().unwrap();
    assert!(
        header.contains("joint_6_torque_n_m") && header.contains("wrench_force_z_n"),
        "{header}"
    );
    let fields = |line: &str| line.split(',').count();
    assert!(
        prediction
            .lines()
            .all(|line| fields(line) == fields(header))
    );
}

#[test]
fn a_part_that_is_misplaced_and_friction_of_a_drive_are_both_named() {
    let planted = Planted {
        friction: 7.0,
        ..Planted::default()
    };
    let (names, answer, bench) = found(planted, |p| p.cell.part_shift = 8e-4);
    assert_eq!(names, ["part_misplaced", "joint_friction (joint 2)"]);
    let dry = answer.effects[1]
        .parameters
        .iter()
        .find(|(key, _)| key == "coulomb_n_m")
        .unwrap()
        .1;
    assert!(
        (dry.value - COULOMB[1] - planted.friction).abs() < 1.0,
        "{dry:?}"
    );
    // What either side says is in the account: of two parts of one kind the second was lost.
    let account = std::fs::read_to_string(bench.path("out/account.txt")).unwrap();
    for said in [
        "Of device, part and contact:",
        "Of the arm, its load and its sensor:",
    ] {
        assert!(account.contains(said), "{said}: {account}");
    }
    // What is written is a cell again, with the arm beside it.
    let improved = load_recorded_cell(&bench.path("out/improved.toml")).unwrap();
    let arm = improved.arm.recorded_arm.unwrap();
    assert!((arm.nominal.drives[1].coulomb - dry.value).abs() < 1e-6);
}

#[test]
fn the_zero_of_the_raw_wrench_is_named() {
    let zero = [3.0, -2.0, 4.0, 0.2, -0.15, 0.1];
    let (names, answer, _) = found(
        Planted {
            zero,
            friction: 0.0,
        },
        |_| {},
    );
    assert_eq!(names, ["wrench_zero"]);
    for ((_, number), planted) in answer.effects[0].parameters.iter().zip(zero) {
        assert!(
            (number.value - planted).abs() < 0.05 * planted.abs().max(1.0),
            "{number:?} {planted}"
        );
    }
}
