//! The motion in each maker's form of log.

use std::fmt::Write as _;
use std::path::Path;
use std::sync::Arc;

use arrow::array::{ArrayRef, FixedSizeListArray, Float64Array, Int64Array, RecordBatch};
use arrow::datatypes::{Field, Float64Type, Schema};
use mcap::Writer;
use mcap::records::MessageHeader;
use parquet::arrow::ArrowWriter;
use re_cdr::{CdrWriter, LittleEndian};

use super::{JOINTS, Sample, assert_same, diagnosed, done, logged, plain};
use crate::import::files::{HEADER, JOINT_STATE, WRENCH};
use crate::program::Bench;

/// A form of log.
struct Dialect {
    /// File to write, from the bench's folder.
    file: &'static str,
    write: fn(&Path, &[Sample]),
    /// Whether drives' torques are logged, in place of currents.
    as_torques: bool,
    with_wrench: bool,
}

const DIALECTS: [Dialect; 7] = [
    Dialect {
        file: "rtde.csv",
        write: rtde,
        as_torques: false,
        with_wrench: true,
    },
    Dialect {
        file: "realtime.txt",
        write: realtime,
        as_torques: false,
        with_wrench: true,
    },
    Dialect {
        file: "rsi.csv",
        write: rsi,
        as_torques: false,
        with_wrench: false,
    },
    Dialect {
        file: "franka.csv",
        write: franka,
        as_torques: true,
        with_wrench: true,
    },
    Dialect {
        file: "named.csv",
        write: named,
        as_torques: false,
        with_wrench: true,
    },
    Dialect {
        file: "ride.mcap",
        write: bag,
        as_torques: true,
        with_wrench: true,
    },
    Dialect {
        file: "set/data/chunk-000/episode_000000.parquet",
        write: lerobot,
        as_torques: false,
        with_wrench: false,
    },
];

/// Lines of fields.
fn table(
    path: &Path,
    header: Option<String>,
    separator: &str,
    samples: &[Sample],
    row: impl Fn(&Sample) -> Vec<f64>,
) {
    let mut text = header.map_or(String::new(), |header| header + "\n");
    for sample in samples {
        let fields: Vec<String> = row(sample).iter().map(f64::to_string).collect();
        let _ = writeln!(text, "{}", fields.join(separator));
    }
    std::fs::write(path, text).unwrap();
}

/// Names of six elements.
fn six(name: &str, first: usize) -> Vec<String> {
    (first..first + 6)
        .map(|i| name.replace('#', &i.to_string()))
        .collect()
}

/// As the RTDE client's `record.py` writes it.
fn rtde(path: &Path, samples: &[Sample]) {
    let names = [
        "target_q_#",
        "actual_q_#",
        "actual_qd_#",
        "actual_current_#",
        "actual_TCP_pose_#",
        "actual_TCP_force_#",
    ];
    let names = names
        .iter()
        .flat_map(|name| six(name, 0))
        .collect::<Vec<_>>()
        .join(" ");
    table(
        path,
        Some(format!("timestamp {names} robot_mode")),
        " ",
        samples,
        |s| {
            let pose = [0.1, s.angles[0], 0.3, 0.1, s.angles[1], 0.2];
            let all = [s.commands, s.angles, s.speeds, s.currents, pose, s.wrench];
            [&[s.time][..], all.as_flattened(), &[7.0]].concat()
        },
    );
}

/// The real-time interface, its columns as they come.
fn realtime(path: &Path, samples: &[Sample]) {
    let nothing = [0.0; 6];
    table(path, None, ",", samples, |s| {
        let torques = s.currents.map(|c| 9.0 * c);
        let all = [
            s.commands, s.speeds, nothing, s.currents, torques, s.angles, s.speeds, s.currents,
            nothing, [0.4; 6], nothing, s.wrench, [0.4; 6], nothing,
        ];
        [&[s.time][..], all.as_flattened(), &[0.0, 31.0, 31.5]].concat()
    });
}

/// KUKA's RobotSensorInterface: degrees, and a counter of milliseconds.
fn rsi(path: &Path, samples: &[Sample]) {
    let names = ["AIPos.A#", "ASPos.A#", "MACur.A#"];
    let names = names
        .iter()
        .flat_map(|name| six(name, 1))
        .collect::<Vec<_>>()
        .join(";");
    table(
        path,
        Some(format!("IPOC;{names};Delay.D")),
        ";",
        samples,
        |s| {
            let all = [
                s.angles.map(f64::to_degrees),
                s.commands.map(f64::to_degrees),
                s.currents,
            ];
            [
                &[(1e3 * s.time).round() + 4_208_163_000.0][..],
                all.as_flattened(),
                &[0.0],
            ]
            .concat()
        },
    );
}

