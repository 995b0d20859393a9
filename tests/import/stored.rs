//! Bags as recorders leave them: stamps of zero, parts that are lost, messages that are packed, files that were not closed; and what of them is drafted.

use rusqlite::{Connection, params};

use super::bags::{PRESSURE, bag, map};
use super::files::{ROWS, START, truth};
use super::refused::refused;
use super::{FORCE, Folder, STROKE, assert_planted, channel};

/// Rewrites the messages of a bag; `topic` from 1.
fn rewrite(folder: &Folder, name: &str, of: impl Fn(i64, i64, Vec<u8>) -> Vec<u8>) {
    let mut connection = Connection::open(folder.path(name)).unwrap();
    let read: Vec<(i64, i64, Vec<u8>)> = {
        let mut all = connection
            .prepare("SELECT id, topic_id, data FROM messages ORDER BY id")
            .unwrap();
        let rows = all.query_map([], |row| Ok((row.get(0)?, row.get(1)?, row.get(2)?)));
        rows.unwrap().collect::<Result<_, _>>().unwrap()
    };
    let write = connection.transaction().unwrap();
    for (id, topic, data) in read {
        let update = "UPDATE messages SET data = ? WHERE id = ?";
        write
            .execute(update, params![of(id, topic, data), id])
            .unwrap();
    }
    write.commit().unwrap();
}

/// A message whose stamp is zero: seconds and nanoseconds stand behind the header of CDR.
fn unstamped(mut data: Vec<u8>) -> Vec<u8> {
    data[4..12].fill(0);
    data
}

fn drafted(folder: &Folder, log: &str) -> String {
    let outcome = folder.run(&["new", "import", "draft.toml", "--force", "--from", log]);
    assert_eq!(outcome.code, 0, "{}", outcome.err);
    std::fs::read_to_string(folder.path("draft.toml")).unwrap()
}

#[test]
fn a_stamp_of_zero_is_none() {
    let folder = Folder::new();
    bag(&folder, "ride.db3", 0..ROWS, true);
    // The first ten rows have six messages each.
    rewrite(&folder, "ride.db3", |id, _, data| {
        if id <= 60 { unstamped(data) } else { data }
    });
    folder.map("map.toml", &map());
    let (stored, said) = folder.imported("map.toml", &["ride.db3"]);
    assert!(
        said.contains("whose stamp is 0, which is none, were left out: 10"),
        "{said}"
    );
    let recording = stored.recording;
    assert_eq!(recording.sample_count(), ROWS - 10);
    let span = recording.time().last().unwrap() - recording.time()[0];
    assert!(
        (span - (truth(ROWS - 1).time - truth(10).time)).abs() < 1e-9,
        "{span}"
    );
    for (row, force) in recording.values("force").unwrap().iter().enumerate() {
        assert!((force - truth(row + 10).force).abs() < 1e-9);
    }
    let draft = drafted(&folder, "ride.db3");
    assert!(
        draft.contains("column = \"header.stamp\"") && draft.contains("of 2400 messages are 0"),
        "{draft}"
    );
    rewrite(&folder, "ride.db3", |_, _, data| unstamped(data));
    std::fs::remove_file(folder.path("draft.toml")).unwrap();
    std::fs::remove_file(folder.path("out.parquet")).unwrap();
    refused(
        &folder,
        &["ride.db3"],
        &["holds 0 in all 400 messages", "`log_time`"],
    );
    let draft = drafted(&folder, "ride.db3");
    assert!(
        draft.contains("time = { column = \"log_time\" }")
            && draft.contains("certain: the stamps of all messages are 0"),
        "{draft}"
    );
}

#[test]
fn times_of_zero_among_those_since_1970_are_none_in_a_text_too() {
    let folder = Folder::new();
    folder.map(
        "map.toml",
        &("form = \"text\"\nnames_line = 1\ntime = { column = \"t\", unit = \"s\" }\n".to_owned()
            + &channel("force", "\"F\"", "N")),
    );
    let mut text = "t,F\n0,7\n".to_owned();
    for row in 0..ROWS {
        text += &format!(
            "{:.3},{}\n",
            START as f64 + truth(row).time,
            truth(row).force
        );
    }
    folder.write("log.csv", text);
    let (stored, said) = folder.imported("map.toml", &["log.csv"]);
    assert_eq!(stored.recording.sample_count(), ROWS);
    assert!(said.contains("left out: 1 (line 2)"), "{said}");
    assert!(stored.recording.time()[0] < 1.0);
}

#[test]
fn a_lost_part_is_named() {
    let folder = Folder::new();
    std::fs::create_dir(folder.path("ride")).unwrap();
    let mut list = String::new();
    for part in 0..5 {
        let rows = ROWS * part / 5..ROWS * (part + 1) / 5;
        bag(&folder, &format!("ride/ride_{part}.db3"), rows, true);
        list += &format!("  - ride_{part}.db3\n");
    }
    let about = format!(
        "rosbag2_bagfile_information:\n  message_count: 2400\n  relative_file_paths:\n{list}"
    );
    folder.write("ride/metadata.yaml", about);
    folder.map("map.toml", &map());
    let (stored, _) = folder.imported("map.toml", &["ride"]);
    assert_planted(&stored.recording, &[STROKE, FORCE, PRESSURE]);
    // A bag beside it is none of its parts.
    bag(&folder, "ride/other_0.db3", 0..ROWS, true);
    let (stored, said) = folder.imported("map.toml", &["ride"]);
    assert_planted(&stored.recording, &[STROKE, FORCE]);
    assert!(
        said.contains("other_0.db3 is not among the files"),
        "{said}"
    );
    std::fs::remove_file(folder.path("ride/ride_2.db3")).unwrap();
    std::fs::remove_file(folder.path("out.parquet")).unwrap();
    refused(
        &folder,
        &["ride"],
        &["names ride_2.db3, not there", "accept_truncated"],
    );
    assert!(drafted(&folder, "ride").contains("names ride_2.db3, not there"));
    folder.map(
        "map.toml",
        &("accept_truncated = true\n".to_owned() + &map()),
    );
    let (stored, said) = folder.imported("map.toml", &["ride"]);
    assert_eq!(stored.recording.sample_count(), ROWS * 4 / 5);
    assert!(said.contains("ride_2.db3"), "{said}");
}

