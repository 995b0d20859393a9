//! Changes of a text by its words and lines.

use std::ops::Range;

/// Numbers that readers may stumble over.
const NUMBERS: [&str; 12] = [
    "0",
    "-1",
    "1",
    "-0.0",
    "0.5",
    "1e308",
    "-1e308",
    "1e-320",
    "2147483648",
    "4294967295",
    "99999999999",
    "1.5e3",
];
/// Words and marks.
const ODD: [&str; 10] = [
    "nan",
    "inf",
    "",
    "true",
    "18446744073709551616",
    "[]",
    "{}",
    "../",
    "\u{fc}",
    "\"\"",
];

/// Xorshift: the same changes for the same seed.
pub struct Random(u64);

impl Random {
    pub fn new(seed: u32) -> Self {
        Self(u64::from(seed) << 16 | 0x9e37)
    }

    /// A number from 0 to below `count`, which is not 0.
    pub fn below(&mut self, count: usize) -> usize {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 11) as usize % count
    }
}

/// The text after one change.
pub fn changed(text: &[u8], random: &mut Random) -> Vec<u8> {
    let (words, pieces) = (words(text), pieces(text));
    if words.is_empty() {
        return [text, ODD[random.below(ODD.len())].as_bytes()].concat();
    }
    let word = words[random.below(words.len())].clone();
    let is_number =
        |word: &Range<usize>| text[word.start].is_ascii_digit() || text[word.start] == b'-';
    // A number by a number, a word by a word of the same text: most texts stay of their format.
    let alike: Vec<&Range<usize>> = words
        .iter()
        .filter(|other| is_number(other) == is_number(&word))
        .collect();
    let other = alike[random.below(alike.len())].clone();
    let odd = ODD[random.below(ODD.len())].as_bytes();
    let kind = random.below(16);
    if (10..15).contains(&kind) && !pieces.is_empty() {
        let [piece, another] = [0; 2].map(|_| pieces[random.below(pieces.len())].clone());
        return match kind {
            10 | 11 => replaced(text, piece.start..piece.start, &text[another]),
            _ => replaced(text, piece, b""),
        };
    }
    match kind {
        0..=5 if is_number(&word) => {
            replaced(text, word, NUMBERS[random.below(NUMBERS.len())].as_bytes())
        }
        9 => replaced(text, word, odd),
        15 => {
            let length = (1 + random.below(24)).min(text.len() - word.start);
            let piece = text[word.start..word.start + length].repeat(1 + random.below(40));
            replaced(text, word.start..word.start, &piece)
        }
        _ => replaced(text, word, &text[other]),
    }
}

fn replaced(text: &[u8], part: Range<usize>, by: &[u8]) -> Vec<u8> {
    [&text[..part.start], by, &text[part.end..]].concat()
}

/// Words and numbers; in XML none that is an element's name, of which there are two.
fn words(text: &[u8]) -> Vec<Range<usize>> {
    let mut found = parts(text, |byte| {
        byte.is_ascii_alphanumeric() || b"_.+-".contains(&byte)
    });
    found.retain(|word| word.start == 0 || !b"</".contains(&text[word.start - 1]));
    found
}

/// What can be left out or stand twice: lines; in XML empty elements, in JSON nothing.
fn pieces(text: &[u8]) -> Vec<Range<usize>> {
    let is_xml = text.trim_ascii_start().starts_with(b"<");
    if text.trim_ascii_start().starts_with(b"{") {
        return Vec::new();
    }
    let mut start = 0;
    let mut found = Vec::new();
    for (at, byte) in text.iter().enumerate() {
        match byte {
            b'<' if is_xml => start = at,
            b'>' if is_xml && text[..at].ends_with(b"/") => found.push(start..at + 1),
            b'\n' if !is_xml => {
                found.push(start..at + 1);
                start = at + 1;
            }
            _ => {}
        }
    }
    found
}

fn parts(text: &[u8], is_in: impl Fn(u8) -> bool) -> Vec<Range<usize>> {
    let mut found: Vec<Range<usize>> = Vec::new();
    for (at, byte) in text.iter().enumerate() {
        match found.last_mut() {
            _ if !is_in(*byte) => {}
            Some(last) if last.end == at => last.end += 1,
            _ => found.push(at..at + 1),
        }
    }
    found
}
