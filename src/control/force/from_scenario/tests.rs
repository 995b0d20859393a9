//! A scenario's words against the controllers' own limits.

use std::path::Path;

use super::super::test_plant::{CONTACT, device};
use super::*;
use crate::plant::ContactParameters;
use crate::scenario::{BenchScenario, load_bench};

fn moving_surface() -> BenchScenario {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenarios/moving_surface.toml");
    load_bench(&path).unwrap()
}

/// Result of a law on the bench of the moving surface.
fn built(law: ForceLaw) -> Result<ForceController, ScenarioError> {
    let mut bench = moving_surface();
    let mut choice = bench.controller;
    choice.law = law;
    bench.nominal.contact = ContactParameters::linear(CONTACT.stiffness, CONTACT.damping);
    let pressing = Pressing {
        force: 0.0,
        share: 1.0,
    };
    ForceController::of_scenario(
        &choice,
        &bench.nominal,
        &bench.sensing,
        Some(pressing),
        bench.step,
    )
}

fn proportional_integral(gain: f64, integral: f64) -> ForceLaw {
    ForceLaw::ProportionalIntegral {
        proportional_gain: Some(gain),
        integral_gain: Some(integral),
    }
}

/// The numbers that a message gives as the limits.
fn limits(message: &str) -> Vec<f64> {
    let expected = message.rsplit_once("expected ").unwrap().1;
    expected
        .split(' ')
        .filter_map(|word| word.parse().ok())
        .collect()
}

#[test]
fn the_reported_limit_is_stable_and_little_more_is_not() {
    let message = built(proportional_integral(50.0, 400.0))
        .unwrap_err()
        .to_string();
    assert!(
        message.contains("`controller.proportional_gain` is 50, its default, with which the loop is unstable: at "),
        "{message}"
    );
    let stated = limits(&message);
    let [gain, integral] = stated[..] else {
        panic!("{message}")
    };
    // In proportion, but for the rounding.
    assert!((integral / gain / 8.0 - 1.0).abs() < 1e-3, "{message}");
    assert!(built(proportional_integral(gain, integral)).is_ok());
    assert!(built(proportional_integral(1.005 * gain, 1.005 * integral)).is_err());

    let rate = |rate| ForceLaw::FeedbackLinearisation {
        rate: Some(rate),
        integral_gain: None,
    };
    let message = built(rate(5000.0)).unwrap_err().to_string();
    let [most] = limits(&message)[..] else {
        panic!("{message}")
    };
    assert!(built(rate(most)).is_ok() && built(rate(1.005 * most)).is_err());

    let response = |time| ForceLaw::DisturbancePrediction {
        response_time: Some(time),
        observer_time: None,
        tracking_frequency: None,
        seals: None,
        friction_uncertainty: None,
    };
    let message = built(response(1e-4)).unwrap_err().to_string();
    let [least] = limits(&message)[..] else {
        panic!("{message}")
    };
    assert!(built(response(least)).is_ok() && built(response(0.995 * least)).is_err());
}

#[test]
fn an_integral_alone_is_blamed_alone() {
    let message = built(proportional_integral(0.0, 400.0))
        .unwrap_err()
        .to_string();
    assert!(message.contains("`controller.integral_gain_per_s` is 400 1/s"));
    let [most] = limits(&message)[..] else {
        panic!("{message}")
    };
    assert!(built(proportional_integral(0.0, most)).is_ok());
}

#[test]
fn the_rc_and_the_filter_take_from_the_gains() {
    let plain = device(10.0);
    let (ideal, paper) = (SensingParameters::ideal(), SensingParameters::paper());
    assert_eq!(sensed_device(&plain, &ideal), plain);
    // 10 kohm and 10 uF: half of 0.1 s to either.
    let regulator = sensed_device(&plain, &paper).regulator;
    assert!((regulator.time_constant - 0.2).abs() < 1e-12);
    assert!((regulator.dead_time - 0.07).abs() < 1e-12);
    let gain = |device: &DeviceParameters| {
        let law = ForceLaw::ProportionalIntegral {
            proportional_gain: None,
            integral_gain: None,
        };
        match parameters(&law, device) {
            ControllerParameters::ProportionalIntegral(gains) => gains.proportional_gain,
            other => panic!("{other:?}"),
        }
    };
    let behind_rc = sensed_device(&plain, &paper);
    assert!(gain(&behind_rc) < 0.6 * gain(&plain));
    assert!(gain(&delayed(&behind_rc, 0.03)) < 0.8 * gain(&behind_rc));
}
