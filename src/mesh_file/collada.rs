//! COLLADA 1.4 and 1.5: the scene with its nodes, instances and transforms, over the XML tree of `roxmltree`.

mod geometry;
mod material;
mod tree;
mod walk;

use glam::DMat4;

use self::tree::{Tree, is};
use self::walk::Walk;
use super::scene::{Assembly, Fault, MeshFile, Up};
use super::text::{decoded, number, shown};
use crate::xml;

pub(super) fn parse(bytes: &[u8]) -> Result<MeshFile, Fault> {
    let text = decoded(bytes);
    let text = text.trim_start();
    xml::check(text).map_err(|excess| Fault::at_line(excess.line as usize, excess))?;
    let options = roxmltree::ParsingOptions {
        allow_dtd: true,
        ..roxmltree::ParsingOptions::default()
    };
    let document = roxmltree::Document::parse_with_options(text, options)
        .map_err(|error| Fault::malformed(format!("its XML: {error}")))?;
    let tree = Tree::new(&document)?;
    let asset = asset(&tree)?;
    let mut assembly = Assembly::new(MeshFile {
        in_metres: true,
        up: asset.up,
        notes: asset.note.into_iter().collect(),
        ..MeshFile::unitless(Vec::new())
    });
    let unit = DMat4::from_scale(glam::DVec3::splat(asset.metre));
    let mut walk = Walk::new(&tree);
    match scene(&tree)? {
        Some(scene) => walk.children(scene, unit, &mut assembly)?,
        None => walk.all_geometries(unit, &mut assembly)?,
    }
    let mut file = assembly.file;
    if walk.bent > 0 {
        file.notes.push(format!(
            "{} of its faces are not plane: they were split where they fold the least",
            walk.bent
        ));
    }
    file.doubtful = walk.doubtful;
    Ok(file)
}

/// What the document says of its unit and axes.
struct Asset {
    /// Length of its unit [m].
    metre: f64,
    up: Up,
    note: Option<String>,
}

fn asset(tree: &Tree) -> Result<Asset, Fault> {
    let root = tree.root();
    let of = |element: roxmltree::Node| -> Result<(f64, Up), Fault> {
        let asset = tree::child(element, "asset");
        let unit = asset.and_then(|asset| tree::child(asset, "unit"));
        let metre = match unit.and_then(|unit| unit.attribute("meter")) {
            None => 1.0,
            Some(text) => match number(text.trim()) {
                Ok(value) if value.is_finite() && value > 0.0 => value,
                _ => {
                    return Err(tree.fault(
                        element,
                        format!(
                            "its unit is `{}` metres, expected a positive number",
                            shown(text)
                        ),
                    ));
                }
            },
        };
        let up = asset
            .and_then(|asset| tree::child(asset, "up_axis"))
            .and_then(|up| up.text());
        let up = match up.map(str::trim) {
            Some("X_UP") => Up::X,
            None | Some("Y_UP") => Up::Y,
            Some("Z_UP") => Up::Z,
            Some(other) => {
                return Err(tree.fault(
                    element,
                    format!(
                        "its up_axis is `{}`, expected X_UP, Y_UP or Z_UP",
                        shown(other)
                    ),
                ));
            }
        };
        Ok((metre, up))
    };
    let (metre, up) = of(root)?;
    // An asset of a library, a geometry or a node may have a unit and axes of its own.
    for inner in root
        .descendants()
        .filter(|node| *node != root && tree::child(*node, "asset").is_some())
    {
        let asset = tree::child(inner, "asset");
        let stated = |name| asset.and_then(|asset| tree::child(asset, name)).is_some();
        let own = of(inner)?;
        if (stated("unit") && (own.0 - metre).abs() > 1e-12 * metre)
            || (stated("up_axis") && own.1 != up)
        {
            return Err(Fault::unsupported(
                format!(
                    "line {}: a unit or an up_axis of <{}> that is not the document's",
                    tree.line(inner),
                    inner.tag_name().name()
                ),
                "export the scene with one unit and one up axis",
            ));
        }
    }
    let said = tree::child(root, "asset")
        .and_then(|asset| tree::child(asset, "unit"))
        .is_some();
    let note = (!said).then(|| "it states no unit: metres, as COLLADA has it then".to_owned());
    Ok(Asset { metre, up, note })
}

/// The visual scene that is shown; none where the document has none.
fn scene<'a>(tree: &Tree<'a>) -> Result<Option<roxmltree::Node<'a, 'a>>, Fault> {
    let instance = tree::child(tree.root(), "scene")
        .and_then(|scene| tree::child(scene, "instance_visual_scene"));
    if let Some(instance) = instance {
        return tree.target(instance, "url", "visual_scene").map(Some);
    }
    let all: Vec<_> = tree
        .root()
        .descendants()
        .filter(|node| is(*node, "visual_scene"))
        .collect();
    match all[..] {
        [] => Ok(None),
        [only] => Ok(Some(only)),
        _ => Err(Fault::unsupported(
            format!(
                "a document of {} visual scenes that says not which is shown (<scene>)",
                all.len()
            ),
            "export one scene",
        )),
    }
}
