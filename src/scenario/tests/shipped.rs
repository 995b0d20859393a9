//! The files that come with the project.

use super::super::{EdgeSelection, load, load_device};
use super::scenarios;

/// Every scenario file shipped, by name.
fn shipped() -> Vec<String> {
    let mut names: Vec<String> = std::fs::read_dir(scenarios())
        .unwrap()
        .filter_map(|entry| entry.unwrap().file_name().into_string().ok())
        .filter_map(|name| name.strip_suffix(".toml").map(str::to_owned))
        .collect();
    names.sort();
    names
}

#[test]
fn every_scenario_loads_says_what_it_shows_and_stands_in_the_readme() {
    let readme = std::fs::read_to_string(scenarios().join("README.md")).unwrap();
    let names = shipped();
    for expected in [
        "bracket_loop",
        "burred_edge",
        "locked_tool",
        "misplaced_part",
        "plate_edge",
        "tilted_wrist",
        "weak_supply",
    ] {
        assert!(names.iter().any(|name| name == expected), "no {expected}");
    }
    for name in names {
        let path = scenarios().join(format!("{name}.toml"));
        let scenario = load(&path).unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(scenario.path, path);
        let text = std::fs::read_to_string(&path).unwrap();
        assert!(
            text.starts_with("# ") && text.contains("# Should happen: "),
            "{name}"
        );
        assert!(readme.contains(&format!("[{name}]({name}.toml)")), "{name}");
        // What is refused has no results to bound.
        assert_eq!(scenario.expect.is_empty(), name == "weak_supply", "{name}");
    }
}

#[test]
fn the_plate_edge_is_the_nominal_job() {
    let scenario = load(&scenarios().join("plate_edge.toml")).unwrap();
    assert_eq!(scenario.process.force, 150.0);
    assert_eq!(scenario.process.feed, 0.02);
    assert_eq!(scenario.process.working_stroke, 0.025);
    assert_eq!(scenario.workpiece.mesh_scale, 1e-3);
    assert_eq!(scenario.workpiece.edge.selection, EdgeSelection::Edge(1));
    assert!(!scenario.device.locked);
    let variation = "coefficient_of_variation_percent";
    let bound = scenario
        .expect
        .iter()
        .find(|bound| bound.metric == variation)
        .unwrap();
    assert_eq!((bound.min, bound.max), (None, Some(1.0)));
}

#[test]
fn locked_tool_is_misplaced_part_but_for_the_lock() {
    let free = load(&scenarios().join("misplaced_part.toml")).unwrap();
    let mut locked = load(&scenarios().join("locked_tool.toml")).unwrap();
    assert!(locked.device.locked && !free.device.locked);
    locked.device.locked = false;
    locked.path.clone_from(&free.path);
    locked.title.clone_from(&free.title);
    locked.expect.clone_from(&free.expect);
    assert_eq!(format!("{locked:?}"), format!("{free:?}"));
}

#[test]
fn the_device_model_is_the_device_of_the_issue() {
    let device = load_device(&scenarios().join("../models/device.toml")).unwrap();
    let parameters = &device.parameters;
    assert!((3e5 * parameters.areas().extending - 482.5).abs() < 0.1);
    assert_eq!(
        (parameters.full_stroke, parameters.dead_volume),
        (0.05, 2e-5)
    );
    assert_eq!(
        (parameters.supply_orifice, parameters.exhaust_orifice),
        (2.5e-6, 2e-6)
    );
    assert_eq!(
        (parameters.moving_mass, parameters.discharge_coefficient),
        (4.0, 0.95)
    );
    let regulator = parameters.regulator;
    assert_eq!((regulator.time_constant, regulator.dead_time), (0.15, 0.02));
    assert_eq!((regulator.gain, regulator.supply), (1.0, 6e5));
    assert_eq!(parameters.gas, crate::physics::gas::Gas::default());
    let stop = parameters.end_stop;
    assert_eq!((stop.stiffness, stop.damping), (1e6, 2e3));
    assert_eq!(parameters.lock_stiffness, 1e8);
    assert_eq!((device.tool_centre, device.tool_radius), (0.15, 0.005));
    assert_eq!(
        (
            device.moving_centre_of_mass,
            device.moving_radius_of_gyration
        ),
        (0.1, 0.05)
    );
    assert!(!device.locked);
}
