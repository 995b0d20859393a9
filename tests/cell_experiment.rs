//! `idc next` and `idc investigate` of a cell: the arm rides along the path of its recordings anew, as far and as fast as they went.

use std::path::Path;
use std::time::Duration;

use glam::DVec3;
use glamx::DPose3;
use idc_cell::arm::kinematics::link_poses;
use idc_cell::diagnosis::answer::Answer;
use idc_cell::plant::{PlantParameters, simulate};
use idc_cell::recording::csv::read_cell_csv;
use idc_cell::replay::LoadedCell;
use idc_cell::scenario::load_recorded_cell;

use crate::next_experiment::rig;
use crate::program::Bench;
use crate::recorded_cell::{CELL, Commands, PROGRAMS, carried_out, inputs, record, text};

/// A cell with an encoder that is off, and the recording of one ride.
fn begun(limits: &str) -> (Bench, LoadedCell, PlantParameters) {
    let bench = Bench::new("plate_edge_ideal");
    bench.write("cell.toml", format!("{CELL}{limits}"));
    let cell = LoadedCell::new(load_recorded_cell(&bench.path("cell.toml")).unwrap()).unwrap();
    let mut planted = cell.plant();
    planted.cell.encoder_offset[2] = 0.0003;
    record(&cell, &planted, &PROGRAMS[0], &bench.path("rides"));
    (bench, cell, planted)
}

/// Arguments of a command line.
fn words_of(line: &str) -> Vec<&str> {
    line.split(' ').collect()
}

/// Commands as a file has them.
fn commands(file: &Path, cell: &LoadedCell) -> Commands {
    let read = read_cell_csv(file, cell.joints.len()).unwrap();
    Commands {
        time: read.time,
        path: read.path,
        joints: read.commands,
        set_pressure: read.set_pressure,
    }
}

/// Largest speed [rad/s] and acceleration [rad/s2] of a joint, over 20 ms.
fn motion(time: &[f64], joint: &[f64]) -> [f64; 2] {
    let step = time[1] - time[0];
    let apart = (0.02 / step).round() as usize;
    let window = apart as f64 * step;
    let triples =
        (apart..joint.len() - apart).map(|at| [joint[at - apart], joint[at], joint[at + apart]]);
    triples.fold([0.0; 2], |[speed, acceleration], [a, b, c]| {
        [
            f64::max(speed, (c - a).abs() / (2.0 * window)),
            f64::max(acceleration, (c - 2.0 * b + a).abs() / (window * window)),
        ]
    })
}

