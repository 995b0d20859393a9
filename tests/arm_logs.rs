//! One motion of an arm, logged as robots log it: each log is imported by the commands that the program suggests, and diagnosed as the same numbers in the program's own columns.

mod dialects;
mod refused;

use std::fmt::Write as _;

use crate::program::{Bench, Outcome};

/// Joints base first, by names that do not tell their order.
const JOINTS: [&str; 6] = ["waist", "shoulder", "elbow", "forearm", "bend", "roll"];
/// Samples, and the time between them [s].
const SAMPLES: usize = 800;
const STEP: f64 = 0.02;
/// Standard deviation of noise on currents [A], forces [N] and torques [N m].
const NOISE: [f64; 3] = [0.03, 0.2, 0.01];

/// An arm of six joints, by link lengths and masses.
fn urdf() -> String {
    let links = [
        (0.3, 9.0, "0 0 1", "300"),
        (0.5, 8.0, "0 1 0", "300"),
        (0.45, 5.0, "0 1 0", "150"),
        (0.1, 2.0, "0 0 1", "60"),
        (0.1, 1.5, "0 1 0", "60"),
        (0.08, 0.6, "0 0 1", "60"),
    ];
    let mut text = "<robot name=\"six\"><link name=\"base\"/>".to_owned();
    let (mut parent, mut above) = ("base".to_owned(), 0.1);
    for (joint, (length, mass, axis, effort)) in JOINTS.iter().zip(links) {
        let (centre, inertia) = (0.5 * length, mass * (0.002 + length * length / 12.0));
        let _ = write!(
            text,
            "<link name=\"{joint}_link\"><inertial><origin xyz=\"0 0.01 {centre}\"/><mass value=\"{mass}\"/>\
             <inertia ixx=\"{inertia}\" iyy=\"{inertia}\" izz=\"{}\" ixy=\"0\" ixz=\"0\" iyz=\"0\"/></inertial></link>\
             <joint name=\"{joint}\" type=\"revolute\"><parent link=\"{parent}\"/><child link=\"{joint}_link\"/><origin xyz=\"0 0 {above}\"/><axis xyz=\"{axis}\"/>\
             <limit lower=\"-6.28\" upper=\"6.28\" effort=\"{effort}\" velocity=\"3\"/></joint>",
            0.002 * mass
        );
        (parent, above) = (format!("{joint}_link"), length);
    }
    text + "<link name=\"flange\"/><joint name=\"face\" type=\"fixed\"><parent link=\"roll_link\"/><child link=\"flange\"/><origin xyz=\"0 0 0.08\"/></joint></robot>"
}

/// The arm as it is: a shoulder with friction that nobody declared.
fn truth() -> String {
    let mut text =
        "kind = \"recorded_arm\"\nschema = 1\n[arm]\nurdf = \"six.urdf\"\nflange = \"flange\"\n"
            .to_owned();
    for joint in JOINTS {
        text += &format!(
            "[[drive]]\njoint = \"{joint}\"\ngain_n_m_per_a = 10.0\nmotor_inertia_kg_m2 = 0.5\n"
        );
        if joint == "shoulder" {
            text += "coulomb_friction_n_m = 12.0\nviscous_friction_n_m_s_per_rad = 15.0\n";
        }
    }
    text + "[load]\nmass_kg = 0.0\n[wrench_sensor]\nrotation_z_rad = 0.0\ntool_mass_kg = 1.2\ntool_centre_m = [0.01, 0.0, 0.06]\n\
        [sensors]\nrate_hz = 50\njoint_rad = 1e-6\ncurrent_a = [0.03, 0.03, 0.03, 0.03, 0.03, 0.03]\nwrench_force_n = 0.2\nwrench_torque_n_m = 0.01\n\
        [recordings]\nfit = [\"motion.csv\"]\n"
}

/// Angle of a joint, and its slope, of a Fourier series [rad], [rad/s].
fn course(joint: usize, time: f64) -> [f64; 2] {
    let (mut angle, mut slope) = (0.2 * joint as f64 - 0.5, 0.0);
    for term in 1..=3 {
        let rate = 0.4 * std::f64::consts::TAU * f64::from(term) / 4.0;
        let phase = rate * time + 1.7 * joint as f64 + 0.9 * f64::from(term * term);
        let size = 0.5 / f64::from(term);
        angle += size * phase.sin();
        slope += size * rate * phase.cos();
    }
    [angle, slope]
}

/// What was logged, in SI.
pub struct Sample {
    pub time: f64,
    pub angles: [f64; 6],
    pub commands: [f64; 6],
    pub speeds: [f64; 6],
    pub currents: [f64; 6],
    /// Forces, torques.
    pub wrench: [f64; 6],
}

/// Uniform noise of some standard deviation.
fn noise(state: &mut u64, deviation: f64) -> f64 {
    *state ^= *state << 13;
    *state ^= *state >> 7;
    *state ^= *state << 17;
    3.0f64.sqrt() * deviation * ((*state >> 11) as f64 / (1u64 << 52) as f64 - 1.0)
}

fn done(outcome: &Outcome) {
    assert_eq!(outcome.code, 0, "{}\n{}", outcome.out, outcome.err);
}

