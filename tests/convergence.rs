//! Halved steps: the results do not hang on the step.

use idc_cell::metrics::Summary;

use crate::common::{run, scenario};

fn summaries(name: &str) -> [Summary; 2] {
    let coarse = scenario(name);
    let mut fine = coarse.clone();
    fine.simulation.step *= 0.5;
    // The pneumatic sub-step is a share of the step, so it is halved with it.
    [run(coarse).summary, run(fine).summary]
}

#[test]
fn halving_both_steps_moves_nothing_that_matters() {
    for name in ["plate_edge", "misplaced_part", "burred_edge"] {
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
