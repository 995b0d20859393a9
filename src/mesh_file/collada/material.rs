//! The colour of a COLLADA material: the diffuse one of its effect.

use roxmltree::Node;

use super::tree::{Tree, child, is};

/// The material that an instance binds to a symbol.
pub(super) fn material<'a>(
    tree: &Tree<'a>,
    instance: Node<'a, 'a>,
    symbol: &str,
) -> Option<Node<'a, 'a>> {
    let bound = instance
        .descendants()
        .find(|node| is(*node, "instance_material") && node.attribute("symbol") == Some(symbol))?;
    tree.target(bound, "target", "material").ok()
}

/// The colour of a material; none where it has a texture, or nothing.
pub(super) fn colour<'a>(tree: &Tree<'a>, material: Node<'a, 'a>) -> Option<[f64; 4]> {
    let effect = tree
        .target(child(material, "instance_effect")?, "url", "effect")
        .ok()?;
    let diffuse = effect.descendants().find(|node| is(*node, "diffuse"))?;
    let numbers = tree.numbers(child(diffuse, "color")?).ok()?;
    match numbers[..] {
        [red, green, blue] => Some([red, green, blue, 1.0]),
        [red, green, blue, opacity, ..] => Some([red, green, blue, opacity]),
        _ => None,
    }
}
