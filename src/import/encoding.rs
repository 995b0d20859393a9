//! The encoding of a text log: as the map says, or as its bytes tell. What cannot be determined is refused: a guess would garble names and units.
//!
//! A byte order mark tells, then zero bytes at every other place (UTF-16 without a mark), then valid UTF-8. What is left is Windows-1252 if all that it would
//! then hold beyond ASCII is what western European logs hold: their letters within words, and the signs of units.

use std::path::Path;

use encoding_rs::{Encoding, UTF_8, UTF_16BE, UTF_16LE, WINDOWS_1252};

use super::error::ImportError;

/// Signs of units, currency and quotation that stand alone.
const SIGNS: &str = "°²³µ±·×÷´§¹¼½¾€–—…„“”‚‘’«»©®\u{a0}";
/// Those of them that no word holds; in other code pages their bytes are letters.
const BETWEEN_WORDS: &str = "„“”‚‘…";
/// Letters of German, French, Italian, Spanish, Portuguese and the Nordic languages.
const LETTERS: &str = "äöüÄÖÜßàâæçèéêëîïôœùûÿÀÂÇÈÉÊËÎÔÙÛìòÌÒáíñóúÁÍÑÓÚåÅæÆøØãõÃÕ";
/// Letters that stand together at most.
const TOGETHER: usize = 2;
/// Share of the bytes at every other place that are zero in UTF-16 of mostly ASCII.
const ZEROS: f64 = 0.7;
/// Bytes that are looked at for zeros, at most.
const LOOKED_AT: usize = 1 << 16;

/// Certainty of an encoding, and its reason.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct DetectedEncoding {
    /// Its name, as the map has it.
    pub name: String,
    /// Why.
    pub reason: &'static str,
    /// Whether it could be another one.
    pub is_certain: bool,
}

/// An encoding by its name, as the WHATWG lists them.
pub(super) fn named(name: &str) -> Option<&'static Encoding> {
    Encoding::for_label(name.trim().as_bytes())
}

/// Whether this is the name of an encoding.
#[must_use]
pub fn is_known(name: &str) -> bool {
    named(name).is_some()
}

/// The text of a log in the encoding of its map, or in that which its bytes tell; and which that is.
pub(super) fn decode(
    path: &Path,
    bytes: Vec<u8>,
    given: Option<&str>,
) -> Result<(String, DetectedEncoding), ImportError> {
    let (encoding, detected) = match given.and_then(named) {
        Some(encoding) => (
            encoding,
            DetectedEncoding {
                name: encoding.name().to_lowercase(),
                reason: "the map says so",
                is_certain: true,
            },
        ),
        None => tell(path, &bytes)?,
    };
    let is_plain = encoding == UTF_8 && Encoding::for_bom(&bytes).is_none();
    let bytes = match is_plain {
        true => match String::from_utf8(bytes) {
            // It is not copied.
            Ok(text) => return Ok((text, detected)),
            Err(faulty) => faulty.into_bytes(),
        },
        false => bytes,
    };
    let (text, _, is_faulty) = encoding.decode(&bytes);
    if is_faulty {
        let line = 1 + text.split('\u{fffd}').next().map_or(0, |before| {
            before.bytes().filter(|byte| *byte == b'\n').count()
        });
        return Err(ImportError::Encoding {
            file: path.to_owned(),
            seen: format!(
                "line {line} holds bytes that are no {}",
                encoding.name().to_lowercase()
            ),
        });
    }
    Ok((text.into_owned(), detected))
}

/// The encoding that the bytes tell.
fn tell(path: &Path, bytes: &[u8]) -> Result<(&'static Encoding, DetectedEncoding), ImportError> {
    let detected = |encoding: &'static Encoding, reason, is_certain| {
        let name = encoding.name().to_lowercase();
        let detected = DetectedEncoding {
            name,
            reason,
            is_certain,
        };
        Ok((encoding, detected))
    };
    if let Some((encoding, _)) = Encoding::for_bom(bytes) {
        return detected(encoding, "it begins with the byte order mark", true);
    }
    if let Some(encoding) = by_zeros(bytes) {
        return detected(encoding, "every other byte is zero", true);
    }
    if let Some(at) = bytes.iter().position(|byte| *byte == 0) {
        return Err(ImportError::Encoding {
            file: path.to_owned(),
            seen: format!(
                "line {} holds a zero byte, as no text does",
                line(bytes, at)
            ),
        });
    }
    match std::str::from_utf8(bytes) {
        Ok(_) if bytes.is_ascii() => return detected(UTF_8, "plain ASCII", true),
        Ok(_) => return detected(UTF_8, "all of it is valid UTF-8", true),
        Err(_) => {}
    }
    match odd_character(bytes) {
        None => detected(
            WINDOWS_1252,
            "no UTF-8; read so, its letters and signs are those of western European logs",
            false,
        ),
        Some((at, seen)) => Err(ImportError::Encoding {
            file: path.to_owned(),
            seen: format!(
                "line {} holds the byte 0x{:02X}: no UTF-8, and in Windows-1252 {seen}",
                line(bytes, at),
                bytes[at]
            ),
        }),
    }
}

