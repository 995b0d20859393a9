//! What keeps a path from being designed.

use std::path::PathBuf;

use crate::arm::ArmError;
use crate::cell::CellError;
use crate::collision::ModelError;

/// What a path runs into.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum Hindrance {
    /// A joint is too weak.
    #[error("{joint} needs {:.0} % of what its effort in the URDF leaves (less a fifth), however little it moves", 100.0 * share)]
    Torque {
        /// The joint.
        joint: String,
        /// Torque that it needs over what it may have [1].
        share: f64,
    },
    /// Bodies come too near to each other.
    #[error("{first} and {second} come nearer to each other than {:.0} mm, however little the joints move; [collision] has allowed_pairs, floor_height_mm and margin_mm", 1e3 * margin)]
    Met {
        /// One.
        first: String,
        /// The other.
        second: String,
        /// Distance that was asked for [m].
        margin: f64,
    },
}

/// A path that cannot be designed.
#[derive(Debug, thiserror::Error)]
pub enum ExcitationError {
    /// The limits leave no room.
    #[error("{}: no path was found within the limits of position, speed, torque and collision: of the last that was tried, {hindrance}", file.display())]
    NoRoom {
        /// The arm's file.
        file: PathBuf,
        /// What the last path ran into.
        hindrance: Hindrance,
    },
    /// The URDF's shapes.
    #[error("{}: the arm's shapes: {source}", file.display())]
    Shapes {
        /// The arm's file.
        file: PathBuf,
        /// Why not.
        source: Box<ArmError>,
    },
    /// Bodies that cannot be checked for collisions.
    #[error("{}: {source}", file.display())]
    Bodies {
        /// The arm's file.
        file: PathBuf,
        /// Why not.
        source: Box<ModelError>,
    },
    /// An obstacle.
    #[error(transparent)]
    Obstacle(Box<CellError>),
}
