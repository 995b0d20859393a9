//! Why no experiment is proposed, and what a rig's program did wrong.

use crate::diagnosis::experiment::limits::LimitError;

/// A refusal.
#[derive(Debug, thiserror::Error)]
pub enum NextError {
    /// Neither a bench nor a cell.
    #[error(
        "{case}: experiments are proposed of a whole device, expected a folder with a rig.toml without [rig] chain, or a cell's recordings with --scenario; of a recorded arm `idc check ARM --design` writes one"
    )]
    NoBench {
        /// Name of the case.
        case: String,
    },
    /// A cell whose device never presses.
    #[error(
        "{case}: the set pressure is zero in every recording, expected one of a ride: experiments move the arm along the path on which its device pressed"
    )]
    NoCourse {
        /// Name of the case.
        case: String,
    },
    /// Limits that leave nothing.
    #[error(transparent)]
    Limits(LimitError),
    /// The program of a rig cannot be started.
    #[error(
        "--rig {program}: cannot be started ({cause}), expected a program that is called as PROGRAM IN.csv OUT.csv"
    )]
    NoProgram {
        /// The program.
        program: String,
        /// Why.
        cause: String,
    },
    /// It took too long.
    #[error("--rig {program}: no recording after {seconds:.0} s, expected one within --patience")]
    TooLong {
        /// The program.
        program: String,
        /// The limit [s].
        seconds: f64,
    },
    /// It failed.
    #[error(
        "--rig {program}: exit code {code}{said}; expected 0 with a recording, 3 where it refuses the inputs, 4 where they are to be tried again"
    )]
    Failed {
        /// The program.
        program: String,
        /// Its exit code, or what ended it.
        code: String,
        /// What it printed on stderr, where it printed anything.
        said: String,
    },
    /// It refuses whatever is asked.
    #[error(
        "--rig {program}: refused {tries} experiments (exit code 3){said}; expected one that it takes: state its limits in [limits] of the rig or cell file"
    )]
    Refused {
        /// The program.
        program: String,
        /// Experiments that were tried.
        tries: usize,
        /// What it printed on stderr.
        said: String,
    },
    /// It gave nothing back.
    #[error("--rig {program}: {file} was not written, expected a recording with columns {columns}")]
    Nothing {
        /// The program.
        program: String,
        /// File that was asked for.
        file: String,
        /// Columns of a recording.
        columns: String,
    },
    /// Inputs that come back otherwise than they were asked for.
    #[error(
        "{file}: at {time:.3} s `{column}` is {found}, expected {asked} as it was asked for; a recording states the inputs that were carried out, within 50 ms and 1 % of the time"
    )]
    OtherInputs {
        /// The recording.
        file: String,
        /// Time in it [s].
        time: f64,
        /// The column.
        column: String,
        /// What it holds.
        found: String,
        /// What was asked for.
        asked: String,
    },
}
