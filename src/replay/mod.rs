//! From the commands of a recorded cell to what its device feels: the arm's trajectory along the part's edge.

mod drive_torque;
mod load;
mod trajectory;

pub use drive_torque::Drive;
pub use load::LoadedCell;
