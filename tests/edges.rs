//! The page on which an edge is picked, and the drawing of a run: their numbers by other code than that which wrote them.

use std::fs;

use base64::Engine as _;
use idc_cell::recording::parquet::read_parquet;
use serde_json::Value;

use crate::common::{project, shared};
use crate::program::Bench;

/// Data of the drawing in a page.
fn drawn(page: &str) -> Value {
    let (_, place) = page.split_once("<div class=\"space\">").unwrap();
    let (_, data) = place
        .split_once("<script type=\"application/json\">")
        .unwrap();
    serde_json::from_str(data.split_once("</script>").unwrap().0).unwrap()
}

fn floats(text: &Value) -> Vec<f64> {
    let bytes = base64::prelude::BASE64_STANDARD.decode(text.as_str().unwrap());
    let bytes = bytes.unwrap();
    let words = bytes.chunks_exact(4);
    words
        .map(|word| f64::from(f32::from_le_bytes(word.try_into().unwrap())))
        .collect()
}

fn length(points: &[f64]) -> f64 {
    let points: Vec<&[f64]> = points.chunks(3).collect();
    let distance = |two: &[&[f64]]| {
        let sides = (0..3).map(|axis| (two[1][axis] - two[0][axis]).powi(2));
        sides.sum::<f64>().sqrt()
    };
    points.windows(2).map(distance).sum()
}

/// An angle bracket, 30 x 20 mm with legs of 10 mm, 40 mm wide, which has one inside edge.
fn angle_bracket() -> String {
    let outline = [
        [0.0, 0.0],
        [30.0, 0.0],
        [30.0, 10.0],
        [10.0, 10.0],
        [10.0, 20.0],
        [0.0, 20.0],
    ];
    let point = |[x, z]: [f64; 2], y: f64| format!("{x} {y} {z}");
    let mut triangles = Vec::new();
    for (at, from) in outline.into_iter().enumerate() {
        let to = outline[(at + 1) % 6];
        let corners = [(from, 0.0), (to, 0.0), (to, 40.0), (from, 40.0)].map(|(p, y)| point(p, y));
        triangles.push([0, 2, 1].map(|i| corners[i].clone()));
        triangles.push([0, 3, 2].map(|i| corners[i].clone()));
    }
    for [a, b, c] in [[0, 1, 2], [0, 2, 3], [0, 3, 4], [0, 4, 5]] {
        triangles.push([a, b, c].map(|i: usize| point(outline[i], 0.0)));
        triangles.push([a, c, b].map(|i: usize| point(outline[i], 40.0)));
    }
    let facet = |[a, b, c]: &[String; 3]| {
        format!(
            "facet normal 0 0 0\nouter loop\nvertex {a}\nvertex {b}\nvertex {c}\nendloop\nendfacet\n"
        )
    };
    let facets: String = triangles.iter().map(facet).collect();
    format!("solid bracket\n{facets}endsolid bracket\n")
}

