//! The bench format: each key reaches its field in SI, each misuse gives one clear message.

use super::super::bench::{
    BenchScenario, CommandScenario, HandScenario, LoadScenario, SurfaceMotion,
};
use super::{MINIMAL_BENCH, read_bench, replaced, text_refused};
use crate::physics::gas_process::GasProcess;
use crate::physics::valve::ValvePosition;
use crate::plant::ContactParameters;

fn bench(from: &str, to: &str) -> BenchScenario {
    read_bench(&replaced(MINIMAL_BENCH, from, to)).unwrap()
}

/// Refuses each `to` in place of `from` in the minimal bench, at its place with its words.
fn refused(cases: &[(&str, &str, &str, &str)]) {
    for (from, to, location, words) in cases {
        text_refused(&replaced(MINIMAL_BENCH, from, to), location, words);
    }
}

const FREE: &str = "kind = \"free\"\n";

#[test]
fn every_key_of_bench_and_simulation_reaches_its_field() {
    let bench = bench(
        "duration_s = 6\n",
        "duration_s = 7\ngravity_along_extension_m_per_s2 = -9.81\nstart_stroke_mm = 12\n\
         [simulation]\nstep_ms = 0.5\ndevice_substeps = 4\nseed = 9\n[expect]\na_n = { min = -1, max = 1 }\n",
    );
    assert_eq!((bench.duration, bench.start_stroke), (7.0, 0.012));
    assert_eq!(bench.nominal.gravity_along_extension, -9.81);
    assert_eq!((bench.step, bench.substeps, bench.seed), (5e-4, 4, 9));
    let bound = &bench.expect[0];
    assert_eq!(
        (bound.metric.as_str(), bound.min, bound.max),
        ("a_n", Some(-1.0), Some(1.0))
    );
}

#[test]
fn every_kind_of_load_is_read() {
    let contact = ContactParameters::linear(2e4, 200.0);
    let given = "position_mm = 35\nstiffness_n_per_m = 2e4\ndamping_n_s_per_m = 200\n";
    let moved = "peak_to_peak_mm = 20\nfrequency_hz = 0.5\nstart_s = 4\n";
    assert_eq!(bench(FREE, FREE).load, LoadScenario::Free);
    let load_cell = bench(FREE, &format!("kind = \"load_cell\"\n{given}"));
    let surface = LoadScenario::Contact {
        position: 0.035,
        motion: None,
    };
    assert_eq!(load_cell.load, surface);
    assert_eq!(load_cell.nominal.contact, contact);
    let surface = bench(FREE, &format!("kind = \"surface\"\n{given}{moved}"));
    let moving = LoadScenario::Contact {
        position: 0.035,
        motion: Some(SurfaceMotion {
            peak_to_peak: 0.02,
            frequency: 0.5,
            start: 4.0,
        }),
    };
    assert_eq!(surface.load, moving);
    assert_eq!(surface.nominal.contact, contact);
}

#[test]
fn hand_commands_and_valve_are_read() {
    let bench = bench(
        FREE,
        "kind = \"free\"\n[hand]\npeak_force_n = 40\nfrequency_hz = 2\nstart_s = 3\n\
         [[command]]\nat_s = 0.5\nset_pressure_bar_gauge = 1.2\n[[command]]\nat_s = 6\nset_pressure_bar_gauge = 0\n\
         [[valve]]\nat_s = 1\nposition = \"retract\"\n[[valve]]\nat_s = 2\nposition = \"extend\"\n",
    );
    let hand = HandScenario {
        peak_force: 40.0,
        frequency: 2.0,
        start: 3.0,
    };
    assert_eq!(bench.hand, Some(hand));
    let steps = vec![(0.5, 1.2e5), (6.0, 0.0)];
    assert_eq!(bench.command, CommandScenario::SetPressure(steps));
    let positions = [(1.0, ValvePosition::Retract), (2.0, ValvePosition::Extend)];
    assert_eq!(bench.valve, positions);
}

