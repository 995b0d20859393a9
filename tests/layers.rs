//! Permitted uses between modules: ARCHITECTURE.md tells them, the sources must keep to them.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use crate::common::project;

/// A row of the modules' table: a module and those it may use.
type Layer = (String, Vec<String>);

/// Cells of the rows below the heading that begins with this word, without their backticks.
fn table(text: &str, heading: &str) -> Vec<Vec<String>> {
    let rows = text
        .lines()
        .skip_while(|line| !line.starts_with(&format!("| {heading} |")));
    let rows = rows.skip(2).take_while(|line| line.starts_with('|'));
    let cells = |line: &str| {
        line.trim_matches('|')
            .split('|')
            .map(|cell| cell.trim().replace('`', ""))
            .collect()
    };
    rows.map(cells).collect()
}

fn list(cell: &str) -> Vec<String> {
    let names = cell.split(',').map(|name| name.trim().to_owned());
    names
        .filter(|name| !name.is_empty() && name != "-")
        .collect()
}

fn architecture() -> String {
    std::fs::read_to_string(project("ARCHITECTURE.md")).unwrap()
}

fn layers() -> Vec<Layer> {
    let rows = table(&architecture(), "module");
    rows.iter()
        .map(|row| {
            (
                row[0]
                    .trim_start_matches("src/")
                    .trim_end_matches('/')
                    .to_owned(),
                list(&row[2]),
            )
        })
        .collect()
}

/// Rust files under a folder, with their text, in order.
fn sources(folder: &Path) -> Vec<(PathBuf, String)> {
    let mut paths: Vec<_> = std::fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .collect();
    paths.sort();
    let mut found = Vec::new();
    for path in paths {
        if path.is_dir() {
            found.extend(sources(&path));
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            let text = std::fs::read_to_string(&path).unwrap();
            found.push((path, text));
        }
    }
    found
}

/// The lines of code: no comments, and no unit tests, which stand at the end of a file.
fn code(text: &str) -> String {
    let product = text
        .split("#[cfg(test)]\nmod tests")
        .next()
        .unwrap_or_default();
    product
        .lines()
        .map(|line| line.split("//").next().unwrap_or_default().to_owned() + "\n")
        .collect()
}

/// Modules of this crate that a text names: after `crate::`, alone or in braces.
fn modules_used(text: &str) -> BTreeSet<String> {
    let mut used = BTreeSet::new();
    for (place, _) in text.match_indices("crate::") {
        let rest = &text[place + "crate::".len()..];
        match rest.strip_prefix('{') {
            None => drop(used.insert(word(rest))),
            Some(group) => {
                let mut depth = 0;
                let mut start = true;
                for (index, letter) in group.char_indices() {
                    match letter {
                        '{' => depth += 1,
                        '}' if depth == 0 => break,
                        '}' => depth -= 1,
                        ',' if depth == 0 => start = true,
                        letter if start && !letter.is_whitespace() => {
                            used.insert(word(&group[index..]));
                            start = false;
                        }
                        _ => (),
                    }
                }
            }
        }
    }
    used
}

/// The identifier that a text begins with.
fn word(text: &str) -> String {
    text.chars()
        .take_while(|letter| letter.is_alphanumeric() || *letter == '_')
        .collect()
}

/// Whether this external crate is named as the head of a path, `name::` or `::name::`, or in a `use` of itself.
fn names_crate(text: &str, name: &str) -> bool {
    text.match_indices(name).any(|(place, _)| {
        let (before, after) = (&text[..place], &text[place + name.len()..]);
        let part = |letter: char| letter.is_alphanumeric() || letter == '_';
        let whole = !before.ends_with(part) && !after.starts_with(part);
        let inner = before
            .strip_suffix("::")
            .is_some_and(|head| head.ends_with(part));
        let used = before.trim_end().ends_with("use") || before.trim_end().ends_with("use ::");
        whole
            && !inner
            && (after.starts_with("::") || (used && after.trim_start().starts_with([';', 'a'])))
    })
}

/// Whether a file climbs out of its module by `super::super::`. `depth` counts its own path in the crate.
fn climbs_out(text: &str, depth: usize) -> bool {
    text.contains(&"super::".repeat(depth))
}

