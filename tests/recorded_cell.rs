//! `idc diagnose --scenario`: a recorded cell's effects, planted in recordings made by the project's own plan and model, are found, named with their joint,
//! sized, and predicted with; where nothing is planted nothing is found.

use std::fmt::Write as _;
use std::path::Path;

use idc_cell::cell::Cell;
use idc_cell::diagnosis::answer::{Answer, Verdict};
use idc_cell::path::Phase;
use idc_cell::plant::{Burr, InitialState, PlantInputs, PlantParameters, follow, simulate};
use idc_cell::recording::schema;
use idc_cell::replay::LoadedCell;
use idc_cell::scenario::{Scenario, load, load_any, load_recorded_cell};
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rand_distr::StandardNormal;

use crate::common::{project, run, scenario, shared};
use crate::program::Bench;

pub const CELL: &str = r#"schema = 1
kind = "recorded_cell"
title = "A cell of which there are recordings"

[arm]
urdf = "arm.urdf"
flange_link = "flange"

[joints]
servo_bandwidth_hz = 25
stiffness_n_m_per_rad = [2e6, 2e6, 2e6, 2e5, 2e5, 2e4]

[device]
ideal = true
model = "device.toml"

[workpiece]
mesh = "part.stl"
mesh_unit = "mm"
position_mm = [750, 0, 200]
rotation_deg = [0, 0, -90]

[workpiece.edge]
edge = 1
start_mm = 100
end_mm = 200

[sensors]
joints_rad = 2e-6
regulator_pressure_pa = 400
stroke_um = 40
force_n = 0.8

[belief]
tolerance = 0
start_stroke_tolerance_mm = 0
"#;
/// Noise of encoders, outlet, stroke and force.
const NOISE: [f64; 4] = [2e-6, 400.0, 4e-5, 0.8];
/// Samples per second.
const RATE: f64 = 250.0;

/// One program: lean, feed, pressure.
pub struct Program {
    pub name: &'static str,
    lean: f64,
    feed: f64,
    pressure: f64,
}

pub const PROGRAMS: [Program; 3] = [
    Program {
        name: "a",
        lean: 0.0,
        feed: 0.04,
        pressure: 1.2e5,
    },
    Program {
        name: "b",
        lean: 0.22,
        feed: 0.06,
        pressure: 1.8e5,
    },
    Program {
        name: "c",
        lean: -0.12,
        feed: 0.05,
        pressure: 1.5e5,
    },
];

/// Times, places along the edge, angles of the joints, set pressures.
pub struct Commands {
    pub time: Vec<f64>,
    pub path: Vec<f64>,
    pub joints: Vec<Vec<f64>>,
    pub set_pressure: Vec<f64>,
}

/// The project's own job in a program.
fn job(mut nominal: Scenario, program: &Program) -> Scenario {
    nominal.workpiece.edge.start = 0.1;
    nominal.workpiece.edge.end = Some(0.2);
    nominal.process.lean = program.lean;
    nominal.process.feed = program.feed;
    nominal.process.corner_feed = program.feed;
    nominal.process.settle_time = 0.8;
    nominal
}

/// The project's own plan of a program.
fn commands(program: &Program) -> Commands {
    let cell = Cell::new(job(scenario("plate_edge_ideal"), program)).unwrap();
    let axes = cell.setup.arm.chain.len();
    let count = (cell.plan.duration() * RATE) as usize;
    let mut made = Commands {
        time: Vec::new(),
        path: Vec::new(),
        joints: vec![Vec::new(); axes],
        set_pressure: Vec::new(),
    };
    let engaged = cell.plan.phases();
    let follow = engaged
        .iter()
        .find(|(phase, ..)| *phase == Phase::Follow)
        .unwrap()
        .1;
    let retract = engaged
        .iter()
        .find(|(phase, ..)| *phase == Phase::Retract)
        .unwrap()
        .1;
    for i in 0..count {
        let t = i as f64 / RATE;
        let reference = cell.plan.reference(t);
        made.time.push(t);
        made.path.push(reference.edge_length);
        for (own, angle) in made.joints.iter_mut().zip(reference.position) {
            own.push(angle);
        }
        let on = t > follow - 0.6 && t < retract - 0.3;
        made.set_pressure
            .push(if on { program.pressure } else { 0.0 });
    }
    made
}

/// Commands of a program, and what they are to a cell with physics planted in it.
pub fn inputs(
    cell: &LoadedCell,
    plant: &PlantParameters,
    program: &Program,
) -> (Commands, PlantInputs) {
    let made = commands(program);
    let inputs = carried_out(cell, plant, &made);
    (made, inputs)
}

