//! `idc vary` and `idc task`: the same table whoever does the runs, nothing done twice, what cannot be is refused before anything is written.

use std::collections::BTreeMap;
use std::net::TcpListener;
use std::os::unix::fs::MetadataExt as _;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};

use idc_cell::recording::long_column::LongColumn;
use idc_cell::recording::long_table::read_long;
use serde_json::Value;

use crate::common::{project, skipped};
use crate::program::Bench;

/// A short stretch of the plate's edge.
fn plate() -> Bench {
    let bench = Bench::new("plate_edge_ideal");
    bench.replace("scenario.toml", "end_mm = 290", "end_mm = 30");
    bench
}

const FORCES: &str = "process.force_n=100,150";
const FEEDS: &str = "process.feed_mm_per_s=20..30:3";

fn vary(bench: &Bench, out: &str, more: &[&str]) -> crate::program::Outcome {
    let set = [
        "vary",
        "scenario.toml",
        "--set",
        FORCES,
        "--set",
        FEEDS,
        "--out",
        out,
    ];
    bench.idc(&[&set[..], more].concat(), &[])
}

fn columns(bench: &Bench, file: &str) -> BTreeMap<String, LongColumn> {
    read_long(&bench.path(file)).unwrap().into_iter().collect()
}

fn numbers(columns: &BTreeMap<String, LongColumn>, name: &str) -> Vec<f64> {
    match &columns[name] {
        LongColumn::Numbers(numbers) => numbers.clone(),
        LongColumn::Names(_) => panic!("{name} are names"),
    }
}

/// Inode of each result: another one was written anew.
fn results(bench: &Bench, out: &str) -> BTreeMap<PathBuf, u64> {
    let entries = std::fs::read_dir(bench.path(&format!("{out}/tasks"))).unwrap();
    let result = |entry: std::io::Result<std::fs::DirEntry>| {
        let path = entry.unwrap().path().join("result.json");
        let inode = std::fs::metadata(&path).unwrap().ino();
        (path, inode)
    };
    entries.map(result).collect()
}

#[test]
fn each_row_is_the_run_that_idc_run_makes_with_its_values() {
    let bench = plate();
    let outcome = vary(&bench, "out", &["--quiet"]);
    assert_eq!((outcome.code, outcome.err.as_str()), (0, ""));
    let table = columns(&bench, "out/runs.parquet");
    assert_eq!(
        numbers(&table, "process.force_n"),
        [100.0, 100.0, 100.0, 150.0, 150.0, 150.0]
    );
    assert_eq!(
        numbers(&table, "process.feed_mm_per_s")[..3],
        [20.0, 25.0, 30.0]
    );
    // Outside the bounds of the scenario's mean force, as 100 N are.
    assert_eq!(numbers(&table, "code"), [1.0, 1.0, 1.0, 0.0, 0.0, 0.0]);
    let set = [
        "--set",
        "process.force_n=150",
        "--set",
        "process.feed_mm_per_s=25",
    ];
    let run = [
        &[
            "run",
            "scenario.toml",
            "--out",
            "run",
            "--quiet",
            "--no-recording",
        ][..],
        &set,
    ]
    .concat();
    assert_eq!(bench.idc(&run, &[]).code, 0);
    let text = std::fs::read_to_string(bench.path("run/summary.json")).unwrap();
    let summary: Value = serde_json::from_str(&text).unwrap();
    let mut compared = 0;
    for (name, column) in &table {
        if let (LongColumn::Numbers(numbers), Some(value)) =
            (column, summary["summary"][name].as_f64())
        {
            assert_eq!(numbers[4], value, "{name}");
            compared += 1;
        }
    }
    assert!(compared > 20, "{compared}");
    // The mean force goes with the force alone.
    let text = std::fs::read_to_string(bench.path("out/vary.json")).unwrap();
    let document: Value = serde_json::from_str(&text).unwrap();
    assert_eq!(document["codes"]["1"], 3);
    let page = bench.idc(&["report", "out"], &[]);
    assert!(
        page.out.contains("page of the sweep"),
        "{}{}",
        page.out,
        page.err
    );
}

