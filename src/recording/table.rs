//! Columns of any Parquet table, whatever they are called: numbers, stamps of a clock, texts. Fields of structures and elements of lists are columns of their
//! own: `wrench.force`, `force[2]`, counted from 0.

use std::path::{Path, PathBuf};

use arrow::array::{Array, ArrayRef, AsArray, RecordBatch, UInt64Array};
use arrow::compute::{cast, take};
use arrow::datatypes::{DataType, Float64Type, Int64Type, TimeUnit};

use super::RecordingError;
use super::parquet_file::ParquetFile;
use crate::file::{Limit, guarded};

/// Elements of a list that are columns, at most, and rows that are looked at for the length of lists.
const MOST_ELEMENTS: usize = 64;
const LOOKED_AT: usize = 1024;
/// Columns of a table, at most: lists in lists multiply.
const MOST_COLUMNS: usize = 4096;

/// A Parquet table, its columns not read yet.
#[derive(Debug)]
pub struct Table {
    path: PathBuf,
    file: ParquetFile,
    limit: Limit,
    columns: Vec<Leaf>,
}

/// A column, or a part of one.
#[derive(Debug, Clone)]
struct Leaf {
    name: String,
    /// The column of the file.
    root: usize,
    /// The way into it.
    steps: Vec<Step>,
}

/// A step into a column.
#[derive(Debug, Clone)]
enum Step {
    Field(String),
    Element(usize),
}

/// A column's values, as many as the table has rows.
#[derive(Debug, Clone, PartialEq)]
pub enum Cells {
    /// Numbers; NaN where there is none.
    Numbers(Vec<f64>),
    /// Stamps or durations [ns]; none where there is none.
    Nanoseconds(Vec<Option<i64>>),
    /// Texts; none where there is none.
    Texts(Vec<Option<String>>),
}

impl Table {
    /// Opens a file.
    ///
    /// # Errors
    /// [`RecordingError::Read`] if it is absent, cut off or no Parquet.
    pub fn open(path: &Path, limit: Limit) -> Result<Self, RecordingError> {
        let file = ParquetFile::open(path)?;
        let columns = leaves(path, &file, limit)?;
        Ok(Self {
            path: path.to_owned(),
            file,
            limit,
            columns,
        })
    }

    /// Names of its columns, in order.
    #[must_use]
    pub fn names(&self) -> Vec<String> {
        self.columns.iter().map(|leaf| leaf.name.clone()).collect()
    }

    /// Reads columns by their place from 0, in the order asked for.
    ///
    /// # Errors
    /// [`RecordingError::Column`] for one that holds neither numbers nor stamps nor texts; [`RecordingError::Read`] for a damaged file.
    pub fn read(self, places: &[usize]) -> Result<Vec<Cells>, RecordingError> {
        let Self {
            path,
            file,
            limit,
            columns,
        } = self;
        let wanted: Vec<&Leaf> = places.iter().map(|place| &columns[*place]).collect();
        // Only the columns asked for are left, in the file's order.
        let mut kept: Vec<usize> = wanted.iter().map(|leaf| leaf.root).collect();
        kept.sort_unstable();
        kept.dedup();
        let mut all: Vec<Option<Cells>> = vec![None; wanted.len()];
        let most = |size: u64| limit.unpacked(size);
        file.decode(&path, &kept, None, most, |batch| {
            for (leaf, all) in wanted.iter().zip(&mut all) {
                let index = kept.partition_point(|own| *own < leaf.root);
                let read = || cells(&descended(batch.column(index), &leaf.steps)?);
                let found = guarded(read).map_err(|cause| RecordingError::read(&path, cause))?;
                let more = found.ok_or_else(|| RecordingError::Column {
                    path: path.clone(),
                    column: leaf.name.clone(),
                    found: format!("of {}", batch.schema().field(index).data_type()),
                    expected: "numbers, stamps or texts".to_owned(),
                })?;
                match all {
                    Some(all) => all.extend(more),
                    None => *all = Some(more),
                }
            }
            Ok(())
        })?;
        let none = || Cells::Numbers(Vec::new());
        Ok(all
            .into_iter()
            .map(|all| all.unwrap_or_else(none))
            .collect())
    }
}

impl Cells {
    /// Puts others of the same column behind them.
    fn extend(&mut self, more: Self) {
        match (self, more) {
            (Self::Numbers(all), Self::Numbers(more)) => all.extend(more),
            (Self::Nanoseconds(all), Self::Nanoseconds(more)) => all.extend(more),
            (Self::Texts(all), Self::Texts(more)) => all.extend(more),
            // A column has one type.
            _ => {}
        }
    }
}

/// The columns of a table: those of structures by their fields, those of lists by their elements.
fn leaves(path: &Path, file: &ParquetFile, limit: Limit) -> Result<Vec<Leaf>, RecordingError> {
    let schema = file.builder.schema().clone();
    let nested: Vec<usize> = (0..schema.fields().len())
        .filter(|root| schema.field(*root).data_type().is_nested())
        .collect();
    let first = if nested.is_empty() {
        None
    } else {
        first_rows(path, &nested, limit)?
    };
    let mut found = Vec::new();
    for (root, field) in schema.fields().iter().enumerate() {
        let leaf = Leaf {
            name: field.name().clone(),
            root,
            steps: Vec::new(),
        };
        let place = nested.iter().position(|own| *own == root);
        let column = place.and_then(|place| Some(first.as_ref()?.column(place)));
        grow(leaf, column, &mut found);
    }
    Ok(found)
}

