//! Logs of every kind that people have, made here from one truth: a map drafted from each reads it, or asks for what no log can tell.

use idc_cell::recording::Recording;
use idc_cell::recording::schema;

use super::Folder;
use super::refused::refused;

/// Rows, and the time between two [s].
const ROWS: usize = 300;
const STEP: f64 = 0.01;
const NAMES: &str = "t [s];p_set [bar];p_out [bar];F [N]";

/// Set and outlet pressure [bar], force [N] at a row.
fn truth(row: usize) -> [f64; 3] {
    let set = if row < 60 { 0.0 } else { 2.0 };
    let since = row.saturating_sub(60) as f64 * STEP;
    let out = 2.0 * (1.0 - (-since / 0.1).exp()) + 0.003 * (1.7 * row as f64).sin();
    [set, out, 60.0 * out - 0.4 * (2.3 * row as f64).sin()]
}

/// A row with its time as text.
fn row(index: usize, time: &str) -> String {
    let [set, out, force] = truth(index);
    format!("{time};{set:.2};{out:.4};{force:.2}")
}

/// Rows with their times.
fn rows(time: impl Fn(usize) -> String) -> Vec<String> {
    (0..ROWS).map(|index| row(index, &time(index))).collect()
}

fn seconds(index: usize) -> String {
    format!("{:.2}", STEP * index as f64)
}

/// A log of lines below names.
fn log(names: &str, lines: &[String]) -> String {
    format!("{names}\n{}\n", lines.join("\n"))
}

/// The map that is drafted from a log, and what was asked.
fn drafted(folder: &Folder, log: impl AsRef<[u8]>) -> (String, String) {
    folder.write("log.csv", log);
    let outcome = folder.run(&["new", "import", "map.toml", "--force", "--from", "log.csv"]);
    assert_eq!(
        (outcome.code, outcome.err.as_str()),
        (0, ""),
        "{}",
        outcome.out
    );
    let map = std::fs::read_to_string(folder.path("map.toml")).unwrap();
    (map, outcome.out)
}

/// Reads a log by the map drafted from it, without an edit, and returns it with the map and what was said.
fn read(log: impl AsRef<[u8]>) -> (Recording, String, String) {
    let folder = Folder::new();
    let (map, asked) = drafted(&folder, log);
    assert!(!asked.contains("asked"), "{asked}\n{map}");
    let (stored, said) = folder.imported("map.toml", &["log.csv"]);
    (stored.recording, map, said)
}

/// Holds a recording's times and values against the truth of these rows.
fn assert_rows(recording: &Recording, count: usize, what: &str) {
    assert_eq!(recording.sample_count(), count, "{what}");
    let values = |name: &str| {
        recording
            .values(name)
            .unwrap_or_else(|error| panic!("{what}: {error}"))
    };
    let columns = [
        values(schema::SET_PRESSURE_GAUGE),
        values(schema::MEASURED_REGULATOR_PRESSURE_GAUGE),
        values(schema::MEASURED_FORCE),
    ];
    let digits = [0.006e5, 0.000_06e5, 0.006];
    for (index, stamp) in recording.time().iter().enumerate() {
        let time = stamp - recording.time()[0];
        assert!(
            (time - STEP * index as f64).abs() < 1e-5,
            "{what}, row {index}: {time}"
        );
        let [set, out, force] = truth(index);
        let right = [1e5 * set, 1e5 * out, force].into_iter().zip(digits);
        for (column, (right, digit)) in columns.iter().zip(right) {
            let own = column[index];
            assert!(
                (own - right).abs() <= digit,
                "{what}, row {index}: {own} for {right}"
            );
        }
    }
}

/// A log that a draft reads to the last row.
fn reads(what: &str, log: impl AsRef<[u8]>) -> (String, String) {
    let (recording, map, said) = read(log);
    assert_rows(&recording, ROWS, &format!("{what}\n{map}"));
    assert!(!said.contains("doubtful"), "{what}: {said}");
    (map, said)
}

