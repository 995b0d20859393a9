//! Logs of an arm with clocks that start again, stamps that repeat, and joints of another arm.

use std::fmt::Write as _;

use super::{JOINTS, Sample, diagnosed, done, logged};

/// Lines of a log by the joints' names, with these times.
fn log(joints: &[&str], rows: &[(f64, &Sample)]) -> String {
    let of = |what: &str| {
        joints
            .iter()
            .map(|joint| format!(",{joint} {what}"))
            .collect::<String>()
    };
    let mut text = format!("t [s]{}{}\n", of("position [rad]"), of("current [A]"));
    for (time, sample) in rows {
        let values = sample.angles.iter().chain(&sample.currents);
        let values: Vec<String> = values.map(f64::to_string).collect();
        let _ = writeln!(text, "{time},{}", values.join(","));
    }
    text
}

#[test]
fn a_clock_that_starts_again_makes_two_recordings_and_stamps_that_repeat_are_left_out() {
    let (bench, samples) = logged();
    let half = samples.len() / 2;
    let again = |row: usize| samples[row].time - if row < half { 0.0 } else { samples[half].time };
    let rows: Vec<(f64, &Sample)> = (0..samples.len())
        .map(|row| (again(row), &samples[row]))
        .collect();
    bench.write("log.csv", log(&JOINTS, &rows));
    done(&bench.idc(&["new", "import", "map.toml", "--from", "log.csv"], &[]));
    let refused = bench.idc(&["import", "map.toml", "log.csv", "--out", "one.csv"], &[]);
    assert_eq!(refused.code, 2, "{}", refused.out);
    let line = refused.only_line("error");
    let dropped = format!("`drop_first_rows = {half}`");
    for word in ["log.csv:402", "starts again", "--split", &dropped] {
        assert!(line.contains(word), "{word}: {line}");
    }
    let arguments = [
        "import",
        "map.toml",
        "log.csv",
        "--split",
        "--out",
        "arm/recording.csv",
    ];
    done(&bench.idc(&arguments, &[]));
    assert_eq!(
        bench.names_in("arm"),
        ["recording-1.csv", "recording-2.csv"]
    );
    let lines = |file: &str| {
        std::fs::read_to_string(bench.path(file))
            .unwrap()
            .lines()
            .count()
    };
    assert_eq!(lines("arm/recording-1.csv"), half + 1);
    assert_eq!(lines("arm/recording-2.csv"), half + 1);
    // A stamp that stands twice, in one line of twenty.
    let doubled = (0..samples.len())
        .flat_map(|row| vec![(samples[row].time, &samples[row]); 1 + usize::from(row % 20 == 0)]);
    bench.write("twice.csv", log(&JOINTS, &doubled.collect::<Vec<_>>()));
    let arguments = [
        "import",
        "map.toml",
        "twice.csv",
        "--out",
        "twice/recording.csv",
    ];
    let imported = bench.idc(&arguments, &[]);
    done(&imported);
    assert!(
        imported
            .words()
            .contains("repeat the one before them were left out: 40"),
        "{}",
        imported.out
    );
    assert_eq!(lines("twice/recording.csv"), samples.len() + 1);
    diagnosed(&bench, "twice", "recording.csv");
}

#[test]
fn joints_that_the_urdf_does_not_have_are_refused_with_those_that_it_has() {
    let (bench, samples) = logged();
    let rows: Vec<(f64, &Sample)> = samples.iter().map(|sample| (sample.time, sample)).collect();
    let mut others = JOINTS;
    others[3] = "trunk";
    bench.write("log.csv", log(&others, &rows));
    done(&bench.idc(&["new", "import", "map.toml", "--from", "log.csv"], &[]));
    done(&bench.idc(
        &[
            "import",
            "map.toml",
            "log.csv",
            "--out",
            "arm/recording.csv",
        ],
        &[],
    ));
    bench.write(
        "arm/six.urdf",
        std::fs::read(bench.path("six.urdf")).unwrap(),
    );
    let arguments = [
        "new",
        "arm",
        "arm/arm.toml",
        "--urdf",
        "arm/six.urdf",
        "--log",
        "arm/recording.csv",
    ];
    done(&bench.idc(&arguments, &[]));
    let refused = bench.idc(&["diagnose", "arm", "--out", "found"], &[]);
    assert_eq!(refused.code, 2, "{}", refused.out);
    let line = refused.only_line("error");
    for word in [
        "arm/recording.csv",
        "joint_4_rad",
        "`trunk_encoder_rad`",
        "waist, shoulder, elbow, forearm",
    ] {
        assert!(line.contains(word), "{word}: {line}");
    }
    assert!(!bench.path("found").exists());
}
