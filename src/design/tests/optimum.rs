//! The chosen design against the closed form, what binds it, and that it does not depend on the number of threads.

use super::surrogate::{STUDY, Surrogate, least_variation, variation};
use super::*;
use crate::design::{Design, EvaluateError, Outcome};

/// The study without a second objective.
fn single() -> String {
    STUDY
        .replace("trade_off = \"impact_peak_n\"\n", "")
        .replace("trade_off_over = \"worst\"\n", "")
}

#[test]
fn the_planted_optimum_is_found_whatever_the_seed() {
    for seed in [3, 4, 5] {
        let text = single()
            .replace("seed = 3", &format!("seed = {seed}"))
            .replace("evaluations = 1200", "evaluations = 600");
        let result = search(&text, &Surrogate).unwrap();
        let chosen = &result.chosen;
        near(chosen.objective, least_variation(200.0), 5e-4);
        assert_eq!(chosen.design.get("bore_mm"), Some(40.0));
        assert_eq!(chosen.design.get("rod_mm"), Some(16.0));
        near(chosen.design.get("supply_orifice_mm2").unwrap(), 6.0, 1e-3);
        near(chosen.design.get("dead_volume_cm3").unwrap(), 15.0, 0.05);
        near(chosen.design.get("moving_mass_kg").unwrap(), 4.0, 0.08);
        assert!(chosen.feasible && chosen.limits.iter().all(|limit| limit.kept));
        assert!(result.evaluations <= 600, "{}", result.evaluations);
        assert!(result.front.is_empty());
    }
}

#[test]
fn the_smallest_budget_is_kept_as_well() {
    let least = STUDY.replace("evaluations = 1200", "evaluations = 200");
    for text in [
        least.clone(),
        least.replace(
            "trade_off = \"impact_peak_n\"\ntrade_off_over = \"worst\"\n",
            "",
        ),
    ] {
        let result = search(&text, &Surrogate).unwrap();
        assert!(result.evaluations <= 200, "{}", result.evaluations);
        assert!(result.chosen.feasible && result.chosen.objective < result.start.objective);
    }
}

#[test]
fn what_binds_is_named_with_its_price() {
    let result = search(&single(), &Surrogate).unwrap();
    let bounds: Vec<_> = result
        .active_bounds
        .iter()
        .map(|b| (b.variable.as_str(), b.side))
        .collect();
    assert_eq!(bounds, [("supply_orifice_mm2", crate::design::Side::Max)]);
    // A tenth more orifice, alone, and the peak's limit a tenth higher with all chosen anew: both in closed form.
    let best = least_variation(200.0);
    let wider = 100.0 * (variation(6.6, 4.0, 15.0, 40.0) / best - 1.0);
    near(
        result.active_bounds[0].objective_change_percent.unwrap(),
        wider,
        0.01,
    );
    let limits: Vec<_> = result
        .active_limits
        .iter()
        .map(|limit| limit.limit.as_str())
        .collect();
    assert_eq!(limits, ["impact_peak_n at most 200 N"]);
    let looser = 100.0 * (least_variation(220.0) / best - 1.0);
    near(
        result.active_limits[0].objective_change_percent.unwrap(),
        looser,
        0.02,
    );
    let smaller = result
        .sensitivities
        .iter()
        .find(|s| s.variable == "bore_mm" && s.value == 32.0);
    assert_eq!(smaller.unwrap().breaks, ["force_n"]);
    assert_eq!(result.improving_steps(0.1).count(), 0);
}

#[test]
fn candidates_that_fail_are_counted_by_reason() {
    let result = search(&single(), &Surrogate).unwrap();
    assert!(
        result.infeasible["tool left the workpiece"] > 0,
        "{:?}",
        result.infeasible
    );
    assert!(result.infeasible["force_n up to 1000 N"] > 0);
}

#[test]
fn the_same_study_gives_the_same_bytes_on_any_number_of_threads() {
    let on = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .unwrap();
        pool.install(|| {
            let result = search(STUDY, &Surrogate).unwrap();
            let front = crate::report::study_charts::front(&result).unwrap();
            let svg = crate::figure::svg(&front).unwrap();
            (serde_json::to_string(&result).unwrap(), svg)
        })
    };
    let alone = on(1);
    assert_eq!(alone, on(2));
    assert_eq!(alone, on(5));
    let other = search(&STUDY.replace("seed = 3", "seed = 4"), &Surrogate).unwrap();
    assert_ne!(alone.0, serde_json::to_string(&other).unwrap());
}

#[test]
fn a_catalogue_of_two_neighbouring_optima_is_not_left_to_chance() {
    // Two catalogues whose best entries go together: the neighbour's continuous variables must be chosen anew to see that it is better.
    struct Valley;
    impl Evaluate for Valley {
        fn evaluate(&self, design: &Design) -> Result<Outcome, EvaluateError> {
            let [hose, length, volume] = ["hose_diameter_mm", "hose_length_m", "dead_volume_cm3"]
                .map(|k| design.get(k).unwrap());
            let value = 1.0
                + 0.1 * (hose - 6.0).abs()
                + 40.0 * (length - 0.2 * hose).powi(2)
                + (volume - 10.0 * length).powi(2) / 25.0;
            Ok(super::fronts::outcome(&[(
                "coefficient_of_variation_percent",
                value,
            )]))
        }
    }
    let text = r#"schema = 1
[study]
title = "valley"
scenarios = ["../plate_edge.toml"]
evaluations = 400
[variables.hose_diameter_mm]
catalogue = [2.5, 4, 6, 8, 10]
start = 10
[variables.hose_length_m]
min = 0
max = 3
start = 2
[variables.dead_volume_cm3]
min = 1
max = 40
start = 30
"#;
    let result = search(text, &Valley).unwrap();
    assert_eq!(result.chosen.design.get("hose_diameter_mm"), Some(6.0));
    near(result.chosen.objective, 1.0, 1e-4);
    assert!(result.active_bounds.is_empty() && result.active_limits.is_empty());
}

#[test]
fn limits_that_nobody_can_keep_are_refused_with_the_gap() {
    let text = STUDY.replace(
        "stroke_margin_mm = { min = 5 }",
        "stroke_margin_mm = { min = 25 }",
    );
    let message = search(&text, &Surrogate).unwrap_err().to_string();
    assert!(
        message.starts_with("no design within the bounds keeps the limits: the best of "),
        "{message}"
    );
    assert!(
        message.ends_with("violates stroke_margin_mm at least 25 mm by 5 mm, with 20 mm"),
        "{message}"
    );
}

#[test]
fn a_metric_that_no_scenario_gives_and_a_start_that_fails_are_refused() {
    let text = STUDY.replace("stroke_margin_mm", "stroke_margins_mm");
    let message = search(&text, &Surrogate).unwrap_err().to_string();
    assert!(
        message.ends_with(
            "test.toml:14:1: `limits.stroke_margins_mm` names the metric `stroke_margins_mm`, which no scenario gives for the starting design; known here are coefficient_of_variation_percent, impact_peak_n, stroke_margin_mm"
        ),
        "{message}"
    );
    let text = STUDY.replace("start = 20\n", "start = 58\n");
    let message = search(&text, &Surrogate).unwrap_err().to_string();
    assert!(
        message.ends_with(
            "test.toml: the starting design cannot be simulated: tool left the workpiece at 58 cm3"
        ),
        "{message}"
    );
}
