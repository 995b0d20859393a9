//! Small valid files of each kind, from the project's own and made here: what fuzzing starts from.

use std::collections::BTreeMap;
use std::sync::Arc;

use arrow::array::{ArrayRef, Float64Array, Int64Array, RecordBatch, StringArray};
use arrow::datatypes::{Field, Schema};
use mcap::records::MessageHeader;
use mcap::{WriteOptions, Writer};
use parquet::arrow::ArrowWriter;
use parquet::basic::Compression;
use parquet::file::properties::WriterProperties;
use re_cdr::{CdrWriter, LittleEndian};
use rusqlite::{Connection, params};

use super::zip::workbook;
use crate::common::project;
use crate::import::files::{HEADER, JOINT_STATE, WRENCH};

/// Rows of a log.
const ROWS: usize = 8;
/// Its start, in seconds since 1970 [s].
const START: u64 = 1_714_740_000;

fn is_toml(name: &str) -> bool {
    std::path::Path::new(name)
        .extension()
        .is_some_and(|end| end == "toml")
}

/// Files of a door's kind.
pub fn seeds(door: &str) -> Vec<Vec<u8>> {
    match door {
        "scenario" => own("scenarios", is_toml),
        "device" => own("models", |name| name == "device.toml"),
        "rig" => [
            own("assets/rigs", |_| true),
            own("assets/new", |name| name == "rig.toml"),
        ]
        .concat(),
        "recorded_arm" => [
            own("tests", |name| name == "recorded_arm.toml"),
            own("models/arm", |name| name == "arm10.toml"),
        ]
        .concat(),
        "recorded_cell" => own("tests", |name| name == "lab_cell.toml"),
        "postures" => own("assets/new", |name| name == "postures.toml"),
        "removal_table" => own("assets/new", |name| name == "removal_table.toml"),
        "import_map" => [
            own("assets/import", is_toml),
            own("assets/new", |name| name == "import.toml"),
        ]
        .concat(),
        "urdf" => vec![read("models/arm/arm10.urdf"), URDF.into()],
        "stl" => vec![read("assets/plate.stl"), STL.into()],
        "obj" => vec![OBJ.into()],
        "collada" => vec![collada()],
        "ply" => ply(),
        "gltf" => gltf(),
        "csv" => csv(),
        "text_log" => text_logs(),
        "mcap" => [None, Some(mcap::Compression::Zstd)]
            .into_iter()
            .flat_map(|packed| [true, false].map(|in_chunks| mcap_bag(packed, in_chunks, false)))
            .collect(),
        "run_bag" => [true, false]
            .map(|in_chunks| mcap_bag(None, in_chunks, true))
            .into(),
        "sqlite" => [false, true].map(sqlite_bag).into(),
        "mat" => mat(),
        "parquet_log" | "parquet" => parquets(),
        "tdms" => [false, true].map(tdms).into(),
        "spreadsheet" => vec![sheet(), workbook(&sheet())],
        "expression" => EXPRESSIONS.map(|text| text.as_bytes().to_vec()).into(),
        "result" => ["run/summary.json", "diagnosis/diagnosis.json"]
            .map(|name| smaller(&read(&format!("tests/results_0_1_0/{name}"))))
            .into(),
        other => panic!("no files are made for `{other}`"),
    }
}

fn read(path: &str) -> Vec<u8> {
    std::fs::read(project(path)).unwrap()
}

/// Files of a folder of the project, without their comments, what they lead to as it lies in a `Room`.
fn own(folder: &str, is_meant: impl Fn(&str) -> bool) -> Vec<Vec<u8>> {
    let entries = std::fs::read_dir(project(folder)).unwrap();
    let names = entries.map(|entry| entry.unwrap().file_name().into_string().unwrap());
    let mut names: Vec<String> = names.filter(|name| is_meant(name)).collect();
    names.sort();
    assert!(!names.is_empty(), "{folder} has none");
    let text = |name: String| {
        let text = String::from_utf8(read(&format!("{folder}/{name}"))).unwrap();
        let kept = text
            .lines()
            .filter(|line| !line.is_empty() && !line.starts_with('#'));
        let kept: String = kept
            .map(|line| line.split(" # ").next().unwrap().trim_end().to_owned() + "\n")
            .collect();
        kept.replace("\"arm10.urdf\"", "\"../models/arm/arm10.urdf\"")
            .replace("../../shared/cell/lab6.urdf", "../models/arm/arm10.urdf")
            .replace("../../shared/cell/", "../assets/")
            .into_bytes()
    };
    names.into_iter().map(text).collect()
}

