//! From the commands of a recorded cell to what its device feels: the arm's trajectory along the part's edge.

mod contact_load;
mod drive_torque;
mod load;
mod trajectory;

pub use contact_load::ToolContact;
pub use drive_torque::Drive;
pub use load::LoadedCell;