/// By the samples of what is asked for: every posture is one of the recording, no joint is faster than there, and the cell as it truly is keeps the force.
#[test]
fn an_experiment_of_a_cell_stays_on_the_path_of_its_recordings() {
    let torques = "joint_torque_n_m = [900, 900, 900, 300, 300, 300]";
    let limits = format!(
        "\n[limits]\nforce_n = 300.0\nset_pressure_pa = 110000.0\nduration_s = 6\n{torques}\n"
    );
    let limits = limits.as_str();
    let (bench, cell, planted) = begun(limits);
    let words = words_of("next rides --scenario cell.toml --out next --programmes 16 --quiet");
    let done = bench.idc(&words, &[]);
    assert_eq!((done.code, done.out.as_str()), (0, ""), "{}", done.err);
    assert_eq!(
        bench.names_in("next"),
        [
            "cell.toml",
            "expected.svg",
            "inputs.csv",
            "instructions.txt",
            "next.json",
            "report.html"
        ]
    );
    let asked = commands(&bench.path("next/inputs.csv"), &cell);
    let (ride, _) = inputs(&cell, &planted, &PROGRAMS[0]);
    assert!(asked.time[asked.time.len() - 1] <= 6.0);
    for pressure in &asked.set_pressure {
        assert!((0.0..=110_000.0).contains(pressure), "{pressure}");
    }
    let mut moved = 0.0f64;
    for (asked_joint, joint) in asked.joints.iter().zip(&ride.joints) {
        let [speed, acceleration] = motion(&asked.time, asked_joint);
        let most = motion(&ride.time, joint);
        assert!(speed <= 1.02 * most[0] + 1e-6, "{speed} {most:?}");
        assert!(
            acceleration <= 1.1 * most[1] + 1e-3,
            "{acceleration} {most:?}"
        );
        moved = moved.max(speed);
    }
    for at in (0..asked.time.len()).step_by(25) {
        let away = (0..ride.time.len())
            .map(|other| {
                let pairs = asked.joints.iter().zip(&ride.joints);
                pairs
                    .map(|(a, b)| (a[at] - b[other]).abs())
                    .fold(0.0, f64::max)
            })
            .fold(f64::INFINITY, f64::min);
        assert!(away < 2e-3, "{away} at {}", asked.time[at]);
    }
    let force = simulate(&planted, &carried_out(&cell, &planted, &asked))
        .truth
        .contact_force;
    let force = force.into_iter().fold(0.0, f64::max);
    assert!(force <= 300.0, "{force}");
    let next = bench.path("next/next.json");
    let next: serde_json::Value =
        serde_json::from_str(&std::fs::read_to_string(next).unwrap()).unwrap();
    let share = next["largest_torque_share_percent"].as_f64().unwrap();
    assert!(share > 5.0 && share < 100.0, "{share}");
    let page = std::fs::read_to_string(bench.path("next/report.html")).unwrap();
    assert!(page.contains("of the torque that it may"), "{page}");
    let instructions = std::fs::read_to_string(bench.path("next/instructions.txt")).unwrap();
    assert!(instructions.contains("along the edge"), "{instructions}");
    assert!(!instructions.contains("valve"), "{instructions}");
    // Nothing that a cell has may be moved.
    let words = words_of("next rides --scenario cell.toml --out none --may solenoid --quiet");
    let refused = bench.idc(&words, &[]);
    assert_eq!(refused.code, 2);
    assert!(
        refused.err.contains("the arm is to be left alone"),
        "{}",
        refused.err
    );
}

/// Drives that may not even hold the arm, and one torque too few.
#[test]
fn torques_that_no_experiment_can_keep_are_said() {
    let (bench, ..) = begun("");
    for (torques, said) in [
        (
            "[1, 1, 1, 1, 1, 1]",
            "more than `joint_torque_n_m`, at least for",
        ),
        (
            "[900, 900]",
            "`limits.joint_torque_n_m` has 2 values, expected 6",
        ),
    ] {
        bench.write(
            "weak.toml",
            format!("{CELL}\n[limits]\njoint_torque_n_m = {torques}\n"),
        );
        let words = words_of("next rides --scenario weak.toml --out weak --programmes 4 --quiet");
        let refused = bench.idc(&words, &[]);
        assert_eq!(refused.code, 2);
        assert!(refused.err.contains(said), "{}", refused.err);
        assert!(!bench.path("weak/next.json").exists());
    }
}

/// A cell that has a job states its limits as one that was only recorded does; a run does not look at them.
#[test]
fn a_cell_with_a_job_has_limits_too() {
    let bench = Bench::new("plate_edge_ideal");
    let scenario = std::fs::read_to_string(bench.path("scenario.toml")).unwrap();
    let limits = "\n[limits]\njoint_speed_rad_per_s = 0.5\njoint_torque_n_m = [9, 9, 9, 3, 3, 3]\nforce_n = 250.0\n";
    bench.write("limited.toml", format!("{scenario}{limits}"));
    let read = load_recorded_cell(&bench.path("limited.toml")).unwrap();
    assert_eq!(read.limits.joint_motion, [Some(0.5), None]);
    assert_eq!(read.limits.force, Some(250.0));
    assert_eq!(read.limits.joint_torque.map(|own| own.len()), Some(6));
    let file = bench.path("limited.toml").display().to_string();
    let checked = bench.idc(&["check", &file], &[]);
    assert_eq!(checked.code, 0, "{}", checked.err);
}

