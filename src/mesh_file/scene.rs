//! What a mesh file holds, and why it may not be readable.

use glam::{DMat4, DVec3};

/// Most triangles and points of a file: a scene may name one shape many times over.
const MOST_TRIANGLES: usize = 10_000_000;
pub(super) const MOST_POINTS: usize = 15_000_000;
/// Most elements that a walk through a scene comes by: nodes may name nodes twice at each level.
const MOST_ELEMENTS: usize = 5_000_000;

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

    /// Refuses a file that holds more than is read.
    pub(super) fn checked(self) -> Result<Self, Fault> {
        let points = self.parts.iter().map(|part| part.points.len()).sum();
        bounded(self.triangle_count(), points)?;
        Ok(self)
    }
}

/// Refuses more triangles and points than are read.
pub(super) fn bounded(triangles: usize, points: usize) -> Result<(), Fault> {
    let (most, what) = match () {
        () if triangles > MOST_TRIANGLES => (MOST_TRIANGLES, "triangles"),
        () if points > MOST_POINTS => (MOST_POINTS, "points"),
        () => return Ok(()),
    };
    Err(Fault::unsupported(
        format!("a mesh of more than {most} {what}"),
        "export a simpler one",
    ))
}

/// A scene on its way to a file, with a count of what it names.
pub(super) struct Assembly {
    pub(super) file: MeshFile,
    points: usize,
    triangles: usize,
    elements: usize,
}

impl Assembly {
    pub(super) fn new(file: MeshFile) -> Self {
        Self {
            file,
            points: 0,
            triangles: 0,
            elements: 0,
        }
    }

    /// Counts elements that the walk comes by.
    pub(super) fn pass(&mut self, elements: usize) -> Result<(), Fault> {
        self.elements += elements;
        if self.elements <= MOST_ELEMENTS {
            return Ok(());
        }
        Err(Fault::unsupported(
            format!(
                "a scene whose nodes name one another so often that it comes to more than {MOST_ELEMENTS} of them"
            ),
            "export a simpler one",
        ))
    }

    /// Puts a shape where a node of the scene has it.
    pub(super) fn place(&mut self, part: &MeshPart, place: DMat4) -> Result<(), Fault> {
        self.pass(1)?;
        if part.triangles.is_empty() {
            return Ok(());
        }
        self.triangles += part.triangles.len();
        self.points += part.points.len();
        bounded(self.triangles, self.points)?;
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
        self.file.parts.push(placed);
        Ok(())
    }
}

/// Triangles with the points that they use, in their order.
pub(super) fn with_own_points(points: &[DVec3], triangles: &[[u32; 3]]) -> MeshPart {
    let mut used: Vec<u32> = triangles.iter().flatten().copied().collect();
    used.sort_unstable();
    used.dedup();
    let place = |corner: u32| used.partition_point(|own| *own < corner) as u32;
    MeshPart {
        points: used.iter().map(|own| points[*own as usize]).collect(),
        triangles: triangles
            .iter()
            .map(|triangle| triangle.map(place))
            .collect(),
        colour: None,
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
