//! Helpers that tests share.

use std::io::Write as _;
use std::path::{Path, PathBuf};

use idc_cell::app::{Finished, run_cell};
use idc_cell::cell::Cell;
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

/// A scenario of the project by name.
pub fn scenario(name: &str) -> Scenario {
    load(&project(&format!("scenarios/{name}.toml"))).unwrap()
}

/// Runs a scenario to its end, which it must reach.
pub fn run(scenario: Scenario) -> Finished {
    let cell = Cell::new(scenario).unwrap_or_else(|error| panic!("{error}"));
    let finished = run_cell(&cell, &mut |_, _| ()).unwrap();
    assert!(finished.stop.is_none(), "{}", finished.stop.unwrap());
    finished
}
