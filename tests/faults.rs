//! A disk that is full, one that fails, and a process that is killed, at each call that writes, syncs, makes, links, renames or removes a file: what stands
//! afterwards is the old result or the new one, and the next run is as any other. The calls are stopped by a small tracer (`faults/inject.c`).
//!
//! Some calls of each command are met in the ordinary tests, all of them with `IDC_ALL_FAULTS=1`.

#![cfg(all(target_os = "linux", target_arch = "x86_64"))]

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::OnceLock;

use crate::common::project;
use crate::diagnose::planted::{Dirt, OFFSET, case};
use crate::program::Bench;

/// A command that writes.
struct Writing {
    /// What makes the old result; none where there is none before.
    old: Option<&'static str>,
    /// What makes the new one; the same words run again make it once more.
    new: &'static str,
    /// Files or folders, each of which is old or new as a whole. Folders of tasks are not looked into.
    results: &'static [&'static str],
    /// Files of them that hold the time that the work took, and are never the same.
    timed: &'static [&'static str],
    /// Fewest calls: of a tracer that sees nothing nothing would fail.
    calls: usize,
}

/// A call that was met.
#[derive(Debug, Clone)]
struct Call {
    name: String,
    path: String,
}

const FAULTS: [(&str, &str); 3] = [
    ("ENOSPC", "No space left on device"),
    ("EIO", "Input/output error"),
    ("KILL", ""),
];

/// The tracer, compiled once.
fn tracer() -> &'static Path {
    static TRACER: OnceLock<(tempfile::TempDir, PathBuf)> = OnceLock::new();
    let (_, path) = TRACER.get_or_init(|| {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("inject");
        let source = project("tests/faults/inject.c");
        let made = Command::new("cc")
            .args(["-O1", "-o"])
            .arg(&path)
            .arg(source)
            .output();
        let made = made.expect("a C compiler, as SQLite needs one too");
        assert!(
            made.status.success(),
            "{}",
            String::from_utf8_lossy(&made.stderr)
        );
        (folder, path)
    });
    path
}

fn copy_tree(from: &Path, to: &Path) {
    std::fs::create_dir_all(to).unwrap();
    for entry in std::fs::read_dir(from).unwrap() {
        let path = entry.unwrap().path();
        let target = to.join(path.file_name().unwrap());
        match path.is_dir() {
            true => copy_tree(&path, &target),
            false => drop(std::fs::copy(&path, &target).unwrap()),
        }
    }
}

/// Runs a command in a folder, with a fault at a call; exit code, standard error, calls.
fn traced(folder: &Path, words: &str, at: usize, fault: &str) -> (i32, String, Vec<Call>) {
    let room = tempfile::tempdir().unwrap();
    let log = room.path().join("calls");
    let output = Command::new(tracer())
        .arg(folder)
        .args([&at.to_string(), fault])
        .arg(&log)
        .arg(env!("CARGO_BIN_EXE_idc"))
        .args(words.split(' '))
        // The same calls in the same order, as far as that goes.
        .env("RAYON_NUM_THREADS", "1")
        .current_dir(folder)
        .output()
        .unwrap();
    let code = output.status.code().unwrap();
    let err = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_ne!(code, 125, "the tracer: {err}");
    let text = std::fs::read_to_string(log).unwrap();
    let call = |line: &str| {
        let mut words = line.splitn(3, ' ').skip(1).map(str::to_owned);
        Call {
            name: words.next().unwrap(),
            path: words.next().unwrap(),
        }
    };
    (code, err, text.lines().map(call).collect())
}

/// Files of a result by their paths, but for those of tasks and for what is unfinished.
fn content(result: &Path) -> BTreeMap<PathBuf, Vec<u8>> {
    let mut found = BTreeMap::new();
    let mut waiting = vec![result.to_owned()];
    while let Some(path) = waiting.pop() {
        let name = path.file_name().unwrap().to_string_lossy();
        if name.starts_with(".unfinished-") || name == "tasks" || name.ends_with(".jsonl") {
            continue;
        }
        if path.is_dir() {
            waiting.extend(
                std::fs::read_dir(&path)
                    .unwrap()
                    .map(|entry| entry.unwrap().path()),
            );
        } else if path.exists() {
            let short = path.strip_prefix(result).unwrap().to_owned();
            found.insert(short, std::fs::read(&path).unwrap());
        }
    }
    found
}

