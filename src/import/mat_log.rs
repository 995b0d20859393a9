//! A log as MATLAB's MAT file of version 5: arrays with names.
//!
//! ```text
//! header of 128 bytes, then elements: kind [4 bytes], length [4 bytes], content; padded to 8 bytes unless it is compressed
//! ```
//!
//! (MathWorks, MAT-File Format). The elements are distinguished here, so that a file that is cut off is known as such and an array that cannot be
//! read does not take the others with it; `matfile` reads each.

use std::io::Read;
use std::path::Path;

use flate2::read::ZlibDecoder;
use matfile::{MatFile, NumericData};

use super::error::ImportError;
use super::map::{Column, FileMap};
use super::rows::{Remark, Rows, Times, places};
use super::signature;
use crate::file::{self, Limit, guarded};

const HEADER: usize = 128;
const TAG: usize = 8;
/// Kind of an element that is a compressed one.
const COMPRESSED: u32 = 15;

/// Where an array's class stands behind the tags of the element and of its flags, and two classes. Numbers of an array of doubles may be stored as
/// int32, which `matfile` reads; those of an array of int32 it takes for uint32 (0.5.0) and refuses.
const CLASS: usize = 16;
const INT32: u32 = 12;
const DOUBLE: u8 = 6;
/// Kind of an element that is an array, and classes of those that hold numbers.
const MATRIX: u32 = 14;
const NUMBERS: std::ops::RangeInclusive<u32> = 6..=15;

/// A column of an array, with its name.
struct NamedColumn {
    name: String,
    values: Vec<f64>,
}

/// Content of a file.
#[derive(Default)]
struct Contents {
    columns: Vec<NamedColumn>,
    /// Arrays that hold no numbers, or none that are read.
    others: usize,
    /// Whether it ends within an element.
    torn: bool,
}

/// Reads the arrays of a file as columns.
pub(super) fn read(path: &Path, map: &FileMap) -> Result<Rows, ImportError> {
    let fail = |cause: String| ImportError::Read {
        file: path.to_owned(),
        cause,
    };
    signature::check(path, "mat5", "a MAT file of version 5 to 7")?;
    let contents = opened(path, map.limit).map_err(fail)?;
    let names: Vec<String> = contents.columns.iter().map(|c| c.name.clone()).collect();
    let mut remarks = Vec::new();
    if contents.torn {
        let found = "it ends within an array".to_owned();
        let rest = match &names[..] {
            [] => "no array before that can be read".to_owned(),
            names => format!("{} can be read", names.join(", ")),
        };
        if !map.accepts_truncated {
            return Err(ImportError::Truncated {
                file: path.to_owned(),
                found,
                rest,
                advice: "`accept_truncated = true` in the map's [[file]] uses them if they are all that it names"
                    .to_owned(),
            });
        }
        remarks.push(Remark::Truncated(format!("it is cut off: {found}; {rest}")));
    }
    let (time_place, channel_places) =
        places(path, map, Some(&names), names.len()).map_err(|error| match error {
            ImportError::NoColumn {
                file,
                column,
                there,
            } if contents.others > 0 => ImportError::NoColumn {
                file,
                column,
                there: format!(
                    "{there}, and {} that are no arrays of real numbers (structures, cells, texts, int64)",
                    contents.others
                ),
            },
            other => other,
        })?;
    let values = |place: usize| contents.columns[place].values.as_slice();
    let first = channel_places.first();
    let counts = || Times::counts(first.map_or(0, |place| values(*place).len()));
    let time = time_place.map_or_else(counts, |place| values(place).to_vec());
    let time_column = map.time.as_ref().map(|time| time.column.clone());
    if let Some(row) = time.iter().position(|time| !time.is_finite()) {
        return Err(ImportError::Number {
            file: path.to_owned(),
            line: row as u64 + 1,
            column: time_column.unwrap_or(Column::Number(1)),
            found: time[row].to_string(),
            expected: "a time".to_owned(),
        });
    }
    let mut columns = Vec::new();
    for (place, channel) in channel_places.iter().zip(&map.channels) {
        let values = values(*place);
        if values.len() != time.len() {
            return Err(ImportError::Length {
                file: path.to_owned(),
                column: channel.column.clone(),
                found: values.len(),
                expected: time.len(),
            });
        }
        columns.push(values.to_vec());
    }
    Ok(Rows {
        channels: (0..map.channels.len()).collect(),
        lines: (1..=time.len() as u64).collect(),
        time: Times::Numbers(time),
        columns,
        remarks,
        ..Rows::default()
    })
}

