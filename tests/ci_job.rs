//! What the action of action.yml runs in somebody's repository (`assets/ci/run_scenarios`), on the example repository: exit code, summary and folder of the artifact.
//! And the container's last step, into a fresh root folder.

use std::os::unix::fs::PermissionsExt as _;
use std::path::Path;
use std::process::Command;

use crate::common::project;

/// Bounds of the example's scenario, and bounds that it cannot keep.
const KEPT: &str = "force_mean_n = { min = 148.5, max = 151.5 }";
const NOT_KEPT: &str = "force_mean_n = { min = 168.5, max = 171.5 }";

/// A copy of the example repository's scenario, as `scenarios/NAME.toml`.
fn repository(names: &[(&str, &str)]) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let models = "scenarios/plate_models";
    std::fs::create_dir_all(folder.path().join(models)).unwrap();
    for entry in std::fs::read_dir(project("examples/ci").join(models)).unwrap() {
        let entry = entry.unwrap();
        let copy = folder.path().join(models).join(entry.file_name());
        std::fs::copy(entry.path(), copy).unwrap();
    }
    let text = std::fs::read_to_string(project("examples/ci/scenarios/plate.toml")).unwrap();
    assert!(text.contains(KEPT));
    for (name, bounds) in names {
        let path = folder.path().join(format!("scenarios/{name}.toml"));
        std::fs::write(path, text.replace(KEPT, bounds)).unwrap();
    }
    folder
}

/// Runs the script in a folder: exit code, what it appended to the job's summary, standard error.
fn job(folder: &Path, arguments: &[&str]) -> (i32, String, String) {
    let summary = folder.join("step_summary");
    std::fs::write(&summary, "of another step\n").unwrap();
    let output = Command::new(project("assets/ci/run_scenarios"))
        .args(arguments)
        .env("IDC", env!("CARGO_BIN_EXE_idc"))
        .env("GITHUB_STEP_SUMMARY", &summary)
        .current_dir(folder)
        .output()
        .unwrap();
    let text = std::fs::read_to_string(&summary).unwrap();
    let text = text.strip_prefix("of another step\n").unwrap().to_owned();
    let errors = String::from_utf8(output.stderr).unwrap();
    (output.status.code().unwrap(), text, errors)
}

#[test]
fn a_job_whose_bounds_are_kept_passes_and_leaves_summary_and_reports() {
    let folder = repository(&[("plate", KEPT)]);
    let arguments = ["runs", "scenarios/*.toml", "", "--", "--no-recording"];
    let (code, summary, errors) = job(folder.path(), &arguments);
    assert_eq!(code, 0, "{errors}");
    let row = "| scenarios/plate.toml | bounds kept | 0 |\n";
    assert!(summary.contains(row), "{summary}");
    // The numbers are those of summary.json: here the mean force, by another route.
    let results = folder.path().join("runs/scenarios_plate");
    let json = std::fs::read_to_string(results.join("summary.json")).unwrap();
    let json: serde_json::Value = serde_json::from_str(&json).unwrap();
    let mean = json["summary"]["force_mean_n"].as_f64().unwrap();
    let fact = format!("| force, mean | {mean:.1} N |");
    assert!(summary.contains(&fact), "{fact} in {summary}");
    assert!(!summary.contains("~~~~"), "{summary}");
    assert!(results.join("report.html").is_file());
    assert!(!results.join("recording.rrd").exists());
    let kept = std::fs::read_to_string(folder.path().join("runs/summary.md")).unwrap();
    assert_eq!(kept, summary);
}

