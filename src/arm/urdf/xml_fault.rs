//! Faults of XML in words: the line, and the link or joint in which it stands.

use roxmltree::{Error, TextPos};

use super::walk::Fault;

/// An element that is open at some place.
struct Open<'a> {
    name: &'a str,
    /// Its attribute `name`, if it has one.
    own: Option<&'a str>,
    line: u32,
}

/// The fault of a text that is no XML.
pub(super) fn in_words(text: &str, error: &Error) -> Fault {
    let TextPos { row, col } = match error {
        // Of these the reader says no place.
        Error::UnclosedRootNode | Error::UnexpectedEndOfStream => {
            TextPos::new(1 + lines_in(text.trim_end()), u32::MAX)
        }
        other => other.pos(),
    };
    let before = up_to(text, row, col);
    let open = open_elements(before);
    let within = open
        .iter()
        .rev()
        .find(|element| element.own.is_some() && ["link", "joint"].contains(&element.name));
    let within = within.map_or(String::new(), |element| {
        format!(
            "{} `{}` (begun on line {}): ",
            element.name,
            element.own.unwrap_or_default(),
            element.line
        )
    });
    let words = match error {
        Error::UnexpectedCloseTag(expected, actual, _) => {
            let begun = open.iter().rev().find(|element| element.name == expected);
            let begun = begun.map_or(String::new(), |element| {
                format!(", which was begun on line {}", element.line)
            });
            format!("</{actual}> stands where <{expected}>{begun}, is to be closed first")
        }
        Error::UnclosedRootNode | Error::UnexpectedEndOfStream => match open.last() {
            Some(element) => format!(
                "the file ends, and <{}> of line {} is not closed",
                element.name, element.line
            ),
            None => "the file ends too early".to_owned(),
        },
        Error::DuplicatedAttribute(name, _) => format!("the attribute {name} is given twice"),
        Error::UnknownNamespace(prefix, _) => {
            format!("the prefix `{prefix}:` is not declared by xmlns:{prefix}")
        }
        Error::InvalidAttributeValue(_) => {
            "an attribute's value holds a `<`: a quotation mark is missing before it".to_owned()
        }
        Error::InvalidChar2(expected, found, _) => {
            format!("found {:?}, expected {expected}", char::from(*found))
        }
        Error::InvalidChar(found, expected, _) => format!(
            "found {:?}, expected {:?}",
            char::from(*expected),
            char::from(*found)
        ),
        Error::InvalidName(_) => "a name holds a letter that XML does not take".to_owned(),
        Error::DtdDetected => {
            "it has a document type definition (<!DOCTYPE), which URDF files do not".to_owned()
        }
        Error::NoRootNode => "it has no <robot> element".to_owned(),
        other => {
            // The reader's own words, without the place that stands before them already.
            let said = other.to_string();
            let location = format!(" at {row}:{col}");
            said.replace(&location, "")
        }
    };
    Fault {
        line: row,
        words: format!("{within}{words}"),
        xacro: false,
    }
}

/// The text before a line and column.
fn up_to(text: &str, row: u32, col: u32) -> &str {
    let mut start = 0;
    for _ in 1..row {
        match text[start..].find('\n') {
            Some(at) => start += at + 1,
            None => return text,
        }
    }
    let line = &text[start..];
    let width = line
        .char_indices()
        .nth(col.saturating_sub(1) as usize)
        .map_or(line.len(), |(at, _)| at);
    &text[..start + width]
}

/// The elements that a text leaves open, outermost first.
fn open_elements(text: &str) -> Vec<Open<'_>> {
    let mut open: Vec<Open> = Vec::new();
    let (mut at, mut line) = (0, 1);
    while let Some(found) = text[at..].find('<') {
        line += lines_in(&text[at..at + found]);
        at += found;
        let rest = &text[at..];
        let (end, is_markup) = if rest.starts_with("<!--") {
            (rest.find("-->").map(|end| end + 3), false)
        } else if rest.starts_with("<![CDATA[") {
            (rest.find("]]>").map(|end| end + 3), false)
        } else {
            let plain = !rest.starts_with("<?") && !rest.starts_with("<!");
            (rest.find('>').map(|end| end + 1), plain)
        };
        let tag = &rest[..end.unwrap_or(rest.len())];
        if is_markup {
            let inner = tag.trim_start_matches('<').trim_end_matches('>');
            if let Some(name) = inner.strip_prefix('/') {
                if open.last().is_some_and(|last| last.name == name.trim()) {
                    open.pop();
                }
            } else if !inner.ends_with('/') {
                let name = inner.split(|c: char| c.is_whitespace()).next();
                open.push(Open {
                    name: name.unwrap_or_default(),
                    own: attribute(inner, "name"),
                    line,
                });
            }
        }
        line += lines_in(tag);
        at += tag.len();
    }
    open
}

fn lines_in(text: &str) -> u32 {
    text.matches('\n').count() as u32
}

/// Value of an attribute of a tag, as far as it can be read.
fn attribute<'a>(tag: &'a str, name: &str) -> Option<&'a str> {
    let at = tag.find(&format!(" {name}="))? + name.len() + 2;
    let quote = tag[at..].chars().next().filter(|c| "\"'".contains(*c))?;
    let value = &tag[at + 1..];
    Some(&value[..value.find(quote)?])
}
