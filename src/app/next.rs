//! `idc next`: the experiment that is expected to tell most of what a diagnosis leaves open, as something that runs; `idc investigate`: a rig that is asked so.

mod command;
mod error;
mod files;
mod investigate;
mod outputs;
mod page;
mod proposal;
mod rig_program;

pub(super) use command::{EXAMPLES, NextArguments, run};
pub use error::NextError;
pub(super) use investigate::{EXAMPLES as INVESTIGATE_EXAMPLES, InvestigateArguments, investigate};
