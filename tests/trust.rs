//! Nothing stale, nothing trusted: a result whose inputs have changed, or that is not what was written, is done again and that is said; of two processes that
//! would write into one place one is refused.
//!
//! How many pairs and damages are tried is set by `IDC_PAIRS` and `IDC_DAMAGES`; 200 of each take some minutes.

use std::path::Path;
use std::process::{Child, Command, Stdio};

use idc_cell::recording::claim::Claim;
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;

use crate::common::project;
use crate::diagnose::planted::{Dirt, OFFSET, case, case_files};
use crate::program::{Bench, Outcome};

/// A number that the environment may ask for.
fn asked(name: &str, usual: usize) -> usize {
    std::env::var(name).map_or(usual, |text| text.parse().unwrap())
}

/// A short run of a bench, a log with its map, and a case.
fn bench() -> Bench {
    let bench = Bench::new("paper_step");
    bench.write(
        "short.toml",
        "schema = 1\nkind = \"bench\"\ntitle = \"Short\"\n[device]\nideal = true\nmodel = \"device.toml\"\n[bench]\nduration_s = 0.5\n\
         [load]\nkind = \"load_cell\"\nposition_mm = 20\n[[command]]\nat_s = 0.1\nforce_n = 60\n",
    );
    std::fs::copy(project("assets/first/map.toml"), bench.path("map.toml")).unwrap();
    std::fs::copy(project("assets/first/ride.csv"), bench.path("ride.csv")).unwrap();
    bench
}

fn idc(bench: &Bench, words: &str) -> Outcome {
    bench.idc(&words.split(' ').collect::<Vec<_>>(), &[])
}

fn begun(bench: &Bench, words: &str) -> Child {
    Command::new(env!("CARGO_BIN_EXE_idc"))
        .args(words.split(' '))
        .current_dir(bench.path(""))
        .stdout(Stdio::null())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap()
}

fn outcome_of(child: Child) -> (Option<i32>, String) {
    let output = child.wait_with_output().unwrap();
    (
        output.status.code(),
        String::from_utf8(output.stderr).unwrap(),
    )
}

#[test]
fn of_two_processes_into_one_place_one_is_refused() {
    let commands = [
        ("run short.toml --out out --quiet", "out"),
        ("import map.toml ride.csv --out out.csv --quiet", "out.csv"),
        (
            "run short.toml --set command[0].force_n=60,70 --out out --quiet --no-recording",
            "out",
        ),
        (
            "vary short.toml --set command[0].force_n=60,70 --out out --quiet",
            "out",
        ),
        ("import map.toml ride.csv --out out/ --quiet", "out"),
    ];
    let bench = bench();
    let pairs = asked("IDC_PAIRS", 10);
    let mut met = 0;
    for pair in 0..pairs {
        let (words, out) = commands[pair % commands.len()];
        let both = [begun(&bench, words), begun(&bench, words)].map(outcome_of);
        let mut codes = both.each_ref().map(|(code, _)| *code);
        codes.sort_unstable();
        assert_eq!(codes, [Some(0), Some(2)], "{words}: {both:?}");
        let (_, refused) = both.iter().find(|(code, _)| *code == Some(2)).unwrap();
        let lines: Vec<&str> = refused.lines().collect();
        assert_eq!(lines.len(), 1, "{words}: {refused}");
        let claimed = refused.contains("another idc is writing");
        assert!(claimed || refused.contains("already"), "{words}: {refused}");
        met += usize::from(claimed);
        let out = bench.path(out);
        drop(std::fs::remove_dir_all(&out).or_else(|_| std::fs::remove_file(&out)));
        assert!(
            bench
                .names_in("")
                .iter()
                .all(|name| !name.starts_with(".unfinished"))
        );
    }
    println!("{pairs} pairs, one refused in each; {met} while the other was writing");
    // Both ways of refusing are met in two hundred; here at least that they met at all.
    assert!(pairs < 10 || met > 0);
}

