//! `idc run --set`: a scenario with other values, once or for each combination of several.

use std::process::Command;

use serde_json::Value;

use crate::program::Bench;

/// A second on the load cell: short, and without an arm.
fn bench() -> Bench {
    let bench = Bench::new("paper_step");
    bench.write(
        "short.toml",
        r#"schema = 1
kind = "bench"
title = "Short"
[device]
ideal = true
model = "device.toml"
[bench]
duration_s = 1.5
[load]
kind = "load_cell"
position_mm = 20
[[command]]
at_s = 0.1 # soon
force_n = 100
[expect]
force_mean_n = { min = 50, max = 150 }
"#,
    );
    bench
}

fn json(bench: &Bench, file: &str) -> Value {
    serde_json::from_slice(&std::fs::read(bench.path(file)).unwrap()).unwrap()
}

/// SHA-256 by the system's own program.
fn hash(bench: &Bench, file: &str) -> String {
    let output = Command::new("sha256sum").arg(bench.path(file)).output();
    let text = String::from_utf8(output.unwrap().stdout).unwrap();
    text.split(' ').next().unwrap().to_owned()
}

#[test]
fn every_combination_is_run_in_order_as_if_the_file_said_so() {
    let bench = bench();
    let set = [
        "run",
        "short.toml",
        "--set",
        "command[0].force_n=60,100",
        "--set",
        "device.override.moving_mass_kg=3,4,5",
        "--out",
        "out",
        "--json",
    ];
    let outcome = bench.idc(&set, &[]);
    assert_eq!((outcome.code, outcome.err.as_str()), (0, ""));
    let runs: Vec<Value> = serde_json::from_str(&outcome.out).unwrap();
    let expected = [60.0, 100.0].map(|f| [3.0, 4.0, 5.0].map(|m| (f, m)));
    for (run, (force, mass)) in runs.iter().zip(expected.into_iter().flatten()) {
        let folder = format!("out/force_n={force},moving_mass_kg={mass}");
        assert_eq!(run["folder"], folder.as_str());
        assert_eq!(run["set"]["command[0].force_n"], force);
        // A bench at rest on its load cell gives what is asked for.
        let mean = run["summary"]["force_mean_n"].as_f64().unwrap();
        assert!((mean / force - 1.0).abs() < 0.01, "{mean} N at {force} N");
        // The file beside the results is what was run, by its hash, and runs again to the same.
        let copy = format!("{folder}/varied.toml");
        let source = &json(&bench, &format!("{folder}/summary.json"))["provenance"]["files"][0];
        assert_eq!(source["file"], copy.as_str());
        assert_eq!(source["sha256"], hash(&bench, &copy).as_str());
        let text = std::fs::read_to_string(bench.path(&copy)).unwrap();
        assert!(text.contains("at_s = 0.1 # soon"), "{text}");
    }
    assert_eq!(runs.len(), 6);
    assert!(bench.path("out/compare.html").is_file());
    let one = "out/force_n=60,moving_mass_kg=5";
    let again = bench.idc(
        &[
            "run",
            &format!("{one}/varied.toml"),
            "--out",
            "again",
            "--quiet",
        ],
        &[],
    );
    assert_eq!(again.code, 0, "{}", again.err);
    for file in ["samples.parquet", "figures.svg"] {
        let bytes = |folder: &str| std::fs::read(bench.path(&format!("{folder}/{file}"))).unwrap();
        assert!(bytes(one) == bytes("again"), "{file}");
    }
    // Nor does it matter how many are run at a time.
    let mut alone = set;
    alone[7] = "alone";
    assert_eq!(bench.idc(&alone, &[("RAYON_NUM_THREADS", "1")]).code, 0);
    for name in bench.names_in("out") {
        for file in ["samples.parquet", "recording.rrd"] {
            let bytes = |out: &str| std::fs::read(bench.path(out).join(&name).join(file)).ok();
            assert!(bytes("out") == bytes("alone"), "{name}/{file}");
        }
    }
}