/// UTF-16 without a mark, by its zero bytes.
fn by_zeros(bytes: &[u8]) -> Option<&'static Encoding> {
    let bytes = &bytes[..bytes.len().min(LOOKED_AT) & !1];
    let half = bytes.len() / 2;
    let zeros = |odd: usize| {
        let own = bytes.iter().skip(odd).step_by(2);
        own.filter(|byte| **byte == 0).count()
    };
    let [even, odd] = [zeros(0), zeros(1)];
    let most = |count: usize| half > 0 && count as f64 > ZEROS * half as f64;
    match (most(even), most(odd)) {
        (false, true) if even == 0 => Some(UTF_16LE),
        (true, false) if odd == 0 => Some(UTF_16BE),
        _ => None,
    }
}

/// Place of the first byte that a western European log does not hold, and what it would be.
fn odd_character(bytes: &[u8]) -> Option<(usize, String)> {
    let high = |at: usize| bytes.get(at).is_some_and(|byte| *byte >= 0x80);
    let is_letter = |at: usize| bytes.get(at).is_some_and(u8::is_ascii_alphabetic);
    let mut at = 0;
    while at < bytes.len() {
        if !high(at) {
            at += 1;
            continue;
        }
        let end = (at..bytes.len()).find(|i| !high(*i)).unwrap_or(bytes.len());
        let (run, _, _) = WINDOWS_1252.decode(&bytes[at..end]);
        let [before, after] = [at > 0 && is_letter(at - 1), is_letter(end)];
        // A small letter before a capital begins no word: code page 850 has its degree there.
        let begins =
            |c: char| !(c.is_lowercase() && bytes.get(end).is_some_and(u8::is_ascii_uppercase));
        let in_word = before || (after && run.chars().all(begins));
        let mut letters = 0;
        for (index, character) in run.chars().enumerate() {
            letters = if LETTERS.contains(character) {
                letters + 1
            } else {
                0
            };
            let is_torn = before && after && BETWEEN_WORDS.contains(character);
            let is_sign = SIGNS.contains(character) && !is_torn;
            let is_fine = is_sign || (letters > 0 && in_word && letters <= TOGETHER);
            if !is_fine {
                let seen = if character.is_control() {
                    "no character".to_owned()
                } else {
                    format!("a `{character}` that no western European log would hold there")
                };
                return Some((at + index, seen));
            }
        }
        at = end;
    }
    None
}

/// The line, from 1, of a byte.
fn line(bytes: &[u8], at: usize) -> usize {
    #[expect(clippy::naive_bytecount, reason = "once, for a message")]
    let before = bytes[..at].iter().filter(|byte| **byte == b'\n').count();
    1 + before
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str = "Zeit [s];Oberfläche [µm];Temp. [°C]\n0,001;12,5;20\n";

    fn detected(bytes: &[u8]) -> Result<(String, String), String> {
        match decode(Path::new("log.csv"), bytes.to_vec(), None) {
            Ok((text, detected)) => Ok((text, detected.name)),
            Err(error) => Err(error.to_string()),
        }
    }

    fn utf_16(text: &str, bytes: fn(u16) -> [u8; 2]) -> Vec<u8> {
        text.encode_utf16().flat_map(bytes).collect()
    }

    #[test]
    fn each_encoding_is_detected_by_its_bytes() {
        let text = || TEXT.to_owned();
        let marked = |bytes: Vec<u8>, mark: &[u8]| [mark, &bytes].concat();
        let little = || utf_16(TEXT, u16::to_le_bytes);
        let big = || utf_16(TEXT, u16::to_be_bytes);
        for (bytes, name) in [
            (TEXT.as_bytes().to_vec(), "utf-8"),
            (marked(TEXT.as_bytes().to_vec(), b"\xef\xbb\xbf"), "utf-8"),
            (WINDOWS_1252.encode(TEXT).0.into_owned(), "windows-1252"),
            (little(), "utf-16le"),
            (marked(little(), b"\xff\xfe"), "utf-16le"),
            (big(), "utf-16be"),
            (marked(big(), b"\xfe\xff"), "utf-16be"),
        ] {
            assert_eq!(detected(&bytes), Ok((text(), name.to_owned())));
        }
    }

    #[test]
    fn an_unclear_encoding_is_refused_with_what_was_seen() {
        // Code page 850: a u umlaut is 0x81, an a umlaut 0x84, a degree 0xF8.
        for (bytes, says) in [
            (&b"t;Dr\x81cke\n0;1\n"[..], "line 1 holds the byte 0x81"),
            (b"t;p\n0;Oberfl\x84che\n", "no UTF-8"),
            (b"t;T [\xf8C]\n", "byte 0xF8"),
            // Cyrillic in Windows-1251.
            (b"t;\xc4\xe0\xe2\xeb\xe5\xed\xe8\xe5\n", "byte 0xC4"),
            (b"t;p\n0;1\n\x00\x01\x02", "line 3 holds a zero byte"),
        ] {
            let said = detected(bytes).unwrap_err();
            assert!(said.contains(says), "{said}\nlacks {says:?}");
            assert!(said.contains("encoding = \"windows-1252\""), "{said}");
        }
        let cyrillic = b"\xc4\xe0\xe2\xeb";
        let (text, _) = decode(Path::new("a"), cyrillic.to_vec(), Some("windows-1251")).unwrap();
        assert_eq!(text, "Давл");
        let wrong = decode(Path::new("a"), b"a\n\xff\xfe\xfd".to_vec(), Some("utf-8")).unwrap_err();
        assert!(
            wrong
                .to_string()
                .contains("line 2 holds bytes that are no utf-8"),
            "{wrong}"
        );
    }
}