/// The first rows of some columns, to see how long their lists are.
fn first_rows(
    path: &Path,
    roots: &[usize],
    limit: Limit,
) -> Result<Option<RecordBatch>, RecordingError> {
    let mut first = None;
    let most = |size: u64| limit.unpacked(size);
    let file = ParquetFile::open(path)?;
    file.decode(path, roots, Some(LOOKED_AT), most, |batch| {
        first.get_or_insert(batch);
        Ok(())
    })?;
    Ok(first)
}

/// Puts a column, or the parts of one, behind those found.
fn grow(leaf: Leaf, column: Option<&ArrayRef>, found: &mut Vec<Leaf>) {
    if found.len() >= MOST_COLUMNS {
        return;
    }
    let Some(column) = column else {
        found.push(leaf);
        return;
    };
    let inner = |name: String, step: Step| Leaf {
        name,
        root: leaf.root,
        steps: [leaf.steps.clone(), vec![step]].concat(),
    };
    if let Some(structure) = column.as_struct_opt() {
        for (name, own) in structure
            .column_names()
            .into_iter()
            .zip(structure.columns())
        {
            let next = inner(
                format!("{}.{name}", leaf.name),
                Step::Field(name.to_owned()),
            );
            grow(next, Some(own), found);
        }
        return;
    }
    match list_of(column) {
        None => found.push(leaf),
        Some((values, ranges)) => {
            let longest = ranges.iter().flatten().map(ExactSizeIterator::len).max();
            for index in 0..longest.unwrap_or(0).min(MOST_ELEMENTS) {
                let next = inner(format!("{}[{index}]", leaf.name), Step::Element(index));
                grow(next, Some(&values), found);
            }
        }
    }
}

/// Values of all lists of a column, and where those of each row stand among them; none of a column of something else.
fn list_of(column: &ArrayRef) -> Option<(ArrayRef, Vec<Option<std::ops::Range<usize>>>)> {
    let rows = 0..column.len();
    let there = |row: usize| column.is_valid(row);
    if let Some(list) = column.as_fixed_size_list_opt() {
        let size = usize::try_from(list.value_length()).ok()?;
        let range = |row: usize| {
            let start = usize::try_from(list.value_offset(row)).ok()?;
            there(row).then_some(start..start + size)
        };
        return Some((list.values().clone(), rows.map(range).collect()));
    }
    if let Some(list) = column.as_list_opt::<i32>() {
        let ends = list.value_offsets();
        let range = |row: usize| there(row).then_some(ends[row] as usize..ends[row + 1] as usize);
        return Some((list.values().clone(), rows.map(range).collect()));
    }
    let list = column.as_list_opt::<i64>()?;
    let ends = list.value_offsets();
    let range = |row: usize| there(row).then_some(ends[row] as usize..ends[row + 1] as usize);
    Some((list.values().clone(), rows.map(range).collect()))
}

/// The part of a column that steps lead to.
fn descended(column: &ArrayRef, steps: &[Step]) -> Option<ArrayRef> {
    let mut column = column.clone();
    for step in steps {
        column = match step {
            Step::Field(name) => column.as_struct_opt()?.column_by_name(name)?.clone(),
            Step::Element(index) => {
                let (values, ranges) = list_of(&column)?;
                let at = |range: Option<std::ops::Range<usize>>| {
                    let range = range?;
                    (*index < range.len()).then(|| (range.start + index) as u64)
                };
                let places: UInt64Array = ranges.into_iter().map(at).collect();
                take(&values, &places, None).ok()?
            }
        };
    }
    Some(column)
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
        DataType::Date32 => Some(86_400_000_000_000),
        DataType::Date64 => Some(1_000_000),
        DataType::Utf8 | DataType::LargeUtf8 | DataType::Utf8View => return texts(column),
        DataType::Dictionary(_, inner) if inner.is_string() => return texts(column),
        DataType::Boolean => None,
        kind if kind.is_numeric() => None,
        _ => return None,
    };
    if let Some(factor) = factor {
        // Days are kept in 32 bits, and so are some times of the day.
        let whole = match column.data_type() {
            DataType::Date32 | DataType::Time32(_) => cast(column, &DataType::Int32).ok()?,
            _ => column.clone(),
        };
        let ticks = cast(&whole, &DataType::Int64).ok()?;
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

/// Texts of a column.
fn texts(column: &ArrayRef) -> Option<Cells> {
    let texts = cast(column, &DataType::Utf8).ok()?;
    let texts = texts.as_string_opt::<i32>()?;
    Some(Cells::Texts(
        texts.iter().map(|text| text.map(str::to_owned)).collect(),
    ))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs::File;
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
        let table = Table::open(&path, Limit::default()).unwrap();
        assert_eq!(table.names(), ["stamp", "note", "ticks", "force"]);
        let read = table.read(&[3, 0, 2]).unwrap();
        assert_eq!(read[0], Cells::Numbers(vec![1.5, 2.5]));
        let stamps = [1_700_000_000_000_001_000, 1_700_000_000_000_002_000];
        assert_eq!(read[1], Cells::Nanoseconds(stamps.map(Some).to_vec()));
        let Cells::Numbers(ticks) = &read[2] else {
            panic!("{read:?}")
        };
        assert!(ticks[0] == -7.0 && ticks[1].is_nan());
        let texts = Table::open(&path, Limit::default())
            .unwrap()
            .read(&[1])
            .unwrap();
        let both = vec![Some("a".to_owned()), Some("b".to_owned())];
        assert_eq!(texts, [Cells::Texts(both)]);
    }

    #[test]
    fn a_table_that_is_cut_off_says_so() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("log.parquet");
        write(&path);
        let bytes = std::fs::read(&path).unwrap();
        std::fs::write(&path, &bytes[..bytes.len() - 9]).unwrap();
        let error = Table::open(&path, Limit::default())
            .unwrap_err()
            .to_string();
        assert!(error.contains("cut off"), "{error}");
    }
}