#[test]
fn existing_results_are_not_done_again_and_a_sweep_may_grow() {
    let bench = plate();
    assert_eq!(vary(&bench, "out", &["--quiet"]).code, 0);
    let before = results(&bench, "out");
    let table = std::fs::read(bench.path("out/runs.parquet")).unwrap();
    let again = vary(&bench, "out", &["--quiet"]);
    assert!(
        again.only_line("error").contains("--force"),
        "{}",
        again.err
    );
    // Two are lost, as of an engine that died.
    let lost: Vec<&PathBuf> = before.keys().take(2).collect();
    for path in &lost {
        std::fs::remove_dir_all(path.parent().unwrap()).unwrap();
    }
    assert_eq!(vary(&bench, "out", &["--quiet", "--resume"]).code, 0);
    let after = results(&bench, "out");
    assert!(
        before
            .iter()
            .all(|(path, inode)| lost.contains(&path) || after[path] == *inode)
    );
    assert!(std::fs::read(bench.path("out/runs.parquet")).unwrap() == table);
    let more = [
        "vary",
        "scenario.toml",
        "--set",
        "process.force_n=100,150,200",
        "--set",
        FEEDS,
    ];
    let more = [&more[..], &["--out", "out", "--resume", "--quiet"]].concat();
    assert_eq!(bench.idc(&more, &[]).code, 0);
    let grown = results(&bench, "out");
    assert_eq!(grown.len(), 9);
    assert!(after.iter().all(|(path, inode)| grown[path] == *inode));
    // A scenario that says something else is another content: all are done anew.
    bench.replace("scenario.toml", "end_mm = 30", "end_mm = 31");
    assert_eq!(vary(&bench, "out", &["--quiet", "--resume"]).code, 0);
    assert_eq!(results(&bench, "out").len(), 15);
}

#[test]
fn a_task_is_a_run_by_its_name_and_its_exit_code_is_a_result() {
    let bench = plate();
    let plan = vary(&bench, "out", &["--plan"]);
    assert_eq!(plan.out, "6 runs planned in out/plan.jsonl\n");
    let text = std::fs::read_to_string(bench.path("out/plan.jsonl")).unwrap();
    let ids: Vec<String> = (text.lines().skip(1))
        .map(|line| {
            serde_json::from_str::<Value>(line).unwrap()["id"]
                .as_str()
                .unwrap()
                .to_owned()
        })
        .collect();
    let codes: Vec<i32> = (ids.iter())
        .map(|id| bench.idc(&["task", "out/plan.jsonl", id], &[]).code)
        .collect();
    assert_eq!(codes, [1, 1, 1, 0, 0, 0]);
    let inodes = results(&bench, "out");
    assert_eq!(vary(&bench, "out", &["--resume", "--quiet"]).code, 0);
    assert_eq!(results(&bench, "out"), inodes);
    assert_eq!(vary(&bench, "other", &["--quiet", "--jobs", "1"]).code, 0);
    let table = |out: &str| std::fs::read(bench.path(&format!("{out}/runs.parquet"))).unwrap();
    assert!(table("out") == table("other"));
    // Of several the highest code; those that stand are left, the others done.
    for id in [&ids[1], &ids[4]] {
        std::fs::remove_dir_all(bench.path(&format!("out/tasks/{id}"))).unwrap();
    }
    let several = ["task", "out/plan.jsonl", &ids[4], &ids[3], &ids[1]];
    assert_eq!(bench.idc(&several, &[]).code, 1);
    assert_eq!(vary(&bench, "out", &["--resume", "--quiet"]).code, 0);
    assert!(table("out") == table("other"));
    let kept = results(&bench, "out").len();
    assert_eq!((kept, inodes.len()), (6, 6));
    let none = bench.idc(&["task", "out/plan.jsonl", "abc"], &[]);
    assert!(
        none.only_line("error").contains("has no task abc"),
        "{}",
        none.err
    );
    let device = std::fs::read_to_string(bench.path("device.toml")).unwrap();
    bench.write("device.toml", device + "\n# changed\n");
    std::fs::remove_dir_all(bench.path(&format!("out/tasks/{}", ids[0]))).unwrap();
    let changed = bench.idc(&["task", "out/plan.jsonl", &ids[0]], &[]);
    assert!(
        changed
            .only_line("error")
            .contains("has changed since the plan"),
        "{}",
        changed.err
    );
    let file = bench.idc(&["task", "out/plan.jsonl", "--export", "snakemake"], &[]);
    assert!(
        file.out.contains("rule task:") && file.out.contains("plan.jsonl"),
        "{}",
        file.out
    );
}

