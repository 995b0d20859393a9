//! What a diagnosis of a case comes to.

use crate::diagnosis::answer::Answer;
use crate::diagnosis::answer::finding::Diagnosis;
use crate::diagnosis::difference::comparison::Comparison;
use crate::plant::PlantParameters;

use super::explanations::Explanations;

/// Name of the improved model's file.
pub const IMPROVED: &str = "improved.toml";
/// Name of the table of a recorded arm's drives.
pub const DRIVES: &str = "drives.csv";
/// Name of a recorded arm's URDF with identified numbers.
pub const IDENTIFIED: &str = "identified.urdf";

/// Name of the improved description of a cell's arm.
pub const IMPROVED_ARM: &str = "improved_arm.toml";

/// Result of a diagnosis, with the files that it comes to.
pub struct Diagnosed {
    /// The finding.
    pub answer: Answer,
    /// The improved model as a file.
    pub improved: String,
    /// The improved model's prediction of the recording that was kept back, as comma-separated values.
    pub prediction: Option<String>,
    /// Recordings beside models.
    pub comparison: Comparison,
    /// The search with all its explanations; none of a contact flange or an arm.
    pub diagnosis: Option<Diagnosis>,
    /// What a diagnosis with a recording more goes on from; none but of a device on a bench or a cell.
    pub explanations: Option<Explanations>,
    /// The improved model; none of a contact flange or an arm.
    pub plant: Option<PlantParameters>,
    /// Further files by their names; none but of an arm.
    pub beside: Vec<(&'static str, String)>,
}
