//! What an `.rrd` file holds, as Rerun's own decoder reads it. Unit tests of `src/recording/rerun/` use this file too.

use std::io::BufRead;

use re_chunk::Chunk;
use re_log_encoding::Decoder;
use re_log_types::{LogMsg, StoreId};

/// One of a file's stores: the recording, or the layout in which it opens.
pub struct Store {
    pub id: StoreId,
    /// In the order in which they stand.
    pub chunks: Vec<Chunk>,
}

/// The stores of a file, in the order in which they stand.
pub fn stores(file: impl BufRead) -> Vec<Store> {
    let mut stores: Vec<Store> = Vec::new();
    for message in Decoder::decode_eager(file).unwrap() {
        match message.unwrap() {
            LogMsg::SetStoreInfo(start) => stores.push(Store {
                id: start.info.store_id,
                chunks: Vec::new(),
            }),
            LogMsg::ArrowMsg(id, message) => {
                let store = stores.iter_mut().find(|store| store.id == id).unwrap();
                store.chunks.push(Chunk::from_arrow_msg(&message).unwrap());
            }
            LogMsg::BlueprintActivationCommand(_) => (),
        }
    }
    stores
}

/// The recording among them.
pub fn recording(file: impl BufRead) -> Store {
    let mut stores = stores(file).into_iter();
    stores.find(|store| store.id.is_recording()).unwrap()
}