/// The log of libfranka, with the wrench.
fn franka(path: &Path, samples: &[Sample]) {
    let names = [
        "state.q[#]",
        "state.q_d[#]",
        "state.dq[#]",
        "state.tau_J[#]",
        "state.tau_ext_hat_filtered[#]",
        "K_F_ext_hat_K[#]",
    ];
    let names = names
        .iter()
        .flat_map(|name| six(name, 0))
        .collect::<Vec<_>>()
        .join(",");
    table(
        path,
        Some(format!("time,{names},control_command_success_rate")),
        ",",
        samples,
        |s| {
            let all = [
                s.angles,
                s.commands,
                s.speeds,
                s.currents.map(|c| 10.0 * c),
                [0.1; 6],
                s.wrench,
            ];
            [&[s.time][..], all.as_flattened(), &[1.0]].concat()
        },
    );
}

/// Places of the joints in logs that call them by name.
const MIXED: [usize; 6] = [2, 0, 5, 1, 4, 3];

/// Columns by the joints' names, in another order, in degrees and milliamperes.
fn named(path: &Path, samples: &[Sample]) {
    let of = |what: &str| {
        MIXED
            .map(|joint| format!("{} {what}", JOINTS[joint]))
            .join(";")
    };
    let header = format!(
        "t [ms];{};{};Fx [N];Fy [N];Fz [N];Tx [Nm];Ty [Nm];Tz [Nm]",
        of("position [deg]"),
        of("current [mA]")
    );
    table(path, Some(header), ";", samples, |s| {
        let angles = MIXED.map(|joint| s.angles[joint].to_degrees());
        let currents = MIXED.map(|joint| 1e3 * s.currents[joint]);
        [&[1e3 * s.time][..], &angles, &currents, &s.wrench].concat()
    });
}

/// JointState with its joints in another order each time, and WrenchStamped.
fn bag(path: &Path, samples: &[Sample]) {
    let mut writer = Writer::new(std::io::BufWriter::new(
        std::fs::File::create(path).unwrap(),
    ))
    .unwrap();
    let mut channel = |topic: &str, name: &str, definition: &str| {
        let schema = writer
            .add_schema(name, "ros2msg", format!("{definition}{HEADER}").as_bytes())
            .unwrap();
        writer
            .add_channel(schema, topic, "cdr", &std::collections::BTreeMap::default())
            .unwrap()
    };
    let joints = channel("/joint_states", "sensor_msgs/msg/JointState", JOINT_STATE);
    let wrench = channel("/ft/wrench", "geometry_msgs/msg/WrenchStamped", WRENCH);
    for (row, sample) in samples.iter().enumerate() {
        let stamp = (1e9 * sample.time).round() as u64 + 1_714_740_000_000_000_000;
        let message = |write: &dyn Fn(&mut CdrWriter<'_, LittleEndian>)| {
            let mut body = Vec::new();
            let mut cdr = CdrWriter::new(&mut body);
            cdr.write_i32((stamp / 1_000_000_000) as i32);
            cdr.write_u32((stamp % 1_000_000_000) as u32);
            cdr.write_string("tool0");
            write(&mut cdr);
            [vec![0, 1, 0, 0], body].concat()
        };
        let mut order = MIXED;
        order.rotate_left(row % 6);
        let state = message(&|cdr| {
            cdr.write_sequence_length(6);
            for joint in order {
                cdr.write_string(JOINTS[joint]);
            }
            for values in [
                sample.angles,
                sample.speeds,
                sample.currents.map(|c| 10.0 * c),
            ] {
                cdr.write_sequence_length(6);
                for joint in order {
                    cdr.write_f64(values[joint]);
                }
            }
        });
        let forces = message(&|cdr| sample.wrench.iter().for_each(|value| cdr.write_f64(*value)));
        for (channel_id, data) in [(joints, state), (wrench, forces)] {
            let header = MessageHeader {
                channel_id,
                sequence: row as u32,
                log_time: stamp + 200_000,
                publish_time: stamp,
            };
            writer.write_to_known_channel(&header, &data).unwrap();
        }
    }
    writer.finish().unwrap();
}

