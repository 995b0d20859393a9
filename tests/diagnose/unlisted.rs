//! Physics that no known effect explains: answered so, drawn, written into the improved rig file, and predicted.

use serde_json::Value;

use super::{diagnose, json, names};
use crate::diagnose::planted::{Dirt, case};
use crate::program::Bench;

/// Something that the slide catches on at one place of its stroke.
const SNAG: &str = "
[latent]
port = \"piston_force\"
variable = \"stroke_m\"
directed = false
from_m = 0.017
to_m = 0.025
value_n = [0.0, -4.0, -14.0, -30.0, -14.0, -4.0, 0.0]
";

/// Plants a term and diagnoses it; the answer must be that it has no name.
fn unlisted(term: &str) -> (Bench, Value) {
    let bench = Bench::new("plate_edge_ideal");
    case(&bench, "case", term, Dirt::None);
    let outcome = diagnose(&bench, &["case", "--out", "out"]);
    assert_eq!(outcome.code, 0, "{}", outcome.err);
    let answer = json(&bench.path("out/diagnosis.json"));
    assert_eq!(names(&answer), ["unlisted"], "{answer:#}");
    (bench, answer)
}

/// The improved rig file predicts what the diagnosis predicted.
pub(super) fn predicts_the_same(bench: &Bench) {
    let arguments = [
        "predict",
        "out/improved.toml",
        "case/predict.csv",
        "--out",
        "again.csv",
    ];
    let predicted = bench.idc(&arguments, &[]);
    assert_eq!(predicted.code, 0, "{}", predicted.err);
    let text = |file: &str| std::fs::read_to_string(bench.path(file)).unwrap();
    assert!(text("again.csv") == text("out/prediction.csv"));
}

#[test]
fn a_planted_snag_is_answered_as_unlisted_with_its_shape() {
    let (bench, answer) = unlisted(SNAG);
    assert_eq!(answer["verdict"], "unlisted");
    let found = &answer["effects"][0];
    assert_eq!(found["subsystem"], "force_balance");
    assert_eq!(found["depends_on"][0], "stroke_m");
    assert_eq!(found["port"], "piston_force");
    assert_eq!(found["form"], "localised");
    assert!(found["share_explained"].as_f64().unwrap() > 0.95);
    let said = found["nearest"]["resembles"].as_str().unwrap();
    assert!(said.contains("sticking spot"), "{said}");

    // The shape is that which was planted: 95 % of its knots within their intervals, a third more for the knots that are not those planted.
    let planted = |at: f64| {
        let value = [0.0, -4.0, -14.0, -30.0, -14.0, -4.0, 0.0];
        let place = ((at - 0.017) / 0.008 * 6.0).clamp(0.0, 6.0);
        let left = (place as usize).min(5);
        value[left] + (value[left + 1] - value[left]) * (place - left as f64)
    };
    let shape = found["shape"].as_array().unwrap();
    let inside = shape.iter().filter(|row| {
        let [at, value, half] = ["at", "value", "half_width"].map(|k| row[k].as_f64().unwrap());
        (value - planted(at)).abs() < half + 1.5
    });
    let inside = inside.count();
    assert!(
        10 * inside >= 8 * shape.len(),
        "{inside} of {}: {found:#}",
        shape.len()
    );

    let account = std::fs::read_to_string(bench.path("out/account.txt")).unwrap();
    let words = account.split_whitespace().collect::<Vec<_>>().join(" ");
    for said in [
        "Missing: physics that no known effect explains",
        "a force on the piston that depends on the stroke",
        "drawn in unlisted.svg",
    ] {
        assert!(words.contains(said), "no {said:?} in\n{account}");
    }
    let picture = std::fs::read_to_string(bench.path("out/unlisted.svg")).unwrap();
    assert!(picture.contains("needed by the recordings") && picture.contains("<polygon"));

    // The improved rig file holds the term, and predicts what was predicted.
    predicts_the_same(&bench);
    let text = |file: &str| std::fs::read_to_string(bench.path(file)).unwrap();
    let improved = text("out/improved.toml");
    let curve = improved.contains("\n[latent]\nport = \"piston_force\"\n");
    let formula = improved.contains("name = \"unlisted\"\nacts_on = \"piston_force\"\n");
    assert!(curve != formula, "{improved}");

    // What holds a curve is no rig file to diagnose from.
    let rig = format!("{}{SNAG}", text("case/rig.toml"));
    bench.write("case/rig.toml", rig);
    let refused = diagnose(&bench, &["case", "--out", "other"]);
    let line = refused.only_line("error: ");
    assert_eq!(refused.code, 2);
    assert!(line.contains("rig.toml holds [latent]"), "{line}");
}

/// A damper that acts on the way out alone.
pub(super) const ONE_WAY: &str = "
[[effect]]
name = \"one_way\"
acts_on = \"piston_force\"
is = \"-c * max(v, 0)\"
c = 260
";

#[test]
fn a_planted_law_is_answered_as_a_formula_that_runs() {
    let (bench, answer) = unlisted(ONE_WAY);
    let found = &answer["effects"][0];
    assert_eq!(found["subsystem"], "force_balance");
    assert_eq!(found["depends_on"][0], "velocity");
    // Its form, or that with a threshold of next to nothing.
    let is = found["law"]["is"].as_str().unwrap();
    let threshold = &found["parameters"]["threshold"]["value"];
    assert!(is.starts_with("gain * max(v"), "{is}");
    assert!(
        threshold.as_f64().unwrap_or_default().abs() < 5e-3,
        "{threshold}"
    );
    assert_eq!(found["law"]["units"]["gain"], "N s/m");
    let gain = &found["parameters"]["gain"];
    let [value, low, high] = ["value", "low", "high"].map(|key| gain[key].as_f64().unwrap());
    assert!(low <= -260.0 && -260.0 <= high, "{gain}");
    assert!((value + 260.0).abs() < 3.0, "{gain}");

    let text = |file: &str| std::fs::read_to_string(bench.path(file)).unwrap();
    let improved = text("out/improved.toml");
    assert!(improved.contains(&format!("is = \"{is}\"\n")), "{improved}");
    predicts_the_same(&bench);
    let account = text("out/account.txt");
    let words = account.split_whitespace().collect::<Vec<_>>().join(" ");
    let said = format!("As a formula, in SI: piston_force = {is}, with gain = -2");
    assert!(words.contains(&said), "no {said:?} in\n{account}");
}

/// An outlet that gives way in proportion to the air that is drawn.
const DROOP: &str = "
[latent]
port = \"outlet_pressure\"
variable = \"mass_flow\"
directed = false
from_kg_per_s = -0.003
to_kg_per_s = 0.003
value_pa = [15000.0, 10000.0, 5000.0, 0.0, -5000.0, -10000.0, -15000.0]
";

#[test]
fn a_planted_droop_is_placed_at_the_regulator_over_the_flow() {
    let (_bench, answer) = unlisted(DROOP);
    let found = &answer["effects"][0];
    assert_eq!(found["subsystem"], "regulator");
    assert_eq!(found["depends_on"][0], "mass_flow");
}
