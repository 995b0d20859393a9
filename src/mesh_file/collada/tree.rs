//! The XML tree of a COLLADA document: elements by name, targets by id, numbers.

use std::collections::HashMap;

use roxmltree::{Document, Node};

use crate::mesh_file::scene::Fault;
use crate::mesh_file::text::number;

/// Levels of elements in elements; deeper ones are no scene that a program has written.
const DEEPEST: usize = 400;

pub(super) struct Tree<'a> {
    document: &'a Document<'a>,
    /// Only looked up: the hash order cannot reach a result.
    by_id: HashMap<&'a str, Node<'a, 'a>>,
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

/// The parser goes one level deeper into the stack with each element: so deep ones are refused before.
pub(super) fn checked_depth(text: &str) -> Result<(), Fault> {
    let mut depth = 0_usize;
    let mut rest = text;
    while let Some(place) = rest.find('<') {
        rest = &rest[place..];
        let end = match rest {
            _ if rest.starts_with("<!--") => "-->",
            _ if rest.starts_with("<![CDATA[") => "]]>",
            _ => ">",
        };
        let length = rest.find(end).map_or(rest.len(), |found| found + end.len());
        let tag = &rest[..length];
        if tag.starts_with("</") {
            depth = depth.saturating_sub(1);
        } else if !tag.starts_with("<!") && !tag.starts_with("<?") && !tag.ends_with("/>") {
            depth += 1;
        }
        if depth > DEEPEST {
            return Err(Fault::malformed(format!(
                "its elements lie more than {DEEPEST} deep in each other"
            )));
        }
        rest = &rest[length..];
    }
    Ok(())
}

impl<'a> Tree<'a> {
    pub(super) fn new(document: &'a Document<'a>) -> Result<Self, Fault> {
        let mut by_id = HashMap::new();
        for node in document.descendants() {
            if let Some(id) = node.attribute("id") {
                by_id.entry(id).or_insert(node);
            }
        }
        let tree = Self { document, by_id };
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
        self.document.text_pos_at(node.range().start).row
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
                        "line {}: <{}> of another document ({url})",
                        self.line(node),
                        node.tag_name().name()
                    ),
                    "export the scene as one file",
                ),
            });
        };
        let found = self.by_id.get(id).copied().filter(|found| is(*found, name));
        found.ok_or_else(|| self.fault(node, format!("there is no <{name}> with the id `{id}`")))
    }

    /// An element's numbers.
    pub(super) fn numbers(&self, node: Node) -> Result<Vec<f64>, Fault> {
        let text = whole_text(node);
        let words = text.split_ascii_whitespace();
        words
            .map(|word| number(word).map_err(|reason| self.fault(node, reason)))
            .collect()
    }

    /// An element's indices.
    pub(super) fn indices(&self, node: Node) -> Result<Vec<u32>, Fault> {
        let text = whole_text(node);
        let index = |word: &str| {
            word.parse().map_err(|_| {
                self.fault(
                    node,
                    format!("`{word}` is no index, expected a whole number from 0"),
                )
            })
        };
        text.split_ascii_whitespace().map(index).collect()
    }
}

/// An element's text, also where a comment stands within.
fn whole_text(node: Node) -> String {
    let texts = node
        .children()
        .filter(Node::is_text)
        .filter_map(|text| text.text());
    texts.collect::<Vec<_>>().join("")
}
