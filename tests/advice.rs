//! Advice that is applied works: jobs are spoilt, what `--json` advises is set, and the whole check and run pass.

use serde_json::Value;

use crate::program::{Bench, Outcome};

/// The refusal's JSON.
fn refusal(outcome: &Outcome) -> Value {
    assert_eq!(outcome.code, 2, "{}", outcome.err);
    let line = outcome.err.lines().find(|line| line.starts_with('{'));
    let document: Value = serde_json::from_str(line.expect("no JSON")).unwrap();
    document["error"].clone()
}

/// What a remedy sets, as flags.
fn flags(remedy: &Value) -> Vec<String> {
    let set = remedy["set"].as_object().unwrap();
    assert!(!set.is_empty(), "{remedy}");
    let flag = |(key, value): (&String, &Value)| {
        let value = value
            .as_str()
            .map_or_else(|| value.to_string(), str::to_owned);
        ["--set".to_owned(), format!("{key}={value}")]
    };
    set.iter().flat_map(flag).collect()
}

/// Spoils the nominal job by other words, and has each remedy applied and run; returns the kinds that were given.
fn remedies_of(edits: &[(&str, &str)]) -> Vec<String> {
    let bench = Bench::new("plate_edge_ideal");
    for (from, to) in edits {
        bench.replace("scenario.toml", from, to);
    }
    let refused = bench.idc(&["check", "scenario.toml", "--json", "--effort", "50"], &[]);
    let error = refusal(&refused);
    let mut kinds = Vec::new();
    for remedy in error["remedies"].as_array().unwrap() {
        let flags = flags(remedy);
        let mut words = vec!["run", "scenario.toml", "--out", "out", "--force"];
        words.extend(["--no-recording", "--quiet"]);
        words.extend(flags.iter().map(String::as_str));
        let outcome = bench.idc(&words, &[]);
        assert!(outcome.code <= 1, "{flags:?}: {}", outcome.err);
        let numbers = &bench.summary()["summary"];
        let number = |name: &str| numbers[name].as_f64().unwrap();
        let (mean, desired) = (number("force_mean_n"), number("desired_force_n"));
        assert!((mean / desired - 1.0).abs() < 0.1, "{flags:?}: {mean} N");
        assert!(number("joint_torque_share_percent") < 100.0, "{flags:?}");
        kinds.push(remedy["kind"].as_str().unwrap().to_owned());
    }
    kinds
}

#[track_caller]
fn check(edits: &[(&str, &str)], expected: &[&str]) {
    let kinds = remedies_of(edits);
    for kind in expected {
        assert!(kinds.iter().any(|own| own == kind), "{kind} in {kinds:?}");
    }
}

#[test]
fn a_part_out_of_reach_is_moved_and_a_wall_where_it_would_go_is_not_entered() {
    check(&[("[750, 0, 200]", "[1750, 0, 200]")], &["part moved"]);
    // Where the shortest way leads a block stands.
    let block = "[[obstacle]]\nname = \"block\"\nbox_mm = [300, 400, 300]\nposition_mm = [1300, 0, 200]\n\n[expect]";
    check(
        &[("[750, 0, 200]", "[1750, 0, 200]"), ("[expect]", block)],
        &["part moved"],
    );
}

#[test]
fn a_part_inside_an_obstacle_is_refused_and_moved_out() {
    let block = "[[obstacle]]\nname = \"clamp\"\nbox_mm = [60, 60, 60]\nposition_mm = [800, 60, 190]\n\n[expect]";
    let bench = Bench::new("plate_edge_ideal");
    bench.replace("scenario.toml", "[expect]", block);
    let outcome = bench.idc(&["check", "scenario.toml", "--effort", "0"], &[]);
    let line = outcome.only_line("error: ");
    assert!(line.contains("clamp") && line.contains("part"), "{line}");
    assert!(line.contains("mm deep in"), "{line}");
    // What may meet by the scenario does.
    let allowed = format!("[collision]\nallowed_pairs = [[\"part\", \"clamp\"]]\n\n{block}");
    bench.replace("scenario.toml", block, &allowed);
    let outcome = bench.idc(&["check", "scenario.toml", "--effort", "0"], &[]);
    assert!(!outcome.err.contains("deep in clamp"), "{}", outcome.err);
}