#[test]
fn one_value_is_one_run_into_the_folder_itself() {
    let bench = bench();
    let outcome = bench.idc(
        &[
            "run",
            "short.toml",
            "--set",
            "title=Mine, or yours",
            "--out",
            "out",
        ],
        &[],
    );
    // A comma divides values; a text with one stands in quotes.
    assert_eq!(outcome.code, 0, "{}", outcome.err);
    assert!(bench.path("out/title=Mine/summary.json").is_file());
    let outcome = bench.idc(
        &[
            "run",
            "short.toml",
            "--set",
            "title=\"Mine, or yours\"",
            "--out",
            "one",
        ],
        &[],
    );
    assert_eq!(outcome.code, 0, "{}", outcome.err);
    assert_eq!(json(&bench, "one/summary.json")["title"], "Mine, or yours");
    assert!(bench.path("one/varied.toml").is_file() && !bench.path("one/compare.html").exists());
}

#[test]
fn the_worst_run_is_the_exit_code_and_the_table_says_which_it_is() {
    let bench = bench();
    let arguments = [
        "run",
        "short.toml",
        "--set",
        "command[0].force_n=100,200,120",
        "--out",
        "out",
    ];
    let outcome = bench.idc(&arguments, &[]);
    assert_eq!(outcome.code, 1);
    let line = outcome.only_line("force_n=200: outside its bounds: force_mean_n is 199.9");
    assert!(
        line.ends_with("expected at least 50 and at most 150"),
        "{line}"
    );
    let rows: Vec<&str> = outcome.out.lines().collect();
    let row = |start: &str| {
        rows.iter()
            .find(|row| row.trim_start().starts_with(start))
            .unwrap()
    };
    assert!(
        row("200 ").ends_with("OUTSIDE") && row("120 ").ends_with("kept"),
        "{rows:#?}"
    );
    assert!(
        rows.iter().all(|row| row.chars().count() <= 80),
        "{rows:#?}"
    );
}

#[test]
fn what_cannot_be_is_refused_before_anything_is_run() {
    let bench = bench();
    let before = bench.contents();
    for (sets, words) in [
        (
            &["command[0].force_n=100,nine"][..],
            &[
                "--set command[0].force_n=nine: short.toml: `command[0].force_n` is",
                "expected a number, in N",
            ][..],
        ),
        (
            &["command[0].force_n=100,-5"],
            &["--set command[0].force_n=-5: ", "is -5 N, expected 0 to"],
        ),
        (
            &["bench.duration=2"],
            &["unknown key `bench.duration`; did you mean `bench.duration_s`?"],
        ),
        (
            &["bore_mm=40"],
            &["unknown key `bore_mm`; did you mean `device.override.bore_mm`?"],
        ),
        (
            &["command[1].force_n=1"],
            &["`command` has 1, counted from 0"],
        ),
        (
            &["bench.duration_s.x=1"],
            &["`bench.duration_s` is no table"],
        ),
        (
            &["bench.duration_s=1", "bench.duration_s=2"],
            &["bench.duration_s is given twice"],
        ),
        (
            // Each is sound, both are not.
            &["bench.duration_s=0.05,2", "command[0].at_s=1"],
            &["--set", "short.toml"],
        ),
    ] {
        let mut arguments = vec!["run", "short.toml", "--out", "out"];
        for set in sets {
            arguments.extend(["--set", *set]);
        }
        let outcome = bench.idc(&arguments, &[]);
        assert_eq!((outcome.code, outcome.out.as_str()), (2, ""), "{sets:?}");
        let line = outcome.only_line("error: ");
        for words in words {
            assert!(line.contains(words), "{line}");
        }
        assert!(before == bench.contents(), "{sets:?}");
    }
    for set in ["force_n", "force_n=", "force_n=1,1"] {
        let outcome = bench.idc(&["run", "short.toml", "--set", set], &[]);
        assert_eq!(outcome.code, 2, "{set}");
        assert!(outcome.err.contains("expected"), "{}", outcome.err);
    }
}