#[test]
fn forces_can_be_commanded_instead() {
    let bench = bench(
        FREE,
        "kind = \"free\"\n[[command]]\nat_s = 1\nforce_n = 290\n",
    );
    assert_eq!(bench.command, CommandScenario::Force(vec![(1.0, 290.0)]));
    assert_eq!((bench.hand, bench.valve), (None, vec![]));
}

#[test]
fn every_new_key_of_the_device_reaches_its_field() {
    let parameters = bench(
        "[bench]\n",
        "[device.override]\nseal_coulomb_force_n = 10\nseal_static_force_n = 15\nseal_stribeck_velocity_mm_per_s = 12\n\
         seal_viscous_coefficient_n_s_per_m = 30\nseal_presliding_displacement_um = 60\ngas_process = \"wall_heat\"\n\
         wall_conductance_w_per_k = 0.7\nhose_length_m = 2\nhose_diameter_mm = 4\n[bench]\n",
    )
    .nominal
    .0
    .device;
    let seals = parameters.seal_friction;
    assert_eq!((seals.coulomb, seals.static_force), (10.0, 15.0));
    assert_eq!((seals.stribeck_velocity, seals.viscous), (0.012, 30.0));
    assert_eq!(seals.presliding_displacement, 6e-5);
    let walls = GasProcess::WallHeat { conductance: 0.7 };
    assert_eq!(parameters.gas_process, walls);
    // A tube of 2 m and 4 mm.
    let volume = std::f64::consts::PI * 0.002 * 0.002 * 2.0;
    assert!((parameters.hose.unwrap().volume / volume - 1.0).abs() < 1e-12);
}

#[test]
fn a_load_has_the_keys_of_its_kind_and_no_others() {
    refused(&[
        (
            FREE,
            "kind = \"wall\"\n",
            "9:8",
            "`load.kind` is \"wall\", expected one of `free`, `load_cell`, `surface`",
        ),
        (
            FREE,
            "kind = \"free\"\nposition_mm = 1\n",
            "10:1",
            "`load.position_mm` cannot stand here: kind = \"free\" has no other key",
        ),
        (
            FREE,
            "kind = \"load_cell\"\nposition_mm = 1\nfrequency_hz = 1\n",
            "11:1",
            "`load.frequency_hz` cannot stand here: kind = \"load_cell\" has position_mm, stiffness_n_per_m, damping_n_s_per_m",
        ),
        (
            FREE,
            "kind = \"load_cell\"\n",
            "8:2",
            "`load.position_mm` is missing, expected it to be given with kind = \"load_cell\"",
        ),
        (
            FREE,
            "kind = \"load_cell\"\nposition_mm = 50.5\n",
            "10:1",
            "`load.position_mm` is 50.5 mm, expected at most the device's stroke_mm, 50 mm",
        ),
        (
            FREE,
            "kind = \"surface\"\nposition_mm = 1\npeak_to_peak_mm = 1\n",
            "8:2",
            "`load.frequency_hz` is missing, expected it to be given with kind = \"surface\"",
        ),
        (
            FREE,
            "kind = \"load_cell\"\nposition_mm = 1\nstiffness_n_per_m = 10\n",
            "11:1",
            "`load.stiffness_n_per_m` is 10 N/m, expected 100 to 1000000000 N/m",
        ),
    ]);
}