#[test]
fn what_another_process_writes_is_refused_with_force_too_and_free_once_it_is_gone() {
    let bench = bench();
    case(&bench, "cases/one", "", Dirt::None);
    std::fs::create_dir(bench.path("out")).unwrap();
    let commands = [
        "run short.toml --out out --quiet",
        "diagnose cases/one --effort 1 --out out --quiet",
        "diagnose cases --all --effort 1 --out out --quiet",
        "vary short.toml --set command[0].force_n=60,70 --out out --quiet",
        "prove --cases cases --out out",
        "prove --sweep --effects force_sensor_gain_error --sizes 1 --seeds 1 --empty 0 --duration-s 2 --quiet --out out",
        "laboratory --devices 1 --duration-s 2 --out out --quiet",
        "import map.toml ride.csv --out out/x.csv --quiet",
        "report out --out out/x.csv",
        "new rig --out out/x.csv --quiet",
    ];
    let claim = Claim::of_folder(&bench.path("out")).unwrap().unwrap();
    let file = Claim::of_file(&bench.path("out/x.csv")).unwrap().unwrap();
    // A page is made of results.
    assert_eq!(idc(&bench, "run short.toml --out other --quiet").code, 0);
    let before = bench.contents();
    for words in commands {
        for force in ["", " --force"] {
            let words = words.replace("report out", "report other") + force;
            let refused = idc(&bench, &words);
            assert_eq!(refused.code, 2, "{words}: {}", refused.err);
            let line = refused.only_line("error: ");
            assert!(
                line.contains("another idc is writing") && line.contains("out"),
                "{line}"
            );
            assert!(before == bench.contents(), "{words}");
        }
    }
    drop((claim, file));
    let free = idc(&bench, commands[0]);
    assert_eq!(free.code, 0, "{}", free.err);
}

#[cfg(unix)]
#[test]
fn what_a_killed_run_has_left_goes_with_the_next() {
    let bench = bench();
    let long = "vary short.toml --set command[0].force_n=50..90:400 --out out --quiet";
    let mut child = begun(&bench, long);
    while !bench.path("out/tasks").is_dir() || bench.names_in("out/tasks").len() < 3 {
        assert!(
            child.try_wait().unwrap().is_none(),
            "it was done before it could be killed"
        );
        std::thread::sleep(std::time::Duration::from_millis(2));
    }
    child.kill().unwrap();
    child.wait().unwrap();
    // As more of them would leave it.
    for name in [
        "out/.unfinished-a",
        "out/tasks/.unfinished-b/c",
        ".unfinished-out~d",
    ] {
        std::fs::create_dir_all(bench.path(name)).unwrap();
    }
    bench.write("out/.unfinished-e", "half");
    let next = idc(
        &bench,
        &long
            .replace(":400", ":3")
            .replace("--quiet", "--quiet --resume"),
    );
    assert_eq!(next.code, 0, "{}", next.err);
    for folder in ["", "out", "out/tasks"] {
        let left = bench.names_in(folder);
        assert!(
            left.iter().all(|name| !name.starts_with(".unfinished")),
            "{left:?}"
        );
    }
}

/// What may become of a result that stands.
fn damage(folder: &Path, task: &str, other: &str, random: &mut ChaCha8Rng) -> &'static str {
    let result = |task: &str| folder.join(task).join("result.json");
    let path = result(task);
    let text = std::fs::read(&path).unwrap();
    let digits: Vec<usize> = (0..text.len())
        .filter(|at| text[*at].is_ascii_digit())
        .collect();
    match random.random_range(0..8) {
        0 => {
            std::fs::write(&path, &text[..random.random_range(0..text.len())]).unwrap();
            "cut off"
        }
        1 | 2 => {
            let mut changed = text.clone();
            let at = digits[random.random_range(0..digits.len())];
            changed[at] = b'0' + (changed[at] - b'0' + random.random_range(1..10)) % 10;
            std::fs::write(&path, changed).unwrap();
            "a digit"
        }
        3 => {
            std::fs::copy(result(other), &path).unwrap();
            "of another task"
        }
        4 => {
            let mut value: serde_json::Value = serde_json::from_slice(&text).unwrap();
            value["metrics"] = serde_json::json!([]);
            std::fs::write(&path, value.to_string()).unwrap();
            "empty metrics"
        }
        5 => {
            std::fs::write(&path, "{\"code\":0,\"reason\":\"\",\"metrics\":[]}").unwrap();
            "of an earlier version"
        }
        6 => {
            std::fs::remove_file(&path).unwrap();
            std::fs::write(folder.join(task).join("notes"), "x").unwrap();
            "without its result"
        }
        _ => {
            let mut changed = text.clone();
            let at = random.random_range(0..text.len());
            changed[at] ^= 1 << random.random_range(0..8);
            std::fs::write(&path, changed).unwrap();
            "a bit"
        }
    }
}

