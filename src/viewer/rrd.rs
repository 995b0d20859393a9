//! Writes `.rrd` files chunk by chunk, and streams of the same form.
//!
//! Rerun's own `RecordingStream` stamps every chunk with the clock and only logs a full disk. Here
//! the chunks get ids that follow from the recording and the encoder's errors come back, so equal
//! input gives equal bytes and a failed write is a failed write.

use std::time::Duration;

use ::rerun::external::re_log_encoding::{
    CodecError, CrateVersion, EncodeError, Encoder, EncodingOptions,
};
use ::rerun::external::re_log_types::{
    BlueprintActivationCommand, SetStoreInfo, StoreInfo, StoreSource,
};
use ::rerun::external::re_tuid::Tuid;
use ::rerun::external::re_uri::ProxyUri;
use ::rerun::log::{Chunk, ChunkComponents, ChunkError, ChunkId, LogMsg, RowId, TimeColumn};
use ::rerun::sink::{GrpcSink, GrpcSinkConnectionState, LogSink as _};
use ::rerun::{
    AsComponents, EntityPath, SerializationError, SerializedComponentColumn, StoreId, StoreKind,
};
use arrow::array::Array;

/// Longest time that a viewer that listens may take to answer.
const PATIENCE: Duration = Duration::from_secs(10);

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
    #[error("cannot write: {0}")]
    Write(#[from] std::io::Error),
    #[error("the viewer no longer answers")]
    Gone,
}

/// Where what is written goes.
enum Outlet {
    /// A file, put together in memory.
    File(Encoder<Vec<u8>>),
    /// Whoever reads on the other side, such as a viewer's standard input.
    Stream(Encoder<LiveWriter>),
    /// A viewer that listens for recordings.
    Viewer(Box<GrpcSink>),
}

/// Takes the bytes of a recording while it is made.
pub type LiveWriter = Box<dyn std::io::Write + Send>;

/// A file or stream that is being written: stores, one after the other.
pub(super) struct RrdWriter {
    outlet: Outlet,
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
        let options = EncodingOptions::PROTOBUF_COMPRESSED;
        let encoder = Encoder::new_eager(CrateVersion::LOCAL, options, Vec::new())?;
        Self::begin_at(Outlet::File(encoder), kind, recording_id, id_seed)
    }

    /// Starts a stream in the same way.
    pub(super) fn begin_stream(
        writer: LiveWriter,
        kind: StoreKind,
        recording_id: &str,
        id_seed: u64,
    ) -> Result<Self, RrdError> {
        let options = EncodingOptions::PROTOBUF_COMPRESSED;
        let mut encoder = Encoder::new_eager(CrateVersion::LOCAL, options, writer)?;
        // A footer tells where in a file chunks lie; nobody looks that up in a stream.
        encoder.do_not_emit_footer();
        Self::begin_at(Outlet::Stream(encoder), kind, recording_id, id_seed)
    }

    /// Starts to send to a viewer that listens.
    pub(super) fn begin_sending(
        address: ProxyUri,
        kind: StoreKind,
        recording_id: &str,
        id_seed: u64,
    ) -> Result<Self, RrdError> {
        let sink = Outlet::Viewer(Box::new(GrpcSink::new(address)));
        Self::begin_at(sink, kind, recording_id, id_seed)
    }

    fn begin_at(
        outlet: Outlet,
        kind: StoreKind,
        recording_id: &str,
        id_seed: u64,
    ) -> Result<Self, RrdError> {
        let mut writer = Self {
            outlet,
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
        self.append(LogMsg::SetStoreInfo(SetStoreInfo {
            row_id: Tuid::from_nanos_and_inc(self.id_seed, 0),
            info: StoreInfo::new(self.store.clone(), source),
        }))
    }

    fn append(&mut self, message: LogMsg) -> Result<(), RrdError> {
        match &mut self.outlet {
            Outlet::File(encoder) => drop(encoder.append(&message)?),
            Outlet::Stream(encoder) => drop(encoder.append(&message)?),
            Outlet::Viewer(sink) => {
                if matches!(sink.status(), GrpcSinkConnectionState::Disconnected(_)) {
                    return Err(RrdError::Gone);
                }
                sink.send(message);
            }
        }
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
        let columns: ChunkComponents = columns.into_iter().collect();
        let rows = columns.list_arrays().next().map_or(0, Array::len);
        // In the order in which they come: Rerun's own row ids would sort them along the path, where a second pass begins anew, and give such a chunk an
        // id by the clock.
        let next = |row: &RowId| Some(row.next());
        let first = RowId::from_tuid(id.as_tuid().next());
        let row_ids: Vec<RowId> = std::iter::successors(Some(first), next)
            .take(rows)
            .collect();
        let row_ids = RowId::arrow_from_slice(&row_ids);
        let entity = EntityPath::from(entity);
        let chunk = Chunk::new(id, entity, Some(true), row_ids, times, columns)?;
        self.append(LogMsg::ArrowMsg(self.store.clone(), chunk.to_arrow_msg()?))
    }

    /// Makes this store, a blueprint, the layout in which the viewer opens the recording.
    pub(super) fn activate(&mut self) -> Result<(), RrdError> {
        let command = BlueprintActivationCommand::make_active(self.store.clone());
        self.append(LogMsg::BlueprintActivationCommand(command))
    }

    /// Sees to it that what was added has left.
    pub(super) fn flush(&mut self) -> Result<(), RrdError> {
        match &mut self.outlet {
            Outlet::File(_) => Ok(()),
            Outlet::Stream(encoder) => Ok(encoder.flush_blocking()?),
            Outlet::Viewer(sink) => {
                let sent = sink.flush_blocking(PATIENCE);
                sent.map_err(|_| RrdError::Gone)
            }
        }
    }

    /// The bytes of the whole file, for [`write_joined`](super::footer::write_joined); none of what has left already.
    pub(super) fn finish(mut self) -> Result<Vec<u8>, RrdError> {
        self.flush()?;
        let Outlet::File(mut encoder) = self.outlet else {
            return Ok(Vec::new());
        };
        encoder.finish()?;
        Ok(encoder.into_inner()?)
    }
}
