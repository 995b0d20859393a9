//! Files that claim more than they hold: memory, stack and time are bounded by the file.

use std::fmt::Write as _;
use std::time::{Duration, Instant};

use super::{MeshFile, MeshFileError, read};

/// Longest time for one of these files; without its bound each took minutes, or had no end.
const PATIENCE: Duration = Duration::from_secs(20);

fn read_in_time(name: &str, bytes: &[u8]) -> Result<MeshFile, MeshFileError> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(name);
    std::fs::write(&path, bytes).unwrap();
    let begin = Instant::now();
    let outcome = read(&path);
    assert!(begin.elapsed() < PATIENCE, "{name}: {:?}", begin.elapsed());
    outcome
}

fn refusal(name: &str, text: &str) -> String {
    let message = read_in_time(name, text.as_bytes()).unwrap_err().to_string();
    assert!(message.len() < 500, "{} letters", message.len());
    message
}

/// A COLLADA document of a tetrahedron with `more` points and primitives, and a scene.
fn collada(points: usize, primitives: usize, library: &str, scene: &str) -> String {
    let more = " 0".repeat(3 * points);
    let triangles = "<triangles><input semantic=\"VERTEX\" source=\"#v\" offset=\"0\"/><p>0 2 1 0 1 3 1 2 3 0 3 2</p></triangles>".repeat(primitives);
    format!(
        "<COLLADA version=\"1.4.1\"><asset><unit meter=\"1\"/><up_axis>Z_UP</up_axis></asset>\
         <library_geometries><geometry id=\"g\"><mesh>\
         <source id=\"p\"><float_array id=\"a\">0 0 0 1 0 0 0 1 0 0 0 1{more}</float_array><technique_common>\
         <accessor source=\"#a\" count=\"{count}\" stride=\"3\"><param name=\"X\"/><param name=\"Y\"/><param name=\"Z\"/></accessor></technique_common></source>\
         <vertices id=\"v\"><input semantic=\"POSITION\" source=\"#p\"/></vertices>{triangles}</mesh></geometry></library_geometries>\
         <library_nodes>{library}</library_nodes>\
         <library_visual_scenes><visual_scene id=\"s\">{scene}</visual_scene></library_visual_scenes>\
         <scene><instance_visual_scene url=\"#s\"/></scene></COLLADA>",
        count = 4 + points
    )
}

const ONCE: &str = "<node><instance_geometry url=\"#g\"/></node>";

/// Nodes each of which names the next twice.
fn doubled(innermost: &str) -> String {
    let mut nodes = String::new();
    for level in 0..60 {
        let next = format!("<instance_node url=\"#n{}\"/>", level + 1);
        write!(nodes, "<node id=\"n{level}\">{next}{next}</node>").unwrap();
    }
    nodes + &format!("<node id=\"n60\">{innermost}</node>")
}

#[test]
fn nodes_that_double_at_each_level_are_refused_with_and_without_a_shape() {
    let scene = "<node><instance_node url=\"#n0\"/></node>";
    for innermost in ["", "<instance_geometry url=\"#g\"/>"] {
        let said = refusal("a.dae", &collada(0, 1, &doubled(innermost), scene));
        assert!(said.contains("name one another so often"), "{said}");
    }
    for innermost in ["{}", "{\"mesh\":0}"] {
        let nodes: String = (1..=60)
            .map(|next| format!("{{\"children\":[{next},{next}]}},"))
            .collect();
        let text = format!(
            "{{\"asset\":{{\"version\":\"2.0\"}},\"scenes\":[{{\"nodes\":[0]}}],\"nodes\":[{nodes}{innermost}],\"meshes\":[{{\"primitives\":[]}}]}}"
        );
        let said = refusal("a.gltf", &text);
        assert!(said.contains("name one another so often"), "{said}");
    }
}

#[test]
fn deep_elements_and_entities_of_a_document_s_own_are_refused() {
    for open in ["<a>", "<a b=\"/>\">", "<!-- </a> --><a>"] {
        let deep = format!("<COLLADA>{}", open.repeat(30_000));
        let said = refusal("a.dae", &deep);
        assert!(
            said.contains("line 1") && said.contains("400 deep"),
            "{said}"
        );
    }
    let entity = format!(
        "<!DOCTYPE COLLADA [<!ENTITY a \"{}\">]>",
        "x".repeat(1_000_000)
    );
    let bomb = format!(
        "{entity}<COLLADA><asset>{}</asset></COLLADA>",
        "&a;".repeat(5000)
    );
    assert!(refusal("a.dae", &bomb).contains("<!ENTITY"));
    let word = collada(0, 1, "", ONCE).replace("0 0 0 1", &"z".repeat(1_000_000));
    assert!(refusal("a.dae", &word).contains("zz.."));
}

