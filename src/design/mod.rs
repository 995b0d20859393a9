//! The design study: which device, within bounds and a catalogue, keeps the contact force most uniform under limits.
//!
//! ```text
//! minimise   f(d)                    over scenarios: contact-force variation, or another metric
//! subject to g_j(d) <= 0             limits: force range, stroke margin, impact peak, ...
//!            d_i in [min, max], or in a catalogue
//! ```
//!
//! [`load`] reads and checks the study file; [`run`] searches, given anything that can [`Evaluate`] a [`Design`]; the [`StudyResult`] holds the
//! chosen design beside the starting one, the trade-off front against a second objective, what binds it, and what each variable would still do.
//! The simulation of a design is none of this module's business.
//!
//! What varies from part to part is no variable: `[robustness]` draws it at the chosen design, and tells how many draws keep the limits (`robustness`).
//!
//! The search (`search`): differential evolution over everything with feasibility first, then COBYLA on the continuous variables of the best few
//! catalogue choices and of their neighbours. The front: the same under a ceiling on the second objective, one level after the other.

mod archive;
mod candidate;
mod catalogue;
mod error;
mod evolve;
mod file;
mod front;
mod goal;
mod limits;
mod polish;
mod refine;
mod result;
pub mod robustness;
mod search;
mod sensitivity;
mod study;
#[cfg(test)]
mod tests;
mod variable;

pub use candidate::{Design, Evaluate, EvaluateError, Outcome, ScenarioOutcome};
pub use error::DesignError;
pub use file::schema;
pub use limits::{Limit, LimitQuantity, Side};
pub use result::{
    ActiveBound, ActiveLimit, Candidate, FrontPoint, LimitState, ObjectiveNames, Sensitivity,
    StudyDocument, StudyResult, VariedKey,
};
pub use robustness::{Distribution, Robustness, Scatter, Scattering};
pub use search::{check_start, run};
pub use study::{Objective, Over, Study, TradeOff, load};
pub use variable::{CatalogueEntry, Domain, Variable};