/// What commands are to a cell with physics planted in it.
pub fn carried_out(cell: &LoadedCell, plant: &PlantParameters, made: &Commands) -> PlantInputs {
    let bandwidth = plant.cell.servo_bandwidth;
    let trajectory = cell.trajectory(&made.time, &made.path, &made.joints, bandwidth);
    PlantInputs {
        time: made.time.clone(),
        set_pressure: made.set_pressure.clone(),
        extends: vec![true; made.time.len()],
        surface: trajectory.contact_kinematics(&plant.cell).surface(),
        cell: Some(std::sync::Arc::new(trajectory)),
        motion: None,
        initial: InitialState::AtRest,
        place: 0,
    }
}

/// Records a program with physics planted in the cell.
pub fn record(
    cell: &LoadedCell,
    plant: &PlantParameters,
    program: &Program,
    folder: &Path,
) -> Vec<Vec<f64>> {
    let (made, inputs) = inputs(cell, plant, program);
    let readings = simulate(plant, &inputs).readings;
    let seed = 7 + program.name.len() as u64 + (program.feed * 1e3) as u64;
    let measured = (program.name != "c").then_some(&readings[..3]);
    let text = text(&made, plant.cell.servo_bandwidth, measured, seed);
    std::fs::create_dir_all(folder).unwrap();
    std::fs::write(folder.join(format!("{}.csv", program.name)), text).unwrap();
    readings[..3].to_vec()
}

/// A recording as a file: commands, encoders and, where they are measured, the readings of outlet, stroke and force, with noise.
pub fn text(made: &Commands, bandwidth: f64, measured: Option<&[Vec<f64>]>, seed: u64) -> String {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let mut noisy =
        |value: f64, noise: f64| value + noise * random.sample::<f64, _>(StandardNormal);
    let encoders: Vec<Vec<f64>> = made
        .joints
        .iter()
        .map(|joint| follow(&made.time, joint, bandwidth).angle)
        .collect();
    let mut text = String::from("time_s,path_m,set_pressure_pa");
    for joint in 1..=made.joints.len() {
        let _ = write!(text, ",joint_{joint}_command_rad,joint_{joint}_rad");
    }
    text += if measured.is_some() {
        ",regulator_pressure_pa,stroke_m,force_n\n"
    } else {
        "\n"
    };
    for i in 0..made.time.len() {
        let _ = write!(
            text,
            "{},{},{}",
            made.time[i], made.path[i], made.set_pressure[i]
        );
        for (command, encoder) in made.joints.iter().zip(&encoders) {
            let _ = write!(text, ",{},{}", command[i], noisy(encoder[i], NOISE[0]));
        }
        for (channel, readings) in measured.into_iter().flatten().enumerate() {
            let _ = write!(text, ",{}", noisy(readings[i], NOISE[channel + 1]));
        }
        text.push('\n');
    }
    text
}

/// A planted effect: name, joint, its first number, what is planted.
type Planted = (
    &'static str,
    Option<f64>,
    &'static [(&'static str, f64)],
    fn(&mut PlantParameters),
);

const PLANTED: [Planted; 7] = [
    ("", None, &[], |_| ()),
    (
        "part_misplaced",
        None,
        &[("shift_m", 8e-4), ("tilt_m_per_m", -0.006)],
        |p| {
            p.cell.part_shift = 8e-4;
            p.cell.part_tilt = -0.006;
        },
    ),
    (
        "burr",
        None,
        &[("position_m", 0.06), ("height_m", 4e-4)],
        |p| {
            p.cell.burr = Burr {
                height: 4e-4,
                position: 0.06,
                width: 3e-3,
            };
        },
    ),
    (
        "compliant_joint",
        Some(2.0),
        &[("stiffness_n_m_per_rad", 8e4)],
        |p| p.cell.joint_stiffness[1] = 8e4,
    ),
    (
        "joint_encoder_offset",
        Some(3.0),
        &[("offset_rad", 0.003)],
        |p| p.cell.encoder_offset[2] = 0.003,
    ),
    ("servo_lag", None, &[("bandwidth_hz", 11.0)], |p| {
        p.cell.servo_bandwidth = 11.0;
    }),
    (
        "tool_runout",
        None,
        &[("amplitude_m", 6e-5), ("frequency_hz", 27.0)],
        |p| {
            p.contact.runout.sine = 6e-5;
            p.contact.runout.frequency = 27.0;
        },
    ),
];

