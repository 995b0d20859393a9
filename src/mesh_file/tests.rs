//! Files of each format, made here, and what is read of them; the right values by hand.

use super::*;
use glam::{DMat4, DVec3};
use std::fmt::Write as _;

/// A box from the origin of these sizes as corners and triangles.
const SIZE: [f64; 3] = [4.0, 2.0, 1.0];
const TRIANGLES: [[u32; 3]; 12] = [
    [0, 2, 3],
    [0, 3, 1],
    [4, 5, 7],
    [4, 7, 6],
    [0, 1, 5],
    [0, 5, 4],
    [2, 6, 7],
    [2, 7, 3],
    [0, 4, 6],
    [0, 6, 2],
    [1, 3, 7],
    [1, 7, 5],
];

fn corners() -> Vec<DVec3> {
    let at = |index: usize| {
        DVec3::new(
            SIZE[0] * (index & 1) as f64,
            SIZE[1] * (index >> 1 & 1) as f64,
            SIZE[2] * (index >> 2) as f64,
        )
    };
    (0..8).map(at).collect()
}

fn read_as(name: &str, bytes: &[u8]) -> Result<MeshFile, MeshFileError> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(name);
    std::fs::write(&path, bytes).unwrap();
    read(&path)
}

fn parsed(name: &str, text: &str) -> MeshFile {
    read_as(name, text.as_bytes()).unwrap_or_else(|error| panic!("{error}"))
}

fn refusal(name: &str, text: &str) -> String {
    let message = read_as(name, text.as_bytes()).unwrap_err().to_string();
    assert!(message.contains(name), "{message}");
    message
}

/// Signed volume of all parts, and their lowest and highest corner.
fn measured(file: &MeshFile) -> (f64, [DVec3; 2]) {
    let (mut volume, mut ends) = (0.0, [DVec3::INFINITY, DVec3::NEG_INFINITY]);
    for part in &file.parts {
        for triangle in &part.triangles {
            let [a, b, c] = triangle.map(|corner| part.points[corner as usize]);
            volume += a.dot(b.cross(c)) / 6.0;
            ends = [a, b, c]
                .iter()
                .fold(ends, |[low, high], p| [low.min(*p), high.max(*p)]);
        }
    }
    (volume, ends)
}

fn check(file: &MeshFile, volume: f64, low: [f64; 3], high: [f64; 3]) {
    let (found, [lowest, highest]) = measured(file);
    assert!(
        (found / volume - 1.0).abs() < 1e-6,
        "volume {found} for {volume}"
    );
    let scale = highest.distance(lowest);
    assert!(
        lowest.distance(DVec3::from_array(low)) < 1e-6 * scale,
        "{lowest}"
    );
    assert!(
        highest.distance(DVec3::from_array(high)) < 1e-6 * scale,
        "{highest}"
    );
}

fn stl(head: &str, facet: &str, tail: &str) -> String {
    let mut text = head.to_owned();
    let points = corners();
    for triangle in TRIANGLES {
        text += facet;
        for [x, y, z] in triangle.map(|corner| points[corner as usize].to_array()) {
            writeln!(text, "vertex {x} {y:e} {z}").unwrap();
        }
        text += "endloop\nendfacet\n";
    }
    text + tail
}

const FACET: &str = "facet normal 0 0 0\nouter loop\n";

