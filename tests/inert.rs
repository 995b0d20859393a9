//! What comes in with names and texts of files is shown, and does nothing: in a terminal, in Markdown, on a page.

use crate::program::{Bench, Outcome};
use crate::source::sources;

/// Writes into a clipboard, clears a screen, turns the order of letters.
const HOSTILE: &str = "\u{1b}]52;c;aGk=\u{7}\u{9b}2J\u{8}\r\u{202e}gnp\u{2066}";

/// As TOML and JSON write it.
fn escaped(text: &str) -> String {
    let letter = |letter: char| match letter.is_ascii_graphic() || letter == ' ' {
        true => letter.to_string(),
        false => format!("\\u{:04x}", u32::from(letter)),
    };
    text.chars().map(letter).collect()
}

/// Nothing that steers a terminal is in what was printed; `expected` is.
fn is_inert(outcome: &Outcome, expected: &str) {
    let all = format!("{}{}", outcome.out, outcome.err);
    let acts = |letter: &char| {
        (letter.is_control() && !['\n', '\t'].contains(letter))
            || ('\u{202a}'..='\u{202e}').contains(letter)
            || ('\u{2066}'..='\u{2069}').contains(letter)
    };
    assert_eq!(all.chars().find(acts), None, "{all:?}");
    assert!(all.contains(expected), "no {expected:?} in {all}");
}

/// The nominal job with a hostile title.
fn titled() -> Bench {
    let bench = Bench::new("plate_edge_ideal");
    let text = std::fs::read_to_string(bench.path("scenario.toml")).unwrap();
    let title = text.lines().find(|line| line.starts_with("title")).unwrap();
    bench.replace(
        "scenario.toml",
        title,
        &format!("title = \"{}\"", escaped(HOSTILE)),
    );
    bench
}

#[test]
fn a_title_does_nothing_to_a_terminal_in_any_command() {
    let bench = titled();
    let shown = "\\u001b]52;c;aGk=";
    let run = ["run", "scenario.toml", "--out", "out", "--force"];
    is_inert(&bench.idc(&run, &[]), shown);
    is_inert(&bench.idc(&["check", "scenario.toml"], &[]), "");
    let coloured = [&run[..], &["--color", "always"]].concat();
    let mut outcome = bench.idc(&coloured, &[]);
    // Colours, and nothing else, are let through.
    assert!(outcome.out.contains("\u{1b}[1m"), "{}", outcome.out);
    for colour in [
        "0", "1", "2", "31", "32", "33", "39", "1;31", "38;5;9", "38;5;10",
    ] {
        for text in [&mut outcome.out, &mut outcome.err] {
            *text = text.replace(&format!("\u{1b}[{colour}m"), "");
        }
    }
    is_inert(&outcome, shown);
    // Programs get the title itself.
    let json = bench.idc(&["check", "scenario.toml", "--json"], &[]);
    is_inert(&json, "");
    let outcome = bench.idc(&[&run[..], &["--json"]].concat(), &[]);
    is_inert(&outcome, shown);
    let summary: serde_json::Value = serde_json::from_str(&outcome.out).unwrap();
    assert_eq!(summary["title"], HOSTILE);
    let two = bench.idc(&["run", "scenario.toml", "--out", "two", "--quiet"], &[]);
    assert_eq!(two.code, 0, "{}", two.err);
    is_inert(&bench.idc(&["compare", "out", "two"], &[]), "");
    let sweep = [
        "vary",
        "scenario.toml",
        "--set",
        "simulation.seed=1,2",
        "--out",
        "sweep",
    ];
    is_inert(&bench.idc(&sweep, &[]), "");
}

