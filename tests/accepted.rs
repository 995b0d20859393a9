//! What must hold of every scenario that is accepted, whatever it says: its run is finite, the same twice, loses neither air nor energy and keeps within the
//! ends of its stroke. One that is not accepted is refused in one line, and leaves nothing.
//!
//! Scenarios are drawn from the key tables of scenarios/README.md, within each key's range, at its ends and just beyond them, by a fixed seed.

use std::cell::Cell as Counter;
use std::fmt::Write as _;

use idc_cell::cell::Cell;
use idc_cell::device::{Device, DeviceParameters};
use idc_cell::recording::{Recording, schema};
use idc_cell::rig::Rig;
use idc_cell::run::{run_bench, run_cell};
use proptest::prelude::*;
use proptest::test_runner::{Config, RngAlgorithm, TestCaseError, TestRng, TestRunner};

use crate::common::project;
use crate::program::Bench;

/// Gaps that are accepted: of the mass of the air, of the energy of the air by its work on the piston [1].
const AIR: f64 = 1e-9;
const ENERGY: f64 = 1e-6;

/// Scenarios of each kind of load.
const CASES: u32 = 30;

/// A key with the ends of its range.
#[derive(Debug, Clone, PartialEq)]
struct Key {
    path: String,
    low: f64,
    high: f64,
    is_whole: bool,
}

impl Key {
    /// A value by its place in the range: 0 and 1 are the ends, less and more lie beyond them.
    fn at(&self, place: f64) -> f64 {
        let inside = (0.0..=1.0).contains(&place);
        let value = match self.low > 0.0 && self.high > 100.0 * self.low && inside {
            true => self.low * (self.high / self.low).powf(place),
            false => self.low + place * (self.high - self.low),
        };
        match (self.is_whole, inside) {
            (true, true) => value.round(),
            (true, false) if place < 0.0 => value.floor(),
            (true, false) => value.ceil(),
            (false, true) => value.clamp(self.low, self.high),
            (false, false) => value,
        }
    }
}

/// The keys of a number that may be changed alone, as the tables have them; those that only make a run longer are left out.
fn keys(is_meant: impl Fn(&str) -> bool) -> Vec<Key> {
    let text = std::fs::read_to_string(project("scenarios/README.md")).unwrap();
    let mut found: Vec<Key> = Vec::new();
    for line in text.lines().filter(|line| line.starts_with("| `")) {
        let cells: Vec<&str> = line.split('|').map(str::trim).collect();
        let (path, kind) = (cells[1].trim_matches('`'), cells[2]);
        // A range without an end goes as far as numbers do.
        let ends = match cells[4].strip_prefix("at least ") {
            Some(low) => Some((low, "1e300")),
            None => cells[4].split_once(" to "),
        };
        let Some((Ok(low), Ok(high))) = ends.map(|(low, high)| (low.parse(), high.parse())) else {
            continue;
        };
        let slow = path.ends_with("device_substeps") || path.ends_with("passes");
        if is_meant(path)
            && !slow
            && !kind.contains("list")
            && found.iter().all(|key| key.path != path)
        {
            found.push(Key {
                path: path.to_owned(),
                low: if path.ends_with("step_ms") { 0.25 } else { low },
                high,
                is_whole: kind == "whole number",
            });
        }
    }
    found
}

/// Some keys with the places of their values.
fn draws(count: usize) -> impl Strategy<Value = Vec<(usize, f64)>> {
    let place = prop_oneof![
        16 => 0.0..=1.0,
        2 => Just(0.0),
        2 => Just(1.0),
        1 => Just(-0.001),
        1 => Just(1.001),
    ];
    prop::collection::vec((0..count, place), 0..=4)
}

/// The text of a scenario with these keys set.
fn with_keys(base: &str, keys: &[Key], drawn: &[(usize, f64)]) -> String {
    let mut document: toml::Table = base.parse().unwrap();
    for (index, place) in drawn {
        let key = &keys[*index];
        let (tables, name) = key.path.rsplit_once('.').unwrap();
        let mut table = &mut document;
        for part in tables.split('.') {
            let inner = table.entry(part).or_insert(toml::Table::new().into());
            table = inner.as_table_mut().unwrap();
        }
        let value = key.at(*place);
        let value = match key.is_whole {
            true => toml::Value::Integer(value as i64),
            false => toml::Value::Float(value),
        };
        table.insert(name.to_owned(), value);
    }
    toml::to_string(&document).unwrap()
}

