//! Fronts against those of test problems, known in closed form.

use super::surrogate::{STUDY, Surrogate, least_variation};
use super::*;
use crate::design::{Design, EvaluateError, Outcome, ScenarioOutcome};

pub fn outcome(metrics: &[(&str, f64)]) -> Outcome {
    let metrics = metrics
        .iter()
        .map(|(name, value)| ((*name).to_owned(), *value));
    Outcome {
        force_range: [0.0, 1.0],
        scenarios: vec![ScenarioOutcome {
            name: "only".into(),
            metrics: metrics.collect(),
        }],
    }
}

/// A test problem of two variables: both objectives, then what is limited.
struct Problem(fn(f64, f64) -> [f64; 4]);

impl Evaluate for Problem {
    fn evaluate(&self, design: &Design) -> Result<Outcome, EvaluateError> {
        let [x, y] = ["dead_volume_cm3", "supply_orifice_mm2"].map(|key| design.get(key).unwrap());
        let [f1, f2, c1, c2] = (self.0)(x, y);
        Ok(outcome(&[("f1", f1), ("f2", f2), ("c1", c1), ("c2", c2)]))
    }
}

fn study(limits: &str, x: [f64; 3], y: [f64; 3], minimise: &str, trade_off: &str) -> String {
    let variable = |key: &str, [min, max, start]: [f64; 3]| {
        format!("[variables.{key}]\nmin = {min}\nmax = {max}\nstart = {start}\n")
    };
    format!(
        "schema = 1\n[study]\ntitle = \"front\"\nscenarios = [\"../plate_edge.toml\"]\nevaluations = 800\n[objective]\nminimise = \"{minimise}\"\ntrade_off = \"{trade_off}\"\nfront_points = 9\n[limits]\n{limits}\n{}{}",
        variable("dead_volume_cm3", x),
        variable("supply_orifice_mm2", y),
    )
}

/// The front has no gap wider than this share of its extent, and each of `levels` + 1 evenly spaced points lies on it within `tolerance` of the extent.
fn follows(result: &StudyResult, ends: [f64; 2], tolerance: f64, curve: impl Fn(f64) -> f64) {
    let points: Vec<[f64; 2]> = result
        .front
        .iter()
        .map(|p| [p.trade_off, p.objective])
        .collect();
    assert!(points.is_sorted_by(|a, b| a[0] < b[0] && a[1] > b[1]));
    let height = (curve(ends[0]) - curve(ends[1])).abs();
    let width = ends[1] - ends[0];
    assert!((points[0][0] - ends[0]).abs() < 0.01 * width, "{points:?}");
    assert!(
        (points[points.len() - 1][0] - ends[1]).abs() < 0.01 * width,
        "{points:?}"
    );
    // At each level the best design at or below it is as good as the curve allows.
    for level in 0..=8 {
        let ceiling = ends[0] + width * f64::from(level) / 8.0;
        let ceiling = ceiling + 4e-3 * width;
        let best = points.iter().rfind(|p| p[0] <= ceiling).unwrap();
        let gap = best[1] - curve(best[0].clamp(ends[0], ends[1]));
        assert!(gap.abs() <= tolerance * height, "{best:?} is {gap} off");
        assert!(
            ceiling - best[0] < 0.02 * width,
            "nothing near {ceiling}: {points:?}"
        );
    }
}

/// T. T. Binh and U. Korn, MOBES: a multiobjective evolution strategy for constrained optimization problems, 1997. The front is x = y up to 3,
/// then y = 3.
#[test]
fn binh_and_korn() {
    let problem = Problem(|x, y| {
        [
            4.0 * (x * x + y * y),
            (x - 5.0).powi(2) + (y - 5.0).powi(2),
            (x - 5.0).powi(2) + y * y,
            (x - 8.0).powi(2) + (y + 3.0).powi(2),
        ]
    });
    let limits = "c1 = { max = 25 }\nc2 = { min = 7.7 }";
    let text = study(limits, [0.0, 5.0, 2.0], [0.0, 3.0, 1.0], "f2", "f1");
    let result = search(&text, &problem).unwrap();
    let curve = |f1: f64| {
        let x = if f1 <= 72.0 {
            (f1 / 8.0).sqrt()
        } else {
            (f1 / 4.0 - 9.0).sqrt()
        };
        (x - 5.0).powi(2) + (x.min(3.0) - 5.0).powi(2)
    };
    follows(&result, [0.0, 136.0], 0.005, curve);
}

/// K. Deb, Multi-objective optimization using evolutionary algorithms, 2001, "CONSTR": a limit makes the first half of the front, f2 = (7 - 9 x) / x
/// up to x = 2/3, and the objective alone the second, f2 = 1 / x.
#[test]
fn a_front_half_of_which_is_an_active_limit() {
    let problem = Problem(|x, y| [x, (1.0 + y) / x, y + 9.0 * x, 9.0 * x - y]);
    let limits = "c1 = { min = 6 }\nc2 = { min = 1 }";
    let text = study(limits, [0.1, 1.0, 0.8], [0.0, 5.0, 2.0], "f2", "f1");
    let result = search(&text, &problem).unwrap();
    let curve = |x: f64| {
        if x <= 2.0 / 3.0 {
            (7.0 - 9.0 * x) / x
        } else {
            1.0 / x
        }
    };
    follows(&result, [7.0 / 18.0, 1.0], 0.01, curve);
}

/// A front that is not convex, where weighted sums would find the ends alone: f2 = 1 - f1^2.
#[test]
fn a_front_that_is_not_convex() {
    let problem = Problem(|x, y| {
        let g = 1.0 + 9.0 * y;
        [x, g * (1.0 - (x / g).powi(2)), 0.0, 0.0]
    });
    let text = study("", [0.0, 1.0, 0.5], [0.0, 1.0, 0.5], "f2", "f1");
    let result = search(&text, &problem).unwrap();
    follows(&result, [0.0, 1.0], 0.01, |x| 1.0 - x * x);
}

#[test]
fn the_surrogates_front_is_the_closed_form() {
    let text = STUDY
        .replace("evaluations = 1200", "evaluations = 2000")
        .replace("trade_off_over", "front_points = 9\ntrade_off_over");
    let result = search(&text, &Surrogate).unwrap();
    follows(&result, [120.0, 200.0], 0.01, least_variation);
}

#[test]
fn a_variable_as_second_objective_gives_a_point_an_entry() {
    let text = STUDY
        .replace(
            "trade_off = \"impact_peak_n\"\ntrade_off_over = \"worst\"",
            "trade_off = \"bore_mm\"",
        )
        .replace("max = 1000", "max = 200");
    let result = search(&text, &Surrogate).unwrap();
    let bores: Vec<f64> = result.front.iter().map(|point| point.trade_off).collect();
    assert_eq!(bores, [20.0, 25.0, 32.0]);
    for point in &result.front {
        let bore = point.trade_off;
        near(
            point.objective,
            super::surrogate::variation(6.0, 4.0, 15.0, bore),
            2e-3,
        );
    }
}
