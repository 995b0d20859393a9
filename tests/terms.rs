//! Names and texts use the field's standard terms: words that were the house's own stay out of texts, identifiers and file names.

use std::collections::BTreeSet;
use std::path::Path;

use crate::common::project;
use crate::source::tokens;

/// Words and phrases that no text holds; where a standard term stands for one, it is named.
const PHRASES: [(&str, &str); 18] = [
    ("told", "message, command, reported, distinguished"),
    ("untold", "not reported"),
    ("believed", "nominal"),
    ("believe", "nominal"),
    ("believes", "nominal"),
    ("heard", "observer"),
    ("yardstick", "reference noise"),
    ("yardsticks", "reference noise"),
    ("telling joint", "most observable joint"),
    ("spoken", "display name"),
    ("moves nowhere", "does not move"),
    ("tells nothing", "carries no information"),
    ("what stands about", "obstacles"),
    ("what says when", "explained variance by variable"),
    (
        "tell explanations apart",
        "no further recording is needed to ..",
    ),
    ("term without a name", "model discrepancy"),
    ("terms without a name", "model discrepancies"),
    ("physics without a name", "model discrepancy"),
];

/// Parts of identifiers, modules and file names, each in a folder; a `_` divides parts that follow one another.
const PARTS: [(&str, &str, &str); 22] = [
    ("", "told", "message, command, reported"),
    ("", "untold", "not reported"),
    ("", "believed", "nominal"),
    ("", "heard", "observe"),
    ("", "hear", "observe"),
    ("", "yardstick", "reference noise"),
    ("", "telling", "most observable, informative"),
    ("", "spoken", "display name"),
    ("", "put_in", "apply"),
    ("", "put_into", "apply to"),
    ("", "standing", "overwrite policy, existing"),
    ("", "ended", "outcome"),
    ("", "manner", "run options"),
    ("", "growing", "streaming"),
    ("", "carrier", "piston load, constant load"),
    ("", "pace", "feed override"),
    ("src/simulation/", "behind", "feed lag"),
    ("", "judged", "assumed value"),
    ("src/keys/", "place", "location"),
    ("", "most_of", "robust range"),
    ("", "stands", "exists"),
    ("", "without_a_name", "model discrepancy"),
];

/// Roots that are read. The past in CHANGELOG.md is left alone, and so are the records of docs/evidence, which are as they were made.
const ROOTS: [&str; 18] = [
    "src",
    "tests",
    "benches",
    "assets",
    "scenarios",
    "models",
    "examples",
    "docs",
    ".ci",
    ".config",
    "README.md",
    "ARCHITECTURE.md",
    "CONTRIBUTING.md",
    "CONVENTIONS.md",
    "Cargo.toml",
    "build.rs",
    "clippy.toml",
    "rustfmt.toml",
];

/// Not read: records, results of an older version, what others wrote, and this test's own lists.
const LEFT_OUT: [&str; 4] = [
    "docs/evidence",
    "tests/results_0_1_0",
    "tests/terms.rs",
    "node_modules",
];

/// Keys and columns that files hold and others read: a part of a path, and the text.
const KEYS: [(&str, &str); 19] = [
    ("assets/new/removal_table.toml", "[believed]"),
    ("assets/schemas/removal_table.json", "\"believed\""),
    ("docs/GLOSSARY.md", "`believed`"),
    ("src/report/diagnosis_tables.rs", "\"believed\""),
    ("docs/notebook/analyse.ipynb", "\\\"believed\\\""),
    ("docs/notebook/analyse.ipynb", "<th>believed</th>"),
    ("docs/notebook/analyse.ipynb", "channel     believed"),
    ("scenarios/README.md", "[believed]"),
    ("tests/inert.rs", "[believed]"),
    ("src/app/diagnose/comparison_files.rs", "\"believed\""),
    ("src/case/error.rs", "`believed.reference_volume_mm3`"),
    ("src/case/removal_table.rs", "[believed]"),
    ("src/diagnosis/answer/details.rs", "rename = \"believed\""),
    ("src/scenario/removal_table.rs", "= \"believed\""),
    ("src/scenario/removal_table.rs", "`[believed]`"),
    ("src/scenario/removal_table.rs", "document, \"believed\""),
    ("tests/recomputed/diagnosis.py", "\"believed\""),
    ("tests/removal_table.rs", "[believed]"),
    ("tests/studies/own_cells.py", "\"believed\""),
];

/// Files below a path, by their path in the project.
fn files(path: &str, found: &mut Vec<String>) {
    let whole = project(path);
    let mut left_out = LEFT_OUT.iter();
    if left_out.any(|out| path.ends_with(out)) || !whole.exists() {
        return;
    }
    if whole.is_file() {
        found.push(path.to_owned());
        return;
    }
    let entries = std::fs::read_dir(&whole).unwrap();
    let mut names: Vec<String> = entries
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    names.sort();
    for name in names {
        files(&format!("{path}/{name}"), found);
    }
}

