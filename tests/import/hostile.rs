//! Logs that claim more than they hold, unpack without end, or are no files: one line, exit code 2, nothing written, and no room made for the claim.

use std::io::Write;
use std::process::Command;

use flate2::Compression;
use flate2::write::{GzEncoder, ZlibEncoder};
use mcap::records::MessageHeader;
use mcap::{WriteOptions, Writer};
use rusqlite::Connection;

use super::refused::refused;
use super::{Folder, bags, channel};

/// Bytes of a message before its content: CDR, with the lowest byte first.
const CDR: [u8; 4] = [0, 1, 0, 0];

/// An MCAP with messages of a definition.
fn of_definition(folder: &Folder, definition: &str, content: &[u8]) {
    let file = std::fs::File::create(folder.path("log.mcap")).unwrap();
    let mut writer = Writer::with_options(file, WriteOptions::new().compression(None)).unwrap();
    let schema = writer
        .add_schema("a/msg/A", "ros2msg", definition.as_bytes())
        .unwrap();
    let topic = writer
        .add_channel(schema, "/a", "cdr", &std::collections::BTreeMap::default())
        .unwrap();
    for row in 0..3 {
        let header = MessageHeader {
            channel_id: topic,
            sequence: row,
            log_time: 1000 * u64::from(row),
            publish_time: 0,
        };
        let data = [&CDR, content].concat();
        writer.write_to_known_channel(&header, &data).unwrap();
    }
    writer.finish().unwrap();
}

fn map_of_a_bag(folder: &Folder, column: &str) {
    let keys = "form = \"bag\"\n".to_owned() + &channel("force", column, "N");
    folder.map("map.toml", &keys);
}

/// Definitions of more messages, behind the first.
fn and(others: &[(String, String)]) -> String {
    let rule = "=".repeat(80);
    let more = others
        .iter()
        .map(|(name, fields)| format!("\n{rule}\nMSG: a/{name}\n{fields}"));
    more.collect()
}

#[test]
fn definitions_of_messages_without_end_are_refused_before_a_message_is_read() {
    let chain = |count: usize, fields: &dyn Fn(usize) -> String| -> Vec<(String, String)> {
        let of = |k: usize| match k {
            0 => "float64 x".to_owned(),
            k => fields(k - 1),
        };
        (0..count).map(|k| (format!("M{k}"), of(k))).collect()
    };
    let one = |name: &str, fields: &str| vec![(name.to_owned(), fields.to_owned())];
    // Each is seen before the one that holds it, so that none is deep when it is met.
    let all: String = (0..5000).map(|k| format!("M{k} f{k}\n")).collect();
    for (first, others, says) in [
        // The first definition is known to no other, itself included.
        ("float64 x\nA a", vec![], "does not fit its definition"),
        ("float64 x\nB b", one("B", "B b"), "a/B contain themselves"),
        ("float64 x\nB b", one("B", "B[] b"), "contain themselves"),
        (
            "float64 x\nB b",
            [one("B", "C c"), one("C", "B b")].concat(),
            "contain themselves",
        ),
        (
            "float64 x\nB[2000000000] b",
            one("B", "float64 y"),
            "16000 MB",
        ),
        ("float64 x\nfloat64[2000000000] b", vec![], "16000 MB"),
        (
            "float64 x\nM30 b",
            chain(31, &|k| format!("M{k} a\nM{k} b")),
            "messages in them",
        ),
        (&all, chain(5000, &|k| format!("M{k} a")), "32 deep"),
    ] {
        let folder = Folder::new();
        of_definition(&folder, &(first.to_owned() + &and(&others)), &[0; 64]);
        map_of_a_bag(&folder, "\"/a.x\"");
        refused(&folder, &["log.mcap"], &["log.mcap", "definition", says]);
    }
}

#[test]
fn lists_that_claim_more_than_their_message_holds_are_refused() {
    let claims = 90_000_000u32.to_le_bytes();
    let content = [&[0; 8], &claims[..], &[0; 32]].concat();
    for (definition, says) in [
        ("float64 x\nB[] b", "a list of 90000000 messages"),
        ("float64 x\nfloat64[] b", "does not fit its definition"),
    ] {
        let folder = Folder::new();
        let others = [("B".to_owned(), "uint8 y".to_owned())];
        of_definition(&folder, &(definition.to_owned() + &and(&others)), &content);
        map_of_a_bag(&folder, "\"/a.x\"");
        refused(&folder, &["log.mcap"], &["log.mcap", says]);
    }
}