#[test]
fn the_page_of_a_part_has_the_numbers_of_its_list() {
    let bench = Bench::new("plate_edge_ideal");
    let bracket = project("assets/bracket.stl");
    let bracket = bracket.to_str().unwrap();
    for (mesh, angle, edges) in [(bracket, "60", 8), ("part.stl", "30", 12)] {
        let words = ["edges", mesh, "--sharp-angle-deg", angle];
        let words = [&words[..], &["--out", "new/page.html", "--json", "--force"]].concat();
        let outcome = bench.idc(&words, &[]);
        assert_eq!((outcome.code, outcome.err.as_str()), (0, ""));
        let list: Value = serde_json::from_str(&outcome.out).unwrap();
        let page = fs::read_to_string(bench.path("new/page.html")).unwrap();
        let drawing = drawn(&page);
        let lines = drawing["lines"].as_array().unwrap();
        let curves = ["edges", "loops"].map(|key| list[key].as_array().unwrap().as_slice());
        assert_eq!(curves[0].len(), edges);
        let curves = curves.concat();
        assert_eq!(lines.len(), curves.len());
        for (line, curve) in lines.iter().zip(&curves) {
            let id = curve["id"].as_str().unwrap();
            assert_eq!(line["id"], id);
            let (kind, number) = id.split_once('-').unwrap();
            let reported = curve["length_mm"].as_f64().unwrap();
            let points = floats(&line["points"]);
            // Outlines are drawn within their faces.
            if kind == "edge" {
                assert!((length(&points) / reported - 1.0).abs() < 1e-4, "{id}");
            }
            let fact = |name: &str| {
                let facts = line["facts"].as_array().unwrap();
                let fact = facts.iter().find(|fact| fact[0] == name).unwrap();
                fact[1].as_str().unwrap().to_owned()
            };
            let shown: f64 = fact("length").trim_end_matches(" mm").parse().unwrap();
            assert!(
                (shown - reported).abs() < 6e-4,
                "{id}: {shown} for {reported}"
            );
            // All faces of both parts stand at right angles.
            assert_eq!(fact("angle between the faces"), "90.0°");
            for end in curve["angle_deg"].as_array().unwrap() {
                assert!((end.as_f64().unwrap() - 90.0).abs() < 1e-3, "{id}: {end}");
            }
            let paste = line["lines"].as_str().unwrap();
            assert!(paste.contains(&format!("[workpiece.edge]\n{kind} = {number}\n")));
            assert_eq!(paste.contains("sharp_angle_deg = 60.0"), angle == "60");
            let row = format!("<td>{id}</td>");
            assert!(page.contains(&row), "{row}");
        }
        assert!(page.contains("Content-Security-Policy") && page.contains("default-src 'none'"));
        let again = bench.idc(&words, &[]);
        assert_eq!(again.code, 0);
        assert!(page == fs::read_to_string(bench.path("new/page.html")).unwrap());
    }
}

#[test]
fn an_inside_edge_is_reported_and_has_no_lines_to_paste() {
    let bench = Bench::new("plate_edge_ideal");
    bench.write("bracket.stl", angle_bracket());
    let outcome = bench.idc(&["edges", "bracket.stl", "--out", "page.html"], &[]);
    assert_eq!((outcome.code, outcome.err.as_str()), (0, ""));
    assert!(outcome.out.ends_with("page written to page.html\n"));
    let page = fs::read_to_string(bench.path("page.html")).unwrap();
    let drawing = drawn(&page);
    let lines = drawing["lines"].as_array().unwrap();
    let inside = lines.iter().filter(|line| line["pale"] == true);
    let inside: Vec<_> = inside
        .map(|line| {
            let reported = ["remark", "lines"].map(|key| line[key].as_str().unwrap());
            (line["view"].as_u64().unwrap(), reported)
        })
        .collect();
    let remark = "An inside edge, cannot be ridden.";
    let partly = "An inside edge in a part of it, cannot be ridden.";
    // The edge itself, and the outlines that have it: of the two inner faces.
    assert_eq!(
        inside,
        [(0, [remark, ""]), (1, [partly, ""]), (1, [partly, ""])]
    );
    assert!(page.contains("18 edges and 8 outlines of faces, of which a tool can ride 17 and 6."));
}

/// A convex profile in x and z [mm], 40 mm wide along y, as a text STL's triangles.
fn prism(outline: &[[f64; 2]]) -> Vec<[[f64; 3]; 3]> {
    let at = |[x, z]: [f64; 2], y: f64| [x, y, z];
    let mut triangles = Vec::new();
    for (index, &from) in outline.iter().enumerate() {
        let to = outline[(index + 1) % outline.len()];
        triangles.push([at(from, 0.0), at(to, 40.0), at(to, 0.0)]);
        triangles.push([at(from, 0.0), at(from, 40.0), at(to, 40.0)]);
    }
    for two in outline[1..].windows(2) {
        triangles.push([at(outline[0], 0.0), at(two[0], 0.0), at(two[1], 0.0)]);
        triangles.push([at(outline[0], 40.0), at(two[1], 40.0), at(two[0], 40.0)]);
    }
    triangles
}

fn stl(triangles: &[[[f64; 3]; 3]]) -> String {
    let corner = |[x, y, z]: &[f64; 3]| format!("vertex {x} {y} {z}\n");
    let facet = |corners: &[[f64; 3]; 3]| {
        let corners: String = corners.iter().map(corner).collect();
        format!("facet normal 0 0 0\nouter loop\n{corners}endloop\nendfacet\n")
    };
    let facets: String = triangles.iter().map(facet).collect();
    format!("solid prism\n{facets}endsolid prism\n")
}

