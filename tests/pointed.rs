//! Errors point into the file: the line, with a caret below what is meant; as JSON where JSON is asked for. Colours only where somebody sees them.

use crate::common::skipped;
use crate::program::{Bench, Outcome};

fn spoiled(from: &str, to: &str) -> Outcome {
    let bench = Bench::new("plate_edge_ideal");
    bench.replace("scenario.toml", from, to);
    bench.run()
}

/// Text below the sentence.
fn shown(outcome: &Outcome) -> String {
    let (_, below) = outcome.err.split_once('\n').unwrap();
    below.trim_end().to_owned()
}

#[test]
fn what_is_wrong_is_shown_in_its_line() {
    for (from, to, expected) in [
        // An unknown key: the key.
        (
            "force_n = 150",
            "froce_n = 150",
            "  --> scenario.toml:28:1\n   |\n28 | froce_n = 150\n   | ^^^^^^^",
        ),
        // A value out of range: key and value.
        (
            "force_n = 150",
            "force_n = -150  # too little",
            "  --> scenario.toml:28:1\n   |\n28 | force_n = -150  # too little\n   | ^^^^^^^^^^^^^^",
        ),
        // A value of another type, behind a letter of two bytes: the value.
        (
            "force_mean_n = { min = 148.5, max = 151.5 }",
            "\"\u{e9}\" = { max = \"\u{fc}\" }",
            "  --> scenario.toml:33:15\n   |\n33 | \"\u{e9}\" = { max = \"\u{fc}\" }\n   |               ^^^",
        ),
        // No TOML: where it ends to be some.
        (
            "force_n = 150",
            "force_n = = 150",
            "  --> scenario.toml:28:11\n   |\n28 | force_n = = 150\n   |           ^",
        ),
        // A key that is absent: the table that lacks it.
        (
            "force_n = 150\n",
            "",
            "  --> scenario.toml:27:1\n   |\n27 | [process]\n   | ^^^^^^^^^",
        ),
        // An edge that the part does not have, and a bound on no metric: what only the whole job can tell.
        (
            "edge = 1 ",
            "edge = 99 ",
            "  --> scenario.toml:23:1\n   |\n23 | edge = 99            # long top edge at part y = 0, see `idc edges assets/plate.stl`\n   | ^^^^^^^^^",
        ),
        (
            "force_mean_n =",
            "froce_mean_n =",
            "  --> scenario.toml:33:1\n   |\n33 | froce_mean_n = { min = 148.5, max = 151.5 }\n   | ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^",
        ),
    ] {
        let outcome = spoiled(from, to);
        outcome.only_line("error: ");
        assert_eq!(outcome.code, 2);
        assert_eq!(shown(&outcome), expected, "{}", outcome.err);
    }
}

#[test]
fn a_rig_file_a_map_and_a_study_are_shown_as_well() {
    let bench = Bench::new("plate_edge_ideal");
    for (kind, from, to, line) in [
        ("rig", "bore_m = 0.0211", "bore_m = 21.1", "bore_m = 21.1"),
        ("rig", "rod_m", "rodd_m", "rodd_m"),
        (
            "import",
            "unit = \"mm\"",
            "unit = \"bar\"",
            "unit = \"bar\"",
        ),
    ] {
        bench.idc(&["new", kind, "file.toml", "--force", "--quiet"], &[]);
        bench.replace("file.toml", from, to);
        let outcome = bench.idc(&["check", "file.toml"], &[]);
        outcome.only_line("error: ");
        let carets = format!("| {}\n", "^".repeat(line.len()));
        assert!(outcome.err.contains(&carets), "{}", outcome.err);
    }
}

#[test]
fn an_error_is_json_where_json_is_asked_for() {
    let bench = Bench::new("plate_edge_ideal");
    bench.replace("scenario.toml", "force_n = 150", "force_n = -150");
    let outcome = bench.idc(&["run", "scenario.toml", "--json"], &[]);
    assert_eq!((outcome.code, outcome.out.as_str()), (2, ""));
    let reported: serde_json::Value = serde_json::from_str(&outcome.err).unwrap();
    let error = &reported["error"];
    assert_eq!((&error["line"], &error["column"]), (&28.into(), &1.into()));
    assert_eq!(
        (&error["file"], &error["exit_code"]),
        (&"scenario.toml".into(), &2.into())
    );
    let message = error["message"].as_str().unwrap();
    assert!(message.contains("expected 0.1 to 5000 N"), "{message}");
    // Without a place in a file.
    let outcome = bench.idc(&["run", "nowhere.toml", "--json"], &[]);
    let reported: serde_json::Value = serde_json::from_str(&outcome.err).unwrap();
    assert_eq!(reported["error"]["file"], serde_json::Value::Null);
}

#[test]
fn colours_are_for_terminals_and_for_those_who_ask() {
    let bench = Bench::new("plate_edge_ideal");
    let escapes = |arguments: &[&str], environment: &[(&str, &str)]| {
        let outcome = bench.idc(arguments, environment);
        outcome.out.contains('\u{1b}') || outcome.err.contains('\u{1b}')
    };
    assert!(!escapes(&["run", "nowhere.toml"], &[]));
    assert!(escapes(&["run", "nowhere.toml", "--color", "always"], &[]));
    assert!(!escapes(&["run", "nowhere.toml", "--color", "never"], &[]));
    assert!(escapes(
        &["run", "nowhere.toml"],
        &[("CLICOLOR_FORCE", "1")]
    ));
    let run = ["run", "scenario.toml", "--out", "out", "--force"];
    assert!(!escapes(&run, &[]));
    assert!(escapes(&[&run[..], &["--color", "always"]].concat(), &[]));
    // A terminal with NO_COLOR: `script` gives the program one.
    let terminal = |no_colour: &str| {
        let line = format!("{} run nowhere.toml", env!("CARGO_BIN_EXE_idc"));
        let output = std::process::Command::new("script")
            .args(["-qec", &line, "/dev/null"])
            .env("NO_COLOR", no_colour)
            .env("TERM", "xterm-256color")
            .current_dir(bench.path("."))
            .output();
        output.ok().map(|output| output.stdout.contains(&0x1b))
    };
    match (terminal("1"), terminal("")) {
        (Some(with), Some(without)) => assert_eq!((with, without), (false, true)),
        _ => skipped("there is no `script`"),
    }
}
