//! `idc effects`: every effect is listed and explained, and docs/EFFECTS.md with its pictures is what the program makes of them.

use std::collections::BTreeSet;

use idc_cell::effects::{Effect, NUMBERS_OFF, kinds};

use crate::common::project;
use crate::help::place;
use crate::program::Bench;

fn name(effect: &Effect) -> &'static str {
    effect.vocabulary().0
}

/// A diagnosis that names `number_off` sent its reader to a command that said "there is no effect of this name".
#[test]
fn a_number_that_is_off_is_explained_with_its_keys() {
    let bench = Bench::new("paper_step");
    let said = bench.idc(&["effects", "number_off"], &[]);
    assert_eq!((said.code, said.err.as_str()), (0, ""));
    let json = bench.idc(&["effects", "number_off", "--json"], &[]).out;
    let json: serde_json::Value = serde_json::from_str(&json).unwrap();
    let keys = json["keys"].as_array().unwrap();
    assert_eq!(keys.len(), NUMBERS_OFF.len());
    let keys: Vec<&str> = keys.iter().map(|key| key.as_str().unwrap()).collect();
    assert!(keys.contains(&"cylinder.bore_m"), "{keys:?}");
    for key in keys {
        assert!(said.out.contains(key), "{}", said.out);
    }
    assert!(
        said.out.lines().all(|line| line.len() <= 80),
        "{}",
        said.out
    );
}

#[test]
fn every_effect_is_listed_and_explained() {
    let bench = Bench::new("paper_step");
    let list = bench.idc(&["effects"], &[]);
    assert_eq!((list.code, list.err.as_str()), (0, ""));
    let json: serde_json::Value =
        serde_json::from_str(&bench.idc(&["effects", "--json"], &[]).out).unwrap();
    assert_eq!(json["effects"].as_array().unwrap().len(), kinds().count());
    assert!(list.out.lines().all(|line| line.chars().count() <= 80));
    let said = list.words();
    for effect in kinds() {
        let meaning = &effect.header().meaning;
        let listed = |mark: &str| said.contains(&format!("{}{mark} {meaning}", name(effect)));
        assert!(listed("") || listed("*"), "{effect:?} is not listed");
    }
    // One of each kind: of the device, of a joint, of a part of a device.
    for (name, parts) in [
        (
            "stribeck_friction",
            [
                "idc run assets/effects/sway.toml --with",
                "static_force_n = 16",
            ],
        ),
        (
            "joint_backlash",
            ["idc run assets/effects/edge.toml --with", "joint = 2"],
        ),
        (
            "gap_leakage",
            ["chain = \"closed_chamber\"", "name = \"gap_leakage\""],
        ),
    ] {
        let page = bench.idc(&["effects", name], &[]);
        assert_eq!((page.code, page.err.as_str()), (0, ""), "{name}");
        let all = [
            "Source: ",
            "\nNumbers\n",
            " usual",
            "\nShows as\n",
            "\nConfused with\n",
            "\nPicture\n",
        ];
        for part in all.iter().chain(&parts) {
            assert!(
                page.out.contains(part),
                "{name} lacks {part:?}:\n{}",
                page.out
            );
        }
        // A command is to be copied whole.
        let mut lines = page
            .out
            .lines()
            .filter(|line| !line.starts_with("  idc run "));
        let wide = lines.find(|line| line.chars().count() > 80);
        assert_eq!(wide, None, "{name}");
    }
}

#[test]
fn a_name_that_is_none_is_refused_with_the_nearest() {
    let bench = Bench::new("paper_step");
    for (wrong, right) in [
        ("stribek_friction", "did you mean `stribeck_friction`?"),
        ("gap_leakge", "did you mean `gap_leakage`?"),
    ] {
        let refused = bench.idc(&["effects", wrong, "--out", "picture.svg"], &[]);
        assert_eq!((refused.code, refused.out.as_str()), (2, ""), "{wrong}");
        assert!(
            refused.only_line("error: ").contains(right),
            "{}",
            refused.err
        );
        assert!(!bench.path("picture.svg").exists());
    }
    bench.write("picture.svg", "mine");
    let existing = bench.idc(&["effects", "burr", "--out", "picture.svg"], &[]);
    assert_eq!(existing.code, 2);
    assert!(existing.err.contains("--force"), "{}", existing.err);
}

