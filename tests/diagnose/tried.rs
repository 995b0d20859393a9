//! A law that a user tries with `--try`: held against the tool's own answer, whichever of them is right.

use super::unlisted::{ONE_WAY, predicts_the_same};
use super::{diagnose, json, names};
use crate::diagnose::planted::{Dirt, OFFSET, case};
use crate::program::Bench;

/// A line on one line of words, as terminals wrap it.
fn words(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

#[test]
fn a_right_guess_is_the_answer_and_a_wrong_one_gets_its_odds() {
    let bench = Bench::new("plate_edge_ideal");
    case(&bench, "case", ONE_WAY, Dirt::None);
    let law = "piston_force: -c * max(v, 0); c = 100..1000 N s/m";
    let outcome = diagnose(&bench, &["case", "--try", law, "--out", "out"]);
    assert_eq!(outcome.code, 0, "{}", outcome.err);
    let answer = json(&bench.path("out/diagnosis.json"));
    assert_eq!(names(&answer), ["tried"]);
    let tried = &answer["tried"];
    assert_eq!(tried["is_answer"], true);
    assert_eq!(tried["formula"], "piston_force = -c * max(v, 0)");
    let c = &tried["parameters"]["c"];
    let [low, high] = ["low", "high"].map(|key| c[key].as_f64().unwrap());
    assert!(low <= 260.0 && 260.0 <= high && high - low < 10.0, "{c}");
    let said = words(&outcome.out);
    assert!(
        said.contains("The law tried piston_force = -c * max(v, 0) is the answer: c = 2"),
        "{said}"
    );
    predicts_the_same(&bench);

    // A spring instead: the answer stays the damper, and the spring's odds are reported.
    let spring = "piston_force: k * x; k = -2000..2000";
    let outcome = diagnose(&bench, &["case", "--try", spring, "--out", "spring"]);
    let answer = json(&bench.path("spring/diagnosis.json"));
    assert_eq!(names(&answer), ["unlisted"]);
    let tried = &answer["tried"];
    assert_eq!(tried["is_answer"], false);
    assert!(tried["log10_odds"].as_f64().unwrap() < -6.0, "{tried}");
    assert!(
        tried["departure"]["p90_sigmas"].as_f64().unwrap() > 2.5,
        "{tried}"
    );
    let said = words(&outcome.out);
    assert!(
        said.contains("piston_force = k * x was fitted alone: k = "),
        "{said}"
    );
    assert!(
        said.contains("Odds against the answer given: below 1 to 10^6"),
        "{said}"
    );
    let improved = std::fs::read_to_string(bench.path("spring/improved.toml")).unwrap();
    assert!(!improved.contains("k * x"), "{improved}");
}

#[test]
fn a_guess_that_is_none_is_refused_with_its_place_and_writes_nothing() {
    let bench = Bench::new("plate_edge_ideal");
    case(&bench, "case", OFFSET, Dirt::None);
    for (law, said) in [
        (
            "piston_force: -c * w; c = 1..2",
            "at `w`, character 6 of the expression: there is no `w` here",
        ),
        (
            "piston_force: c / (x - x); c = 1..2",
            "at `c / (x - x)`, character 1 of the expression: it is not finite in press.csv at 0.0000 s",
        ),
        (
            "surface: c * ln(1 - t / tau); c = 1..2 m; tau = 0.2 s",
            "at `ln(1 - t / tau)`, character 5 of the expression: it is not finite in press.csv at 0.2",
        ),
    ] {
        let refused = diagnose(&bench, &["case", "--try", law, "--out", "out"]);
        assert_eq!(refused.code, 2, "{}", refused.err);
        let line = words(&refused.err);
        assert!(line.contains(said), "{line}");
        assert!(!bench.path("out").exists());
    }
}
