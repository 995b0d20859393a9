//! Cases with something planted, recorded by the project's own rig with noise of the sensors that its file states.

use std::fmt::Write as _;

use idc_cell::plant::{InitialState, PlantInputs, simulate};
use idc_cell::scenario::rig_file::load_rig;
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rand_distr::StandardNormal;

use crate::predict::RIG;
use crate::program::Bench;

/// A force that hangs on the tool.
pub const OFFSET: &str = "\n[effect.axial_force_offset]\nforce_n = -20\n";
/// The same [N].
pub const TRUE_OFFSET: f64 = -20.0;

const RECORDINGS: &str =
    "\n[recordings]\nfit = [\"press.csv\", \"free.csv\"]\npredict = \"predict.csv\"\n";

/// Faults of the recordings.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Dirt {
    None,
    Much,
}

/// A new folder with a case.
pub fn case(bench: &Bench, folder: &str, effects: &str, dirt: Dirt) {
    std::fs::create_dir_all(bench.path(folder)).unwrap();
    case_files(bench, folder, effects, dirt);
}

/// The files of a case; the rig file does not say what is planted.
pub fn case_files(bench: &Bench, folder: &str, effects: &str, dirt: Dirt) {
    let rig = format!("{folder}/rig.toml");
    let nominal = RIG.replace(
        "time_constant_s = 0.1",
        "time_constant_s = { value = 0.1, tolerance = 0.1 }",
    );
    bench.write(&rig, nominal.clone() + RECORDINGS + effects);
    let truth = load_rig(&bench.path(&rig)).unwrap();
    bench.write(&rig, nominal + RECORDINGS);
    for (seed, (name, at)) in (1..).zip(PROGRAMS) {
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        let jitter = if dirt == Dirt::Much { 6e-4 } else { 0.0 };
        let time: Vec<f64> = (0..1000)
            .map(|i| 0.004 * f64::from(i) + jitter * random.random::<f64>())
            .collect();
        let values: Vec<(f64, bool, f64)> = time.iter().map(|t| at(*t)).collect();
        let inputs = PlantInputs {
            cell: None,
            motion: None,
            initial: InitialState::AtRest,
            place: 0,
            set_pressure: values.iter().map(|v| v.0).collect(),
            extends: values.iter().map(|v| v.1).collect(),
            surface: values.iter().map(|v| v.2).collect(),
            time,
        };
        let mut readings = simulate(&truth.plant, &inputs).readings;
        for (values, noise) in readings.iter_mut().zip(truth.noise) {
            for value in values {
                *value += noise * random.sample::<f64, _>(StandardNormal);
            }
        }
        let path = format!("{folder}/{name}");
        bench.write(&path, text(name, &inputs, &readings, dirt));
    }
}

type Program = fn(f64) -> (f64, bool, f64);

/// Set pressure, valve, surface against time: stairs of pressure on a surface that moves, strokes without one, and both kinds of the first mixed.
const PROGRAMS: [(&str, Program); 3] = [
    ("press.csv", |t| {
        let step = [1.0, 2.0, 1.4, 1.8][t as usize % 4];
        (1e5 * step, true, 0.02 + 0.003 * (3.0 * t).sin())
    }),
    ("free.csv", |t| {
        let pressure = if t < 2.0 { 1.5e5 } else { 2.2e5 };
        (pressure, t % 2.0 < 1.1, f64::NAN)
    }),
    ("predict.csv", |t| {
        let step = [1.7, 1.2, 2.1, 1.5][t as usize % 4];
        (1e5 * step, true, 0.022 + 0.002 * (5.0 * t).sin())
    }),
];

fn text(name: &str, inputs: &PlantInputs, readings: &[Vec<f64>; 4], dirt: Dirt) -> String {
    let much = dirt == Dirt::Much && name != "predict.csv";
    // A free stroke without an accelerometer.
    let channels = if much && name == "free.csv" { 3 } else { 4 };
    let measured = [
        "regulator_pressure_pa",
        "stroke_m",
        "force_n",
        "acceleration_m_per_s2",
    ];
    let mut text = "time_s,set_pressure_pa,solenoid,surface_m".to_owned();
    for column in &measured[..channels] {
        text += &format!(",{column}");
    }
    text.push('\n');
    for (i, time) in inputs.time.iter().enumerate() {
        let gap = much && (600..620).contains(&i);
        if gap {
            continue;
        }
        let surface = inputs.surface[i];
        let surface = if surface.is_nan() {
            String::new()
        } else {
            surface.to_string()
        };
        let extends = u8::from(inputs.extends[i]);
        write!(
            text,
            "{:.6},{},{extends},{surface}",
            time, inputs.set_pressure[i]
        )
        .unwrap();
        for (channel, values) in readings[..channels].iter().enumerate() {
            let lost = much && channel == 1 && i % 40 == 7;
            let wild = if much && name == "press.csv" && channel == 2 && i == 400 {
                250.0
            } else {
                0.0
            };
            if lost {
                text.push(',');
            } else {
                write!(text, ",{}", values[i] + wild).unwrap();
            }
        }
        text.push('\n');
    }
    text
}
