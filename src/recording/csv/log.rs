//! A log whose columns depend on what was recorded: those of a kind, by their names, at stamps that increase.

use std::path::Path;

use super::super::RecordingError;
use super::columns::TIME;
use super::line::line_of;
use super::table::{fault, value};

/// A log; NaN where a field is empty.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Log {
    /// Stamps [s], increasing.
    pub time: Vec<f64>,
    /// Columns that were wanted, by name, in the order of the file.
    pub columns: Vec<(String, Vec<f64>)>,
    /// Line of each sample, from 1; of a table its row.
    pub lines: Vec<u64>,
    /// Lines whose stamp was that of the line before, left out.
    pub repeated: Vec<u64>,
    /// Columns that were not wanted.
    pub ignored: Vec<String>,
}

/// Reads a log as comma-separated values.
///
/// # Errors
/// A file that cannot be read, one without stamps, a field that is no number, a stamp before the one above it.
pub fn read_log_csv(path: &Path, wanted: impl Fn(&str) -> bool) -> Result<Log, RecordingError> {
    let text = crate::file::read_text(path).map_err(|e| RecordingError::read(path, e))?;
    let text = text.trim_start_matches('\u{feff}');
    let mut reader = csv::ReaderBuilder::new()
        .trim(csv::Trim::All)
        .from_reader(text.as_bytes());
    let header = reader.headers().map_err(|e| fault(path, text, &e))?.clone();
    let names: Vec<String> = header.iter().map(str::to_owned).collect();
    let Some(stamps) = names.iter().position(|name| name == TIME) else {
        return Err(no_stamps(path, &names));
    };
    let mut log = Log::default();
    let mut places = Vec::new();
    for (place, name) in names.iter().enumerate() {
        if names[..place].contains(name) {
            return Err(RecordingError::Column {
                path: path.to_owned(),
                column: name.clone(),
                found: "there twice".to_owned(),
                expected: "it once".to_owned(),
            });
        }
        if place == stamps {
            continue;
        }
        if wanted(name) {
            places.push(place);
            log.columns.push((name.clone(), Vec::new()));
        } else {
            log.ignored.push(name.clone());
        }
    }
    for record in reader.records() {
        let record = record.map_err(|e| fault(path, text, &e))?;
        let line = line_of(text, record.position());
        let field = |place: usize, name: &str| value(path, line, name, &record[place]);
        let time = field(stamps, TIME)?;
        if !log.takes(path, line, time)? {
            continue;
        }
        for ((name, values), place) in log.columns.iter_mut().zip(&places) {
            values.push(field(*place, name)?);
        }
    }
    Ok(log)
}

/// The refusal of a file without stamps.
pub(in super::super) fn no_stamps(path: &Path, names: &[String]) -> RecordingError {
    RecordingError::Column {
        path: path.to_owned(),
        column: TIME.to_owned(),
        found: "missing".to_owned(),
        // Their names are not shown: a case from elsewhere may name any file of this machine.
        expected: format!("it beside the {} columns that there are", names.len()),
    }
}

impl Log {
    /// Takes a stamp; not one that repeats the last.
    pub(in super::super) fn takes(
        &mut self,
        path: &Path,
        line: u64,
        time: f64,
    ) -> Result<bool, RecordingError> {
        let refuse = |found: String, expected: String| RecordingError::Line {
            path: path.to_owned(),
            line,
            column: TIME.to_owned(),
            found,
            expected,
        };
        if !time.is_finite() {
            let expected = "a time in s".to_owned();
            return Err(refuse("no number".to_owned(), expected));
        }
        if let Some(before) = self.time.last() {
            if time == *before {
                self.repeated.push(line);
                return Ok(false);
            }
            if time < *before {
                let expected = format!(
                    "more than the {before} s of the sample before it: where a clock starts again a recording ends, so make it two files"
                );
                return Err(refuse(format!("{time} s"), expected));
            }
        }
        self.time.push(time);
        self.lines.push(line);
        Ok(true)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Result<Log, RecordingError> {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("a.csv");
        std::fs::write(&file, text).unwrap();
        read_log_csv(&file, |name| name.starts_with("joint"))
    }

    #[test]
    fn repeated_stamps_are_left_out_and_a_clock_that_starts_again_is_refused() {
        let log =
            read("time_s,joint_1_rad,state\n0,1,run\n0.01,2,run\n0.01,2,run\n0.02,,run\n").unwrap();
        assert_eq!(log.time, [0.0, 0.01, 0.02]);
        assert_eq!(log.repeated, [4]);
        assert_eq!(log.ignored, ["state"]);
        assert!(log.columns[0].1[2].is_nan());
        let error = read("time_s,joint_1_rad\n0,1\n0.01,2\n0,1\n").unwrap_err();
        let text = error.to_string();
        assert!(
            text.contains(":4:") && text.contains("starts again"),
            "{text}"
        );
        let error = read("joint_1_rad\n0\n").unwrap_err().to_string();
        assert!(error.contains("time_s"), "{error}");
    }
}
