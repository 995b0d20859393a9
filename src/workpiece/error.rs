//! Faults of a part's mesh file, an edge that is asked for, or a burr.

use std::path::PathBuf;

use glam::DVec3;

use crate::mesh_file::MeshFileError;

/// Why a triangle mesh cannot stand for a part.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum MeshFault {
    /// The file holds no triangle of non-zero area.
    #[error("holds no triangle of non-zero area")]
    Empty,
    /// A triangle refers to a vertex that does not exist.
    #[error("triangle {triangle} refers to vertex {vertex}, but there are only {count}")]
    VertexIndex {
        /// Triangle, counted from 0.
        triangle: usize,
        /// Vertex it names.
        vertex: u32,
        /// Number of vertices in the mesh.
        count: usize,
    },
    /// A coordinate is NaN or infinite.
    #[error("vertex {vertex} has a coordinate that is not a finite number")]
    NonFinite {
        /// Vertex, counted from 0 in the file's order.
        vertex: usize,
    },
    /// The triangles do not form a closed orientable surface.
    #[error(
        "is not a closed surface: {} open edges (one triangle only), {} non-manifold edges (more than two triangles), {} edges whose \
         two triangles wind against each other; expected 0 of each, or so few and small that they can be mended; {}",
        count(edges, EdgeFlaw::Open),
        count(edges, EdgeFlaw::NonManifold),
        count(edges, EdgeFlaw::Misoriented),
        where_they_are(edges)
    )]
    NotClosed {
        /// The faulty edges, in the part frame [m].
        edges: Vec<EdgeFault<DVec3>>,
    },
    /// A triangle without area that could not be taken out of the surface.
    #[error("triangle {triangle}, at {} mm, has no area, so its face has no direction", in_millimetres(*place))]
    NoArea {
        /// Triangle, counted from 0 after merging vertices.
        triangle: usize,
        /// One of its corners, in the part frame [m].
        place: DVec3,
    },
    /// The file can be drawn, but leaves open which solid it means.
    #[error("does not say which solid it is: {reason}")]
    Doubtful {
        /// Why.
        reason: String,
    },
    /// The surface is closed, but its normals point into the part, or it encloses nothing.
    #[error(
        "{}: its enclosed volume is {volume:e} m3, expected positive (triangles counter-clockwise seen from outside)",
        if volume.abs() < NO_VOLUME { "is flat" } else { "is inside out" }
    )]
    InsideOut {
        /// Signed volume [m^3].
        volume: f64,
    },
    /// The part is implausibly small or large.
    #[error(
        "is {extent} m long when its unit is {scale} m, expected 0.001 m to 10 m; {}",
        units_that_fit(*extent / *scale)
    )]
    Implausible {
        /// Largest side of the bounding box [m].
        extent: f64,
        /// Scale that was applied [m per file unit].
        scale: f64,
    },
}

/// What is wrong with an edge.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum EdgeFlaw {
    /// It has one triangle.
    Open,
    /// It has more than two triangles.
    NonManifold,
    /// Its two triangles have opposite winding.
    Misoriented,
}

impl EdgeFlaw {
    /// In words.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Open => "open",
            Self::NonManifold => "non-manifold",
            Self::Misoriented => "wound against each other",
        }
    }
}

/// An edge that a closed surface cannot have.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EdgeFault<End> {
    /// What is wrong with it.
    pub flaw: EdgeFlaw,
    /// Its ends.
    pub ends: [End; 2],
}

fn count(edges: &[EdgeFault<DVec3>], flaw: EdgeFlaw) -> usize {
    edges.iter().filter(|edge| edge.flaw == flaw).count()
}

/// The first few faulty edges, each by its middle.
fn where_they_are(edges: &[EdgeFault<DVec3>]) -> String {
    const NAMED: usize = 3;
    let first = edges.iter().take(NAMED).map(|edge| {
        let middle = 0.5 * (edge.ends[0] + edge.ends[1]);
        format!("{} at {} mm", edge.flaw.name(), in_millimetres(middle))
    });
    let more = edges.len().saturating_sub(NAMED);
    let more = if more > 0 {
        format!(" and {more} more")
    } else {
        String::new()
    };
    format!(
        "{}{more}; `idc edges` with --out PAGE.html shows them on the part",
        first.collect::<Vec<_>>().join(", ")
    )
}

