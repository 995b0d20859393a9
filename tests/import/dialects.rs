//! One recording of the laboratory as ten loggers write it: a map drafted by looking at the log reads it back, value by value, with one edit at most.

use std::fmt::Write;

use encoding_rs::{UTF_8, UTF_16LE, WINDOWS_1252};
use idc_cell::recording::csv::read_csv;
use idc_cell::recording::parquet::read_parquet;
use idc_cell::recording::{Recording, schema};

use super::Folder;
use crate::common::project;
use crate::program::Outcome;

/// Channels of the recording, in the order of the columns here.
const CHANNELS: [&str; 7] = [
    schema::SET_PRESSURE_GAUGE,
    schema::VALVE_EXTENDS,
    schema::SURFACE_POSITION,
    schema::MEASURED_REGULATOR_PRESSURE_GAUGE,
    schema::MEASURED_STROKE,
    schema::MEASURED_FORCE,
    schema::MEASURED_ACCELERATION,
];
const ATMOSPHERE: f64 = 101_325.0;

/// Readings of a device of the laboratory, with something concealed in it.
fn truth() -> Recording {
    let ride = project("assets/proof/cases/case-02/ride.csv");
    read_csv(&ride).unwrap().recording
}

/// A logger.
struct Dialect {
    name: &'static str,
    /// Its file.
    file: &'static str,
    /// SI units of one unit of the log, and what is added in SI before, by channel.
    units: [(f64, f64); 7],
    /// Decimals of each channel.
    decimals: [usize; 7],
    /// The file's content.
    content: fn(&Table) -> Vec<u8>,
    /// Open questions of a draft, and its owner's answers.
    edit: Option<(&'static str, &'static str)>,
}

/// The recording in a logger's units.
struct Table {
    /// Times since the start [ms], whole.
    millis: Vec<u64>,
    rows: Vec<[f64; 7]>,
    decimals: [usize; 7],
}

impl Table {
    fn of(truth: &Recording, dialect: &Dialect) -> Self {
        let column = |name: &str| truth.values(name).unwrap();
        let columns = CHANNELS.map(column);
        let row = |i: usize| {
            std::array::from_fn(|c| (columns[c][i] + dialect.units[c].1) / dialect.units[c].0)
        };
        let time = truth.time();
        let millis = time.iter().map(|t| ((t - time[0]) * 1e3).round() as u64);
        Self {
            millis: millis.collect(),
            rows: (0..time.len()).map(row).collect(),
            decimals: dialect.decimals,
        }
    }

    /// Lines of fields: the time, then the channels, the valve as one of two words.
    fn lines(
        &self,
        separator: &str,
        decimal: char,
        words: [&str; 2],
        time: impl Fn(u64) -> String,
    ) -> String {
        let mut text = String::new();
        for (millis, row) in self.millis.iter().zip(&self.rows) {
            let field = |c: usize| match c {
                1 => words[usize::from(row[1] > 0.5)].to_owned(),
                _ if row[c].is_nan() => String::new(),
                _ => format!("{:.*}", self.decimals[c], row[c]).replace('.', &decimal.to_string()),
            };
            let fields: Vec<String> = std::iter::once(time(*millis))
                .chain((0..7).map(field))
                .collect();
            text += &fields.join(separator);
            text += "\r\n";
        }
        text
    }
}

/// 14:02:03 and so many milliseconds.
fn clock(millis: u64, mark: char) -> String {
    let all = (14 * 3600 + 2 * 60 + 3) * 1000 + millis;
    let (seconds, millis) = (all / 1000, all % 1000);
    format!(
        "{:02}:{:02}:{:02}{mark}{millis:03}",
        seconds / 3600,
        seconds / 60 % 60,
        seconds % 60
    )
}

const BAR: (f64, f64) = (1e5, 0.0);
const MM: (f64, f64) = (1e-3, 0.0);
const SI: (f64, f64) = (1.0, 0.0);
const METRIC: [(f64, f64); 7] = [BAR, SI, MM, BAR, MM, SI, SI];
const FINE: [usize; 7] = [5, 0, 4, 5, 4, 3, 3];

/// Excel in Germany, "CSV UTF-8": a mark of the byte order, semicolons, decimal commas, WAHR and FALSCH.
fn excel_csv(table: &Table) -> Vec<u8> {
    let head = "Zeit [ms];Solldruck [bar];Ventil;Oberfläche [mm];Istdruck [bar];Weg [mm];Kraft [N];Beschleunigung [m/s²]\r\n";
    let lines = table.lines(";", ',', ["FALSCH", "WAHR"], |ms| ms.to_string());
    format!("\u{feff}{head}{lines}").into_bytes()
}

