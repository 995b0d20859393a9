//! A smooth model of a device whose best design is known in closed form.
//!
//! ```text
//! variation = 3 / s + m / 10 + 9 / V + 5 (b / 33 - 1)^2        s supply orifice, m moving mass, V dead volume, b bore
//! peak      = 180 + 4 V - 10 m,      force range = 0 .. 2 pi/4 b^2 6 bar
//! ```
//!
//! The bore wants to be 32 mm but must be 40 mm to give 1000 N. The orifice goes to its bound of 6 mm2. With the peak P on its limit,
//! V = (P - 180 + 10 m) / 4, and d/dm (m / 10 + 9 / V) = 0 gives V = 15, m = (240 - P) / 10.

use std::collections::BTreeMap;

use crate::design::{Design, Evaluate, EvaluateError, Outcome, ScenarioOutcome};

pub struct Surrogate;

pub const STUDY: &str = r#"schema = 1
[study]
title = "planted"
scenarios = ["../plate_edge.toml", "../misplaced_part.toml"]
seed = 3
evaluations = 1200
[objective]
minimise = "coefficient_of_variation_percent"
trade_off = "impact_peak_n"
trade_off_over = "worst"
[limits]
force_n = { min = 10, max = 1000 }
impact_peak_n = { max = 200 }
stroke_margin_mm = { min = 5 }
[variables.bore_mm]
min = 20
max = 63
start = 50
[variables.dead_volume_cm3]
min = 5
max = 60
start = 20
[variables.moving_mass_kg]
min = 1
max = 8
start = 5
[variables.supply_orifice_mm2]
min = 0.5
max = 6
start = 2.5
scale = "log"
"#;

/// Least variation with a 40 mm bore and a 6 mm2 orifice at a peak of at most `peak`.
pub fn least_variation(peak: f64) -> f64 {
    let mass = ((240.0 - peak) / 10.0).clamp(1.0, 8.0);
    let volume = (peak - 180.0 + 10.0 * mass) / 4.0;
    variation(6.0, mass, volume, 40.0)
}

pub fn variation(orifice: f64, mass: f64, volume: f64, bore: f64) -> f64 {
    3.0 / orifice + 0.1 * mass + 9.0 / volume + 5.0 * (bore / 33.0 - 1.0_f64).powi(2)
}

impl Evaluate for Surrogate {
    fn evaluate(&self, design: &Design) -> Result<Outcome, EvaluateError> {
        let [bore, volume, mass, orifice] = [
            "bore_mm",
            "dead_volume_cm3",
            "moving_mass_kg",
            "supply_orifice_mm2",
        ]
        .map(|key| design.get(key).unwrap());
        assert!(design.get("rod_mm").is_some_and(|rod| rod < bore));
        if volume > 55.0 {
            return Err(EvaluateError {
                reason: "tool left the workpiece".into(),
                detail: format!("tool left the workpiece at {volume} cm3"),
            });
        }
        let variation = variation(orifice, mass, volume, bore);
        let peak = 180.0 + 4.0 * volume - 10.0 * mass;
        let scenario = |name: &str, factor: f64, drop: f64| ScenarioOutcome {
            name: name.to_owned(),
            metrics: BTreeMap::from([
                (
                    "coefficient_of_variation_percent".to_owned(),
                    factor * variation,
                ),
                ("impact_peak_n".to_owned(), peak - drop),
                ("stroke_margin_mm".to_owned(), 20.0),
            ]),
        };
        Ok(Outcome {
            force_range: [0.0, std::f64::consts::FRAC_PI_2 * bore * bore * 0.6],
            scenarios: vec![
                scenario("plate_edge", 0.9, 0.0),
                scenario("misplaced_part", 1.1, 30.0),
            ],
        })
    }
}
