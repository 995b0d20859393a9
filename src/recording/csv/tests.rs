//! Files that are right, and what is said of those that are not.

use super::super::schema;
use super::*;

const HEADER: &str = "time_s,set_pressure_pa,solenoid,surface_m,regulator_pressure_pa,stroke_m,force_n,acceleration_m_per_s2";

/// Ten samples at 250 Hz.
fn lines() -> Vec<String> {
    let row = |i: i32| {
        format!(
            "{:.4},200000,1,0.02,{},0.01,{},0.1",
            0.004 * f64::from(i),
            190_000 + i,
            i
        )
    };
    std::iter::once(HEADER.to_owned())
        .chain((0..10).map(row))
        .collect()
}

fn read(lines: &[String]) -> Result<CsvRecording, RecordingError> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("ride.csv");
    std::fs::write(&path, lines.join("\n") + "\n").unwrap();
    read_csv(&path)
}

fn refused(lines: &[String], says: &str) {
    let message = read(lines).unwrap_err().to_string();
    assert!(message.contains("ride.csv"), "{message}");
    assert!(message.contains(says), "{message}\nlacks {says:?}");
}

fn with(line: usize, text: &str) -> Vec<String> {
    let mut lines = lines();
    text.clone_into(&mut lines[line - 1]);
    lines
}

/// The file with other names or numbers everywhere.
fn replaced(from: &str, to: &str) -> Vec<String> {
    let lines: Vec<String> = lines().iter().map(|line| line.replace(from, to)).collect();
    assert_ne!(lines, self::lines(), "{from}");
    lines
}

#[test]
fn a_file_becomes_a_recording_with_empty_fields_as_nan() {
    let file = read(&with(4, "0.0080,200000,1,,190002,,7,0.1")).unwrap();
    let recording = &file.recording;
    assert_eq!(recording.sample_count(), 10);
    assert_eq!(recording.time()[3], 0.012);
    assert_eq!(recording.values(schema::MEASURED_FORCE).unwrap()[2], 7.0);
    assert!(recording.values(schema::SURFACE_POSITION).unwrap()[2].is_nan());
    assert!(recording.values(schema::MEASURED_STROKE).unwrap()[2].is_nan());
    assert_eq!(
        recording.values(schema::SET_PRESSURE_GAUGE).unwrap()[9],
        2e5
    );
    assert!(file.repeated.is_empty() && file.ignored.is_empty());
}

#[test]
fn columns_may_stand_in_any_order_and_measured_ones_may_be_absent() {
    let shuffled: Vec<String> = lines()
        .iter()
        .map(|line| {
            let f: Vec<&str> = line.split(',').collect();
            [f[6], f[3], f[0], f[2], f[1], f[7]].join(",")
        })
        .collect();
    let file = read(&shuffled).unwrap();
    let whole = read(&lines()).unwrap();
    assert!(file.recording.channel(schema::MEASURED_STROKE).is_none());
    for channel in file.recording.channels() {
        assert_eq!(Some(channel), whole.recording.channel(&channel.quantity));
    }
}

#[test]
fn a_line_that_is_repeated_counts_once() {
    let mut twice = lines();
    twice.insert(5, twice[4].clone());
    let file = read(&twice).unwrap();
    assert_eq!(file.repeated, [6]);
    assert_eq!(file.recording, read(&lines()).unwrap().recording);
}

#[test]
fn what_cannot_be_read_is_refused_with_line_and_column() {
    refused(
        &replaced("solenoid", "valve"),
        "column `solenoid` is missing, expected it beside the other inputs",
    );
    refused(
        &replaced("force_n", "force_kN"),
        "column `force_kN` is unknown, expected the column `force_n`, in SI",
    );
    refused(
        &replaced("stroke_m", "force_n"),
        "column `force_n` is there twice",
    );
    refused(
        &replaced("time_s", "when"),
        "column `time_s` is missing, expected the columns time_s, ",
    );
    refused(
        &with(4, "0.0080,200000,1,0.02,190002,abc,7,0.1"),
        "ride.csv:4: column `stroke_m` is \"abc\", expected a finite number, or nothing",
    );
    refused(
        &with(4, "0.0080,200000,1,0.02,190002,inf,7,0.1"),
        "ride.csv:4: column `stroke_m` is \"inf\"",
    );
    refused(
        &with(4, "0.0080,200000,1,0.02"),
        "ride.csv:4: 4 fields, expected 8, as many as the header names",
    );
    refused(
        &with(4, "0.0030,200000,1,0.02,190002,0.01,7,0.1"),
        "ride.csv:4: column `time_s` is 0.003 s, expected more than the 0.004 s of the sample before it",
    );
    refused(
        &with(4, ",200000,1,0.02,190002,0.01,7,0.1"),
        "ride.csv:4: column `time_s` is \"\", expected a time in s",
    );
    refused(
        &with(2, "0.0000,,1,0.02,190002,0.01,7,0.1"),
        "ride.csv:2: column `set_pressure_pa` is empty, expected what is commanded at the start",
    );
    refused(
        &with(4, "0.0080,200000,0.5,0.02,190002,0.01,7,0.1"),
        "ride.csv:4: column `solenoid` is 0.5, expected 1 to extend or 0 to retract",
    );
    refused(&lines()[..2], "1 samples, expected at least 2");
    refused(&[], "column `time_s` is missing");
    let missing = read_csv(Path::new("/nowhere/ride.csv")).unwrap_err();
    assert!(
        missing
            .to_string()
            .starts_with("cannot read /nowhere/ride.csv")
    );
}

#[test]
fn units_other_than_si_are_recognised() {
    refused(
        &replaced("200000", "2"),
        "ride.csv:2: column `set_pressure_pa` is 2 Pa at most, expected at least 2000 Pa somewhere (it looks like bar or kPa",
    );
    refused(
        &replaced("19000", "1.90"),
        "column `regulator_pressure_pa` is 1.909 Pa at most",
    );
    refused(
        &replaced(",0.01,", ",10,"),
        "ride.csv:2: column `stroke_m` is 10 m, expected -0.5 to 1.5 m (it looks like mm",
    );
    refused(&replaced(",0.02,", ",20,"), "column `surface_m` is 20 m");
    let in_milliseconds: Vec<String> = lines()
        .iter()
        .enumerate()
        .map(|(i, line)| match line.split_once(',') {
            Some((_, rest)) if i > 0 => format!("{},{rest}", 4 * (i - 1)),
            _ => line.clone(),
        })
        .collect();
    refused(
        &in_milliseconds,
        "column `time_s` is in steps of 4 s, expected steps of at most 0.2 s (it looks like ms",
    );
}

#[test]
fn one_wild_reading_is_no_wrong_unit() {
    let mut many: Vec<String> = vec![HEADER.to_owned()];
    for i in 0..100 {
        let force = if i == 50 { "1e9" } else { "1" };
        many.push(format!(
            "{},200000,1,,190000,0.01,{force},0.1",
            0.004 * f64::from(i)
        ));
    }
    assert_eq!(read(&many).unwrap().recording.sample_count(), 100);
}

#[test]
fn what_is_written_reads_back() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("prediction.csv");
    let values = [0.1 + 0.2, f64::NAN, -3e-7];
    write_csv(&path, &[0.0, 0.002, 0.004], &[("force_n", &values)]).unwrap();
    let text = std::fs::read_to_string(&path).unwrap();
    assert_eq!(
        text,
        "time_s,force_n\n0.0,0.30000000000000004\n0.002,\n0.004,-3e-7\n"
    );
}
