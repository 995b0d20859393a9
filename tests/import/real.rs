//! The maps that come with the project, on the recordings that they were written for.

use std::path::{Path, PathBuf};

use idc_cell::import::findings::findings;
use idc_cell::import::{Imported, import, load_map};

use crate::common::{project, shared};

/// A set of recordings, where it is there.
fn set(name: &str) -> Option<PathBuf> {
    shared(&format!("recordings/{name}"))
}

/// Logs of a folder whose names end so, in order.
fn logs(folder: &Path, end: &str) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(folder).unwrap();
    let mut paths: Vec<PathBuf> = entries.map(|entry| entry.unwrap().path()).collect();
    paths.retain(|path| path.to_string_lossy().ends_with(end));
    paths.sort();
    assert!(!paths.is_empty(), "no *{end} in {}", folder.display());
    paths
}

/// Imports logs and expects nothing doubtful.
fn clean(map: &str, logs: &[PathBuf]) -> Imported {
    let map = load_map(&project(&format!("assets/import/{map}.toml"))).unwrap();
    let imported = import(&map, logs).unwrap_or_else(|error| panic!("{error}"));
    for finding in findings(&imported, &map) {
        assert!(
            finding.doubts.is_empty(),
            "{}: {:?}",
            logs[0].display(),
            finding.doubts
        );
        let missing = finding.missing as f64 / finding.samples as f64;
        assert!(missing < 0.01, "{finding:?}");
    }
    imported
}

#[test]
fn every_map_that_comes_with_the_project_is_one() {
    for path in logs(&project("assets/import"), ".toml") {
        load_map(&path).unwrap_or_else(|error| panic!("{error}"));
    }
}

#[test]
fn every_set_is_imported_by_its_map_without_a_doubt() {
    for (name, map, end) in [
        ("cylinder_friction", "cylinder_friction", ".csv"),
        ("chamber_leak", "chamber_leak", ".csv"),
        ("emps", "emps", ".csv"),
        ("emps", "emps_mat", ".mat"),
        ("regulator_steps", "regulator_steps", ".txt"),
    ] {
        let Some(folder) = set(name) else { return };
        for log in logs(&folder, end) {
            let imported = clean(map, &[log]);
            assert!(imported.recording.sample_count() > 1000);
        }
    }
    let Some(folder) = set("acf_ur10e") else {
        return;
    };
    for pair in logs(&folder, ".csv").chunks(2) {
        assert_eq!(clean("contact_flange", pair).recording.channels().len(), 4);
    }
}

#[test]
fn the_published_mat_file_is_the_text_that_was_made_of_it() {
    let Some(folder) = set("emps") else { return };
    let mat = clean("emps_mat", &logs(&folder, ".mat")).recording;
    let text = clean("emps", &logs(&folder, ".csv")).recording;
    assert_eq!(mat.sample_count(), text.sample_count());
    // The text was rounded: times to ms, the rest to nine decimals.
    for (a, b) in mat.time().iter().zip(text.time()) {
        assert!((a - b).abs() < 1e-6);
    }
    for (a, b) in mat.channels().iter().zip(text.channels()) {
        assert_eq!((&a.quantity, a.unit), (&b.quantity, b.unit));
        let digits = if a.quantity == "measured_force" {
            2e-8
        } else {
            5.1e-10
        };
        assert!(
            a.values
                .iter()
                .zip(&b.values)
                .all(|(a, b)| (a - b).abs() < digits)
        );
    }
}

#[test]
fn volts_taken_for_newtons_are_doubted() {
    let Some(folder) = set("emps") else { return };
    for (map, end) in [("emps", ".csv"), ("emps_mat", ".mat")] {
        let text = std::fs::read_to_string(project(&format!("assets/import/{map}.toml"))).unwrap();
        let without: Vec<&str> = text
            .lines()
            .filter(|line| !line.starts_with("gain"))
            .collect();
        let here = tempfile::tempdir().unwrap();
        let path = here.path().join("map.toml");
        std::fs::write(&path, without.join("\n")).unwrap();
        let map = load_map(&path).unwrap();
        let imported = import(&map, &logs(&folder, end)).unwrap();
        let all = findings(&imported, &map);
        let force = all.iter().find(|f| f.quantity == "measured_force").unwrap();
        let said = force.doubts.join("\n");
        assert!(said.contains("controller's output in volts"), "{said}");
        assert!(
            all.iter()
                .filter(|f| f.quantity != "measured_force")
                .all(|f| f.doubts.is_empty())
        );
    }
}
