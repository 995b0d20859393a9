//! Conserved quantities over the bench rig's trajectories: the mass of the air, and energy by both balances of `EnergyLedger`.

use idc_cell::device::{Device, DeviceParameters, DeviceState, PistonMotion};
use idc_cell::physics::axial_load::AxialLoad;
use idc_cell::physics::end_cushioning::EndCushioning;
use idc_cell::physics::gas::Gas;
use idc_cell::physics::gas_process::GasProcess;
use idc_cell::physics::hose::Hose;
use idc_cell::physics::leakage::Leakage;
use idc_cell::physics::regulator::{RateLimit, RegulatorParameters, SecondOrder};
use idc_cell::physics::seal_friction::SealFriction;
use idc_cell::physics::supply_reservoir::SupplyReservoir;
use idc_cell::physics::valve::ValvePosition;

use super::devices::{Outside, reached, still, usual};

/// A trajectory of scenarios/: times [s] with set pressures [Pa gauge] and with positions of the valve.
struct Trajectory {
    name: &'static str,
    commands: &'static [(f64, f64)],
    valve: &'static [(f64, ValvePosition)],
    duration: f64,
    load_cell: Option<f64>,
    late_regulator: bool,
}

const COURSES: [Trajectory; 3] = [
    Trajectory {
        name: "paper_step",
        commands: &[(0.5, 1.8e5)],
        valve: &[],
        duration: 6.0,
        load_cell: Some(0.04),
        late_regulator: true,
    },
    Trajectory {
        name: "paper_stairstep",
        commands: &[(0.5, 1.2e5), (5.5, 2.1e5), (10.5, 3e5)],
        valve: &[],
        duration: 16.0,
        load_cell: Some(0.04),
        late_regulator: true,
    },
    Trajectory {
        name: "retract",
        commands: &[(0.2, 1e5)],
        valve: &[(2.5, ValvePosition::Retract), (4.5, ValvePosition::Extend)],
        duration: 6.0,
        load_cell: None,
        late_regulator: false,
    },
];

const SEALS: SealFriction = SealFriction {
    coulomb: 10.0,
    static_force: 12.0,
    stribeck_velocity: 0.01,
    viscous: 20.0,
    presliding_displacement: 5e-5,
    pressure_coefficient: 0.0,
};

fn held<T: Copy>(steps: &[(f64, T)], time: f64) -> Option<T> {
    let due = steps.iter().rev().find(|step| step.0 <= time + 1e-9);
    due.map(|step| step.1)
}

/// Runs a trajectory by milliseconds, and shows each to `look`.
fn run(
    trajectory: &Trajectory,
    mut parameters: DeviceParameters,
    substeps: usize,
    look: &mut dyn FnMut(&Device, &DeviceState, PistonMotion),
) {
    if trajectory.late_regulator {
        parameters.regulator = RegulatorParameters {
            time_constant: 0.5,
            dead_time: 0.5,
            ..parameters.regulator
        };
    }
    let device = Device::new(parameters);
    let outside = trajectory
        .load_cell
        .map_or(Outside::NOTHING, Outside::load_cell);
    let (mut state, mut motion) = (device.at_rest(0.0, 0.0), still(0.0));
    look(&device, &state, motion);
    for step in 0..(trajectory.duration * 1e3).round() as usize {
        let time = step as f64 * 1e-3;
        state.valve = held(trajectory.valve, time).unwrap_or(ValvePosition::Extend);
        let set = held(trajectory.commands, time).unwrap_or(0.0);
        device.advance_loaded::<_, true>(&mut state, &mut motion, set, &outside, 1e-3, substeps);
        look(&device, &state, motion);
    }
}

