//! Recordings as Parquet tables: `samples.parquet`.
//!
//! One row per sample, one column per channel, the unit at the end of the column's name
//! (`contact_force_n`, [`crate::unit`]). `time_s` comes first; `phase` is text. Where a channel has
//! no value the cell is null. The file's key-value metadata hold the layout's version, what each
//! column means, and whatever the caller adds. Equal recordings give equal bytes: nothing in the
//! file depends on the clock or the machine.

use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Arc;

use ::parquet::arrow::{ARROW_SCHEMA_META_KEY, ArrowWriter};
use ::parquet::basic::{Compression, Encoding};
use ::parquet::errors::ParquetError;
use ::parquet::file::metadata::KeyValue;
use ::parquet::file::properties::WriterProperties;
use ::parquet::schema::types::ColumnPath;
use arrow::array::{Array, ArrayRef, AsArray, DictionaryArray, Float64Array, RecordBatch};
use arrow::compute::cast;
use arrow::datatypes::{DataType, Field, Float64Type, Int32Type, Schema};

use super::atomic::write_atomic;
use super::parquet_file::ParquetFile;
use super::{PhaseSpan, RecordedChannel, Recording, RecordingError, Unit, schema};
use crate::file::{Limit, guarded};
use crate::unit::{column_name, parse_column_name};

/// Version of the table's layout, raised when a reader of the old one would misread the new one.
pub const LAYOUT_VERSION: &str = "1";

const LAYOUT_KEY: &str = "idc_layout_version";
const COLUMNS_KEY: &str = "idc_columns";
/// Rows a row group; fixed so that the bytes do not depend on a library's default.
const ROW_GROUP_ROWS: usize = 1 << 20;

/// A recording read from a file, with the metadata that its writer added.
#[derive(Debug, Clone, PartialEq)]
pub struct StoredRecording {
    /// The signals.
    pub recording: Recording,
    /// The writer's own key-value metadata.
    pub metadata: BTreeMap<String, String>,
}

/// Writes a recording as a Parquet table, with the caller's metadata beside our own.
///
/// # Errors
/// [`RecordingError::Write`] if the file cannot be written; nothing is left then.
pub fn write_parquet(
    path: &Path,
    recording: &Recording,
    metadata: &BTreeMap<String, String>,
) -> Result<(), RecordingError> {
    let batch = batch_of(recording).map_err(|e| RecordingError::write(path, e))?;
    let properties = writer_properties(recording, metadata);
    write_atomic(path, |file| -> Result<(), ParquetError> {
        let mut writer = ArrowWriter::try_new(file, batch.schema(), Some(properties))?;
        writer.write(&batch)?;
        writer.close()?;
        Ok(())
    })
}

/// Reads a table that [`write_parquet`] wrote, or another whose columns are named the same way.
///
/// The phases are rebuilt from the `phase` column: a span starts with its first sample and ends
/// with the first sample after it, or with the recording.
///
/// # Errors
/// [`RecordingError::Read`] if the file is absent, cut short or no Parquet;
/// [`RecordingError::Column`] for a column that is no channel; those of [`Recording::new`].
pub fn read_parquet(path: &Path) -> Result<StoredRecording, RecordingError> {
    let fail = |cause: &dyn std::fmt::Display| RecordingError::read(path, cause);
    let file = ParquetFile::open(path)?;
    let pairs = file.builder.metadata().file_metadata().key_value_metadata();
    let mut metadata: BTreeMap<String, String> = pairs
        .into_iter()
        .flatten()
        .filter(|pair| pair.key != ARROW_SCHEMA_META_KEY && pair.key != COLUMNS_KEY)
        .filter_map(|pair| Some((pair.key.clone(), pair.value.clone()?)))
        .collect();
    if let Some(version) = metadata.remove(LAYOUT_KEY)
        && version != LAYOUT_VERSION
    {
        return Err(fail(&format!(
            "its layout has version {version}, expected {LAYOUT_VERSION}"
        )));
    }
    Ok(StoredRecording {
        recording: recording_of(path, file)?,
        metadata,
    })
}

