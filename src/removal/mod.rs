//! What a turning tool takes off an edge: its contact, and the edge as it is left.

mod edge_state;
mod tool;

pub use edge_state::{EdgeState, EdgeStationState, Ride};
pub use tool::{ToolShape, TurningTool};
