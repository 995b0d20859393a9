//! Halved steps: the results do not hang on the step.

use idc_cell::cell::Cell;
use idc_cell::metrics::Summary;
use idc_cell::path::Phase;
use idc_cell::recording::{Recording, schema};
use idc_cell::rig::Rig;
use idc_cell::scenario::bench::{CommandScenario, HandScenario};
use idc_cell::scenario::{BenchScenario, load_bench};
use idc_cell::simulation::Simulation;

use crate::common::{project, run, scenario};

fn summaries(name: &str) -> [Summary; 2] {
    let coarse = scenario(name);
    let mut fine = coarse.clone();
    fine.simulation.step *= 0.5;
    // The pneumatic sub-step is a share of the step, so it is halved with it.
    [run(coarse).summary, run(fine).summary]
}

#[test]
fn halving_both_steps_moves_nothing_that_matters() {
    for name in ["plate_edge_ideal", "misplaced_part", "burred_edge"] {
        let [coarse, fine] = summaries(name);
        let change = |of: fn(&Summary) -> Option<f64>| {
            let [coarse, fine] = [of(&coarse), of(&fine)].map(Option::unwrap);
            (coarse / fine - 1.0).abs()
        };
        let force = change(|s| s.force_mean_n);
        let stroke = change(|s| s.stroke_max_mm).max(change(|s| s.stroke_min_mm));
        let [a, b] = [&coarse, &fine].map(|s| s.coefficient_of_variation_percent.unwrap());
        println!(
            "{name}: mean force moves {:.4} %, stroke {:.4} %, coefficient of variation {:.5} points",
            100.0 * force,
            100.0 * stroke,
            (a - b).abs()
        );
        assert!(force < 0.002 && stroke < 0.002, "{force} {stroke}");
        assert!((a - b).abs() < 0.05, "{a} against {b}");
    }
}

