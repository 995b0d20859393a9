//! The project's own cell, simulated with Rapier, one thing planted in it: what its runs show, handed to `idc diagnose` as they are, is named, placed, sized,
//! and predicts another path better; in a nominal cell nothing is found.

use std::fs::File;
use std::path::Path;

use idc_cell::diagnosis::answer::{Answer, Verdict};
use parquet::file::reader::{FileReader, SerializedFileReader};
use parquet::record::{Field, Row};

use crate::common::project;
use crate::program::Bench;

/// Planted effects: name of the case, where it goes in a scenario, how an answer names it, joint from 1, numbers, a column that is predicted better.
struct Planted {
    case: &'static str,
    edits: &'static [(&'static str, &'static str)],
    name: &'static str,
    joint: Option<usize>,
    numbers: &'static [(&'static str, f64)],
    better: &'static str,
    /// Whether nothing else is named beside it on the plate, on the bracket. What a joint swings and strikes by while the tool is set on the edge, the encoders'
    /// samples do not follow quite, and a smaller effect may be named for what is left.
    alone: [bool; 2],
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
    alone: [true; 2],
};

const RUBBING: Planted = Planted {
    case: "friction",
    edits: &[(
        DRIVES,
        "[[arm.drives]]\njoint = \"shoulder_lift\"\nfriction_n_m = 20\n",
    )],
    name: "joint_friction",
    joint: Some(2),
    numbers: &[("friction_n_m", 20.0)],
    better: "joint_2_torque_n_m",
    alone: [true; 2],
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
        alone: [true; 2],
        better: "force_n",
    },
    Planted {
        case: "delay",
        edits: &[(DEVICE, "[device.override]\nregulator_dead_time_ms = 90\n")],
        name: "transport_delay",
        joint: None,
        numbers: &[("delay_s", 0.09)],
        alone: [true; 2],
        better: "regulator_pressure_pa",
    },
    Planted {
        case: "backlash",
        edits: &[(
            DRIVES,
            "[[arm.drives]]\njoint = \"shoulder_lift\"\nstiffness_n_m_per_rad = 1e6\nbacklash_deg = 0.04\n",
        )],
        name: "joint_backlash",
        joint: Some(2),
        numbers: &[("play_rad", 0.04 * std::f64::consts::PI / 180.0)],
        alone: [false; 2],
        better: "stroke_m",
    },
    RUBBING,
    Planted {
        case: "soft",
        edits: &[(
            DRIVES,
            "[[arm.drives]]\njoint = \"shoulder_lift\"\nstiffness_n_m_per_rad = 1.5e5\n",
        )],
        name: "compliant_joint",
        joint: Some(2),
        numbers: &[("stiffness_n_m_per_rad", 1.5e5)],
        alone: [true, false],
        better: "stroke_m",
    },
    Planted {
        case: "lag",
        edits: &[(SERVO, "lag_bandwidth_hz = 25\n")],
        name: "servo_lag",
        joint: None,
        numbers: &[("bandwidth_hz", 25.0)],
        alone: [true; 2],
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
        alone: [true; 2],
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
        alone: [true; 2],
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
        alone: [true; 2],
        better: "force_n",
    },
];

