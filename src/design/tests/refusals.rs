//! Bad studies are refused by place, value and what was expected.

use super::surrogate::STUDY;
use super::*;

fn refused(from: &str, to: &str, words: &str) {
    assert_eq!(STUDY.matches(from).count(), 1, "{from:?} must stand once");
    let message = match read(&STUDY.replace(from, to)) {
        Ok(study) => panic!("accepted: {study:?}"),
        Err(error) => error.to_string(),
    };
    assert!(!message.contains('\n'), "{message}");
    let expected = format!("scenarios/studies/test.toml:{words}");
    assert!(
        message.ends_with(&expected),
        "{message}\nexpected {expected}"
    );
}

const VOLUME: &str = "[variables.dead_volume_cm3]\nmin = 5\nmax = 60\nstart = 20";
const BORE: &str = "[variables.bore_mm]\nmin = 20\nmax = 63\nstart = 50";

#[test]
fn variables() {
    let volume = |min: &str, max: &str, start: &str| {
        format!("[variables.dead_volume_cm3]\nmin = {min}\nmax = {max}\nstart = {start}")
    };
    refused(
        VOLUME,
        &VOLUME.replace("dead_volume_cm3", "dead_volume_l"),
        "19:12: unknown key `variables.dead_volume_l`; a variable is a key of [device.override] or, in quotes, \"table.key\" of controller, contact, process, removal or tool; the key is `dead_volume_cm3`, in cm3",
    );
    refused(
        VOLUME,
        &volume("60", "5", "20"),
        "20:1: `variables.dead_volume_cm3.min` is 60, expected less than max, 5",
    );
    refused(
        VOLUME,
        &volume("5", "60", "70"),
        "22:1: `variables.dead_volume_cm3.start` is 70, expected 5 to 60",
    );
    refused(
        VOLUME,
        &volume("-inf", "60", "20"),
        "20:1: `variables.dead_volume_cm3.min` is -inf, expected a finite number",
    );
    refused(
        VOLUME,
        &VOLUME.replace("max = 60\n", ""),
        "19:12: `variables.dead_volume_cm3.max` is missing, expected it to be given, or a catalogue",
    );
    refused(
        VOLUME,
        &(volume("0", "60", "20") + "\nscale = \"log\""),
        "20:1: `variables.dead_volume_cm3.min` is 0, expected more than 0, as the scale is \"log\"",
    );
    refused(
        VOLUME,
        &VOLUME.replace("dead_volume_cm3", "controller.proportional_gain"),
        "19:23: unknown key `variables.controller.proportional_gain`; a name with a dot stands in quotes: [variables.\"controller.proportional_gain\"]",
    );
}

#[test]
fn catalogues() {
    refused(
        BORE,
        &BORE.replace("min = 20\nmax = 63", "min = 51\nmax = 62"),
        "16:1: `variables.bore_mm.min` is 51, expected one of 8, 10, 12, 16, 20, 25, 32, 40, 50, 63, 80, 100 within min and max",
    );
    refused(
        BORE,
        "[variables.bore_mm]\ncatalogue = []\nstart = 50",
        "16:1: `variables.bore_mm.catalogue` is [], expected at least one entry",
    );
    refused(
        BORE,
        &BORE.replace("start = 50", "start = 45"),
        "18:1: `variables.bore_mm.start` is 45, expected one of 20, 25, 32, 40, 50, 63",
    );
    refused(
        BORE,
        "[variables.bore_mm]\ncatalogue = [25, 30]\nstart = 25",
        "15:12: `variables.bore_mm.rod_mm` is missing, expected the rod of each bore, as 30 mm is no bore of ISO 6432 or 15552",
    );
    refused(
        BORE,
        "[variables.bore_mm]\ncatalogue = [25, 30]\nrod_mm = [10, 40]\nstart = 25",
        "17:1: `variables.bore_mm.rod_mm` is [10.0, 40.0], expected 2 numbers, the rod of each bore in the catalogue and less than it",
    );
}

#[test]
fn study_objective_and_limits() {
    refused(
        "scenarios = [\"../plate_edge.toml\", \"../misplaced_part.toml\"]",
        "scenarios = []",
        "4:1: `study.scenarios` is [], expected at least one scenario file",
    );
    refused(
        "evaluations = 1200",
        "evaluations = 50",
        "6:1: `study.evaluations` is 50, expected 200 to 1000000",
    );
    refused(
        "evaluations = 1200",
        "evaluation = 1200",
        "6:1: unknown key `study.evaluation`; did you mean `evaluations`?",
    );
    refused(
        "trade_off = \"impact_peak_n\"",
        "trade_off = \"coefficient_of_variation_percent\"",
        "9:1: `objective.trade_off` is \"coefficient_of_variation_percent\", expected another quantity than the one that is minimised",
    );
    refused(
        "trade_off = \"impact_peak_n\"\n",
        "",
        "9:1: `objective.trade_off_over` cannot stand here: there is no `trade_off` that it belongs to",
    );
    refused(
        "impact_peak_n = { max = 200 }",
        "impact_peak_n = { }",
        "13:1: `limits.impact_peak_n.min` is missing, expected min or max, or both",
    );
    refused(
        "force_n = { min = 10, max = 1000 }",
        "force_n = { min = 10, max = 1 }",
        "12:13: `limits.force_n.min` is 10, expected at most max, 1",
    );
    refused(
        "trade_off_over = \"worst\"",
        "trade_off_over = \"best\"",
        "10:18: `objective.trade_off_over` is \"best\", expected one of `mean`, `worst`",
    );
}

#[test]
fn a_scenario_that_is_not_there_or_is_given_twice() {
    for (name, words) in [
        (
            "../no_such.toml",
            "4:36: `study.scenarios[1]` is \"../no_such.toml\", expected an existing file",
        ),
        (
            "../plate_edge.toml",
            "4:36: `study.scenarios[1]` is \"../plate_edge.toml\", expected each scenario once",
        ),
    ] {
        let message = read(&STUDY.replace("../misplaced_part.toml", name))
            .unwrap_err()
            .to_string();
        assert!(message.contains(words), "{message}");
    }
}

#[test]
fn no_variables() {
    let (text, _) = STUDY.split_once("[variables.bore_mm]").unwrap();
    let message = read(text).unwrap_err().to_string();
    assert!(
        message.ends_with(
            "`variables` is missing, expected at least one table such as [variables.bore_mm]"
        ),
        "{message}"
    );
}

#[test]
fn the_study_shipped_is_a_good_one() {
    let path = file().with_file_name("device_design.toml");
    let study = crate::design::load(&path).unwrap();
    assert!(study.trade_off.is_some() && study.limits.len() > 2 && study.variables.len() > 4);
}