#[test]
fn a_job_fails_with_the_largest_exit_code_and_runs_all_the_same() {
    let folder = repository(&[("a", NOT_KEPT), ("b", KEPT)]);
    let arguments = ["runs", "scenarios/*.toml", "--", "--no-recording"];
    let (code, summary, errors) = job(folder.path(), &arguments);
    assert_eq!(code, 1, "{errors}");
    for row in [
        "| scenarios/a.toml | **outside its bounds** | 1 |\n",
        "| scenarios/b.toml | bounds kept | 0 |\n",
    ] {
        assert!(summary.contains(row), "{row} in {summary}");
    }
    // Which bound it is stands in the summary and in the log of the job.
    assert!(errors.contains("168.5"), "{errors}");
    assert!(summary.contains("168.5"), "{summary}");
    for name in ["a", "b"] {
        let page = format!("runs/scenarios_{name}/report.html");
        assert!(folder.path().join(page).is_file());
    }
    // A key that does not exist, beside results of before: bad input, whose message stands in place of numbers.
    let path = folder.path().join("scenarios/a.toml");
    let text = std::fs::read_to_string(&path).unwrap();
    std::fs::write(&path, text.replace("force_mean_n", "froce_mean_n")).unwrap();
    let (code, summary, _) = job(folder.path(), &["runs", "scenarios/a.toml"]);
    assert_eq!(code, 2);
    assert!(summary.contains("**bad input** | 2 |"), "{summary}");
    assert!(summary.contains("froce_mean_n"), "{summary}");
    assert!(!summary.contains("force, mean"), "{summary}");
}

#[test]
fn a_job_without_scenarios_is_refused() {
    let folder = repository(&[]);
    for arguments in [
        &["runs"][..],
        &["runs", ""],
        &["runs", "nowhere/*.toml"],
        &["runs", "scenarios/plate.toml", "--", "--no-recording"],
    ] {
        let (code, summary, errors) = job(folder.path(), arguments);
        assert_eq!((code, summary.as_str()), (2, ""), "{errors}");
        assert!(errors.starts_with("error: "), "{errors}");
        assert!(!folder.path().join("runs").exists());
    }
}

#[test]
fn the_example_repository_is_what_the_program_writes() {
    let folder = tempfile::tempdir().unwrap();
    let output = Command::new(env!("CARGO_BIN_EXE_idc"))
        .args(["new", "cell", "scenarios/plate.toml"])
        .current_dir(folder.path())
        .output()
        .unwrap();
    assert!(output.status.success());
    for name in [
        "plate.toml",
        "plate_models/arm10.urdf",
        "plate_models/device.toml",
        "plate_models/plate.stl",
    ] {
        let name = format!("scenarios/{name}");
        let made = std::fs::read(folder.path().join(&name)).unwrap();
        let shipped = std::fs::read(project("examples/ci").join(&name)).unwrap();
        assert!(made == shipped, "examples/ci/{name}");
    }
    // The action is asked for by its own inputs.
    let read = |path: &str| std::fs::read_to_string(project(path)).unwrap();
    let action = read("action.yml");
    assert!(action.contains("\n  scenarios:\n"));
    let version = format!("OWNER/idc-cell@v{}\n", env!("CARGO_PKG_VERSION"));
    assert!(read("examples/ci/.github/workflows/scenarios.yml").contains(&version));
}

#[test]
fn the_container_gets_a_user_without_rights_once() {
    let root = tempfile::tempdir().unwrap();
    std::fs::create_dir(root.path().join("etc")).unwrap();
    std::fs::write(
        root.path().join("etc/passwd"),
        "root:x:0:0::/root:/bin/sh\n",
    )
    .unwrap();
    for _ in 0..2 {
        let output = Command::new(project("assets/ci/container_steps"))
            .arg("install")
            .arg(root.path())
            .output()
            .unwrap();
        assert!(output.status.success(), "{output:?}");
    }
    let read = |name: &str| std::fs::read_to_string(root.path().join(name)).unwrap();
    let user = "idc:x:10001:10001::/work:/usr/sbin/nologin\n";
    let expected = format!("root:x:0:0::/root:/bin/sh\n{user}");
    assert_eq!(read("etc/passwd"), expected);
    assert_eq!(read("etc/group"), "idc:x:10001:\n");
    assert!(root.path().join("work").is_dir());
    // The image runs as this user, and each step of it is the script's.
    let image = std::fs::read_to_string(project("Dockerfile")).unwrap();
    assert!(image.contains("\nUSER 10001:10001\n"));
    let steps = image.lines().filter(|line| line.starts_with("RUN "));
    assert!(steps.clone().all(|step| step.contains("/container_steps ")));
    assert_eq!(steps.count(), 2);
    for script in ["container_steps", "run_scenarios"] {
        let mode = std::fs::metadata(project("assets/ci").join(script)).unwrap();
        assert_eq!(mode.permissions().mode() & 0o111, 0o111, "{script}");
    }
}