/// A run of this text by the program: refused in one line, with nothing left.
fn is_refused_at_once(text: &str, reason: &str) -> Result<(), TestCaseError> {
    prop_assert!(!reason.contains('\n') && !reason.is_empty(), "{}", reason);
    let bench = Bench::new("plate_edge_ideal");
    bench.write("scenario.toml", text);
    let before = bench.contents();
    let arguments = ["run", "scenario.toml", "--out", "out", "--effort", "0"];
    let outcome = bench.idc(&arguments, &[]);
    prop_assert_eq!(outcome.code, 2, "{}", outcome.err);
    outcome.only_line("error: ");
    prop_assert!(bench.contents() == before, "files were left");
    Ok(())
}

/// Finite, one as the other to the bit.
fn is_finite_and_the_same(one: &Recording, other: &Recording) -> Result<(), TestCaseError> {
    prop_assert_eq!(one.time(), other.time());
    for (channel, again) in one.channels().iter().zip(other.channels()) {
        let bits = |values: &[f64]| {
            values
                .iter()
                .map(|value| value.to_bits())
                .collect::<Vec<_>>()
        };
        prop_assert_eq!(
            bits(&channel.values),
            bits(&again.values),
            "{}",
            channel.quantity
        );
        let bad = channel.values.iter().position(|value| !value.is_finite());
        prop_assert_eq!(bad, None, "{}", channel.quantity);
    }
    Ok(())
}

/// Bounds on what is recorded, of the device's own numbers; `give` is how far the stops may give way [m].
fn is_within_bounds(
    recording: &Recording,
    own: &DeviceParameters,
    give: f64,
) -> Result<(), TestCaseError> {
    let extent = |name: &str| {
        let values = recording.values(name).unwrap();
        let low = values.iter().copied().fold(f64::INFINITY, f64::min);
        let high = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        (low, high)
    };
    let (low, high) = extent(schema::STROKE);
    prop_assert!(
        low > -give && high < own.full_stroke + give,
        "stroke {low} to {high} m, stops give {give} m"
    );
    let atmosphere = own.gas.atmosphere;
    let supply = (atmosphere + own.regulator.supply) * (1.0 + 1e-9);
    let (low, high) = extent(schema::REGULATOR_PRESSURE);
    prop_assert!(
        low > 0.999 * atmosphere && high < supply,
        "outlet {low} to {high} Pa of {supply} Pa"
    );
    // A piston that is thrown against its end squeezes the air behind it to more than the supply's pressure.
    for name in [schema::CHAMBER_1_PRESSURE, schema::CHAMBER_2_PRESSURE] {
        let (low, high) = extent(name);
        prop_assert!(low > 0.0 && high < 1e8, "{name} {low} to {high} Pa");
    }
    let (low, _) = extent(schema::CONTACT_FORCE);
    prop_assert!(low >= 0.0, "contact force {low} N");
    Ok(())
}

/// A failure with the scenario that it is of.
fn with_text(error: TestCaseError, text: &str) -> TestCaseError {
    match error {
        TestCaseError::Fail(reason) => TestCaseError::fail(format!("{reason}\nof\n{text}")),
        TestCaseError::Reject(reason) => TestCaseError::Reject(reason),
    }
}

fn runner(cases: u32) -> TestRunner {
    let config = Config {
        cases,
        failure_persistence: None,
        max_shrink_iters: 60,
        ..Config::default()
    };
    // The same scenarios on every machine and every day.
    TestRunner::new_with_rng(config, TestRng::deterministic_rng(RngAlgorithm::ChaCha))
}

const BENCHES: [(&str, &str); 4] = [
    (
        "free",
        "[load]\nkind = \"free\"\n[[command]]\nat_s = 0.05\nset_pressure_bar_gauge = 1.0\n[[valve]]\nat_s = 0.4\nposition = \"retract\"\n[[valve]]\nat_s = 0.8\nposition = \"extend\"\n",
    ),
    (
        "load_cell",
        "[load]\nkind = \"load_cell\"\nposition_mm = 40\n[[command]]\nat_s = 0.05\nset_pressure_bar_gauge = 1.8\n",
    ),
    (
        "surface",
        "[load]\nkind = \"surface\"\nposition_mm = 25\nstiffness_n_per_m = 2e4\npeak_to_peak_mm = 20\nfrequency_hz = 2\nstart_s = 0.3\n[[command]]\nat_s = 0.05\nforce_n = 150\n[controller]\nkind = \"disturbance_prediction\"\n[sensing]\npreset = \"white\"\n",
    ),
    (
        "hand",
        "[load]\nkind = \"free\"\n[hand]\npeak_force_n = 100\nfrequency_hz = 3\n[[command]]\nat_s = 0.05\nset_pressure_bar_gauge = 1.0\n[sensing]\npreset = \"paper\"\n",
    ),
];

