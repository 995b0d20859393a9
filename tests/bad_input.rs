//! Bad input is refused with one line that a user can act on: exit code 2, and nothing is written.

mod bench;

use crate::program::{Bench, FILES};

/// A way to spoil the nominal job, and what the program must say about it.
struct Refusal {
    spoil: fn(&Bench),
    says: &'static [&'static str],
}

const fn refusal(spoil: fn(&Bench), says: &'static [&'static str]) -> Refusal {
    Refusal { spoil, says }
}

/// Spoils a key of the scenario file.
fn edit(bench: &Bench, from: &str, to: &str) {
    bench.replace("scenario.toml", from, to);
}

fn check(refusals: &[Refusal]) {
    check_of("plate_edge_ideal", refusals);
}

fn check_of(scenario: &str, refusals: &[Refusal]) {
    for refusal in refusals {
        let bench = Bench::new(scenario);
        (refusal.spoil)(&bench);
        let before = bench.contents();
        let outcome = bench.run();
        let line = outcome.only_line("error: ");
        for words in refusal.says {
            assert!(line.contains(words), "{line}\nlacks {words:?}");
        }
        assert_eq!(outcome.code, 2, "{line}");
        assert_eq!(outcome.sentences(), line, "more than the one line");
        assert_eq!(outcome.out, "", "{line}");
        assert!(before == bench.contents(), "files changed: {line}");
    }
}

#[test]
fn the_job_that_the_refusals_spoil_is_done() {
    let bench = Bench::new("plate_edge_ideal");
    let outcome = bench.run();
    assert_eq!(outcome.code, 0, "{}", outcome.err);
    assert_eq!(bench.names_in("out"), FILES);
    assert!(
        outcome.out.contains("Plate edge, ideal device"),
        "{}",
        outcome.out
    );
}

#[test]
fn scenario_files() {
    check(&[
        refusal(
            |b| std::fs::remove_file(b.path("scenario.toml")).unwrap(),
            &["there is no file scenario.toml"],
        ),
        refusal(
            |b| b.write("scenario.toml", [0xff, 0xfe]),
            &["cannot read scenario.toml", "UTF-8"],
        ),
        refusal(
            |b| edit(b, "force_n = 150", "force_n = = 150"),
            &["scenario.toml:28:11: not valid TOML"],
        ),
        refusal(
            |b| b.write("scenario.toml", ""),
            &["scenario.toml", "`schema` is missing"],
        ),
        refusal(
            |b| edit(b, "schema = 2", "schema = 3"),
            &["scenario.toml:4:10: schema is 3, expected 1 to 2"],
        ),
        refusal(
            |b| edit(b, "force_n", "froce_n"),
            &["scenario.toml:28:1: unknown key `process.froce_n`; did you mean `force_n`?"],
        ),
        refusal(
            |b| edit(b, "force_n = 150", "force_kn = 0.15"),
            &["scenario.toml:28:1: unknown key `process.force_kn`; the key is `force_n`, in N"],
        ),
        refusal(
            |b| edit(b, "force_n = 150", "force_n = -150"),
            &["scenario.toml:28:1: `process.force_n` is -150 N, expected 0.1 to 5000 N"],
        ),
        refusal(
            |b| edit(b, "force_n = 150", "force_n = nan"),
            &["`process.force_n` is NaN N, expected 0.1 to 5000 N"],
        ),
        refusal(
            |b| edit(b, "force_n = 150\n", ""),
            &["scenario.toml:27:1: `process.force_n` is missing", "in N"],
        ),
        refusal(
            |b| b.replace("device.toml", "bore_mm = 32", "bore_mm = 320"),
            &[
                "device.toml:",
                "`device.bore_mm` is 320 mm, expected 2 to 300 mm",
            ],
        ),
        refusal(
            |b| {
                edit(
                    b,
                    "flange_link = \"flange\"",
                    "flange_link = \"flange\"\nseed_posture_deg = [0, 0]",
                );
            },
            &["scenario.toml: `arm.seed_posture_deg` is a list of 2, expected a list of 6"],
        ),
        refusal(
            |b| edit(b, "[expect]", "[expect]\nforce_mean = { max = 3 }"),
            &[
                "scenario.toml: [expect] names `force_mean`",
                "nearest is `force_mean_n`",
            ],
        ),
    ]);
}

