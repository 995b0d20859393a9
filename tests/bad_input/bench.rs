//! The same for the scenario of a bench: `scenarios/paper_step.toml`, spoiled.

use super::{Refusal, check_of, edit, refusal};
use crate::program::Bench;

fn check(refusals: &[Refusal]) {
    check_of("paper_step", refusals);
}

/// Gives a key of [device.override], which stands in line 14 instead of another.
fn device(bench: &Bench, key_and_value: &str) {
    edit(bench, "regulator_time_constant_s = 0.5", key_and_value);
}

/// Puts lines behind the one command, from line 27 on.
fn more(bench: &Bench, lines: &str) {
    let command = "set_pressure_bar_gauge = 1.8\n";
    edit(bench, command, &format!("{command}{lines}"));
}

/// The set value goes through its chain: 0 to 8 V for 0 to 5 bar.
fn chain(bench: &Bench) {
    more(
        bench,
        "[sensing.command]\nkind = \"real\"\nfull_scale_bar_gauge = 5\n",
    );
}

#[test]
fn the_bench_that_the_refusals_spoil_runs() {
    let bench = Bench::new("paper_step");
    chain(&bench);
    let outcome = bench.run();
    assert_eq!(outcome.code, 0, "{}", outcome.err);
    assert!(bench.path("out/samples.parquet").exists());
}

#[test]
fn devices_that_cannot_be() {
    check(&[
        refusal(
            |b| device(b, "dead_volume_cm3 = 0"),
            &[
                "scenario.toml:14:1: `device.override.dead_volume_cm3` is 0 cm3, expected 0.01 to 5000 cm3",
            ],
        ),
        refusal(
            |b| device(b, "dead_volume_cm3 = -20"),
            &[
                "scenario.toml:14:1: `device.override.dead_volume_cm3` is -20 cm3, expected 0.01 to 5000 cm3",
            ],
        ),
        refusal(
            |b| device(b, "bore_mm = 0"),
            &["scenario.toml:14:1: `device.override.bore_mm` is 0 mm, expected 2 to 300 mm"],
        ),
        refusal(
            |b| device(b, "bore_mm = 11"),
            &["device.toml:30:1: `device.rod_mm` is 12 mm, expected less than bore_mm, 11 mm"],
        ),
        refusal(
            |b| device(b, "supply_orifice_mm2 = -2.5"),
            &[
                "scenario.toml:14:1: `device.override.supply_orifice_mm2` is -2.5 mm2, expected 0.01 to 200 mm2",
            ],
        ),
        refusal(
            |b| device(b, "exhaust_orifice_mm2 = 0"),
            &[
                "scenario.toml:14:1: `device.override.exhaust_orifice_mm2` is 0 mm2, expected 0.01 to 200 mm2",
            ],
        ),
        refusal(
            |b| device(b, "moving_mass_kg = nan"),
            &[
                "scenario.toml:14:1: `device.override.moving_mass_kg` is NaN kg, expected 0.05 to 200 kg",
            ],
        ),
        refusal(
            |b| device(b, "atmosphere_pa_absolute = 0"),
            &[
                "scenario.toml:14:1: `device.override.atmosphere_pa_absolute` is 0 Pa absolute, expected 50000 to 110000 Pa absolute",
            ],
        ),
        refusal(
            |b| device(b, "supply_pressure_bar_gauge = -0.5"),
            &[
                "scenario.toml:14:1: `device.override.supply_pressure_bar_gauge` is -0.5 bar gauge, expected 0.1 to 16 bar gauge",
            ],
        ),
        refusal(
            |b| device(b, "hose_length_m = -1"),
            &["scenario.toml:14:1: `device.override.hose_length_m` is -1 m, expected 0 to 50 m"],
        ),
        refusal(
            |b| device(b, "dead_volume_l = 0.02"),
            &[
                "scenario.toml:14:1: unknown key `device.override.dead_volume_l`",
                "dead_volume_cm3",
            ],
        ),
    ]);
}

