//! docs/FIRST-DIAGNOSIS.md, run as printed from where the program stands: what it tells a newcomer to type leads to the right diagnosis.

use std::process::Command;

use crate::common::{project, skipped};
use crate::documents::commands;
use crate::help::{place, shell};

#[test]
fn the_page_leads_to_the_right_diagnosis_in_ten_commands_at_most() {
    let commands = commands("docs/FIRST-DIAGNOSIS.md");
    assert!(commands.len() <= 10, "{} commands", commands.len());
    let [clone, install, rest @ ..] = &commands[..] else {
        panic!("{commands:?}");
    };
    // In a test the clone is a folder like it, and the program stands already.
    assert!(clone.starts_with("git clone ") && clone.ends_with(" idc-cell && cd idc-cell"));
    assert_eq!(install, "cargo install --path . --locked");
    let folder = place();
    let mut said = String::new();
    for line in rest {
        let output = shell(line, folder.path());
        said += &String::from_utf8_lossy(&output.stdout);
        let err = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success(), "{line}\n{said}{err}");
        // A diagnosis names its stages where no terminal shows its progress.
        let stages = |line: &&str| line.split_once(" of 5: ").is_some();
        let other: Vec<&str> = err.lines().filter(|line| !stages(line)).collect();
        assert_eq!(other, [""; 0], "{line}");
    }
    let found = folder.path().join("runs/mine/found");
    let text = std::fs::read_to_string(found.join("diagnosis.json")).unwrap();
    let answer: serde_json::Value = serde_json::from_str(&text).unwrap();
    let effects = answer["effects"].as_array().unwrap();
    assert_eq!(effects.len(), 1, "{said}");
    assert_eq!(effects[0]["name"], "coulomb_viscous_friction");
    // As the page says, and what was put in lies within the interval.
    let number = |name: &str| &effects[0]["parameters"][name];
    for (name, page, truth) in [
        ("coulomb_force_n", 24.8, 24.7016),
        ("viscous_coefficient_n_s_per_m", 107.0, 107.508),
    ] {
        let number = number(name);
        let value = |key: &str| number[key].as_f64().unwrap();
        assert!((value("value") / page - 1.0).abs() < 0.01, "{number}");
        assert!(value("low") < truth && truth < value("high"), "{number}");
    }
    for file in [
        "report.html",
        "account.txt",
        "improved.toml",
        "prediction.csv",
    ] {
        assert!(found.join(file).is_file(), "{file}");
    }
    for words in [
        "a case to diagnose",
        "cycle.parquet, to be predicted",
        "coulomb_viscous_friction",
    ] {
        assert!(said.contains(words), "{said}\nlacks {words:?}");
    }
}

#[test]
fn the_logs_are_those_of_the_case_that_they_come_from() {
    let folder = tempfile::tempdir().unwrap();
    for name in ["first", "proof/cases/case-02"] {
        std::fs::create_dir_all(folder.path().join("assets").join(name)).unwrap();
    }
    let copy = |name: &str| {
        std::fs::copy(project(name), folder.path().join(name)).unwrap();
    };
    copy("assets/first/make_logs.py");
    for name in ["stairs", "ride", "cycle"] {
        copy(&format!("assets/proof/cases/case-02/{name}.csv"));
    }
    let Ok(status) = Command::new("python3")
        .arg(folder.path().join("assets/first/make_logs.py"))
        .status()
    else {
        skipped("there is no python3");
        return;
    };
    assert!(status.success());
    for name in ["stairs", "ride", "cycle"] {
        let name = format!("assets/first/{name}.csv");
        let read = |path| std::fs::read(path).unwrap();
        assert!(
            read(folder.path().join(&name)) == read(project(&name)),
            "{name}"
        );
    }
}
