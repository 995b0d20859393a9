//! Forms of files: known by their first bytes, unpacked, read where they can be; recordings with gaps; forms that are written.

use std::io::Write;
use std::sync::Arc;

use arrow::array::{ArrayRef, FixedSizeListArray, Float64Array, RecordBatch, StringArray};
use arrow::datatypes::{Field, Float64Type, Schema};
use parquet::arrow::ArrowWriter;
use parquet::basic::Compression as Codec;
use parquet::file::properties::WriterProperties;

use super::files::{ROWS, START, truth, whole};
use super::refused::refused;
use super::{FORCE, Folder, STROKE, assert_planted, channel, plain};

const CSV: &str = "form = \"text\"\nnames_line = 1\ntime = { column = \"t\", unit = \"ms\" }\n";

/// The planted force beside its times.
fn csv() -> Vec<u8> {
    let mut text = "t,F\n".to_owned();
    for row in 0..ROWS {
        text += &format!("{},{}\n", whole(row).0, truth(row).force);
    }
    text.into_bytes()
}

fn gzip(plain: &[u8]) -> Vec<u8> {
    let mut encoder = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::fast());
    encoder.write_all(plain).unwrap();
    encoder.finish().unwrap()
}

fn zstd(plain: &[u8]) -> Vec<u8> {
    zstd::encode_all(plain, 1).unwrap()
}

#[test]
fn packed_texts_and_bags_are_unpacked() {
    let folder = Folder::new();
    folder.map(
        "map.toml",
        &(CSV.to_owned() + &channel("force", "\"F\"", "N")),
    );
    folder.write("log.csv.gz", gzip(&csv()));
    folder.write("log.csv.zst", zstd(&csv()));
    for log in ["log.csv.gz", "log.csv.zst"] {
        let (stored, _) = folder.imported("map.toml", &[log]);
        assert_planted(&stored.recording, &[FORCE]);
    }
    super::files::mcap(&folder.path("plain.mcap"), None);
    let plain = std::fs::read(folder.path("plain.mcap")).unwrap();
    folder.write("log.mcap.zstd", zstd(&plain));
    folder.map(
        "bag.toml",
        &("form = \"bag\"\ntime = { column = \"header.stamp\" }\n".to_owned()
            + &channel("force", "\"/wrench.wrench.force.z\"", "N")),
    );
    let (stored, _) = folder.imported("bag.toml", &["log.mcap.zstd"]);
    assert_planted(&stored.recording, &[FORCE]);
    // Drafted by what is in them, whatever their names.
    for (log, form) in [("log.csv.gz", "\"text\""), ("log.mcap.zstd", "\"bag\"")] {
        let outcome = folder.run(&["new", "import", "draft.toml", "--force", "--from", log]);
        assert_eq!(outcome.code, 0, "{}", outcome.err);
        let draft = std::fs::read_to_string(folder.path("draft.toml")).unwrap();
        assert!(draft.contains(&format!("form = {form}")), "{draft}");
    }
}

#[test]
fn forms_that_are_not_read_are_known_by_their_first_bytes() {
    let folder = Folder::new();
    folder.map(
        "map.toml",
        &(CSV.to_owned() + &channel("force", "\"F\"", "N")),
    );
    let padded = |start: &[u8]| [start, &[0; 600]].concat();
    let tar = [vec![b'a'; 257], b"ustar\0".to_vec(), vec![0; 300]].concat();
    for (bytes, says) in [
        (padded(b"MDF     4.10    "), "ASAM MDF"),
        (padded(b"\x89HDF\r\n\x1a\n"), "HDF5"),
        (padded(b"#ROSBAG V2.0\n"), "rosbags-convert"),
        (padded(b"%PDF-1.7\n"), "a PDF"),
        (
            b"version https://git-lfs.github.com/spec/v1\noid sha256:0\nsize 9\n".to_vec(),
            "git lfs pull",
        ),
        (padded(b"PK\x03\x04"), "a zip archive"),
        (padded(b"BZh9"), "bunzip2"),
        (tar.clone(), "tar"),
        (gzip(&tar), "packed, and holds an archive of tar"),
        (
            gzip(b"PAR1\x15 .. PAR1"),
            "packed, and holds a Parquet table",
        ),
        (
            b"{\"t\": 0, \"F\": 1.5}\n{\"t\": 1, \"F\": 1.5}\n".to_vec(),
            "jq -r",
        ),
        (b"<!DOCTYPE html>\n<html></html>\n".to_vec(), "a web page"),
        (padded(b"PAR1\x15"), "`form = \"parquet\"`"),
        (gzip(&csv())[..500].to_vec(), "damaged or cut off"),
    ] {
        folder.write("log.csv", &bytes);
        refused(&folder, &["log.csv"], &["log.csv", says]);
        let drafted = folder.run(&["new", "import", "draft.toml", "--from", "log.csv"]);
        if !bytes.starts_with(b"PAR1") {
            assert_eq!(drafted.code, 2, "{says}");
            assert!(
                drafted.only_line("error: ").contains(says),
                "{}",
                drafted.err
            );
        }
    }
}