#[test]
fn what_is_planted_in_a_cell_is_found_placed_and_predicted_with() {
    let bench = Bench::new("plate_edge_ideal");
    bench.write("cell.toml", CELL);
    let device = std::fs::read_to_string(bench.path("device.toml")).unwrap();
    assert!(device.contains("regulator_dead_time_ms"));
    let cell = LoadedCell::new(load_recorded_cell(&bench.path("cell.toml")).unwrap()).unwrap();
    let mut truths = Vec::new();
    for (index, (.., plant)) in PLANTED.iter().enumerate() {
        let folder = bench.path("cases").join(format!("case-{index}"));
        let mut planted = cell.plant();
        plant(&mut planted);
        let of = |program| record(&cell, &planted, program, &folder);
        let all: Vec<Vec<Vec<f64>>> = PROGRAMS.iter().map(of).collect();
        truths.push(all[2].clone());
    }
    let outcome = bench.idc(
        &[
            "diagnose",
            "cases",
            "--all",
            "--scenario",
            "cell.toml",
            "--out",
            "out",
            "--quiet",
        ],
        &[],
    );
    assert_eq!(outcome.code, 0, "{}", outcome.err);
    for (index, (name, joint, numbers, _)) in PLANTED.iter().enumerate() {
        let folder = bench.path("out").join(format!("case-{index}"));
        let text = std::fs::read_to_string(folder.join("diagnosis.json")).unwrap();
        let answer: Answer = serde_json::from_str(&text).unwrap();
        crate::statements::hold_together(&answer);
        let account = std::fs::read_to_string(folder.join("account.txt")).unwrap();
        if name.is_empty() {
            assert_eq!(answer.verdict, Verdict::NothingMissing, "{account}");
            assert!(answer.mismatch.is_empty());
        } else {
            let names: Vec<&str> = answer.effects.iter().map(|e| e.name.as_str()).collect();
            assert_eq!(names, [*name], "{account}");
            let found = &answer.effects[0].parameters;
            let number = |name: &str| found.iter().find(|(n, _)| n == name).map(|(_, e)| *e);
            assert_eq!(number("joint").map(|j| j.value), *joint, "{account}");
            for (parameter, planted) in *numbers {
                let value = number(parameter).unwrap().value;
                let error = (value - planted).abs() / planted.abs();
                assert!(error < 0.1, "{name}.{parameter} {value} against {planted}");
            }
            assert!(!answer.mismatch.is_empty(), "{name}");
            assert!(account.contains("Where on the path"), "{account}");
            if let Some(joint) = joint {
                assert!(
                    account.contains(&format!("joint {joint} from the base")),
                    "{account}"
                );
            }
        }
        predicts(&folder.join("prediction.csv"), &truths[index], name);
    }
    // What is written is a scenario again, with the effect in it.
    let improved = load_recorded_cell(&bench.path("out/case-3/improved.toml")).unwrap();
    assert_eq!(improved.effects.len(), 1);
    let stiffness = LoadedCell::new(improved)
        .unwrap()
        .plant()
        .cell
        .joint_stiffness[1];
    assert!((stiffness / 8e4 - 1.0).abs() < 0.1);
}

/// A program's commands, and where the surface then stands along the slide at each sample [m], of a cell with something planted.
fn surface(
    cell: &LoadedCell,
    made: &Commands,
    joints: &[Vec<f64>],
    plant: &PlantParameters,
) -> Vec<f64> {
    let nominal = cell.plant().cell.servo_bandwidth;
    let trajectory = cell.trajectory(&made.time, &made.path, joints, nominal);
    trajectory.contact_kinematics(&plant.cell).surface()
}

/// Catches: the sign of an encoder's offset, which a cell that is recorded and diagnosed by the same model does not show. A servo closes on the encoder: where
/// that reads too much, the arm stands as if it had been commanded so much less.
#[test]
fn a_joint_whose_encoder_reads_too_much_stays_short_of_its_command() {
    const OFFSET: f64 = 1e-3;
    let bench = Bench::new("plate_edge_ideal");
    bench.write("cell.toml", CELL);
    let cell = LoadedCell::load(&bench.path("cell.toml")).unwrap();
    let made = commands(&PROGRAMS[1]);
    for bandwidth in [25.0, 11.0] {
        let mut without = cell.plant();
        without.cell.servo_bandwidth = bandwidth;
        let as_commanded = surface(&cell, &made, &made.joints, &without);
        let mut seen = 0;
        for joint in 0..made.joints.len() {
            let mut short = made.joints.clone();
            for angle in &mut short[joint] {
                *angle -= OFFSET;
            }
            let expected = surface(&cell, &made, &short, &without);
            let mut with = without.clone();
            with.cell.encoder_offset[joint] = OFFSET;
            let found = surface(&cell, &made, &made.joints, &with);
            let largest = |a: &[f64], b: &[f64]| {
                let apart = a.iter().zip(b).map(|(a, b)| (a - b).abs());
                apart.filter(|d| d.is_finite()).fold(0.0, f64::max)
            };
            let moved = largest(&expected, &as_commanded);
            let off = largest(&expected, &found);
            assert!(
                off < 0.02 * moved + 1e-7,
                "joint {}: {off} of {moved} m",
                joint + 1
            );
            seen += usize::from(moved > 2e-4);
        }
        // A joint on which the ball hangs by a long lever across the edge.
        assert!(seen > 0);
    }
}

