//! `idc vary`: many runs of a scenario with other values, and what they say together.

mod command;
mod in_process;
mod page;
mod planned;
mod table;
mod work;

pub(super) use command::{EXAMPLES, VaryArguments, run};
pub use in_process::{SweepOfRuns, SweepRequest, between, vary_scenario};
pub(super) use page::document;
pub(super) use planned::Files;
pub(super) use table::{RUNS, SWEEP, columns};
pub(super) use work::{KIND, Worker, report_result};
