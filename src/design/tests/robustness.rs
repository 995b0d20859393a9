//! Draws at the chosen design, of a model of which the shares are known in closed form.
//!
//! ```text
//! variation = V,   impact = 20 x + y,   x ~ normal(0, 1), y ~ uniform(-1, 1);   it cannot be simulated with a seed above 90 of 1 to 100
//! ```

use std::collections::BTreeMap;

use super::*;
use crate::design::robustness::Distribution;
use crate::design::{Design, EvaluateError, Outcome, ScenarioOutcome};
use crate::report::study_charts;

struct Planted;

impl Evaluate for Planted {
    fn evaluate(&self, design: &Design) -> Result<Outcome, EvaluateError> {
        let drawn = |key: &str| design.get(key).unwrap_or(0.0);
        if drawn("workpiece.burr.seed") > 90.0 {
            return Err(EvaluateError {
                reason: "planted".to_owned(),
                detail: "planted".to_owned(),
            });
        }
        let impact = 20.0 * drawn("workpiece.misplacement.shift_mm") + drawn("contact.runout_um");
        let metrics = [
            ("coefficient_of_variation_percent", drawn("dead_volume_cm3")),
            ("impact_peak_n", impact),
        ];
        let metrics = metrics.map(|(name, value)| (name.to_owned(), value));
        Ok(Outcome {
            force_range: [0.0, 100.0],
            scenarios: vec![ScenarioOutcome {
                name: "planted".to_owned(),
                metrics: BTreeMap::from(metrics),
            }],
        })
    }
}

/// The limit at 1.2 standard deviations and a bit: all of y lies within a twentieth of one.
const TEXT: &str = r#"schema = 1
[study]
title = "planted"
scenarios = ["../plate_edge.toml"]
evaluations = 50
[limits]
force_n = { max = 90 }
impact_peak_n = { max = 24 }
[variables.dead_volume_cm3]
min = 5
max = 60
start = 20
[robustness]
runs = 50
[robustness.variables."workpiece.misplacement.shift_mm"]
mean = 0
standard_deviation = 1
[robustness.variables."contact.runout_um"]
min = -1
max = 1
"#;
/// Share of a normal distribution below 1.2 standard deviations.
const BELOW: f64 = 0.884_930;
const SEED: &str =
    "[robustness.variables.\"workpiece.burr.seed\"]\nmin = 1\nmax = 100\nwhole = true\n";

fn robustness(text: &str) -> crate::design::Robustness {
    search(text, &Planted).unwrap().robustness.unwrap()
}

#[test]
fn the_share_and_the_quantiles_are_those_of_the_planted_distribution() {
    let found = robustness(&TEXT.replace("runs = 50", "runs = 2000"));
    near(found.all_limits.share_percent, 100.0 * BELOW, 0.003);
    assert_eq!(found.limits.len(), 2);
    assert_eq!(found.limits[0].limit, "force_n up to 90 N");
    assert_eq!(found.limits[0].share.kept, 2000);
    assert_eq!(found.limits[1].share, found.all_limits);
    let [low, high] = found.all_limits.interval_percent;
    assert!(low < 100.0 * BELOW && 100.0 * BELOW < high && high - low < 3.5);
    let [variation, impact] = &found.quantiles[..] else {
        panic!("{:?}", found.quantiles);
    };
    assert_eq!(
        [
            variation.percent_5,
            variation.percent_50,
            variation.percent_95
        ],
        [5.0; 3]
    );
    assert!(
        impact.chosen == 0.0 && impact.percent_50.abs() < 0.2,
        "{impact:?}"
    );
    near(impact.percent_5, -20.0 * 1.644_854, 0.02);
    near(impact.percent_95, 20.0 * 1.644_854, 0.02);
}

#[test]
fn the_interval_holds_the_truth_for_nearly_every_seed() {
    let study = read(TEXT).unwrap();
    let chosen = search(TEXT, &Planted).unwrap().chosen;
    let seeds = 400;
    let held = (0..seeds).filter(|seed| {
        let mut scattering = study.scattering.clone().unwrap();
        scattering.seed = *seed;
        let found =
            crate::design::robustness::draw(&study, &scattering, &chosen, &Planted, &|_| ());
        let [low, high] = found.all_limits.interval_percent;
        (low..=high).contains(&(100.0 * BELOW))
    });
    let held = held.count();
    assert!(held as f64 > 0.95 * seeds as f64, "{held} of {seeds}");
}

#[test]
fn what_cannot_be_simulated_keeps_no_limit_and_is_counted() {
    let found = robustness(&(TEXT.replace("runs = 50", "runs = 200") + SEED));
    assert_eq!(found.failed, BTreeMap::from([("planted".to_owned(), 20)]));
    assert_eq!(found.limits[0].share.kept, 180);
    assert!(found.all_limits.kept < 180);
    let failed = found
        .draws
        .iter()
        .filter(|draw| draw.metrics.contains(&None));
    assert!(failed.clone().all(|draw| !draw.kept) && failed.count() == 20);
}

