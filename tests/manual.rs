//! Completions and manual pages are made, and shells and man take them; `idc check` and `--json` tell programs what they tell people.

use std::io::Write as _;
use std::process::{Command, Stdio};

use clap::CommandFactory as _;
use idc_cell::app::Cli;
use serde_json::Value;

use crate::common::{project, skipped};
use crate::program::Bench;

/// Gives a program a text, and says whether it took it and what it made of it; nothing where there is no such program.
fn fed(program: &str, arguments: &[&str], text: &str) -> Option<(bool, String)> {
    let mut child = Command::new(program)
        .args(arguments)
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .ok()?;
    child
        .stdin
        .take()
        .unwrap()
        .write_all(text.as_bytes())
        .unwrap();
    let output = child.wait_with_output().unwrap();
    let said =
        [output.stdout, output.stderr].map(|bytes| String::from_utf8_lossy(&bytes).into_owned());
    Some((output.status.success(), said.concat()))
}

#[test]
fn shells_take_the_completions() {
    let bench = Bench::new("plate_edge_ideal");
    let names: Vec<String> = (Cli::command().get_subcommands())
        .map(|command| command.get_name().to_owned())
        .collect();
    for (shell, check) in [
        ("bash", Some("-n")),
        ("zsh", Some("-n")),
        ("fish", Some("--no-execute")),
        ("elvish", None),
        ("powershell", None),
    ] {
        let outcome = bench.idc(&["completions", shell], &[]);
        assert_eq!((outcome.code, outcome.err.as_str()), (0, ""), "{shell}");
        for name in &names {
            assert!(
                outcome.out.contains(name.as_str()),
                "{shell} knows no {name}"
            );
        }
        match check.map(|flag| fed(shell, &[flag], &outcome.out)) {
            Some(Some((well, said))) => assert!(well && said.is_empty(), "{shell}: {said}"),
            Some(None) => skipped(&format!("there is no {shell}")),
            None => {}
        }
    }
    // What is typed is completed.
    let script = bench.idc(&["completions", "bash"], &[]).out;
    let asked =
        "\nCOMP_WORDS=(idc diag); COMP_CWORD=1; _idc idc diag idc; echo \"${COMPREPLY[*]}\"\n";
    if let Some((well, said)) = fed("bash", &[], &(script + asked)) {
        assert!(well, "{said}");
        assert_eq!(said.trim(), "diagnose");
    }
}

#[test]
fn every_command_has_a_page_that_man_renders() {
    let bench = Bench::new("plate_edge_ideal");
    let outcome = bench.idc(&["man", "--out", "pages"], &[]);
    assert_eq!((outcome.code, outcome.err.as_str()), (0, ""));
    let count = Cli::command()
        .get_subcommands()
        .filter(|c| c.get_name() != "help")
        .map(|c| 1 + c.get_subcommands().count())
        .sum::<usize>()
        + 1;
    let pages = bench.names_in("pages");
    assert_eq!(pages.len(), count, "{pages:?}");
    let main = bench.idc(&["man"], &[]).out;
    assert_eq!(
        main,
        std::fs::read_to_string(bench.path("pages/idc.1")).unwrap()
    );
    for words in ["Exit codes", "bad input", "idc\\-diagnose(1)"] {
        assert!(main.contains(words), "the page lacks {words:?}");
    }
    for page in &pages {
        let text = std::fs::read_to_string(bench.path("pages").join(page)).unwrap();
        let Some((well, said)) = fed("groff", &["-man", "-ww", "-Tascii"], &text) else {
            skipped("there is no groff");
            return;
        };
        assert!(well && said.contains("Examples:"), "{page}: {said}");
    }
}

