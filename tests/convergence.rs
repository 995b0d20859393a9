//! Halved steps: the results do not hang on the step.

use idc_cell::metrics::Summary;
use idc_cell::recording::{Recording, schema};
use idc_cell::rig::Rig;
use idc_cell::scenario::bench::{CommandScenario, HandScenario};
use idc_cell::scenario::{BenchScenario, load_bench};

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