fn table(folder: &Folder, name: &str, columns: Vec<(&str, ArrayRef)>, codec: Codec) {
    let fields: Vec<Field> = columns
        .iter()
        .map(|(name, values)| Field::new(*name, values.data_type().clone(), true))
        .collect();
    let arrays = columns.into_iter().map(|(_, values)| values).collect();
    let batch = RecordBatch::try_new(Arc::new(Schema::new(fields)), arrays).unwrap();
    let properties = WriterProperties::builder().set_compression(codec).build();
    let file = std::fs::File::create(folder.path(name)).unwrap();
    let mut writer = ArrowWriter::try_new(file, batch.schema(), Some(properties)).unwrap();
    writer.write(&batch).unwrap();
    writer.close().unwrap();
}

#[test]
fn parquet_tables_hold_texts_lists_and_the_newest_row_first() {
    let folder = Folder::new();
    let stamp = |row: usize| {
        let millis = whole(row).0;
        Some(format!(
            "2024-05-03 12:40:{:02}.{:03}",
            millis / 1000,
            millis % 1000
        ))
    };
    let stamps: StringArray = (0..ROWS).map(stamp).collect();
    let force = |row: usize| truth(row).force;
    let vectors = (0..ROWS).map(|row| Some(vec![Some(1.0), Some(force(row))]));
    let vectors = FixedSizeListArray::from_iter_primitive::<Float64Type, _, _>(vectors, 2);
    let codec = Codec::BROTLI(parquet::basic::BrotliLevel::default());
    let columns: Vec<(&str, ArrayRef)> =
        vec![("when", Arc::new(stamps)), ("wrench", Arc::new(vectors))];
    table(&folder, "texts.parquet", columns, codec);
    folder.map(
        "map.toml",
        &("form = \"parquet\"\ntime = { column = \"when\" }\n".to_owned()
            + &channel("force", "\"wrench[1]\"", "N")),
    );
    let (stored, _) = folder.imported("map.toml", &["texts.parquet"]);
    assert_planted(&stored.recording, &[FORCE]);
    // 2024-05-03 12:40:01 in seconds since 1970.
    assert_eq!(
        stored.metadata["time_origin_unix_s"],
        (START + 1).to_string()
    );
    let outcome = folder.run(&["new", "import", "draft.toml", "--from", "texts.parquet"]);
    assert_eq!(outcome.code, 0, "{}", outcome.err);
    let draft = std::fs::read_to_string(folder.path("draft.toml")).unwrap();
    assert!(draft.contains("time = { column = \"when\" }"), "{draft}");
    let back = || (0..ROWS).rev();
    let times: Float64Array = back().map(|row| Some(truth(row).time)).collect();
    let forces: Float64Array = back().map(|row| Some(force(row))).collect();
    let columns: Vec<(&str, ArrayRef)> = vec![("t", Arc::new(times)), ("F", Arc::new(forces))];
    table(&folder, "back.parquet", columns, Codec::UNCOMPRESSED);
    folder.map(
        "map.toml",
        &("form = \"parquet\"\ntime = { column = \"t\", unit = \"s\" }\n".to_owned()
            + &channel("force", "\"F\"", "N")),
    );
    let (stored, said) = folder.imported("map.toml", &["back.parquet"]);
    assert_planted(&stored.recording, &[FORCE]);
    assert!(said.contains("turned round"), "{said}");
    let outcome = folder.run(&[
        "new",
        "import",
        "draft.toml",
        "--force",
        "--from",
        "back.parquet",
    ]);
    let draft = std::fs::read_to_string(folder.path("draft.toml")).unwrap();
    assert!(
        draft.contains("time = { column = \"t\""),
        "{draft}{}",
        outcome.err
    );
}