fn unfinished(folder: &Path) -> Vec<PathBuf> {
    let mut found = Vec::new();
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path
            .file_name()
            .unwrap()
            .to_string_lossy()
            .starts_with(".unfinished-")
        {
            found.push(path);
        } else if path.is_dir() {
            found.extend(unfinished(&path));
        }
    }
    found
}

impl Writing {
    /// Whether a result is the new one; the time that it took is another each time.
    fn is_new(
        &self,
        found: &BTreeMap<PathBuf, Vec<u8>>,
        [old, new]: [&BTreeMap<PathBuf, Vec<u8>>; 2],
    ) -> bool {
        found.keys().eq(new.keys())
            && found.iter().all(|(name, content)| {
                let timed = self.timed.iter().any(|timed| name.ends_with(timed));
                match timed {
                    true => old.get(name) != Some(content),
                    false => new[name] == *content,
                }
            })
    }

    /// Meets the calls, in copies of a folder.
    fn meet(&self, bench: &Bench) {
        let name = self.new;
        if let Some(old) = self.old {
            let made = bench.idc(
                &old.split(' ').collect::<Vec<_>>(),
                &[("RAYON_NUM_THREADS", "1")],
            );
            assert!(made.code <= 1, "{old}: {}", made.err);
        }
        let at = |folder: &Path| -> Vec<BTreeMap<PathBuf, Vec<u8>>> {
            self.results
                .iter()
                .map(|result| content(&folder.join(result)))
                .collect()
        };
        let copy = || {
            let room = tempfile::tempdir().unwrap();
            let folder = room.path().canonicalize().unwrap().join("work");
            copy_tree(&bench.path(""), &folder);
            (room, folder)
        };
        let (_room, folder) = copy();
        let old = at(&folder);
        let (code, err, calls) = traced(&folder, self.new, 0, "KILL");
        assert!(code <= 1, "{name}: {err}");
        let new = at(&folder);
        assert!(
            calls.len() >= self.calls,
            "{name}: only {} calls",
            calls.len()
        );
        assert!(old.iter().zip(&new).all(|(old, new)| old != new), "{name}");
        assert_eq!(unfinished(&folder), Vec::<PathBuf>::new(), "{name}");
        let chosen = chosen(&calls);
        for (number, fault) in &chosen {
            let (_room, folder) = copy();
            let (code, err, met) = traced(&folder, self.new, *number, fault.0);
            let call = met.get(number - 1);
            let place =
                call.map_or_else(String::new, |call| format!("{} {}", call.name, call.path));
            let place = format!(
                "{name}: {} at call {number} of {}, {place}",
                fault.0,
                calls.len()
            );
            self.check_end((code, &err), fault, call, &place);
            let found = at(&folder);
            for (((found, old), new), result) in found.iter().zip(&old).zip(&new).zip(self.results)
            {
                let whole = found == old || self.is_new(found, [old, new]);
                let names: Vec<_> = found.keys().collect();
                assert!(
                    whole,
                    "{place}: {result} is neither old nor new: {names:?}\n{err}"
                );
            }
            // The next one is as any other, and clears away.
            let (code, err, _) = traced(&folder, self.new, 0, "KILL");
            assert!(code <= 1, "{place}, then: {err}");
            for ((found, old), new) in at(&folder).iter().zip(&old).zip(&new) {
                assert!(self.is_new(found, [old, new]), "{place}, then");
            }
            assert_eq!(unfinished(&folder), Vec::<PathBuf>::new(), "{place}, then");
        }
        println!("{name}: {} calls, {} faults", calls.len(), chosen.len());
    }

    fn check_end(
        &self,
        (code, err): (i32, &str),
        fault: &(&str, &str),
        call: Option<&Call>,
        place: &str,
    ) {
        assert!(!err.contains("panicked"), "{place}: {err}");
        let Some(call) = call else {
            // A call less, as threads went another way.
            return;
        };
        // What is cleared away in passing may stay, and goes the next time.
        let in_passing = call.name == "unlink";
        match fault.0 {
            "KILL" => assert_eq!(code, 137, "{place}: {err}"),
            _ if in_passing && code <= 1 => (),
            _ => {
                assert_eq!(code, 2, "{place}: {err}");
                let lines: Vec<&str> = err.lines().filter(|l| l.starts_with("error: ")).collect();
                let last = lines.last().unwrap_or_else(|| panic!("{place}: {err}"));
                assert!(lines[0].contains(fault.1), "{place}: {err}");
                // Of many parts one message for the part, and one for the whole.
                assert!(
                    lines.len() == 1 || last.contains("failed"),
                    "{place}: {err}"
                );
                let top = self.results[0].split('/').next().unwrap();
                assert!(lines[0].contains(top), "{place}: {err}");
                assert!(!lines[0].contains(".unfinished-"), "{place}: {err}");
            }
        }
    }
}

