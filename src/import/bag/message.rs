//! A message of a bag, wherever it is kept.

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::rc::Rc;

use crate::import::packed::{Budget, unpacked_message};

/// Definition of a kind of messages: its name, its encoding and its text. Many topics may share one.
#[derive(Debug, PartialEq, Eq, Default)]
pub(super) struct Schema {
    pub name: String,
    pub encoding: String,
    pub data: Vec<u8>,
}

/// A topic that is there.
#[derive(Debug, Clone)]
pub(super) struct There {
    pub topic: String,
    pub encoding: String,
    pub schema: Option<Rc<Schema>>,
    /// What its writer says of it.
    pub metadata: Rc<BTreeMap<String, String>>,
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
    /// What all messages may come to.
    pub budget: &'a Budget,
}

impl Message<'_> {
    /// Its bytes, unpacked where it was packed by itself. Plain ones begin with a zero, as CDR does.
    pub fn plain(&self) -> Result<Cow<'_, [u8]>, String> {
        let plain = unpacked_message(self.data)?;
        if let Some(plain) = &plain {
            self.budget.take(plain.len() as u64)?;
        }
        Ok(plain.map_or(Cow::Borrowed(self.data), Cow::Owned))
    }
}