#[cfg(unix)]
#[test]
fn a_file_s_name_does_nothing_and_is_one_line() {
    let bench = titled();
    let name = format!("{HOSTILE}\nerror: all is well.toml");
    let shown = "\\u001b]52;c;aGk=\\u0007\\u009b2J";
    std::fs::copy(bench.path("scenario.toml"), bench.path(&name)).unwrap();
    let out = format!("out{HOSTILE}\nwritten to nowhere");
    for (words, lines) in [
        (vec!["run", &name, "--out", &out, "--force"], 0),
        (vec!["check", &name], 0),
        (vec!["run", &name, "--set", "process.force=1"], 1),
        (vec!["run", "missing\u{1b}[2J\nerror: b.toml"], 1),
        (vec!["report", &out], 0),
        (vec!["view", &out, "--native"], 1),
        (vec!["diagnose", &out], 1),
        (vec!["import", &name, &name], 1),
        (vec!["edges", &name, "--unit", "m"], 1),
        (vec!["run", &name, "--\u{1b}[2J"], 1),
    ] {
        let outcome = bench.idc(&words, &[]);
        is_inert(&outcome, if words[0] == "run" { "\\u001b" } else { "" });
        let errors = outcome.err.lines().filter(|line| line.starts_with("error"));
        assert_eq!(errors.count(), lines, "{words:?}: {}", outcome.err);
        let places = outcome
            .out
            .lines()
            .filter(|line| line.starts_with("written to"));
        assert!(places.count() < 2, "{}", outcome.out);
    }
    let refused = bench.idc(&["run", &name, "--set", "process.force=1", "--json"], &[]);
    is_inert(&refused, shown);
    // A line of the file that is shown below a sentence.
    let text = std::fs::read_to_string(bench.path("scenario.toml")).unwrap();
    let text = text.replacen("force_n =", "froce_n =", 1);
    let at = text.find("froce_n").unwrap();
    let end = at + text[at..].find('\n').unwrap();
    bench.write(
        "wrong.toml",
        format!("{} # \u{9b}2J\u{202e}{}", &text[..end], &text[end..]),
    );
    is_inert(&bench.idc(&["run", "wrong.toml"], &[]), "froce_n");
}

#[test]
fn a_log_s_columns_do_nothing_to_a_terminal() {
    let bench = Bench::new("plate_edge_ideal");
    let rows: String = (0..50)
        .map(|i| format!("{}.0,{i}.5\n", f64::from(i)))
        .collect();
    let name = HOSTILE.replace('\r', "");
    bench.write("log.csv", format!("time_s,\"{name}\"\n{rows}"));
    let draft = ["new", "import", "map.toml", "--from", "log.csv", "--force"];
    is_inert(&bench.idc(&draft, &[]), "");
    is_inert(&bench.idc(&["check", "map.toml"], &[]), "");
    is_inert(
        &bench.idc(
            &["import", "map.toml", "log.csv", "--out", "log_si.csv"],
            &[],
        ),
        "",
    );
}

/// What is printed goes through one door, which lets nothing through (src/app/terminal.rs), and a bar through another (src/app/progress.rs).
#[test]
fn nothing_is_printed_past_the_door() {
    let doors = ["app/terminal.rs", "app/progress.rs"];
    let mut past = Vec::new();
    for (file, tokens) in sources() {
        let of_tests = file.ends_with("tests.rs") || file.contains("/tests/");
        if of_tests || doors.contains(&file.as_str()) {
            continue;
        }
        for (place, token) in tokens.iter().enumerate() {
            let next = |ahead: usize| tokens.get(place + ahead).map_or("", |t| t.text.as_str());
            let before = place.checked_sub(1).map_or("", |b| tokens[b].text.as_str());
            let printed = match token.text.as_str() {
                "print" | "println" | "eprint" | "eprintln" | "dbg" => next(1) == "!",
                "stdout" | "stderr" => {
                    // Asked what they are, not written to.
                    let asked = next(4) == "is_terminal" || before == "::" && next(3) == ")";
                    next(1) == "(" && next(2) == ")" && !asked
                }
                "set_message" => before == ".",
                _ => false,
            };
            if printed || token.text == "println" && before == "." {
                past.push(format!("src/{file}:{}: {}", token.line, token.text));
            }
        }
    }
    assert!(past.is_empty(), "{}", past.join("\n"));
}