#[test]
fn robot_files() {
    const ELBOW: &str = "<joint name=\"elbow\" type=\"revolute\">";
    check(&[
        refusal(
            |b| edit(b, "arm.urdf", "nowhere.urdf"),
            &["scenario.toml:8:1: `arm.urdf` is \"nowhere.urdf\", expected an existing file"],
        ),
        refusal(
            |b| b.write("arm.urdf", "a robot"),
            &["arm.urdf: not a valid URDF file: it has no <robot>"],
        ),
        refusal(
            |b| b.replace("arm.urdf", "</robot>", ""),
            &["arm.urdf", "cut off before </robot>"],
        ),
        refusal(
            |b| b.replace("arm.urdf", "effort=\"150\"", "effort=\"150"),
            &[
                "arm.urdf:11",
                "not a valid URDF file",
                "joint `elbow` (begun on line 106)",
            ],
        ),
        refusal(
            |b| {
                b.replace(
                    "arm.urdf",
                    ELBOW,
                    &format!("{ELBOW}<mimic joint=\"shoulder_pan\"/>"),
                );
            },
            &["arm.urdf:106: joint `elbow`", "mimics joint `shoulder_pan`"],
        ),
        refusal(
            |b| b.replace("arm.urdf", ELBOW, "<joint name=\"elbow\" type=\"planar\">"),
            &[
                "arm.urdf:106: joint `elbow` is planar; expected revolute, continuous, prismatic or fixed",
            ],
        ),
        refusal(
            |b| b.replace("arm.urdf", "effort=\"150\"", ""),
            &["arm.urdf:106: joint `elbow` has effort limit 0; expected a positive number"],
        ),
        refusal(
            |b| edit(b, "\"flange\"", "\"tool0\""),
            &[
                "arm.urdf: there is no link `tool0`",
                "the links are base_link, flange",
            ],
        ),
        refusal(
            |b| {
                edit(
                    b,
                    "[device]",
                    "[[arm.limit_overrides]]\njoint = \"elbo\"\neffort_n_m = 30\n[device]",
                );
            },
            &["limit override names joint `elbo`"],
        ),
    ]);
}

#[test]
fn meshes() {
    /// The nominal part, a binary STL of 12 triangles, cut or altered.
    fn part(b: &Bench, change: fn(&mut Vec<u8>)) {
        let mut bytes = std::fs::read(b.path("part.stl")).unwrap();
        assert_eq!(bytes.len(), 84 + 12 * 50);
        change(&mut bytes);
        b.write("part.stl", bytes);
    }
    check(&[
        refusal(
            |b| edit(b, "part.stl", "nowhere.stl"),
            &["scenario.toml:17:1: `workpiece.mesh` is \"nowhere.stl\", expected an existing file"],
        ),
        refusal(
            |b| part(b, |bytes| bytes.truncate(400)),
            &["part.stl: malformed mesh", "12 triangles", "316 bytes"],
        ),
        refusal(
            // The two triangles of the last side are left out.
            |b| {
                part(b, |bytes| {
                    bytes.truncate(84 + 10 * 50);
                    bytes[80] = 10;
                });
            },
            &[
                "part.stl: mesh is not a closed surface: 4 open edges",
                "expected 0 of each",
                "open at (",
                "--out PAGE.html",
            ],
        ),
        refusal(
            |b| edit(b, "mesh_unit = \"mm\"", "mesh_unit = \"m\""),
            &[
                "part.stl: mesh is 300 m long",
                "expected 0.001 m to 10 m",
                "mesh_unit",
            ],
        ),
    ]);
}

