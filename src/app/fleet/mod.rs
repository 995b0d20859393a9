//! `idc fleet`: all recordings of many devices diagnosed in the order of their days, and what a maintenance engineer asks of them.

mod command;
mod page;
mod planned;
mod table;
mod work;

pub(super) use command::{EXAMPLES, FleetArguments, run};
pub(super) use page::document;
pub(super) use table::FLEET;
pub(super) use work::{KIND, Worker, report_result};
