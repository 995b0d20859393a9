//! Faults of a part's mesh file, an edge that is asked for, or a burr.

use std::path::PathBuf;

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
        "is not a closed surface: {open} open edges (one triangle only), {non_manifold} non-manifold edges \
         (more than two triangles), {misoriented} edges whose two triangles wind against each other; expected 0 of each"
    )]
    NotClosed {
        /// Edges with one triangle.
        open: usize,
        /// Edges with more than two triangles.
        non_manifold: usize,
        /// Edges whose two triangles have opposite winding.
        misoriented: usize,
    },
    /// A triangle without area that could not be taken out of the surface.
    #[error("triangle {triangle} has no area, so its face has no direction")]
    NoArea {
        /// Triangle, counted from 0 after merging vertices.
        triangle: usize,
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
        "is {extent} m long when its unit is {scale} m, expected 0.001 m to 10 m; STL and OBJ carry no unit: {}",
        units_that_fit(*extent / *scale)
    )]
    Implausible {
        /// Largest side of the bounding box [m].
        extent: f64,
        /// Scale that was applied [m per file unit].
        scale: f64,
    },
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
    /// The file's name does not end in a format that is read here.
    #[error("{file}: unknown mesh format, expected a name that ends in .stl, .obj or .dae")]
    Format {
        /// File.
        file: PathBuf,
    },
    /// The file is not a well-formed mesh of its format.
    #[error("{file}: malformed mesh: {reason}")]
    Malformed {
        /// File.
        file: PathBuf,
        /// The fault.
        reason: String,
    },
    /// The file states something that is not honoured, so that it is refused.
    #[error("{file}: {feature} is not supported: {remedy}")]
    Unsupported {
        /// File.
        file: PathBuf,
        /// Feature that the file asks for.
        feature: String,
        /// The remedy.
        remedy: &'static str,
    },
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