#[test]
fn every_number_of_a_device_is_named_when_it_is_not_one() {
    let model = std::fs::read_to_string(crate::common::project("models/device.toml")).unwrap();
    let values = model.lines().skip_while(|line| *line != "[device]");
    let mut keys = 0;
    for line in values {
        let Some((key, rest)) = line.split_once(" = ") else {
            continue;
        };
        if key.starts_with('#') || rest.starts_with('"') || key == "cylinder_count" {
            continue;
        }
        keys += 1;
        for (value, shown) in [("-1e99", "is -1"), ("nan", "is NaN"), ("inf", "is inf")] {
            // A scenario that overrides nothing.
            let bench = Bench::new("retract");
            let value_there = rest.split_whitespace().next().unwrap();
            if value_there == value {
                // A limit that is none.
                continue;
            }
            let to = format!("{key} = {value} ");
            bench.replace("device.toml", &format!("{key} = {value_there}"), &to);
            let outcome = bench.run();
            let line = outcome.only_line("error: device.toml:");
            let name = format!("`device.{key}` {shown}");
            assert!(
                line.contains(&name) && line.contains(", expected "),
                "{line}"
            );
            assert_eq!(
                (outcome.code, bench.path("out").exists()),
                (2, false),
                "{line}"
            );
        }
    }
    assert!(keys > 25, "{keys}");
}

#[test]
fn pressures_and_set_values_beyond_what_there_is() {
    check(&[
        refusal(
            |b| edit(b, "gauge = 1.8", "gauge = -0.2"),
            &[
                "scenario.toml:26:1: `command[0].set_pressure_bar_gauge` is -0.2 bar gauge, expected 0 to 16 bar gauge",
            ],
        ),
        refusal(
            |b| edit(b, "gauge = 1.8", "gauge = nan"),
            &[
                "scenario.toml:26:1: `command[0].set_pressure_bar_gauge` is NaN bar gauge, expected 0 to 16 bar gauge",
            ],
        ),
        refusal(
            |b| {
                chain(b);
                edit(b, "gauge = 1.8", "gauge = 5.5");
            },
            &[
                "scenario.toml:26:1: `command[0].set_pressure_bar_gauge` is 5.5 bar gauge, 8.8 V at the regulator",
                "expected 0 to 5 bar gauge, the 0 to 8 V that [sensing.command] can give",
            ],
        ),
        refusal(
            |b| edit(b, "bar_gauge = 1.8", "bar = 1.8"),
            &[
                "scenario.toml:26:1: unknown key `command[0].set_pressure_bar`",
                "set_pressure_bar_gauge",
            ],
        ),
    ]);
}

#[test]
fn loads_that_the_tool_cannot_meet() {
    const SURFACE: &str = "kind = \"surface\"\npeak_to_peak_mm = 20\nfrequency_hz = 0.5";
    check(&[
        refusal(
            |b| edit(b, "[load]\nkind = \"load_cell\"\nposition_mm = 40\n", ""),
            &["scenario.toml:1:1: `load` is missing, expected a table [load]"],
        ),
        refusal(
            |b| edit(b, "\"load_cell\"", "\"spring\""),
            &[
                "scenario.toml:21:8: `load.kind` is \"spring\", expected one of `free`, `load_cell`, `surface`",
            ],
        ),
        refusal(
            |b| edit(b, "position_mm = 40", ""),
            &["scenario.toml:20:2: `load.position_mm` is missing"],
        ),
        refusal(
            |b| edit(b, "position_mm = 40", "position_mm = nan"),
            &["scenario.toml:22:1: `load.position_mm` is NaN mm, expected 0 to 500 mm"],
        ),
        refusal(
            |b| {
                edit(b, "kind = \"load_cell\"", SURFACE);
                edit(b, "position_mm = 40", "position_mm = 62");
            },
            &[
                "scenario.toml:24:1: `load.position_mm` is 62 mm, expected at most the device's stroke_mm, 50 mm",
            ],
        ),
        refusal(
            |b| {
                edit(b, "kind = \"load_cell\"", SURFACE);
                edit(b, "position_mm = 40", "position_mm = -3");
            },
            &["scenario.toml:24:1: `load.position_mm` is -3 mm, expected 0 to 500 mm"],
        ),
        refusal(
            |b| {
                edit(
                    b,
                    "position_mm = 40",
                    "position_mm = 40\nstiffness_n_per_m = 0",
                );
            },
            &[
                "scenario.toml:23:1: `load.stiffness_n_per_m` is 0 N/m, expected 100 to 1000000000 N/m",
            ],
        ),
        refusal(
            |b| edit(b, "duration_s = 6", "duration_s = 6\nstart_stroke_mm = 51"),
            &[
                "scenario.toml:19:1: `bench.start_stroke_mm` is 51 mm, expected at most the device's stroke_mm, 50 mm",
            ],
        ),
    ]);
}