/// The same JSON, of each list its first two elements.
fn smaller(json: &[u8]) -> Vec<u8> {
    fn cut(value: &mut serde_json::Value) {
        match value {
            serde_json::Value::Array(list) => {
                list.truncate(2);
                list.iter_mut().for_each(cut);
            }
            serde_json::Value::Object(map) => map.values_mut().for_each(cut),
            _ => {}
        }
    }
    let mut value = serde_json::from_slice(json).unwrap();
    cut(&mut value);
    value.to_string().into_bytes()
}

const URDF: &str = r#"<?xml version="1.0"?>
<robot name="a"><material name="grey"><color rgba="0.5 0.5 0.5 1"/></material>
<link name="base"><visual><origin xyz="0 0 0.1" rpy="0 0 0"/><geometry><mesh filename="../assets/plate.stl" scale="0.001 0.001 0.001"/></geometry><material name="grey"/></visual></link>
<link name="one"><inertial><mass value="2"/><origin xyz="0 0 0.1"/><inertia ixx="0.1" ixy="0" ixz="0" iyy="0.1" iyz="0" izz="0.1"/></inertial><collision><geometry><cylinder radius="0.1" length="0.2"/></geometry></collision></link>
<link name="two"><inertial><mass value="1"/><inertia ixx="0.1" ixy="0" ixz="0" iyy="0.1" iyz="0" izz="0.1"/></inertial><visual><geometry><box size="0.1 0.1 0.3"/></geometry></visual></link>
<link name="tool0"/>
<joint name="a" type="revolute"><parent link="base"/><child link="one"/><origin xyz="0 0 0.2" rpy="0 1.57 0"/><axis xyz="0 0 1"/><limit lower="-3" upper="3" effort="100" velocity="2"/><dynamics damping="0.1" friction="0.2"/></joint>
<joint name="b" type="prismatic"><parent link="one"/><child link="two"/><origin xyz="0.3 0 0"/><axis xyz="1 0 0"/><limit lower="0" upper="0.5" effort="50" velocity="1"/></joint>
<joint name="c" type="fixed"><parent link="two"/><child link="tool0"/></joint>
</robot>
"#;

const STL: &str = "solid a
facet normal 0 0 -1
outer loop
vertex 0 0 0
vertex 0 10 0
vertex 10 0 0
endloop
endfacet
facet normal 0 -1 0
outer loop
vertex 0 0 0
vertex 1e1 0 0
vertex 0 0 10
endloop
endfacet
endsolid a
";

const OBJ: &str = "# a wedge
mtllib a.mtl
o part
v 0 0 0
v 10 0 0 1.0
v 10 10 0
v 0 10 0
v 0 0 5.5
v 10 0 5.5
vt 0 0
vn 0 0 1
usemtl red
g bottom
f 1/1/1 4/1/1 3/1/1 2/1/1
f 1//1 2//1 6//1 5//1
f 1 5 4
f -5 -4 \\
-1
f 3 4 5 6
l 1 2
";

const EXPRESSIONS: [&str; 6] = [
    "-c * max(v, 0) ^ 1.5",
    "c * (p1 - p2) / (1 + n * abs(x)) - 2e-3 * sign(v) * sqrt(abs(v))",
    "min(x, 0.01) * tanh(v / 1e-3) + (t > 2) * c",
    "exp(-t / c) * sin(6.28 * n * t) * cos(x / 0.01)",
    "((((x))))",
    "ln(p_set + 1) * atan(f) < q - x_s",
];