#[test]
fn text_stl_is_read_whatever_is_around_it() {
    let whole = |text: &str| check(&parsed("a.stl", text), 8.0, [0.0; 3], SIZE);
    let long = format!("solid {}\n", "x".repeat(5000));
    for head in [
        "solid\n",
        "solid part\n",
        &long,
        "\u{feff}solid part\n",
        "\n\n  solid part\n",
        "# made by a program\n; really\nsolid part\n",
        "Hello, this is a scanner\n\nsolid a facet of it\n",
        "",
        "solid binary vertex facets\r\n",
    ] {
        whole(&stl(head, FACET, "endsolid\n"));
    }
    for facet in [
        "facet normal -nan(ind) -nan(ind) -nan(ind)\nouter loop\n",
        "facet normal 1.#QNAN 1.#INF -1.#IND\n outer loop\n",
        "facet\nouter loop\n",
        "facet normal a b\nouter loop\n",
    ] {
        whole(&stl("solid a\n", facet, "endsolid a\n"));
    }
    whole(&stl(
        "solid a\n",
        FACET,
        "endsolid a\n\n\u{1a}what else it said\n",
    ));
    whole(&stl("solid a\n", FACET, "endsolid a\n").to_uppercase());
    whole(&stl("solid a\n", FACET, "endsolid a\n").replace('\n', "\r\n"));
    whole(&stl("solid a\n", FACET, "endsolid a\n").replace('\n', "\r"));
    whole(&stl("solid a ", "facet normal 0 0 1 ", "endsolid a").replace('\n', " "));
    let cut = parsed("a.stl", &stl("solid a\n", FACET, ""));
    assert!(cut.notes[0].contains("without `endsolid`"));
    let sixteen: Vec<u8> = [0xff, 0xfe]
        .into_iter()
        .chain(
            stl("solid a\n", FACET, "endsolid\n")
                .encode_utf16()
                .flat_map(u16::to_le_bytes),
        )
        .collect();
    check(&read_as("a.stl", &sixteen).unwrap(), 8.0, [0.0; 3], SIZE);
}

#[test]
fn text_stl_that_is_wrong_is_refused_with_its_line() {
    let text = stl("solid a\n", FACET, "endsolid a\n");
    assert!(
        refusal("a.stl", &text.replacen("vertex 4", "vertex four", 1))
            .contains("line 6: of a vertex `four` is no number")
    );
    assert!(
        refusal("a.stl", &text.replacen("vertex 4", "vertex 4,5", 1)).contains("decimal comma")
    );
    assert!(refusal("a.stl", &text[..text.rfind("endloop").unwrap()]).contains("cut short"));
    assert!(refusal("a.stl", &text.replacen("vertex 0", "", 1)).contains("line"));
    assert!(refusal("a.stl", "words about nothing at all").contains("too few"));
}

fn binary(header: &[u8], count: u32, extra: &[u8]) -> Vec<u8> {
    let mut bytes = header.to_vec();
    bytes.resize(80, 0);
    bytes.extend(count.to_le_bytes());
    let points = corners();
    for triangle in TRIANGLES {
        bytes.extend([0; 12]);
        for value in triangle
            .iter()
            .flat_map(|corner| points[*corner as usize].to_array())
        {
            bytes.extend((value as f32).to_le_bytes());
        }
        bytes.extend([0; 2]);
    }
    bytes.extend(extra);
    bytes
}

#[test]
fn binary_stl_is_detected_by_its_size_and_counts() {
    let whole = |bytes: &[u8]| {
        let file = read_as("a.stl", bytes).unwrap();
        check(&file, 8.0, [0.0; 3], SIZE);
        file.notes.join(" ")
    };
    assert_eq!(whole(&binary(b"", 12, b"")), "");
    assert_eq!(whole(&binary(b"solid of a facet, endsolid", 12, b"")), "");
    assert!(
        whole(&binary(b"solid facet", 12, b"trailing")).contains("8 bytes behind the 12 triangles")
    );
    assert!(whole(&binary(b"", 0, b"")).contains("counts 0 triangles, and 12 follow"));
    assert!(whole(&binary(b"", u32::MAX, b"")).contains("12 follow"));
    let message = read_as("a.stl", &binary(b"", 13, b""))
        .unwrap_err()
        .to_string();
    assert!(message.contains("announces 13 triangles"), "{message}");
}

fn obj(faces: &str) -> String {
    let mut text = "# a box\n".to_owned();
    for [x, y, z] in corners().iter().map(DVec3::to_array) {
        writeln!(text, "v {x} {y} {z} 1.0").unwrap();
    }
    text + "vt 0 0\nvn 0 0 1\n" + faces
}