/// Corners of 90, 90, 135, 135 and 90 degrees.
const PROFILE: [[f64; 2]; 5] = [
    [0.0, 0.0],
    [40.0, 0.0],
    [40.0, 10.0],
    [30.0, 20.0],
    [0.0, 20.0],
];

#[test]
fn the_angle_between_faces_is_that_of_the_profile_wherever_it_is_shown() {
    let bench = Bench::new("plate_edge_ideal");
    bench.write("prism.stl", stl(&prism(&PROFILE)));
    let words = ["edges", "prism.stl", "--out", "page.html"];
    let table = bench.idc(&words, &[]);
    assert_eq!((table.code, table.err.as_str()), (0, ""));
    let page = fs::read_to_string(bench.path("page.html")).unwrap();
    let drawing = drawn(&page);
    let list = bench.idc(&["edges", "prism.stl", "--json"], &[]);
    let list: Value = serde_json::from_str(&list.out).unwrap();
    let mut seen = 0;
    for edge in list["edges"].as_array().unwrap() {
        let ends = ["start_mm", "end_mm"].map(|key| edge[key].as_array().unwrap().clone());
        let number = |end: usize, axis: usize| ends[end][axis].as_f64().unwrap();
        if (number(0, 1) - number(1, 1)).abs() < 1.0 {
            continue;
        }
        // The angle of the profile at this corner, by its two sides.
        let here = PROFILE
            .iter()
            .position(|[x, z]| (x - number(0, 0)).abs() < 1e-3 && (z - number(0, 2)).abs() < 1e-3);
        let here = here.unwrap();
        let to = |other: usize| {
            let [x, z] = PROFILE[other % 5];
            (z - PROFILE[here][1]).atan2(x - PROFILE[here][0])
        };
        let turned = (to(here + 4) - to(here + 1)).to_degrees();
        let expected = turned.rem_euclid(360.0);
        for end in edge["angle_deg"].as_array().unwrap() {
            assert!((end.as_f64().unwrap() - expected).abs() < 1e-6, "{end}");
        }
        let id = edge["id"].as_str().unwrap();
        let row = table
            .out
            .lines()
            .find(|line| line.split(' ').next() == Some(id));
        assert!(row.unwrap().contains(&format!(" {expected:.1} convex")));
        let lines = drawing["lines"].as_array().unwrap();
        let line = lines.iter().find(|line| line["id"] == id).unwrap();
        assert_eq!(line["facts"][1][1], format!("{expected:.1}°"));
        seen += 1;
    }
    assert_eq!(seen, 5);
}

#[test]
fn small_flaws_are_mended_with_places_and_others_shown_on_the_page() {
    let bench = Bench::new("plate_edge_ideal");
    let sound = prism(&PROFILE);
    let mut turned = sound.clone();
    turned[2].swap(0, 1);
    bench.write("turned.stl", stl(&turned));
    let outcome = bench.idc(&["edges", "turned.stl"], &[]);
    assert_eq!((outcome.code, outcome.err.as_str()), (0, ""));
    let reported = "note: mended: 1 face wound against its neighbours turned, at (40, ";
    assert!(outcome.out.contains(reported), "{}", outcome.out);
    // Without the side at x = 40 mm.
    let open: Vec<_> = sound
        .iter()
        .copied()
        .filter(|t| t.iter().any(|c| c[0] < 40.0))
        .collect();
    bench.write("open.stl", stl(&open));
    let outcome = bench.idc(&["edges", "open.stl", "--out", "faults.html"], &[]);
    assert_eq!(outcome.code, 2);
    assert!(
        outcome.err.contains("open.stl") && outcome.err.contains("4 open edges"),
        "{}",
        outcome.err
    );
    assert!(outcome.err.contains("open at (40, "), "{}", outcome.err);
    let drawing = drawn(&fs::read_to_string(bench.path("faults.html")).unwrap());
    let lines = drawing["lines"].as_array().unwrap();
    assert_eq!(lines.len(), 4);
    for line in lines {
        let points = floats(&line["points"]);
        assert!((points[0] - 40.0).abs() < 1e-3 && (points[3] - 40.0).abs() < 1e-3);
        assert_eq!(line["facts"][0][1], "open");
    }
    let none = bench.idc(&["edges", "open.stl", "--json"], &[]);
    assert_eq!((none.code, none.out.as_str()), (2, ""));
}