#[test]
fn what_cannot_be_is_refused_before_anything_is_written() {
    let bench = plate();
    bench.write("points.csv", "process.force_n\n");
    for (arguments, expected) in [
        (
            vec!["--set", "process.force=1,2"],
            "did you mean `process.force_n`?",
        ),
        (
            vec!["--set", "process.force_n=100..99999:3"],
            "process.force_n",
        ),
        (vec!["--set", "process.force_n=9..1"], "the range is empty"),
        (vec!["--set", "process.force_n=100.5..110.5"], "a..b:COUNT"),
        (vec!["--points", "points.csv"], "it has no points"),
        (
            vec!["--set", FORCES, "--engine", "ray"],
            "expected local, dask=local:N",
        ),
        (
            vec!["--set", FORCES, "--sample", "sobol:4"],
            "grid, random:N or latin:N",
        ),
        (vec!["--set", "device.model=gone.toml"], "gone.toml"),
    ] {
        let all = [&["vary", "scenario.toml", "--out", "out"][..], &arguments].concat();
        let outcome = bench.idc(&all, &[]);
        assert_eq!(outcome.code, 2, "{arguments:?}");
        assert!(
            outcome.err.contains(expected),
            "{arguments:?}: {}",
            outcome.err
        );
        assert!(!bench.path("out").exists(), "{arguments:?}");
    }
    // Keys that only go together, and a combination that cannot be run: a result.
    let edge = [
        "--set",
        "workpiece.edge.start_mm=10,40",
        "--set",
        "workpiece.edge.end_mm=30,60",
    ];
    let all = [
        &["vary", "scenario.toml", "--out", "out", "--quiet"][..],
        &edge,
    ]
    .concat();
    let outcome = bench.idc(&all, &[]);
    assert_eq!(outcome.code, 0, "{}", outcome.err);
    let table = columns(&bench, "out/runs.parquet");
    assert_eq!(numbers(&table, "code"), [0.0, 0.0, 2.0, 0.0]);
}

/// A Python with Dask and Snakemake: that of IDC_DASK_PYTHON, that which `.ci/install_references` has installed, or the one that is there.
fn python_with(module: &str) -> Option<PathBuf> {
    let named = std::env::var_os("IDC_DASK_PYTHON").map(PathBuf::from);
    let installed = project("build/references/engines/bin/python");
    let installed = installed.exists().then_some(installed);
    let python = named.or(installed).unwrap_or_else(|| "python3".into());
    let there = Command::new(&python)
        .args(["-c", &format!("import {module}")])
        .output();
    let there = there.is_ok_and(|output| output.status.success());
    if !there {
        skipped(&format!(
            "no {module} for {} (IDC_DASK_PYTHON names another)",
            python.display()
        ));
    }
    there.then_some(python)
}

#[test]
fn a_task_that_takes_its_program_with_it_costs_no_other_of_its_batch() {
    let Some(python) = python_with("distributed") else {
        return;
    };
    let bench = Bench::new("paper_step");
    let python = python.display().to_string();
    let words = ["vary", "scenario.toml", "--out", "out", "--quiet"];
    let words = [&words[..], &["--set", "bench.duration_s=8..9:40"]].concat();
    assert_eq!(bench.idc(&[&words[..], &["--plan"]].concat(), &[]).code, 0);
    let plan = std::fs::read_to_string(bench.path("out/plan.jsonl")).unwrap();
    let fatal: Value = serde_json::from_str(plan.lines().nth(30).unwrap()).unwrap();
    let fatal = fatal["id"].as_str().unwrap();
    let idc = env!("CARGO_BIN_EXE_idc");
    // Each call is kept: how many words it has, and whether it names the fatal task.
    let calls = bench.path("calls").display().to_string();
    let script = format!(
        "#!/bin/sh\ncase \"$*\" in task*{fatal}*) echo $# fatal >> {calls}; kill -9 $$;; task*) echo $# >> {calls};; esac\nexec {idc} \"$@\"\n"
    );
    bench.write("fatal", script);
    Command::new("chmod")
        .arg("+x")
        .arg(bench.path("fatal"))
        .status()
        .unwrap();
    let program = bench.path("fatal").display().to_string();
    let dask = ["--resume", "--engine", "dask=local:1", "--python", &python];
    let dask = [&words[..], &dask, &["--program", &program]].concat();
    let outcome = bench.idc(&dask, &[]);
    let message = outcome.only_line("error");
    assert!(
        message.contains("1 of 40 tasks came to no result"),
        "{message}"
    );
    assert!(message.contains("signal 9"), "{message}");
    assert_eq!(results(&bench, "out").len(), 39);
    let calls = std::fs::read_to_string(calls).unwrap();
    // In halves down to the one, which is tried three times; a batch has at most 64.
    let lost = calls.lines().filter(|call| call.ends_with("fatal"));
    let lost: Vec<&str> = lost.collect();
    assert!((3..=6 + 3).contains(&lost.len()), "{calls}");
    assert_eq!(lost.iter().filter(|call| **call == "3 fatal").count(), 3);
    // A large one is not done again task by task: fewer calls follow than it has tasks.
    let first = calls.lines().position(|call| call.ends_with("fatal"));
    let first = first.unwrap();
    let words = calls.lines().nth(first).unwrap().split(' ').next().unwrap();
    let tasks = words.parse::<usize>().unwrap() - 2;
    let after = calls.lines().count() - first - 1;
    assert!(tasks <= 16 || after < tasks, "{tasks} tasks: {calls}");
}