/// A later recording of a cell is taken in by a diagnosis of the first, and the same comes of it as from the beginning; the next experiment of that diagnosis knows both.
#[test]
fn a_later_recording_of_a_cell_is_taken_in() {
    let (bench, cell, planted) = begun("");
    record(&cell, &planted, &PROGRAMS[1], &bench.path("later"));
    let diagnosed = |out: &str, with: &[&str]| {
        let words = [
            "diagnose",
            "rides",
            "--scenario",
            "cell.toml",
            "--out",
            out,
            "--quiet",
        ];
        let done = bench.idc(&[&words[..], with].concat(), &[]);
        assert_eq!(done.code, 0, "{}", done.err);
        let text = std::fs::read_to_string(bench.path(out).join("diagnosis.json")).unwrap();
        (done.err, serde_json::from_str::<Answer>(&text).unwrap())
    };
    let (_, first) = diagnosed("found", &[]);
    let with = ["--with-recording", "later/b.csv"];
    let (said, on) = diagnosed("found", &with);
    assert!(!said.contains("from the beginning"), "{said}");
    let (_, anew) = diagnosed("anew", &with);
    let stated = |answer: &Answer| -> Vec<(String, f64)> {
        let own = answer.effects.iter();
        own.map(|own| (own.name.clone(), own.confidence)).collect()
    };
    let [first_stated, on_stated, anew_stated] = [&first, &on, &anew].map(stated);
    // One ride does not show it, two do.
    assert_eq!(
        [first_stated.len(), on_stated.len()],
        [0, 1],
        "{first_stated:?} {on_stated:?}"
    );
    assert_eq!(on_stated.len(), anew_stated.len());
    for ((name, odds), (other, expected)) in on_stated.iter().zip(&anew_stated) {
        assert_eq!(name, other);
        assert!((odds - expected).abs() < 0.02, "{name}: {odds} {expected}");
    }
    let text = std::fs::read_to_string(bench.path("found/explanations.json")).unwrap();
    assert!(text.contains("later/b.csv"), "{text}");
    let few = words_of("next found --out next --programmes 2 --time 3s --quiet");
    let done = bench.idc(&few, &[]);
    assert_eq!(done.code, 0, "{}", done.err);
    assert!(!done.err.contains("from the beginning"), "{}", done.err);
    // A file that is none.
    let words =
        words_of("diagnose rides --scenario cell.toml --out none --with-recording nowhere.csv");
    let refused = bench.idc(&words, &[]);
    assert_eq!(refused.code, 2);
    assert!(refused.err.contains("nowhere.csv"), "{}", refused.err);
    assert!(!bench.path("none").exists());
}

/// A rig that this test is: it takes what its script is called with, and gives back what the planted cell records. On half of a ride an encoder that is off by so little
/// is one of the joints beside it too, whose axes are parallel: that is said, and nothing is asked for that would not tell.
#[test]
fn a_cell_is_asked_until_nothing_would_tell_more() {
    let (bench, cell, planted) = begun("");
    // Of the ride its first 1.2 s.
    let file = bench.path("rides/a.csv");
    let whole = std::fs::read_to_string(&file).unwrap();
    let (ride, _) = inputs(&cell, &planted, &PROGRAMS[0]);
    let rides = ride.path.windows(2).position(|two| two[1] > two[0]);
    let begun: Vec<&str> = whole.lines().take(rides.unwrap() + 300).collect();
    std::fs::write(&file, begun.join("\n") + "\n").unwrap();
    rig(
        &bench,
        "cp \"$1\" asked.part && mv asked.part asked.csv\nwhile [ ! -f answer.csv ]; do sleep 0.02; done\nmv answer.csv \"$2\"",
    );
    let words = words_of(
        "investigate rides --scenario cell.toml --rig ./rig.sh --programmes 24 --time 6s --until 0.98 --out out --quiet",
    );
    let (asked, answer) = (bench.path("asked.csv"), bench.path("answer.csv"));
    let done = std::thread::scope(|scope| {
        let program = scope.spawn(|| bench.idc(&words, &[]));
        let mut seed = 40;
        while !program.is_finished() {
            std::thread::sleep(Duration::from_millis(20));
            if !asked.is_file() {
                continue;
            }
            let made = commands(&asked, &cell);
            std::fs::remove_file(&asked).unwrap();
            let readings = simulate(&planted, &carried_out(&cell, &planted, &made)).readings;
            seed += 1;
            let recorded = text(
                &made,
                planted.cell.servo_bandwidth,
                Some(&readings[..3]),
                seed,
            );
            let part = bench.path("answer.part");
            std::fs::write(&part, recorded).unwrap();
            std::fs::rename(&part, &answer).unwrap();
        }
        program.join().unwrap()
    });
    assert_eq!(done.err, "");
    let record = std::fs::read_to_string(bench.path("out/investigation.json")).unwrap();
    let record: serde_json::Value = serde_json::from_str(&record).unwrap();
    assert_eq!(done.code, 1, "{record:#}");
    assert_eq!(record["stop"], "no allowed experiment would tell more");
    let odds = record["odds"].as_array().unwrap();
    let explanations = odds[odds.len() - 1]["explanations"].as_array().unwrap();
    assert_eq!(
        explanations[0]["effects"], "joint_encoder_offset (joint 3)",
        "{record:#}"
    );
    let left_open = record["left_open"].to_string();
    assert!(
        left_open.contains("joint_encoder_offset (joint 3)"),
        "{left_open}"
    );
    let asked = record["asked"].as_array().unwrap().len();
    assert_eq!((odds.len(), asked), (2, 1), "{record:#}");
    assert_eq!(bench.names_in("out/case"), ["a.csv", "run-1.csv"]);
    let ride = commands(&bench.path("out/run-1/inputs.csv"), &cell);
    assert!(
        ride.path.windows(2).any(|two| two[0] != two[1]),
        "{record:#}"
    );
}

