//! A cell's planned path as a program for its robot, in the words of a maker; and programs of makers read back into moves.
//!
//! - `planned`: the plan as moves, or sampled over time;
//! - `moves`: what all dialects can say;
//! - `posture`: how an arm stands, as dialects name it;
//! - one file for each dialect, which writes and reads it;
//! - `trajectory`, `ros_bag`: the joints over time, for every arm.

mod compared;
mod dialect;
mod error;
mod fanuc_ls;
mod krl;
mod moves;
mod orientation;
mod output;
mod planned;
mod posture;
mod rapid;
mod ros_bag;
mod trajectory;
mod urscript;
mod words;

pub use compared::{Deviation, deviation};
pub use dialect::Dialect;
pub use error::ProgramError;
pub use moves::{Configuration, Frame, Move, Program, Step, Target, Timing, Way, Zone};
pub use planned::{Moves, planned};
pub use posture::{Posture, configuration};
pub use ros_bag::bag;
pub use trajectory::{Sampled, csv, sampled};

/// The text of a program.
#[must_use]
pub fn write(dialect: Dialect, program: &Program) -> String {
    match dialect {
        Dialect::Urscript => urscript::write(program),
        Dialect::Krl => krl::write(program),
        Dialect::Rapid => rapid::write(program),
        Dialect::FanucLs => fanuc_ls::write(program),
    }
}

/// The program of a text.
///
/// # Errors
/// The line that is not understood.
pub fn read(dialect: Dialect, text: &str) -> Result<Program, ProgramError> {
    match dialect {
        Dialect::Urscript => urscript::read(text),
        Dialect::Krl => krl::read(text),
        Dialect::Rapid => rapid::read(text),
        Dialect::FanucLs => fanuc_ls::read(text),
    }
}