/// A log of which something is asked, and which is not read before that is answered.
fn asks(what: &str, log: impl AsRef<[u8]>, says: &str) -> (Folder, String) {
    let folder = Folder::new();
    let (map, asked) = drafted(&folder, log);
    assert!(
        asked.contains(says) && map.contains("asked:"),
        "{what}: {asked}\n{map}"
    );
    assert_eq!(
        folder.idc(&["map.toml", "log.csv"]).code,
        2,
        "{what}: {map}"
    );
    (folder, map)
}

#[test]
fn lines_that_are_no_rows_hide_no_table_and_are_reported() {
    let lines = rows(seconds);
    for foot in [
        "EOF;;;",
        "EOF",
        "\nMin;0.00;-0.01;-1.4\nMean;1.6;1.5;98",
        "# 300 rows",
    ] {
        let (map, said) = reads(foot, log(NAMES, &lines) + foot + "\n");
        let count = foot.trim().lines().count();
        assert!(map.contains(&format!("drop_last_rows = {count}")), "{map}");
        assert!(
            map.contains("# Left out, as no rows: line 302") || map.contains("line 303"),
            "{map}"
        );
        assert!(
            said.contains(&format!("{ROWS} of {ROWS} rows used")),
            "{said}"
        );
        // By hand, without a word on its lines, it is refused with what to write.
        let folder = Folder::new();
        folder.write("log.csv", log(NAMES, &lines) + foot + "\n");
        let without: String = map
            .lines()
            .filter(|line| !line.starts_with("drop_last_rows"))
            .map(|line| format!("{line}\n"))
            .collect();
        folder.write("map.toml", without);
        let how = format!("`drop_last_rows = {count}`");
        refused(
            &folder,
            &["log.csv"],
            &[if foot == "EOF" || foot.starts_with('#') {
                "fields"
            } else {
                &how
            }],
        );
    }
    for (what, stray) in [
        ("a second header", NAMES),
        ("a page", "--- page 2 ---;;;"),
        ("a warning", "WARNING: overrun;;;"),
    ] {
        let mut with = lines.clone();
        with.insert(150, stray.to_owned());
        let (map, said) = reads(what, log(NAMES, &with));
        assert!(map.contains("skip_stray_lines = true"), "{map}");
        assert!(said.contains("line 152"), "{said}");
    }
    let (map, _) = reads(
        "greeting",
        "Connected to device v1.2\nOK\n\n".to_owned() + &log(NAMES, &lines),
    );
    assert!(map.contains("header_lines = 4"), "{map}");
    let (map, _) = reads(
        "units",
        log(
            NAMES,
            &[vec!["V;bar;bar;N".to_owned()], lines.clone()].concat(),
        ),
    );
    assert!(
        map.contains("likely: its name says s, but the line of units V"),
        "{map}"
    );
    // Another recording behind it.
    let again = [lines.clone(), vec![NAMES.to_owned()], lines.clone()].concat();
    let (recording, map, _) = read(log(NAMES, &again));
    assert_rows(&recording, ROWS, &map);
    assert!(
        map.contains("begin anew") && map.contains("`header_lines = 302`"),
        "{map}"
    );
}

