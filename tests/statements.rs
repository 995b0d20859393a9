//! Every answer at hand holds together: no statement of it contradicts another.

use std::path::{Path, PathBuf};

use idc_cell::diagnosis::answer::Answer;
use idc_cell::diagnosis::answer::statements::contradictions;

use crate::common::{project, shared};
use crate::program::Bench;

/// Folders of answers beside those of the project, separated by colons: `IDC_ANSWERS=runs/a:runs/b`.
const FOLDERS: &str = "IDC_ANSWERS";

/// Holds the statements of an answer to each other.
pub fn hold_together(answer: &Answer) {
    let found = contradictions(answer);
    assert!(found.is_empty(), "{}: {found:#?}", answer.details.case);
}

/// Answers below a folder.
fn below(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in std::fs::read_dir(folder).into_iter().flatten().flatten() {
        let path = entry.path();
        if path.is_dir() {
            below(&path, found);
        } else if path
            .file_name()
            .is_some_and(|name| name == "diagnosis.json")
        {
            found.push(path);
        }
    }
}

/// The project's own, those of `../shared` that are answers, those of folders that are given, and that of a table. Planted cases of other tests are held to
/// the same where they are read.
#[test]
fn every_answer_at_hand_holds_together() {
    let mut files = Vec::new();
    below(&project("assets"), &mut files);
    if let Some(concealed) = shared("concealed") {
        below(&concealed, &mut files);
    }
    let given = std::env::var(FOLDERS).unwrap_or_default();
    let given: Vec<&str> = given.split(':').filter(|f| !f.is_empty()).collect();
    for folder in &given {
        let before = files.len();
        below(Path::new(folder), &mut files);
        assert!(files.len() > before, "{folder} holds no diagnosis.json");
    }
    let bench = Bench::new("plate_edge_ideal");
    for arguments in [
        &["new", "removal_table", "mine/rig.toml", "--quiet"][..],
        &["diagnose", "mine", "--out", "found", "--quiet"],
    ] {
        let outcome = bench.idc(arguments, &[]);
        assert_eq!(outcome.code, 0, "{}", outcome.err);
    }
    files.push(bench.path("found/diagnosis.json"));
    let mut found = Vec::new();
    for file in &files {
        let text = std::fs::read_to_string(file).unwrap();
        let answer: Answer = serde_json::from_str(&text).unwrap();
        let sentences = contradictions(&answer).into_iter();
        found.extend(sentences.map(|sentence| format!("{}: {sentence}", file.display())));
    }
    println!("{} answers", files.len());
    assert!(found.is_empty(), "{found:#?}");
}