#[test]
fn a_check_says_what_would_be_done() {
    let check = |file: &str| {
        let bench = Bench::new("plate_edge_ideal");
        let file = project(file).display().to_string();
        let outcome = bench.idc(&["check", &file, "--json"], &[]);
        assert_eq!((outcome.code, outcome.err.as_str()), (0, ""), "{file}");
        let text = bench.idc(&["check", &file], &[]).out;
        assert!(text.contains("\nnext: "), "{text}");
        serde_json::from_str::<Value>(&outcome.out).unwrap()
    };
    let cell = check("scenarios/plate_edge.toml");
    let numbers = &cell["numbers"];
    let near = |name: &str, expected: f64| {
        let value = numbers[name].as_f64().unwrap();
        assert!((value / expected - 1.0).abs() < 1e-9, "{name} {value}");
    };
    near("edge_length_mm", 280.0);
    near("force_n", 150.0);
    near("feed_mm_per_s", 20.0);
    // What it says of a run is what the run does.
    let bench = Bench::new("plate_edge_ideal");
    bench.run();
    assert_eq!(
        numbers["samples"].as_f64(),
        bench.summary()["samples"].as_f64()
    );
    let written: u64 = ["recording.rrd", "samples.parquet", "summary.json"]
        .map(|name| {
            std::fs::metadata(bench.path("out").join(name))
                .unwrap()
                .len()
        })
        .iter()
        .sum();
    let ratio = numbers["estimated_bytes"].as_f64().unwrap() / written as f64;
    assert!((0.7..1.4).contains(&ratio), "{ratio} of what was written");
    // A bench has a sample at its start and one at its end: idc check counted one too few.
    let bench = Bench::new("paper_step");
    bench.run();
    let reported = &check("scenarios/paper_step.toml")["numbers"]["samples"];
    assert_eq!(reported.as_f64(), bench.summary()["samples"].as_f64());
    for (file, kind) in [
        ("scenarios/paper_step.toml", "a bench to simulate"),
        ("scenarios/studies/device_design.toml", "a design study"),
        ("assets/rigs/emps.toml", "a rig file"),
        ("assets/import/contact_flange.toml", "an import map"),
        ("assets/proof/cases/case-03", "a case to diagnose"),
        ("models/device.toml", "a device model"),
    ] {
        let reported = check(file);
        assert!(
            reported["kind"].as_str().unwrap().starts_with(kind),
            "{reported}"
        );
    }
    for (file, says) in [
        ("weak_supply.toml", "400 N, which needs 2.31 bar"),
        ("README.md", "expected a scenario, a rig file"),
    ] {
        let file = project(&format!("scenarios/{file}")).display().to_string();
        let outcome = bench.idc(&["check", &file], &[]);
        assert_eq!((outcome.code, outcome.out.as_str()), (2, ""));
        assert!(
            outcome.only_line("error: ").contains(says),
            "{}",
            outcome.err
        );
    }
}

/// Results as JSON are one document on standard output, with nothing beside it.
#[test]
fn every_command_with_results_has_them_as_json() {
    let bench = Bench::new("paper_step");
    let case = project("assets/proof/cases/case-03").display().to_string();
    let [rig, ride] = ["rig.toml", "ride.csv"].map(|name| format!("{case}/{name}"));
    let [map, log] = ["map.toml", "ride.csv"].map(|name| {
        project(&format!("assets/first/{name}"))
            .display()
            .to_string()
    });
    let edges = project("assets/plate.stl").display().to_string();
    for (arguments, key) in [
        (vec!["run", "scenario.toml", "--out", "run"], "summary"),
        (vec!["edges", &edges], "edges"),
        (vec!["check", "scenario.toml"], "kind"),
        (vec!["new", "import", "map.toml"], "written"),
        (vec!["import", &map, &log], "recordings"),
        (vec!["predict", &rig, &ride, "--out", "p.csv"], "samples"),
        (vec!["laboratory", "--out", "lab"], "cases"),
        (
            vec![
                "prove",
                "--sweep",
                "--out",
                "s",
                "--effects",
                "hose_volume",
                "--seeds",
                "0",
                "--empty",
                "0",
            ],
            "",
        ),
    ] {
        let outcome = bench.idc(&[&arguments[..], &["--json"]].concat(), &[]);
        assert_eq!(
            (outcome.code, outcome.err.as_str()),
            (0, ""),
            "{arguments:?}"
        );
        let reported: Value = serde_json::from_str(&outcome.out).unwrap();
        assert!(
            key.is_empty() || !reported[key].is_null(),
            "{arguments:?}: {reported}"
        );
    }
    // All others have the flag, but those whose result is a text for another program.
    for command in Cli::command().get_subcommands() {
        // A task leaves files, for an engine.
        let texts = ["completions", "man", "schema", "help", "view", "task"];
        let has_json = |command: &clap::Command| {
            let mut arguments = command.get_arguments();
            arguments.any(|argument| argument.get_id() == "json")
        };
        let mut parts = command.get_subcommands().peekable();
        let has = has_json(command) || (parts.peek().is_some() && parts.all(has_json));
        assert!(
            has || texts.contains(&command.get_name()),
            "{} has no --json",
            command.get_name()
        );
    }
}
