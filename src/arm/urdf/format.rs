//! The elements and attributes of a URDF file, as its specification has them, and those of other programs that are known.
//!
//! Format: <http://wiki.ros.org/urdf/XML>.

/// What an attribute holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Form {
    /// Any text.
    Text,
    /// A number.
    Number,
    /// As many numbers.
    Numbers(usize),
}

/// An attribute of an element.
pub(super) struct Attribute {
    pub name: &'static str,
    pub form: Form,
    pub absent: Absent,
}

/// What is done where an attribute is absent.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Absent {
    /// Its default counts.
    Default,
    /// The file is refused.
    Refused,
    /// This is put in its place, silently, as the parser asks for it.
    Put(&'static str),
    /// This is put in its place, and noted.
    Noted(&'static str),
}

/// An element: its attributes and what stands in it.
pub(super) struct Element {
    pub name: &'static str,
    pub attributes: &'static [Attribute],
    pub children: &'static [Child],
    /// Whether its attributes are all numbers of the model, so that none that is unknown can be passed over.
    pub exact: bool,
}

/// An element in another.
pub(super) struct Child {
    pub element: &'static Element,
    pub count: Count,
}

/// How often an element may stand in another.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Count {
    Any,
    AtMostOnce,
    Once,
}

const fn text(name: &'static str, absent: Absent) -> Attribute {
    Attribute {
        name,
        form: Form::Text,
        absent,
    }
}

const fn number(name: &'static str, absent: Absent) -> Attribute {
    Attribute {
        name,
        form: Form::Number,
        absent,
    }
}

const fn numbers(name: &'static str, count: usize, absent: Absent) -> Attribute {
    Attribute {
        name,
        form: Form::Numbers(count),
        absent,
    }
}

const fn plain(name: &'static str, attributes: &'static [Attribute]) -> Element {
    Element {
        name,
        attributes,
        children: &[],
        exact: true,
    }
}

const fn any(element: &'static Element) -> Child {
    Child {
        element,
        count: Count::Any,
    }
}

const fn at_most_once(element: &'static Element) -> Child {
    Child {
        element,
        count: Count::AtMostOnce,
    }
}

const fn once(element: &'static Element) -> Child {
    Child {
        element,
        count: Count::Once,
    }
}

use Absent::{Default, Noted, Put, Refused};

static ORIGIN: Element = plain(
    "origin",
    &[numbers("xyz", 3, Default), numbers("rpy", 3, Default)],
);
static MASS: Element = plain("mass", &[number("value", Refused)]);
static INERTIA: Element = plain(
    "inertia",
    &[
        number("ixx", Refused),
        number("ixy", Noted("0")),
        number("ixz", Noted("0")),
        number("iyy", Refused),
        number("iyz", Noted("0")),
        number("izz", Refused),
    ],
);
pub(super) static INERTIAL: Element = Element {
    name: "inertial",
    attributes: &[],
    children: &[at_most_once(&ORIGIN), once(&MASS), at_most_once(&INERTIA)],
    exact: false,
};
static BOX: Element = plain("box", &[numbers("size", 3, Refused)]);
static CYLINDER: Element = plain(
    "cylinder",
    &[number("radius", Refused), number("length", Refused)],
);
static CAPSULE: Element = plain(
    "capsule",
    &[number("radius", Refused), number("length", Refused)],
);
static SPHERE: Element = plain("sphere", &[number("radius", Refused)]);
static MESH: Element = plain(
    "mesh",
    &[text("filename", Refused), numbers("scale", 3, Default)],
);
pub(super) static GEOMETRY: Element = Element {
    name: "geometry",
    attributes: &[],
    children: &[
        at_most_once(&BOX),
        at_most_once(&CYLINDER),
        at_most_once(&CAPSULE),
        at_most_once(&SPHERE),
        at_most_once(&MESH),
    ],
    exact: false,
};
static COLOUR: Element = plain("color", &[numbers("rgba", 4, Refused)]);
static TEXTURE: Element = plain("texture", &[text("filename", Refused)]);
static MATERIAL: Element = Element {
    name: "material",
    attributes: &[text("name", Put(""))],
    children: &[at_most_once(&COLOUR), at_most_once(&TEXTURE)],
    exact: false,
};
static VISUAL: Element = Element {
    name: "visual",
    attributes: &[text("name", Default)],
    children: &[
        at_most_once(&ORIGIN),
        at_most_once(&GEOMETRY),
        at_most_once(&MATERIAL),
    ],
    exact: false,
};
static COLLISION: Element = Element {
    name: "collision",
    attributes: &[text("name", Default)],
    children: &[at_most_once(&ORIGIN), at_most_once(&GEOMETRY)],
    exact: false,
};
pub(super) static LINK: Element = Element {
    name: "link",
    attributes: &[text("name", Refused)],
    children: &[at_most_once(&INERTIAL), any(&VISUAL), any(&COLLISION)],
    exact: false,
};
static PARENT: Element = plain("parent", &[text("link", Refused)]);
static CHILD: Element = plain("child", &[text("link", Refused)]);
static AXIS: Element = plain("axis", &[numbers("xyz", 3, Refused)]);
static LIMIT: Element = plain(
    "limit",
    &[
        number("lower", Default),
        number("upper", Default),
        number("effort", Default),
        number("velocity", Put("0")),
        number("acceleration", Default),
        number("deceleration", Default),
        number("jerk", Default),
    ],
);
static CALIBRATION: Element = plain(
    "calibration",
    &[number("rising", Default), number("falling", Default)],
);
static DYNAMICS: Element = plain(
    "dynamics",
    &[number("damping", Put("0")), number("friction", Put("0"))],
);
static MIMIC: Element = plain(
    "mimic",
    &[
        text("joint", Refused),
        number("multiplier", Default),
        number("offset", Default),
    ],
);
static SAFETY: Element = plain(
    "safety_controller",
    &[
        number("soft_lower_limit", Default),
        number("soft_upper_limit", Default),
        number("k_position", Default),
        number("k_velocity", Put("0")),
    ],
);
pub(super) static JOINT: Element = Element {
    name: "joint",
    attributes: &[text("name", Refused), text("type", Refused)],
    children: &[
        at_most_once(&ORIGIN),
        once(&PARENT),
        once(&CHILD),
        at_most_once(&AXIS),
        at_most_once(&LIMIT),
        at_most_once(&CALIBRATION),
        at_most_once(&DYNAMICS),
        at_most_once(&MIMIC),
        at_most_once(&SAFETY),
    ],
    exact: false,
};
pub(super) static ROBOT: Element = Element {
    name: "robot",
    attributes: &[text("name", Put("robot")), text("version", Default)],
    children: &[any(&LINK), any(&JOINT), any(&MATERIAL)],
    exact: false,
};

