//! Texts of mesh files: their encoding, their numbers.

use std::borrow::Cow;

pub(super) use crate::xml::shown;

/// A file's text: UTF-8 or UTF-16 by its byte-order mark; letters that are neither stand for themselves no more, as in names only.
pub(super) fn decoded(bytes: &[u8]) -> Cow<'_, str> {
    let sixteen = |rest: &[u8], pair: fn([u8; 2]) -> u16| {
        let units = rest.chunks_exact(2).map(|two| pair([two[0], two[1]]));
        let letters = char::decode_utf16(units);
        letters
            .map(|letter| letter.unwrap_or('\u{fffd}'))
            .collect::<String>()
    };
    match bytes {
        [0xef, 0xbb, 0xbf, rest @ ..] => String::from_utf8_lossy(rest),
        [0xff, 0xfe, rest @ ..] => Cow::Owned(sixteen(rest, u16::from_le_bytes)),
        [0xfe, 0xff, rest @ ..] => Cow::Owned(sixteen(rest, u16::from_be_bytes)),
        _ => String::from_utf8_lossy(bytes),
    }
}

/// Lines of a text, whichever way they end.
pub(super) fn lines(text: &str) -> impl Iterator<Item = &str> {
    let end = if text.contains('\n') { '\n' } else { '\r' };
    text.split(end).map(|line| line.trim_end_matches('\r'))
}

/// A number, also with the exponent letters of Fortran; the fault says what was found.
pub(super) fn number(word: &str) -> Result<f64, String> {
    if let Ok(value) = word.parse::<f64>() {
        return Ok(value);
    }
    if let Ok(value) = word.replace(['d', 'D'], "e").parse::<f64>() {
        return Ok(value);
    }
    let word = &shown(word);
    let comma = word.contains(',') && word.replace(',', ".").parse::<f64>().is_ok();
    Err(if comma {
        format!("`{word}` has a decimal comma, expected a number with a decimal point")
    } else {
        format!("`{word}` is no number")
    })
}
