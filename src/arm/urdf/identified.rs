//! A URDF file with numbers that were identified in place of its own; all else of its text stays as it is.

use std::ops::Range;
use std::path::Path;

use glam::DVec3;
use roxmltree::{Document, Node};

use super::source::Source;
use super::tree::Tree;
use super::{ArmError, ArmOptions, MAX_JOINTS, refused};

/// What was identified of a joint and of the link behind it, with all that is fixed to that.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Identified {
    /// Mass over that of the file; inertia tensors go with it [1].
    pub mass_ratio: f64,
    /// By how much the centre of mass lies elsewhere, in the moving link's frame [m].
    pub shift: DVec3,
    /// Viscous damping [N m s/rad or N s/m].
    pub damping: f64,
    /// Dry friction [N m or N].
    pub friction: f64,
}

/// Parts of a text, and what takes their place.
type Edits = Vec<(Range<usize>, String)>;

/// Text of the file at `path` with what was identified of each moving joint, base first; none of a file of macros, which states its numbers elsewhere.
///
/// # Errors
/// As [`super::load_arm`].
pub fn identified_urdf(
    path: &Path,
    options: &ArmOptions,
    found: &[Identified],
) -> Result<Option<String>, ArmError> {
    let source = Source::read(path)?;
    let Ok(text) = crate::file::read_text(path) else {
        return Ok(None);
    };
    let Ok(document) = Document::parse(&text) else {
        return Ok(None);
    };
    let base = options.base_link.as_deref();
    let tree = Tree::build(
        &source.robot,
        base,
        &options.tip_link,
        1..=MAX_JOINTS,
        &mut Vec::new(),
    )
    .map_err(|refusal| refused(path, &source, refusal))?;
    let root = document.root_element();
    let named = |kind: &str, name: &str| {
        let mut own = root.children();
        own.find(|node| node.has_tag_name(kind) && node.attribute("name") == Some(name))
    };
    let mut edits = Edits::new();
    for placed in tree.placed.iter().filter(|placed| placed.link_index > 0) {
        let own = &found[placed.link_index - 1];
        let unchanged = own.mass_ratio == 1.0 && own.shift == DVec3::ZERO;
        if let Some(link) = named("link", &placed.link.name)
            && let Some(inertial) = child(link, "inertial")
            && !unchanged
        {
            let shift = placed.moving_from_link.rotation.inverse() * own.shift;
            of_inertial(inertial, own.mass_ratio, shift, &mut edits);
        }
    }
    for (joint, own) in tree.path_joints().zip(found) {
        if let Some(node) = named("joint", &joint.name) {
            of_joint(node, own, &text, &mut edits);
        }
    }
    Ok(Some(edited(&text, edits)))
}

fn child<'a, 'i>(node: Node<'a, 'i>, name: &str) -> Option<Node<'a, 'i>> {
    node.children().find(|node| node.has_tag_name(name))
}

/// Number as it is written: without what rounding adds.
fn written(value: f64) -> String {
    let rounded: f64 = format!("{value:.9e}").parse().unwrap_or(value);
    rounded.to_string()
}

fn put(node: Node, name: &str, value: &str, edits: &mut Edits) {
    let known = node.attributes().find(|attribute| attribute.name() == name);
    match known {
        Some(attribute) => edits.push((attribute.range(), format!("{name}=\"{value}\""))),
        None => {
            let after = node.range().start + 1 + node.tag_name().name().len();
            edits.push((after..after, format!(" {name}=\"{value}\"")));
        }
    }
}