/// A signal of the whole cell: its name, its channels, and the scale of its size.
type Signal = (&'static str, &'static [&'static str], f64);

/// Signals of the coupled step outside of impacts: arm, slide, contact, device.
const SIGNALS: [Signal; 5] = [
    (
        "joint angles",
        &[
            "joint_1_position",
            "joint_2_position",
            "joint_3_position",
            "joint_4_position",
            "joint_5_position",
            "joint_6_position",
        ],
        1.0,
    ),
    ("stroke", &[schema::STROKE], 0.05),
    ("contact force", &[schema::CONTACT_FORCE], 150.0),
    ("device force", &[schema::DEVICE_FORCE], 150.0),
    ("chamber pressure", &[schema::CHAMBER_1_PRESSURE], 6e5),
];
/// Steps, each half of the one before, and the one against which their errors are [s].
const HALVED: [f64; 5] = [1e-3, 5e-4, 2.5e-4, 1.25e-4, 6.25e-5];
const FINEST: f64 = 2.5e-5;
/// From the start of following: when the tool slides steadily, and how long that is looked at [s].
const STEADY: [f64; 2] = [1.0, 3.0];

/// Signals while the edge is followed, at the coarsest step's times.
fn followed(step: f64) -> Vec<Vec<f64>> {
    let mut scenario = scenario("plate_edge_ideal");
    scenario.simulation.step = step;
    let cell = Cell::new(scenario).unwrap();
    let phases = cell.plan.phases();
    let follow = phases
        .iter()
        .find(|(phase, ..)| *phase == Phase::Follow)
        .unwrap();
    let [from, to] = STEADY.map(|time| ((follow.1 + time) / HALVED[0]).round() as usize);
    let mut simulation = Simulation::new(&cell);
    while (simulation.steps() as f64) * step < to as f64 * HALVED[0] {
        simulation.step().unwrap();
    }
    let recording = simulation.into_logs().0.into_recording().unwrap();
    let row = |i: usize| (i as f64 * HALVED[0] / step).round() as usize - 1;
    let values = |(_, channels, _): &Signal| {
        let channel = |name: &&str| {
            let values = recording.values(name).unwrap();
            (from..to).map(|i| values[row(i)]).collect::<Vec<f64>>()
        };
        channels.iter().flat_map(channel).collect()
    };
    SIGNALS.iter().map(values).collect()
}

// Catches: what is taken at the start or the end of a step where its middle is meant; a part of the step that knows nothing of what another did in it.
#[test]
fn the_whole_step_converges_by_the_second_order() {
    let finest = followed(FINEST);
    let errors = HALVED.map(|step| {
        let coarse = followed(step);
        let signals = coarse.iter().zip(&finest).zip(SIGNALS);
        let error = |((coarse, finest), (.., scale)): ((&Vec<f64>, &Vec<f64>), Signal)| {
            let pairs = coarse.iter().zip(finest);
            let sum: f64 = pairs.map(|(a, b)| ((a - b) / scale).powi(2)).sum();
            (sum / finest.len() as f64).sqrt()
        };
        signals.map(error).collect::<Vec<f64>>()
    });
    for (signal, (name, ..)) in SIGNALS.iter().enumerate() {
        let errors = errors.each_ref().map(|errors| errors[signal]);
        let order = (errors[0] / errors[4]).log2() / 4.0;
        let errors = errors.map(|error| format!("{error:.1e}")).join(", ");
        println!("{name}: {errors} at {HALVED:?} s, order {order:.2}");
        assert!(order >= 1.8, "{name}: {order}");
    }
}

/// Angles of the joints through a whole job [rad], its mass matrix taken at most in one of so many steps.
fn angles(name: &str, arm_steps: usize) -> Vec<Vec<f64>> {
    let mut scenario = scenario(name);
    scenario.simulation.arm_steps = arm_steps;
    let recording = Cell::new(scenario)
        .unwrap()
        .run(&mut |_| ())
        .unwrap()
        .recording;
    let channel = |joint: &&str| recording.values(joint).unwrap().to_vec();
    SIGNALS[0].1.iter().map(channel).collect()
}

// A tool that creeps over the part was once pushed to and fro by friction in the direction of the step before: a swing of three steps, 5e-6 rad at the fifth joint.
#[test]
fn a_mass_matrix_held_over_steps_moves_the_joints_by_less_than_encoders_read() {
    for name in ["tilted_wrist", "bracket_loop"] {
        let [held, each] = [16, 1].map(|arm_steps| angles(name, arm_steps));
        let joints = held.iter().flatten().zip(each.iter().flatten());
        let mut off: Vec<f64> = joints.map(|(held, each)| (held - each).abs()).collect();
        off.sort_by(f64::total_cmp);
        let percentile = off[off.len() * 9 / 10];
        println!("{name}: 90th percentile {percentile:.1e} rad");
        assert!(percentile < 2e-7, "{name}: {percentile}");
    }
}

// Catches: what is lacking at a step of Rapier's taken for more than it is, so that each step is Rapier's again.
#[test]
fn the_mass_matrix_is_held_over_steps_on_a_smooth_edge_and_on_a_burr() {
    for (name, least) in [("plate_edge_ideal", 3.5), ("deburred_edge", 6.0)] {
        let run = Cell::new(scenario(name)).unwrap().run(&mut |_| ()).unwrap();
        let steps = run.steps_per_mass_matrix;
        println!("{name}: {steps:.2} steps for one mass matrix");
        assert!(steps > least, "{name}: {steps}");
    }
}

/// A bench scenario's run by a number of sub-steps.
fn bench(scenario: &BenchScenario, substeps: usize) -> Recording {
    let mut scenario = scenario.clone();
    scenario.substeps = substeps;
    let (recording, stop) = Rig::new(scenario).unwrap().run(&mut |_| ()).unwrap();
    assert!(stop.is_none(), "{}", stop.unwrap());
    recording
}

/// Root mean square of the difference of two runs over full scale, pressures and stroke [1].
fn difference(one: &Recording, other: &Recording) -> f64 {
    let scales = [
        (schema::CHAMBER_1_PRESSURE, 6e5),
        (schema::CHAMBER_2_PRESSURE, 6e5),
        (schema::STROKE, 0.05),
    ];
    let mut sum = 0.0;
    for (channel, scale) in scales {
        let pairs = one
            .values(channel)
            .unwrap()
            .iter()
            .zip(other.values(channel).unwrap());
        sum += pairs.map(|(a, b)| ((a - b) / scale).powi(2)).sum::<f64>();
    }
    (sum / (scales.len() * one.sample_count()) as f64).sqrt()
}

/// Errors of a few numbers of sub-steps against one that is far finer.
fn errors<const N: usize>(
    scenario: &BenchScenario,
    substeps: [usize; N],
    finest: usize,
) -> [f64; N] {
    let finest = bench(scenario, finest);
    substeps.map(|substeps| difference(&bench(scenario, substeps), &finest))
}

#[test]
fn a_bench_whose_law_is_smooth_converges_by_the_fourth_order() {
    // A hand that rocks the piston on closed chambers, far from its stops.
    let mut scenario = load_bench(&project("scenarios/retract.toml")).unwrap();
    scenario.command = CommandScenario::SetPressure(Vec::new());
    scenario.valve.clear();
    scenario.start_stroke = 0.025;
    scenario.duration = 2.0;
    scenario.step = 0.02;
    scenario.hand = Some(HandScenario {
        peak_force: 40.0,
        frequency: 3.0,
        start: 0.0,
    });
    let device = &mut scenario.nominal.device;
    device.end_stop.stiffness = 1e4;
    device.end_stop.damping = 0.0;
    (device.supply_orifice, device.exhaust_orifice) = (0.0, 0.0);
    let errors = errors(&scenario, [16, 32, 64], 512);
    let orders: Vec<f64> = errors.windows(2).map(|e| (e[0] / e[1]).log2()).collect();
    println!("16, 32, 64 sub-steps in 20 ms: {errors:?}, orders {orders:.2?}");
    for order in orders {
        assert!((3.5..4.5).contains(&order), "{order}");
    }
}

// Contacts and stops are met to a ten-millionth of a sub-step, but the edge of the orifice law's linear part is stepped over: there the order is two.
#[test]
fn the_papers_benches_converge_with_their_substeps() {
    for name in ["paper_step", "paper_stairstep", "hand_push", "retract"] {
        let scenario = load_bench(&project(&format!("scenarios/{name}.toml"))).unwrap();
        let errors = errors(&scenario, [2, 8, 32], 256);
        println!("{name}: 2, 8, 32 sub-steps a millisecond {errors:?} of full scale");
        assert!(errors[0] < 2e-7, "{name}: {errors:?}");
        assert!(errors[2] < errors[0] / 10.0, "{name}: {errors:?}");
    }
}
