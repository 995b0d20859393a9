//! Numbers as a page holds them: little-endian words of four bytes in base64.

use std::io::Write as _;

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use flate2::Compression;
use flate2::write::GzEncoder;
use serde::de::Error as _;
use serde::{Deserialize as _, Deserializer};

/// Bytes as a text.
pub(super) fn text(bytes: impl Iterator<Item = u8>) -> String {
    STANDARD.encode(bytes.collect::<Vec<u8>>())
}

/// Bytes compressed, as a text.
pub(super) fn gzip(bytes: &[u8]) -> String {
    let mut packed = GzEncoder::new(Vec::new(), Compression::best());
    // Writing into memory does not fail.
    let packed = packed.write_all(bytes).and_then(|()| packed.finish());
    STANDARD.encode(packed.unwrap_or_default())
}

/// Words of a text.
fn words<'de, D: Deserializer<'de>>(from: D) -> Result<Vec<[u8; 4]>, D::Error> {
    let text = String::deserialize(from)?;
    let bytes = STANDARD.decode(text).map_err(D::Error::custom)?;
    let (words, rest) = bytes.as_chunks::<4>();
    match rest {
        [] => Ok(words.to_vec()),
        _ => Err(D::Error::custom("expected words of four bytes")),
    }
}

/// A field of `f32`.
pub(super) mod floats {
    use serde::{Deserializer, Serializer};

    /// As a text.
    pub fn serialize<S: Serializer>(values: &[f32], to: S) -> Result<S::Ok, S::Error> {
        let bytes = values.iter().flat_map(|value| value.to_le_bytes());
        to.serialize_str(&super::text(bytes))
    }

    /// From one.
    pub fn deserialize<'de, D: Deserializer<'de>>(from: D) -> Result<Vec<f32>, D::Error> {
        let words = super::words(from)?.into_iter();
        Ok(words.map(f32::from_le_bytes).collect())
    }
}

/// A field of `u32`.
pub(super) mod indices {
    use serde::{Deserializer, Serializer};

    /// As a text.
    pub fn serialize<S: Serializer>(values: &[u32], to: S) -> Result<S::Ok, S::Error> {
        let bytes = values.iter().flat_map(|value| value.to_le_bytes());
        to.serialize_str(&super::text(bytes))
    }

    /// From one.
    pub fn deserialize<'de, D: Deserializer<'de>>(from: D) -> Result<Vec<u32>, D::Error> {
        let words = super::words(from)?.into_iter();
        Ok(words.map(u32::from_le_bytes).collect())
    }
}
