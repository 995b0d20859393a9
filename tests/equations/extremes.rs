//! Values that a device file may hold, at the ends of their ranges: the sub-steps have to be short enough for them.

use idc_cell::device::{Device, DeviceParameters, PistonMotion};
use idc_cell::physics::gas_process::GasProcess;
use idc_cell::physics::push_only::PushOnly;
use idc_cell::physics::seal_friction::SealFriction;
use idc_cell::physics::valve::ValvePosition;

use super::devices::{ADIABATIC, Outside, closed, filled, reached, still, usual, volumes};

/// Runs out at 4 bar for half a second, is pulled back for another, and must keep its air and its pressures all the way.
fn check(parameters: DeviceParameters) {
    let device = Device::new(parameters);
    let (mut state, mut motion) = (device.at_rest(0.02, 0.0), still(0.02));
    let first = state.air.held();
    for ms in 0..1000 {
        state.valve = match ms < 500 {
            true => ValvePosition::Extend,
            false => ValvePosition::Retract,
        };
        device.advance_loaded::<_, true>(&mut state, &mut motion, 4e5, &Outside::NOTHING, 1e-3, 2);
        assert!(
            motion.stroke.abs() < 0.06,
            "{ms} ms: stroke {} m",
            motion.stroke
        );
        for pressure in device.pressures(&state, motion.stroke) {
            // A chamber that is torn open falls below the atmosphere, but far from nothing.
            assert!(pressure > 1e4 && pressure < 2e6, "{ms} ms: {pressure} Pa");
        }
    }
    // Twice one chamber or the other was filled and let go of: a few of the first fillings, not dozens from chattering.
    let through = state.air.entered / first;
    assert!(through < 20.0, "{through} fillings went through");
}

// Catches: G / (m c_v) left out of the rates that the sub-steps are chosen by.
#[test]
fn the_largest_wall_conductance_is_integrated() {
    for (dead_volume, orifice) in [(2e-5, 2e-6), (1e-5, 1e-6)] {
        check(DeviceParameters {
            dead_volume,
            supply_orifice: orifice,
            exhaust_orifice: orifice,
            gas_process: GasProcess::WallHeat { conductance: 100.0 },
            ..usual()
        });
    }
}

// Catches: sub-steps for the dead volume where the piston, pressed into its stop, leaves less than that.
#[test]
fn a_small_dead_volume_survives_the_piston_in_its_stop() {
    for dead_volume in [3e-7, 1e-7] {
        check(DeviceParameters {
            dead_volume,
            supply_orifice: 5e-6,
            exhaust_orifice: 5e-6,
            ..usual()
        });
    }
}

// Catches: the seals' viscous coefficient over the mass left out of the same.
#[test]
fn the_most_viscous_seals_are_integrated() {
    check(DeviceParameters {
        seal_friction: SealFriction {
            coulomb: 10.0,
            static_force: 12.0,
            viscous: 1e5,
            ..SealFriction::NONE
        },
        ..usual()
    });
}

// Catches: the air springs left out of the rates that the sub-steps are chosen by, or the exponent left out of them.
#[test]
fn a_light_piston_on_small_volumes_swings_as_its_air_springs_say() {
    for (name, process, exponent) in [
        ("isothermal", GasProcess::Isothermal, 1.0),
        ("adiabatic", ADIABATIC, 1.4),
    ] {
        // A kilohertz and more, between stops that are soft and do not damp.
        let device = Device::new(DeviceParameters {
            full_stroke: 1e-3,
            dead_volume: 1e-7,
            moving_mass: 0.1,
            end_stop: PushOnly {
                stiffness: 1e4,
                damping: 0.0,
            },
            ..closed(process)
        });
        let (stroke, first, speed) = (5e-4, 7e5, 1e-3);
        let areas = device.parameters().areas();
        let second = (first * areas.extending - 101_325.0 * areas.rod()) / areas.retracting;
        let [v1, v2] = volumes(device.parameters(), stroke);
        let stiffness =
            first * areas.extending.powi(2) / v1 + second * areas.retracting.powi(2) / v2;
        let frequency = (exponent * stiffness / 0.1).sqrt();
        let mut state = filled(&device, stroke, [first, second], 0.0);
        let mut motion = PistonMotion { stroke, speed };
        let mut largest = 0.0f64;
        for ms in 1..=10 {
            device.advance_loaded::<_, true>(
                &mut state,
                &mut motion,
                0.0,
                &Outside::NOTHING,
                1e-3,
                1,
            );
            let expected = speed / frequency * (frequency * f64::from(ms) * 1e-3).sin();
            largest = largest.max((motion.stroke - stroke - expected).abs());
        }
        println!("{name}: {:.0} Hz", frequency / std::f64::consts::TAU);
        reached(
            "swing of a light piston, of its amplitude",
            largest / (speed / frequency),
            1e-2,
        );
    }
}