#[test]
fn commands_and_positions_follow_one_another_within_the_run() {
    let two =
        |first: &str, second: &str| format!("{FREE}[[command]]\n{first}\n[[command]]\n{second}\n");
    for (keys, location, words) in [
        (
            two("at_s = 2\nforce_n = 1", "at_s = 2\nforce_n = 2"),
            "14:1",
            "`command[1].at_s` is 2 s, expected later than the entry ahead of it, 2 s",
        ),
        (
            two("at_s = 2\nforce_n = 1", "at_s = 6.5\nforce_n = 2"),
            "14:1",
            "`command[1].at_s` is 6.5 s, expected 0 to 6 s",
        ),
        (
            two(
                "at_s = 2\nforce_n = 1",
                "at_s = 3\nset_pressure_bar_gauge = 2",
            ),
            "15:1",
            "`command[1].set_pressure_bar_gauge` cannot stand here: the first command gives a force, so all of them do",
        ),
        (
            two(
                "at_s = 2\nset_pressure_bar_gauge = 1",
                "at_s = 3\nforce_n = 2",
            ),
            "15:1",
            "`command[1].force_n` cannot stand here: the first command gives a set pressure, so all of them do",
        ),
        (
            two("at_s = 2\nset_pressure_bar_gauge = 1", "at_s = 3"),
            "13:1",
            "`command[1].set_pressure_bar_gauge` is missing, expected it or force_n to be given",
        ),
        (
            two("at_s = 2\nforce_n = 1", "force_n = 2"),
            "13:1",
            "`command[1].at_s` is missing, expected it to be given in s, it has no default",
        ),
        (
            two("at_s = 2\nset_pressure_bar_gauge = -0.1", "at_s = 3"),
            "12:1",
            "`command[0].set_pressure_bar_gauge` is -0.1 bar gauge, expected 0 to 16 bar gauge",
        ),
        (
            two("at_s = nan\nforce_n = 1", "at_s = 3\nforce_n = 2"),
            "11:1",
            "`command[0].at_s` is NaN s, expected 0 to 6 s",
        ),
        (
            format!("{FREE}[[valve]]\nat_s = 1\nposition = \"out\"\n"),
            "12:12",
            "`valve[0].position` is \"out\", expected one of `extend`, `retract`",
        ),
        (
            format!("{FREE}[[valve]]\nat_s = 7\nposition = \"extend\"\n"),
            "11:1",
            "`valve[0].at_s` is 7 s, expected 0 to 6 s",
        ),
    ] {
        refused(&[(FREE, &keys, location, words)]);
    }
}

#[test]
fn what_a_bench_does_not_have_is_refused_by_name() {
    refused(&[
        (
            "[bench]",
            "locked = true\n[bench]",
            "6:1",
            "`device.locked` cannot stand here: a bench has no locked device",
        ),
        (
            "duration_s = 6",
            "duration_s = 6\nstart_stroke_mm = 51",
            "8:1",
            "`bench.start_stroke_mm` is 51 mm, expected at most the device's stroke_mm, 50 mm",
        ),
        (
            "duration_s = 6",
            "",
            "6:1",
            "`bench.duration_s` is missing, expected it to be given in s, it has no default",
        ),
        (
            "duration_s = 6",
            "duration = 6",
            "7:1",
            "unknown key `bench.duration`; the key is `duration_s`, in s",
        ),
        (
            "title",
            "command = 3\ntitle",
            "3:11",
            "`command` is 3, expected tables [[command]]",
        ),
        (
            "\"bench\"",
            "\"benhc\"",
            "2:8",
            "`kind` is \"benhc\", expected one of `cell`, `bench`, `recorded_cell`",
        ),
        (
            "[load]",
            "[process]\nforce_n = 1\n[load]",
            "8:2",
            "unknown key `process`; a scenario of kind = \"cell\" has it",
        ),
        (
            "kind = \"bench\"\n",
            "",
            "5:2",
            "unknown key `bench`; a scenario of kind = \"bench\" has it",
        ),
        (
            "[bench]",
            "[device.override]\nseal_coulomb_force_n = 8\nseal_static_force_n = 7\n[bench]",
            "8:1",
            "`device.override.seal_static_force_n` is 7 N, expected at least seal_coulomb_force_n, 8 N",
        ),
        (
            "[bench]",
            "[device.override]\ngas_process = \"adiabatic\"\n[bench]",
            "7:15",
            "`device.override.gas_process` is \"adiabatic\", expected one of `isothermal`, `wall_heat`",
        ),
    ]);
}