#[test]
fn obj_faces_of_all_kinds_are_read() {
    let whole = |faces: &str| check(&parsed("a.obj", &obj(faces)), 8.0, [0.0; 3], SIZE);
    let quads = "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n";
    whole(quads);
    whole(&quads.replace('\n', "\r\n"));
    whole(
        &quads
            .replace("1 3 4 2", "1/1 3/1 4/1 2/1")
            .replace("5 6 8 7", "5//1 6//1 8//1 7//1"),
    );
    whole(&quads.replace(
        "f 1 3 4 2",
        "g one\no two\ns off\nf -8/1/1 -6/1/1 \\\n  -5/1/1 -7/1/1 # behind",
    ));
    whole(&quads.replace("1 3 4 2", "1 3 3 4 2"));
    assert!(
        refusal("a.obj", &obj("f 1 2 9\n"))
            .contains("line 12: a face refers to the missing vertex 9")
    );
    assert!(refusal("a.obj", &obj("f 1 2 0\n")).contains("line 12: `0` is no corner"));
    assert!(refusal("a.obj", &obj("f 1 2\n")).contains("line 12: a face of 2 corners"));
    assert!(refusal("a.obj", &obj("f 1 4 3 2\n")).contains("line 12: the sides of a face cross"));
    assert!(
        refusal("a.obj", &obj("f 1 2 3\ncurv 0 1 1 2\n")).contains("line 13: a free-form curve")
    );
    assert!(refusal("a.obj", "v 1,5 0 0\n").contains("decimal comma"));
}

#[test]
fn concave_obj_faces_are_split_within_their_outline() {
    // An arrowhead's prism: 30 x 40 x 10 with a notch; area by the shoelace formula.
    let outline = [[0.0, 0.0], [100.0, 0.0], [30.0, 10.0], [0.0, 40.0]];
    for start in 0..4 {
        let mut text = String::new();
        for z in [0, 10] {
            for [x, y] in outline {
                writeln!(text, "v {x} {y} {z}").unwrap();
            }
        }
        let ring = |base: usize| (0..4).map(move |i| base + (i + start) % 4);
        let cap: Vec<String> = ring(5).map(|i| i.to_string()).collect();
        let floor: Vec<String> = ring(1).map(|i| i.to_string()).rev().collect();
        writeln!(text, "f {}\nf {}", cap.join(" "), floor.join(" ")).unwrap();
        for i in 0..4 {
            let next = (i + 1) % 4;
            writeln!(text, "f {} {} {} {}", i + 1, next + 1, next + 5, i + 5).unwrap();
        }
        check(
            &parsed("a.obj", &text),
            10.0 * 1100.0,
            [0.0; 3],
            [100.0, 40.0, 10.0],
        );
    }
}

#[test]
fn bent_faces_are_reported_and_strongly_bent_ones_leave_the_solid_open() {
    let bent = obj("f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n");
    let slightly = parsed("a.obj", &bent.replace("v 4 2 1 ", "v 4 2 1.2 "));
    assert!(
        slightly.notes[0].contains("1 of its faces are not plane (line 13:"),
        "{:?}",
        slightly.notes
    );
    assert_eq!(slightly.doubtful, None);
    let strongly = parsed("a.obj", &bent.replace("v 4 2 1 ", "v 4 2 3 "));
    assert!(strongly.doubtful.unwrap().contains("line 13:"));
}

fn ply(format: &str, body: &[u8]) -> Vec<u8> {
    let header = format!(
        "ply\nformat {format} 1.0\ncomment made here\nelement vertex 8\nproperty float x\nproperty float y\nproperty float z\nproperty uchar red\nelement face 6\nproperty uchar flags\nproperty list uchar int vertex_indices\nelement extra 1\nproperty double d\nend_header\n"
    );
    [header.as_bytes(), body].concat()
}

const QUADS: [[i32; 4]; 6] = [
    [0, 2, 3, 1],
    [4, 5, 7, 6],
    [0, 1, 5, 4],
    [2, 6, 7, 3],
    [0, 4, 6, 2],
    [1, 3, 7, 5],
];