/// Calls of a kind that are met.
const OF_A_KIND: usize = 2;

/// Calls that are met, each with its fault: all with each, or some of each kind, in turn.
fn chosen(calls: &[Call]) -> Vec<(usize, (&'static str, &'static str))> {
    let numbers = 1..=calls.len();
    if std::env::var_os("IDC_ALL_FAULTS").is_some() {
        return numbers
            .flat_map(|number| FAULTS.map(|fault| (number, fault)))
            .collect();
    }
    let mut of_kind: BTreeMap<&str, Vec<usize>> = BTreeMap::new();
    for (number, call) in numbers.zip(calls) {
        of_kind.entry(&call.name).or_default().push(number);
    }
    let mut chosen = Vec::new();
    for numbers in of_kind.values() {
        let count = OF_A_KIND.min(numbers.len());
        for part in 0..count {
            let number = numbers[(2 * part + 1) * numbers.len() / (2 * count)];
            chosen.push((number, FAULTS[chosen.len() % FAULTS.len()]));
        }
    }
    // The last of these puts results in their place: each way.
    for kind in ["rename", "write"] {
        let last = of_kind.get(kind).and_then(|numbers| numbers.last());
        chosen.extend(
            last.into_iter()
                .flat_map(|number| FAULTS.map(|fault| (*number, fault))),
        );
    }
    chosen
}

/// Two short runs of a bench, two cases, a log with its map, a study.
fn bench() -> Bench {
    let bench = Bench::new("paper_step");
    for (name, force) in [("one", 60), ("two", 80)] {
        bench.write(
            &format!("{name}.toml"),
            format!(
                "schema = 1\nkind = \"bench\"\ntitle = \"{name}\"\n[device]\nideal = true\nmodel = \"device.toml\"\n[bench]\nduration_s = 0.5\n\
                 [load]\nkind = \"load_cell\"\nposition_mm = 20\n[[command]]\nat_s = 0.1\nforce_n = {force}\n"
            ),
        );
    }
    std::fs::create_dir(bench.path("logs")).unwrap();
    std::fs::copy(project("assets/first/map.toml"), bench.path("map.toml")).unwrap();
    let ride = std::fs::read_to_string(project("assets/first/ride.csv")).unwrap();
    let lines: Vec<&str> = ride.lines().collect();
    for (name, count) in [("one", 400), ("two", 500)] {
        bench.write(
            &format!("logs/{name}.csv"),
            lines[..count].join("\n") + "\n",
        );
    }
    bench
}

#[test]
fn of_a_run_the_old_files_stand_or_the_new_ones() {
    let writing = Writing {
        old: Some("run one.toml --out out --quiet"),
        new: "run two.toml --out out --quiet --force",
        results: &["out"],
        timed: &["summary.json"],
        calls: 40,
    };
    writing.meet(&bench());
    // And where there is none before.
    let first = Writing {
        old: None,
        new: "run two.toml --out out/deep --quiet --force",
        ..writing
    };
    first.meet(&bench());
}

#[test]
fn of_several_runs_each_is_old_or_new() {
    let writing = Writing {
        old: Some("run one.toml --set command[0].force_n=60,70 --out out --quiet --no-recording"),
        new: "run two.toml --set command[0].force_n=60,70 --out out --quiet --no-recording --force",
        results: &["out/force_n=60", "out/force_n=70", "out/compare.html"],
        timed: &["summary.json"],
        calls: 60,
    };
    writing.meet(&bench());
}

const TIMED: &[&str] = &[
    "diagnosis.json",
    "account.txt",
    "report.html",
    "diagnosis.rrd",
];

#[test]
fn of_a_diagnosis_the_old_files_stand_or_the_new_ones() {
    let bench = bench();
    case(&bench, "cases/one", OFFSET, Dirt::None);
    case(&bench, "cases/two", "", Dirt::None);
    let writing = Writing {
        old: Some("diagnose cases/one --out out --quiet --effort 1"),
        new: "diagnose cases/two --out out --quiet --effort 1 --force",
        results: &["out"],
        timed: TIMED,
        calls: 40,
    };
    writing.meet(&bench);
}

