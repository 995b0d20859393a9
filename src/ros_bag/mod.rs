//! Messages of ROS 2 in an MCAP: their definitions, their coding, and files of them as `ros2 bag` and Foxglove read them. Knows nothing of what they say.

mod coded;
mod definitions;
mod file;

pub use coded::Coded;
pub use definitions::definition;
#[cfg(test)]
pub(crate) use definitions::names;
pub use file::{BagFile, Packing, TopicId};
pub use mcap::McapError as BagError;
