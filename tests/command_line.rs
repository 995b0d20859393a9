//! Output and exit codes of the program.

use std::process::Stdio;

use crate::common::project;
use crate::program::{Bench, FILES};

#[test]
fn a_result_outside_its_bounds_is_named_and_kept() {
    let bench = Bench::new("plate_edge_ideal");
    bench.replace(
        "scenario.toml",
        "force_mean_n = { min = 148.5, max = 151.5 }",
        "force_mean_n = { min = 1, max = 100 }",
    );
    for flag in ["--quiet", "--json"] {
        let outcome = bench.idc(
            &["run", "scenario.toml", "--out", "out", "--force", flag],
            &[],
        );
        assert_eq!(outcome.code, 1);
        let line = outcome.only_line("outside its bounds: force_mean_n is 1");
        assert!(
            line.ends_with("expected at least 1 and at most 100"),
            "{line}"
        );
        assert_eq!(bench.names_in("out"), FILES);
    }
    let verdicts = &bench.summary()["expectations"];
    let kept = |verdict: &&serde_json::Value| verdict["kept"] == true;
    assert_eq!(
        verdicts.as_array().unwrap().iter().filter(kept).count() + 1,
        verdicts.as_array().unwrap().len()
    );
}

#[test]
fn json_is_what_the_summary_file_holds_and_quiet_is_quiet() {
    let bench = Bench::new("plate_edge_ideal");
    let outcome = bench.idc(&["run", "scenario.toml", "--out", "out", "--json"], &[]);
    assert_eq!((outcome.code, outcome.err.as_str()), (0, ""));
    assert_eq!(
        serde_json::from_str::<serde_json::Value>(&outcome.out).unwrap(),
        bench.summary()
    );
    let outcome = bench.idc(&["run", "scenario.toml", "--quiet"], &[]);
    assert_eq!(
        (outcome.code, outcome.out.as_str(), outcome.err.as_str()),
        (0, "", "")
    );
    assert_eq!(bench.names_in("runs/scenario"), FILES);
}

#[test]
fn the_edges_of_the_plate_are_listed() {
    let bench = Bench::new("plate_edge_ideal");
    let outcome = bench.idc(
        &["edges", project("assets/plate.stl").to_str().unwrap()],
        &[],
    );
    assert_eq!((outcome.code, outcome.err.as_str()), (0, ""));
    let edges: Vec<&str> = outcome
        .out
        .lines()
        .filter(|line| line.starts_with("edge-"))
        .collect();
    assert_eq!(edges.len(), 12, "{}", outcome.out);
    let long = edges
        .iter()
        .filter(|line| line.contains(" 300.000 "))
        .count();
    assert_eq!(long, 4, "{}", outcome.out);
}

#[test]
fn what_cannot_be_listed_is_refused() {
    let bench = Bench::new("plate_edge_ideal");
    for (arguments, words) in [
        (&["edges", "nowhere.stl"][..], "cannot read nowhere.stl"),
        (
            &["edges", "part.stl", "--unit", "m"],
            "part.stl: mesh is 300 m long",
        ),
        (
            &["edges", "part.stl", "--sharp-angle-deg", "nan"],
            "--sharp-angle-deg is NaN, expected 1 to 170",
        ),
        (
            &["edges", "part.stl", "--sharp-angle-deg", "-5"],
            "--sharp-angle-deg is -5, expected 1 to 170",
        ),
    ] {
        let outcome = bench.idc(arguments, &[]);
        assert_eq!(
            (outcome.code, outcome.out.as_str()),
            (2, ""),
            "{arguments:?}"
        );
        assert!(
            outcome.only_line("error: ").contains(words),
            "{}",
            outcome.err
        );
    }
}

#[test]
fn a_proof_needs_nothing_of_the_project() {
    let bench = Bench::new("plate_edge_ideal");
    let outcome = bench.idc(&["prove", "--only", "case-01", "--out", "proof"], &[]);
    assert_eq!(outcome.code, 0, "{}{}", outcome.out, outcome.err);
    outcome.only_line("note: there is no assets/proof/cases here");
    // The same case as the project's.
    for file in ["rig.toml", "ride.csv"] {
        let made = std::fs::read(bench.path("proof/laboratory/cases/case-01").join(file));
        let ours = std::fs::read(project("assets/proof/cases/case-01").join(file));
        assert!(made.unwrap() == ours.unwrap(), "{file}");
    }
    let outcome = bench.idc(&["prove", "--only", "case-77", "--out", "other"], &[]);
    assert_eq!(outcome.code, 2);
    assert!(
        outcome
            .only_line("error: --only case-77")
            .contains("case-01")
    );
    assert!(!bench.path("other").exists());
}

#[test]
fn a_reader_that_has_gone_is_no_error() {
    let (reader, writer) = std::io::pipe().unwrap();
    drop(reader);
    let output = std::process::Command::new(env!("CARGO_BIN_EXE_idc"))
        .args(["edges", project("assets/plate.stl").to_str().unwrap()])
        .stdout(Stdio::from(writer))
        .output()
        .unwrap();
    assert_eq!(String::from_utf8(output.stderr).unwrap(), "");
    assert_eq!(output.status.code(), Some(0));
}

/// The template's springs are those of the arm that comes with the program; a file for another arm named joints that it had not.
#[test]
fn a_cell_to_start_from_fits_an_arm_with_joints_of_other_names() {
    let bench = Bench::new("plate_edge_ideal");
    let arm = std::fs::read_to_string(bench.path("arm.urdf")).unwrap();
    bench.write("other.urdf", arm.replace("\"elbow\"", "\"joint_3\""));
    for (arguments, expected) in [
        (vec![], "stiffness_n_m_per_rad"),
        (vec!["--urdf", "other.urdf"], "lag_bandwidth_hz"),
    ] {
        let new = [
            &["new", "cell", "own.toml", "--force", "--quiet"],
            &arguments[..],
        ]
        .concat();
        assert_eq!(bench.idc(&new, &[]).code, 0);
        let text = std::fs::read_to_string(bench.path("own.toml")).unwrap();
        assert!(text.contains(expected), "{text}");
        let checked = bench.idc(&["check", "own.toml"], &[]);
        assert_eq!(checked.code, 0, "{}", checked.err);
    }
}