#[test]
fn mesh_files_that_people_have_are_read_as_their_formats_have_them() {
    let Some(found) = shared("found") else {
        return;
    };
    // Lowest and highest corners [mm], volume [mm3], by hand from the files' transforms.
    let box_of = |low: [f64; 3], high: [f64; 3]| {
        let sizes = (0..3).map(|axis| high[axis] - low[axis]);
        (low, high, sizes.product::<f64>())
    };
    let (cube, plate) = ([-60.0, -60.0, 0.0], [100.0, 40.0, 10.0]);
    let on = |up: f64| box_of([-60.0, -60.0, up], [60.0, 60.0, up + 60.0]);
    let unit = |name: &'static str| (name, "m", box_of(cube, [60.0, 60.0, 60.0]));
    let text = |name: &'static str| (name, "mm", box_of([0.0; 3], plate));
    let arrow = 1100.0 * 10.0;
    for (name, unit, (low, high, volume)) in [
        ("urdf/d_libnodes.dae", "m", on(400.0)),
        ("urdf/d_nested.dae", "m", on(400.0)),
        (
            "urdf/d_twice.dae",
            "m",
            (cube, [60.0, 60.0, 560.0], 2.0 * 120.0 * 120.0 * 60.0),
        ),
        (
            "urdf/e_inst2.dae",
            "m",
            ([0.0; 3], [600.0, 700.0, 300.0], 2.0 * 6e6),
        ),
        // (x, y, z) to (x, -z, y), after the shift.
        (
            "urdf/e_two_R_T.dae",
            "m",
            box_of([100.0, -600.0, 200.0], [200.0, -300.0, 400.0]),
        ),
        (
            "urdf/e_two_T_T.dae",
            "m",
            box_of([100.0, 200.0, 0.0], [200.0, 400.0, 300.0]),
        ),
        unit("urdf/u_instnode_unit.dae"),
        unit("urdf/u_mm.dae"),
        unit("urdf/u_no_name.dae"),
        unit("urdf/u_noscene.dae"),
        text("mesh/a_noname.stl"),
        text("mesh/a_upper.stl"),
        text("mesh/a_bom.stl"),
        text("mesh/a_longname.stl"),
        text("mesh/a_nan_ind.stl"),
        ("mesh/mixed_concave.obj", "mm", ([0.0; 3], plate, arrow)),
        // The corner lifted by 15 mm adds a third of that over one of the two triangles, along the shorter diagonal.
        (
            "mesh/nonplanar.obj",
            "mm",
            ([0.0; 3], [100.0, 40.0, 25.0], 4e4 + 1e4),
        ),
    ] {
        let file = found.join(name);
        let scale = if unit == "m" { 1.0 } else { 1e-3 };
        let mesh = idc_cell::workpiece::load_mesh(&file, scale).unwrap();
        let (lowest, highest) = mesh.bounds();
        for axis in 0..3 {
            assert!(
                (1e3 * lowest[axis] - low[axis]).abs() < 1e-3,
                "{name}: {lowest}"
            );
            assert!(
                (1e3 * highest[axis] - high[axis]).abs() < 1e-3,
                "{name}: {highest}"
            );
        }
        assert!(
            (1e9 * mesh.volume() / volume - 1.0).abs() < 1e-5,
            "{name}: {}",
            mesh.volume()
        );
    }
    let pointer = idc_cell::workpiece::load_mesh(&found.join("mesh/lfs.stl"), 1e-3);
    let message = pointer.unwrap_err().to_string();
    assert!(
        message.contains("Git LFS pointer to a file of 123456 bytes"),
        "{message}"
    );
}

