//! Columns of a table of runs, by names that its owner gave them.

use std::path::Path;

use super::super::RecordingError;
use super::line::line_of;
use super::table::fault;

/// Values of the columns asked for, NaN for an empty field, and the line of each row, from 1.
#[derive(Debug, Clone, PartialEq)]
pub struct NamedColumns {
    /// In the order asked for.
    pub columns: Vec<Vec<f64>>,
    /// Line of each row.
    pub lines: Vec<u64>,
}

/// Names in the header of a table.
///
/// # Errors
/// A file that cannot be read.
pub fn header_of(path: &Path) -> Result<Vec<String>, RecordingError> {
    let text = crate::file::read_text(path).map_err(|e| RecordingError::read(path, e))?;
    let text = text.trim_start_matches('\u{feff}');
    let mut reader = csv::ReaderBuilder::new()
        .trim(csv::Trim::All)
        .from_reader(text.as_bytes());
    let header = reader.headers().map_err(|e| fault(path, text, &e))?;
    Ok(header.iter().map(str::to_owned).collect())
}

/// Reads columns by their names.
///
/// # Errors
/// A file that cannot be read, a column that it lacks, a field that is no number.
pub fn read_named(path: &Path, names: &[&str]) -> Result<NamedColumns, RecordingError> {
    let text = crate::file::read_text(path).map_err(|e| RecordingError::read(path, e))?;
    let text = text.trim_start_matches('\u{feff}');
    let mut reader = csv::ReaderBuilder::new()
        .trim(csv::Trim::All)
        .from_reader(text.as_bytes());
    let header = reader.headers().map_err(|e| fault(path, text, &e))?.clone();
    let place = |name: &&str| {
        header
            .iter()
            .position(|column| column == *name)
            .ok_or_else(|| {
                // Not what is there: a case from elsewhere may name any file of this machine.
                let reason = format!(
                    "there is no column `{name}` among the {} of its first line, expected one of this name",
                    header.len()
                );
                RecordingError::read(path, reason)
            })
    };
    let places = names.iter().map(place).collect::<Result<Vec<usize>, _>>()?;
    let mut columns = vec![Vec::new(); names.len()];
    let mut lines = Vec::new();
    for record in reader.records() {
        let record = record.map_err(|e| fault(path, text, &e))?;
        let line = line_of(text, record.position());
        lines.push(line);
        for ((values, place), name) in columns.iter_mut().zip(&places).zip(names) {
            let field = &record[*place];
            let value = match field {
                "" => Some(f64::NAN),
                _ => field.parse().ok().filter(|value: &f64| value.is_finite()),
            };
            values.push(value.ok_or_else(|| {
                let reason =
                    format!("line {line}: `{name}` is {field:?}, expected a number or nothing");
                RecordingError::read(path, reason)
            })?);
        }
    }
    Ok(NamedColumns { columns, lines })
}
