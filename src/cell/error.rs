//! Why a cell cannot be assembled or cannot do its job.

use std::path::PathBuf;

use crate::arm::urdf::ArmError;
use crate::path::PlanError;
use crate::scenario::Scenario;
use crate::workpiece::WorkpieceError;

/// A cell that is refused before anything moves.
#[derive(Debug, thiserror::Error)]
pub enum CellError {
    /// The arm's file.
    #[error(transparent)]
    Arm(#[from] ArmError),
    /// The part, its edge or its burr.
    #[error(transparent)]
    Workpiece(#[from] WorkpieceError),
    /// The chosen edge is not there.
    #[error("{}: workpiece.edge: {chosen} does not exist; the part has {edges} edges and {loops} loops (list them with `idc edges {}`)",
        file.display(), mesh.display())]
    EdgeUnknown {
        /// Scenario file or mesh that the choice belongs to.
        file: PathBuf,
        /// The mesh.
        mesh: PathBuf,
        /// What was chosen.
        chosen: String,
        /// Number of edges.
        edges: usize,
        /// Number of loops.
        loops: usize,
    },
    /// The chosen edge is not one that a tool can ride.
    #[error("{}: {chosen} is {convexity}: only an edge that sticks out everywhere can be deburred from outside", mesh.display())]
    EdgeNotConvex {
        /// The mesh.
        mesh: PathBuf,
        /// What was chosen.
        chosen: String,
        /// How it is.
        convexity: &'static str,
    },
    /// The path.
    #[error("{}: {source}", file.display())]
    Plan {
        /// Scenario file.
        file: PathBuf,
        /// What stands in the way.
        source: PlanError,
    },
    /// The supply cannot give the force.
    #[error("{}: process.force_n = {force:.1} N needs {:.2} bar gauge at the regulator at {:.1} mm along the edge; the supply gives 0 to {:.2} bar, which is {:.1} to {:.1} N there",
        file.display(), needed / 1e5, 1e3 * edge_length, supply / 1e5, attainable[0].max(0.0), attainable[1])]
    Supply {
        /// Scenario file.
        file: PathBuf,
        /// Desired force [N].
        force: f64,
        /// Where [m].
        edge_length: f64,
        /// Pressure needed, gauge [Pa].
        needed: f64,
        /// Pressure of the supply, gauge [Pa].
        supply: f64,
        /// Contact forces at no and at full pressure [N].
        attainable: [f64; 2],
    },
}

impl CellError {
    pub(super) fn plan(scenario: &Scenario, source: PlanError) -> Self {
        Self::Plan { file: scenario.path.clone(), source }
    }
}