/// Name, lean [deg], force [N], feed [mm/s], seed.
type Program = (&'static str, f64, f64, f64, u32);

const PROGRAMS: [Program; 5] = [
    ("a", 0.0, 170.0, 40.0, 11),
    ("b", 14.0, 60.0, 60.0, 12),
    ("c", -9.0, 115.0, 50.0, 14),
    ("d", 0.0, 70.0, 50.0, 15),
    ("predict", 6.0, 150.0, 55.0, 13),
];

/// A job of the project, cut short.
struct Job {
    name: &'static str,
    part: &'static str,
    /// Text of its file, and its text in the test.
    cuts: &'static [(&'static str, &'static str)],
}

const PLATE: Job = Job {
    name: "plate_edge_ideal",
    part: "plate.stl",
    cuts: &[
        ("start_mm = 10\n", "start_mm = 100\n"),
        ("end_mm = 290", "end_mm = 160"),
        ("force_n = 150", "force_n = FORCE"),
    ],
};
const BRACKET: Job = Job {
    name: "bracket_loop",
    part: "bracket.stl",
    cuts: &[
        ("start_mm = 60 ", "start_mm = 200\nend_mm = 300 "),
        ("force_n = 100", "force_n = FORCE"),
        ("corner_feed_mm_per_s = 5\n", ""),
    ],
};

/// Process that sets the tool on the edge.
const PROCESS: &str = "feed_mm_per_s = FEED
lean_deg = LEAN
approach_distance_mm = 10
working_stroke_mm = 40
settle_time_s = 0.4

[controller]
kind = \"proportional_integral\"
period_ms = 20

[simulation]
seed = SEED
";

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

/// The job in a program, with something planted.
fn scenario(job: &Job, program: &Program, planted: &Planted) -> String {
    let file = project(&format!("scenarios/{}.toml", job.name));
    let nominal = std::fs::read_to_string(file).unwrap();
    let mut text = nominal.split("[expect]").next().unwrap().to_owned();
    let part = format!("../assets/{}", job.part);
    let mut put = |from: &str, to: &str| {
        assert!(text.contains(from), "{from}");
        text = text.replacen(from, to, 1);
    };
    put("../models/arm/arm10.urdf", "arm.urdf");
    put("../models/device.toml", "device.toml");
    put(&part, job.part);
    for (from, to) in job.cuts {
        put(from, to);
    }
    put("feed_mm_per_s = 20\n", PROCESS);
    put(
        "[device]\n",
        "[arm.servo]\nencoder_noise_rad = 2e-6\n\n[device]\n",
    );
    let (_, lean, force, feed, seed) = program;
    put("LEAN", &lean.to_string());
    put("FORCE", &force.to_string());
    put("FEED", &feed.to_string());
    put("SEED", &seed.to_string());
    text += SENSING;
    for (after, added) in planted.edits {
        // A table that ends with what it stands before takes its place.
        let with = if added.ends_with(after) {
            (*added).to_owned()
        } else {
            format!("{after}{added}")
        };
        assert!(text.contains(after), "{after}");
        text = text.replacen(after, &with, 1);
    }
    text
}

/// Runs the programs of each and diagnoses them.
fn diagnosed(job: &Job, all: &[Planted]) -> Bench {
    let bench = Bench::new("plate_edge_ideal");
    let asset = project(&format!("assets/{}", job.part));
    std::fs::copy(asset, bench.path(job.part)).unwrap();
    bench.write("nominal.toml", scenario(job, &PROGRAMS[0], &NOTHING));
    for planted in all {
        for program in &PROGRAMS {
            bench.write("run.toml", scenario(job, program, planted));
            let folder = format!("cases/{}/{}", planted.case, program.0);
            let outcome = bench.idc(&["run", "run.toml", "--out", &folder, "--quiet"], &[]);
            assert_eq!(outcome.code, 0, "{}: {}", planted.case, outcome.err);
        }
    }
    diagnose_cases(&bench);
    bench
}

/// Diagnoses all cases of a bench against the nominal model.
fn diagnose_cases(bench: &Bench) {
    let outcome = bench.idc(
        &[
            "diagnose",
            "cases",
            "--all",
            "--scenario",
            "nominal.toml",
            "--out",
            "out",
            "--quiet",
        ],
        &[],
    );
    assert_eq!(outcome.code, 0, "{}", outcome.err);
}

/// Answer to a case, and the account of it.
fn answer(bench: &Bench, case: &str) -> (Answer, String) {
    let folder = bench.path("out").join(case);
    let text = std::fs::read_to_string(folder.join("diagnosis.json")).unwrap();
    let account = std::fs::read_to_string(folder.join("account.txt")).unwrap();
    let answer = serde_json::from_str(&text).unwrap();
    crate::statements::hold_together(&answer);
    (answer, account)
}

fn holds(bench: &Bench, planted: &Planted, job: usize) {
    let (answer, account) = answer(bench, planted.case);
    if planted.name.is_empty() {
        assert_eq!(answer.verdict, Verdict::NothingMissing, "{account}");
        return;
    }
    let names: Vec<&str> = answer.effects.iter().map(|e| e.name.as_str()).collect();
    if planted.alone[job] {
        assert_eq!(names, [planted.name], "{account}");
    }
    assert_eq!(names[0], planted.name, "{account}");
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
fn in_nominal_runs_nothing_is_found_and_a_joint_that_rubs_is_named() {
    let all = [NOTHING, RUBBING];
    let bench = diagnosed(&PLATE, &all);
    for planted in &all {
        holds(&bench, planted, 0);
    }
}

/// A tool that turns, and takes off what its work is worth, twice.
const DEBURRING: &str = "[tool]
shape = \"ball\"
spindle_speed_rpm = 20000
spindle_lead_deg = 45
stall_torque_n_mm = 500

[removal]
law = \"preston\"
coefficient_mm3_per_j = 0.012
specific_energy_j_per_mm3 = 25
friction_coefficient = 0.3

[[pass]]

[[pass]]
";

/// Columns of a run's edge_profile.csv: place on the edge [mm], burr before and after [mm].
fn edge_profile(file: &Path) -> Vec<[f64; 3]> {
    let text = std::fs::read_to_string(file).unwrap();
    let rows = text.lines().skip(1).map(|line| {
        let numbers: Vec<f64> = line.split(',').map(|n| n.parse().unwrap()).collect();
        [numbers[0], numbers[1], numbers[2]]
    });
    rows.collect()
}

/// The same edge is measured, ground in two passes, and measured again, with the burr that the passes left.
#[test]
#[ignore = "a minute: two diagnoses of four runs each"]
fn a_burr_is_found_before_it_is_ground_off_and_not_after() {
    let burred = PLANTED.iter().find(|p| p.case == "burr").unwrap();
    let bench = Bench::new("plate_edge_ideal");
    let asset = project(&format!("assets/{}", PLATE.part));
    std::fs::copy(asset, bench.path(PLATE.part)).unwrap();
    bench.write("nominal.toml", scenario(&PLATE, &PROGRAMS[0], &NOTHING));
    let measured = |case: &str, edited: &dyn Fn(String) -> String, planted: &Planted| {
        for program in &PROGRAMS {
            bench.write("run.toml", edited(scenario(&PLATE, program, planted)));
            let folder = format!("cases/{case}/{}", program.0);
            let outcome = bench.idc(&["run", "run.toml", "--out", &folder, "--quiet"], &[]);
            assert_eq!(outcome.code, 0, "{case}: {}", outcome.err);
        }
    };
    measured("before", &|text| text, burred);

    let program = ("grind", 0.0, 60.0, 30.0, 21);
    bench.write("grind.toml", scenario(&PLATE, &program, burred) + DEBURRING);
    let outcome = bench.idc(&["run", "grind.toml", "--out", "ground", "--quiet"], &[]);
    assert_eq!(outcome.code, 0, "{}", outcome.err);
    let profile = edge_profile(&bench.path("ground/edge_profile.csv"));
    let largest = |column: usize| profile.iter().map(|row| row[column]).fold(0.0, f64::max);
    assert!((largest(1) - 0.4).abs() < 0.01, "{}", largest(1));
    assert_eq!(largest(2), 0.0, "the law says that two passes take it off");

    // Stations stand in the middle of what they are of: a table goes from end to end.
    let end = profile.last().unwrap()[0] + 1.0;
    let mut table = "position_mm,height_mm\n".to_owned();
    table += &format!("0,{}\n", profile[0][2]);
    for [place, _, after] in &profile {
        table += &format!("{place},{after}\n");
    }
    table += &format!("{end},{}\n", profile.last().unwrap()[2]);
    bench.write("left.csv", table);
    let left = |text: String| {
        let burr = "[workpiece.burr]\nkind = \"table\"\npath = \"left.csv\"\n[sensing]\n";
        text.replacen(END, burr, 1)
    };
    measured("after", &left, &NOTHING);

    diagnose_cases(&bench);
    let before = Planted {
        case: "before",
        ..PLANTED[7]
    };
    assert_eq!(before.name, "burr");
    holds(&bench, &before, 0);
    let after = Planted {
        case: "after",
        ..NOTHING
    };
    holds(&bench, &after, 0);
}

/// Seals that cell and belief both have.
const SEALS: Planted = Planted {
    case: "seals",
    edits: &[(
        DEVICE,
        "[device.override]\nseal_coulomb_force_n = 10\nseal_static_force_n = 10\nseal_viscous_coefficient_n_s_per_m = 60\n",
    )],
    ..NOTHING
};

/// Columns of a Parquet file, row by row; of one recording where it holds several.
pub fn columns<const N: usize>(file: &Path, recording: &str, names: [&str; N]) -> Vec<[f64; N]> {
    let reader = SerializedFileReader::new(File::open(file).unwrap()).unwrap();
    let number = |row: &Row, name: &str| {
        let mut fields = row.get_column_iter();
        match fields.find(|(column, _)| *column == name).unwrap().1 {
            Field::Double(value) => *value,
            _ => f64::NAN,
        }
    };
    let of_another = |row: &Row| {
        let named = |(column, field): (&String, &Field)| {
            column == "recording" && *field != Field::Str(recording.to_owned())
        };
        row.get_column_iter().any(named)
    };
    let rows = reader.get_row_iter(None).unwrap().map(Result::unwrap);
    rows.filter(|row| !of_another(row))
        .map(|row| names.map(|name| number(&row, name)))
        .collect()
}

/// A ball that is set down leaned is held by friction across the edge; seals keep what that did to the slide. Once the plant of the diagnosis had no such
/// friction: it stood 1.2 N off from the first touch on, and a soft joint was found in a cell that had none.
#[test]
fn rapier_and_the_plant_of_the_diagnosis_agree_on_a_leaned_tool_with_seals() {
    let bench = Bench::new("plate_edge_ideal");
    let asset = project(&format!("assets/{}", PLATE.part));
    std::fs::copy(asset, bench.path(PLATE.part)).unwrap();
    let done = |words: &[&str]| {
        let outcome = bench.idc(words, &[]);
        assert_eq!(outcome.code, 0, "{}", outcome.err);
    };
    for program in &PROGRAMS[1..3] {
        bench.write("run.toml", scenario(&PLATE, program, &SEALS));
        let folder = format!("runs/{}", program.0);
        done(&["run", "run.toml", "--out", &folder, "--quiet"]);
    }
    done(&[
        "diagnose",
        "runs",
        "--scenario",
        "run.toml",
        "--out",
        "out",
        "--quiet",
    ]);
    let truth = columns(
        &bench.path("runs/c/samples.parquet"),
        "c",
        ["time_s", "stroke_m", "measured_force_n"],
    );
    let compared = columns(
        &bench.path("out/comparison.parquet"),
        "c",
        [
            "time_s",
            "believed_stroke_m",
            "believed_force_n",
            "measured_force_n",
        ],
    );
    let (mut stroke, mut force) = (Vec::new(), Vec::new());
    for [time, nominal, force_n, measured] in compared {
        let near = truth.partition_point(|row| row[0] < time - 1e-6);
        stroke.push((nominal - truth[near][1]).abs() / 4e-5);
        if measured.is_finite() {
            force.push((force_n - measured) / 0.8);
        }
    }
    stroke.sort_by(f64::total_cmp);
    let stroke = stroke[stroke.len() * 9 / 10];
    let square = force.iter().map(|e| e * e).sum::<f64>() / force.len() as f64;
    assert!(
        force.len() > 500 && stroke < 0.5,
        "{} {stroke}",
        force.len()
    );
    assert!(square - 1.0 < 0.25, "{square}");
    let answer = std::fs::read_to_string(bench.path("out/diagnosis.json")).unwrap();
    let answer: Answer = serde_json::from_str(&answer).unwrap();
    assert_eq!(
        answer.verdict,
        Verdict::NothingMissing,
        "{:#?}",
        answer.effects
    );
}

#[test]
#[ignore = "minutes"]
fn everything_planted_in_the_plate_s_cell_is_named_placed_and_sized() {
    let bench = diagnosed(&PLATE, &PLANTED);
    for planted in &PLANTED {
        holds(&bench, planted, 0);
    }
}

#[test]
#[ignore = "minutes"]
fn everything_planted_in_the_bracket_s_cell_is_named_placed_and_sized() {
    let bench = diagnosed(&BRACKET, &PLANTED);
    for planted in &PLANTED {
        holds(&bench, planted, 1);
    }
}