#[test]
fn messages_that_are_packed_are_unpacked() {
    let folder = Folder::new();
    bag(&folder, "ride.db3", 0..ROWS, true);
    rewrite(&folder, "ride.db3", |_, _, data| {
        zstd::encode_all(&data[..], 1).unwrap()
    });
    folder.map("map.toml", &map());
    let (stored, _) = folder.imported("map.toml", &["ride.db3"]);
    assert_planted(&stored.recording, &[STROKE, FORCE, PRESSURE]);
    assert!(drafted(&folder, "ride.db3").contains("column = \"/wrench.wrench.force.z\""));
    let file = std::fs::read(folder.path("ride.db3")).unwrap();
    folder.write("ride.db3.zstd", zstd::encode_all(&file[..], 1).unwrap());
    let (stored, _) = folder.imported("map.toml", &["ride.db3.zstd"]);
    assert_planted(&stored.recording, &[STROKE, FORCE, PRESSURE]);
}

#[test]
fn a_bag_that_was_not_closed_is_read_with_its_journal() {
    let folder = Folder::new();
    bag(&folder, "ride.db3", 0..ROWS - 100, true);
    // Written ahead and never taken over, as by a recorder that was killed.
    let recorder = Connection::open(folder.path("ride.db3")).unwrap();
    recorder
        .execute_batch("PRAGMA journal_mode = WAL; PRAGMA wal_autocheckpoint = 0;")
        .unwrap();
    bag(&folder, "rest.db3", ROWS - 100..ROWS, true);
    recorder
        .execute_batch(&format!(
            "ATTACH '{}' AS rest; INSERT INTO messages(topic_id, timestamp, data) SELECT topic_id, timestamp, data FROM rest.messages ORDER BY id; DETACH rest;",
            folder.path("rest.db3").display()
        ))
        .unwrap();
    folder.map("map.toml", &map());
    let (stored, said) = folder.imported("map.toml", &["ride.db3"]);
    assert_planted(&stored.recording, &[STROKE, FORCE, PRESSURE]);
    assert!(
        said.contains("it was not closed: its journal ride.db3-wal was read with it"),
        "{said}"
    );
    drop(recorder);
    // An MCAP without what closes it.
    super::files::mcap(&folder.path("log.mcap"), None);
    let bytes = std::fs::read(folder.path("log.mcap")).unwrap();
    folder.write("log.mcap", &bytes[..bytes.len() * 2 / 3]);
    let keys = "time = { column = \"header.stamp\" }\n".to_owned()
        + &channel("force", "\"/wrench.wrench.force.z\"", "N");
    folder.map("map.toml", &("form = \"bag\"\n".to_owned() + &keys));
    std::fs::remove_file(folder.path("out.parquet")).unwrap();
    refused(
        &folder,
        &["log.mcap"],
        &["it was not closed, or is cut off", "can be read"],
    );
    folder.map(
        "map.toml",
        &("form = \"bag\"\naccept_truncated = true\n".to_owned() + &keys),
    );
    let (stored, _) = folder.imported("map.toml", &["log.mcap"]);
    for (row, force) in stored.recording.values("force").unwrap().iter().enumerate() {
        assert!((force - truth(row).force).abs() < 1e-9);
    }
}

#[test]
fn joints_are_drafted_as_joints_and_variances_as_nothing() {
    let folder = Folder::new();
    bag(&folder, "ride.db3", 0..ROWS, true);
    let draft = drafted(&folder, "ride.db3");
    assert!(!draft.contains("variance"), "{draft}");
    for (quantity, joint) in [("joint_1_encoder", "elbow"), ("joint_2_encoder", "wrist")] {
        let table = draft
            .split("[[file.channel]]")
            .find(|table| table.contains(quantity));
        let table = table.unwrap_or_else(|| panic!("{draft}\nlacks {quantity}"));
        assert!(
            table.contains(&format!("joint = \"{joint}\"")) && table.contains("unit = \"rad\""),
            "{table}"
        );
    }
    let answered = draft.replace("# frame = \"tool0\"", "frame = \"tool0\"");
    folder.write("draft.toml", answered);
    let (stored, _) = folder.imported("draft.toml", &["ride.db3"]);
    assert!(
        stored
            .recording
            .values("joint_1_encoder")
            .unwrap()
            .iter()
            .all(|angle| *angle == -1.5)
    );
    assert!(
        stored
            .recording
            .values("joint_2_encoder")
            .unwrap()
            .iter()
            .all(|angle| *angle == 0.25)
    );
}

#[test]
fn a_database_that_is_no_bag_says_so() {
    let folder = Folder::new();
    let connection = Connection::open(folder.path("log.db3")).unwrap();
    connection
        .execute_batch("CREATE TABLE samples(t REAL, f REAL);")
        .unwrap();
    drop(connection);
    folder.map("map.toml", &map());
    refused(
        &folder,
        &["log.db3"],
        &["no tables `topics` and `messages`"],
    );
}
