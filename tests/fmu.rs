//! A bench as a co-simulation unit, driven from here as an importer drives it, against a run of the same bench; and the file that `idc export fmu` writes.
//!
//! `.ci/fmu` does the same through the shared library, by FMPy.

use std::collections::BTreeMap;
use std::f64::consts::TAU;
use std::io::Read as _;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use idc_cell::fmu::{Causality, Instance, MARK, Model};
use idc_cell::recording::{Recording, schema};
use idc_cell::rig::Rig;
use idc_cell::scenario::bench::{BenchScenario, CommandScenario, LoadScenario};
use idc_cell::unit::column_name;

use crate::common::project;
use crate::program::Bench;

/// A bench that does all at once: two effects as a diagnosis finds them, a surface that moves, stairs, the valve.
const FOUND: &str = "
[[effect]]
name = \"stribeck_friction\"
coulomb_force_n = 9
static_force_n = 15
stribeck_velocity_m_per_s = 0.008
viscous_coefficient_n_s_per_m = 60
presliding_displacement_m = 3e-5

[[effect]]
name = \"cross_piston_leakage\"
orifice_area_m2 = 4e-8
";

/// A scenario of the project in a folder of its own, with more text at its end.
fn bench(name: &str, more: &str) -> Bench {
    let bench = Bench::new(name);
    let text = std::fs::read_to_string(bench.path("scenario.toml")).unwrap();
    bench.write("scenario.toml", text + more);
    bench
}

/// A surface that goes to and fro by set pressures that change.
fn moved() -> Bench {
    let bench = bench("hand_push", "");
    bench.replace(
        "scenario.toml",
        "force_n = 290",
        "set_pressure_bar_gauge = 1.8",
    );
    bench.replace("scenario.toml", "start_s = 4", "start_s = 2");
    bench.replace("scenario.toml", "duration_s = 12", "duration_s = 5");
    bench
}

fn instance(path: &Path) -> Instance {
    Instance::new(Arc::new(Model::load(path).unwrap()))
}

/// Value references by name.
fn references(instance: &Instance) -> BTreeMap<String, u32> {
    let all = instance.model().variables.iter().enumerate();
    all.map(|(at, variable)| (variable.name.clone(), at as u32))
        .collect()
}

/// The last value whose time has come.
fn held<T: Copy>(steps: &[(f64, T)], time: f64) -> Option<T> {
    let due = steps.iter().rev().find(|(at, _)| *at <= time + 1e-9);
    due.map(|(_, value)| *value)
}

/// Says what a scenario's inputs are at a time [s], by its formulas.
fn say(instance: &mut Instance, at: &BTreeMap<String, u32>, scenario: &BenchScenario, time: f64) {
    let CommandScenario::SetPressure(steps) = &scenario.command else {
        panic!("set pressures are asked for");
    };
    let set = |instance: &mut Instance, name: &str, value: f64| {
        instance.set_real(at[name], value).unwrap();
    };
    let pressure = held(steps, time).unwrap_or(0.0);
    set(instance, "set_pressure_gauge_pa", pressure);
    let extends = held(&scenario.valve, time).is_none_or(|valve| valve.supplied() == 0);
    instance.set_boolean(at["valve_extends"], extends).unwrap();
    let LoadScenario::Contact {
        position,
        motion: Some(motion),
    } = scenario.load
    else {
        return;
    };
    let (rate, since) = (TAU * motion.frequency, time - motion.start);
    let [mut moved, mut speed, mut acceleration] = [0.0; 3];
    if since >= 0.0 {
        moved = 0.5 * motion.peak_to_peak * (1.0 - (rate * since).cos());
        speed = 0.5 * motion.peak_to_peak * rate * (rate * since).sin();
        acceleration = 0.5 * motion.peak_to_peak * rate * rate * (rate * since).cos();
    }
    set(instance, "surface_position_m", position - moved);
    set(instance, "surface_speed_m_per_s", -speed);
    set(instance, "surface_acceleration_m_per_s2", -acceleration);
}

