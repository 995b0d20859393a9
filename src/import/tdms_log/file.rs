//! The segments of a TDMS file (National Instruments, TDMS File Format Internal Structure), put together channel by channel.
//!
//! ```text
//! segment   "TDSm", contents [u32], version [u32], length [u64], length of the metadata [u64], metadata, chunks of raw data
//! metadata  number of objects, then each: path, index of its raw data, properties
//! ```
//!
//! An object keeps the index and the place that it had in the segment before unless the metadata say otherwise.

use std::collections::BTreeMap;

use super::bytes::{Bytes, EndOfData};
use super::scaling::{Property, Scales};
use crate::recording::table::Cells;

const LEAD_IN: usize = 28;
/// Bits of a segment's contents.
const METADATA: u32 = 1 << 1;
const NEW_OBJECTS: u32 = 1 << 2;
const RAW_DATA: u32 = 1 << 3;
const INTERLEAVED: u32 = 1 << 5;
const BIG_ENDIAN: u32 = 1 << 6;
/// Indices of raw data that are none, that of the segment before, and those of DAQmx.
const NO_DATA: u32 = u32::MAX;
const AS_BEFORE: u32 = 0;
const DAQMX: [u32; 3] = [0x1269, 0x126a, 0x1369];
/// Type of texts.
const TEXT: u32 = 0x20;

/// Times of a channel as its properties say.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in crate::import) struct Waveform {
    /// Since 1970 [ns], if it says so.
    pub start: Option<i64>,
    /// Of its first sample after that [s].
    pub offset: f64,
    /// Between two samples [s].
    pub increment: f64,
}

/// A channel, its segments put together.
#[derive(Debug, Clone, PartialEq)]
pub(in crate::import) struct Channel {
    pub group: String,
    pub name: String,
    /// Unit that its property `unit_string` says.
    pub unit: Option<String>,
    pub cells: Cells,
    pub waveform: Option<Waveform>,
    /// Kind of its data, where they cannot be read.
    pub problem: Option<String>,
}

/// Content of a file.
#[derive(Debug, Default)]
pub(in crate::import) struct Contents {
    pub channels: Vec<Channel>,
    /// How it breaks off, if it does.
    pub torn: Option<String>,
}

/// Raw data of an object in a chunk.
#[derive(Debug, Clone, Copy, PartialEq)]
struct RawIndex {
    kind: u32,
    values: u64,
    /// Bytes of all of them.
    size: u64,
}

/// An object while the file is read.
#[derive(Debug, Default)]
struct Object {
    path: String,
    properties: BTreeMap<String, Property>,
    index: Option<RawIndex>,
    numbers: Vec<f64>,
    stamps: Vec<Option<i64>>,
    problem: Option<String>,
    /// Whether it is among those of the segment.
    is_active: bool,
}

/// The objects seen so far, and which of them a segment's chunks hold.
#[derive(Default)]
struct Reader {
    objects: Vec<Object>,
    places: BTreeMap<String, usize>,
    /// Objects of the segment, in the order of their data.
    active: Vec<usize>,
    /// Those with data in each chunk and the bytes of a chunk, while the metadata stay as they are.
    layout: Option<(Vec<(usize, RawIndex)>, usize)>,
}

/// Reads a file.
///
/// # Errors
/// It is no TDMS, or of a kind that cannot be read.
pub(super) fn parse(bytes: &[u8]) -> Result<Contents, String> {
    let mut reader = Reader::default();
    let mut at = 0;
    let mut torn = None;
    while at < bytes.len() && torn.is_none() {
        let segment = &bytes[at..];
        let before = format!("the segment that begins at byte {at}");
        let Some(lead) = segment.get(..LEAD_IN) else {
            torn = Some(format!("it ends within {before}"));
            break;
        };
        if !lead.starts_with(b"TDSm") {
            return Err(format!("{before} does not begin as one of TDMS does"));
        }
        let contents = u32::from_le_bytes([lead[4], lead[5], lead[6], lead[7]]);
        let is_big = contents & BIG_ENDIAN != 0;
        let mut numbers = Bytes::new(&lead[12..], is_big);
        // The slice is as long as these two.
        let (next, raw) = (numbers.u64().unwrap_or(0), numbers.u64().unwrap_or(0));
        let body = &segment[LEAD_IN..];
        let length = usize::try_from(next)
            .ok()
            .filter(|length| *length <= body.len());
        if length.is_none() {
            torn = Some(format!("{before} was not written to its end"));
        }
        let body = &body[..length.unwrap_or(body.len())];
        let raw = usize::try_from(raw).unwrap_or(usize::MAX).min(body.len());
        if contents & METADATA != 0
            && reader
                .metadata(&mut Bytes::new(&body[..raw], is_big), contents)?
                .is_err()
        {
            torn = Some(format!("it ends within the metadata of {before}"));
            break;
        }
        if contents & RAW_DATA != 0 {
            let is_interleaved = contents & INTERLEAVED != 0;
            reader.chunks(&body[raw..], is_big, is_interleaved);
        }
        at += LEAD_IN + body.len();
    }
    Ok(Contents {
        channels: reader.channels(),
        torn,
    })
}

