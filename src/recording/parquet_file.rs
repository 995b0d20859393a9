//! Parquet files as they are opened and decoded: what their metadata and pages claim is seen before room is made for it, and a panic of the decoder is a refusal.

use std::fs::File;
use std::io::{Read, Seek, SeekFrom};
use std::path::Path;

use ::parquet::arrow::ProjectionMask;
use ::parquet::arrow::arrow_reader::ParquetRecordBatchReaderBuilder;
use ::parquet::basic::{Compression, Type};
use ::parquet::file::metadata::ColumnChunkMetaData;
use arrow::array::RecordBatch;

use super::RecordingError;
use super::thrift::{Seen, walk};
use crate::file::{self, Limit, guarded, megabytes};

/// First and last bytes of a file.
const MAGIC: [u8; 4] = *b"PAR1";
/// Length of the metadata and magic, at the end.
const TAIL: u64 = 8;
/// Bytes of the metadata, at most, and depth of the columns in one another.
const LONGEST_METADATA: u64 = 1 << 24;
const DEEPEST: usize = 32;
/// Rows that are decoded at once, and bytes that those of a column of texts may come to.
const ROWS: usize = 8192;
const TEXTS: u64 = 1 << 26;
/// How many times its size a page may come to: of gzip (RFC 1951), of LZ4.
const GZIP: u64 = 1032;
const LZ4: u64 = 255;
/// Bytes at a page's head that are looked at, with longer ones where those do not suffice.
const HEADS: [u64; 3] = [1 << 9, 1 << 14, 1 << 20];

/// A file that is open, its columns not read yet.
#[derive(Debug)]
pub(super) struct ParquetFile {
    file: File,
    size: u64,
    pub builder: ParquetRecordBatchReaderBuilder<File>,
}

/// What a chunk's pages come to as their heads say.
#[derive(Debug, Default)]
struct Pages {
    values: u64,
    /// Bytes of its dictionary.
    dictionary: u64,
}

/// A page's head.
#[derive(Debug, Default)]
struct Head {
    kind: i64,
    unpacked: u64,
    packed: u64,
    values: u64,
}

impl ParquetFile {
    /// Opens a file.
    ///
    /// # Errors
    /// [`RecordingError::Read`] if it is absent, cut off, damaged or no Parquet.
    pub fn open(path: &Path) -> Result<Self, RecordingError> {
        let fail = |cause: &dyn std::fmt::Display| RecordingError::read(path, cause);
        let mut file = file::open(path).map_err(|e| fail(&e))?;
        let size = file.metadata().map_err(|e| fail(&e))?.len();
        check_metadata(&mut file, size).map_err(|cause| fail(&cause))?;
        let own = file.try_clone().map_err(|e| fail(&e))?;
        let builder = guarded(|| ParquetRecordBatchReaderBuilder::try_new(own));
        let builder = builder
            .map_err(|cause| fail(&cause))?
            .map_err(|e| fail(&e))?;
        Ok(Self {
            file,
            size,
            builder,
        })
    }

    /// Decodes columns, by their places from 0, and shows them batch by batch; `rows` of them at most, if that is given.
    ///
    /// # Errors
    /// They come to more than `limit` says, or are damaged; those of `show`.
    pub fn decode(
        mut self,
        path: &Path,
        roots: &[usize],
        rows: Option<usize>,
        most: impl Fn(u64) -> u64,
        mut show: impl FnMut(RecordBatch) -> Result<(), RecordingError>,
    ) -> Result<(), RecordingError> {
        let fail = |cause: &dyn std::fmt::Display| RecordingError::read(path, cause);
        let most = most(self.size);
        let at_once = guarded(|| self.checked(roots, most));
        let at_once = at_once.and_then(|at_once| at_once).map_err(|e| fail(&e))?;
        let refusal = Limit::default().refusal(self.size, most);
        let builder = self.builder;
        let reader = guarded(|| {
            let mask = ProjectionMask::roots(builder.parquet_schema(), roots.iter().copied());
            let builder = builder.with_projection(mask).with_batch_size(at_once);
            match rows {
                Some(rows) => builder.with_limit(rows).build(),
                None => builder.build(),
            }
        });
        let mut reader = reader.map_err(|e| fail(&e))?.map_err(|e| fail(&e))?;
        let mut held = 0;
        while let Some(batch) = guarded(|| reader.next()).map_err(|e| fail(&e))? {
            let batch = batch.map_err(|e| fail(&e))?;
            held += batch.get_array_memory_size() as u64;
            if held > most {
                return Err(fail(&refusal));
            }
            show(batch)?;
        }
        Ok(())
    }

