//! The physics that a rig's model may lack: each effect an edit of its description, with the numbers that it needs.

mod catalogue;
mod cell;
mod chambers;
mod contact;
mod effect;
mod force_balance;
mod header;
mod links;
mod number_off;
mod own;
mod parts;
mod quantity;
mod regulator;
mod sensors;

pub use catalogue::{CATALOGUE, UNLISTED, every, vocabulary};
pub use cell::{CELL_EFFECTS, JOINT_EFFECTS, JOINT_FRICTION, SERVO_LAG};
pub use contact::{known_turns, tool_turns_at};
pub use effect::{Clues, Effect, NUMBER_OFF, Parameter, Subsystem, Which};
pub use header::{Header, kinds, meaning};
pub use links::{LINK_EFFECTS, candidates};
pub use number_off::{NUMBERS_OFF, numbers_off};
pub use own::{PresentEffect, actual, own_effect, sought};
pub use quantity::Coordinate;