/// Outputs at each communication point, by name, of steps of a length [s].
fn driven(path: &Path, step: f64) -> BTreeMap<String, Vec<f64>> {
    let mut instance = instance(path);
    let at = references(&instance);
    let scenario = instance.model().scenario.clone();
    let outputs: Vec<String> = (instance.model().variables.iter())
        .filter(|variable| variable.causality == Causality::Output)
        .map(|variable| variable.name.clone())
        .collect();
    let mut found: BTreeMap<String, Vec<f64>> = BTreeMap::new();
    let mut note = |instance: &mut Instance| {
        for name in &outputs {
            let value = instance.real(at[name]).unwrap();
            found.entry(name.clone()).or_default().push(value);
        }
    };
    say(&mut instance, &at, &scenario, 0.0);
    instance.initialize();
    note(&mut instance);
    for index in 0..(scenario.duration / step).round() as usize {
        let time = index as f64 * step;
        say(&mut instance, &at, &scenario, time);
        instance.step(time, step).unwrap();
        note(&mut instance);
    }
    found
}

fn recorded(path: &Path) -> Recording {
    let (recording, stop) = Rig::load(path).unwrap().run(&mut |_| ()).unwrap();
    assert!(stop.is_none(), "{stop:?}");
    recording
}

/// Largest difference of a signal over its largest value, `every` steps of the bench.
fn difference(
    recording: &Recording,
    found: &BTreeMap<String, Vec<f64>>,
    signal: &str,
    every: usize,
) -> f64 {
    let unit = schema::definition(signal).unwrap().unit;
    let own = &found[&column_name(signal, unit)];
    let expected: Vec<f64> = (recording.values(signal).unwrap().iter())
        .step_by(every)
        .copied()
        .collect();
    assert_eq!(own.len(), expected.len());
    let largest = expected
        .iter()
        .fold(0.0f64, |most, value| most.max(value.abs()));
    assert!(
        largest > 0.0 || signal == schema::CONTACT_FORCE,
        "{signal} is nothing"
    );
    let pairs = own.iter().zip(&expected);
    pairs.fold(0.0f64, |most, (one, other)| most.max((one - other).abs()))
        / largest.max(f64::MIN_POSITIVE)
}

/// Step, stairs, moved surface, retraction, and with what a diagnosis found.
fn benches() -> Vec<(&'static str, Bench)> {
    let found = moved();
    let text = std::fs::read_to_string(found.path("scenario.toml")).unwrap();
    found.write("scenario.toml", text + FOUND);
    vec![
        ("step", bench("paper_step", "")),
        ("stairs", bench("paper_stairstep", "")),
        ("moved surface", moved()),
        ("retract", bench("retract", "")),
        ("found in a step", bench("paper_step", FOUND)),
        ("found with a moved surface", found),
    ]
}

#[test]
fn at_the_bench_s_step_a_unit_has_its_numbers_and_at_ten_times_that_nearly() {
    for (name, bench) in benches() {
        let path = bench.path("scenario.toml");
        let recording = recorded(&path);
        let signals = [
            (schema::CONTACT_FORCE, 1e-6, 1e-3),
            (schema::STROKE, 1e-6, 1e-3),
            (schema::CHAMBER_1_PRESSURE, 1e-6, 1e-3),
            (schema::MEASURED_STROKE, 1e-6, 1e-3),
        ];
        for (step, every) in [(1e-3, 1), (1e-2, 10)] {
            let found = driven(&path, step);
            for (signal, fine, coarse) in signals {
                let bound = if every == 1 { fine } else { coarse };
                let off = difference(&recording, &found, signal, every);
                println!("{name}, {step} s, {signal}: {off:.1e}");
                assert!(off <= bound, "{name}, {step} s: {signal} is off by {off}");
            }
        }
    }
}