#[test]
fn stamps_of_spreadsheets_controllers_and_programs_are_read() {
    let names = "Time;p_set [bar];p_out [bar];F [N]";
    let hundredths = |index: usize| format!("{:02}.{:02}", index / 100, index % 100);
    // Noon of 18 January 2024.
    let unix = |index: usize| 1_705_579_200_000 + 10 * index as u64;
    let stamps: [(&str, &dyn Fn(usize) -> String); 9] = [
        ("mm:ss", &|i| format!("00:{}", hundredths(i))),
        ("timedelta", &|i| {
            format!("0 days 00:00:{}0000", hundredths(i))
        }),
        ("TOD", &|i| format!("TOD#09:10:{}", hundredths(i))),
        ("DT", &|i| format!("DT#2024-01-18-12:00:{}", hundredths(i))),
        ("filetime", &|i| {
            format!("{}", (unix(i) + 11_644_473_600_000) * 10_000)
        }),
        (".NET", &|i| {
            format!("{}", (unix(i) + 62_135_596_800_000) * 10_000)
        }),
        ("ns", &|i| format!("{}000000", unix(i))),
        ("days", &|i| {
            format!("{:.10}", 25_569.0 + unix(i) as f64 / 86_400e3)
        }),
        ("LabVIEW", &|i| {
            format!("{:.2}", 2_082_844_800.0 + unix(i) as f64 / 1e3)
        }),
    ];
    for (what, time) in stamps {
        let (_, said) = reads(what, log(names, &rows(time)));
        let is_absolute = !["mm:ss", "timedelta", "TOD"].contains(&what);
        assert_eq!(
            said.contains("1705579200 s since 1970"),
            is_absolute,
            "{what}: {said}"
        );
    }
}

#[test]
fn counters_and_coarse_stamps_ask_for_the_rate_unless_the_header_says_it() {
    for name in ["Sample", "Nr", "#", "Index", ""] {
        let names = NAMES.replacen("t [s]", name, 1);
        let (folder, map) = asks(
            name,
            log(&names, &rows(|index| index.to_string())),
            "sample_rate_hz",
        );
        // With an answer it is read.
        let time = map.lines().find(|line| line.starts_with("# time")).unwrap();
        let answered = time
            .trim_start_matches("# ")
            .split(" # ")
            .next()
            .unwrap()
            .trim_end();
        folder.write(
            "map.toml",
            map.replacen(time, &format!("{answered}\nsample_rate_hz = 100"), 1),
        );
        let (stored, _) = folder.imported("map.toml", &["log.csv"]);
        assert_rows(&stored.recording, ROWS, name);
    }
    let counted = log(
        &NAMES.replacen("t [s]", "Sample", 1),
        &rows(|index| index.to_string()),
    );
    for said in ["Sample rate;100;Hz", "Abtastzeit [ms];10", "# fs = 100"] {
        let (map, _) = reads(said, format!("{said}\n{counted}"));
        assert!(map.contains("sample_rate_hz = 100 "), "{map}");
    }
    let coarse = |index: usize| format!("2024-01-18 09:10:{:02}", index / 100);
    let (folder, map) = asks("coarse", log(NAMES, &rows(coarse)), "whole seconds");
    assert!(map.contains("# sample_rate_hz = 100 "), "{map}");
    // A map that takes them as they are loses most rows, and says so.
    let all = "form = \"text\"\nseparator = \";\"\nnames_line = 1\ntime = { column = \"t [s]\" }\n[[file.channel]]\nquantity = \"force\"\ncolumn = 4\nunit = \"N\"\n";
    folder.map("map.toml", all);
    refused(
        &folder,
        &["log.csv"],
        &[
            "3 of 300 rows would be used",
            "whole seconds are too coarse",
            "`accept_unused_rows = true`",
        ],
    );
    folder.map("map.toml", &format!("accept_unused_rows = true\n{all}"));
    assert_eq!(
        folder
            .imported("map.toml", &["log.csv"])
            .0
            .recording
            .sample_count(),
        3
    );
    folder.map(
        "map.toml",
        &all.replacen("time = { column = \"t [s]\" }", "sample_rate_hz = 100", 1),
    );
    let (stored, said) = folder.imported("map.toml", &["log.csv"]);
    assert_eq!(stored.recording.time()[ROWS - 1], 2.99);
    assert!(
        said.contains("2.990 s at 100 Hz") && said.contains("300 of 300 rows used"),
        "{said}"
    );
}