/// Sources of the crate below `src`, by module, but for unit tests in files of their own.
fn product() -> Vec<(String, PathBuf, String)> {
    let src = project("src");
    let mut found = Vec::new();
    for (path, text) in sources(&src) {
        let inside = path.strip_prefix(&src).unwrap().to_owned();
        let is_test = crate::source::is_of_tests(&inside);
        if let (Some(module), true, false) =
            (inside.iter().next(), inside.iter().count() > 1, is_test)
        {
            found.push((module.to_string_lossy().into_owned(), inside, code(&text)));
        }
    }
    assert!(found.len() > 80, "only {} files found", found.len());
    found
}

#[test]
fn modules_use_what_the_table_allows_them_and_all_of_it() {
    let layers = layers();
    let mut unused: BTreeSet<(String, String)> = BTreeSet::new();
    for (module, allowed) in &layers {
        unused.extend(allowed.iter().map(|other| (module.clone(), other.clone())));
    }
    for (module, path, text) in product() {
        let (_, allowed) = layers.iter().find(|(name, _)| *name == module).unwrap();
        for other in modules_used(&text) {
            unused.remove(&(module.clone(), other.clone()));
            assert!(
                other == module || allowed.contains(&other),
                "src/{}: `{module}` uses `{other}`; ARCHITECTURE.md allows it {}",
                path.display(),
                allowed.join(", ")
            );
        }
        let depth = path.iter().count() - usize::from(path.ends_with("mod.rs"));
        assert!(
            !climbs_out(&text, depth),
            "src/{} leaves its module by super::",
            path.display()
        );
    }
    assert!(
        unused.is_empty(),
        "allowed in ARCHITECTURE.md, but not used: {unused:?}"
    );
}

#[test]
fn the_table_lists_every_module_and_has_no_cycle() {
    let layers = layers();
    let library = std::fs::read_to_string(project("src/lib.rs")).unwrap();
    let declared: BTreeSet<String> = library
        .lines()
        .filter_map(|line| line.strip_prefix("pub mod "))
        .map(word)
        .collect();
    let listed: BTreeSet<String> = layers.iter().map(|(module, _)| module.clone()).collect();
    assert_eq!(declared, listed);
    for (row, (module, allowed)) in layers.iter().enumerate() {
        for other in allowed {
            let before = layers[..row].iter().any(|(name, _)| name == other);
            assert!(
                before,
                "`{module}` may use `{other}`, which must stand in a row above it"
            );
        }
    }
}

#[test]
fn external_crates_stay_behind_their_doors() {
    let rows = table(&architecture(), "crate");
    let manifest = std::fs::read_to_string(project("Cargo.toml")).unwrap();
    let program = (
        PathBuf::from("main.rs"),
        code(&std::fs::read_to_string(project("src/main.rs")).unwrap()),
    );
    assert!(rows.len() >= 8, "{rows:?}");
    for row in &rows {
        for name in list(&row[0]) {
            let package = name.replace('_', "-");
            assert!(
                [&package, &name]
                    .iter()
                    .any(|it| manifest.contains(&format!("\n{it} = "))),
                "{package} is no dependency"
            );
            let doors = list(&row[1]);
            let mut seen = BTreeSet::new();
            for (path, text) in product()
                .into_iter()
                .map(|(_, path, text)| (path, text))
                .chain([program.clone()])
            {
                let inside = format!("src/{}", path.display());
                if names_crate(&text, &name) {
                    let door = doors.iter().find(|door| inside.starts_with(door.as_str()));
                    seen.insert(door.unwrap_or_else(|| {
                        panic!("{inside} names `{name}`; it may stand in {doors:?}")
                    }));
                }
            }
            assert_eq!(seen.len(), doors.len(), "`{name}` is used only in {seen:?}");
        }
    }
}