#[test]
fn draws_lie_within_their_bounds_and_whole_ones_are_whole() {
    let edited = TEXT.replace(
        "standard_deviation = 1\n",
        "standard_deviation = 1\nmin = -0.5\n",
    );
    let found = robustness(&(edited + SEED));
    let names: Vec<&str> = found.variables.iter().map(|v| v.key.as_str()).collect();
    assert_eq!(
        names,
        [
            "contact.runout_um",
            "workpiece.burr.seed",
            "workpiece.misplacement.shift_mm"
        ]
    );
    assert!(matches!(
        found.variables[2].distribution,
        Distribution::Normal {
            bounds: [-0.5, _],
            ..
        }
    ));
    for draw in &found.draws {
        assert!((-1.0..=1.0).contains(&draw.values[0]));
        assert!(draw.values[1].fract() == 0.0 && (1.0..=100.0).contains(&draw.values[1]));
        assert!((-0.5..4.0).contains(&draw.values[2]));
    }
    // The same again, another by another seed.
    let again = robustness(
        &(TEXT.replace(
            "standard_deviation = 1\n",
            "standard_deviation = 1\nmin = -0.5\n",
        ) + SEED),
    );
    assert_eq!(found, again);
    let other = robustness(&TEXT.replace("runs = 50", "runs = 50\nseed = 2"));
    assert_ne!(other.draws, robustness(TEXT).draws);
}

#[test]
fn table_and_picture_tell_the_share_with_its_interval() {
    let study = read(TEXT).unwrap();
    let result = search(TEXT, &Planted).unwrap();
    let table = super::output::shown(&study, &result);
    let share = &result.robustness.as_ref().unwrap().all_limits;
    let [low, high] = share.interval_percent;
    let ends = format!("{low:.0} to {high:.0}");
    let percent = format!("{:.0}", share.share_percent);
    for part in [
        "Robustness",
        "Of 50 draws at the chosen design",
        &ends,
        &percent,
    ] {
        assert!(table.contains(part), "{part} in:\n{table}");
    }
    assert!(table.lines().all(|line| line.chars().count() <= 80));
    let figure = study_charts::robustness(&result).unwrap();
    let svg = crate::figure::svg(&figure).unwrap();
    for part in [
        "keep all limits",
        "impact peak [N]",
        "draws at or below [%]",
        "limit: at most 24 N",
    ] {
        assert!(svg.contains(part), "{part}");
    }
    for panel in &figure.panels {
        // A dot for each draw, beside the line of the chosen design.
        let dots = panel.series[1..].iter().map(|of| of.values.len());
        assert_eq!(dots.sum::<usize>(), 50);
    }
    if let Some(path) = std::env::var_os("ROBUSTNESS_SVG") {
        std::fs::write(path, svg).unwrap();
    }
    let without = TEXT.split("[robustness]").next().unwrap();
    let result = search(without, &Planted).unwrap();
    assert!(result.robustness.is_none());
    assert!(study_charts::robustness(&result).is_none());
}

#[test]
fn bad_tables_are_refused_by_place() {
    let refused = |from: &str, to: &str, words: &str| {
        assert_eq!(TEXT.matches(from).count(), 1, "{from}");
        let message = read(&TEXT.replace(from, to)).unwrap_err().to_string();
        let expected = format!("scenarios/studies/test.toml:{words}");
        assert!(
            message.ends_with(&expected),
            "{message}\nexpected {expected}"
        );
    };
    let shift = "[robustness.variables.\"workpiece.misplacement.shift_mm\"]\nmean = 0\nstandard_deviation = 1\n";
    refused(
        "runs = 50",
        "runs = 5",
        "14:1: `robustness.runs` is 5, expected 10 to 100000",
    );
    refused(
        "mean = 0\n",
        "",
        "15:23: `robustness.variables.workpiece.misplacement.shift_mm.mean` is missing, expected it to be given with standard_deviation",
    );
    refused(
        "min = -1\nmax = 1\n",
        "min = 1\nmax = -1\n",
        "19:1: `robustness.variables.contact.runout_um.min` is 1, expected less than max, -1",
    );
    refused(
        "standard_deviation = 1",
        "standard_deviation = 0",
        "17:1: `robustness.variables.workpiece.misplacement.shift_mm.standard_deviation` is 0, expected more than 0",
    );
    refused(
        shift,
        "[robustness.variables.dead_volume_cm3]\nmin = 1\nmax = 2\n",
        "15:23: `robustness.variables.dead_volume_cm3` cannot stand here: it is a variable of the study; what is drawn is what the study does not choose",
    );
    refused(
        "misplacement.shift_mm",
        "misplacement.shift_m",
        "15:23: unknown key `robustness.variables.workpiece.misplacement.shift_m`; what is drawn is a key of [device.override] or, in quotes, \"table.key\" of a scenario; the key is `shift_mm`, in mm",
    );
}
