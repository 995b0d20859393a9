//! The examples print what their headers say.

use std::path::PathBuf;
use std::process::Command;

use crate::common::project;

/// Beside this test's program, where Cargo builds them with the tests.
fn program(name: &str) -> PathBuf {
    let own = std::env::current_exe().unwrap();
    let folder = own.parent().unwrap().parent().unwrap().join("examples");
    folder.join(format!("{name}{}", std::env::consts::EXE_SUFFIX))
}

fn header(source: &str) -> String {
    let reported = source.lines().map_while(|line| line.strip_prefix("//!"));
    let reported = reported.map(|line| line.strip_prefix(' ').unwrap_or(line));
    let block = reported.skip_while(|line| *line != "```text").skip(1);
    let block = block.take_while(|line| *line != "```");
    block.map(|line| format!("{line}\n")).collect()
}

#[test]
fn each_example_prints_what_its_header_says() {
    let entries = std::fs::read_dir(project("examples")).unwrap();
    let mut seen = 0;
    for entry in entries {
        let path = entry.unwrap().path();
        // A repository to copy, examples/ci, is no program.
        if path.is_dir() {
            continue;
        }
        let source = std::fs::read_to_string(&path).unwrap();
        // A library, which .ci/fmu drives.
        if !source.contains("fn main()") {
            continue;
        }
        let name = path.file_stem().unwrap().to_str().unwrap();
        assert!(source.lines().count() <= 60, "{name} is long");
        let done = Command::new(program(name)).output().unwrap();
        let errors = String::from_utf8_lossy(&done.stderr);
        assert!(done.status.success(), "{name}: {errors}");
        let printed = String::from_utf8(done.stdout).unwrap();
        assert_eq!(printed, header(&source), "{name}");
        seen += 1;
    }
    assert_eq!(seen, 5);
}
