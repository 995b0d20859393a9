//! Columns of any Parquet table, whatever they are called: numbers, and stamps of a clock.

use std::fs::File;
use std::io::{Read, Seek, SeekFrom};
use std::path::{Path, PathBuf};

use ::parquet::arrow::ProjectionMask;
use ::parquet::arrow::arrow_reader::ParquetRecordBatchReaderBuilder;
use arrow::array::{Array, ArrayRef, AsArray, RecordBatch};
use arrow::compute::{cast, concat_batches};
use arrow::datatypes::{DataType, Float64Type, Int64Type, TimeUnit};

use super::RecordingError;

/// First and last bytes of a Parquet file.
const MAGIC: [u8; 4] = *b"PAR1";

/// A Parquet table, its columns not read yet.
#[derive(Debug)]
pub struct Table {
    path: PathBuf,
    builder: ParquetRecordBatchReaderBuilder<File>,
}

/// A column's values, as many as the table has rows.
#[derive(Debug, Clone, PartialEq)]
pub enum Cells {
    /// Numbers; NaN where there is none.
    Numbers(Vec<f64>),
    /// Stamps or durations [ns]; none where there is none.
    Nanoseconds(Vec<Option<i64>>),
}

impl Table {
    /// Opens a file.
    ///
    /// # Errors
    /// [`RecordingError::Read`] if it is absent, cut off or no Parquet.
    pub fn open(path: &Path) -> Result<Self, RecordingError> {
        let fail = |cause: &dyn std::fmt::Display| RecordingError::read(path, cause);
        let mut file = File::open(path).map_err(|e| fail(&e))?;
        let [start, end] = ends(&mut file).map_err(|e| fail(&e))?;
        if start == MAGIC && end != MAGIC {
            return Err(fail(
                &"the Parquet file is cut off: where its columns stand is written at its end, and that is missing; \
                  nothing of it can be read, copy it once more from where it was recorded",
            ));
        }
        let builder = ParquetRecordBatchReaderBuilder::try_new(file).map_err(|e| fail(&e))?;
        Ok(Self {
            path: path.to_owned(),
            builder,
        })
    }

    /// Names of its columns, in order.
    #[must_use]
    pub fn names(&self) -> Vec<String> {
        let fields = self.builder.schema().fields().iter();
        fields.map(|field| field.name().clone()).collect()
    }

    /// Reads columns by their place from 0, in the order asked for.
    ///
    /// # Errors
    /// [`RecordingError::Column`] for one that holds neither numbers nor stamps; [`RecordingError::Read`] for a damaged file.
    pub fn read(self, places: &[usize]) -> Result<Vec<Cells>, RecordingError> {
        let Self { path, builder } = self;
        let fail = |cause: &dyn std::fmt::Display| RecordingError::read(&path, cause);
        let mask = ProjectionMask::roots(builder.parquet_schema(), places.iter().copied());
        let batches: Vec<RecordBatch> = builder
            .with_projection(mask)
            .build()
            .map_err(|e| fail(&e))?
            .collect::<Result<_, _>>()
            .map_err(|e| fail(&e))?;
        let Some(first) = batches.first() else {
            return Ok(vec![Cells::Numbers(Vec::new()); places.len()]);
        };
        let table = concat_batches(&first.schema(), &batches).map_err(|e| fail(&e))?;
        // Only the columns asked for are left, in the file's order.
        let mut kept = places.to_vec();
        kept.sort_unstable();
        kept.dedup();
        let place = |wanted: &usize| {
            let index = kept.partition_point(|own| own < wanted);
            let schema = table.schema();
            cells(table.column(index)).ok_or_else(|| RecordingError::Column {
                path: path.clone(),
                column: schema.field(index).name().clone(),
                found: format!("of {}", schema.field(index).data_type()),
                expected: "numbers or stamps".to_owned(),
            })
        };
        places.iter().map(place).collect()
    }
}

