//! A small generator: one planted trajectory, written in every form of log.

use std::io::Write;
use std::path::Path;
use std::sync::Arc;

use arrow::array::{ArrayRef, Float32Array, Float64Array, RecordBatch, TimestampMicrosecondArray};
use arrow::datatypes::{DataType, Field, Schema, TimeUnit};
use flate2::Compression;
use flate2::write::ZlibEncoder;
use mcap::records::MessageHeader;
use mcap::{WriteOptions, Writer};
use parquet::arrow::ArrowWriter;
use parquet::basic::{Compression as Codec, ZstdLevel};
use parquet::file::properties::WriterProperties;
use re_cdr::{CdrWriter, LittleEndian};

/// Rows of a log.
pub const ROWS: usize = 400;
/// When the recorders of stamped logs were started, in seconds since 1970 [s].
pub const START: u64 = 1_714_740_000;
/// Area that presses, and sliding friction, of which the planted force is made [m2, N].
const AREA: f64 = 4.9e-4;
const FRICTION: f64 = 6.0;

/// Values of a device at a row: times [ms] and strokes [um] are whole numbers, so that every form holds them exactly.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Truth {
    /// Time [s].
    pub time: f64,
    /// Stroke [m].
    pub stroke: f64,
    /// Pressure above the atmosphere [Pa].
    pub pressure: f64,
    /// Force [N].
    pub force: f64,
}

/// The planted trajectory at a row.
pub fn truth(row: usize) -> Truth {
    let (millis, micros) = whole(row);
    let pressure = 3e5 + 2e4 * (0.013 * row as f64).sin();
    Truth {
        time: millis as f64 * 1e-3,
        stroke: micros as f64 * 1e-6,
        pressure,
        force: AREA * pressure - FRICTION * (0.05 * row as f64).cos().signum(),
    }
}

/// Time [ms] and stroke [um] at a row.
pub fn whole(row: usize) -> (u64, i64) {
    let stroke = 2e4 * (1.0 + (0.05 * row as f64).sin());
    (1000 + 2 * row as u64, stroke.round() as i64)
}

/// A text, a line of it made for each row, the last without its end where it is torn.
pub fn text(path: &Path, header: &str, line: impl Fn(usize) -> String) {
    let lines: Vec<String> = (0..ROWS).map(line).collect();
    std::fs::write(path, format!("{header}{}\n", lines.join("\n"))).unwrap();
}

/// A number with dots before every third digit: 1003000 as 1.003.000.
pub fn dotted(number: u64) -> String {
    let digits = number.to_string();
    let first = digits.len() % 3;
    let mut text = digits[..first].to_owned();
    for (index, digit) in digits[first..].char_indices() {
        if index % 3 == 0 && !text.is_empty() {
            text.push('.');
        }
        text.push(digit);
    }
    text
}

/// A table with stamps [us], stroke [mm] in single precision and force [kN], packed with zstd.
pub fn parquet(path: &Path) {
    let fields = vec![
        Field::new("force_kn", DataType::Float64, true),
        Field::new(
            "stamp",
            DataType::Timestamp(TimeUnit::Microsecond, None),
            false,
        ),
        Field::new("stroke_mm", DataType::Float32, true),
    ];
    let stamp = |row| (START * 1_000_000 + whole(row).0 * 1_000) as i64;
    let columns: Vec<ArrayRef> = vec![
        Arc::new(
            (0..ROWS)
                .map(|row| Some(truth(row).force * 1e-3))
                .collect::<Float64Array>(),
        ),
        Arc::new(
            (0..ROWS)
                .map(|row| Some(stamp(row)))
                .collect::<TimestampMicrosecondArray>(),
        ),
        Arc::new(
            (0..ROWS)
                .map(|row| Some(whole(row).1 as f32 * 1e-3))
                .collect::<Float32Array>(),
        ),
    ];
    let batch = RecordBatch::try_new(Arc::new(Schema::new(fields)), columns).unwrap();
    let properties = WriterProperties::builder()
        .set_compression(Codec::ZSTD(ZstdLevel::default()))
        .set_max_row_group_row_count(Some(150))
        .build();
    let file = std::fs::File::create(path).unwrap();
    let mut writer = ArrowWriter::try_new(file, batch.schema(), Some(properties)).unwrap();
    writer.write(&batch).unwrap();
    writer.close().unwrap();
}

/// A MAT file of version 5 (MathWorks, MAT-File Format) with `t` [ms] as whole numbers of 16 bits, `u` [um] as such of 32, `data` of two columns, stroke [mm] and force [N],
/// and a text `note` that is no array of numbers.
pub fn mat5(path: &Path, packed: bool) {
    let mut file = format!("{:<124}", "MATLAB 5.0 MAT-file, written by a test").into_bytes();
    file.extend([0, 1, b'I', b'M']);
    let times: Vec<u8> = (0..ROWS)
        .flat_map(|row| (whole(row).0 as i16).to_le_bytes())
        .collect();
    let ticks: Vec<u8> = (0..ROWS)
        .flat_map(|row| (whole(row).1 as i32 - 30_000).to_le_bytes())
        .collect();
    let numbers = |of: fn(usize) -> f64| (0..ROWS).flat_map(move |row| of(row).to_le_bytes());
    let data: Vec<u8> = numbers(|row| whole(row).1 as f64 * 1e-3)
        .chain(numbers(|row| truth(row).force))
        .collect();
    let note: Vec<u8> = "slow".bytes().flat_map(|c| [c, 0]).collect();
    // Classes: 10 is int16, 12 int32, 4 characters, 6 double; kinds of data: 3 is int16, 5 int32, 4 uint16, 9 double.
    for array in [
        matrix("t", 10, [ROWS, 1], 3, &times),
        matrix("note", 4, [1, 4], 4, &note),
        matrix("u", 12, [1, ROWS], 5, &ticks),
        matrix("data", 6, [ROWS, 2], 9, &data),
    ] {
        if packed {
            let mut encoder = ZlibEncoder::new(Vec::new(), Compression::default());
            encoder.write_all(&array).unwrap();
            let packed = encoder.finish().unwrap();
            file.extend(15u32.to_le_bytes());
            file.extend((packed.len() as u32).to_le_bytes());
            file.extend(packed);
        } else {
            file.extend(array);
        }
    }
    std::fs::write(path, file).unwrap();
}