#[test]
fn points_are_read_once_and_kept_where_triangles_use_them() {
    let shared = collada(100_000, 2000, "", &ONCE.repeat(50));
    let file = read_in_time("a.dae", shared.as_bytes()).unwrap();
    assert_eq!(file.parts.len(), 2000 * 50);
    assert!(file.parts.iter().all(|part| part.points.len() == 4));
    // 3 MB of points that primitives share, and views that begin a byte apart.
    let accessor = "{\"bufferView\":0,\"componentType\":5121,\"count\":1000000,\"type\":\"VEC3\"}";
    let primitive = "{\"attributes\":{\"POSITION\":0},\"indices\":1}";
    let shared = format!(
        "{{\"asset\":{{\"version\":\"2.0\"}},\"nodes\":[{{\"mesh\":0}}],\"meshes\":[{{\"primitives\":[{}]}}],\
         \"accessors\":[{accessor},{{\"bufferView\":0,\"componentType\":5121,\"count\":3,\"type\":\"SCALAR\"}}{}],\
         \"bufferViews\":[{{\"buffer\":0,\"byteLength\":3000000}}],\"buffers\":[{{\"uri\":\"data:;base64,{}\"}}]}}",
        vec![primitive; 500].join(","),
        format!(",{accessor}").repeat(100),
        "A".repeat(4_000_000)
    );
    let file = read_in_time("a.gltf", shared.as_bytes()).unwrap();
    assert_eq!(file.triangle_count(), 500);
    let each = (0..100).map(|own| primitive.replace(":0}", &format!(":{}}}", own + 2)));
    let apart = shared.replace(
        &vec![primitive; 500].join(","),
        &each.collect::<Vec<_>>().join(","),
    );
    assert!(refusal("a.gltf", &apart).contains("more than 15000000 points"));
}

#[test]
fn counts_that_are_claimed_reserve_nothing() {
    let ply = |elements: &str| {
        format!(
            "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n{elements}end_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"
        )
    };
    let faces = "element face 1\nproperty list uchar int vertex_indices\n";
    let nothing = format!("{faces}element mark 18446744073709551615\n");
    let file = read_in_time("a.ply", ply(&nothing).as_bytes()).unwrap();
    assert_eq!(file.triangle_count(), 1);
    let many = faces.replace("face 1", "face 4000000000");
    assert!(refusal("a.ply", &ply(&many)).contains("ends before its face 1"));
    let claimed = collada(0, 1, "", ONCE).replace("count=\"4\"", "count=\"4000000000\"");
    assert!(refusal("a.dae", &claimed).contains("its array holds 4"));
    let mut stl = vec![0; 84];
    stl[80..].copy_from_slice(&4_000_000_000_u32.to_le_bytes());
    let said = read_in_time("a.stl", &stl).unwrap_err().to_string();
    assert!(said.contains("announces 4000000000 triangles"), "{said}");
    let nodes = format!("{{\"nodes\":[{}{{}}]}}", "{},".repeat(2_000_000));
    assert!(refusal("a.gltf", &nodes).contains("500000 objects"));
}

#[test]
fn an_obj_takes_the_time_that_its_length_takes() {
    let points = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n";
    let continued = format!("{points}{}\nf 1 2 3\n", "\\\n".repeat(600_000));
    let file = read_in_time("a.obj", continued.as_bytes()).unwrap();
    assert_eq!(file.triangle_count(), 1);
    let named = format!(
        "{points}usemtl {}\n{}",
        "m".repeat(1_000_000),
        "f 1 2 3\n".repeat(20_000)
    );
    let file = read_in_time("a.obj", named.as_bytes()).unwrap();
    assert_eq!(
        (file.triangle_count(), file.parts[0].points.len()),
        (20_000, 3)
    );
    let libraries = format!("{}{points}f 1 2 3\n", "mtllib a.obj\n".repeat(100_000));
    read_in_time("a.obj", libraries.as_bytes()).unwrap();
    let outline: String = (1..=60_000).map(|corner| format!(" {corner}")).collect();
    let star = |corner: u32| {
        let angle = f64::from(corner) * std::f64::consts::TAU / 60_000.0;
        let radius = 1.0 + 0.5 * f64::from(corner % 2);
        format!("v {} {} 0\n", radius * angle.cos(), radius * angle.sin())
    };
    let stars: String = (0..60_000).map(star).collect();
    let said = refusal("a.obj", &format!("{stars}f{outline}\n"));
    assert!(said.contains("so many corners"), "{said}");
    for corner in ["-9223372036854775808", "9223372036854775807", "5", "-5"] {
        let said = refusal("a.obj", &format!("{points}f 1 2 {corner}\n"));
        assert!(said.contains("missing vertex"), "{said}");
    }
}
