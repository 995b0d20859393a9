//! Optional parts of a device - leaks, loads, cushions, a finite supply, a late valve - against closed forms.

use super::{Device, DeviceParameters, Load, PistonMotion};
use crate::physics::axial_load::AxialLoad;
use crate::physics::end_cushioning::EndCushioning;
use crate::physics::gas_process::GasProcess;
use crate::physics::leakage::Leakage;
use crate::physics::regulator::RegulatorParameters;
use crate::physics::seal_friction::SealFriction;
use crate::physics::supply_reservoir::SupplyReservoir;
use crate::physics::valve::ValvePosition;

/// A piston that nothing else acts on.
struct Alone;

impl Load for Alone {
    type Now = ();

    fn now(&self, _: f64) {}

    fn force(&self, (): &(), _: PistonMotion, _: bool) -> f64 {
        0.0
    }

    fn touches(&self, (): &(), _: PistonMotion) -> bool {
        false
    }

    fn rate(&self) -> f64 {
        0.0
    }
}

const STILL: PistonMotion = PistonMotion {
    stroke: 0.025,
    speed: 0.0,
};

/// The usual device without openings, which obeys its set pressure at once.
fn closed() -> DeviceParameters {
    DeviceParameters {
        supply_orifice: 0.0,
        exhaust_orifice: 0.0,
        regulator: RegulatorParameters {
            time_constant: 1e-9,
            dead_time: 0.0,
            ..RegulatorParameters::default()
        },
        ..DeviceParameters::default()
    }
}

/// Decay of a pressure over a choked orifice [1/s]: A C f sqrt(R T) / V.
fn choked_rate(area: f64, volume: f64) -> f64 {
    let choked = (1.4f64 * (2.0f64 / 2.4).powi(6)).sqrt();
    area * 0.95 * choked * (287.05f64 * 293.15).sqrt() / volume
}

#[test]
fn a_leak_to_the_atmosphere_empties_chamber_1_exponentially_while_choked() {
    let device = Device::new(DeviceParameters {
        leakage: Leakage {
            external: 3e-7,
            ..Leakage::NONE
        },
        ..closed()
    });
    let mut state = device.at_rest(0.025, 5e5);
    let [before, other] = device.pressures(&state, 0.025);
    let rate = choked_rate(3e-7, device.chambers[0].volume(0.025));
    for step in 1..=300 {
        device.advance(&mut state, 0.0, STILL, 1e-3, 1);
        let [now, untouched] = device.pressures(&state, 0.025);
        let expected = before * (-rate * 1e-3 * f64::from(step)).exp();
        assert!((now / expected - 1.0).abs() < 1e-10, "{now} {expected}");
        assert_eq!(untouched, other);
    }
    let lost = (before - device.pressures(&state, 0.025)[0]) / before;
    assert!(lost > 0.2 && state.air.entered == 0.0, "{lost}");
    for _ in 0..20_000 {
        device.advance(&mut state, 0.0, STILL, 1e-3, 1);
    }
    assert!((device.pressures(&state, 0.025)[0] - 101_325.0).abs() < 1.0);
}

/// A leak that is set from outside is one of the parameters' area, of either chamber, and what is added to the set pressure is set.
#[test]
fn what_is_set_from_outside_acts_as_a_leak_and_as_a_set_pressure() {
    let leaky = Device::new(DeviceParameters {
        leakage: Leakage {
            external: 3e-7,
            ..Leakage::NONE
        },
        ..closed()
    });
    let tight = Device::new(closed());
    let mut expected = leaky.at_rest(0.025, 5e5);
    let mut first = tight.at_rest(0.025, 5e5);
    first.disturbance.leaks = [3e-7, 0.0];
    let mut second = tight.at_rest(0.025, 0.0);
    second.air.masses[1] *= 4.0;
    second.disturbance.leaks = [0.0, 3e-7];
    let before = tight.pressures(&second, 0.025)[1];
    let rate = choked_rate(3e-7, tight.chambers[1].volume(0.025));
    for step in 1..=100 {
        leaky.advance(&mut expected, 0.0, STILL, 1e-3, 1);
        for state in [&mut first, &mut second] {
            tight.advance(state, 0.0, STILL, 1e-3, 1);
        }
        let [a, b] = [&expected, &first].map(|state| state.air.masses[0]);
        assert!((a / b - 1.0).abs() < 1e-12, "{a} {b}");
        let decayed = before * (-rate * 1e-3 * f64::from(step)).exp();
        let now = tight.pressures(&second, 0.025)[1];
        assert!((now / decayed - 1.0).abs() < 1e-9, "{now} {decayed}");
    }
    let open = Device::new(DeviceParameters::default());
    let [mut plain, mut moved] = [0, 1].map(|_| open.at_rest(0.025, 0.0));
    moved.disturbance.set_pressure = 1e5;
    for _ in 0..200 {
        open.advance(&mut plain, 3e5, STILL, 1e-3, 1);
        open.advance(&mut moved, 2e5, STILL, 1e-3, 1);
    }
    assert_eq!(plain.air, moved.air);
}

