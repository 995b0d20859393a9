//! The project's own cell, simulated with Rapier, one thing planted in it: what its runs show, handed to `idc diagnose` as they are, is named, placed, sized,
//! and predicts another path better; in a cell as believed nothing is found.

use idc_cell::diagnosis::answer::{Answer, Verdict};

use crate::program::Bench;

/// What is planted: name of the case, where it goes in a scenario, how an answer names it, joint from 1, numbers, a column that is predicted better.
struct Planted {
    case: &'static str,
    edits: &'static [(&'static str, &'static str)],
    name: &'static str,
    joint: Option<usize>,
    numbers: &'static [(&'static str, f64)],
    better: &'static str,
}

/// Tables that an edit can add to: what they follow in the file.
const DEVICE: &str = "model = \"device.toml\"\n";
const DRIVES: &str = "flange_link = \"flange\"\n";
const SERVO: &str = "encoder_noise_rad = 2e-6\n";
const END: &str = "[sensing]\n";

const NOTHING: Planted = Planted {
    case: "nothing",
    edits: &[],
    name: "",
    joint: None,
    numbers: &[],
    better: "",
};

const PLANTED: [Planted; 9] = [
    Planted {
        case: "seals",
        edits: &[(
            DEVICE,
            "[device.override]\nseal_coulomb_force_n = 8\nseal_static_force_n = 8\nseal_viscous_coefficient_n_s_per_m = 60\n",
        )],
        name: "coulomb_viscous_friction",
        joint: None,
        numbers: &[("coulomb_force_n", 8.0)],
        better: "force_n",
    },
    Planted {
        case: "delay",
        edits: &[(DEVICE, "[device.override]\nregulator_dead_time_ms = 90\n")],
        name: "transport_delay",
        joint: None,
        numbers: &[("delay_s", 0.09)],
        better: "regulator_pressure_pa",
    },
    Planted {
        case: "backlash",
        edits: &[(
            DRIVES,
            "[[arm.drives]]\njoint = \"elbow\"\nstiffness_n_m_per_rad = 1e6\nbacklash_deg = 0.1\n",
        )],
        name: "joint_backlash",
        joint: Some(3),
        numbers: &[("play_rad", 0.1 * std::f64::consts::PI / 180.0)],
        better: "stroke_m",
    },
    Planted {
        case: "friction",
        edits: &[(
            DRIVES,
            "[[arm.drives]]\njoint = \"shoulder_lift\"\nfriction_n_m = 20\n",
        )],
        name: "joint_friction",
        joint: Some(2),
        numbers: &[("friction_n_m", 20.0)],
        better: "joint_2_torque_n_m",
    },
    Planted {
        case: "soft",
        edits: &[(
            DRIVES,
            "[[arm.drives]]\njoint = \"elbow\"\nstiffness_n_m_per_rad = 8e4\n",
        )],
        name: "compliant_joint",
        joint: Some(3),
        numbers: &[("stiffness_n_m_per_rad", 8e4)],
        better: "stroke_m",
    },
    Planted {
        case: "lag",
        edits: &[(SERVO, "lag_bandwidth_hz = 8\n")],
        name: "servo_lag",
        joint: None,
        numbers: &[("bandwidth_hz", 8.0)],
        better: "joints_rad",
    },
    Planted {
        case: "moved",
        edits: &[(
            END,
            "[workpiece.misplacement]\nshift_mm = 0.8\ntilt_deg = -0.4\n[sensing]\n",
        )],
        name: "part_misplaced",
        joint: None,
        numbers: &[("shift_m", 8e-4), ("tilt_m_per_m", -0.006_981_4)],
        better: "stroke_m",
    },
    Planted {
        case: "burr",
        edits: &[(
            END,
            "[workpiece.burr]\nkind = \"bump\"\nposition_mm = 35\nheight_mm = 0.4\nwidth_mm = 12\n[sensing]\n",
        )],
        name: "burr",
        joint: None,
        numbers: &[("position_m", 0.035), ("height_m", 4e-4)],
        better: "stroke_m",
    },
    Planted {
        case: "runout",
        edits: &[(
            END,
            "[contact]\nrunout_um = 60\nrunout_frequency_hz = 27\n[sensing]\n",
        )],
        name: "tool_runout",
        joint: None,
        numbers: &[("amplitude_m", 6e-5), ("frequency_hz", 27.0)],
        better: "force_n",
    },
];

/// Name, lean [deg], force [N], feed [mm/s], seed.
const PROGRAMS: [(&str, f64, f64, f64, u32); 3] = [
    ("a", 0.0, 150.0, 40.0, 11),
    ("b", 14.0, 80.0, 60.0, 12),
    ("predict", -9.0, 120.0, 50.0, 13),
];