/// A place in words, to a micrometre.
pub(super) fn in_millimetres(place: DVec3) -> String {
    let [x, y, z] = place
        .to_array()
        .map(|metres| (1e6 * metres).round() / 1e3 + 0.0);
    format!("({x}, {y}, {z})")
}

/// Volume of rounding errors, far below that of anything whose largest side is a millimetre [m^3].
pub(super) const NO_VOLUME: f64 = 1e-15;

/// Units with which a part of a size in units of its file would be one that a robot can carry a tool along.
fn units_that_fit(size: f64) -> String {
    const USUAL: std::ops::RangeInclusive<f64> = 0.01..=5.0;
    let units = [
        ("millimetres", "mm", 1e-3),
        ("metres", "m", 1.0),
        ("inches", "inch", 0.0254),
    ];
    let fitting: Vec<String> = (units.iter())
        .map(|(name, key, length)| (name, key, size * length))
        .filter(|(_, _, length)| USUAL.contains(length))
        .map(|(name, key, length)| {
            let millimetres = 1e3 * length;
            format!("in {name} (mesh_unit or --unit {key}) it would be {millimetres:.0} mm long")
        })
        .collect();
    match &fitting[..] {
        _ if size == 0.0 => "all of its points lie in one place".to_owned(),
        [] => format!("its points span {size:.3e} units, which is no usual part in any of them"),
        fitting => fitting.join(", "),
    }
}

/// Errors of the workpiece module.
#[derive(Debug, thiserror::Error)]
pub enum WorkpieceError {
    /// A file could not be opened or read.
    #[error("cannot read {file}: {source}")]
    Read {
        /// File.
        file: PathBuf,
        /// Message of the operating system.
        source: std::io::Error,
    },
    /// A mesh file that is not read.
    #[error(transparent)]
    MeshFile(#[from] MeshFileError),
    /// The mesh was read but cannot stand for a part.
    #[error("{file}: mesh {fault}")]
    Mesh {
        /// File.
        file: PathBuf,
        /// Its fault.
        fault: MeshFault,
    },
    /// A number is out of its range.
    #[error("{quantity} is {value}, expected {expected}")]
    Range {
        /// Which quantity, with its unit.
        quantity: &'static str,
        /// Value found.
        value: f64,
        /// The allowed values.
        expected: String,
    },
    /// No edge has this id.
    #[error("no edge '{id}' on this part, expected one of {known}")]
    UnknownEdge {
        /// Id asked for.
        id: String,
        /// Ids there are.
        known: String,
    },
    /// A line of a burr table is wrong.
    #[error("{file}, line {line}: {reason}")]
    BurrTable {
        /// CSV file.
        file: PathBuf,
        /// Line, counted from 1.
        line: u64,
        /// The fault and the expected form.
        reason: String,
    },
    /// A burr table is shorter than the path it lies on, or a bump lies beside it.
    #[error(
        "the burr covers {:.3} mm to {:.3} mm of the followed edge, expected {expected} 0 mm to {:.3} mm",
        1e3 * from, 1e3 * to, 1e3 * length
    )]
    BurrCoverage {
        /// First position [m].
        from: f64,
        /// Last position [m].
        to: f64,
        /// Path length [m].
        length: f64,
        /// The intended use of the path, a verb.
        expected: &'static str,
    },
}

/// Refuses a number that is not finite or not in the range that `allowed` tests.
pub(crate) fn require(
    quantity: &'static str,
    value: f64,
    allowed: bool,
    expected: &str,
) -> Result<(), WorkpieceError> {
    if value.is_finite() && allowed {
        return Ok(());
    }
    Err(WorkpieceError::Range {
        quantity,
        value,
        expected: expected.to_owned(),
    })
}
