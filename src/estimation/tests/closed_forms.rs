//! At rest and without noise everything has a closed form.

use super::ensemble::parameters;
use super::plant::{PERIOD, device};
use crate::device::DeviceParameters;
use crate::estimation::{
    ContactForceEstimator, EstimatorOutput, EstimatorParameters, Measurement, ProcessModel,
    SensorNoise, Tolerances,
};
use crate::physics::seal_friction::SealFriction;
use crate::physics::valve::ValvePosition;

const QUIET: SensorNoise = SensorNoise {
    stroke: 1e-9,
    acceleration: 1e-6,
    regulator_pressure: 1e-3,
};

fn rest(valve: ValvePosition) -> Measurement {
    Measurement {
        stroke: 0.025,
        acceleration: 0.0,
        regulator_pressure: 1.8e5,
        valve,
    }
}

fn settle(
    data: &DeviceParameters,
    given: &EstimatorParameters,
    sample: &Measurement,
) -> EstimatorOutput {
    let mut estimator = ContactForceEstimator::new(data, given, sample.stroke, PERIOD).unwrap();
    let mut estimate = estimator.update(sample);
    for _ in 0..3000 {
        estimate = estimator.update(sample);
    }
    estimate
}

fn frictionless() -> DeviceParameters {
    DeviceParameters {
        seal_friction: SealFriction::NONE,
        ..device()
    }
}

#[test]
fn at_rest_the_force_is_pressure_times_area_less_the_weight() {
    let data = frictionless();
    let areas = data.areas();
    for gravity in [0.0, 9.81, -9.81] {
        let given = EstimatorParameters {
            gravity_along_axis: gravity,
            ..parameters(&data, Tolerances::NONE)
        };
        for (valve, gas) in [
            (ValvePosition::Extend, 1.8e5 * areas.extending),
            (ValvePosition::Retract, -1.8e5 * areas.retracting),
        ] {
            let estimate = settle(&data, &given, &rest(valve));
            let expected = gas + data.moving_mass * gravity;
            let error = estimate.force - expected;
            assert!(error.abs() < 1e-4, "{valve:?} {gravity}: {error} N");
            assert!((estimate.gas_force - gas).abs() < 1e-4);
        }
    }
}

#[test]
fn at_rest_without_noise_the_variance_is_the_sum_of_the_tolerances() {
    // A^2 b^2 + M^2 dg^2 + (dM/M)^2 (M g)^2 + (dA/A)^2 F_gas^2 + F_s^2, each limit over the square root of 3: seals at rest may hold any force.
    let data = device();
    let tolerances = Tolerances {
        acceleration_bias: 0.0,
        piston_area: 0.005,
        ..Tolerances::default()
    };
    let given = EstimatorParameters {
        gravity_along_axis: -9.81,
        ..EstimatorParameters::new(QUIET, tolerances)
    };
    let estimate = settle(&data, &given, &rest(ValvePosition::Extend));
    let area = data.areas().extending;
    let expected = [
        area * tolerances.regulator_pressure_bias,
        data.moving_mass * tolerances.gravity_along_axis,
        data.moving_mass * 9.81 * tolerances.moving_mass,
        tolerances.piston_area * 1.8e5 * area,
        data.seal_friction.coulomb,
    ];
    let expected: f64 = expected.iter().map(|limit| limit * limit / 3.0).sum();
    let ratio = estimate.standard_deviation.powi(2) / expected;
    assert!((ratio - 1.0).abs() < 1e-3, "{ratio}");
}

#[test]
fn noise_of_the_acceleration_leaves_the_variance_of_a_scalar_walk() {
    // Walk of variance Q a sample, noise R: P = (sqrt(Q^2 + 4 Q R) - Q) / 2 after each sample. Stroke without worth, orifices that do not matter.
    let mut data = frictionless();
    data.supply_orifice = 1e-2;
    data.exhaust_orifice = 1e-2;
    let walk = 4.0;
    let noise = SensorNoise {
        stroke: 1e3,
        acceleration: 0.25,
        regulator_pressure: 1e-3,
    };
    let given = EstimatorParameters {
        models: vec![ProcessModel {
            acceleration_walk: walk,
            pressure_walk: 1e-3,
            dwell: 1.0,
        }],
        ..EstimatorParameters::new(noise, Tolerances::NONE)
    };
    let mut estimator = ContactForceEstimator::new(&data, &given, 0.025, PERIOD).unwrap();
    let mut estimate = estimator.update(&rest(ValvePosition::Extend));
    for _ in 0..200 {
        estimate = estimator.update(&rest(ValvePosition::Extend));
    }
    let (q, r) = (walk * walk * PERIOD, 0.25 * 0.25);
    let variance = 0.5 * ((q * q + 4.0 * q * r).sqrt() - q);
    let expected = data.moving_mass * variance.sqrt();
    let ratio = estimate.standard_deviation / expected;
    assert!((ratio - 1.0).abs() < 2e-3, "{ratio}");
}
