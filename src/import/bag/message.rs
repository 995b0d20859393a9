//! A message of a bag, wherever it is kept.

use std::borrow::Cow;

use crate::import::packed::{LARGEST_MESSAGE, unpacked};

/// A topic that is there, with the name, the encoding and the text of its definition.
#[derive(Debug, Clone)]
pub(super) struct There {
    pub topic: String,
    pub encoding: String,
    pub schema: Option<(String, String, Vec<u8>)>,
}

/// A message.
pub(super) struct Message<'a> {
    /// Its topic.
    pub there: &'a There,
    /// Its number in the bag, from 1.
    pub number: u64,
    /// When it was logged and published [ns].
    pub logged: u64,
    pub published: u64,
    /// Its bytes.
    pub data: &'a [u8],
}

impl Message<'_> {
    /// Its bytes, unpacked where it was packed by itself. Plain ones begin with a zero, as CDR does.
    pub fn plain(&self) -> Result<Cow<'_, [u8]>, String> {
        let plain = unpacked(self.data, LARGEST_MESSAGE)?;
        Ok(plain.map_or(Cow::Borrowed(self.data), Cow::Owned))
    }
}