#[test]
fn obstacles() {
    /// An obstacle that is a mesh of these triangles [mm], far from all else.
    fn mesh(b: &Bench, triangles: &[[[u32; 3]; 3]]) {
        let corner = |[x, y, z]: [u32; 3]| format!("vertex {x} {y} {z}\n");
        let facet = |corners: &[[u32; 3]; 3]| {
            let corners: String = corners.iter().copied().map(corner).collect();
            format!("facet normal 0 0 0\nouter loop\n{corners}endloop\nendfacet\n")
        };
        let facets: String = triangles.iter().map(facet).collect();
        b.write(
            "thing.stl",
            format!("solid thing\n{facets}endsolid thing\n"),
        );
        obstacle(b, "mesh = \"thing.stl\"\nmesh_unit = \"mm\"");
    }
    fn obstacle(b: &Bench, keys: &str) {
        let keys = format!("[[obstacle]]\nposition_mm = [-900, 900, 50]\n{keys}\n[process]");
        edit(b, "[process]", &keys);
    }
    const A: [u32; 3] = [0, 0, 0];
    const B: [u32; 3] = [100, 0, 0];
    const C: [u32; 3] = [0, 100, 0];
    const D: [u32; 3] = [100, 100, 0];
    const TOP: [u32; 3] = [30, 30, 50];
    check(&[
        refusal(
            // A tetrahedron whose corners lie in a plane: closed, but without a volume.
            |b| mesh(b, &[[A, C, B], [B, C, D], [A, B, D], [A, D, C]]),
            &["thing.stl: mesh is flat: its enclosed volume is 0e0 m3, expected positive"],
        ),
        refusal(
            |b| mesh(b, &[[A, C, B], [A, B, TOP], [B, C, TOP]]),
            &["thing.stl: mesh is not a closed surface: 3 open edges"],
        ),
        refusal(
            |b| obstacle(b, "name = \"post\""),
            &[
                "scenario.toml",
                "`obstacle[0].box_mm` is missing",
                "box_mm = [x, y, z], or mesh",
            ],
        ),
        refusal(
            |b| obstacle(b, "box_mm = [100, 0, 100]"),
            &["`obstacle[0].box_mm[1]` is 0 mm, expected 0.01 to 100000 mm"],
        ),
    ]);
    // The same tetrahedron, not flat, stands where it is in nobody's way.
    let bench = Bench::new("plate_edge_ideal");
    mesh(&bench, &[[A, C, B], [A, B, TOP], [B, C, TOP], [C, A, TOP]]);
    let outcome = bench.idc(&["check", "scenario.toml"], &[]);
    assert_eq!(outcome.code, 0, "{}", outcome.err);
    // Wound inwards it is turned, and that is reported.
    let bench = Bench::new("plate_edge_ideal");
    mesh(&bench, &[[A, B, C], [A, TOP, B], [B, TOP, C], [C, TOP, A]]);
    let outcome = bench.idc(&["check", "scenario.toml"], &[]);
    assert_eq!(outcome.code, 0, "{}", outcome.err);
    let reported = "thing.stl: mended: 4 faces, all wound inwards turned, at (";
    assert!(outcome.words().contains(reported), "{}", outcome.out);
}

#[test]
fn collision_shapes_of_a_robot() {
    fn given(b: &Bench, link: &str, shape: &str) {
        let link = format!("<link name=\"{link}\">");
        let own = format!("{link}<collision><geometry>{shape}</geometry></collision>");
        b.replace("arm.urdf", &link, &own);
    }
    check(&[refusal(
        // Three joints lie between them.
        |b| given(b, "wrist_2_link", "<sphere radius=\"1.0\"/>"),
        &[
            "scenario.toml: with all joints at zero",
            "upper_arm and wrist_2_link reach ",
            "collision.allowed_pairs = [[\"upper_arm\", \"wrist_2_link\"]]",
        ],
    )]);
    // Meshes that are not there: what is drawn of the links counts in their place, and it is said once.
    let bench = Bench::new("plate_edge_ideal");
    for link in ["shoulder", "forearm"] {
        given(&bench, link, "<mesh filename=\"none.stl\"/>");
    }
    let outcome = bench.run();
    assert_eq!(outcome.code, 0, "{}", outcome.err);
    let reported = |file: &str| outcome.err.matches(file).count();
    assert_eq!(
        reported("there is no file ./none.stl"),
        1,
        "{}",
        outcome.err
    );
    let said = "links with collision meshes that cannot be used have the shape that is drawn of them: shoulder, forearm";
    assert_eq!(reported(said), 1, "{}", outcome.err);
    let as_drawn = std::fs::read(bench.path("out/samples.parquet")).unwrap();
    let bench = Bench::new("plate_edge_ideal");
    assert_eq!(bench.run().code, 0);
    assert!(as_drawn == std::fs::read(bench.path("out/samples.parquet")).unwrap());
}