/// Holding torques of an arm that rests and presses, by virtual work: what the drives give is the slope of the bodies' height and of the way of the point of contact
/// against the force on it, with friction in full.
#[test]
fn the_torque_that_a_ride_asks_for_is_that_of_virtual_work() {
    let (_bench, cell, planted) = begun("");
    let (ride, _) = inputs(&cell, &planted, &PROGRAMS[0]);
    let at = ride.time.len() / 2;
    let count = 5;
    let rests = Commands {
        time: (0..count).map(|i| 0.004 * f64::from(i)).collect(),
        path: vec![ride.path[at]; count as usize],
        joints: (ride.joints.iter())
            .map(|joint| vec![joint[at]; count as usize])
            .collect(),
        set_pressure: vec![1e5; count as usize],
    };
    let held = carried_out(&cell, &planted, &rests);
    let trajectory = held.cell.as_ref().unwrap();
    let (stroke, pressed, friction) = (0.02, 180.0, 3.0);
    let touched = (vec![stroke; count as usize], vec![pressed; count as usize]);
    let contact = &cell.tool_contacts(trajectory, &touched.0, &touched.1, 0.0)[2];
    let chain = &cell.chain;
    let base = cell.scenario.arm.world_from_base;
    let nominal = &cell.scenario.nominal;
    let q: Vec<f64> = rests.joints.iter().map(|joint| joint[0]).collect();
    let poses = |q: &[f64]| {
        let mut poses = vec![DPose3::IDENTITY; q.len()];
        link_poses(chain, base, q, &mut poses);
        poses
    };
    // Of the point of contact in the last link, from the posture of the sample.
    let last = poses(&q)[q.len() - 1];
    let centre = trajectory.ball[2] + trajectory.slide[2] * stroke;
    let point = last.inverse() * (centre + contact.from_centre);
    let slide = last.rotation.inverse() * trajectory.slide[2];
    let mass_at = last.inverse() * centre - slide * trajectory.mass_behind_ball;
    let work = |q: &[f64]| {
        let poses = poses(q);
        let weight = |mass: f64, at: DVec3| -mass * cell.scenario.gravity.dot(at);
        let bodies = chain.joints.iter().zip(&poses);
        let links: f64 = bodies
            .map(|(joint, pose)| weight(joint.body.mass, *pose * joint.body.centre_of_mass))
            .sum();
        let end = poses[poses.len() - 1];
        links + weight(nominal.device.moving_mass, end * mass_at) - contact.force.dot(end * point)
    };
    let step = 1e-6;
    for joint in 0..q.len() {
        let moved = |by: f64| {
            let mut moved = q.clone();
            moved[joint] += by;
            work(&moved)
        };
        let expected = ((moved(step) - moved(-step)) / (2.0 * step)).abs() + friction;
        let mut most = vec![1e12; q.len()];
        most[joint] = 50.0;
        let frictions = vec![friction; q.len()];
        let found =
            50.0 * cell.torque_share(trajectory, (&touched.0, &touched.1), &frictions, &most);
        assert!(
            (found / expected - 1.0).abs() < 1e-3,
            "joint {}: {found} {expected}",
            joint + 1
        );
    }
}