#[test]
fn commands_and_valve_positions_that_contradict_themselves() {
    check(&[
        refusal(
            |b| more(b, "[[command]]\nat_s = 0.4\nset_pressure_bar_gauge = 1\n"),
            &[
                "scenario.toml:28:1: `command[1].at_s` is 0.4 s, expected later than the entry ahead of it, 0.5 s",
            ],
        ),
        refusal(
            |b| edit(b, "at_s = 0.5", "at_s = 6.5"),
            &["scenario.toml:25:1: `command[0].at_s` is 6.5 s, expected 0 to 6 s"],
        ),
        refusal(
            |b| edit(b, "at_s = 0.5", "at_s = nan"),
            &["scenario.toml:25:1: `command[0].at_s` is NaN s, expected 0 to 6 s"],
        ),
        refusal(
            |b| more(b, "force_n = 290\n"),
            &[
                "scenario.toml:27:1: `command[0].force_n` cannot stand here: a command gives a set pressure or a force",
            ],
        ),
        refusal(
            |b| more(b, "[[command]]\nat_s = 2\nforce_n = 290\n"),
            &[
                "scenario.toml:29:1: `command[1].force_n` cannot stand here: the first command gives a set pressure, so all of them do",
            ],
        ),
        refusal(
            |b| edit(b, "set_pressure_bar_gauge = 1.8", ""),
            &[
                "scenario.toml:24:1: `command[0].set_pressure_bar_gauge` is missing, expected it or force_n to be given",
            ],
        ),
        refusal(
            |b| more(b, "[[valve]]\nat_s = 1\nposition = \"centre\"\n"),
            &[
                "scenario.toml:29:12: `valve[0].position` is \"centre\", expected one of `extend`, `retract`",
            ],
        ),
        refusal(
            |b| {
                more(
                    b,
                    "[[valve]]\nat_s = 2\nposition = \"retract\"\n[[valve]]\nat_s = 1\nposition = \"extend\"\n",
                );
            },
            &[
                "scenario.toml:31:1: `valve[1].at_s` is 1 s, expected later than the entry ahead of it, 2 s",
            ],
        ),
    ]);
}

#[test]
fn scenarios_that_are_no_bench() {
    check(&[
        refusal(
            |b| edit(b, "\"bench\"", "\"benhc\""),
            &["scenario.toml:6:8: `kind` is \"benhc\", expected one of `cell`, `bench`"],
        ),
        refusal(
            |b| edit(b, "duration_s = 6", "duration_s = 0"),
            &["scenario.toml:18:1: `bench.duration_s` is 0 s, expected 0.01 to 3600 s"],
        ),
        refusal(
            |b| edit(b, "[bench]\nduration_s = 6\n", ""),
            &["scenario.toml:1:1: `bench` is missing, expected a table [bench]"],
        ),
        refusal(
            |b| edit(b, "[load]", "[process]\nforce_n = 1\n[load]"),
            &["scenario.toml:20:2: unknown key `process`; a scenario of kind = \"cell\" has it"],
        ),
        refusal(
            |b| more(b, "[expect]\nforce_mean = { max = 3 }\n"),
            &["scenario.toml: [expect] names `force_mean`", "force_mean_n"],
        ),
        refusal(
            |b| b.write("out", "in the way"),
            &["output folder out: there is a file of that name", "--out"],
        ),
    ]);
}
