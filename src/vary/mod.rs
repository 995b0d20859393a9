//! Sweeps of a scenario: which values its keys have in each run, and what the runs' numbers say together.
//!
//! [`Variable`] is what is varied, [`Points`] the values of each run by its number, so that none need be held; [`shares_of_variance`] says how much of a
//! number's scatter goes with each variable, with an interval; [`Swept`] is what all runs say together, of the table of their numbers.

mod additive;
mod latin;
mod points;
mod share;
mod statistics;
mod sweep;
mod swept;
mod variable;

pub use additive::Varied;
pub use latin::LatinHypercube;
pub use points::{Points, Sampling};
pub use share::{Share, shares_of_variance};
pub use statistics::{QUANTILES, rank_correlation};
pub use sweep::Sweep;
pub use swept::{Driver, MetricOfRuns, ReadColumns, Swept, VariedKey, percent, short};
pub use variable::{Values, Variable, VaryError};
