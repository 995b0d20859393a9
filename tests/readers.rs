//! Foreign files come in by the doors that fuzzing tries (`fuzz/README.md`): valid ones are read, and what once broke a reader is answered.

mod doors;
mod seeds;
mod zip;

use std::time::{Duration, Instant};

use crate::common::project;
use doors::{DOORS, Reached, Room, door};

/// Set, the valid files are written to that folder, a folder a door: what fuzzing starts from.
const WRITE: &str = "IDC_WRITE_FUZZ_CORPUS";
/// Folder of inputs, a folder a door.
const GROWN: &str = "IDC_FUZZ_GROWN";
/// Longest time for an answer.
const LONGEST: Duration = Duration::from_secs(10);

#[test]
fn a_valid_file_of_every_kind_is_read() {
    let room = Room::new(&project(""));
    let target = std::env::var_os(WRITE);
    for door in &DOORS {
        let mut furthest = Reached::Header;
        for (number, seed) in seeds::seeds(door.name).iter().enumerate() {
            if let Some(target) = &target {
                let folder = std::path::Path::new(target).join(door.name);
                std::fs::create_dir_all(&folder).unwrap();
                std::fs::write(folder.join(format!("seed_{number}")), seed).unwrap();
            }
            let reached = door.open(&room, seed);
            // Of some a map or a unit is still to be given.
            assert!(reached > Reached::Header, "{}, file {number}", door.name);
            furthest = furthest.max(reached);
        }
        assert_eq!(furthest, Reached::End, "{}", door.name);
    }
}

/// Inputs that broke a reader, as fuzzing found them: `tests/readers/found/DOOR/`.
#[test]
fn what_broke_a_reader_once_is_answered() {
    let room = Room::new(&project(""));
    let mut count = 0;
    for folder in std::fs::read_dir(project("tests/readers/found")).unwrap() {
        let folder = folder.unwrap().path();
        let door = door(&folder.file_name().unwrap().to_string_lossy());
        for entry in std::fs::read_dir(&folder).unwrap() {
            let path = entry.unwrap().path();
            let start = Instant::now();
            // Some are refused, of some what is whole is read; none panics or goes on for long.
            door.open(&room, &std::fs::read(&path).unwrap());
            let shown = path.display();
            assert!(start.elapsed() < LONGEST, "{shown}: {:?}", start.elapsed());
            count += 1;
        }
    }
    assert!(count > 0, "no input was tried");
}

#[test]
#[ignore = "takes what fuzzing has grown, as fuzz/coverage does"]
fn what_fuzzing_has_grown_is_answered() {
    let grown = std::env::var_os(GROWN).expect("a folder with a folder for each door");
    let room = Room::new(&project(""));
    for folder in std::fs::read_dir(grown).unwrap() {
        let folder = folder.unwrap().path();
        let door = door(&folder.file_name().unwrap().to_string_lossy());
        let mut counts = [0; 3];
        for entry in std::fs::read_dir(&folder).unwrap() {
            let bytes = std::fs::read(entry.unwrap().path()).unwrap();
            counts[door.open(&room, &bytes) as usize] += 1;
        }
        let [header, content, end] = counts;
        println!(
            "{}: {header} refused at the header, {content} behind it, {end} read",
            door.name
        );
    }
}

// Catches: a reader that is added here and not fuzzed.
#[test]
fn each_door_has_its_fuzz_target() {
    // A packed crate comes without the fuzz targets, a package of their own.
    let Ok(text) = std::fs::read_to_string(project("fuzz/Cargo.toml")) else {
        return;
    };
    let manifest: toml::Table = text.parse().unwrap();
    let targets = manifest["bin"].as_array().unwrap();
    let names: Vec<&str> = targets
        .iter()
        .map(|bin| bin["name"].as_str().unwrap())
        .collect();
    assert_eq!(names, DOORS.map(|door| door.name));
}
