//! A robot as `urdf_rs` describes one, of an XML tree that has been walked over: one parser reads a file.
//!
//! The crate's own reading parses a text three times over (two more parsers, and a text written in between), and does not take a `<visual>` after an
//! `<inertial>` after a `<visual>`.

use std::collections::BTreeSet;

use roxmltree::Node;
use urdf_rs::{
    Axis, Collision, Color, Dynamics, Geometry, Inertia, Inertial, Joint, JointLimit, JointType,
    Link, LinkName, Mass, Material, Mimic, Pose, Robot, SafetyController, Texture, Vec3, Vec4,
    Visual,
};

use super::format::{Absent, Element, ROBOT};

/// An element with what the format says of it.
#[derive(Clone, Copy)]
struct Given<'a> {
    node: Node<'a, 'a>,
    element: &'static Element,
    left_out: &'a BTreeSet<usize>,
}

impl<'a> Given<'a> {
    fn children(self, name: &'static str) -> impl Iterator<Item = Self> {
        let known = self.element.children.iter().map(|child| child.element);
        let element = known.into_iter().find(|element| element.name == name);
        element.into_iter().flat_map(move |element| {
            let own = self.node.children().filter(move |child| {
                child.has_tag_name(name) && !self.left_out.contains(&child.id().get_usize())
            });
            own.map(move |node| Self {
                node,
                element,
                ..self
            })
        })
    }

    fn child(self, name: &'static str) -> Option<Self> {
        self.children(name).next()
    }

    /// An attribute, or what the format puts in its place.
    fn text(self, name: &str) -> Option<&'a str> {
        let put = || {
            let known = self.element.attributes.iter();
            match known.into_iter().find(|known| known.name == name)?.absent {
                Absent::Put(value) | Absent::Noted(value) => Some(value),
                Absent::Default | Absent::Refused => None,
            }
        };
        self.node.attribute(name).or_else(put)
    }

    fn name(self, attribute: &str) -> String {
        self.text(attribute).unwrap_or_default().to_owned()
    }

    fn number(self, name: &str) -> Option<f64> {
        self.text(name)?.trim().parse().ok()
    }

    fn numbers<const N: usize>(self, name: &str) -> Option<[f64; N]> {
        let words = self.text(name)?.split_whitespace();
        let numbers: Option<Vec<f64>> = words.map(|word| word.parse().ok()).collect();
        numbers?.try_into().ok()
    }

    fn pose(self) -> Pose {
        let origin = self.child("origin");
        let three = |name| Vec3(origin.and_then(|it| it.numbers(name)).unwrap_or_default());
        Pose {
            xyz: three("xyz"),
            rpy: three("rpy"),
        }
    }
}

/// The robot of a tree's root, without what was left out; absent numbers have their defaults.
pub(super) fn robot<'a>(root: Node<'a, 'a>, left_out: &'a BTreeSet<usize>) -> Robot {
    let given = Given {
        node: root,
        element: &ROBOT,
        left_out,
    };
    let version = given.text("version").map(str::to_owned);
    let is_open = version.as_deref().is_some_and(leaves_limits_open);
    Robot {
        name: given.name("name"),
        links: given.children("link").map(link).collect(),
        joints: (given.children("joint"))
            .map(|own| joint(own, is_open))
            .collect(),
        materials: given.children("material").map(material).collect(),
        version,
    }
}

/// Whether absent limits are none in a version of the format, from 1.2 on.
fn leaves_limits_open(version: &str) -> bool {
    let parts = version.trim().split_once('.');
    let parts = parts.and_then(|(major, minor)| Some((major.parse().ok()?, minor.parse().ok()?)));
    parts.is_some_and(|parts: (u32, u32)| parts >= (1, 2))
}

fn link(given: Given) -> Link {
    let visual = |own: Given| Visual {
        name: own.text("name").map(str::to_owned),
        origin: own.pose(),
        geometry: geometry(own),
        material: own.child("material").map(material),
    };
    let collision = |own: Given| Collision {
        name: own.text("name").map(str::to_owned),
        origin: own.pose(),
        geometry: geometry(own),
    };
    Link {
        name: given.name("name"),
        inertial: given.child("inertial").map(inertial).unwrap_or_default(),
        visual: given.children("visual").map(visual).collect(),
        collision: given.children("collision").map(collision).collect(),
    }
}

