//! A log of any form, its columns by name.

use std::path::Path;

use super::RecordingError;
use super::csv::{Log, read_log_csv};

/// Reads the columns of a log that are wanted: of a Parquet table by its extension, otherwise of comma-separated values.
///
/// # Errors
/// Those of the file; any table where the library is built without the feature `parquet`.
pub fn read_log(path: &Path, wanted: impl Fn(&str) -> bool) -> Result<Log, RecordingError> {
    let is_table = path.extension().is_some_and(|ending| ending == "parquet");
    if !is_table {
        return read_log_csv(path, wanted);
    }
    #[cfg(feature = "parquet")]
    return of_table(path, wanted);
    #[cfg(not(feature = "parquet"))]
    return Err(RecordingError::WithoutParquet {
        file: path.display().to_string(),
    });
}

#[cfg(feature = "parquet")]
fn of_table(path: &Path, wanted: impl Fn(&str) -> bool) -> Result<Log, RecordingError> {
    use super::csv::no_stamps;
    use super::long_column::LongColumn;
    use super::long_table::read_columns;

    const TIME: &str = "time_s";
    let mut log = Log::default();
    let (mut stamps, mut columns) = (None, Vec::new());
    for (name, column) in read_columns(path, |name| name == TIME || wanted(name))? {
        match column {
            LongColumn::Numbers(values) if name == TIME => stamps = Some(values),
            LongColumn::Numbers(values) => columns.push((name, values)),
            LongColumn::Names(_) => log.ignored.push(name),
        }
    }
    let Some(stamps) = stamps else {
        let names: Vec<String> = columns.into_iter().map(|(name, _)| name).collect();
        return Err(no_stamps(path, &names));
    };
    let mut kept = Vec::new();
    for (row, time) in stamps.into_iter().enumerate() {
        if log.takes(path, row as u64 + 1, time)? {
            kept.push(row);
        }
    }
    let columns = columns.into_iter().map(|(name, values)| {
        let values = kept.iter().map(|row| values[*row]).collect();
        (name, values)
    });
    log.columns = columns.collect();
    Ok(log)
}