fn collada() -> Vec<u8> {
    r##"<?xml version="1.0"?><COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1"><asset><unit meter="0.001"/><up_axis>Z_UP</up_axis></asset>
<library_effects><effect id="e"><profile_COMMON><technique sid="t"><lambert><diffuse><color>1 0.5 0 1</color></diffuse></lambert></technique></profile_COMMON></effect></library_effects>
<library_materials><material id="m"><instance_effect url="#e"/></material></library_materials>
<library_geometries><geometry id="g"><mesh><source id="p"><float_array id="a" count="12">0 0 0 10 0 0 0 10 0 0 0 10</float_array><technique_common><accessor source="#a" count="4" stride="3"><param name="X" type="float"/><param name="Y" type="float"/><param name="Z" type="float"/></accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices><triangles count="2" material="x"><input semantic="VERTEX" source="#v" offset="0"/><p>0 2 1 0 1 3</p></triangles>
<polylist count="2"><input semantic="VERTEX" source="#v" offset="0"/><vcount>3 3</vcount><p>0 3 2 1 2 3</p></polylist></mesh></geometry></library_geometries>
<library_nodes><node id="n"><rotate>0 0 1 90</rotate><instance_geometry url="#g"/></node></library_nodes>
<library_visual_scenes><visual_scene id="s"><node><matrix>1 0 0 0 0 1 0 0 0 0 1 5 0 0 0 1</matrix><scale>2 2 2</scale><instance_geometry url="#g"><bind_material><technique_common><instance_material symbol="x" target="#m"/></technique_common></bind_material></instance_geometry>
<node><translate>1 2 3</translate><instance_node url="#n"/></node></node></visual_scene></library_visual_scenes><scene><instance_visual_scene url="#s"/></scene></COLLADA>"##
        .into()
}

/// A tetrahedron's corners and triangles.
const CORNERS: [[f32; 3]; 4] = [[0., 0., 0.], [10., 0., 0.], [0., 10., 0.], [0., 0., 10.]];
const TRIANGLES: [[u8; 3]; 4] = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];

fn ply() -> Vec<Vec<u8>> {
    let header = |format: &str| {
        format!(
            "ply\nformat {format} 1.0\ncomment a tetrahedron\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\nproperty uchar red\nelement face 4\nproperty list uchar int vertex_indices\nend_header\n"
        )
        .into_bytes()
    };
    let [mut text, mut little, mut big] =
        ["ascii", "binary_little_endian", "binary_big_endian"].map(header);
    for corner in CORNERS {
        text.extend(format!("{} {} {} 200\n", corner[0], corner[1], corner[2]).into_bytes());
        little.extend(corner.iter().flat_map(|value| value.to_le_bytes()));
        big.extend(corner.iter().flat_map(|value| value.to_be_bytes()));
        little.push(200);
        big.push(200);
    }
    for triangle in TRIANGLES {
        text.extend(format!("3 {} {} {}\n", triangle[0], triangle[1], triangle[2]).into_bytes());
        little.push(3);
        big.push(3);
        little.extend(
            triangle
                .iter()
                .flat_map(|corner| i32::from(*corner).to_le_bytes()),
        );
        big.extend(
            triangle
                .iter()
                .flat_map(|corner| i32::from(*corner).to_be_bytes()),
        );
    }
    vec![text, little, big]
}

