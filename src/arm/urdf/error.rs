//! Why a URDF file is not taken as an arm.

use std::path::PathBuf;

/// Why an arm could not be loaded.
#[derive(Debug, thiserror::Error)]
pub enum ArmError {
    /// The file cannot be read.
    #[error("{file}: cannot read the arm's URDF file: {source}")]
    Unreadable {
        /// The URDF file.
        file: PathBuf,
        /// Message of the system.
        source: std::io::Error,
    },
    /// A Git LFS pointer in the file's place.
    #[error(
        "{file}: this is a Git LFS pointer to a file of {size} bytes, not the file itself; expected the URDF: `git lfs pull` in its repository fetches it"
    )]
    Pointer {
        /// The URDF file.
        file: PathBuf,
        /// Size of the file that it points to [bytes].
        size: String,
    },
    /// The file is no URDF, or not all of one.
    #[error("{file}: not a valid URDF file: {fault}")]
    Incomplete {
        /// The URDF file.
        file: PathBuf,
        /// Its fault, in words.
        fault: &'static str,
    },
    /// The file holds at a line what URDF does not have.
    #[error("{file}:{line}: not a valid URDF file: {fault}")]
    Faulty {
        /// The URDF file.
        file: PathBuf,
        /// The line, counted from 1.
        line: u32,
        /// The fault, in words.
        fault: String,
    },
    /// Macros in the file that cannot be evaluated.
    #[error("{file}:{line}: {why}, which is for the program xacro to evaluate: {reason}; by hand: xacro {file} -o {}", file.with_extension("expanded.urdf").display())]
    Xacro {
        /// The file.
        file: PathBuf,
        /// Line of the first macro.
        line: u32,
        /// What stands there.
        why: String,
        /// Why xacro did not help.
        reason: String,
    },
    /// The file holds something that cannot be honoured.
    #[error("{file}{}: {refusal}", line.map_or(String::new(), |line| format!(":{line}")))]
    Refused {
        /// The URDF file.
        file: PathBuf,
        /// Line of the link or joint, counted from 1.
        line: Option<u32>,
        /// The refused part and the reason.
        refusal: Box<Refusal>,
    },
}