/// Excel, "Unicode text": UTF-16 with tabs, dates as a German shows them.
fn excel_unicode(table: &Table) -> Vec<u8> {
    let head = "Zeitstempel\tSolldruck (bar)\tMagnetventil\tWand (mm)\tRegler Ausgang Druck (bar)\tHub (mm)\tKraft (N)\tBeschleunigung (m/s²)\r\n";
    let stamp = |ms| format!("05.03.2024 {}", clock(ms, ','));
    let text = head.to_owned() + &table.lines("\t", ',', ["AUS", "EIN"], stamp);
    let units = text.encode_utf16().flat_map(u16::to_le_bytes);
    [vec![0xff, 0xfe], units.collect()].concat()
}

/// A trace of a Siemens controller: the programme's quoted names, Windows-1252, milliseconds, no units but in names.
fn siemens(table: &Table) -> Vec<u8> {
    let head = "\"Zeit_ms\";\"DB_Messung.Druck_Soll_bar\";\"DB_Messung.Ventil_Ausfahren\";\"DB_Messung.Oberfläche_mm\";\
        \"DB_Messung.Druck_Ist_bar\";\"DB_Messung.Weg_mm\";\"DB_Messung.Kraft_N\";\"DB_Messung.Beschleunigung [m/s²]\"\r\n";
    let text = head.to_owned() + &table.lines(";", '.', ["FALSE", "TRUE"], |ms| ms.to_string());
    let (bytes, _, lost) = WINDOWS_1252.encode(&text);
    assert!(!lost);
    bytes.into_owned()
}

/// Beckhoff's Scope: tabs, a header of many lines, for each channel a column of times of its own.
fn twincat(table: &Table) -> Vec<u8> {
    let names = [
        "fDruckSoll",
        "bVentil",
        "fOberflaeche",
        "fDruckIst",
        "fWeg",
        "fKraft",
        "fBeschleunigung",
    ];
    let units = ["bar", "bool", "mm", "bar", "mm", "N", "m/s2"];
    let mut text = "Name\tScopeProject\r\nFile\tC:\\Messung\\ride.svdx\r\nStarttime of export\t133541065231230000\t05.03.2024 14:02:03.123\r\n\r\n".to_owned();
    let mut line = |label: &str, cell: &dyn Fn(usize) -> String| {
        let cells: Vec<String> = (0..7).map(|c| format!("{label}\t{}", cell(c))).collect();
        let _ = write!(text, "{}\r\n", cells.join("\t"));
    };
    line("Name", &|c| names[c].to_owned());
    line("SymbolComment", &|_| String::new());
    line("Data-Type", &|c| {
        if c == 1 { "BIT" } else { "LREAL" }.to_owned()
    });
    line("SampleTime[ms]", &|_| "4".to_owned());
    line("SymbolName", &|c| format!("MAIN.{}", names[c]));
    line("Unit", &|c| units[c].to_owned());
    text += "\r\n";
    for (ms, row) in table.millis.iter().zip(&table.rows) {
        let cells: Vec<String> = (0..7)
            .map(|c| format!("{ms}\t{:.*}", table.decimals[c], row[c]))
            .collect();
        text += &cells.join("\t");
        text += "\r\n";
    }
    text.into_bytes()
}

/// LabVIEW's measurement file: two headers with units among other things, decimal commas, a column for comments that is empty.
fn labview(table: &Table) -> Vec<u8> {
    let head = "LabVIEW Measurement\t\nWriter_Version\t2\nReader_Version\t2\nSeparator\tTab\nDecimal_Separator\t,\nMulti_Headings\tNo\nX_Columns\tOne\n\
        Time_Pref\tRelative\nOperator\tPrüfstand\nDate\t2024/03/05\nTime\t14:02:03,123\n***End_of_Header***\t\n\t\n\
        Channels\t7\t\t\t\t\t\t\t\nSamples\t1001\t1001\t1001\t1001\t1001\t1001\t1001\t\n\
        Date\t2024/03/05\t2024/03/05\t2024/03/05\t2024/03/05\t2024/03/05\t2024/03/05\t2024/03/05\t\n\
        Y_Unit_Label\tbar\t\tmm\tbar\tmm\tN\tm/s^2\t\nX_Dimension\tTime\tTime\tTime\tTime\tTime\tTime\tTime\t\n\
        X0\t0,0000000000000000E+0\t0,0E+0\t0,0E+0\t0,0E+0\t0,0E+0\t0,0E+0\t0,0E+0\t\nDelta_X\t0,004000\t0,004000\t0,004000\t0,004000\t0,004000\t0,004000\t0,004000\t\n\
        ***End_of_Header***\t\t\t\t\t\t\t\t\nX_Value\tSolldruck\tVentil\tOberfläche\tDruck\tWeg\tKraft\tBeschleunigung\tComment\n";
    let lines = table.lines("\t", ',', ["0,000000", "1,000000"], |ms| {
        format!("{:.6}", ms as f64 * 1e-3).replace('.', ",")
    });
    (head.to_owned() + &lines.replace("\r\n", "\n")).into_bytes()
}