/// As a text with its buffer in it, and as a .glb.
fn gltf() -> Vec<Vec<u8>> {
    use base64::Engine as _;
    let mut buffer: Vec<u8> = CORNERS
        .iter()
        .flatten()
        .flat_map(|v| v.to_le_bytes())
        .collect();
    buffer.extend(TRIANGLES.iter().flatten());
    let text = |uri: &str| {
        format!(
            r#"{{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[0]}}],"nodes":[{{"children":[1],"translation":[1,0,0],"rotation":[0,0,0.6,0.8]}},{{"mesh":0,"scale":[2,2,2]}}],"meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}},"indices":1,"material":0}},{{"attributes":{{"POSITION":0}},"mode":5}}]}}],"materials":[{{"pbrMetallicRoughness":{{"baseColorFactor":[1,0.5,0,1]}}}}],"accessors":[{{"bufferView":0,"componentType":5126,"count":4,"type":"VEC3"}},{{"bufferView":1,"componentType":5121,"count":12,"type":"SCALAR"}}],"bufferViews":[{{"buffer":0,"byteLength":48}},{{"buffer":0,"byteOffset":48,"byteLength":12}}],"buffers":[{{"byteLength":60{uri}}}]}}"#
        )
    };
    let packed = base64::engine::general_purpose::STANDARD.encode(&buffer);
    let whole = text(&format!(
        ",\"uri\":\"data:application/octet-stream;base64,{packed}\""
    ));
    let mut json = text("").into_bytes();
    json.resize(json.len().next_multiple_of(4), b' ');
    let mut glb = b"glTF\x02\0\0\0".to_vec();
    glb.extend((12 + 8 + json.len() as u32 + 8 + buffer.len() as u32).to_le_bytes());
    for (chunk, kind) in [(&json, b"JSON"), (&buffer, b"BIN\0")] {
        glb.extend((chunk.len() as u32).to_le_bytes());
        glb.extend(kind);
        glb.extend(chunk);
    }
    vec![whole.into_bytes(), glb]
}

fn csv() -> Vec<Vec<u8>> {
    let rows = |header: &str, row: &dyn Fn(usize) -> String| {
        let rows: String = (0..ROWS).map(row).collect();
        format!("{header}\n{rows}").into_bytes()
    };
    vec![
        rows(
            "time_s,set_pressure_pa_gauge,valve_extends,surface_position_m,measured_stroke_m,measured_force_n",
            &|row| {
                format!(
                    "{:.3},300000,1,,{:.4},{}\n",
                    row as f64 * 2e-3,
                    0.01 + 1e-4 * row as f64,
                    40 + row
                )
            },
        ),
        rows("time_s,joint_1_rad,wrench_force_x_n,note_n", &|row| {
            format!("{},{},{},\n", row as f64 * 0.01, 0.1 * row as f64, -3.5)
        }),
        rows("position_mm,height_mm", &|row| format!("{row},0.{row}\n")),
        rows(
            "position_mm,burr_before_mm,burr_after_mm,chamfer_leg_mm,section_removed_mm2",
            &|row| format!("{row},0.3,0.01,0.5,{}\n", 0.1 * row as f64),
        ),
    ]
}

fn text_logs() -> Vec<Vec<u8>> {
    let rows = |header: &str, row: &dyn Fn(usize) -> String| {
        let rows: String = (0..ROWS).map(row).collect();
        format!("{header}\n{rows}").into_bytes()
    };
    vec![
        rows("t,F", &|row| format!("{},{}\n", row as f64 * 0.5, 40 + row)),
        rows("Zeit;Kraft [N];Weg [mm]", &|row| {
            format!("03.05.2024 12:40:0{row},5;4{row},25;{row},1\n")
        }),
        rows(
            "exported by a logger\n\ntime\tpressure (bar)\tforce N",
            &|row| format!("2024-05-03T12:40:0{row}.250Z\t3.{row}\t-4{row}\n"),
        ),
        rows("timestamp,\"a, b\",state", &|row| {
            format!("17147400{row}0000,\"1,{row}50.5\",on\n")
        }),
    ]
}

/// Messages of a row: a wrench, and the state of two joints.
fn messages(row: usize) -> [Vec<u8>; 2] {
    let message = |write: &dyn Fn(&mut CdrWriter<'_, LittleEndian>)| {
        let mut body = Vec::new();
        let mut cdr = CdrWriter::new(&mut body);
        cdr.write_i32(START as i32);
        cdr.write_u32(row as u32 * 10_000_000);
        cdr.write_string("tool0");
        write(&mut cdr);
        [vec![0, 1, 0, 0], body].concat()
    };
    let wrench = message(&|cdr| (0..6).for_each(|axis| cdr.write_f64((axis * row) as f64)));
    let joints = message(&|cdr| {
        cdr.write_sequence_length(2);
        cdr.write_string("a");
        cdr.write_string("elbow");
        for length in [2, 0, 0] {
            cdr.write_sequence_length(length);
            for _ in 0..length {
                cdr.write_f64(0.5 * row as f64);
            }
        }
    });
    [wrench, joints]
}