fn writer_properties(
    recording: &Recording,
    metadata: &BTreeMap<String, String>,
) -> WriterProperties {
    let own = [
        (LAYOUT_KEY.to_owned(), LAYOUT_VERSION.to_owned()),
        (COLUMNS_KEY.to_owned(), column_meanings(recording)),
    ];
    let added = metadata.iter().map(|(k, v)| (k.clone(), v.clone()));
    let pairs = own.into_iter().chain(added);
    WriterProperties::builder()
        .set_created_by(concat!("idc-cell ", env!("CARGO_PKG_VERSION")).to_owned())
        .set_compression(Compression::SNAPPY)
        // Neighbouring samples share their high bytes: split into byte streams they compress.
        .set_dictionary_enabled(false)
        .set_encoding(Encoding::BYTE_STREAM_SPLIT)
        .set_column_dictionary_enabled(ColumnPath::from(schema::PHASE), true)
        .set_column_encoding(ColumnPath::from(schema::PHASE), Encoding::PLAIN)
        .set_max_row_group_row_count(Some(ROW_GROUP_ROWS))
        .set_key_value_metadata(Some(
            pairs
                .map(|(key, value)| KeyValue::new(key, value))
                .collect(),
        ))
        .build()
}

/// JSON object from column name to unit and meaning.
fn column_meanings(recording: &Recording) -> String {
    let entry = |quantity: &str, symbol: &str| {
        let meaning = schema::meaning(quantity);
        serde_json::json!({ "unit": symbol, "meaning": meaning })
    };
    let mut columns = serde_json::Map::new();
    let time = column_name(schema::TIME, Unit::Second);
    columns.insert(time, entry(schema::TIME, Unit::Second.symbol()));
    columns.insert(schema::PHASE.to_owned(), entry(schema::PHASE, "text"));
    for channel in recording.channels() {
        let name = column_name(&channel.quantity, channel.unit);
        columns.insert(name, entry(&channel.quantity, channel.unit.symbol()));
    }
    serde_json::Value::Object(columns).to_string()
}

pub(super) fn batch_of(recording: &Recording) -> Result<RecordBatch, arrow::error::ArrowError> {
    let time_name = column_name(schema::TIME, Unit::Second);
    let phases = phase_column(recording);
    let mut fields = vec![
        Field::new(time_name, DataType::Float64, false),
        Field::new(schema::PHASE, phases.data_type().clone(), true),
    ];
    let mut columns: Vec<ArrayRef> = vec![
        Arc::new(Float64Array::from(recording.time().to_vec())),
        Arc::new(phases),
    ];
    for channel in recording.channels() {
        let name = column_name(&channel.quantity, channel.unit);
        fields.push(Field::new(name, DataType::Float64, true));
        let values = channel.values.iter().map(|v| (!v.is_nan()).then_some(*v));
        columns.push(Arc::new(values.collect::<Float64Array>()));
    }
    RecordBatch::try_new(Arc::new(Schema::new(fields)), columns)
}

fn phase_column(recording: &Recording) -> DictionaryArray<Int32Type> {
    let mut names: Vec<Option<&str>> = vec![None; recording.sample_count()];
    for span in recording.phases() {
        names[recording.samples_in(span)].fill(Some(span.name.as_str()));
    }
    names.into_iter().collect()
}

/// What a column of a file is.
enum Column {
    Phase(Vec<Option<String>>),
    Time(Vec<f64>),
    Channel(RecordedChannel),
}

impl Column {
    /// By its name and its type.
    fn of(path: &Path, field: &Field) -> Result<Self, RecordingError> {
        let fault = |expected: &str| RecordingError::Column {
            path: path.to_path_buf(),
            column: field.name().clone(),
            found: field.data_type().to_string(),
            expected: expected.to_owned(),
        };
        if field.name() == schema::PHASE {
            return Ok(Self::Phase(Vec::new()));
        }
        let Some((quantity, unit)) = parse_column_name(field.name()) else {
            return Err(fault(
                "a channel, its name ending in a unit such as `_n`, `_m` or `_pa`",
            ));
        };
        if !field.data_type().is_numeric() {
            return Err(fault("numbers"));
        }
        Ok(match quantity == schema::TIME && unit == Unit::Second {
            true => Self::Time(Vec::new()),
            false => Self::Channel(RecordedChannel::new(quantity, unit, Vec::new())),
        })
    }