/// Steps that are no multiple of the bench's: shorter ones, a prime number of microseconds.
#[test]
fn a_step_of_any_length_comes_near() {
    let bench = moved();
    let path = bench.path("scenario.toml");
    let recording = recorded(&path);
    let mut instance = instance(&path);
    let at = references(&instance);
    let scenario = instance.model().scenario.clone();
    say(&mut instance, &at, &scenario, 0.0);
    instance.initialize();
    let (mut time, mut index, mut most) = (0.0, 0usize, 0.0f64);
    let forces = recording.values(schema::CONTACT_FORCE).unwrap();
    while time < 4.0 {
        say(&mut instance, &at, &scenario, time);
        let length = [3.7e-3, 0.4e-3, 2.1e-3][index % 3];
        instance.step(time, length).unwrap();
        time += length;
        index += 1;
        let place = (time / scenario.step).floor() as usize;
        let share = time / scenario.step - place as f64;
        let expected = forces[place] + share * (forces[place + 1] - forces[place]);
        // Past the first contact, whose blow lasts a few steps.
        if time > 1.5 {
            let force = instance.real(at["contact_force_n"]).unwrap();
            most = most.max((force - expected).abs());
        }
    }
    assert!(most < 0.3, "{most} N of 290");
    assert!((instance.time() - time).abs() < 1e-9);
}

#[test]
fn a_saved_state_repeats_to_the_bit() {
    let bench = moved();
    // Sensors with noise remember where they are in it.
    let text = std::fs::read_to_string(bench.path("scenario.toml")).unwrap();
    bench.write(
        "scenario.toml",
        text + "\n[sensing]\npreset = \"white\"\n" + FOUND,
    );
    let path = bench.path("scenario.toml");
    let mut unit = instance(&path);
    let at = references(&unit);
    let scenario = unit.model().scenario.clone();
    let from = |unit: &mut Instance, first: usize, count: usize| {
        let mut values = Vec::new();
        for index in first..first + count {
            let time = index as f64 * 2e-3;
            say(unit, &at, &scenario, time);
            unit.step(time, 2e-3).unwrap();
            for name in [
                "contact_force_n",
                "stroke_m",
                "measured_force_n",
                "seal_force_n",
            ] {
                values.push(unit.real(at[name]).unwrap().to_bits());
            }
        }
        values
    };
    unit.initialize();
    from(&mut unit, 0, 1100);
    let state = unit.save();
    let once = from(&mut unit, 1100, 400);
    // Whatever happens in between is gone, a changed number too.
    unit.set_real(at["cylinder.moving_mass_kg"], 9.0).unwrap();
    from(&mut unit, 1500, 100);
    unit.restore(&state);
    assert_eq!(once, from(&mut unit, 1100, 400));
    // And another instance goes on from there as well.
    let mut other = instance(&path);
    other.restore(&state);
    assert_eq!(once, from(&mut other, 1100, 400));
}

/// The same number by the importer and by the scenario's key, which is another way into the description.
#[test]
fn a_number_that_is_tuned_is_that_of_the_scenario_s_key() {
    for (variable, value, key, in_file) in [
        (
            "regulator.time_constant_s",
            0.3,
            "regulator_time_constant_s",
            "0.3",
        ),
        (
            "regulator.dead_time_s",
            0.1,
            "regulator_dead_time_ms",
            "100",
        ),
        ("cylinder.moving_mass_kg", 6.0, "moving_mass_kg", "6"),
        (
            "leak.cross_piston_m2",
            5e-8,
            "cross_piston_leak_mm2",
            "0.05",
        ),
        ("valve.supply_orifice_m2", 1e-6, "supply_orifice_mm2", "1"),
        ("cylinder.bore_m", 0.025, "bore_mm", "25"),
    ] {
        let set = format!("device.override.{key}={in_file}");
        let plain = bench("paper_step", "");
        let other =
            idc_cell::scenario::ScenarioTemplate::read(&plain.path("scenario.toml")).unwrap();
        let (key, text) = set.split_once('=').unwrap();
        let typed = idc_cell::scenario::KeyValue::typed(key, text);
        plain.write("other.toml", other.text(&[typed]).unwrap());
        let tuned = |step: bool| {
            let mut unit = instance(&plain.path("scenario.toml"));
            let at = references(&unit);
            if step {
                unit.set_real(at[variable], value).unwrap();
                assert_eq!(unit.real(at[variable]).unwrap(), value);
            }
            unit.initialize();
            unit.set_real(at["set_pressure_gauge_pa"], 1.8e5).unwrap();
            unit.step(0.0, 1.2).unwrap();
            unit.real(at["chamber_1_pressure_pa"]).unwrap()
        };
        let mut by_key = instance(&plain.path("other.toml"));
        let at = references(&by_key);
        by_key.initialize();
        by_key.set_real(at["set_pressure_gauge_pa"], 1.8e5).unwrap();
        by_key.step(0.0, 1.2).unwrap();
        let expected = by_key.real(at["chamber_1_pressure_pa"]).unwrap();
        assert_eq!(tuned(true), expected, "{variable}");
        assert_ne!(tuned(false), expected, "{variable} changes nothing");
    }
}

