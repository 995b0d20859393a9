//! Logs and maps that are refused: one line, exit code 2, nothing written.

use idc_cell::recording::parquet::read_parquet;

use super::files::{self, truth, whole};
use super::{Folder, channel, plain};

/// Imports into `out.parquet` and expects to be refused in these words.
pub fn refused(folder: &Folder, logs: &[&str], says: &[&str]) {
    let before = folder.names(".");
    let outcome = folder.idc(&[&["map.toml"], logs, &["--out", "out.parquet"]].concat());
    let line = outcome.only_line("error: ");
    for words in says {
        assert!(line.contains(words), "{line}\nlacks {words:?}");
    }
    assert_eq!(outcome.sentences(), line, "more than the one line");
    assert_eq!((outcome.code, outcome.out.as_str()), (2, ""), "{line}");
    assert_eq!(folder.names("."), before, "{line}");
}

/// The map of [`plain`] with other words in it.
fn spoiled(from: &str, to: &str, says: &[&str]) {
    let folder = Folder::new();
    plain(&folder, &["log.csv"]);
    let map = std::fs::read_to_string(folder.path("map.toml")).unwrap();
    assert!(map.contains(from), "{map}");
    folder.write("map.toml", map.replacen(from, to, 1));
    refused(&folder, &["log.csv"], says);
}

#[test]
fn maps_that_do_not_fit() {
    spoiled(
        "\"F\"",
        "\"f\"",
        &["log.csv has no column `f`; there are `F`, `t`"],
    );
    spoiled(
        "\"F\"",
        "7",
        &["log.csv has no column 7; there are 2 columns"],
    );
    spoiled(
        "\"F\"",
        "0",
        &[
            "map.toml:10:10",
            "a column's number from 1, or its name in quotes",
        ],
    );
    spoiled(
        "names_line = 1",
        "header_lines = 1",
        &["2 columns without names", "`names_line`"],
    );
    spoiled(
        "unit = \"N\"",
        "unit = \"bar\"",
        &[
            "map.toml:11:1",
            "`file[0].channel[0].unit` is \"bar\", expected one of N, kN",
        ],
    );
    spoiled(
        "unit = \"N\"",
        "unit = \"V\"",
        &["is \"V\", expected one of N, kN", "`gain` makes of them"],
    );
    spoiled(
        "unit = \"N\"",
        "unit = \"furlong\"",
        &["is \"furlong\", expected one of N, kN"],
    );
    spoiled(
        "unit = \"ms\"",
        "unit = \"mm\"",
        &["file[0].time.unit", "expected one of s, ms"],
    );
    spoiled(
        "separator",
        "seperator",
        &["`file[0].seperator`", "did you mean `separator`?"],
    );
    spoiled(
        "unit = \"N\"",
        "units = \"N\"",
        &["units", "did you mean `unit`?"],
    );
    spoiled(", unit = \"ms\"", "", &["unit", "one of s, ms"]);
    spoiled(
        "form = \"text\"",
        "form = \"mcap\"",
        &["only a text has it"],
    );
    spoiled(
        "\"F\"\n",
        "\"F\"\npressure = \"gauge\"\n",
        &["N is no unit of a pressure"],
    );
    spoiled(
        "form = \"text\"",
        "form = \"text\"\ndecimal_mark = \";\"",
        &["another character than between fields"],
    );
}

