//! `idc fleet`: what sets in in a device is found where and since when; where nothing is planted nothing is reported; what was done is not done again.

use std::collections::BTreeMap;
use std::path::Path;
use std::time::SystemTime;

use idc_cell::fleet::date_of_day;
use idc_cell::laboratory::{Conditions, Recipe, write_session};
use serde_json::Value;

use crate::program::{Bench, Outcome};

/// 2026-03-01.
const FIRST: u64 = 20_513;

/// A type of device, with an effect of a share of its largest.
fn recipe(seed: u64, effect: Option<(&'static str, f64)>) -> Recipe {
    Recipe {
        name: "fleet".to_owned(),
        seed,
        effects: effect.into_iter().collect(),
        law: None,
        duration: 2.0,
        conditions: Conditions::default(),
    }
}

/// Records a device on a day, with a leak of a share of the largest that is plausible.
pub fn record(folder: &Path, device: u64, day: u64, leak: f64) {
    let effect = (leak > 0.0).then_some(("external_leakage", leak));
    let session = recipe(4, effect)
        .session(device, 1 + 100 * device + day)
        .unwrap();
    let name = date_of_day((FIRST + day) as f64);
    let dated = folder.join(format!("recorded/device-{device}/{name}"));
    let rig = folder.join("rig.toml");
    let rig = (!rig.exists()).then_some(rig);
    write_session(&session, &dated, rig.as_deref()).unwrap();
}

fn fleet(bench: &Bench) -> (Outcome, Value) {
    let arguments = [
        "fleet",
        "recorded",
        "--scenario",
        "rig.toml",
        "--out",
        "out",
    ];
    let outcome = bench.idc(&arguments, &[]);
    assert_eq!(outcome.code, 0, "{}", outcome.err);
    let text = std::fs::read_to_string(bench.path("out/fleet.json")).unwrap();
    (outcome, serde_json::from_str(&text).unwrap())
}

/// Results of tasks, and when each was written.
fn written(bench: &Bench) -> BTreeMap<String, SystemTime> {
    let entries = std::fs::read_dir(bench.path("out/tasks")).unwrap();
    let result = |entry: std::io::Result<std::fs::DirEntry>| {
        let path = entry.unwrap().path().join("result.json");
        let name = path.display().to_string();
        (name, std::fs::metadata(path).unwrap().modified().unwrap())
    };
    entries.map(result).collect()
}

#[test]
fn what_sets_in_is_found_where_and_since_when_and_a_new_day_does_its_own_work_alone() {
    let bench = Bench::new("plate_edge_ideal");
    let folder = bench.path("");
    for day in 0..12 {
        record(&folder, 1, day, 0.0);
        record(&folder, 2, day, if day >= 6 { 0.3 } else { 0.0 });
    }
    let (outcome, found) = fleet(&bench);
    assert!(
        outcome
            .out
            .contains("24 recordings of 2 devices, 24 not diagnosed yet"),
        "{}",
        outcome.out
    );
    let [sound, leaking] = [0, 1].map(|place| &found["devices"][place]);
    assert_eq!(sound["effects"], serde_json::json!([]), "{sound}");
    assert_eq!(sound["changed"], serde_json::json!([]), "{sound}");
    let effects = leaking["effects"].as_array().unwrap();
    assert_eq!(effects.len(), 1, "{effects:?}");
    assert_eq!(effects[0]["name"], "external_leakage");
    let planted = [5, 6, 7].map(|day| date_of_day((FIRST + day) as f64));
    let since = effects[0]["since"]["date"].as_str().unwrap_or("");
    assert!(planted.iter().any(|date| date == since), "{}", effects[0]);
    // Most days are what the one before was.
    assert!(found["searched"].as_u64().unwrap() <= 3, "{found}");
    let page = std::fs::read_to_string(bench.path("out/report.html")).unwrap();
    assert!(page.contains("device-2") && page.contains("external leakage"));
    // Another day: what stands is left as it is.
    let before = written(&bench);
    record(&folder, 1, 12, 0.0);
    record(&folder, 2, 12, 0.3);
    std::fs::write(
        bench.path("recorded/device-1/2026-03-14.csv"),
        "time_s\nx\n",
    )
    .unwrap();
    std::fs::write(bench.path("recorded/device-1/notes.csv"), "a").unwrap();
    let (outcome, found) = fleet(&bench);
    assert!(
        outcome
            .out
            .contains("27 recordings of 2 devices, 3 not diagnosed yet"),
        "{}",
        outcome.out
    );
    let after = written(&bench);
    assert!(before.iter().all(|(name, time)| after[name] == *time));
    assert_eq!(after.len(), before.len() + 3);
    let unread = found["unread"].as_array().unwrap();
    assert_eq!(unread.len(), 2, "{unread:?}");
    assert!(
        unread[0][0].as_str().unwrap().ends_with("2026-03-14.csv"),
        "{unread:?}"
    );
    assert_eq!(found["devices"][1]["effects"][0]["of"], 13);
}

/// Five devices over forty days: seals that set in, a leak that grows, a part that lies elsewhere from a day on; two sound ones. tests/studies/fleet.sh runs it and
/// tells its time.
#[test]
#[ignore = "takes three minutes: tests/studies/fleet.sh"]
fn two_hundred_recordings_of_five_devices_over_forty_days() {
    let bench = Bench::new("plate_edge_ideal");
    let folder = bench.path("");
    let planted = |device: u64, day: u64| match (device, day) {
        (2, 15..) => Some(("coulomb_viscous_friction", 0.3)),
        (3, 21..) => Some(("external_leakage", 0.03 * (day - 20) as f64)),
        (5, 28..) => Some(("surface_offset", 0.3)),
        _ => None,
    };
    for device in 1..=5 {
        for day in 0..40 {
            let session = recipe(4, planted(device, day)).session(device, 1 + 100 * device + day);
            let dated = format!(
                "recorded/device-{device}/{}",
                date_of_day((FIRST + day) as f64)
            );
            let rig = (device == 1 && day == 0).then(|| folder.join("rig.toml"));
            write_session(&session.unwrap(), &folder.join(dated), rig.as_deref()).unwrap();
        }
    }
    let begin = std::time::Instant::now();
    let (outcome, found) = fleet(&bench);
    let seconds = begin.elapsed().as_secs_f64();
    println!(
        "{}{seconds:.0} s, {} searched",
        outcome.out, found["searched"]
    );
    for (place, device) in found["devices"].as_array().unwrap().iter().enumerate() {
        let (name, day) = match place + 1 {
            2 => ("friction", 15),
            3 => ("external_leakage", 20),
            5 => ("surface_offset", 28),
            _ => {
                assert_eq!(device["effects"], serde_json::json!([]), "{device}");
                assert_eq!(device["changed"], serde_json::json!([]), "{device}");
                continue;
            }
        };
        let effect = &device["effects"][0];
        assert!(effect["name"].as_str().unwrap().contains(name), "{effect}");
        let near: Vec<String> = (day - 2..=day + 2)
            .map(|day| date_of_day((FIRST + day) as f64))
            .collect();
        let since = effect["since"]["date"].as_str().unwrap_or("").to_owned();
        assert!(near.contains(&since), "{effect}: not within {near:?}");
    }
    for device in 1..=5 {
        record(&folder, device, 40, 0.0);
    }
    let before = written(&bench);
    fleet(&bench);
    let after = written(&bench);
    assert!(before.iter().all(|(name, time)| after[name] == *time));
    assert_eq!(after.len(), before.len() + 5);
}

#[test]
fn a_folder_without_dates_and_a_scenario_that_is_gone_are_refused() {
    let bench = Bench::new("plate_edge_ideal");
    let refused = |arguments: &[&str], expected: &str| {
        let outcome = bench.idc(arguments, &[]);
        assert_eq!(outcome.code, 2, "{arguments:?}");
        assert!(
            outcome.only_line("error").contains(expected),
            "{}",
            outcome.err
        );
        assert!(!bench.path("out").exists());
    };
    std::fs::create_dir_all(bench.path("recorded/device/monday")).unwrap();
    let fleet = |scenario| ["fleet", "recorded", "--scenario", scenario, "--out", "out"];
    refused(&fleet("scenario.toml"), "expected recorded/DEVICE/DATE");
    refused(&fleet("gone.toml"), "gone.toml");
}