/// Between two steps a number changes what comes, and nothing of what was.
#[test]
fn a_number_may_change_between_steps() {
    let bench = bench("paper_step", "");
    let run = |change: bool| {
        let mut unit = instance(&bench.path("scenario.toml"));
        let at = references(&unit);
        unit.initialize();
        unit.set_real(at["set_pressure_gauge_pa"], 1.8e5).unwrap();
        unit.step(0.0, 4.0).unwrap();
        let before = unit.real(at["contact_force_n"]).unwrap();
        if change {
            unit.set_real(at["regulator.gain"], 0.5).unwrap();
        }
        unit.step(4.0, 6.0).unwrap();
        [before, unit.real(at["contact_force_n"]).unwrap()]
    };
    let (plain, halved) = (run(false), run(true));
    assert_eq!(plain[0], halved[0]);
    assert!(
        (halved[1] / plain[1] - 0.5).abs() < 1e-2,
        "{plain:?} {halved:?}"
    );
}

#[test]
fn what_cannot_be_set_is_refused_and_changes_nothing() {
    let bench = bench("retract", "");
    let mut unit = instance(&bench.path("scenario.toml"));
    let at = references(&unit);
    assert!(!at.contains_key("surface_position_m"), "nothing is met");
    let mut refused = |name: &str, value: f64, expected: &str| {
        let before = unit.real(at[name]).unwrap();
        let error = unit.set_real(at[name], value).unwrap_err().to_string();
        assert!(error.contains(name) && error.contains(expected), "{error}");
        assert_eq!(unit.real(at[name]).unwrap(), before);
    };
    refused("cylinder.bore_m", 0.5, "expected 0.002 to 0.3 m");
    refused(
        "cylinder.rod_m",
        0.033,
        "the rod less than the bore, 0.032 m",
    );
    refused("cylinder.count", 1.5, "a whole number");
    refused("set_pressure_gauge_pa", f64::NAN, "a finite number");
    refused("contact_force_n", 1.0, "expected an input");
    unit.initialize();
    let start = at["bench.start_stroke_m"];
    let error = unit.set_real(start, 0.01).unwrap_err().to_string();
    assert!(error.contains("after the initialization"), "{error}");
    for (point, length, expected) in [
        (1.0, 1e-3, "expected 0 s"),
        (0.0, 0.0, "above 0"),
        (0.0, f64::INFINITY, "at most 3600 s"),
        (f64::NAN, 1e-3, "expected 0 s"),
    ] {
        let error = unit.step(point, length).unwrap_err().to_string();
        assert!(error.contains(expected), "{error}");
    }
    let error = unit.real(10_000).unwrap_err().to_string();
    assert!(error.contains("10000"), "{error}");
    assert_eq!(unit.time(), 0.0);
}

/// A file that passes for the library: it holds its mark.
fn marked(bench: &Bench) {
    bench.write("library.so", format!("\u{7f}ELF {MARK} and more"));
}

fn exported(bench: &Bench, file: &str, fmi: &str) -> BTreeMap<String, Vec<u8>> {
    marked(bench);
    let arguments = [
        "export",
        "fmu",
        file,
        "--fmi",
        fmi,
        "--library",
        "library.so",
        "--out",
        "unit.fmu",
        "--force",
    ];
    let done = bench.idc(&arguments, &[]);
    assert_eq!(done.code, 0, "{}", done.err);
    let bytes = std::fs::read(bench.path("unit.fmu")).unwrap();
    let mut archive = zip::ZipArchive::new(std::io::Cursor::new(bytes)).unwrap();
    let mut found = BTreeMap::new();
    for index in 0..archive.len() {
        let mut file = archive.by_index(index).unwrap();
        let mut content = Vec::new();
        file.read_to_end(&mut content).unwrap();
        found.insert(file.name().unwrap().into_owned(), content);
    }
    found
}