#[test]
fn texts_that_are_not_what_the_map_says() {
    let spoil = |line: usize, with: &str, says: &[&str]| {
        let folder = Folder::new();
        plain(&folder, &["log.csv"]);
        let text = std::fs::read_to_string(folder.path("log.csv")).unwrap();
        let mut lines: Vec<&str> = text.lines().collect();
        lines[line - 1] = with;
        folder.write("log.csv", lines.join("\n") + "\n");
        refused(&folder, &["log.csv"], says);
    };
    spoil(
        5,
        "1006;over",
        &["log.csv:5: column `F` is `over`, expected a number"],
    );
    spoil(
        5,
        "1006;12,5",
        &[
            "log.csv:5: column `F` is `12,5`",
            "mixes both marks",
            "write line 5 as `12.5`",
        ],
    );
    spoil(
        5,
        "1.006.000;12",
        &["column `t` is `1.006.000`", "`thousands_mark = \".\"`"],
    );
    // Bytes of code page 850 in a name, marks of both kinds, a date without a year.
    let folder = Folder::new();
    plain(&folder, &["log.csv"]);
    let text = std::fs::read(folder.path("log.csv")).unwrap();
    folder.write("log.csv", [&b"Dr\x81cken;\x84\n"[..], &text].concat());
    refused(
        &folder,
        &["log.csv"],
        &[
            "the encoding of log.csv cannot be determined: line 1 holds the byte 0x81",
            "encoding = \"windows-1252\"",
        ],
    );
    let text = "t;F\n1;0,5\n2;1,25\n3;2.5\n4;3,5\n";
    folder.write("log.csv", text);
    let map = std::fs::read_to_string(folder.path("map.toml")).unwrap();
    let with_comma = map.replace("names_line", "decimal_mark = \",\"\nnames_line");
    folder.write("map.toml", &with_comma);
    refused(
        &folder,
        &["log.csv"],
        &[
            "log.csv:4: column `F` is `2.5`",
            "`0,5` of line 2",
            "mixes both marks",
            "write line 4 as `2,5`",
        ],
    );
    let stamped = map.replace(", unit = \"ms\"", "");
    folder.write("map.toml", &stamped);
    folder.write("log.csv", "t;F\n05.03. 14:02:03;1\n05.03. 14:02:04;2\n");
    refused(
        &folder,
        &["log.csv"],
        &[
            "log.csv:2: column `t` is `05.03. 14:02:03`",
            "`year = 2024` in [file.time]",
        ],
    );
    folder.write(
        "log.csv",
        "t;F\n03/05/2024 14:02:03;1\n03/05/2024 14:02:04;2\n",
    );
    refused(
        &folder,
        &["log.csv"],
        &["`date_order = \"day-month-year\"`", "day 3 of month 5"],
    );
    // A thousand with its mark is no one.
    folder.write("map.toml", &with_comma);
    folder.write("log.csv", "t;F\n998;1,5\n999;2,5\n1.000;3,5\n");
    refused(
        &folder,
        &["log.csv"],
        &[
            "log.csv:4: column `t` is `1.000`",
            "`thousands_mark = \".\"` makes 1000 of it",
        ],
    );
    folder.write("map.toml", &map);
    folder.write("log.csv", "t;F\n998;1\n999;2\n1.000;3\n");
    refused(
        &folder,
        &["log.csv"],
        &["it fell to a thousandth", "thousands_mark"],
    );
    spoil(5, "1006", &["log.csv:5: 1 fields, expected at least 2"]);
    spoil(5, "900;12", &["log.csv:5: time 0.9 s after 1.004 s"]);
    let folder = Folder::new();
    plain(&folder, &["log.csv"]);
    folder.write("log.csv", "t;F\n");
    refused(&folder, &["log.csv"], &["no rows after 1 header lines"]);
    refused(&folder, &["nolog.csv"], &["cannot read nolog.csv"]);
    refused(&folder, &[], &["names no file", "give one after the map"]);
}

#[test]
fn logs_of_different_times_and_clocks_that_cannot_be_found() {
    let folder = Folder::new();
    plain(&folder, &["a.csv"]);
    files::text(&folder.path("b.csv"), "", |row| {
        format!("{},{}", 100.0 + 0.01 * row as f64, row % 2)
    });
    let map = std::fs::read_to_string(folder.path("map.toml")).unwrap();
    let second = |clock: &str| {
        format!(
            "{map}[[file]]\nform = \"text\"\n{clock}time = {{ column = 1, unit = \"s\" }}\n{}",
            channel("stroke", "2", "mm")
        )
    };
    folder.write("map.toml", second(""));
    refused(
        &folder,
        &["a.csv", "b.csv"],
        &[
            "b.csv goes from 100.000 to 103.990 s",
            "does not overlap a.csv",
            "`clock_offset_s`",
        ],
    );
    refused(&folder, &["a.csv"], &["1 logs were given, expected 2"]);
    folder.write(
        "map.toml",
        second(
            "clock = \"unknown\"\naligned_by = [\"force\", \"stroke\"]\nlargest_offset_s = 110.0\n",
        ),
    );
    refused(
        &folder,
        &["a.csv", "b.csv"],
        &["b.csv: its clock cannot be found", "`stroke`", "`force`"],
    );
}

#[test]
fn recordings_that_would_take_each_others_place_or_a_logs() {
    let folder = Folder::new();
    plain(&folder, &["log.csv"]);
    std::fs::create_dir(folder.path("other")).unwrap();
    std::fs::copy(folder.path("log.csv"), folder.path("other/log.csv")).unwrap();
    refused(
        &folder,
        &["log.csv", "other/log.csv"],
        &["log.csv and other/log.csv would both be written to out.parquet/log.parquet"],
    );
    files::parquet(&folder.path("out.parquet"));
    let keys = "form = \"parquet\"\ntime = { column = \"stamp\" }\n".to_owned();
    folder.map(
        "map.toml",
        &(keys + &channel("force", "\"force_kn\"", "kN")),
    );
    refused(
        &folder,
        &["out.parquet"],
        &["--out is out.parquet, which is read here"],
    );
}