/// Types of joints.
pub(super) const JOINT_TYPES: [&str; 7] = [
    "revolute",
    "continuous",
    "prismatic",
    "fixed",
    "floating",
    "planar",
    "spherical",
];

/// Every element of the format, for what stands where it does not belong.
pub(super) const ELEMENTS: [&str; 25] = [
    "origin",
    "mass",
    "inertia",
    "inertial",
    "box",
    "cylinder",
    "capsule",
    "sphere",
    "mesh",
    "geometry",
    "color",
    "texture",
    "material",
    "visual",
    "collision",
    "link",
    "parent",
    "child",
    "axis",
    "limit",
    "dynamics",
    "mimic",
    "safety_controller",
    "joint",
    "robot",
];

/// Elements that other programs put into URDF files and that say nothing about the arm's own physics, by the element in which they stand.
pub(super) const PASSED_OVER: [(&str, &[&str]); 9] = [
    (
        "robot",
        &[
            "gazebo",
            "transmission",
            "ros2_control",
            "sensor",
            "actuator",
            "disable_collisions",
            "loop_joint",
        ],
    ),
    (
        "link",
        &[
            "self_collision_checking",
            "sensor",
            "contact",
            "contact_coefficients",
            "gazebo",
        ],
    ),
    (
        "joint",
        &["hardwareInterface", "gazebo", "transmission", "sensor"],
    ),
    (
        "collision",
        &[
            "material",
            "verbose",
            "contact_coefficients",
            "max_contacts",
            "surface",
        ],
    ),
    (
        "visual",
        &["transparency", "cast_shadows", "plugin", "meta"],
    ),
    ("material", &["script", "shader", "ambient", "diffuse"]),
    ("dynamics", &[]),
    ("geometry", &[]),
    ("inertial", &[]),
];

/// Elements with which other formats (SDF, MJCF, SRDF) say what URDF says otherwise: passing them over would change the arm.
pub(super) const OTHER_FORMATS: [(&str, &str); 20] = [
    ("pose", "<origin xyz=\"..\" rpy=\"..\"/>"),
    ("frame", "a <link> without shape and a fixed <joint> to it"),
    ("transform", "<origin xyz=\"..\" rpy=\"..\"/>"),
    ("rotation", "<origin rpy=\"..\"/>"),
    ("translation", "<origin xyz=\"..\"/>"),
    ("position", "<origin xyz=\"..\"/>"),
    ("orientation", "<origin rpy=\"..\"/>"),
    ("body", "<link>"),
    ("geom", "<visual> and <collision> with a <geometry>"),
    ("site", "a <link> without shape and a fixed <joint> to it"),
    ("model", "<robot>"),
    ("worldbody", "<robot> with its <link>s"),
    (
        "include",
        "nothing, as the program `xacro` puts files together,",
    ),
    ("uri", "<mesh filename=\"..\"/>"),
    ("com", "<inertial> with an <origin>"),
    ("center_of_mass", "<inertial> with an <origin>"),
    ("range", "<limit lower=\"..\" upper=\"..\"/>"),
    ("damping", "<dynamics damping=\"..\"/>"),
    ("friction", "<dynamics friction=\"..\"/>"),
    ("effort", "<limit effort=\"..\"/>"),
];
