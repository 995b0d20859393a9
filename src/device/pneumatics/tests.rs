//! The device against closed forms, conserved quantities and halved steps.

use super::*;
use crate::physics::gas::Gas;
use crate::physics::push_only::PushOnly;
use crate::physics::regulator::RegulatorParameters;
use crate::physics::seal_friction::SealFriction;

fn parameters() -> DeviceParameters {
    DeviceParameters {
        cylinder_count: 2,
        bore: 0.032,
        rod: 0.012,
        full_stroke: 0.05,
        dead_volume: 2e-5,
        moving_mass: 4.0,
        supply_orifice: 2.5e-6,
        exhaust_orifice: 2e-6,
        discharge_coefficient: 0.95,
        regulator: RegulatorParameters {
            gain: 1.0,
            time_constant: 0.15,
            dead_time: 0.02,
            supply: 6e5,
            ..RegulatorParameters::default()
        },
        end_stop: PushOnly {
            stiffness: 1e6,
            damping: 2e3,
        },
        seal_friction: SealFriction::NONE,
        gas: Gas::default(),
        gas_process: GasProcess::Isothermal,
        hose: None,
        lock_stiffness: 1e8,
        ..DeviceParameters::default()
    }
}

const STILL: PistonMotion = PistonMotion {
    stroke: 0.025,
    speed: 0.0,
};

#[test]
fn at_rest_nothing_flows() {
    let device = Device::new(parameters());
    let mut state = device.at_rest(0.025, 2e5);
    let before = state.air.masses;
    let mut force = 0.0;
    for _ in 0..1000 {
        force = device.advance(&mut state, 2e5, STILL, 1e-3, 2).force;
    }
    let area = device.parameters().areas().extending;
    assert!((force - 2e5 * area).abs() < 1e-6, "{force}");
    for (now, before) in state.air.masses.iter().zip(before) {
        assert!((now / before - 1.0).abs() < 1e-12);
    }
}

#[test]
fn a_choked_chamber_fills_linearly() {
    // Regulator at once at 6 bar, chamber from 1 to 3 bar absolute: choked below 0.528 of 7 bar.
    let mut parameters = parameters();
    parameters.regulator.time_constant = 1e-9;
    parameters.regulator.dead_time = 0.0;
    let device = Device::new(parameters);
    let mut state = device.at_rest(0.025, 0.0);
    let gas = Gas::default();
    let volume = 2e-5 + device.parameters().areas().extending * 0.025;
    let upstream: f64 = 6e5 + gas.atmosphere;
    let rt = gas.specific_gas_constant * gas.temperature;
    let flow = 0.95 * 2.5e-6 * upstream / rt.sqrt() * (1.4 * (2.0f64 / 2.4).powi(6)).sqrt();
    let rate = flow * rt / volume;
    device.advance(&mut state, 6e5, STILL, 1e-6, 1);
    let start = device.pressures(&state, 0.025)[0];
    for step in 1..=8 {
        device.advance(&mut state, 6e5, STILL, 1e-3, 2);
        let expected = start + rate * 1e-3 * f64::from(step);
        let pressure = device.pressures(&state, 0.025)[0];
        assert!(pressure < 0.528 * upstream, "no longer choked");
        assert!(
            (pressure / expected - 1.0).abs() < 1e-6,
            "{pressure} against {expected}"
        );
    }
}

#[test]
fn closed_chambers_are_isothermal_springs_that_give_back_their_work() {
    let mut parameters = parameters();
    parameters.supply_orifice = 0.0;
    parameters.exhaust_orifice = 0.0;
    let device = Device::new(parameters);
    let mut state = device.at_rest(0.01, 2e5);
    let start = device.pressures(&state, 0.01);
    let volumes = |stroke: f64| device.chambers.map(|chamber| chamber.volume(stroke));
    let (mut work, mut stroke) = (0.0, 0.01);
    for step in 0..2000 {
        let speed = if step < 1000 { 0.03 } else { -0.03 };
        let motion = PistonMotion { stroke, speed };
        work += device.advance(&mut state, 2e5, motion, 1e-3, 2).force * speed * 1e-3;
        stroke += speed * 1e-3;
        if step == 999 {
            // Work of the gas from 10 to 40 mm: sum of p0 V0 ln(V/V0), less the atmosphere's on the rod.
            let gas: f64 = (0..2)
                .map(|i| start[i] * volumes(0.01)[i] * (volumes(0.04)[i] / volumes(0.01)[i]).ln())
                .sum();
            let expected = gas - Gas::default().atmosphere * device.areas.rod() * 0.03;
            assert!(
                (work / expected - 1.0).abs() < 1e-7,
                "{work} against {expected}"
            );
            let pressure = device.pressures(&state, stroke)[0];
            assert!(
                (pressure * volumes(stroke)[0] / (start[0] * volumes(0.01)[0]) - 1.0).abs() < 1e-12
            );
        }
    }
    assert!(work.abs() < 1e-9, "{work} J were lost or made");
}

/// Regulator stepping up while the piston swings: pressures at the end [Pa], air entered less left less held [kg].
fn swing(substeps: usize) -> ([f64; 2], f64) {
    let device = Device::new(parameters());
    let mut state = device.at_rest(0.025, 1e5);
    let held: f64 = state.air.masses.iter().sum();
    let (dt, steps) = (1e-3, 400);
    let mut stroke = 0.025;
    for step in 0..steps {
        let speed = 0.1 * (20.0 * dt * f64::from(step)).cos();
        device.advance(
            &mut state,
            2.5e5,
            PistonMotion { stroke, speed },
            dt,
            substeps,
        );
        stroke += speed * dt;
    }
    let now: f64 = state.air.masses.iter().sum();
    (
        device.pressures(&state, stroke),
        state.air.entered - state.air.left - (now - held),
    )
}

#[test]
fn two_substeps_a_millisecond_are_enough_and_no_air_is_lost() {
    let (reference, _) = swing(64);
    for (substeps, tolerance) in [(1, 2e-4), (2, 2e-5), (4, 2e-6)] {
        let (pressures, lost) = swing(substeps);
        for (pressure, reference) in pressures.iter().zip(reference) {
            assert!(
                (pressure / reference - 1.0).abs() < tolerance,
                "{substeps}: {pressure} against {reference}"
            );
        }
        assert!(lost.abs() < 1e-18, "{lost} kg");
    }
}

#[test]
fn the_end_stop_adds_its_push_and_its_damping() {
    let device = Device::new(parameters());
    let mut state = device.at_rest(0.0501, 1e5);
    let motion = PistonMotion {
        stroke: 0.0501,
        speed: 0.01,
    };
    let free = device.gas_force(&state, 0.0501);
    let force = device.advance(&mut state, 1e5, motion, 1e-5, 1);
    assert!(
        (force.force - (free - 1e6 * 1e-4 - 2e3 * 0.01)).abs() < 0.1,
        "{force:?}"
    );
    assert_eq!(force.damping, 2e3);
}