/// The front page of the library's documentation.
#[test]
fn every_module_of_the_library_is_introduced() {
    let text = std::fs::read_to_string(project("src/lib.rs")).unwrap();
    let modules = text
        .lines()
        .filter_map(|line| line.strip_prefix("pub mod "));
    for module in modules.map(|module| module.trim_end_matches(';')) {
        let introduced = [format!("- [`{module}`]: "), format!("- `{module}`: ")];
        let found = introduced.iter().any(|entry| text.contains(entry.as_str()));
        assert!(found, "src/lib.rs does not introduce `{module}`");
    }
}

#[test]
fn paths_in_the_documents_exist() {
    for document in ["ARCHITECTURE.md", "CONVENTIONS.md", "docs/DIAGNOSIS.md"] {
        let text = std::fs::read_to_string(project(document)).unwrap();
        let is_path = |quote: &&str| {
            !quote.contains([' ', '<', ':'])
                && (quote.contains('/') || quote.contains(".md") || quote.contains(".toml"))
        };
        // What lies beside the project does not come with it.
        let of_project = |path: &&str| is_path(path) && !path.starts_with("../");
        // In a table by rooms paths without a folder lie in the room, which the first cell names, or that of a row above.
        let (mut room, mut count) = ("", 0);
        for line in text.lines() {
            let quoted: Vec<&str> = line.split('`').skip(1).step_by(2).collect();
            room = match line {
                line if line.starts_with("| `src/") => quoted[0],
                line if line.starts_with("| | ") => room,
                _ => "",
            };
            let in_room = |quote: &&str| {
                !room.is_empty() && Path::new(quote).extension().is_some_and(|end| end == "rs")
            };
            for path in quoted.into_iter().filter(|q| of_project(q) || in_room(q)) {
                let exists = project(path).exists() || project(room).join(path).exists();
                assert!(exists, "{document} names {path}, which does not exist");
                count += 1;
            }
        }
        assert!(count > 0, "{document}");
    }
}

#[test]
fn the_checkers_see_what_they_look_for() {
    let used = |text: &str| modules_used(&code(text)).into_iter().collect::<Vec<_>>();
    assert_eq!(used("use crate::app::Cli;"), ["app"]);
    assert_eq!(
        used("use crate::{arm::{chain, urdf}, path::Plan, cell};"),
        ["arm", "cell", "path"]
    );
    assert_eq!(used("let x = crate::metrics::FOLLOW_PHASE;"), ["metrics"]);
    assert!(used("// crate::app\n/// [`crate::app`]\n").is_empty());
    assert!(used("fn f() {}\n#[cfg(test)]\nmod tests {\n use crate::app;\n}").is_empty());

    for (text, expected) in [
        ("use rerun::Scalars;", true),
        ("use ::rerun::Scalars;", true),
        ("use rerun as r;", true),
        ("use crate::viewer::write_rrd;", false),
        ("let rerun = 1;", false),
        ("use rerun_sdk::X;", false),
    ] {
        assert_eq!(names_crate(text, "rerun"), expected, "{text}");
    }

    assert!(climbs_out("use super::super::app;", 2));
    assert!(!climbs_out("use super::app;", 2));
    assert!(climbs_out("use super::app;", 1));

    let rows = table(
        "| module | x |\n| --- | --- |\n| `a` | b, c |\n\n| d | e |",
        "module",
    );
    assert_eq!(rows, [["a", "b, c"]]);
}

#[test]
fn files_are_opened_for_reading_by_one_module() {
    for (file, tokens) in crate::source::sources() {
        // A folder is locked by opening it; tests read what they wrote.
        if file.starts_with("file/")
            || crate::source::is_of_tests(Path::new(&file))
            || ["recording/atomic.rs", "recording/claim.rs"].contains(&file.as_str())
        {
            continue;
        }
        for four in tokens.windows(4) {
            let words: Vec<&str> = four.iter().map(|token| token.text.as_str()).collect();
            let opens = match words[..] {
                ["fs", "::", what, "("] => ["read", "read_to_string"].contains(&what),
                ["File", "::", what, "("] => ["open", "options"].contains(&what),
                [_, _, what, "("] => what == "from_path",
                _ => false,
            };
            assert!(
                !opens,
                "src/{file}:{}: `{}`, expected a function of `src/file/`, which neither waits for a pipe nor reads without end",
                four[0].line,
                words.concat()
            );
        }
    }
}
