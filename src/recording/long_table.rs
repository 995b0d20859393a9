//! Long tables as Parquet: columns of names and of numbers, one row an observation, as a data frame takes them.
//!
//! Numbers are `f64`, null where there is none; names are text. Equal tables give equal bytes.

use std::fs::File;
use std::path::Path;
use std::sync::Arc;

use ::parquet::arrow::ArrowWriter;
use ::parquet::arrow::arrow_reader::ParquetRecordBatchReaderBuilder;
use ::parquet::basic::{Compression, Encoding};
use ::parquet::errors::ParquetError;
use ::parquet::file::properties::WriterProperties;
use ::parquet::schema::types::ColumnPath;
use arrow::array::{ArrayRef, AsArray, DictionaryArray, Float64Array, RecordBatch};
use arrow::compute::cast;
use arrow::datatypes::{DataType, Float64Type, Int32Type};

use super::RecordingError;
use super::atomic::write_atomic;
use super::parquet::whole;

/// A column.
#[derive(Debug, Clone, PartialEq)]
pub enum LongColumn {
    /// Names.
    Names(Vec<String>),
    /// Numbers; NaN where there is none.
    Numbers(Vec<f64>),
}

/// Writes columns by name, all of one length.
///
/// # Errors
/// [`RecordingError::Write`] if the file cannot be written; nothing is left then.
pub fn write_long(path: &Path, columns: &[(String, LongColumn)]) -> Result<(), RecordingError> {
    let fields = columns.iter().map(|(name, column)| {
        let array: ArrayRef = match column {
            LongColumn::Names(names) => {
                let names = names.iter().map(|name| Some(name.as_str()));
                Arc::new(names.collect::<DictionaryArray<Int32Type>>())
            }
            LongColumn::Numbers(numbers) => {
                let numbers = numbers.iter().map(|n| (!n.is_nan()).then_some(*n));
                Arc::new(numbers.collect::<Float64Array>())
            }
        };
        (name.as_str(), array, true)
    });
    let batch = RecordBatch::try_from_iter_with_nullable(fields)
        .map_err(|e| RecordingError::write(path, e))?;
    let mut properties = WriterProperties::builder()
        .set_created_by(concat!("idc-cell ", env!("CARGO_PKG_VERSION")).to_owned())
        .set_compression(Compression::SNAPPY)
        // As in samples.parquet: neighbours share their high bytes.
        .set_dictionary_enabled(false)
        .set_encoding(Encoding::BYTE_STREAM_SPLIT);
    for (name, column) in columns {
        if matches!(column, LongColumn::Names(_)) {
            let name = ColumnPath::from(name.as_str());
            properties = properties
                .set_column_dictionary_enabled(name.clone(), true)
                .set_column_encoding(name, Encoding::PLAIN);
        }
    }
    let properties = properties.build();
    write_atomic(path, |file| -> Result<(), ParquetError> {
        let mut writer = ArrowWriter::try_new(file, batch.schema(), Some(properties))?;
        writer.write(&batch)?;
        writer.close()?;
        Ok(())
    })
}

/// Reads a table that [`write_long`] wrote: its columns by name, in order.
///
/// # Errors
/// [`RecordingError::Read`] if the file is absent, cut short or no such table.
pub fn read_long(path: &Path) -> Result<Vec<(String, LongColumn)>, RecordingError> {
    let fail = |cause: &dyn std::fmt::Display| RecordingError::read(path, cause);
    let file = File::open(path).map_err(|e| fail(&e))?;
    let builder = ParquetRecordBatchReaderBuilder::try_new(file).map_err(|e| fail(&e))?;
    let schema = builder.schema().clone();
    let table = whole(path, builder)?;
    let column = |(index, field): (usize, &Arc<arrow::datatypes::Field>)| {
        let array = table.column(index);
        let column = if field.data_type().is_numeric() {
            let numbers = cast(array, &DataType::Float64).map_err(|e| fail(&e))?;
            let numbers = numbers.as_primitive::<Float64Type>().iter();
            LongColumn::Numbers(numbers.map(|n| n.unwrap_or(f64::NAN)).collect())
        } else {
            let names = cast(array, &DataType::Utf8).map_err(|e| fail(&e))?;
            let names = names.as_string::<i32>().iter();
            LongColumn::Names(names.map(|n| n.unwrap_or_default().to_owned()).collect())
        };
        Ok((field.name().clone(), column))
    };
    schema.fields().iter().enumerate().map(column).collect()
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
}
