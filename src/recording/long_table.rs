//! Long tables as Parquet: columns of names and of numbers, one row an observation, as a data frame takes them.
//!
//! Numbers are `f64`, null where there is none; names are text. Equal tables give equal bytes.

use std::path::Path;
use std::sync::Arc;

use ::parquet::arrow::ArrowWriter;
use ::parquet::basic::{Compression, Encoding};
use ::parquet::errors::ParquetError;
use ::parquet::file::properties::WriterProperties;
use ::parquet::schema::types::ColumnPath;
use arrow::array::{
    Array, ArrayRef, AsArray, DictionaryArray, Float64Array, RecordBatch, new_empty_array,
};
use arrow::compute::cast;
use arrow::datatypes::{DataType, Field, FieldRef, Float64Type, Int32Type, Schema};

use super::RecordingError;
use super::atomic::write_atomic;
use super::long_column::LongColumn;
use super::parquet_file::ParquetFile;
use crate::file::Limit;

/// Writes columns by name, all of one length.
///
/// # Errors
/// [`RecordingError::Write`] if the file cannot be written; nothing is left then.
pub fn write_long(path: &Path, columns: &[(String, LongColumn)]) -> Result<(), RecordingError> {
    let kinds: Vec<(&str, bool)> = (columns.iter())
        .map(|(name, column)| (name.as_str(), matches!(column, LongColumn::Names(_))))
        .collect();
    let mut group = Some(columns.iter().map(|(_, column)| column.clone()).collect());
    write_groups(path, &kinds, || Ok::<_, RecordingError>(group.take()))
}

/// Writes a table group of rows by group of rows, so that no more than a group is held: columns by name, and whether they hold names; `next` gives the values
/// of the next group in the same order, or none after the last.
///
/// # Errors
/// [`RecordingError::Write`] if the file cannot be written, or what `next` fails with; nothing is left then.
pub fn write_groups<E: From<RecordingError>>(
    path: &Path,
    columns: &[(&str, bool)],
    mut next: impl FnMut() -> Result<Option<Vec<LongColumn>>, E>,
) -> Result<(), E> {
    let schema = schema(columns);
    let properties = properties(columns);
    let mut fault = None;
    let written = write_atomic(path, |file| -> Result<(), ParquetError> {
        let mut writer = ArrowWriter::try_new(file, Arc::clone(&schema), Some(properties))?;
        loop {
            let group = match next() {
                Ok(Some(group)) => group,
                Ok(None) => break,
                Err(error) => {
                    fault = Some(error);
                    return Err(ParquetError::General("not finished".to_owned()));
                }
            };
            let arrays = group.iter().map(array).collect();
            writer.write(&RecordBatch::try_new(Arc::clone(&schema), arrays)?)?;
            writer.flush()?;
        }
        writer.close()?;
        Ok(())
    });
    match fault {
        Some(error) => Err(error),
        None => Ok(written?),
    }
}

fn schema(columns: &[(&str, bool)]) -> Arc<Schema> {
    let fields = columns.iter().map(|(name, names)| {
        let kind = match names {
            true => DataType::Dictionary(Box::new(DataType::Int32), Box::new(DataType::Utf8)),
            false => DataType::Float64,
        };
        Field::new(*name, kind, true)
    });
    Arc::new(Schema::new(fields.collect::<Vec<_>>()))
}

/// Columns by name, all of one length, as the tables of this file have them.
#[cfg(feature = "cli")]
pub(super) fn batch_of_columns(
    columns: &[(String, LongColumn)],
) -> Result<RecordBatch, arrow::error::ArrowError> {
    let kinds: Vec<(&str, bool)> = (columns.iter())
        .map(|(name, column)| (name.as_str(), matches!(column, LongColumn::Names(_))))
        .collect();
    let arrays = columns.iter().map(|(_, column)| array(column)).collect();
    RecordBatch::try_new(schema(&kinds), arrays)
}

fn array(column: &LongColumn) -> ArrayRef {
    match column {
        LongColumn::Names(names) => {
            let names = names.iter().map(|name| Some(name.as_str()));
            Arc::new(names.collect::<DictionaryArray<Int32Type>>())
        }
        LongColumn::Numbers(numbers) => {
            let numbers = numbers.iter().map(|n| (!n.is_nan()).then_some(*n));
            Arc::new(numbers.collect::<Float64Array>())
        }
    }
}

fn properties(columns: &[(&str, bool)]) -> WriterProperties {
    let mut properties = WriterProperties::builder()
        .set_created_by(concat!("idc-cell ", env!("CARGO_PKG_VERSION")).to_owned())
        .set_compression(Compression::SNAPPY)
        // As in samples.parquet: neighbours share their high bytes.
        .set_dictionary_enabled(false)
        .set_encoding(Encoding::BYTE_STREAM_SPLIT);
    for (name, names) in columns {
        if *names {
            // A dot in a name is no level of it.
            let name = ColumnPath::new(vec![(*name).to_owned()]);
            properties = properties
                .set_column_dictionary_enabled(name.clone(), true)
                .set_column_encoding(name, Encoding::PLAIN);
        }
    }
    properties.build()
}

/// Reads a table that [`write_long`] or [`write_groups`] wrote: its columns by name, in order.
///
/// # Errors
/// [`RecordingError::Read`] if the file is absent, cut short or no such table.
pub fn read_long(path: &Path) -> Result<Vec<(String, LongColumn)>, RecordingError> {
    read_columns(path, |_| true)
}

