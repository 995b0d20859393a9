//! `idc run`: from a scenario to its recording and numbers, once or with `--set` for each of several values.

mod cell_run;
mod command;
mod job;
mod numbers;
mod settings;
mod source;
mod table;
mod variants;

pub use cell_run::{Finished, run_cell};
pub(super) use cell_run::{Listener, RunPart};
pub(super) use command::{RunArguments, put_in, run};
pub(super) use numbers::{Numbers, can_run, metric_names, numbers};
pub(super) use settings::blamed;
pub(super) use source::Source;
pub(super) use table::{FINISHED, most_telling};