/// An MCAP of one chunk that is packed with zstd, of zeros, and says that it holds so many.
fn of_chunk(zeros: usize, claimed: u64) -> Vec<u8> {
    let record = |opcode: u8, body: &[u8]| {
        let length = (body.len() as u64).to_le_bytes();
        [&[opcode], &length[..], body].concat()
    };
    // A record of a kind that nobody knows.
    let mut plain = vec![0x80];
    plain.extend((zeros as u64).to_le_bytes());
    plain.resize(plain.len() + zeros, 0);
    let packed = zstd::encode_all(&plain[..], 1).unwrap();
    let mut chunk = [0; 16].to_vec();
    chunk.extend(claimed.to_le_bytes());
    chunk.extend(7u32.to_le_bytes());
    chunk.extend(4u32.to_le_bytes());
    chunk.extend(b"zstd");
    chunk.extend((packed.len() as u64).to_le_bytes());
    chunk.extend(packed);
    [mcap::MAGIC, &record(1, &[0; 8]), &record(6, &chunk)].concat()
}

#[test]
fn chunks_that_come_to_more_than_their_file_can_are_refused_with_the_key_that_takes_them() {
    let folder = Folder::new();
    map_of_a_bag(&folder, "\"/a.x\"");
    folder.write("log.mcap", of_chunk(300_000_000, 300_000_009));
    refused(
        &folder,
        &["log.mcap"],
        &["more than 256 MB unpacked", "`largest_mb`", "--largest-mb"],
    );
    folder.write("log.mcap", of_chunk(100, 1 << 62));
    refused(&folder, &["log.mcap"], &["more than 256 MB unpacked"]);
    // With the key it is read as far as it goes, and its check sum is wrong.
    folder.write("log.mcap", of_chunk(2_000_000, 2_000_009));
    refused(&folder, &["log.mcap"], &["Chunk CRC failed"]);
    let keys = "form = \"bag\"\nlargest_mb = 1\n".to_owned() + &channel("force", "\"/a.x\"", "N");
    folder.map("map.toml", &keys);
    refused(&folder, &["log.mcap"], &["more than 1.0 MB unpacked"]);
}

#[test]
fn what_sql_computes_is_no_table_of_a_bag() {
    let endless = "WITH RECURSIVE n(i) AS (SELECT 1 UNION ALL SELECT i + 1 FROM n)";
    let messages = format!(
        "CREATE VIEW messages AS {endless} SELECT i AS id, 1 AS topic_id, i AS timestamp, x'00' AS data FROM n;"
    );
    let large = "CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER, timestamp INTEGER, data BLOB GENERATED ALWAYS AS (zeroblob(900000000)));";
    let topics = format!(
        "CREATE VIEW topics AS {endless} SELECT i AS id, 'a' AS name, 'b' AS type, 'cdr' AS serialization_format FROM n;"
    );
    let definitions = format!(
        "CREATE VIEW message_definitions AS {endless} SELECT 'a' AS topic_type, 'b' AS encoding, 'c' AS encoded_message_definition FROM n;"
    );
    let lie = "PRAGMA writable_schema = ON; UPDATE sqlite_master SET type = 'table' WHERE name = 'messages';";
    let without = |table: &str| format!("DROP TABLE {table};");
    for (script, says) in [
        (
            without("messages") + &messages,
            "its `messages` is no plain table",
        ),
        (
            without("messages") + &messages + lie,
            "malformed database schema (messages)",
        ),
        (
            without("messages") + large,
            "its `messages` is no plain table",
        ),
        (
            without("topics") + &topics,
            "its `topics` is no plain table",
        ),
        (definitions, "its `message_definitions` is no plain table"),
    ] {
        let folder = Folder::new();
        bags::bag(&folder, "log.db3", 0..3, false);
        let base = Connection::open(folder.path("log.db3")).unwrap();
        base.execute_batch(&script).unwrap();
        drop(base);
        folder.map("map.toml", &bags::map());
        refused(&folder, &["log.db3"], &["log.db3", says]);
    }
}