/// Topics, types, definitions.
const TOPICS: [[&str; 3]; 2] = [
    ["/wrench", "geometry_msgs/msg/WrenchStamped", WRENCH],
    ["/joint_states", "sensor_msgs/msg/JointState", JOINT_STATE],
];

/// A bag whose check sums are left out, which MCAP allows: an input is not stopped by them.
fn mcap_bag(packed: Option<mcap::Compression>, in_chunks: bool, of_run: bool) -> Vec<u8> {
    let options = WriteOptions::new()
        .profile("ros2")
        .compression(packed)
        .use_chunks(in_chunks)
        .chunk_size(Some(2000))
        .calculate_chunk_crcs(false)
        .calculate_data_section_crc(false)
        .calculate_summary_section_crc(false)
        .emit_message_indexes(false)
        .emit_summary_records(false)
        .emit_summary_offsets(false);
    let mut bytes = std::io::Cursor::new(Vec::new());
    let mut writer = Writer::with_options(&mut bytes, options).unwrap();
    let channels = TOPICS.map(|[topic, name, definition]| {
        let definition = format!("{definition}{HEADER}");
        let schema = writer
            .add_schema(name, "ros2msg", definition.as_bytes())
            .unwrap();
        let metadata = match of_run && topic == "/wrench" {
            true => says(),
            false => BTreeMap::default(),
        };
        writer.add_channel(schema, topic, "cdr", &metadata).unwrap()
    });
    if of_run {
        let schema = writer.add_schema("idc.Phase", "jsonschema", b"{}").unwrap();
        let metadata = BTreeMap::default();
        let channel_id = writer
            .add_channel(schema, "/phases", "json", &metadata)
            .unwrap();
        let header = MessageHeader {
            channel_id,
            sequence: 0,
            log_time: 0,
            publish_time: 0,
        };
        let phase = br#"{"name":"follow","start_s":0.5,"end_s":1.5}"#;
        writer.write_to_known_channel(&header, phase).unwrap();
    }
    for row in 0..ROWS {
        for (channel_id, data) in channels.into_iter().zip(messages(row)) {
            let time = START * 1_000_000_000 + row as u64 * 10_000_000;
            let header = MessageHeader {
                channel_id,
                sequence: row as u32,
                log_time: time,
                publish_time: time,
            };
            writer.write_to_known_channel(&header, &data).unwrap();
        }
    }
    writer.finish().unwrap();
    drop(writer);
    bytes.into_inner()
}

/// What `idc run --mcap` says of a topic.
fn says() -> BTreeMap<String, String> {
    let columns = r#"[{"column":"contact_force_n","field":"wrench.force.z","place":1},{"column":"wrench_force_x_n","field":"wrench.force.x","place":0}]"#;
    let pair = |key: &str, value: &str| (key.to_owned(), value.to_owned());
    BTreeMap::from([
        pair("idc_layout_version", "1"),
        pair("idc_columns", columns),
    ])
}

/// A bag in SQLite, with definitions as since ROS 2 Iron or without.
fn sqlite_bag(with_definitions: bool) -> Vec<u8> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.db3");
    let connection = Connection::open(&path).unwrap();
    connection
        .execute_batch(
            "PRAGMA page_size = 512; CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT, type TEXT, serialization_format TEXT, offered_qos_profiles TEXT);
            CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER, timestamp INTEGER, data BLOB);",
        )
        .unwrap();
    if with_definitions {
        connection
            .execute_batch("CREATE TABLE message_definitions(topic_type TEXT, encoding TEXT, encoded_message_definition TEXT);")
            .unwrap();
    }
    for (index, [topic, kind, definition]) in TOPICS.into_iter().enumerate() {
        let insert = "INSERT INTO topics VALUES (?, ?, ?, 'cdr', '')";
        let (id, whole) = (index as i64 + 1, format!("{definition}{HEADER}"));
        connection
            .execute(insert, params![id, topic, kind])
            .unwrap();
        if with_definitions {
            let insert = "INSERT INTO message_definitions VALUES (?, 'ros2msg', ?)";
            connection.execute(insert, params![kind, whole]).unwrap();
        }
    }
    for row in 0..ROWS {
        for (topic, data) in (1i64..).zip(messages(row)) {
            let insert = "INSERT INTO messages(topic_id, timestamp, data) VALUES (?, ?, ?)";
            let stamp = (START * 1_000_000_000) as i64 + row as i64 * 10_000_000;
            connection
                .execute(insert, params![topic, stamp, data])
                .unwrap();
        }
    }
    drop(connection);
    std::fs::read(path).unwrap()
}