const SENSING: &str = "
[sensing]
preset = \"white\"
sample_rate_hz = 250
[sensing.force]
standard_deviation_n = 0.8
[sensing.stroke]
standard_deviation_mm = 0.04
[sensing.regulator_pressure]
standard_deviation_pa = 400
";

/// A short stretch of the plate's edge in a program, with something planted.
fn scenario(nominal: &str, program: &(&str, f64, f64, f64, u32), planted: &Planted) -> String {
    let (_, lean, force, feed, seed) = *program;
    let job = nominal.split("[expect]").next().unwrap();
    let mut text = job
        .replace("start_mm = 10", "start_mm = 100")
        .replace("end_mm = 290", "end_mm = 160")
        .replace("force_n = 150", &format!("force_n = {force}"))
        .replace(
            "feed_mm_per_s = 20",
            &format!(
                "feed_mm_per_s = {feed}\nlean_deg = {lean}\napproach_distance_mm = 10\nengage_speed_mm_per_s = 40\nsettle_time_s = 0.5"
            ),
        )
        .replace("[device]\n", "[arm.servo]\nencoder_noise_rad = 2e-6\n\n[device]\n");
    text += SENSING;
    text += &format!("[simulation]\nseed = {seed}\n");
    for (after, added) in planted.edits {
        assert!(text.contains(after), "{after}");
        // A table that ends with what it stood before takes its place.
        let put = if added.ends_with(after) {
            (*added).to_owned()
        } else {
            format!("{after}{added}")
        };
        text = text.replacen(after, &put, 1);
    }
    text
}

/// Runs the programs of each and diagnoses them.
fn diagnosed(all: &[Planted]) -> Bench {
    let bench = Bench::new("plate_edge");
    let nominal = std::fs::read_to_string(bench.path("scenario.toml")).unwrap();
    bench.write("believed.toml", scenario(&nominal, &PROGRAMS[0], &NOTHING));
    for planted in all {
        for program in &PROGRAMS {
            bench.write("run.toml", scenario(&nominal, program, planted));
            let folder = format!("cases/{}/{}", planted.case, program.0);
            let outcome = bench.idc(&["run", "run.toml", "--out", &folder, "--quiet"], &[]);
            assert_eq!(outcome.code, 0, "{}: {}", planted.case, outcome.err);
        }
    }
    let outcome = bench.idc(
        &[
            "diagnose",
            "cases",
            "--all",
            "--scenario",
            "believed.toml",
            "--out",
            "out",
            "--quiet",
        ],
        &[],
    );
    assert_eq!(outcome.code, 0, "{}", outcome.err);
    bench
}

/// What was said of a case, and the account of it.
fn answer(bench: &Bench, case: &str) -> (Answer, String) {
    let folder = bench.path("out").join(case);
    let text = std::fs::read_to_string(folder.join("diagnosis.json")).unwrap();
    let account = std::fs::read_to_string(folder.join("account.txt")).unwrap();
    (serde_json::from_str(&text).unwrap(), account)
}

fn holds(bench: &Bench, planted: &Planted) {
    let (answer, account) = answer(bench, planted.case);
    if planted.name.is_empty() {
        assert_eq!(answer.verdict, Verdict::NothingMissing, "{account}");
        return;
    }
    let names: Vec<&str> = answer.effects.iter().map(|e| e.name.as_str()).collect();
    assert_eq!(names, [planted.name], "{account}");
    let found = &answer.effects[0].parameters;
    let number = |name: &str| found.iter().find(|(n, _)| n == name).map(|(_, e)| e.value);
    assert_eq!(
        number("joint"),
        planted.joint.map(|joint| joint as f64),
        "{account}"
    );
    for (name, truth) in planted.numbers {
        let value = number(name).unwrap();
        let error = (value / truth - 1.0).abs();
        assert!(
            error < 0.1,
            "{}.{name}: {value} against {truth}",
            planted.case
        );
    }
    let predicted = &answer.details.prediction;
    let better = predicted
        .iter()
        .find(|p| p.channel == planted.better)
        .unwrap();
    assert!(
        better.recording == "predict" && better.after < better.before,
        "{account}"
    );
}

#[test]
fn in_a_run_as_believed_nothing_is_found_and_a_regulator_s_delay_is() {
    let [_, delay, ..] = PLANTED;
    let all = [NOTHING, delay];
    let bench = diagnosed(&all);
    for planted in &all {
        holds(&bench, planted);
    }
}

#[test]
#[ignore = "minutes"]
fn everything_planted_in_the_plate_s_cell_is_named_placed_and_sized() {
    let bench = diagnosed(&PLANTED);
    for planted in &PLANTED {
        holds(&bench, planted);
    }
}