impl Reader {
    /// Reads a segment's metadata; the inner error is their end where more was expected.
    fn metadata(
        &mut self,
        from: &mut Bytes<'_>,
        contents: u32,
    ) -> Result<Result<(), EndOfData>, String> {
        self.layout = None;
        if contents & NEW_OBJECTS != 0 {
            for place in self.active.drain(..) {
                self.objects[place].is_active = false;
            }
        }
        let mut refused = None;
        let mut read = || -> Result<(), EndOfData> {
            for _ in 0..from.u32()? {
                let path = from.text()?;
                let place = self.place(path);
                let object = &mut self.objects[place];
                match index(from, object)? {
                    Ok(has_data) => {
                        if has_data && !object.is_active {
                            self.active.push(place);
                        } else if !has_data && object.is_active {
                            self.active.retain(|other| *other != place);
                        }
                        object.is_active = has_data;
                    }
                    Err(cause) => {
                        refused = Some(cause);
                        return Ok(());
                    }
                }
                for _ in 0..from.u32()? {
                    let key = from.text()?;
                    match property(from)? {
                        Some(value) => object.properties.insert(key, value),
                        None => {
                            refused = Some(format!(
                                "the property `{key}` of its object {} is of a type that TDMS does not have",
                                object.path
                            ));
                            return Ok(());
                        }
                    };
                }
            }
            Ok(())
        };
        let outcome = read();
        refused.map_or(Ok(outcome), Err)
    }

    /// Where an object stands, a new one at the end.
    fn place(&mut self, path: String) -> usize {
        let next = self.objects.len();
        let place = *self.places.entry(path.clone()).or_insert(next);
        if place == next {
            self.objects.push(Object {
                path,
                ..Object::default()
            });
        }
        place
    }

    /// Reads the chunks of a segment; what is left of one that is not whole is left out.
    fn chunks(&mut self, mut raw: &[u8], is_big: bool, is_interleaved: bool) {
        let (indices, size) = self.layout.take().unwrap_or_else(|| self.laid_out());
        if size == 0 {
            self.layout = Some((indices, size));
            return;
        }
        while raw.len() >= size {
            let (chunk, rest) = raw.split_at(size);
            raw = rest;
            let mut bytes = Bytes::new(chunk, is_big);
            if is_interleaved {
                // Texts cannot stand so, and their number says nothing of their bytes.
                let of_numbers = indices.iter().filter(|(_, index)| index.kind != TEXT);
                let rows = of_numbers.map(|(_, index)| index.values).max();
                let rows = rows.unwrap_or(0);
                for _ in 0..rows {
                    for (place, index) in &indices {
                        self.objects[*place].take(&mut bytes, index.kind);
                    }
                }
                continue;
            }
            for (place, index) in &indices {
                let object = &mut self.objects[*place];
                if object.problem.is_some() {
                    let _ = bytes.take(index.size as usize);
                    continue;
                }
                for _ in 0..index.values {
                    object.take(&mut bytes, index.kind);
                }
            }
        }
        self.layout = Some((indices, size));
    }

    /// Objects with data in each chunk of the segment, and the bytes of a chunk; 0 where it cannot be one.
    fn laid_out(&self) -> (Vec<(usize, RawIndex)>, usize) {
        let indices: Vec<(usize, RawIndex)> = (self.active.iter())
            .filter_map(|place| Some((*place, self.objects[*place].index?)))
            .filter(|(_, index)| index.size > 0)
            .collect();
        let size = indices
            .iter()
            .try_fold(0u64, |sum, (_, index)| sum.checked_add(index.size));
        let size = size.and_then(|size| usize::try_from(size).ok());
        (indices, size.unwrap_or(0))
    }

    /// The channels that hold data.
    fn channels(self) -> Vec<Channel> {
        let all = self.objects.into_iter();
        all.filter_map(Object::into_channel).collect()
    }
}