/// The columns of a file by their names, as far as they can be read.
pub(super) fn columns(path: &Path) -> Result<Vec<(String, Vec<f64>)>, ImportError> {
    let fail = |cause: String| ImportError::Read {
        file: path.to_owned(),
        cause,
    };
    let contents = opened(path, Limit::default()).map_err(fail)?;
    if contents.columns.is_empty() {
        return Err(fail(format!(
            "none of its {} arrays is one of real numbers (structures, cells, texts, int64 are not read); in MATLAB, save(file, '-struct', 'log', '-v7') writes the fields of a structure `log` as arrays",
            contents.others
        )));
    }
    let columns = contents.columns.into_iter();
    Ok(columns.map(|column| (column.name, column.values)).collect())
}

fn opened(path: &Path, limit: Limit) -> Result<Contents, String> {
    let bytes = file::read_up_to(path, limit.whole()).map_err(|cause| cause.to_string())?;
    contents(&bytes, limit)
}

/// Tells a file's elements apart and reads them one by one.
fn contents(bytes: &[u8], limit: Limit) -> Result<Contents, String> {
    let is_hdf = bytes.starts_with(b"\x89HDF") || bytes.get(512..516) == Some(b"\x89HDF");
    if is_hdf || bytes.starts_with(b"MATLAB 7.3") {
        return Err(
            "it is of version 7.3, expected 5 to 7: in MATLAB, save(file, '-v7') writes that"
                .to_owned(),
        );
    }
    let number: fn([u8; 4]) -> u32 = match bytes.get(124..HEADER) {
        Some([0, 1, b'I', b'M']) => u32::from_le_bytes,
        Some([1, 0, b'M', b'I']) => u32::from_be_bytes,
        _ => {
            return Err(
                "it is no MAT file of version 5 to 7: its header is not that of one, and those of version 4 are not read; in MATLAB, save(file, '-v7') writes one"
                    .to_owned(),
            );
        }
    };
    let header = &bytes[..HEADER];
    let most = limit.unpacked(bytes.len() as u64);
    let refusal = || limit.refusal(bytes.len() as u64, most);
    let mut left = most;
    let mut found = Contents::default();
    let mut rest = &bytes[HEADER..];
    while !rest.is_empty() {
        let Some((tag, content)) = rest.split_at_checked(TAG) else {
            found.torn = true;
            break;
        };
        let word = |from: usize| number([tag[from], tag[from + 1], tag[from + 2], tag[from + 3]]);
        let (kind, length) = (word(0), word(4) as usize);
        let Some((own, after)) = content.split_at_checked(length) else {
            found.torn = true;
            break;
        };
        let padding = if kind == COMPRESSED {
            0
        } else {
            length.next_multiple_of(8) - length
        };
        rest = after.get(padding..).unwrap_or_default();
        // The array behind the header, as a file of its own.
        let mut alone = header.to_vec();
        if kind == COMPRESSED {
            let unpacked = ZlibDecoder::new(own).take(left.saturating_add(1));
            let read = { unpacked }.read_to_end(&mut alone);
            read.map_err(|cause| format!("an array in it is damaged: {cause}"))?;
        } else {
            alone.extend_from_slice(tag);
            alone.extend_from_slice(own);
        }
        let Some(array) = Array::of(&alone[HEADER..], number) else {
            left = left
                .checked_sub((alone.len() - HEADER) as u64)
                .ok_or_else(refusal)?;
            found.others += 1;
            continue;
        };
        let held = (alone.len() - HEADER) as u64;
        left = left.checked_sub(held.max(array.held)).ok_or_else(refusal)?;
        // Nothing behind it is read as another.
        alone.truncate(HEADER + array.length);
        if array.class == INT32 {
            let least = if number([1, 0, 0, 0]) == 1 { 0 } else { 3 };
            alone[HEADER + CLASS + least] = DOUBLE;
        }
        note(alone, &mut found);
    }
    Ok(found)
}