#[test]
fn another_s_picture_is_an_image_on_a_page() {
    let bench = Bench::new("plate_edge_ideal");
    let run = bench.idc(&["run", "scenario.toml", "--out", "out", "--quiet"], &[]);
    assert_eq!(run.code, 0, "{}", run.err);
    let hostile = "<svg xmlns=\"http://www.w3.org/2000/svg\" onload=\"alert(1)\"><script>alert(2)</script></svg>";
    for name in ["cell.svg", "edge.svg", "lean.svg"] {
        bench.write(&format!("out/{name}"), hostile);
    }
    bench.write("out/report.html", "<script>alert(3)</script>");
    let page = || {
        let outcome = bench.idc(&["report", "out", "--quiet"], &[]);
        assert_eq!(outcome.code, 0, "{}", outcome.err);
        std::fs::read_to_string(bench.path("out/report.html")).unwrap()
    };
    let text = page();
    assert!(!text.contains("alert") || text.contains("%3Cscript%3Ealert%282%29"));
    assert!(!text.contains("<svg xmlns") && !text.contains("onload=\""));
    let policy = text.split_once("script-src ").unwrap().1;
    let policy = policy.split_once(';').unwrap().0;
    assert!(
        policy.split(' ').all(|part| part.starts_with("'sha256-")),
        "{policy}"
    );
    // One that is none: a message, and the page stays.
    bench.write("out/cell.svg", vec![b' '; 5_000_000]);
    let outcome = bench.idc(&["report", "out"], &[]);
    assert_eq!(outcome.code, 2);
    let message = outcome.only_line("error");
    assert!(
        message.contains("cell.svg") && message.contains("5000000 bytes"),
        "{message}"
    );
    assert_eq!(
        std::fs::read_to_string(bench.path("out/report.html")).unwrap(),
        text
    );
    #[cfg(unix)]
    {
        // Nobody writes into it.
        std::fs::remove_file(bench.path("out/cell.svg")).unwrap();
        let made = std::process::Command::new("mkfifo")
            .arg(bench.path("out/cell.svg"))
            .status();
        assert!(made.unwrap().success());
        assert!(page().len() < text.len());
    }
}

const TABLE_OF_RUNS: &str = r#"schema = 1
kind = "removal_table"

[tables]
fit = ["shadow"]

[columns]
force = { name = "force_n", unit = "N" }
volume = { name = "removed_mm3", unit = "mm3" }

[believed]
law = "preston"
"#;

#[test]
fn a_row_of_a_table_of_points_is_named_and_another_s_file_is_not_shown() {
    let bench = Bench::new("plate_edge_ideal");
    let refused = |text: &str| {
        bench.write("points.csv", text);
        let words = [
            "vary",
            "scenario.toml",
            "--points",
            "points.csv",
            "--out",
            "out",
        ];
        let outcome = bench.idc(&words, &[]);
        assert_eq!(outcome.code, 2, "{text}");
        assert!(!bench.path("out").exists());
        outcome.only_line("error").to_owned()
    };
    for (text, expected) in [
        (
            "process.force_n,simulation.seed\n100,1\n1e9,2\n",
            "points.csv: line 3: process.force_n = 1e9: ",
        ),
        (
            "process.force_n\n\n100\nmany\n",
            "points.csv: line 4: process.force_n = many: ",
        ),
        (
            "process.force\n100\n",
            "points.csv: line 2: process.force = 100: ",
        ),
        (
            "process.force_n\n100,2\n",
            "points.csv: line 2: it has 2 values",
        ),
        (
            "process.force_n\nnan\n",
            "points.csv: line 2: `process.force_n` is `nan`",
        ),
    ] {
        let message = refused(text);
        assert!(message.contains(expected), "{text}: {message}");
        assert!(!message.contains("--set"), "{message}");
    }
    let secret = "root:$y$j9T$secret:19000:0:::\n";
    assert!(!refused(&format!("{secret}daemon:*:19000\n")).contains("secret"));
    // The same where a case names it as its table of runs, or a scenario as its device.
    bench.write("shadow", secret);
    bench.write("rig.toml", TABLE_OF_RUNS);
    let outcome = bench.idc(&["diagnose", ".", "--out", "found"], &[]);
    let message = outcome.only_line("error");
    let expected = "there is no column `force_n` among the 1 of its first line";
    assert!(
        message.contains("shadow") && message.contains(expected),
        "{message}"
    );
    assert!(!outcome.err.contains("secret"), "{}", outcome.err);
    bench.replace("scenario.toml", "device.toml", "shadow");
    let outcome = bench.idc(&["run", "scenario.toml"], &[]);
    assert_eq!(outcome.code, 2);
    assert!(!outcome.err.contains("secret"), "{}", outcome.err);
}
