//! The proof of a diagnosis: cases of the laboratory, whose truth is sealed, diagnosed and scored.
//!
//! An answer is scored that stands already: the sealed file of a case is opened only after its diagnosis has been written.

mod case_conditions;
mod confusion;
mod devices;
mod error;
mod laws;
mod outcome;
mod prove;
mod queue;
mod reliability;
mod score;
mod summary;
mod sweep;

pub use case_conditions::CaseConditions;
pub use confusion::page;
pub use devices::{DrawPlan, LEAST_SHARE, write_recipes};
pub use error::ProofError;
pub use laws::{LawAnswer, LawOutcome, laws, laws_page};
pub use outcome::{Made, Outcome};
pub use prove::{Diagnose, folders, prove};
pub use queue::all as in_order;
pub use reliability::{Reliability, ReliabilityBin};
pub use score::{CaseScore, StatedName, judge, overlap, worst_channel};
pub use summary::{Claims, ProofSummary};
pub use sweep::{Course, SweepPlan, sweep};