#[test]
fn a_leak_past_the_piston_moves_air_and_its_heat_and_loses_none() {
    for gas_process in [
        GasProcess::Isothermal,
        GasProcess::WallHeat { conductance: 0.0 },
    ] {
        let device = Device::new(DeviceParameters {
            leakage: Leakage {
                cross_piston: 4e-7,
                ..Leakage::NONE
            },
            gas_process,
            ..closed()
        });
        let mut state = device.at_rest(0.025, 5e5);
        let (held, energy) = (state.air.held(), device.internal_energy(&state));
        let before = device.pressures(&state, 0.025);
        let volumes = device.chambers.map(|chamber| chamber.volume(0.025));
        let rate = choked_rate(4e-7, volumes[0]);
        for _ in 0..50 {
            device.advance(&mut state, 0.0, STILL, 1e-3, 1);
        }
        if gas_process == GasProcess::Isothermal {
            let expected = before[0] * (-rate * 0.05).exp();
            assert!((device.pressures(&state, 0.025)[0] / expected - 1.0).abs() < 1e-10);
        } else {
            // What stays behind expands without heat: p V^k.
            let mass = gas_mass(before[0], volumes[0]);
            let temperature = 293.15 * (state.air.masses[0] / mass).powf(0.4);
            let error = device.temperatures(&state)[0] / temperature - 1.0;
            assert!(error.abs() < 1e-9, "{error:e}");
        }
        for _ in 0..5000 {
            device.advance(&mut state, 0.0, STILL, 1e-3, 1);
        }
        assert!((state.air.held() / held - 1.0).abs() < 1e-13);
        assert_eq!((state.air.entered, state.air.left), (0.0, 0.0));
        assert!((device.internal_energy(&state) / energy - 1.0).abs() < 1e-12);
        let even = (before[0] * volumes[0] + before[1] * volumes[1]) / (volumes[0] + volumes[1]);
        for pressure in device.pressures(&state, 0.025) {
            assert!((pressure / even - 1.0).abs() < 1e-5, "{pressure} {even}");
        }
    }
}

fn gas_mass(pressure: f64, volume: f64) -> f64 {
    pressure * volume / (287.05 * 293.15)
}

#[test]
fn the_axial_load_moves_the_piston_to_where_it_balances_the_gas() {
    let parameters = DeviceParameters {
        axial_load: AxialLoad {
            force: -20.0,
            return_stiffness: 2500.0,
        },
        ..DeviceParameters::default()
    };
    let device = Device::new(parameters);
    let mut state = device.at_rest(0.0, 0.0);
    let mut motion = PistonMotion {
        stroke: 0.0,
        speed: 0.0,
    };
    for _ in 0..20_000 {
        device.advance_loaded::<_, true>(&mut state, &mut motion, 5e4, &Alone, 1e-3, 2);
    }
    let balance = (5e4 * device.parameters().areas().extending - 20.0) / 2500.0;
    assert!(
        (motion.stroke - balance).abs() < 1e-6,
        "{motion:?} {balance}"
    );
    assert!(device.piston_force(&state, motion).abs() < 1e-3);
    let predicted = device.advance(&mut state, 5e4, motion, 1e-3, 2);
    assert_eq!(predicted.stiffness, 2500.0);
    assert!(predicted.force.abs() < 1e-2, "{predicted:?}");
    let stored = 0.5 * 2500.0 * balance * balance + 20.0 * balance;
    assert!((state.ledger.axial_work / stored + 1.0).abs() < 1e-4);
}

