//! Bags of ROS 2 in SQLite, as rosbag2 writes them: read by joint, frame and topic, in one file or the folder of several.

use re_cdr::{CdrWriter, LittleEndian};
use rusqlite::{Connection, params};

use super::files::{ROWS, START, truth, whole};
use super::{FORCE, Folder, Planted, STROKE, assert_planted, channel};

/// Tables of rosbag2_storage_sqlite3, those of Iron with definitions and those of before without.
const TABLES: &str = "CREATE TABLE schema(schema_version INTEGER PRIMARY KEY, ros_distro TEXT NOT NULL);\
    CREATE TABLE metadata(id INTEGER PRIMARY KEY, metadata_version INTEGER NOT NULL, metadata TEXT NOT NULL);\
    CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT NOT NULL, type TEXT NOT NULL, serialization_format TEXT NOT NULL, offered_qos_profiles TEXT NOT NULL, type_description_hash TEXT NOT NULL);\
    CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER NOT NULL, timestamp INTEGER NOT NULL, data BLOB NOT NULL);\
    CREATE INDEX timestamp_idx ON messages (timestamp ASC);";
const DEFINITIONS: &str = "CREATE TABLE message_definitions(id INTEGER PRIMARY KEY, topic_type TEXT NOT NULL, encoding TEXT NOT NULL, encoded_message_definition TEXT NOT NULL, type_description_hash TEXT NOT NULL);";
const VALVE: &str = "std_msgs/Header header\nbool extends\nuint16 counts\n================================================================================\n\
    MSG: std_msgs/Header\nbuiltin_interfaces/Time stamp\nstring frame_id\n================================================================================\n\
    MSG: builtin_interfaces/Time\nint32 sec\nuint32 nanosec\n";

/// Types of the topics, from 1.
const TOPICS: [(&str, &str); 4] = [
    ("/joint_states", "sensor_msgs/msg/JointState"),
    ("/wrench", "geometry_msgs/msg/WrenchStamped"),
    ("/regulator", "sensor_msgs/msg/FluidPressure"),
    ("/valve", "lab_msgs/msg/Valve"),
];
const ATMOSPHERE: f64 = 101_325.0;

fn stamp(row: usize) -> u64 {
    START * 1_000_000_000 + whole(row).0 * 1_000_000
}

