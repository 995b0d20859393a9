//! Numbers as a page holds them: little-endian words of four bytes in base64.

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use serde::de::Error as _;
use serde::{Deserialize as _, Deserializer};

/// Bytes as a text.
pub(super) fn text(bytes: impl Iterator<Item = u8>) -> String {
    STANDARD.encode(bytes.collect::<Vec<u8>>())
}

/// Words of a text.
pub(super) fn words<'de, D: Deserializer<'de>>(from: D) -> Result<Vec<[u8; 4]>, D::Error> {
    let text = String::deserialize(from)?;
    let bytes = STANDARD.decode(text).map_err(D::Error::custom)?;
    let (words, rest) = bytes.as_chunks::<4>();
    match rest {
        [] => Ok(words.to_vec()),
        _ => Err(D::Error::custom("expected words of four bytes")),
    }
}
