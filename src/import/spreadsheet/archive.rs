//! What the zip archive of a spreadsheet comes to, before any of it is read: its members unpacked, as their sizes may lie, and cells of an ods, of which one
//! may stand for any number.

use std::io::{Read, copy, sink};

use flate2::read::DeflateDecoder;

/// Beginnings of an entry of a directory and of a member (PKWARE, APPNOTE 4.3).
const ENTRY: &[u8] = b"PK\x01\x02";
const MEMBER: &[u8] = b"PK\x03\x04";
const MEMBER_HEAD: usize = 30;
/// The member of an ods that holds its sheets.
const CONTENT: &[u8] = b"content.xml";
/// Bytes of a cell, with its formula and its place.
const CELL: u64 = 64;

/// A member as the directory has it.
struct Member<'a> {
    name: &'a [u8],
    is_packed: bool,
    data: &'a [u8],
}

/// What the members of an archive come to unpacked [B], counted no further than beyond `most`.
pub(super) fn unpacked_size(bytes: &[u8], most: u64) -> u64 {
    let mut sum = 0u64;
    for member in members(bytes) {
        let left = most.saturating_sub(sum).saturating_add(1);
        sum += match member.is_packed {
            // One that is damaged is said to be when it is read.
            true => {
                let mut plain = DeflateDecoder::new(member.data).take(left);
                let mut count = Counted(0);
                let _ = copy(&mut plain, &mut count);
                count.0
            }
            false => member.data.len() as u64,
        };
        if sum > most {
            break;
        }
    }
    sum
}

/// Bytes that were written.
struct Counted(u64);

impl std::io::Write for Counted {
    fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
        self.0 += bytes.len() as u64;
        sink().write(bytes)
    }

    fn flush(&mut self) -> std::io::Result<()> {
        Ok(())
    }
}

fn members(bytes: &[u8]) -> impl Iterator<Item = Member<'_>> {
    let mut rest = bytes;
    std::iter::from_fn(move || {
        loop {
            let at = rest.windows(ENTRY.len()).position(|own| own == ENTRY)?;
            let entry = &rest[at..];
            rest = &entry[ENTRY.len()..];
            if let Some(member) = member(bytes, entry) {
                return Some(member);
            }
        }
    })
}

fn member<'a>(bytes: &'a [u8], entry: &[u8]) -> Option<Member<'a>> {
    let short = |of: &[u8], at: usize| {
        let own = of.get(at..at + 2)?;
        Some(usize::from(u16::from_le_bytes([own[0], own[1]])))
    };
    let long = |at: usize| {
        let own = entry.get(at..at + 4)?;
        Some(u32::from_le_bytes([own[0], own[1], own[2], own[3]]) as usize)
    };
    let (method, size, place) = (short(entry, 10)?, long(20)?, long(42)?);
    let own = bytes.get(place..)?;
    if !own.starts_with(MEMBER) {
        return None;
    }
    let (name, extra) = (short(own, 26)?, short(own, 28)?);
    let data = own.get(MEMBER_HEAD + name + extra..)?;
    // Of a length in 64 bits these are all ones.
    let size = size.min(data.len());
    Some(Member {
        name: own.get(MEMBER_HEAD..MEMBER_HEAD + name)?,
        is_packed: method != 0,
        data: &data[..size],
    })
}

/// What the cells of an ods come to [B], repeated as it says.
pub(super) fn cells_of_ods(bytes: &[u8], most: u64) -> u64 {
    let Some(member) = members(bytes).find(|member| member.name == CONTENT) else {
        return 0;
    };
    let mut xml = Vec::new();
    let read = match member.is_packed {
        true => DeflateDecoder::new(member.data)
            .take(most)
            .read_to_end(&mut xml),
        false => member.data.take(most).read_to_end(&mut xml),
    };
    // As far as it can be unpacked.
    let _ = read;
    cells(&xml)
}

fn cells(xml: &[u8]) -> u64 {
    let (mut sum, mut rows, mut row, mut empty) = (0u64, 1, 0u64, 0u64);
    let tags = xml.split(|byte| *byte == b'<').skip(1);
    // Texts of the cell that was last.
    let (mut repeats, mut texts) = (0u64, 0u64);
    for tag in tags {
        if tag.starts_with(b"table:table-row") {
            rows = repeated(tag, b"table:number-rows-repeated");
            (row, empty, repeats, texts) = (0, 0, 0, 0);
        } else if tag.starts_with(b"/table:table-row") {
            row = row.saturating_add(repeats.saturating_mul(texts));
            // As they stand, and as they are repeated.
            sum = sum.saturating_add(row.saturating_mul(rows.saturating_add(1)));
            (repeats, texts) = (0, 0);
        } else if tag.starts_with(b"table:table-cell")
            || tag.starts_with(b"table:covered-table-cell")
        {
            row = row.saturating_add(repeats.saturating_mul(texts));
            let own = repeated(tag, b"table:number-columns-repeated");
            // Empty ones before others are made.
            let head = tag.split(|byte| *byte == b'>').next().unwrap_or(tag);
            let has = |key: &[u8]| head.windows(key.len()).any(|own| own == key);
            if has(b"office:") || has(b"table:formula") {
                row = row.saturating_add(CELL.saturating_mul(own.saturating_add(empty)));
                (repeats, texts, empty) = (own, tag.len() as u64, 0);
            } else {
                (repeats, texts, empty) = (0, 0, own);
            }
        } else {
            texts += tag.len() as u64;
        }
    }
    sum
}

/// How often a cell or a row is repeated, as far as a sheet goes.
fn repeated(tag: &[u8], key: &[u8]) -> u64 {
    const MOST: u64 = 1 << 20;
    let after = tag.windows(key.len()).position(|own| own == key);
    let Some(at) = after else {
        return 1;
    };
    let digits = tag[at + key.len()..]
        .iter()
        .skip_while(|byte| !byte.is_ascii_digit());
    let number = digits
        .take_while(|byte| byte.is_ascii_digit())
        .fold(0u64, |sum, digit| {
            sum.saturating_mul(10)
                .saturating_add(u64::from(digit - b'0'))
        });
    number.min(MOST)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cell_counts_as_often_as_it_is_repeated() {
        let cell = |columns: &str| {
            format!(
                "<table:table-cell office:value-type=\"float\" table:number-columns-repeated=\"{columns}\" office:value=\"1\"/>"
            )
        };
        let sheet = |rows: &str, cells: &str| {
            format!(
                "<table:table-row table:number-rows-repeated=\"{rows}\">{cells}</table:table-row>"
            )
        };
        let few = cells(sheet("1", &cell("3")).as_bytes());
        assert!((3 * CELL..10 * CELL + 1000).contains(&few), "{few}");
        let wide = cells(sheet("1000", &cell("16384")).as_bytes());
        assert!(wide > 16_384_000 * CELL, "{wide}");
        let trailing = "<table:table-cell table:number-columns-repeated=\"16380\"/>";
        let usual = cells(sheet("1048576", trailing).as_bytes());
        assert_eq!(usual, 0);
    }
}
