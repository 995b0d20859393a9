//! Sweeps of a scenario: which values its keys have in each run, and what the runs' numbers say together.
//!
//! [`Variable`] is what is varied, [`Points`] the values of each run by its number, so that none need be held; [`shares_of_variance`] says how much of a
//! number's scatter goes with each variable, with an interval, and [`quantiles`] how it is distributed.

mod additive;
mod latin;
mod points;
mod share;
mod statistics;
mod variable;

pub use additive::Varied;
pub use latin::LatinHypercube;
pub use points::{Points, Sampling};
pub use share::{Share, shares_of_variance};
pub use statistics::{QUANTILES, rank_correlation};
pub use variable::{Values, Variable, VaryError};