/// LeRobot's lists, whose elements its info.json names; a gripper is no joint of the arm.
fn lerobot(path: &Path, samples: &[Sample]) {
    let list = |of: &dyn Fn(&Sample, usize) -> f64| -> ArrayRef {
        let row = |s: &Sample| {
            let joints = MIXED.iter().map(|joint| Some(of(s, *joint)));
            Some(joints.chain([Some(40.0 + s.time)]).collect::<Vec<_>>())
        };
        Arc::new(
            FixedSizeListArray::from_iter_primitive::<Float64Type, _, _>(
                samples.iter().map(row),
                7,
            ),
        )
    };
    let count = || 0..samples.len() as i64;
    let columns: Vec<(&str, ArrayRef)> = vec![
        (
            "observation.state",
            list(&|s, joint| s.angles[joint].to_degrees()),
        ),
        ("action", list(&|s, joint| s.commands[joint].to_degrees())),
        (
            "observation.current",
            list(&|s, joint| 1e3 * s.currents[joint]),
        ),
        (
            "timestamp",
            Arc::new(Float64Array::from_iter_values(
                samples.iter().map(|s| s.time),
            )),
        ),
        (
            "frame_index",
            Arc::new(Int64Array::from_iter_values(count())),
        ),
        (
            "episode_index",
            Arc::new(Int64Array::from_iter_values(count().map(|_| 0))),
        ),
        ("index", Arc::new(Int64Array::from_iter_values(count()))),
    ];
    let folder = path.parent().unwrap();
    std::fs::create_dir_all(folder).unwrap();
    let fields = columns
        .iter()
        .map(|(name, array)| Field::new(*name, array.data_type().clone(), true));
    let schema = Arc::new(Schema::new(fields.collect::<Vec<_>>()));
    let arrays = columns.into_iter().map(|(_, array)| array).collect();
    let batch = RecordBatch::try_new(schema, arrays).unwrap();
    let mut writer =
        ArrowWriter::try_new(std::fs::File::create(path).unwrap(), batch.schema(), None).unwrap();
    writer.write(&batch).unwrap();
    writer.close().unwrap();
    let names: Vec<String> = MIXED
        .iter()
        .map(|joint| format!("{}.pos", JOINTS[*joint]))
        .chain(["gripper.pos".to_owned()])
        .collect();
    let feature = serde_json::json!({ "dtype": "float32", "shape": [7], "names": names });
    let info = serde_json::json!({ "codebase_version": "v2.1", "fps": 50, "features": { "observation.state": feature, "action": feature, "observation.current": feature } });
    let meta = folder.join("../../meta");
    std::fs::create_dir_all(&meta).unwrap();
    std::fs::write(meta.join("info.json"), info.to_string()).unwrap();
}

/// Columns of a CSV file by name.
fn columns(bench: &Bench, file: &str) -> Vec<(String, Vec<f64>)> {
    let text = std::fs::read_to_string(bench.path(file)).unwrap();
    let mut lines = text.lines();
    let names = lines.next().unwrap().split(',');
    let rows: Vec<Vec<f64>> = lines
        .map(|line| {
            line.split(',')
                .map(|cell| cell.parse().unwrap_or(f64::NAN))
                .collect()
        })
        .collect();
    names
        .enumerate()
        .map(|(place, name)| (name.to_owned(), rows.iter().map(|row| row[place]).collect()))
        .collect()
}

#[test]
fn a_log_of_each_maker_is_imported_and_diagnosed_as_the_same_numbers_in_si() {
    let (bench, samples) = logged();
    let mut answers: Vec<((bool, bool), serde_json::Value)> = Vec::new();
    for dialect in &DIALECTS {
        let folder = dialect.file.split(['.', '/']).next().unwrap().to_owned() + "_arm";
        std::fs::create_dir(bench.path(&folder)).unwrap();
        let log = bench.path(dialect.file);
        std::fs::create_dir_all(log.parent().unwrap()).unwrap();
        (dialect.write)(&log, &samples);
        let map = format!("{folder}/map.toml");
        let drafted = bench.idc(&["new", "import", &map, "--from", dialect.file], &[]);
        done(&drafted);
        assert!(!drafted.out.contains("asked"), "{}", drafted.out);
        let recording = format!("{folder}/recording.csv");
        done(&bench.idc(
            &["import", &map, dialect.file, "--out", &recording, "--quiet"],
            &[],
        ));
        let kind = (dialect.as_torques, dialect.with_wrench);
        if answers.iter().all(|(own, _)| *own != kind) {
            let own = format!("plain_{}_{}", u8::from(kind.0), u8::from(kind.1));
            std::fs::create_dir(bench.path(&own)).unwrap();
            bench.write(
                &format!("{own}/recording.csv"),
                plain(&samples, kind.0, kind.1),
            );
            answers.push((kind, diagnosed(&bench, &own, "recording.csv")));
        }
        let (_, expected) = answers.iter().find(|(own, _)| *own == kind).unwrap();
        let first = columns(&bench, &recording)[0].1[0];
        assert!(
            columns(&bench, &recording)[0]
                .1
                .iter()
                .zip(&samples)
                .all(|(t, s)| (t - first - s.time).abs() < 1e-6)
        );
        let found = diagnosed(&bench, &folder, "recording.csv");
        for key in ["verdict", "effects"] {
            assert_same(
                &found[key],
                &expected[key],
                &format!("{}: {key}", dialect.file),
                1e-4,
            );
        }
        assert!(
            expected["effects"]
                .as_array()
                .unwrap()
                .iter()
                .any(|effect| effect["name"] == "joint_friction"),
            "{expected:#}"
        );
    }
}