#[test]
fn a_unit_holds_all_that_it_reads_and_lists_its_variables() {
    for (fmi, folder, token) in [
        ("2", "linux64", "guid"),
        ("3", "x86_64-linux", "instantiationToken"),
    ] {
        let bench = bench("paper_step", FOUND);
        // The device lies elsewhere under another name.
        std::fs::create_dir(bench.path("own")).unwrap();
        std::fs::rename(bench.path("device.toml"), bench.path("own/mine.toml")).unwrap();
        bench.replace("scenario.toml", "\"device.toml\"", "\"own/mine.toml\"");
        let files = exported(&bench, "scenario.toml", fmi);
        let names: Vec<&str> = files.keys().map(String::as_str).collect();
        let library = format!("binaries/{folder}/idc_device.so");
        let expected = [
            &library,
            "modelDescription.xml",
            "resources/device.toml",
            "resources/scenario.toml",
        ];
        assert_eq!(names, expected);
        // Elsewhere it reads as the scenario that it was.
        let elsewhere = tempfile::tempdir().unwrap();
        for name in ["device.toml", "scenario.toml"] {
            std::fs::write(
                elsewhere.path().join(name),
                &files[&format!("resources/{name}")],
            )
            .unwrap();
        }
        let place: PathBuf = elsewhere.path().join("scenario.toml");
        let model = Model::load(&place).unwrap();
        let text = String::from_utf8(files["modelDescription.xml"].clone()).unwrap();
        let xml = roxmltree::Document::parse(&text).unwrap();
        assert_eq!(
            xml.root_element().attribute(token),
            Some(model.token.as_str())
        );
        let listed: Vec<_> = (xml.descendants())
            .filter(|node| node.has_attribute("causality"))
            .map(|node| {
                (
                    node.attribute("name").unwrap(),
                    node.attribute("valueReference").unwrap(),
                )
            })
            .collect();
        let own: Vec<(&str, String)> = (model.variables.iter().enumerate())
            .map(|(at, variable)| (variable.name.as_str(), at.to_string()))
            .collect();
        let own: Vec<(&str, &str)> = own.iter().map(|(name, at)| (*name, at.as_str())).collect();
        assert_eq!(listed, own);
        // What was found is in it.
        let variable = |name: &str| model.variables.iter().find(|v| v.name == name).unwrap();
        assert_eq!(variable("leak.cross_piston_m2").start, Some(4e-8));
        assert_eq!(variable("seal.coulomb_force_n").start, Some(9.0));
        let once = std::fs::read(bench.path("unit.fmu")).unwrap();
        exported(&bench, "scenario.toml", fmi);
        assert_eq!(once, std::fs::read(bench.path("unit.fmu")).unwrap());
    }
}

#[test]
fn a_rig_file_is_put_on_a_bench() {
    let bench = bench("paper_step", "");
    let rig = std::fs::read_to_string(project("assets/new/rig.toml")).unwrap();
    bench.write("improved.toml", rig + FOUND);
    let files = exported(&bench, "improved.toml", "3");
    let folder = tempfile::tempdir().unwrap();
    for name in ["device.toml", "scenario.toml"] {
        std::fs::write(
            folder.path().join(name),
            &files[&format!("resources/{name}")],
        )
        .unwrap();
    }
    let mut unit = instance(&folder.path().join("scenario.toml"));
    let at = references(&unit);
    unit.initialize();
    unit.set_real(at["set_pressure_gauge_pa"], 1.8e5).unwrap();
    unit.step(0.0, 5.0).unwrap();
    // The same rig on a bench that is written here.
    let own = "schema = 2\nkind = \"bench\"\ntitle = \"own\"\n[device]\nmodel = \"improved.toml\"\n[bench]\nduration_s = 5\n[load]\nkind = \"load_cell\"\nposition_mm = 49.6\n[[command]]\nat_s = 0\nset_pressure_bar_gauge = 1.8\n";
    bench.write("own.toml", own);
    let recording = recorded(&bench.path("own.toml"));
    for (signal, name) in [
        (schema::CONTACT_FORCE, "contact_force_n"),
        (schema::STROKE, "stroke_m"),
    ] {
        let expected = *recording.values(signal).unwrap().last().unwrap();
        assert_eq!(unit.real(at[name]).unwrap(), expected, "{name}");
        assert!(expected > 0.0);
    }
}