#[test]
fn a_coasting_piston_is_slowed_by_its_cushion_as_far_as_the_closed_form_says() {
    // Chambers so large that their pressures stay, at the atmosphere.
    let device = Device::new(DeviceParameters {
        dead_volume: 1e4,
        end_cushioning: EndCushioning {
            damping: 900.0,
            length: 8e-3,
        },
        ..closed()
    });
    for direction in [1.0, -1.0] {
        let mut state = device.at_rest(0.025, 0.0);
        let mut motion = PistonMotion {
            stroke: 0.025,
            speed: direction,
        };
        let end = if direction > 0.0 { 0.05 } else { 0.0 };
        while (end - motion.stroke) * direction > 0.0 {
            device.advance_loaded::<_, true>(&mut state, &mut motion, 0.0, &Alone, 1e-4, 1);
            if (end - motion.stroke) * direction > 8e-3 {
                assert!((motion.speed * direction - 1.0).abs() < 1e-6);
            }
        }
        // M dv/dx = -c (1 - d/l) down to the end; the stop has had part of one step.
        let at_end = 1.0 - 900.0 * 8e-3 / (2.0 * 4.0);
        assert!(
            (motion.speed * direction - at_end).abs() < 0.02,
            "{motion:?}"
        );
        let work = 0.5 * 4.0 * (1.0 - at_end * at_end);
        let booked = state.ledger.cushion_work;
        assert!((booked / work - 1.0).abs() < 5e-3, "{booked} {work}");
        // Back from the end it is free.
        assert_eq!(
            device.cushion_force(PistonMotion {
                stroke: end,
                speed: -direction
            }),
            0.0
        );
    }
}

#[test]
fn friction_grows_with_the_pressure_across_the_piston() {
    let device = Device::new(DeviceParameters {
        seal_friction: SealFriction {
            coulomb: 6.0,
            static_force: 6.0,
            viscous: 40.0,
            pressure_coefficient: 3e-5,
            ..SealFriction::NONE
        },
        ..closed()
    });
    let mut state = device.at_rest(0.02, 3e5);
    let mut motion = PistonMotion {
        stroke: 0.02,
        speed: 0.05,
    };
    let mut force = 0.0;
    for _ in 0..100 {
        force = device.advance(&mut state, 3e5, motion, 1e-3, 1).force;
        motion.stroke += motion.speed * 1e-3;
    }
    let [p1, p2] = device.pressures(&state, motion.stroke);
    let friction = 6.0 + 3e-5 * (p1 - p2) + 40.0 * 0.05;
    let middle = device.gas_force(&state, motion.stroke - 0.5 * motion.speed * 1e-3);
    // The bristles follow the rising level by their own displacement, 0.03 N late.
    assert!((middle - force - friction).abs() < 0.05, "{force}");
    assert!(friction > 12.0);
}

#[test]
fn a_reservoir_without_compressor_shares_its_air_and_holds_the_outlet_down() {
    let device = Device::new(DeviceParameters {
        exhaust_orifice: 0.0,
        supply_orifice: 2.5e-6,
        supply_reservoir: Some(SupplyReservoir::new(2e-4, 0.0)),
        ..closed()
    });
    let mut state = device.at_rest(0.05, 0.0);
    let still = PistonMotion {
        stroke: 0.05,
        speed: 0.0,
    };
    let before = (state.air.reservoir_mass, state.air.masses[0]);
    for _ in 0..3000 {
        device.advance(&mut state, 6e5, still, 1e-3, 1);
        let stored = state.air.reservoir_mass * 287.05 * 293.15 / 2e-4;
        assert!(state.regulator.outlet <= (stored - 101_325.0).min(6e5) * (1.0 + 1e-15));
    }
    let drawn = before.0 - state.air.reservoir_mass;
    assert!((drawn / (state.air.masses[0] - before.1) - 1.0).abs() < 1e-10);
    assert!((drawn / state.air.entered - 1.0).abs() < 1e-10);
    let volume = device.chambers[0].volume(0.05);
    let even = (7e5 * 2e-4 + 101_325.0 * volume) / (2e-4 + volume);
    assert!((device.pressures(&state, 0.05)[0] / even - 1.0).abs() < 1e-6);
    assert!((state.regulator.outlet / (even - 101_325.0) - 1.0).abs() < 1e-6);
    // What is let out does not come back.
    for _ in 0..1000 {
        device.advance(&mut state, 1e5, still, 1e-3, 1);
    }
    assert!((before.0 - state.air.reservoir_mass - drawn).abs() < 1e-12 * drawn);
    assert!(state.air.left > 0.1 * drawn);
}