/// Catches: the same in the cell that is simulated, or in one of the two alone: Rapier's arm and the replayed one move the slide alike.
#[test]
fn an_encoder_s_offset_moves_the_simulated_slide_as_the_replayed_one() {
    let bench = Bench::new("plate_edge_ideal");
    bench.write("cell.toml", CELL);
    let replayed = LoadedCell::load(&bench.path("cell.toml")).unwrap();
    let program = &PROGRAMS[0];
    let made = commands(program);
    let mean = |values: &[f64], from: f64, to: f64, time: &[f64]| {
        let within = time.iter().zip(values);
        let within = within.filter(|(t, _)| (from..to).contains(*t));
        let values: Vec<f64> = within.map(|(_, value)| *value).collect();
        values.iter().sum::<f64>() / values.len() as f64
    };
    let plain = std::fs::read_to_string(bench.path("scenario.toml")).unwrap();
    // Joint 2, which lifts the arm; so little that the ball stays where the edge is met along its bisector.
    let offset = "\n[[effect]]\nname = \"joint_encoder_offset\"\njoint = 2\noffset_rad = 2e-4\n";
    let [without, with] = ["", offset].map(|effect| {
        bench.write("with.toml", plain.clone() + effect);
        let scenario = load(&bench.path("with.toml")).unwrap();
        let finished = run(job(scenario, program));
        let follow = finished.recording.phase("follow").unwrap();
        let stroke = finished.recording.values(schema::STROKE).unwrap();
        let mut plant = replayed.plant();
        if !effect.is_empty() {
            plant.cell.encoder_offset[1] = 2e-4;
        }
        let surface = surface(&replayed, &made, &made.joints, &plant);
        let time = finished.recording.time();
        [(stroke, time), (&surface[..], &made.time[..])]
            .map(|(values, time)| mean(values, follow.start + 0.1, follow.end - 0.1, time))
    });
    let [simulated, expected] = [0, 1].map(|hand| with[hand] - without[hand]);
    assert!(expected.abs() > 5e-5, "{expected} m");
    let off = (simulated / expected - 1.0).abs();
    assert!(off < 0.05, "{simulated} m for {expected} m");
}

/// Catches: a burr that is met a sample early or late. With servos that do not lag, the slide gives way where the burr stands.
#[test]
fn a_burr_is_met_where_it_is_to_a_fraction_of_a_sample() {
    let burr = Burr {
        height: 2e-4,
        position: 0.06,
        width: 4e-3,
    };
    let bench = Bench::new("plate_edge_ideal");
    bench.write("cell.toml", CELL);
    let cell = LoadedCell::load(&bench.path("cell.toml")).unwrap();
    for program in &PROGRAMS {
        let made = commands(program);
        let stroke = |burr: Burr| {
            let mut plant = cell.plant();
            plant.cell.burr = burr;
            plant.cell.servo_bandwidth = f64::INFINITY;
            // A damper holds the slide back by its share of the spring: here by a tenth of a sample.
            plant.contact.damping = 50.0;
            let trajectory = cell.trajectory(&made.time, &made.path, &made.joints, f64::INFINITY);
            let inputs = PlantInputs {
                time: made.time.clone(),
                set_pressure: made.set_pressure.clone(),
                extends: vec![true; made.time.len()],
                surface: trajectory.contact_kinematics(&plant.cell).surface(),
                cell: Some(std::sync::Arc::new(trajectory)),
                motion: None,
                initial: InitialState::AtRest,
                place: 0,
            };
            simulate(&plant, &inputs).readings[1].clone()
        };
        let (plain, burred) = (stroke(Burr::NONE), stroke(burr));
        // Centre of what the slide gave way, along the edge.
        let (mut given, mut moment) = (0.0, 0.0);
        for ((plain, burred), place) in plain.iter().zip(&burred).zip(&made.path) {
            if (place - burr.position).abs() < 5.0 * burr.width {
                given += plain - burred;
                moment += (plain - burred) * place;
            }
        }
        let sample = program.feed / RATE;
        let off = (moment / given - burr.position) / sample;
        assert!(
            given > 0.0 && off.abs() < 0.3,
            "{}: {off} samples",
            program.name
        );
    }
}