/// TDMS in either byte order, interleaved or not, its data in two segments of which the second says nothing new.
#[expect(
    clippy::too_many_lines,
    reason = "one file, from its first byte to its last"
)]
fn tdms(is_big: bool, is_interleaved: bool, start: bool) -> Vec<u8> {
    let u32 = |n: u32| {
        if is_big {
            n.to_be_bytes()
        } else {
            n.to_le_bytes()
        }
    };
    let u64 = |n: u64| {
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
    let text = |text: &str| [&u32(text.len() as u32)[..], text.as_bytes()].concat();
    let half = ROWS / 2;
    let number =
        |key: &str, value: f64| [text(key), u32(10).to_vec(), f64(value).to_vec()].concat();
    let seconds = START + 2_082_844_800 + 1;
    let when = [text("wf_start_time"), u32(0x44).to_vec(), {
        let (whole, parts) = (u64(seconds), u64(0));
        if is_big {
            [whole, parts]
        } else {
            [parts, whole]
        }
        .concat()
    }]
    .concat();
    let mut properties = vec![
        number("wf_increment", 0.002),
        number("wf_start_offset", 0.0),
    ];
    if start {
        properties.push(when);
    }
    let object = |path: &str, index: Vec<u8>, properties: &[Vec<u8>]| {
        let count = u32(properties.len() as u32).to_vec();
        [text(path), index, count, properties.concat()].concat()
    };
    let index = |kind: u32| [&u32(20)[..], &u32(kind), &u32(1), &u64(half as u64)].concat();
    let none = u32(u32::MAX).to_vec();
    // The stroke in micrometres, as a converter's whole numbers with a scale.
    let scaled = [
        properties.clone(),
        vec![
            [
                text("NI_Number_Of_Scales"),
                u32(7).to_vec(),
                u32(1).to_vec(),
            ]
            .concat(),
            [
                text("NI_Scale[0]_Scale_Type"),
                u32(0x20).to_vec(),
                text("Linear"),
            ]
            .concat(),
            number("NI_Scale[0]_Linear_Slope", 1e-6),
            number("NI_Scale[0]_Linear_Y_Intercept", 0.0),
            [text("unit_string"), u32(0x20).to_vec(), text("m")].concat(),
        ],
    ]
    .concat();
    let objects = [
        object("/", none.clone(), &[]),
        object("/'Prüfstand'", none, &[]),
        object("/'Prüfstand'/'Kraft'", index(10), &properties),
        object("/'Prüfstand'/'Weg'", index(3), &scaled),
    ];
    let metadata = [u32(objects.len() as u32).to_vec(), objects.concat()].concat();
    let values = |rows: std::ops::Range<usize>| -> Vec<u8> {
        let force = |row| f64(truth(row).force).to_vec();
        let stroke = |row| u32(whole(row).1 as u32).to_vec();
        if is_interleaved {
            return rows
                .flat_map(|row| [force(row), stroke(row)].concat())
                .collect();
        }
        rows.clone()
            .flat_map(force)
            .chain(rows.flat_map(stroke))
            .collect()
    };
    let own = u32::from(is_big) << 6 | u32::from(is_interleaved) << 5 | 1 << 3;
    let segment = |contents: u32, metadata: &[u8], raw: &[u8]| {
        let length = u64((metadata.len() + raw.len()) as u64);
        let start = [
            &b"TDSm"[..],
            &contents.to_le_bytes(),
            &u32(4713),
            &length,
            &u64(metadata.len() as u64),
        ];
        [&start.concat()[..], metadata, raw].concat()
    };
    [
        segment(own | 1 << 1 | 1 << 2, &metadata, &values(0..half)),
        segment(own, &[], &values(half..ROWS)),
    ]
    .concat()
}

#[test]
fn waveforms_of_tdms_come_back() {
    let folder = Folder::new();
    let keys = "form = \"tdms\"\n".to_owned()
        + &channel("force", "\"Prüfstand/Kraft\"", "N")
        + &channel("stroke", "\"Prüfstand/Weg\"", "m");
    folder.map("map.toml", &keys);
    for (is_big, is_interleaved) in [(false, false), (false, true), (true, false), (true, true)] {
        folder.write("log.tdms", tdms(is_big, is_interleaved, true));
        let (stored, _) = folder.imported("map.toml", &["log.tdms"]);
        assert_planted(&stored.recording, &[FORCE, STROKE]);
        assert_eq!(
            stored.metadata["time_origin_unix_s"],
            (START + 1).to_string()
        );
    }
    let bytes = tdms(false, false, false);
    folder.write("log.tdms", &bytes);
    let outcome = folder.run(&["new", "import", "draft.toml", "--from", "log.tdms"]);
    assert_eq!(outcome.code, 0, "{}", outcome.err);
    let (stored, said) = folder.imported("draft.toml", &["log.tdms"]);
    assert_eq!(stored.recording.sample_count(), ROWS, "{said}");
    let draft = std::fs::read_to_string(folder.path("draft.toml")).unwrap();
    assert!(
        draft.contains("quantity = \"measured_stroke\"")
            && !draft.contains("asked: no column rises"),
        "{draft}"
    );
    // Cut off within the second segment.
    folder.write("log.tdms", &bytes[..bytes.len() - 50]);
    refused(
        &folder,
        &["log.tdms"],
        &["was not written to its end", "accept_truncated"],
    );
    folder.write("log.tdms", &bytes[..bytes.len() / 8]);
    refused(&folder, &["log.tdms"], &["log.tdms"]);
}

/// A zip archive whose members are stored (PKWARE, APPNOTE).
fn zip(members: &[(&str, String)]) -> Vec<u8> {
    let (mut bytes, mut directory) = (Vec::new(), Vec::new());
    for (name, content) in members {
        let mut crc = flate2::Crc::new();
        crc.update(content.as_bytes());
        let length = (content.len() as u32).to_le_bytes();
        let common = [
            &[20, 0, 0, 0, 0, 0, 0, 0, 0x21, 0][..],
            &crc.sum().to_le_bytes(),
            &length,
            &length,
            &(name.len() as u16).to_le_bytes(),
            &[0, 0],
        ]
        .concat();
        let at = (bytes.len() as u32).to_le_bytes();
        directory.extend(
            [
                b"PK\x01\x02\x14\x00",
                &common[..],
                &[0; 10],
                &at,
                name.as_bytes(),
            ]
            .concat(),
        );
        bytes.extend(
            [
                b"PK\x03\x04",
                &common[..],
                name.as_bytes(),
                content.as_bytes(),
            ]
            .concat(),
        );
    }
    let (start, length) = (bytes.len() as u32, directory.len() as u32);
    let count = (members.len() as u16).to_le_bytes();
    bytes.extend(directory);
    bytes.extend(
        [
            b"PK\x05\x06\0\0\0\0",
            &count[..],
            &count,
            &length.to_le_bytes(),
            &start.to_le_bytes(),
            &[0, 0],
        ]
        .concat(),
    );
    bytes
}

/// A workbook with a sheet of notes if that is wanted, and one with a title, names, and dates with times.
fn xlsx(with_notes: bool) -> Vec<u8> {
    const MAIN: &str = "xmlns=\"http://schemas.openxmlformats.org/spreadsheetml/2006/main\"";
    const OFFICE: &str = "http://schemas.openxmlformats.org/officeDocument/2006/relationships";
    const PACKAGE: &str = "http://schemas.openxmlformats.org/package/2006";
    let text = |cell: &str, text: &str| {
        format!("<c r=\"{cell}\" t=\"inlineStr\"><is><t>{text}</t></is></c>")
    };
    let mut rows = format!("<row r=\"2\">{}</row>", text("B2", "Messung, \"Mai\""));
    rows += &format!(
        "<row r=\"4\">{}{}</row>",
        text("B4", "Zeit"),
        text("D4", "Kraft [N]")
    );
    for row in 0..ROWS {
        // Days since 1899-12-30 of 2024-05-03 12:40:00 and so many milliseconds.
        let days = 45_415.0 + (45_600.0 + whole(row).0 as f64 * 1e-3) / 86_400.0;
        let number = row + 5;
        rows += &format!(
            "<row r=\"{number}\"><c r=\"B{number}\" s=\"1\"><v>{days}</v></c><c r=\"D{number}\"><v>{}</v></c></row>",
            truth(row).force
        );
    }
    let sheet = |rows: &str| {
        format!(
            "<?xml version=\"1.0\"?><worksheet {MAIN}><sheetData>{rows}</sheetData></worksheet>"
        )
    };
    let mut sheets = "<sheet name=\"Messung\" sheetId=\"1\" r:id=\"rId1\"/>".to_owned();
    if with_notes {
        sheets += "<sheet name=\"Notizen\" sheetId=\"2\" r:id=\"rId2\"/>";
    }
    let relation = |id: &str, kind: &str, target: &str| {
        format!("<Relationship Id=\"{id}\" Type=\"{OFFICE}/{kind}\" Target=\"{target}\"/>")
    };
    let relations = |all: String| {
        format!(
            "<?xml version=\"1.0\"?><Relationships xmlns=\"{PACKAGE}/relationships\">{all}</Relationships>"
        )
    };
    zip(&[
        (
            "[Content_Types].xml",
            format!(
                "<?xml version=\"1.0\"?><Types xmlns=\"{PACKAGE}/content-types\"><Default Extension=\"xml\" ContentType=\"application/xml\"/></Types>"
            ),
        ),
        (
            "_rels/.rels",
            relations(relation("rId1", "officeDocument", "xl/workbook.xml")),
        ),
        (
            "xl/workbook.xml",
            format!(
                "<?xml version=\"1.0\"?><workbook {MAIN} xmlns:r=\"{OFFICE}\"><sheets>{sheets}</sheets></workbook>"
            ),
        ),
        (
            "xl/_rels/workbook.xml.rels",
            relations(
                relation("rId1", "worksheet", "worksheets/sheet1.xml")
                    + &relation("rId2", "worksheet", "worksheets/sheet2.xml")
                    + &relation("rId3", "styles", "styles.xml"),
            ),
        ),
        (
            "xl/styles.xml",
            format!(
                "<?xml version=\"1.0\"?><styleSheet {MAIN}><cellXfs count=\"2\"><xf numFmtId=\"0\"/><xf numFmtId=\"22\"/></cellXfs></styleSheet>"
            ),
        ),
        ("xl/worksheets/sheet1.xml", sheet(&rows)),
        (
            "xl/worksheets/sheet2.xml",
            sheet(&format!("<row r=\"1\">{}</row>", text("A1", "notes"))),
        ),
    ])
}

#[test]
fn a_sheet_with_dates_comes_back() {
    let folder = Folder::new();
    folder.write("log.xlsx", xlsx(false));
    let keys =
        "form = \"spreadsheet\"\nheader_lines = 4\nnames_line = 4\ntime = { column = \"Zeit\" }\n"
            .to_owned()
            + &channel("force", "\"Kraft [N]\"", "N");
    folder.map("map.toml", &keys);
    let (stored, _) = folder.imported("map.toml", &["log.xlsx"]);
    let recording = stored.recording;
    assert_eq!(recording.sample_count(), ROWS);
    for (row, (time, force)) in recording
        .time()
        .iter()
        .zip(recording.values("force").unwrap())
        .enumerate()
    {
        // A date's double holds half a microsecond.
        assert!(
            (time + 1.0 - truth(row).time).abs() < 1.5e-6,
            "{row}: {time}"
        );
        assert!((force - truth(row).force).abs() < 1e-9);
    }
    assert_eq!(
        stored.metadata["time_origin_unix_s"],
        (START + 1).to_string()
    );
    folder.write("log.xlsx", xlsx(true));
    refused(&folder, &["log.xlsx"], &["`Messung`, `Notizen`", "`sheet`"]);
    let outcome = folder.run(&["new", "import", "draft.toml", "--from", "log.xlsx"]);
    assert_eq!(outcome.code, 0, "{}", outcome.err);
    let draft = std::fs::read_to_string(folder.path("draft.toml")).unwrap();
    for words in [
        "form = \"spreadsheet\"",
        "sheet = \"Messung\"",
        "names_line = 4",
        "column = \"Kraft [N]\"",
    ] {
        assert!(draft.contains(words), "{draft}\nlacks {words}");
    }
    let (stored, _) = folder.imported("draft.toml", &["log.xlsx"]);
    assert_eq!(stored.recording.sample_count(), ROWS);
}

#[test]
fn a_gap_parts_a_recording_and_the_ending_of_its_name_says_its_form() {
    let folder = Folder::new();
    plain(&folder, &["log.csv"]);
    let text = std::fs::read_to_string(folder.path("log.csv")).unwrap();
    let mut lines: Vec<String> = text.lines().map(str::to_owned).collect();
    // From the 100th row on an hour later.
    for line in &mut lines[101..] {
        let (time, rest) = line.split_once(';').unwrap();
        let later = time.parse::<u64>().unwrap() + 3_600_000;
        *line = format!("{later};{rest}");
    }
    folder.write("log.csv", lines.join("\n") + "\n");
    let outcome = folder.idc(&["map.toml", "log.csv", "--out", "made/log.csv", "--split"]);
    assert_eq!(outcome.code, 0, "{}", outcome.err);
    assert!(
        outcome.words().contains("Gaps part it into 2 recordings"),
        "{}",
        outcome.out
    );
    assert_eq!(folder.names("made"), ["log-1.csv", "log-2.csv"]);
    let read = |name: &str| std::fs::read_to_string(folder.path(name)).unwrap();
    assert_eq!(read("made/log-1.csv").lines().count(), 101);
    assert_eq!(read("made/log-2.csv").lines().count(), ROWS - 99);
    assert!(read("made/log-1.csv").starts_with("time_s,force_n\n"));
    refused_out(&folder, "log.xlsx");
    refused_out(&folder, "log.json");
    assert_eq!(folder.names("."), ["log.csv", "made", "map.toml"]);
}

fn refused_out(folder: &Folder, out: &str) {
    let outcome = folder.idc(&["map.toml", "log.csv", "--out", out]);
    assert_eq!(outcome.code, 2);
    let line = outcome.only_line("error: ");
    assert!(
        line.contains(out) && line.contains("neither .parquet nor .csv"),
        "{line}"
    );
}

/// Data types of columns that hold nothing to import are said, and hide no others.
#[test]
fn other_columns_hide_none() {
    let folder = Folder::new();
    let bytes: arrow::array::BinaryArray = (0..ROWS).map(|_| Some(b"x".as_slice())).collect();
    let times: Float64Array = (0..ROWS).map(|row| Some(truth(row).time)).collect();
    let forces: Float64Array = (0..ROWS).map(|row| Some(truth(row).force)).collect();
    let columns: Vec<(&str, ArrayRef)> = vec![
        ("blob", Arc::new(bytes)),
        ("t", Arc::new(times)),
        ("force_n", Arc::new(forces)),
    ];
    table(&folder, "log.parquet", columns, Codec::SNAPPY);
    let outcome = folder.run(&["new", "import", "map.toml", "--from", "log.parquet"]);
    assert_eq!(outcome.code, 0, "{}", outcome.err);
    let (stored, _) = folder.imported("map.toml", &["log.parquet"]);
    assert_eq!(
        stored.recording.values("measured_force").unwrap().len(),
        ROWS
    );
}