/// catman's ASCII: Windows-1252, some lines about the job, the time's name with its sample rate.
fn catman(table: &Table) -> Vec<u8> {
    let head = "Job: Prüfung 17\r\nBeginn: 05.03.2024 14:02:03\r\nKanäle: 8\r\n\r\n\
        Zeit  1 - Standardmessrate [s]\tDruck Sollwert [bar]\tMagnetventil [-]\tWerkstück Oberfläche [mm]\tDruck Regler [bar]\tKolbenweg [mm]\tLastzelle [kN]\tBeschleunigung [m/s²]\r\n";
    let lines = table.lines("\t", ',', ["0", "1"], |ms| {
        format!("{:.3}", ms as f64 * 1e-3).replace('.', ",")
    });
    WINDOWS_1252
        .encode(&(head.to_owned() + &lines))
        .0
        .into_owned()
}

/// An export with commas and points, absolute pressures in kPa, a line of units.
fn english(table: &Table) -> Vec<u8> {
    let head = "Data export,,,,,,,\r\nSample rate,250,Hz,,,,,\r\n\r\nTime,Set pressure,Valve,Wall position,Outlet pressure,Stroke,Contact force,Acceleration\r\n\
        (s),(kPa abs),(-),(mm),(kPa abs),(mm),(N),(m/s2)\r\n";
    let lines = table.lines(",", '.', ["off", "on"], |ms| {
        format!("{:.4}", ms as f64 * 1e-3)
    });
    (head.to_owned() + &lines).into_bytes()
}

/// A controller's own log: durations and flags as IEC 61131-3 writes them.
fn controller(table: &Table) -> Vec<u8> {
    let head = "tElapsed|p_set_bar|xExtend|wall_mm|p_act_bar|pos_mm|force_N|acc_m_per_s2\r\n";
    let time = |ms: u64| format!("T#{}s{}ms", ms / 1000, ms % 1000);
    (head.to_owned() + &table.lines("|", '.', ["FALSE", "TRUE"], time)).into_bytes()
}

/// A data frame of pandas with stamps as its index.
fn pandas(table: &Table) -> Vec<u8> {
    let head = ",set_pressure_pa,solenoid,surface_m,regulator_pressure_pa,stroke_m,force_n,acceleration_m_per_s2\n";
    let stamp = |ms| format!("2024-03-05 {}000+00:00", clock(ms, '.'));
    let lines = table.lines(",", '.', ["False", "True"], stamp);
    (head.to_owned() + &lines.replace("\r\n", "\n")).into_bytes()
}

/// Excel in the United States: date and time apart, and the fifth of March looks like the third of May; psi, inches, pounds.
fn american(table: &Table) -> Vec<u8> {
    let head = "Date,Time,Pressure Setpoint (psig),Solenoid,Surface (in),Pressure (psig),Position (in),Load Cell (lbf),Accel (g)\r\n";
    let stamp = |ms| format!("3/5/2024,{} PM", clock(ms, '.').replacen("14", "02", 1));
    let lines = table.lines(",", '.', ["OFF", "ON"], stamp);
    (head.to_owned() + &lines).into_bytes()
}

const PSI: (f64, f64) = (6_894.757_293_168_361, 0.0);
const INCH: (f64, f64) = (0.0254, 0.0);
const KPA_ABS: (f64, f64) = (1e3, ATMOSPHERE);

