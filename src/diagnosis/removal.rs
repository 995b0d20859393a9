//! What a table of runs says of the law of removal: settings and the volume that each run took off, against a nominal law.
//!
//! ```text
//! ln V = ln V_0 + a ln (F - F_t)/(F_0 - F_t) + s [ln n/n_0 + ln (1 - g F)/(1 - g F_0)] + q ln t/t_0 + b ln A/A_0 - w r
//! ```
//!
//! V volume [m3], F force [N], n speed, t grinding time [s], or 1/feed [s/m] of a moving tool, A contact area [m2], w wear in its column's unit;
//! a, s, q, b exponents [1], F_t threshold force [N], g sag of the speed under load [1/N], r wear rate. Every set of deviations from the nominal law is
//! fitted (`fit`) and the one is named whose numbers each better the fit more than chance does in one of twenty tables (`select`).
//! Leaves out: that the scatter may be that of the settings as well as that of the volume; wear that is not exponential.

pub mod answer;
mod fit;
mod law;
mod select;
#[cfg(test)]
mod tests;

pub use law::{Deviation, Reference, TableLaw, TableRow};
pub use select::{Left, RemovalDiagnosis, diagnose_table};
