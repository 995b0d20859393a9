//! XML within limits: memory and stack are bounded by the file, not by what it claims.
//!
//! ```text
//! depth <= 400, attributes of an element <= 200, elements and marks <= 2 000 000, no entities of its own
//! ```
//!
//! Programs write URDF and COLLADA with a hundredth of that. An entity of a document's own is read as often as it is named, so that few letters come to
//! any number of them.

mod lines;

pub use lines::Lines;

/// Letters of a file's word that a message shows.
const SHOWN: usize = 60;

/// A word as a message shows it: of a long one the beginning.
#[must_use]
pub fn shown(word: &str) -> String {
    match word.char_indices().nth(SHOWN) {
        Some((end, _)) => format!("{}..", &word[..end]),
        None => word.to_owned(),
    }
}

/// Levels of elements in elements.
const DEEPEST: usize = 400;
/// Attributes of one element: each is compared with all before it.
const MOST_ATTRIBUTES: usize = 200;
/// Elements, comments and other marks of a document; each takes some 100 bytes in memory.
const MOST_MARKS: usize = 2_000_000;

/// A document that is refused before it is parsed.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{reason}")]
pub struct Excess {
    /// Line, from 1.
    pub line: u32,
    /// In words.
    pub reason: String,
}

/// Checks a text before it is parsed.
///
/// # Errors
/// It goes beyond one of the limits.
pub fn check(text: &str) -> Result<(), Excess> {
    let (mut at, mut depth, mut marks) = (0, 0_usize, 0_usize);
    while let Some(found) = text[at..].find('<') {
        at += found;
        marks += 1;
        let refuse = |reason: String| Err(excess(text, at, reason));
        if marks > MOST_MARKS {
            return refuse(format!(
                "it has more than {MOST_MARKS} elements and comments, expected fewer: export a simpler one"
            ));
        }
        let rest = &text[at..];
        let mark = mark(rest);
        match mark.kind {
            Kind::Open { attributes } => {
                depth += 1;
                if attributes > MOST_ATTRIBUTES {
                    return refuse(format!(
                        "an element has {attributes} attributes, expected at most {MOST_ATTRIBUTES}"
                    ));
                }
                if depth > DEEPEST {
                    return refuse(format!(
                        "its elements lie more than {DEEPEST} deep in each other"
                    ));
                }
                depth -= usize::from(rest[..mark.length].ends_with("/>"));
            }
            Kind::Close => depth = depth.saturating_sub(1),
            Kind::Definitions => {
                if rest[..mark.length].contains("<!ENTITY") {
                    return refuse(
                        "it defines entities of its own (<!ENTITY), which are not read: write what they stand for in their place"
                            .to_owned(),
                    );
                }
            }
            Kind::Other => {}
        }
        at += mark.length;
    }
    Ok(())
}

fn excess(text: &str, at: usize, reason: String) -> Excess {
    Excess {
        line: Lines::of(&text[..at]).last(),
        reason,
    }
}

enum Kind {
    Open {
        attributes: usize,
    },
    Close,
    /// `<!DOCTYPE ..>` with what it defines.
    Definitions,
    Other,
}

/// What begins at a `<`, and its length.
struct Mark {
    kind: Kind,
    length: usize,
}

fn mark(rest: &str) -> Mark {
    let up_to = |end: &str| rest.find(end).map_or(rest.len(), |at| at + end.len());
    let other = |length| Mark {
        kind: Kind::Other,
        length,
    };
    match rest {
        _ if rest.starts_with("<!--") => other(up_to("-->")),
        _ if rest.starts_with("<![CDATA[") => other(up_to("]]>")),
        _ if rest.starts_with("<?") => other(up_to("?>")),
        _ if rest.starts_with("<!DOCTYPE") => Mark {
            kind: Kind::Definitions,
            length: definitions(rest),
        },
        _ if rest.starts_with("</") => Mark {
            kind: Kind::Close,
            length: up_to(">"),
        },
        _ => tag(rest),
    }
}

/// A tag that opens an element: a `>` within an attribute's value does not end it.
fn tag(rest: &str) -> Mark {
    let (mut quote, mut attributes) = (None, 0);
    let mut length = rest.len();
    for (at, byte) in rest.bytes().enumerate() {
        match (quote, byte) {
            (Some(open), byte) if byte == open => quote = None,
            // No value may hold it: what follows is a tag of its own.
            (_, b'<') if at > 0 => {
                length = at;
                break;
            }
            (Some(_), _) => {}
            (None, b'"' | b'\'') => quote = Some(byte),
            (None, b'=') => attributes += 1,
            (None, b'>') => {
                length = at + 1;
                break;
            }
            (None, _) => {}
        }
    }
    Mark {
        kind: Kind::Open { attributes },
        length,
    }
}

/// Length of a document type with the definitions in its brackets.
fn definitions(rest: &str) -> usize {
    let (mut quote, mut in_brackets) = (None, false);
    for (at, byte) in rest.bytes().enumerate() {
        match (quote, byte) {
            (Some(open), byte) if byte == open => quote = None,
            (Some(_), _) => {}
            (None, b'"' | b'\'') => quote = Some(byte),
            (None, b'[') => in_brackets = true,
            (None, b']') => in_brackets = false,
            (None, b'>') if !in_brackets => return at + 1,
            (None, _) => {}
        }
    }
    rest.len()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn refusal(text: &str) -> String {
        check(text).unwrap_err().reason
    }

    #[test]
    fn depth_is_counted_whatever_values_and_comments_hold() {
        let nested = |count: usize, tag: &str| {
            format!("<r>{}{}</r>", tag.repeat(count), "</a>".repeat(count))
        };
        for tag in [
            "<a>",
            "<a b=\"/>\">",
            "<a b = \">\" c='\"'>",
            "<!-- </a> --><a>",
            "<![CDATA[</a></a>]]><a>",
            "<?p </a> ?><a>",
        ] {
            assert_eq!(check(&nested(DEEPEST - 1, tag)), Ok(()), "{tag}");
            assert!(refusal(&nested(DEEPEST * 3, tag)).contains("deep"), "{tag}");
        }
        assert_eq!(check(&"<a b=\"1\"/>".repeat(5000)), Ok(()));
        assert_eq!(check(&format!("<r>{}</r>", "<a></a>".repeat(5000))), Ok(()));
    }

    #[test]
    fn attributes_elements_and_entities_are_bounded_and_the_line_is_said() {
        let attributes = |count: usize| -> String {
            let own: String = (0..count).map(|i| format!(" a{i}=\"=\"")).collect();
            format!("<r>\n<a{own}/></r>")
        };
        assert_eq!(check(&attributes(MOST_ATTRIBUTES)), Ok(()));
        let refused = check(&attributes(MOST_ATTRIBUTES + 1)).unwrap_err();
        assert_eq!(refused.line, 2);
        assert!(refused.reason.contains("201 attributes"), "{refused}");
        assert!(refusal(&"<a/>".repeat(MOST_MARKS + 1)).contains("2000000 elements"));
        let entities = "<!DOCTYPE r [ <!ELEMENT r ANY> <!ENTITY a \">]&b;\"> ]><r>&a;</r>";
        assert!(refusal(entities).contains("<!ENTITY"));
        assert_eq!(check("<!DOCTYPE r SYSTEM \"r[.dtd\"><r/>"), Ok(()));
    }
}
