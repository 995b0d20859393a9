//! The program itself, run in a folder of its own that holds the nominal job side by side: `scenario.toml`, `arm.urdf`, `device.toml`, `part.stl`.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::common::project;

/// Output of a run of the program.
pub struct Outcome {
    /// Exit code.
    pub code: i32,
    /// Standard output.
    pub out: String,
    /// Standard error.
    pub err: String,
}

impl Outcome {
    /// Words of standard output, however its lines were broken.
    pub fn words(&self) -> String {
        self.out.split_whitespace().collect::<Vec<_>>().join(" ")
    }

    /// The only line of standard error that begins with this word; no line may speak of a panic.
    pub fn only_line(&self, word: &str) -> &str {
        assert!(!self.err.contains("panicked"), "{}", self.err);
        let lines: Vec<&str> = self
            .err
            .lines()
            .filter(|line| line.starts_with(word))
            .collect();
        assert_eq!(lines.len(), 1, "lines with {word:?} in:\n{}", self.err);
        lines[0]
    }
}

impl Outcome {
    /// Standard error without the lines of a file that it shows below a sentence, and without those that tell of a search for advice that takes long.
    pub fn sentences(&self) -> String {
        let shown = |line: &&str| {
            let rest = line.trim_start_matches(|c: char| c == ' ' || c.is_ascii_digit());
            let looking = line.starts_with("looking for what would make it possible");
            looking || rest.starts_with('|') || rest.starts_with("--> ")
        };
        let reported: Vec<&str> = self.err.lines().filter(|line| !shown(line)).collect();
        reported.join("\n")
    }
}

/// A folder with a job in it.
pub struct Bench {
    folder: tempfile::TempDir,
}

impl Bench {
    /// The job of `scenarios/<name>.toml`.
    pub fn new(name: &str) -> Self {
        let bench = Self {
            folder: tempfile::tempdir().unwrap(),
        };
        let text = std::fs::read_to_string(project(&format!("scenarios/{name}.toml"))).unwrap();
        let mut local = text;
        for (source, file) in [
            ("models/arm/arm10.urdf", "arm.urdf"),
            ("models/device.toml", "device.toml"),
            ("assets/plate.stl", "part.stl"),
        ] {
            std::fs::copy(project(source), bench.path(file)).unwrap();
            local = local.replace(&format!("../{source}"), file);
        }
        std::fs::write(bench.path("scenario.toml"), local).unwrap();
        bench
    }

    /// A path in the folder.
    pub fn path(&self, file: &str) -> PathBuf {
        self.folder.path().join(file)
    }

    /// Puts other words in place of the first such words of a file, which must be there.
    pub fn replace(&self, file: &str, from: &str, to: &str) {
        let text = std::fs::read_to_string(self.path(file)).unwrap();
        assert!(text.contains(from), "{file} holds no {from:?}");
        std::fs::write(self.path(file), text.replacen(from, to, 1)).unwrap();
    }

    /// Writes a file.
    pub fn write(&self, file: &str, content: impl AsRef<[u8]>) {
        std::fs::write(self.path(file), content).unwrap();
    }

    /// Runs the program in the folder.
    pub fn idc(&self, arguments: &[&str], environment: &[(&str, &str)]) -> Outcome {
        let output = Command::new(env!("CARGO_BIN_EXE_idc"))
            .args(arguments)
            .envs(environment.iter().copied())
            .current_dir(self.folder.path())
            .output()
            .unwrap();
        Outcome {
            code: output.status.code().expect("the program was not killed"),
            out: String::from_utf8(output.stdout).unwrap(),
            err: String::from_utf8(output.stderr).unwrap(),
        }
    }

    /// Runs the job, its files going to `out`, in place of what is there.
    pub fn run(&self) -> Outcome {
        self.idc(&["run", "scenario.toml", "--out", "out", "--force"], &[])
    }

    /// Every file and folder with its content.
    pub fn contents(&self) -> BTreeMap<PathBuf, Vec<u8>> {
        let mut found = BTreeMap::new();
        note(self.folder.path(), &mut found);
        found
    }

    /// Names in a folder, sorted.
    pub fn names_in(&self, folder: &str) -> Vec<String> {
        let entries = std::fs::read_dir(self.path(folder)).unwrap();
        let mut names: Vec<String> = entries
            .map(|entry| entry.unwrap().file_name().into_string().unwrap())
            .collect();
        names.sort();
        names
    }

    /// summary.json of the run into `out`.
    pub fn summary(&self) -> serde_json::Value {
        serde_json::from_slice(&std::fs::read(self.path("out/summary.json")).unwrap()).unwrap()
    }
}

fn note(folder: &Path, found: &mut BTreeMap<PathBuf, Vec<u8>>) {
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            note(&path, found);
            found.insert(path, Vec::new());
        } else {
            let content = std::fs::read(&path).unwrap();
            found.insert(path, content);
        }
    }
}

/// The files of a run.
pub const FILES: [&str; 8] = [
    "cell.svg",
    "drawing.json",
    "edge.svg",
    "lean.svg",
    "recording.rrd",
    "report.html",
    "samples.parquet",
    "summary.json",
];