#[test]
fn columns_that_a_parquet_or_a_mat_file_does_not_have() {
    let folder = Folder::new();
    files::parquet(&folder.path("log.parquet"));
    let map = |time: &str, column: &str, form: &str| {
        let keys = format!("form = \"{form}\"\ntime = {{ {time} }}\n");
        folder.map("map.toml", &(keys + &channel("force", column, "N")));
    };
    map("column = \"stamp\"", "\"force\"", "parquet");
    refused(
        &folder,
        &["log.parquet"],
        &["no column `force`; there are `force_kn`,"],
    );
    map(
        "column = \"stamp\", unit = \"us\"",
        "\"force_kn\"",
        "parquet",
    );
    refused(
        &folder,
        &["log.parquet"],
        &["`stamp` holds stamps", "no `unit = \"us\"`"],
    );
    map("column = \"stroke_mm\"", "\"force_kn\"", "parquet");
    refused(
        &folder,
        &["log.parquet"],
        &["`stroke_mm` holds numbers", "one of s, ms"],
    );
    files::mat5(&folder.path("log.mat"), true);
    map("column = \"t\", unit = \"ms\"", "\"data\"", "mat5");
    refused(
        &folder,
        &["log.mat"],
        &[
            "no column `data`; there are `data(:,1)`, `data(:,2)`, `t`, `u`, and 1 that are no arrays",
        ],
    );
    folder.write("log.mat", b"MATLAB 7.3 MAT-file");
    refused(&folder, &["log.mat"], &["version 7.3", "'-v7'"]);
    folder.write("log.mat", b"PK");
    refused(&folder, &["log.mat"], &["no MAT file of version 5"]);
}

#[test]
fn fields_that_a_bag_does_not_have() {
    let folder = Folder::new();
    files::mcap(&folder.path("log.mcap"), None);
    let says = |time: &str, column: &str, says: &[&str]| {
        let keys = format!("form = \"mcap\"\n{time}");
        folder.map("map.toml", &(keys + &channel("force", column, "N")));
        refused(&folder, &["log.mcap"], says);
    };
    says(
        "",
        "\"/wrnch.wrench.force.z\"",
        &["no column `/wrnch.wrench.force.z`", "the topics `/wrench`"],
    );
    says(
        "",
        "\"/wrench.wrench.fource.z\"",
        &["there are `/wrench.wrench.force.z`"],
    );
    says(
        "",
        "\"/wrench.wrench\"",
        &["is a message, expected a number"],
    );
    says(
        "",
        "\"/wrench.header.frame_id\"",
        &["is a text, expected a number"],
    );
    says(
        "",
        "\"/joint_states.position\"",
        &["is a list", "`/joint_states.position[0]`"],
    );
    says(
        "",
        "\"/joint_states.position[7]\"",
        &["in none of the 80 messages", "counted from 0"],
    );
    says("", "3", &["is the number 3, expected a topic and a field"]);
    says(
        "",
        "\"/camera.data\"",
        &["encoding `protobuf`", "`ros2msg`"],
    );
    says(
        "time = { column = \"header.stamp\" }\n",
        "\"/set.data\"",
        &["no column `header.stamp`", "log_time, publish_time", "/set"],
    );
    says(
        "time = { column = \"log_time\", unit = \"ns\" }\n",
        "\"/set.data\"",
        &["no `unit = \"ns\"`"],
    );
    folder.write("log.mcap", b"bag");
    says("", "\"/set.data\"", &["it is no MCAP"]);
}

/// Cuts the end off a file.
fn cut(folder: &Folder, name: &str, kept: f64) {
    let bytes = std::fs::read(folder.path(name)).unwrap();
    let length = (kept * bytes.len() as f64) as usize;
    folder.write(name, &bytes[..length]);
}

/// Samples of what is imported with a map that accepts what is left.
fn accepted(folder: &Folder, log: &str, says: &str) -> usize {
    let map = std::fs::read_to_string(folder.path("map.toml")).unwrap();
    folder.write(
        "map.toml",
        map.replacen("[[file]]", "[[file]]\naccept_truncated = true", 1),
    );
    let (stored, said) = folder.imported("map.toml", &[log]);
    assert!(
        said.contains(says) && said.contains("as the map accepts"),
        "{said}"
    );
    for (row, time) in stored.recording.time().iter().enumerate() {
        let since = truth(row).time - truth(0).time;
        assert!((time - stored.recording.time()[0] - since).abs() < 1e-9);
    }
    stored.recording.sample_count()
}

