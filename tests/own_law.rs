//! Physics that a user writes as an expression: it does what an effect of the catalogue does that says the same, it is found with its number where it was planted,
//! and nothing of it is found where it was not.

use idc_cell::diagnosis::answer::{Answer, Verdict};
use idc_cell::recording::parquet::read_parquet;

use crate::common::shared;
use crate::diagnose::planted::{Dirt, case_files};
use crate::program::Bench;

/// A damping of extension alone, which no effect of the catalogue is, with a number to be found.
const DAMPING: &str = "
[[effect]]
name = \"one_way_damping\"
acts_on = \"piston_force\"
is = \"-c * max(v, 0)\"
c = { value = 80, min = 0, max = 1000, unit = \"N s/m\" }
";

fn answer(bench: &Bench, folder: &str) -> Answer {
    let outcome = bench.idc(
        &["diagnose", folder, "--out", "out", "--force", "--quiet"],
        &[],
    );
    assert_eq!(outcome.code, 0, "{}", outcome.err);
    let text = std::fs::read_to_string(bench.path("out/diagnosis.json")).unwrap();
    let answer = serde_json::from_str(&text).unwrap();
    crate::statements::hold_together(&answer);
    answer
}

/// Makes the law a candidate of a case.
fn seek(bench: &Bench, folder: &str) {
    let rig = format!("{folder}/rig.toml");
    let text = std::fs::read_to_string(bench.path(&rig)).unwrap();
    bench.write(&rig, text + DAMPING);
}

#[test]
fn a_law_is_found_with_its_number_and_predicts_what_was_kept_back() {
    let bench = Bench::new("plate_edge_ideal");
    std::fs::create_dir(bench.path("case")).unwrap();
    case_files(
        &bench,
        "case",
        &DAMPING.replace("value = 80", "value = 240"),
        Dirt::None,
    );
    seek(&bench, "case");
    let found = answer(&bench, "case");
    let names: Vec<&str> = found.effects.iter().map(|e| e.name.as_str()).collect();
    assert_eq!(names, ["one_way_damping"]);
    let effect = &found.effects[0];
    assert_eq!(effect.subsystem, "force_balance");
    assert_eq!(effect.law.as_ref().unwrap().is, "-c * max(v, 0)");
    let (name, number) = &effect.parameters[0];
    assert_eq!(name, "c");
    assert!((number.value / 240.0 - 1.0).abs() < 0.02, "{number:?}");
    assert!(number.low < 240.0 && 240.0 < number.high, "{number:?}");
    for error in &found.details.prediction {
        assert!(error.after < 1.1 * error.noise.unwrap(), "{error:?}");
    }
    // The file it ends with runs, and has the law with its number.
    let improved = std::fs::read_to_string(bench.path("out/improved.toml")).unwrap();
    assert!(
        improved.contains("is = \"-c * max(v, 0)\"\nc = { value = 2"),
        "{improved}"
    );
    let outcome = bench.idc(&["check", "out/improved.toml"], &[]);
    assert_eq!(outcome.code, 0, "{}", outcome.err);
}

#[test]
fn where_it_was_not_planted_nothing_of_it_is_found() {
    let bench = Bench::new("plate_edge_ideal");
    std::fs::create_dir(bench.path("case")).unwrap();
    case_files(&bench, "case", "", Dirt::None);
    seek(&bench, "case");
    let found = answer(&bench, "case");
    assert_eq!(
        found.verdict,
        Verdict::NothingMissing,
        "{:?}",
        found.effects
    );
    let improved = std::fs::read_to_string(bench.path("out/improved.toml")).unwrap();
    assert!(!improved.contains("[[effect]]"), "{improved}");
}

/// Recordings of devices by others' equations, with physics outside the catalogue and its formula.
#[test]
fn a_law_of_a_foreign_device_is_found_with_its_number() {
    let Some(cases) = shared("concealed/beyond/practice/cases") else {
        return;
    };
    let bench = Bench::new("plate_edge_ideal");
    std::fs::create_dir(bench.path("case")).unwrap();
    for file in std::fs::read_dir(cases.join("case-12")).unwrap() {
        let file = file.unwrap();
        std::fs::copy(file.path(), bench.path("case").join(file.file_name())).unwrap();
    }
    seek(&bench, "case");
    let found = answer(&bench, "case");
    let names: Vec<&str> = found.effects.iter().map(|e| e.name.as_str()).collect();
    assert_eq!(names, ["one_way_damping"]);
    let (_, number) = &found.effects[0].parameters[0];
    assert!((number.value / 266.19 - 1.0).abs() < 0.02, "{number:?}");
}

/// Samples of a run, with an effect put in by name or by law.
fn run(bench: &Bench, file: &str, effect: &str) -> Vec<Vec<f64>> {
    let text = std::fs::read_to_string(bench.path(file)).unwrap();
    bench.write("with.toml", text + effect);
    let arguments = [
        "run",
        "with.toml",
        "--out",
        "out",
        "--force",
        "--quiet",
        "--no-recording",
    ];
    let outcome = bench.idc(&arguments, &[]);
    assert_eq!((outcome.code, outcome.err.as_str()), (0, ""), "{effect}");
    let samples = read_parquet(&bench.path("out/samples.parquet")).unwrap();
    let channels = samples.recording.channels().iter();
    channels.map(|channel| channel.values.clone()).collect()
}

/// Largest difference of all signals, of their largest size.
fn difference(one: &[Vec<f64>], other: &[Vec<f64>]) -> f64 {
    let pairs = one.iter().zip(other);
    let each = pairs.map(|(a, b)| {
        let size = a.iter().fold(1e-9f64, |most, v| most.max(v.abs()));
        let off = a.iter().zip(b).map(|(a, b)| (a - b).abs());
        off.fold(0.0, f64::max) / size
    });
    each.fold(0.0, f64::max)
}

#[test]
fn in_a_running_cell_a_law_does_what_the_effect_does_that_says_the_same() {
    let bench = Bench::new("plate_edge_ideal");
    bench.replace("scenario.toml", "end_mm = 290", "end_mm = 40");
    let text = std::fs::read_to_string(bench.path("scenario.toml")).unwrap();
    bench.write("scenario.toml", text.split("[expect]").next().unwrap());
    let nominal = run(&bench, "scenario.toml", "");
    let law = |port: &str, is: &str| {
        format!("\n[[effect]]\nname = \"mine\"\nacts_on = \"{port}\"\nis = \"{is}\"\n")
    };
    let effect =
        |name: &str, numbers: &str| format!("\n[[effect]]\nname = \"{name}\"\n{numbers}\n");
    for (by_law, by_name, within) in [
        (
            law("piston_force", "-20 - k * x") + "k = 300\n",
            effect("axial_force_offset", "force_n = -20")
                + &effect("return_spring_load", "stiffness_n_per_m = 300"),
            1e-6,
        ),
        (
            law("force_reading", "0.05 * f"),
            effect("force_sensor_gain_error", "gain = 1.05"),
            // The load cell's gain is of the force along the slide, f of all of it.
            0.05,
        ),
        (
            law("stroke_reading", "0.02 * x"),
            effect("stroke_sensor_gain_error", "gain = 1.02"),
            1e-6,
        ),
        (
            law("supply_orifice", "-1.5e-6")
                + &law("exhaust_orifice", "-1.2e-6").replace("mine", "its"),
            effect("supply_restriction", "orifice_area_m2 = 1e-6")
                + &effect("exhaust_restriction", "orifice_area_m2 = 0.8e-6"),
            1e-6,
        ),
        (
            law("contact_stiffness", "-1e5"),
            effect("contact_stiffness_error", "stiffness_n_per_m = 5e4"),
            // Rapier's own constraint, which carries the friction, keeps the stiffness of the file.
            1e-3,
        ),
    ] {
        let [own, listed] = [&by_law, &by_name].map(|effect| run(&bench, "scenario.toml", effect));
        let apart = difference(&own, &listed);
        assert!(apart < within, "{by_law}{apart}");
        assert!(difference(&own, &nominal) > 0.01, "{by_law}");
    }
}