#[test]
fn a_damaged_result_is_done_again_and_the_table_is_right() {
    let bench = bench();
    let vary = "vary short.toml --set command[0].force_n=60,70,80 --out out --quiet";
    assert_eq!(idc(&bench, vary).code, 0);
    let tables = || {
        ["runs.parquet", "vary.json", "report.html"]
            .map(|name| std::fs::read(bench.path(&format!("out/{name}"))).unwrap())
    };
    let right = tables();
    let tasks = bench.path("out/tasks");
    let names = bench.names_in("out/tasks");
    let mut random = ChaCha8Rng::seed_from_u64(43);
    let count = asked("IDC_DAMAGES", 12);
    for _ in 0..count {
        let task = random.random_range(0..names.len());
        let other = (task + 1) % names.len();
        let how = damage(&tasks, &names[task], &names[other], &mut random);
        let again = idc(&bench, &format!("{vary} --resume"));
        assert_eq!(again.code, 0, "{how}: {}", again.err);
        let said = again.only_line("note: done again");
        assert!(
            said.contains(&names[task][..12]) && said.contains("1 result in out/tasks"),
            "{said}"
        );
        assert!(tables() == right, "{how}: another table");
    }
    println!("{count} damages, the table right after each");
    // Sound ones are left alone, without a word.
    let again = idc(&bench, &format!("{vary} --resume"));
    assert_eq!((again.code, again.err.as_str()), (0, ""));
    // A task by itself, as an engine asks for it, is done again too.
    let result = tasks.join(&names[0]).join("result.json");
    std::fs::write(&result, "{").unwrap();
    let one = idc(&bench, &format!("task out/plan.jsonl {}", names[0]));
    assert_eq!(one.code, 0, "{}", one.err);
    assert!(one.err.contains("done again") && std::fs::metadata(&result).unwrap().len() > 100);
}

#[test]
fn a_sweep_of_which_a_file_has_changed_says_so() {
    let bench = bench();
    let vary = "vary short.toml --set command[0].force_n=60,70 --out out --quiet";
    assert_eq!(idc(&bench, vary).code, 0);
    let before = bench.names_in("out/tasks");
    bench.replace("short.toml", "at_s = 0.1", "at_s = 0.2");
    let again = idc(&bench, &format!("{vary} --resume"));
    assert_eq!(again.code, 0, "{}", again.err);
    assert!(
        again.only_line("note: ").contains("short.toml changed"),
        "{}",
        again.err
    );
    assert_eq!(bench.names_in("out/tasks").len(), 2 * before.len());
}

#[test]
fn a_diagnosis_whose_recording_has_changed_is_done_again() {
    let bench = bench();
    case(&bench, "cases/one", "", Dirt::None);
    case(&bench, "cases/two", "", Dirt::None);
    let all = "diagnose cases --all --effort 20 --out out --resume";
    assert_eq!(idc(&bench, all).code, 0);
    let file =
        |name: &str| std::fs::read(bench.path(&format!("out/{name}/diagnosis.json"))).unwrap();
    let old = [file("one"), file("two")];
    // Written anew with the same content: nothing is done.
    let text = std::fs::read(bench.path("cases/one/press.csv")).unwrap();
    bench.write("cases/one/press.csv", &text);
    let kept = idc(&bench, all);
    assert!(
        kept.code == 0 && !kept.err.contains("note: "),
        "{}",
        kept.err
    );
    assert_eq!(
        kept.out.matches("(stood already)").count(),
        2,
        "{}",
        kept.out
    );
    assert!([file("one"), file("two")] == old);
    // Other recordings, of the same length and time.
    let time = std::fs::metadata(bench.path("cases/one/press.csv"))
        .unwrap()
        .modified()
        .unwrap();
    case_files(&bench, "cases/one", OFFSET, Dirt::None);
    let changed = std::fs::File::options()
        .write(true)
        .open(bench.path("cases/one/press.csv"));
    changed.unwrap().set_modified(time).unwrap();
    let again = idc(&bench, all);
    assert_eq!(again.code, 0, "{}", again.err);
    let said = again.only_line("note: ");
    assert!(said.contains("cases/one: press.csv has changed"), "{said}");
    assert!(
        again
            .words()
            .contains("(done again: press.csv has changed)"),
        "{}",
        again.out
    );
    assert_eq!(
        again.out.matches("(stood already)").count(),
        1,
        "{}",
        again.out
    );
    assert!(file("one") != old[0] && file("two") == old[1]);
    // Of one alone, and asked for otherwise.
    let one = idc(
        &bench,
        "diagnose cases/one --effort 20 --out out/one --resume",
    );
    assert_eq!((one.code, one.err.as_str()), (0, ""));
    assert!(one.out.contains("holds a diagnosis already"));
    let other = idc(
        &bench,
        "diagnose cases/one --effort 21 --out out/one --resume --quiet",
    );
    assert!(
        other.code == 0 && other.err.contains("diagnosed again"),
        "{}",
        other.err
    );
}