/// MAT files of version 5: little end first, packed, big end first.
fn mat() -> Vec<Vec<u8>> {
    use std::io::Write as _;
    let file = |is_big: bool, packed: bool| {
        let u32 = |n: u32| {
            if is_big {
                n.to_be_bytes()
            } else {
                n.to_le_bytes()
            }
        };
        let f64 = |n: f64| {
            if is_big {
                n.to_be_bytes()
            } else {
                n.to_le_bytes()
            }
        };
        let element = |kind: u32, content: &[u8]| {
            let mut bytes = [u32(kind), u32(content.len() as u32)].concat();
            bytes.extend(content);
            bytes.resize(bytes.len().next_multiple_of(8), 0);
            bytes
        };
        // Class 6 and kind 9 are doubles.
        let matrix = |name: &str, [rows, columns]: [u32; 2], of: &dyn Fn(usize) -> f64| {
            let data: Vec<u8> = (0..(rows * columns) as usize)
                .flat_map(|at| f64(of(at)))
                .collect();
            let content = [
                element(6, &[u32(6), u32(0)].concat()),
                element(5, &[u32(rows), u32(columns)].concat()),
                element(1, name.as_bytes()),
                element(9, &data),
            ];
            element(14, &content.concat())
        };
        let mut bytes = format!("{:<124}", "MATLAB 5.0 MAT-file").into_bytes();
        bytes.extend(if is_big { *b"\x01\0MI" } else { *b"\0\x01IM" });
        let rows = ROWS as u32;
        for array in [
            matrix("t", [rows, 1], &|row| 2.0 * row as f64),
            matrix("F", [1, rows], &|row| 40.0 + row as f64),
            matrix("data", [rows, 2], &|at| at as f64),
        ] {
            if packed {
                let mut encoder =
                    flate2::write::ZlibEncoder::new(Vec::new(), flate2::Compression::default());
                encoder.write_all(&array).unwrap();
                let array = encoder.finish().unwrap();
                bytes.extend(u32(15));
                bytes.extend(u32(array.len() as u32));
                bytes.extend(array);
            } else {
                bytes.extend(array);
            }
        }
        bytes
    };
    vec![file(false, false), file(false, true), file(true, false)]
}

/// Tables as a log, as a recording and as long columns, plain and packed.
fn parquets() -> Vec<Vec<u8>> {
    let numbers = |of: &dyn Fn(usize) -> f64| -> ArrayRef {
        Arc::new((0..ROWS).map(of).collect::<Float64Array>())
    };
    let stamps: ArrayRef = Arc::new((0..ROWS as i64).map(|row| 10 * row).collect::<Int64Array>());
    let names: ArrayRef = Arc::new(
        (0..ROWS)
            .map(|row| Some(["approach", "follow"][row / 4]))
            .collect::<StringArray>(),
    );
    let table = |columns: Vec<(&str, ArrayRef)>, codec: Compression| {
        let fields = columns
            .iter()
            .map(|(name, array)| Field::new(*name, array.data_type().clone(), true));
        let schema = Arc::new(Schema::new(fields.collect::<Vec<_>>()));
        let arrays = columns.into_iter().map(|(_, array)| array).collect();
        let batch = RecordBatch::try_new(schema, arrays).unwrap();
        let properties = WriterProperties::builder()
            .set_compression(codec)
            .set_dictionary_enabled(codec == Compression::SNAPPY)
            .build();
        let mut bytes = Vec::new();
        let mut writer =
            ArrowWriter::try_new(&mut bytes, batch.schema(), Some(properties)).unwrap();
        writer.write(&batch).unwrap();
        writer.close().unwrap();
        bytes
    };
    [Compression::UNCOMPRESSED, Compression::SNAPPY]
        .into_iter()
        .flat_map(|codec| {
            let force = numbers(&|row| 40.0 + row as f64);
            let time = numbers(&|row| 0.01 * row as f64);
            [
                table(
                    vec![
                        ("stamp", stamps.clone()),
                        ("contact_force_n", force.clone()),
                    ],
                    codec,
                ),
                table(
                    vec![
                        ("time_s", time),
                        ("phase", names.clone()),
                        ("contact_force_n", force),
                    ],
                    codec,
                ),
            ]
        })
        .collect()
}

