//! Languages of robot programs, and what each can say.

use crate::listed::listed;

listed! {
    /// A language of robot programs.
    #[derive(Debug, Clone, Copy, PartialEq, Eq)]
    pub enum Dialect: 4,
    /// Its name on the command line.
    name: &'static str {
        /// URScript, Universal Robots.
        Urscript = "urscript",
        /// KRL, KUKA.
        Krl = "krl",
        /// RAPID, ABB.
        Rapid = "rapid",
        /// TP programs as text, FANUC.
        FanucLs = "fanuc_ls",
    }
}

impl Dialect {
    /// Its maker's name.
    #[must_use]
    pub const fn maker(self) -> &'static str {
        match self {
            Self::Urscript => "Universal Robots",
            Self::Krl => "KUKA",
            Self::Rapid => "ABB",
            Self::FanucLs => "FANUC",
        }
    }

    /// Ending of its files.
    #[must_use]
    pub const fn ending(self) -> &'static str {
        match self {
            Self::Urscript => "script",
            Self::Krl => "src",
            Self::Rapid => "mod",
            Self::FanucLs => "ls",
        }
    }

    /// The output that sets the force where the scenario names none.
    #[must_use]
    pub const fn usual_output(self) -> &'static str {
        match self {
            Self::Urscript => "0",
            Self::Rapid => "aoForce",
            Self::Krl | Self::FanucLs => "1",
        }
    }

    /// The output's value at 10 V, where the dialect itself says it.
    #[must_use]
    pub const fn full_output(self) -> Option<f64> {
        match self {
            Self::Urscript | Self::Krl => Some(1.0),
            Self::Rapid => Some(10.0),
            Self::FanucLs => None,
        }
    }

    /// Least and greatest value of an output.
    #[must_use]
    pub const fn output_range(self) -> [f64; 2] {
        match self {
            Self::Urscript => [0.0, 1.0],
            Self::Krl => [-1.0, 1.0],
            Self::Rapid => [-1e6, 1e6],
            Self::FanucLs => [0.0, 32_767.0],
        }
    }
}
