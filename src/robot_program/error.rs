//! What keeps a program from being written, or read.

use std::path::PathBuf;

use thiserror::Error;

use crate::cell::CellError;

/// What keeps a program from being written or read.
#[derive(Debug, Error)]
pub enum ProgramError {
    /// Another number of axes than the dialect has.
    #[error(
        "{file}: the arm has {axes} axes, expected six for --dialect {dialect}; without --dialect, trajectory.csv and trajectory.mcap are written for every arm"
    )]
    Axes {
        /// The scenario.
        file: PathBuf,
        /// The dialect.
        dialect: &'static str,
        /// Their number.
        axes: usize,
    },
    /// An axis that slides.
    #[error(
        "{file}: axis {axis} slides, which --dialect {dialect} takes for an external axis and is not written; expected six axes that turn; without --dialect, trajectory.csv and trajectory.mcap are written for every arm"
    )]
    Slides {
        /// The scenario.
        file: PathBuf,
        /// The dialect.
        dialect: &'static str,
        /// The axis.
        axis: String,
    },
    /// A robot of another maker.
    #[error(
        "{file}: the robot `{robot}` is by {maker}, and --dialect {dialect} is for {of}; expected {way_out} (program.maker says otherwise where the name misleads)"
    )]
    Maker {
        /// The scenario.
        file: PathBuf,
        /// The robot's name.
        robot: String,
        /// Its maker.
        maker: &'static str,
        /// The dialect.
        dialect: &'static str,
        /// The maker that the dialect is of.
        of: &'static str,
        /// What to do.
        way_out: String,
    },
    /// An output of which nobody knows what its values mean.
    #[error(
        "{file}: program.output_forces_n and program.output_values are missing: what a value of AO does is set in a FANUC controller; expected both, as output_forces_n = [0, 200] and output_values = [0, 2000]"
    )]
    OutputUnknown {
        /// The scenario.
        file: PathBuf,
    },
    /// A force beyond the table.
    #[error(
        "{file}: pass {pass} presses with {force} N, and program.output_forces_n goes from {low} to {high}; expected a table that holds it"
    )]
    ForceBeyond {
        /// The scenario.
        file: PathBuf,
        /// The pass, from 1.
        pass: usize,
        /// Its force [N].
        force: f64,
        /// Least force of the table [N].
        low: f64,
        /// Greatest force of the table [N].
        high: f64,
    },
    /// A value that the output cannot have.
    #[error(
        "{file}: program.output_values holds {value}, expected {low} to {high} for an output in --dialect {dialect}"
    )]
    OutputValue {
        /// The scenario.
        file: PathBuf,
        /// The value.
        value: f64,
        /// Least value.
        low: f64,
        /// Greatest value.
        high: f64,
        /// The dialect.
        dialect: &'static str,
    },
    /// A name that the dialect does not know for an output.
    #[error(
        "{file}: program.force_output is `{found}`, expected {expected} for --dialect {dialect}"
    )]
    OutputName {
        /// The scenario.
        file: PathBuf,
        /// The name.
        found: String,
        /// What was expected.
        expected: &'static str,
        /// The dialect.
        dialect: &'static str,
    },
    /// A posture that the dialect's words do not describe.
    #[error(
        "{file}: {reason}, so that the configuration of --dialect {dialect} cannot be known; expected --moves joint, which needs none"
    )]
    Configuration {
        /// The scenario.
        file: PathBuf,
        /// The dialect.
        dialect: &'static str,
        /// Why.
        reason: &'static str,
    },
    /// Joint angles that depend on the controller.
    #[error(
        "{file}: program.joint_3_by_2 is missing: joint 3 of a FANUC controller may count from the horizontal, and its URDF does not say so; expected 1 (usual), 0 or -1 for --moves joint, or --moves cartesian"
    )]
    Coupling {
        /// The scenario.
        file: PathBuf,
    },
    /// A line that is not understood.
    #[error("line {line}: {found}, expected {expected}")]
    Line {
        /// The line, from 1.
        line: usize,
        /// What is there.
        found: String,
        /// What was expected.
        expected: String,
    },
    /// A program that was read back as another one.
    #[error(
        "the {dialect} program does not say what was planned ({what}): a fault of the program, please report it"
    )]
    NotTheSame {
        /// The dialect.
        dialect: &'static str,
        /// The difference.
        what: String,
    },
    /// The arm's file.
    #[error(transparent)]
    Cell(Box<CellError>),
    /// A bag that could not be written.
    #[error("cannot make the bag: {0}")]
    Bag(String),
}