#[test]
fn numbers_with_signs_of_typesetters_and_quoted_commas_are_read() {
    let lines = rows(seconds);
    reads(
        "minus",
        log(
            NAMES,
            &lines
                .iter()
                .map(|line| line.replace('-', "\u{2212}"))
                .collect::<Vec<_>>(),
        ),
    );
    let quoted: Vec<String> = (lines.iter())
        .map(|line| format!("\"{}\"", line.replace('.', ",").replace(';', "\",\"")))
        .collect();
    let (map, _) = reads("quoted", log(&NAMES.replace(';', ","), &quoted));
    assert!(map.contains("decimal_mark = \",\""), "{map}");
    // Without quotes a number is two.
    let folder = Folder::new();
    folder.write("map.toml", map);
    folder.write(
        "log.csv",
        log(&NAMES.replace(';', ","), &quoted).replace('"', ""),
    );
    refused(
        &folder,
        &["log.csv"],
        &["log.csv:2: 8 fields, expected 4", "must be quoted"],
    );
    let spaced = |space: char| -> Vec<String> {
        let line = |index: usize| {
            let [set, out, force] = truth(index);
            let grouped = |pascal: f64| match pascal.round() as i64 {
                whole if whole.abs() > 999 => {
                    format!("{}{space}{:03}", whole / 1000, whole.abs() % 1000)
                }
                whole => whole.to_string(),
            };
            format!(
                "{};{};{};{force:.2}",
                seconds(index),
                grouped(1e5 * set),
                grouped(1e5 * out)
            )
        };
        (0..ROWS).map(line).collect()
    };
    for space in ['\u{a0}', '\u{2009}', '\u{202f}', ' '] {
        reads(
            "thousands",
            log("t [s];p_set [Pa];p_out [Pa];F [N]", &spaced(space)),
        );
    }
}

#[test]
fn marks_of_missing_values_are_named_and_lone_values_are_doubtful() {
    let holed = |mark: &str| -> String {
        let mut lines = rows(seconds);
        for index in [150, 151, 220] {
            let (head, _) = lines[index].rsplit_once(';').unwrap();
            lines[index] = format!("{head};{mark}");
        }
        log(NAMES, &lines)
    };
    for mark in ["OVER", "#DIV/0!", "nan"] {
        let (recording, map, said) = read(holed(mark));
        assert_eq!(
            map.contains(&format!("missing = [\"{mark}\"]")),
            mark != "nan",
            "{map}"
        );
        let force = recording.values(schema::MEASURED_FORCE).unwrap();
        let gone: Vec<usize> = (0..ROWS).filter(|index| force[*index].is_nan()).collect();
        assert_eq!(gone, [150, 151, 220], "{said}");
    }
    let folder = Folder::new();
    let (map, _) = drafted(&folder, holed("-9999"));
    let said = folder.idc(&["map.toml", "log.csv"]).words();
    assert!(
        said.contains("3 of 300 values lie far") && said.contains("`missing = [-9999]`"),
        "{said}"
    );
    folder.write(
        "map.toml",
        map.replacen("separator", "missing = [-9999]\nseparator", 1),
    );
    let (stored, said) = folder.imported("map.toml", &["log.csv"]);
    assert!(
        !said.contains("doubtful") && said.contains("3 of 300 samples empty"),
        "{said}"
    );
    assert!(stored.recording.values(schema::MEASURED_FORCE).unwrap()[151].is_nan());
}