#[test]
fn edges_and_burrs() {
    fn burr_table(b: &Bench, rows: &str) {
        edit(
            b,
            "[process]",
            "[workpiece.burr]\nkind = \"table\"\npath = \"burr.csv\"\n[process]",
        );
        b.write("burr.csv", format!("position_mm,height_mm\n{rows}"));
    }
    check(&[
        refusal(
            |b| edit(b, "edge = 1 ", "edge = 99 "),
            &[
                "scenario.toml: `workpiece.edge` is edge 99",
                "edges 0 to 11",
                "`idc edges part.stl`",
            ],
        ),
        refusal(
            |b| edit(b, "end_mm = 290", "end_mm = 390"),
            &[
                "scenario.toml: `workpiece.edge.end_mm` is 390 mm, expected at most the edge's length, 300 mm",
            ],
        ),
        refusal(
            |b| edit(b, "start_mm = 10\nend_mm = 290", "start_mm = 310"),
            &[
                "scenario.toml: `workpiece.edge.start_mm` is 310 mm, expected less than the edge's length, 300 mm",
            ],
        ),
        refusal(
            |b| burr_table(b, "0,0.1\n10,x\n"),
            &["`workpiece.burr`: burr.csv, line 3: height_mm is 'x'"],
        ),
        refusal(
            |b| burr_table(b, "0,0.1\n9,1,1\n"),
            &["burr.csv, line 3: 3 fields, expected 2"],
        ),
        refusal(
            |b| burr_table(b, "0,0.1\n300,-1\n"),
            &["burr.csv, line 3: height_mm is -1, expected 0 or more"],
        ),
        refusal(
            |b| burr_table(b, "0,0.1\n100,0.1\n"),
            &[
                "scenario.toml: `workpiece.burr`",
                "0.000 mm to 100.000 mm",
                "0 mm to 280.000 mm",
            ],
        ),
        refusal(
            |b| {
                let keys = "kind = \"bump\"\nposition_mm = 400\nheight_mm = 1\nwidth_mm = 5";
                edit(
                    b,
                    "[process]",
                    &format!("[workpiece.burr]\n{keys}\n[process]"),
                );
            },
            &[
                "scenario.toml: `workpiece.burr`",
                "397.500 mm to 402.500 mm",
                "0 mm to 280.000 mm",
            ],
        ),
    ]);
}

#[test]
fn paths_and_forces_beyond_the_cell() {
    fn limit(b: &Bench, limit: &str) {
        edit(
            b,
            "[device]",
            &format!("[[arm.limit_overrides]]\njoint = \"elbow\"\n{limit}\n[device]"),
        );
    }
    check(&[
        refusal(
            |b| edit(b, "[750, 0, 200]", "[3750, 0, 200]"),
            &[
                "scenario.toml: approach, waypoint 1 of",
                "(3750.0, 140.0, 200.0) mm",
                "out of reach by",
                "it can be done with the part moved by (",
                "workpiece.position_mm = [",
            ],
        ),
        refusal(
            // The wrist's first and last axes in line all along the edge.
            |b| {
                edit(b, "[750, 0, 200]", "[600, 470, 350]");
                edit(b, "[0, 0, -90]", "[45, 0, 0]");
                edit(
                    b,
                    "[device]",
                    "seed_posture_deg = [180, -60, 90, -30, 175, 0]\n[device]",
                );
            },
            &[
                "scenario.toml: ",
                "waypoint ",
                "all but singular",
                "least accepted 0.015",
                "axis wrist_3 would move most",
            ],
        ),
        refusal(
            |b| limit(b, "velocity_deg_per_s = 1"),
            &[
                "scenario.toml: approach, waypoint ",
                "axis elbow would need ",
                "deg/s, its limit is 1.00 deg/s",
            ],
        ),
        refusal(
            |b| limit(b, "effort_n_m = 30"),
            &[
                "scenario.toml: ",
                "waypoint ",
                "axis elbow would need ",
                "N m, its limit is 30.00 N m",
            ],
        ),
        refusal(
            |b| edit(b, "force_n = 150", "force_n = 2000"),
            &[
                "scenario.toml: `process.force_n` is 2000 N",
                "12.26 bar gauge",
                "expected 27.7 to 992.8 N",
            ],
        ),
        refusal(
            // Less than the part of the tool's weight that presses.
            |b| edit(b, "force_n = 150", "force_n = 5"),
            &[
                "scenario.toml: `process.force_n` is 5 N",
                "alone presses with 27.7 N",
                "device.override.moving_mass_kg at most 0.72 (now 4)",
                "opposing_pressure_bar_gauge at least 0.17 of a second regulator",
            ],
        ),
    ]);
}

