//! What an importer or a file asks of a unit that cannot be.

use crate::rig::RigError;
use crate::scenario::ScenarioError;

/// A refusal.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum FmuError {
    /// The scenario, or the device that it names.
    #[error(transparent)]
    Scenario(#[from] ScenarioError),
    /// A scenario of another kind.
    #[error(
        "{file}: a cell cannot be a co-simulation unit, expected a scenario of kind = \"bench\" or a rig file of a whole device"
    )]
    Cell {
        /// The file.
        file: String,
    },
    /// A rig that is a part of a device.
    #[error(
        "{file}: [rig] chain = \"{chain}\" is a part of a device, and a co-simulation unit is a whole one; expected a rig file without [rig] chain"
    )]
    Part {
        /// The file.
        file: String,
        /// The part.
        chain: &'static str,
    },
    /// The unit's description is of another build or of another rig.
    #[error(
        "this library (idc {library}) does not make the variables that modelDescription.xml lists; expected the library and the files of one `idc export fmu`"
    )]
    Token {
        /// Build of the library.
        library: &'static str,
    },
    /// A variable that there is not.
    #[error(
        "value reference {reference} is no variable of type {kind}, expected one of modelDescription.xml"
    )]
    NoVariable {
        /// Its value reference.
        reference: u32,
        /// Type asked for.
        kind: &'static str,
    },
    /// A variable that the importer cannot set.
    #[error("`{name}` cannot be set {when}, expected an input or a tunable parameter")]
    NotSet {
        /// Its name.
        name: String,
        /// When it was tried.
        when: &'static str,
    },
    /// A value out of range.
    #[error("`{name}` is {value}, expected {expected}")]
    Value {
        /// Name of the variable.
        name: String,
        /// The value [SI].
        value: f64,
        /// What it may be.
        expected: String,
    },
    /// A step before the initialization, or after the end.
    #[error(
        "the unit is not initialized, expected EnterInitializationMode and ExitInitializationMode first"
    )]
    NotInitialized,
    /// A communication point that is not where the unit is.
    #[error("the communication point is {point} s, expected {time} s, where the step before ended")]
    Point {
        /// Communication point [s].
        point: f64,
        /// Time of the unit [s].
        time: f64,
    },
    /// A communication step that cannot be.
    #[error("the communication step is {length} s, expected a time above 0, at most {most} s")]
    Length {
        /// Its length [s].
        length: f64,
        /// The longest [s].
        most: f64,
    },
    /// The physics went astray.
    #[error(transparent)]
    Rig(#[from] RigError),
    /// A place of resources that is none.
    #[error("the resources are at {given}, expected {expected}")]
    Resources {
        /// As the importer says.
        given: String,
        /// Form that is expected.
        expected: &'static str,
    },
    /// A function that the unit does not have.
    #[error("{function} is not of this unit, expected what modelDescription.xml says that it can")]
    NoFunction {
        /// The function.
        function: &'static str,
    },
    /// Arguments that cannot be.
    #[error("{what}")]
    Argument {
        /// What is wrong, and what was expected.
        what: String,
    },
}

impl FmuError {
    /// Whether the call can be made again with another value: nothing has changed.
    pub(super) fn is_discarded(&self) -> bool {
        matches!(self, Self::Value { .. } | Self::NotSet { .. })
    }
}