#[test]
fn the_compressor_fills_the_reservoir_linearly_to_its_full_pressure() {
    let device = Device::new(DeviceParameters {
        supply_reservoir: Some(SupplyReservoir::new(1e-3, 2e-4)),
        ..closed()
    });
    let mut state = device.at_rest(0.025, 0.0);
    state.air.reservoir_mass *= 0.5;
    let before = state.air.reservoir_mass;
    for _ in 0..1000 {
        device.advance(&mut state, 0.0, STILL, 1e-3, 1);
    }
    assert!(((state.air.reservoir_mass - before) / 2e-4 - 1.0).abs() < 1e-10);
    for _ in 0..40_000 {
        device.advance(&mut state, 0.0, STILL, 1e-3, 1);
    }
    assert!((state.air.reservoir_mass / (2.0 * before) - 1.0).abs() < 1e-6);
}

#[test]
fn a_late_valve_does_what_a_prompt_one_does_that_is_commanded_later() {
    let run = |switching_delay: f64, commanded: std::ops::Range<i32>| {
        let device = Device::new(DeviceParameters {
            switching_delay,
            ..DeviceParameters::default()
        });
        let mut state = device.at_rest(0.0, 0.0);
        let mut motion = PistonMotion {
            stroke: 0.0,
            speed: 0.0,
        };
        let step = |step| {
            state.valve = match commanded.contains(&step) {
                true => ValvePosition::Retract,
                false => ValvePosition::Extend,
            };
            device.advance_loaded::<_, true>(&mut state, &mut motion, 2e5, &Alone, 1e-3, 1);
            motion.stroke
        };
        (0..1500).map(step).collect::<Vec<f64>>()
    };
    let (late, later, prompt) = (run(0.02, 400..800), run(0.0, 420..820), run(0.0, 400..800));
    for (late, later) in late.iter().zip(&later) {
        assert!((late - later).abs() < 1e-9, "{late} {later}");
    }
    assert!((late[600] - prompt[600]).abs() > 1e-3);
}

/// A wall that pushes, and the lengths of the sub-steps that were taken [s].
struct Wall {
    position: f64,
    lengths: std::cell::RefCell<Vec<f64>>,
}

impl Load for Wall {
    type Now = ();

    fn now(&self, _: f64) {}

    fn force(&self, (): &(), motion: PistonMotion, touching: bool) -> f64 {
        match touching {
            true => -1e5 * (motion.stroke - self.position) - 300.0 * motion.speed,
            false => 0.0,
        }
    }

    fn touches(&self, (): &(), motion: PistonMotion) -> bool {
        motion.stroke > self.position
    }

    fn note(&self, _: f64, length: f64, _: [PistonMotion; 2]) {
        self.lengths.borrow_mut().push(length);
    }

    fn rate(&self) -> f64 {
        200.0
    }
}

// A sub-step that was cut at a contact had those behind it begin as short as its last piece, and double from there.
#[test]
fn a_contact_that_is_met_leaves_the_sub_steps_behind_it_as_long_as_they_were() {
    let device = Device::new(DeviceParameters::default());
    let (dt, count) = (1e-3, 40);
    for place in 1..20 {
        let mut state = device.at_rest(0.02, 2e5);
        let mut motion = PistonMotion {
            stroke: 0.02,
            speed: 0.2,
        };
        let wall = Wall {
            position: 0.02 + 0.2 * dt * f64::from(place) / 20.0,
            lengths: std::cell::RefCell::default(),
        };
        device.advance_loaded::<_, true>(&mut state, &mut motion, 2e5, &wall, dt, count);
        let lengths = wall.lengths.borrow();
        let whole = dt / count as f64;
        let short = lengths.iter().filter(|length| **length < 0.99 * whole);
        assert!(motion.stroke > wall.position, "{place}: never touched");
        assert!(short.count() <= 2, "{place}: {lengths:?}");
        let sum: f64 = lengths.iter().sum();
        assert!((sum - dt).abs() < 1e-12);
    }
}