/// A folder with the arm's URDF, and its motion as the arm that it really is logs it.
pub fn logged() -> (Bench, Vec<Sample>) {
    let bench = Bench::new("plate_edge_ideal");
    bench.write("six.urdf", urdf());
    bench.write("truth.toml", truth());
    let names = |end: &str| {
        (1..=6)
            .map(|n| format!("joint_{n}_{end}"))
            .collect::<Vec<_>>()
    };
    let mut motion = format!("time_s,{}\n", names("rad").join(","));
    let time = |row: usize| (1e6 * STEP * row as f64).round() * 1e-6;
    for row in 0..SAMPLES {
        let angles = (0..6).map(|joint| course(joint, time(row))[0].to_string());
        let angles: Vec<String> = angles.collect();
        motion += &format!("{},{}\n", time(row), angles.join(","));
    }
    bench.write("motion.csv", motion);
    done(&bench.idc(
        &["predict", "truth.toml", "motion.csv", "--out", "read.csv"],
        &[],
    ));
    let read = std::fs::read_to_string(bench.path("read.csv")).unwrap();
    let mut lines = read.lines();
    let header: Vec<&str> = lines.next().unwrap().split(',').collect();
    let mut state = 11;
    let mut sample = |(row, line): (usize, &str)| {
        let cells: Vec<f64> = line.split(',').map(|cell| cell.parse().unwrap()).collect();
        let of = |name: String| cells[header.iter().position(|own| *own == name).unwrap()];
        let all = |of: &dyn Fn(usize) -> f64| -> [f64; 6] { std::array::from_fn(of) };
        let axis = |i: usize| {
            [
                "force_x_n",
                "force_y_n",
                "force_z_n",
                "torque_x_n_m",
                "torque_y_n_m",
                "torque_z_n_m",
            ][i]
        };
        let angles = all(&|joint| course(joint, time(row))[0]);
        let speeds = all(&|joint| course(joint, time(row))[1]);
        let mut currents = all(&|joint| of(format!("joint_{}_current_a", joint + 1)));
        let mut wrench = all(&|i| of(format!("wrench_{}", axis(i))));
        for current in &mut currents {
            *current += noise(&mut state, NOISE[0]);
        }
        for (place, reading) in wrench.iter_mut().enumerate() {
            *reading += noise(&mut state, NOISE[1 + place / 3]);
        }
        Sample {
            time: time(row),
            angles,
            commands: angles.map(|angle| angle + 1e-4),
            speeds,
            currents,
            wrench,
        }
    };
    let samples = lines.enumerate().map(&mut sample).collect();
    (bench, samples)
}

/// The log in the program's own columns; torques in newton metres in place of currents where the dialect has these.
fn plain(samples: &[Sample], as_torques: bool, with_wrench: bool) -> String {
    let mut text = "time_s".to_owned();
    let drive = if as_torques {
        "torque_n_m"
    } else {
        "current_a"
    };
    for end in ["rad", drive] {
        for number in 1..=6 {
            text += &format!(",joint_{number}_{end}");
        }
    }
    for axis in [
        "force_x_n",
        "force_y_n",
        "force_z_n",
        "torque_x_n_m",
        "torque_y_n_m",
        "torque_z_n_m",
    ] {
        if with_wrench {
            text += &format!(",wrench_{axis}");
        }
    }
    text.push('\n');
    for sample in samples {
        let factor = if as_torques { 10.0 } else { 1.0 };
        let wrench = if with_wrench { &sample.wrench[..] } else { &[] };
        let values = sample
            .angles
            .iter()
            .copied()
            .chain(sample.currents.map(|c| factor * c));
        let values: Vec<String> = values
            .chain(wrench.iter().copied())
            .map(|v| v.to_string())
            .collect();
        text += &format!("{},{}\n", sample.time, values.join(","));
    }
    text
}

/// What a diagnosis of a log says, from the commands that a user types: its answer, with the arm's file made of URDF and log.
fn diagnosed(bench: &Bench, folder: &str, recording: &str) -> serde_json::Value {
    let path = |file: &str| format!("{folder}/{file}");
    std::fs::copy(bench.path("six.urdf"), bench.path(&path("six.urdf"))).unwrap();
    let (arm, urdf, log) = (path("arm.toml"), path("six.urdf"), path(recording));
    done(&bench.idc(&["new", "arm", &arm, "--urdf", &urdf, "--log", &log], &[]));
    let out = path("found");
    done(&bench.idc(&["diagnose", folder, "--out", &out, "--quiet"], &[]));
    let text = std::fs::read_to_string(bench.path(&path("found/diagnosis.json"))).unwrap();
    serde_json::from_str(&text).unwrap()
}

/// Refuses answers that differ by more than the digits of a log.
fn assert_same(found: &serde_json::Value, expected: &serde_json::Value, what: &str, digits: f64) {
    use serde_json::Value::{Array, Number, Object};
    match (found, expected) {
        (Object(a), Object(b)) => {
            assert_eq!(
                a.keys().collect::<Vec<_>>(),
                b.keys().collect::<Vec<_>>(),
                "{what}"
            );
            for (key, own) in a {
                assert_same(own, &b[key], &format!("{what}.{key}"), digits);
            }
        }
        (Array(a), Array(b)) => {
            assert_eq!(a.len(), b.len(), "{what}: {found} {expected}");
            for (index, (own, other)) in a.iter().zip(b).enumerate() {
                assert_same(own, other, &format!("{what}[{index}]"), digits);
            }
        }
        (Number(a), Number(b)) => {
            let (a, b) = (a.as_f64().unwrap(), b.as_f64().unwrap());
            assert!(
                (a - b).abs() <= digits * a.abs().max(b.abs()).max(1e-3),
                "{what}: {a} for {b}"
            );
        }
        _ => assert_eq!(found, expected, "{what}"),
    }
}