#[test]
fn a_page_overwrites_nothing() {
    let bench = Bench::new("plate_edge_ideal");
    let words = ["edges", "part.stl", "--out", "page.html"];
    assert_eq!(bench.idc(&words, &[]).code, 0);
    let before = bench.contents();
    for (words, reported) in [
        (&words[..], "error: page.html is there already"),
        (
            &["edges", "part.stl", "--out", "part.stl", "--force"],
            "error: --out is part.stl, which is read here",
        ),
        (
            &["edges", "nowhere.stl", "--out", "new/page.html"],
            "error: cannot read nowhere.stl",
        ),
    ] {
        let outcome = bench.idc(words, &[]);
        assert_eq!((outcome.code, outcome.out.as_str()), (2, ""), "{words:?}");
        outcome.only_line(reported);
        assert!(before == bench.contents(), "{words:?}");
    }
}

#[test]
fn the_edge_of_a_run_is_drawn_in_the_errors_of_its_recording() {
    let bench = Bench::new("plate_edge_ideal");
    // A force that changes along the edge: a burr.
    let text = fs::read_to_string(bench.path("scenario.toml")).unwrap();
    let burr = "[workpiece.burr]\nkind = \"bump\"\nposition_mm = 140\nheight_mm = 1\nwidth_mm = 40\n\n[process]";
    let text = text.split("[expect]").next().unwrap();
    bench.write("scenario.toml", text.replace("[process]", burr));
    let words = ["run", "scenario.toml", "--out", "out", "--no-recording"];
    let outcome = bench.idc(&words, &[]);
    assert_eq!(outcome.code, 0, "{}", outcome.err);
    let page = fs::read_to_string(bench.path("out/report.html")).unwrap();
    let drawing = drawn(&page);
    let file = fs::read_to_string(bench.path("out/drawing.json")).unwrap();
    assert!(drawing == serde_json::from_str::<Value>(&file).unwrap());
    let line = &drawing["lines"][0];
    let [points, errors] = ["points", "values"].map(|key| floats(&line[key]));
    // 10 to 290 mm of an edge along x of a part that is turned by -90 degrees about z at (750, 0, 200) mm.
    assert!((length(&points) - 280.0).abs() < 1e-2);
    for (found, expected) in points[..3].iter().zip([750.0, 140.0, 200.0]) {
        assert!((found - expected).abs() < 1e-3, "{found}");
    }
    let recording = read_parquet(&bench.path("out/samples.parquet")).unwrap();
    let recording = recording.recording;
    let values = |name: &str| &recording.channel(name).unwrap().values;
    let force = values(idc_cell::recording::schema::CONTACT_FORCE);
    let place = values(idc_cell::recording::schema::PATH_LENGTH);
    let follow = recording.phase("follow").unwrap();
    let mut sums = vec![(0.0, 0.0); errors.len()];
    for (index, time) in recording.time().iter().enumerate() {
        if (follow.start..follow.end).contains(time) && force[index] > 0.0 {
            let segment = (place[index] / 0.280 * errors.len() as f64) as usize;
            let sum = &mut sums[segment.min(errors.len() - 1)];
            *sum = (sum.0 + 100.0 * (force[index] / 150.0 - 1.0), sum.1 + 1.0);
        }
    }
    let mut most: f64 = 0.0;
    for (segment, (error, (sum, count))) in errors.iter().zip(sums).enumerate().skip(1) {
        // A sample at the border of two segments may be of either.
        let expected: f64 = sum / count;
        let off = (error - expected).abs();
        assert!(
            off < 0.05 * expected.abs() + 0.02,
            "{segment}: {error} for {expected}"
        );
        most = most.max(expected.abs());
    }
    assert!(most > 0.2, "the burr moves the force by {most} %");
    // The same page from the files; without the drawing one that has no library for it.
    let words = ["report", "out", "--quiet"];
    assert_eq!(bench.idc(&words, &[]).code, 0);
    assert!(page == fs::read_to_string(bench.path("out/report.html")).unwrap());
    fs::remove_file(bench.path("out/drawing.json")).unwrap();
    assert_eq!(bench.idc(&words, &[]).code, 0);
    let plain = fs::read_to_string(bench.path("out/report.html")).unwrap();
    assert!(plain.contains("class=\"sketches\"") && !plain.contains("class=\"space\""));
    assert!(page.contains("id=\"space-library\"") && !plain.contains("id=\"space-library\""));
    bench.write("out/drawing.json", &file[..file.len() / 2]);
    let outcome = bench.idc(&words, &[]);
    assert_eq!(outcome.code, 2);
    outcome.only_line("error: cannot read out/drawing.json");
}