/// A scheduler and a worker, as docs/CLUSTER.md starts them; they end with this.
struct Cluster(Vec<Child>);

impl Drop for Cluster {
    fn drop(&mut self) {
        for child in &mut self.0 {
            child.kill().ok();
            child.wait().ok();
        }
    }
}

/// A cluster on a free port, with certificates or without, and the engine's name of it.
fn at_address(python: &Path, certificates: &[&str]) -> (Cluster, String) {
    // Free now; the scheduler takes it at once.
    let port = TcpListener::bind("127.0.0.1:0")
        .unwrap()
        .local_addr()
        .unwrap()
        .port();
    let protocol = ["tcp", "tls"][usize::from(!certificates.is_empty())];
    let address = format!("{protocol}://127.0.0.1:{port}");
    let start = |words: &[&str]| {
        let mut command = Command::new(python);
        command.args(["-m", "dask"]).args(words);
        command.args(["--protocol", protocol, "--host", "127.0.0.1"]);
        command.args(certificates);
        command.stdout(Stdio::null()).stderr(Stdio::null());
        command.spawn().unwrap()
    };
    let text = port.to_string();
    let scheduler = start(&[
        "scheduler",
        "--port",
        &text,
        "--dashboard-address",
        "127.0.0.1:0",
    ]);
    let worker = start(&[
        "worker",
        &address,
        "--nthreads",
        "1",
        "--no-nanny",
        "--dashboard-address",
        "127.0.0.1:0",
    ]);
    (Cluster(vec![scheduler, worker]), format!("dask={address}"))
}

#[test]
fn a_cluster_with_certificates_takes_tasks_of_those_alone_who_have_one() {
    let Some(python) = python_with("distributed") else {
        return;
    };
    let bench = plate();
    // As the page for clusters has it.
    let page = std::fs::read_to_string(project("docs/CLUSTER.md")).unwrap();
    let commands = page.lines().filter(|line| line.starts_with("    openssl "));
    let commands: Vec<&str> = commands.collect();
    assert_eq!(commands.len(), 3);
    let mut shell = Command::new("sh");
    shell.args(["-e", "-c", &commands.join("\n")]);
    shell.current_dir(bench.path("")).stderr(Stdio::null());
    match shell.status() {
        Ok(status) if status.success() => (),
        _ => return skipped("no openssl"),
    }
    let [ca, cert, key] = ["ca.pem", "dask.pem", "dask.key"].map(|name| bench.path(name));
    let [ca, cert, key] = [&ca, &cert, &key].map(|path| path.to_str().unwrap());
    let files = ["--tls-ca-file", ca, "--tls-cert", cert, "--tls-key", key];
    let (_cluster, address) = at_address(&python, &files);
    let words = [
        "vary",
        "scenario.toml",
        "--set",
        FORCES,
        "--quiet",
        "--engine",
        &address,
        "--python",
        python.to_str().unwrap(),
        "--out",
    ];
    let with = |out: &str, variables: &[(&str, &str)]| {
        bench.idc(&[&words[..], &[out]].concat(), variables)
    };
    let own = [
        ("DASK_DISTRIBUTED__COMM__TLS__CA_FILE", ca),
        ("DASK_DISTRIBUTED__COMM__TLS__CLIENT__CERT", cert),
        ("DASK_DISTRIBUTED__COMM__TLS__CLIENT__KEY", key),
    ];
    let done = with("closed", &own);
    assert_eq!((done.code, done.err.as_str()), (0, ""));
    let refused = with("none", &[]);
    assert_eq!(refused.code, 2);
    let message = refused.only_line("error");
    assert!(message.contains("no certificate here"), "{message}");
    // One of another's making.
    let make = format!(
        "openssl req -x509 -newkey rsa:2048 -nodes -subj /CN=other -keyout {key}.other -out {cert}.other"
    );
    let mut shell = Command::new("sh");
    assert!(
        shell
            .args(["-c", &make])
            .stderr(Stdio::null())
            .status()
            .unwrap()
            .success()
    );
    let [other_cert, other_key] = [cert, key].map(|name| format!("{name}.other"));
    let other = [
        own[0],
        (own[1].0, other_cert.as_str()),
        (own[2].0, other_key.as_str()),
    ];
    assert_eq!(with("other", &other).code, 2);
}