#[test]
fn a_damaged_diagnosis_is_done_again() {
    let bench = bench();
    case(&bench, "cases/one", OFFSET, Dirt::None);
    let all = "diagnose cases --all --effort 20 --out out --resume";
    let first = idc(&bench, all);
    assert_eq!(first.code, 0, "{}", first.err);
    let [document, improved, table] = ["diagnosis.json", "improved.toml", "comparison.parquet"]
        .map(|name| bench.path(&format!("out/one/{name}")));
    let [right, model] = [&document, &improved].map(|path| std::fs::read_to_string(path).unwrap());
    let at = right.find("\"verdict\"").unwrap();
    let damages: [(&str, &dyn Fn()); 4] = [
        ("cut off", &|| {
            std::fs::write(&document, &right[..right.len() / 3]).unwrap();
        }),
        ("another verdict", &|| {
            let other = right[at..].replacen("explained", "unlisted", 1);
            std::fs::write(&document, format!("{}{other}", &right[..at])).unwrap();
        }),
        ("another number", &|| {
            std::fs::write(&improved, model.replacen('1', "2", 1)).unwrap();
        }),
        ("a table is missing", &|| {
            std::fs::remove_file(&table).unwrap();
        }),
    ];
    for (how, damage) in damages {
        damage();
        let again = idc(&bench, all);
        assert_eq!(again.code, 0, "{how}: {}", again.err);
        assert!(
            again.only_line("note: ").contains("diagnosed again"),
            "{how}: {}",
            again.err
        );
        assert_eq!(std::fs::read_to_string(&improved).unwrap(), model, "{how}");
        assert!(table.is_file(), "{how}");
    }
}

#[test]
fn a_damaged_run_is_run_again() {
    let bench = bench();
    let run = "run short.toml --set command[0].force_n=60,70 --out out --no-recording";
    let first = idc(&bench, run);
    assert_eq!(first.code, 0, "{}", first.err);
    let path = bench.path("out/force_n=60/summary.json");
    let right = std::fs::read_to_string(&path).unwrap();
    let digit = right.find("force_mean_n").unwrap() + "force_mean_n\": ".len();
    let damages = [
        right[..right.len() / 2].to_owned(),
        format!("{}9{}", &right[..digit], &right[digit..]),
        std::fs::read_to_string(bench.path("out/force_n=70/summary.json")).unwrap(),
    ];
    for damaged in damages {
        std::fs::write(&path, damaged).unwrap();
        let again = idc(&bench, &format!("{run} --resume"));
        assert_eq!(again.code, 0, "{}", again.err);
        assert!(
            again.only_line("note: ").contains("run again"),
            "{}",
            again.err
        );
        assert_eq!(again.out, first.out);
        let untimed = |text: &str| {
            let mut value: serde_json::Value = serde_json::from_str(text).unwrap();
            value["summary"]["timing"].take();
            value
        };
        let read = std::fs::read_to_string(&path).unwrap();
        assert_eq!(untimed(&read), untimed(&right));
    }
}

#[test]
fn a_damaged_outcome_of_a_proof_is_done_again() {
    let bench = bench();
    let sweep = "prove --sweep --effects force_sensor_gain_error --sizes 1 --seeds 1 --empty 0 --duration-s 2 --out out";
    let first = idc(&bench, sweep);
    assert_eq!(first.code, 0, "{}", first.err);
    let name = bench.names_in("out/outcomes").remove(0);
    let path = bench.path(&format!("out/outcomes/{name}"));
    let right = std::fs::read_to_string(&path).unwrap();
    std::fs::write(&path, right.replacen("true", "false", 1)).unwrap();
    let again = idc(&bench, &format!("{sweep} --resume"));
    assert_eq!(again.code, 0, "{}", again.err);
    assert!(again.err.contains("done again"), "{}", again.err);
    let numbers = |text: &str| -> serde_json::Value {
        let mut value: serde_json::Value = serde_json::from_str(text).unwrap();
        value["score"]["seconds"].take();
        value
    };
    let read = std::fs::read_to_string(&path).unwrap();
    assert_eq!(numbers(&read), numbers(&right));
}