#[test]
fn each_clock_of_a_log_is_its_columns_own() {
    // The pressure is logged half a second later, on a clock of its own.
    let behind = 50;
    let line = |index: usize| {
        let ([_, _, force], [_, out, _]) = (truth(index), truth(index + behind));
        format!(
            "{};{force:.2};{};{out:.4}",
            seconds(index),
            seconds(index + behind)
        )
    };
    let count = ROWS - behind;
    let lines: Vec<String> = (0..count).map(line).collect();
    let check = |recording: &Recording, grid: usize, map: &str| {
        let pressure = recording
            .values(schema::MEASURED_REGULATOR_PRESSURE_GAUGE)
            .unwrap();
        for index in (behind..count).step_by(grid) {
            let right = 1e5 * truth(index)[1];
            assert!(
                (pressure[index] - right).abs() < 6.0,
                "row {index}: {} for {right}\n{map}",
                pressure[index]
            );
        }
    };
    for names in [
        "t_F [s];F [N];t_p [s];p_out [bar]",
        "Time;F [N];Time;p_out [bar]",
        "X_Value;F [N];X_Value;p_out [bar]",
    ] {
        let (recording, map, _) = read(log(names, &lines));
        assert_eq!(
            (
                map.lines()
                    .filter(|line| line.starts_with("[[file]]"))
                    .count(),
                map.matches("same_log = true").count()
            ),
            (2, 1),
            "{map}"
        );
        check(&recording, 1, &map);
    }
    // A name that two columns have is none to choose by.
    let folder = Folder::new();
    folder.write("log.csv", log("Time;F [N];Time;p_out [bar]", &lines));
    folder.map("map.toml", "form = \"text\"\nseparator = \";\"\nnames_line = 1\ntime = { column = \"Time\", unit = \"s\" }\n[[file.channel]]\nquantity = \"force\"\ncolumn = 2\nunit = \"N\"\n");
    refused(
        &folder,
        &["log.csv"],
        &["log.csv has 2 columns `Time`, numbers 1, 3"],
    );
    // A second clock that may be the first's is asked for.
    asks(
        "uptime",
        log("t [s];F [N];uptime [s];p_out [bar]", &lines),
        "clock",
    );
    // TwinCAT's: a slower clock ends early, and rows with it.
    for empty in [true, false] {
        let line = |index: usize| {
            let fast = format!("{};{:.2}", seconds(index), truth(index)[2]);
            match (index < ROWS / 5, empty) {
                (true, _) => format!("{fast};{};{:.4}", seconds(5 * index), truth(5 * index)[1]),
                (false, true) => format!("{fast};;"),
                (false, false) => fast,
            }
        };
        let lines: Vec<String> = (0..ROWS).map(line).chain(["EOF".to_owned()]).collect();
        let (recording, map, said) = read(log("Time [s];F [N];Time [s];p_out [bar]", &lines));
        check(&recording, 5, &map);
        assert_eq!(recording.sample_count(), ROWS);
        assert!(
            said.contains("60 of 60 rows used") && said.contains("240 rows hold nothing"),
            "{said}"
        );
    }
}

#[test]
fn rows_of_several_variables_are_taken_apart() {
    let stamp = |index: usize| format!("2024-01-18 09:10:{:02}.{:02}", index / 100, index % 100);
    let line = |index: usize| {
        let [set, out, force] = truth(index);
        let stamp = stamp(index);
        format!(
            "HMI_pSet_bar;{stamp};{set:.2}\nHMI_pIst_bar;{stamp};{out:.4}\nHMI_Kraft_N;{stamp};{force:.2}"
        )
    };
    let lines: Vec<String> = (0..ROWS)
        .map(line)
        .chain(["$RT_OFF$;2024-01-18 09:11:00;0".to_owned()])
        .collect();
    let text = log("VarName;TimeString;VarValue", &lines);
    let (map, said) = reads("long", &text);
    assert!(
        map.contains("rows = { column = \"VarName\", value = \"HMI_Kraft_N\" }"),
        "{map}"
    );
    assert!(said.contains("300 of 300 rows used"), "{said}");
    let folder = Folder::new();
    folder.write("log.csv", &text);
    let all = "form = \"text\"\nseparator = \";\"\nnames_line = 1\ntime = { column = \"TimeString\" }\n[[file.channel]]\nquantity = \"force\"\ncolumn = \"VarValue\"\nunit = \"N\"\n";
    folder.map("map.toml", all);
    refused(
        &folder,
        &["log.csv"],
        &["301 of 901 rows would be used", "`rows = { column"],
    );
    folder.map(
        "map.toml",
        &all.replacen(
            "time",
            "rows = { column = \"VarName\", value = \"Kraft\" }\ntime",
            1,
        ),
    );
    refused(
        &folder,
        &["log.csv"],
        &["no row has `Kraft` in column `VarName`; there are `HMI_pSet_bar`, `HMI_pIst_bar`"],
    );
}

