//! The estimator against a planted truth, closed forms and its own statistics.

mod closed_forms;
mod consistency;
mod ensemble;
pub(in crate::estimation) mod plant;
mod refusals;
