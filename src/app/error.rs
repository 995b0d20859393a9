//! Errors that end a command early, and the exit code that goes with each.

use crate::advice::Advice;
use crate::case::CaseError;
use crate::cell::CellError;
use crate::design::DesignError;
use crate::diagnosis::answer::AnswerError;
use crate::diagnosis::recordings::recorded::RecordedError;
use crate::excitation::ExcitationError;
use crate::import::ImportError;
use crate::quantity::counted;
use crate::recording::RecordingError;
use crate::run::RunError;
use crate::scenario::ScenarioError;
use crate::workpiece::WorkpieceError;

/// Exit codes of the program.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum ExitCode {
    /// All is well.
    Done = 0,
    /// A result lies outside the bounds that the scenario states, or no design keeps the limits of the study.
    OutsideBounds = 1,
    /// Bad input: nothing was simulated, nothing was written.
    BadInput = 2,
    /// The physics stopped the run; what was recorded up to there was written.
    Stopped = 3,
}

impl From<ExitCode> for std::process::ExitCode {
    fn from(code: ExitCode) -> Self {
        Self::from(code as u8)
    }
}

/// Bad input, or a file that cannot be written.
#[derive(Debug, thiserror::Error)]
pub enum AppError {
    /// A law to be tried beside a table of runs.
    #[error("{folder} holds a table of runs: --try takes a law of a rig or a cell, expected none")]
    NoLawOfTable {
        /// The folder.
        folder: String,
    },
    /// A scenario, its run or its numbers.
    #[error(transparent)]
    Run(Box<RunError>),
    /// A refusal with what would make the job possible.
    #[error("{source}{advice}")]
    Advised {
        /// The refusal.
        source: Box<AppError>,
        /// What would help.
        advice: Box<Advice>,
    },
    /// An experiment that cannot be proposed, or a rig's program.
    #[error(transparent)]
    Next(#[from] super::next::NextError),
    /// A mesh.
    #[error(transparent)]
    Workpiece(#[from] WorkpieceError),
    /// A folder without results.
    #[error(
        "{folder}: there are no results in it, expected the folder of a run (summary.json), a diagnosis (diagnosis.json), a sweep (vary.json), a fleet (fleet.json) or a study (design.json)"
    )]
    NoResults {
        /// The folder.
        folder: String,
    },
    /// Folders of runs and of diagnoses.
    #[error("{diagnosis} holds a diagnosis and {run} a run, expected all of one kind")]
    MixedResults {
        /// A folder with a diagnosis.
        diagnosis: String,
        /// A folder with a run.
        run: String,
    },
    /// One folder alone.
    #[error(
        "{folder} is the only folder given, expected two to seven, the first of which the others are compared with"
    )]
    ComparedWithNothing {
        /// The folder.
        folder: String,
    },
    /// A folder that cannot be compared.
    #[error(
        "{folder}: there is nothing in it to compare, expected the folder of a run (summary.json) or of a diagnosis (diagnosis.json)"
    )]
    NotCompared {
        /// The folder.
        folder: String,
    },
    /// A name that a file cannot hold.
    #[error(
        "{file}: its name stands in the file too, and {letter:?} cannot; expected a name without it"
    )]
    Unwritable {
        /// The file.
        file: String,
        /// The letter that cannot.
        letter: char,
    },
    /// A log, or its map's columns.
    #[error(transparent)]
    Import(#[from] ImportError),
    /// Only an import map is drafted from logs.
    #[error("--from is of `idc new import`, and `idc new {kind}` was asked for")]
    NotDrafted {
        /// The request.
        kind: &'static str,
    },
    /// Logs that do not come in the map's number.
    #[error("{given} logs were given, expected {each} or a multiple of it: {} has as many [[file]]", map.display())]
    Logs {
        /// Their number.
        given: usize,
        /// Number of them that the map has.
        each: usize,
        /// The map.
        map: std::path::PathBuf,
    },
    /// Logs after a recording that needs no map.
    #[error("{} is a recording and no import map, and says itself what it holds: expected no logs after it, {more} were given; one command for each recording, or an import map in its place", file.display())]
    OwnRecording {
        /// The recording.
        file: std::path::PathBuf,
        /// Number of the logs.
        more: usize,
    },
    /// Two recordings of one name.
    #[error("{} and {} would both be written to {}; expected logs of different names, or one command for each", one.display(), other.display(), out.display())]
    SameOutput {
        /// The first log.
        one: std::path::PathBuf,
        /// The second.
        other: std::path::PathBuf,
        /// The recording.
        out: std::path::PathBuf,
    },
    /// A design study.
    #[error(transparent)]
    Design(Box<DesignError>),
    /// The output folder.
    #[error(
        "cannot write into the output folder {folder}: {reason}; expected a folder, there or to be made, that can be written (--out names another)"
    )]
    OutputFolder {
        /// The folder.
        folder: String,
        /// Why.
        reason: String,
    },
    /// Results stand where new ones are to go.
    #[error(
        "{folder} holds results already ({name}); expected another folder (--out), or --force to put new ones in their place"
    )]
    ResultsExist {
        /// The folder.
        folder: String,
        /// A file that stands in it.
        name: String,
    },
    /// A folder that another process is writing.
    #[error(
        "another idc is writing into {folder}; expected another folder (--out), or that one to end first"
    )]
    FolderClaimed {
        /// The folder.
        folder: String,
    },
    /// A file that another process is writing.
    #[error(
        "another idc is writing {file}; expected another name ({option}), or that one to end first"
    )]
    FileClaimed {
        /// The file.
        file: String,
        /// The option that names another.
        option: &'static str,
    },
    /// A file that describes nothing.
    #[error(
        "{file}: expected a scenario, a rig file, an import map, a study or a device model (a .toml), or a folder with a rig.toml; idc import reads logs"
    )]
    NoDescription {
        /// The file.
        file: String,
    },
    /// A file stands where one is to go.
    #[error(
        "{file} is there already; expected another name ({option}), or --force to put a new one in its place"
    )]
    FileExists {
        /// The file.
        file: String,
        /// The option that names another.
        option: &'static str,
    },
    /// An output file that cannot be.
    #[error(
        "cannot write {file}: {reason}; expected a file, in a folder that can be written ({option} names another)"
    )]
    OutputFile {
        /// The file.
        file: String,
        /// The option that names another.
        option: &'static str,
        /// Why.
        reason: String,
    },
    /// Flags that ask for no runs.
    #[error("--set: {reason}")]
    Setting {
        /// The fault, and what was expected.
        reason: String,
    },
    /// A law of a user's own that is none.
    #[error("tried: {reason}")]
    Tried {
        /// The fault, and what was expected.
        reason: String,
    },
    /// An effect that there is not.
    #[error("there is no effect `{name}`: {advice}")]
    NoEffect {
        /// Its name.
        name: String,
        /// The nearest one.
        advice: String,
    },
    /// A scenario that cannot be with what is set.
    #[error("{flags}: {source}")]
    Set {
        /// The flags.
        flags: String,
        /// The fault.
        source: Box<AppError>,
    },
    /// Several runs where one can be watched.
    #[error(
        "--view shows one run, and --set asks for {runs}; expected one of the two, and idc view FOLDER for all of them afterwards"
    )]
    ViewOfSeveral {
        /// Their number.
        runs: usize,
    },
    /// A case that does not come with the project.
    #[error(
        "--only {name}: no case of that name comes with the project, which has {known}; expected one of them, or your own cases (--cases)"
    )]
    NoShippedCase {
        /// The name.
        name: String,
        /// Those that there are.
        known: String,
    },
    /// A folder without recordings.
    #[error(
        "{folder}: there is nothing in it to look at, expected a folder that run (recording.rrd) or diagnose (diagnosis.rrd) wrote, or a folder of such folders; --no-recording leaves the recording out, and report.html needs a browser alone"
    )]
    NothingToView {
        /// The folder.
        folder: String,
    },
    /// A folder with too many recordings.
    #[error(
        "{folder} holds {count} recordings, {some} and others, expected at most {most}; name the folders or files to look at"
    )]
    TooManyToView {
        /// The folder.
        folder: String,
        /// Their number.
        count: usize,
        /// Largest number that is opened.
        most: usize,
        /// The first ones.
        some: String,
    },
    /// A part of many that ended in a panic.
    #[error("{part}: a fault of the program, see above; please report it")]
    Fault {
        /// The part.
        part: String,
    },
    /// An arm that does not reach the part anywhere.
    #[error(
        "the arm, with the device on its link `{arm}`, was found no place of the part at which it can work its edge, not even with the smallest device; the first trouble: {reason}"
    )]
    NoPlace {
        /// The link.
        arm: String,
        /// What was in the way.
        reason: String,
    },
    /// A part without an edge that can be ridden.
    #[error("{part}: no edge of it was found that the tool can ride where the robot reaches it, of {}; {reason}; expected a part with a sharp outer edge (idc edges lists them), or another robot (--urdf)", counted(*convex, "outer edge"))]
    NothingRidden {
        /// The mesh.
        part: String,
        /// Its edges that stick out.
        convex: usize,
        /// What is in the way of the longest.
        reason: String,
    },
    /// Something of a cell for another kind of file.
    #[error("{option} is for a cell, a {kind} has none")]
    OfACell {
        /// The option.
        option: &'static str,
        /// The kind of file.
        kind: &'static str,
    },
    /// A log of an arm for another kind of file.
    #[error("--log is for a recorded arm, a {kind} has none (an import map takes --from)")]
    OfAnArm {
        /// The kind of file.
        kind: &'static str,
    },
    /// A recorded arm without a description of its links.
    #[error(
        "idc new arm: --urdf is missing, expected the URDF file of the arm, as its maker gives it"
    )]
    NoUrdf,
    /// A log in which no column is of a joint.
    #[error(
        "{file}: no column is joint_1_rad, expected positions of joints as joint_N_rad beside time_s (it has {columns}); `{import}` drafts a map that makes such columns"
    )]
    NoJoints {
        /// The log.
        file: String,
        /// Its columns.
        columns: String,
        /// Command that helps.
        import: String,
    },
    /// A drawing of the tool of what has none.
    #[error("{file} has no tool on an edge to draw, expected a cell that is simulated with --draw")]
    NoTool {
        /// The file.
        file: String,
    },
    /// A number on the command line.
    #[error("--{option} is {value}, expected {expected}")]
    Option {
        /// The option.
        option: &'static str,
        /// Its value.
        value: f64,
        /// Expected value or form.
        expected: &'static str,
    },
    /// An option that only a cell has.
    #[error("--{option} is for cells, and the scenario is a bench")]
    NoBench {
        /// The option.
        option: &'static str,
    },
    /// A recording of a rig.
    #[error(transparent)]
    Recorded(#[from] RecordedError),
    /// A case.
    #[error(transparent)]
    Case(Box<CaseError>),
    /// A folder without cases.
    #[error(
        "{folder}: {reason}; expected a folder of folders, each with a rig.toml and the recordings that it names"
    )]
    NoCases {
        /// The folder.
        folder: String,
        /// Why there are none.
        reason: String,
    },
    /// Cases of which some could not be diagnosed.
    #[error("{failed} of {} failed; the others are done", counted(*of, "case"))]
    CasesFailed {
        /// Number that failed.
        failed: usize,
        /// Of how many.
        of: usize,
    },
    /// A diagnosis stands where one is to go.
    #[error(
        "{folder} holds a diagnosis already; expected another folder, --force to put a new one in its place, or --resume to keep it"
    )]
    Diagnosed {
        /// The folder.
        folder: String,
    },
    /// The output would go among the inputs.
    #[error("--out is {folder}, where the recordings stand; expected another folder")]
    AmongInputs {
        /// The folder.
        folder: String,
    },
    /// A diagnosis that cannot be written.
    #[error(transparent)]
    Answer(#[from] AnswerError),
    /// A run of a contact flange whose simulated force cannot be measured.
    #[error(
        "{file}: the fitted flange's force never settles in this run, and nothing of it can be measured; expected a run nearer to those that it was fitted to"
    )]
    NeverSettles {
        /// The recording.
        file: String,
    },
    /// The output would take the place of an input.
    #[error("--out is {file}, which is read here; expected another file")]
    Overwrites {
        /// The file.
        file: String,
    },
    /// A sweep that cannot be.
    #[error(transparent)]
    Vary(#[from] crate::vary::VaryError),
    /// A folder of a fleet.
    #[error(transparent)]
    Fleet(#[from] crate::fleet::FleetError),
    /// A plan, its tasks or the engine.
    #[error(transparent)]
    Tasks(#[from] crate::tasks::TaskError),
    /// A proof.
    #[error(transparent)]
    Proof(#[from] crate::proof::ProofError),
    /// A picture.
    #[error(transparent)]
    Figure(#[from] crate::figure::FigureError),
    /// A robot's program.
    #[error(transparent)]
    Program(#[from] crate::robot_program::ProgramError),
    /// A co-simulation unit.
    #[error(transparent)]
    Export(#[from] super::export::ExportError),
    /// A viewer.
    #[error(transparent)]
    Viewer(#[from] super::viewer::ViewerError),
    /// A path for something that is no recorded arm.
    #[error(
        "{file} is no recorded arm, expected an arm file (kind = \"recorded_arm\") or a folder with arm.toml for --design"
    )]
    NoArm {
        /// The file or folder.
        file: String,
    },
    /// A path that cannot be designed.
    #[error(transparent)]
    Excitation(#[from] ExcitationError),
    /// The terminal, or whatever is in its place.
    #[error("cannot print: {0}")]
    Print(std::io::Error),
    /// A document as JSON.
    #[error("cannot write or read results as JSON: {0}")]
    Json(#[from] serde_json::Error),
}

/// What keeps a scenario from being run may come from any part of it.
macro_rules! of_a_run {
    ($($error:ty),*) => {
        $(impl From<$error> for AppError {
            fn from(error: $error) -> Self {
                Self::Run(Box::new(error.into()))
            }
        })*
    };
}
of_a_run!(RunError, ScenarioError, CellError, RecordingError);

impl From<CaseError> for AppError {
    fn from(error: CaseError) -> Self {
        match error {
            CaseError::Scenario(error) => error.into(),
            CaseError::Cell(error) => error.into(),
            CaseError::Recording(error) => error.into(),
            CaseError::Recorded(error) => Self::Recorded(error),
            error => Self::Case(Box::new(error)),
        }
    }
}

impl From<DesignError> for AppError {
    fn from(error: DesignError) -> Self {
        Self::Design(Box::new(error))
    }
}

impl AppError {
    /// The same of a value that stands in a row of a table in place of a flag.
    pub(super) fn in_row(self, row: &str, key: &str, value: &str) -> Self {
        match self {
            Self::Set { source, .. } => Self::Set {
                flags: format!("{row}: {key} = {value}"),
                source,
            },
            other => other,
        }
    }

    /// Exit code that goes with it.
    pub fn exit_code(&self) -> ExitCode {
        match self {
            Self::Design(error) if error.is_verdict() => ExitCode::OutsideBounds,
            _ => ExitCode::BadInput,
        }
    }
}