/// As [`read_long`], of those columns alone whose names are wanted.
///
/// # Errors
/// As [`read_long`].
pub fn read_columns(
    path: &Path,
    wanted: impl Fn(&str) -> bool,
) -> Result<Vec<(String, LongColumn)>, RecordingError> {
    let fail = |cause: &dyn std::fmt::Display| RecordingError::read(path, cause);
    let file = ParquetFile::open(path)?;
    let schema = file.builder.schema().clone();
    let fields = schema.fields().iter().enumerate();
    let fields: Vec<_> = fields.filter(|(_, field)| wanted(field.name())).collect();
    // A table without rows has its columns too.
    let empty = |(_, field): &(usize, &FieldRef)| {
        let values = long_column(&new_empty_array(field.data_type())).map_err(|e| fail(&e))?;
        Ok((field.name().clone(), values))
    };
    let mut columns: Vec<(String, LongColumn)> = fields
        .iter()
        .map(empty)
        .collect::<Result<_, RecordingError>>()?;
    let places: Vec<usize> = fields.iter().map(|(place, _)| *place).collect();
    let most = |size: u64| Limit::default().passed(size);
    file.decode(path, &places, None, most, |batch| {
        for ((_, all), column) in columns.iter_mut().zip(batch.columns()) {
            match (all, long_column(column).map_err(|e| fail(&e))?) {
                (LongColumn::Names(all), LongColumn::Names(more)) => all.extend(more),
                (LongColumn::Numbers(all), LongColumn::Numbers(more)) => all.extend(more),
                _ => return Err(fail(&"a column holds both names and numbers")),
            }
        }
        Ok(())
    })?;
    Ok(columns)
}

fn long_column(array: &ArrayRef) -> Result<LongColumn, arrow::error::ArrowError> {
    if array.data_type().is_numeric() {
        let numbers = cast(array, &DataType::Float64)?;
        let numbers = numbers.as_primitive::<Float64Type>().iter();
        Ok(LongColumn::Numbers(
            numbers.map(|n| n.unwrap_or(f64::NAN)).collect(),
        ))
    } else {
        let names = cast(array, &DataType::Utf8)?;
        let names = names.as_string::<i32>().iter();
        Ok(LongColumn::Names(
            names.map(|n| n.unwrap_or_default().to_owned()).collect(),
        ))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_table_reads_back_and_equal_ones_have_equal_bytes() {
        let folder = tempfile::tempdir().unwrap();
        let columns = vec![
            (
                "recording".to_owned(),
                LongColumn::Names(["a", "a", "b"].map(str::to_owned).to_vec()),
            ),
            (
                "force_n".to_owned(),
                LongColumn::Numbers(vec![0.1, f64::NAN, -3e200]),
            ),
        ];
        let paths = ["one", "other"].map(|name| folder.path().join(name));
        for path in &paths {
            write_long(path, &columns).unwrap();
        }
        assert!(std::fs::read(&paths[0]).unwrap() == std::fs::read(&paths[1]).unwrap());
        let read = read_long(&paths[0]).unwrap();
        assert_eq!(read[0], columns[0]);
        let LongColumn::Numbers(numbers) = &read[1].1 else {
            panic!("{read:?}");
        };
        assert!(numbers[0] == 0.1 && numbers[1].is_nan() && numbers[2] == -3e200);
        let bytes = std::fs::read(&paths[0]).unwrap();
        std::fs::write(&paths[0], &bytes[..bytes.len() / 2]).unwrap();
        let message = read_long(&paths[0]).unwrap_err().to_string();
        assert!(message.contains("one"), "{message}");
    }

    // Catches: the comparison of a table of runs has no rows, and its report could not be made anew.
    #[test]
    fn a_table_without_rows_reads_back_with_its_columns() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("empty.parquet");
        let columns = vec![
            ("recording".to_owned(), LongColumn::Names(Vec::new())),
            ("force_n".to_owned(), LongColumn::Numbers(Vec::new())),
        ];
        write_long(&path, &columns).unwrap();
        assert_eq!(read_long(&path).unwrap(), columns);
    }

    #[test]
    fn a_table_written_in_groups_reads_back_by_column() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("runs.parquet");
        let mut groups = (0..3).map(|group| {
            let rows = (0..4).map(|row| group * 4 + row);
            vec![
                LongColumn::Names(rows.clone().map(|row| format!("run {row}")).collect()),
                LongColumn::Numbers(rows.map(f64::from).collect()),
            ]
        });
        let columns = [("a.name", true), ("a.number", false)];
        write_groups(&path, &columns, || Ok::<_, RecordingError>(groups.next())).unwrap();
        let read = read_columns(&path, |name| name == "a.number").unwrap();
        let expected: Vec<f64> = (0..12).map(f64::from).collect();
        assert_eq!(
            read,
            [("a.number".to_owned(), LongColumn::Numbers(expected))]
        );
        let LongColumn::Names(names) = &read_long(&path).unwrap()[0].1 else {
            panic!("no names");
        };
        assert_eq!((names.len(), names[11].as_str()), (12, "run 11"));
        let broken = write_groups(&path, &columns, || {
            Err(RecordingError::write(&path, "full"))
        });
        assert!(broken.unwrap_err().to_string().contains("full"));
        assert_eq!(read_long(&path).unwrap().len(), 2);
    }
}
