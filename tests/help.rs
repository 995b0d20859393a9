//! Every example of every `--help` is run as printed, from a folder that looks like the project's; help fits into 80 columns.

use std::path::Path;
use std::process::Command;

use clap::CommandFactory as _;
use idc_cell::app::Cli;

use crate::common::project;

/// Allowed words in the comment of an example that no test runs.
const REASONS: [&str; 4] = [
    "(takes minutes)",
    "(takes hours)",
    "(opens a window)",
    "(serves until stopped)",
];

/// The help of a command as a terminal of 80 columns shows it.
fn help(command: &[String]) -> String {
    let output = Command::new(env!("CARGO_BIN_EXE_idc"))
        .args(command)
        .arg("--help")
        .env("COLUMNS", "80")
        .output()
        .unwrap();
    assert!(output.status.success(), "{command:?}");
    String::from_utf8(output.stdout).unwrap()
}

/// Every command by its words, the program itself first; what takes commands itself is followed down.
fn commands() -> Vec<Vec<String>> {
    fn note(command: &clap::Command, words: &[String], found: &mut Vec<Vec<String>>) {
        found.push(words.to_vec());
        for sub in command.get_subcommands() {
            if !sub.is_hide_set() && sub.get_name() != "help" {
                let words = [words, &[sub.get_name().to_owned()]].concat();
                note(sub, &words, found);
            }
        }
    }
    let mut found = Vec::new();
    note(&Cli::command(), &[], &mut found);
    found
}

/// Examples: the command as it would be pasted, and the comment above it.
fn examples(help: &str) -> Vec<(String, String)> {
    let Some((_, text)) = help.split_once("Examples:\n") else {
        return Vec::new();
    };
    let mut found: Vec<(String, String)> = Vec::new();
    let mut comment = String::new();
    let mut open = false;
    for line in text.lines() {
        if open {
            let (command, _) = found.last_mut().unwrap();
            *command += &format!("\n{line}");
        } else if let Some(words) = line.strip_prefix("  # ") {
            words.clone_into(&mut comment);
        } else {
            let command = line.strip_prefix("  ");
            let command =
                command.unwrap_or_else(|| panic!("neither comment nor example: {line:?}"));
            found.push((command.to_owned(), comment.clone()));
        }
        open = line.ends_with('\\');
    }
    found
}

/// A folder with what the project comes with, where nothing can be spoiled.
pub fn place() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    for name in ["assets", "docs", "models", "scenarios"] {
        std::os::unix::fs::symlink(project(name), folder.path().join(name)).unwrap();
    }
    folder
}

/// Runs a line in a shell that knows this program as `idc`.
pub fn shell(line: &str, folder: &Path) -> std::process::Output {
    let program = Path::new(env!("CARGO_BIN_EXE_idc")).parent().unwrap();
    let path = std::env::var_os("PATH").unwrap_or_default();
    let mut paths = vec![program.to_owned()];
    paths.extend(std::env::split_paths(&path));
    Command::new("bash")
        .args(["-e", "-o", "pipefail", "-c", line])
        .env("PATH", std::env::join_paths(paths).unwrap())
        .env("HOME", folder)
        .current_dir(folder)
        .output()
        .unwrap()
}

/// Clap would break a longer line, and with it an example.
#[test]
fn what_help_ends_with_is_not_broken() {
    let program = Cli::command();
    for command in program.get_subcommands().chain([&program]) {
        let text = command.get_after_help().map(ToString::to_string);
        let text = text.unwrap_or_default();
        let wide = text.lines().find(|line| line.chars().count() > 80);
        assert_eq!(wide, None, "{}", command.get_name());
    }
}

#[test]
fn every_help_fits_into_80_columns_and_ends_with_examples() {
    for command in commands() {
        let text = help(&command);
        let wide = text.lines().find(|line| line.chars().count() > 80);
        assert_eq!(wide, None, "{command:?}");
        let examples = examples(&text);
        assert!(!examples.is_empty(), "{command:?} has no examples:\n{text}");
        if let Some(name) = command.first() {
            let own = |(line, _): &(String, String)| line.contains(&format!("idc {name}"));
            assert!(
                examples.iter().any(own),
                "{command:?}: none of its examples is one of its own"
            );
        }
    }
}

/// The lines of a usage, as one.
fn usage(text: &str) -> String {
    let after = text.split_once("Usage: ").map_or("", |(_, after)| after);
    let lines = after.lines().take_while(|line| !line.trim().is_empty());
    lines.map(str::trim).collect::<Vec<_>>().join(" ")
}

#[test]
fn no_usage_has_a_part_twice() {
    for command in commands() {
        let mut wrong = Command::new(env!("CARGO_BIN_EXE_idc"));
        // Of what is missing, or of what is not known, whichever it tells.
        let output = wrong
            .args(&command)
            .arg("--no-such-option")
            .output()
            .unwrap();
        assert_eq!(output.status.code(), Some(2), "{command:?}");
        let refused = String::from_utf8(output.stderr).unwrap();
        for text in [help(&command), refused] {
            let usage = usage(&text);
            assert!(usage.starts_with("idc"), "{command:?}: {text}");
            let mut parts: Vec<&str> = usage
                .split(' ')
                .map(|p| p.trim_end_matches("..."))
                .collect();
            parts.sort_unstable();
            let twice = parts.windows(2).find(|pair| pair[0] == pair[1]);
            assert_eq!(twice, None, "{usage}");
        }
    }
}

/// A number in a text that no person would write so: with an exponent, or a zero with a minus.
fn odd_number(text: &str) -> Option<&str> {
    text.split(|c: char| c.is_whitespace() || "(),;[]{}|=:".contains(c))
        .find(|word| {
            let exponent = word
                .split_once(['e', 'E'])
                .is_some_and(|(mantissa, power)| {
                    let power = power.trim_start_matches(['+', '-']);
                    let digits =
                        |text: &str| !text.is_empty() && text.chars().all(|c| c.is_ascii_digit());
                    mantissa.parse::<f64>().is_ok() && digits(power)
                });
            let zero = word.strip_prefix('-').is_some_and(|rest| {
                rest.starts_with("0.0") && rest.chars().all(|c| c == '0' || c == '.')
            });
            exponent || zero
        })
}

#[test]
fn odd_numbers_are_seen() {
    for text in ["by 1.299e0 N", "a change of -0.0 %", "(-0.00)", "3E-4"] {
        assert!(odd_number(text).is_some(), "{text}");
    }
    for text in [
        "case-03",
        "1.3 N",
        "-0.04",
        "runs/e3",
        "2.5·10⁻⁷",
        "0.0",
        "--set a=1",
    ] {
        assert_eq!(odd_number(text), None);
    }
}

#[test]
fn every_example_of_the_help_runs_as_printed() {
    let mut run = 0;
    for command in commands() {
        let folder = place();
        for (line, comment) in examples(&help(&command)) {
            if REASONS.iter().any(|reason| comment.contains(reason)) {
                continue;
            }
            let output = shell(&line, folder.path());
            assert!(
                output.status.success(),
                "{line}\n{}{}",
                String::from_utf8_lossy(&output.stdout),
                String::from_utf8_lossy(&output.stderr)
            );
            // JSON is for programs.
            if !line.contains("--json") && !line.contains("schema") {
                for reported in [&output.stdout, &output.stderr] {
                    let reported = String::from_utf8_lossy(reported);
                    assert_eq!(odd_number(&reported), None, "{line}\n{reported}");
                    assert!(!reported.contains(" 1 cases"), "{line}\n{reported}");
                }
            }
            run += 1;
        }
    }
    assert!(run > 15, "{run} examples");
}