    /// Looks through the pages of columns, and says how many rows can be decoded at once.
    fn checked(&mut self, roots: &[usize], most: u64) -> Result<usize, String> {
        let metadata = self.builder.metadata().clone();
        let (mut held, mut at_once) = (0u64, ROWS);
        for group in metadata.row_groups() {
            let schema = metadata.file_metadata().schema_descr();
            for (place, chunk) in group.columns().iter().enumerate() {
                if !roots.contains(&schema.get_column_root_idx(place)) {
                    continue;
                }
                let pages = self.pages(chunk, most)?;
                let is_text = matches!(
                    chunk.column_type(),
                    Type::BYTE_ARRAY | Type::FIXED_LEN_BYTE_ARRAY
                );
                let mut each = 8;
                if is_text && pages.dictionary > 0 {
                    at_once = at_once.min((TEXTS / pages.dictionary).max(1) as usize);
                    // A row may hold many.
                    if chunk.column_descr().max_rep_level() > 0 {
                        each += pages.dictionary;
                    }
                }
                held = held.saturating_add(pages.values.saturating_mul(each));
                if held > most {
                    return Err(Limit::default().refusal(self.size, most));
                }
            }
        }
        Ok(at_once)
    }

    /// Looks at the heads of a chunk's pages.
    fn pages(&mut self, chunk: &ColumnChunkMetaData, most: u64) -> Result<Pages, String> {
        let (mut at, length) = chunk.byte_range();
        let end = at.saturating_add(length).min(self.size);
        let mut found = Pages::default();
        while at < end && found.values < chunk.num_values() as u64 {
            let (head, length) = self.head(at)?;
            if head.unpacked > most {
                return Err(Limit::default().refusal(self.size, most));
            }
            at += length;
            self.check_unpacked(&head, at, chunk.compression(), most)?;
            at = at.saturating_add(head.packed);
            match head.kind {
                2 => found.dictionary = found.dictionary.max(head.unpacked),
                _ => found.values = found.values.saturating_add(head.values),
            }
        }
        Ok(found)
    }

    /// The head of a page, and its bytes.
    fn head(&mut self, at: u64) -> Result<(Head, u64), String> {
        for longest in HEADS {
            let bytes = self.bytes(at, longest)?;
            let mut head = Head::default();
            let length = walk(&bytes, |path, seen| {
                let Seen::Number(number) = seen else {
                    return;
                };
                let count = u64::try_from(number).unwrap_or(u64::MAX);
                match path {
                    [1] => head.kind = number,
                    [2] => head.unpacked = count,
                    [3] => head.packed = count,
                    [5 | 8, 1] => head.values = count,
                    _ => {}
                }
            });
            if let Some(length) = length {
                return Ok((head, length as u64));
            }
        }
        Err("it is damaged: a page in it has no head".to_owned())
    }

    /// Refuses a page that comes to more than its head says, of codecs that take no heed of that.
    fn check_unpacked(
        &mut self,
        head: &Head,
        at: u64,
        codec: Compression,
        most: u64,
    ) -> Result<(), String> {
        let longer = || "it is damaged: a page in it comes to more than its head says".to_owned();
        let plain: fn(Vec<u8>) -> Box<dyn Read> = match codec {
            Compression::GZIP(_) if head.packed.saturating_mul(GZIP) > most => |bytes| {
                Box::new(flate2::read::MultiGzDecoder::new(std::io::Cursor::new(
                    bytes,
                )))
            },
            Compression::BROTLI(_) => |bytes| {
                Box::new(brotli::Decompressor::new(
                    std::io::Cursor::new(bytes),
                    1 << 12,
                ))
            },
            Compression::LZ4 if head.packed.saturating_mul(LZ4) > most => return Err(longer()),
            _ => return Ok(()),
        };
        let mut plain = plain(self.bytes(at, head.packed)?).take(head.unpacked + 1);
        // One that is damaged is said to be when it is decoded.
        match std::io::copy(&mut plain, &mut std::io::sink()) {
            Ok(count) if count > head.unpacked => Err(longer()),
            _ => Ok(()),
        }
    }

    /// Bytes from a place on, so many or as there are.
    fn bytes(&mut self, at: u64, most: u64) -> Result<Vec<u8>, String> {
        let unread = |cause: std::io::Error| cause.to_string();
        self.file.seek(SeekFrom::Start(at)).map_err(unread)?;
        let mut bytes = Vec::new();
        let mut piece = (&mut self.file).take(most);
        piece.read_to_end(&mut bytes).map_err(unread)?;
        Ok(bytes)
    }
}