fn inertial(given: Given) -> Inertial {
    let mass = given.child("mass").and_then(|mass| mass.number("value"));
    let tensor = given.child("inertia");
    let of = |name| tensor.and_then(|it| it.number(name)).unwrap_or(0.0);
    Inertial {
        origin: given.pose(),
        mass: Mass {
            value: mass.unwrap_or(0.0),
        },
        inertia: Inertia {
            ixx: of("ixx"),
            ixy: of("ixy"),
            ixz: of("ixz"),
            iyy: of("iyy"),
            iyz: of("iyz"),
            izz: of("izz"),
        },
    }
}

/// The shape of a visual or a collision, of which the walk has seen that it has one.
fn geometry(given: Given) -> Geometry {
    let shape = |name| given.child("geometry").and_then(|own| own.child(name));
    let size = |own: Given, name: &str| own.number(name).unwrap_or(0.0);
    if let Some(own) = shape("cylinder") {
        let (radius, length) = (size(own, "radius"), size(own, "length"));
        return Geometry::Cylinder { radius, length };
    }
    if let Some(own) = shape("capsule") {
        let (radius, length) = (size(own, "radius"), size(own, "length"));
        return Geometry::Capsule { radius, length };
    }
    if let Some(own) = shape("sphere") {
        let radius = size(own, "radius");
        return Geometry::Sphere { radius };
    }
    if let Some(own) = shape("mesh") {
        return Geometry::Mesh {
            filename: own.name("filename"),
            scale: own.numbers("scale").map(Vec3),
        };
    }
    let size = shape("box").and_then(|own| own.numbers("size"));
    Geometry::Box {
        size: Vec3(size.unwrap_or_default()),
    }
}

fn material(given: Given) -> Material {
    let colour = given
        .child("color")
        .and_then(|colour| colour.numbers("rgba"));
    Material {
        name: given.name("name"),
        color: colour.map(|rgba| Color { rgba: Vec4(rgba) }),
        texture: given.child("texture").map(|own| Texture {
            filename: own.name("filename"),
        }),
    }
}

fn joint(given: Given, is_open: bool) -> Joint {
    let end = |name| LinkName {
        link: given
            .child(name)
            .map(|own| own.name("link"))
            .unwrap_or_default(),
    };
    let axis = given.child("axis").and_then(|axis| axis.numbers("xyz"));
    Joint {
        name: given.name("name"),
        joint_type: kind(&given.name("type")),
        origin: given.pose(),
        parent: end("parent"),
        child: end("child"),
        axis: axis.map_or_else(Axis::default, |xyz| Axis { xyz: Vec3(xyz) }),
        limit: (given.child("limit"))
            .map(|own| limit(own, is_open))
            .unwrap_or_default(),
        calibration: None,
        dynamics: given.child("dynamics").map(|own| Dynamics {
            damping: own.number("damping").unwrap_or(0.0),
            friction: own.number("friction").unwrap_or(0.0),
        }),
        mimic: given.child("mimic").map(|own| Mimic {
            joint: own.name("joint"),
            multiplier: own.number("multiplier"),
            offset: own.number("offset"),
        }),
        safety_controller: given.child("safety_controller").map(safety),
    }
}

fn limit(given: Given, is_open: bool) -> JointLimit {
    let or = |name, usual: f64| given.number(name).unwrap_or(usual);
    // Of older versions these are not read.
    let change = |name| match is_open {
        true => or(name, f64::INFINITY),
        false => f64::INFINITY,
    };
    let (least, end) = match is_open {
        true => (f64::NEG_INFINITY, f64::INFINITY),
        false => (0.0, 0.0),
    };
    JointLimit {
        lower: or("lower", least),
        upper: or("upper", end),
        effort: or("effort", end),
        velocity: or("velocity", end),
        acceleration: change("acceleration"),
        deceleration: match is_open {
            true => or("deceleration", change("acceleration")),
            false => f64::INFINITY,
        },
        jerk: change("jerk"),
    }
}

fn safety(given: Given) -> SafetyController {
    let or_zero = |name| given.number(name).unwrap_or(0.0);
    SafetyController {
        soft_lower_limit: or_zero("soft_lower_limit"),
        soft_upper_limit: or_zero("soft_upper_limit"),
        k_position: or_zero("k_position"),
        k_velocity: or_zero("k_velocity"),
    }
}

/// A joint's type, of which the walk has seen that it is one.
fn kind(name: &str) -> JointType {
    match name {
        "revolute" => JointType::Revolute,
        "continuous" => JointType::Continuous,
        "prismatic" => JointType::Prismatic,
        "floating" => JointType::Floating,
        "planar" => JointType::Planar,
        "spherical" => JointType::Spherical,
        _ => JointType::Fixed,
    }
}
