//! Puts the footer of an `.rrd` file in order.
//!
//! The footer tells readers which stores and columns there are and where their chunks lie. Rerun's
//! encoder lists stores and columns as its hash maps hold them, in another order at every run;
//! sorted, equal content gives equal bytes.

use ::rerun::external::re_log_encoding::{
    CodecError, Decodable as _, Encodable as _, MessageHeader, MessageKind, RawRrdManifest,
    RrdFooter, StreamFooter, ToApplication as _, ToTransport,
};
use arrow::datatypes::Schema;

/// The footer as it is stored.
type StoredFooter = <RrdFooter as ToTransport>::Output;

/// Sorts the stores in the footer of a whole file, and the columns of each.
pub(super) fn sort_footer(file: &mut Vec<u8>) -> Result<(), CodecError> {
    let pointer_start = file.len().saturating_sub(StreamFooter::ENCODED_SIZE_BYTES);
    let pointer = StreamFooter::from_rrd_bytes(&file[pointer_start..])?;
    let Some(entry) = pointer.entries.first() else {
        return Ok(());
    };
    let start = entry.rrd_footer_byte_span_from_start_excluding_header.start;
    // A place within the file, hence within memory.
    let footer_start = start as usize;
    let mut footer = StoredFooter::from_rrd_bytes(&file[footer_start..pointer_start])?;

    let mut stores: Vec<RawRrdManifest> =
        footer.to_application(())?.manifests.into_values().collect();
    stores.sort_by(|a, b| a.store_id.cmp(&b.store_id));
    for store in &mut stores {
        let mut columns = store.sorbet_schema.fields().to_vec();
        columns.sort_by(|a, b| a.name().cmp(b.name()));
        store.sorbet_schema = Schema::new(columns);
    }
    let sorted: Result<Vec<_>, CodecError> = stores.iter().map(|s| s.to_transport(())).collect();
    footer.manifests = sorted?;

    let mut bytes = Vec::new();
    footer.to_rrd_bytes(&mut bytes)?;
    // Sorted, the footer may be a little longer or shorter: its header is written anew as well.
    file.truncate(footer_start.saturating_sub(MessageHeader::ENCODED_SIZE_BYTES));
    let header = MessageHeader {
        kind: MessageKind::End,
        len: bytes.len() as u64,
    };
    header.to_rrd_bytes(file)?;
    file.extend_from_slice(&bytes);
    StreamFooter::from_rrd_footer_bytes(start, &bytes).to_rrd_bytes(file)?;
    Ok(())
}
