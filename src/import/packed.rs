//! Files and messages that are packed with gzip or zstd, unpacked up to a bound: few bytes may stand for any number of them.

use std::cell::Cell;
use std::io::Read;
use std::path::{Path, PathBuf};

use flate2::read::MultiGzDecoder;
use zstd::stream::read::Decoder;

use super::error::ImportError;
use super::signature;
use crate::file::{self, Limit};

/// Bytes of a message, at most.
pub(super) const LARGEST_MESSAGE: u64 = 1 << 26;

/// First bytes of what is packed.
pub(super) const GZIP: &[u8] = b"\x1f\x8b";
pub(super) const ZSTD: &[u8] = b"\x28\xb5\x2f\xfd";

/// Endings of files that are packed.
const ENDINGS: [&str; 3] = ["zstd", "zst", "gz"];

/// A file's name without the ending of what is packed.
pub(super) fn plain_name(file: &Path) -> PathBuf {
    let ending = file.extension().and_then(|ending| ending.to_str());
    match ending {
        Some(ending) if ENDINGS.contains(&ending) => file.with_extension(""),
        _ => file.to_owned(),
    }
}

/// What a bag's messages come to, which may lie in it packed, and more than once packed.
pub(super) struct Budget {
    limit: Limit,
    size: u64,
    used: Cell<u64>,
}

impl Budget {
    /// Of files that have so many bytes.
    pub fn new(limit: Limit, size: u64) -> Self {
        Self {
            limit,
            size,
            used: Cell::new(0),
        }
    }

    /// Bytes that one piece may come to.
    pub fn piece(&self) -> u64 {
        self.limit.unpacked(self.size)
    }

    /// Counts bytes.
    ///
    /// # Errors
    /// There are more than files of this size can hold.
    pub fn take(&self, bytes: u64) -> Result<(), String> {
        let most = self.limit.passed(self.size);
        self.used.set(self.used.get().saturating_add(bytes));
        match self.used.get() > most {
            true => Err(self.limit.refusal(self.size, most)),
            false => Ok(()),
        }
    }

    /// Why a piece that claims to be longer than [`Budget::piece`] is refused.
    pub fn refusal(&self) -> String {
        self.limit.refusal(self.size, self.piece())
    }
}

/// Bytes of a file unpacked, if they begin as packed ones do.
///
/// # Errors
/// They are damaged or cut off, or come to more than the limit.
pub(super) fn unpacked(bytes: &[u8], limit: Limit) -> Result<Option<Vec<u8>>, String> {
    let size = bytes.len() as u64;
    let most = limit.unpacked(size);
    unpacked_to(bytes, most, || limit.refusal(size, most))
}

/// Bytes of a message, as [`unpacked`].
///
/// # Errors
/// As those of [`unpacked`].
pub(super) fn unpacked_message(bytes: &[u8]) -> Result<Option<Vec<u8>>, String> {
    let refusal = || format!("it comes to more than {}", file::megabytes(LARGEST_MESSAGE));
    unpacked_to(bytes, LARGEST_MESSAGE, refusal)
}

fn unpacked_to(
    bytes: &[u8],
    most: u64,
    refusal: impl Fn() -> String,
) -> Result<Option<Vec<u8>>, String> {
    if bytes.starts_with(GZIP) {
        return all(MultiGzDecoder::new(bytes), most, "gzip", refusal).map(Some);
    }
    if bytes.starts_with(ZSTD) {
        let decoder = Decoder::with_buffer(bytes).map_err(|cause| cause.to_string())?;
        return all(decoder, most, "zstd", refusal).map(Some);
    }
    Ok(None)
}

/// Bytes of a text, unpacked where they are packed.
///
/// # Errors
/// It cannot be read or unpacked, or is known to be no text.
pub(super) fn text_bytes(path: &Path, limit: Limit) -> Result<Vec<u8>, ImportError> {
    const EXPECTED: &str = "a text";
    signature::check(path, "text", EXPECTED)?;
    let fail = |cause: String| ImportError::Read {
        file: path.to_owned(),
        cause,
    };
    let bytes = file::read_up_to(path, limit.whole()).map_err(|cause| fail(cause.to_string()))?;
    let Some(plain) = unpacked(&bytes, limit).map_err(fail)? else {
        return Ok(bytes);
    };
    match signature::of_bytes(&plain) {
        Some(inside) => Err(inside.refusal_inside(path, EXPECTED)),
        None => Ok(plain),
    }
}

/// What a file that is packed unpacks to, to be read as far as it is wanted.
pub(super) fn begins_packed(file: std::fs::File) -> Option<Box<dyn Read>> {
    use std::io::{BufRead, BufReader};
    let mut file = BufReader::new(file);
    let start = file.fill_buf().ok()?;
    if start.starts_with(GZIP) {
        return Some(Box::new(MultiGzDecoder::new(file)));
    }
    if start.starts_with(ZSTD) {
        return Some(Box::new(Decoder::with_buffer(file).ok()?));
    }
    None
}

/// All that a decoder gives, up to a bound.
fn all(
    decoder: impl Read,
    most: u64,
    what: &str,
    refusal: impl Fn() -> String,
) -> Result<Vec<u8>, String> {
    let mut plain = Vec::new();
    let mut bounded = decoder.take(most.saturating_add(1));
    bounded
        .read_to_end(&mut plain)
        .map_err(|cause| format!("it is packed with {what}, and damaged or cut off: {cause}"))?;
    if plain.len() as u64 > most {
        return Err(format!("it is packed with {what}: {}", refusal()));
    }
    Ok(plain)
}

#[cfg(test)]
mod tests {
    use std::io::Write;

    use super::*;

    fn gzip(plain: &[u8]) -> Vec<u8> {
        let mut encoder = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::best());
        encoder.write_all(plain).unwrap();
        encoder.finish().unwrap()
    }

    #[test]
    fn what_was_packed_comes_back_up_to_a_bound() {
        let plain = vec![7u8; 5000];
        let by_zstd = zstd::encode_all(&plain[..], 3).unwrap();
        for packed in [
            gzip(&plain),
            by_zstd,
            [gzip(&plain[..2000]), gzip(&plain[2000..])].concat(),
        ] {
            let to = |most: u64| unpacked_to(&packed, most, || "too much".to_owned());
            assert_eq!(to(5000), Ok(Some(plain.clone())));
            let said = to(4999).unwrap_err();
            assert!(said.contains("too much"), "{said}");
            let said = unpacked(&packed[..packed.len() - 3], Limit::default()).unwrap_err();
            assert!(said.contains("damaged or cut off"), "{said}");
        }
        assert_eq!(unpacked(b"0.5 1.5\n", Limit::default()), Ok(None));
    }
}