#[test]
fn units_that_nobody_knows_are_asked_for_and_vectors_are_read_by_element() {
    let lines = rows(seconds);
    asks("unit", log(&NAMES.replace("[N]", "[ozf]"), &lines), "`ozf`");
    // Milliamperes are no newtons: the column is left, and said.
    let (_, map, _) = read(log(&NAMES.replace("[N]", "[mA]"), &lines));
    assert!(
        map.contains("mA; of a sensor `gain`") && !map.contains("measured_force"),
        "{map}"
    );
    let folder = Folder::new();
    let vector = |index: usize| format!("{};[0.1, 0.2, {:.2}]", seconds(index), truth(index)[2]);
    let (map, _) = drafted(
        &folder,
        log(
            "t [s];force [N]",
            &(0..ROWS).map(vector).collect::<Vec<_>>(),
        ),
    );
    assert!(
        map.contains("`column = \"force [N][0]\"` is the first element"),
        "{map}"
    );
    let keys = |column: &str| {
        format!(
            "form = \"text\"\nseparator = \";\"\nnames_line = 1\ntime = {{ column = \"t [s]\", unit = \"s\" }}\n[[file.channel]]\nquantity = \"force\"\ncolumn = \"{column}\"\nunit = \"N\"\n\
            [[file.channel]]\nquantity = \"valve_current\"\ncolumn = \"force [N][1]\"\nunit = \"mA\"\n"
        )
    };
    folder.map("map.toml", &keys("force [N][2]"));
    let (stored, _) = folder.imported("map.toml", &["log.csv"]);
    let force = stored.recording.values("force").unwrap();
    assert!((0..ROWS).all(|index| (force[index] - truth(index)[2]).abs() < 0.006));
    assert_eq!(stored.recording.values("valve_current").unwrap()[7], 0.2e-3);
    folder.map("map.toml", &keys("force [N]"));
    refused(
        &folder,
        &["log.csv"],
        &["is `[0.1, 0.2,", "of a vector `column = \"NAME[0]\"`"],
    );
    folder.map("map.toml", &keys("force [N][3]"));
    refused(
        &folder,
        &["log.csv"],
        &["a vector with an element 3, counted from 0"],
    );
}

#[test]
fn logs_found_in_the_field_are_read_or_refused_as_they_should_be() {
    let Some(folder) = crate::common::shared("found/logs") else {
        return;
    };
    let asked = [
        "idx_Sample.csv",
        "idx_Nr.csv",
        "idx_hash.csv",
        "t_coarse_1s.csv",
    ];
    let mut read = 0;
    for entry in std::fs::read_dir(&folder).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_name().unwrap().to_string_lossy().into_owned();
        if path.extension().is_some_and(|ending| ending == "toml") {
            continue;
        }
        let own = Folder::new();
        let (_, said) = drafted(&own, std::fs::read(&path).unwrap());
        let outcome = own.idc(&["map.toml", "log.csv"]);
        let is_asked = asked.contains(&name.as_str());
        assert_eq!(
            (outcome.code == 2, said.contains("asked")),
            (is_asked, is_asked),
            "{name}: {said}{}",
            outcome.err
        );
        // Six seconds at 100 samples each, or what the shown minutes and seconds say.
        let span = [
            "5.990 s at 100 Hz",
            "5.490 s at 100 Hz",
            "2.990 s at 100 Hz",
            "59.900 s at 10 Hz",
            "29.900 s at 10 Hz",
            "4.990 s at 100 Hz",
        ];
        let fits = span.iter().any(|span| outcome.words().contains(span));
        assert!(is_asked || fits, "{name}: {}", outcome.out);
        assert_eq!(
            outcome.words().contains("missing = [-9999]"),
            name == "sentinel_9999.csv",
            "{name}: {}",
            outcome.out
        );
        read += usize::from(!is_asked);
    }
    assert!(read > 15, "{read}");
}
