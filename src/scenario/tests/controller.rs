//! `[controller]`: each key reaches its field in SI, each misuse gives one clear message.

use super::super::{ControllerScenario, ForceLaw};
use super::{MINIMAL, MINIMAL_BENCH, read, read_bench, replaced, text_refused};
use crate::physics::seal_friction::SealFriction;

/// A bench that presses with a force, and these lines.
fn pressing(lines: &str) -> String {
    let cell = "kind = \"load_cell\"\nposition_mm = 30";
    let text = replaced(MINIMAL_BENCH, "kind = \"free\"", cell);
    format!("{text}[[command]]\nat_s = 0\nforce_n = 100\n{lines}")
}

fn chosen(lines: &str) -> ControllerScenario {
    let cell = read(&format!("{MINIMAL}{lines}")).unwrap().controller;
    let bench = read_bench(&pressing(lines)).unwrap().controller;
    assert_eq!((bench.law, bench.period), (cell.law, cell.period));
    bench
}

#[test]
fn every_key_reaches_its_field() {
    assert_eq!(chosen("").law, ForceLaw::OpenLoop);
    let controller = chosen(
        "[controller]\nkind = 'proportional_integral'\nproportional_gain = 2\nintegral_gain_per_s = 7\nperiod_ms = 4",
    );
    assert_eq!((controller.period, controller.steps(1e-3)), (4e-3, 4));
    assert!(controller.gives("proportional_gain") && !controller.gives("rate_per_s"));
    let expected = ForceLaw::ProportionalIntegral {
        proportional_gain: Some(2.0),
        integral_gain: Some(7.0),
    };
    assert_eq!(controller.law, expected);
    let expected = ForceLaw::FeedbackLinearisation {
        rate: Some(150.0),
        integral_gain: None,
    };
    let lines = "[controller]\nkind = 'feedback_linearisation'\nrate_per_s = 150";
    assert_eq!(chosen(lines).law, expected);
    let lines = "[controller]\nkind = 'disturbance_prediction'\nresponse_time_s = 0.02\nobserver_time_s = 0.03\n\
        tracking_frequency_rad_per_s = 50\nfriction_n = 12\nviscous_n_s_per_m = 30\npresliding_um = 20\nfriction_uncertainty = 0.25";
    let expected = ForceLaw::DisturbancePrediction {
        response_time: Some(0.02),
        observer_time: Some(0.03),
        tracking_frequency: Some(50.0),
        // Breaking away takes as much as of the device, more than sliding.
        seals: Some(SealFriction {
            coulomb: 12.0,
            static_force: 14.0,
            stribeck_velocity: 0.01,
            viscous: 30.0,
            presliding_displacement: 20e-6,
            pressure_coefficient: 0.0,
        }),
        friction_uncertainty: Some(0.25),
    };
    assert_eq!(chosen(lines).law, expected);
}

#[test]
fn the_period_is_that_of_the_sensors_in_whole_steps() {
    for (sensing, period) in [
        ("", 1e-3),
        ("[sensing]\nsample_rate_hz = 100\n", 0.01),
        // 3.3 ms: the next whole step, so that each answer has a sample of its own.
        ("[sensing]\nsample_rate_hz = 300\n", 4e-3),
        ("[sensing]\nsample_rate_hz = 1000\n", 1e-3),
    ] {
        let found = chosen(sensing).period;
        assert!((found - period).abs() < 1e-12, "{sensing}: {found}");
    }
}