fn dialects() -> [Dialect; 10] {
    let plain = |name, file, content| Dialect {
        name,
        file,
        units: METRIC,
        decimals: FINE,
        content,
        edit: None,
    };
    [
        plain("Excel, CSV UTF-8", "ride.csv", excel_csv),
        plain("Excel, Unicode text", "ride.txt", excel_unicode),
        plain("Siemens trace", "trace.csv", siemens),
        plain("TwinCAT Scope", "scope.csv", twincat),
        plain("LabVIEW", "ride.lvm", labview),
        Dialect {
            units: [BAR, SI, MM, BAR, MM, (1e3, 0.0), SI],
            decimals: [5, 0, 4, 5, 4, 6, 3],
            ..plain("catman", "ride.asc", catman)
        },
        Dialect {
            units: [KPA_ABS, SI, MM, KPA_ABS, MM, SI, SI],
            decimals: [3, 0, 4, 3, 4, 3, 3],
            ..plain("English export", "export.csv", english)
        },
        plain("IEC controller", "log.txt", controller),
        Dialect {
            units: [SI; 7],
            decimals: [1, 0, 7, 1, 7, 4, 4],
            ..plain("pandas", "frame.csv", pandas)
        },
        Dialect {
            units: [
                PSI,
                SI,
                INCH,
                PSI,
                INCH,
                (4.448_221_615_260_5, 0.0),
                (9.806_65, 0.0),
            ],
            decimals: [4, 0, 6, 4, 6, 4, 5],
            edit: Some((
                "date_column = \"Date\"",
                "date_column = \"Date\", date_order = \"month-day-year\"",
            )),
            ..plain("Excel, United States", "us.csv", american)
        },
    ]
}

/// Drafts a map for logs and returns it.
fn drafted(folder: &Folder, logs: &[&str]) -> (String, Outcome) {
    let outcome = folder.run(&[&["new", "import", "map.toml", "--force", "--from"], logs].concat());
    assert_eq!(
        (outcome.code, outcome.err.as_str()),
        (0, ""),
        "{}",
        outcome.out
    );
    (
        std::fs::read_to_string(folder.path("map.toml")).unwrap(),
        outcome,
    )
}

/// Imports a log by the drafted map and compares it with the truth, to the last digit that the logger wrote.
fn compare(folder: &Folder, dialect: &Dialect, truth: &Recording, map: &str) {
    let outcome = folder.idc(&["map.toml", dialect.file, "--out", "out.parquet", "--force"]);
    let name = dialect.name;
    assert_eq!(
        (outcome.code, outcome.err.as_str()),
        (0, ""),
        "{name}\n{map}"
    );
    assert!(
        !outcome.out.contains("doubtful"),
        "{name}\n{}\n{map}",
        outcome.out
    );
    let read = read_parquet(&folder.path("out.parquet")).unwrap().recording;
    assert_eq!(read.sample_count(), truth.sample_count(), "{name}");
    let since = |recording: &Recording, i: usize| recording.time()[i] - recording.time()[0];
    for i in 0..truth.sample_count() {
        assert!(
            (since(&read, i) - since(truth, i)).abs() < 1e-7,
            "{name}, time of row {i}"
        );
    }
    for (c, channel) in CHANNELS.into_iter().enumerate() {
        let values = read.values(channel);
        let values = values.unwrap_or_else(|error| panic!("{name}: {error}\n{map}"));
        let digit = 0.5 * dialect.units[c].0 * 0.1f64.powi(dialect.decimals[c] as i32);
        for (i, (own, right)) in values
            .iter()
            .zip(truth.values(channel).unwrap())
            .enumerate()
        {
            let same = own.is_nan() && right.is_nan();
            let near = (own - right).abs() <= 1.01 * digit + 1e-9 * right.abs();
            assert!(
                same || near,
                "{name}: {channel}, row {i}: {own} for {right}\n{map}"
            );
        }
    }
}

#[test]
fn ten_loggers_are_read_by_maps_drafted_from_their_logs() {
    let truth = truth();
    let mut edits = 0;
    for dialect in &dialects() {
        let folder = Folder::new();
        folder.write(dialect.file, (dialect.content)(&Table::of(&truth, dialect)));
        let (mut map, said) = drafted(&folder, &[dialect.file]);
        assert_eq!(
            said.out.contains("asked:"),
            dialect.edit.is_some(),
            "{}\n{}\n{map}",
            dialect.name,
            said.out
        );
        if let Some((from, to)) = dialect.edit {
            assert!(map.contains(from), "{}\n{map}", dialect.name);
            // Without the edit the log is refused, with what to write.
            let refused = folder.idc(&["map.toml", dialect.file]);
            assert_eq!(refused.code, 2, "{}", refused.out);
            assert!(
                refused.only_line("error: ").contains("date_order"),
                "{}",
                refused.err
            );
            map = map.replacen(from, to, 1);
            folder.write("map.toml", &map);
            edits += 1;
        }
        compare(&folder, dialect, &truth, &map);
    }
    // Eight of ten without, two with one.
    assert!(edits <= 2, "{edits}");
}