fn of_inertial(inertial: Node, ratio: f64, shift: DVec3, edits: &mut Edits) {
    let number =
        |node: Node, name: &str| -> Option<f64> { node.attribute(name)?.trim().parse().ok() };
    if let Some(mass) = child(inertial, "mass")
        && let Some(value) = number(mass, "value")
    {
        put(mass, "value", &written(ratio * value), edits);
    }
    if let Some(inertia) = child(inertial, "inertia") {
        for name in ["ixx", "ixy", "ixz", "iyy", "iyz", "izz"] {
            if let Some(value) = number(inertia, name).filter(|value| *value != 0.0) {
                put(inertia, name, &written(ratio * value), edits);
            }
        }
    }
    if shift == DVec3::ZERO {
        return;
    }
    let moved = |old: DVec3| {
        let centre = (old + shift).to_array().map(written);
        centre.join(" ")
    };
    match child(inertial, "origin") {
        Some(origin) => {
            let words = origin.attribute("xyz").unwrap_or("").split_whitespace();
            let old: Vec<f64> = words.filter_map(|word| word.parse().ok()).collect();
            let old = <[f64; 3]>::try_from(old).map_or(DVec3::ZERO, DVec3::from_array);
            put(origin, "xyz", &moved(old), edits);
        }
        None => {
            let after = inertial.range().start + "<inertial>".len();
            let origin = format!("<origin xyz=\"{}\"/>", moved(DVec3::ZERO));
            edits.push((after..after, origin));
        }
    }
}

fn of_joint(joint: Node, own: &Identified, text: &str, edits: &mut Edits) {
    let numbers = [("damping", own.damping), ("friction", own.friction)];
    if let Some(dynamics) = child(joint, "dynamics") {
        for (name, value) in numbers {
            put(dynamics, name, &written(value), edits);
        }
        return;
    }
    let range = joint.range();
    if let Some(end) = text[range.clone()].rfind("</") {
        let at = range.start + end;
        let [damping, friction] = numbers.map(|(_, value)| written(value));
        let dynamics = format!("<dynamics damping=\"{damping}\" friction=\"{friction}\"/>");
        edits.push((at..at, dynamics));
    }
}

fn edited(text: &str, mut edits: Edits) -> String {
    edits.sort_by_key(|(range, _)| (range.start, range.end));
    let mut out = String::with_capacity(text.len());
    let mut end = 0;
    for (range, new) in edits {
        out += &text[end..range.start];
        out += &new;
        end = range.end;
    }
    out + &text[end..]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::arm::load_arm;

    const URDF: &str = r#"<robot name="one">
  <link name="base"/>
  <link name="arm"><inertial><origin xyz="0.1 0 0.2"/><mass value="4"/><inertia ixx="0.2" iyy="0.3" izz="0.25" ixy="0.01" ixz="0" iyz="0"/></inertial></link>
  <link name="hand"><inertial><mass value="1"/><inertia ixx="0.01" iyy="0.01" izz="0.01" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <joint name="turn" type="continuous"><parent link="base"/><child link="arm"/><axis xyz="0 0 1"/><!-- stays --></joint>
  <joint name="fixed" type="fixed"><parent link="arm"/><child link="hand"/><origin xyz="0 0 0.5" rpy="1.2 0.3 -0.4"/></joint>
</robot>"#;

    #[test]
    fn the_arm_of_the_identified_file_has_the_identified_numbers() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("one.urdf");
        std::fs::write(&path, URDF).unwrap();
        let options = ArmOptions {
            tip_link: "hand".to_owned(),
            skip_visuals: true,
            is_recorded: true,
            ..ArmOptions::default()
        };
        let before = load_arm(&path, &options).unwrap().chain.joints[0].body;
        let own = Identified {
            mass_ratio: 1.1,
            shift: DVec3::new(0.01, -0.02, 0.03),
            damping: 12.5,
            friction: 7.25,
        };
        let text = identified_urdf(&path, &options, &[own]).unwrap().unwrap();
        assert!(text.contains("<!-- stays -->"), "{text}");
        std::fs::write(&path, &text).unwrap();
        let joint = load_arm(&path, &options).unwrap().chain.joints.remove(0);
        assert_eq!((joint.damping, joint.friction), (12.5, 7.25));
        let after = joint.body;
        assert!((after.mass - 1.1 * before.mass).abs() < 1e-8);
        let moved = after.centre_of_mass - before.centre_of_mass;
        assert!((moved - own.shift).length() < 1e-8, "{moved}");
        assert!(after.inertia.abs_diff_eq(before.inertia * 1.1, 1e-8));
        // Again: what stands there is replaced.
        let again = Identified {
            mass_ratio: 1.0,
            shift: DVec3::ZERO,
            ..own
        };
        assert_eq!(
            identified_urdf(&path, &options, &[again]).unwrap().unwrap(),
            text
        );
    }
}