/// Parts of a URDF file that cannot be honoured, by name.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[allow(missing_docs)] // the messages say what each field is
pub enum Refusal {
    #[error("there is no link `{link}` to be the {role}; the links are {known}")]
    UnknownLink {
        role: &'static str,
        link: String,
        known: String,
    },
    #[error("joint `{joint}` names a link `{link}` that the file does not define")]
    DanglingJoint { joint: String, link: String },
    #[error("{what} `{name}` is defined twice")]
    Duplicate { what: &'static str, name: String },
    #[error(
        "link `{link}` is the child of both joint `{first}` and joint `{second}`; expected a tree"
    )]
    TwoParents {
        link: String,
        first: String,
        second: String,
    },
    #[error(
        "the base link is not given and the file has not exactly one root link but {roots}; arm.base_link in the scenario chooses one"
    )]
    NoSingleRoot { roots: String },
    #[error(
        "every link is the child of a joint ({links}): the joints form a ring; expected a base link from which the arm starts"
    )]
    Ring { links: String },
    #[error(
        "line {line}: <loop_joint> `{joint}` closes a chain between links `{first}` and `{second}`, which move against each other; expected a serial arm: linkages are not simulated"
    )]
    Loop {
        joint: String,
        line: u32,
        first: String,
        second: String,
    },
    #[error("tip link `{tip}` is not reached from base link `{base}`")]
    TipNotReached { base: String, tip: String },
    #[error(
        "the path from `{base}` to `{tip}` has {count} moving joints{names}; expected {} to {}{hint}", .expected[0], .expected[1]
    )]
    JointCount {
        base: String,
        tip: String,
        count: usize,
        expected: [usize; 2],
        names: String,
        hint: &'static str,
    },
    #[error("joint `{joint}` is {kind}; expected revolute, continuous, prismatic or fixed")]
    JointType { joint: String, kind: &'static str },
    #[error(
        "joint `{joint}` on the path mimics joint `{source_joint}`; a driven axis cannot mimic another"
    )]
    MimicOnPath { joint: String, source_joint: String },
    #[error("joint `{joint}` mimics `{source_joint}`, which {why}")]
    Mimic {
        joint: String,
        source_joint: String,
        why: &'static str,
    },
    #[error("joint `{joint}` has axis ({axis}); expected a vector of non-zero length")]
    Axis { joint: String, axis: String },
    #[error(
        "joint `{joint}` has {limit} limit {value}; expected a positive number: [[arm.limit_overrides]] in the scenario gives one (joint, {key}), and `idc new cell --urdf` writes one that suits the arm's size"
    )]
    DriveLimit {
        joint: String,
        limit: &'static str,
        key: &'static str,
        value: f64,
    },
    #[error(
        "joint `{joint}` has position limits {lower} to {upper}{origin}; expected lower below upper, or type continuous of a joint that turns without end"
    )]
    PositionLimits {
        joint: String,
        lower: f64,
        upper: f64,
        origin: &'static str,
    },
    #[error("joint `{joint}` has {what} {value}; expected zero or a positive number")]
    JointDynamics {
        joint: String,
        what: &'static str,
        value: f64,
    },
    #[error("a limit override names joint `{joint}`, which is not a moving joint on the path")]
    OverrideUnknown { joint: String },
    #[error("link `{link}` has mass {mass} kg{context}; expected a positive mass")]
    Mass {
        link: String,
        mass: f64,
        context: &'static str,
    },
    #[error(
        "link `{link}` has no mass ({why}); expected a positive mass: [[arm.link_masses]] in the scenario gives one (link, mass_kg), or arm.mass_kg, the robot's whole mass, of which the link then takes the share of its volume; `idc new cell --urdf` writes one that suits the arm's size"
    )]
    NoMass { link: String, why: &'static str },
    #[error("a mass is given for link `{link}`, which {why}")]
    MassUnknown { link: String, why: &'static str },
    #[error(
        "the robot's whole mass is given as {whole} kg, but its links with masses weigh {known:.1} kg together; expected more"
    )]
    WholeMass { whole: f64, known: f64 },
    #[error(
        "link `{link}` has principal inertias {moments} kg m2{context}; expected {expected} ones, which [[arm.link_masses]] in the scenario (link, mass_kg) takes from the link's shape where the file's are all zero"
    )]
    Inertia {
        link: String,
        moments: String,
        context: &'static str,
        expected: &'static str,
    },
    #[error("{location} is not finite")]
    NotFinite { location: String },
    #[error("{location} is {value:.3e} {unit}, expected at most {most:.0e}: no arm has such")]
    Absurd {
        location: String,
        value: f64,
        unit: &'static str,
        most: f64,
    },
    #[error("link `{link}` has a {role} {shape} of {value}; expected positive sizes")]
    ShapeSize {
        link: String,
        role: &'static str,
        shape: &'static str,
        value: String,
    },
    #[error("link `{link}`: {role} mesh `{mesh}` cannot be used: {reason}")]
    Mesh {
        link: String,
        role: &'static str,
        mesh: String,
        reason: String,
    },
}

impl Refusal {
    /// The link or joint that it is about.
    pub(super) fn subject(&self) -> Option<(&'static str, &str)> {
        match self {
            Self::DanglingJoint { joint, .. }
            | Self::JointType { joint, .. }
            | Self::MimicOnPath { joint, .. }
            | Self::Mimic { joint, .. }
            | Self::Axis { joint, .. }
            | Self::DriveLimit { joint, .. }
            | Self::PositionLimits { joint, .. }
            | Self::JointDynamics { joint, .. } => Some(("joint", joint)),
            Self::TwoParents { second, .. } => Some(("joint", second)),
            Self::Duplicate { what, name } => Some((what, name)),
            Self::Mass { link, .. }
            | Self::NoMass { link, .. }
            | Self::Inertia { link, .. }
            | Self::ShapeSize { link, .. }
            | Self::Mesh { link, .. } => Some(("link", link)),
            _ => None,
        }
    }
}