#[test]
fn a_text_with_a_torn_last_line() {
    let folder = Folder::new();
    plain(&folder, &["log.csv"]);
    let text = std::fs::read_to_string(folder.path("log.csv")).unwrap();
    folder.write("log.csv", format!("{text}{}", whole(400).0));
    refused(
        &folder,
        &["log.csv"],
        &[
            "log.csv is cut off or damaged: its last row, line 402, ends after 1 of 2 fields; the 400 rows before it can be read",
            "accept_truncated",
        ],
    );
    assert_eq!(accepted(&folder, "log.csv", "line 402, is torn"), 400);

    files::text(&folder.path("log.txt"), "", |row| {
        format!("{:>6}{:>9}", whole(row).0, whole(row).1)
    });
    cut(&folder, "log.txt", 0.997);
    let keys = "form = \"text\"\nfield_widths = [6, 9]\ntime = { column = 1, unit = \"ms\" }\n";
    folder.map(
        "map.toml",
        &(keys.to_owned() + &channel("stroke", "2", "um")),
    );
    refused(
        &folder,
        &["log.txt"],
        &["line 399, ends after 1 of 2 fields; the 398 rows"],
    );
}

#[test]
fn a_bag_that_is_cut_off() {
    for compression in [
        None,
        Some(mcap::Compression::Zstd),
        Some(mcap::Compression::Lz4),
    ] {
        let folder = Folder::new();
        files::mcap(&folder.path("log.mcap"), compression);
        cut(&folder, "log.mcap", 0.5);
        let keys = "form = \"mcap\"\ntime = { column = \"header.stamp\" }\n".to_owned();
        folder.map(
            "map.toml",
            &(keys + &channel("force", "\"/wrench.wrench.force.z\"", "N")),
        );
        refused(
            &folder,
            &["log.mcap"],
            &[
                "log.mcap is cut off or damaged",
                "messages can be read, the last of them 0.",
                "`mcap recover`",
                "accept_truncated",
            ],
        );
        let samples = accepted(&folder, "log.mcap", "messages can be read");
        assert!((100..300).contains(&samples), "{samples}");
    }
}

#[test]
fn of_a_bag_that_is_damaged_nothing_is_read_but_what_was_written() {
    let folder = Folder::new();
    files::mcap(&folder.path("log.mcap"), None);
    let mut bytes = std::fs::read(folder.path("log.mcap")).unwrap();
    // A bit in the force of a message in the last chunks.
    let force = truth(350).force.to_le_bytes();
    let place = bytes.windows(8).position(|window| window == force).unwrap();
    bytes[place + 3] ^= 1;
    folder.write("log.mcap", bytes);
    let keys = "form = \"mcap\"\ntime = { column = \"header.stamp\" }\n".to_owned();
    folder.map(
        "map.toml",
        &(keys + &channel("force", "\"/wrench.wrench.force.z\"", "N")),
    );
    refused(&folder, &["log.mcap"], &["Chunk CRC failed"]);
    let samples = accepted(&folder, "log.mcap", "Chunk CRC failed");
    assert!((100..350).contains(&samples), "{samples}");
    let stored = read_parquet(&folder.path("out.parquet")).unwrap();
    let read = stored.recording.values("force").unwrap();
    assert!((0..samples).all(|row| read[row] == truth(row).force));
}

#[test]
fn a_mat_file_that_is_cut_off() {
    let folder = Folder::new();
    files::mat5(&folder.path("log.mat"), false);
    cut(&folder, "log.mat", 0.9);
    let keys = "form = \"mat5\"\ntime = { column = \"t\", unit = \"ms\" }\n".to_owned();
    folder.map(
        "map.toml",
        &(keys.clone() + &channel("force", "\"data(:,2)\"", "N")),
    );
    refused(
        &folder,
        &["log.mat"],
        &[
            "log.mat is cut off or damaged: it ends within an array; t, u can be read",
            "accept_truncated",
        ],
    );
    folder.map("map.toml", &(keys + &channel("time_again", "\"t\"", "1")));
    assert_eq!(accepted(&folder, "log.mat", "ends within an array"), 400);
}

#[test]
fn a_parquet_that_is_cut_off() {
    let folder = Folder::new();
    files::parquet(&folder.path("log.parquet"));
    cut(&folder, "log.parquet", 0.9);
    let keys = "form = \"parquet\"\ntime = { column = \"stamp\" }\n".to_owned()
        + &channel("force", "\"force_kn\"", "kN");
    folder.map("map.toml", &keys);
    refused(
        &folder,
        &["log.parquet"],
        &["log.parquet", "is cut off", "nothing of it can be read"],
    );
    folder.map(
        "map.toml",
        &("accept_truncated = true\n".to_owned() + &keys),
    );
    refused(
        &folder,
        &["log.parquet"],
        &["accept_truncated", "cannot be read at all"],
    );
}