/// Refuses metadata whose lists are longer than they are, or whose columns lie too deep in one another; what is no Parquet is left to the reader.
fn check_metadata(file: &mut File, size: u64) -> Result<(), String> {
    let unread = |cause: std::io::Error| cause.to_string();
    if size < TAIL + MAGIC.len() as u64 {
        return Ok(());
    }
    let (mut start, mut length, mut end) = ([0; 4], [0; 4], [0; 4]);
    file.read_exact(&mut start).map_err(unread)?;
    file.seek(SeekFrom::Start(size - TAIL)).map_err(unread)?;
    file.read_exact(&mut length).map_err(unread)?;
    file.read_exact(&mut end).map_err(unread)?;
    if start == MAGIC && end != MAGIC {
        return Err(
            "the Parquet file is cut off: where its columns stand is written at its end, and that is missing; \
             nothing of it can be read, copy it once more from where it was recorded"
                .to_owned(),
        );
    }
    let length = u64::from(u32::from_le_bytes(length));
    if start != MAGIC || length > size - TAIL {
        return Ok(());
    }
    if length > LONGEST_METADATA {
        return Err(format!(
            "its metadata have {}, expected {} at most",
            megabytes(length),
            megabytes(LONGEST_METADATA)
        ));
    }
    let mut bytes = vec![0; length as usize];
    file.seek(SeekFrom::Start(size - TAIL - length))
        .map_err(unread)?;
    file.read_exact(&mut bytes).map_err(unread)?;
    let mut children: Vec<u64> = Vec::new();
    let walked = walk(&bytes, |path, seen| match (path, seen) {
        ([2], Seen::Structure) => children.push(0),
        ([2, 5], Seen::Number(count)) => {
            if let Some(last) = children.last_mut() {
                *last = u64::try_from(count).unwrap_or(0);
            }
        }
        _ => {}
    });
    if walked.is_none() {
        return Err("it is damaged: its metadata, at its end, are none".to_owned());
    }
    match depth(&children) > DEEPEST {
        true => Err(format!(
            "its columns lie more than {DEEPEST} deep in one another"
        )),
        false => Ok(()),
    }
}

/// How deep elements lie, each before as many as it says.
fn depth(children: &[u64]) -> usize {
    let mut open: Vec<u64> = Vec::new();
    let mut deepest = 0;
    for count in children {
        if let Some(left) = open.last_mut() {
            *left -= 1;
        }
        open.push(*count);
        deepest = deepest.max(open.len());
        while open.last() == Some(&0) {
            open.pop();
        }
    }
    deepest
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use ::parquet::arrow::ArrowWriter;
    use ::parquet::basic::{BrotliLevel, GzipLevel};
    use ::parquet::file::properties::WriterProperties;
    use arrow::array::{Array, ArrayRef, Float64Array, StringArray};

    use super::*;

    /// Rows that are all alike: a few bytes stand for all of them.
    const ALIKE: usize = 100_000;

    fn write(path: &Path, column: ArrayRef, codec: Compression) {
        let batch = RecordBatch::try_from_iter([("a", column)]).unwrap();
        let properties = WriterProperties::builder().set_compression(codec).build();
        let mut file = File::create(path).unwrap();
        let mut writer = ArrowWriter::try_new(&mut file, batch.schema(), Some(properties)).unwrap();
        writer.write(&batch).unwrap();
        writer.close().unwrap();
    }

    fn decoded(path: &Path, most: u64) -> Result<usize, String> {
        let mut rows = 0;
        let file = ParquetFile::open(path).map_err(|e| e.to_string())?;
        let count = |batch: RecordBatch| {
            rows += batch.num_rows();
            Ok(())
        };
        let read = file.decode(path, &[0], None, |_| most, count);
        read.map(|()| rows).map_err(|e| e.to_string())
    }

    #[test]
    fn rows_that_few_bytes_stand_for_are_refused_beyond_the_limit() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.parquet");
        let numbers: ArrayRef = Arc::new(Float64Array::from(vec![1.0; ALIKE]));
        let texts: ArrayRef = Arc::new(StringArray::from(vec!["abcdefgh"; ALIKE]));
        let codecs = [
            Compression::UNCOMPRESSED,
            Compression::GZIP(GzipLevel::default()),
            Compression::BROTLI(BrotliLevel::default()),
        ];
        for codec in codecs {
            for column in [&numbers, &texts] {
                write(&path, Arc::clone(column), codec);
                assert!(path.metadata().unwrap().len() < 5000);
                assert_eq!(decoded(&path, 4_000_000), Ok(ALIKE), "{codec:?}");
                let said = decoded(&path, 600_000).unwrap_err();
                assert!(said.contains("--largest-mb"), "{said}");
            }
        }
        let nulls: ArrayRef = Arc::new(Float64Array::new_null(ALIKE));
        assert_eq!(nulls.null_count(), ALIKE);
        write(&path, nulls, Compression::UNCOMPRESSED);
        assert!(decoded(&path, 600_000).is_err());
    }

    #[test]
    fn metadata_that_lie_are_refused_by_a_sentence() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.parquet");
        let numbers: ArrayRef = Arc::new(Float64Array::from(vec![1.0; 9]));
        write(&path, numbers, Compression::UNCOMPRESSED);
        let whole = std::fs::read(&path).unwrap();
        // Every byte of the metadata set to each of these.
        let length = u32::from_le_bytes(whole[whole.len() - 8..][..4].try_into().unwrap());
        for at in whole.len() - 8 - length as usize..whole.len() - 8 {
            for byte in [0, 0x7f, 0x80, 0xff] {
                let mut bytes = whole.clone();
                bytes[at] = byte;
                std::fs::write(&path, &bytes).unwrap();
                if let Err(said) = decoded(&path, 4_000_000) {
                    assert!(said.starts_with("cannot read "), "{at} {byte}: {said}");
                }
            }
        }
        assert_eq!(depth(&[2, 0, 1, 0]), 3);
        assert_eq!(depth(&vec![1; 200]), 200);
    }
}