/// The third program without its noise, within the sensors' noise.
fn predicts(file: &Path, truth: &[Vec<f64>], name: &str) {
    let text = std::fs::read_to_string(file).unwrap();
    let columns: Vec<&str> = text.lines().next().unwrap().split(',').collect();
    for (channel, column) in ["regulator_pressure_pa", "stroke_m", "force_n"]
        .into_iter()
        .enumerate()
    {
        let place = columns.iter().position(|c| *c == column).unwrap();
        let mut errors: Vec<f64> = text
            .lines()
            .skip(1)
            .zip(&truth[channel])
            .map(|(line, truth)| {
                let value: f64 = line.split(',').nth(place).unwrap().parse().unwrap();
                (value - truth).abs() / NOISE[channel + 1]
            })
            .collect();
        errors.sort_by(f64::total_cmp);
        let p90 = errors[errors.len() * 9 / 10];
        assert!(
            p90 < 0.5,
            "{name}: {column} is predicted within {p90} of its noise"
        );
    }
}

#[test]
fn a_recorded_cell_is_nothing_to_run_and_its_file_holds_nominal_values_alone() {
    let bench = Bench::new("plate_edge_ideal");
    bench.write("cell.toml", CELL);
    let message = load_any(&bench.path("cell.toml")).unwrap_err().to_string();
    assert!(message.contains("recorded_cell"), "{message}");
    for (from, to, said) in [
        (
            "[joints]",
            "[arm.servo]\ndamping_ratio = 1\n[joints]",
            "`arm.servo`",
        ),
        ("2e5, 2e4]", "2e5]", "5 values, expected 6"),
        ("edge = 1", "edge = 99", "`workpiece.edge`"),
        (
            "[sensors]",
            "[workpiece.misplacement]\nshift_mm = 1\n[sensors]",
            "`workpiece.misplacement`",
        ),
        (
            "[sensors]",
            "[effect.compliant_joint_3]\nstiffness = 1\n[sensors]",
            "`effect.compliant_joint_3.stiffness`",
        ),
        (
            "[sensors]",
            "[effect.gremlins]\nsize = 1\n[sensors]",
            "`effect.gremlins`",
        ),
    ] {
        bench.write("bad.toml", CELL);
        bench.replace("bad.toml", from, to);
        let loaded = load_recorded_cell(&bench.path("bad.toml"));
        let message = match loaded {
            Err(error) => error.to_string(),
            Ok(scenario) => LoadedCell::new(scenario).unwrap_err().to_string(),
        };
        assert!(message.contains(said), "{message}");
    }
}

#[test]
fn the_laboratory_s_nothing_is_nothing() {
    let Some(shared) = shared("cell") else {
        return;
    };
    let scenario = project("tests/lab_cell.toml");
    let loaded = LoadedCell::new(load_recorded_cell(&scenario).unwrap()).unwrap();
    assert_eq!(loaded.joints.len(), 6);
    let middle = loaded
        .trajectory(&[0.0, 2e-3], &[0.15; 2], &vec![vec![0.0; 2]; 6], 25.0)
        .edge[0];
    assert!((middle.point - glam::DVec3::new(0.75, 0.0, -0.10)).length() < 1e-7);
    let bisector = glam::DVec3::new(-1.0, 0.0, 1.0).normalize();
    assert!((middle.bisector - bisector).length() < 1e-7);
    // The sixth case is a control.
    let bench = Bench::new("plate_edge_ideal");
    let case = shared.join("practice/cases/case-06");
    let of = |path: &Path| path.display().to_string();
    let outcome = bench.idc(
        &[
            "diagnose",
            &of(&case),
            "--scenario",
            &of(&scenario),
            "--out",
            "out",
            "--quiet",
        ],
        &[],
    );
    assert_eq!(outcome.code, 0, "{}", outcome.err);
    let text = std::fs::read_to_string(bench.path("out/diagnosis.json")).unwrap();
    let answer: Answer = serde_json::from_str(&text).unwrap();
    crate::statements::hold_together(&answer);
    assert_eq!(answer.verdict, Verdict::NothingMissing);
}