#[test]
fn packed_logs_that_unpack_without_end_are_refused() {
    let zeros = vec![0; 1 << 20];
    let folder = Folder::new();
    let mut text = GzEncoder::new(Vec::new(), Compression::best());
    // As an array of doubles, of a name and of many numbers.
    let mut array = ZlibEncoder::new(Vec::new(), Compression::best());
    let words: [u32; 14] = [
        14,
        300_000_048,
        6,
        8,
        6,
        0,
        5,
        8,
        37_500_000,
        1,
        0x1_0001,
        u32::from(b't'),
        9,
        300_000_000,
    ];
    for word in words {
        array.write_all(&word.to_le_bytes()).unwrap();
    }
    for _ in 0..300 {
        text.write_all(&zeros).unwrap();
        array.write_all(&zeros).unwrap();
    }
    folder.write("log.csv.gz", text.finish().unwrap());
    let array = array.finish().unwrap();
    let mut mat = b"MATLAB 5.0 MAT-file".to_vec();
    mat.resize(124, b' ');
    mat.extend([0, 1, b'I', b'M', 15, 0, 0, 0]);
    mat.extend((array.len() as u32).to_le_bytes());
    mat.extend(array);
    folder.write("log.mat", mat);
    let time = "time = { column = \"t\", unit = \"s\" }\n";
    let force = channel("force", "\"F\"", "N");
    let says = ["more than", "unpacked", "`largest_mb`"];
    folder.map("map.toml", &format!("form = \"mat5\"\n{time}{force}"));
    refused(&folder, &["log.mat"], &says);
    folder.map(
        "map.toml",
        &format!("form = \"text\"\nnames_line = 1\n{time}{force}"),
    );
    refused(&folder, &["log.csv.gz"], &says);
    for log in ["log.mat", "log.csv.gz"] {
        let outcome = folder.run(&["new", "import", "--from", log, "draft.toml"]);
        assert_eq!(outcome.code, 2, "{}", outcome.err);
        assert!(outcome.only_line("error: ").contains("--largest-mb"));
    }
}

#[test]
fn a_text_of_more_rows_than_can_be_held_is_refused_with_the_key_that_takes_them() {
    let folder = Folder::new();
    folder.write("log.csv", "F\n".to_owned() + &"1\n".repeat(20_000));
    let force = channel("force", "\"F\"", "N");
    let map = |largest: u64| {
        let keys = "form = \"text\"\nnames_line = 1\nsample_rate_hz = 100\n";
        folder.map(
            "map.toml",
            &format!("{keys}largest_mb = {largest}\n{force}"),
        );
    };
    map(1);
    let says = ["more than 15625 rows", "`largest_mb`", "--largest-mb"];
    refused(&folder, &["log.csv"], &says);
    map(2);
    let outcome = folder.run(&["import", "map.toml", "log.csv"]);
    assert_eq!(outcome.code, 0, "{}", outcome.err);
    let draft = ["new", "import", "--from", "log.csv", "draft.toml"];
    let outcome = folder.run(&[&draft[..], &["--largest-mb", "1"]].concat());
    assert_eq!(outcome.code, 2, "{}", outcome.err);
    assert!(outcome.only_line("error: ").contains("15625 rows"));
}

#[cfg(unix)]
#[test]
fn what_is_no_file_is_neither_waited_for_nor_read() {
    let folder = Folder::new();
    let made = Command::new("mkfifo").arg(folder.path("pipe")).status();
    assert!(made.unwrap().success());
    let keys = "form = \"text\"\nnames_line = 1\nsample_rate_hz = 100\n";
    folder.map(
        "map.toml",
        &(keys.to_owned() + &channel("force", "\"F\"", "N")),
    );
    refused(
        &folder,
        &["pipe"],
        &["pipe", "a pipe, expected a regular file"],
    );
    refused(&folder, &["/dev/zero"], &["/dev/zero", "a device"]);
    refused(&folder, &["."], &["a folder"]);
    for arguments in [
        &["check", "pipe"][..],
        &["check", "/dev/zero"],
        &["run", "pipe", "--out", "out"],
        &["import", "pipe"],
        &["edges", "pipe", "--unit", "mm"],
        &["edges", "/dev/zero", "--unit", "mm"],
        &["new", "import", "--from", "pipe", "draft.toml"],
        &["new", "arm", "--urdf", "pipe", "arm.toml"],
    ] {
        let outcome = folder.run(arguments);
        assert_eq!(outcome.code, 2, "{arguments:?}: {}", outcome.err);
        let line = outcome.only_line("error: ");
        let says = line.contains("a pipe") || line.contains("a device");
        assert!(says, "{arguments:?}: {line}");
    }
}