#[test]
fn dask_and_snakemake_make_the_same_table_with_and_without_a_shared_folder() {
    let bench = plate();
    assert_eq!(vary(&bench, "local", &["--quiet"]).code, 0);
    let table = |out: &str| std::fs::read(bench.path(&format!("{out}/runs.parquet"))).unwrap();
    if let Some(python) = python_with("distributed") {
        let python = python.display().to_string();
        let dask = ["--quiet", "--engine", "dask=local:2", "--python", &python];
        for (out, more) in [("dask", &[][..]), ("carried", &["--carry"][..])] {
            let outcome = vary(&bench, out, &[&dask[..], more].concat());
            assert_eq!((outcome.code, outcome.err.as_str()), (0, ""), "{out}");
            assert!(table(out) == table("local"), "{out}");
        }
        let gone = vary(
            &bench,
            "gone",
            &[&dask[..], &["--program", "/no/such/idc"]].concat(),
        );
        assert!(
            gone.only_line("error").contains("cannot run /no/such/idc"),
            "{}",
            gone.err
        );
        let old = bench.path("old");
        std::fs::write(&old, "#!/bin/sh\necho idc 0.0.1\n").unwrap();
        Command::new("chmod").arg("+x").arg(&old).status().unwrap();
        let other = vary(
            &bench,
            "old_out",
            &[&dask[..], &["--program", &old.display().to_string()]].concat(),
        );
        assert!(
            other
                .only_line("error")
                .contains("has `idc 0.0.1`, expected idc"),
            "{}",
            other.err
        );
    }
    if let Some(python) = python_with("distributed") {
        let (cluster, address) = at_address(&python, &[]);
        let python = python.display().to_string();
        let dask = ["--quiet", "--engine", &address, "--python", &python];
        let outcome = vary(&bench, "address", &dask);
        assert_eq!((outcome.code, outcome.err.as_str()), (0, ""));
        assert!(table("address") == table("local"));
        drop(cluster);
    }
    if let Some(python) = python_with("snakemake") {
        assert_eq!(vary(&bench, "snake", &["--plan", "--quiet"]).code, 0);
        let export = [
            "task",
            "snake/plan.jsonl",
            "--export",
            "snakemake",
            "--out",
            "Snakefile",
        ];
        assert_eq!(bench.idc(&export, &[]).code, 0);
        let run = [
            "-m",
            "snakemake",
            "--snakefile",
            "Snakefile",
            "--cores",
            "2",
            "--quiet",
            "all",
        ];
        let done = Command::new(python)
            .args(run)
            .current_dir(bench.path(""))
            .output()
            .unwrap();
        assert!(
            done.status.success(),
            "{}",
            String::from_utf8_lossy(&done.stderr)
        );
        let before = results(&bench, "snake");
        assert_eq!(vary(&bench, "snake", &["--resume", "--quiet"]).code, 0);
        assert_eq!(results(&bench, "snake"), before);
        assert!(table("snake") == table("local"));
    }
}