fn bench_text(kind: &str, rest: &str) -> String {
    format!(
        "schema = 2\nkind = \"bench\"\ntitle = \"{kind}\"\n[device]\nmodel = \"{}\"\nideal = {}\n[bench]\nduration_s = 1.2\n{rest}",
        project("models/device.toml").display(),
        kind != "free"
    )
}

#[test]
fn every_bench_that_is_accepted_runs_finite_repeats_and_balances() {
    let of_bench = keys(|path| {
        let tables = [
            "device.override.",
            "bench.",
            "load.",
            "hand.",
            "simulation.",
            "sensing.",
        ];
        tables.iter().any(|table| path.starts_with(table)) && path != "bench.duration_s"
    });
    assert!(of_bench.len() > 80, "{} keys", of_bench.len());
    let mut faults = String::new();
    let count = Counter::new([0, 0]);
    for (kind, rest) in BENCHES {
        // Of other loads and without a hand a key has no place.
        let own = |key: &&Key| match key.path.split_once('.') {
            Some(("load", name)) => {
                rest.contains(name) || (kind == "load_cell" && name.ends_with("_per_m"))
            }
            Some(("hand", _)) => kind == "hand",
            // The preset's kind of sensor says which keys it has.
            Some(("sensing", name)) => match kind {
                "hand" => !name.starts_with("filter"),
                "surface" => name.contains("standard_deviation"),
                _ => false,
            },
            _ => true,
        };
        let keys: Vec<Key> = of_bench.iter().filter(own).cloned().collect();
        let base = bench_text(kind, rest);
        let outcome = runner(CASES).run(&draws(keys.len()), |drawn| {
            let text = with_keys(&base, &keys, &drawn);
            let [refused, accepted] = count.get();
            match check_bench(&text).map_err(|error| with_text(error, &text))? {
                true => count.set([refused, accepted + 1]),
                false => count.set([refused + 1, accepted]),
            }
            Ok(())
        });
        if let Err(error) = outcome {
            writeln!(faults, "{kind}: {error}").unwrap();
        }
    }
    let [refused, accepted] = count.get();
    println!("{accepted} benches accepted, {refused} refused");
    assert!(faults.is_empty(), "{faults}");
    assert!(
        accepted > 2 * CASES && refused > CASES / 4,
        "{accepted} accepted, {refused} refused"
    );
}

fn loaded(text: &str) -> Result<Rig, String> {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("bench.toml");
    std::fs::write(&file, text).unwrap();
    Rig::load(&file).map_err(|error| error.to_string())
}

/// Checks a bench; whether it is accepted.
fn check_bench(text: &str) -> Result<bool, TestCaseError> {
    let rig = match loaded(text) {
        Ok(rig) => rig,
        Err(reason) => return is_refused_at_once(text, &reason).map(|()| false),
    };
    let device = Device::new(rig.actual.device.clone());
    let (mut first, mut gap, mut work, mut before) = (None, 0.0f64, 0.0f64, 0.0);
    let mut fastest = 0.0f64;
    let run = run_bench(&rig, &mut |simulation| {
        let (state, ledger) = (simulation.device(), &simulation.device().ledger);
        let energy = device.internal_energy(state)
            - (ledger.enthalpy_in + ledger.heat_in - ledger.chamber_work);
        gap = gap.max((energy - *first.get_or_insert(energy)).abs());
        work += (ledger.chamber_work - before).abs();
        before = ledger.chamber_work;
        fastest = fastest.max(simulation.motion().speed.abs());
    });
    let run = run.map_err(|error| TestCaseError::fail(error.to_string()))?;
    let again =
        run_bench(&rig, &mut |_| ()).map_err(|error| TestCaseError::fail(error.to_string()))?;
    is_finite_and_the_same(&run.recording, &again.recording)?;
    let air = run.summary.air_mass_balance_relative.unwrap_or(0.0);
    prop_assert!(air < AIR, "air balances within {air:e}");
    // Of a piston that hardly moves the work is nothing to measure by.
    prop_assert!(
        gap < ENERGY * work.max(1.0),
        "energy of the air within {gap:e} J of {work} J"
    );
    let own = device.parameters();
    let pressures = [schema::CHAMBER_1_PRESSURE, schema::CHAMBER_2_PRESSURE];
    let pressures = pressures.map(|name| run.recording.values(name).unwrap());
    let highest = pressures.into_iter().flatten().copied().fold(0.0, f64::max);
    let push = highest * own.areas().extending.max(own.areas().retracting);
    let outside = own.axial_load.force.abs() + own.moving_mass * 40.0 + 5000.0;
    let landing = fastest * (own.moving_mass / own.end_stop.stiffness).sqrt();
    is_within_bounds(
        &run.recording,
        own,
        1e-4 + landing + 2.0 * (push + outside) / own.end_stop.stiffness,
    )
    .map(|()| true)
}