#[test]
fn ply_is_read_as_text_and_in_both_byte_orders() {
    let mut text = String::new();
    let (mut little, mut big) = (Vec::new(), Vec::new());
    for [x, y, z] in corners().iter().map(DVec3::to_array) {
        writeln!(text, "{x} {y} {z} 200").unwrap();
        for value in [x, y, z] {
            little.extend((value as f32).to_le_bytes());
            big.extend((value as f32).to_be_bytes());
        }
        little.push(200);
        big.push(200);
    }
    for quad in QUADS {
        writeln!(text, "7 4 {} {} {} {}", quad[0], quad[1], quad[2], quad[3]).unwrap();
        little.extend([7, 4]);
        big.extend([7, 4]);
        little.extend(quad.iter().flat_map(|index| index.to_le_bytes()));
        big.extend(quad.iter().flat_map(|index| index.to_be_bytes()));
    }
    text += "0.5\n";
    little.extend(0.5_f64.to_le_bytes());
    big.extend(0.5_f64.to_be_bytes());
    for (format, body) in [
        ("ascii", text.as_bytes()),
        ("binary_little_endian", &little[..]),
        ("binary_big_endian", &big[..]),
    ] {
        check(
            &read_as("a.ply", &ply(format, body)).unwrap(),
            8.0,
            [0.0; 3],
            SIZE,
        );
        let cut = read_as("a.ply", &ply(format, &body[..body.len() / 2]))
            .unwrap_err()
            .to_string();
        assert!(cut.contains("ends before its"), "{cut}");
    }
    let wrong = text.replace("7 4 0 2 3 1", "7 4 0 2 3 8");
    let message = read_as("a.ply", &ply("ascii", wrong.as_bytes()))
        .unwrap_err()
        .to_string();
    assert!(
        message.contains("face 0 refers to the missing vertex 8"),
        "{message}"
    );
    assert!(
        refusal(
            "a.ply",
            "ply\nformat ascii 1.0\nelement vertex many\nend_header\n"
        )
        .contains("line 3")
    );
}

/// A glTF document of the box, its buffer in a data URI: 96 bytes of positions, 72 of indices.
fn gltf(nodes: &str, more: &str) -> (String, Vec<u8>) {
    use base64::Engine as _;
    let mut bytes: Vec<u8> = corners()
        .iter()
        .flat_map(|point| point.as_vec3().to_array())
        .flat_map(f32::to_le_bytes)
        .collect();
    bytes.extend(
        TRIANGLES
            .iter()
            .flatten()
            .flat_map(|index| (*index as u16).to_le_bytes()),
    );
    let uri = base64::engine::general_purpose::STANDARD.encode(&bytes);
    let text = format!(
        r#"{{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[0]}}],"nodes":[{nodes}],{more}
        "meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}},"indices":1,"material":0}}]}}],
        "materials":[{{"pbrMetallicRoughness":{{"baseColorFactor":[1,0.5,0,1]}}}}],
        "accessors":[{{"bufferView":0,"componentType":5126,"count":8,"type":"VEC3"}},{{"bufferView":1,"componentType":5123,"count":36,"type":"SCALAR"}}],
        "bufferViews":[{{"buffer":0,"byteLength":96}},{{"buffer":0,"byteOffset":96,"byteLength":72}}],
        "buffers":[{{"byteLength":168,"uri":"data:application/octet-stream;base64,{uri}"}}]}}"#
    );
    (text, bytes)
}

