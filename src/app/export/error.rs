//! What keeps a co-simulation unit from being written.

use crate::fmu::FmuError;

/// A refusal.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ExportError {
    /// The bench, or what is asked of it.
    #[error(transparent)]
    Fmu(#[from] FmuError),
    /// Another platform.
    #[error(
        "a co-simulation unit is for x86_64 Linux, and this program is for {architecture} {system}; expected `idc export fmu` there, as in the container of docs/CI.md"
    )]
    Platform {
        /// Processor.
        architecture: &'static str,
        /// Operating system.
        system: &'static str,
    },
    /// No shared library.
    #[error(
        "{looked}: there is no such file, expected the shared library of co-simulation units, which `{BUILD_COMMAND}` builds into target/release/examples (--library names it elsewhere)"
    )]
    NoLibrary {
        /// Where it was sought.
        looked: String,
    },
    /// A library of other sources.
    #[error(
        "{file} is not the shared library of this program's build, expected one that says \"{mark}\"; `{BUILD_COMMAND}` builds it of the same sources"
    )]
    OtherLibrary {
        /// The file.
        file: String,
        /// What stands in the right one.
        mark: &'static str,
    },
    /// A contact flange.
    #[error(
        "{file}: [flange] is a contact flange with its own control, and a co-simulation unit is a device with its regulator; expected a rig file of such a device"
    )]
    Flange {
        /// The file.
        file: String,
    },
    /// The archive.
    #[error("cannot pack the unit: {0}")]
    Pack(#[from] std::io::Error),
}

/// How the library is built.
const BUILD_COMMAND: &str = "cargo build --release --example co_simulation_unit";
