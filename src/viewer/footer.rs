//! Puts `.rrd` files together as one, its footer in order.
//!
//! The footer tells readers which stores and columns there are and where their chunks lie. Rerun's
//! encoder lists stores and columns as its hash maps hold them, in another order at every run;
//! sorted, equal content gives equal bytes.

use std::io::Write;
use std::sync::Arc;

use ::rerun::external::re_log_encoding::{
    CodecError, Decodable as _, Encodable as _, MessageHeader, MessageKind, RawRrdManifest,
    RrdFooter, StreamFooter, StreamHeader, ToApplication as _, ToTransport,
};
use arrow::array::{RecordBatch, UInt64Array};
use arrow::datatypes::Schema;

use super::rrd::RrdError;

/// The footer as it is stored.
type StoredFooter = <RrdFooter as ToTransport>::Output;

/// Writes the stores of whole files, one after the other, as one file.
pub(super) fn write_joined(files: &[Vec<u8>], to: &mut dyn Write) -> Result<(), RrdError> {
    let mut stores: Vec<RawRrdManifest> = Vec::new();
    let mut length = 0;
    for (index, file) in files.iter().enumerate() {
        let (messages_end, found) = take_apart(file)?;
        let messages_start = StreamHeader::ENCODED_SIZE_BYTES;
        // The first file's header is that of all.
        let start = if index == 0 { 0 } else { messages_start };
        let shift = length - start as u64;
        for mut store in found {
            move_chunks(&mut store, shift)?;
            stores.push(store);
        }
        to.write_all(&file[start..messages_end])?;
        length += (messages_end - start) as u64;
    }
    write_footer(stores, length, to)
}

/// Where the messages of a file end, and what its footer says of its stores.
fn take_apart(file: &[u8]) -> Result<(usize, Vec<RawRrdManifest>), CodecError> {
    let pointer_start = file.len().saturating_sub(StreamFooter::ENCODED_SIZE_BYTES);
    let pointer = StreamFooter::from_rrd_bytes(&file[pointer_start..])?;
    let Some(entry) = pointer.entries.first() else {
        return Ok((pointer_start, Vec::new()));
    };
    // A place within the file, hence within memory.
    let footer_start = entry.rrd_footer_byte_span_from_start_excluding_header.start as usize;
    let footer = StoredFooter::from_rrd_bytes(&file[footer_start..pointer_start])?;
    let stores = footer.to_application(())?.manifests.into_values();
    let messages_end = footer_start.saturating_sub(MessageHeader::ENCODED_SIZE_BYTES);
    Ok((messages_end, stores.collect()))
}

/// Says of a store's chunks that they lie `shift` bytes further on.
fn move_chunks(store: &mut RawRrdManifest, shift: u64) -> Result<(), RrdError> {
    let moved = store.col_chunk_byte_offset()?.map(|start| start + shift);
    let moved = UInt64Array::from_iter_values(moved);
    let schema = store.data.schema();
    let column = schema.index_of(RawRrdManifest::FIELD_CHUNK_BYTE_OFFSET);
    let mut columns = store.data.columns().to_vec();
    columns[column.map_err(CodecError::ArrowDeserialization)?] = Arc::new(moved);
    let moved = RecordBatch::try_new(schema, columns);
    store.data = moved.map_err(CodecError::ArrowSerialization)?;
    Ok(())
}

/// Writes the footer of a file whose messages take up `length` bytes: its stores sorted, and the columns of each.
fn write_footer(
    mut stores: Vec<RawRrdManifest>,
    length: u64,
    to: &mut dyn Write,
) -> Result<(), RrdError> {
    stores.sort_by(|a, b| a.store_id.cmp(&b.store_id));
    for store in &mut stores {
        let mut columns = store.sorbet_schema.fields().to_vec();
        columns.sort_by(|a, b| a.name().cmp(b.name()));
        store.sorbet_schema = Schema::new(columns);
    }
    let sorted: Result<Vec<_>, CodecError> = stores.iter().map(|s| s.to_transport(())).collect();
    let mut footer = RrdFooter::default().to_transport(())?;
    footer.manifests = sorted?;
    let mut footer_bytes = Vec::new();
    footer.to_rrd_bytes(&mut footer_bytes)?;
    let header = MessageHeader {
        kind: MessageKind::End,
        len: footer_bytes.len() as u64,
    };
    let mut end = Vec::new();
    header.to_rrd_bytes(&mut end)?;
    let footer_start = length + end.len() as u64;
    end.extend_from_slice(&footer_bytes);
    StreamFooter::from_rrd_footer_bytes(footer_start, &footer_bytes).to_rrd_bytes(&mut end)?;
    Ok(to.write_all(&end)?)
}
