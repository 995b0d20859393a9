//! Helpers that tests share.

use std::io::Write as _;
use std::path::{Path, PathBuf};

use idc_cell::cell::Cell;
use idc_cell::run::{FinishedCell, run_cell};
use idc_cell::scenario::{Scenario, load};

/// A path inside the project.
pub fn project(path: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(path)
}

/// Says that a test, or a part of it, is left out for want of something that `.ci/run` installs; there that is a fault.
pub fn skipped(why: &str) {
    // Not by eprintln!, which the test harness swallows when a test passes.
    writeln!(std::io::stderr(), "skipped: {why}").expect("standard error is open");
}

/// Recordings beside the project that do not come with it; where they are absent the test, or the part of it, is left out and `.ci/run` says so.
pub fn shared(path: &str) -> Option<PathBuf> {
    let list = project("build/ci/left_out_without_shared.txt");
    present_or_listed(&project("../shared"), path, &list)
}

/// A path below a folder, or a line in a list: which test goes without what.
fn present_or_listed(folder: &Path, path: &str, list: &Path) -> Option<PathBuf> {
    let full = folder.join(path);
    if full.exists() {
        return Some(full);
    }
    let thread = std::thread::current();
    let line = format!(
        "{}: {} is absent\n",
        thread.name().unwrap_or("a thread of a test"),
        Path::new("../shared").join(path).display()
    );
    std::fs::create_dir_all(list.parent().unwrap()).unwrap();
    // Tests run side by side: appended by one call, so that no line falls into another.
    let mut file = std::fs::OpenOptions::new();
    let mut file = file.create(true).append(true).open(list).unwrap();
    file.write_all(line.as_bytes()).unwrap();
    eprint!("{line}");
    None
}

#[test]
fn who_goes_without_is_listed_with_what_is_absent() {
    let folder = tempfile::tempdir().unwrap();
    let list = folder.path().join("below/list.txt");
    std::fs::write(folder.path().join("there"), "").unwrap();
    let there = present_or_listed(folder.path(), "there", &list);
    assert_eq!(there, Some(folder.path().join("there")));
    assert!(!list.exists());
    std::thread::scope(|scope| {
        for test in 0..8 {
            let (folder, list) = (folder.path(), &list);
            let named = std::thread::Builder::new().name(format!("test_{test}"));
            let look = move || {
                for set in 0..50 {
                    assert_eq!(present_or_listed(folder, &format!("{set}"), list), None);
                }
            };
            named.spawn_scoped(scope, look).unwrap();
        }
    });
    let text = std::fs::read_to_string(&list).unwrap();
    let mut lines: Vec<&str> = text.lines().collect();
    lines.sort_unstable();
    let mut expected: Vec<String> = (0..400)
        .map(|at| format!("test_{}: ../shared/{} is absent", at / 50, at % 50))
        .collect();
    expected.sort_unstable();
    assert_eq!(lines, expected);
}

/// A scenario of the project by name.
pub fn scenario(name: &str) -> Scenario {
    load(&project(&format!("scenarios/{name}.toml"))).unwrap()
}

/// Runs a scenario to its end, which it must reach.
pub fn run(scenario: Scenario) -> FinishedCell {
    let cell = Cell::new(scenario).unwrap_or_else(|error| panic!("{error}"));
    let finished = run_cell(&cell, &mut |_| ()).unwrap();
    assert!(finished.stop.is_none(), "{}", finished.stop.unwrap());
    finished
}
