//! Text from files as a terminal may be sent it: what steers a terminal, or turns the order of letters, stands as an escape.
//!
//! An escape is written as JSON and TOML write one, `\u001b`: within a string of theirs it means the same letter, so that a document for programs is not changed.

use std::borrow::Cow;

/// Text on one line: the end of a line is an escape too.
#[must_use]
pub fn printable(text: &str) -> Cow<'_, str> {
    escaped(text, &[])
}

/// Text of several lines.
#[must_use]
pub fn printable_lines(text: &str) -> Cow<'_, str> {
    escaped(text, &['\n', '\t'])
}

/// Text of several lines in which this program has set colours; no other sequence is let through.
#[must_use]
pub fn printable_styled(text: &str) -> String {
    let mut parts = text.split('\x1b');
    let mut out = printable_lines(parts.next().unwrap_or_default()).into_owned();
    for part in parts {
        let digits = part.strip_prefix('[').and_then(|rest| rest.split_once('m'));
        let colour = digits.filter(|(digits, _)| {
            let is_digit = |letter: char| letter.is_ascii_digit() || letter == ';';
            digits.chars().all(is_digit)
        });
        out += &match colour {
            Some((digits, rest)) => format!("\x1b[{digits}m{}", printable_lines(rest)),
            None => format!("\\u001b{}", printable_lines(part)),
        };
    }
    out
}

/// Whether a letter acts on what stands around it: controls, ends of lines, marks and overrides of direction.
fn acts(letter: char) -> bool {
    letter.is_control()
        || matches!(letter, '\u{61c}' | '\u{200e}' | '\u{200f}' | '\u{2028}' | '\u{2029}'
            | '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}')
}

fn escaped<'a>(text: &'a str, kept: &[char]) -> Cow<'a, str> {
    let is_shown = |letter: char| kept.contains(&letter) || !acts(letter);
    if text.chars().all(is_shown) {
        return Cow::Borrowed(text);
    }
    let mut out = String::with_capacity(text.len() + 16);
    for letter in text.chars() {
        match letter {
            _ if is_shown(letter) => out.push(letter),
            '\n' => out += "\\n",
            '\r' => out += "\\r",
            '\t' => out += "\\t",
            _ => out += &format!("\\u{:04x}", u32::from(letter)),
        }
    }
    Cow::Owned(out)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_steers_a_terminal_is_shown_and_not_sent() {
        let hostile = "a\x1b]52;c;aGk=\x07b\u{9b}2J\u{202e}c\u{2066}\r\nd\x7f";
        assert_eq!(
            printable(hostile),
            "a\\u001b]52;c;aGk=\\u0007b\\u009b2J\\u202ec\\u2066\\r\\nd\\u007f"
        );
        assert_eq!(printable_lines("one\n\ttwo\x08"), "one\n\ttwo\\u0008");
        assert!(matches!(printable("Öl, 5 µm, 力"), Cow::Borrowed(_)));
    }

    #[test]
    fn of_sequences_colours_alone_are_let_through() {
        let styled = "\x1b[1;31mred\x1b[0m \x1b[2J\x1b]8;;x\x07\x1b";
        assert_eq!(
            printable_styled(styled),
            "\x1b[1;31mred\x1b[0m \\u001b[2J\\u001b]8;;x\\u0007\\u001b"
        );
    }

    #[test]
    fn a_document_for_programs_says_the_same_afterwards() {
        let name = "a\u{9b}b\u{202e}c\u{7f}";
        let json = serde_json::json!({ "name": name }).to_string();
        let shown = printable_lines(&json);
        assert_ne!(shown, json);
        let read: serde_json::Value = serde_json::from_str(&shown).unwrap();
        assert_eq!(read["name"], name);
    }
}
