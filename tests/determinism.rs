//! The same scenario gives the same bytes, again and with any number of threads.

use crate::program::{Bench, FILES};

/// Bytes of a run's files, the summary without its timing.
fn files(bench: &Bench, threads: Option<&str>) -> Vec<(String, Vec<u8>)> {
    let environment: Vec<(&str, &str)> = threads
        .map(|count| ("RAYON_NUM_THREADS", count))
        .into_iter()
        .collect();
    let outcome = bench.idc(
        &["run", "scenario.toml", "--out", "out", "--force", "--quiet"],
        &environment,
    );
    assert_eq!(outcome.code, 0, "{}", outcome.err);
    let bytes = |name: &str| match name {
        "summary.json" => {
            let mut summary = bench.summary();
            let timing = summary["summary"]
                .as_object_mut()
                .unwrap()
                .remove("timing")
                .unwrap();
            assert!(timing["wall_time_s"].as_f64().unwrap() > 0.0);
            summary.to_string().into_bytes()
        }
        _ => std::fs::read(bench.path("out").join(name)).unwrap(),
    };
    let names = bench.names_in("out").into_iter();
    names.map(|name| (name.clone(), bytes(&name))).collect()
}

fn assert_equal(name: &str, expected: &[(String, Vec<u8>)], found: &[(String, Vec<u8>)]) {
    // A bench has its figures where a cell has three files of its edge.
    assert!(expected.len() + 2 >= FILES.len() && expected.len() == found.len());
    for ((file, expected), (same, found)) in expected.iter().zip(found) {
        assert_eq!(file, same);
        assert!(expected == found, "{name}: {file} differs");
    }
}

#[test]
fn a_scenario_gives_the_same_bytes_again_and_with_any_number_of_threads() {
    // The last in two passes: its path goes back.
    for name in ["plate_edge", "burred_edge", "deburred_edge"] {
        let bench = Bench::new(name);
        let first = files(&bench, None);
        for threads in [None, Some("1"), Some("4")] {
            assert_equal(name, &first, &files(&bench, threads));
        }
        // Nor does it matter where the job stands.
        assert_equal(name, &first, &files(&Bench::new(name), None));
    }
}

#[test]
fn a_bench_gives_the_same_bytes_again() {
    for name in ["paper_step", "hand_push", "retract"] {
        let bench = Bench::new(name);
        bench.replace(
            "scenario.toml",
            "[bench]\n",
            "[sensing]\npreset = \"paper\"\n[bench]\n",
        );
        let first = files(&bench, None);
        assert!(first.iter().any(|(file, _)| file == "figures.svg"));
        for threads in [None, Some("1")] {
            assert_equal(name, &first, &files(&bench, threads));
        }
    }
}

#[test]
fn another_burr_gives_other_bytes() {
    let bench = Bench::new("burred_edge");
    let first = files(&bench, None);
    bench.replace("scenario.toml", "seed = 1", "seed = 2");
    for ((file, one), (_, other)) in first.iter().zip(&files(&bench, None)) {
        // How the tool stands does not depend on the burr.
        assert!(one != other || file == "lean.svg", "{file}");
    }
}
