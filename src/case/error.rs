//! Reasons why a folder is no case that can be diagnosed.

use crate::cell::CellError;
use crate::diagnosis::flange::NoContact;
use crate::diagnosis::recordings::recorded::RecordedError;
use crate::recording::RecordingError;
use crate::scenario::ScenarioError;

/// A case that cannot be read, or a model of it that cannot be simulated.
#[derive(Debug, thiserror::Error)]
pub enum CaseError {
    /// The rig file or the scenario.
    #[error(transparent)]
    Scenario(#[from] ScenarioError),
    /// The cell.
    #[error(transparent)]
    Cell(#[from] CellError),
    /// A recording's file.
    #[error(transparent)]
    Recording(#[from] RecordingError),
    /// A recording of a rig.
    #[error(transparent)]
    Recorded(#[from] RecordedError),
    /// A law that a user tries, without a value somewhere in the recordings.
    #[error(
        "--try: at `{part}`, character {location} of the expression: it is not finite in {recording} at {time_s:.4} s, as the nominal model runs it; expected a value there for all its constants' ranges"
    )]
    TriedNotFinite {
        /// The part.
        part: String,
        /// Its first character, from 1.
        location: usize,
        /// The recording.
        recording: String,
        /// When.
        time_s: f64,
    },
    /// A law that a user tries on a contact flange, which is seen from outside.
    #[error(
        "--try: {folder} is of a contact flange, of which nothing is simulated; expected a case with a device or a part of one"
    )]
    TriedOnFlange {
        /// The case's folder.
        folder: String,
    },
    /// A law that a user tries on a recorded arm.
    #[error(
        "--try: {folder} is of a recorded arm; expected a case with a device or a part of one ([[law]] in arm.toml states a law at a joint)"
    )]
    TriedOnArm {
        /// The case's folder.
        folder: String,
    },
    /// Recordings beside those of a case that takes none.
    #[error(
        "--with-recording: {folder} is no case of a whole device on a bench; expected one (a rig.toml without `device.parts`), or a cell (--scenario): name the recordings of any other in its own file"
    )]
    NothingToAddTo {
        /// The case's folder.
        folder: String,
    },
    /// Explanations of a diagnosis that cannot be gone on from.
    #[error("{file}: {reason}; expected what `idc diagnose` writes: diagnose the case again")]
    Explanations {
        /// The file.
        file: String,
        /// Why.
        reason: String,
    },
    /// A log of an arm that is too short.
    #[error(
        "{file}: {found} samples are too few to diagnose an arm from, expected at least {least}: record longer, or leave it out of `recordings.fit`"
    )]
    ShortLog {
        /// The log.
        file: String,
        /// Its samples.
        found: usize,
        /// Least number.
        least: usize,
    },
    /// A cell with an arm file, and recordings without anything of its drives.
    #[error(
        "{file}: no column of a drive's current or torque or of a wrench, expected at least one, as {arm} describes the arm's drives and sensor: log them, or leave `arm.recorded_arm` out"
    )]
    NoDrives {
        /// The first recording.
        file: String,
        /// The arm file.
        arm: String,
    },
    /// Logs of an arm in which no joint turns back.
    #[error(
        "{file}: it is shorter than a period of its motion, as no joint turns back in it or in any other recording; expected motion to and fro, without which friction and load look alike"
    )]
    NoPeriod {
        /// The log.
        file: String,
    },
    /// Torques in columns of currents.
    #[error(
        "{file}: column `{column}` is {times:.1} times the current that the nominal arm takes, expected about that current: it looks like a torque; name such columns joint_N_torque_n_m and leave `gain_n_m_per_a` out of the drives"
    )]
    TorquesAsCurrents {
        /// The log.
        file: String,
        /// The column.
        column: String,
        /// Its size over the nominal current.
        times: f64,
    },
    /// A case of a cell without a recording to diagnose from.
    #[error(
        "{folder}: no recording in it has a measured column, expected at least one to diagnose from"
    )]
    NothingMeasured {
        /// The case's folder.
        folder: String,
    },
    /// Two recordings of a cell's case that were not measured.
    #[error(
        "{file}: it has no measured column, nor has {first}; expected one recording at most that is to be predicted"
    )]
    TwoUnseen {
        /// The second.
        file: String,
        /// The first.
        first: String,
    },
    /// A folder without a rig file.
    #[error(
        "{folder} holds no rig.toml, arm.toml or postures.toml; expected a folder with one and the recordings that it names (--all takes a folder of such folders)"
    )]
    NoRig {
        /// The folder.
        folder: String,
    },
    /// Still postures of a wrench sensor without their file.
    #[error(
        "{folder} holds no rig.toml, arm.toml or postures.toml; {table} looks like still postures of a wrench sensor: expected a postures.toml beside it with schema = 1, kind = \"wrench_postures\" and [recordings] fit = [{table:?}], all else as far as it is known (`idc new postures` writes one with every key)"
    )]
    PosturesUnstated {
        /// The folder.
        folder: String,
        /// The table.
        table: String,
    },
    /// Too few postures.
    #[error(
        "{file}: {found} postures are too few to tell zero from weight, expected at least {least} that turn the sensor about two axes"
    )]
    FewPostures {
        /// The file.
        file: String,
        /// Postures.
        found: usize,
        /// Least number.
        least: usize,
    },
    /// Postures that turn the sensor about one axis.
    #[error(
        "{file}: beside one axis its postures turn the sensor by {degrees:.2} degrees RMS, in which zero and weight look alike; expected 3 at least: record postures that lean about two axes"
    )]
    NotTurned {
        /// The file.
        file: String,
        /// The turn [degrees].
        degrees: f64,
    },
    /// A posture without a value.
    #[error(
        "{file}: line {line}: `{column}` is empty, expected a number; leave out rows without a reading"
    )]
    NoReading {
        /// The table.
        file: String,
        /// Its line, from 1.
        line: u64,
        /// The column.
        column: String,
    },
    /// A quaternion that is none.
    #[error(
        "{file}: line {line}: the quaternion has a norm of {norm:.3}, expected 1, of a pose as x, y, z, w ([columns] of the file says which columns hold them)"
    )]
    NoRotation {
        /// The table.
        file: String,
        /// Its line, from 1.
        line: u64,
        /// Its norm.
        norm: f64,
    },
    /// Torques in a smaller unit.
    #[error(
        "{file}: its torques change as if the tool hung {lever:.0} m from the sensor, expected 5 m at most: they look like N mm (`torque_unit` in [columns]), or forces like kN (`force_unit`)"
    )]
    LongLever {
        /// The file.
        file: String,
        /// The lever [m].
        lever: f64,
    },
    /// A file of postures that cannot predict.
    #[error(
        "{file}: `wrench_sensor.{key}` is missing, expected it to be given where readings are to be predicted (improved.toml of a diagnosis has it)"
    )]
    NotDeclared {
        /// The file.
        file: String,
        /// The key.
        key: &'static str,
    },
    /// A rig file that names nothing to diagnose from.
    #[error("{file}: `recordings.fit` names no recording, expected the files to diagnose from")]
    NoRecordings {
        /// Rig file.
        file: String,
    },
    /// A run of a contact flange without contact.
    #[error("{folder}: {source}")]
    NoContact {
        /// The case.
        folder: String,
        /// Which run, and what was expected.
        source: NoContact,
    },
    /// A pattern that no recording fits.
    #[error("{file}: `recordings.fit` has {pattern:?}, which no file beside it fits")]
    NoneLike {
        /// Rig file.
        file: String,
        /// The pattern.
        pattern: String,
    },
    /// A rig file that carries a model discrepancy already.
    #[error(
        "{file} holds [latent], a term that a diagnosis found; expected the nominal rig file, to diagnose from (idc predict takes this one)"
    )]
    Latent {
        /// Rig file.
        file: String,
    },
    /// A table of runs with a value that cannot be.
    #[error("{file}: line {line}: `{column}` is {value}, expected {expected}")]
    Row {
        /// The table.
        file: String,
        /// Its line, from 1.
        line: u64,
        /// The column.
        column: String,
        /// The value as written.
        value: f64,
        /// What it may be.
        expected: &'static str,
    },
    /// A table of runs that is too short to judge a law by.
    #[error(
        "{file}: {rows} of its rows can be used to fit the law, expected at least {least}: with every setting known and something taken off"
    )]
    FewRows {
        /// The file of the case.
        file: String,
        /// Rows that can be used.
        rows: usize,
        /// Least number.
        least: usize,
    },
    /// A law of removal that cannot predict.
    #[error(
        "{file}: `believed.reference_volume_mm3` is missing, expected it to be given where a table is to be predicted (improved.toml of a diagnosis has it)"
    )]
    NoCoefficient {
        /// The file.
        file: String,
    },
    /// A rig whose motion cannot be followed.
    #[error(
        "{rig}: the rig goes astray at {time} s of {inputs}: its {column} is {value}; expected a rig that stays finite"
    )]
    NotFinite {
        /// Rig file.
        rig: String,
        /// Recording.
        inputs: String,
        /// When [s].
        time: f64,
        /// The column.
        column: &'static str,
        /// Its value.
        value: f64,
    },
}