/// The entry that a page says to write into a file is what a file takes.
#[test]
fn the_lines_of_every_page_are_those_of_a_file() {
    let folder = place();
    let near = folder.path().join("runs/mine");
    std::fs::create_dir_all(&near).unwrap();
    let bench = Bench::new("paper_step");
    for effect in kinds() {
        let reported = bench.idc(&["effects", name(effect), "--json"], &[]).out;
        let reported: serde_json::Value = serde_json::from_str(&reported).unwrap();
        let lines = reported["lines"].as_array().unwrap().iter();
        let lines: Vec<&str> = lines.map(|line| line.as_str().unwrap()).collect();
        let whole = reported["command"].as_str();
        let shipped = match (whole, reported["chain"].as_str()) {
            (Some(command), _) => command.split(' ').nth(2).unwrap(),
            (None, Some("closed_chamber")) => "assets/rigs/chamber_leak.toml",
            (None, Some("driven_slide")) => "assets/rigs/emps.toml",
            (None, chain) => {
                assert_eq!(chain, Some("regulator"));
                "assets/rigs/regulator_steps.toml"
            }
        };
        let text = std::fs::read_to_string(project(shipped)).unwrap();
        let text = text.replace("../plate.stl", "../../assets/plate.stl");
        let file = near.join("file.toml");
        std::fs::write(&file, format!("{text}\n{}\n", lines.join("\n"))).unwrap();
        let refused = match whole {
            Some(_) => idc_cell::scenario::load_any(&file).err(),
            None => idc_cell::scenario::rig_file::load_rig(&file).err(),
        };
        assert!(refused.is_none(), "{}: {}", name(effect), refused.unwrap());
    }
}

/// `idc effects --gallery docs --force` makes it again.
#[test]
fn the_gallery_is_what_the_program_makes() {
    let bench = Bench::new("paper_step");
    let made = bench.idc(&["effects", "--gallery", "docs"], &[]);
    assert_eq!((made.code, made.err.as_str()), (0, ""));
    let read = |path: std::path::PathBuf| {
        std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{path:?}: {error}"))
    };
    let again = "is another one now: idc effects --gallery docs --force";
    let same = |file: &str| read(bench.path(file)) == read(project(file));
    assert!(same("docs/EFFECTS.md"), "docs/EFFECTS.md {again}");
    let mut pictures = BTreeSet::new();
    for effect in kinds() {
        let file = format!("docs/pictures/effects/{}.svg", name(effect));
        assert!(same(&file), "{file} {again}");
        let size = read(project(&file)).len();
        assert!(size < 25_000, "{file}: {size} bytes");
        pictures.insert(format!("{}.svg", name(effect)));
    }
    for effect in idc_cell::demonstration::arm_effects() {
        let file = format!("docs/pictures/effects/{}.svg", effect.name);
        assert!(same(&file), "{file} {again}");
        let size = read(project(&file)).len();
        assert!(size < 25_000, "{file}: {size} bytes");
        pictures.insert(format!("{}.svg", effect.name));
    }
    let existing: BTreeSet<String> = std::fs::read_dir(project("docs/pictures/effects"))
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    assert_eq!(existing, pictures);
    // The eye sees what each is about.
    let mut reported = 0;
    for line in made.out.lines() {
        let share: f64 = (line
            .split_once(": ")
            .and_then(|(_, rest)| rest.split_once(" %")))
        .and_then(|(share, _)| share.parse().ok())
        .unwrap_or_else(|| panic!("{line}"));
        assert!(share >= 3.0, "{line}");
        reported += 1;
    }
    assert_eq!(reported, pictures.len());
}
