//! `idc vary`: many runs of a scenario with other values, and what they say together.

mod command;
mod drivers;
mod page;
mod planned;
mod table;
mod work;

pub(super) use command::{EXAMPLES, VaryArguments, run};
pub(super) use drivers::SWEEP;
pub(super) use page::page_of;
pub(super) use planned::Files;
pub(super) use table::RUNS;
pub(super) use work::{KIND, Worker, told};