    /// Puts more rows behind those that it has; not where they are of another type.
    fn extend(&mut self, more: &ArrayRef) -> Option<()> {
        let values = match self {
            Self::Phase(names) => {
                let text = cast(more, &DataType::Utf8).ok()?;
                let text = text.as_string::<i32>();
                names.extend(text.iter().map(|name| name.map(str::to_owned)));
                return Some(());
            }
            Self::Time(values) => values,
            Self::Channel(channel) => &mut channel.values,
        };
        let numbers = cast(more, &DataType::Float64).ok()?;
        let numbers = numbers.as_primitive::<Float64Type>();
        match numbers.null_count() {
            0 => values.extend_from_slice(numbers.values()),
            _ => values.extend(numbers.iter().map(|v| v.unwrap_or(f64::NAN))),
        }
        Some(())
    }
}

fn recording_of(path: &Path, file: ParquetFile) -> Result<Recording, RecordingError> {
    let fields = file.builder.schema().fields().clone();
    let columns = fields.iter().map(|field| Column::of(path, field));
    let mut columns: Vec<Column> = columns.collect::<Result<_, _>>()?;
    let all: Vec<usize> = (0..columns.len()).collect();
    let most = |size: u64| Limit::default().passed(size);
    file.decode(path, &all, None, most, |batch| {
        for ((field, own), more) in fields.iter().zip(&mut columns).zip(batch.columns()) {
            let read = guarded(|| own.extend(more));
            let read = read.map_err(|cause| RecordingError::read(path, cause))?;
            read.ok_or_else(|| RecordingError::Column {
                path: path.to_path_buf(),
                column: field.name().clone(),
                found: field.data_type().to_string(),
                expected: match field.name() == schema::PHASE {
                    true => "text".to_owned(),
                    false => "numbers".to_owned(),
                },
            })?;
        }
        Ok(())
    })?;
    let (mut time, mut phase_names, mut channels) = (None, Vec::new(), Vec::new());
    for column in columns {
        match column {
            Column::Phase(names) => phase_names = names,
            Column::Time(values) => time = Some(values),
            Column::Channel(channel) => channels.push(channel),
        }
    }
    let Some(time) = time else {
        return Err(RecordingError::read(path, "it has no column `time_s`"));
    };
    if !phase_names.is_empty() && phase_names.len() != time.len() {
        return Err(RecordingError::read(path, "its columns differ in length"));
    }
    let phases = phases_of(&time, &phase_names);
    Recording::new(time, channels, phases)
}