fn is_word(letter: char) -> bool {
    letter.is_alphanumeric() || letter == '_'
}

/// Whether a text in small letters holds a phrase as words.
fn holds(text: &str, phrase: &str) -> bool {
    text.match_indices(phrase).any(|(at, _)| {
        !text[..at].ends_with(is_word) && !text[at + phrase.len()..].starts_with(is_word)
    })
}

/// The words of a text in small letters, those of a comment over several lines in a row.
fn flowing(text: &str) -> String {
    let lines = text.lines().map(|line| {
        line.trim_start_matches([' ', '\t', '/', '!', '#', '*'])
            .trim_end()
    });
    lines.collect::<Vec<_>>().join(" ").to_lowercase()
}

/// Parts of a name in snake case or camel case, in small letters, with `_` between and around them.
fn parts(name: &str) -> String {
    let letters: Vec<char> = name.chars().collect();
    let mut parts = "_".to_owned();
    for (at, letter) in letters.iter().enumerate() {
        let after_small = at > 0 && letters[at - 1].is_lowercase();
        let before_small = letters.get(at + 1).is_some_and(|next| next.is_lowercase());
        if letter.is_uppercase() && (after_small || before_small) && !parts.ends_with('_') {
            parts.push('_');
        }
        parts.extend(letter.to_lowercase());
    }
    parts + "_"
}

/// Parts that a name in a file should not have, with what it should be called.
fn private<'a>(file: &'a str, name: &'a str) -> impl Iterator<Item = String> + 'a {
    let own = parts(name);
    let held = PARTS.iter().filter(move |(folder, part, _)| {
        file.starts_with(folder) && own.contains(&format!("_{part}_"))
    });
    held.map(move |(_, part, term)| format!("{file}: `{name}` has `{part}`: {term}"))
}

/// Phrases that a text should not hold.
fn phrases(file: &str, text: &str) -> Vec<String> {
    let mut text = text.to_owned();
    for (part, key) in KEYS {
        if file.contains(part) {
            text = text.replace(key, "");
        }
    }
    let text = flowing(&text);
    let held = PHRASES.iter().filter(|(phrase, _)| holds(&text, phrase));
    held.map(|(phrase, term)| format!("{file}: `{phrase}`: {term}"))
        .collect()
}

fn all() -> Vec<String> {
    let mut found = Vec::new();
    for root in ROOTS {
        files(root, &mut found);
    }
    assert!(found.len() > 1000, "only {} files found", found.len());
    found
}

// Catches: a private word that comes back in a text, a name or the name of a file.
#[test]
fn texts_and_names_have_standard_terms() {
    let mut faults = BTreeSet::new();
    for file in all() {
        for part in Path::new(&file).iter().map(|part| part.to_str().unwrap()) {
            let name = part.split('.').next().unwrap_or_default();
            faults.extend(private(&file, name));
        }
        let Ok(text) = std::fs::read_to_string(project(&file)) else {
            continue;
        };
        faults.extend(phrases(&file, &text));
        if Path::new(&file).extension().is_some_and(|end| end == "rs") {
            for token in tokens(&text) {
                faults.extend(private(&file, &token.text));
            }
        }
    }
    let faults: Vec<String> = faults.into_iter().collect();
    assert!(
        faults.is_empty(),
        "{} faults\n{}",
        faults.len(),
        faults.join("\n")
    );
}

// Catches: an exception that nothing needs any more.
#[test]
fn each_key_that_keeps_its_name_is_in_use() {
    let files = all();
    for (part, key) in KEYS {
        let own = files.iter().filter(|file| file.contains(part));
        let has = |file: &&String| {
            std::fs::read_to_string(project(file)).is_ok_and(|text| text.contains(key))
        };
        assert!(own.clone().any(|file| has(&file)), "{part}: {key}");
    }
}

#[test]
fn words_are_found_in_names_and_across_lines() {
    assert_eq!(parts("TermWithoutAName"), "_term_without_a_name_");
    assert_eq!(parts("MOST_OF"), "_most_of_");
    assert_eq!(private("src/a.rs", "is_told").count(), 1);
    assert_eq!(private("src/a.rs", "folder_upstands").count(), 0);
    assert_eq!(private("src/a.rs", "behind").count(), 0);
    assert_eq!(phrases("a", "// a term\n    // without a name").len(), 1);
    assert_eq!(phrases("a", "retold believed_rms").len(), 0);
    assert_eq!(phrases("a", "\"Told.\"").len(), 1);
}
