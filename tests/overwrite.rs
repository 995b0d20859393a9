//! Results that stand are not touched without `--force`, whichever command would write; outputs that cannot be are refused by one sentence.

use crate::common::project;
use crate::program::Bench;

/// A folder with a job, a study, a rig with a recording, a log with its map and a case.
fn folder() -> Bench {
    let bench = Bench::new("paper_step");
    let copy = |from: &str, to: &str| {
        let to = bench.path(to);
        std::fs::create_dir_all(to.parent().unwrap()).unwrap();
        std::fs::copy(project(from), to).unwrap();
    };
    for name in ["device_design", "landing", "moved_surface", "wavy_edge"] {
        let text = std::fs::read_to_string(project(&format!("scenarios/studies/{name}.toml")));
        let text = text
            .unwrap()
            .replace("../../models/device.toml", "device.toml");
        bench.write(&format!("{name}.toml"), text);
    }
    for name in [
        "rig.toml",
        "stairs.csv",
        "ride.csv",
        "cycle.csv",
        "predict.csv",
    ] {
        copy(
            &format!("assets/proof/cases/case-03/{name}"),
            &format!("cases/case-03/{name}"),
        );
    }
    for name in ["case-03.json", "case-03.predict.csv"] {
        copy(
            &format!("assets/proof/sealed/{name}"),
            &format!("sealed/{name}"),
        );
    }
    copy("assets/first/map.toml", "map.toml");
    copy("assets/first/ride.csv", "ride.csv");
    bench
}

/// Commands that write, each to `out`, with a file of it.
const COMMANDS: [(&str, &str); 10] = [
    ("run scenario.toml --quiet", "out/summary.json"),
    (
        "design device_design.toml --evaluations 10 --quiet",
        "out/design.json",
    ),
    (
        "predict cases/case-03/rig.toml cases/case-03/ride.csv --quiet",
        "out",
    ),
    ("import map.toml ride.csv --quiet", "out/ride.parquet"),
    (
        "diagnose cases/case-03 --quiet --effort 1",
        "out/diagnosis.json",
    ),
    ("prove --cases cases --json", "out/case-03/diagnosis.json"),
    (
        "prove --sweep --effects force_sensor_gain_error --sizes 1 --seeds 1 --empty 0 --duration-s 2 --quiet",
        "out/CONFUSION.md",
    ),
    ("new rig --quiet", "out"),
    ("man", "out/idc.1"),
    ("laboratory --quiet", "out/cases/case-01/rig.toml"),
];

#[test]
fn results_that_stand_are_kept_without_force() {
    for (command, file) in COMMANDS {
        let bench = folder();
        let words: Vec<&str> = command.split(' ').chain(["--out", "out"]).collect();
        let first = bench.idc(&words, &[]);
        assert_eq!(first.code, 0, "{command}: {}", first.err);
        assert!(bench.path(file).is_file(), "{command}");
        let before = bench.contents();
        let again = bench.idc(&words, &[]);
        let reported = again.err.clone();
        assert_eq!(again.code, 2, "{command}: {reported}");
        assert!(
            reported.contains("--force") && reported.contains("out"),
            "{reported}"
        );
        assert!(before == bench.contents(), "{command} touched what stands");
        // What was there is replaced.
        bench.write(file, "stale");
        let forced = bench.idc(&[&words[..], &["--force"]].concat(), &[]);
        assert_eq!(forced.code, 0, "{command}: {}", forced.err);
        assert_ne!(
            std::fs::read(bench.path(file)).unwrap(),
            b"stale",
            "{command}"
        );
    }
}

#[test]
fn a_place_that_cannot_be_written_is_refused_and_nothing_is_done() {
    for (command, _) in COMMANDS {
        for place in ["scenario.toml/deep", "/proc/nowhere/deep"] {
            let bench = folder();
            let before = bench.contents();
            let words: Vec<&str> = command.split(' ').chain(["--out", place]).collect();
            let outcome = bench.idc(&words, &[]);
            assert_eq!(outcome.code, 2, "{command} --out {place}: {}", outcome.err);
            assert_eq!(outcome.err.trim_end().lines().count(), 1, "{}", outcome.err);
            assert!(outcome.err.contains(place), "{command}: {}", outcome.err);
            assert!(before == bench.contents(), "{command}");
        }
    }
}

#[test]
fn a_diagnosis_does_not_take_the_place_of_a_run() {
    let bench = folder();
    assert_eq!(bench.run().code, 0);
    let before = bench.contents();
    let outcome = bench.idc(&["diagnose", "cases/case-03", "--out", "out"], &[]);
    let line = outcome.only_line("error: ");
    assert!(
        line.contains("out holds results already (report.html)"),
        "{line}"
    );
    assert!(outcome.code == 2 && before == bench.contents());
}

#[test]
fn a_run_replaces_all_files_of_another() {
    let bench = Bench::new("paper_step");
    assert_eq!(bench.run().code, 0);
    assert!(bench.path("out/figures.svg").is_file());
    std::fs::copy(
        project("scenarios/plate_edge.toml"),
        bench.path("scenario.toml"),
    )
    .unwrap();
    bench.replace("scenario.toml", "../models/arm/arm10.urdf", "arm.urdf");
    bench.replace("scenario.toml", "../models/device.toml", "device.toml");
    bench.replace("scenario.toml", "../assets/plate.stl", "part.stl");
    let outcome = bench.run();
    assert_eq!(outcome.code, 0, "{}", outcome.err);
    assert!(
        !bench.path("out/figures.svg").exists(),
        "that of the other run"
    );
}

#[test]
fn a_run_without_its_recording_leaves_none_of_an_earlier_one() {
    for scenario in ["paper_step", "plate_edge"] {
        let bench = Bench::new(scenario);
        assert_eq!(bench.run().code, 0);
        assert!(bench.path("out/recording.rrd").is_file());
        let summary = std::fs::read(bench.path("out/samples.parquet")).unwrap();
        let words = ["run", "scenario.toml", "--out", "out", "--force"];
        let outcome = bench.idc(&[&words[..], &["--no-recording"]].concat(), &[]);
        assert_eq!(outcome.code, 0, "{}", outcome.err);
        assert!(!outcome.out.contains("recording.rrd"), "{}", outcome.out);
        assert!(!bench.path("out/recording.rrd").exists());
        let same = std::fs::read(bench.path("out/samples.parquet")).unwrap();
        assert!(same == summary && bench.path("out/report.html").is_file());
    }
}
