//! What a mesh file holds, and why it may not be readable.

use glam::{DMat4, DVec3};

/// Most triangles of a file: a scene may name one shape many times over.
const MOST_TRIANGLES: usize = 20_000_000;

/// Triangles of one colour.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct MeshPart {
    /// Points, in metres or in the file's unit, see [`MeshFile::in_metres`].
    pub points: Vec<DVec3>,
    /// Triangles as indices of points, counter-clockwise seen from outside.
    pub triangles: Vec<[u32; 3]>,
    /// Red, green, blue and opacity [1], where the file names them.
    pub colour: Option<[f64; 4]>,
}

/// The axis that a file calls up.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Up {
    /// Its x axis.
    X,
    /// Its y axis.
    Y,
    /// Its z axis, or it says nothing of it.
    Z,
}

impl Up {
    /// A point with z up, as the COLLADA specification turns the axes.
    #[must_use]
    pub fn z_up(self, point: DVec3) -> DVec3 {
        match self {
            Self::X => DVec3::new(-point.y, -point.z, point.x),
            Self::Y => DVec3::new(point.x, -point.z, point.y),
            Self::Z => point,
        }
    }

    /// Its name.
    #[must_use]
    pub fn axis(self) -> &'static str {
        match self {
            Self::X => "x",
            Self::Y => "y",
            Self::Z => "z",
        }
    }
}

/// A file's triangles, in the axes that it is written in.
#[derive(Debug, Clone, PartialEq)]
pub struct MeshFile {
    /// Its parts, in its order.
    pub parts: Vec<MeshPart>,
    /// Whether the file states its unit, so that points are in metres.
    pub in_metres: bool,
    /// The axis that it calls up.
    pub up: Up,
    /// What a reader should know of how it was read.
    pub notes: Vec<String>,
    /// Why it does not say of which shape a solid is, though it can be drawn.
    pub doubtful: Option<String>,
}

impl MeshFile {
    /// A file whose unit and axes are not stated.
    pub(super) fn unitless(parts: Vec<MeshPart>) -> Self {
        Self {
            parts,
            in_metres: false,
            up: Up::Z,
            notes: Vec::new(),
            doubtful: None,
        }
    }

    /// Number of its triangles.
    #[must_use]
    pub fn triangle_count(&self) -> usize {
        self.parts.iter().map(|part| part.triangles.len()).sum()
    }

    /// Puts a shape where a node of the scene has it.
    pub(super) fn place(&mut self, part: &MeshPart, place: DMat4) -> Result<(), Fault> {
        if part.triangles.is_empty() {
            return Ok(());
        }
        if self.triangle_count() + part.triangles.len() > MOST_TRIANGLES {
            return Err(Fault::unsupported(
                format!("a scene of more than {MOST_TRIANGLES} triangles"),
                "export a simpler one",
            ));
        }
        let mut placed = part.clone();
        for point in &mut placed.points {
            *point = place.transform_point3(*point);
        }
        // Mirrored it would be inside out.
        if place.determinant() < 0.0 {
            for triangle in &mut placed.triangles {
                triangle.swap(1, 2);
            }
        }
        self.parts.push(placed);
        Ok(())
    }
}

/// Why a file cannot be read.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Fault {
    /// It is not as its format has it.
    Malformed(String),
    /// It is, but holds what is not read here.
    Unsupported {
        /// What.
        feature: String,
        /// A way round it.
        remedy: &'static str,
    },
}

impl Fault {
    pub(super) fn malformed(reason: impl Into<String>) -> Self {
        Self::Malformed(reason.into())
    }

    pub(super) fn at_line(line: usize, reason: impl std::fmt::Display) -> Self {
        Self::Malformed(format!("line {line}: {reason}"))
    }

    pub(super) fn unsupported(feature: impl Into<String>, remedy: &'static str) -> Self {
        Self::Unsupported {
            feature: feature.into(),
            remedy,
        }
    }
}