#[test]
fn logs_of_one_kind_share_a_map_and_what_is_not_known_is_asked_for() {
    let folder = Folder::new();
    // No names, no units: times rise, one column is of two states, the others may be anything.
    for name in ["a.csv", "b.csv"] {
        let row = |i: usize| {
            format!(
                "{},{},{:.3}\n",
                4 * i,
                i / 30 % 2,
                0.3 + 0.2 * (0.1 * i as f64).sin()
            )
        };
        folder.write(name, (0..200).map(row).collect::<String>());
    }
    let (map, said) = drafted(&folder, &["a.csv", "b.csv"]);
    assert_eq!(map.matches("[[file]]").count(), 1, "{map}");
    for words in [
        "unit = \"ms\"",
        "likely: nothing says it; steps of 4 make 250 samples a second of it",
        "quantity = \"valve_extends\"",
        "likely: it is of two states",
        "#   column 3: 0.1 to 0.5",
        "# quantity = \"set_pressure_gauge\"",
        "# [[constant]]",
    ] {
        assert!(map.contains(words), "{map}\nlacks {words:?}");
    }
    assert!(said.out.contains("valve_extends  column 2"), "{}", said.out);
    // A pressure that may be bar or MPa, and never rests.
    let row = |i: usize| format!("{},{:.3}\n", 4 * i, 0.5 + 0.1 * (0.1 * i as f64).sin());
    let text: String = (0..200).map(row).collect();
    folder.write("c.csv", format!("time [ms],pressure\n{text}"));
    let (map, said) = drafted(&folder, &["c.csv"]);
    assert!(
        map.contains("# unit = \"\"") && map.contains("asked: nothing says it"),
        "{map}"
    );
    assert!(
        said.out.contains("asked: unit of `pressure`"),
        "{}",
        said.out
    );
    let refused = folder.idc(&["map.toml", "c.csv"]);
    assert_eq!(refused.code, 2);
    assert!(
        refused.only_line("error: ").contains("unit"),
        "{}",
        refused.err
    );
}

#[test]
fn constants_stand_for_what_a_log_does_not_have() {
    let folder = Folder::new();
    folder.write(
        "log.csv",
        (0..100).map(|i| format!("{i},{i}\n")).collect::<String>(),
    );
    folder.map(
        "map.toml",
        "form = \"text\"\ntime = { column = 1, unit = \"ms\" }\n[[file.channel]]\nquantity = \"measured_force\"\ncolumn = 2\nunit = \"N\"\n\
         [[constant]]\nquantity = \"set_pressure_gauge\"\nvalue = 3.5\nunit = \"bar\"\npressure = \"gauge\"\n\
         [[constant]]\nquantity = \"valve_extends\"\nvalue = 1\nunit = \"1\"\n\
         [[constant]]\nquantity = \"surface_position\"\nvalue = nan\nunit = \"mm\"\n",
    );
    let (stored, _) = folder.imported("map.toml", &["log.csv"]);
    let all = |name: &str| stored.recording.values(name).unwrap().to_vec();
    assert_eq!(all("set_pressure_gauge"), [3.5e5; 100]);
    assert_eq!(all("valve_extends"), [1.0; 100]);
    assert!(all("surface_position").iter().all(|value| value.is_nan()));
}

#[test]
fn encodings_may_be_named() {
    let text = "t;Größe\n0;1\n1;2\n2;3\n";
    for (name, bytes) in [
        ("utf-8", UTF_8.encode(text).0.into_owned()),
        ("windows-1252", WINDOWS_1252.encode(text).0.into_owned()),
        (
            UTF_16LE.name(),
            text.encode_utf16().flat_map(u16::to_le_bytes).collect(),
        ),
    ] {
        let folder = Folder::new();
        folder.write("log.csv", bytes);
        folder.map(
            "map.toml",
            &format!("form = \"text\"\nencoding = \"{name}\"\nseparator = \";\"\nnames_line = 1\ntime = {{ column = \"t\", unit = \"s\" }}\n[[file.channel]]\nquantity = \"size\"\ncolumn = \"Größe\"\nunit = \"1\"\n"),
        );
        let (stored, _) = folder.imported("map.toml", &["log.csv"]);
        assert_eq!(
            stored.recording.values("size").unwrap(),
            [1.0, 2.0, 3.0],
            "{name}"
        );
    }
}
