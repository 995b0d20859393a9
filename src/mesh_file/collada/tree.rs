//! The XML tree of a COLLADA document: elements by name, targets by id, numbers.

use std::borrow::Cow;
use std::cell::Cell;
use std::collections::HashMap;

use roxmltree::{Document, Node};

use crate::mesh_file::scene::{Fault, MOST_POINTS, bounded};
use crate::mesh_file::text::{number, shown};
use crate::xml::Lines;

/// Times that the letters of a document may be read as numbers, on an average, and letters that always may: elements may name the same numbers again and again.
const MOST_TIMES: usize = 4;
const ALWAYS: usize = 16 << 20;

pub(super) struct Tree<'a> {
    document: &'a Document<'a>,
    /// Only looked up: the hash order cannot reach a result.
    by_id: HashMap<&'a str, Node<'a, 'a>>,
    lines: Lines,
    /// Letters that may yet be read as numbers.
    letters: Cell<usize>,
}

/// Whether an element has a name, in whatever namespace.
pub(super) fn is(node: Node, name: &str) -> bool {
    node.is_element() && node.tag_name().name() == name
}

/// The first child of a name.
pub(super) fn child<'a>(node: Node<'a, 'a>, name: &str) -> Option<Node<'a, 'a>> {
    node.children().find(|child| is(*child, name))
}

/// Children of a name.
pub(super) fn children<'a>(
    node: Node<'a, 'a>,
    name: &'a str,
) -> impl Iterator<Item = Node<'a, 'a>> {
    node.children().filter(move |child| is(*child, name))
}

impl<'a> Tree<'a> {
    pub(super) fn new(document: &'a Document<'a>) -> Result<Self, Fault> {
        let mut by_id = HashMap::new();
        for node in document.descendants() {
            if let Some(id) = node.attribute("id") {
                by_id.entry(id).or_insert(node);
            }
        }
        let text = document.input_text();
        let tree = Self {
            document,
            by_id,
            lines: Lines::of(text),
            letters: Cell::new(MOST_TIMES * text.len() + ALWAYS),
        };
        if is(tree.root(), "COLLADA") {
            return Ok(tree);
        }
        Err(Fault::malformed(format!(
            "its XML is a <{}>, expected <COLLADA>",
            tree.root().tag_name().name()
        )))
    }

    pub(super) fn root(&self) -> Node<'a, 'a> {
        self.document.root_element()
    }

    pub(super) fn line(&self, node: Node) -> u32 {
        self.lines.at(node.range().start)
    }

    /// A fault at an element.
    pub(super) fn fault(&self, node: Node, reason: impl std::fmt::Display) -> Fault {
        Fault::malformed(format!(
            "line {}, <{}>: {reason}",
            self.line(node),
            node.tag_name().name()
        ))
    }

    /// The element that an attribute names as `#id`.
    pub(super) fn target(
        &self,
        node: Node<'a, 'a>,
        attribute: &str,
        name: &str,
    ) -> Result<Node<'a, 'a>, Fault> {
        let url = node.attribute(attribute).unwrap_or_default().trim();
        let Some(id) = url.strip_prefix('#') else {
            return Err(match url {
                "" => self.fault(node, format!("it has no {attribute}")),
                _ => Fault::unsupported(
                    format!(
                        "line {}: <{}> of another document ({})",
                        self.line(node),
                        node.tag_name().name(),
                        shown(url)
                    ),
                    "export the scene as one file",
                ),
            });
        };
        let found = self.by_id.get(id).copied().filter(|found| is(*found, name));
        found.ok_or_else(|| {
            self.fault(
                node,
                format!("there is no <{name}> with the id `{}`", shown(id)),
            )
        })
    }

    /// An element's numbers.
    pub(super) fn numbers(&self, node: Node<'a, 'a>) -> Result<Vec<f64>, Fault> {
        let text = self.text(node)?;
        let words = text.split_ascii_whitespace();
        let numbers = words
            .take(3 * MOST_POINTS + 3)
            .map(|word| number(word).map_err(|reason| self.fault(node, reason)))
            .collect::<Result<Vec<f64>, Fault>>()?;
        bounded(0, numbers.len() / 3)?;
        Ok(numbers)
    }

    /// An element's indices.
    pub(super) fn indices(&self, node: Node<'a, 'a>) -> Result<Vec<u32>, Fault> {
        let text = self.text(node)?;
        let index = |word: &str| {
            word.parse().map_err(|_| {
                self.fault(
                    node,
                    format!(
                        "`{}` is no index, expected a whole number from 0",
                        shown(word)
                    ),
                )
            })
        };
        text.split_ascii_whitespace().map(index).collect()
    }

    /// An element's text, also where a comment stands within.
    fn text(&self, node: Node<'a, 'a>) -> Result<Cow<'a, str>, Fault> {
        let texts = node
            .children()
            .filter(Node::is_text)
            .filter_map(|text| text.text());
        let text = match texts.collect::<Vec<_>>()[..] {
            [only] => Cow::Borrowed(only),
            ref several => Cow::Owned(several.concat()),
        };
        // Also of an element without text, which is looked at all the same.
        match self.letters.get().checked_sub(text.len() + 16) {
            Some(left) => {
                self.letters.set(left);
                Ok(text)
            }
            None => Err(Fault::unsupported(
                "a scene that names the same numbers again and again",
                "export a simpler one",
            )),
        }
    }
}