/// Spans of equal neighbouring names.
fn phases_of(time: &[f64], names: &[Option<String>]) -> Vec<PhaseSpan> {
    let mut phases = Vec::new();
    let mut first = 0;
    for run in names.chunk_by(|a, b| a == b) {
        let after = first + run.len();
        if let (Some(name), Some(last)) = (&run[0], time.last()) {
            phases.push(PhaseSpan {
                name: name.clone(),
                start: time[first],
                end: time.get(after).copied().unwrap_or(*last),
            });
        }
        first = after;
    }
    phases
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs::{self, File};

    use ::parquet::arrow::arrow_reader::ParquetRecordBatchReaderBuilder;

    fn sample_recording() -> Recording {
        let time: Vec<f64> = (0..5000_i32).map(|i| f64::from(i) * 1e-3).collect();
        let mut force: Vec<f64> = time.iter().map(|t| 100.0 + (40.0 * t).sin()).collect();
        force[..700].fill(f64::NAN);
        let stroke: Vec<f64> = time.iter().map(|t| 0.025 + 1e-4 * t.cos()).collect();
        let span = |name: &str, start: usize, end: usize| PhaseSpan {
            name: name.to_owned(),
            start: time[start],
            end: time[end],
        };
        let phases = vec![
            span("approach", 0, 700),
            span("engage", 700, 1200),
            span("retract", 1300, 4999),
        ];
        let channels = vec![
            RecordedChannel::new(schema::CONTACT_FORCE, Unit::Newton, force),
            RecordedChannel::new(schema::STROKE, Unit::Metre, stroke),
            RecordedChannel::new(
                "joint_1_torque",
                Unit::NewtonMetre,
                vec![f64::MIN_POSITIVE; 5000],
            ),
        ];
        Recording::new(time.clone(), channels, phases).unwrap()
    }

    fn note() -> BTreeMap<String, String> {
        BTreeMap::from([("scenario".to_owned(), "plate_edge".to_owned())])
    }

    #[test]
    fn a_recording_reads_back_to_the_bit() {
        let directory = tempfile::tempdir().unwrap();
        let path = directory.path().join("samples.parquet");
        let recording = sample_recording();
        write_parquet(&path, &recording, &note()).unwrap();
        let stored = read_parquet(&path).unwrap();
        assert_eq!(stored.metadata, note());
        assert_eq!(stored.recording.time(), recording.time());
        assert_eq!(stored.recording.phases(), recording.phases());
        assert_eq!(stored.recording.channels().len(), 3);
        for (read, written) in stored.recording.channels().iter().zip(recording.channels()) {
            assert_eq!(
                (&read.quantity, read.unit),
                (&written.quantity, written.unit)
            );
            for (a, b) in read.values.iter().zip(&written.values) {
                assert!(a.to_bits() == b.to_bits() || (a.is_nan() && b.is_nan()));
            }
        }
    }

    #[test]
    fn equal_recordings_give_equal_bytes() {
        let directory = tempfile::tempdir().unwrap();
        let paths = [directory.path().join("a"), directory.path().join("b")];
        for path in &paths {
            write_parquet(path, &sample_recording(), &note()).unwrap();
        }
        assert!(fs::read(&paths[0]).unwrap() == fs::read(&paths[1]).unwrap());
    }

    #[test]
    fn columns_carry_units_and_null_means_no_value() {
        let directory = tempfile::tempdir().unwrap();
        let path = directory.path().join("samples.parquet");
        write_parquet(&path, &sample_recording(), &note()).unwrap();
        let builder = ParquetRecordBatchReaderBuilder::try_new(File::open(&path).unwrap()).unwrap();
        let names: Vec<&str> = builder
            .schema()
            .fields()
            .iter()
            .map(|f| f.name().as_str())
            .collect();
        assert_eq!(
            names,
            [
                "time_s",
                "phase",
                "contact_force_n",
                "stroke_m",
                "joint_1_torque_n_m"
            ]
        );
        assert_eq!(builder.metadata().num_row_groups(), 1);
        let batches: Vec<RecordBatch> = builder.build().unwrap().map(Result::unwrap).collect();
        let nulls: usize = batches.iter().map(|b| b.column(2).null_count()).sum();
        assert_eq!(nulls, 700);
    }

    #[test]
    fn damaged_and_foreign_files_are_refused_with_their_name() {
        let directory = tempfile::tempdir().unwrap();
        let path = directory.path().join("samples.parquet");
        let refusal = || read_parquet(&path).unwrap_err().to_string();
        assert!(refusal().contains("samples.parquet") && refusal().contains("No such file"));
        write_parquet(&path, &sample_recording(), &note()).unwrap();
        let bytes = fs::read(&path).unwrap();
        for length in [0, 3, 100, bytes.len() / 2, bytes.len() - 1] {
            fs::write(&path, &bytes[..length]).unwrap();
            let message = refusal();
            assert!(message.starts_with("cannot read "), "{message}");
            assert!(message.contains("samples.parquet"), "{message}");
        }
    }

    fn write_table(path: &Path, name: &str, column: ArrayRef) {
        let batch = RecordBatch::try_from_iter([(name, column)]).unwrap();
        let file = File::create(path).unwrap();
        let mut writer = ArrowWriter::try_new(file, batch.schema(), None).unwrap();
        writer.write(&batch).unwrap();
        writer.close().unwrap();
    }

    #[test]
    fn a_column_that_is_no_channel_is_refused_by_name() {
        let directory = tempfile::tempdir().unwrap();
        let path = directory.path().join("other.parquet");
        let numbers: ArrayRef = Arc::new(Float64Array::from(vec![1.0]));
        let text: ArrayRef = Arc::new(arrow::array::StringArray::from(vec!["x"]));
        for (name, column, expected) in [
            ("force", &numbers, "column `force`"),
            ("force_n", &text, "expected numbers"),
            ("force_n", &numbers, "no column `time_s`"),
        ] {
            write_table(&path, name, column.clone());
            let message = read_parquet(&path).unwrap_err().to_string();
            assert!(message.contains(expected), "{message}");
        }
    }
}