fn message(
    row: usize,
    frame: &str,
    write: impl FnOnce(&mut CdrWriter<'_, LittleEndian>),
) -> Vec<u8> {
    let mut body = Vec::new();
    let mut cdr = CdrWriter::new(&mut body);
    cdr.write_i32((stamp(row) / 1_000_000_000) as i32);
    cdr.write_u32((stamp(row) % 1_000_000_000) as u32);
    cdr.write_string(frame);
    write(&mut cdr);
    [vec![0, 1, 0, 0], body].concat()
}

/// Messages of a row: the joints in another order each time, a second publisher of other joints, a wrench in each of two frames.
fn messages(row: usize) -> Vec<(usize, Vec<u8>)> {
    let own = truth(row);
    let joints = |names: &[(&str, f64)]| {
        message(row, "", |cdr| {
            cdr.write_sequence_length(names.len());
            for (name, _) in names {
                cdr.write_string(name);
            }
            cdr.write_sequence_length(names.len());
            for (_, position) in names {
                cdr.write_f64(*position);
            }
            cdr.write_sequence_length(0);
            cdr.write_sequence_length(0);
        })
    };
    let mut arm = vec![
        ("slide_joint", own.stroke),
        ("elbow", -1.5),
        ("wrist", 0.25),
    ];
    arm.rotate_left(row % 3);
    let wrench = |frame: &str, force: f64| {
        message(row, frame, |cdr| {
            for value in [0.1, 0.2, force, 0.0, 0.0, 0.0] {
                cdr.write_f64(value);
            }
        })
    };
    vec![
        (1, joints(&arm)),
        (1, joints(&[("gripper", 0.04)])),
        (2, wrench("tool0", own.force)),
        (2, wrench("base", -own.force)),
        (
            3,
            message(row, "", |cdr| {
                cdr.write_f64(own.pressure + ATMOSPHERE);
                cdr.write_f64(0.0);
            }),
        ),
        (
            4,
            message(row, "", |cdr| {
                cdr.write_bool(row / 50 % 2 == 1);
                cdr.write_u16(7);
            }),
        ),
    ]
}

/// Writes a bag with these rows.
pub fn bag(folder: &Folder, name: &str, rows: std::ops::Range<usize>, with_definitions: bool) {
    let mut connection = Connection::open(folder.path(name)).unwrap();
    connection.execute_batch(TABLES).unwrap();
    if with_definitions {
        connection.execute_batch(DEFINITIONS).unwrap();
        let insert = "INSERT INTO message_definitions(topic_type, encoding, encoded_message_definition, type_description_hash) VALUES (?, 'ros2msg', ?, '')";
        connection
            .execute(insert, params![TOPICS[3].1, VALVE])
            .unwrap();
    }
    let write = connection.transaction().unwrap();
    for (index, (topic, kind)) in TOPICS.iter().enumerate() {
        let insert = "INSERT INTO topics VALUES (?, ?, ?, 'cdr', '', '')";
        write
            .execute(insert, params![index as i64 + 1, topic, kind])
            .unwrap();
    }
    for row in rows {
        for (topic, data) in messages(row) {
            let insert = "INSERT INTO messages(topic_id, timestamp, data) VALUES (?, ?, ?)";
            let logged = stamp(row) as i64 + 200_000;
            write
                .execute(insert, params![topic as i64, logged, data])
                .unwrap();
        }
    }
    write.commit().unwrap();
}

/// A channel of a joint, or of a frame.
fn picked(quantity: &str, column: &str, unit: &str, key: &str) -> String {
    channel(quantity, column, unit) + key + "\n"
}

pub fn map() -> String {
    "form = \"bag\"\ntime = { column = \"header.stamp\" }\n".to_owned()
        + &picked(
            "stroke",
            "\"/joint_states.position\"",
            "m",
            "joint = \"slide_joint\"",
        )
        + &picked(
            "force",
            "\"/wrench.wrench.force.z\"",
            "N",
            "frame = \"tool0\"",
        )
        + "[[file.channel]]\nquantity = \"pressure_gauge\"\ncolumn = \"/regulator.fluid_pressure\"\nunit = \"Pa\"\npressure = \"absolute\"\n"
}

pub const PRESSURE: Planted = ("pressure_gauge", |t| t.pressure, 1e-12);

#[test]
fn a_bag_in_sqlite_is_read_by_joint_frame_and_topic() {
    for with_definitions in [false, true] {
        let folder = Folder::new();
        bag(&folder, "ride.db3", 0..ROWS, with_definitions);
        folder.map("map.toml", &map());
        let (stored, _) = folder.imported("map.toml", &["ride.db3"]);
        assert_planted(&stored.recording, &[STROKE, FORCE, PRESSURE]);
        assert_eq!(
            stored.metadata["time_origin_unix_s"],
            (START + 1).to_string()
        );
        // Nothing is left beside it.
        assert_eq!(folder.names("."), ["map.toml", "out.parquet", "ride.db3"]);
    }
}

#[test]
fn the_folder_of_a_bag_is_read_in_the_order_of_its_files() {
    let folder = Folder::new();
    std::fs::create_dir(folder.path("ride")).unwrap();
    for part in 0..11 {
        let rows = ROWS * part / 11..ROWS * (part + 1) / 11;
        bag(&folder, &format!("ride/ride_{part}.db3"), rows, true);
    }
    folder.write(
        "ride/metadata.yaml",
        "rosbag2_bagfile_information:\n  version: 9\n",
    );
    folder.map("map.toml", &map());
    let (stored, _) = folder.imported("map.toml", &["ride"]);
    assert_planted(&stored.recording, &[STROKE, FORCE, PRESSURE]);
}

#[test]
fn a_map_is_drafted_from_a_bag() {
    let folder = Folder::new();
    bag(&folder, "ride.db3", 0..ROWS, true);
    let outcome = folder.run(&["new", "import", "map.toml", "--from", "ride.db3"]);
    assert_eq!(
        (outcome.code, outcome.err.as_str()),
        (0, ""),
        "{}",
        outcome.out
    );
    let map = std::fs::read_to_string(folder.path("map.toml")).unwrap();
    for words in [
        "column = \"/joint_states.position\"",
        "joint = \"slide_joint\"",
        "column = \"/wrench.wrench.force.z\"",
        "certain: sensor_msgs/FluidPressure is in Pa",
        "column = \"/valve.extends\"",
        "time = { column = \"header.stamp\" }",
    ] {
        assert!(map.contains(words), "{map}\nlacks {words:?}");
    }
    // The frames are two, and only its owner knows which is meant.
    let asked = "frames `tool0`, `base`";
    assert!(
        map.contains("# frame = \"tool0\"") && outcome.out.contains(asked),
        "{map}"
    );
    folder.write("map.toml", map.replace("# frame", "frame"));
    let (stored, _) = folder.imported("map.toml", &["ride.db3"]);
    let force = stored.recording.values("measured_force").unwrap();
    assert!(
        force
            .iter()
            .enumerate()
            .all(|(row, v)| (v - truth(row).force).abs() < 1e-9)
    );
    let stroke = stored.recording.values("measured_stroke").unwrap();
    assert!(
        stroke
            .iter()
            .enumerate()
            .all(|(row, v)| (v - truth(row).stroke).abs() < 1e-12)
    );
    let valve = stored.recording.values("valve_extends").unwrap();
    assert!((0..ROWS).all(|row| valve[row] == f64::from(u8::from(row / 50 % 2 == 1))));
}

#[test]
fn a_joint_is_found_by_its_name_in_an_mcap_too() {
    let folder = Folder::new();
    super::files::mcap(&folder.path("log.mcap"), None);
    let joint = picked(
        "elbow_angle",
        "\"/joint_states.position\"",
        "rad",
        "joint = \"elbow\"",
    );
    folder.map(
        "map.toml",
        &("form = \"mcap\"\ntime = { column = \"header.stamp\" }\n".to_owned() + &joint),
    );
    let (stored, _) = folder.imported("map.toml", &["log.mcap"]);
    let angle = stored.recording.values("elbow_angle").unwrap();
    for (index, angle) in angle.iter().enumerate() {
        let since = (whole(5 * index).0 + 1) as f64 * 1e-3;
        assert!((angle - 10.0 * since).abs() < 1e-9, "{index}: {angle}");
    }
}

#[test]
fn what_a_bag_does_not_have_is_refused_with_what_it_has() {
    let folder = Folder::new();
    bag(&folder, "ride.db3", 0..ROWS, false);
    let refused = |keys: &str, says: &[&str]| {
        folder.map("map.toml", &("form = \"bag\"\n".to_owned() + keys));
        super::refused::refused(&folder, &["ride.db3"], says);
    };
    refused(
        &channel("force", "\"/loadcell.data\"", "N"),
        &[
            "no column `/loadcell.data`",
            "the topics",
            "`/joint_states`",
            "`/regulator`",
            "`/valve`",
            "`/wrench`",
        ],
    );
    refused(
        &picked(
            "stroke",
            "\"/joint_states.position\"",
            "m",
            "joint = \"slider\"",
        ),
        &["of no joint `slider`", "`slide_joint`", "`gripper`"],
    );
    refused(
        &picked(
            "force",
            "\"/wrench.wrench.force.z\"",
            "N",
            "frame = \"flange\"",
        ),
        &["of no frame `flange`", "`tool0`", "`base`"],
    );
    refused(
        &picked(
            "stroke",
            "\"/wrench.wrench.force.z\"",
            "m",
            "joint = \"slider\"",
        ),
        &["whose messages name no joints"],
    );
    refused(
        &channel("valve_extends", "\"/valve.extends\"", "1"),
        &[
            "lab_msgs/msg/Valve",
            "definition does not stand in the bag",
            "ros2 bag convert",
        ],
    );
    // Cut off in the middle.
    let bytes = std::fs::read(folder.path("ride.db3")).unwrap();
    folder.write("ride.db3", &bytes[..bytes.len() / 2]);
    refused(
        &picked(
            "stroke",
            "\"/joint_states.position\"",
            "m",
            "joint = \"slide_joint\"",
        ),
        &["cut off or damaged", "accept_truncated"],
    );
}