#[test]
fn controllers_of_a_cell() {
    fn controller(b: &Bench, lines: &str) {
        edit(b, "[expect]", &format!("[controller]\n{lines}\n[expect]"));
    }
    check(&[
        refusal(
            |b| controller(b, "kind = \"bang_bang\""),
            &[
                "scenario.toml:32:8: `controller.kind` is \"bang_bang\", expected one of `open_loop`",
            ],
        ),
        refusal(
            |b| {
                controller(
                    b,
                    "kind = \"proportional_integral\"\nproportional_gain = 60",
                );
            },
            &[
                "scenario.toml:33:1: `controller.proportional_gain` is 60, with which the loop is unstable",
                "it turns by 180 degrees with a gain of ",
                "expected at most ",
                " with integral_gain_per_s at most ",
            ],
        ),
        refusal(
            |b| {
                controller(
                    b,
                    "kind = \"proportional_integral\"\nproportional_gain = -1",
                );
            },
            &["scenario.toml:33:1: `controller.proportional_gain` is -1, expected 0 to 1000"],
        ),
        refusal(
            |b| controller(b, "rate_per_s = 100"),
            &[
                "scenario.toml:32:1: `controller.rate_per_s` cannot stand here: kind = \"open_loop\" has period_ms",
            ],
        ),
        refusal(
            |b| {
                controller(
                    b,
                    "kind = \"disturbance_prediction\"\ntracking_frequency_rad_per_s = 4000",
                );
            },
            &[
                "scenario.toml:33:1: `controller.tracking_frequency_rad_per_s` is 4000 rad/s, expected less than 3141.6 rad/s",
            ],
        ),
        refusal(
            // 1 of 8 V.
            |b| {
                edit(
                    b,
                    "[expect]",
                    "[sensing.command]\nkind = \"real\"\npwm_high_v = 0.625\n[expect]",
                );
            },
            &[
                "scenario.toml: `process.force_n` is 150 N, which needs 0.76 bar gauge",
                "[sensing.command] can set 0 to 0.75 bar, expected 27.7 to 148.",
            ],
        ),
    ]);
}