#[test]
fn numbers_that_cannot_be_are_given_as_ones_that_can() {
    check(&[("force_n = 150", "force_n = 1500")], &["force"]);
    let weak = "[device.override]\nsupply_pressure_bar_gauge = 0.5\n[workpiece]";
    check(&[("[workpiece]", weak)], &["force", "supply pressure"]);
    let heavy = "[device.override]\nmoving_mass_kg = 30\n[workpiece]";
    check(&[("[workpiece]", heavy)], &["moving mass"]);
    let slow = "[[arm.limit_overrides]]\njoint = \"wrist_1\"\nvelocity_deg_per_s = 2\n[device]";
    check(&[("[device]", slow)], &["feed"]);
}

#[test]
fn a_lean_that_was_not_needed_and_an_edge_that_does_not_exist() {
    check(
        &[("[workpiece.edge]\nedge = 1", "[workpiece.edge]\nedge = 40")],
        &["another edge"],
    );
    check(
        &[("end_mm = 290", "end_mm = 310")],
        &["another stretch of the edge"],
    );
}

#[test]
fn a_shift_beyond_the_stroke_is_refused_with_another_stroke() {
    let shifted = "[workpiece.misplacement]\nshift_mm = 12\n\n[process]\nworking_stroke_mm = 10";
    check(
        &[("[process]", shifted)],
        &["working stroke", "part located"],
    );
    // Just within it is done.
    let bench = Bench::new("plate_edge_ideal");
    bench.replace(
        "scenario.toml",
        "[process]",
        &shifted.replace("= 12", "= 9"),
    );
    assert_eq!(
        bench.idc(&["check", "scenario.toml", "--quiet"], &[]).code,
        0
    );
}

#[test]
fn without_effort_nothing_is_looked_for_and_what_is_well_has_no_remedy() {
    let bench = Bench::new("plate_edge_ideal");
    let fine = bench.idc(&["check", "scenario.toml", "--json"], &[]);
    assert_eq!((fine.code, fine.err.as_str()), (0, ""));
    bench.replace("scenario.toml", "force_n = 150", "force_n = 1500");
    let error = refusal(&bench.idc(&["check", "scenario.toml", "--json", "--effort", "0"], &[]));
    assert_eq!(error["remedies"], Value::Null);
    let outcome = bench.idc(&["check", "scenario.toml", "--effort=-1"], &[]);
    assert!(
        outcome.err.contains("expected a number from 0 to 1000"),
        "{}",
        outcome.err
    );
}

/// A block with a bore of a radius [mm] through it: text STL.
fn bored_block(radius: f64) -> String {
    const STEPS: usize = 48;
    let turn = |step: usize| std::f64::consts::TAU * (step % STEPS) as f64 / STEPS as f64;
    let (half, height) = (30.0, 20.0);
    let bore = |step: usize, z: f64| [radius * turn(step).cos(), radius * turn(step).sin(), z];
    let rim = |step: usize, z: f64| {
        let (sin, cos) = turn(step).sin_cos();
        let scale = half / sin.abs().max(cos.abs());
        [scale * cos, scale * sin, z]
    };
    let mut triangles: Vec<[[f64; 3]; 3]> = Vec::new();
    for step in 0..STEPS {
        let next = step + 1;
        let mut quad = |a: [f64; 3], b: [f64; 3], c: [f64; 3], d: [f64; 3]| {
            triangles.extend([[a, b, c], [a, c, d]]);
        };
        quad(
            bore(step, height),
            rim(step, height),
            rim(next, height),
            bore(next, height),
        );
        quad(
            bore(next, 0.0),
            rim(next, 0.0),
            rim(step, 0.0),
            bore(step, 0.0),
        );
        quad(
            rim(step, 0.0),
            rim(next, 0.0),
            rim(next, height),
            rim(step, height),
        );
        quad(
            bore(next, 0.0),
            bore(step, 0.0),
            bore(step, height),
            bore(next, height),
        );
    }
    let mut text = "solid block\n".to_owned();
    for corners in triangles {
        text += "facet normal 0 0 0\nouter loop\n";
        for [x, y, z] in corners {
            text += &format!("vertex {x} {y} {z}\n");
        }
        text += "endloop\nendfacet\n";
    }
    text + "endsolid block\n"
}

