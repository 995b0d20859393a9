//! The paper's two experiments, run with edited scenario files.

use std::path::Path;

use idc_cell::recording::{Recording, schema};
use idc_cell::rig::Rig;
use idc_cell::scenario::load_bench;
use toml::{Table, Value};

use crate::common::project;

/// A level at which the paper states a deviation.
pub struct Level {
    /// Scenario, and which of its commands.
    pub scenario: &'static str,
    pub command: usize,
    /// Set pressure, and the one before it [bar gauge].
    pub pressure: f64,
    pub before: f64,
    /// Deviation as printed [%].
    pub printed: f64,
}

/// In the order of the paper.
pub const LEVELS: [Level; 4] = [
    level("paper_step", 0, 1.8, 0.0, 6.5),
    level("paper_stairstep", 0, 1.2, 0.0, 6.0),
    level("paper_stairstep", 1, 2.1, 1.2, 6.3),
    level("paper_stairstep", 2, 3.0, 2.1, 6.3),
];

const fn level(
    scenario: &'static str,
    command: usize,
    pressure: f64,
    before: f64,
    printed: f64,
) -> Level {
    Level {
        scenario,
        command,
        pressure,
        before,
        printed,
    }
}

/// A change of a scenario file.
#[derive(Debug, Clone, PartialEq)]
pub enum Edit {
    /// A key with all its tables, and its value.
    Key(&'static str, f64),
    /// The same for a whole number.
    Count(&'static str, i64),
    /// The same for a text.
    Text(&'static str, &'static str),
    /// Every set pressure, in bar, times a factor and plus an offset.
    Commands(f64, f64),
}

/// Result of a run at a level.
#[derive(Debug, Clone)]
pub struct Shown {
    /// Outlet as read, steady [Pa gauge].
    pub outlet_read: f64,
    /// Outlet, steady [Pa gauge].
    pub outlet: f64,
    /// Load cell's reading, steady [N].
    pub force_read: f64,
    /// Contact force, steady [N].
    pub force: f64,
    /// p_1 A_1 - p_2 A_2 of the absolute pressures, as eq. (1) is printed, steady [N].
    pub force_as_printed: f64,
    /// Outlet from the command to the next one [Pa gauge].
    pub trajectory: Vec<f64>,
}

fn set(table: &mut Table, key: &str, value: Value) {
    match key.split_once('.') {
        None => {
            table.insert(key.to_owned(), value);
        }
        Some((first, rest)) => {
            let inner = table
                .entry(first.to_owned())
                .or_insert_with(|| Value::Table(Table::new()));
            set(inner.as_table_mut().unwrap(), rest, value);
        }
    }
}

fn edited(scenario: &str, edits: &[Edit]) -> String {
    let path = project(&format!("scenarios/{scenario}.toml"));
    let mut table: Table = std::fs::read_to_string(path).unwrap().parse().unwrap();
    let model = project("models/device.toml").display().to_string();
    set(&mut table, "device.model", Value::String(model));
    for edit in edits {
        match *edit {
            Edit::Key(key, value) => set(&mut table, key, Value::Float(value)),
            Edit::Count(key, value) => set(&mut table, key, Value::Integer(value)),
            Edit::Text(key, value) => set(&mut table, key, Value::String(value.to_owned())),
            Edit::Commands(factor, offset) => {
                for command in table["command"].as_array_mut().unwrap() {
                    let command = command.as_table_mut().unwrap();
                    let pressure = command["set_pressure_bar_gauge"].as_float().unwrap();
                    let edited = Value::Float(factor * pressure + offset);
                    command.insert("set_pressure_bar_gauge".to_owned(), edited);
                }
            }
        }
    }
    toml::to_string(&table).unwrap()
}

fn record(text: &str) -> (Recording, Vec<f64>, [f64; 2], f64) {
    let folder = tempfile::tempdir().unwrap();
    let path: &Path = &folder.path().join("edited.toml");
    std::fs::write(path, text).unwrap();
    let scenario = load_bench(path).unwrap_or_else(|error| panic!("{error}"));
    let times = scenario.command.steps().iter().map(|(time, _)| *time);
    let ends = times.chain([scenario.duration]).collect();
    let areas = scenario.nominal.device.areas();
    let atmosphere = scenario.nominal.device.gas.atmosphere;
    let (recording, stop) = Rig::new(scenario).unwrap().run(&mut |_| ()).unwrap();
    assert_eq!(stop, None);
    (
        recording,
        ends,
        [areas.extending, areas.retracting],
        atmosphere,
    )
}

/// Runs a scenario with edits and returns what its levels show.
pub fn run(scenario: &str, edits: &[Edit]) -> Vec<Shown> {
    let (recording, ends, areas, atmosphere) = record(&edited(scenario, edits));
    let values = |quantity| recording.values(quantity).unwrap();
    let step = recording.time()[1];
    let index = |time: f64| (time / step).round() as usize;
    ends.windows(2)
        .map(|window| {
            // Steady in the last second; the sample at the end belongs to the next command.
            let (start, from, to) = (index(window[0]), index(window[1] - 1.0), index(window[1]));
            let mean = |quantity| {
                let steady = &values(quantity)[from..to];
                steady.iter().sum::<f64>() / steady.len() as f64
            };
            let [first, second] =
                [schema::CHAMBER_1_PRESSURE, schema::CHAMBER_2_PRESSURE].map(mean);
            let outlet = values(schema::REGULATOR_PRESSURE);
            Shown {
                outlet_read: mean(schema::MEASURED_REGULATOR_PRESSURE) - atmosphere,
                outlet: mean(schema::REGULATOR_PRESSURE) - atmosphere,
                force_read: mean(schema::MEASURED_FORCE),
                force: mean(schema::CONTACT_FORCE),
                force_as_printed: first * areas[0] - second * areas[1],
                trajectory: outlet[start..to].iter().map(|p| p - atmosphere).collect(),
            }
        })
        .collect()
}

/// Results of the four levels with edits.
pub fn run_all(edits: &[Edit]) -> Vec<Shown> {
    let mut shown = run("paper_step", edits);
    shown.extend(run("paper_stairstep", edits));
    shown
}