#[test]
fn misuse_is_refused_by_place_and_key() {
    // The lines begin after the 13 of the bench.
    for (lines, location, words) in [
        (
            "[controller]\nkind = 'bang_bang'",
            "15:8",
            "`controller.kind` is 'bang_bang', expected one of `open_loop`, `proportional_integral`, `feedback_linearisation`, `disturbance_prediction`",
        ),
        (
            "[controller]\nkind = 'proportional_integral'\nproportional_gain = -1",
            "16:1",
            "`controller.proportional_gain` is -1, expected 0 to 1000",
        ),
        (
            "[controller]\nkind = 'proportional_integral'\nrate_per_s = 3",
            "16:1",
            "`controller.rate_per_s` cannot stand here: kind = \"proportional_integral\" has period_ms, proportional_gain, integral_gain_per_s",
        ),
        (
            "[controller]\nintegral_gain_per_s = 3",
            "15:1",
            "`controller.integral_gain_per_s` cannot stand here: kind = \"open_loop\" has period_ms",
        ),
        (
            "[controller]\nperiod_ms = 1.5",
            "15:1",
            "`controller.period_ms` is 1.5 ms, expected whole steps of simulation.step_ms, 1 ms",
        ),
        (
            "[controller]\nperiod_ms = 5\n[sensing]\nsample_rate_hz = 100",
            "15:1",
            "`controller.period_ms` is 5 ms, expected at least the sample period of [sensing], 10 ms",
        ),
        (
            "[controller]\nkind = 'disturbance_prediction'\nfriction_n = 9\nstatic_friction_n = 8",
            "17:1",
            "`controller.static_friction_n` is 8 N, expected at least the nominal sliding friction, 9 N",
        ),
        (
            "[controller]\nintegral_gain = 3",
            "15:1",
            "unknown key `controller.integral_gain`; the key is `integral_gain_per_s`, in 1/s",
        ),
    ] {
        text_refused(&pressing(lines), location, words);
    }
}

#[test]
fn a_controller_without_a_force_to_control_is_refused() {
    let lines = "[controller]\nkind = 'proportional_integral'\n";
    text_refused(
        &format!("{MINIMAL_BENCH}{lines}"),
        "11:1",
        "`controller.kind` cannot stand here: no [[command]] gives a force, so there is nothing to control",
    );
    let force = "[[command]]\nat_s = 0\nforce_n = 100\n";
    text_refused(
        &format!("{MINIMAL_BENCH}{force}{lines}"),
        "14:1",
        "`controller.kind` cannot stand here: nothing is met when load.kind = \"free\", so there is no force to feed back",
    );
    let device = "model = \"../models/device.toml\"\n";
    let locked = replaced(MINIMAL, device, &format!("{device}locked = true\n"));
    text_refused(
        &format!("{locked}{lines}"),
        "19:1",
        "`controller.kind` cannot stand here: the slide is clamped (device.locked), so that no pressure changes the force",
    );
}

#[test]
fn a_force_beyond_the_set_range_of_the_regulator_is_refused() {
    let force = |force: &str, more: &str| {
        let text = replaced(
            &pressing(""),
            "force_n = 100",
            &format!("force_n = {force}"),
        );
        format!("{text}{more}")
    };
    text_refused(
        &force("1000", ""),
        "13:1",
        "`command[0].force_n` is 1000 N, which needs 6.22 bar gauge at the regulator; the supply gives 0 to 6.00 bar, expected 0.0 to 965.1 N",
    );
    // 4 V PWM, amplified by 1.6: 6.4 of 8 V.
    let chain = "[sensing.command]\nkind = 'real'\npwm_high_v = 4\n";
    text_refused(
        &force("800", chain),
        "13:1",
        "`command[0].force_n` is 800 N, which needs 4.97 bar gauge at the regulator; [sensing.command] can set 0 to 4.80 bar, expected 0.0 to 772.1 N",
    );
    assert!(read_bench(&force("770", chain)).is_ok());
    // A device that presses down with its weight of 39.24 N.
    let heavy = replaced(
        &force("30", ""),
        "duration_s = 6\n",
        "duration_s = 6\ngravity_along_extension_m_per_s2 = 9.81\n",
    );
    text_refused(
        &heavy,
        "14:1",
        "`command[0].force_n` is 30 N, which needs -0.06 bar gauge at the regulator; the supply gives 0 to 6.00 bar, expected 39.2 to 1004.3 N",
    );
}