/// Reads the index of an object's raw data; whether it has any in the segment, or why it cannot be read.
fn index(from: &mut Bytes<'_>, object: &mut Object) -> Result<Result<bool, String>, EndOfData> {
    match from.u32()? {
        NO_DATA => return Ok(Ok(false)),
        AS_BEFORE => return Ok(Ok(object.index.is_some())),
        length if DAQMX.contains(&length) => {
            return Ok(Err(
                "its data are raw ones of DAQmx, which are not read; export it as TDMS with scaled values or CSV (DIAdem, or the Python package `nptdms`)"
                    .to_owned(),
            ));
        }
        _ => {}
    }
    let (kind, _dimension, values) = (from.u32()?, from.u32()?, from.u64()?);
    let size = if kind == TEXT {
        from.u64()?
    } else {
        match size_of_kind(kind).and_then(|size| values.checked_mul(size)) {
            Some(size) => size,
            None => {
                return Ok(Err(format!(
                    "its object {} holds data of the type 0x{kind:x}, which TDMS does not have or is not read",
                    object.path
                )));
            }
        }
    };
    object.problem = match kind {
        TEXT => Some("texts".to_owned()),
        0x08_000c | 0x10_000d => Some("complex numbers".to_owned()),
        _ => None,
    };
    object.index = Some(RawIndex { kind, values, size });
    Ok(Ok(true))
}

/// Bytes of a value of a type.
fn size_of_kind(kind: u32) -> Option<u64> {
    Some(match kind {
        1 | 5 | 0x21 => 1,
        2 | 6 => 2,
        3 | 7 | 9 | 0x19 => 4,
        4 | 8 | 0x0a | 0x1a | 0x08_000c => 8,
        0x44 | 0x10_000d => 16,
        _ => return None,
    })
}

/// A number of a type; none of one that is no number.
fn number(from: &mut Bytes<'_>, kind: u32) -> Result<Option<f64>, EndOfData> {
    Ok(Some(match kind {
        1 => f64::from(from.i8()?),
        2 => f64::from(from.i16()?),
        3 => f64::from(from.i32()?),
        4 => from.i64()? as f64,
        5 => f64::from(from.u8()?),
        6 => f64::from(from.u16()?),
        7 => f64::from(from.u32()?),
        8 => from.u64()? as f64,
        9 | 0x19 => f64::from(from.f32()?),
        0x0a | 0x1a => from.f64()?,
        0x21 => f64::from(u8::from(from.u8()? != 0)),
        _ => return Ok(None),
    }))
}

/// Reads a property; none of a type that TDMS does not have.
fn property(from: &mut Bytes<'_>) -> Result<Option<Property>, EndOfData> {
    let kind = from.u32()?;
    Ok(match kind {
        TEXT => Some(Property::Text(from.text()?)),
        0x44 => Some(Property::Stamp(from.stamp()?)),
        0x08_000c | 0x10_000d => {
            from.take(if kind == 0x08_000c { 8 } else { 16 })?;
            Some(Property::Text(String::new()))
        }
        kind => number(from, kind)?.map(Property::Number),
    })
}

impl Object {
    /// Takes its next value; the chunk was measured before.
    fn take(&mut self, bytes: &mut Bytes<'_>, kind: u32) {
        if kind == 0x44 {
            self.stamps.extend(bytes.stamp());
        } else if let Ok(Some(number)) = number(bytes, kind) {
            self.numbers.push(number);
        }
    }

    /// The channel that it is; none of a file or a group, or of a channel without data.
    fn into_channel(mut self) -> Option<Channel> {
        let [group, name] = split(&self.path)?;
        self.index?;
        let number = |key: &str| match self.properties.get(key) {
            Some(Property::Number(number)) => Some(*number),
            _ => None,
        };
        let waveform = number("wf_increment")
            .filter(|increment| *increment > 0.0 && increment.is_finite())
            .map(|increment| Waveform {
                start: match self.properties.get("wf_start_time") {
                    Some(Property::Stamp(start)) => *start,
                    _ => None,
                },
                offset: number("wf_start_offset").unwrap_or(0.0),
                increment,
            });
        let unit = match self.properties.get("unit_string") {
            Some(Property::Text(unit)) if !unit.trim().is_empty() => Some(unit.clone()),
            _ => None,
        };
        match Scales::of(&self.properties) {
            Ok(None) => {}
            Ok(Some(scales)) => {
                let own = self.numbers.iter_mut();
                own.for_each(|number| *number = scales.apply(*number));
            }
            Err(found) => self.problem = Some(found),
        }
        Some(Channel {
            group,
            name,
            unit,
            cells: if self.stamps.is_empty() {
                Cells::Numbers(self.numbers)
            } else {
                Cells::Nanoseconds(self.stamps)
            },
            waveform,
            problem: self.problem,
        })
    }
}

/// Group and channel of a path: `/'Group'/'Channel'`, a quote in a name doubled.
fn split(path: &str) -> Option<[String; 2]> {
    let inner = path.strip_prefix("/'")?.strip_suffix('\'')?;
    let (group, name) = inner.split_once("'/'")?;
    Some([group, name].map(|part| part.replace("''", "'")))
}
