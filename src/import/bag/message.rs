//! A message of a bag, wherever it is kept.

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
