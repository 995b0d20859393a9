//! Table, picture and override text.

use super::surrogate::{STUDY, Surrogate};
use super::*;
use crate::design::{StudyDocument, StudyResult, VariedKey};
use crate::document::{Style, text};
use crate::figure::svg;
use crate::recording::provenance::Provenance;
use crate::report::{self, study_charts::front};

/// The study as a terminal shows it.
pub(super) fn shown(study: &Study, result: &StudyResult) -> String {
    let varied = study.variables.iter().map(|variable| VariedKey {
        key: variable.key.clone(),
        min: variable.domain.ends()[0],
        max: variable.domain.ends()[1],
        choices: None,
    });
    let document = StudyDocument {
        study: String::new(),
        scenarios: Vec::new(),
        variables: varied.collect(),
        result: result.clone(),
        assumed: Vec::new(),
        provenance: Provenance::default(),
    };
    // As it is read back.
    let file = serde_json::to_string(&document).unwrap();
    let document: StudyDocument = serde_json::from_str(&file).unwrap();
    let report = report::study(&document);
    text(&report, Style::Plain)
}

#[test]
fn the_table_fits_a_terminal_and_says_what_binds() {
    let study = read(STUDY).unwrap();
    let result = run(&study, &Surrogate, &|_, _| ()).unwrap();
    let table = shown(&study, &result);
    for line in table.lines() {
        assert!(
            line.chars().count() <= 80 && line == line.trim_end(),
            "{line}"
        );
    }
    for part in [
        "at its upper end",
        "impact peak at most 200 N",
        "at 220 N, chosen",
        "-12 %",
        "just kept",
        "rod",
    ] {
        assert!(table.contains(part), "{part} in:\n{table}");
    }
}

// Catches: words cut at the terminal's width, into a file as well.
#[test]
fn what_is_longer_than_a_line_goes_on_below_whole() {
    let study = read(STUDY).unwrap();
    let mut result = run(&study, &Surrogate, &|_, _| ()).unwrap();
    let title = "How stiff \u{fc}ber alles may the spring of the second regulator be before the impact at touch exceeds what a thin edge bears?";
    title.clone_into(&mut result.title);
    let reason = "the tool leaves the workpiece at the third corner of the outline, where the feed is lowered too late for so heavy a slide";
    result.infeasible.insert(reason.to_owned(), 3);
    let limit = "a_metric_of_a_name_that_is_longer_than_its_column_percent at most 0 %";
    if let Some(active) = result.active_limits.first_mut() {
        limit.clone_into(&mut active.limit);
    }
    let table = shown(&study, &result);
    let words: Vec<&str> = table.split_whitespace().collect();
    for text in [
        title,
        reason,
        &limit.replace('_', " ").replace(" percent", ""),
    ] {
        let cut = text.split(' ').find(|word| !words.contains(word));
        assert!(cut.is_none(), "{cut:?} of {text} in:\n{table}");
    }
    assert!(
        table.lines().all(|line| line.chars().count() <= 80),
        "{table}"
    );
}

#[test]
fn the_override_holds_the_chosen_design() {
    let result = search(STUDY, &Surrogate).unwrap();
    let table: toml::Table = result.override_text().parse().unwrap();
    let device = &table["device"]["override"];
    assert_eq!(device["bore_mm"].as_integer(), Some(40));
    let volume = device["dead_volume_cm3"].as_float();
    assert_eq!(volume, result.chosen.design.get("dead_volume_cm3"));
}

#[test]
fn the_picture_names_its_axes_and_marks_both_designs() {
    let result = search(STUDY, &Surrogate).unwrap();
    let svg = svg(&front(&result).unwrap()).unwrap();
    for part in [
        "impact peak [N], worst of 2 scenarios",
        "coefficient of variation [%], mean of 2 scenarios",
        "chosen: ",
        "start: ",
        "limit: at most 200 N",
    ] {
        assert!(svg.contains(part), "{part}");
    }
    // For a look at it: DESIGN_SVG=front.svg cargo test.
    if let Some(path) = std::env::var_os("DESIGN_SVG") {
        std::fs::write(path, svg).unwrap();
    }
}

#[test]
fn progress_ends_within_the_budget() {
    let most = std::sync::Mutex::new((0, 0));
    let study = read(STUDY).unwrap();
    let result = run(&study, &Surrogate, &|done, budget| {
        let mut most = most.lock().unwrap();
        *most = (most.0.max(done), budget);
    })
    .unwrap();
    let (done, budget) = *most.lock().unwrap();
    assert_eq!(budget, 1200);
    // What a part of the search leaves of its stretch of the budget is passed over, so that it ends where the time left does.
    assert!(done <= budget && result.evaluations <= budget);
    assert!(done > 9 * budget / 10, "{done} of {budget}");
}
