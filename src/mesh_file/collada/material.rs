//! The colour of a COLLADA material: the diffuse one of its effect.

use roxmltree::Node;

use super::tree::{Tree, child, is};

/// The colour that an instance binds to a symbol; none where it has a texture, or nothing.
pub(super) fn colour<'a>(
    tree: &Tree<'a>,
    instance: Node<'a, 'a>,
    symbol: &str,
) -> Option<[f64; 4]> {
    let bound = instance
        .descendants()
        .find(|node| is(*node, "instance_material") && node.attribute("symbol") == Some(symbol))?;
    let material = tree.target(bound, "target", "material").ok()?;
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
