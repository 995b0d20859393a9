//! README.md and docs/GUIDE.md: every command in a box runs as printed, in order, from a folder that looks like the project's.

use std::path::Path;

use crate::common::project;
use crate::help::{place, shell};

/// Lines of the README at most: what it is, what it can do, where to go on.
const README_LINES: usize = 120;

/// Commands of the boxes of a page, in order; a line that ends with a backslash goes on.
pub fn commands(page: &str) -> Vec<String> {
    let page = std::fs::read_to_string(project(page)).unwrap();
    let mut commands: Vec<String> = Vec::new();
    let (mut inside, mut open) = (false, false);
    for line in page.lines() {
        match line {
            "```sh" => inside = true,
            "```" => inside = false,
            line if inside && open => *commands.last_mut().unwrap() += &format!("\n{line}"),
            line if inside && !line.starts_with('#') => commands.push(line.to_owned()),
            _ => (),
        }
        open = inside && line.ends_with('\\');
    }
    commands
}

/// Runs commands as printed, but for those that get and test the program: these are in a test already.
fn run(page: &str) -> Vec<String> {
    let folder = place();
    let mut left_out = Vec::new();
    for line in commands(page) {
        let line = line.replace("cargo run --release --", "idc");
        if !line.starts_with("idc ") {
            left_out.push(line);
            continue;
        }
        let output = shell(&line, folder.path());
        assert!(
            output.status.success(),
            "{page}: {line}\n{}{}",
            String::from_utf8_lossy(&output.stdout),
            String::from_utf8_lossy(&output.stderr)
        );
    }
    left_out
}

#[test]
fn every_command_of_the_readme_runs_as_printed() {
    let others = run("README.md");
    let [clone, install, test] = &others[..] else {
        panic!("{others:?}");
    };
    assert!(clone.starts_with("git clone ") && clone.ends_with(" idc-cell && cd idc-cell"));
    assert_eq!(install, "cargo install --path . --locked");
    // These tests are run by it; CI's script says so.
    assert_eq!(test, "cargo test --release");
    let ci = std::fs::read_to_string(project(".ci/run")).unwrap();
    assert!(ci.contains(&format!("    {test} ")));
}

#[test]
fn every_command_of_the_guide_runs_as_printed() {
    assert_eq!(run("docs/GUIDE.md"), Vec::<String>::new());
}

#[test]
fn the_readme_is_short() {
    let readme = std::fs::read_to_string(project("README.md")).unwrap();
    let lines = readme.lines().count();
    assert!(lines <= README_LINES, "{lines} lines");
}

/// Links of the documents to files of the project, as they are written.
#[test]
fn every_link_of_a_document_leads_to_a_file() {
    let mut broken = Vec::new();
    let folders = [
        "",
        "docs/",
        "docs/evidence/",
        "scenarios/",
        "assets/import/",
        "models/arm/",
        "examples/ci/",
    ];
    let pages = folders.into_iter().flat_map(|folder| {
        let entries = std::fs::read_dir(project(folder)).unwrap();
        let names = entries.map(|entry| entry.unwrap().file_name().into_string().unwrap());
        let pages = names.filter(|name| Path::new(name).extension().is_some_and(|end| end == "md"));
        pages.map(move |name| (folder, name)).collect::<Vec<_>>()
    });
    for (folder, name) in pages {
        let text = std::fs::read_to_string(project(&format!("{folder}{name}"))).unwrap();
        for link in text.split("](").skip(1) {
            let Some((link, _)) = link.split_once(')') else {
                continue;
            };
            let (file, anchor) = link.split_once('#').unwrap_or((link, ""));
            if file.contains("://") || file.contains(' ') {
                continue;
            }
            let path = match file {
                "" => format!("{folder}{name}"),
                file => format!("{folder}{file}"),
            };
            if !project(&path).exists() {
                broken.push(format!("{folder}{name}: {link}"));
            } else if !anchor.is_empty() && !has_heading(&path, anchor) {
                broken.push(format!("{folder}{name}: no heading {link}"));
            }
        }
    }
    assert_eq!(broken, Vec::<String>::new());
}

/// Whether a page has a heading of this anchor, as GitHub makes it.
fn has_heading(page: &str, anchor: &str) -> bool {
    let text = std::fs::read_to_string(project(page)).unwrap();
    let slug = |heading: &str| -> String {
        let kept = heading.trim_start_matches('#').trim().to_lowercase();
        let kept = kept.chars().filter_map(|letter| match letter {
            ' ' => Some('-'),
            '-' | '_' => Some(letter),
            letter if letter.is_alphanumeric() => Some(letter),
            _ => None,
        });
        kept.collect()
    };
    text.lines()
        .filter(|line| line.starts_with('#'))
        .any(|line| slug(line) == anchor)
}