/// A TDMS file of two channels, as a waveform.
fn tdms(is_interleaved: bool) -> Vec<u8> {
    let u32 = |n: u32| n.to_le_bytes().to_vec();
    let u64 = |n: u64| n.to_le_bytes().to_vec();
    let text = |text: &str| [u32(text.len() as u32), text.as_bytes().to_vec()].concat();
    let number =
        |key: &str, value: f64| [text(key), u32(10), value.to_le_bytes().to_vec()].concat();
    let object = |path: &str, index: Vec<u8>, properties: &[Vec<u8>]| {
        let count = u32(properties.len() as u32);
        [text(path), index, count, properties.concat()].concat()
    };
    let waveform = [number("wf_increment", 0.01), number("wf_start_offset", 0.0)];
    let index = |kind: u32| [u32(20), u32(kind), u32(1), u64(ROWS as u64)].concat();
    let scale = [
        [text("NI_Number_Of_Scales"), u32(7), u32(1)].concat(),
        [text("NI_Scale[0]_Scale_Type"), u32(0x20), text("Linear")].concat(),
        number("NI_Scale[0]_Linear_Slope", 1e-6),
        number("NI_Scale[0]_Linear_Y_Intercept", 0.0),
    ];
    let objects = [
        object("/", u32(u32::MAX), &[]),
        object("/'Bench'", u32(u32::MAX), &[]),
        object("/'Bench'/'Force'", index(10), &waveform),
        object(
            "/'Bench'/'Stroke'",
            index(3),
            &[&waveform[..], &scale].concat(),
        ),
    ];
    let metadata = [u32(objects.len() as u32), objects.concat()].concat();
    let force = |row: usize| (40.0 + row as f64).to_le_bytes().to_vec();
    let stroke = |row: usize| u32(1000 * row as u32);
    let raw: Vec<u8> = if is_interleaved {
        (0..ROWS)
            .flat_map(|row| [force(row), stroke(row)].concat())
            .collect()
    } else {
        (0..ROWS)
            .flat_map(force)
            .chain((0..ROWS).flat_map(stroke))
            .collect()
    };
    let contents = u32(1 << 1 | 1 << 2 | 1 << 3 | u32::from(is_interleaved) << 5);
    let length = (metadata.len() + raw.len()) as u64;
    let start = [
        b"TDSm".to_vec(),
        contents,
        u32(4713),
        u64(length),
        u64(metadata.len() as u64),
    ];
    [start.concat(), metadata, raw].concat()
}

fn sheet() -> Vec<u8> {
    let text = |cell: &str, text: &str| {
        format!("<c r=\"{cell}\" t=\"inlineStr\"><is><t>{text}</t></is></c>")
    };
    let mut rows = format!("<row r=\"1\">{}{}</row>", text("A1", "t"), text("B1", "F"));
    for row in 2..ROWS + 2 {
        rows += &format!(
            "<row r=\"{row}\"><c r=\"A{row}\"><v>{row}</v></c><c r=\"B{row}\"><v>40.{row}</v></c></row>"
        );
    }
    format!("<?xml version=\"1.0\"?><worksheet xmlns=\"http://schemas.openxmlformats.org/spreadsheetml/2006/main\"><sheetData>{rows}</sheetData></worksheet>").into_bytes()
}