/// The first and the last bytes of a file.
fn ends(file: &mut File) -> std::io::Result<[[u8; 4]; 2]> {
    let (mut start, mut end) = ([0; 4], [0; 4]);
    if file.metadata()?.len() >= 8 {
        file.read_exact(&mut start)?;
        file.seek(SeekFrom::End(-4))?;
        file.read_exact(&mut end)?;
        file.rewind()?;
    }
    Ok([start, end])
}

/// Values of a column, if it holds any.
fn cells(column: &ArrayRef) -> Option<Cells> {
    let factor = match column.data_type() {
        DataType::Timestamp(unit, _)
        | DataType::Duration(unit)
        | DataType::Time32(unit)
        | DataType::Time64(unit) => Some(match unit {
            TimeUnit::Second => 1_000_000_000,
            TimeUnit::Millisecond => 1_000_000,
            TimeUnit::Microsecond => 1_000,
            TimeUnit::Nanosecond => 1,
        }),
        DataType::Boolean => None,
        kind if kind.is_numeric() => None,
        _ => return None,
    };
    if let Some(factor) = factor {
        let ticks = cast(column, &DataType::Int64).ok()?;
        let ticks = ticks.as_primitive_opt::<Int64Type>()?;
        let all = ticks.iter().map(|tick| tick?.checked_mul(factor));
        return Some(Cells::Nanoseconds(all.collect()));
    }
    let numbers = cast(column, &DataType::Float64).ok()?;
    let numbers = numbers.as_primitive_opt::<Float64Type>()?;
    Some(Cells::Numbers(
        numbers.iter().map(|v| v.unwrap_or(f64::NAN)).collect(),
    ))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::Arc;

    use ::parquet::arrow::ArrowWriter;
    use arrow::array::{Float32Array, Int16Array, StringArray, TimestampMicrosecondArray};
    use arrow::datatypes::{Field, Schema};

    fn write(path: &Path) {
        let fields = vec![
            Field::new(
                "stamp",
                DataType::Timestamp(TimeUnit::Microsecond, None),
                true,
            ),
            Field::new("note", DataType::Utf8, true),
            Field::new("ticks", DataType::Int16, true),
            Field::new("force", DataType::Float32, true),
        ];
        let columns: Vec<ArrayRef> = vec![
            Arc::new(TimestampMicrosecondArray::from(vec![
                1_700_000_000_000_001,
                1_700_000_000_000_002,
            ])),
            Arc::new(StringArray::from(vec!["a", "b"])),
            Arc::new(Int16Array::from(vec![Some(-7), None])),
            Arc::new(Float32Array::from(vec![1.5, 2.5])),
        ];
        let batch = RecordBatch::try_new(Arc::new(Schema::new(fields)), columns).unwrap();
        let file = File::create(path).unwrap();
        let mut writer = ArrowWriter::try_new(file, batch.schema(), None).unwrap();
        writer.write(&batch).unwrap();
        writer.close().unwrap();
    }

    #[test]
    fn columns_come_in_the_order_asked_for_whatever_their_type() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("log.parquet");
        write(&path);
        let table = Table::open(&path).unwrap();
        assert_eq!(table.names(), ["stamp", "note", "ticks", "force"]);
        let read = table.read(&[3, 0, 2]).unwrap();
        assert_eq!(read[0], Cells::Numbers(vec![1.5, 2.5]));
        let stamps = [1_700_000_000_000_001_000, 1_700_000_000_000_002_000];
        assert_eq!(read[1], Cells::Nanoseconds(stamps.map(Some).to_vec()));
        let Cells::Numbers(ticks) = &read[2] else {
            panic!("{read:?}")
        };
        assert!(ticks[0] == -7.0 && ticks[1].is_nan());
        let error = Table::open(&path).unwrap().read(&[1]).unwrap_err();
        assert!(error.to_string().contains("column `note`"), "{error}");
    }

    #[test]
    fn a_table_that_is_cut_off_says_so() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("log.parquet");
        write(&path);
        let bytes = std::fs::read(&path).unwrap();
        std::fs::write(&path, &bytes[..bytes.len() - 9]).unwrap();
        let error = Table::open(&path).unwrap_err().to_string();
        assert!(error.contains("cut off"), "{error}");
    }
}
