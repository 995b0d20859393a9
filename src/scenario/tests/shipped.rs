//! The files that come with the project.

use super::super::bench::{CommandScenario, LoadScenario};
use super::super::device::load_with_overrides;
use super::super::{
    AnyScenario, EdgeSelection, ScenarioError, load, load_any, load_bench, load_device,
};
use super::{MINIMAL, read_any, scenarios};
use crate::device::DeviceParameters;
use crate::physics::gas_process::GasProcess;
use crate::physics::valve::ValvePosition;
use crate::plant::ContactParameters;

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
fn every_scenario_loads_says_what_it_shows_and_is_in_the_readme() {
    let readme = std::fs::read_to_string(scenarios().join("README.md")).unwrap();
    let names = shipped();
    for expected in [
        "bracket_loop",
        "burred_edge",
        "hand_push",
        "locked_tool",
        "misplaced_part",
        "moving_surface",
        "paper_stairstep",
        "paper_step",
        "plate_edge",
        "plate_edge_ideal",
        "retract",
        "tilted_wrist",
        "weak_supply",
    ] {
        assert!(names.iter().any(|name| name == expected), "no {expected}");
    }
    for name in names {
        let path = scenarios().join(format!("{name}.toml"));
        let text = std::fs::read_to_string(&path).unwrap();
        assert!(
            text.starts_with("# ") && text.contains("# Should happen: "),
            "{name}"
        );
        let link = format!("| [{name}]({name}.toml) | ");
        let row = readme.lines().find_map(|line| line.strip_prefix(&link));
        let row = row.unwrap_or_else(|| panic!("{name} has no row"));
        match load_any(&path).unwrap_or_else(|error| panic!("{error}")) {
            AnyScenario::Cell(cell) => {
                assert_eq!(cell.path, path);
                // What is refused has no results to bound.
                assert_eq!(cell.expect.is_empty(), name == "weak_supply", "{name}");
                assert!(!row.starts_with("bench: "), "{name}");
            }
            AnyScenario::Bench(bench) => {
                assert_eq!(bench.path, path);
                assert!(row.starts_with("bench: "), "{name}");
            }
        }
    }
}

#[test]
fn the_papers_benches_are_what_the_paper_did() {
    let bench = |name: &str| load_bench(&scenarios().join(format!("{name}.toml"))).unwrap();
    for (name, steps) in [
        ("paper_step", &[(0.5, 1.8e5)][..]),
        (
            "paper_stairstep",
            &[(0.5, 1.2e5), (5.5, 2.1e5), (10.5, 3e5)],
        ),
    ] {
        let bench = bench(name);
        assert_eq!(bench.command, CommandScenario::SetPressure(steps.to_vec()));
        let LoadScenario::Contact { motion, .. } = bench.load else {
            panic!("{:?}", bench.load)
        };
        assert_eq!(motion, None);
    }
    let LoadScenario::Contact {
        motion: Some(motion),
        ..
    } = bench("hand_push").load
    else {
        panic!("the hand does not move")
    };
    assert_eq!((motion.peak_to_peak, motion.frequency), (0.02, 0.5));
    let retract = bench("retract");
    let positions = [(2.5, ValvePosition::Retract), (4.5, ValvePosition::Extend)];
    assert_eq!(retract.valve, positions);
    assert_eq!(retract.load, LoadScenario::Free);
}

#[test]
fn each_kind_is_refused_where_the_other_is_asked_for() {
    let path = |name: &str| scenarios().join(format!("{name}.toml"));
    let message = load(&path("paper_step")).unwrap_err().to_string();
    assert!(
        message.ends_with("paper_step.toml: the scenario is a bench, expected a cell"),
        "{message}"
    );
    let message = load_bench(&path("plate_edge")).unwrap_err().to_string();
    assert!(
        message.ends_with("plate_edge.toml: the scenario is a cell, expected a bench"),
        "{message}"
    );
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
    assert_eq!(locked.controller.law, free.controller.law);
    locked.controller.clone_from(&free.controller);
    assert_eq!(format!("{locked:?}"), format!("{free:?}"));
}

#[test]
fn the_device_model_is_the_device_of_the_issue() {
    let model = scenarios().join("../models/device.toml");
    let (device, plant) = load_with_overrides(&model, None, true).unwrap();
    let parameters = &plant.device;
    assert_eq!(*parameters, DeviceParameters::default());
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
    // As in the source paper: no friction of the seals, no heat, no line.
    let seals = parameters.seal_friction;
    assert_eq!(
        (seals.coulomb, seals.static_force, seals.viscous),
        (0.0, 0.0, 0.0)
    );
    assert_eq!(parameters.gas_process, GasProcess::Isothermal);
    assert_eq!(parameters.hose, None);
    let mounting = plant.mounting;
    assert_eq!((mounting.tool_centre, mounting.tool_radius), (0.15, 0.005));
    assert_eq!(
        (
            mounting.moving_centre_of_mass,
            mounting.moving_radius_of_gyration
        ),
        (0.1, 0.05)
    );
    assert!(!device.locked && device.ideal);
    // A device that exists has its seals and its heat besides, and no more.
    let (real, plant) = load_device(&model).unwrap();
    assert!(!real.ideal);
    let seals = plant.device.seal_friction;
    assert_eq!(
        (seals.coulomb, seals.static_force, seals.viscous),
        (10.0, 14.0, 50.0)
    );
    assert_eq!(
        plant.device.gas_process,
        GasProcess::WallHeat { conductance: 0.5 }
    );
    let without = DeviceParameters {
        seal_friction: DeviceParameters::default().seal_friction,
        gas_process: DeviceParameters::default().gas_process,
        ..plant.device
    };
    assert_eq!(without, DeviceParameters::default());
}

#[test]
fn what_a_scenario_gives_precedes_what_makes_its_device_ideal() {
    let with = |lines: &str| {
        let (before, after) = MINIMAL.split_once("[workpiece]").unwrap();
        let AnyScenario::Cell(cell) = read_any(&format!("{before}{lines}\n[workpiece]{after}"))?
        else {
            panic!("a cell")
        };
        Ok::<_, ScenarioError>(cell)
    };
    let cell = with("ideal = true\n[device.override]\nseal_static_force_n = 3").unwrap();
    let seals = cell.nominal.device.seal_friction;
    assert_eq!((seals.coulomb, seals.static_force), (0.0, 3.0));
    assert_eq!(cell.nominal.contact, ContactParameters::linear(1.5e5, 4e2));
    let real = with("").unwrap();
    assert_eq!(real.nominal.contact, ContactParameters::linear(8.5e5, 2e2));
    // The breakaway force that makes it ideal stands nowhere, so that it cannot be pointed at.
    let message = with("ideal = true\n[device.override]\nseal_coulomb_force_n = 3")
        .unwrap_err()
        .to_string();
    assert!(
        message.contains("`device.override.seal_static_force_n` is missing")
            && message.contains("at least seal_coulomb_force_n"),
        "{message}"
    );
}