#[test]
fn a_ball_too_large_for_a_bore_is_refused_with_the_largest_that_can() {
    let bench = Bench::new("plate_edge_ideal");
    bench.write("part.stl", bored_block(2.2));
    // The bore's rim on top is the closed edge of its circumference.
    let listed = bench.idc(&["edges", "part.stl", "--json"], &[]);
    let list: Value = serde_json::from_str(&listed.out).unwrap();
    let rim = list["edges"].as_array().unwrap().iter().position(|edge| {
        let high = edge["start_mm"][2].as_f64().unwrap() > 19.0;
        high && edge["closed"] == true && edge["convexity"] == "convex"
    });
    let edge = format!("edge = {}", rim.unwrap());
    let text = std::fs::read_to_string(bench.path("scenario.toml")).unwrap();
    let kept = text
        .lines()
        .filter(|line| !line.starts_with("start_mm") && !line.starts_with("end_mm"));
    let lines: Vec<&str> = kept
        .map(|line| {
            if line.starts_with("edge = ") {
                edge.as_str()
            } else {
                line
            }
        })
        .collect();
    bench.write("scenario.toml", lines.join("\n"));
    let outcome = bench.idc(&["check", "scenario.toml", "--effort", "0"], &[]);
    let line = outcome.only_line("error: ");
    // A ball at 45 deg in a round bore: its radius at most the bore's times the root of two.
    let words = "tool_ball_radius_mm` is 5: the ball cannot follow the edge";
    assert!(line.contains(words), "{line}");
    let at_most = line.split("expected at most ").nth(1).unwrap();
    let radius: f64 = at_most.split(',').next().unwrap().parse().unwrap();
    assert!(
        (radius / (2.2 * 2f64.sqrt()) - 1.0).abs() < 0.04,
        "{radius}"
    );
    // That ball can, one a little larger cannot.
    for (share, can) in [(1.0, true), (1.04, false)] {
        let override_table = format!(
            "[device.override]\ntool_ball_radius_mm = {}\n[workpiece]",
            share * radius
        );
        let own = Bench::new("plate_edge_ideal");
        own.write("part.stl", bored_block(2.2));
        own.write(
            "scenario.toml",
            lines.join("\n").replacen("[workpiece]", &override_table, 1),
        );
        let outcome = own.idc(&["check", "scenario.toml", "--effort", "0"], &[]);
        assert_eq!(
            !outcome.err.contains("cannot follow the edge"),
            can,
            "{share}: {}",
            outcome.err
        );
    }
}

#[test]
fn a_part_of_one_s_own_is_put_where_its_longest_edge_is_ridden_and_runs() {
    let bench = Bench::new("plate_edge_ideal");
    bench.write("block.stl", bored_block(9.0));
    let words = [
        "new",
        "cell",
        "own/cell.toml",
        "--part",
        "block.stl",
        "--json",
    ];
    let outcome = bench.idc(&words, &[]);
    assert_eq!(outcome.code, 0, "{}", outcome.err);
    let reported: Value = serde_json::from_str(&outcome.out).unwrap();
    assert!(
        reported["chosen"].as_str().unwrap().starts_with("edge "),
        "{reported}"
    );
    let words = [
        "run",
        "own/cell.toml",
        "--out",
        "out",
        "--no-recording",
        "--quiet",
    ];
    let outcome = bench.idc(&words, &[]);
    assert_eq!(outcome.code, 0, "{}", outcome.err);
    // Its longest edges are those of the block's sides, and the whole of one is ridden.
    let length = bench.summary()["summary"]["path_length_mm"]
        .as_f64()
        .unwrap();
    assert!((length - 60.0).abs() < 1.0, "{length}");
}
