//! The packed crate (`cargo package`): what it is built from and what the README's first command reads is in it, and what is not needed for that is not.

use std::collections::BTreeSet;
use std::path::{Component, Path, PathBuf};
use std::process::Command;

use crate::common::{project, skipped};
use crate::documents::commands;
use crate::help::shell;

/// Files that the crate would have, as cargo lists them; those that cargo makes itself are left out.
fn packed() -> Option<BTreeSet<String>> {
    let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let output = Command::new(cargo)
        .args(["package", "--list", "--allow-dirty", "--offline"])
        .current_dir(project(""))
        .output();
    let Ok(output) = output else {
        skipped("there is no `cargo`");
        return None;
    };
    let words = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(output.status.success(), "{words}");
    let list = String::from_utf8(output.stdout).unwrap();
    let made = [".cargo_vcs_info.json", "Cargo.toml.orig"];
    let kept = list.lines().filter(|line| !made.contains(line));
    Some(kept.map(str::to_owned).collect())
}

/// Paths that a source takes in as it is compiled, from the project's folder; a `*` stands for a name that a macro fills in.
fn taken_in(source: &str, text: &str) -> Vec<String> {
    let mut found = Vec::new();
    for word in ["include_str!(", "include_bytes!("] {
        for (at, _) in text.match_indices(word) {
            let rest = &text[at + word.len()..];
            let (arguments, _) = rest.split_once(';').unwrap_or((rest, ""));
            let arguments = arguments.trim_start();
            let path = match arguments.strip_prefix("concat!(") {
                Some(parts) => {
                    let (parts, _) = parts.split_once(')').unwrap();
                    let parts = parts.split(',').map(str::trim);
                    let part = |part: &str| match part.strip_prefix('"') {
                        Some(part) => part.trim_end_matches('"').to_owned(),
                        None => "*".to_owned(),
                    };
                    parts.map(part).collect::<String>()
                }
                None => {
                    let path = arguments.strip_prefix('"');
                    let path = path.unwrap_or_else(|| panic!("{source}: {word}{arguments}"));
                    path.split_once('"').unwrap().0.to_owned()
                }
            };
            let whole = Path::new(source).parent().unwrap().join(path);
            found.push(plain(&whole));
        }
    }
    found
}

/// A path without `..`.
fn plain(path: &Path) -> String {
    let mut parts = PathBuf::new();
    for part in path.components() {
        match part {
            Component::ParentDir => assert!(parts.pop(), "{}", path.display()),
            part => parts.push(part),
        }
    }
    parts.into_os_string().into_string().unwrap()
}

#[test]
fn what_the_program_is_built_from_is_packed() {
    let Some(packed) = packed() else { return };
    // build.rs names the program by all files of `src` and by Cargo.lock: without one of them it would be another program.
    let mut needed = vec!["Cargo.lock".to_owned(), "build.rs".to_owned()];
    let mut folders = vec!["src".to_owned()];
    let mut included = 0;
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(project(&folder)).unwrap() {
            let path = entry.unwrap().path();
            let name = path.file_name().unwrap().to_str().unwrap();
            let name = format!("{folder}/{name}");
            if path.is_dir() {
                folders.push(name);
                continue;
            }
            if path.extension().is_some_and(|ending| ending == "rs") {
                let text = std::fs::read_to_string(&path).unwrap();
                let paths = taken_in(&name, &text);
                included += paths.len();
                needed.extend(paths);
            }
            needed.push(name);
        }
    }
    assert!(included > 60, "only {included} files that are taken in");
    let is_packed = |name: &String| match name.split_once('*') {
        None => packed.contains(name),
        // All that such a path can mean.
        Some((before, after)) => {
            let folder = Path::new(before);
            let entries = std::fs::read_dir(project(before)).unwrap();
            let names = entries.map(|entry| folder.join(entry.unwrap().file_name()));
            let mut names = names.filter(|name| name.to_str().unwrap().ends_with(after));
            names.all(|name| packed.contains(name.to_str().unwrap()))
        }
    };
    let absent: Vec<_> = needed.iter().filter(|name| !is_packed(name)).collect();
    assert_eq!(absent, Vec::<&String>::new());
}

#[test]
fn the_first_command_of_the_readme_runs_from_what_is_packed() {
    let Some(packed) = packed() else { return };
    let folder = tempfile::tempdir().unwrap();
    for name in packed.iter().filter(|name| !name.starts_with("src/")) {
        let copy = folder.path().join(name);
        std::fs::create_dir_all(copy.parent().unwrap()).unwrap();
        std::fs::copy(project(name), copy).unwrap();
    }
    let commands = commands("README.md");
    let line = commands.iter().find(|line| line.starts_with("cargo run "));
    let line = line.unwrap().replace("cargo run --release --", "idc");
    let output = shell(&line, folder.path());
    let words = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(output.status.success(), "{line}\n{words}");
    assert!(
        folder
            .path()
            .join("runs/deburred_edge/report.html")
            .is_file()
    );
}

#[test]
fn what_nobody_builds_with_is_not_packed() {
    let Some(packed) = packed() else { return };
    let folders = [
        "tests/",
        "benches/",
        "docs/",
        "fuzz/",
        ".ci/",
        "assets/proof/",
        "examples/ci/",
    ];
    let idle: Vec<_> = (packed.iter())
        .filter(|name| folders.iter().any(|folder| name.starts_with(folder)))
        .collect();
    assert_eq!(idle, Vec::<&String>::new());
    for name in ["README.md", "LICENSE-MIT", "LICENSE-APACHE", "CITATION.cff"] {
        assert!(packed.contains(name), "{name}");
    }
}

#[test]
fn version_and_day_of_the_citation_are_those_of_the_newest_release() {
    let read = |path: &str| std::fs::read_to_string(project(path)).unwrap();
    let citation = read("CITATION.cff");
    let changes = read("CHANGELOG.md");
    let newest = changes
        .lines()
        .find(|line| line.starts_with("## "))
        .unwrap();
    let value = |key: &str| {
        let line = citation.lines().find_map(|line| line.strip_prefix(key));
        line.unwrap().to_owned()
    };
    let version = value("version: ");
    assert_eq!(version, env!("CARGO_PKG_VERSION"));
    assert_eq!(
        newest,
        format!("## {version} ({})", value("date-released: "))
    );
}
