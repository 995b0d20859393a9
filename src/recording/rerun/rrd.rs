//! Writes `.rrd` files chunk by chunk.
//!
//! Rerun's own `RecordingStream` stamps every chunk with the clock and only logs a full disk. Here
//! the chunks get ids that follow from the recording and the encoder's errors come back, so equal
//! input gives equal bytes and a failed write is a failed write.

use ::rerun::external::re_log_encoding::{CodecError, EncodeError, Encoder};
use ::rerun::external::re_log_types::{
    BlueprintActivationCommand, SetStoreInfo, StoreInfo, StoreSource,
};
use ::rerun::external::re_tuid::Tuid;
use ::rerun::log::{Chunk, ChunkError, ChunkId, LogMsg, TimeColumn};
use ::rerun::{
    AsComponents, EntityPath, SerializationError, SerializedComponentColumn, StoreId, StoreKind,
};

use super::footer::sort_footer;

/// Name under which the viewer groups our recordings and keeps their layout.
pub(super) const APPLICATION: &str = "idc-cell";

/// Why a file could not be encoded.
#[derive(Debug, thiserror::Error)]
pub(super) enum RrdError {
    #[error(transparent)]
    Encode(#[from] EncodeError),
    #[error(transparent)]
    Codec(#[from] CodecError),
    #[error(transparent)]
    Chunk(#[from] ChunkError),
    #[error(transparent)]
    Serialize(#[from] SerializationError),
}

/// A file that is being written: stores, one after the other, in one stream.
pub(super) struct RrdWriter {
    encoder: Encoder<Vec<u8>>,
    store: StoreId,
    /// High half of all chunk ids; from the recording, so that two open files do not share ids.
    id_seed: u64,
    chunks: u64,
}

impl RrdWriter {
    /// Starts a file with a store of the given kind. `id_seed` must differ between recordings that
    /// differ.
    pub(super) fn begin(
        kind: StoreKind,
        recording_id: &str,
        id_seed: u64,
    ) -> Result<Self, RrdError> {
        let encoder = Encoder::local()?;
        let mut writer = Self {
            encoder,
            store: StoreId::new(kind, APPLICATION, recording_id.to_owned()),
            id_seed,
            chunks: 0,
        };
        writer.announce_store()?;
        Ok(writer)
    }

    /// Goes on with another store.
    pub(super) fn begin_store(
        &mut self,
        kind: StoreKind,
        recording_id: &str,
    ) -> Result<(), RrdError> {
        self.store = StoreId::new(kind, APPLICATION, recording_id.to_owned());
        self.announce_store()
    }

    fn announce_store(&mut self) -> Result<(), RrdError> {
        let source = StoreSource::Other(APPLICATION.to_owned());
        self.encoder.append(&LogMsg::SetStoreInfo(SetStoreInfo {
            row_id: Tuid::from_nanos_and_inc(self.id_seed, 0),
            info: StoreInfo::new(self.store.clone(), source),
        }))?;
        Ok(())
    }

    /// Adds what holds at all times.
    pub(super) fn add_static(
        &mut self,
        entity: &str,
        components: &dyn AsComponents,
    ) -> Result<(), RrdError> {
        self.add_row(entity, vec![], components)
    }

    /// Adds one row at the times given (none: at all times).
    pub(super) fn add_row(
        &mut self,
        entity: &str,
        times: Vec<TimeColumn>,
        components: &dyn AsComponents,
    ) -> Result<(), RrdError> {
        let batches = components.as_serialized_batches();
        let columns = batches.into_iter().map(SerializedComponentColumn::from);
        self.add_columns(entity, times, columns)
    }

    /// Adds one row per time.
    pub(super) fn add_columns(
        &mut self,
        entity: &str,
        times: Vec<TimeColumn>,
        columns: impl IntoIterator<Item = SerializedComponentColumn>,
    ) -> Result<(), RrdError> {
        self.chunks += 1;
        // Row ids count up from the chunk's id: 2^32 rows fit before the next chunk.
        let id = ChunkId::from_tuid(Tuid::from_nanos_and_inc(self.id_seed, self.chunks << 32));
        let times = times
            .into_iter()
            .map(|t| (*t.timeline().name(), t))
            .collect();
        let columns = columns.into_iter().collect();
        let chunk = Chunk::from_auto_row_ids(id, EntityPath::from(entity), times, columns)?;
        let message = LogMsg::ArrowMsg(self.store.clone(), chunk.to_arrow_msg()?);
        self.encoder.append(&message)?;
        Ok(())
    }

    /// Makes this store, a blueprint, the layout in which the viewer opens the recording.
    pub(super) fn activate(&mut self) -> Result<(), RrdError> {
        let command = BlueprintActivationCommand::make_active(self.store.clone());
        let message = LogMsg::BlueprintActivationCommand(command);
        self.encoder.append(&message)?;
        Ok(())
    }

    /// The bytes of the whole file.
    pub(super) fn finish(mut self) -> Result<Vec<u8>, RrdError> {
        self.encoder.finish()?;
        let mut file = self.encoder.into_inner()?;
        sort_footer(&mut file)?;
        Ok(file)
    }
}
