//! `idc import`: a planted trajectory in every form of log comes back; what does not fit is refused by one line.

mod bags;
mod dialects;
pub mod files;
mod forms;
mod hostile;
mod kinds;
mod real;
mod refused;
mod stored;

use std::path::PathBuf;
use std::process::Command;

use idc_cell::recording::parquet::{StoredRecording, read_parquet};
use idc_cell::recording::{RecordedChannel, Recording, Unit};

use crate::program::Outcome;
use files::{ROWS, START, Truth, dotted, truth, whole};

/// A folder with logs and maps.
struct Folder(tempfile::TempDir);

impl Folder {
    fn new() -> Self {
        Self(tempfile::tempdir().unwrap())
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    fn write(&self, name: &str, content: impl AsRef<[u8]>) {
        std::fs::write(self.path(name), content).unwrap();
    }

    /// Writes a map of one file.
    fn map(&self, name: &str, keys: &str) {
        self.write(
            name,
            format!("schema = 1\ntitle = \"A test\"\n[[file]]\n{keys}"),
        );
    }

    /// Runs `idc import`.
    fn idc(&self, arguments: &[&str]) -> Outcome {
        self.run(&[&["import"], arguments].concat())
    }

    /// Runs the program in the folder.
    fn run(&self, arguments: &[&str]) -> Outcome {
        let output = Command::new(env!("CARGO_BIN_EXE_idc"))
            .args(arguments)
            .current_dir(self.0.path())
            .output()
            .unwrap();
        Outcome {
            code: output.status.code().expect("the program was not killed"),
            out: String::from_utf8(output.stdout).unwrap(),
            err: String::from_utf8(output.stderr).unwrap(),
        }
    }

    /// Imports logs and reads what was written.
    fn imported(&self, map: &str, logs: &[&str]) -> (StoredRecording, String) {
        let outcome = self.idc(&[&[map], logs, &["--out", "out.parquet", "--force"]].concat());
        assert_eq!(
            (outcome.code, outcome.err.as_str()),
            (0, ""),
            "{}",
            outcome.out
        );
        (
            read_parquet(&self.path("out.parquet")).unwrap(),
            outcome.words(),
        )
    }

    fn names(&self, folder: &str) -> Vec<String> {
        let entries = std::fs::read_dir(self.path(folder)).unwrap();
        let mut names: Vec<String> = entries
            .map(|entry| entry.unwrap().file_name().into_string().unwrap())
            .collect();
        names.sort();
        names
    }
}

/// A channel's keys in a map.
fn channel(quantity: &str, column: &str, unit: &str) -> String {
    let pressure = if quantity.contains("pressure") {
        "pressure = \"gauge\"\n"
    } else {
        ""
    };
    format!(
        "[[file.channel]]\nquantity = \"{quantity}\"\ncolumn = {column}\nunit = \"{unit}\"\n{pressure}"
    )
}

/// Asks a recording for the planted trajectory, to the rounding of its unit's factor.
fn assert_planted(recording: &Recording, what: &[Planted]) {
    assert_eq!(recording.sample_count(), ROWS);
    let start = recording.time()[0] - truth(0).time;
    for (row, time) in recording.time().iter().enumerate() {
        assert!(
            (time - start - truth(row).time).abs() < 1e-9,
            "row {row}: {time}"
        );
    }
    for (quantity, of, tolerance) in what {
        for (row, value) in recording.values(quantity).unwrap().iter().enumerate() {
            let right = of(truth(row));
            assert!(
                (value - right).abs() <= tolerance * right.abs().max(1e-3),
                "{quantity}, row {row}: {value}, planted {right}"
            );
        }
    }
}

/// A quantity, what was planted, and how far the two may be apart, relatively.
type Planted = (&'static str, fn(Truth) -> f64, f64);

const EXACT: f64 = 1e-14;
const STROKE: Planted = ("stroke", |t| t.stroke, 1e-12);
const FORCE: Planted = ("force", |t| t.force, EXACT);

#[test]
fn texts_of_every_kind_come_back() {
    let folder = Folder::new();
    // Semicolons, decimal commas, a spreadsheet's dots in times, pressure in psi.
    let comma = |number: f64| format!("{number}").replace('.', ",");
    files::text(&folder.path("log.csv"), "made by\r\nt;F;p;s\r\n", |row| {
        let (truth, (millis, micros)) = (truth(row), whole(row));
        let psi = comma(truth.pressure / 6_894.757_293_168_361);
        let time = dotted(millis * 1000);
        format!(
            "{time};{};{psi};{}\r",
            comma(truth.force),
            comma(micros as f64 * 1e-3)
        )
    });
    let keys = "form = \"text\"\nseparator = \";\"\ndecimal_mark = \",\"\nheader_lines = 2\nnames_line = 2\n\
        time = { column = \"t\", unit = \"us\", thousands_mark = \".\" }\n";
    let channels = [
        channel("force", "\"F\"", "N"),
        channel("pressure_gauge", "\"p\"", "psi"),
        channel("stroke", "\"s\"", "mm"),
    ];
    folder.map("map.toml", &(keys.to_owned() + &channels.concat()));
    let pressure: Planted = ("pressure_gauge", |t| t.pressure, 1e-12);
    let (stored, _) = folder.imported("map.toml", &["log.csv"]);
    assert_planted(&stored.recording, &[FORCE, STROKE, pressure]);

    // Fields of a width, a sensor in volts, the other sign.
    files::text(&folder.path("log.txt"), "", |row| {
        let volts = (truth(row).force + 12.0) / 50.0;
        let (millis, micros) = whole(row);
        format!("{millis:>7}{:>24}{micros:>9}", -volts)
    });
    let force = "[[file.channel]]\nquantity = \"force\"\ncolumn = 2\nunit = \"N\"\ngain = 50.0\noffset = 12.0\nreversed = true\n";
    let stroke = channel("stroke", "3", "um");
    folder.map(
        "map.toml",
        &format!("form = \"text\"\nfield_widths = [7, 24, 9]\ntime = {{ column = 1, unit = \"ms\" }}\n{force}{stroke}"),
    );
    let (stored, _) = folder.imported("map.toml", &["log.txt"]);
    let volts: Planted = ("force", |t| t.force, 1e-13);
    assert_planted(&stored.recording, &[volts, STROKE]);
}

#[test]
fn a_parquet_with_stamps_comes_back() {
    let folder = Folder::new();
    files::parquet(&folder.path("log.parquet"));
    let channels =
        channel("force", "\"force_kn\"", "kN") + &channel("stroke", "\"stroke_mm\"", "mm");
    let keys = "form = \"parquet\"\ntime = { column = \"stamp\" }\n";
    folder.map("map.toml", &(keys.to_owned() + &channels));
    let (stored, said) = folder.imported("map.toml", &["log.parquet"]);
    let single: Planted = ("stroke", |t| t.stroke, 3e-7);
    let force: Planted = ("force", |t| t.force, 1e-13);
    assert_planted(&stored.recording, &[force, single]);
    let origin = START + 1;
    assert_eq!(stored.metadata["time_origin_unix_s"], origin.to_string());
    assert!(said.contains(&origin.to_string()), "{said}");
    assert_eq!(stored.recording.time()[0], 0.0);
}

#[test]
fn what_the_program_writes_is_imported_and_read_alike() {
    let folder = Folder::new();
    let time: Vec<f64> = (0..ROWS).map(|row| truth(row).time).collect();
    let values = |of: fn(Truth) -> f64| (0..ROWS).map(|row| of(truth(row))).collect();
    let own = Recording::new(
        time,
        vec![
            RecordedChannel::new("force", Unit::Newton, values(|t| t.force)),
            RecordedChannel::new("stroke", Unit::Metre, values(|t| t.stroke)),
        ],
        Vec::new(),
    )
    .unwrap();
    let path = folder.path("samples.parquet");
    idc_cell::recording::parquet::write_parquet(
        &path,
        &own,
        &std::collections::BTreeMap::default(),
    )
    .unwrap();
    let channels = channel("force", "\"force_n\"", "N") + &channel("stroke", "\"stroke_m\"", "m");
    let keys = "form = \"parquet\"\ntime = { column = \"time_s\", unit = \"s\" }\n";
    folder.map("map.toml", &(keys.to_owned() + &channels));
    let (stored, _) = folder.imported("map.toml", &["samples.parquet"]);
    assert_eq!(stored.recording, own);
    assert_eq!(stored.recording, read_parquet(&path).unwrap().recording);
}

#[test]
fn a_mat_file_comes_back_packed_or_not() {
    for packed in [false, true] {
        let folder = Folder::new();
        files::mat5(&folder.path("log.mat"), packed);
        let channels =
            channel("force", "\"data(:,2)\"", "N") + &channel("stroke", "\"data(:,1)\"", "mm");
        // Whole numbers of 32 bits, 30 mm less than the stroke.
        let moved = "[[file.channel]]\nquantity = \"measured_stroke\"\ncolumn = \"u\"\nunit = \"um\"\noffset = 30000\n";
        let channels = channels + moved;
        let keys = "form = \"mat5\"\ntime = { column = \"t\", unit = \"ms\" }\n";
        folder.map("map.toml", &(keys.to_owned() + &channels));
        let (stored, _) = folder.imported("map.toml", &["log.mat"]);
        let moved: Planted = ("measured_stroke", |t| t.stroke, 1e-12);
        assert_planted(&stored.recording, &[FORCE, STROKE, moved]);
    }
}

#[test]
fn topics_with_stamps_of_their_own_come_back_whatever_the_compression() {
    let compressions = [
        None,
        Some(mcap::Compression::Lz4),
        Some(mcap::Compression::Zstd),
    ];
    for compression in compressions {
        let folder = Folder::new();
        files::mcap(&folder.path("log.mcap"), compression);
        let channels = channel("force", "\"/wrench.wrench.force.z\"", "N")
            + &channel("elbow_angle", "\"/joint_states.position[1]\"", "rad")
            + &channel("stroke", "\"/wrench.wrench.torque.z\"", "m");
        let keys = "form = \"mcap\"\ntime = { column = \"header.stamp\" }\n";
        folder.map("map.toml", &(keys.to_owned() + &channels));
        let (stored, _) = folder.imported("map.toml", &["log.mcap"]);
        let stroke: Planted = ("stroke", |t| t.stroke, EXACT);
        assert_planted(&stored.recording, &[FORCE, stroke]);
        let angle = stored.recording.values("elbow_angle").unwrap();
        // A line, so that reading it off between its messages is exact; it starts 1 ms after the wrench and ends 8 ms before it.
        assert!(angle[0].is_nan() && angle[ROWS - 1].is_nan());
        for (row, angle) in angle.iter().enumerate().take(ROWS - 4).skip(1) {
            let right = 10.0 * truth(row).time;
            assert!((angle - right).abs() < 1e-8, "row {row}: {angle}");
        }
    }
}

#[test]
fn a_topic_without_a_stamp_has_the_times_at_which_it_was_logged() {
    let folder = Folder::new();
    files::mcap(&folder.path("log.mcap"), None);
    folder.map(
        "map.toml",
        &("form = \"mcap\"\n".to_owned() + &channel("pressure_gauge", "\"/set.data\"", "Pa")),
    );
    let (stored, _) = folder.imported("map.toml", &["log.mcap"]);
    let recording = &stored.recording;
    assert_eq!(recording.sample_count(), ROWS / 5);
    assert_eq!(
        stored.metadata["time_origin_unix_s"],
        (START + 1).to_string()
    );
    for (index, value) in recording
        .values("pressure_gauge")
        .unwrap()
        .iter()
        .enumerate()
    {
        let row = 5 * index;
        assert_eq!(*value, truth(row).pressure);
        let logged = truth(row).time - 1.0 + 300e-6 + 1e-6 * (row % 7) as f64;
        assert!((recording.time()[index] - logged).abs() < 1e-9);
    }
}

#[test]
fn a_clock_that_is_off_by_what_nobody_knows_is_set_right() {
    let folder = Folder::new();
    let trajectory =
        |t: f64| (-(t - 1.4f64).powi(2) / 0.01).exp() - 0.7 * (-(t - 1.6f64).powi(2) / 0.003).exp();
    files::text(&folder.path("force.csv"), "", |row| {
        let time = truth(row).time;
        format!("{time},{}", 80.0 * trajectory(time))
    });
    // It rises and falls with the force, and its clock is 0.2347 s ahead.
    files::text(&folder.path("stroke.csv"), "", |row| {
        let time = 1.1 + 0.0013 * row as f64;
        format!("{},{}", time + 0.2347, 3.0 + 5.0 * trajectory(time))
    });
    let time = "form = \"text\"\ntime = { column = 1, unit = \"s\" }\n";
    let clock =
        "clock = \"unknown\"\naligned_by = [\"force\", \"stroke\"]\nlargest_offset_s = 1.0\n";
    folder.write(
        "map.toml",
        format!(
            "schema = 1\ntitle = \"Two clocks\"\n[[file]]\n{time}{}[[file]]\n{clock}{time}{}",
            channel("force", "2", "N"),
            channel("stroke", "2", "mm")
        ),
    );
    let (stored, said) = folder.imported("map.toml", &["force.csv", "stroke.csv"]);
    let (_, found) = said.split_once("its clock was found: ").unwrap();
    let found: f64 = found.split_whitespace().next().unwrap().parse().unwrap();
    assert!((found + 0.2347).abs() < 2e-4, "{said}");
    let stroke = stored.recording.values("stroke").unwrap();
    let off = stored
        .recording
        .time()
        .iter()
        .zip(stroke)
        .filter(|(_, s)| s.is_finite());
    let worst = off
        .map(|(t, s)| (s - 5e-3 * trajectory(*t) - 3e-3).abs())
        .fold(0.0, f64::max);
    assert!(worst < 2e-5, "{worst}");
}

/// Two loggers of one motion, the second's clock ahead or behind: `clock_offset_s` is added to its stamps, so that what happens at once is at one time in the
/// recording. Of the wrong sign the stroke would lie twice the offset off the force.
#[test]
fn a_clock_offset_that_is_given_is_added_to_the_stamps() {
    for offset in [0.35, -0.2] {
        let folder = Folder::new();
        let trajectory = |t: f64| (-(t - 1.4f64).powi(2) / 0.01).exp();
        files::text(&folder.path("force.csv"), "", |row| {
            let time = truth(row).time;
            format!("{time},{}", 80.0 * trajectory(time))
        });
        // What it stamps with s happened at s + offset.
        files::text(&folder.path("stroke.csv"), "", |row| {
            let time = 1.0 + 0.0017 * row as f64;
            format!("{},{}", time - offset, 5.0 * trajectory(time))
        });
        let time = "form = \"text\"\ntime = { column = 1, unit = \"s\" }\n";
        folder.write(
            "map.toml",
            format!(
                "schema = 1\ntitle = \"Two clocks\"\n[[file]]\n{time}{}[[file]]\nclock_offset_s = {offset}\n{time}{}",
                channel("force", "2", "N"),
                channel("stroke", "2", "mm")
            ),
        );
        let (stored, _) = folder.imported("map.toml", &["force.csv", "stroke.csv"]);
        let stroke = stored.recording.values("stroke").unwrap();
        let both = stored.recording.time().iter().zip(stroke);
        let off = both.filter(|(_, stroke)| stroke.is_finite());
        let worst = off.map(|(t, stroke)| (stroke - 5e-3 * trajectory(*t)).abs());
        let (count, worst) = worst.fold((0, 0.0f64), |(n, most), off| (n + 1, most.max(off)));
        assert!(
            count > ROWS / 3 && worst < 2e-5,
            "{offset}: {count} samples, {worst}"
        );
    }
}

/// A map and logs that the other tests write for themselves.
fn plain(folder: &Folder, names: &[&str]) {
    for name in names {
        files::text(&folder.path(name), "t;F\n", |row| {
            format!("{};{}", whole(row).0, truth(row).force)
        });
    }
    let keys = "form = \"text\"\nseparator = \";\"\nnames_line = 1\ntime = { column = \"t\", unit = \"ms\" }\n";
    folder.map(
        "map.toml",
        &(keys.to_owned() + &channel("force", "\"F\"", "N")),
    );
}

#[test]
fn a_folder_of_logs_makes_a_recording_each_by_its_name() {
    let folder = Folder::new();
    plain(&folder, &["F35_v0.10_a.csv", "F35_v0.25_a.csv"]);
    let outcome = folder.idc(&[
        "map.toml",
        "F35_v0.10_a.csv",
        "F35_v0.25_a.csv",
        "--out",
        "made/here",
    ]);
    assert_eq!(outcome.code, 0, "{}", outcome.err);
    assert_eq!(
        folder.names("made/here"),
        ["F35_v0.10_a.parquet", "F35_v0.25_a.parquet"]
    );
    assert!(
        outcome
            .out
            .contains("are the same data: 100 % of their rows"),
        "{}",
        outcome.out
    );
    // One log into a folder that is there.
    let outcome = folder.idc(&["map.toml", "F35_v0.10_a.csv", "--out", "made"]);
    assert_eq!(outcome.code, 0, "{}", outcome.err);
    assert_eq!(folder.names("made"), ["F35_v0.10_a.parquet", "here"]);
}

#[test]
fn what_was_understood_is_reported_to_people_to_programs_or_to_nobody() {
    let folder = Folder::new();
    plain(&folder, &["a.csv", "b.csv"]);
    // A row twice, and one with a time that was there.
    let text = std::fs::read_to_string(folder.path("a.csv")).unwrap();
    let lines: Vec<&str> = text.lines().collect();
    let time = lines[10].split(';').next().unwrap();
    let stamped = format!("{time};0");
    let doubled = [&lines[..11], &[lines[10], &stamped], &lines[11..]].concat();
    folder.write("a.csv", doubled.join("\n") + "\n");
    let said = folder.idc(&["map.toml", "a.csv", "b.csv"]).words();
    for words in [
        "a.csv: 400 samples from 1.000 to 1.798 s",
        "force N 500",
        "rows that repeat the one before them were left out: 1 (line 12)",
        "with the time of the one before them but other values were left out: 1 (line 13)",
        "a.csv and b.csv are the same data: 100 % of their rows",
    ] {
        assert!(said.contains(words), "{said}\nlacks {words:?}");
    }
    let json = folder.idc(&["map.toml", "a.csv", "b.csv", "--json", "--out", "out"]);
    assert_eq!((json.code, json.err.as_str()), (0, ""));
    let json: serde_json::Value = serde_json::from_str(&json.out).unwrap();
    assert_eq!(json["same_data"][0]["share"], 1.0);
    let first = &json["recordings"][0];
    assert_eq!(first["samples"], 400);
    assert_eq!(first["written_to"], "out/a.parquet");
    assert_eq!(first["logs"][0]["remarks"].as_array().unwrap().len(), 2);
    let force = &first["channels"][0];
    assert_eq!(
        (force["quantity"].as_str(), force["unit"].as_str()),
        (Some("force"), Some("N"))
    );
    assert!((force["rate_hz"].as_f64().unwrap() - 500.0).abs() < 1e-6);
    let quiet = folder.idc(&["map.toml", "a.csv", "--quiet", "--out", "a.parquet"]);
    assert_eq!(
        (quiet.code, quiet.out.as_str(), quiet.err.as_str()),
        (0, "", "")
    );
    assert!(folder.path("a.parquet").is_file());
}