#[test]
fn controllers_of_a_bench() {
    const KIND: &str = "kind = \"disturbance_prediction\"";
    check_of(
        "moving_surface",
        &[
            refusal(
                |b| edit(b, KIND, "kind = \"fuzzy\""),
                &[
                    "scenario.toml:33:8: `controller.kind` is \"fuzzy\", expected one of `open_loop`",
                ],
            ),
            refusal(
                |b| edit(b, KIND, &format!("{KIND}\nresponse_time_s = 0.0001")),
                &[
                    "scenario.toml:34:1: `controller.response_time_s` is 0.0001 s, with which the loop is unstable",
                    "if the regulator's time constant is 20 % off",
                    "expected at least 0.00",
                ],
            ),
            refusal(
                |b| {
                    edit(
                        b,
                        KIND,
                        "kind = \"feedback_linearisation\"\nintegral_gain_per_s = 900",
                    );
                },
                &[
                    "scenario.toml:34:1: `controller.integral_gain_per_s` is 900 1/s, with which the loop is unstable",
                    "expected at most ",
                ],
            ),
            refusal(
                |b| edit(b, KIND, &format!("{KIND}\nobserver_time_s = -1")),
                &[
                    "scenario.toml:34:1: `controller.observer_time_s` is -1 s, expected 0.00001 to 100 s",
                ],
            ),
            refusal(
                |b| edit(b, KIND, &format!("{KIND}\nproportional_gain = 1")),
                &[
                    "scenario.toml:34:1: `controller.proportional_gain` cannot stand here: kind = \"disturbance_prediction\" has",
                ],
            ),
            refusal(
                |b| edit(b, "force_n = 150", "force_n = 1000"),
                &[
                    "scenario.toml:27:1: `command[0].force_n` is 1000 N, which needs 6.22 bar gauge at the regulator; the supply gives 0 to 6.00 bar",
                    "expected 0.0 to 965.1 N",
                ],
            ),
            refusal(
                |b| {
                    edit(b, "force_n = 150", "set_pressure_bar_gauge = 6.5");
                    edit(
                        b,
                        "preset = \"white\"",
                        "preset = \"white\"\n[sensing.command]\nkind = \"real\"",
                    );
                },
                &[
                    "scenario.toml:27:1: `command[0].set_pressure_bar_gauge` is 6.5 bar gauge, 8.667 V at the regulator",
                    "the 0 to 8 V that [sensing.command] can give",
                ],
            ),
            refusal(
                |b| edit(b, "force_n = 150", "set_pressure_bar_gauge = 1"),
                &[
                    "scenario.toml:33:1: `controller.kind` cannot stand here: no [[command]] gives a force",
                ],
            ),
        ],
    );
}

#[test]
fn output_folders_that_cannot_be_written() {
    check(&[
        refusal(
            |b| b.write("out", "in the way"),
            &["output folder out: there is a file of that name", "--out"],
        ),
        refusal(
            |b| std::fs::create_dir_all(b.path("out/recording.rrd")).unwrap(),
            &["output folder out: recording.rrd in it is a folder"],
        ),
    ]);
}

#[test]
fn a_refused_run_leaves_the_files_of_the_last_one() {
    let bench = Bench::new("plate_edge_ideal");
    assert_eq!(bench.run().code, 0);
    edit(&bench, "force_n = 150", "force_n = 2000");
    let before = bench.contents();
    assert_eq!(bench.run().code, 2);
    assert!(before == bench.contents());
}

// Catches: bodies of one name that are noticed only when their picture is written, with the folder begun.
#[test]
fn bodies_of_one_name_get_one_answer_from_check_and_run() {
    for name in ["forearm", "part", "device", "tool"] {
        let bench = Bench::new("plate_edge_ideal");
        let text = std::fs::read_to_string(bench.path("scenario.toml")).unwrap();
        let obstacle = format!(
            "\n[[obstacle]]\nname = \"{name}\"\nbox_mm = [10, 10, 10]\nposition_mm = [-900, 900, 50]\n"
        );
        bench.write("scenario.toml", text + &obstacle);
        let before = bench.contents();
        let check = bench.idc(&["check", "scenario.toml"], &[]);
        let run = bench.idc(&["run", "scenario.toml", "--out", "out"], &[]);
        assert_eq!((check.code, run.code), (2, 2), "{}{}", check.err, run.err);
        let said = check.only_line("error: ");
        assert_eq!(said, run.only_line("error: "));
        let expected = format!("`{name}` is the name of ");
        assert!(
            said.contains(&expected) && said.contains("an obstacle"),
            "{said}"
        );
        assert!(bench.contents() == before, "{name}: files were left");
    }
    // A name's empty parts are no parts of a path in the picture.
    let bench = Bench::new("plate_edge_ideal");
    for file in ["arm.urdf", "scenario.toml"] {
        let text = std::fs::read_to_string(bench.path(file)).unwrap();
        bench.write(file, text.replace("\"forearm\"", "\"fore//arm/\""));
    }
    bench.replace("scenario.toml", "end_mm = 290", "end_mm = 12");
    let outcome = bench.idc(&["run", "scenario.toml", "--out", "out"], &[]);
    assert!(outcome.code < 2, "{}", outcome.err);
}