/// Once its `[device]` passed for that of a scenario, and a key of it was called unknown.
#[test]
fn a_device_model_is_put_on_a_bench() {
    let bench = bench("paper_step", "");
    let files = exported(&bench, "device.toml", "3");
    let own = std::fs::read(bench.path("device.toml")).unwrap();
    assert!(files["resources/device.toml"] == own);
    bench.write("unit.toml", &files["resources/scenario.toml"]);
    let mut unit = instance(&bench.path("unit.toml"));
    let at = references(&unit);
    unit.initialize();
    unit.set_real(at["set_pressure_gauge_pa"], 1.8e5).unwrap();
    unit.step(0.0, 5.0).unwrap();
    // 1.8 bar on two pistons of 32 mm, less what its seals hold.
    let expected = 1.8e5 * std::f64::consts::PI * 0.016 * 0.016 * 2.0;
    let force = unit.real(at["contact_force_n"]).unwrap();
    assert!((0.96..1.0).contains(&(force / expected)), "{force}");
}

#[test]
fn what_cannot_be_a_unit_is_refused_and_nothing_is_written() {
    let with = |file: &str, from: &str, to: &str| {
        let bench = bench("paper_step", "");
        let cell = std::fs::read_to_string(project("scenarios/plate_edge.toml")).unwrap();
        let local = cell
            .replace("../models/arm/arm10.urdf", "arm.urdf")
            .replace("../models/device.toml", "device.toml")
            .replace("../assets/plate.stl", "part.stl");
        bench.write("cell.toml", local);
        let rig = std::fs::read_to_string(project("assets/new/rig.toml")).unwrap();
        bench.write("rig.toml", rig);
        marked(&bench);
        bench.write("other.so", "another library");
        if !from.is_empty() {
            bench.replace(file, from, to);
        }
        bench
    };
    for (file, from, to, library, expected) in [
        (
            "cell.toml",
            "",
            "",
            "library.so",
            vec!["cell.toml", "kind = \"bench\""],
        ),
        (
            "rig.toml",
            "bore_m = 0.0211",
            "bore_m = 0.9",
            "library.so",
            vec!["rig.toml", "bore_m", "0.002 to 0.3"],
        ),
        (
            "scenario.toml",
            "duration_s = 6",
            "duration_s = -6",
            "library.so",
            vec!["scenario.toml", "bench.duration_s"],
        ),
        ("absent.toml", "", "", "library.so", vec!["absent.toml"]),
        (
            "scenario.toml",
            "",
            "",
            "other.so",
            vec!["other.so", "cargo build", "co_simulation_unit"],
        ),
        (
            "scenario.toml",
            "",
            "",
            "absent.so",
            vec!["absent.so", "cargo build", "co_simulation_unit"],
        ),
    ] {
        let bench = with(file, from, to);
        let before = bench.contents();
        let arguments = [
            "export",
            "fmu",
            file,
            "--library",
            library,
            "--out",
            "below/unit.fmu",
        ];
        let refused = bench.idc(&arguments, &[]);
        assert_eq!(refused.code, 2, "{file}: {}", refused.out);
        refused.only_line("error");
        for words in expected.iter().chain(&["expected"]) {
            // A file that is not there: its system says so.
            assert!(
                refused.sentences().contains(words) || file == "absent.toml",
                "{words}: {}",
                refused.err
            );
        }
        assert_eq!(before, bench.contents(), "{file}: something was written");
    }
    // One that stands is kept.
    let bench = with("scenario.toml", "", "");
    bench.write("unit.fmu", "mine");
    let arguments = [
        "export",
        "fmu",
        "scenario.toml",
        "--library",
        "library.so",
        "--out",
        "unit.fmu",
    ];
    let refused = bench.idc(&arguments, &[]);
    assert_eq!(refused.code, 2);
    assert!(refused.sentences().contains("--force"), "{}", refused.err);
    assert_eq!(std::fs::read(bench.path("unit.fmu")).unwrap(), b"mine");
}