// Catches: a flow that one account has and another has not: chamber, line, regulator, exhaust.
#[test]
fn air_is_neither_made_nor_lost() {
    let hose = Some(Hose::tube(2.0, 0.004, &Gas::default()));
    let mut largest = 0.0f64;
    for trajectory in &COURSES {
        for hose in [None, hose] {
            for gas_process in [
                GasProcess::Isothermal,
                GasProcess::WallHeat { conductance: 0.5 },
            ] {
                let parameters = DeviceParameters {
                    hose,
                    gas_process,
                    ..usual()
                };
                let (mut first, mut worst, mut moved) = (f64::NAN, 0.0f64, 0.0);
                run(trajectory, parameters, 1, &mut |_, state, _| {
                    let air = &state.air;
                    if first.is_nan() {
                        first = air.held();
                    }
                    let gap = air.held() - first - (air.entered - air.left);
                    worst = worst.max(gap.abs() / air.held());
                    moved = air.entered + air.left;
                });
                println!(
                    "{}, line {}, {gas_process:?}: {worst:.1e}",
                    trajectory.name,
                    hose.is_some()
                );
                assert!(moved > first, "air went through: {moved} kg");
                largest = largest.max(worst);
            }
        }
    }
    reached("mass of the air", largest, 1e-9);
}

/// Largest gaps of the balances over a trajectory.
struct Gaps {
    /// Of the air, of its work on the piston summed without its sign [1].
    air: f64,
    /// Of the piston, of the same [1].
    piston: f64,
    /// Of both together, of all that passed through any account, enthalpy included [1].
    whole: f64,
    /// That work [J].
    work: f64,
    /// All that passed [J].
    turned_over: f64,
}

/// The accounts of the ledger: enthalpy, heat, and the works on piston, atmosphere, seals, stops, cushions, of the axial load and of the load from outside.
fn accounts(state: &DeviceState) -> [f64; 9] {
    let ledger = &state.ledger;
    [
        ledger.enthalpy_in,
        ledger.heat_in,
        ledger.chamber_work,
        ledger.atmosphere_work,
        ledger.seal_work,
        ledger.stop_work,
        ledger.cushion_work,
        ledger.axial_work,
        ledger.load_work,
    ]
}

fn energy_gaps(trajectory: &Trajectory, parameters: DeviceParameters, substeps: usize) -> Gaps {
    let (mut first, mut before) = (f64::NAN, [0.0; 9]);
    let (mut air, mut piston, mut whole) = (0.0f64, 0.0f64, 0.0f64);
    let (mut work, mut turned_over) = (0.0, 0.0);
    run(
        trajectory,
        parameters,
        substeps,
        &mut |device, state, motion| {
            let energy = device.internal_energy(state);
            if first.is_nan() {
                first = energy;
            }
            let now = accounts(state);
            let [
                enthalpy,
                heat,
                chamber,
                atmosphere,
                seal,
                stop,
                cushion,
                axial,
                load,
            ] = now;
            let kinetic = 0.5 * device.parameters().moving_mass * motion.speed * motion.speed;
            let of_air = energy - first - (enthalpy + heat - chamber);
            let taken = atmosphere + seal + stop + cushion;
            let of_piston = kinetic - (chamber + axial + load - taken);
            air = air.max(of_air.abs());
            piston = piston.max(of_piston.abs());
            whole = whole.max((of_air + of_piston).abs());
            work += (now[2] - before[2]).abs();
            let passed = now
                .iter()
                .zip(before)
                .map(|(now, before)| (now - before).abs());
            turned_over += passed.sum::<f64>();
            before = now;
        },
    );
    Gaps {
        air: air / work,
        piston: piston / work,
        whole: whole / turned_over,
        work,
        turned_over,
    }
}