#[test]
fn of_many_diagnoses_each_is_old_or_new() {
    let bench = bench();
    case(&bench, "old/one", OFFSET, Dirt::None);
    case(&bench, "cases/one", "", Dirt::None);
    let writing = Writing {
        old: Some("diagnose old --all --out out --quiet --effort 1"),
        new: "diagnose cases --all --out out --quiet --effort 1 --force",
        results: &["out/one"],
        timed: TIMED,
        calls: 40,
    };
    writing.meet(&bench);
}

#[test]
fn of_a_sweep_the_old_tables_stand_or_the_new_ones() {
    let writing = Writing {
        old: Some("vary one.toml --set command[0].force_n=60,70 --out out --quiet"),
        new: "vary one.toml --set command[0].force_n=60,70,80 --out out --quiet --jobs 1 --resume",
        results: &["out"],
        timed: &[],
        calls: 20,
    };
    writing.meet(&bench());
    let anew = Writing {
        new: "vary two.toml --set command[0].force_n=60,70 --out out --quiet --jobs 1 --force",
        ..writing
    };
    anew.meet(&bench());
}

#[test]
fn of_a_fleet_the_old_tables_stand_or_the_new_ones() {
    let bench = bench();
    for (folder, days) in [("one", 1), ("two", 2)] {
        for day in 0..days {
            crate::fleet::record(&bench.path(folder), 0, day, 0.0);
        }
    }
    let writing = Writing {
        old: Some("fleet one/recorded --scenario one/rig.toml --out out --quiet"),
        new: "fleet two/recorded --scenario one/rig.toml --out out --quiet --jobs 1",
        results: &["out"],
        timed: &[],
        calls: 20,
    };
    writing.meet(&bench);
}

#[test]
fn of_an_import_the_old_file_is_kept_or_the_new_one() {
    let writing = Writing {
        old: Some("import map.toml logs/one.csv --out out.csv --quiet"),
        new: "import map.toml logs/two.csv --out out.csv --quiet --force",
        results: &["out.csv"],
        timed: &[],
        calls: 5,
    };
    writing.meet(&bench());
    let several = Writing {
        old: None,
        new: "import map.toml logs/one.csv logs/two.csv --out out --quiet --force",
        results: &["out/one.parquet", "out/two.parquet"],
        calls: 10,
        ..writing
    };
    several.meet(&bench());
}

#[test]
fn of_a_study_the_old_files_stand_or_the_new_ones() {
    let bench = bench();
    for name in ["device_design", "landing", "moved_surface", "wavy_edge"] {
        let text = std::fs::read_to_string(project(&format!("scenarios/studies/{name}.toml")));
        let text = text
            .unwrap()
            .replace("../../models/device.toml", "device.toml");
        let other = text.replace("seed = 1", "seed = 2");
        bench.write(&format!("{name}.toml"), text);
        bench.write(&format!("{name}_other.toml"), other);
    }
    let writing = Writing {
        old: Some("design device_design.toml --evaluations 10 --out out --quiet"),
        new: "design device_design_other.toml --evaluations 10 --out out --quiet --force",
        results: &["out"],
        timed: &[],
        calls: 15,
    };
    writing.meet(&bench);
}

#[test]
fn of_pages_and_tables_each_is_old_or_new() {
    let bench = bench();
    for name in ["one", "two"] {
        let words = [
            "run",
            &format!("{name}.toml"),
            "--out",
            name,
            "--quiet",
            "--no-recording",
        ];
        assert_eq!(bench.idc(&words, &[]).code, 0);
    }
    let writing = Writing {
        old: Some("compare one one --out page.html --quiet"),
        new: "compare one two --out page.html --quiet --force",
        results: &["page.html"],
        timed: &[],
        calls: 5,
    };
    writing.meet(&bench);
    let page = Writing {
        old: Some("report one --out page.html --quiet --force"),
        new: "report two --out page.html --quiet --force",
        ..writing
    };
    page.meet(&bench);
    let manual = Writing {
        old: None,
        new: "man --out pages --force",
        results: &["pages/idc.1", "pages/idc-run.1"],
        ..page
    };
    manual.meet(&bench);
    let cases = Writing {
        old: None,
        new: "laboratory --devices 2 --duration-s 2 --out lab --quiet --force",
        results: &["lab"],
        ..manual
    };
    cases.meet(&bench);
    let started = Writing {
        old: None,
        new: "new rig --out rig.toml --quiet --force",
        results: &["rig.toml"],
        ..cases
    };
    started.meet(&bench);
}
