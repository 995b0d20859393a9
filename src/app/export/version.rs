//! Versions of FMI.

use clap::ValueEnum;

/// Version of FMI.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(super) enum Version {
    /// 2.0.
    #[value(name = "2")]
    Two,
    /// 3.0.
    #[value(name = "3")]
    Three,
}

impl Version {
    /// As the description has it.
    pub(super) fn number(self) -> &'static str {
        match self {
            Self::Two => "2.0",
            Self::Three => "3.0",
        }
    }

    /// Folder of a library for x86-64 Linux.
    pub(super) fn platform(self) -> &'static str {
        match self {
            Self::Two => "linux64",
            Self::Three => "x86_64-linux",
        }
    }
}