#[test]
fn every_cell_that_is_accepted_runs_finite_repeats_and_balances() {
    let of_cell = keys(|path| {
        let tables = [
            "device.override.",
            "process.",
            "arm.servo.",
            "contact.",
            "workpiece.misplacement.",
            "simulation.",
        ];
        let slow = [
            "approach_distance_mm",
            "settle_time_s",
            "approach_speed_mm_per_s",
            "engage_speed_mm_per_s",
            "feed_mm_per_s",
            "acceleration_mm_per_s2",
            "jerk_mm_per_s3",
        ];
        tables.iter().any(|table| path.starts_with(table))
            && !slow.iter().any(|name| path.ends_with(name))
            && !path.contains("feed_follows")
    });
    assert!(of_cell.len() > 50, "{} keys", of_cell.len());
    let text = std::fs::read_to_string(project("scenarios/plate_edge_ideal.toml")).unwrap();
    let base = text
        .replace("\"../", &format!("\"{}/", project("").display()))
        .replace("start_mm = 10", "start_mm = 140")
        .replace("end_mm = 290", "end_mm = 145")
        .replace(
            "[process]",
            "[process]\nsettle_time_s = 0.2\napproach_distance_mm = 5",
        )
        .split("[expect]")
        .next()
        .unwrap()
        .to_owned();
    let count = Counter::new([0, 0]);
    runner(12)
        .run(&draws(of_cell.len()), |drawn| {
            let text = with_keys(&base, &of_cell, &drawn);
            let [refused, accepted] = count.get();
            match check_cell(&text).map_err(|error| with_text(error, &text))? {
                true => count.set([refused, accepted + 1]),
                false => count.set([refused + 1, accepted]),
            }
            Ok(())
        })
        .unwrap_or_else(|error| panic!("{error}"));
    let [refused, accepted] = count.get();
    println!("{accepted} cells accepted, {refused} refused");
    assert!(accepted > 3, "{accepted} accepted, {refused} refused");
}

/// Checks a cell; whether it is accepted.
fn check_cell(text: &str) -> Result<bool, TestCaseError> {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("cell.toml");
    std::fs::write(&file, text).unwrap();
    let cell = match Cell::load(&file) {
        Ok(cell) => cell,
        Err(error) => return is_refused_at_once(text, &error.to_string()).map(|()| false),
    };
    let fail = |error: idc_cell::run::RunError| TestCaseError::fail(error.to_string());
    let run = run_cell(&cell, &mut |_| ()).map_err(fail)?;
    let again = run_cell(&cell, &mut |_| ()).map_err(fail)?;
    is_finite_and_the_same(&run.recording, &again.recording)?;
    let air = run.summary.air_mass_balance_relative.unwrap_or(0.0);
    prop_assert!(air < AIR, "air balances within {air:e}");
    let own = &cell.setup.scenario.nominal.device;
    let push = own.areas().extending.max(own.areas().retracting) * 2e6;
    let give = 1e-3
        + 2.0 * (push + own.axial_load.force.abs() + own.moving_mass * 40.0)
            / own.end_stop.stiffness;
    is_within_bounds(&run.recording, own, give).map(|()| true)
}

// Catches: a range that is not read, so that nothing beyond it would be drawn.
#[test]
fn keys_are_drawn_from_their_tables_within_and_beyond_their_ranges() {
    let keys =
        keys(|path| path == "device.override.bore_mm" || path == "device.override.cylinder_count");
    assert_eq!(keys.len(), 2, "{keys:?}");
    let bore = keys.iter().find(|key| !key.is_whole).unwrap();
    assert_eq!([bore.at(0.0), bore.at(1.0)], [2.0, 300.0]);
    assert!(bore.at(-0.001) < 2.0 && bore.at(1.001) > 300.0);
    let count = keys.iter().find(|key| key.is_whole).unwrap();
    assert_eq!(
        [count.at(0.0), count.at(1.0), count.at(1.001)],
        [1.0, 16.0, 17.0]
    );
    let text = with_keys("[device.override]\n", &keys, &[(0, 1.001)]);
    assert!(
        text.contains(&keys[0].path["device.override.".len()..]),
        "{text}"
    );
}