#[test]
fn gltf_nodes_are_placed_as_the_specification_has_them() {
    let half = std::f64::consts::FRAC_1_SQRT_2;
    let nodes = format!(
        r#"{{"children":[1],"translation":[10,0,0],"rotation":[0,0,{half},{half}]}},{{"mesh":0,"scale":[2,2,2],"translation":[0,0,5]}}"#
    );
    let (text, bytes) = gltf(&nodes, "");
    let file = parsed("a.gltf", &text);
    // Twice as large, then a quarter turn about z.
    check(&file, 64.0, [6.0, 0.0, 5.0], [10.0, 8.0, 7.0]);
    assert!(file.in_metres && file.up == Up::Y);
    assert_eq!(file.parts[0].colour, Some([1.0, 0.5, 0.0, 1.0]));
    let mirrored = parsed("a.gltf", &gltf(r#"{"mesh":0,"scale":[-1,1,1]}"#, "").0);
    check(&mirrored, 8.0, [-4.0, 0.0, 0.0], [0.0, 2.0, 1.0]);
    // As a .glb, its buffer in the binary chunk.
    let start = text.find(",\"uri\"").unwrap();
    let mut json = format!("{}}}]}}", &text[..start]).into_bytes();
    json.resize(json.len().next_multiple_of(4), b' ');
    let mut glb = b"glTF\x02\0\0\0\0\0\0\0".to_vec();
    for (chunk, kind) in [(&json, b"JSON"), (&bytes, b"BIN\0")] {
        glb.extend((chunk.len() as u32).to_le_bytes());
        glb.extend(kind);
        glb.extend(chunk);
    }
    check(
        &read_as("a.glb", &glb).unwrap(),
        64.0,
        [6.0, 0.0, 5.0],
        [10.0, 8.0, 7.0],
    );
    assert!(
        read_as("a.glb", &glb[..glb.len() - 9])
            .unwrap_err()
            .to_string()
            .contains("cut short")
    );
}

#[test]
fn gltf_that_cannot_be_read_rightly_is_refused_by_name() {
    let node = r#"{"mesh":0}"#;
    let draco = gltf(
        node,
        r#""extensionsRequired":["KHR_draco_mesh_compression"],"#,
    )
    .0;
    assert!(refusal("a.gltf", &draco).contains("Draco"));
    let other = gltf(node, r#""extensionsRequired":["EXT_meshopt_compression"],"#).0;
    assert!(refusal("a.gltf", &other).contains("EXT_meshopt_compression"));
    // Version 1 keeps its parts by name where version 2 has lists.
    let old = r#"{"asset":{"version":"1.0"},"accessors":{"a":{}},"meshes":{}}"#;
    assert!(refusal("a.gltf", old).contains("glTF version 1.0"));
    let text = gltf(node, "").0;
    assert!(
        refusal("a.gltf", &text.replace("\"count\":8", "\"count\":9"))
            .contains("accessor 0: it goes beyond")
    );
    assert!(
        refusal(
            "a.gltf",
            &text.replace("\"byteLength\":72}", "\"byteLength\":999}")
        )
        .contains("beyond its buffer's end")
    );
    assert!(refusal("a.gltf", &gltf(r#"{"mesh":0,"children":[0]}"#, "").0).contains("in itself"));
    assert!(refusal("a.gltf", &gltf(r#"{"mesh":0,"skin":0}"#, "").0).contains("skin"));
}

/// A COLLADA document of the box as geometry `g`.
fn collada(asset: &str, faces: &str, scene: &str) -> String {
    let numbers: Vec<String> = corners()
        .iter()
        .flat_map(glam::DVec3::to_array)
        .map(|value| value.to_string())
        .collect();
    format!(
        r##"<?xml version="1.0"?><COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1"><asset>{asset}</asset>
<library_geometries><geometry id="g"><mesh><source id="p"><float_array id="a" count="24">{}</float_array><technique_common>
<accessor source="#a" count="8" stride="3"><param name="X" type="float"/><param name="Y" type="float"/><param name="Z" type="float"/></accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>{faces}</mesh></geometry></library_geometries>{scene}</COLLADA>"##,
        numbers.join(" ")
    )
}

const METRE: &str = "<unit meter=\"1\"/><up_axis>Z_UP</up_axis>";
const INPUT: &str = "<input semantic=\"VERTEX\" source=\"#v\" offset=\"0\"/>";

fn triangles() -> String {
    let indices: Vec<String> = TRIANGLES.iter().flatten().map(u32::to_string).collect();
    format!(
        "<triangles count=\"12\">{INPUT}<p>{}</p></triangles>",
        indices.join(" ")
    )
}

fn in_scene(nodes: &str) -> String {
    format!(
        "<library_visual_scenes><visual_scene id=\"s\">{nodes}</visual_scene></library_visual_scenes><scene><instance_visual_scene url=\"#s\"/></scene>"
    )
}

const GEOMETRY: &str = "<instance_geometry url=\"#g\"/>";

/// Where the box's corners are by a matrix.
fn ends(matrix: DMat4) -> ([f64; 3], [f64; 3]) {
    let placed: Vec<DVec3> = corners()
        .iter()
        .map(|corner| matrix.transform_point3(*corner))
        .collect();
    let low = placed.iter().fold(DVec3::INFINITY, |low, p| low.min(*p));
    let high = placed
        .iter()
        .fold(DVec3::NEG_INFINITY, |high, p| high.max(*p));
    (low.to_array(), high.to_array())
}

#[test]
fn collada_transforms_act_in_the_order_in_which_they_are_written() {
    let translate = DMat4::from_translation(DVec3::new(1.0, 2.0, 3.0));
    let rotate = DMat4::from_rotation_z(std::f64::consts::FRAC_PI_2);
    let scale = DMat4::from_scale(DVec3::new(2.0, 1.0, 0.5));
    // x grows by y: a skew of 45 degrees of what lies along y towards x.
    let skew = DMat4::from_cols_array(&[
        1.0, 0.0, 0.0, 0.0, 1.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0,
    ]);
    let words = [
        ("<translate>1 2 3</translate>", translate),
        ("<rotate>0 0 1 90</rotate>", rotate),
        ("<scale>2 1 0.5</scale>", scale),
        (
            "<matrix>1 0 0 1  0 1 0 2  0 0 1 3  0 0 0 1</matrix>",
            translate,
        ),
        ("<skew>45 0 1 0 1 0 0</skew>", skew),
        // From (0, 0, 5) to the origin with y up: along -z, as it lies.
        (
            "<lookat>0 0 5 0 0 0 0 1 0</lookat>",
            DMat4::from_translation(DVec3::new(0.0, 0.0, 5.0)),
        ),
        // From (5, 0, 0) to the origin with z up: its z axis along x, its x along y.
        (
            "<lookat>5 0 0 0 0 0 0 0 1</lookat>",
            DMat4::from_cols_array(&[
                0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 1.0, 0.0, 0.0, 0.0, 5.0, 0.0, 0.0, 1.0,
            ]),
        ),
    ];
    for (one, first) in &words {
        for (other, second) in &words {
            let matrix = *first * *second;
            let (low, high) = ends(matrix);
            let flat = format!("<node>{one}{other}{GEOMETRY}</node>");
            let nested = format!("<node>{one}<node>{other}{GEOMETRY}</node></node>");
            for nodes in [flat, nested] {
                let file = parsed("a.dae", &collada(METRE, &triangles(), &in_scene(&nodes)));
                check(&file, 8.0 * matrix.determinant().abs(), low, high);
            }
        }
    }
    let mirrored = format!("<node><scale>-1 1 1</scale>{GEOMETRY}</node>");
    check(
        &parsed("a.dae", &collada(METRE, &triangles(), &in_scene(&mirrored))),
        8.0,
        [-4.0, 0.0, 0.0],
        [0.0, 2.0, 1.0],
    );
}

#[test]
fn collada_instances_libraries_units_and_scenes_are_read() {
    let millimetre = "<unit name=\"mm\" meter=\"0.001\"/><up_axis>Z_UP</up_axis>";
    let read = |asset: &str, scene: &str| parsed("a.dae", &collada(asset, &triangles(), scene));
    let twice = in_scene(&format!(
        "<node>{GEOMETRY}</node><node><translate>0 0 9</translate>{GEOMETRY}</node>"
    ));
    check(&read(METRE, &twice), 16.0, [0.0; 3], [4.0, 2.0, 10.0]);
    let library = format!(
        "<library_nodes><node id=\"lib\"><translate>0 0 7</translate>{GEOMETRY}</node></library_nodes>"
    );
    let of_library = library
        + &in_scene("<node><translate>1 0 0</translate><instance_node url=\"#lib\"/></node>");
    check(
        &read(METRE, &of_library),
        8.0,
        [1.0, 0.0, 7.0],
        [5.0, 2.0, 8.0],
    );
    check(
        &read(millimetre, &of_library),
        8e-9,
        [1e-3, 0.0, 7e-3],
        [5e-3, 2e-3, 8e-3],
    );
    let inch = read("<unit meter=\"0.0254\"/><up_axis>Z_UP</up_axis>", "");
    check(
        &inch,
        8.0 * 0.0254_f64.powi(3),
        [0.0; 3],
        SIZE.map(|size| 0.0254 * size),
    );
    assert!(inch.notes[0].contains("no scene"));
    let unstated = read("", &in_scene(&format!("<node>{GEOMETRY}</node>")));
    check(&unstated, 8.0, [0.0; 3], SIZE);
    assert!(unstated.up == Up::Y && unstated.notes[0].contains("no unit"));
    assert_eq!(read("<up_axis>X_UP</up_axis>", "").up, Up::X);
    // Of two scenes the one that is shown.
    let other = format!(
        "<library_visual_scenes><visual_scene id=\"t\"><node>{GEOMETRY}{GEOMETRY}</node></visual_scene></library_visual_scenes>"
    );
    check(
        &read(
            METRE,
            &(other.clone() + &in_scene(&format!("<node>{GEOMETRY}</node>"))),
        ),
        8.0,
        [0.0; 3],
        SIZE,
    );
    let unsaid = other.clone() + &other.replace("\"t\"", "\"u\"");
    assert!(refusal("a.dae", &collada(METRE, &triangles(), &unsaid)).contains("2 visual scenes"));
}

#[test]
fn up_axes_turn_as_the_specification_has_them() {
    let along = |up: Up| [DVec3::X, DVec3::Y, DVec3::Z].map(|axis| up.z_up(axis).to_array());
    // Rows: where the file's x, y and z axes point to with z up.
    assert_eq!(
        along(Up::Z),
        [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]
    );
    assert_eq!(
        along(Up::Y),
        [[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]]
    );
    assert_eq!(
        along(Up::X),
        [[0.0, 0.0, 1.0], [-1.0, 0.0, 0.0], [0.0, -1.0, 0.0]]
    );
}

#[test]
fn collada_primitives_of_all_kinds_are_read() {
    let read = |faces: &str| parsed("a.dae", &collada(METRE, faces, ""));
    let words = |quad: &[i32; 4]| quad.map(|index| index.to_string()).join(" ");
    let quads: Vec<String> = QUADS.iter().map(words).collect();
    let polylist = format!(
        "<polylist count=\"6\">{INPUT}<vcount>4 4 4 4 4 4</vcount><p>{}</p></polylist>",
        quads.join(" ")
    );
    let polygons: String = quads.iter().map(|quad| format!("<p>{quad}</p>")).collect();
    let polygons = format!("<polygons count=\"6\">{INPUT}{polygons}</polygons>");
    let fans: String = quads.iter().map(|quad| format!("<p>{quad}</p>")).collect();
    let fans = format!("<trifans count=\"6\">{INPUT}{fans}</trifans>");
    let strips: String = QUADS
        .iter()
        .map(|&[a, b, c, d]| format!("<p>{a} {b} {d} {c}</p>"))
        .collect();
    let strips = format!("<tristrips count=\"6\">{INPUT}{strips}</tristrips>");
    let lines = format!(
        "<lines count=\"1\">{INPUT}<p>0 1</p></lines>{}",
        triangles()
    );
    // Each corner with a normal and a texture before its vertex.
    let offset: Vec<String> = TRIANGLES
        .iter()
        .flatten()
        .map(|index| format!("9 8 {index}"))
        .collect();
    let offset = format!(
        "<triangles count=\"12\"><input semantic=\"NORMAL\" source=\"#n\" offset=\"0\"/><input semantic=\"TEXCOORD\" source=\"#t\" offset=\"1\"/>{}<p>{}</p></triangles>",
        INPUT.replace("\"0\"", "\"2\""),
        offset.join(" ")
    );
    for faces in [
        triangles(),
        polylist.clone(),
        polygons,
        fans,
        strips,
        lines,
        offset,
    ] {
        check(&read(&faces), 8.0, [0.0; 3], SIZE);
    }
    let refused = |faces: &str| refusal("a.dae", &collada(METRE, faces, ""));
    assert!(
        refused(&polylist.replace("4 4</vcount>", "4 5</vcount>"))
            .contains("more corners than the 24")
    );
    assert!(
        refused(&triangles().replace("<p>0", "<p>8")).contains("missing vertex 8 (there are 8)")
    );
    assert!(refused(&triangles().replace("<p>0", "<p>-1")).contains("`-1` is no index"));
    assert!(refused("<triangles count=\"1\"><p>0 1 2</p></triangles>").contains("no input VERTEX"));
}

#[test]
fn collada_that_cannot_be_read_rightly_is_refused_by_name_and_line() {
    let scene = |nodes: &str| collada(METRE, &triangles(), &in_scene(nodes));
    let refused = |text: &str| refusal("a.dae", text);
    assert!(
        refused(&scene("<node><instance_controller url=\"#c\"/></node>"))
            .contains("<instance_controller>")
    );
    assert!(
        refused(&scene("<node><instance_geometry url=\"#h\"/></node>"))
            .contains("no <geometry> with the id `h`")
    );
    assert!(
        refused(&scene(
            "<node><instance_geometry url=\"other.dae#g\"/></node>"
        ))
        .contains("another document")
    );
    assert!(
        refused(&scene("<node><translate>1 2</translate></node>"))
            .contains("<translate>: it has 2 numbers, expected 3")
    );
    assert!(
        refused(&scene("<node id=\"n\"><instance_node url=\"#n\"/></node>")).contains("in itself")
    );
    let deep = "<a>".repeat(5000);
    assert!(refused(&format!("<COLLADA>{deep}")).contains("400 deep"));
    let text = scene(&format!("<node>{GEOMETRY}</node>"));
    assert!(refused(&text.replace("name=\"X\" ", "")).contains("do not name X, Y and Z"));
    assert!(refused(&text.replace("stride=\"3\"", "stride=\"2\"")).contains("stride is 2"));
    assert!(refused(&text.replace("count=\"8\"", "count=\"9\"")).contains("counts 9 points"));
    assert!(refused(&text.replace("meter=\"1\"", "meter=\"one\"")).contains("its unit is `one`"));
    assert!(
        refused(&text.replace(
            "<geometry id=\"g\">",
            "<geometry id=\"g\"><asset><unit meter=\"2\"/></asset>"
        ))
        .contains("a unit or an up_axis of <geometry>")
    );
    assert!(refused(&text[..text.len() - 20]).contains("its XML"));
}

#[test]
fn pointers_and_foreign_files_are_named_with_a_way_on() {
    let pointer = "version https://git-lfs.github.com/spec/v1\noid sha256:0123\nsize 123456\n";
    for name in ["a.stl", "a.dae", "a.step"] {
        let message = refusal(name, pointer);
        assert!(
            message.contains("Git LFS pointer to a file of 123456 bytes")
                && message.contains("git lfs pull"),
            "{message}"
        );
    }
    let step = refusal("my part.step", "ISO-10303-21;\nHEADER;");
    assert!(
        step.contains("a STEP file") && step.contains("gmsh"),
        "{step}"
    );
    let unknown = refusal("a.xyz", "1 2 3\n");
    assert!(
        unknown.contains("unknown mesh format") && !unknown.contains('{'),
        "{unknown}"
    );
}