// Catches: a work or heat that is booked twice, not at all or with the wrong sign; an integration too coarse for its contacts and reversals.
#[test]
fn energy_balances_over_extension_retraction_extension() {
    let mut worst = [0.0f64; 4];
    let heated = GasProcess::WallHeat { conductance: 0.5 };
    for trajectory in &COURSES {
        for (seal_friction, gas_process) in [
            (SealFriction::NONE, GasProcess::Isothermal),
            (SealFriction::NONE, heated),
            (SEALS, GasProcess::Isothermal),
            (SEALS, heated),
        ] {
            let parameters = DeviceParameters {
                seal_friction,
                gas_process,
                ..usual()
            };
            // Two a millisecond are the bench's default.
            let gaps = [2, 4, 8, 16].map(|n| energy_gaps(trajectory, parameters.clone(), n));
            let shown: Vec<_> = gaps
                .iter()
                .map(|gap| format!("{:.1e}", gap.piston))
                .collect();
            println!(
                "{}, seals {} N, {gas_process:?}: work {:.1} J of {:.0} J turned over; air {:.1e}, piston by 2, 4, 8, 16 sub-steps {}",
                trajectory.name,
                seal_friction.coulomb,
                gaps[0].work,
                gaps[0].turned_over,
                gaps[0].air,
                shown.join(", ")
            );
            assert!(gaps[0].work > 1.0, "work was done");
            for (worst, found) in
                worst
                    .iter_mut()
                    .zip([gaps[0].air, gaps[0].whole, gaps[0].piston, gaps[1].piston])
            {
                *worst = worst.max(found);
            }
        }
    }
    reached("energy of the air, of its net work", worst[0], 1e-6);
    reached(
        "energy of the device, of all that was turned over, 2 sub-steps",
        worst[1],
        1e-6,
    );
    reached(
        "energy of the piston, of the net work of the air, 4 sub-steps",
        worst[3],
        1e-6,
    );
    // The hard landings of the retraction on the stops; falls with the fourth power of the sub-step.
    reached(
        "energy of the piston, of the net work of the air, 2 sub-steps",
        worst[2],
        1e-6,
    );
}

// Catches: an enthalpy or heat that both sides of the first balance book alike: here each is held against what it must be.
#[test]
fn isothermal_air_brings_c_p_t_and_takes_the_heat_of_its_work() {
    let trajectory = &COURSES[2];
    let mut largest = 0.0f64;
    run(trajectory, usual(), 1, &mut |device, state, _| {
        let gas = &device.parameters().gas;
        let brought = state.air.entered - state.air.left;
        let enthalpy = 1.4 / 0.4 * 287.05 * 293.15 * brought;
        // U = m c_v T, so that the heat is the work less the flow's share, R T m.
        let heat =
            state.ledger.chamber_work - gas.specific_gas_constant * gas.temperature * brought;
        largest = largest.max((state.ledger.enthalpy_in - enthalpy).abs());
        largest = largest.max((state.ledger.heat_in - heat).abs());
    });
    reached("enthalpy and heat of isothermal air [J]", largest, 1e-9);
}

/// Everything that a device need not have, at once.
fn burdened(gas_process: GasProcess, hose: Option<Hose>) -> DeviceParameters {
    DeviceParameters {
        regulator: RegulatorParameters {
            hysteresis: 4e3,
            rate_limit: RateLimit {
                rise: 9e5,
                fall: 6e5,
            },
            second_order: Some(SecondOrder {
                natural_frequency: 20.0,
                damping_ratio: 0.4,
            }),
            ..usual().regulator
        },
        seal_friction: SealFriction {
            pressure_coefficient: 2e-5,
            ..SEALS
        },
        leakage: Leakage {
            cross_piston: 1.5e-7,
            external: 1e-7,
        },
        axial_load: AxialLoad {
            force: -15.0,
            return_stiffness: 400.0,
        },
        end_cushioning: EndCushioning {
            damping: 700.0,
            length: 6e-3,
        },
        supply_reservoir: Some(SupplyReservoir::new(5e-4, 1e-4)),
        switching_delay: 0.0173,
        gas_process,
        hose,
        ..usual()
    }
}