/// What an element says of an array of numbers, before it is read.
struct Array {
    class: u32,
    /// Bytes of the element with its tag.
    length: usize,
    /// Bytes that its numbers come to as doubles: few may be stored for each.
    held: u64,
}

impl Array {
    /// None of one that is none, or of no numbers.
    fn of(element: &[u8], number: fn([u8; 4]) -> u32) -> Option<Self> {
        let word = |from: usize| {
            let bytes = element.get(from..from + 4)?;
            Some(number([bytes[0], bytes[1], bytes[2], bytes[3]]))
        };
        let length = TAG.checked_add(word(4)? as usize)?;
        let class = word(CLASS)? & 0xff;
        let is_array = word(0)? == MATRIX && NUMBERS.contains(&class) && length <= element.len();
        // Flags, dimensions and name stand before the numbers.
        let mut at = TAG;
        for _ in 0..3 {
            at = tag_at(word(at)?, word(at + 4)?, at).next;
        }
        let mut held = 0;
        // Real and imaginary ones.
        while at < length && is_array {
            let tag = tag_at(word(at)?, word(at + 4).unwrap_or(0), at);
            held += 8 * (tag.bytes / size_of_kind(tag.kind)) as u64;
            at = tag.next;
        }
        is_array.then_some(Self {
            class,
            length,
            held,
        })
    }
}

/// Kind and length of what a tag stands before, and where the next one is.
struct Tag {
    kind: u32,
    bytes: usize,
    next: usize,
}

/// The tag of two words; few bytes have their length in the first, and stand in place of the second.
fn tag_at(first: u32, second: u32, at: usize) -> Tag {
    match first >> 16 {
        0 => Tag {
            kind: first,
            bytes: second as usize,
            next: at + TAG + (second as usize).next_multiple_of(8),
        },
        few => Tag {
            kind: first & 0xffff,
            bytes: few as usize,
            next: at + TAG,
        },
    }
}

/// Bytes of a number as it is stored.
fn size_of_kind(kind: u32) -> usize {
    match kind {
        3 | 4 => 2,
        5..=7 => 4,
        9 | 12 | 13 => 8,
        _ => 1,
    }
}

/// Notes the columns of the one array in a file.
fn note(file: Vec<u8>, found: &mut Contents) {
    let read = guarded(|| MatFile::parse(file.as_slice()).ok());
    drop(file);
    let read = read.ok().flatten();
    let Some(array) = read.as_ref().and_then(|file| file.arrays().first()) else {
        found.others += 1;
        return;
    };
    let Some(values) = numbers(array.data()) else {
        found.others += 1;
        return;
    };
    let name = array.name();
    match array.size()[..] {
        [rows, columns] if rows > 1 && columns > 1 => {
            for (index, column) in values.chunks(rows).enumerate() {
                found.columns.push(NamedColumn {
                    name: format!("{name}(:,{})", index + 1),
                    values: column.to_vec(),
                });
            }
        }
        [_, _] => found.columns.push(NamedColumn {
            name: name.to_owned(),
            values,
        }),
        _ => found.others += 1,
    }
}

/// Numbers of an array; none where they are complex.
fn numbers(data: &NumericData) -> Option<Vec<f64>> {
    macro_rules! real {
        ($($kind:ident),*) => {
            match data {
                $(NumericData::$kind { real, imag: None } => Some(real.iter().map(|v| f64::from(*v)).collect()),)*
                NumericData::Int64 { real, imag: None } => Some(real.iter().map(|v| *v as f64).collect()),
                NumericData::UInt64 { real, imag: None } => Some(real.iter().map(|v| *v as f64).collect()),
                _ => None,
            }
        };
    }
    real!(Int8, UInt8, Int16, UInt16, Int32, UInt32, Single, Double)
}