// Catches: a seed that does nothing reported to drive the force, a length between whole ends that has three values, bounds kept that nobody set.
#[test]
fn what_does_nothing_is_not_named_and_between_whole_ends_a_length_is_any_number() {
    let bench = plate();
    let text = std::fs::read_to_string(bench.path("scenario.toml")).unwrap();
    let unbounded = text.split("[expect]").next().unwrap();
    bench.write("scenario.toml", unbounded);
    let words = [
        "vary",
        "scenario.toml",
        "--out",
        "out",
        "--sample",
        "latin:40",
        "--set",
        "process.force_n=120..180",
        "--set",
        "workpiece.misplacement.shift_mm=-1..1",
        "--set",
        "simulation.seed=1..200",
    ];
    let outcome = bench.idc(&words, &[]);
    assert_eq!(outcome.code, 0, "{}", outcome.err);
    for said in [
        "40 runs, all to their end; the scenario sets no bounds.",
        "workpiece.misplacement.shift_mm",
        "any number between",
        "simulation.seed",
        "whole numbers",
        "driven by force 100 % (",
    ] {
        // What is long goes on below in its column of the table.
        let words: Vec<&str> = outcome.out.split_whitespace().collect();
        let is_whole = words.join(" ").contains(said);
        let in_column = said.split(' ').all(|word| words.contains(&word));
        assert!(is_whole || in_column, "{said}: {}", outcome.out);
    }
    assert!(!outcome.out.contains("driven by seed"), "{}", outcome.out);
    let table = columns(&bench, "out/runs.parquet");
    let shifts = numbers(&table, "workpiece.misplacement.shift_mm");
    assert!(
        shifts
            .iter()
            .all(|shift| shift.fract() != 0.0 && shift.abs() < 1.0)
    );
    assert!(
        numbers(&table, "simulation.seed")
            .iter()
            .all(|seed| seed.fract() == 0.0)
    );
    let grid = [
        "vary",
        "scenario.toml",
        "--out",
        "grid",
        "--set",
        "process.force_n=120..180",
    ];
    let refused = bench.idc(&grid, &[]);
    assert_eq!(refused.code, 2);
    assert!(
        refused.err.contains("process.force_n=a..b:COUNT"),
        "{}",
        refused.err
    );
}

/// A command that is suggested is one that a shell takes as it stands.
#[test]
fn suggested_commands_run_whatever_the_folder_is_called() {
    let bench = plate();
    let folder = bench.path("my cell's \"$HOME\"");
    std::fs::create_dir(&folder).unwrap();
    let paths = ["device.toml", "arm.urdf", "part.stl", "scenario.toml"];
    for name in paths.into_iter().filter(|name| bench.path(name).exists()) {
        std::fs::copy(bench.path(name), folder.join(name)).unwrap();
    }
    let file = folder.join("scenario.toml").display().to_string();
    let checked = bench.idc(&["check", &file], &[]);
    assert_eq!(checked.code, 0, "{}", checked.err);
    let next = checked
        .out
        .lines()
        .find_map(|line| line.strip_prefix("next: idc "))
        .unwrap();
    let reported = Command::new("sh")
        .args(["-c", &format!("printf '%s\\n' {next}")])
        .output()
        .unwrap();
    let words = String::from_utf8(reported.stdout).unwrap();
    assert_eq!(words.lines().collect::<Vec<_>>(), ["run", &file]);
}

/// What stands in a cell is seen in the picture of places, by name.
#[test]
fn the_picture_of_places_has_robot_obstacles_and_part() {
    let bench = plate();
    let text = std::fs::read_to_string(bench.path("scenario.toml")).unwrap();
    let rack = "\n[[obstacle]]\nname = \"tool rack\"\nbox_mm = [200, 200, 600]\nposition_mm = [300, 700, 300]\n";
    bench.write("scenario.toml", text + rack);
    let range = [
        "--x-mm",
        "700..800:2",
        "--y-mm",
        "0..500:2",
        "--out",
        "place.svg",
    ];
    let outcome = bench.idc(&[&["place", "scenario.toml"][..], &range].concat(), &[]);
    assert_eq!(outcome.code, 0, "{}", outcome.err);
    let svg = std::fs::read_to_string(bench.path("place.svg")).unwrap();
    for word in ["tool rack", "robot", "part now", "part, best", "reach: "] {
        assert!(svg.contains(word), "{word}");
    }
    // Obstacle, base, six links with device and tool, part twice.
    assert!(
        svg.matches("<polygon").count() >= 9,
        "{}",
        svg.matches("<polygon").count()
    );
}

/// Paths of what is read stay what they are: the plan leads to them from its own folder.
#[test]
fn a_plan_elsewhere_leads_to_the_same_files() {
    let bench = plate();
    let out = [
        "vary",
        "scenario.toml",
        "--set",
        FORCES,
        "--plan",
        "--quiet",
        "--out",
        "deep/below/out",
    ];
    assert_eq!(bench.idc(&out, &[]).code, 0);
    let text = std::fs::read_to_string(bench.path("deep/below/out/plan.jsonl")).unwrap();
    let head: Value = serde_json::from_str(text.lines().next().unwrap()).unwrap();
    for file in head["files"].as_array().unwrap() {
        let path = bench
            .path("deep/below/out")
            .join(file["file"].as_str().unwrap());
        assert!(path.is_file(), "{}", path.display());
    }
}