// Catches: an effect whose flow or work is not booked, or is booked for another; one that makes air or energy.
#[test]
fn every_effect_keeps_both_accounts() {
    let hose = Some(Hose::tube(1.0, 0.004, &Gas::default()));
    let heated = GasProcess::WallHeat { conductance: 0.5 };
    let mut worst = [0.0f64; 3];
    for trajectory in &COURSES {
        for (gas_process, hose) in [
            (GasProcess::Isothermal, None),
            (GasProcess::Isothermal, hose),
            (heated, None),
            (heated, hose),
        ] {
            let parameters = burdened(gas_process, hose);
            let (mut first, mut gap) = (f64::NAN, 0.0f64);
            let (mut last, mut lowest) = (f64::NAN, f64::INFINITY);
            run(trajectory, parameters.clone(), 1, &mut |_, state, _| {
                let air = &state.air;
                if first.is_nan() {
                    first = air.held();
                    last = air.reservoir_mass;
                }
                lowest = lowest.min(air.reservoir_mass / last);
                gap = gap.max((air.held() - first - (air.entered - air.left)).abs() / air.held());
            });
            assert!(lowest < 0.9, "the reservoir was drawn from: {lowest}");
            let energy = energy_gaps(trajectory, parameters, 4);
            println!(
                "{}, line {}, {gas_process:?}: air {gap:.1e}, its energy {:.1e}, the piston's {:.1e} of {:.0} J",
                trajectory.name,
                hose.is_some(),
                energy.air,
                energy.piston,
                energy.work
            );
            for (worst, found) in worst.iter_mut().zip([gap, energy.air, energy.piston]) {
                *worst = worst.max(found);
            }
        }
    }
    reached("mass of the air with every effect", worst[0], 1e-9);
    reached("energy of the air with every effect", worst[1], 1e-6);
    reached(
        "energy of the piston with every effect, 4 sub-steps",
        worst[2],
        1e-6,
    );
}

// Catches: a ledger that stands still while somebody else moves the piston, or that leaves out stops, seals, cushions, the axial load or the
// atmosphere.
#[test]
fn a_foretold_piston_keeps_the_same_books() {
    let heated = GasProcess::WallHeat { conductance: 0.5 };
    for gas_process in [GasProcess::Isothermal, heated] {
        let device = Device::new(DeviceParameters {
            seal_friction: SEALS,
            axial_load: AxialLoad {
                force: -15.0,
                return_stiffness: 400.0,
            },
            end_cushioning: EndCushioning {
                damping: 700.0,
                length: 6e-3,
            },
            gas_process,
            ..usual()
        });
        let mut state = device.at_rest(0.03, 1e5);
        let first = device.internal_energy(&state);
        let (mut stroke, mut given, mut turned_over) = (0.03, 0.0, 0.0);
        for ms in 0..2000 {
            // Out to 0.5 mm beyond the end, and back.
            let speed = 0.0205 * 6.0 * (6e-3 * f64::from(ms)).cos();
            let motion = PistonMotion { stroke, speed };
            let set = if ms < 1000 { 1e5 } else { 2.5e5 };
            let before = accounts(&state);
            let force = device.advance(&mut state, set, motion, 1e-3, 2).force;
            given -= force * speed * 1e-3;
            stroke += speed * 1e-3;
            let passed = accounts(&state);
            let passed = passed
                .iter()
                .zip(before)
                .map(|(now, before)| (now - before).abs());
            turned_over += passed.sum::<f64>();
        }
        let [
            enthalpy,
            heat,
            chamber,
            atmosphere,
            seal,
            stop,
            cushion,
            axial,
            load,
        ] = accounts(&state);
        assert!(cushion > 1e-3 && axial.abs() > 1e-3);
        assert!(seal > 1.0 && stop.abs() > 1e-3 && chamber.abs() > 1.0 && atmosphere.abs() > 1e-3);
        let of_air = device.internal_energy(&state) - first - (enthalpy + heat - chamber);
        let of_piston = chamber + axial + load - atmosphere - seal - stop - cushion;
        println!("{gas_process:?}: {turned_over:.0} J turned over");
        reached(
            "air of a predicted piston",
            of_air.abs() / turned_over,
            1e-9,
        );
        reached("a predicted piston", of_piston.abs() / turned_over, 1e-12);
        reached(
            "work of the foreteller against force times way",
            (load - given).abs() / turned_over,
            1e-12,
        );
    }
}
