//! Arms of people's own: `idc new cell --urdf` writes what runs as it stands, macros are given to xacro, and what cannot be an arm is refused in one line.

use std::path::{Path, PathBuf};
use std::process::Command;

use crate::common::{project, skipped};
use crate::program::Bench;

/// One robot in the style of a maker, made by the study's script; none where there is no Python.
fn made(folder: &Path, number: usize) -> Option<PathBuf> {
    let script = project("tests/studies/made_robots.py");
    let made = Command::new("python3")
        .arg(script)
        .args(["--make", "--only", &number.to_string(), "--out"])
        .arg(folder)
        .output();
    let Some(made) = made.ok().filter(|made| made.status.success()) else {
        skipped("python3 is absent: no robot is made");
        return None;
    };
    Some(PathBuf::from(
        String::from_utf8(made.stdout).unwrap().trim(),
    ))
}

#[test]
fn an_arm_without_masses_and_torques_runs_as_new_cell_writes_it() {
    let bench = Bench::new("plate_edge_ideal");
    let Some(urdf) = made(&bench.path("robots"), 0) else {
        return;
    };
    let urdf = urdf.to_str().unwrap();
    // Without estimates it is refused, with the way on.
    bench.replace("scenario.toml", "\"arm.urdf\"", &format!("{urdf:?}"));
    bench.replace("scenario.toml", "\"flange\"", "\"tool0\"");
    let refused = bench.run();
    assert_eq!(refused.code, 2);
    let line = refused.only_line("error: ");
    assert!(
        line.contains("link `link_1` has no mass") && line.contains("arm.mass_kg"),
        "{line}"
    );
    let new = bench.idc(&["new", "cell", "own.toml", "--urdf", urdf], &[]);
    assert_eq!(new.code, 0, "{}", new.err);
    assert!(new.out.contains("estimated"), "{}", new.out);
    let run = bench.idc(&["run", "own.toml", "--out", "own", "--no-recording"], &[]);
    assert_eq!(run.code, 0, "{}", run.err);
    let text = std::fs::read_to_string(bench.path("own/summary.json")).unwrap();
    let document: serde_json::Value = serde_json::from_str(&text).unwrap();
    let share = document["summary"]["joint_torque_share_percent"]
        .as_f64()
        .unwrap();
    assert!(share < 100.0, "{share} %");
    let estimated = &document["estimated_masses"];
    assert_eq!(estimated["links"].as_array().unwrap().len(), 6);
    let joints = estimated["joints"].as_array().unwrap();
    for joint in joints {
        let torque = |key: &str| joint[key].as_f64().unwrap();
        assert!(torque("least_n_m") <= torque("largest_n_m"));
        assert!(torque("largest_n_m") < torque("greatest_n_m"));
    }
    // What the run took is near what was planned; the touch itself is not in the plan.
    let planned = joints.iter().map(|joint| {
        100.0 * joint["largest_n_m"].as_f64().unwrap() / joint["limit_n_m"].as_f64().unwrap()
    });
    let planned = planned.fold(0.0, f64::max);
    assert!(
        (share - planned).abs() < 0.5 * planned,
        "{share} % of {planned} %"
    );
    let page = std::fs::read_to_string(bench.path("own/report.html")).unwrap();
    assert!(page.contains("Estimated masses"));
    let check = bench.idc(&["check", "own.toml"], &[]);
    assert!(
        check.words().contains("masses estimated from shapes"),
        "{}",
        check.out
    );
}

#[test]
fn an_arm_of_four_axes_is_refused_by_the_link_that_was_tried() {
    let bench = Bench::new("plate_edge_ideal");
    for joint in ["wrist_2", "wrist_3"] {
        let of = |kind: &str| format!("<joint name=\"{joint}\" type=\"{kind}\">");
        bench.replace("arm.urdf", &of("revolute"), &of("fixed"));
    }
    let frame = "<link name=\"base\"/><joint name=\"b\" type=\"fixed\"><parent link=\"base_link\"/><child link=\"base\"/></joint></robot>";
    bench.replace("arm.urdf", "</robot>", frame);
    let new = bench.idc(&["new", "cell", "own.toml", "--urdf", "arm.urdf"], &[]);
    assert_eq!(new.code, 2);
    let line = new.only_line("error: ");
    assert!(
        line.contains("to `flange` has 4 moving joints") && line.contains("palletisers"),
        "{line}"
    );
    assert!(!bench.path("own.toml").exists());
}

#[cfg(unix)]
#[test]
fn macros_are_evaluated_by_the_program_xacro_where_it_is_installed() {
    use std::os::unix::fs::PermissionsExt;

    let bench = Bench::new("plate_edge_ideal");
    std::fs::copy(bench.path("arm.urdf"), bench.path("plain.urdf")).unwrap();
    bench.replace(
        "arm.urdf",
        "<robot name",
        "<robot xmlns:xacro=\"http://www.ros.org/wiki/xacro\" name",
    );
    bench.replace(
        "arm.urdf",
        "</robot>",
        "<xacro:if value=\"1\"><link name=\"gripper\"/></xacro:if></robot>",
    );
    std::fs::create_dir(bench.path("bin")).unwrap();
    let path = bench.path("bin");
    let path = path.to_str().unwrap();
    let check = || bench.idc(&["check", "scenario.toml"], &[("PATH", path)]);
    let absent = check();
    assert_eq!(absent.code, 2);
    let line = absent.only_line("error: ").to_owned();
    assert!(
        line.contains("<xacro:if>") && line.contains("pip install xacro"),
        "{line}"
    );
    assert!(line.contains("arm.urdf -o "), "{line}");
    // A stand-in that gives what xacro would give, if it is given the file.
    let plain = bench.path("plain.urdf");
    let plain = plain.to_str().unwrap();
    let put = |script: String| {
        bench.write("bin/xacro", script);
        let mode = std::fs::Permissions::from_mode(0o755);
        std::fs::set_permissions(bench.path("bin/xacro"), mode).unwrap();
    };
    put(format!(
        "#!/bin/sh\ncase \"$1\" in */arm.urdf) exec /bin/cat {plain:?};; esac\nexit 3\n"
    ));
    let there = check();
    assert_eq!(there.code, 0, "{}", there.err);
    assert!(
        there.out.contains("evaluated by the program xacro"),
        "{}",
        there.out
    );
    put("#!/bin/sh\necho 'undefined macro: xacro:gripper' >&2\nexit 2\n".to_owned());
    let failing = check();
    assert_eq!(failing.code, 2);
    assert!(
        failing
            .only_line("error: ")
            .contains("it says: undefined macro: xacro:gripper")
    );
}