#[test]
fn an_existing_run_is_kept_by_resume_if_it_is_the_same() {
    let bench = bench();
    let run = |values: &str, flag: &str| {
        let set = format!("command[0].force_n={values}");
        bench.idc(
            &["run", "short.toml", "--set", &set, "--out", "out", flag],
            &[],
        )
    };
    assert_eq!(run("60,80", "--quiet").code, 0);
    let modified = |force: u32| {
        let file = format!("out/force_n={force}/summary.json");
        std::fs::metadata(bench.path(&file))
            .unwrap()
            .modified()
            .unwrap()
    };
    let before = [modified(60), modified(80)];
    assert_eq!(run("60,80,90", "--quiet").code, 2);
    std::fs::remove_file(bench.path("out/force_n=80/samples.parquet")).unwrap();
    assert_eq!(run("60,80,90", "--resume").code, 0);
    assert_eq!(modified(60), before[0]);
    assert!(modified(80) > before[1] && bench.path("out/force_n=90/summary.json").is_file());
    // Another device is another run.
    bench.replace("short.toml", "at_s = 0.1", "at_s = 0.2");
    assert_eq!(run("60,80,90", "--resume").code, 0);
    assert!(modified(60) > before[0]);
}

/// Two hundred runs, begun; their folder is `out`.
#[cfg(unix)]
fn many_runs(bench: &Bench) -> std::process::Child {
    let values: Vec<String> = (50..250).map(|force| force.to_string()).collect();
    let set = format!("command[0].force_n={}", values.join(","));
    Command::new(env!("CARGO_BIN_EXE_idc"))
        .args([
            "run",
            "short.toml",
            "--set",
            &set,
            "--out",
            "out",
            "--quiet",
        ])
        .current_dir(bench.path(""))
        .stderr(std::process::Stdio::piped())
        .spawn()
        .unwrap()
}

#[cfg(unix)]
fn signal(child: &std::process::Child, name: &str) {
    let pid = child.id().to_string();
    assert!(
        Command::new("kill")
            .args([name, &pid])
            .status()
            .unwrap()
            .success()
    );
}

/// One whose terminal was gone waited for ever: the message could not be written, and the thread that was to end the program ended in its place.
#[cfg(unix)]
#[test]
fn an_interrupted_command_ends_where_nobody_reads_its_message() {
    use std::os::unix::process::ExitStatusExt as _;

    let bench = bench();
    let mut child = many_runs(&bench);
    drop(child.stderr.take());
    while std::fs::read_dir(bench.path("out")).map_or(0, Iterator::count) < 2 {
        std::thread::sleep(std::time::Duration::from_millis(5));
    }
    signal(&child, "-TERM");
    for _ in 0..1000 {
        if let Some(status) = child.try_wait().unwrap() {
            assert_eq!(status.signal(), Some(15));
            return;
        }
        std::thread::sleep(std::time::Duration::from_millis(10));
    }
    child.kill().unwrap();
    panic!("it has not ended");
}

/// Nothing half written remains, what is whole does, and a message says so.
#[cfg(unix)]
#[test]
fn an_interrupted_command_keeps_what_is_whole_and_says_so() {
    use std::os::unix::process::ExitStatusExt as _;

    let bench = bench();
    let child = many_runs(&bench);
    let whole = || {
        let folders = std::fs::read_dir(bench.path("out")).into_iter().flatten();
        let whole = |entry: &std::fs::DirEntry| entry.path().join("summary.json").is_file();
        folders
            .filter(|entry| whole(entry.as_ref().unwrap()))
            .count()
    };
    while whole() < 3 {
        std::thread::sleep(std::time::Duration::from_millis(5));
    }
    signal(&child, "-INT");
    let output = child.wait_with_output().unwrap();
    assert_eq!(output.status.signal(), Some(2), "130 in a shell");
    let reported = String::from_utf8(output.stderr).unwrap();
    let line = reported
        .lines()
        .find(|line| line.starts_with("interrupted: "))
        .unwrap();
    assert!(
        line.ends_with(
            "of 200 runs are done and kept in out; the same command with --resume does the others"
        ),
        "{line}"
    );
    let count: usize = line.split(' ').nth(1).unwrap().parse().unwrap();
    // One may have come into its place without having been counted.
    assert!(
        (count..=count + 2).contains(&whole()) && whole() < 200,
        "{line}"
    );
    for name in bench.names_in("out") {
        let files = bench.names_in(&format!("out/{name}"));
        assert!(
            files.contains(&"samples.parquet".to_owned()),
            "{name}: {files:?}"
        );
        assert!(
            !files.iter().any(|file| file.starts_with(".unfinished")),
            "{files:?}"
        );
    }
}