/// An array as an element of a MAT file.
fn matrix(name: &str, class: u32, size: [usize; 2], kind: u32, data: &[u8]) -> Vec<u8> {
    let sizes: Vec<u8> = size
        .iter()
        .flat_map(|n| (*n as i32).to_le_bytes())
        .collect();
    let flags: Vec<u8> = [class, 0].iter().flat_map(|n| n.to_le_bytes()).collect();
    let content = [
        element(6, &flags),
        element(5, &sizes),
        element(1, name.as_bytes()),
        element(kind, data),
    ];
    element(14, &content.concat())
}

fn element(kind: u32, content: &[u8]) -> Vec<u8> {
    let mut bytes = kind.to_le_bytes().to_vec();
    bytes.extend((content.len() as u32).to_le_bytes());
    bytes.extend(content);
    bytes.resize(bytes.len().next_multiple_of(8), 0);
    bytes
}

pub const HEADER: &str = "\
================================================================================
MSG: std_msgs/Header
builtin_interfaces/Time stamp
string frame_id
================================================================================
MSG: builtin_interfaces/Time
int32 sec
uint32 nanosec
";
pub const WRENCH: &str = "\
# A wrench with reference coordinate frame and timestamp
std_msgs/Header header
Wrench wrench
================================================================================
MSG: geometry_msgs/Wrench
Vector3  force
Vector3  torque
================================================================================
MSG: geometry_msgs/Vector3
float64 x
float64 y
float64 z
";
pub const JOINT_STATE: &str = "\
std_msgs/Header header

string[] name
float64[] position
float64[] velocity
float64[] effort
";

/// A bag with `/wrench` at every row, `/joint_states` at every fifth and 1 ms later, `/set` with nothing but a number, and `/camera` with
/// messages of another encoding. The joints' second position is 10 rad/s times the time since the start.
pub fn mcap(path: &Path, compression: Option<mcap::Compression>) {
    let file = std::io::BufWriter::new(std::fs::File::create(path).unwrap());
    let options = WriteOptions::new()
        .profile("ros2")
        .compression(compression)
        .chunk_size(Some(20_000));
    let mut writer = Writer::with_options(file, options).unwrap();
    let mut channel = |topic: &str, name: &str, encodings: [&str; 2], definition: &str| {
        let schema = writer
            .add_schema(name, encodings[0], definition.as_bytes())
            .unwrap();
        writer
            .add_channel(
                schema,
                topic,
                encodings[1],
                &std::collections::BTreeMap::default(),
            )
            .unwrap()
    };
    let ros = ["ros2msg", "cdr"];
    let wrench = format!("{WRENCH}{HEADER}");
    let wrench = channel("/wrench", "geometry_msgs/msg/WrenchStamped", ros, &wrench);
    let joints = format!("{JOINT_STATE}{HEADER}");
    let joints = channel("/joint_states", "sensor_msgs/msg/JointState", ros, &joints);
    let set = channel("/set", "std_msgs/msg/Float64", ros, "float64 data\n");
    let camera = channel("/camera", "foxglove.Image", ["protobuf", "protobuf"], "");
    for row in 0..ROWS {
        let stamp = START * 1_000_000_000 + whole(row).0 * 1_000_000;
        // It is logged a little later than it was stamped.
        let logged = stamp + 300_000 + 1000 * (row as u64 % 7);
        let mut write = |channel: u16, data: Vec<u8>| {
            let header = MessageHeader {
                channel_id: channel,
                sequence: row as u32,
                log_time: logged,
                publish_time: logged,
            };
            writer.write_to_known_channel(&header, &data).unwrap();
        };
        write(
            wrench,
            message(|cdr| {
                stamped(cdr, stamp);
                let truth = truth(row);
                for value in [0.0, 0.0, truth.force, 0.0, 0.0, truth.stroke] {
                    cdr.write_f64(value);
                }
            }),
        );
        if row % 5 == 0 {
            let stamp = stamp + 1_000_000;
            let since = (whole(row).0 + 1) as f64 * 1e-3;
            write(
                joints,
                message(|cdr| {
                    stamped(cdr, stamp);
                    cdr.write_sequence_length(2);
                    cdr.write_string("a");
                    cdr.write_string("elbow");
                    for length in [2, 0, 0] {
                        cdr.write_sequence_length(length);
                        if length > 0 {
                            cdr.write_f64(-1.0);
                            cdr.write_f64(10.0 * since);
                        }
                    }
                }),
            );
            write(set, message(|cdr| cdr.write_f64(truth(row).pressure)));
            write(camera, vec![1, 2, 3]);
        }
    }
    writer.finish().unwrap();
}

fn message(write: impl FnOnce(&mut CdrWriter<'_, LittleEndian>)) -> Vec<u8> {
    let mut body = Vec::new();
    write(&mut CdrWriter::new(&mut body));
    [vec![0, 1, 0, 0], body].concat()
}

fn stamped(cdr: &mut CdrWriter<'_, LittleEndian>, stamp: u64) {
    cdr.write_i32((stamp / 1_000_000_000) as i32);
    cdr.write_u32((stamp % 1_000_000_000) as u32);
    cdr.write_string("tool");
}
